//! What a ray sees that hits nothing.

use std::sync::Arc;

use snell_math::Rgb;

use crate::diagnostic::Span;
use crate::table::Id;

/// The background; it gives light to no surface but through reflection and refraction.
#[derive(Clone, Debug, PartialEq)]
pub enum Background {
    /// The same colour everywhere.
    Color(Rgb),
    /// By the ray direction's height (its world y): stops of (height in [−1, 1], colour), increasing.
    Gradient(Vec<(f64, Rgb)>),
    /// A photograph that fills the camera's view exactly, as if on a screen at infinity. Directions outside the view take
    /// the nearest border pixel; those pointing behind the camera see it mirrored.
    Photograph {
        /// The picture.
        image: Id<ImageAsset>,
        /// Multiplies its colours.
        intensity: f32,
    },
    /// A panorama (equirectangular) around the scene: the picture's middle is seen along −z, its top row straight up (+y).
    Panorama {
        /// The picture, most often HDR.
        image: Id<ImageAsset>,
        /// Multiplies its colours.
        intensity: f32,
        /// Turns it about +y, radians, counter-clockwise seen from above.
        rotation: f64,
    },
}

impl Default for Background {
    fn default() -> Self {
        Self::Color(Rgb::BLACK)
    }
}

/// A picture file, still encoded; the engine decodes it when it compiles the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageAsset {
    /// Its name as the user knows it.
    pub name: String,
    /// The file's bytes.
    pub bytes: Arc<[u8]>,
    /// Where the scene names it, for messages about its content.
    pub span: Option<Span>,
}

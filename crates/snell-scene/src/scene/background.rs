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
    /// By the ray direction's height (its world y in unit length): stops of (height in [−1, 1], colour) in order, blended
    /// linearly. Stops at the same height make a step; from there on up the last counts.
    Gradient(Vec<(f64, Rgb)>),
    /// A photograph that fills the camera's view exactly, as if on a screen at infinity, stretched where its shape is another
    /// than the picture's. Directions outside the view take the nearest border pixel; those pointing behind the camera are
    /// mirrored to its front. Rays of an orthographic camera, whose directions are all the same, see it by their place in
    /// the picture; once turned aside, as for a perspective camera with 40° between the left and right borders.
    Photograph {
        /// The picture.
        image: Id<ImageAsset>,
        /// Multiplies its colours.
        intensity: f32,
    },
    /// A panorama (equirectangular) around the scene: the picture's middle is seen along −z, its right half towards +x, its
    /// top border straight up (+y), where it has the mean colour of the top row; blended between the centres of pixels.
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

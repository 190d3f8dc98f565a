//! What travels through the tracing loop: rays to be traced, questions to lights, and the names of what comes of them.

mod differentials;
mod media;
mod rows;
mod sums;

use snell_math::{Ray, Rgb};

pub use differentials::Differentials;
pub use media::{Crossing, Inside, MediumStack, MediumStacks};
pub use rows::{QuestionNotes, QuestionQueue, QuestionRows, Queue, RayNotes, RayQueue, RayRows, column, set_column};
pub use sums::SampleSums;

/// A ray to be traced, with its weight to a sample of a pixel. "Rays are tasks": the lecture's recursion is a list of these.
#[derive(Clone, Copy, Debug)]
pub struct RayTask {
    /// The ray, in world space, its direction of unit length.
    pub ray: Ray,
    /// The factor on everything this ray will see, up to its sample.
    pub throughput: Rgb,
    /// Which sample of the tile it belongs to.
    pub sample: u32,
    /// Its own number within the tile's pass, and its parent's; a camera ray is its own parent.
    pub id: u32,
    /// See `id`.
    pub parent: u32,
    /// In which transparent bodies it travels.
    pub media: MediumStack,
    /// 1 for a camera ray, its parent's plus one for a reflected or refracted one.
    pub depth: u16,
    /// How many boundaries without effect it went through since it was spawned, such as that of a body inside one of higher
    /// priority.
    pub passes: u16,
    /// What made it.
    pub kind: RayKind,
    /// The wavelength band it carries, or all light.
    pub band: Option<Band>,
    /// Samples of a pixel, and of neighbouring pixels, split white light at different places: the number of this one's. Of paths, the
    /// number of its own.
    pub split: u32,
}

/// What made a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayKind {
    /// The camera.
    Camera,
    /// Reflection at a mirroring or transparent surface.
    Reflected,
    /// Refraction into or out of a transparent body.
    Refracted,
    /// Reflection in any direction at a surface that is no mirror, or a turn in a medium that scatters.
    Scattered,
}

/// One wavelength band of those that white light is split into, as a place in the integrator's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Band(pub u16);

/// A question that shading asks: how much of a light arrives here?
#[derive(Clone, Copy, Debug)]
pub struct ShadowQuestion {
    /// From the shaded point towards the light, direction of unit length.
    pub ray: Ray,
    /// How far the light is; infinite for a directional one.
    pub distance: f64,
    /// What the light adds to the sample if nothing blocks it, term by term; a term that adds nothing is black.
    pub terms: [(Term, Rgb); 2],
    /// Which sample it belongs to.
    pub sample: u32,
    /// The ray that asks.
    pub task: u32,
    /// The bodies around the shaded point, on the light's side.
    pub media: MediumStack,
    /// The factor on the extinction of scattering media on the way: 1, but for the orders of multiple scattering.
    pub extinction_scale: f32,
}

/// A term of the lecture's `shade`: what a share of a sample came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Term {
    /// The ray hit nothing.
    Background,
    /// Light that the surface gives off.
    Emission,
    /// The ambient term.
    Ambient,
    /// The diffuse lobe, lit by the light of that number.
    Diffuse(u32),
    /// The highlight, lit by the light of that number.
    Specular(u32),
    /// Light scattered towards the viewer inside a milky body.
    Scattering(u32),
    /// Light that came to the surface by specular ones, as photons.
    Photons,
}

/// Why a ray was not followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cut {
    /// It would have been deeper than allowed.
    Depth,
    /// It would have weighed less than allowed.
    Weight,
    /// Its sample had too many rays already.
    Number,
    /// A path ended by chance: those that go on carry more instead.
    Chance,
}

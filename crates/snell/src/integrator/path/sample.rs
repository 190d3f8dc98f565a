//! What a path knows of itself besides its ray: random numbers, wavelengths, what it carries, where it scattered last.

use snell_math::Point3;
use snell_math::sampler::Sampler;

use super::spectra::{Spectral, WHITE, Wavelengths};

/// One path, of one sample of a pixel.
#[derive(Clone, Copy, Debug)]
pub struct PathSample {
    /// Its random numbers; see [`Purpose`] for which set serves what.
    pub sampler: Sampler,
    /// Its wavelengths.
    pub wavelengths: Wavelengths,
    /// What it carries: the factor on the light that it finds.
    pub throughput: Spectral,
    /// By how much radiance is compressed where it is, over where it began: the square of a ratio of indices.
    pub compression: f64,
    /// Where it was last sent on by something that is not specular; `None` while nothing did.
    pub scattered: Option<Vertex>,
    /// How many specular surfaces it met since then.
    pub specular: u32,
    /// How often it was scattered or reflected or refracted: which random numbers come next.
    pub events: u32,
}

/// A place where a path was sent on by something that is not specular.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    /// The place.
    pub point: Point3,
    /// The density per steradian of the direction in which it was sent.
    pub density: f64,
    /// The cosine of that direction with the surface.
    pub cosine: f64,
    /// Photons are gathered there.
    pub gathers: bool,
}

/// What random numbers are for: sets of four dimensions.
#[derive(Clone, Copy, Debug)]
pub enum Purpose {
    /// The place in the pixel and on the lens.
    Camera,
    /// The wavelengths.
    Wavelengths,
    /// A light and a place of it.
    Light,
    /// A lobe, a direction, and whether the path goes on.
    Direction,
    /// How far the path goes in a medium that scatters.
    Medium,
}

impl Purpose {
    /// The set of dimensions for it after so many events.
    pub fn set(self, events: u32) -> u32 {
        match self {
            Self::Camera => 0,
            Self::Wavelengths => 1,
            Self::Light => 2 + 3 * events,
            Self::Direction => 3 + 3 * events,
            Self::Medium => 4 + 3 * events,
        }
    }
}

impl PathSample {
    /// A path that begins at the camera.
    pub fn new(sampler: Sampler, wavelengths: Wavelengths) -> Self {
        Self { sampler, wavelengths, throughput: WHITE, compression: 1.0, scattered: None, specular: 0, events: 0 }
    }

    /// Four random numbers.
    pub fn draw(&self, purpose: Purpose) -> [f64; 4] {
        self.sampler.set(purpose.set(self.events))
    }
}

//! What a path knows of itself besides its ray: random numbers, wavelengths, what it carries, where it scattered last.

use snell_math::Point3;
use snell_math::sampler::Sampler;

use super::spectra::{Spectral, WHITE, Wavelengths, largest, times};

/// One path, of one sample of a pixel: the one that the sample begins with, or one that [left it](PathSample::divide).
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
    /// How often it divided.
    pub divisions: u32,
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
    /// What photons are gathered from there.
    pub gathers: Gathers,
}

/// What photons around a place are gathered from.
#[derive(Clone, Copy, Debug)]
pub enum Gathers {
    /// A disk on a surface, with which the direction that a path was sent on in has a cosine.
    Disk {
        /// The cosine.
        cosine: f64,
    },
    /// A ball in a medium.
    Ball {
        /// What the medium takes away per world unit, the mean of the wavelengths.
        extinction: f64,
    },
}

/// So often a path divides: into the reflection of a ball, and what is seen through it, and what is reflected inside.
const MOST_DIVISIONS: u32 = 4;
/// The events of paths that leave others are counted from multiples of this: more than a path has.
const OTHER_NUMBERS: u32 = 1 << 24;

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
        Self {
            sampler,
            wavelengths,
            throughput: WHITE,
            compression: 1.0,
            scattered: None,
            specular: 0,
            divisions: 0,
            events: 0,
        }
    }

    /// True straight from the eye: where nothing but specular surfaces has sent it on.
    pub fn is_straight(&self) -> bool {
        self.scattered.is_none()
    }

    /// True while it goes both ways at a boundary that reflects some light and lets some through: straight from the eye, so that the picture of a
    /// lamp in a glass ball, a twenty-fifth of the light, has no noise of its own.
    pub fn divides(&self) -> bool {
        self.is_straight() && self.divisions < MOST_DIVISIONS
    }

    /// What it would carry after it is weighed once more, the largest of the wavelengths.
    pub fn would_carry(&self, weight: Spectral) -> f64 {
        largest(times(self.throughput, weight)) * self.compression
    }

    /// Divides it: the path that is given goes another way, with other random numbers.
    pub fn divide(&mut self) -> Self {
        self.divisions += 1;
        Self { events: self.events + (OTHER_NUMBERS << self.divisions), ..*self }
    }

    /// Four random numbers.
    pub fn draw(&self, purpose: Purpose) -> [f64; 4] {
        self.sampler.set(purpose.set(self.events))
    }
}

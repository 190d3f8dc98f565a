//! Colours that change over a surface or through space.

use snell_math::{Rgb, Transform, Vector3};

use super::background::ImageAsset;
use crate::table::Id;

/// A colour for every point of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The pattern in texture space.
    pub pattern: Pattern,
    /// From the surface to texture space.
    pub mapping: Mapping,
}

impl Texture {
    /// The same colour everywhere.
    pub fn constant(color: Rgb) -> Self {
        Self { pattern: Pattern::Constant(color), mapping: Mapping::default() }
    }
}

/// Which coordinates a pattern is evaluated at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mapping {
    /// The coordinates to start from.
    pub space: Space,
    /// Carries them into texture space.
    pub texture_from_space: Transform,
}

impl Default for Mapping {
    fn default() -> Self {
        Self { space: Space::Object, texture_from_space: Transform::IDENTITY }
    }
}

/// The coordinates a mapping starts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// The point in the space of the object that has the material: the pattern moves with the object.
    Object,
    /// The point in the world: objects move through the pattern.
    World,
    /// The surface's own (u, v, 0), see each shape.
    Uv,
}

/// A pattern in texture space (x, y, z). Colours are themselves textures, so patterns nest.
#[derive(Clone, Debug, PartialEq)]
pub enum Pattern {
    /// One colour.
    Constant(Rgb),
    /// Unit cubes of two colours in turn: the sum of the coordinates' floors is even or odd. In [`Space::Uv`], unit squares.
    Checker([Id<Texture>; 2]),
    /// A picture over [0, 1]², x to the right and y up.
    Image {
        /// The picture.
        image: Id<ImageAsset>,
        /// What is outside [0, 1]²: repeated, or else the border's colour.
        repeat: bool,
        /// Blended between pixels, or else the nearest pixel's colour.
        smooth: bool,
    },
    /// Along `axis` (its length is the distance from position 0 to 1): stops of (position, colour), increasing.
    Gradient {
        /// Direction and scale of the position.
        axis: Vector3,
        /// At least one.
        stops: Vec<(f64, Rgb)>,
        /// Repeated beyond the first and last stop, or else their colours.
        repeat: bool,
    },
    /// Gradient noise: the mix of two colours, by noise of zero mean around 1/2.
    Noise {
        /// The colours at noise 0 and 1.
        colors: [Id<Texture>; 2],
        /// How many octaves, each of twice the frequency and half the strength of the one before, 1 to 16.
        octaves: u32,
        /// How the octaves become a number in [0, 1].
        kind: NoiseKind,
        /// Chooses among patterns that look alike.
        seed: u32,
    },
}

/// How the octaves of noise become a number in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoiseKind {
    /// Their sum around 1/2.
    Smooth,
    /// The sum of their absolute values: billows and cracks (Perlin's turbulence).
    Turbulence,
    /// Sine stripes along x, disturbed by turbulence.
    Marble,
    /// Rings around the y axis, disturbed by smooth noise.
    Wood,
}

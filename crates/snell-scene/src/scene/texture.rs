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

/// A pattern in texture space (x, y, z). Colours are themselves textures, so patterns nest: up to 32 deep, never in a cycle.
/// Each has its own [`Mapping`], from the surface; those of the patterns around it do not count.
///
/// In object and world space a pattern is read just inside the surface, by a little more than the rounding error of the
/// point, so that a face lying exactly on a border shows one side of it: its inner one.
#[derive(Clone, Debug, PartialEq)]
pub enum Pattern {
    /// One colour.
    Constant(Rgb),
    /// Unit cubes of two colours in turn: the first where the sum of the coordinates' floors is even, the second where it is
    /// odd. In [`Space::Uv`], unit squares: z does not count.
    Checker([Id<Texture>; 2]),
    /// A picture over [0, 1]², x to the right and y up; z does not count.
    Image {
        /// The picture.
        image: Id<ImageAsset>,
        /// What is outside [0, 1]²: repeated, or else the border's colour.
        repeat: bool,
        /// Blended between the centres of pixels, where their own colours are met exactly, or else the nearest pixel's colour.
        smooth: bool,
    },
    /// Along `axis` (its length is the distance from position 0 to 1, the origin of texture space lies at 0): stops of
    /// (position, colour) in order, blended linearly. Stops at the same position make a step; from there on the last counts.
    Gradient {
        /// Direction and scale of the position.
        axis: Vector3,
        /// At least one; positions do not decrease.
        stops: Vec<(f64, Rgb)>,
        /// Repeated beyond the first and last stop, or else their colours.
        repeat: bool,
    },
    /// Gradient noise, one cell of its first octave's lattice a unit: the mix of two colours by a number from 0 to 1.
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

/// How the octaves of noise become a number in [0, 1]. One octave has mean 0 and standard deviation 0.27, and is never above
/// 1.04; S stands for the octaves' sum and T (turbulence) for the sum of their absolute values, each octave times its strength
/// 1, 1/2, 1/4 …
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoiseKind {
    /// (1 + S) / 2: clouds. The mean is 1/2, the standard deviation 0.13 for one octave and 0.16 for many; where it goes
    /// beyond 0 or 1, hardly ever, it is cut off.
    Smooth,
    /// T: billows and cracks (Perlin's turbulence). The mean is 0.22 for one octave and 0.44 for many; cut off above 1.
    Turbulence,
    /// (1 + sin 2π(x + T)) / 2: stripes along x, one a unit, disturbed by turbulence.
    Marble,
    /// (1 − cos 2π(r + S/4)) / 2 with r the distance from the y axis: rings, one a unit, disturbed by smooth noise.
    Wood,
}

//! Sources of light without extent.

use snell_math::spectrum::Spectrum;
use snell_math::{Point3, Rgb, Vector3};

/// A light.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Its name, where the author gave one.
    pub name: Option<String>,
    /// Where it is and how it shines.
    pub kind: LightKind,
    /// Its colour times its strength: the irradiance it gives to a surface that faces it, at distance 1 where it falls off.
    pub intensity: Rgb,
    /// Its spectrum, where the author gave one: that of `intensity`, which is its colour. Relative to equal energy of luminance 1.
    pub spectrum: Option<Spectrum>,
    /// How that changes with distance; of no effect on a directional light.
    pub falloff: Falloff,
}

/// Where a light is and how it shines. World space, radians.
#[derive(Clone, Debug, PartialEq)]
pub enum LightKind {
    /// In all directions from one point.
    Point {
        /// The point.
        position: Point3,
    },
    /// From infinitely far away.
    Directional {
        /// The direction in which the light travels, any positive length.
        direction: Vector3,
        /// The angle that it is seen under, radians: what makes shadows soft where paths are traced; 0 for a point.
        angle: f64,
    },
    /// A cone of light from one point.
    Spot {
        /// The point.
        position: Point3,
        /// The cone's axis, the way the light travels, any positive length.
        direction: Vector3,
        /// Half the cone's opening angle, in (0, π/2]: darkness outside.
        cone_angle: f64,
        /// Half the angle within which it has full strength, at most `cone_angle`; a smooth step between.
        full_angle: f64,
    },
}

/// How light decreases with distance d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Falloff {
    /// Not at all, as the lecture has it.
    None,
    /// 1 / d.
    Linear,
    /// 1 / d², as real light does.
    InverseSquare,
    /// 1 / (constant + linear d + quadratic d²), at most 1.
    Polynomial {
        /// The constant term.
        constant: f64,
        /// The factor of d.
        linear: f64,
        /// The factor of d².
        quadratic: f64,
    },
}

//! Directions: of the whole sphere, of the hemisphere by the cosine, of a cone, and those in which a sphere is seen.
//!
//! Follows: Archimedes, "On the Sphere and Cylinder" (equal heights have equal areas); Malley's method (the disk's places
//! raised to the hemisphere have the cosine's density), Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th
//! edition, appendix A.5; Shirley, Wang and Zimmerman, "Monte Carlo Techniques for Direct Lighting Calculations", ACM TOG
//! 15(1), 1996, section 3.3 (a sphere is sampled by the cone in which it is seen); the cone is narrow for far spheres, so it
//! is measured by 1 − cos, which then keeps all digits.

use std::f64::consts::{FRAC_1_PI, PI};

use super::uniform_disk;
use crate::{Point3, Vector3, portable};

/// The density of [`uniform_sphere`], per steradian: 1/4π.
pub const UNIFORM_SPHERE_DENSITY: f64 = 0.25 * FRAC_1_PI;

/// A direction, each as likely as the others.
///
/// ```
/// use snell_math::warp::uniform_sphere;
/// assert!((uniform_sphere([0.3, 0.8]).length() - 1.0).abs() < 1e-14);
/// ```
#[inline]
#[must_use]
pub fn uniform_sphere(u: [f64; 2]) -> Vector3 {
    // The cap of half the sphere is a disk by an equal-area map (Lambert's azimuthal projection), twice.
    uniform_cone(u, 2.0)
}

/// A direction with z ≥ 0, by the cosine with +z. The density is [`cosine_hemisphere_density`].
///
/// ```
/// use snell_math::{Vector3, warp::cosine_hemisphere};
/// assert_eq!(cosine_hemisphere([0.5, 0.5]), Vector3::Z);
/// ```
#[inline]
#[must_use]
pub fn cosine_hemisphere(u: [f64; 2]) -> Vector3 {
    let [x, y] = uniform_disk(u);
    Vector3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt())
}

/// The density of [`cosine_hemisphere`] per steradian, where `cos` is the cosine with +z: cos/π, 0 below.
#[inline]
#[must_use]
pub fn cosine_hemisphere_density(cos: f64) -> f64 {
    cos.max(0.0) * FRAC_1_PI
}

/// A direction whose cosine with +z is at least 1 − `one_minus_cos` (in [0, 2]), each as likely as the others.
///
/// ```
/// use snell_math::warp::uniform_cone;
/// let moonlight = uniform_cone([0.9, 0.2], 1e-5);
/// assert!(moonlight.z() >= 1.0 - 1e-5 && moonlight.z() < 1.0);
/// ```
#[inline]
#[must_use]
pub fn uniform_cone(u: [f64; 2], one_minus_cos: f64) -> Vector3 {
    // Lambert's azimuthal equal-area projection: a radius r in the disk belongs to the height 1 − r² (1 − cos).
    let [x, y] = uniform_disk(u);
    let height = (x * x + y * y) * one_minus_cos;
    // sin = √(h (2 − h)); over the radius, whose square is h / (1 − cos).
    let scale = (one_minus_cos * (2.0 - height)).max(0.0).sqrt();
    Vector3::new(x * scale, y * scale, 1.0 - height)
}

/// The density of [`uniform_cone`] within its cone, per steradian: 1/(2π (1 − cos)); infinite for an empty cone.
#[inline]
#[must_use]
pub fn uniform_cone_density(one_minus_cos: f64) -> f64 {
    1.0 / (2.0 * PI * one_minus_cos)
}

/// The directions in which a sphere is seen from a place: what next-event estimation samples for a light that is a sphere.
/// From inside, the sphere is seen in all directions.
///
/// ```
/// use snell_math::{Point3, Vector3, warp::Cone};
/// let sun = Cone::around_sphere(Point3::ORIGIN, Point3::new(0.0, 0.0, 150.0), 0.7).unwrap();
/// assert!((sun.solid_angle() - 6.842e-5).abs() < 1e-8);
/// assert!(sun.density(Vector3::Z) * sun.solid_angle() > 0.999_999);
/// assert_eq!(sun.density(Vector3::X), 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    axis: Vector3,
    tangents: [Vector3; 2],
    one_minus_cos: f64,
}

impl Cone {
    /// The cone about a unit vector of half the opening angle whose cosine is 1 − `one_minus_cos`, clamped to [0, 2].
    #[inline]
    #[must_use]
    pub fn new(axis: Vector3, one_minus_cos: f64) -> Self {
        let (x, y) = axis.orthonormal_basis();
        Self { axis, tangents: [x, y], one_minus_cos: one_minus_cos.clamp(0.0, 2.0) }
    }

    /// The cone in which a sphere is seen from a point, or the whole sphere of directions from inside; `None` where
    /// the radius is not positive, or a number not finite.
    #[inline]
    #[must_use]
    pub fn around_sphere(from: Point3, center: Point3, radius: f64) -> Option<Self> {
        let towards = center - from;
        let squared = towards.length_squared();
        if !(radius > 0.0 && squared.is_finite() && radius.is_finite()) {
            return None;
        }
        if squared <= radius * radius {
            return Some(Self::new(Vector3::Z, 2.0));
        }
        // 1 − cos = sin² / (1 + cos): nothing cancels.
        let sin_squared = radius * radius / squared;
        let cos = (1.0 - sin_squared).max(0.0).sqrt();
        Some(Self::new(towards.try_normalize()?, sin_squared / (1.0 + cos)))
    }

    /// Its solid angle in steradians.
    #[inline]
    #[must_use]
    pub fn solid_angle(&self) -> f64 {
        2.0 * PI * self.one_minus_cos
    }

    /// A direction of the cone, each as likely as the others.
    #[inline]
    #[must_use]
    pub fn sample(&self, u: [f64; 2]) -> Vector3 {
        let local = uniform_cone(u, self.one_minus_cos);
        let [x, y] = self.tangents;
        (x * local.x() + y * local.y() + self.axis * local.z()).normalize()
    }

    /// The density of [`Self::sample`] per steradian: one over the solid angle inside, 0 outside. The edge is taken a
    /// little wider, by the rounding of unit vectors.
    #[inline]
    #[must_use]
    pub fn density(&self, direction: Vector3) -> f64 {
        // |d − axis|² = 2 (1 − cos) keeps the digits of narrow cones.
        let chord = direction - self.axis;
        let inside = 0.5 * chord.length_squared() <= self.one_minus_cos * (1.0 + 1e-9) + 1e-15;
        if inside { uniform_cone_density(self.one_minus_cos) } else { 0.0 }
    }

    /// The greatest angle with the axis, in radians.
    #[must_use]
    pub fn half_angle(&self) -> f64 {
        // 1 − cos = 2 sin²(θ/2).
        2.0 * portable::asin((0.5 * self.one_minus_cos).sqrt().min(1.0))
    }
}

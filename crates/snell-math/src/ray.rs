//! A half-line in space.

use crate::{Point3, Vector3};

/// Points `origin + t * direction`, t ≥ 0.
///
/// The direction of a ray that the tracer makes has unit length, so that t is a distance in world units. A ray carried
/// into an object's space by [`crate::Transform::inverse_ray`] keeps t instead, and its direction has another length.
///
/// ```
/// use snell_math::{Point3, Ray, Vector3};
/// let ray = Ray::new(Point3::ORIGIN, Vector3::Z);
/// assert_eq!(ray.at(2.0), Point3::new(0.0, 0.0, 2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: Point3,
    /// Where it goes.
    pub direction: Vector3,
}

impl Ray {
    /// From its origin and direction, taken as they are.
    #[inline]
    pub const fn new(origin: Point3, direction: Vector3) -> Self {
        Self { origin, direction }
    }

    /// The point at parameter `t`.
    #[inline]
    pub fn at(&self, t: f64) -> Point3 {
        self.origin + self.direction * t
    }
}

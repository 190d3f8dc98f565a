//! Placements: a transform into the space around, with what rounding does on the way.

use snell_math::{Normal3, Point3, Ray, Transform};

use crate::interaction::SurfaceInteraction;

/// A transform from a local space to the one around it.
#[derive(Clone, Debug)]
pub struct Placement {
    outer_from_local: Transform,
    /// By how much the transform stretches an error at most, and by how much its inverse does.
    stretch: f64,
    shrink: f64,
}

/// Rounding of one product of a matrix and a point: four terms each, relative to the sum of their absolute values.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

impl Placement {
    pub fn new(outer_from_local: Transform) -> Self {
        let frobenius = |t: &Transform| {
            let m = t.affine().matrix3;
            (m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()).sqrt()
        };
        Self {
            stretch: frobenius(&outer_from_local),
            shrink: frobenius(&outer_from_local.inverse()),
            outer_from_local,
        }
    }

    /// A ray in the local space; its parameter means the same.
    #[inline]
    pub fn to_local(&self, ray: &Ray) -> Ray {
        self.outer_from_local.inverse_ray(ray)
    }

    /// A point in the local space.
    #[inline]
    pub fn point_to_local(&self, point: Point3) -> Point3 {
        self.outer_from_local.inverse_point(point)
    }

    /// By how much a point in the local space may be wrong that is wrong by `error` in the space around.
    #[inline]
    pub fn error_to_local(&self, error: f64) -> f64 {
        self.shrink * error
    }

    /// A normal in the local space, unit length.
    #[inline]
    pub fn normal_to_local(&self, normal: Normal3) -> Normal3 {
        self.outer_from_local.inverse().normal(normal).normalize()
    }

    /// Carries an interaction from the local space to the one around; where on its object it is, stays.
    #[inline]
    pub fn carry_out(&self, interaction: &mut SurfaceInteraction, outer_ray: &Ray) {
        let local = interaction.point;
        interaction.point = self.outer_from_local.point(local);
        // The ray was rounded on its way in, the point on its way out, and both will be again for the next ray from here.
        let translation = Point3(self.outer_from_local.affine().translation).max_abs();
        let outer_size = outer_ray.origin.max_abs().max(interaction.point.max_abs()) + translation;
        let rounding = ROUNDING * self.stretch * (local.max_abs() + self.shrink * outer_size);
        interaction.error = self.stretch * interaction.error + rounding;
        interaction.geometric_normal = self.outer_from_local.normal(interaction.geometric_normal).normalize();
        interaction.shading_normal = self.outer_from_local.normal(interaction.shading_normal).normalize();
    }
}

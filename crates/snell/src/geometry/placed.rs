//! Placements: a transform into the space around, with what rounding does on the way.

use snell_math::lanes::Lanes;
use snell_math::{Normal3, Point3, Ray, Transform};

use crate::shape::{LaneRay, LaneSurfacePoint, SurfacePoint};

/// A transform from a local space to the one around it.
#[derive(Clone, Debug)]
pub struct Placement {
    outer_from_local: Transform,
    /// By how much the inverse stretches an error at most.
    shrink: f64,
}

impl Placement {
    pub fn new(outer_from_local: Transform) -> Self {
        let back = outer_from_local.inverse().affine().matrix3;
        let squares = back.x_axis.length_squared() + back.y_axis.length_squared() + back.z_axis.length_squared();
        Self { outer_from_local, shrink: squares.sqrt() }
    }

    /// The map itself.
    pub fn outer_from_local(&self) -> &Transform {
        &self.outer_from_local
    }

    /// A ray in the local space; its parameter means the same.
    #[inline]
    pub fn to_local(&self, ray: &Ray) -> Ray {
        self.outer_from_local.inverse_ray(ray)
    }

    /// As [`Placement::to_local`], a ray in each lane.
    #[inline(always)]
    pub fn lanes_to_local<L: Lanes>(&self, ray: LaneRay<L>) -> LaneRay<L> {
        LaneRay {
            origin: self.outer_from_local.inverse_points(ray.origin),
            direction: self.outer_from_local.inverse_vectors(ray.direction),
        }
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

    /// As [`Placement::carry_out`], a point in each lane.
    #[inline(always)]
    pub fn carry_lanes_out<L: Lanes>(&self, surface: &LaneSurfacePoint<L>) -> LaneSurfacePoint<L> {
        surface.carried(&self.outer_from_local)
    }

    /// A point of a surface in the space around.
    #[inline]
    pub fn carry_out(&self, surface: &SurfacePoint) -> SurfacePoint {
        surface.carried(&self.outer_from_local)
    }
}

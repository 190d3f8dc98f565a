//! Where a ray met the scene: what shading needs to know of it. World space.

use snell_math::lanes::{Bits, LaneVector, Lanes, WIDTH};
use snell_math::{Normal3, Point3, Ray, Rgb, Vector3};

use crate::differential::SurfaceDifferential;
use crate::texture::{Footprint, RELATIVE_INSET};

/// A body that has an inside: which one a ray enters or leaves. Two placements of one prototype are two bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SolidId(pub(crate) u64);

/// A hit, worked out.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceInteraction {
    /// The ray parameter, a distance in world units.
    pub t: f64,
    /// The point on the surface.
    pub point: Point3,
    /// How far `point` is from the true surface, at most.
    pub error: f64,
    /// Unit length, outward.
    pub geometric_normal: Normal3,
    /// Unit length, outward; the geometric one but on smooth meshes.
    pub shading_normal: Normal3,
    /// The surface's own coordinates.
    pub uv: [f64; 2],
    /// The point in the space of the object that has the material: where patterns are.
    pub object_point: Point3,
    /// A short way from there into the solid, in the same space; zero where the material asks for no such thing.
    pub object_inside: Vector3,
    /// The mesh's own colour here: a factor on the diffuse colour.
    pub vertex_color: Option<Rgb>,
    /// Which material, as a place in the compiled scene's list.
    pub material: u32,
    /// Which object, as a place in the compiled scene's list of names.
    pub object: u32,
    /// The body whose boundary this is.
    pub solid: SolidId,
}

impl SurfaceInteraction {
    /// A ray that leaves this point, see [`LaneSurface::spawn_origin`].
    #[inline]
    pub fn spawn_ray(&self, direction: Vector3) -> Ray {
        Ray::new(LaneSurface::<f64>::from(self).spawn_origin(direction.into()).into(), direction)
    }

    /// A short way into the solid, world space: where patterns of the world are read.
    #[inline]
    pub fn inside(&self) -> Vector3 {
        self.geometric_normal.as_vector() * -(8.0 * self.error + RELATIVE_INSET * self.point.max_abs())
    }

    /// True where a direction that leaves the surface goes to its outward side.
    #[inline]
    pub fn is_outward(&self, direction: Vector3) -> bool {
        self.geometric_normal.dot(direction) >= 0.0
    }
}

/// Eight hits, worked out, in rows of eight numbers. What stands in lanes without a hit means nothing.
#[derive(Clone, Debug)]
pub struct SurfaceRows {
    /// See [`SurfaceInteraction::point`]; the rows of x, y and z.
    pub point: [[f64; WIDTH]; 3],
    /// See [`SurfaceInteraction::error`].
    pub error: [f64; WIDTH],
    /// See [`SurfaceInteraction::geometric_normal`].
    pub geometric_normal: [[f64; WIDTH]; 3],
    /// See [`SurfaceInteraction::shading_normal`].
    pub shading_normal: [[f64; WIDTH]; 3],
    /// See [`SurfaceInteraction::material`].
    pub material: [u32; WIDTH],
    /// See [`SurfaceInteraction::solid`].
    pub solid: [SolidId; WIDTH],
    /// The whole interaction, of the hits that were worked out one by one.
    pub whole: [Option<SurfaceInteraction>; WIDTH],
    /// The hits whose objects stand in the world as they are, so that points of the world are points of theirs.
    pub unplaced: Bits,
    /// What neighbouring rays meet, where it was asked for; in other scenes nothing.
    pub around: [Surroundings; WIDTH],
}

/// What the neighbours of a ray meet beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surroundings {
    /// How the surface differs there.
    pub differential: SurfaceDifferential,
    /// The part of the surface that the ray stands for.
    pub footprint: Footprint,
}

impl Surroundings {
    /// A ray that stands for a point.
    pub const NONE: Self = Self { differential: SurfaceDifferential::NONE, footprint: Footprint::SHARP };
}

impl Default for SurfaceRows {
    fn default() -> Self {
        Self {
            point: [[0.0; WIDTH]; 3],
            error: [0.0; WIDTH],
            geometric_normal: [[0.0; WIDTH]; 3],
            shading_normal: [[0.0; WIDTH]; 3],
            material: [0; WIDTH],
            solid: [SolidId(0); WIDTH],
            whole: [const { None }; WIDTH],
            unplaced: Bits::NONE,
            around: [Surroundings::NONE; WIDTH],
        }
    }
}

/// Hits side by side: what the geometry of shading looks at.
#[derive(Clone, Copy, Debug)]
pub struct LaneSurface<L> {
    /// See [`SurfaceInteraction::point`].
    pub point: LaneVector<L>,
    /// See [`SurfaceInteraction::error`].
    pub error: L,
    /// See [`SurfaceInteraction::geometric_normal`].
    pub geometric_normal: LaneVector<L>,
    /// See [`SurfaceInteraction::shading_normal`].
    pub shading_normal: LaneVector<L>,
}

impl From<&SurfaceInteraction> for LaneSurface<f64> {
    #[inline(always)]
    fn from(interaction: &SurfaceInteraction) -> Self {
        Self {
            point: interaction.point.into(),
            error: interaction.error,
            geometric_normal: interaction.geometric_normal.into(),
            shading_normal: interaction.shading_normal.into(),
        }
    }
}

impl<L: Lanes> LaneSurface<L> {
    /// From rows, see [`Lanes::load`].
    #[inline(always)]
    pub fn load(rows: &SurfaceRows, at: usize) -> Self {
        Self {
            point: LaneVector::load(&rows.point, at),
            error: L::load(&rows.error, at),
            geometric_normal: LaneVector::load(&rows.geometric_normal, at),
            shading_normal: LaneVector::load(&rows.shading_normal, at),
        }
    }

    /// Where a ray starts that leaves this point in a direction: off the surface, to the side the direction points to, by as
    /// much as the point may be wrong, so that the surface is not met again by rounding. No length of the scene enters.
    #[inline(always)]
    pub fn spawn_origin(&self, direction: LaneVector<L>) -> LaneVector<L> {
        let outward = self.geometric_normal;
        let side = (-self.error).or_where_not(outward.dot(direction).lt(L::splat(0.0)), self.error);
        self.point + outward * side
    }

    /// As [`SurfaceInteraction::inside`].
    #[inline(always)]
    pub fn inside(&self) -> LaneVector<L> {
        let depth = L::splat(8.0) * self.error + L::splat(RELATIVE_INSET) * self.point.max_abs();
        self.geometric_normal * -depth
    }

    /// Where a direction that leaves the surface goes to its outward side.
    #[inline(always)]
    pub fn is_outward(&self, direction: LaneVector<L>) -> Bits {
        self.geometric_normal.dot(direction).ge(L::splat(0.0))
    }

    /// 1 where a direction goes to the outward side, −1 where it goes to the other.
    #[inline(always)]
    pub fn side(&self, direction: LaneVector<L>) -> L {
        L::splat(1.0).or_where_not(self.is_outward(direction), L::splat(-1.0))
    }

    /// The shading normal on the side of `wo`; the geometric one where the shading normal is seen from behind.
    #[inline(always)]
    pub fn consistent_normal(&self, wo: LaneVector<L>) -> LaneVector<L> {
        let side = self.side(wo);
        let shading = self.shading_normal * side;
        shading.or_where_not(shading.dot(wo).gt(L::splat(0.0)), self.geometric_normal * side)
    }

    /// The geometric normal on the side of `wo`, as [`Normal3::face_forward`].
    #[inline(always)]
    pub fn flat_normal(&self, wo: LaneVector<L>) -> LaneVector<L> {
        let behind = self.geometric_normal.dot(wo).lt(L::splat(0.0));
        (-self.geometric_normal).or_where_not(behind, self.geometric_normal)
    }
}

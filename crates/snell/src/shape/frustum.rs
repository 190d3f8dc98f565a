//! Cylinders, cones and truncated cones, open or capped: one family, whose radius is linear along an axis.
//!
//! In own coordinates the axis is z, from the centre of the thinner end (z = 0) to that of the thicker one (z = length),
//! with radius R(z) = thin + slope z. From the thin end R keeps its relative accuracy up to an apex, where it is 0. The
//! quadratic is Glassner (ed.), An Introduction to Ray Tracing (1989), section 2.4 (Pharr, Jakob, Humphreys, Physically
//! Based Rendering, 4th ed., section 6.3), made stable in two ways: the origin is first moved along the ray to where it
//! comes closest to the axis between the ends; and the discriminant is either b² − ac, exact for lines that run along the
//! side, or, with x and d the two-dimensional parts of origin and direction across the axis and κ = slope dz, the same
//! number written as |R d − κ x|² − (x × d)², exact near the apex: whichever rounding can do less to. For a cylinder the
//! second compares the line's distance from the axis with the radius.

use snell_math::lanes::{LaneVector, Lanes};
use snell_math::{Bounds3, Point3, Ray, Transform};

use super::frame::{Frame, turn};
use super::rounding::gamma;
use super::span::{Passage, Span, ends};
use super::{Crossing, LaneRay, ShapeHit, SurfacePoint};

/// The part number of the side.
const SIDE: u32 = 0;
/// The part number of the cap at the base.
const BASE_CAP: u32 = 1;
/// The part number of the cap at the top.
const TOP_CAP: u32 = 2;

/// A cylinder, cone or truncated cone. Part 0 is the side, 1 the cap at the base, 2 the cap at the top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frustum {
    /// At the middle of the thinner end, z to the thicker one.
    frame: Frame,
    length: f64,
    thin: f64,
    /// Radius gained per length: 0 for a cylinder, never negative.
    slope: f64,
    /// 1/√(1 + slope²): makes (x/R, y/R, −slope) a unit normal.
    normal_scale: f64,
    capped: bool,
    /// The base is at z = length.
    base_is_thick: bool,
}

impl Frustum {
    /// From the middles of its ends and the radii there.
    pub fn new(base: Point3, base_radius: f64, top: Point3, top_radius: f64, capped: bool) -> Self {
        let frame = Frame::around(base, top - base);
        let length = base.distance(top);
        let base_is_thick = base_radius > top_radius;
        let frame = if base_is_thick { Frame { origin: top, z: -frame.z, ..frame } } else { frame };
        let slope = (base_radius - top_radius).abs() / length;
        let normal_scale = 1.0 / (1.0 + slope * slope).sqrt();
        Self { frame, length, thin: base_radius.min(top_radius), slope, normal_scale, capped, base_is_thick }
    }

    /// The same without caps.
    #[cfg(test)]
    pub(super) const fn opened(&self) -> Self {
        Self { capped: false, ..*self }
    }

    /// Its frame, at the middle of the thinner end and with z to the thicker one, which is `length` away.
    pub(crate) fn frame_and_length(&self) -> (Frame, f64) {
        (self.frame, self.length)
    }

    /// The radius at the thinner end, and what is gained per length from there.
    pub(crate) fn radius_and_slope(&self) -> (f64, f64) {
        (self.thin, self.slope)
    }

    /// True where caps close it.
    pub(crate) fn is_capped(&self) -> bool {
        self.capped
    }

    /// The part number of the cap at z = 0, where an apex is part of the side, and of that at z = length.
    #[inline]
    fn caps(&self) -> (u32, u32) {
        let (thin, thick) = if self.base_is_thick { (TOP_CAP, BASE_CAP) } else { (BASE_CAP, TOP_CAP) };
        (if self.thin > 0.0 { thin } else { SIDE }, thick)
    }

    /// Where lines enter and leave the capped solid, as what the side and the slab between the ends have in common: an edge between
    /// side and cap cannot leak.
    #[inline(always)]
    fn ends<L: Lanes>(&self, ray: &LaneRay<L>) -> [Passage<L>; 2] {
        let (o, d) = self.frame.lanes(ray);
        let (zero, infinity) = (L::splat(0.0), L::splat(f64::INFINITY));
        let (length, thin, slope) = (L::splat(self.length), L::splat(self.thin), L::splat(self.slope));
        let (side, caps) = (L::splat(f64::from(SIDE)), self.caps());
        let (thin_cap, thick_cap) = (L::splat(f64::from(caps.0)), L::splat(f64::from(caps.1)));
        // The slab between the ends.
        let up = d.z.gt(zero);
        let (first_cap, last_cap) = (thin_cap.or_where_not(up, thick_cap), thick_cap.or_where_not(up, thin_cap));
        let (a, b) = (-o.z / d.z, (length - o.z) / d.z);
        let rising = a.lt(b);
        let (mut slab_enter, mut slab_leave) = (a.or_where_not(rising, b), b.or_where_not(rising, a));
        let mut met = L::all();
        let level = d.z.same(zero);
        if level.any() {
            met = met.without(level.without(zero.le(o.z) & o.z.le(length)));
            if met.is_empty() {
                return [Passage::none(); 2];
            }
            (slab_enter, slab_leave) =
                ((-infinity).or_where_not(level, slab_enter), infinity.or_where_not(level, slab_leave));
        }
        // The origin moved to where the line is closest to the axis; a t² + 2 b t + c is negative inside.
        let across = d.x * d.x + d.y * d.y;
        let closest = (-(o.x * d.x + o.y * d.y) / across).or_where_not(across.gt(zero), zero);
        let shift = closest.larger(slab_enter).smaller(slab_leave);
        let (x, y) = (o.x + d.x * shift, o.y + d.y * shift);
        let radius = thin + slope * (o.z + d.z * shift);
        // a t² + 2 b t + c is negative inside.
        let kappa = slope * d.z;
        let apart = x * x + y * y;
        let (a, b, c) = (across - kappa * kappa, x * d.x + y * d.y - radius * kappa, apart - radius * radius);
        let discriminant = {
            let (wx, wy) = (radius * d.x - kappa * x, radius * d.y - kappa * y);
            let cross = x * d.y - y * d.x;
            // What rounding can do to each form, in the same unit.
            let b_terms = (x * d.x).abs() + (y * d.y).abs() + (radius * kappa).abs();
            let (a_terms, c_terms) = (across + kappa * kappa, apart + radius * radius);
            let two = L::splat(2.0);
            let plain_error = two * b.abs() * b_terms + a.abs() * c_terms + c.abs() * a_terms;
            let geometric_error = two * (radius * radius * across + kappa * kappa * apart) + cross * cross;
            (b * b - a * c).or_where_not(plain_error.lt(geometric_error), wx * wx + wy * wy - cross * cross)
        };
        let (usual, steep) = (a.gt(zero), a.lt(zero));
        met = met.without(usual.without(discriminant.gt(zero)));
        if met.is_empty() {
            return [Passage::none(); 2];
        }
        let q = -(b + zero.larger(discriminant).sqrt().copysign(b));
        let (s, t) = (q / a, c / q);
        let sorted = s.lt(t);
        let (mut side_enter, mut side_leave) = (s.or_where_not(sorted, t), t.or_where_not(sorted, s));
        if met.without(usual).any() {
            // Steeper than the side: the line meets both nappes of the double cone, and this one where R grows.
            let some = !q.same(zero);
            let (s, t) = (s.or_where_not(some, zero), t.or_where_not(some, zero));
            let grows = kappa.gt(zero);
            let steep_enter = s.larger(t).or_where_not(grows, -infinity);
            let steep_leave = infinity.or_where_not(grows, s.smaller(t));
            // Along the side there is one end.
            let (before, behind) = (b.lt(zero), b.gt(zero));
            let end = L::splat(-0.5) * c / b;
            let flat_enter = end.or_where_not(before, -infinity);
            let flat_leave = end.or_where_not(behind, infinity);
            side_enter = side_enter.or_where_not(usual, steep_enter.or_where_not(steep, flat_enter));
            side_leave = side_leave.or_where_not(usual, steep_leave.or_where_not(steep, flat_leave));
            // Along the axis of a cylinder, or along the side itself, which is a touch.
            let along = !(usual | steep | before | behind);
            let inside = across.same(zero) & kappa.same(zero) & c.lt(zero) & !level;
            met = met.without(along.without(inside));
        }
        let (side_enter, side_leave) = (shift + side_enter, shift + side_leave);
        let (by_side, out_by_side) = (side_enter.gt(slab_enter), side_leave.lt(slab_leave));
        let enter = (side_enter.or_where_not(by_side, slab_enter), side.or_where_not(by_side, first_cap));
        let leave = (side_leave.or_where_not(out_by_side, slab_leave), side.or_where_not(out_by_side, last_cap));
        ends(met, enter, leave)
    }

    /// Where lines pass through the surface: open ones have no caps.
    #[inline(always)]
    pub(super) fn passages<L: Lanes>(&self, ray: &LaneRay<L>) -> [Passage<L>; 2] {
        let [mut enter, mut leave] = self.ends(ray);
        if !self.capped {
            let side = L::splat(f64::from(SIDE));
            enter.met &= enter.part.same(side);
            leave.met &= leave.part.same(side);
        }
        [enter, leave]
    }

    #[inline]
    fn span(&self, ray: &Ray) -> Option<Span> {
        Span::of_ends(self.ends::<f64>(&LaneRay::from(ray)))
    }

    /// See [`super::Shape::intersect`].
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        Passage::first_between(self.passages(&LaneRay::from(ray)), t_min, t_max)
    }

    pub(super) fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        if let Some(span) = self.span(ray) {
            span.push_to(out);
        }
    }

    /// The points, the outward normals and the error of the points of hits at `t` with some parts.
    ///
    /// On a cap z is exact; on the side z or the radius, whichever the other depends on less, gives the other.
    #[inline(always)]
    pub(super) fn surfaces<L: Lanes>(&self, ray: &LaneRay<L>, t: L, part: L) -> (LaneVector<L>, LaneVector<L>, L) {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let (thin, slope, length) = (L::splat(self.thin), L::splat(self.slope), L::splat(self.length));
        let p = self.frame.lane_points(ray, t);
        let distance = (p.x * p.x + p.y * p.y).sqrt();
        let z = if self.slope > 1.0 { (distance - thin) / slope } else { p.z };
        let z = z.larger(zero).smaller(length);
        // On the axis, at an apex, any direction is as good.
        let apart = distance.gt(zero);
        let (x, y) = ((p.x / distance).or_where_not(apart, one), (p.y / distance).or_where_not(apart, zero));
        let radius = thin + slope * z;
        let normal = LaneVector { x, y, z: -slope } * L::splat(self.normal_scale);
        let side = part.same(L::splat(f64::from(SIDE)));
        let below = part.same(L::splat(f64::from(self.caps().0)));
        let axis = LaneVector::splat(self.frame.z.to_array());
        let of_cap = LaneVector { x: p.x, y: p.y, z: zero.or_where_not(below, length) };
        let local = LaneVector { x: x * radius, y: y * radius, z }.or_where_not(side, of_cap);
        let normal = self.frame.lanes_out(normal).or_where_not(side, (-axis).or_where_not(below, axis));
        let size = self.length + self.thin + self.slope * self.length;
        let error = L::splat(gamma(64) * (self.frame.origin.max_abs() + size));
        (LaneVector::splat(self.frame.origin.to_array()) + self.frame.lanes_out(local), normal, error)
    }

    /// See [`Frustum::surfaces`].
    #[inline]
    pub(super) fn surface_geometry(&self, ray: &Ray, hit: ShapeHit) -> SurfacePoint {
        let (point, normal, error) = self.surfaces::<f64>(&LaneRay::from(ray), hit.t, f64::from(hit.part));
        SurfacePoint::flat(point.into(), normal.into(), error)
    }

    pub(super) fn uv(&self, p: Point3) -> [f64; 2] {
        let local = self.frame.point(p);
        let height = (local.z() / self.length).clamp(0.0, 1.0);
        [turn(local.x(), local.y()), if self.base_is_thick { 1.0 - height } else { height }]
    }

    pub(super) fn contains(&self, p: Point3) -> bool {
        let local = self.frame.point(p);
        let radius = self.thin + self.slope * local.z();
        let within = 0.0 < local.z() && local.z() < self.length;
        self.capped && within && local.x() * local.x() + local.y() * local.y() < radius * radius
    }

    pub(super) fn bounds(&self) -> Bounds3 {
        let end = |z: f64| {
            let middle = self.frame.origin + self.frame.z * z;
            let reach = self.frame.circle_extent() * (self.thin + self.slope * z);
            Bounds3::new(middle - reach, middle + reach)
        };
        end(0.0).union(&end(self.length))
    }

    pub(super) fn transformed(&self, map: &Transform) -> Option<Self> {
        let scale = map.uniform_scale()?;
        let frame = self.frame.transformed(map);
        Some(Self { frame, length: self.length * scale, thin: self.thin * scale, ..*self })
    }
}

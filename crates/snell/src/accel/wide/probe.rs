//! A ray, prepared for filters in `f32` that never lose a hit.
//!
//! Rounding a far origin to `f32` would lose the ray. So it is started again, in `f64`, where it enters the box around
//! everything: at the parameter `start`, from a point that is no further from zero than the box. From there it is measured
//! by s = (t − start) · scale with the largest component of the direction for the scale, so that direction/scale has
//! components of at most 1, one of them ±1, and s is as large as the tree's extent E (its largest absolute coordinate) at
//! most, times a small number. Trees with E outside [2⁻⁴⁰, 2⁴⁰], and rays that rounding in `f64` leaves no digits of, are
//! the business of [`Slabs`]: what follows may count on no overflow, and on no underflow that matters.
//!
//! **The box test.** With ε = 2⁻²⁴, e the new origin and d the new direction on one axis, and p a plane across it, the ray meets the
//! plane at p · (1/d) + c with c = −(e ± m)/d, computed in `f64` and rounded, where the margin m grows the box on all sides. Each
//! error but the last is that of a plane that is elsewhere:
//!
//! - e errs by 4 u (|origin| + E) from `f64`, u = 2⁻⁵³. With |e| ≤ 1.5 E, the rounding of c is worth 1.6 ε E of the plane's place, that
//!   of 1/d ε E, and that of the product, where it is rounded by itself, ε E. m = 2⁻²¹ E + 2⁻⁴⁵ (|origin| + E) is twice as much,
//!   and what is left serves the primitive's own test, as in [`slabs`].
//! - The rounding of the sum is one of ε of itself, so entries may be computed to be at 1 + ε of what they should be, and exits at
//!   1 − ε; an exit that is negative belongs to a box that is behind. Exits and the limit on s are multiplied by 1 + 16 ε before they
//!   are compared with entries.
//! - A component below 2⁻⁴⁰ is taken for ±2⁻⁴⁰. Over the tree it moves the ray by less than 2⁻³⁷ E, which m covers. So
//!   inverses are finite, and products of at most 2⁴³ · 2⁴⁰.
//!
//! [`slabs`]: super::slabs

use snell_math::Ray;
use snell_math::lanes::{Eight, Floats, Lanes};

use super::slabs::Slabs;
use super::{WideNode, WideTree};

/// 1 + 16 ε.
pub(super) const WIDER: f32 = 1.0 + 16.0 * EPSILON;
/// The relative rounding error of `f32`, 2⁻²⁴.
pub const EPSILON: f32 = 0.5 * f32::EPSILON;
/// The smallest component of a direction.
pub(super) const LEAST: f32 = 1.0 / (1_u64 << 40) as f32;
/// The extents of trees that are tested in `f32`.
pub(super) const EXTENTS: std::ops::RangeInclusive<f64> = 1.0 / (1_u64 << 40) as f64..=(1_u64 << 40) as f64;

/// How a ray is measured.
#[derive(Clone, Copy, Debug)]
pub struct Measure {
    /// The ray parameter of the new origin.
    pub start: f64,
    /// The largest component of the direction: what the ray parameter is multiplied by.
    pub scale: f64,
}

/// A ray that starts where it enters a tree.
#[derive(Clone, Copy, Debug)]
pub struct Probe {
    /// See [`Measure`].
    pub measure: Measure,
    /// The new origin.
    pub origin: [f64; 3],
    /// The new direction.
    pub direction: [f64; 3],
    /// One by the new direction, infinite where that is zero.
    pub(super) inverse: [f64; 3],
    /// By how much boxes are grown on all sides.
    pub(super) margin: f64,
    /// A bound for the error of coordinates relative to the new origin that `f64` makes.
    pub error: f64,
    /// The tree's largest absolute coordinate.
    pub extent: f64,
}

/// How a ray goes through a tree.
pub enum Approach {
    /// Not at all.
    Missed,
    /// As most do.
    Plain(Probe),
    /// With numbers that only `f64` has room for.
    Strange(Slabs),
}

impl WideTree {
    /// Prepares a ray for this tree, between two parameters.
    #[inline(always)]
    pub fn approach(&self, ray: &Ray, t_min: f64, t_max: f64) -> Approach {
        // False with NaN.
        let is_range = t_min <= t_max;
        if self.nodes.is_empty() || !is_range {
            return Approach::Missed;
        }
        let (extent, reach, scale) = (self.extent, ray.origin.max_abs(), ray.direction.max_abs());
        let error = 1.0 / (1_u64 << 45) as f64 * (reach + extent);
        let margin = 1.0 / (1_u64 << 21) as f64 * extent + error;
        let is_plain = EXTENTS.contains(&extent) && margin < 0.125 * extent && scale.is_normal();
        let is_inside = t_min == 0.0 && self.bounds.contains_point(ray.origin);
        let mut start = t_min;
        if !(is_inside && is_plain) {
            let slabs = Slabs::new(ray, extent);
            match slabs.enter(&self.bounds, t_min, t_max) {
                None => return Approach::Missed,
                Some(enter) if is_plain && enter.is_finite() => start = enter,
                Some(_) => return Approach::Strange(slabs),
            }
        }
        let origin = ray.at(start);
        // The divisions wait for nothing, and the largest component is the one of the smallest inverse.
        let inverse = ray.direction.to_array().map(|x| 1.0 / x);
        let [x, y, z] = inverse.map(f64::abs);
        let direction = ray.direction * smaller(smaller(x, y), z);
        if !(origin.max_abs() <= 1.5 * extent && direction.max_abs() >= 0.5) {
            return Approach::Strange(Slabs::new(ray, extent));
        }
        let [origin, direction] = [origin.to_array(), direction.to_array()];
        let inverse = inverse.map(|x| x * scale);
        let measure = Measure { start, scale };
        Approach::Plain(Probe { measure, origin, direction, inverse, margin, error, extent })
    }
}

/// The smaller one; without the care for NaN that the one of the library takes.
#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

impl Probe {
    /// What stands in for one where there is none.
    pub const NOTHING: Self = Self {
        measure: Measure { start: 0.0, scale: 1.0 },
        origin: [0.0; 3],
        direction: [0.0; 3],
        inverse: [0.0; 3],
        margin: 0.0,
        error: 0.0,
        extent: 1.0,
    };
}

impl Measure {
    /// The measure of a ray parameter, enlarged: no entry up to there is computed to be beyond.
    #[inline(always)]
    pub fn limit(&self, t_max: f64) -> f32 {
        // A hit may be found, by rounding, in front of the start.
        let s = (t_max - self.start) * self.scale;
        let s = s as f32 * WIDER;
        if s > 0.0 { s } else { 0.0 }
    }

    /// The measure of a ray parameter, reduced: what is in front of it there is in front of it in truth.
    #[inline(always)]
    pub fn surely_before(&self, t_max: f64) -> f32 {
        // In `f64` it is off by two roundings of a number that is not much larger than what it is compared with.
        let s = (t_max - self.start) * self.scale;
        s as f32 * (1.0 - 16.0 * EPSILON)
    }

    /// As [`Measure::limit`], of an upper bound in the measure itself.
    #[inline(always)]
    pub fn widened(s: f32) -> f32 {
        s * WIDER
    }
}

/// As [`Measure::limit`], of measures (t − start) · scale side by side.
#[inline(always)]
pub fn widened_measure<L: Lanes>(s: L) -> L::Floats {
    let (s, zero) = (s.to_floats() * L::Floats::splat(WIDER), L::Floats::splat(0.0));
    s.or_where_not(zero.lt(s), zero)
}

/// A probe, made ready for box tests.
#[derive(Clone, Copy, Debug)]
pub struct BoxLine {
    inverse: [f32; 3],
    /// What is added to a plane times the inverse: of the planes met first, and of those met last.
    near: [f32; 3],
    far: [f32; 3],
    /// Which side of a box is met first: 0 the smaller, 1 the larger coordinate.
    near_side: [usize; 3],
}

impl BoxLine {
    /// Of a probe.
    #[inline(always)]
    pub fn new(probe: &Probe) -> Self {
        let zero = [0.0; 3];
        let mut line = Self { inverse: zero, near: zero, far: zero, near_side: [0; 3] };
        for axis in 0..3 {
            // Of a tiny component the largest inverse that there may be, with its sign.
            let magnitude = smaller(probe.inverse[axis].abs(), 1.0 / f64::from(LEAST));
            let (origin, direction) = (probe.origin[axis], probe.direction[axis]);
            let inverse = magnitude.copysign(direction);
            line.near_side[axis] = usize::from(direction.is_sign_negative());
            line.inverse[axis] = inverse as f32;
            let (middle, margin) = (-origin * inverse, probe.margin * magnitude);
            line.near[axis] = (middle - margin) as f32;
            line.far[axis] = (middle + margin) as f32;
        }
        line
    }
}

/// A [`BoxLine`] in all lanes.
#[derive(Clone, Copy)]
pub struct BoxRay<F> {
    pub(super) inverse: [F; 3],
    pub(super) near: [F; 3],
    pub(super) far: [F; 3],
    pub(super) near_side: [usize; 3],
}

impl<F: Eight> BoxRay<F> {
    /// Of a probe.
    #[inline(always)]
    pub fn new(probe: &Probe) -> Self {
        Self::spread(&BoxLine::new(probe))
    }

    /// Of what was made ready.
    #[inline(always)]
    pub fn spread(line: &BoxLine) -> Self {
        Self {
            inverse: splat(&line.inverse),
            near: splat(&line.near),
            far: splat(&line.far),
            near_side: line.near_side,
        }
    }

    /// Where the ray meets the nearer planes of an axis.
    #[inline(always)]
    fn near(&self, node: &WideNode, axis: usize) -> F {
        // Masked only to show that the index is in range.
        let planes = F::load(&node.planes[axis][self.near_side[axis] & 1], 0);
        planes.multiply_add(self.inverse[axis], self.near[axis])
    }

    /// Where the ray meets the farther planes of an axis.
    #[inline(always)]
    fn far(&self, node: &WideNode, axis: usize) -> F {
        let planes = F::load(&node.planes[axis][self.near_side[axis] & 1 ^ 1], 0);
        planes.multiply_add(self.inverse[axis], self.far[axis])
    }

    /// Which children of a node the ray enters before the limit, and where it does, not before 0.
    #[inline(always)]
    pub(super) fn enter(&self, node: &WideNode, limit: F) -> (u32, F) {
        let enter = self.near(node, 0).greater(self.near(node, 1)).greater(self.near(node, 2).greater(F::splat(0.0)));
        let leave = self.far(node, 0).lesser(self.far(node, 1)).lesser(self.far(node, 2)) * F::splat(WIDER);
        (enter.le(leave.lesser(limit)).mask(), enter)
    }
}

/// The bits of a child's entry in front of the child: keys that sort as the entries do, which are not negative.
#[inline(always)]
pub(super) fn key(enter: f32, child: u32) -> u64 {
    u64::from(enter.to_bits()) << 32 | u64::from(child)
}

/// The entry of a [`key`].
#[inline(always)]
pub(super) fn entry_of(key: u64) -> f32 {
    f32::from_bits((key >> 32) as u32)
}

/// Each of three numbers in all lanes.
#[inline(always)]
pub fn splat<F: Eight>([x, y, z]: &[f32; 3]) -> [F; 3] {
    [F::splat(*x), F::splat(*y), F::splat(*z)]
}

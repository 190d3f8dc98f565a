//! Triangles eight by eight: a filter in `f32` that says of each whether a ray surely meets it, surely misses it, or who knows.
//!
//! The filter follows the paper of [`watertight`], without a division until something is nearly met: with the axes renamed
//! so that the ray is longest on the third, and corners relative to the [`Probe`]'s origin and sheared along its direction,
//! the ray meets a triangle where the three edge functions U, V, W have the same sign. What they decide here is kept apart
//! from what [`RaySpace::meet`] would decide by a bound on their error:
//!
//! With ε = 2⁻²⁴, E the mesh's largest coordinate and η the error of `f64` in the probe's origin and in the exact test, which
//! both are far below ε E unless the ray comes from afar:
//!
//! - The origin is within 1.5 E of zero and is rounded to `f32`: 1.5 ε E + η. A corner is exact; relative to the origin it is
//!   at most 2.5 E and errs by 4 ε E + η. Sheared coordinates x − s z with |s| ≤ 1, s rounded, are at most 5 E and err by
//!   2 (4 ε E + η) + (2.5 + 2.5 + 5) ε E, so by less than **δ = 24 ε E + 2 η**.
//! - U = c_x b_y − c_y b_x from coordinates that err by δ errs by δ (|c_x| + |b_y| + |c_y| + |b_x|) + 2 δ², and rounding
//!   adds less than 5 ε E of the same sum. So all of U, V, W err by less than **τ = 2 δ (S + δ)**, S the sum of the magnitudes
//!   of all six coordinates.
//! - Surely missed: one of them is below −τ and another above τ. Surely met: all are above τ, or all below −τ. The exact test
//!   then sees the same signs.
//! - The distance. With D = U + V + W, which errs by less than 4 τ, and |D| > 8 τ, the weights V/D and W/D err by less than
//!   5 τ / (|D| − 4 τ) < 10 τ / |D|. With the third coordinates a, b, c, which err by δ, the measure of the ray parameter is
//!   s = a + V/D (b − a) + W/D (c − a), and errs by less than **12 τ/|D| (|b − a| + |c − a|) + 10 δ**, roundings included. An
//!   exact s also lies between the smallest and the largest of a, b and c.
//!
//! E is in [2⁻⁴⁰, 2⁴⁰], so that no product overflows, and what underflows, 2⁻¹⁵⁰, is far below δ², at least 2⁻¹¹⁹.
//!
//! [`watertight`]: super::watertight

use snell_math::lanes::{Eight, WIDTH};

use super::watertight::RaySpace;
use crate::accel::wide::{EPSILON, NONE, Probe, number, splat};

/// Eight triangles, in the order of their numbers. Five cache lines.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct TriangleBlock {
    /// Of each corner each coordinate of each triangle; NaN where there is none, which no filter lets through.
    corners: [[[f32; WIDTH]; 3]; 3],
    /// The triangles' entries, see [`WideTree::new`](crate::accel::wide::WideTree::new).
    pub(super) triangles: [u32; WIDTH],
}

const _: () = assert!(size_of::<TriangleBlock>() == 320);

impl TriangleBlock {
    /// Of a leaf's entries.
    pub(super) fn new(triangles: [u32; WIDTH], corners_of: impl Fn(u32) -> [[f32; 3]; 3]) -> Self {
        let mut corners = [[[f32::NAN; WIDTH]; 3]; 3];
        for (lane, entry) in triangles.into_iter().enumerate().filter(|(_, entry)| *entry != NONE) {
            for (row, corner) in corners.iter_mut().zip(corners_of(number(entry))) {
                for (row, x) in row.iter_mut().zip(corner) {
                    row[lane] = x;
                }
            }
        }
        Self { corners, triangles }
    }

    /// The corners of one triangle.
    #[inline(always)]
    pub(super) fn corners(&self, lane: usize) -> [[f32; 3]; 3] {
        self.corners_on([0, 1, 2], lane)
    }

    /// The same, with their coordinates on some axes, in that order.
    #[inline(always)]
    pub(super) fn corners_on(&self, axes: [usize; 3], lane: usize) -> [[f32; 3]; 3] {
        let ([x, y, z], lane) = (axes, lane & (WIDTH - 1));
        let [a, b, c] = &self.corners;
        // No closure, see `BlockRay::sheared`.
        [
            [a[x][lane], a[y][lane], a[z][lane]],
            [b[x][lane], b[y][lane], b[z][lane]],
            [c[x][lane], c[y][lane], c[z][lane]],
        ]
    }
}

/// A probe, made ready for triangles.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockLine {
    /// Which axes of space are called first, second and third.
    axes: [usize; 3],
    origin: [f32; 3],
    /// The direction's first and second components, and the third, ±1.
    direction: [f32; 3],
    /// δ.
    error: f32,
}

impl BlockLine {
    #[inline(always)]
    pub(super) fn new(probe: &Probe, space: &RaySpace) -> Self {
        let axes @ [first, second, third] = space.axes();
        let error = 24.0 * f64::from(EPSILON) * probe.extent + 2.0 * probe.error;
        let (o, d) = (&probe.origin, &probe.direction);
        Self {
            axes,
            origin: [o[first] as f32, o[second] as f32, o[third] as f32],
            direction: [d[first] as f32, d[second] as f32, d[third] as f32],
            error: error as f32,
        }
    }
}

/// A [`BlockLine`] in all lanes.
#[derive(Clone, Copy)]
pub(super) struct BlockRay<F> {
    axes: [usize; 3],
    origin: [F; 3],
    slopes: [F; 2],
    /// The sign of the third component of the direction.
    sign: F,
    error: F,
    /// 2 δ.
    twice: F,
}

/// What the filter says of eight triangles.
pub(super) struct Verdict<F> {
    /// Those that are met for sure.
    pub(super) sure: u32,
    /// Those that may be met.
    pub(super) unsure: u32,
    /// Between which measures of the ray parameter, where they are.
    pub(super) low: F,
    pub(super) high: F,
}

impl<F: Eight> BlockRay<F> {
    #[inline(always)]
    pub(super) fn new(probe: &Probe, space: &RaySpace) -> Self {
        Self::spread(&BlockLine::new(probe, space))
    }

    /// Of what was made ready.
    #[inline(always)]
    pub(super) fn spread(line: &BlockLine) -> Self {
        let [first, second, sign] = splat(&line.direction);
        Self {
            axes: line.axes,
            origin: splat(&line.origin),
            slopes: [first, second],
            sign,
            error: F::splat(line.error),
            twice: F::splat(2.0 * line.error),
        }
    }

    /// A corner of all triangles in the space of the ray. No closure: not being compiled for the instructions at hand, it would
    /// become a function that calls others for each of them.
    #[inline(always)]
    fn sheared(&self, block: &TriangleBlock, corner: usize) -> [F; 3] {
        let row = |k: usize| &block.corners[corner][self.axes[k]];
        let z = (F::load(row(2), 0) - self.origin[2]).times_sign(self.sign);
        let x = F::load(row(0), 0) - self.origin[0] - self.slopes[0] * z;
        let y = F::load(row(1), 0) - self.origin[1] - self.slopes[1] * z;
        [x, y, z]
    }

    /// The filter; `None` where all are missed for sure, or lie beyond the limit on the measure.
    #[inline(always)]
    pub(super) fn look(&self, block: &TriangleBlock, limit: F) -> Option<Verdict<F>> {
        let (a, b, c) = (self.sheared(block, 0), self.sheared(block, 1), self.sheared(block, 2));
        let (u, v, w) = (edge(b, c), edge(c, a), edge(a, b));
        let sum = size(a) + size(b) + size(c);
        let tolerance = (sum + self.error) * self.twice;
        let (least, most) = (u.lesser(v).lesser(w), u.greater(v).greater(w));
        let negative = F::splat(-0.0);
        let candidates = tolerance.times_sign(negative).le(least) | most.le(tolerance);
        if candidates.is_empty() {
            return None;
        }
        let slack = self.error * F::splat(10.0);
        let (front, back) = (a[2].lesser(b[2]).lesser(c[2]) - slack, a[2].greater(b[2]).greater(c[2]) + slack);
        let candidates = candidates & front.le(limit) & F::splat(0.0).le(back);
        let area = u + v + w;
        let size = area.abs();
        let is_clear = (tolerance * F::splat(8.0)).lt(size);
        let sure = candidates & is_clear & (tolerance.lt(least) | most.lt(tolerance.times_sign(negative)));
        let (ab, ac) = (b[2] - a[2], c[2] - a[2]);
        let inverse = F::splat(1.0) / area;
        // Weights first: the product of an edge function and a length may be too small a number.
        let middle = a[2] + (v * inverse * ab + w * inverse * ac);
        let width = (ab.abs() + ac.abs()) * (tolerance * inverse.abs() * F::splat(12.0));
        let width = width + slack;
        let unsure = candidates.without(sure).mask();
        Some(Verdict { sure: sure.mask(), unsure, low: middle - width, high: middle + width })
    }
}

/// The edge function from one corner to the next.
#[inline(always)]
fn edge<F: Eight>(from: [F; 3], to: [F; 3]) -> F {
    from[0] * to[1] - from[1] * to[0]
}

/// The magnitude of a corner across the ray.
#[inline(always)]
fn size<F: Eight>(corner: [F; 3]) -> F {
    corner[0].abs() + corner[1].abs()
}

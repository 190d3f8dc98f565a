//! Triangles eight by eight: a filter in `f32` that says of each whether a ray surely meets it, surely misses it, or who knows.
//!
//! The filter follows the paper of [`watertight`], without a division until something is nearly met: with the axes renamed
//! so that the ray is longest on the third, and corners relative to the line of the [`Probe`] and sheared along it,
//! the ray meets a triangle where the three edge functions U, V, W have the same sign. What they decide here is kept apart
//! from what [`RaySpace::meet`] would decide by a bound on their error:
//!
//! With ε = 2⁻²⁴, E the mesh's largest coordinate and η the error of `f64` in the probe's origin and in the exact test, which
//! both are far below ε E unless the ray comes from afar:
//!
//! - Across the ray a corner is at x + s z − k, with slopes |s| ≤ 1 and k = o_x + s o_z for an origin within 1.5 E of zero, both
//!   from `f64`. The rounding of s is worth ε E, that of s z, where it is rounded by itself, ε E, of the sum 2 ε E, of k 3 ε E + 2 η
//!   with what `f64` loses, of the difference 5 ε E. Along it, z − o_z errs by less. So all coordinates are at most 5 E and err by
//!   less than **δ = 24 ε E + 2 η**, half of which is left over.
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

use snell_math::lanes::{Eight, Floats, LaneVector, Lanes, WIDTH};

use super::spaces::LongAxes;
use super::watertight::RaySpace;
use crate::accel::wide::{EPSILON, NONE, Probe, Probes, number, splat, spread};

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
        // No closure, see `BlockRay::across`.
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
    /// The slopes of the direction on the first two axes against the third, negative.
    slopes: [f32; 2],
    /// Where the line is on the first two axes when it is at 0 on the third; and where it begins on the third.
    origin: [f32; 3],
    /// The third component of the direction, ±1.
    sign: f32,
    /// δ.
    error: f32,
}

impl BlockLine {
    #[inline(always)]
    pub(super) fn new(probe: &Probe, space: &RaySpace) -> Self {
        let axes @ [first, second, third] = space.axes();
        let error = 24.0 * f64::from(EPSILON) * probe.extent + 2.0 * probe.error;
        let (o, d) = (&probe.origin, &probe.direction);
        let slopes = [-d[first] * d[third], -d[second] * d[third]];
        Self {
            axes,
            slopes: [slopes[0] as f32, slopes[1] as f32],
            origin: [
                (o[first] + slopes[0] * o[third]) as f32,
                (o[second] + slopes[1] * o[third]) as f32,
                o[third] as f32,
            ],
            sign: d[third] as f32,
            error: error as f32,
        }
    }
}

/// As [`BlockLine`], in rows.
pub(super) struct BlockLines {
    slopes: [[f32; WIDTH]; 2],
    origin: [[f32; WIDTH]; 3],
    sign: [f32; WIDTH],
    error: [f32; WIDTH],
}

impl BlockLines {
    /// Of probes.
    #[inline(always)]
    pub(super) fn of<L: Lanes>(probes: &Probes<L>, axes: LongAxes) -> Self {
        Self::new(probes.origin, probes.direction, probes.error, probes.extent, axes)
    }

    /// Of what a [`Probe`] has of the same names.
    #[inline(always)]
    pub(super) fn new<L: Lanes>(
        origin: LaneVector<L>,
        direction: LaneVector<L>,
        error: L,
        extent: f64,
        axes: LongAxes,
    ) -> Self {
        let row = [0.0; WIDTH];
        let mut lines = Self { slopes: [row; 2], origin: [row; 3], sign: row, error: row };
        let (o, d) = (axes.in_order(origin), axes.in_order(direction));
        let slopes = [-d.x * d.z, -d.y * d.z];
        slopes[0].to_floats().store(&mut lines.slopes[0], 0);
        slopes[1].to_floats().store(&mut lines.slopes[1], 0);
        (o.x + slopes[0] * o.z).to_floats().store(&mut lines.origin[0], 0);
        (o.y + slopes[1] * o.z).to_floats().store(&mut lines.origin[1], 0);
        o.z.to_floats().store(&mut lines.origin[2], 0);
        d.z.to_floats().store(&mut lines.sign, 0);
        let error = L::splat(24.0 * f64::from(EPSILON) * extent) + L::splat(2.0) * error;
        error.to_floats().store(&mut lines.error, 0);
        lines
    }

    /// One of them in all lanes.
    #[inline(always)]
    pub(super) fn spread<F: Eight>(&self, axes: LongAxes, lane: usize) -> BlockRay<F> {
        let lane = lane & (WIDTH - 1);
        BlockRay {
            axes: axes.of(lane),
            slopes: [F::splat(self.slopes[0][lane]), F::splat(self.slopes[1][lane])],
            origin: spread(&self.origin, lane),
            sign: F::splat(self.sign[lane]),
            error: F::splat(self.error[lane]),
            twice: F::splat(2.0 * self.error[lane]),
        }
    }
}

/// A [`BlockLine`] in all lanes.
#[derive(Clone, Copy)]
pub(super) struct BlockRay<F> {
    axes: [usize; 3],
    slopes: [F; 2],
    origin: [F; 3],
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
        Self {
            axes: line.axes,
            slopes: [F::splat(line.slopes[0]), F::splat(line.slopes[1])],
            origin: splat(&line.origin),
            sign: F::splat(line.sign),
            error: F::splat(line.error),
            twice: F::splat(2.0 * line.error),
        }
    }

    /// A corner of all triangles, across the ray. No closure: not being compiled for the instructions at hand, it would become a
    /// function that calls others for each of them.
    #[inline(always)]
    fn across(&self, block: &TriangleBlock, corner: usize) -> [F; 2] {
        let [x, y, z] = self.axes;
        let rows = &block.corners[corner];
        let z = F::load(&rows[z], 0);
        let x = z.multiply_add(self.slopes[0], F::load(&rows[x], 0)) - self.origin[0];
        let y = z.multiply_add(self.slopes[1], F::load(&rows[y], 0)) - self.origin[1];
        [x, y]
    }

    /// The same along it.
    #[inline(always)]
    fn along(&self, block: &TriangleBlock, corner: usize) -> F {
        (F::load(&block.corners[corner][self.axes[2]], 0) - self.origin[2]).times_sign(self.sign)
    }

    /// The filter; `None` where all are missed for sure, or lie beyond the limit on the measure.
    #[inline(always)]
    pub(super) fn look(&self, block: &TriangleBlock, limit: F) -> Option<Verdict<F>> {
        let (a, b, c) = (self.across(block, 0), self.across(block, 1), self.across(block, 2));
        let (u, v, w) = (edge(b, c), edge(c, a), edge(a, b));
        let tolerance = (size(a) + size(b) + size(c) + self.error) * self.twice;
        let (least, most) = (u.lesser(v).lesser(w), u.greater(v).greater(w));
        let negative = F::splat(-0.0);
        let candidates = tolerance.times_sign(negative).le(least) | most.le(tolerance);
        if candidates.is_empty() {
            return None;
        }
        let (a, b, c) = (self.along(block, 0), self.along(block, 1), self.along(block, 2));
        let slack = self.error * F::splat(10.0);
        let (front, back) = (a.lesser(b).lesser(c) - slack, a.greater(b).greater(c) + slack);
        let candidates = candidates & front.le(limit) & F::splat(0.0).le(back);
        let area = u + v + w;
        let size = area.abs();
        let is_clear = (tolerance * F::splat(8.0)).lt(size);
        let sure = candidates & is_clear & (tolerance.lt(least) | most.lt(tolerance.times_sign(negative)));
        let (ab, ac) = (b - a, c - a);
        let inverse = F::splat(1.0) / area;
        // Weights first: the product of an edge function and a length may be too small a number.
        let middle = (v * inverse).multiply_add(ab, (w * inverse).multiply_add(ac, a));
        let width = (ab.abs() + ac.abs()).multiply_add(tolerance * inverse.abs() * F::splat(12.0), slack);
        let unsure = candidates.without(sure).mask();
        Some(Verdict { sure: sure.mask(), unsure, low: middle - width, high: middle + width })
    }
}

/// The edge function from one corner to the next.
#[inline(always)]
fn edge<F: Eight>(from: [F; 2], to: [F; 2]) -> F {
    from[0].multiply_add(to[1], -(from[1] * to[0]))
}

/// The magnitude of a corner across the ray.
#[inline(always)]
fn size<F: Eight>(corner: [F; 2]) -> F {
    corner[0].abs() + corner[1].abs()
}

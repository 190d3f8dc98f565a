//! Leaves of balls: a filter in `f32` that turns away most of those that a ray misses, and never one that it meets.
//!
//! Where all primitives are balls, a leaf has their centres and radii side by side. A ball is surely missed where the line passes
//! it at more than its radius, or it lies behind the ray's origin or beyond the limit.
//!
//! With ε = 2⁻²⁴, E the tree's extent, η the error of `f64` (both see [`super::probe`]) and r the radius rounded up: the centre
//! relative to the origin, f, is at most 4.4 E long and errs by 5 ε E + η on each axis. With d the direction, rounded, and
//! m = f·d / d·d, the perpendicular f − m d errs by less than √3 (5 ε E + η) for that, 2 ε |f| for the direction's rounding
//! (twice: in m and in the product), and 12 ε |f| for the roundings of m, of the product and of the difference: by less than
//! 90 ε E + 2 η in all. So the line surely passes beyond the ball where the square of the perpendicular exceeds that of
//! r + δ, with δ = 128 ε E + 4 η for the roundings of squares too. Since |d| ≥ 1, the ball's part of the line lies within
//! m ± (r + δ).

use snell_math::Point3;
use snell_math::lanes::{Eight, Floats, LaneVector, Lanes, WIDTH};

use super::probe::{EPSILON, Probe, splat};
use super::probes::spread;
use super::shared::{NONE, number};

/// Eight balls.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct BallBlock {
    center: [[f32; WIDTH]; 3],
    /// Rounded up. NaN where there is no ball, which no filter lets through.
    radius: [f32; WIDTH],
}

impl BallBlock {
    /// Of a leaf's entries, by the centres and radii of all balls.
    pub(super) fn new(entries: &[u32; WIDTH], balls: &[(Point3, f64)]) -> Self {
        let mut block = Self { center: [[0.0; WIDTH]; 3], radius: [f32::NAN; WIDTH] };
        for (lane, entry) in entries.iter().enumerate().filter(|(_, entry)| **entry != NONE) {
            let (center, radius) = balls[number(*entry) as usize];
            for (axis, row) in block.center.iter_mut().enumerate() {
                row[lane] = center[axis] as f32;
            }
            block.radius[lane] = (radius as f32).next_up();
        }
        block
    }
}

/// Probes side by side, made ready for balls; see [`BallRay`].
pub(super) struct BallLines {
    origin: [[f32; WIDTH]; 3],
    direction: [[f32; WIDTH]; 3],
    scaled: [[f32; WIDTH]; 3],
    error: [f32; WIDTH],
}

impl BallLines {
    /// Of the probes' origins, directions and errors, and the tree's extent.
    #[inline(always)]
    pub(super) fn new<L: Lanes>(origin: LaneVector<L>, direction: LaneVector<L>, error: L, extent: f64) -> Self {
        let rows = [[0.0; WIDTH]; 3];
        let mut lines = Self { origin: rows, direction: rows, scaled: rows, error: [0.0; WIDTH] };
        store(origin, &mut lines.origin);
        store(direction, &mut lines.direction);
        let rounded = LaneVector {
            x: L::from_floats(direction.x.to_floats()),
            y: L::from_floats(direction.y.to_floats()),
            z: L::from_floats(direction.z.to_floats()),
        };
        store(rounded * (L::splat(1.0) / rounded.length_squared()), &mut lines.scaled);
        let error = L::splat(128.0 * f64::from(EPSILON) * extent) + L::splat(4.0) * error;
        error.to_floats().store(&mut lines.error, 0);
        lines
    }

    /// One of them in all lanes.
    #[inline(always)]
    pub(super) fn spread<F: Eight>(&self, lane: usize) -> BallRay<F> {
        let lane = lane & (WIDTH - 1);
        BallRay {
            origin: spread(&self.origin, lane),
            direction: spread(&self.direction, lane),
            scaled: spread(&self.scaled, lane),
            error: F::splat(self.error[lane]),
        }
    }
}

/// Rounds vectors to rows of `f32`.
#[inline(always)]
fn store<L: Lanes>(v: LaneVector<L>, [x, y, z]: &mut [[f32; WIDTH]; 3]) {
    v.x.to_floats().store(x, 0);
    v.y.to_floats().store(y, 0);
    v.z.to_floats().store(z, 0);
}

/// A probe in all lanes, for balls.
#[derive(Clone, Copy)]
pub(super) struct BallRay<F> {
    origin: [F; 3],
    direction: [F; 3],
    /// The direction over its squared length.
    scaled: [F; 3],
    /// δ.
    error: F,
}

impl<F: Eight> BallRay<F> {
    #[inline(always)]
    pub(super) fn new(probe: &Probe) -> Self {
        let direction = probe.direction.map(|x| x as f32);
        let squared = direction.iter().map(|x| x * x).sum::<f32>();
        let error = 128.0 * f64::from(EPSILON) * probe.extent + 4.0 * probe.error;
        Self {
            origin: splat(&probe.origin.map(|x| x as f32)),
            direction: splat(&direction),
            scaled: splat(&direction.map(|x| x / squared)),
            error: F::splat(error as f32),
        }
    }

    /// The lanes whose balls the ray may meet before the limit.
    #[inline(always)]
    pub(super) fn look(&self, block: &BallBlock, limit: F) -> u32 {
        let mut f = self.origin;
        for (f, row) in f.iter_mut().zip(&block.center) {
            *f = F::load(row, 0) - *f;
        }
        let middle = dot(f, self.scaled);
        let mut beside = f;
        for (beside, direction) in beside.iter_mut().zip(self.direction) {
            *beside = direction.multiply_add(-middle, *beside);
        }
        let reach = F::load(&block.radius, 0) + self.error;
        let (front, back) = (middle - reach, middle + reach);
        (dot(beside, beside).le(reach * reach) & front.le(limit) & F::splat(0.0).le(back)).mask()
    }
}

// Functions and not closures, which cannot be marked to be inlined: left out of line, they would be compiled without the
// instructions.

#[inline(always)]
fn dot<F: Eight>(a: [F; 3], b: [F; 3]) -> F {
    a[0].multiply_add(b[0], a[1].multiply_add(b[1], a[2] * b[2]))
}

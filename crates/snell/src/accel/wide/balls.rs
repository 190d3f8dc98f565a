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
use snell_math::lanes::{Eight, WIDTH};

use super::probe::{EPSILON, Probe};
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
            origin: splat(probe.origin.map(|x| x as f32)),
            direction: splat(direction),
            scaled: splat(direction.map(|x| x / squared)),
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
            *beside = *beside - direction * middle;
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
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn splat<F: Eight>([x, y, z]: [f32; 3]) -> [F; 3] {
    [F::splat(x), F::splat(y), F::splat(z)]
}

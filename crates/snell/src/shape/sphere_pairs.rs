//! Several spheres at once: which of them may a ray meet? Two side by side in each step, as every 64-bit processor can.
//!
//! A filter and no more: it turns away nearly all that are missed, by the same reasoning as [`Sphere::intersect`] for one, and
//! never one that is met, so what a hit is remains [`Sphere`]'s to say, and pictures do not depend on it.

use snell_math::Ray;
use wide::f64x2;

use super::Sphere;
use super::sphere::{MISS_MARGIN, MISS_REACH};

/// Spheres in a row, laid out for the filter.
#[derive(Clone, Debug, Default)]
pub struct SpherePairs {
    pairs: Vec<Pair>,
    count: u32,
}

/// Two spheres: one in each lane.
#[derive(Clone, Copy, Debug)]
struct Pair {
    center: [f64x2; 3],
    /// The square of the radius.
    squared: f64x2,
}

impl SpherePairs {
    /// Of any number of spheres. Where it is odd, the last one is there twice.
    pub fn new(spheres: &[Sphere]) -> Self {
        let pair = |chunk: &[Sphere]| {
            let lanes = |of: &dyn Fn(&Sphere) -> f64| f64x2::new([of(&chunk[0]), of(&chunk[chunk.len() - 1])]);
            Pair {
                center: [0, 1, 2].map(|axis| lanes(&|sphere| sphere.center[axis])),
                squared: lanes(&|sphere| sphere.radius * sphere.radius),
            }
        };
        Self { pairs: spheres.chunks(2).map(pair).collect(), count: spheres.len() as u32 }
    }

    /// True where there is none.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// Gives the places of all spheres that a ray may meet with t > 0 to `visit`, in order, until it says that it is enough; true
    /// where it did.
    #[inline]
    pub fn any(&self, ray: &Ray, mut visit: impl FnMut(u32) -> bool) -> bool {
        let origin = ray.origin.to_array().map(f64x2::splat);
        let direction = ray.direction.to_array().map(f64x2::splat);
        let a = f64x2::splat(ray.direction.length_squared());
        for (pair, first) in self.pairs.iter().zip((0..).step_by(2)) {
            let missed = pair.surely_missed(&origin, &direction, a);
            if missed == 0b11 {
                continue;
            }
            let second = first + 1;
            if missed & 1 == 0 && visit(first) || missed & 2 == 0 && second < self.count && visit(second) {
                return true;
            }
        }
        false
    }
}

impl Pair {
    /// One bit for each lane, set as [`Sphere`]'s own filter has it; `a` is the squared length of the direction.
    #[inline]
    fn surely_missed(&self, origin: &[f64x2; 3], direction: &[f64x2; 3], a: f64x2) -> u32 {
        let f = [self.center[0] - origin[0], self.center[1] - origin[1], self.center[2] - origin[2]];
        let b = f[0] * direction[0] + f[1] * direction[1] + f[2] * direction[2];
        let c = f[0] * f[0] + f[1] * f[1] + f[2] * f[2];
        let is_behind = b.simd_lt(f64x2::ZERO) & c.simd_ge(self.squared);
        let (distance, reach) = (c * a - b * b, a * (self.squared + MISS_MARGIN * c));
        let is_beside = distance.simd_gt(reach) & reach.simd_gt(MISS_REACH) & distance.simd_lt(f64::INFINITY);
        (is_behind | is_beside).to_bitmask()
    }
}

//! A sampling routine against its density: samples counted in the cells of a rectangle, the density integrated over each.
//!
//! The rectangle is of any two coordinates in which the density is one per unit of area. Directions are counted by
//! (cos θ, φ), in which a density per steradian is just that, since dω = d(cos θ) dφ (Archimedes).

use std::f64::consts::PI;

use snell_math::{Vector3, portable};

use super::assert_counts;
use crate::TestRng;

/// How often a cell is cut into quarters at most, to integrate over it.
const DEEPEST: u32 = 7;

/// A grid of cells over a rectangle, and how many samples are drawn into it.
#[derive(Clone, Copy, Debug)]
pub struct Histogram {
    /// Where the rectangle begins and ends in each coordinate.
    pub domain: [[f64; 2]; 2],
    /// The number of cells along each coordinate.
    pub cells: [usize; 2],
    /// The number of samples.
    pub samples: u64,
    /// Of how many tests of one claim this is one.
    pub tests: u32,
    /// The seed of the random numbers.
    pub seed: u64,
}

impl Histogram {
    /// A grid of a size that suits most routines, over a rectangle.
    pub fn over(domain: [[f64; 2]; 2]) -> Self {
        Self { domain, cells: [24, 24], samples: 200_000, tests: 1, seed: 1 }
    }

    /// Over all directions, as (cos θ, φ) about +z: see [`Histogram::direction`].
    pub fn of_directions() -> Self {
        Self { cells: [32, 16], ..Self::over([[-1.0, 1.0], [-PI, PI]]) }
    }

    /// One of `tests` tests of the same claim.
    #[must_use]
    pub fn one_of(self, tests: u32) -> Self {
        Self { tests, ..self }
    }

    /// With so many cells along the coordinates.
    #[must_use]
    pub fn with_cells(self, cells: [usize; 2]) -> Self {
        Self { cells, ..self }
    }

    /// The coordinates (cos θ, φ) of a unit vector.
    pub fn coordinates(direction: Vector3) -> [f64; 2] {
        [direction.z(), portable::atan2(direction.y(), direction.x())]
    }

    /// The unit vector of coordinates (cos θ, φ).
    pub fn direction([cos, angle]: [f64; 2]) -> Vector3 {
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        Vector3::new(sin * portable::cos(angle), sin * portable::sin(angle), cos)
    }

    /// Fails where the samples are not distributed by the density.
    ///
    /// `sample` turns two uniform numbers in [0, 1) into a place, or `None` where it gives none; the density then
    /// integrates to less than one by that share. A sample outside the rectangle counts as `None`.
    ///
    /// # Panics
    /// Where the density integrates to more than one (by 0.002, since jumps of a density are integrated no better), or the counts would come by chance less often than the
    /// significance says.
    ///
    /// ```
    /// use snell_testkit::{chi_square::Histogram, must_fail};
    /// let square = Histogram::over([[0.0, 1.0], [0.0, 1.0]]);
    /// square.assert("x squared", |[u, v]| Some([u.sqrt(), v]), |[x, _]| 2.0 * x);
    /// must_fail("a wrong density", || square.assert("x squared", |[u, v]| Some([u.sqrt(), v]), |_| 1.0));
    /// ```
    #[track_caller]
    pub fn assert(
        &self,
        what: &str,
        mut sample: impl FnMut([f64; 2]) -> Option<[f64; 2]>,
        density: impl Fn([f64; 2]) -> f64,
    ) {
        let count = self.cells[0] * self.cells[1];
        let mut rng = TestRng::new(self.seed);
        // The last is for samples that are nowhere.
        let mut observed = vec![0_u64; count + 1];
        for _ in 0..self.samples {
            let place = sample([rng.unit(), rng.unit()]).and_then(|place| self.cell(place));
            observed[place.unwrap_or(count)] += 1;
        }
        let mut expected: Vec<f64> = (0..count).map(|cell| self.integral(cell, &density)).collect();
        let total: f64 = expected.iter().sum();
        assert!(total <= 1.0 + 2e-3, "{what}: the density integrates to {total}");
        // Less than a thousandth of one sample in all is the integrals' own error.
        let rest = 1.0 - total;
        let without = if rest.abs() < 2e-3 && observed[count] == 0 { 0.0 } else { rest.max(0.0) };
        let scale = self.samples as f64 / (total + without);
        expected.push(without);
        expected.iter_mut().for_each(|share| *share *= scale);
        assert_counts(what, &observed, &expected, self.tests);
    }

    /// As [`Histogram::assert`] for directions, with a density per steradian; the histogram is
    /// [`Histogram::of_directions`], or one of its part.
    ///
    /// # Panics
    /// As [`Histogram::assert`].
    #[track_caller]
    pub fn assert_directions(
        &self,
        what: &str,
        mut sample: impl FnMut([f64; 2]) -> Option<Vector3>,
        density: impl Fn(Vector3) -> f64,
    ) {
        self.assert(what, |u| sample(u).map(Self::coordinates), |coordinates| density(Self::direction(coordinates)));
    }

    /// The cell of a place, if there is one.
    fn cell(&self, place: [f64; 2]) -> Option<usize> {
        let mut index = [0; 2];
        for axis in 0..2 {
            let [low, high] = self.domain[axis];
            let position = (place[axis] - low) / (high - low);
            // The end itself belongs to the last cell; rounding may go a little beyond.
            if !(-1e-9..=1.0 + 1e-9).contains(&position) {
                return None;
            }
            index[axis] = ((position * self.cells[axis] as f64) as usize).min(self.cells[axis] - 1);
        }
        Some(index[0] * self.cells[1] + index[1])
    }

    /// The integral of a density over a cell.
    fn integral(&self, cell: usize, density: &impl Fn([f64; 2]) -> f64) -> f64 {
        let index = [cell / self.cells[1], cell % self.cells[1]];
        let range: [[f64; 2]; 2] = std::array::from_fn(|axis| {
            let [low, high] = self.domain[axis];
            let width = (high - low) / self.cells[axis] as f64;
            [low + width * index[axis] as f64, low + width * (index[axis] + 1) as f64]
        });
        refine(range, gauss(range, density), density, DEEPEST)
    }
}

/// An integral, by quarters for as long as that changes it.
fn refine(range: [[f64; 2]; 2], whole: f64, density: &impl Fn([f64; 2]) -> f64, depth: u32) -> f64 {
    let [[a, b], [c, d]] = range;
    let (x, y) = (0.5 * (a + b), 0.5 * (c + d));
    let quarters = [[[a, x], [c, y]], [[a, x], [y, d]], [[x, b], [c, y]], [[x, b], [y, d]]];
    let parts = quarters.map(|quarter| gauss(quarter, density));
    let sum: f64 = parts.iter().sum();
    // Not at once: nine points may miss an edge in a corner.
    let settled = depth < DEEPEST && (sum - whole).abs() <= 1e-9 + 1e-6 * sum.abs();
    if depth == 0 || settled {
        return sum;
    }
    quarters.into_iter().zip(parts).map(|(quarter, part)| refine(quarter, part, density, depth - 1)).sum()
}

/// Gauss and Legendre's rule of three by three points.
fn gauss([[a, b], [c, d]]: [[f64; 2]; 2], density: &impl Fn([f64; 2]) -> f64) -> f64 {
    const RULE: [(f64, f64); 3] =
        [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];
    let mut sum = 0.0;
    for (x, x_weight) in RULE {
        for (y, y_weight) in RULE {
            let place = [0.5 * (a + b + (b - a) * x), 0.5 * (c + d + (d - c) * y)];
            sum += x_weight * y_weight * density(place);
        }
    }
    0.25 * sum * (b - a) * (d - c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::must_fail;

    const SQUARE: [[f64; 2]; 2] = [[0.0, 1.0], [0.0, 1.0]];

    #[test]
    fn a_routine_that_sometimes_gives_nothing_passes_with_its_own_density() {
        let half = |[u, v]: [f64; 2]| (u < 0.5).then_some([u, v]);
        let density = |[x, _]: [f64; 2]| if x < 0.5 { 1.0 } else { 0.0 };
        Histogram::over(SQUARE).assert("half", half, density);
        must_fail("a share that is lost", || Histogram::over(SQUARE).assert("half", half, |_| 1.0));
        must_fail("a density above one", || Histogram::over(SQUARE).assert("x", Some, |_| 1.01));
    }

    #[test]
    fn small_shifts_and_slopes_are_caught() {
        for defect in [|u: f64| 0.98 * u, |u: f64| (u + 0.02).min(0.999), |u: f64| u + 0.08 * u * (1.0 - u)] {
            must_fail("a bent coordinate", || {
                Histogram::over(SQUARE).assert("bent", |[u, v]| Some([u, defect(v)]), |_| 1.0);
            });
        }
    }

    #[test]
    fn integrals_meet_edges_and_peaks() {
        let grid = Histogram::over([[-1.0, 1.0], [-1.0, 1.0]]).with_cells([5, 7]);
        let disk = |[x, y]: [f64; 2]| f64::from(u8::from(x * x + y * y < 1.0));
        let area: f64 = (0..35).map(|cell| grid.integral(cell, &disk)).sum();
        assert!((area - PI).abs() < 5e-3, "{area}");
        let peak = |[x, y]: [f64; 2]| portable::exp(-200.0 * (x * x + y * y));
        let volume: f64 = (0..35).map(|cell| grid.integral(cell, &peak)).sum();
        assert!((volume - PI / 200.0).abs() < 1e-6, "{volume}");
    }

    #[test]
    fn directions_and_coordinates_are_inverse() {
        let mut rng = TestRng::new(4);
        for _ in 0..100 {
            let direction = rng.direction();
            assert!((Histogram::direction(Histogram::coordinates(direction)) - direction).length() < 1e-7);
        }
        let uniform = |[u, v]: [f64; 2]| Some(Histogram::direction([2.0 * u - 1.0, PI * (2.0 * v - 1.0)]));
        Histogram::of_directions().assert_directions("uniform", uniform, |_| 0.25 / PI);
    }
}

//! A density of the unit square that is constant in each cell of a grid: what environment maps are sampled by.
//!
//! Follows: Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th edition, appendix A.5.6: a row by the sums of
//! the rows, then a cell of it.

use super::PiecewiseConstant;

/// A choice among the cells of a grid over [0, 1) × [0, 1), by weights.
///
/// ```
/// use snell_math::warp::PiecewiseConstantPlane;
/// // A map of two rows and three columns with one bright pixel.
/// let map = PiecewiseConstantPlane::new(3, &[0.0, 0.0, 1.0, 0.0, 0.0, 0.0]).unwrap();
/// let spot = map.sample([0.3, 0.6]);
/// assert_eq!((spot.column, spot.row), (2, 0));
/// assert_eq!(spot.density, 6.0);
/// assert_eq!(map.density(spot.place), 6.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseConstantPlane {
    rows: PiecewiseConstant,
    /// `None` for a row without weight, which is never chosen.
    columns: Vec<Option<PiecewiseConstant>>,
    width: usize,
}

/// What [`PiecewiseConstantPlane::sample`] has chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// The place in [0, 1) × [0, 1): the first coordinate along rows, the second across them.
    pub place: [f64; 2],
    /// The column of the cell.
    pub column: usize,
    /// The row of the cell.
    pub row: usize,
    /// The density there, per unit of area of the square.
    pub density: f64,
}

impl PiecewiseConstantPlane {
    /// A grid of `width` columns with these weights, row after row; `None` where the weights are not a whole number of
    /// rows, none is positive, or their sum is not finite. A negative or NaN weight counts as 0.
    #[must_use]
    pub fn new(width: usize, weights: &[f64]) -> Option<Self> {
        let total: f64 = weights.iter().filter(|weight| **weight > 0.0).sum();
        if width == 0 || !weights.len().is_multiple_of(width) || !total.is_finite() {
            return None;
        }
        let columns: Vec<_> = weights.chunks_exact(width).map(PiecewiseConstant::new).collect();
        let sums: Vec<f64> = columns.iter().map(|row| row.as_ref().map_or(0.0, PiecewiseConstant::integral)).collect();
        Some(Self { rows: PiecewiseConstant::new(&sums)?, columns, width })
    }

    /// The mean of the weights: their integral over the square.
    #[must_use]
    pub fn integral(&self) -> f64 {
        self.rows.integral()
    }

    /// Chooses a place by two numbers in [0, 1): the first for the column, the second for the row.
    #[must_use]
    pub fn sample(&self, [u, v]: [f64; 2]) -> Spot {
        let row = self.rows.sample(v);
        let column = self.columns[row.index].as_ref().map_or_else(
            // No row without weight is chosen; were it, any column would be as good.
            || super::Piece { index: 0, probability: 0.0, within: u },
            |columns| columns.sample(u),
        );
        let (width, height) = (self.width as f64, self.columns.len() as f64);
        Spot {
            place: [(column.index as f64 + column.within) / width, (row.index as f64 + row.within) / height],
            column: column.index,
            row: row.index,
            density: column.probability * row.probability * width * height,
        }
    }

    /// The density of [`Self::sample`] at a place, per unit of area of the square; 0 outside.
    #[must_use]
    pub fn density(&self, [x, y]: [f64; 2]) -> f64 {
        let height = self.columns.len() as f64;
        if !(0.0..1.0).contains(&y) {
            return 0.0;
        }
        let row = &self.columns[((y * height) as usize).min(self.columns.len() - 1)];
        row.as_ref().map_or(0.0, |columns| columns.density(x)) * self.rows.density(y)
    }
}

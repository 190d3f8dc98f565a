//! A density of an interval that is constant in each of equal pieces; and the choice of one of many things by weights.
//!
//! Follows: Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th edition, appendix A.4.7: inversion of the summed
//! weights by bisection. It is monotonic, so well-spread numbers stay well spread; an alias table would be quicker and
//! lose that.

/// A choice among pieces of the interval [0, 1), by weights.
///
/// ```
/// use snell_math::warp::PiecewiseConstant;
/// let lights = PiecewiseConstant::new(&[1.0, 0.0, 3.0]).unwrap();
/// let choice = lights.sample(0.5);
/// assert_eq!((choice.index, choice.probability), (2, 0.75));
/// assert_eq!(lights.probability(1), 0.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseConstant {
    /// The share of all pieces before each; one more than there are pieces, from 0 to 1.
    summed: Vec<f64>,
    /// The sum of the weights, over their number: the integral over [0, 1).
    integral: f64,
}

/// What [`PiecewiseConstant::sample`] has chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Which piece.
    pub index: usize,
    /// How probable it was.
    pub probability: f64,
    /// Where in the piece, in [0, 1): uniform and independent of the choice, so it can serve as a random number again.
    pub within: f64,
}

impl PiecewiseConstant {
    /// A choice by weights; `None` where none is positive, or their sum not finite. A negative or NaN weight counts as 0.
    #[must_use]
    pub fn new(weights: &[f64]) -> Option<Self> {
        let mut summed = Vec::with_capacity(weights.len() + 1);
        let mut sum = 0.0;
        summed.push(0.0);
        for weight in weights {
            // NaN is not larger than 0.
            sum += if *weight > 0.0 { *weight } else { 0.0 };
            summed.push(sum);
        }
        if !(sum > 0.0 && sum.is_finite()) {
            return None;
        }
        for share in &mut summed {
            *share /= sum;
        }
        Some(Self { summed, integral: sum / weights.len() as f64 })
    }

    /// The number of pieces.
    #[expect(clippy::len_without_is_empty, reason = "there is always a piece")]
    #[must_use]
    pub fn len(&self) -> usize {
        self.summed.len() - 1
    }

    /// The mean of the weights: the integral of the weight over [0, 1).
    #[must_use]
    pub fn integral(&self) -> f64 {
        self.integral
    }

    /// Chooses a piece by a number in [0, 1). Never one of weight 0.
    #[must_use]
    pub fn sample(&self, u: f64) -> Piece {
        // The last piece that begins at or before u; pieces without weight begin where the next one does.
        let after = self.summed.partition_point(|share| *share <= u);
        let mut index = after.clamp(1, self.len()) - 1;
        // Only where u is at or beyond the end: the last piece that has a weight.
        while index > 0 && self.probability(index) == 0.0 {
            index -= 1;
        }
        let probability = self.probability(index);
        let within = ((u - self.summed[index]) / probability).clamp(0.0, 1.0 - f64::EPSILON);
        Piece { index, probability, within }
    }

    /// How probable a piece is; 0 for one that is not there.
    #[must_use]
    pub fn probability(&self, index: usize) -> f64 {
        match (self.summed.get(index), self.summed.get(index + 1)) {
            (Some(before), Some(after)) => after - before,
            _ => 0.0,
        }
    }

    /// The density over [0, 1) at a place, where [`Self::sample`]'s place is (index + within) / len; 0 outside.
    #[must_use]
    pub fn density(&self, place: f64) -> f64 {
        let count = self.len() as f64;
        if (0.0..1.0).contains(&place) { self.probability((place * count) as usize) * count } else { 0.0 }
    }
}

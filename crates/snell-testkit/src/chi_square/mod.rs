//! Pearson's chi-square test: whether counts are those of a distribution.
//!
//! Follows: Pearson, "On the criterion…", Philosophical Magazine 50, 1900; Cochran, "Some Methods for Strengthening the
//! Common χ² Tests", Biometrics 10, 1954 (cells with few expected counts are pooled); Šidák, "Rectangular Confidence
//! Regions for the Means of Multivariate Normal Distributions", JASA 62, 1967 (several tests of one claim).
//!
//! Two doors: [`assert_counts`] for counts whose expectations are known, [`Histogram`] for a sampling routine with its
//! density beside it. Random numbers are [`crate::TestRng`]'s, so that a test passes always or never.

mod gamma;
mod histogram;

pub use histogram::Histogram;

/// The chance that a right routine fails one claim, however many tests the claim is split into.
pub const SIGNIFICANCE: f64 = 1e-3;
/// Cells that expect fewer counts than this are pooled with others.
const FEWEST_EXPECTED: f64 = 5.0;

/// What a chi-square test has found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiSquare {
    /// Σ (observed − expected)² / expected over the pooled cells.
    pub statistic: f64,
    /// The number of pooled cells, less one.
    pub degrees_of_freedom: u32,
    /// The chance of a statistic at least as large, were the expectations right: in [0, 1].
    pub p_value: f64,
}

/// Compares counts with their expectations, which should have the same sum. Cells that expect fewer than five are pooled, from the
/// smallest on, until five are together. A count where exactly nothing is expected gives a `p_value` of 0.
///
/// # Panics
/// Where the slices differ in length, or an expectation is negative or no number.
///
/// ```
/// use snell_testkit::chi_square::chi_square;
/// let fair = chi_square(&[48, 52], &[50.0, 50.0]);
/// assert!((fair.statistic - 0.16).abs() < 1e-12 && fair.p_value > 0.6);
/// assert!(chi_square(&[20, 80], &[50.0, 50.0]).p_value < 1e-8);
/// ```
pub fn chi_square(observed: &[u64], expected: &[f64]) -> ChiSquare {
    assert_eq!(observed.len(), expected.len(), "a count for each expectation");
    assert!(expected.iter().all(|count| *count >= 0.0), "no expectation is negative: {expected:?}");
    let mut cells: Vec<(f64, f64)> =
        expected.iter().zip(observed).map(|(expected, observed)| (*expected, *observed as f64)).collect();
    if cells.iter().any(|(expected, observed)| *expected == 0.0 && *observed > 0.0) {
        return ChiSquare { statistic: f64::INFINITY, degrees_of_freedom: 1, p_value: 0.0 };
    }
    cells.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut pooled: Vec<(f64, f64)> = Vec::new();
    let mut open = (0.0, 0.0);
    for (expected, observed) in cells {
        open = (open.0 + expected, open.1 + observed);
        if open.0 >= FEWEST_EXPECTED {
            pooled.push(std::mem::take(&mut open));
        }
    }
    match pooled.last_mut() {
        Some(last) => *last = (last.0 + open.0, last.1 + open.1),
        None => pooled.push(open),
    }
    let statistic = pooled
        .iter()
        .filter(|(expected, _)| *expected > 0.0)
        .map(|(expected, observed)| (observed - expected) * (observed - expected) / expected)
        .sum();
    let degrees_of_freedom = (pooled.len() as u32).saturating_sub(1);
    let p_value = if degrees_of_freedom == 0 { 1.0 } else { gamma::upper(degrees_of_freedom, 0.5 * statistic) };
    ChiSquare { statistic, degrees_of_freedom, p_value }
}

/// The significance that each of `tests` independent tests may have, so that a right routine fails any of them with the chance
/// [`SIGNIFICANCE`]: Šidák's correction.
pub fn corrected_significance(tests: u32) -> f64 {
    use snell_math::portable::{exp, ln};
    1.0 - exp(ln(1.0 - SIGNIFICANCE) / f64::from(tests.max(1)))
}

/// Fails where counts are not those expected, as one of `tests` tests of the same claim.
///
/// # Panics
/// Where the counts would come by chance less often than [`corrected_significance`] says; and as [`chi_square`].
///
/// ```
/// use snell_testkit::{chi_square::assert_counts, must_fail};
/// assert_counts("a coin", &[48, 52], &[50.0, 50.0], 1);
/// must_fail("a coin with two heads", || assert_counts("a coin", &[0, 100], &[50.0, 50.0], 1));
/// ```
#[track_caller]
pub fn assert_counts(what: &str, observed: &[u64], expected: &[f64], tests: u32) {
    let result = chi_square(observed, expected);
    assert!(
        result.p_value >= corrected_significance(tests),
        "{what}: χ² = {:.1} with {} degrees of freedom comes by chance once in {:.1e}",
        result.statistic,
        result.degrees_of_freedom,
        1.0 / result.p_value
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{TestRng, must_fail};

    #[test]
    fn small_cells_are_pooled() {
        let result = chi_square(&[1, 0, 2, 3, 96], &[1.0, 1.0, 1.5, 2.5, 96.0]);
        // 1 + 1 + 1.5 + 2.5 are together.
        assert_eq!(result.degrees_of_freedom, 1);
        assert_eq!(result.statistic, 0.0);
        // What is left over goes to the last cell.
        assert_eq!(chi_square(&[6, 6, 1], &[6.0, 6.0, 1.0]).degrees_of_freedom, 1);
        assert_eq!(chi_square(&[], &[]).p_value, 1.0);
        assert_eq!(chi_square(&[1, 5], &[0.0, 6.0]).p_value, 0.0);
        assert_eq!(chi_square(&[0, 6], &[0.0, 6.0]).p_value, 1.0);
    }

    #[test]
    fn p_values_of_right_counts_are_uniform() {
        // Ten thousand throws of a die with 12 sides, 1000 times: a tenth of the p-values in each tenth.
        let mut rng = TestRng::new(11);
        let mut tenths = [0_u64; 10];
        for _ in 0..1000 {
            let mut counts = [0_u64; 12];
            for _ in 0..2000 {
                counts[rng.below(12) as usize] += 1;
            }
            let p_value = chi_square(&counts, &[2000.0 / 12.0; 12]).p_value;
            tenths[((p_value * 10.0) as usize).min(9)] += 1;
        }
        assert_counts("p-values", &tenths, &[100.0; 10], 1);
        // The twin: a die that has one side a fifth more often.
        let loaded: Vec<u64> = (0..12).map(|side| if side == 0 { 2400 } else { 2000 }).collect();
        must_fail("a loaded die", || assert_counts("die", &loaded, &[2000.0; 12], 1));
    }

    #[test]
    fn many_tests_are_each_stricter() {
        assert!((corrected_significance(1) - SIGNIFICANCE).abs() < 1e-15);
        assert!((corrected_significance(100) - 1e-5).abs() < 1e-8);
    }
}

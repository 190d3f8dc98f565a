//! The film: sums of a pixel's samples, exact, so that no order of adding or merging changes a bit.
//!
//! A sample is rounded once to a whole number of 2⁻³⁰, and sums are integers. That is finer than the steps of an `f32`
//! for every value above 2⁻⁷, far below what a display shows for the rest, and leaves room for thousands of samples at
//! the brightest value there is.

use snell_math::Rgb;

/// The value of one unit: 2⁻³⁰.
const UNIT: f64 = 1.0 / 1_073_741_824.0;
/// Samples beyond this radiance count as this much: 2²⁰, a thousand times the sun's disk in a picture of its sky.
const BRIGHTEST: f64 = 1_048_576.0;

/// The sum of the samples of one pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PixelSum {
    sum: [i64; 3],
    count: u32,
}

impl PixelSum {
    /// Adds a sample. One that is not finite counts as black; the result says whether it was.
    #[must_use = "samples that are not finite are to be counted"]
    pub fn add(&mut self, sample: Rgb) -> bool {
        self.count += 1;
        let finite = sample.is_finite();
        if finite {
            for (sum, component) in self.sum.iter_mut().zip(sample.to_array()) {
                let value = f64::from(component).clamp(-BRIGHTEST, BRIGHTEST);
                *sum = sum.saturating_add(round(value / UNIT));
            }
        }
        finite
    }

    /// The mean of a pixel that has this sample alone, and whether it is finite: what [`PixelSum::add`] and [`PixelSum::mean`] give,
    /// without a sum.
    #[inline]
    pub fn mean_of_one(sample: Rgb) -> (Rgb, bool) {
        if sample.is_finite() { (sample.map(mean_of_component), true) } else { (Rgb::BLACK, false) }
    }

    /// What a pixel of one sample holds, from its [`PixelSum::mean`]: nothing is lost on the way, since a sum that is finer than an
    /// `f32` is a small one, of less than 25 bits.
    pub fn of_one(mean: Rgb) -> Self {
        Self { sum: mean.to_array().map(|component| round(f64::from(component) / UNIT)), count: 1 }
    }

    /// Adds the samples of another part of the same pixel.
    pub fn merge(&mut self, other: &Self) {
        for (sum, more) in self.sum.iter_mut().zip(other.sum) {
            *sum = sum.saturating_add(more);
        }
        self.count += other.count;
    }

    /// How many samples it holds.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// The mean of the samples; black where there are none.
    pub fn mean(&self) -> Rgb {
        if self.count == 0 {
            return Rgb::BLACK;
        }
        let [r, g, b] = self.sum.map(|sum| (sum as f64 * UNIT / f64::from(self.count)) as f32);
        Rgb::new(r, g, b)
    }
}

/// Appends the [`PixelSum::mean_of_one`] of samples; false where one is not finite.
pub fn means_of_ones(samples: &[Rgb], means: &mut Vec<Rgb>) -> bool {
    let before = means.len();
    means.extend(samples.iter().map(|sample| sample.map(mean_of_component)));
    if samples.iter().fold(true, |finite, sample| finite & sample.is_finite()) {
        return true;
    }
    for (mean, sample) in means[before..].iter_mut().zip(samples).filter(|(_, sample)| !sample.is_finite()) {
        *mean = PixelSum::mean_of_one(*sample).0;
    }
    false
}

/// A component of a sample as its sum has it.
#[inline]
fn mean_of_component(component: f32) -> f32 {
    // Not `clamp`, which takes care of NaN.
    let value = f64::from(component);
    let value = if value < BRIGHTEST { value } else { BRIGHTEST };
    let value = if value > -BRIGHTEST { value } else { -BRIGHTEST };
    (rounded(value / UNIT) * UNIT) as f32
}

/// The nearest whole number, of two the even one, for magnitudes up to 2⁵⁰.
///
/// Adding a number whose last bit is worth one makes the addition itself round; there is an instruction for that on every
/// machine, which there is not for `round_ties_even`.
#[inline]
fn rounded(value: f64) -> f64 {
    const LAST_BIT_IS_ONE: f64 = 1.5 * (1_u64 << 52) as f64;
    value + LAST_BIT_IS_ONE - LAST_BIT_IS_ONE
}

/// As [`rounded`], as an integer.
#[inline]
fn round(value: f64) -> i64 {
    rounded(value) as i64
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn no_order_of_adding_or_merging_changes_a_bit(samples in prop::collection::vec(prop::array::uniform3(-2.0..1e6f32), 1..40), cut in 0..40usize) {
            let sum = |samples: &mut dyn Iterator<Item = &[f32; 3]>| {
                let mut pixel = PixelSum::default();
                for sample in samples {
                    assert!(pixel.add(Rgb::from(*sample)));
                }
                pixel
            };
            let forward = sum(&mut samples.iter());
            let backward = sum(&mut samples.iter().rev());
            let cut = cut.min(samples.len());
            let mut merged = sum(&mut samples[cut..].iter());
            merged.merge(&sum(&mut samples[..cut].iter()));
            prop_assert_eq!(forward, backward);
            prop_assert_eq!(forward, merged);
            let plain: f64 = samples.iter().map(|s| f64::from(s[0])).sum::<f64>() / samples.len() as f64;
            prop_assert!((f64::from(forward.mean().r) - plain).abs() <= 1e-7 * plain.abs().max(1.0));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn one_sample_is_known_by_its_mean(sample in prop::array::uniform3(prop_oneof![-2e6..2e6f32, -1e-6..1e-6f32, any::<f32>()])) {
            let mut pixel = PixelSum::default();
            let is_finite = pixel.add(Rgb::from(sample));
            prop_assert_eq!(PixelSum::of_one(pixel.mean()), pixel);
            let (mean, is_finite_too) = PixelSum::mean_of_one(Rgb::from(sample));
            prop_assert_eq!((mean, is_finite_too), (pixel.mean(), is_finite));
            let mut means = vec![Rgb::WHITE];
            prop_assert_eq!(means_of_ones(&[Rgb::BLACK, Rgb::from(sample)], &mut means), is_finite);
            prop_assert_eq!(means, [Rgb::WHITE, Rgb::BLACK, pixel.mean()]);
        }
    }

    #[test]
    fn what_is_not_finite_is_black_and_told() {
        let mut pixel = PixelSum::default();
        assert!(!pixel.add(Rgb::new(f32::NAN, 1.0, 1.0)));
        assert!(!pixel.add(Rgb::new(1.0, f32::INFINITY, 1.0)));
        assert!(pixel.add(Rgb::gray(3.0)));
        assert_eq!(pixel.mean(), Rgb::gray(1.0));
    }

    #[test]
    fn one_sample_comes_back_as_it_was() {
        for value in [0.0_f32, 1.0, 0.5, 0.123_456_79, 1234.567, -0.25] {
            let mut pixel = PixelSum::default();
            assert!(pixel.add(Rgb::gray(value)));
            assert_eq!(pixel.mean().r, value);
        }
    }
}

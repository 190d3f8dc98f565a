//! The bands into which a dispersive surface splits white light: a wavelength that is traced, and the colour it
//! carries.
//!
//! A ray of white light that meets a dispersive surface goes on as one ray for each band. The colour of a band is what
//! the CIE 1931 observer sees of equal energy in its wavelengths, in linear sRGB, with each channel scaled so that all
//! bands together are white. Spectral colours are outside the gamut, so some components are negative: they are kept,
//! because it is their sum over overlapping bands that is the right colour.
//!
//! Where the bands are: dispersion sets each band's image beside the next one's, and what must be small is the gap
//! between them where there is much colour to see. Deflection goes about as 1/λ² (Cauchy's law), so a band of width dλ
//! is 2λ⁻³ dλ wide in the picture; it holds the colour |r| + |g| + |b|. The density of bands is the geometric mean of
//! the two. Of the densities tried (equal steps in λ, in 1/λ², in colour, in luminance; exponents ⅓ and ½) it is the
//! one whose picture of a slit through a prism of N-BK7 or N-SF11 is nearest to the true one, or nearly so, from 8 to
//! 32 bands and for narrow and wide slits.

use super::{VISIBLE_NM, color_matching, xyz_to_linear_srgb};
use crate::Rgb;
use crate::dispersion::fraunhofer;

/// One band of wavelengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// The wavelength that stands for the band, in nanometres: the mean of its wavelengths by their colour content.
    pub wavelength_nm: f64,
    /// From where to where the band reaches, in nanometres.
    pub range_nm: [f64; 2],
    /// The share of white light that it carries, by channel. A multiple of 2⁻²⁰; may be negative.
    pub weight: Rgb,
}

/// White light, split into bands of ascending wavelength that cover the visible range.
///
/// The weights sum to exactly (1, 1, 1), added in any order, and every sum over some of them is exact too: all are
/// multiples of 2⁻²⁰ and no such sum reaches 16.
///
/// ```
/// use snell_math::{Rgb, spectrum::Bands};
/// let bands = Bands::new(16);
/// assert_eq!(bands.len(), 16);
/// assert_eq!(bands.iter().fold(Rgb::BLACK, |sum, band| sum + band.weight), Rgb::WHITE);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Bands {
    bands: Vec<Band>,
}

/// Which wavelength stands for a band.
#[derive(Clone, Copy)]
enum Place {
    /// The mean by colour content: the best for a band by itself.
    Mean,
    /// The middle by the density of bands: even over splits that are shifted against each other.
    Middle,
}

/// Weights are multiples of one over this.
const UNIT: f64 = 1_048_576.0;
/// Bins of one nanometre, which the bands are made of.
const BINS: usize = (VISIBLE_NM[1] - VISIBLE_NM[0]) as usize;

impl Bands {
    /// The most bands that white light is split into.
    pub const MAX: u32 = 64;

    /// Splits white light into `count` bands; 0 counts as 1, more than [`Self::MAX`] as that. A single band is white
    /// and stands at the sodium D line, where the classical index of refraction is given.
    #[must_use]
    pub fn new(count: u32) -> Self {
        if count <= 1 {
            let band = Band { wavelength_nm: fraunhofer::SODIUM_D, range_nm: VISIBLE_NM, weight: Rgb::WHITE };
            return Self { bands: vec![band] };
        }
        Self::split(count.min(Self::MAX), 0.0, Place::Mean, density)
    }

    /// A split for one of several samples whose mean is wanted: all borders between bands are moved towards violet by a share
    /// of a band, `shift` in [0, 1) (anything else counts as 0); what is left over at the red end is one band more. A band's
    /// wavelength is in its middle by the density of bands, so that the wavelengths of samples at even shifts are even
    /// too, and their mean is as good as that of many more bands.
    ///
    /// ```
    /// use snell_math::{Rgb, spectrum::Bands};
    /// let bands = Bands::shifted(8, 0.25);
    /// assert_eq!(bands.len(), 9);
    /// assert_eq!(bands.iter().fold(Rgb::BLACK, |sum, band| sum + band.weight), Rgb::WHITE);
    /// ```
    #[must_use]
    pub fn shifted(count: u32, shift: f64) -> Self {
        if count <= 1 {
            return Self::new(count);
        }
        let shift = if (0.0..1.0).contains(&shift) { shift } else { 0.0 };
        Self::split(count.min(Self::MAX), shift, Place::Middle, density)
    }

    /// How many there are, at least 1.
    #[expect(clippy::len_without_is_empty, reason = "there is always a band")]
    pub fn len(&self) -> usize {
        self.bands.len()
    }

    /// The bands in ascending order of wavelength.
    pub fn as_slice(&self) -> &[Band] {
        &self.bands
    }

    /// The bands in ascending order of wavelength.
    pub fn iter(&self) -> std::slice::Iter<'_, Band> {
        self.bands.iter()
    }

    /// Splits so that every band holds the same share of a density, which is given wavelength and spectral colour; with a
    /// shift, all but the first and the last.
    fn split(count: u32, shift: f64, place: Place, density: impl Fn(f64, [f64; 3]) -> f64) -> Self {
        let colors = spectral_colors();
        let wavelength = |position: f64| VISIBLE_NM[0] + position;

        // Running totals at the bins' borders: the density's, the colours', and the first moment of their content.
        let mut totals = [[0.0; 6]; BINS + 1];
        for (bin, color) in colors.iter().enumerate() {
            let middle = wavelength(bin as f64 + 0.5);
            let content = content(*color);
            let share = [density(middle, *color), color[0], color[1], color[2], content, content * middle];
            for (i, value) in share.iter().enumerate() {
                totals[bin + 1][i] = totals[bin][i] + value;
            }
        }

        // Where the running total of the density reaches a value, in bins from the violet end; a bin is taken as even.
        let position = |wanted: f64| {
            let bin = totals[1..BINS].partition_point(|total| total[0] < wanted);
            let (low, high) = (totals[bin][0], totals[bin + 1][0]);
            bin as f64 + if high > low { (wanted - low) / (high - low) } else { 1.0 }
        };
        let whole = totals[BINS];
        let quantum = |value: f64, of: f64| (value / of * UNIT).round();
        let last = if shift > 0.0 { count + 1 } else { count };
        let mut bands = Vec::with_capacity(last as usize);
        let (mut start, mut before) = (0.0, [0.0; 6]);
        for number in 1..=last {
            let wanted = whole[0] * (f64::from(number) - shift) / f64::from(count);
            let end = if number == last { BINS as f64 } else { position(wanted) };
            let bin = (end as usize).min(BINS - 1);
            let after: [f64; 6] =
                std::array::from_fn(|i| totals[bin][i] + (totals[bin + 1][i] - totals[bin][i]) * (end - bin as f64));
            // Rounding the running totals, not the weights, makes the weights sum to the last total: exactly one.
            let weight = |i: usize| ((quantum(after[i], whole[i]) - quantum(before[i], whole[i])) / UNIT) as f32;
            let represented = match place {
                Place::Mean => (after[5] - before[5]) / (after[4] - before[4]),
                Place::Middle => wavelength(position(0.5 * (before[0] + after[0]))),
            };
            bands.push(Band {
                wavelength_nm: represented.max(wavelength(start)).min(wavelength(end)),
                range_nm: [wavelength(start), wavelength(end)],
                weight: Rgb::new(weight(1), weight(2), weight(3)),
            });
            (start, before) = (end, after);
        }
        Self { bands }
    }
}

impl<'a> IntoIterator for &'a Bands {
    type Item = &'a Band;
    type IntoIter = std::slice::Iter<'a, Band>;
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

/// The density of bands over wavelength, given the colour there; see the top of this file.
fn density(wavelength_nm: f64, color: [f64; 3]) -> f64 {
    let deflection = 1e9 / (wavelength_nm * wavelength_nm * wavelength_nm);
    (content(color) * deflection).sqrt()
}

/// How much a spectral colour has to show, of either sign.
fn content(color: [f64; 3]) -> f64 {
    color[0].abs() + color[1].abs() + color[2].abs()
}

/// The colour of equal energy in each bin, in linear sRGB, each channel scaled to sum to one.
fn spectral_colors() -> [[f64; 3]; BINS] {
    let colors: [[f64; 3]; BINS] =
        std::array::from_fn(|bin| xyz_to_linear_srgb(color_matching(VISIBLE_NM[0] + bin as f64 + 0.5)));
    let mut sum = [0.0; 3];
    for color in &colors {
        for channel in 0..3 {
            sum[channel] += color[channel];
        }
    }
    colors.map(|color| std::array::from_fn(|channel| color[channel] / sum[channel]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::hash;

    /// True where the weights sum to one and every partial sum, in several orders, is exact.
    fn sums_exactly(weights: &[Rgb]) -> bool {
        let mut orders: Vec<Vec<Rgb>> = vec![weights.to_vec(), weights.iter().rev().copied().collect()];
        for seed in 0..8 {
            let mut keyed: Vec<_> = weights.iter().zip(0..).map(|(w, i)| (hash(seed, 0, 0, i, 0), *w)).collect();
            keyed.sort_by_key(|(key, _)| *key);
            orders.push(keyed.into_iter().map(|(_, w)| w).collect());
        }
        orders.iter().all(|order| {
            let (mut single, mut double) = (Rgb::BLACK, [0.0_f64; 3]);
            order.iter().all(|weight| {
                single += *weight;
                for (sum, w) in double.iter_mut().zip(weight.to_array()) {
                    *sum += f64::from(w);
                }
                single.to_array().map(f64::from) == double
            }) && single == Rgb::WHITE
        })
    }

    #[test]
    fn weights_sum_to_exactly_one_in_any_order() {
        for count in 1..=Bands::MAX {
            let weights: Vec<Rgb> = Bands::new(count).iter().map(|band| band.weight).collect();
            assert_eq!(weights.len(), count as usize);
            assert!(sums_exactly(&weights), "{count} bands");
        }
    }

    #[test]
    fn shifted_bands_sum_to_exactly_one_too_and_cover_the_same_range() {
        for count in [2, 3, 8, 16, Bands::MAX] {
            for shift in [0.0, 1e-9, 1.0 / 16.0, 0.5, 15.0 / 16.0, 0.999_999] {
                let bands = Bands::shifted(count, shift);
                let weights: Vec<Rgb> = bands.iter().map(|band| band.weight).collect();
                assert!(sums_exactly(&weights), "{count} bands shifted by {shift}");
                assert_eq!(bands.as_slice()[0].range_nm[0], VISIBLE_NM[0]);
                assert_eq!(bands.as_slice()[bands.len() - 1].range_nm[1], VISIBLE_NM[1]);
                for band in &bands {
                    let [low, high] = band.range_nm;
                    assert!(low <= band.wavelength_nm && band.wavelength_nm <= high, "{band:?}");
                }
                for pair in bands.as_slice().windows(2) {
                    assert_eq!(pair[0].range_nm[1], pair[1].range_nm[0]);
                }
            }
        }
        for odd in [1.0, -0.5, f64::NAN] {
            assert_eq!(Bands::shifted(8, odd), Bands::shifted(8, 0.0));
        }
    }

    #[test]
    fn the_mean_over_shifts_is_as_good_as_one_of_more_bands() {
        // A spectrum with a sharp edge, which few bands cannot see.
        let edge = |nm: f64| f64::from(u8::from(nm > 561.3));
        let mean_error = |count: u32, shifts: u32| {
            let mut sum = [0.0; 3];
            for shift in 0..shifts {
                for band in &Bands::shifted(count, f64::from(shift) / f64::from(shifts)) {
                    for (sum, weight) in sum.iter_mut().zip(band.weight.to_array()) {
                        *sum += f64::from(weight) * edge(band.wavelength_nm) / f64::from(shifts);
                    }
                }
            }
            let exact = spectral_colors().iter().enumerate().fold([0.0; 3], |sum, (bin, color)| {
                let seen = edge(VISIBLE_NM[0] + bin as f64 + 0.5);
                std::array::from_fn(|channel: usize| sum[channel] + color[channel] * seen)
            });
            sum.iter().zip(exact).fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs()))
        };
        assert!(mean_error(8, 16) < 0.03 && mean_error(8, 1) > 0.1, "{} {}", mean_error(8, 16), mean_error(8, 1));
    }

    #[test]
    fn inexact_weights_are_noticed() {
        // A tenth of white is no multiple of a power of two; and one unit more is one unit too much.
        assert!(!sums_exactly(&[Rgb::gray(0.1); 10]));
        let mut weights: Vec<Rgb> = Bands::new(16).iter().map(|band| band.weight).collect();
        weights[3].g += 1.0 / UNIT as f32;
        assert!(!sums_exactly(&weights));
    }

    #[test]
    fn bands_ascend_and_cover_the_visible_range() {
        for count in 2..=Bands::MAX {
            let bands = Bands::new(count);
            assert_eq!(bands.as_slice()[0].range_nm[0], VISIBLE_NM[0]);
            assert_eq!(bands.as_slice()[bands.len() - 1].range_nm[1], VISIBLE_NM[1]);
            for pair in bands.as_slice().windows(2) {
                assert_eq!(pair[0].range_nm[1], pair[1].range_nm[0]);
                assert!(pair[0].wavelength_nm < pair[1].wavelength_nm);
            }
            for band in &bands {
                assert!(band.range_nm[0] <= band.wavelength_nm && band.wavelength_nm <= band.range_nm[1], "{band:?}");
                assert!(!band.weight.is_black(), "{band:?}");
            }
        }
        assert_eq!(Bands::new(0), Bands::new(1));
        assert_eq!(Bands::new(u32::MAX), Bands::new(Bands::MAX));
        assert_eq!(Bands::new(1).as_slice()[0].wavelength_nm, 589.3);
    }

    /// Σ weight · s(λ) over the bands against the integral over the spectrum, the largest difference of a channel.
    fn quadrature_error(bands: &Bands, spectrum: impl Fn(f64) -> f64) -> f64 {
        let mut difference = [0.0; 3];
        for (bin, color) in spectral_colors().iter().enumerate() {
            for channel in 0..3 {
                difference[channel] -= color[channel] * spectrum(VISIBLE_NM[0] + bin as f64 + 0.5);
            }
        }
        for band in bands {
            for (sum, weight) in difference.iter_mut().zip(band.weight.to_array()) {
                *sum += f64::from(weight) * spectrum(band.wavelength_nm);
            }
        }
        difference.iter().fold(0.0, |worst: f64, d| worst.max(d.abs()))
    }

    #[test]
    fn bands_integrate_smooth_spectra() {
        let ramp = |nm: f64| (nm - 360.0) / 470.0;
        let hump = |nm: f64| 1.0 / (1.0 + ((nm - 560.0) / 60.0) * ((nm - 560.0) / 60.0));
        for (count, most) in [(8, 0.08), (16, 0.02), (32, 0.005), (64, 0.002)] {
            assert!(quadrature_error(&Bands::new(count), ramp) < most, "{count} bands, a ramp");
            assert!(quadrature_error(&Bands::new(count), hump) < most, "{count} bands, a hump");
        }
        // The twin: wavelengths set one band aside.
        let mut wrong = Bands::new(32);
        for i in 1..32 {
            wrong.bands[i - 1].wavelength_nm = wrong.bands[i].wavelength_nm;
        }
        assert!(quadrature_error(&wrong, ramp) > 0.005);
    }

    /// The picture of a white slit through a thin prism of N-BK7, its two edge colours 1 apart and the slit `slit`
    /// wide: the root mean square difference between what the bands give and what the spectrum gives.
    fn slit_error(bands: &Bands, slit: f64) -> f64 {
        let glass = crate::Dispersion::Sellmeier {
            constant: 0.0,
            terms: vec![(1.03961212, 0.00600069867), (0.231792344, 0.0200179144), (1.01046945, 103.560653)],
        };
        let (violet, red) = (glass.index(400.0), glass.index(700.0));
        let deflection = |nm: f64| (glass.index(nm) - red) / (violet - red);
        let spectrum: Vec<_> = spectral_colors()
            .iter()
            .enumerate()
            .map(|(bin, color)| (deflection(VISIBLE_NM[0] + bin as f64 + 0.5), *color))
            .collect();
        let split: Vec<_> =
            bands.iter().map(|b| (deflection(b.wavelength_nm), b.weight.to_array().map(f64::from))).collect();
        let color_at = |x: f64, rays: &[(f64, [f64; 3])]| {
            let mut sum = [0.0; 3];
            for (_, color) in rays.iter().filter(|(at, _)| (x - at).abs() < 0.5 * slit) {
                for channel in 0..3 {
                    sum[channel] += color[channel];
                }
            }
            sum
        };
        let squares: f64 = (-40..180)
            .map(|i| {
                let x = f64::from(i) / 100.0;
                let (a, b) = (color_at(x, &split), color_at(x, &spectrum));
                (0..3).map(|c| (a[c] - b[c]) * (a[c] - b[c])).sum::<f64>()
            })
            .sum();
        (squares / 660.0).sqrt()
    }

    #[test]
    fn a_prism_is_drawn_better_than_with_equal_steps_of_wavelength() {
        for count in [8, 16, 32] {
            let equal_steps =
                Bands::split(count, 0.0, Place::Mean, |nm, _| if (400.0..700.0).contains(&nm) { 1.0 } else { 1e-9 });
            let equal_luminance = Bands::split(count, 0.0, Place::Mean, |nm, _| color_matching(nm)[1]);
            for slit in [0.1, 0.3] {
                let ours = slit_error(&Bands::new(count), slit);
                assert!(ours < slit_error(&equal_steps, slit), "{count} bands, slit {slit}");
                assert!(ours < slit_error(&equal_luminance, slit), "{count} bands, slit {slit}");
            }
        }
    }
}

//! The sRGB transfer function (IEC 61966-2-1) as whole-number codes, fast: display-linear light in, 8 or 16 bit codes out.
//!
//! The reference is [`code_reference`]: the formula of `snell_math::color`, scaled and rounded to nearest. A `pow` for
//! every component would take a tenth of a small picture's time, so [`Encoder`] interpolates a table of the curve, and
//! asks the reference only where the interpolated value lies so near to the boundary of two codes that its error could
//! decide. For 8 bit codes, of which there are few, there is a table with the very numbers at which the reference's codes
//! change, see `transfer/bytes.rs`. Hence its codes are those of the reference for every `f32`; the tests hold it to that.

mod bytes;

use std::sync::LazyLock;

use snell_math::color::{linear_to_srgb, srgb_to_linear};
use snell_math::portable;

pub use bytes::ByteEncoder;

/// Knots of the table in one octave, as a power of two.
const KNOTS_LOG2: u32 = 9;
/// The first octave begins at 2^−9, below the end of the formula's straight part at 0.0031308.
const FIRST_EXPONENT: i32 = -9;
const OCTAVES: usize = 9;
const KNOTS: usize = OCTAVES << KNOTS_LOG2;
const FRACTION_BITS: u32 = 23 - KNOTS_LOG2;
const FIRST_BITS: u32 = ((127 + FIRST_EXPONENT) as u32) << 23;
/// Where the formula's straight part ends.
const STRAIGHT_END: f32 = 0.003_130_8;
/// More than the interpolated value can be away from the reference, on the scale of [0, 1]: the largest distance over
/// all `f32` is 1.8e−7.
const ERROR_BOUND: f64 = 2.5e-7;

/// The reference: light clipped to [0, 1] and encoded, times `max_code`, rounded to the nearest whole number. NaN is 0.
#[must_use]
pub fn code_reference(linear: f32, max_code: u16) -> u16 {
    // Rust converts NaN to 0.
    (f64::from(linear_to_srgb(linear.clamp(0.0, 1.0))) * f64::from(max_code) + 0.5) as u16
}

/// Display-linear light to codes from 0 to `max_code`.
#[derive(Clone, Copy, Debug)]
pub struct Encoder {
    table: Table,
    max_code: u16,
}

#[derive(Clone, Copy, Debug)]
enum Table {
    /// Of the curve at every knot, and how near to the boundary of two codes the interpolated value may decide.
    Curve { knots: &'static [f32], margin: f64 },
    /// Of the 8 bit codes.
    Bytes(ByteEncoder),
}

impl Encoder {
    /// For 8 bit codes give 255, for 16 bit codes 65535.
    #[must_use]
    pub fn new(max_code: u16) -> Self {
        let table = if max_code == u16::from(u8::MAX) {
            Table::Bytes(ByteEncoder::new())
        } else {
            Table::Curve { knots: &CURVE, margin: ERROR_BOUND * f64::from(max_code) }
        };
        Self { table, max_code }
    }

    /// The code of one component; exactly [`code_reference`].
    #[inline]
    #[must_use]
    pub fn code(&self, linear: f32) -> u16 {
        let (knots, margin) = match self.table {
            Table::Curve { knots, margin } => (knots, margin),
            Table::Bytes(encoder) => return encoder.code(linear).into(),
        };
        let max_code = f64::from(self.max_code);
        if linear > STRAIGHT_END && linear < 1.0 {
            let offset = linear.to_bits() - FIRST_BITS;
            let scaled = f64::from(interpolated(knots, offset)) * max_code + 0.5;
            let code = scaled as u16;
            let above_boundary = scaled - f64::from(code);
            if above_boundary > margin && above_boundary < 1.0 - margin {
                code
            } else {
                code_reference(linear, self.max_code)
            }
        } else if linear >= 1.0 {
            self.max_code
        } else if linear > 0.0 {
            // The straight part, in the reference's own operations.
            (f64::from(linear * 12.92) * max_code + 0.5) as u16
        } else {
            0
        }
    }
}

/// Tells whether two values differ visibly: whether `linear_to_srgb(high) - linear_to_srgb(low)`, both as
/// `snell_math::color` has them, is more than a threshold. It is exactly what the formula says, and seldom asks it.
///
/// ```
/// use snell_image::transfer::EncodedDifference;
/// let difference = EncodedDifference::new(0.03);
/// assert!(difference.is_exceeded(0.000, 0.003) && !difference.is_exceeded(0.500, 0.503));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct EncodedDifference {
    knots: &'static [f32],
    threshold: f32,
}

impl EncodedDifference {
    /// More than the difference of two interpolated values can be away from that of the reference's: two errors, and what
    /// subtraction rounds.
    const MARGIN: f32 = 1e-6;

    /// For a threshold between encoded values.
    #[must_use]
    pub fn new(threshold: f32) -> Self {
        Self { knots: &CURVE, threshold }
    }

    /// Whether two values, clipped to [0, 1], differ by more than the threshold; never where one is NaN.
    #[inline]
    #[must_use]
    pub fn is_exceeded(self, low: f32, high: f32) -> bool {
        let about = self.about(high) - self.about(low);
        if (about - self.threshold).abs() > Self::MARGIN {
            about > self.threshold
        } else {
            linear_to_srgb(high) - linear_to_srgb(low) > self.threshold
        }
    }

    /// The encoded value of a number in [0, 1], by the table where the curve is no straight line; else NaN.
    #[inline]
    fn about(self, linear: f32) -> f32 {
        if linear > STRAIGHT_END && linear < 1.0 {
            interpolated(self.knots, linear.to_bits() - FIRST_BITS)
        } else if linear <= STRAIGHT_END {
            linear * 12.92
        } else if linear == 1.0 {
            1.0
        } else {
            f32::NAN
        }
    }
}

/// The curve at a number, given by how many steps of `f32` it is above the first knot.
#[inline]
fn interpolated(knots: &[f32], offset: u32) -> f32 {
    let knot = (offset >> FRACTION_BITS) as usize;
    let fraction = (offset & ((1 << FRACTION_BITS) - 1)) as f32 / (1 << FRACTION_BITS) as f32;
    let [low, high] = [knots[knot], knots[knot + 1]];
    low + (high - low) * fraction
}

/// The curved part of the formula at every knot, continued below its end so that interpolation meets no kink.
static CURVE: LazyLock<Vec<f32>> = LazyLock::new(|| {
    (0..=KNOTS as u32)
        .map(|knot| {
            let linear = f64::from(f32::from_bits(FIRST_BITS + (knot << FRACTION_BITS)));
            (1.055 * portable::pow(linear, 1.0 / 2.4) - 0.055) as f32
        })
        .collect()
});

/// Scene-linear light of each of the codes 0 to `max_code`.
pub(crate) fn linear_table(max_code: u16) -> Vec<f32> {
    (0..=max_code).map(|code| srgb_to_linear(f32::from(code) / f32::from(max_code))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(linear: f32) {
        for max_code in [255, u16::MAX] {
            let code = Encoder::new(max_code).code(linear);
            assert_eq!(code, code_reference(linear, max_code), "{linear:e} in {max_code} codes");
        }
    }

    fn around(linear: f32, steps: i32) {
        for step in -steps..=steps {
            check(f32::from_bits(linear.to_bits().saturating_add_signed(step)));
        }
    }

    #[test]
    fn codes_are_the_references_around_every_boundary() {
        for code in 0..255_u16 {
            around(srgb_to_linear((f32::from(code) + 0.5) / 255.0), 200);
        }
        for code in 0..u16::MAX {
            around(srgb_to_linear((f32::from(code) + 0.5) / 65535.0), 2);
        }
    }

    #[test]
    fn codes_are_the_references_over_the_whole_line() {
        // Every 2311th float (a prime) from zero to infinity, both signs.
        for bits in (0..=f32::INFINITY.to_bits()).step_by(2311) {
            check(f32::from_bits(bits));
            check(-f32::from_bits(bits));
        }
        for special in [STRAIGHT_END, 1.0, f32::MIN_POSITIVE, 0.5_f32] {
            around(special, 500);
        }
        for special in [0.0, -0.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, 2.0] {
            check(special);
        }
    }

    /// All 2^30 floats in [0, 1], and how far the interpolation is away.
    #[test]
    #[ignore = "takes half a minute"]
    fn codes_are_the_references_for_every_float() {
        use rayon::prelude::*;
        let worst = (0..=1.0_f32.to_bits())
            .into_par_iter()
            .map(|bits| {
                let linear = f32::from_bits(bits);
                check(linear);
                if linear > STRAIGHT_END && linear < 1.0 {
                    (f64::from(interpolated(&CURVE, bits - FIRST_BITS)) - f64::from(linear_to_srgb(linear))).abs()
                } else {
                    0.0
                }
            })
            .reduce(|| 0.0, f64::max);
        assert!(worst < ERROR_BOUND, "the interpolation is up to {worst:e} away from the reference");
    }

    /// The first pair whose difference is judged otherwise than by the formula.
    fn first_misjudged(difference: EncodedDifference, threshold: f32) -> Option<(f32, f32)> {
        let special = [0.0, 1e-9, 0.003, STRAIGHT_END, STRAIGHT_END.next_up(), 0.0032, 0.5, 1.0_f32.next_down(), 1.0];
        let lows = special.into_iter().chain((0..600).map(|i| i as f32 / 613.0));
        let pairs = lows.flat_map(|low| {
            // Around the value that is just as far away as the threshold, and anywhere.
            let edge = srgb_to_linear((linear_to_srgb(low) + threshold).min(1.0));
            let around = (-30..30).map(move |step| f32::from_bits(edge.to_bits().saturating_add_signed(step)).min(1.0));
            around.chain((0..40).map(|i| i as f32 / 39.0)).chain(special).map(move |high| (low, high))
        });
        let plain = |(low, high): (f32, f32)| linear_to_srgb(high) - linear_to_srgb(low) > threshold;
        pairs.into_iter().find(|&pair| difference.is_exceeded(pair.0, pair.1) != plain(pair))
    }

    #[test]
    fn differences_are_judged_as_the_formula_says() {
        for threshold in [0.03, 0.2, 1e-4] {
            assert_eq!(first_misjudged(EncodedDifference::new(threshold), threshold), None);
        }
        let difference = EncodedDifference::new(0.03);
        assert!(!difference.is_exceeded(f32::NAN, 1.0) && !difference.is_exceeded(0.0, f32::NAN));
        assert!(difference.is_exceeded(0.5, f32::INFINITY) && difference.is_exceeded(0.5, 2.0));
        assert!(!difference.is_exceeded(f32::INFINITY, f32::NEG_INFINITY), "no samples at all");
    }

    #[test]
    fn a_difference_that_is_off_by_a_bit_would_be_seen() {
        assert!(first_misjudged(EncodedDifference::new(0.03), 0.03_f32.next_up()).is_some());
    }

    #[test]
    fn codes_survive_decoding_and_encoding() {
        for max_code in [255, u16::MAX] {
            let table = linear_table(max_code);
            for code in 0..=max_code {
                assert_eq!(Encoder::new(max_code).code(table[usize::from(code)]), code);
            }
        }
    }

    #[test]
    fn a_table_that_is_off_by_one_code_would_be_seen() {
        let wrong = |linear: f32| Encoder::new(255).code(linear + 2e-5);
        let seen = (0..255_u16)
            .map(|code| srgb_to_linear((f32::from(code) + 0.5) / 255.0) - 1e-5)
            .any(|linear| wrong(linear) != code_reference(linear, 255));
        assert!(seen);
    }
}

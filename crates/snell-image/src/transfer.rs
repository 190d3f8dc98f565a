//! The sRGB transfer function (IEC 61966-2-1) as whole-number codes, fast: display-linear light in, 8 or 16 bit codes out.
//!
//! The reference is [`code_reference`]: the formula of `snell_math::color`, scaled and rounded to nearest. A `pow` for
//! every component would take a tenth of a small picture's time, so [`Encoder`] interpolates a table of the curve, and
//! asks the reference only where the interpolated value lies so near to the boundary of two codes that its error could
//! decide. Hence its codes are those of the reference for every `f32`; the tests hold it to that.

use std::sync::LazyLock;

use snell_math::color::{linear_to_srgb, srgb_to_linear};
use snell_math::portable;

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
    curve: &'static [f32],
    max_code: u16,
    margin: f64,
}

impl Encoder {
    /// For 8 bit codes give 255, for 16 bit codes 65535.
    #[must_use]
    pub fn new(max_code: u16) -> Self {
        Self { curve: &CURVE, max_code, margin: ERROR_BOUND * f64::from(max_code) }
    }

    /// The code of one component; exactly [`code_reference`].
    #[inline]
    #[must_use]
    pub fn code(&self, linear: f32) -> u16 {
        let max_code = f64::from(self.max_code);
        if linear > STRAIGHT_END && linear < 1.0 {
            let offset = linear.to_bits() - FIRST_BITS;
            let knot = (offset >> FRACTION_BITS) as usize;
            let fraction = (offset & ((1 << FRACTION_BITS) - 1)) as f32 / (1 << FRACTION_BITS) as f32;
            let [low, high] = [self.curve[knot], self.curve[knot + 1]];
            let scaled = f64::from(low + (high - low) * fraction) * max_code + 0.5;
            let code = scaled as u16;
            let above_boundary = scaled - f64::from(code);
            if above_boundary > self.margin && above_boundary < 1.0 - self.margin {
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
        let encoder = Encoder::new(u16::MAX);
        let worst = (0..=1.0_f32.to_bits())
            .into_par_iter()
            .map(|bits| {
                let linear = f32::from_bits(bits);
                check(linear);
                let reference = linear_to_srgb(linear);
                if linear > STRAIGHT_END && linear < 1.0 {
                    let offset = bits - FIRST_BITS;
                    let knot = (offset >> FRACTION_BITS) as usize;
                    let fraction = (offset & ((1 << FRACTION_BITS) - 1)) as f32 / (1 << FRACTION_BITS) as f32;
                    let [low, high] = [encoder.curve[knot], encoder.curve[knot + 1]];
                    (f64::from(low + (high - low) * fraction) - f64::from(reference)).abs()
                } else {
                    0.0
                }
            })
            .reduce(|| 0.0, f64::max);
        assert!(worst < ERROR_BOUND, "the interpolation is up to {worst:e} away from the reference");
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

//! The sRGB transfer function (IEC 61966-2-1) as whole-number codes, fast: display-linear light in, 8 or 16 bit codes out.
//!
//! The reference is [`code_reference`]: the formula of `snell_math::color`, scaled and rounded to nearest. A `pow` for
//! every component would take a tenth of a small picture's time, so [`Encoder`] interpolates a table of the curve, and
//! asks the reference only where the interpolated value lies so near to the boundary of two codes that its error could
//! decide. For 8 bit codes, of which there are few, there is a table with the very numbers at which the reference's codes
//! change, see [`bytes`]. Hence its codes are those of the reference for every `f32`; the tests hold it to that.

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

//! 8 bit sRGB codes, many at a time and straight into bytes.
//!
//! The numbers from 2^−13, below which all codes are zero, up to one are cut into 128 pieces an octave, so short that there is at
//! most one boundary between two codes in a piece. What the table says of a piece is one whole number: the code at its
//! beginning times 2^16, and 2^16 less the place of the boundary, so that adding a number's place in its piece carries into the
//! code from the boundary on. A piece has 2^16 places, for that many `f32` are in it. The idea is Fabian Giesen's (2012,
//! "float->sRGB8 conversion"), whose table has a slope instead and so is not exact everywhere.

use std::sync::LazyLock;

use snell_math::color::srgb_to_linear;

use super::code_reference;

/// Everything below 2^−13 has code 0: 2^−13 · 12.92 · 255 is 0.402.
const FIRST_EXPONENT: i32 = -13;
const OCTAVES: u32 = 13;
/// Pieces in one octave, as a power of two.
const PIECES_LOG2: u32 = 7;
/// Places in a piece, as a power of two.
const PLACE_BITS: u32 = 23 - PIECES_LOG2;
const PLACES: u32 = 1 << PLACE_BITS;
const PIECES: u32 = OCTAVES << PIECES_LOG2;
const FIRST_BITS: u32 = ((127 + FIRST_EXPONENT) as u32) << 23;

/// Display-linear light to 8 bit sRGB codes: exactly [`code_reference`].
///
/// ```
/// use snell_image::transfer::{ByteEncoder, code_reference};
/// let light = [0.0, 0.001, 0.5, 1.0, 7.0, f32::NAN];
/// let mut codes = [0; 6];
/// ByteEncoder::new().encode(&light, 0.5, &mut codes);
/// assert_eq!(codes, light.map(|light| code_reference(light * 0.5, 255) as u8));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ByteEncoder {
    pieces: &'static [u32],
    has_avx2: bool,
}

impl Default for ByteEncoder {
    fn default() -> Self {
        Self::new()
    }
}

impl ByteEncoder {
    /// By the best instructions that the machine has; the codes do not depend on them.
    #[must_use]
    pub fn new() -> Self {
        #[cfg(target_arch = "x86_64")]
        let has_avx2 = is_x86_feature_detected!("avx2");
        #[cfg(not(target_arch = "x86_64"))]
        let has_avx2 = false;
        Self { pieces: &TABLE, has_avx2 }
    }

    /// The code of one component.
    #[inline]
    #[must_use]
    pub fn code(self, linear: f32) -> u8 {
        // NaN is not above the first number.
        let first = f32::from_bits(FIRST_BITS);
        let bits = (if linear > first { linear } else { first }).min(1.0).to_bits() - FIRST_BITS;
        ((self.pieces[(bits >> PLACE_BITS) as usize] + bits % PLACES) >> 16) as u8
    }

    /// The codes of components times a factor, as many as there are of both.
    pub fn encode(self, linear: &[f32], factor: f32, codes: &mut [u8]) {
        let count = linear.len().min(codes.len());
        let (linear, codes) = (&linear[..count], &mut codes[..count]);
        #[cfg(target_arch = "x86_64")]
        let done = if self.has_avx2 {
            // SAFETY: the machine has AVX2.
            unsafe { avx2::encode(self.pieces, linear, factor, codes) }
        } else {
            0
        };
        #[cfg(not(target_arch = "x86_64"))]
        let done = 0;
        for (&linear, code) in linear[done..].iter().zip(&mut codes[done..]) {
            *code = self.code(linear * factor);
        }
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use std::arch::x86_64::*;

    use super::{FIRST_BITS, PIECES, PLACE_BITS, PLACES};

    /// Components of one step: as many bytes as a register has.
    const STEP: usize = 32;

    /// Encodes as many whole steps as there are, and says how many components that were.
    #[target_feature(enable = "avx2")]
    pub fn encode(pieces: &[u32], linear: &[f32], factor: f32, codes: &mut [u8]) -> usize {
        assert!(pieces.len() > PIECES as usize, "the table has a piece for one as well");
        let factor = _mm256_set1_ps(factor);
        // The eight codes, as 32 bit numbers, of eight components.
        let eight = |linear: &[f32; 8]| {
            // SAFETY: eight numbers are there to be read.
            let linear = unsafe { _mm256_loadu_ps(linear.as_ptr()) };
            let first = _mm256_set1_epi32(FIRST_BITS as i32);
            // Of a number and NaN, this instruction gives the second.
            let scaled = _mm256_max_ps(_mm256_mul_ps(linear, factor), _mm256_castsi256_ps(first));
            let clipped = _mm256_min_ps(scaled, _mm256_set1_ps(1.0));
            let bits = _mm256_sub_epi32(_mm256_castps_si256(clipped), first);
            let piece = _mm256_srli_epi32::<{ PLACE_BITS as i32 }>(bits);
            // SAFETY: numbers from the first to one have pieces from 0 to `PIECES`, which are in the table.
            let piece = unsafe { _mm256_i32gather_epi32::<4>(pieces.as_ptr().cast(), piece) };
            let place = _mm256_and_si256(bits, _mm256_set1_epi32(PLACES as i32 - 1));
            _mm256_srli_epi32::<16>(_mm256_add_epi32(piece, place))
        };
        let (linear, _) = linear.as_chunks::<STEP>();
        let (codes, _) = codes.as_chunks_mut::<STEP>();
        let mut done = 0;
        for (linear, codes) in linear.iter().zip(codes) {
            let (eights, _) = linear.as_chunks::<8>();
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| eight(&eights[i]));
            // Packing works in each half of a register by itself; the order is put right at the end.
            let packed = _mm256_packus_epi16(_mm256_packus_epi32(a, b), _mm256_packus_epi32(c, d));
            let ordered = _mm256_permutevar8x32_epi32(packed, _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7));
            // SAFETY: 32 bytes are there to be written.
            unsafe { _mm256_storeu_si256(codes.as_mut_ptr().cast(), ordered) };
            done += STEP;
        }
        done
    }
}

/// The pieces from 2^−13 to one, and one more that begins at one.
static TABLE: LazyLock<Vec<u32>> = LazyLock::new(|| {
    let byte = |bits| u32::from(code_reference(f32::from_bits(bits), u16::from(u8::MAX)));
    // The first number of each code, found from near where the inverse of the formula has it.
    let first_of = |code: u32| {
        let mut first = srgb_to_linear((code as f32 - 0.5) / 255.0).to_bits();
        while byte(first) < code {
            first += 1;
        }
        while byte(first - 1) >= code {
            first -= 1;
        }
        first
    };
    let mut code = 0;
    let mut next = first_of(1);
    let mut table = Vec::with_capacity(PIECES as usize + 1);
    for piece in 0..=PIECES {
        let begin = FIRST_BITS + (piece << PLACE_BITS);
        while next <= begin {
            code += 1;
            next = if code < 255 { first_of(code + 1) } else { u32::MAX };
        }
        // No carry where the boundary is in a later piece.
        table.push((code << 16) + PLACES.saturating_sub(next - begin));
    }
    table
});

#[cfg(test)]
mod tests {
    use super::*;

    /// All ways that this machine has.
    fn encoders() -> Vec<ByteEncoder> {
        let best = ByteEncoder::new();
        if best.has_avx2 { vec![best, ByteEncoder { has_avx2: false, ..best }] } else { vec![best] }
    }

    fn reference(linear: f32) -> u8 {
        code_reference(linear, 255) as u8
    }

    /// The first number whose code differs from the reference's, of some numbers.
    fn first_wrong(encoder: ByteEncoder, linear: &[f32]) -> Option<f32> {
        let mut codes = vec![1; linear.len()];
        encoder.encode(linear, 1.0, &mut codes);
        let wrong = |(linear, code): (&f32, &u8)| *code != reference(*linear) || *code != encoder.code(*linear);
        linear.iter().zip(&codes).find(|&pair| wrong(pair)).map(|(linear, _)| *linear)
    }

    fn around_boundaries() -> Vec<f32> {
        let boundaries = (0..255_u16).map(|code| srgb_to_linear((f32::from(code) + 0.5) / 255.0).to_bits());
        boundaries.flat_map(|bits| (bits - 40..bits + 40).map(f32::from_bits)).collect()
    }

    #[test]
    fn codes_are_the_references_by_all_instructions() {
        let mut linear = around_boundaries();
        linear.extend((0..=f32::INFINITY.to_bits()).step_by(9973).map(f32::from_bits));
        linear.extend((0..=f32::INFINITY.to_bits()).step_by(99_991).map(|bits| -f32::from_bits(bits)));
        linear.extend([0.0, -0.0, f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, 1.0, 2.0]);
        // Around every border of two pieces.
        let borders = (0..=PIECES).map(|piece| FIRST_BITS + (piece << PLACE_BITS));
        linear.extend(borders.flat_map(|bits| [bits - 1, bits, bits + 1]).map(f32::from_bits));
        for encoder in encoders() {
            assert_eq!(first_wrong(encoder, &linear), None, "{:?}", encoder.has_avx2);
            // Any length and any place.
            for length in 0..70 {
                assert_eq!(first_wrong(encoder, &linear[length..][..length]), None);
            }
        }
    }

    #[test]
    fn a_boundary_that_is_off_by_one_number_would_be_seen() {
        for encoder in encoders() {
            for wrong in [-1_i32, 1] {
                let mut pieces = encoder.pieces.to_vec();
                let piece = pieces.iter_mut().find(|piece| **piece % PLACES > 1 && **piece >> 16 == 77).unwrap();
                *piece = piece.checked_add_signed(wrong).unwrap();
                let planted = ByteEncoder { pieces: pieces.leak(), ..encoder };
                assert!(first_wrong(planted, &around_boundaries()).is_some());
            }
        }
    }

    #[test]
    fn the_factor_is_applied_before_clipping() {
        let linear: Vec<f32> = (0..100).map(|i| i as f32 * 0.03).collect();
        for encoder in encoders() {
            let mut codes = [0; 100];
            encoder.encode(&linear, 0.37, &mut codes);
            assert!(linear.iter().zip(codes).all(|(linear, code)| code == reference(linear * 0.37)));
        }
    }

    /// All floats in [0, 1], by all instructions.
    #[test]
    #[ignore = "takes half a minute"]
    fn codes_are_the_references_for_every_float() {
        use rayon::prelude::*;
        const MANY: u32 = 1 << 16;
        (0..=1.0_f32.to_bits() / MANY).into_par_iter().for_each(|part| {
            let linear: Vec<f32> = (part * MANY..(part + 1) * MANY).map(f32::from_bits).collect();
            for encoder in encoders() {
                assert_eq!(first_wrong(encoder, &linear), None);
            }
        });
    }
}

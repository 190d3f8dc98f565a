//! 8 bit sRGB codes, many at a time and straight into bytes.
//!
//! The numbers from 2^−13, below which all codes are zero, up to one are cut into 128 pieces an octave, so short that there is at
//! most one boundary between two codes in a piece. What the table says of a piece is one whole number: the code at its
//! beginning times 2^16, and 2^16 less the place of the boundary, so that adding a number's place in its piece carries into the
//! code from the boundary on. A piece has 2^16 places, for that many `f32` are in it. The idea is Fabian Giesen's (2012,
//! "float->sRGB8 conversion"), whose table has a slope instead and so is not exact everywhere.

use std::sync::LazyLock;

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

/// Display-linear light to 8 bit sRGB codes: exactly [`code_reference`](super::code_reference).
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

/// The first number of each code from 1 to 255, as bits. To find them anew takes longer than to start a process.
#[rustfmt::skip]
const FIRSTS: [u32; 255] = [
    0x391f22b4, 0x39eeb40e, 0x3a46eb61, 0x3a8b3e5d, 0x3ab3070b, 0x3adacfb7, 0x3b014c32, 0x3b153089, 0x3b2914df, 0x3b3cf936,
    0x3b50f2d1, 0x3b65fb9a, 0x3b7c3404, 0x3b89d05f, 0x3b962333, 0x3ba314be, 0x3bb0a731, 0x3bbedcb7, 0x3bcdb76c, 0x3bdd3966,
    0x3bed64ae, 0x3bfe3b44, 0x3c07df90, 0x3c10f919, 0x3c1a6b32, 0x3c2436c7, 0x3c2e5cc7, 0x3c38de19, 0x3c43bba3, 0x3c4ef646,
    0x3c5a8ee2, 0x3c668654, 0x3c72dd74, 0x3c7f9512, 0x3c865703, 0x3c8d1490, 0x3c940396, 0x3c9b247c, 0x3ca277a8, 0x3ca9fd79,
    0x3cb1b654, 0x3cb9a299, 0x3cc1c2a9, 0x3cca16e3, 0x3cd29fa4, 0x3cdb5d4d, 0x3ce45034, 0x3ced78b7, 0x3cf6d72f, 0x3d0035fc,
    0x3d051bb6, 0x3d0a1cee, 0x3d0f39d1, 0x3d14728a, 0x3d19c745, 0x3d1f382c, 0x3d24c56a, 0x3d2a6f24, 0x3d303586, 0x3d3618b9,
    0x3d3c18e6, 0x3d423633, 0x3d4870cb, 0x3d4ec8d3, 0x3d553e73, 0x3d5bd1d3, 0x3d628319, 0x3d69526a, 0x3d703fee, 0x3d774bce,
    0x3d7e7627, 0x3d82df92, 0x3d869374, 0x3d8a56cc, 0x3d8e29ad, 0x3d920c28, 0x3d95fe50, 0x3d9a0036, 0x3d9e11ed, 0x3da23385,
    0x3da66510, 0x3daaa6a1, 0x3daef847, 0x3db35a16, 0x3db7cc1c, 0x3dbc4e6c, 0x3dc0e115, 0x3dc5842a, 0x3dca37ba, 0x3dcefbd6,
    0x3dd3d08f, 0x3dd8b5f5, 0x3dddac19, 0x3de2b30a, 0x3de7cad9, 0x3decf395, 0x3df22d4f, 0x3df7781a, 0x3dfcd3ff, 0x3e012088,
    0x3e03dfaf, 0x3e06a77c, 0x3e0977f7, 0x3e0c5127, 0x3e0f3314, 0x3e121dc6, 0x3e151144, 0x3e180d95, 0x3e1b12c2, 0x3e1e20d1,
    0x3e2137cb, 0x3e2457b7, 0x3e27809a, 0x3e2ab27c, 0x3e2ded67, 0x3e313160, 0x3e347e6f, 0x3e37d49d, 0x3e3b33ed, 0x3e3e9c68,
    0x3e420e14, 0x3e4588fa, 0x3e490d21, 0x3e4c9a8f, 0x3e50314b, 0x3e53d15c, 0x3e577ac9, 0x3e5b2d99, 0x3e5ee9d6, 0x3e62af80,
    0x3e667ea1, 0x3e6a5740, 0x3e6e3967, 0x3e722517, 0x3e761a57, 0x3e7a1931, 0x3e7e21aa, 0x3e8119e5, 0x3e8327ca, 0x3e853a89,
    0x3e875224, 0x3e896ea0, 0x3e8b8ffe, 0x3e8db644, 0x3e8fe172, 0x3e92118d, 0x3e944698, 0x3e968097, 0x3e98bf8b, 0x3e9b0379,
    0x3e9d4c63, 0x3e9f9a4d, 0x3ea1ed3a, 0x3ea4452d, 0x3ea6a228, 0x3ea90430, 0x3eab6b45, 0x3eadd76e, 0x3eb048ab, 0x3eb2bf02,
    0x3eb53a75, 0x3eb7bb04, 0x3eba40b5, 0x3ebccb88, 0x3ebf5b85, 0x3ec1f0a9, 0x3ec48afd, 0x3ec72a7f, 0x3ec9cf35, 0x3ecc7920,
    0x3ecf2845, 0x3ed1dca5, 0x3ed49644, 0x3ed75523, 0x3eda1949, 0x3edce2b4, 0x3edfb16b, 0x3ee2856c, 0x3ee55ec0, 0x3ee83d64,
    0x3eeb2160, 0x3eee0ab2, 0x3ef0f961, 0x3ef3ed6c, 0x3ef6e6da, 0x3ef9e5a9, 0x3efce9e1, 0x3efff37e, 0x3f018147, 0x3f030b84,
    0x3f049879, 0x3f062829, 0x3f07ba94, 0x3f094fbc, 0x3f0ae7a1, 0x3f0c8246, 0x3f0e1fac, 0x3f0fbfd4, 0x3f1162bf, 0x3f130870,
    0x3f14b0e6, 0x3f165c24, 0x3f180a2a, 0x3f19bafb, 0x3f1b6e97, 0x3f1d2500, 0x3f1ede37, 0x3f209a3d, 0x3f225914, 0x3f241abd,
    0x3f25df39, 0x3f27a68a, 0x3f2970b0, 0x3f2b3dae, 0x3f2d0d83, 0x3f2ee035, 0x3f30b5c0, 0x3f328e26, 0x3f34696b, 0x3f36478e,
    0x3f382891, 0x3f3a0c75, 0x3f3bf33c, 0x3f3ddce7, 0x3f3fc977, 0x3f41b8ed, 0x3f43ab4a, 0x3f45a090, 0x3f4798c1, 0x3f4993dc,
    0x3f4b91e5, 0x3f4d92da, 0x3f4f96bf, 0x3f519d93, 0x3f53a75a, 0x3f55b412, 0x3f57c3bf, 0x3f59d660, 0x3f5bebf8, 0x3f5e0487,
    0x3f60200f, 0x3f623e91, 0x3f64600f, 0x3f668486, 0x3f68abfe, 0x3f6ad671, 0x3f6d03e8, 0x3f6f345b, 0x3f7167d5, 0x3f739e4d,
    0x3f75d7cf, 0x3f781452, 0x3f7a53e0, 0x3f7c9671, 0x3f7edc11,
];

/// The pieces from 2^−13 to one, and one more that begins at one.
static TABLE: LazyLock<Vec<u32>> = LazyLock::new(|| {
    let mut firsts = FIRSTS.into_iter();
    let mut code = 0;
    let mut next = firsts.next().unwrap_or(u32::MAX);
    let mut table = Vec::with_capacity(PIECES as usize + 1);
    for piece in 0..=PIECES {
        let begin = FIRST_BITS + (piece << PLACE_BITS);
        while next <= begin {
            code += 1;
            next = firsts.next().unwrap_or(u32::MAX);
        }
        // No carry where the boundary is in a later piece.
        table.push((code << 16) + PLACES.saturating_sub(next - begin));
    }
    table
});

#[cfg(test)]
mod tests {
    use snell_math::color::srgb_to_linear;

    use super::super::code_reference;
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
    fn the_first_numbers_are_the_references() {
        let byte = |bits| usize::from(reference(f32::from_bits(bits)));
        // From near where the inverse of the formula has it.
        let first_of = |code: usize| {
            let mut first = srgb_to_linear((code as f32 - 0.5) / 255.0).to_bits();
            while byte(first) < code {
                first += 1;
            }
            while byte(first - 1) >= code {
                first -= 1;
            }
            first
        };
        let firsts: Vec<u32> = (1..=255).map(first_of).collect();
        assert!(firsts == FIRSTS, "they should be {firsts:#x?}");
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

//! Lanes by the instructions of x86-64: eight `f64` in one register with AVX-512, in two with AVX2.
//!
//! Safety, here once for all: the types of this file are known outside only as a type parameter of [`super::Work::run`], which
//! [`super::dispatch`] calls with them after it has found that the machine has the instructions. So wherever a method of theirs
//! runs, its instructions are there.

use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::OnceLock;

use super::{Bits, Eight, End, Floats, Lanes, WIDTH, Work};

/// Whether the machine has what [`Eight256`] needs.
#[inline]
pub fn has_avx2() -> bool {
    static HAS: OnceLock<bool> = OnceLock::new();
    *HAS.get_or_init(|| {
        is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") && is_x86_feature_detected!("bmi2")
    })
}

/// Whether the machine has what [`Eight512`] needs.
#[inline]
pub fn has_avx512() -> bool {
    static HAS: OnceLock<bool> = OnceLock::new();
    *HAS.get_or_init(|| {
        is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512bw")
            && has_avx2()
    })
}

/// See [`Lanes::product_error`].
#[expect(clippy::disallowed_methods, reason = "what comes of it is exact, so it is the same number on all machines")]
#[inline(always)]
fn fused_error(a: f64, b: f64, product: f64) -> f64 {
    a.mul_add(b, -product)
}

/// Eight `f64` in one register of 512 bits.
#[derive(Clone, Copy, Debug)]
pub struct Eight512(__m512d);

/// Eight `f32` in a register of 256 bits, with masks of AVX-512.
#[derive(Clone, Copy, Debug)]
pub struct Floats512(__m256);

/// Eight `f64` in two registers of 256 bits.
#[derive(Clone, Copy, Debug)]
pub struct Eight256(__m256d, __m256d);

/// Eight `f32` in a register of 256 bits.
#[derive(Clone, Copy, Debug)]
pub struct Floats256(__m256);

/// Implements an operator by an expression that may use the instructions, see the safety note at the top of the file.
macro_rules! operator {
    ($type:ident, $trait:ident, $method:ident, |$a:ident, $b:ident| $body:expr) => {
        impl $trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let ($a, $b) = (self, other);
                // SAFETY: the instructions are there, see the top of the file.
                unsafe { $body }
            }
        }
    };
}

operator!(Eight512, Add, add, |a, b| Self(_mm512_add_pd(a.0, b.0)));
operator!(Eight512, Sub, sub, |a, b| Self(_mm512_sub_pd(a.0, b.0)));
operator!(Eight512, Mul, mul, |a, b| Self(_mm512_mul_pd(a.0, b.0)));
operator!(Eight512, Div, div, |a, b| Self(_mm512_div_pd(a.0, b.0)));
operator!(Eight256, Add, add, |a, b| Self(_mm256_add_pd(a.0, b.0), _mm256_add_pd(a.1, b.1)));
operator!(Eight256, Sub, sub, |a, b| Self(_mm256_sub_pd(a.0, b.0), _mm256_sub_pd(a.1, b.1)));
operator!(Eight256, Mul, mul, |a, b| Self(_mm256_mul_pd(a.0, b.0), _mm256_mul_pd(a.1, b.1)));
operator!(Eight256, Div, div, |a, b| Self(_mm256_div_pd(a.0, b.0), _mm256_div_pd(a.1, b.1)));

macro_rules! float_operators {
    ($($type:ident),*) => {
        $(operator!($type, Add, add, |a, b| Self(_mm256_add_ps(a.0, b.0)));
        operator!($type, Sub, sub, |a, b| Self(_mm256_sub_ps(a.0, b.0)));
        operator!($type, Mul, mul, |a, b| Self(_mm256_mul_ps(a.0, b.0)));
        operator!($type, Div, div, |a, b| Self(_mm256_div_ps(a.0, b.0)));
        impl Neg for $type {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                // SAFETY: the instructions are there, see the top of the file.
                unsafe { Self(_mm256_xor_ps(self.0, _mm256_set1_ps(-0.0))) }
            }
        })*
    };
}
float_operators!(Floats512, Floats256);

impl Neg for Eight512 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: the instructions are there, see the top of the file.
        unsafe { Self(_mm512_xor_pd(self.0, _mm512_set1_pd(-0.0))) }
    }
}

impl Neg for Eight256 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: the instructions are there, see the top of the file.
        unsafe {
            let sign = _mm256_set1_pd(-0.0);
            Self(_mm256_xor_pd(self.0, sign), _mm256_xor_pd(self.1, sign))
        }
    }
}

impl Lanes for Eight512 {
    const COUNT: usize = WIDTH;
    type Floats = Floats512;
    type Eight = Floats512;

    #[inline(always)]
    fn stage<W: Work>(work: W) -> W::Output {
        #[inline(never)]
        #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
        fn with_instructions<W: Work>(work: W) -> W::Output {
            work.run::<Eight512>()
        }
        // SAFETY: the instructions are there, see the top of the file; every machine with AVX2 counts bits.
        unsafe { with_instructions(work) }
    }
    #[inline(always)]
    fn product_error(a: f64, b: f64, product: f64) -> f64 {
        fused_error(a, b, product)
    }
    #[inline(always)]
    fn product_errors(self, other: Self, product: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm512_fmsub_pd(self.0, other.0, product.0)) }
    }
    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm512_set1_pd(value)) }
    }
    #[inline(always)]
    fn load(row: &[f64; WIDTH], _: usize) -> Self {
        // SAFETY: as above; the row has eight numbers.
        unsafe { Self(_mm512_loadu_pd(row.as_ptr())) }
    }
    #[inline(always)]
    fn store(self, row: &mut [f64; WIDTH], _: usize) {
        // SAFETY: as above; the row has eight places.
        unsafe { _mm512_storeu_pd(row.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm512_sqrt_pd(self.0)) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm512_abs_pd(self.0)) }
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        // SAFETY: as above.
        unsafe {
            let minus = _mm512_set1_pd(-0.0);
            Self(_mm512_or_pd(_mm512_andnot_pd(minus, self.0), _mm512_and_pd(minus, sign.0)))
        }
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Bits {
        // SAFETY: as above.
        unsafe { Bits(_mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0)) }
    }
    #[inline(always)]
    fn le(self, other: Self) -> Bits {
        // SAFETY: as above.
        unsafe { Bits(_mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, other.0)) }
    }
    #[inline(always)]
    fn same(self, other: Self) -> Bits {
        // SAFETY: as above.
        unsafe { Bits(_mm512_cmp_pd_mask::<_CMP_EQ_OQ>(self.0, other.0)) }
    }
    #[inline(always)]
    fn or_where_not(self, bits: Bits, other: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm512_mask_blend_pd(bits.0, other.0, self.0)) }
    }
    #[inline(always)]
    fn to_floats(self) -> Floats512 {
        // SAFETY: as above.
        unsafe { Floats512(_mm512_cvtpd_ps(self.0)) }
    }
    #[inline(always)]
    fn from_floats(floats: Floats512) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm512_cvtps_pd(floats.0)) }
    }
    #[inline(always)]
    fn floor(self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm512_roundscale_pd::<{ _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC }>(self.0)) }
    }
    #[inline(always)]
    fn exponent(self) -> Self {
        // SAFETY: as above.
        unsafe {
            let field = _mm512_srli_epi64::<53>(_mm512_slli_epi64::<1>(_mm512_castpd_si512(self.0)));
            Self(_mm512_sub_pd(_mm512_cvtepi64_pd(field), _mm512_set1_pd(1023.0)))
        }
    }
    #[inline(always)]
    fn times_power_of_two(self, power: Self) -> Self {
        // SAFETY: as above.
        unsafe {
            let field = _mm512_add_epi64(_mm512_cvtpd_epi64(power.0), _mm512_set1_epi64(1023));
            Self(_mm512_mul_pd(self.0, _mm512_castsi512_pd(_mm512_slli_epi64::<52>(field))))
        }
    }
    // The instructions give their second operand where neither is larger, or one is NaN.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm512_max_pd(other.0, self.0)) }
    }
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm512_min_pd(other.0, self.0)) }
    }
    #[inline(always)]
    fn append(self, end: End, [first, second]: [&mut [f64; WIDTH]; 2]) {
        // SAFETY: as above; the rows have eight places.
        unsafe {
            let (sources, [to_first, to_second]) = moves(end);
            let moved = _mm512_permutexvar_pd(sources, self.0);
            _mm512_mask_storeu_pd(first.as_mut_ptr(), to_first, moved);
            if to_second != 0 {
                _mm512_mask_storeu_pd(second.as_mut_ptr(), to_second, moved);
            }
        }
    }
    #[inline(always)]
    fn append_floats(floats: Floats512, end: End, [first, second]: [&mut [f32; WIDTH]; 2]) {
        // SAFETY: as above; the rows have eight places.
        unsafe {
            let (sources, [to_first, to_second]) = moves(end);
            let moved = _mm256_permutexvar_ps(_mm512_cvtepi64_epi32(sources), floats.0);
            _mm256_mask_storeu_ps(first.as_mut_ptr(), to_first, moved);
            if to_second != 0 {
                _mm256_mask_storeu_ps(second.as_mut_ptr(), to_second, moved);
            }
        }
    }
    #[inline(always)]
    fn append_words(words: &[u32; WIDTH], _: usize, end: End, [first, second]: [&mut [u32; WIDTH]; 2]) {
        // SAFETY: as above; the rows have eight places.
        unsafe {
            let (sources, [to_first, to_second]) = moves(end);
            let words = _mm256_loadu_si256(words.as_ptr().cast());
            let moved = _mm256_permutexvar_epi32(_mm512_cvtepi64_epi32(sources), words);
            _mm256_mask_storeu_epi32(first.as_mut_ptr().cast(), to_first, moved);
            if to_second != 0 {
                _mm256_mask_storeu_epi32(second.as_mut_ptr().cast(), to_second, moved);
            }
        }
    }
}

/// For [`Lanes::append`]: for each place of a row the lane that goes there, and which places of both rows are written. The lanes that go to
/// the second row come round to its beginning.
///
/// # Safety
/// The machine has AVX-512.
#[inline(always)]
unsafe fn moves(end: End) -> (__m512i, [u8; 2]) {
    // SAFETY: the caller knows.
    unsafe {
        let lanes = _mm512_setr_epi64(0, 1, 2, 3, 4, 5, 6, 7);
        let together = _mm512_maskz_compress_epi64(end.lanes.0, lanes);
        let turned = _mm512_sub_epi64(lanes, _mm512_set1_epi64(end.from as i64));
        // Only the three lowest bits of a number count, so that it is taken modulo eight.
        let sources = _mm512_permutexvar_epi64(turned, together);
        let places = Bits::first(end.lanes.count() as usize).0;
        let [first, second] = (u16::from(places) << end.from).to_le_bytes();
        (sources, [first, second])
    }
}

impl Lanes for Eight256 {
    const COUNT: usize = WIDTH;
    type Floats = Floats256;
    type Eight = Floats256;

    #[inline(always)]
    fn stage<W: Work>(work: W) -> W::Output {
        #[inline(never)]
        #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
        fn with_instructions<W: Work>(work: W) -> W::Output {
            work.run::<Eight256>()
        }
        // SAFETY: the instructions are there, see the top of the file; every machine with AVX2 counts bits.
        unsafe { with_instructions(work) }
    }
    #[inline(always)]
    fn product_error(a: f64, b: f64, product: f64) -> f64 {
        fused_error(a, b, product)
    }
    #[inline(always)]
    fn product_errors(self, other: Self, product: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_fmsub_pd(self.0, other.0, product.0), _mm256_fmsub_pd(self.1, other.1, product.1)) }
    }
    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_set1_pd(value), _mm256_set1_pd(value)) }
    }
    #[inline(always)]
    fn load(row: &[f64; WIDTH], _: usize) -> Self {
        // SAFETY: as above; the row has eight numbers.
        unsafe { Self(_mm256_loadu_pd(row.as_ptr()), _mm256_loadu_pd(row.as_ptr().add(4))) }
    }
    #[inline(always)]
    fn store(self, row: &mut [f64; WIDTH], _: usize) {
        // SAFETY: as above; the row has eight places.
        unsafe {
            _mm256_storeu_pd(row.as_mut_ptr(), self.0);
            _mm256_storeu_pd(row.as_mut_ptr().add(4), self.1);
        }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_sqrt_pd(self.0), _mm256_sqrt_pd(self.1)) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: as above.
        unsafe {
            let sign = _mm256_set1_pd(-0.0);
            Self(_mm256_andnot_pd(sign, self.0), _mm256_andnot_pd(sign, self.1))
        }
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        // SAFETY: as above.
        unsafe {
            let minus = _mm256_set1_pd(-0.0);
            Self(
                _mm256_or_pd(_mm256_andnot_pd(minus, self.0), _mm256_and_pd(minus, sign.0)),
                _mm256_or_pd(_mm256_andnot_pd(minus, self.1), _mm256_and_pd(minus, sign.1)),
            )
        }
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Bits {
        // SAFETY: as above.
        unsafe { join(_mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0), _mm256_cmp_pd::<_CMP_LT_OQ>(self.1, other.1)) }
    }
    #[inline(always)]
    fn le(self, other: Self) -> Bits {
        // SAFETY: as above.
        unsafe { join(_mm256_cmp_pd::<_CMP_LE_OQ>(self.0, other.0), _mm256_cmp_pd::<_CMP_LE_OQ>(self.1, other.1)) }
    }
    #[inline(always)]
    fn same(self, other: Self) -> Bits {
        // SAFETY: as above.
        unsafe { join(_mm256_cmp_pd::<_CMP_EQ_OQ>(self.0, other.0), _mm256_cmp_pd::<_CMP_EQ_OQ>(self.1, other.1)) }
    }
    #[inline(always)]
    fn or_where_not(self, bits: Bits, other: Self) -> Self {
        // SAFETY: as above.
        unsafe {
            // Each lane's bit is shifted to where the blend looks for it, the sign.
            let all = _mm256_set1_epi64x(i64::from(bits.0));
            let low_mask = _mm256_castsi256_pd(_mm256_sllv_epi64(all, _mm256_setr_epi64x(63, 62, 61, 60)));
            let high_mask = _mm256_castsi256_pd(_mm256_sllv_epi64(all, _mm256_setr_epi64x(59, 58, 57, 56)));
            Self(_mm256_blendv_pd(other.0, self.0, low_mask), _mm256_blendv_pd(other.1, self.1, high_mask))
        }
    }
    #[inline(always)]
    fn to_floats(self) -> Floats256 {
        // SAFETY: as above.
        unsafe { Floats256(_mm256_set_m128(_mm256_cvtpd_ps(self.1), _mm256_cvtpd_ps(self.0))) }
    }
    #[inline(always)]
    fn from_floats(floats: Floats256) -> Self {
        // SAFETY: as above.
        unsafe {
            let high = _mm256_extractf128_ps::<1>(floats.0);
            Self(_mm256_cvtps_pd(_mm256_castps256_ps128(floats.0)), _mm256_cvtps_pd(high))
        }
    }
    #[inline(always)]
    fn floor(self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_floor_pd(self.0), _mm256_floor_pd(self.1)) }
    }
    #[inline(always)]
    fn exponent(self) -> Self {
        // SAFETY: as above.
        unsafe { Self(exponent(self.0), exponent(self.1)) }
    }
    #[inline(always)]
    fn times_power_of_two(self, power: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_mul_pd(self.0, power_of_two(power.0)), _mm256_mul_pd(self.1, power_of_two(power.1))) }
    }
    // As with AVX-512.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_max_pd(other.0, self.0), _mm256_max_pd(other.1, self.1)) }
    }
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_min_pd(other.0, self.0), _mm256_min_pd(other.1, self.1)) }
    }
    #[inline(always)]
    fn append(self, end: End, [first, second]: [&mut [f64; WIDTH]; 2]) {
        // SAFETY: as above.
        unsafe {
            let sources = sources(end);
            let moved = Self(pick(self, sources as u32), pick(self, (sources >> 32) as u32));
            moved.or_where_not(!Bits::first(end.from), Self::load(first, 0)).store(first, 0);
            if end.is_split() {
                moved.store(second, 0);
            }
        }
    }
    #[inline(always)]
    fn append_floats(floats: Floats256, end: End, [first, second]: [&mut [f32; WIDTH]; 2]) {
        // SAFETY: as above.
        unsafe {
            let sources = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(sources(end) as i64));
            let moved = Floats256(_mm256_permutevar8x32_ps(floats.0, sources));
            moved.or_where_not(!Bits::first(end.from), Floats256::load(first, 0)).store(first, 0);
            if end.is_split() {
                moved.store(second, 0);
            }
        }
    }
    #[inline(always)]
    fn append_words(words: &[u32; WIDTH], _: usize, end: End, rows: [&mut [u32; WIDTH]; 2]) {
        // Whatever their bits mean, they are only moved.
        let floats = Floats256::load(bytemuck::cast_ref(words), 0);
        Self::append_floats(floats, end, rows.map(bytemuck::cast_mut));
    }
}

/// For [`Lanes::append`]: for each place of a row the lane that goes there, a byte each; those of the second row come round to its
/// beginning. What is written beyond the end means nothing there, so whole rows are.
///
/// # Safety
/// The machine has AVX2, and with it BMI2.
#[inline(always)]
unsafe fn sources(end: End) -> u64 {
    // SAFETY: the caller knows.
    let together = unsafe {
        let bytes = _pdep_u64(u64::from(end.lanes.0), 0x0101_0101_0101_0101) * 0xff;
        _pext_u64(0x0706_0504_0302_0100, bytes)
    };
    together.rotate_left(8 * end.from as u32)
}

/// Four of eight numbers, by their lanes, a byte each.
///
/// # Safety
/// The machine has AVX2.
#[inline(always)]
unsafe fn pick(numbers: Eight256, lanes: u32) -> __m256d {
    // SAFETY: the caller knows.
    unsafe {
        let lanes = _mm256_cvtepu8_epi64(_mm_cvtsi32_si128(lanes as i32));
        // Each number is two words side by side.
        let low_word = _mm256_and_si256(_mm256_slli_epi64::<1>(lanes), _mm256_set1_epi64x(6));
        let high_word = _mm256_slli_epi64::<32>(_mm256_add_epi64(low_word, _mm256_set1_epi64x(1)));
        let words = _mm256_or_si256(low_word, high_word);
        let low = _mm256_castps_pd(_mm256_permutevar8x32_ps(_mm256_castpd_ps(numbers.0), words));
        let high = _mm256_castps_pd(_mm256_permutevar8x32_ps(_mm256_castpd_ps(numbers.1), words));
        // The bit of four becomes the sign.
        _mm256_blendv_pd(low, high, _mm256_castsi256_pd(_mm256_slli_epi64::<61>(lanes)))
    }
}

/// See [`Lanes::exponent`]. Small whole numbers become `f64` in the low bits of 2⁵².
///
/// # Safety
/// The machine has AVX2.
#[inline(always)]
unsafe fn exponent(numbers: __m256d) -> __m256d {
    // SAFETY: the caller knows.
    unsafe {
        let field = _mm256_srli_epi64::<53>(_mm256_slli_epi64::<1>(_mm256_castpd_si256(numbers)));
        let whole = _mm256_or_si256(field, _mm256_castpd_si256(_mm256_set1_pd(TWO_TO_52)));
        _mm256_sub_pd(_mm256_castsi256_pd(whole), _mm256_set1_pd(TWO_TO_52 + 1023.0))
    }
}

/// Two to the power of whole numbers, see [`Lanes::times_power_of_two`]: their low bits in the place of an exponent's.
///
/// # Safety
/// The machine has AVX2.
#[inline(always)]
unsafe fn power_of_two(power: __m256d) -> __m256d {
    // SAFETY: the caller knows.
    unsafe {
        let whole = _mm256_add_pd(power, _mm256_set1_pd(TWO_TO_52 + 1023.0));
        _mm256_castsi256_pd(_mm256_slli_epi64::<52>(_mm256_castpd_si256(whole)))
    }
}

const TWO_TO_52: f64 = (1_u64 << 52) as f64;

/// The signs of two halves as bits.
///
/// # Safety
/// The machine has AVX2.
#[inline(always)]
unsafe fn join(low: __m256d, high: __m256d) -> Bits {
    // SAFETY: the caller knows.
    unsafe { Bits((_mm256_movemask_pd(low) | _mm256_movemask_pd(high) << 4) as u8) }
}

macro_rules! floats {
    (
        $type:ident,
        |$a:ident, $b:ident| $lt:expr, $le:expr, $is_zero:expr, $is_nan:expr, |$larger:ident| $max:expr, |$bits:ident| $blend:expr
    ) => {
        impl Floats for $type {
            #[inline(always)]
            fn splat(value: f32) -> Self {
                // SAFETY: the instructions are there, see the top of the file.
                unsafe { Self(_mm256_set1_ps(value)) }
            }
            #[inline(always)]
            fn load(row: &[f32; WIDTH], _: usize) -> Self {
                // SAFETY: as above; the row has eight numbers.
                unsafe { Self(_mm256_loadu_ps(row.as_ptr())) }
            }
            #[inline(always)]
            fn store(self, row: &mut [f32; WIDTH], _: usize) {
                // SAFETY: as above; the row has eight places.
                unsafe { _mm256_storeu_ps(row.as_mut_ptr(), self.0) }
            }
            #[inline(always)]
            fn abs(self) -> Self {
                // SAFETY: as above.
                unsafe { Self(_mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0)) }
            }
            #[inline(always)]
            fn lt(self, other: Self) -> Bits {
                let ($a, $b) = (self.0, other.0);
                // SAFETY: as above.
                unsafe { Bits($lt as u8) }
            }
            #[inline(always)]
            fn is_zero(self) -> Bits {
                let $a = self.0;
                // SAFETY: as above.
                unsafe { Bits($is_zero as u8) }
            }
            #[inline(always)]
            fn is_nan(self) -> Bits {
                let $a = self.0;
                // SAFETY: as above.
                unsafe { Bits($is_nan as u8) }
            }
            #[inline(always)]
            fn or_where_not(self, $bits: Bits, other: Self) -> Self {
                let ($a, $b) = (self.0, other.0);
                // SAFETY: as above.
                unsafe { Self($blend) }
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                let ($a, $b) = (self.0, other.0);
                // SAFETY: as above. The instruction gives its second operand where one is NaN.
                unsafe {
                    let $larger = _mm256_max_ps($b, $a);
                    Self($max)
                }
            }
        }

        impl Eight for $type {
            #[inline(always)]
            fn to_array(self) -> [f32; WIDTH] {
                let mut row = [0.0; WIDTH];
                self.store(&mut row, 0);
                row
            }
            #[inline(always)]
            fn lesser(self, other: Self) -> Self {
                // SAFETY: as above.
                unsafe { Self(_mm256_min_ps(self.0, other.0)) }
            }
            #[inline(always)]
            fn greater(self, other: Self) -> Self {
                // SAFETY: as above.
                unsafe { Self(_mm256_max_ps(self.0, other.0)) }
            }
            #[inline(always)]
            fn times_sign(self, sign: Self) -> Self {
                // SAFETY: as above.
                unsafe { Self(_mm256_xor_ps(self.0, _mm256_and_ps(sign.0, _mm256_set1_ps(-0.0)))) }
            }
            #[inline(always)]
            fn le(self, other: Self) -> Bits {
                let ($a, $b) = (self.0, other.0);
                // SAFETY: as above.
                unsafe { Bits($le as u8) }
            }
            #[inline(always)]
            fn multiply_add(self, factor: Self, addend: Self) -> Self {
                // SAFETY: as above.
                unsafe { Self(_mm256_fmadd_ps(self.0, factor.0, addend.0)) }
            }
            #[inline(always)]
            fn prefetch<T>(place: &T) {
                let start = std::ptr::from_ref(place).cast::<i8>();
                for line in (0..size_of::<T>()).step_by(64) {
                    // SAFETY: within the object; and a prefetch reads nothing.
                    unsafe { _mm_prefetch::<_MM_HINT_T0>(start.add(line)) };
                }
            }
        }
    };
}

floats!(
    Floats512,
    |a, b| _mm256_cmp_ps_mask::<_CMP_LT_OQ>(a, b),
    _mm256_cmp_ps_mask::<_CMP_LE_OQ>(a, b),
    _mm256_cmp_ps_mask::<_CMP_EQ_OQ>(a, _mm256_setzero_ps()),
    _mm256_cmp_ps_mask::<_CMP_UNORD_Q>(a, a),
    |larger| _mm256_mask_blend_ps(_mm256_cmp_ps_mask::<_CMP_UNORD_Q>(a, a), larger, b),
    |bits| _mm256_mask_blend_ps(bits.0, b, a)
);
floats!(
    Floats256,
    |a, b| _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(a, b)),
    _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b)),
    _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_EQ_OQ>(a, _mm256_setzero_ps())),
    _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_UNORD_Q>(a, a)),
    |larger| _mm256_blendv_ps(larger, b, _mm256_cmp_ps::<_CMP_UNORD_Q>(a, a)),
    |bits| {
        let all = _mm256_set1_epi32(i32::from(bits.0));
        let mask = _mm256_sllv_epi32(all, _mm256_setr_epi32(31, 30, 29, 28, 27, 26, 25, 24));
        _mm256_blendv_ps(b, a, _mm256_castsi256_ps(mask))
    }
);

//! Eight `f32` side by side: the registers of box and triangle filters.
//!
//! What is written over [`Eight`] runs by AVX-512, by AVX2 or by what every machine has. [`dispatch`] gives the work a type
//! whose instructions are there; nothing else hands out such a type, so this is where their safety is shown, here once for
//! all. Work and what it calls is `#[inline(always)]`, so that it becomes one function compiled for those instructions.
//!
//! Every operation is rounded by itself: nothing is fused. The ways agree bit by bit, NaN's payload aside; pictures would
//! not depend on it if they did not, since these numbers only choose what is tested in `f64`.

use snell_math::lanes::InstructionSet;

/// How many numbers there are.
pub const WIDTH: usize = 8;

/// Eight `f32`. Masks have the bit of the first lane lowest.
pub trait Eight: Copy {
    /// The same number in all lanes.
    fn splat(x: f32) -> Self;
    /// A row of memory.
    fn load(row: &[f32; WIDTH]) -> Self;
    /// All lanes.
    fn to_array(self) -> [f32; WIDTH];
    /// The sum.
    fn add(self, other: Self) -> Self;
    /// The difference.
    fn sub(self, other: Self) -> Self;
    /// The product.
    fn mul(self, other: Self) -> Self;
    /// The quotient.
    fn div(self, other: Self) -> Self;
    /// `self` where it is less, else `other`: so `other` where one of them is NaN.
    fn min(self, other: Self) -> Self;
    /// `self` where it is greater, else `other`: so `other` where one of them is NaN.
    fn max(self, other: Self) -> Self;
    /// The magnitude.
    fn abs(self) -> Self;
    /// With its sign changed where the sign of `sign` is negative.
    fn times_sign(self, sign: Self) -> Self;
    /// Where this is less; never with NaN.
    fn lt(self, other: Self) -> u32;
    /// Where this is less or equal; never with NaN.
    fn le(self, other: Self) -> u32;
    /// Asks for memory that will soon be read.
    fn prefetch<T>(place: &T);
}

/// What can be done with any kind of [`Eight`].
pub trait Kernel {
    /// What comes of it.
    type Output;
    /// Does it. Mark it `#[inline(always)]`.
    fn run<F: Eight>(self) -> Self::Output;
}

/// Runs a kernel by an instruction set; by portable code where the machine does not have it.
#[inline]
pub fn dispatch<K: Kernel>(set: InstructionSet, kernel: K) -> K::Output {
    match set {
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx2 | InstructionSet::Avx512 if is_x86_feature_detected!("avx2") => x86::run(kernel),
        _ => kernel.run::<Portable>(),
    }
}

/// By arrays, which every compiler turns into what the machine has.
#[derive(Clone, Copy)]
pub struct Portable([f32; WIDTH]);

impl Portable {
    #[inline(always)]
    fn map2(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }

    #[inline(always)]
    fn mask(self, other: Self, f: impl Fn(f32, f32) -> bool) -> u32 {
        (0..WIDTH).fold(0, |mask, i| mask | u32::from(f(self.0[i], other.0[i])) << i)
    }
}

impl Eight for Portable {
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self([x; WIDTH])
    }
    #[inline(always)]
    fn load(row: &[f32; WIDTH]) -> Self {
        Self(*row)
    }
    #[inline(always)]
    fn to_array(self) -> [f32; WIDTH] {
        self.0
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.map2(other, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.map2(other, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.map2(other, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.map2(other, |a, b| a / b)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.map2(other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.map2(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f32::abs))
    }
    #[inline(always)]
    fn times_sign(self, sign: Self) -> Self {
        self.map2(sign, |a, s| f32::from_bits(a.to_bits() ^ (s.to_bits() & 1 << 31)))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> u32 {
        self.mask(other, |a, b| a < b)
    }
    #[inline(always)]
    fn le(self, other: Self) -> u32 {
        self.mask(other, |a, b| a <= b)
    }
    #[inline(always)]
    fn prefetch<T>(_: &T) {}
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::*;

    use super::{Eight, Kernel, WIDTH};

    /// By AVX2.
    #[derive(Clone, Copy)]
    pub struct Avx2(__m256);

    /// Runs a kernel compiled for these instructions. There is no closure between them and the kernel: it would be compiled for
    /// every machine, and where the compiler does not inline it, every instruction would become a call.
    #[inline]
    pub fn run<K: Kernel>(kernel: K) -> K::Output {
        #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
        fn with_instructions<K: Kernel>(kernel: K) -> K::Output {
            kernel.run::<Avx2>()
        }
        // SAFETY: as above; every machine with AVX2 has the instructions that count bits.
        unsafe { with_instructions(kernel) }
    }

    impl Eight for Avx2 {
        #[inline(always)]
        fn splat(x: f32) -> Self {
            // SAFETY: the instructions are there, see the top of the file; so below.
            unsafe { Self(_mm256_set1_ps(x)) }
        }
        #[inline(always)]
        fn load(row: &[f32; WIDTH]) -> Self {
            // SAFETY: as above; the row has eight numbers, and need not be aligned.
            unsafe { Self(_mm256_loadu_ps(row.as_ptr())) }
        }
        #[inline(always)]
        fn to_array(self) -> [f32; WIDTH] {
            let mut row = [0.0; WIDTH];
            // SAFETY: as above; the row has eight places.
            unsafe { _mm256_storeu_ps(row.as_mut_ptr(), self.0) };
            row
        }
        #[inline(always)]
        fn add(self, other: Self) -> Self {
            // SAFETY: as above.
            unsafe { Self(_mm256_add_ps(self.0, other.0)) }
        }
        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            // SAFETY: as above.
            unsafe { Self(_mm256_sub_ps(self.0, other.0)) }
        }
        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            // SAFETY: as above.
            unsafe { Self(_mm256_mul_ps(self.0, other.0)) }
        }
        #[inline(always)]
        fn div(self, other: Self) -> Self {
            // SAFETY: as above.
            unsafe { Self(_mm256_div_ps(self.0, other.0)) }
        }
        #[inline(always)]
        fn min(self, other: Self) -> Self {
            // SAFETY: as above.
            unsafe { Self(_mm256_min_ps(self.0, other.0)) }
        }
        #[inline(always)]
        fn max(self, other: Self) -> Self {
            // SAFETY: as above.
            unsafe { Self(_mm256_max_ps(self.0, other.0)) }
        }
        #[inline(always)]
        fn abs(self) -> Self {
            // SAFETY: as above.
            unsafe { Self(_mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0)) }
        }
        #[inline(always)]
        fn times_sign(self, sign: Self) -> Self {
            // SAFETY: as above.
            unsafe { Self(_mm256_xor_ps(self.0, _mm256_and_ps(sign.0, _mm256_set1_ps(-0.0)))) }
        }
        #[inline(always)]
        fn lt(self, other: Self) -> u32 {
            // SAFETY: as above.
            unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0)) as u32 }
        }
        #[inline(always)]
        fn le(self, other: Self) -> u32 {
            // SAFETY: as above.
            unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0)) as u32 }
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
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation on the same numbers.
    struct Everything([f32; WIDTH], [f32; WIDTH]);

    impl Kernel for Everything {
        type Output = (Vec<u32>, [u32; 2]);
        #[inline(always)]
        fn run<F: Eight>(self) -> Self::Output {
            let (a, b) = (F::load(&self.0), F::load(&self.1));
            let all =
                [a.add(b), a.sub(b), a.mul(b), a.div(b), a.min(b), a.max(b), a.abs(), a.times_sign(b), F::splat(2.0)];
            let bits = |x: f32| if x.is_nan() { u32::MAX } else { x.to_bits() };
            (all.into_iter().flat_map(F::to_array).map(bits).collect(), [a.lt(b), a.le(b)])
        }
    }

    #[test]
    fn all_ways_agree() {
        let numbers = [0.0, -0.0, 1.0, -1.5, f32::NAN, f32::INFINITY, 1e-40, 3e38];
        for turn in 0..WIDTH {
            let mut turned = numbers;
            turned.rotate_left(turn);
            let expected = Everything(numbers, turned).run::<Portable>();
            for set in InstructionSet::available() {
                assert_eq!(dispatch(set, Everything(numbers, turned)), expected, "{set:?}");
            }
        }
    }
}

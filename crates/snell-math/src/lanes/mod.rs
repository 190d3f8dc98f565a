//! Numbers side by side: the same operation on up to eight `f64` or `f32` at once, with the same bits on every machine.
//!
//! Code that is generic over [`Lanes`] is written once and runs on one number at a time (`f64` itself has one lane) or on eight, by
//! whichever instructions the machine has: AVX-512, AVX2, or those that every machine has. Every operation here is one that IEEE
//! 754 rounds correctly, and none is fused with another, so that all ways give the same bits, NaN's aside. The one exception says so:
//! [`Eight::multiply_add`].
//!
//! Which instructions there are is known only when the program runs. [`dispatch`] asks once, and gives the work a type whose
//! operations may be used because they are there; nothing else hands out such a type. For the compiler to make one stretch of
//! machine code out of many small operations, what is generic over lanes is marked `#[inline(always)]` up to [`Lanes::stage`] or
//! [`Work::run`], which are compiled for the instructions at hand.
//!
//! ```
//! use snell_math::lanes::{InstructionSet, Lanes, Work, dispatch};
//!
//! /// The distances of eight points (x, y) from the origin.
//! struct Distances<'a>(&'a [f64; 8], &'a [f64; 8]);
//!
//! impl Work for Distances<'_> {
//!     type Output = [f64; 8];
//!     #[inline(always)]
//!     fn run<L: Lanes>(self) -> [f64; 8] {
//!         let mut distances = [0.0; 8];
//!         for at in (0..8).step_by(L::COUNT) {
//!             let (x, y) = (L::load(self.0, at), L::load(self.1, at));
//!             (x * x + y * y).sqrt().store(&mut distances, at);
//!         }
//!         distances
//!     }
//! }
//!
//! let (x, y) = ([3.0; 8], [4.0; 8]);
//! for set in InstructionSet::available() {
//!     assert_eq!(dispatch(set, Distances(&x, &y)), [5.0; 8]);
//! }
//! ```

mod bits;
mod end;
mod portable;
mod power;
#[cfg(test)]
mod tests;
mod vector;
#[cfg(target_arch = "x86_64")]
mod x86;

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

pub use bits::Bits;
pub use end::End;
pub use power::{exponential_to_f32, power_to_f32};
pub use vector::{LaneColor, LaneVector};

/// How many numbers stand in one row of memory: the most lanes there are.
pub const WIDTH: usize = 8;

/// `f64` numbers side by side.
pub trait Lanes:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + 'static
{
    /// How many.
    const COUNT: usize;
    /// As many `f32`.
    type Floats: Floats;
    /// Eight `f32` by the same instructions, however many lanes there are.
    type Eight: Eight;

    /// Does a stretch of work, compiled for these instructions. What it calls must be `#[inline(always)]` to be so as well, which a
    /// closure cannot be.
    fn stage<W: Work>(work: W) -> W::Output;

    /// The same number in all lanes.
    fn splat(value: f64) -> Self;
    /// [`Lanes::COUNT`] numbers of a row, from place `at` on, a multiple of the count.
    fn load(row: &[f64; WIDTH], at: usize) -> Self;
    /// Writes them to a row; see [`Lanes::load`].
    fn store(self, row: &mut [f64; WIDTH], at: usize);
    /// The square root.
    fn sqrt(self) -> Self;
    /// The magnitude.
    fn abs(self) -> Self;
    /// The magnitude of these with the signs of those.
    fn copysign(self, sign: Self) -> Self;
    /// Where this is less; never with NaN.
    fn lt(self, other: Self) -> Bits;
    /// Where this is less or equal; never with NaN.
    fn le(self, other: Self) -> Bits;
    /// Where they are equal; never with NaN.
    fn same(self, other: Self) -> Bits;
    /// `self` where a bit is set, `other` elsewhere.
    fn or_where_not(self, bits: Bits, other: Self) -> Self;
    /// Rounded to `f32`.
    fn to_floats(self) -> Self::Floats;
    /// Every `f32` is an `f64`.
    fn from_floats(floats: Self::Floats) -> Self;
    /// Rounded down to a whole number.
    fn floor(self) -> Self;
    /// The exponent of the power of two that is the largest below the magnitude, of normal numbers; −1023 for those too small to be
    /// normal, 1024 for what is infinite or NaN.
    fn exponent(self) -> Self;
    /// Times two to the power of whole numbers from −1022 to 1023; with others what comes of it means nothing.
    fn times_power_of_two(self, power: Self) -> Self;

    /// What rounding took from the product of two numbers: a · b − `product`, which has no error where that is at least about 1e-290
    /// in magnitude; the same bits by all instructions. Dekker, "A Floating-Point Technique for Extending the Available Precision",
    /// Numerische Mathematik 18, 1971, where there is no fused operation.
    #[inline(always)]
    fn product_error(a: f64, b: f64, product: f64) -> f64 {
        a.product_errors(b, product)
    }

    /// As [`Lanes::product_error`], side by side.
    #[inline(always)]
    fn product_errors(self, other: Self, product: Self) -> Self {
        let ((a_high, a_low), (b_high, b_low)) = (halves(self), halves(other));
        // With zero added, so that no error is +0.
        a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low) + Self::splat(0.0)
    }

    /// Writes some lanes, counted from 0, to the end of rows that are partly full; see [`End`]. What stands behind the new end means
    /// nothing afterwards.
    #[inline(always)]
    fn append(self, end: End, rows: [&mut [f64; WIDTH]; 2]) {
        let mut row = [0.0; WIDTH];
        self.store(&mut row, 0);
        end.append(&row, rows);
    }
    /// As [`Lanes::append`].
    #[inline(always)]
    fn append_floats(floats: Self::Floats, end: End, rows: [&mut [f32; WIDTH]; 2]) {
        let mut row = [0.0; WIDTH];
        floats.store(&mut row, 0);
        end.append(&row, rows);
    }
    /// As [`Lanes::append`], of numbers that stand in a row from place `at` on.
    #[inline(always)]
    fn append_words(words: &[u32; WIDTH], at: usize, end: End, rows: [&mut [u32; WIDTH]; 2]) {
        let mut row = [0; WIDTH];
        row[..Self::COUNT].copy_from_slice(&words[at..][..Self::COUNT]);
        end.append(&row, rows);
    }

    /// Where this is greater; never with NaN.
    #[inline(always)]
    fn gt(self, other: Self) -> Bits {
        other.lt(self)
    }
    /// Where this is greater or equal; never with NaN.
    #[inline(always)]
    fn ge(self, other: Self) -> Bits {
        other.le(self)
    }
    /// All lanes.
    #[inline(always)]
    fn all() -> Bits {
        Bits::first(Self::COUNT)
    }
    /// The larger one; this one where neither is larger.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        other.or_where_not(self.lt(other), self)
    }
    /// The smaller one; this one where neither is smaller.
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        other.or_where_not(other.lt(self), self)
    }
}

/// A number of half the digits, and the rest.
#[inline(always)]
fn halves<L: Lanes>(x: L) -> (L, L) {
    let scaled = L::splat(((1_u64 << 27) + 1) as f64) * x;
    let high = scaled - (scaled - x);
    (high, x - high)
}

/// `f32` numbers side by side.
pub trait Floats:
    Copy + Debug + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self> + 'static
{
    /// The same number in all lanes.
    fn splat(value: f32) -> Self;
    /// As [`Lanes::load`].
    fn load(row: &[f32; WIDTH], at: usize) -> Self;
    /// As [`Lanes::store`].
    fn store(self, row: &mut [f32; WIDTH], at: usize);
    /// The magnitude.
    fn abs(self) -> Self;
    /// Where this is less; never with NaN.
    fn lt(self, other: Self) -> Bits;
    /// Where it is zero, of either sign.
    fn is_zero(self) -> Bits;
    /// `self` where a bit is set, `other` elsewhere.
    fn or_where_not(self, bits: Bits, other: Self) -> Self;

    /// The larger one; the one that is a number where one is NaN: as `f32::max`.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // Not less or equal, so that NaN loses on either side.
        let number = other.or_where_not(self.lt(other), self);
        other.or_where_not(self.is_nan(), number)
    }
    /// Where it is NaN.
    fn is_nan(self) -> Bits;
}

/// Eight `f32` side by side, whatever the number of lanes: the registers of filters that test a ray with eight things.
pub trait Eight: Floats + Div<Output = Self> {
    /// All lanes.
    fn to_array(self) -> [f32; WIDTH];
    /// `self` where it is less, else `other`: so `other` where one of them is NaN.
    fn lesser(self, other: Self) -> Self;
    /// `self` where it is greater, else `other`: so `other` where one of them is NaN.
    fn greater(self, other: Self) -> Self;
    /// With its sign changed where the sign of `sign` is negative.
    fn times_sign(self, sign: Self) -> Self;
    /// Where this is less or equal; never with NaN.
    fn le(self, other: Self) -> Bits;
    /// `self * factor + addend`, rounded once or twice, whichever the machine does faster: for filters whose bounds hold either way,
    /// and for nothing that a picture depends on.
    #[inline(always)]
    fn multiply_add(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }
    /// Asks for memory that will soon be read.
    fn prefetch<T>(place: &T);
}

/// What can be done with any kind of lanes.
pub trait Work {
    /// What comes of it.
    type Output;
    /// Does it. Mark it `#[inline(always)]`.
    fn run<L: Lanes>(self) -> Self::Output;
}

/// Instructions that work on several numbers at once. Pictures do not depend on them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InstructionSet {
    /// One number after the other.
    Scalar,
    /// Eight at a time, by what every machine has.
    Portable,
    /// x86-64 with AVX2: four at a time.
    Avx2,
    /// x86-64 with AVX-512 (F, VL, DQ and BW): eight at a time.
    Avx512,
}

impl InstructionSet {
    /// The best that this machine has.
    #[must_use]
    pub fn best() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if x86::has_avx512() {
                return Self::Avx512;
            }
            if x86::has_avx2() {
                return Self::Avx2;
            }
        }
        Self::Portable
    }

    /// All that this machine has, for tests that compare them.
    #[must_use]
    pub fn available() -> Vec<Self> {
        let mut sets = vec![Self::Scalar, Self::Portable];
        #[cfg(target_arch = "x86_64")]
        {
            sets.extend(x86::has_avx2().then_some(Self::Avx2));
            sets.extend(x86::has_avx512().then_some(Self::Avx512));
        }
        sets
    }
}

/// Does some work with the lanes of an instruction set; with portable ones where the machine does not have it.
#[inline]
pub fn dispatch<W: Work>(set: InstructionSet, work: W) -> W::Output {
    // Each way is a function by itself: their frames together would be a page and more, which each call would pay for.
    match set {
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx512 if x86::has_avx512() => x86::Eight512::stage(work),
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx2 if x86::has_avx2() => x86::Eight256::stage(work),
        InstructionSet::Scalar => apart::<f64, W>(work),
        _ => apart::<portable::Eight, W>(work),
    }
}

/// Work that is not made part of the function that asks for it.
#[inline(never)]
fn apart<L: Lanes, W: Work>(work: W) -> W::Output {
    work.run::<L>()
}

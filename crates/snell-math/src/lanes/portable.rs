//! Lanes that every machine has: one number, and eight in an array.

use std::array::from_fn;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::{Bits, Floats, Lanes, WIDTH, Work};

impl Lanes for f64 {
    const COUNT: usize = 1;
    type Floats = f32;
    type Eight = EightFloats;

    #[inline(always)]
    fn stage<W: Work>(work: W) -> W::Output {
        work.run::<Self>()
    }
    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn load(row: &[f64; WIDTH], at: usize) -> Self {
        row[at]
    }
    #[inline(always)]
    fn store(self, row: &mut [f64; WIDTH], at: usize) {
        row[at] = self;
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        f64::copysign(self, sign)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Bits {
        Bits(u8::from(self < other))
    }
    #[inline(always)]
    fn le(self, other: Self) -> Bits {
        Bits(u8::from(self <= other))
    }
    #[inline(always)]
    fn same(self, other: Self) -> Bits {
        Bits(u8::from(self == other))
    }
    #[inline(always)]
    fn or_where_not(self, bits: Bits, other: Self) -> Self {
        if bits.has(0) { self } else { other }
    }
    #[inline(always)]
    fn to_floats(self) -> f32 {
        self as f32
    }
    #[inline(always)]
    fn from_floats(floats: f32) -> Self {
        f64::from(floats)
    }
    #[inline(always)]
    fn floor(self) -> Self {
        f64::floor(self)
    }
    #[inline(always)]
    fn exponent(self) -> Self {
        (self.to_bits() >> 52 & 0x7ff) as f64 - 1023.0
    }
    #[inline(always)]
    fn times_power_of_two(self, power: Self) -> Self {
        self * f64::from_bits(((power as i64).wrapping_add(1023) as u64) << 52)
    }
}

impl Floats for f32 {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        value
    }
    #[inline(always)]
    fn load(row: &[f32; WIDTH], at: usize) -> Self {
        row[at]
    }
    #[inline(always)]
    fn store(self, row: &mut [f32; WIDTH], at: usize) {
        row[at] = self;
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f32::abs(self)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Bits {
        Bits(u8::from(self < other))
    }
    #[inline(always)]
    fn is_zero(self) -> Bits {
        Bits(u8::from(self.to_bits() << 1 == 0))
    }
    #[inline(always)]
    fn or_where_not(self, bits: Bits, other: Self) -> Self {
        if bits.has(0) { self } else { other }
    }
    #[inline(always)]
    fn is_nan(self) -> Bits {
        Bits(u8::from(f32::is_nan(self)))
    }
}

/// Eight `f64` in an array. What the compiler makes of it is up to it.
#[derive(Clone, Copy, Debug)]
pub struct Eight([f64; WIDTH]);

/// Eight `f32`.
#[derive(Clone, Copy, Debug)]
pub struct EightFloats([f32; WIDTH]);

/// The lanes where a condition holds.
#[inline(always)]
fn bits(condition: impl Fn(usize) -> bool) -> Bits {
    let mut bits = 0;
    for lane in 0..WIDTH {
        bits |= u8::from(condition(lane)) << lane;
    }
    Bits(bits)
}

macro_rules! componentwise {
    ($type:ident: $($trait:ident $method:ident $op:tt),*) => {
        $(impl $trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(from_fn(|i| self.0[i] $op other.0[i]))
            }
        })*
        impl Neg for $type {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self(self.0.map(|x| -x))
            }
        }
    };
}
componentwise!(Eight: Add add +, Sub sub -, Mul mul *, Div div /);
componentwise!(EightFloats: Add add +, Sub sub -, Mul mul *, Div div /);

impl Lanes for Eight {
    const COUNT: usize = WIDTH;
    type Floats = EightFloats;
    type Eight = EightFloats;

    #[inline(always)]
    fn stage<W: Work>(work: W) -> W::Output {
        work.run::<Self>()
    }
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; WIDTH])
    }
    #[inline(always)]
    fn load(row: &[f64; WIDTH], _: usize) -> Self {
        Self(*row)
    }
    #[inline(always)]
    fn store(self, row: &mut [f64; WIDTH], _: usize) {
        *row = self.0;
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f64::abs))
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        Self(from_fn(|i| self.0[i].copysign(sign.0[i])))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Bits {
        bits(|i| self.0[i] < other.0[i])
    }
    #[inline(always)]
    fn le(self, other: Self) -> Bits {
        bits(|i| self.0[i] <= other.0[i])
    }
    #[inline(always)]
    fn same(self, other: Self) -> Bits {
        bits(|i| self.0[i] == other.0[i])
    }
    #[inline(always)]
    fn or_where_not(self, bits: Bits, other: Self) -> Self {
        Self(from_fn(|i| if bits.has(i) { self.0[i] } else { other.0[i] }))
    }
    #[inline(always)]
    fn to_floats(self) -> EightFloats {
        EightFloats(self.0.map(|x| x as f32))
    }
    #[inline(always)]
    fn from_floats(floats: EightFloats) -> Self {
        Self(floats.0.map(f64::from))
    }
    #[inline(always)]
    fn floor(self) -> Self {
        Self(self.0.map(f64::floor))
    }
    #[inline(always)]
    fn exponent(self) -> Self {
        Self(self.0.map(Lanes::exponent))
    }
    #[inline(always)]
    fn times_power_of_two(self, power: Self) -> Self {
        Self(from_fn(|i| self.0[i].times_power_of_two(power.0[i])))
    }
}

impl Floats for EightFloats {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self([value; WIDTH])
    }
    #[inline(always)]
    fn load(row: &[f32; WIDTH], _: usize) -> Self {
        Self(*row)
    }
    #[inline(always)]
    fn store(self, row: &mut [f32; WIDTH], _: usize) {
        *row = self.0;
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f32::abs))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Bits {
        bits(|i| self.0[i] < other.0[i])
    }
    #[inline(always)]
    fn is_zero(self) -> Bits {
        bits(|i| self.0[i] == 0.0)
    }
    #[inline(always)]
    fn or_where_not(self, bits: Bits, other: Self) -> Self {
        Self(from_fn(|i| if bits.has(i) { self.0[i] } else { other.0[i] }))
    }
    #[inline(always)]
    fn is_nan(self) -> Bits {
        bits(|i| self.0[i].is_nan())
    }
}

impl super::Eight for EightFloats {
    #[inline(always)]
    fn to_array(self) -> [f32; WIDTH] {
        self.0
    }
    #[inline(always)]
    fn lesser(self, other: Self) -> Self {
        Self(from_fn(|i| if self.0[i] < other.0[i] { self.0[i] } else { other.0[i] }))
    }
    #[inline(always)]
    fn greater(self, other: Self) -> Self {
        Self(from_fn(|i| if self.0[i] > other.0[i] { self.0[i] } else { other.0[i] }))
    }
    #[inline(always)]
    fn times_sign(self, sign: Self) -> Self {
        Self(from_fn(|i| f32::from_bits(self.0[i].to_bits() ^ (sign.0[i].to_bits() & 1 << 31))))
    }
    #[inline(always)]
    fn le(self, other: Self) -> Bits {
        bits(|i| self.0[i] <= other.0[i])
    }
    #[inline(always)]
    fn prefetch<T>(_: &T) {}
}

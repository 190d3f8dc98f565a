//! Colour as the renderer computes with it: three scene-linear numbers with Rec. 709 / sRGB primaries and white D65.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub};

use bytemuck::{Pod, Zeroable};

use crate::portable;

/// A scene-linear colour: radiance, reflectance, transmittance or throughput, by context. Components may be negative
/// (a spectral colour outside the sRGB gamut) and above one.
///
/// ```
/// use snell_math::Rgb;
/// assert_eq!(Rgb::gray(0.5) * Rgb::new(1.0, 0.5, 0.0), Rgb::new(0.5, 0.25, 0.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Default, Pod, Zeroable)]
#[repr(C)]
pub struct Rgb {
    /// Red.
    pub r: f32,
    /// Green.
    pub g: f32,
    /// Blue.
    pub b: f32,
}

impl Rgb {
    /// No light; blocks all.
    pub const BLACK: Self = Self::gray(0.0);
    /// One in every component; passes all.
    pub const WHITE: Self = Self::gray(1.0);

    /// From three components.
    #[inline]
    pub const fn new(r: f32, g: f32, b: f32) -> Self {
        Self { r, g, b }
    }

    /// The same value in all three.
    #[inline]
    pub const fn gray(value: f32) -> Self {
        Self { r: value, g: value, b: value }
    }

    /// As an array `[r, g, b]`.
    #[inline]
    pub const fn to_array(self) -> [f32; 3] {
        [self.r, self.g, self.b]
    }

    /// Applies a function to each component.
    #[inline]
    #[must_use]
    pub fn map(self, mut f: impl FnMut(f32) -> f32) -> Self {
        Self { r: f(self.r), g: f(self.g), b: f(self.b) }
    }

    /// True where all three are exactly zero.
    #[inline]
    pub fn is_black(self) -> bool {
        // As bits, without the sign: no branch for each of them.
        (self.r.to_bits() | self.g.to_bits() | self.b.to_bits()) << 1 == 0
    }

    /// True where none is NaN or infinite.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.r.is_finite() && self.g.is_finite() && self.b.is_finite()
    }

    /// The largest absolute component: how much a weight can still matter.
    #[inline]
    pub fn max_abs(self) -> f32 {
        self.r.abs().max(self.g.abs()).max(self.b.abs())
    }

    /// Relative luminance Y (ITU-R BT.709-6, item 3.2, on linear components).
    #[inline]
    pub fn luminance(self) -> f32 {
        0.2126 * self.r + 0.7152 * self.g + 0.0722 * self.b
    }

    /// The mean of the three components.
    #[inline]
    pub fn mean(self) -> f32 {
        (self.r + self.g + self.b) / 3.0
    }

    /// The mix `self (1 − t) + other t`.
    #[inline]
    #[must_use]
    pub fn lerp(self, other: Self, t: f32) -> Self {
        self * (1.0 - t) + other * t
    }

    /// From display values in [0, 1], sRGB-encoded.
    pub fn from_srgb(encoded: [f32; 3]) -> Self {
        Self::new(srgb_to_linear(encoded[0]), srgb_to_linear(encoded[1]), srgb_to_linear(encoded[2]))
    }
}

impl From<[f32; 3]> for Rgb {
    #[inline]
    fn from([r, g, b]: [f32; 3]) -> Self {
        Self { r, g, b }
    }
}

/// One sRGB display value in [0, 1] to linear (IEC 61966-2-1).
#[must_use]
pub fn srgb_to_linear(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { portable::powf32((encoded + 0.055) / 1.055, 2.4) }
}

/// One linear value to the sRGB display value (IEC 61966-2-1); the caller clips to [0, 1].
#[must_use]
pub fn linear_to_srgb(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * portable::powf32(linear, 1.0 / 2.4) - 0.055 }
}

macro_rules! componentwise {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for Rgb {
            type Output = Self;
            #[inline]
            fn $method(self, other: Self) -> Self {
                Self { r: self.r $op other.r, g: self.g $op other.g, b: self.b $op other.b }
            }
        }
    };
}
componentwise!(Add, add, +);
componentwise!(Sub, sub, -);
componentwise!(Mul, mul, *);

impl AddAssign for Rgb {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl MulAssign for Rgb {
    #[inline]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}
impl Mul<f32> for Rgb {
    type Output = Self;
    #[inline]
    fn mul(self, s: f32) -> Self {
        self.map(|c| c * s)
    }
}
impl Div<f32> for Rgb {
    type Output = Self;
    #[inline]
    fn div(self, s: f32) -> Self {
        self.map(|c| c / s)
    }
}
impl Neg for Rgb {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        self.map(|c| -c)
    }
}

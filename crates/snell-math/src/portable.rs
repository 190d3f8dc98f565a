//! Transcendental functions that give the same bits on every machine.
//!
//! `f64::sin` and friends call the platform's C library, whose last bits differ; these call `libm`, the same Rust code
//! everywhere. Square root, absolute value, floor and the four operations are exact by IEEE 754 and stay in `std`.
//! All angles are radians.

macro_rules! portable {
    ($($(#[$doc:meta])* $name:ident => $function:path),* $(,)?) => {
        $($(#[$doc])* #[inline] #[must_use] pub fn $name(x: f64) -> f64 { $function(x) })*
    };
}

portable! {
    /// Sine.
    sin => libm::sin,
    /// Cosine.
    cos => libm::cos,
    /// Tangent.
    tan => libm::tan,
    /// Arc sine, in [−π/2, π/2].
    asin => libm::asin,
    /// Arc cosine, in [0, π].
    acos => libm::acos,
    /// Arc tangent, in (−π/2, π/2).
    atan => libm::atan,
    /// e to the power x.
    exp => libm::exp,
    /// Natural logarithm.
    ln => libm::log,
    /// Logarithm to base two.
    log2 => libm::log2,
    /// Cube root.
    cbrt => libm::cbrt,
}

/// The angle of the vector (x, y), in (−π, π].
#[inline]
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// `base` to the power `exponent`.
#[inline]
#[must_use]
pub fn pow(base: f64, exponent: f64) -> f64 {
    libm::pow(base, exponent)
}

/// `base` to the power `exponent`, single precision.
#[inline]
#[must_use]
pub fn powf32(base: f32, exponent: f32) -> f32 {
    libm::powf(base, exponent)
}

/// e to the power x, single precision.
#[inline]
#[must_use]
pub fn expf32(x: f32) -> f32 {
    libm::expf(x)
}

/// Degrees to radians.
#[inline]
#[must_use]
pub fn radians(degrees: f64) -> f64 {
    degrees * (std::f64::consts::PI / 180.0)
}

/// Radians to degrees.
#[inline]
#[must_use]
pub fn degrees(radians: f64) -> f64 {
    radians * (180.0 / std::f64::consts::PI)
}

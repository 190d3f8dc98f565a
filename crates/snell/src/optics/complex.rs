//! Complex numbers, as far as optics needs them, and the complex index of refraction.
//!
//! Convention: waves go as exp(i (k·x − ω t)), so an absorbing medium has an index n + i k with k ≥ 0, and a root is taken with
//! an imaginary part that is not negative: waves fade in the direction in which they go.

use std::ops::{Add, Div, Mul, Sub};

use snell_math::portable;

/// The index of refraction of a medium that may absorb, n + i k, at one wavelength.
///
/// ```
/// use snell::optics::ComplexIndex;
/// // Gold at 582 nm (Johnson and Christy 1972).
/// let gold = ComplexIndex::new(0.29, 2.863);
/// assert_eq!(ComplexIndex::from(1.5), ComplexIndex::new(1.5, 0.0));
/// // exp(−4π k / λ): light is nearly gone after a tenth of a micrometre.
/// assert!(gold.transmittance(100.0, 582.1) < 0.003);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComplexIndex {
    /// The index of refraction: how much slower waves go.
    pub n: f64,
    /// The coefficient of extinction, not negative.
    pub k: f64,
}

impl ComplexIndex {
    /// From its two parts.
    #[inline]
    #[must_use]
    pub const fn new(n: f64, k: f64) -> Self {
        Self { n, k }
    }

    /// The share of power that is left after a straight way through the medium; both lengths in nanometres, the wavelength
    /// in vacuum.
    #[must_use]
    pub fn transmittance(self, distance_nm: f64, wavelength_nm: f64) -> f64 {
        portable::exp(-4.0 * std::f64::consts::PI * self.k * distance_nm / wavelength_nm)
    }

    #[inline]
    pub(super) const fn complex(self) -> Complex {
        Complex { re: self.n, im: self.k }
    }
}

impl From<f64> for ComplexIndex {
    /// That of a medium which does not absorb.
    #[inline]
    fn from(n: f64) -> Self {
        Self { n, k: 0.0 }
    }
}

/// A complex number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Complex {
    pub(super) re: f64,
    pub(super) im: f64,
}

impl Complex {
    pub(super) const ONE: Self = Self { re: 1.0, im: 0.0 };

    #[inline]
    pub(super) const fn real(re: f64) -> Self {
        Self { re, im: 0.0 }
    }

    /// |z|².
    #[inline]
    pub(super) fn norm_squared(self) -> f64 {
        self.re * self.re + self.im * self.im
    }

    #[inline]
    pub(super) fn conjugate(self) -> Self {
        Self { im: -self.im, ..self }
    }

    /// The root whose imaginary part is not negative; of two real ones, the positive.
    #[inline]
    pub(super) fn sqrt(self) -> Self {
        let length = self.norm_squared().sqrt();
        // The larger part from a sum, the other by division, so that neither loses digits.
        let large = (0.5 * (length + self.re.abs())).sqrt();
        if large == 0.0 {
            return Self::real(0.0);
        }
        let small = 0.5 * self.im.abs() / large;
        let (re, im) = if self.re >= 0.0 { (large, small) } else { (small, large) };
        Self { re: if self.im < 0.0 { -re } else { re }, im }
    }

    /// exp(i z).
    #[inline]
    pub(super) fn exp_i(self) -> Self {
        let size = portable::exp(-self.im);
        Self { re: size * portable::cos(self.re), im: size * portable::sin(self.re) }
    }
}

impl Add for Complex {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }
}
impl Sub for Complex {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self { re: self.re - other.re, im: self.im - other.im }
    }
}
impl Mul for Complex {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }
}
impl Mul<f64> for Complex {
    type Output = Self;
    #[inline]
    fn mul(self, s: f64) -> Self {
        Self { re: self.re * s, im: self.im * s }
    }
}
impl Div for Complex {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        (self * other.conjugate()) * (1.0 / other.norm_squared())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_roots_and_fade() {
        for (re, im) in
            [(4.0, 0.0), (-4.0, 0.0), (3.0, 4.0), (-3.0, 4.0), (3.0, -4.0), (-3.0, -4.0), (0.0, 0.0), (1.0, 1e-200)]
        {
            let z = Complex { re, im };
            let root = z.sqrt();
            assert!((root * root - z).norm_squared() < 1e-28, "{z:?}: {root:?}");
            assert!(root.im >= 0.0);
            // The twin: the other root would grow.
            assert!(im == 0.0 && re >= 0.0 || (root * -1.0).im <= 0.0);
        }
        assert_eq!(Complex::real(4.0).sqrt(), Complex::real(2.0));
    }

    #[test]
    fn division_and_exponential() {
        let (a, b) = (Complex { re: 1.0, im: -2.0 }, Complex { re: 0.5, im: 3.0 });
        assert!((a / b * b - a).norm_squared() < 1e-30);
        let turned = Complex { re: std::f64::consts::PI, im: 1.0 }.exp_i();
        assert!((turned + Complex::real(portable::exp(-1.0))).norm_squared() < 1e-30);
    }
}

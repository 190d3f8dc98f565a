//! Dispersion formulas of any form that data sheets use: sums of powers of the wavelength over powers of its distance from a
//! resonance.
//!
//! Follows: the formulas of the refractiveindex.info database (Polyanskiy 2024) and of Zemax's glass catalogues; Herzberger, "Color
//! Correction in Optical Systems and a New Dispersion Formula", Optica Acta 6(3), 1959; Conrady, "Applied Optics and Optical
//! Design", part 2, 1960. Wavelengths λ are micrometres here.

use super::POLE_MARGIN;
use super::fraunhofer::HELIUM_D;
use crate::portable;

/// One term: coefficient · λ^power / (λ² − pole)^order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RationalTerm {
    /// What it is multiplied by, in micrometres to whatever power makes it a number.
    pub coefficient: f64,
    /// The power of the wavelength.
    pub power: f64,
    /// The square of the wavelength of a resonance, in square micrometres; without meaning where `order` is 0.
    pub pole: f64,
    /// How often the distance from the resonance divides: 0 for a plain power.
    pub order: u32,
}

impl RationalTerm {
    /// A plain power: coefficient · λ^power.
    #[must_use]
    pub const fn power(coefficient: f64, power: f64) -> Self {
        Self { coefficient, power, pole: 0.0, order: 0 }
    }

    /// A resonance: coefficient · λ^power / (λ² − pole).
    #[must_use]
    pub const fn resonance(coefficient: f64, power: f64, pole: f64) -> Self {
        Self { coefficient, power, pole, order: 1 }
    }

    fn at(&self, micrometres: f64, squared: f64) -> f64 {
        let numerator = if self.power == 0.0 {
            self.coefficient
        } else if self.power == 2.0 {
            self.coefficient * squared
        } else {
            self.coefficient * portable::pow(micrometres, self.power)
        };
        // No formula has more than a few.
        (0..self.order.min(8)).fold(numerator, |value, _| value / (squared - self.pole))
    }

    /// True where it depends on the wavelength.
    pub(super) fn is_dispersive(&self) -> bool {
        self.coefficient != 0.0 && (self.power != 0.0 || self.order != 0)
    }
}

/// The squared wavelength brought between the two resonances that enclose the d line.
#[inline]
pub(super) fn between_poles(squared: f64, poles: impl Iterator<Item = f64>) -> f64 {
    const D_SQUARED: f64 = HELIUM_D * HELIUM_D * 1e-6;
    let (mut lowest, mut highest) = (0.0_f64, f64::INFINITY);
    for pole in poles {
        if pole < D_SQUARED {
            lowest = lowest.max(pole * (1.0 + POLE_MARGIN));
        } else {
            highest = highest.min(pole * (1.0 - POLE_MARGIN));
        }
    }
    squared.max(lowest).min(highest)
}

/// The sum of terms at a squared wavelength, brought between resonances.
pub(super) fn sum(terms: &[RationalTerm], squared: f64) -> f64 {
    let poles = terms.iter().filter(|term| term.order > 0 && term.coefficient != 0.0).map(|term| term.pole);
    let squared = between_poles(squared, poles);
    let micrometres = squared.sqrt();
    terms.iter().map(|term| term.at(micrometres, squared)).sum()
}

//! A transparent material with all that is known of it, from the catalogue or from a file.

use std::f64::consts::PI;

use snell_math::{Dispersion, portable};

use super::{Entry, Formula, Medium};

/// A transparent material.
///
/// ```
/// use snell_scene::catalogue::{self, Glass};
/// let glass = Glass::from(catalogue::lookup("N-BK7").unwrap());
/// assert!(glass.covers(587.5618) && !glass.covers(200.0));
/// // A centimetre passes 99.8 % of green light.
/// assert!((glass.internal_transmittance(546.0, 10.0).unwrap() - 0.998).abs() < 1e-3);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Glass {
    /// Its name.
    pub name: String,
    /// What it is, in a few words; may be empty.
    pub description: String,
    /// Who measured or printed it; may be empty.
    pub source: String,
    /// What kind of formula gives the index.
    pub formula: String,
    /// The index, by wavelengths in `reference` and relative to it.
    pub dispersion: Dispersion,
    /// The wavelengths in nanometres between which the formula was fitted; `None` for a fixed value.
    pub valid_nm: Option<[f64; 2]>,
    /// What wavelengths are measured in, and what indices are relative to.
    pub reference: Medium,
    /// Pairs of a wavelength in nanometres, ascending, and the coefficient of extinction k; empty where it is not known.
    pub extinction: Vec<[f64; 2]>,
}

impl From<&Entry> for Glass {
    fn from(entry: &Entry) -> Self {
        let formula = match entry.formula {
            Formula::Constant(_) => "constant",
            Formula::Sellmeier(..) => "Sellmeier",
        };
        Self {
            name: entry.key.to_owned(),
            description: entry.description.to_owned(),
            source: entry.source.to_owned(),
            formula: formula.to_owned(),
            dispersion: entry.dispersion(),
            valid_nm: entry.valid_nm,
            reference: entry.reference,
            extinction: entry.extinction().iter().map(|(nm, k)| [f64::from(*nm), f64::from(*k)]).collect(),
        }
    }
}

impl Glass {
    /// True where the formula was fitted to measurements at this wavelength in nanometres, or is a fixed value.
    pub fn covers(&self, wavelength_nm: f64) -> bool {
        self.valid_nm.is_none_or(|[low, high]| (low..=high).contains(&wavelength_nm))
    }

    /// What to tell where the formula is asked for an index outside of its range: names both.
    pub fn outside(&self) -> Option<String> {
        let [low, high] = self.valid_nm?;
        Some(format!(
            "the index of {} was measured from {low} to {high} nm; beyond, its formula is extrapolated",
            self.name
        ))
    }

    /// The share of light that a thickness in millimetres lets through, without what its surfaces reflect; `None` outside of the
    /// wavelengths at which that was measured, between which k is taken as linear.
    pub fn internal_transmittance(&self, wavelength_nm: f64, thickness_mm: f64) -> Option<f64> {
        let after = self.extinction.partition_point(|[nm, _]| *nm < wavelength_nm);
        let [high, k_high] = *self.extinction.get(after)?;
        let k = match after.checked_sub(1).and_then(|before| self.extinction.get(before)) {
            Some([low, k_low]) => k_low + (k_high - k_low) * (wavelength_nm - low) / (high - low),
            None if wavelength_nm == high => k_high,
            None => return None,
        };
        Some(portable::exp(-4.0 * PI * k * thickness_mm * 1e6 / wavelength_nm))
    }

    /// What k is where a thickness in millimetres lets a share of light through; `None` where that is none.
    pub(super) fn extinction_of(wavelength_nm: f64, transmittance: f64, thickness_mm: f64) -> Option<f64> {
        let k = -portable::ln(transmittance) * wavelength_nm / (4.0 * PI * thickness_mm * 1e6);
        (k.is_finite() && transmittance > 0.0 && thickness_mm > 0.0).then_some(k.max(0.0))
    }
}

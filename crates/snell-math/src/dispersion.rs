//! The index of refraction as a function of wavelength.

/// An index of refraction, constant or by a dispersion formula. Wavelengths are vacuum wavelengths in micrometres inside the
/// formulas and nanometres at the door.
#[derive(Clone, Debug, PartialEq)]
pub enum Dispersion {
    /// The same index for every wavelength.
    Constant(f64),
    /// Cauchy: n = Σ cᵢ / λ²ⁱ, λ in micrometres.
    Cauchy(Vec<f64>),
    /// Sellmeier: n² = 1 + c₀ + Σ bᵢ λ² / (λ² − cᵢ), λ and √cᵢ in micrometres.
    Sellmeier {
        /// The constant c₀, most often 0.
        constant: f64,
        /// Pairs (bᵢ, cᵢ), cᵢ in square micrometres.
        terms: Vec<(f64, f64)>,
    },
}

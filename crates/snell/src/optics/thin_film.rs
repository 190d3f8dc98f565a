//! A thin film on a boundary: soap bubbles, oil on water, oxide on metal, coated lenses.
//!
//! Follows: Airy's summation of all that goes to and fro in the film, Born and Wolf, "Principles of Optics", 7th edition, section 7.6.1;
//! Belcour and Barla, "A Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence", ACM TOG 36(4) (SIGGRAPH), 2017, whose
//! sum over the spectrum is not needed where each wavelength is traced by itself; Byrnes, "Multilayer optical calculations",
//! arXiv:1603.02720, for power in absorbing media.
//!
//! All wavelengths and thicknesses are nanometres, wavelengths in vacuum.

use std::f64::consts::PI;

use super::complex::{Complex, ComplexIndex};
use super::conductor::{amplitudes, cosine_within};

/// A film between two media.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinFilm {
    /// Its index of refraction, at the wavelength asked for.
    pub index: ComplexIndex,
    /// Its thickness in nanometres. Films of more than some micrometres show no colours to the eye: wavelengths are then
    /// best asked for without one.
    pub thickness_nm: f64,
}

/// The shares of power that a film reflects and lets through, perpendicular (s) and parallel (p) to the plane of incidence. What
/// is missing to one is absorbed in the film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmShares {
    /// Reflected.
    pub reflected: [f64; 2],
    /// Transmitted into the medium behind, just below its surface.
    pub transmitted: [f64; 2],
}

impl FilmShares {
    /// Of unpolarised light: reflected, transmitted.
    #[inline]
    #[must_use]
    pub fn unpolarized(&self) -> [f64; 2] {
        [self.reflected, self.transmitted].map(|[s, p]| 0.5 * (s + p))
    }
}

/// What a film does with light of one wavelength, which arrives in a transparent medium of index `eta_i` under an angle with the
/// cosine `cos_i` in [0, 1] (values outside count as the nearer end); behind the film is a medium of index `index_t`.
///
/// ```
/// use snell::optics::{ThinFilm, thin_film};
/// // Magnesium fluoride, a quarter of a wave thick, on glass: 1.3 % are reflected instead of 4.3 %.
/// let coating = ThinFilm { index: 1.38.into(), thickness_nm: 550.0 / (4.0 * 1.38) };
/// let [reflected, transmitted] = thin_film(1.0, 1.0, coating, 1.52.into(), 550.0).unpolarized();
/// assert!((reflected - 0.0126).abs() < 1e-4 && (reflected + transmitted - 1.0).abs() < 1e-12);
/// ```
#[must_use]
pub fn thin_film(cos_i: f64, eta_i: f64, film: ThinFilm, index_t: ComplexIndex, wavelength_nm: f64) -> FilmShares {
    let cos_i = cos_i.clamp(0.0, 1.0);
    if cos_i == 0.0 {
        return FilmShares { reflected: [1.0; 2], transmitted: [0.0; 2] };
    }
    let tangential = eta_i * ((1.0 - cos_i) * (1.0 + cos_i)).sqrt();
    let (eta_f, eta_t) = (film.index.complex(), index_t.complex());
    let (cos_f, cos_t) = (cosine_within(tangential, eta_f), cosine_within(tangential, eta_t));
    let (first, into) = amplitudes(Complex::real(eta_i), Complex::real(cos_i), eta_f, cos_f);
    let (second, out) = amplitudes(eta_f, cos_f, eta_t, cos_t);
    // How far a wave turns, and fades, on one way through.
    let phase = eta_f * cos_f * (2.0 * PI * film.thickness_nm.max(0.0) / wavelength_nm);
    let once = phase.exp_i();
    let twice = once * once;
    // The flux through a surface goes with Re(η c), of parallel light with Re(η c*).
    let behind = [(eta_t * cos_t).re, (eta_t * cos_t.conjugate()).re].map(|flux| flux.max(0.0) / (eta_i * cos_i));
    let mut shares = FilmShares { reflected: [0.0; 2], transmitted: [0.0; 2] };
    for i in 0..2 {
        let all = Complex::ONE + first[i] * second[i] * twice;
        let reflected = (first[i] + second[i] * twice) / all;
        let transmitted = into[i] * out[i] * once / all;
        shares.reflected[i] = reflected.norm_squared().min(1.0);
        shares.transmitted[i] = (transmitted.norm_squared() * behind[i]).min(1.0);
    }
    shares
}

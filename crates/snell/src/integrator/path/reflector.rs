//! How much of light a boundary reflects, by wavelength and angle: glass, metals, and thin films on both.

use snell_math::spectrum::HERO_WAVELENGTHS;
use snell_scene::scene;

use super::spectra::Spectral;
use crate::optics::{ComplexIndex, Metal, ThinFilm, fresnel_conductor, fresnel_dielectric, thin_film};

/// A film at the wavelengths of a path.
pub type FilmAt = [ThinFilm; HERO_WAVELENGTHS];

/// A boundary at the wavelengths of a path.
#[derive(Clone, Copy, Debug)]
pub struct Reflector {
    /// The indices of refraction on the side of `wo`.
    pub before: Spectral,
    beyond: Beyond,
    film: Option<FilmAt>,
    nm: Spectral,
}

#[derive(Clone, Copy, Debug)]
enum Beyond {
    Dielectric(Spectral),
    Metal([ComplexIndex; HERO_WAVELENGTHS]),
}

impl Reflector {
    /// The boundary between two transparent bodies.
    pub fn dielectric(before: Spectral, beyond: Spectral, film: Option<FilmAt>, nm: Spectral) -> Self {
        Self { before, beyond: Beyond::Dielectric(beyond), film, nm }
    }

    /// The surface of a metal.
    pub fn metal(before: Spectral, metal: &Metal, film: Option<FilmAt>, nm: Spectral) -> Self {
        let index = nm.map(|nm| metal.index(nm));
        Self { before, beyond: Beyond::Metal(index), film, nm }
    }

    /// The indices of refraction on the other side; those of this one for a metal, which light does not enter.
    pub fn beyond(&self) -> Spectral {
        match self.beyond {
            Beyond::Dielectric(beyond) => beyond,
            Beyond::Metal(_) => self.before,
        }
    }

    /// The share of light of one of the wavelengths that is reflected, by the cosine with the normal in [0, 1].
    #[inline]
    pub fn share(&self, wavelength: usize, cosine: f64) -> f64 {
        let before = self.before[wavelength];
        if let Some(films) = &self.film {
            let beyond = match self.beyond {
                Beyond::Dielectric(beyond) => beyond[wavelength].into(),
                Beyond::Metal(index) => index[wavelength],
            };
            let [reflected, _] =
                thin_film(cosine, before, films[wavelength], beyond, self.nm[wavelength]).unpolarized();
            return reflected.min(1.0);
        }
        match self.beyond {
            Beyond::Dielectric(beyond) => fresnel_dielectric(cosine, before, beyond[wavelength]),
            Beyond::Metal(index) => fresnel_conductor(cosine, before, index[wavelength]),
        }
    }

    /// Those of all wavelengths.
    #[inline]
    pub fn shares(&self, cosine: f64) -> Spectral {
        std::array::from_fn(|wavelength| self.share(wavelength, cosine))
    }

    /// True where wavelengths go different ways beyond.
    #[inline]
    pub fn disperses(&self) -> bool {
        let differ = |indices: Spectral| indices.iter().any(|index| *index != indices[0]);
        match self.beyond {
            Beyond::Dielectric(beyond) => differ(self.before) || differ(beyond),
            Beyond::Metal(_) => false,
        }
    }
}

/// A film of a thickness in nanometres at wavelengths.
pub fn film_at(film: &scene::Film, thickness_nm: f64, nm: Spectral) -> FilmAt {
    nm.map(|nm| ThinFilm { index: film.ior.index(nm).into(), thickness_nm })
}

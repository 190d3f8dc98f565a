//! What surfaces do with light, and what solids do with the light inside.

use std::f64::consts::PI;

use snell_math::spectrum::{MeasuredSpectrum, Spectrum};
use snell_math::{Dispersion, Rgb};

use super::texture::Texture;
use crate::catalogue;
use crate::table::Id;

/// A material: the lecture's terms, each of which may be absent.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Material {
    /// Its name, where the author gave one.
    pub name: Option<String>,
    /// Light it gives off by itself, unlit and casting none: the colour of a lamp or of a photograph to stand behind things.
    pub emission: Option<Id<Texture>>,
    /// The spectrum of that light, where the author gave one; `emission` is its colour. Relative to equal energy of luminance 1.
    pub emission_spectrum: Option<Spectrum>,
    /// The factor on the scene's ambient light; where absent, the diffuse colour.
    pub ambient: Option<Id<Texture>>,
    /// Diffuse reflectance: Lambert's cosine.
    pub diffuse: Option<Id<Texture>>,
    /// Strength and colour of the highlight (Phong's: the cosine between mirrored view and light to the power `shininess`).
    pub specular: Option<Id<Texture>>,
    /// The highlight's exponent, at least 0.
    pub shininess: f32,
    /// The fixed coefficient of the mirrored ray; 0 spawns none.
    pub mirror: Option<Id<Texture>>,
    /// Where it is transparent.
    pub dielectric: Option<Dielectric>,
    /// Where it is a metal.
    pub metal: Option<Metal>,
    /// Seen and lit from its outward side alone, as the Standard Procedural Databases take their opaque surfaces: light
    /// from behind the outward normal gives nothing, from wherever the surface is seen.
    pub one_sided: bool,
}

/// A transparent body: its boundary and its inside.
#[derive(Clone, Debug, PartialEq)]
pub struct Dielectric {
    /// The index of refraction.
    pub ior: Dispersion,
    /// What paths take for it, where `ior` is one that the lecture prints of a material that was measured.
    pub measured_ior: Option<Dispersion>,
    /// Reflection and transmission follow Fresnel's equations, and the coefficients below scale them; or else the
    /// coefficients are the shares themselves. Under total internal reflection all light is reflected either way.
    pub fresnel: bool,
    /// The coefficient of the reflected ray.
    pub reflect: Id<Texture>,
    /// The coefficient of the refracted ray.
    pub transmit: Id<Texture>,
    /// How rough the boundary is, from 0, which is smooth, to 1.
    pub roughness: f32,
    /// A thin film on it.
    pub film: Option<Film>,
    /// What light meets inside.
    pub medium: Medium,
    /// What it absorbs at each wavelength, where that was measured; the medium's absorption is the colour of it.
    pub extinction: Option<Extinction>,
    /// Where bodies overlap, the one of higher priority is there; at equal priority, the one entered last.
    pub priority: i32,
}

/// What a material absorbs, as it was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Extinction {
    /// The coefficient of extinction k, the imaginary part of the index, by wavelength.
    pub k: MeasuredSpectrum,
    /// How many millimetres a world unit is long.
    pub unit_mm: f64,
}

impl Extinction {
    /// The coefficient of absorption at a wavelength in nanometres, per world unit: 4π k / λ (Born and Wolf, "Principles of Optics",
    /// section 14.1).
    ///
    /// ```
    /// use snell_math::spectrum::MeasuredSpectrum;
    /// use snell_scene::scene::Extinction;
    /// let k = MeasuredSpectrum::new(vec![500.0], vec![1e-7]).unwrap();
    /// let per_metre = Extinction { k, unit_mm: 1000.0 }.coefficient(500.0);
    /// assert!((per_metre - 4.0 * std::f64::consts::PI * 1e-7 / 500e-9).abs() < 1e-12);
    /// ```
    pub fn coefficient(&self, wavelength_nm: f64) -> f64 {
        4.0 * PI * self.k.at(wavelength_nm).max(0.0) / (wavelength_nm * 1e-6) * self.unit_mm
    }
}

/// A thin film on a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Its thickness in nanometres; where it varies, that where the texture is black.
    pub thickness_nm: f64,
    /// How it varies, where it does.
    pub variation: Option<FilmVariation>,
    /// Its index of refraction.
    pub ior: Dispersion,
}

/// How the thickness of a film differs from place to place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmVariation {
    /// The thickness in nanometres where the texture is white.
    pub to_nm: f64,
    /// The texture, of which the mean of the components counts, from 0 to 1.
    pub by: Id<Texture>,
}

/// A metal's surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Metal {
    /// What it is.
    pub index: MetalIndex,
    /// How rough it is, from 0, which is a mirror, to 1.
    pub roughness: f32,
    /// A thin film on it.
    pub film: Option<Film>,
}

/// What a metal is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MetalIndex {
    /// One whose indices were measured.
    Measured(&'static catalogue::Metal),
    /// One complex index n + i k at all wavelengths.
    Constant([f64; 2]),
    /// One that reflects this colour of white light that falls on it straight.
    Color(Rgb),
}

/// The inside of a transparent body. Coefficients are per world unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Medium {
    /// Absorption: after distance d a share exp(−absorption · d) is left (Beer and Lambert).
    pub absorption: Rgb,
    /// Scattering: what a milky body does; black where it is clear.
    pub scattering: Rgb,
    /// The mean cosine of scattering in (−1, 1): forward above 0 (Henyey and Greenstein's g).
    pub anisotropy: f32,
}

impl Medium {
    /// True where light passes unchanged.
    pub fn is_clear(&self) -> bool {
        self.absorption.is_black() && self.scattering.is_black()
    }
}

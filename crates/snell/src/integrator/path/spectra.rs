//! Colours of the scene at the wavelengths of a path: materials, lights, and the insides of bodies.
//!
//! A colour that is the same everywhere becomes a smooth spectrum once, when the integrator is made; one of a texture is a mixture
//! of those of a lattice, at each hit. See [`snell_math::spectrum`].

use std::sync::LazyLock;

use snell_math::spectrum::{HERO_WAVELENGTHS, HeroWavelengths, SmoothLattice, SmoothReflectance};
use snell_math::{Rgb, portable};
use snell_scene::scene::{Extinction, Medium};

/// Values at the wavelengths of a path.
pub type Spectral = [f64; HERO_WAVELENGTHS];

/// Nothing at any wavelength.
pub const BLACK: Spectral = [0.0; HERO_WAVELENGTHS];
/// One at all wavelengths.
pub const WHITE: Spectral = [1.0; HERO_WAVELENGTHS];

/// The product, wavelength by wavelength.
#[inline]
pub fn times(a: Spectral, b: Spectral) -> Spectral {
    std::array::from_fn(|i| a[i] * b[i])
}

/// All values times a factor.
#[inline]
pub fn scaled(a: Spectral, factor: f64) -> Spectral {
    a.map(|value| value * factor)
}

/// The sum, wavelength by wavelength.
#[inline]
pub fn plus(a: Spectral, b: Spectral) -> Spectral {
    std::array::from_fn(|i| a[i] + b[i])
}

/// The mean of the values.
#[inline]
pub fn mean(a: Spectral) -> f64 {
    a.iter().sum::<f64>() / HERO_WAVELENGTHS as f64
}

/// The largest of the values.
#[inline]
pub fn largest(a: Spectral) -> f64 {
    a.into_iter().fold(0.0, f64::max)
}

/// True where no value is above 0.
#[inline]
pub fn is_black(a: Spectral) -> bool {
    a.iter().all(|value| *value == 0.0)
}

/// A reflectance or transmittance in [0, 1], ready for any wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reflectance {
    /// The same at all wavelengths.
    Gray(f64),
    /// A smooth spectrum.
    Smooth(SmoothReflectance),
}

impl Reflectance {
    /// Of a colour, clamped to [0, 1].
    pub fn new(color: Rgb) -> Self {
        match gray(color) {
            Some(value) => Self::Gray(value.clamp(0.0, 1.0)),
            None => Self::Smooth(SmoothReflectance::new(color)),
        }
    }

    /// At wavelengths in nanometres.
    #[inline]
    pub fn at(&self, nm: Spectral) -> Spectral {
        match self {
            Self::Gray(value) => [*value; HERO_WAVELENGTHS],
            Self::Smooth(smooth) => nm.map(|nm| smooth.at(nm)),
        }
    }
}

/// The value of a colour without hue.
#[inline]
fn gray(color: Rgb) -> Option<f64> {
    (color.r == color.g && color.g == color.b).then_some(f64::from(color.r))
}

/// The colours of textures at wavelengths.
#[derive(Debug)]
pub struct Colors {
    /// Milliseconds of work, which a scene of constant colours need not wait for.
    lattice: LazyLock<SmoothLattice>,
}

impl Colors {
    /// The spectra of the lattice are found when they are first asked for.
    pub fn new() -> Self {
        Self { lattice: LazyLock::new(SmoothLattice::new) }
    }

    /// A reflectance in [0, 1] at wavelengths in nanometres.
    #[inline]
    pub fn reflectance(&self, color: Rgb, nm: Spectral) -> Spectral {
        match gray(color) {
            Some(value) => [value.clamp(0.0, 1.0); HERO_WAVELENGTHS],
            None => {
                let mixture = self.lattice.mixture(color);
                nm.map(|nm| mixture.at(nm))
            }
        }
    }

    /// Light of a colour, at wavelengths whose share of white light is `white`.
    #[inline]
    pub fn light(&self, color: Rgb, nm: Spectral, white: Spectral) -> Spectral {
        let color = color.map(|component| component.max(0.0));
        match gray(color) {
            Some(value) => scaled(white, value),
            None => {
                // As in `SmoothEmission`: half as bright as a reflectance can be, where spectra are smooth.
                let scale = 2.0 * color.max_abs();
                let mixture = self.lattice.mixture(color * (1.0 / scale));
                times(nm.map(|nm| f64::from(scale) * mixture.at(nm)), white)
            }
        }
    }
}

/// What a body does to light inside, per world unit of length.
#[derive(Clone, Debug)]
pub struct BodySpectra {
    absorption: Option<Absorption>,
    scattering: Option<Coefficient>,
    /// The mean cosine of scattering.
    pub anisotropy: f64,
}

/// What a body absorbs: as a colour, or as it was measured.
#[derive(Clone, Debug)]
enum Absorption {
    Color(Coefficient),
    Measured(Extinction),
}

impl Absorption {
    fn at(&self, nm: Spectral) -> Spectral {
        match self {
            Self::Color(coefficient) => coefficient.at(nm),
            Self::Measured(extinction) => nm.map(|nm| extinction.coefficient(nm)),
        }
    }
}

/// A coefficient of extinction as the transmittance of a slab, whose colour a smooth spectrum has.
#[derive(Clone, Copy, Debug)]
struct Coefficient {
    transmittance: Reflectance,
    /// The slab's thickness.
    distance: f64,
}

impl Coefficient {
    fn new(coefficient: Rgb) -> Option<Self> {
        if coefficient.is_black() {
            return None;
        }
        // A slab that lets half of the light through on the whole: where colours are best told apart.
        let distance = std::f64::consts::LN_2 / f64::from(coefficient.mean());
        let transmittance = coefficient.map(|c| portable::exp(-f64::from(c) * distance) as f32);
        Some(Self { transmittance: Reflectance::new(transmittance), distance })
    }

    fn at(&self, nm: Spectral) -> Spectral {
        self.transmittance.at(nm).map(|transmittance| -portable::ln(transmittance.max(1e-12)) / self.distance)
    }
}

impl BodySpectra {
    /// `None` where light passes unchanged.
    pub fn new(medium: &Medium, extinction: Option<&Extinction>) -> Option<Self> {
        let absorption = match extinction {
            Some(extinction) => Some(Absorption::Measured(extinction.clone())),
            None => Coefficient::new(medium.absorption).map(Absorption::Color),
        };
        let scattering = Coefficient::new(medium.scattering);
        let anisotropy = f64::from(medium.anisotropy);
        (absorption.is_some() || scattering.is_some()).then_some(Self { absorption, scattering, anisotropy })
    }

    /// The coefficients of absorption and scattering.
    pub fn at(&self, nm: Spectral) -> [Spectral; 2] {
        let absorption = self.absorption.as_ref().map_or(BLACK, |absorption| absorption.at(nm));
        [absorption, self.scattering.map_or(BLACK, |coefficient| coefficient.at(nm))]
    }

    /// The share of light that is left after a distance.
    pub fn transmittance(&self, nm: Spectral, distance: f64) -> Spectral {
        let [absorption, scattering] = self.at(nm);
        plus(absorption, scattering).map(|extinction| attenuated(extinction, distance))
    }
}

/// exp(−σ d), where nothing is lost to σ = 0 on an endless way.
#[inline]
pub fn attenuated(extinction: f64, distance: f64) -> f64 {
    if extinction > 0.0 { portable::exp(-extinction * distance) } else { 1.0 }
}

/// The wavelengths of a sample, and what it takes to turn values at them into colours.
#[derive(Clone, Copy, Debug)]
pub struct Wavelengths {
    hero: HeroWavelengths,
    /// White light at them.
    pub white: Spectral,
    /// The colour of the value 1 at each.
    colors: [[f64; 3]; HERO_WAVELENGTHS],
}

impl Wavelengths {
    /// Four wavelengths by a number in [0, 1).
    pub fn sample(u: f64) -> Self {
        let hero = HeroWavelengths::sample(u);
        Self { hero, white: hero.nm().map(snell_math::spectrum::d65), colors: colors(&hero) }
    }

    /// In nanometres.
    #[inline]
    pub fn nm(&self) -> Spectral {
        self.hero.nm()
    }

    /// The hero, in nanometres.
    #[inline]
    pub fn hero_nm(&self) -> f64 {
        self.hero.nm()[0]
    }

    /// True where the others were given up.
    #[inline]
    pub fn is_hero_alone(&self) -> bool {
        self.hero.is_hero_alone()
    }

    /// Gives up all but the hero.
    pub fn give_up_others(&mut self) {
        if !self.is_hero_alone() {
            self.hero = self.hero.hero_alone();
            self.colors = colors(&self.hero);
        }
    }

    /// Shares of light as one number, the mean of the wavelengths that are carried, in all components: what a watcher is told.
    pub fn in_gray(&self, shares: Spectral) -> Rgb {
        Rgb::gray(if self.is_hero_alone() { shares[0] } else { mean(shares) } as f32)
    }

    /// The colour that values have in expectation.
    #[inline]
    pub fn color(&self, values: Spectral) -> Rgb {
        let mut sum = [0.0; 3];
        for (value, color) in values.into_iter().zip(&self.colors) {
            for (sum, component) in sum.iter_mut().zip(color) {
                *sum += value * component;
            }
        }
        Rgb::from(sum.map(|component| component as f32))
    }
}

fn colors(hero: &HeroWavelengths) -> [[f64; 3]; HERO_WAVELENGTHS] {
    std::array::from_fn(|i| {
        let mut one = BLACK;
        one[i] = 1.0;
        hero.to_linear_srgb(one)
    })
}

//! Spectra of every kind that a scene can give: smooth ones of colours, black bodies, daylight, and measured values.
//!
//! Wavelengths are nanometres in vacuum; values are reflectances or transmittances in [0, 1], or radiances relative to the
//! equal-energy spectrum of Y = 1. Measured values are joined by straight lines, as CIE 167:2005 has it for spectra
//! of one or five nanometres' steps, and stay at the ends' values beyond them.

use super::{
    Daylight, HERO_WAVELENGTHS, HeroWavelengths, SmoothEmission, SmoothReflectance, VISIBLE_NM, blackbody,
    color_matching, spectrum_to_xyz, xyz_to_rgb,
};
use crate::Rgb;

/// A function of wavelength.
///
/// ```
/// use snell_math::spectrum::{HeroWavelengths, Spectrum};
/// let lamp = Spectrum::blackbody(2856.0).scaled(5.0);
/// let wavelengths = HeroWavelengths::sample(0.25);
/// assert_eq!(lamp.at_each(&wavelengths)[0], lamp.at(wavelengths.nm()[0]));
/// assert!(lamp.at(700.0) > 4.0 * lamp.at(450.0));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Spectrum {
    /// The same at all wavelengths; as a light, the equal-energy illuminant E of this Y.
    Constant(f64),
    /// Of a colour, between 0 and 1.
    Reflectance(SmoothReflectance),
    /// Of the light of a colour.
    Emission(SmoothEmission),
    /// Planck's law, with a factor: see [`Spectrum::blackbody`].
    Blackbody {
        /// In kelvin.
        temperature_kelvin: f64,
        /// What Planck's radiance, in W/(sr m³), is multiplied by.
        scale: f64,
    },
    /// Daylight, with a factor.
    Daylight(Daylight, f64),
    /// Measured values, with a factor.
    Measured(MeasuredSpectrum, f64),
}

impl Spectrum {
    /// A black body, scaled to Y = 1. Temperatures outside 500 to 10⁶ kelvin count as the nearer of these.
    #[must_use]
    pub fn blackbody(temperature_kelvin: f64) -> Self {
        let temperature_kelvin = if temperature_kelvin > 500.0 { temperature_kelvin.min(1e6) } else { 500.0 };
        let luminance = spectrum_to_xyz(|nm| blackbody(temperature_kelvin, nm))[1];
        Self::Blackbody { temperature_kelvin, scale: 1.0 / luminance }
    }

    /// The CIE's illuminant A, a filament lamp: a black body of 2848 K with the constant c₂ = 0.014 35 m K of its time, which is one of
    /// 2855.5 K by today's (CIE 015:2018, section 4.1.1). Scaled to Y = 1.
    #[must_use]
    pub fn illuminant_a() -> Self {
        Self::blackbody(2848.0 * 0.014_387_768_8 / 0.014_35)
    }

    /// Light of measured values, scaled to Y = 1; `None` where they have nothing that eyes see.
    ///
    /// ```
    /// use snell_math::spectrum::{MeasuredSpectrum, Spectrum};
    /// let sodium = MeasuredSpectrum::new(vec![588.0, 589.3, 590.6], vec![0.0, 7.0, 0.0]).unwrap();
    /// let [r, g, b] = Spectrum::light(sodium).unwrap().to_rgb().to_array();
    /// assert!(r > g && g > 0.0 && b == 0.0);
    /// ```
    #[must_use]
    pub fn light(measured: MeasuredSpectrum) -> Option<Self> {
        let spectrum = Self::Measured(measured, 1.0);
        let [_, luminance, _] = spectrum.to_xyz();
        (luminance > 0.0 && luminance.is_finite()).then(|| spectrum.scaled(1.0 / luminance))
    }

    /// The tristimulus values, as [`spectrum_to_xyz`] has them, which asks at every nanometre; here measured values are asked at
    /// every tenth of one, so that no narrow line is missed.
    #[must_use]
    pub fn to_xyz(&self) -> [f64; 3] {
        let Self::Measured(..) = self else { return spectrum_to_xyz(|nm| self.at(nm)) };
        let (mut sum, mut luminous) = ([0.0; 3], 0.0);
        for tenth in 10 * VISIBLE_NM[0] as u32..=10 * VISIBLE_NM[1] as u32 {
            let nm = f64::from(tenth) / 10.0;
            let (observer, value) = (color_matching(nm), self.at(nm));
            for (sum, response) in sum.iter_mut().zip(observer) {
                *sum += response * value;
            }
            luminous += observer[1];
        }
        sum.map(|sum| sum / luminous)
    }

    /// The colour as light, brought into the gamut of sRGB by leaving out what is negative.
    #[must_use]
    pub fn to_rgb(&self) -> Rgb {
        xyz_to_rgb(self.to_xyz()).map(|component| component.max(0.0))
    }

    /// This times a factor. A reflectance becomes measured values, every 5 nm, since no factor keeps it below 1.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        match self {
            Self::Constant(value) => Self::Constant(value * factor),
            Self::Reflectance(reflectance) => {
                let nm: Vec<f64> = (0..=94).map(|i| 360.0 + 5.0 * f64::from(i)).collect();
                let values = nm.iter().map(|nm| reflectance.at(*nm)).collect();
                Self::Measured(MeasuredSpectrum { wavelengths_nm: nm, values }, factor)
            }
            Self::Emission(emission) => Self::Emission(emission.scaled(factor)),
            Self::Blackbody { temperature_kelvin, scale } => {
                Self::Blackbody { temperature_kelvin, scale: scale * factor }
            }
            Self::Daylight(daylight, scale) => Self::Daylight(daylight, scale * factor),
            Self::Measured(measured, scale) => Self::Measured(measured, scale * factor),
        }
    }

    /// Its value at a wavelength.
    #[inline]
    #[must_use]
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Reflectance(reflectance) => reflectance.at(wavelength_nm),
            Self::Emission(emission) => emission.at(wavelength_nm),
            Self::Blackbody { temperature_kelvin, scale } => scale * blackbody(*temperature_kelvin, wavelength_nm),
            Self::Daylight(daylight, scale) => scale * daylight.radiance(wavelength_nm),
            Self::Measured(measured, scale) => scale * measured.at(wavelength_nm),
        }
    }

    /// Its values at the wavelengths of a path.
    #[inline]
    #[must_use]
    pub fn at_each(&self, wavelengths: &HeroWavelengths) -> [f64; HERO_WAVELENGTHS] {
        wavelengths.nm().map(|nm| self.at(nm))
    }
}

/// Values at ascending wavelengths, joined by straight lines.
///
/// ```
/// use snell_math::spectrum::MeasuredSpectrum;
/// let filter = MeasuredSpectrum::new(vec![400.0, 500.0, 700.0], vec![0.0, 0.5, 0.1]).unwrap();
/// assert_eq!([filter.at(300.0), filter.at(450.0), filter.at(800.0)], [0.0, 0.25, 0.1]);
/// assert!(MeasuredSpectrum::new(vec![500.0, 400.0], vec![1.0, 1.0]).is_err());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredSpectrum {
    wavelengths_nm: Vec<f64>,
    values: Vec<f64>,
}

/// Why numbers are no spectrum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasuredSpectrumError {
    /// There are none, or not as many values as wavelengths.
    Count {
        /// How many wavelengths.
        wavelengths: usize,
        /// How many values.
        values: usize,
    },
    /// A wavelength is not above the one before it, or no number.
    Order {
        /// Which, from 0.
        index: usize,
    },
    /// A value is NaN or infinite.
    Value {
        /// Which, from 0.
        index: usize,
    },
}

impl std::fmt::Display for MeasuredSpectrumError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Count { wavelengths, values } => {
                write!(f, "a spectrum needs as many values as wavelengths, at least one: {wavelengths} and {values}")
            }
            Self::Order { index } => write!(f, "wavelength {} of the spectrum is not above the one before", index + 1),
            Self::Value { index } => write!(f, "value {} of the spectrum is no finite number", index + 1),
        }
    }
}

impl std::error::Error for MeasuredSpectrumError {}

impl MeasuredSpectrum {
    /// From wavelengths in nanometres and the values there.
    ///
    /// # Errors
    /// [`MeasuredSpectrumError`] where they are not as many, or none, do not ascend or are not finite.
    pub fn new(wavelengths_nm: Vec<f64>, values: Vec<f64>) -> Result<Self, MeasuredSpectrumError> {
        if wavelengths_nm.len() != values.len() || values.is_empty() {
            return Err(MeasuredSpectrumError::Count { wavelengths: wavelengths_nm.len(), values: values.len() });
        }
        let mut before = f64::NEG_INFINITY;
        for (index, nm) in wavelengths_nm.iter().enumerate() {
            if !(nm.is_finite() && *nm > before) {
                return Err(MeasuredSpectrumError::Order { index });
            }
            before = *nm;
        }
        match values.iter().position(|value| !value.is_finite()) {
            Some(index) => Err(MeasuredSpectrumError::Value { index }),
            None => Ok(Self { wavelengths_nm, values }),
        }
    }

    /// The value at a wavelength; beyond the ends, that of the nearer one.
    #[must_use]
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        let after = self.wavelengths_nm.partition_point(|nm| *nm <= wavelength_nm);
        let last = self.values.len() - 1;
        if after == 0 || after > last {
            return self.values[after.min(last)];
        }
        let (low, high) = (self.wavelengths_nm[after - 1], self.wavelengths_nm[after]);
        let fraction = (wavelength_nm - low) / (high - low);
        self.values[after - 1] * (1.0 - fraction) + self.values[after] * fraction
    }

    /// From where to where it was measured, in nanometres.
    #[must_use]
    pub fn range_nm(&self) -> [f64; 2] {
        [self.wavelengths_nm[0], self.wavelengths_nm[self.wavelengths_nm.len() - 1]]
    }
}

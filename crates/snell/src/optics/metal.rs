//! Metals by what is known of them: measured indices, one index, or a colour.

use snell_math::Rgb;
use snell_math::spectrum::{SmoothReflectance, d65, spectrum_to_rgb};
use snell_scene::scene::MetalIndex;

use super::complex::ComplexIndex;
use super::conductor::{fresnel_conductor, fresnel_conductor_average};

/// A metal, ready for any wavelength.
///
/// ```
/// use snell::optics::Metal;
/// use snell::scene::{catalogue, scene::MetalIndex};
/// let gold = Metal::new(MetalIndex::Measured(catalogue::metal("gold").unwrap()));
/// let color = gold.color();
/// assert!(color.r > 0.9 && color.b < 0.5, "{color:?}");
/// assert!(gold.average(450.0) < gold.average(650.0));
/// ```
#[derive(Clone, Debug)]
pub struct Metal {
    kind: Kind,
    /// The share of light from everywhere that it reflects, at [`AVERAGES_NM`].
    averages: Vec<f64>,
}

#[derive(Clone, Debug)]
enum Kind {
    Measured(&'static snell_scene::catalogue::Metal),
    Constant(ComplexIndex),
    Color(SmoothReflectance),
}

/// Where averages are known: the first wavelength, the last, and the step, in nanometres.
const AVERAGES_NM: [f64; 3] = [360.0, 830.0, 10.0];

impl Metal {
    /// From the scene's.
    #[must_use]
    pub fn new(index: MetalIndex) -> Self {
        let kind = match index {
            MetalIndex::Measured(measured) => Kind::Measured(measured),
            MetalIndex::Constant([n, k]) => Kind::Constant(ComplexIndex::new(n, k)),
            MetalIndex::Color(color) => Kind::Color(SmoothReflectance::new(color)),
        };
        let mut metal = Self { kind, averages: Vec::new() };
        let [first, last, step] = AVERAGES_NM;
        let count = ((last - first) / step) as u32 + 1;
        metal.averages =
            (0..count).map(|row| fresnel_conductor_average(1.0, metal.index(first + step * f64::from(row)))).collect();
        metal
    }

    /// n + i k at a wavelength in nanometres.
    #[must_use]
    pub fn index(&self, nm: f64) -> ComplexIndex {
        match &self.kind {
            Kind::Measured(measured) => {
                let [n, k] = measured.index(nm);
                ComplexIndex::new(n, k)
            }
            Kind::Constant(index) => *index,
            Kind::Color(color) => index_of_reflectance(color.at(nm)),
        }
    }

    /// The share of light from everywhere that it reflects in air.
    #[must_use]
    pub fn average(&self, nm: f64) -> f64 {
        let [first, _, step] = AVERAGES_NM;
        let position = ((nm - first) / step).clamp(0.0, (self.averages.len() - 1) as f64);
        let row = (position as usize).min(self.averages.len() - 2);
        let fraction = position - row as f64;
        self.averages[row] * (1.0 - fraction) + self.averages[row + 1] * fraction
    }

    /// The colour of white light that falls on it straight.
    #[must_use]
    pub fn color(&self) -> Rgb {
        spectrum_to_rgb(|nm| fresnel_conductor(1.0, 1.0, self.index(nm)) * d65(nm))
    }
}

/// A complex index whose surface reflects that share of light that falls on it straight.
///
/// Gulbrandsen, "Artist Friendly Metallic Fresnel", JCGT 3(4), 2014, with the smallest n that there is: metals' own are like that.
fn index_of_reflectance(share: f64) -> ComplexIndex {
    let share = share.clamp(0.0, 0.999);
    let n = (1.0 - share) / (1.0 + share);
    let k = ((share * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - share)).max(0.0).sqrt();
    ComplexIndex::new(n, k)
}

//! Into which wavelength bands white light splits at a boundary, and each body's index of refraction in them.
//!
//! The bands of one split carry exactly white together (see [`Bands`]). How many there are follows from what can be seen: as
//! many as keep neighbouring bands within [`TOLERANCE`] pixels of each other where they leave the boundary, at most as many as
//! the author allows; where all fit, light is not split at all. The samples of a pixel split at different places, so that
//! their mean has seen many more wavelengths than each of them.

use snell_math::dispersion::fraunhofer::SODIUM_D;
use snell_math::spectrum::Bands;
use snell_math::{Normal3, Rgb, Vector3};

use crate::compile::CompiledScene;
use crate::optics::refract;
use crate::task::{Band, Inside};

/// How far the directions of neighbouring bands may be apart, in the angle that a pixel is seen under.
const TOLERANCE: f64 = 1.5;
/// Where most of the colour is, in nanometres: the directions of these are compared.
const ENDS_NM: [f64; 2] = [420.0, 670.0];
/// The samples of a pixel split at borders shifted by these sixteenths of a band, in turn; the van der Corput sequence, so
/// that the first few are as even as all.
const SHIFTS: [u8; 16] = [0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15];
/// The numbers of bands that there are splits of, up to what the author allows.
const COUNTS: [u32; 11] = [2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64];

/// All splits of white light that a rendering may use, and the indices of refraction of its bodies in their bands.
#[derive(Clone, Debug)]
pub struct Dispersion {
    /// The bands of all splits, one split after the other.
    weights: Vec<Rgb>,
    /// For each number of bands, in ascending order, its splits by shift: from where to where in `weights`.
    splits: Vec<(u32, [(u16, u16); SHIFTS.len()])>,
    /// For each material; `None` where its index is the same for all wavelengths.
    bodies: Vec<Option<Indices>>,
    /// For each material, the index that light has which is not split; 1 where it is opaque.
    unsplit: Vec<f64>,
    /// The wavelengths of `weights`, nanometres.
    wavelengths: Vec<f64>,
    /// The angle that a pixel is seen under, radians.
    pixel_angle: f64,
}

/// The indices of refraction of a body that disperses.
#[derive(Clone, Debug)]
struct Indices {
    /// In each band of `weights`.
    bands: Vec<f64>,
    /// At [`ENDS_NM`].
    ends: [f64; 2],
}

impl Dispersion {
    /// For the bodies of a scene, with at most `most` bands, seen with pixels of an angle in radians.
    ///
    /// With a wavelength in nanometres, all light is bent as it is at that wavelength, and nothing splits.
    pub fn new(scene: &CompiledScene, most: u32, pixel_angle: f64, only_nm: Option<f64>) -> Self {
        let most = if only_nm.is_some() { 1 } else { most };
        let unsplit = |material: &crate::material::Material| {
            material.body.as_ref().map_or(1.0, |body| body.ior.index(only_nm.unwrap_or(SODIUM_D)))
        };
        let unsplit: Vec<f64> = scene.materials.iter().map(unsplit).collect();
        let mut counts: Vec<u32> = COUNTS.into_iter().filter(|&count| count < most).collect();
        counts.extend((most > 1).then_some(most.min(Bands::MAX)));
        let (mut weights, mut wavelengths, mut splits) = (Vec::new(), Vec::new(), Vec::new());
        if scene.materials.iter().any(|m| m.body.as_ref().is_some_and(|body| body.ior.is_dispersive())) {
            for count in counts {
                let split = SHIFTS.map(|shift| {
                    let first = weights.len() as u16;
                    for band in &Bands::shifted(count, f64::from(shift) / SHIFTS.len() as f64) {
                        weights.push(band.weight);
                        wavelengths.push(band.wavelength_nm);
                    }
                    (first, weights.len() as u16)
                });
                splits.push((count, split));
            }
        }
        let indices = |material: &crate::material::Material| {
            let body = material.body.as_ref().filter(|body| body.ior.is_dispersive())?;
            let bands = wavelengths.iter().map(|&wavelength| body.ior.index(wavelength)).collect();
            Some(Indices { bands, ends: ENDS_NM.map(|wavelength| body.ior.index(wavelength)) })
        };
        let bodies = scene.materials.iter().map(indices).collect();
        Self { bodies, unsplit, wavelengths, weights, splits, pixel_angle }
    }

    /// True where no body disperses, and nothing splits.
    #[inline]
    pub fn is_idle(&self) -> bool {
        self.splits.is_empty()
    }

    /// The bands, with their shares of white, that a ray of all light splits into at the boundary between two bodies, for
    /// a sample with that number of a place to split; `None` where it stays together.
    pub fn split(
        &self,
        [before, beyond]: [Option<Inside>; 2],
        wo: Vector3,
        normal: Normal3,
        place: u32,
    ) -> Option<impl Iterator<Item = (Band, Rgb)>> {
        let ends = |inside: Option<Inside>| match inside.map(|i| (i, &self.bodies[i.material as usize])) {
            Some((_, Some(indices))) => (indices.ends, true),
            Some((inside, None)) => ([self.unsplit[inside.material as usize]; 2], false),
            None => ([1.0; 2], false),
        };
        let ((before, before_disperses), (beyond, beyond_disperses)) = (ends(before), ends(beyond));
        if !(before_disperses || beyond_disperses) {
            return None;
        }
        let directions = [0, 1].map(|end| refract(wo, normal, before[end] / beyond[end]));
        let wanted = match directions {
            [Some(a), Some(b)] => (a - b).length() / (TOLERANCE * self.pixel_angle),
            // Some colours come through and some do not: the border between them is as sharp as can be.
            [Some(_), None] | [None, Some(_)] => f64::INFINITY,
            [None, None] => return None,
        };
        if wanted <= 1.0 {
            return None;
        }
        let (_, shifts) =
            self.splits.iter().find(|(count, _)| f64::from(*count) >= wanted).or_else(|| self.splits.last())?;
        let (first, end) = shifts[place as usize % SHIFTS.len()];
        Some((first..end).map(|band| (Band(band), self.weights[usize::from(band)])))
    }

    /// The wavelength that stands for a band, in nanometres.
    pub fn wavelength_nm(&self, Band(band): Band) -> Option<f64> {
        self.wavelengths.get(usize::from(band)).copied()
    }

    /// The index of refraction of a body in a band; at the D line, or at the only wavelength, where the ray carries all light; 1
    /// outside of all.
    #[inline]
    pub fn index(&self, inside: Option<Inside>, band: Option<Band>) -> f64 {
        if let (Some(inside), Some(Band(band))) = (inside, band)
            && let Some(indices) = &self.bodies[inside.material as usize]
        {
            return indices.bands[usize::from(band)];
        }
        inside.map_or(1.0, |inside| self.unsplit[inside.material as usize])
    }
}

//! Smooth spectra for the many colours of a texture: mixtures of those of a lattice of colours.
//!
//! Finding a colour's smooth spectrum takes microseconds, too long for every hit on a picture. But colour is linear in the
//! spectrum: a mixture of spectra has the mixture of their colours. So the cube of reflectances is cut into 8³ smaller ones with
//! the smooth spectra of Jakob and Hanika (2019) at their corners, and a colour between them is the mixture of the four
//! corners of its tetrahedron: its spectrum has exactly that colour, is between 0 and 1, and continuous in the colour.
//!
//! Follows for the tetrahedra: Kasson, Nin, Plouffe and Hafner, "Performing color space conversions with three-dimensional linear
//! interpolation", Journal of Electronic Imaging 4(3), 1995.

use super::SmoothReflectance;
use crate::Rgb;

/// Pieces of each edge of the colour cube.
const PIECES: usize = 8;
const CORNERS: usize = PIECES + 1;

/// The smooth spectra of a lattice of colours: 9 kB, made in some milliseconds, once for all textures.
///
/// ```
/// use snell_math::{Rgb, spectrum::SmoothLattice};
/// let lattice = SmoothLattice::new();
/// let mixture = lattice.mixture(Rgb::new(0.21, 0.4, 0.03));
/// assert!((0.0..=1.0).contains(&mixture.at(550.0)));
/// assert_eq!(lattice.mixture(Rgb::WHITE).at(550.0), 1.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SmoothLattice {
    /// Red changes fastest.
    corners: Vec<SmoothReflectance>,
}

/// A reflectance in [0, 1] that is a mixture of smooth ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothMixture {
    parts: [SmoothReflectance; 4],
    /// Not negative, and one in all.
    weights: [f32; 4],
}

impl Default for SmoothLattice {
    fn default() -> Self {
        Self::new()
    }
}

impl SmoothLattice {
    /// Finds the spectra of all corners.
    #[must_use]
    pub fn new() -> Self {
        let level = |index: usize| (index % CORNERS) as f32 / PIECES as f32;
        let color = |i: usize| Rgb::new(level(i), level(i / CORNERS), level(i / (CORNERS * CORNERS)));
        Self { corners: (0..CORNERS * CORNERS * CORNERS).map(|i| SmoothReflectance::new(color(i))).collect() }
    }

    /// The mixture that has a colour under D65. Components below 0 or above 1 count as that, NaN as 0.
    #[inline]
    #[must_use]
    pub fn mixture(&self, color: Rgb) -> SmoothMixture {
        const STRIDES: [usize; 3] = [1, CORNERS, CORNERS * CORNERS];
        let mut corner = 0;
        let mut axes = [(0.0_f32, 0_usize); 3];
        for (axis, component) in color.to_array().into_iter().enumerate() {
            let position = if component > 0.0 { component.min(1.0) * PIECES as f32 } else { 0.0 };
            let piece = (position as usize).min(PIECES - 1);
            corner += piece * STRIDES[axis];
            axes[axis] = (position - piece as f32, STRIDES[axis]);
        }
        // From the darkest corner along the axes, the one with the largest share first.
        for (a, b) in [(0, 1), (1, 2), (0, 1)] {
            if axes[a].0 < axes[b].0 {
                axes.swap(a, b);
            }
        }
        let weights = [1.0 - axes[0].0, axes[0].0 - axes[1].0, axes[1].0 - axes[2].0, axes[2].0];
        let mut parts = [self.corners[corner]; 4];
        for (part, (_, stride)) in parts[1..].iter_mut().zip(axes) {
            corner += stride;
            *part = self.corners[corner];
        }
        SmoothMixture { parts, weights }
    }
}

impl SmoothMixture {
    /// Its value at a wavelength in nanometres.
    #[inline]
    #[must_use]
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        let mut sum = 0.0;
        for (part, weight) in self.parts.iter().zip(self.weights) {
            sum += f64::from(weight) * part.at(wavelength_nm);
        }
        sum
    }
}

//! What light that bounces among the small mirrors more than once adds: so that a rough surface loses nothing.
//!
//! Follows: Kulla and Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH course, 2017, after Kelemen and
//! Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model", Eurographics 2001: what one bounce leaves over, 1 − E(cos), is
//! sent out with the density of what it leaves over there, which is reciprocal and adds up to all. Of glass a share goes to the
//! other side. Tables are made for one width by quadrature, in some milliseconds, so nothing is interpolated between widths.
//!
//! Functions are per steradian, without the cosine; of power, as in [`super`].

use std::f64::consts::FRAC_1_PI;

use super::Ggx;
use super::albedo::{CosineTable, shares};

/// Less than this is left over by a surface that is as good as smooth.
const NOTHING: f64 = 1e-9;

/// The rest of a rough mirror's reflection.
///
/// ```
/// use snell_math::microfacet::{ConductorCompensation, Ggx};
/// let rough = ConductorCompensation::new(Ggx::from_roughness(0.8));
/// assert!((0.5..1.0).contains(&rough.albedo(0.5)));
/// // The same both ways.
/// assert_eq!(rough.reflection(0.3, 0.9, 1.0), rough.reflection(0.9, 0.3, 1.0));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ConductorCompensation {
    /// 1 − E.
    rest: CosineTable,
    average: f64,
}

/// A surface of the same width in all directions, as wide in the mean as this one.
fn isotropic(ggx: Ggx) -> (Ggx, f64) {
    let [x, y] = ggx.alpha();
    let width = (x * y).sqrt();
    (Ggx::new([width; 2]), width)
}

impl ConductorCompensation {
    /// Tables for a surface; one with different widths counts as one of their geometric mean.
    #[must_use]
    pub fn new(ggx: Ggx) -> Self {
        let (ggx, width) = isotropic(ggx);
        let [reflected, _] = CosineTable::pair(width, |cosine| shares(ggx, cosine, 1.0, |_| 1.0));
        let rest = reflected.rest();
        let average = rest.average();
        Self { rest, average }
    }

    /// E: the share of light from a direction that perfect mirrors send on after one bounce.
    #[inline]
    #[must_use]
    pub fn albedo(&self, cosine: f64) -> f64 {
        1.0 - self.rest.at(cosine)
    }

    /// The function of reflection to be added to [`Ggx::reflection`] times Fresnel's share. `fresnel_average` is the mean of Fresnel's
    /// share over light from everywhere, 2 ∫ F(c) c dc: what each further bounce keeps.
    #[inline]
    #[must_use]
    pub fn reflection(&self, cos_o: f64, cos_i: f64, fresnel_average: f64) -> f64 {
        if self.average < NOTHING || cos_o <= 0.0 || cos_i <= 0.0 {
            return 0.0;
        }
        let kept = fresnel_average * fresnel_average * (1.0 - self.average) / (1.0 - fresnel_average * self.average);
        kept * self.rest.at(cos_o) * self.rest.at(cos_i) * FRAC_1_PI / self.average
    }
}

/// The rest of rough glass's reflection and transmission.
///
/// ```
/// use snell_math::microfacet::{DielectricCompensation, Ggx};
/// // A share reflected that is the same for all directions stands for Fresnel's here.
/// let frosted = DielectricCompensation::new(Ggx::from_roughness(0.7), 1.5, |_, _| 0.1);
/// assert!(frosted.albedo(true, 0.4) < 1.0);
/// assert!(frosted.transmission(true, 0.4, 0.6) > 0.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct DielectricCompensation {
    /// Seen from outside and from inside.
    sides: [Side; 2],
}

#[derive(Clone, Debug, PartialEq)]
struct Side {
    /// 1 − E, E of both reflection and transmission.
    rest: CosineTable,
    average: f64,
    /// The share of the rest that goes to the other side.
    crossing: f64,
}

impl DielectricCompensation {
    /// Tables for a surface of glass whose index is `index` times that outside. `fresnel` gives the share that a smooth boundary
    /// reflects, by the cosine with its normal and by η, the index on the side of the light over that on the other.
    #[must_use]
    pub fn new(ggx: Ggx, index: f64, fresnel: impl Fn(f64, f64) -> f64) -> Self {
        let (ggx, width) = isotropic(ggx);
        let side = |eta: f64| {
            let [through, both] = CosineTable::pair(width, |cosine| {
                let [reflected, transmitted] = shares(ggx, cosine, eta, |c| fresnel(c, eta));
                [transmitted, reflected + transmitted]
            });
            // One bounce splits the light like this in the mean; so will more.
            let (rest, crossing) = (both.rest(), through.average());
            let average = rest.average();
            Side { crossing: crossing / (1.0 - average), average, rest }
        };
        let mut sides = [side(1.0 / index), side(index)];
        // Reciprocity: crossing · average · (index of the side)² must be the same from both, so the smaller one is taken.
        let squares = [1.0, index * index];
        let both = (0..2).map(|i| sides[i].crossing * sides[i].average * squares[i]).fold(f64::INFINITY, f64::min);
        for (side, square) in sides.iter_mut().zip(squares) {
            if side.average > NOTHING {
                side.crossing = (both / (side.average * square)).clamp(0.0, 1.0);
            }
        }
        Self { sides }
    }

    fn side(&self, from_outside: bool) -> &Side {
        &self.sides[usize::from(!from_outside)]
    }

    /// E: the share of light from a direction that goes on after one bounce, to either side.
    #[inline]
    #[must_use]
    pub fn albedo(&self, from_outside: bool, cosine: f64) -> f64 {
        1.0 - self.side(from_outside).rest.at(cosine)
    }

    /// The share of the rest that crosses the surface.
    #[inline]
    #[must_use]
    pub fn crossing(&self, from_outside: bool) -> f64 {
        self.side(from_outside).crossing
    }

    /// The function of reflection to be added to that of one bounce.
    #[inline]
    #[must_use]
    pub fn reflection(&self, from_outside: bool, cos_o: f64, cos_i: f64) -> f64 {
        let side = self.side(from_outside);
        (1.0 - side.crossing) * spread(side, side, cos_o, cos_i)
    }

    /// The function of transmission, of power, to be added to that of one bounce; `from_outside` is where `wo` is, and both
    /// cosines are positive.
    #[inline]
    #[must_use]
    pub fn transmission(&self, from_outside: bool, cos_o: f64, cos_i: f64) -> f64 {
        let side = self.side(from_outside);
        side.crossing * spread(side, self.side(!from_outside), cos_o, cos_i)
    }
}

/// What is left over in one direction, sent out by what would be left over in the other.
#[inline]
fn spread(from: &Side, to: &Side, cos_o: f64, cos_i: f64) -> f64 {
    if to.average < NOTHING || cos_o <= 0.0 || cos_i <= 0.0 {
        return 0.0;
    }
    from.rest.at(cos_o) * to.rest.at(cos_i) * FRAC_1_PI / to.average
}

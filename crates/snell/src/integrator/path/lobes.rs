//! What a surface does with the light of a path: its lobes at the path's wavelengths, evaluated, sampled, with densities.
//!
//! World space; `wo` leads back along the path and `wi` on, both leaving the surface. Values have the cosine in them; densities are
//! per steradian. The lobes are those of `whitted`, in physical units: Lambert's k_d / π; Phong's highlight as
//! k_s / π · (R·L)ⁿ, which under a light without extent is what `whitted` shows; mirrors; the boundaries of bodies; and [rough
//! ones](super::rough).
//!
//! Radiance is multiplied by (η_o / η_i)² where it is refracted (Veach, "Robust Monte Carlo Methods for Light Transport Simulation",
//! 1997, section 5.2), power is not.

use std::f64::consts::PI;

use snell_math::warp::cosine_hemisphere;
use snell_math::{Normal3, Vector3, portable};

use super::reflector::Reflector;
use super::rough::Rough;
use super::spectra::{BLACK, Spectral, is_black, mean, plus, scaled};
use crate::interaction::SurfaceInteraction;
use crate::optics::{reflect, refract};

/// Which way light is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transport {
    /// From the eye: what is carried is radiance.
    Radiance,
    /// From a light: what is carried is power.
    Power,
}

/// The colours of a surface at the wavelengths of a path.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceColors<'a> {
    /// See [`crate::material::Bsdf::diffuse`].
    pub diffuse: Spectral,
    /// See [`crate::material::Bsdf::specular`].
    pub specular: Spectral,
    /// See [`crate::material::Bsdf::shininess`].
    pub shininess: f64,
    /// See [`crate::material::Bsdf::mirror`].
    pub mirror: Spectral,
    /// Lit and seen from the outward side alone.
    pub one_sided: bool,
    /// A smooth metal.
    pub metal: Option<Reflector>,
    /// See [`crate::material::Interface`]; a smooth one.
    pub boundary: Option<BoundaryColors>,
    /// A rough boundary or metal.
    pub rough: Option<Rough<'a>>,
}

/// The smooth boundary of a transparent body at the wavelengths of a path.
#[derive(Clone, Copy, Debug)]
pub struct BoundaryColors {
    /// The shares follow Fresnel's equations, scaled by the coefficients; or else are the coefficients.
    pub fresnel: bool,
    /// The coefficient of the reflected ray.
    pub reflect: Spectral,
    /// The coefficient of the refracted ray.
    pub transmit: Spectral,
    /// What it reflects by Fresnel's equations.
    pub reflector: Reflector,
}

/// The lobes of a surface where a path met it.
#[derive(Clone, Copy, Debug)]
pub struct Lobes<'a> {
    /// Unit length, on the side of `wo`.
    normal: Vector3,
    flat: Vector3,
    wo: Vector3,
    diffuse: Spectral,
    specular: Spectral,
    shininess: f64,
    mirror: Spectral,
    reflected: Spectral,
    refracted: Spectral,
    rough: Option<RoughLobe<'a>>,
    /// Of the hero: η_o / η_i.
    eta: f64,
    /// The wavelengths go different ways where they are refracted.
    disperses: bool,
    /// The hero is reflected totally.
    is_total: bool,
    /// With which probability each lobe is chosen: diffuse, highlight, rough, mirror, reflected, refracted.
    shares: [f64; 6],
}

/// A rough surface with its frame, and where `wo` is in it.
#[derive(Clone, Copy, Debug)]
struct RoughLobe<'a> {
    rough: Rough<'a>,
    tangents: [Vector3; 2],
    wo: Vector3,
}

/// A direction that a path goes on in.
#[derive(Clone, Copy, Debug)]
pub struct Scattered {
    /// The direction, unit length, leaving the surface.
    pub wi: Vector3,
    /// What the light of that direction is multiplied by: value over density.
    pub weight: Spectral,
    /// The density of the direction among all that are not specular; `None` for a specular one.
    pub density: Option<f64>,
    /// It goes to the other side.
    pub crosses: bool,
    /// Only the hero goes this way.
    pub hero_alone: bool,
    /// (η_i / η_o)²: what radiance is larger by on the other side; 1 where it stays.
    pub compression: f64,
}

impl<'a> Lobes<'a> {
    /// Of a surface seen from `wo`.
    pub fn new(colors: &SurfaceColors<'a>, interaction: &SurfaceInteraction, wo: Vector3) -> Self {
        let flat = interaction.geometric_normal.face_forward(wo).as_vector();
        let side = if interaction.is_outward(wo) { 1.0 } else { -1.0 };
        let shading = interaction.shading_normal.as_vector() * side;
        let normal = if shading.dot(wo) > 0.0 { shading } else { flat };
        let hidden = colors.one_sided && side < 0.0;
        let [diffuse, specular] = if hidden { [BLACK; 2] } else { [colors.diffuse, colors.specular] };
        let (mut reflected, mut refracted, mut eta, mut disperses, mut of_hero) = (BLACK, BLACK, 1.0, false, false);
        let mut mirror = colors.mirror;
        let cosine = normal.dot(wo).clamp(0.0, 1.0);
        if let Some(metal) = &colors.metal {
            mirror = plus(mirror, metal.shares(cosine));
        }
        if let Some(BoundaryColors { fresnel, reflect, transmit, reflector }) = &colors.boundary {
            let beyond = reflector.beyond();
            let sine_squared = (1.0 - cosine) * (1.0 + cosine);
            for i in 0..reflected.len() {
                let eta = reflector.before[i] / beyond[i];
                let share = reflector.share(i, cosine);
                let is_total = eta * eta * sine_squared >= 1.0 || share >= 1.0;
                of_hero |= is_total && i == 0;
                (reflected[i], refracted[i]) = match (fresnel, is_total) {
                    (true, true) => (reflect[i], 0.0),
                    (true, false) => (reflect[i] * share, transmit[i] * (1.0 - share)),
                    (false, true) => (reflect[i] + transmit[i], 0.0),
                    (false, false) => (reflect[i], transmit[i]),
                };
            }
            eta = reflector.before[0] / beyond[0];
            disperses = reflector.disperses();
        }
        let rough = colors.rough.map(|rough| {
            let (x, y) = normal.orthonormal_basis();
            RoughLobe { rough, tangents: [x, y], wo: Vector3::new(wo.dot(x), wo.dot(y), wo.dot(normal)) }
        });
        let mut lobes = Self {
            normal,
            flat,
            wo,
            diffuse,
            specular,
            shininess: colors.shininess,
            mirror,
            reflected,
            refracted,
            rough,
            eta,
            disperses,
            is_total: of_hero,
            shares: [0.0; 6],
        };
        lobes.choose();
        lobes
    }

    /// Works out the probabilities: proportional to what lobes reflect. They are the same for light that goes the other way.
    fn choose(&mut self) {
        // Where indices differ between wavelengths, by the hero's share alone, which decides about refraction.
        let of_hero = |shares: Spectral| if self.disperses { shares[0] } else { mean(shares) };
        let albedos = [
            mean(self.diffuse),
            mean(self.specular) * 2.0 / (self.shininess + 1.0),
            self.rough.as_ref().map_or(0.0, |lobe| lobe.rough.albedo(lobe.wo.z())),
            mean(self.mirror),
            of_hero(self.reflected),
            of_hero(self.refracted),
        ];
        let sum: f64 = albedos.iter().sum();
        self.shares = if sum > 0.0 { albedos.map(|albedo| albedo / sum) } else { [0.0; 6] };
    }

    /// Chooses between what a boundary reflects and what it lets through by the roots of their shares: for paths straight from the eye that do not
    /// go both ways. Those after a turn must choose as photons do.
    #[inline]
    pub fn favour_the_weaker(&mut self) {
        let [.., reflected, refracted] = self.shares;
        if reflected > 0.0 && refracted > 0.0 {
            let (first, second) = (reflected.sqrt(), refracted.sqrt());
            let factor = (reflected + refracted) / (first + second);
            (self.shares[4], self.shares[5]) = (first * factor, second * factor);
        }
    }

    /// Both ways that light takes at a smooth boundary, reflected and refracted, with all that goes there; `None` where there is but one, or where
    /// other lobes are.
    #[inline]
    pub fn both_ways(&self) -> Option<[Scattered; 2]> {
        let [others @ .., reflected, refracted] = self.shares;
        if reflected == 0.0 || refracted == 0.0 || others != [0.0; 4] {
            return None;
        }
        Some([self.reflect(self.reflected, 1.0)?, self.refract(1.0, Transport::Radiance)?])
    }

    /// True at the smooth boundary of a body where the hero meets total internal reflection.
    #[inline]
    pub fn is_total(&self) -> bool {
        self.is_total
    }

    /// The normal that directions are reckoned with, on the side of `wo`.
    pub fn normal(&self) -> Vector3 {
        self.normal
    }

    /// What a smooth boundary reflects and refracts of the hero, its coefficients in it.
    pub fn boundary_shares(&self) -> [f64; 2] {
        [self.reflected[0], self.refracted[0]]
    }

    /// True where lights can be asked and light from elsewhere be gathered: where some lobe is not specular.
    #[inline]
    pub fn is_lit(&self) -> bool {
        self.rough.is_some() || !(is_black(self.diffuse) && is_black(self.specular))
    }

    /// The index on the side of `wo` over that beyond, at the hero's wavelength; 1 where there is no smooth boundary.
    #[inline]
    pub fn eta(&self) -> f64 {
        self.eta
    }

    /// The cosine of a direction with the surface as it is, not as it is shaded; negative for one that goes to the other side.
    #[inline]
    pub fn flat_cosine(&self, wi: Vector3) -> f64 {
        self.flat.dot(wi)
    }

    /// What the lobes that are not specular make of light from `wi`, cosine included, and the density with which they would choose
    /// that direction.
    pub fn evaluate(&self, wi: Vector3, transport: Transport) -> (Spectral, f64) {
        let (cosine, flat_cosine) = (self.normal.dot(wi), self.flat.dot(wi));
        if cosine * flat_cosine <= 0.0 {
            return (BLACK, 0.0);
        }
        let (mut value, mut density) = (BLACK, 0.0);
        if let Some(RoughLobe { rough, tangents: [x, y], wo }) = &self.rough {
            let local = Vector3::new(wi.dot(*x), wi.dot(*y), cosine);
            let (of_rough, of_choice) = rough.evaluate(*wo, local, transport);
            (value, density) = (of_rough, self.shares[2] * of_choice);
        }
        if cosine > 0.0 {
            value = plus(value, scaled(self.diffuse, cosine / PI));
            density += self.shares[0] * cosine / PI;
            if self.shares[1] > 0.0 {
                let mirrored = reflect(self.wo, Normal3::from(self.normal));
                let highlight = self.highlight(mirrored.dot(wi));
                value = plus(value, scaled(self.specular, highlight / PI));
                density += self.shares[1] * highlight * (self.shininess + 1.0) / (2.0 * PI);
            }
        }
        (value, density)
    }

    /// cosⁿ about the mirrored direction.
    fn highlight(&self, cosine: f64) -> f64 {
        if cosine > 0.0 { portable::pow(cosine.min(1.0), self.shininess) } else { 0.0 }
    }

    /// A direction to go on in, by a number in [0, 1) for the lobe and two for the direction; `None` where light ends.
    pub fn sample(&self, lobe: f64, u: [f64; 2], transport: Transport) -> Option<Scattered> {
        let [diffuse, highlight, rough, mirror, reflected, refracted] = self.shares;
        if lobe < diffuse + highlight + rough {
            let wi = if lobe < diffuse {
                about(self.normal, cosine_hemisphere(u))
            } else if lobe < diffuse + highlight {
                self.sample_highlight(u)
            } else {
                let RoughLobe { rough: surface, tangents: [x, y], wo } = self.rough.as_ref()?;
                // Again a number in [0, 1).
                let choice = ((lobe - diffuse - highlight) / rough).clamp(0.0, 1.0_f64.next_down());
                let local = surface.sample(*wo, choice, u)?;
                *x * local.x() + *y * local.y() + self.normal * local.z()
            };
            let wi = wi.normalize();
            let (value, density) = self.evaluate(wi, transport);
            let crosses = self.flat.dot(wi) < 0.0;
            let (hero_alone, compression) = match &self.rough {
                Some(lobe) if crosses => {
                    let eta = lobe.rough.eta();
                    (lobe.rough.reflector.disperses(), 1.0 / (eta * eta))
                }
                _ => (false, 1.0),
            };
            return (density > 0.0).then(|| {
                let mut weight = scaled(value, 1.0 / density);
                if hero_alone && !self.is_hero_alone() {
                    // What the hero counts for the others is in the colours of a path that has given them up.
                    weight[0] /= weight.len() as f64;
                }
                Scattered { wi, weight, density: Some(density), crosses, hero_alone, compression }
            });
        }
        let rest = lobe - (diffuse + highlight + rough);
        if rest < mirror + reflected {
            let (color, share) = if rest < mirror { (self.mirror, mirror) } else { (self.reflected, reflected) };
            return self.reflect(color, share);
        }
        if refracted > 0.0 { self.refract(refracted, transport) } else { None }
    }

    fn is_hero_alone(&self) -> bool {
        self.rough.as_ref().is_some_and(|lobe| lobe.rough.hero_alone)
    }

    fn sample_highlight(&self, [u, v]: [f64; 2]) -> Vector3 {
        let mirrored = reflect(self.wo, Normal3::from(self.normal)).normalize();
        let cosine = portable::pow(1.0 - u, 1.0 / (self.shininess + 1.0));
        let sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
        let angle = 2.0 * PI * v;
        about(mirrored, Vector3::new(sine * portable::cos(angle), sine * portable::sin(angle), cosine))
    }

    fn reflect(&self, color: Spectral, share: f64) -> Option<Scattered> {
        let mut wi = reflect(self.wo, Normal3::from(self.normal));
        // On a smooth mesh the shading normal may send it through the surface; then the flat one decides.
        if self.flat.dot(wi) <= 0.0 {
            wi = reflect(self.wo, Normal3::from(self.flat));
        }
        let weight = scaled(color, 1.0 / share);
        Some(Scattered { wi, weight, density: None, crosses: false, hero_alone: false, compression: 1.0 })
    }

    fn refract(&self, share: f64, transport: Transport) -> Option<Scattered> {
        let mut wi = refract(self.wo, Normal3::from(self.normal), self.eta)?;
        if self.flat.dot(wi) >= 0.0 {
            wi = refract(self.wo, Normal3::from(self.flat), self.eta)?;
        }
        let compression = 1.0 / (self.eta * self.eta);
        let factor = match transport {
            Transport::Radiance => 1.0 / compression,
            Transport::Power => 1.0,
        };
        let weight = scaled(self.refracted, factor / share);
        Some(Scattered { wi, weight, density: None, crosses: true, hero_alone: self.disperses, compression })
    }
}

/// A direction that is given about +z, about another axis of unit length.
#[inline]
pub fn about(axis: Vector3, local: Vector3) -> Vector3 {
    let (x, y) = axis.orthonormal_basis();
    x * local.x() + y * local.y() + axis * local.z()
}

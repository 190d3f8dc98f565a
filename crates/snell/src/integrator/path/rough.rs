//! Rough boundaries: many small mirrors of glass or metal, and what bounces among them more than once.
//!
//! Follows [`snell_math::microfacet`]: GGX with visible normals and the compensation of Kulla and Conty. Directions are in the surface's
//! frame, +z its normal on the side of `wo`. Values have the cosine in them; densities are per steradian.

use std::f64::consts::PI;

use snell_math::microfacet::{ConductorCompensation, DielectricCompensation, Ggx};
use snell_math::warp::cosine_hemisphere;
use snell_math::{Normal3, Vector3};

use super::lobes::Transport;
use super::reflector::Reflector;
use super::spectra::{BLACK, Spectral, mean, plus, scaled, times};
use crate::optics::{reflect, refract};

/// A rough surface at the wavelengths of a path.
#[derive(Clone, Copy, Debug)]
pub struct Rough<'a> {
    /// Its small mirrors.
    pub ggx: Ggx,
    /// What each of them reflects.
    pub reflector: Reflector,
    /// What it is.
    pub kind: RoughKind<'a>,
    /// The path has given up all wavelengths but its hero.
    pub hero_alone: bool,
}

/// Metal or glass.
#[derive(Clone, Copy, Debug)]
pub enum RoughKind<'a> {
    /// A metal.
    Metal {
        /// Its further bounces.
        compensation: &'a ConductorCompensation,
        /// The share of light from everywhere that it reflects.
        average: Spectral,
    },
    /// The boundary of a transparent body.
    Dielectric {
        /// Its further bounces, where they are known.
        compensation: Option<&'a DielectricCompensation>,
        /// `wo` is on the side that is outside for those.
        from_outside: bool,
        /// Factors on what is reflected and on what goes through.
        tints: [Spectral; 2],
    },
}

impl Rough<'_> {
    /// How much it sends on of light from a direction, roughly.
    pub fn albedo(&self, cosine: f64) -> f64 {
        match self.kind {
            RoughKind::Metal { .. } => mean(self.reflector.shares(cosine)),
            RoughKind::Dielectric { tints: [reflect, transmit], .. } => 0.5 * (mean(reflect) + mean(transmit)),
        }
    }

    /// η_o / η_i of the hero.
    pub fn eta(&self) -> f64 {
        self.reflector.before[0] / self.reflector.beyond()[0]
    }

    /// The share of light that goes on after one bounce.
    fn single(&self, cosine: f64) -> f64 {
        match self.kind {
            RoughKind::Metal { compensation, .. } => compensation.albedo(cosine),
            RoughKind::Dielectric { compensation, from_outside, .. } => {
                compensation.map_or(1.0, |compensation| compensation.albedo(from_outside, cosine))
            }
        }
        .clamp(0.0, 1.0)
    }

    /// With which probability a mirror under an angle reflects, and does not refract.
    fn reflecting(&self, cosine: f64) -> f64 {
        match self.kind {
            RoughKind::Metal { .. } => 1.0,
            RoughKind::Dielectric { tints: [reflect, transmit], .. } => {
                let share = self.reflector.share(0, cosine);
                let (reflected, refracted) = (share * mean(reflect), (1.0 - share) * mean(transmit));
                let sum = reflected + refracted;
                if sum > 0.0 { reflected / sum } else { 1.0 }
            }
        }
    }

    /// What becomes of light from `wi`, with the density with which that direction is chosen.
    pub fn evaluate(&self, wo: Vector3, wi: Vector3, transport: Transport) -> (Spectral, f64) {
        if wo.z() <= 0.0 || wi.z() == 0.0 {
            return (BLACK, 0.0);
        }
        if wi.z() > 0.0 { self.evaluate_reflection(wo, wi) } else { self.evaluate_transmission(wo, wi, transport) }
    }

    fn evaluate_reflection(&self, wo: Vector3, wi: Vector3) -> (Spectral, f64) {
        let (cos_o, cos_i) = (wo.z(), wi.z());
        let facing = wo.dot((wo + wi).normalize()).clamp(0.0, 1.0);
        let shares = self.reflector.shares(facing);
        let single = self.single(cos_o);
        let once = self.ggx.reflection(wo, wi) * cos_i;
        let density = single * self.reflecting(facing) * self.ggx.reflection_density(wo, wi);
        let spread = (1.0 - single) * cos_i / PI;
        match self.kind {
            RoughKind::Metal { compensation, average } => {
                let more = average.map(|average| compensation.reflection(cos_o, cos_i, average) * cos_i);
                (plus(scaled(shares, once), more), density + spread)
            }
            RoughKind::Dielectric { compensation, from_outside, tints: [tint, _] } => {
                let (more, crossing) = compensation.map_or((0.0, 0.0), |compensation| {
                    (compensation.reflection(from_outside, cos_o, cos_i) * cos_i, compensation.crossing(from_outside))
                });
                let value = times(tint, shares.map(|share| share * once + more));
                (value, density + spread * (1.0 - crossing))
            }
        }
    }

    fn evaluate_transmission(&self, wo: Vector3, wi: Vector3, transport: Transport) -> (Spectral, f64) {
        let RoughKind::Dielectric { compensation, from_outside, tints: [_, tint] } = self.kind else {
            return (BLACK, 0.0);
        };
        let (cos_o, cos_i) = (wo.z(), -wi.z());
        let eta = self.eta();
        let single = self.single(cos_o);
        let (mut once, mut density, mut shares) = (0.0, 0.0, BLACK);
        if let Some(normal) = Ggx::refracting_normal(wo, wi, eta) {
            let facing = wo.dot(normal).clamp(0.0, 1.0);
            once = self.ggx.transmission(wo, wi, eta) * cos_i;
            density = single * (1.0 - self.reflecting(facing)) * self.ggx.transmission_density(wo, wi, eta);
            shares = self.reflector.shares(facing);
        }
        let (more, crossing) = compensation.map_or((0.0, 0.0), |compensation| {
            (compensation.transmission(from_outside, cos_o, cos_i) * cos_i, compensation.crossing(from_outside))
        });
        density += (1.0 - single) * crossing * cos_i / PI;
        let factor = match transport {
            Transport::Radiance => eta * eta,
            Transport::Power => 1.0,
        };
        let mut value = times(tint, shares.map(|share| ((1.0 - share) * once + more) * factor));
        if self.reflector.disperses() {
            // Other wavelengths have other ways: the hero counts for them.
            let hero = value[0] * if self.hero_alone { 1.0 } else { value.len() as f64 };
            value = BLACK;
            value[0] = hero;
        }
        (value, density)
    }

    /// A direction, by a number in [0, 1) for what happens and two for where to; `None` where light ends.
    pub fn sample(&self, wo: Vector3, choice: f64, u: [f64; 2]) -> Option<Vector3> {
        let single = self.single(wo.z());
        if choice >= single {
            // Again a number in [0, 1).
            let choice = (choice - single) / (1.0 - single);
            let crossing = match self.kind {
                RoughKind::Dielectric { compensation: Some(compensation), from_outside, .. } => {
                    compensation.crossing(from_outside)
                }
                _ => 0.0,
            };
            let wi = cosine_hemisphere(u);
            return Some(if choice < crossing { Vector3::new(wi.x(), wi.y(), -wi.z()) } else { wi });
        }
        let choice = choice / single;
        let normal = self.ggx.sample_visible(wo, u);
        let facing = wo.dot(normal);
        if facing <= 0.0 {
            return None;
        }
        let wi = if choice < self.reflecting(facing.min(1.0)) {
            let wi = reflect(wo, Normal3::from(normal));
            (wi.z() > 0.0).then_some(wi)?
        } else {
            let wi = refract(wo, Normal3::from(normal), self.eta())?;
            (wi.z() < 0.0).then_some(wi)?
        };
        Some(wi.normalize())
    }
}

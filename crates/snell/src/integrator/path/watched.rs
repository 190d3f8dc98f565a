//! What a path tells those who watch it; where nobody does, nothing is worked out.

use snell_math::{Normal3, Rgb, Vector3};

use super::Step;
use super::lobes::{BoundaryColors, Lobes, Scattered, SurfaceColors};
use super::spectra::{Spectral, times};
use crate::interaction::SurfaceInteraction;
use crate::material::Bsdf;
use crate::observe::{BoundaryCrossing, Observer, ShadowStep};
use crate::optics::refract;
use crate::task::{Crossing, Inside, Term};

impl<O: Observer> Step<'_, '_, '_, O> {
    /// The wavelengths that the ray carries.
    #[inline]
    pub(super) fn tell_wavelengths(&mut self) {
        if self.out.is_detailed() {
            let nm = self.path.wavelengths.nm();
            let carried = if self.path.wavelengths.is_hero_alone() { &nm[..1] } else { &nm };
            self.out.observer().wavelengths(self.task.id, carried);
        }
    }

    /// Writes down what the path carries, for the ray that it goes on with: by what it would make of white light.
    #[inline]
    pub(super) fn note_throughput(&mut self) {
        if self.out.is_detailed() {
            let wavelengths = &self.path.wavelengths;
            self.task.throughput = wavelengths.color(times(self.path.throughput, wavelengths.white));
        }
    }

    /// What a body left of the light on the ray's way.
    #[inline]
    pub(super) fn tell_travelled(&mut self, left: Spectral) {
        if self.out.is_detailed() {
            let left = self.path.wavelengths.in_gray(left);
            self.out.observer().travelled(self.task.id, left);
        }
    }

    /// The ray was scattered on its way.
    #[inline]
    pub(super) fn tell_scattered(&mut self, distance: f64) {
        if self.out.is_detailed() {
            self.out.observer().scattered(self.task.id, distance);
        }
    }

    /// What the surface does with light.
    #[inline]
    pub(super) fn tell_surface(&mut self, bsdf: &Bsdf) {
        if self.out.is_detailed() {
            self.out.observer().surface(self.task.id, bsdf);
        }
    }

    /// A boundary on a straight way to a light let some of what a term would add through.
    #[inline]
    pub(super) fn tell_filtered(&mut self, term: Term) {
        if self.out.is_watched() {
            self.out.observer().filtered(self.task.id, term);
        }
    }

    /// A part of a straight way to a light: up to a surface, and through it.
    #[inline]
    pub(super) fn tell_shadow_step(
        &mut self,
        surface: Option<&SurfaceInteraction>,
        medium: Option<Inside>,
        absorption: Spectral,
        share: Spectral,
    ) {
        if self.out.is_detailed() {
            let [absorption, transmittance] = [absorption, share].map(|share| self.path.wavelengths.in_gray(share));
            let surface = surface.copied();
            self.out.observer().shadow_step(&ShadowStep {
                surface,
                medium,
                absorption,
                transmittance,
                reflectance: 0.0,
            });
        }
    }

    /// What happened to the hero at the boundary of a body. A rough one is told by the small mirror that sent the path on, and not at all
    /// where none did.
    pub(super) fn tell_boundary(
        &mut self,
        colors: &SurfaceColors<'_>,
        lobes: &Lobes<'_>,
        crossing: Crossing,
        scattered: Option<&Scattered>,
    ) {
        if !self.out.is_detailed() {
            return;
        }
        let wo = -self.task.ray.direction;
        let (reflector, normal, fresnel) = match (&colors.boundary, &colors.rough, scattered) {
            (Some(BoundaryColors { reflector, fresnel, .. }), ..) => (reflector, Some(lobes.normal()), *fresnel),
            (None, Some(rough), Some(scattered)) => {
                let [before, beyond] = [rough.reflector.before[0], rough.reflector.beyond()[0]];
                (&rough.reflector, small_mirror(wo, scattered, before, beyond), true)
            }
            _ => return,
        };
        let Some(normal) = normal else { return };
        let indices = [reflector.before[0], reflector.beyond()[0]];
        let cosine = normal.dot(wo).clamp(0.0, 1.0);
        let refracted = refract(wo, Normal3::from(normal), indices[0] / indices[1]);
        let reflectance = if refracted.is_some() { reflector.share(0, cosine) } else { 1.0 };
        let weights = match colors.boundary {
            Some(_) => lobes.boundary_shares(),
            None => [reflectance, 1.0 - reflectance],
        };
        let told = BoundaryCrossing {
            media: [crossing.before, crossing.beyond],
            indices,
            band: None,
            normal: Normal3::from(normal),
            refracted: refracted.filter(|_| reflectance < 1.0),
            reflectance,
            fresnel,
            weights: weights.map(|weight| Rgb::gray(weight as f32)),
            share: Rgb::WHITE,
        };
        self.out.observer().boundary(self.task.id, &told);
    }
}

/// The normal of the mirror that sent light from one direction to another, on the side of `wo`. (Walter et al., "Microfacet Models for
/// Refraction through Rough Surfaces", EGSR 2007, equations 13 and 16.)
fn small_mirror(wo: Vector3, scattered: &Scattered, before: f64, beyond: f64) -> Option<Vector3> {
    let half = if scattered.crosses { -(wo * before + scattered.wi * beyond) } else { wo + scattered.wi };
    let normal = half.try_normalize()?;
    Some(if normal.dot(wo) < 0.0 { -normal } else { normal })
}

//! The way of a path between surfaces: what bodies absorb and scatter, and what is between a point and a light.
//!
//! Distances in media that scatter are chosen by the extinction of one of the path's wavelengths, each as likely as the others, and weighed
//! by the mean of all densities: Wilkie et al. 2014, section 4. Phase functions are Henyey and Greenstein's.

use snell_math::warp::{exponential, henyey_greenstein, henyey_greenstein_density};
use snell_math::{Ray, Rgb};

use super::lights::Arriving;
use super::lobes::about;
use super::materials::Boundary;
use super::sample::{Gathers, Purpose, Vertex};
use super::spectra::{
    BLACK, BodySpectra, Spectral, WHITE, Wavelengths, attenuated, is_black, mean, plus, scaled, times,
};
use super::{Path, Step};
use crate::geometry::QueryScratch;
use crate::integrator::sink::MAX_PASSES;
use crate::observe::Observer;
use crate::task::{MediumStack, RayKind, Term};
use crate::texture::Footprint;

/// What becomes of light on its way through a body.
pub enum Travelled {
    /// It comes to the end: what is left of it, and one over the probability of that.
    Through {
        /// The share that is left.
        left: Spectral,
        /// One over the probability.
        weight: f64,
    },
    /// It is scattered before.
    Scattered {
        /// Where.
        distance: f64,
        /// The share that is left there.
        left: Spectral,
        /// One over the density of the distance.
        weight: f64,
        /// What the body scatters per world unit.
        scattering: Spectral,
        /// The mean of all that it takes away.
        extinction: f64,
    },
}

/// Light on its way through a body up to a distance. Two numbers in [0, 1), of which the first chooses a wavelength, are drawn where the body
/// scatters.
pub fn travel(
    body: &BodySpectra,
    wavelengths: &Wavelengths,
    distance: f64,
    draw: impl FnOnce() -> [f64; 2],
) -> Travelled {
    let [absorption, scattering] = body.at(wavelengths.nm());
    let extinction = plus(absorption, scattering);
    let left = |distance: f64| extinction.map(|coefficient| attenuated(coefficient, distance));
    if is_black(scattering) {
        return Travelled::Through { left: left(distance), weight: 1.0 };
    }
    let [choice, u] = draw();
    let alone = wavelengths.is_hero_alone();
    let chosen = if alone { 0 } else { ((choice * extinction.len() as f64) as usize).min(extinction.len() - 1) };
    let reached = if extinction[chosen] > 0.0 { exponential(u, extinction[chosen]) } else { f64::INFINITY };
    // The density of what happened, over all wavelengths that might have been chosen.
    let over_choices = |values: Spectral| if alone { values[0] } else { mean(values) };
    if reached >= distance {
        let left = left(distance);
        return Travelled::Through { left, weight: 1.0 / over_choices(left) };
    }
    let left = left(reached);
    let weight = 1.0 / over_choices(times(extinction, left));
    Travelled::Scattered { distance: reached, left, weight, scattering, extinction: over_choices(extinction) }
}

/// A straight way to a light.
#[derive(Clone, Copy, Debug)]
pub struct WayToLight {
    /// Where it begins and where it goes, unit length.
    pub ray: Ray,
    /// How far the light is.
    pub distance: f64,
    /// The bodies where it begins.
    pub media: MediumStack,
}

impl Path {
    /// What happens on the way to a distance. True where the path was scattered before it came there.
    pub(super) fn travel<O: Observer>(&self, step: &mut Step<'_, '_, '_, O>, distance: f64) -> bool {
        let Some(inside) = step.out.media.current(step.task.media) else { return false };
        let Some(body) = self.materials.body(inside.material) else { return false };
        let path = &mut *step.path;
        let mut drawn = [0.0; 4];
        let draw = || {
            drawn = path.draw(Purpose::Medium);
            [drawn[0], drawn[1]]
        };
        match travel(body, &path.wavelengths, distance, draw) {
            Travelled::Through { left, weight } => {
                path.throughput = scaled(times(path.throughput, left), weight);
                step.tell_travelled(left);
                false
            }
            Travelled::Scattered { distance, left, weight, scattering, extinction } => {
                path.throughput = scaled(times(path.throughput, times(scattering, left)), weight);
                step.tell_scattered(distance);
                self.scatter(step, distance, body.anisotropy, extinction, [drawn[2], drawn[3]]);
                true
            }
        }
    }

    /// Scatters a path inside a body.
    fn scatter<O: Observer>(
        &self,
        step: &mut Step<'_, '_, '_, O>,
        reached: f64,
        anisotropy: f64,
        extinction: f64,
        u: [f64; 2],
    ) {
        let point = step.task.ray.at(reached);
        let forward = step.task.ray.direction;
        let [choice, first, second, _] = step.path.draw(Purpose::Light);
        let wavelengths = &step.path.wavelengths;
        let arriving = self.lights.sample(step.scene, &self.colors, wavelengths, point, choice, [first, second]);
        if let Some(arriving) = arriving {
            let density = henyey_greenstein_density(forward.dot(arriving.wi), anisotropy);
            let weight = arriving.density.map_or(1.0, |asked| asked / (asked + density));
            let value = [density * weight; 4];
            let term = Term::Scattering(self.lights.name(arriving.light));
            let ray = Ray::new(point, arriving.wi);
            let way = WayToLight { ray, distance: arriving.distance, media: step.task.media };
            self.ask(step, &arriving, way, value, term);
        }
        if let Some(photons) = &self.photons {
            let alone = step.path.wavelengths.is_hero_alone();
            let found = photons.gather_in_medium(point, forward, anisotropy, extinction, alone);
            step.add(Term::Photons, found);
        }
        let wi = about(forward, henyey_greenstein(u, anisotropy)).normalize();
        let density = henyey_greenstein_density(forward.dot(wi), anisotropy);
        step.path.scattered = Some(Vertex { point, density, gathers: Gathers::Ball { extinction } });
        step.path.specular = 0;
        let [.., roulette] = step.path.draw(Purpose::Direction);
        let media = step.task.media;
        step.spawn(RayKind::Scattered, Ray::new(point, wi), media, roulette, None);
    }

    /// Asks a light for what it gives, times a value; what bodies leave of it on the way is worked out here.
    pub(super) fn ask<O: Observer>(
        &self,
        step: &mut Step<'_, '_, '_, O>,
        arriving: &Arriving,
        way: WayToLight,
        value: Spectral,
        term: Term,
    ) {
        // The place itself is not in its own way.
        let way = WayToLight { distance: way.distance * (1.0 - 1e-9), ..way };
        let light = match arriving.light_over_density {
            Some(light) => light,
            None => match self.light_met(step, arriving, &way.ray) {
                Some(light) => light,
                None => return,
            },
        };
        let value = times(times(step.path.throughput, value), light);
        let is_inside = step.out.media.current(way.media).is_some();
        if !(is_inside || self.materials.some_pass()) {
            let color = step.path.wavelengths.color(value);
            if !color.is_black() {
                let question = step.question(way, term, color);
                step.out.ask(question);
            }
            return;
        }
        let left = self.way_to_light(step, way, term);
        let wavelengths = &step.path.wavelengths;
        let arriving = wavelengths.color(times(value, left));
        // What would arrive if nothing were in the way is of interest to a watcher alone.
        let unblocked = if step.out.is_detailed() { wavelengths.color(value) } else { Rgb::BLACK };
        let question = step.question(way, term, unblocked);
        step.out.answer(&question, arriving, wavelengths.in_gray(left));
    }

    /// The light of a surface whose radiance differs from place to place, over the density of its choice.
    fn light_met<O: Observer>(&self, step: &Step<'_, '_, '_, O>, arriving: &Arriving, ray: &Ray) -> Option<Spectral> {
        let hit = step.scene.geometry.intersect(ray, f64::INFINITY, &mut QueryScratch::default())?;
        let interaction = step.scene.geometry.interaction(ray, &hit);
        if self.lights.surface_at(&interaction) != Some(arriving.light) {
            return None;
        }
        let material = &step.scene.materials[interaction.material as usize];
        let color = material.bsdf(&step.scene.textures, &interaction, &Footprint::SHARP).emission;
        let wavelengths = &step.path.wavelengths;
        let radiance = self.colors.light(color, wavelengths.nm(), wavelengths.white);
        Some(scaled(radiance, 1.0 / arriving.density?))
    }

    /// What is left of light on a straight way through boundaries that do not bend it; nothing where something is in the way.
    fn way_to_light<O: Observer>(&self, step: &mut Step<'_, '_, '_, O>, way: WayToLight, term: Term) -> Spectral {
        let WayToLight { mut ray, mut distance, mut media } = way;
        let nm = step.path.wavelengths.nm();
        let mut left = WHITE;
        let mut scratch = QueryScratch::default();
        for _ in 0..MAX_PASSES {
            let hit = step.scene.geometry.intersect(&ray, distance, &mut scratch);
            let way = hit.as_ref().map_or(distance, |hit| hit.t);
            let mut absorption = WHITE;
            let medium = step.out.media.current(media);
            if let Some(inside) = medium
                && let Some(body) = self.materials.body(inside.material)
            {
                absorption = body.transmittance(nm, way);
                left = times(left, absorption);
            }
            let Some(hit) = hit else {
                step.tell_shadow_step(None, medium, absorption, WHITE);
                return left;
            };
            let interaction = step.scene.geometry.interaction(&ray, &hit);
            let Some(Boundary::Passed { share, media: behind }) =
                self.materials.boundary(step.scene, step.out.media, media, &ray, &interaction, nm)
            else {
                step.tell_shadow_step(Some(&interaction), medium, absorption, BLACK);
                return BLACK;
            };
            step.tell_shadow_step(Some(&interaction), medium, absorption, share);
            step.tell_filtered(term);
            left = times(left, share);
            media = behind;
            let onward = interaction.spawn_ray(ray.direction);
            distance -= (onward.origin - ray.origin).dot(ray.direction);
            ray = onward;
        }
        BLACK
    }
}

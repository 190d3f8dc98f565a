//! From what was seen while samples were traced to an [`Explanation`]: names instead of numbers, angles instead of cosines, shares of
//! the pixel instead of values of a sample.

use snell_math::{Normal3, Rgb, Vector3, portable};

use super::{
    Blocker, Boundary, End, ExplainedMedium, ExplainedRay, ExplainedSample, ExplainedSurface, ExplainedTerm,
    Explanation, Kind, Subject, TermKind, paths,
};
use crate::compile::CompiledScene;
use crate::interaction::SurfaceInteraction;
use crate::observe::{AnsweredShadow, BoundaryCrossing, RayTree, ShadowStep, Share, TracedRay};
use crate::optics::critical_angle;
use crate::render::Watch;
use crate::task::{Cut, Inside, RayKind, Term};

/// Rounding is told in at most so many terms; one does unless shares of opposite signs cancel.
const MOST_ROUNDINGS: usize = 4;

/// From the trees of some samples, each with its number and place, and the pixel's colour.
pub fn explanation(
    watch: &Watch<'_>,
    subject: Subject,
    pixel: Rgb,
    traced: &[(u32, Option<[f64; 2]>, RayTree)],
) -> Explanation {
    let (samples, rays, terms) = (Vec::new(), Vec::new(), Vec::new());
    let mut told = Explanation { subject, pixel, samples, rays, terms, paths: Vec::new() };
    let weight = 1.0 / traced.len().max(1) as f64;
    for (number, place, tree) in traced {
        let color = tree.sum();
        let wavelengths_nm = tree.rays.first().map_or_else(Vec::new, |ray| ray.wavelengths.clone());
        let camera_ray = told.rays.len();
        let sample = ExplainedSample { number: *number, place: *place, color, wavelengths_nm, camera_ray };
        told.samples.push(sample);
        Sample { watch, told: &mut told, tree, weight, counts: color.is_finite() }.add();
    }
    add_rounding(&mut told);
    add_up(&mut told);
    told.paths = paths::paths(&told);
    told
}

/// One sample on its way into the explanation.
struct Sample<'a, 'w> {
    watch: &'a Watch<'w>,
    told: &'a mut Explanation,
    tree: &'a RayTree,
    /// One over the number of samples.
    weight: f64,
    /// False where its colour is no number, and it counts as black.
    counts: bool,
}

impl Sample<'_, '_> {
    fn add(&mut self) {
        let first = self.told.rays.len();
        let sample = self.told.samples.len() - 1;
        for ray in &self.tree.rays {
            let told = self.traced(ray, sample, first);
            self.told.rays.push(told);
        }
        // What asks, and what was not followed, after all that were traced: so parents come first.
        let mut shadows: Vec<usize> = Vec::new();
        for (number, ray) in self.tree.rays.iter().enumerate() {
            shadows.push(self.told.rays.len());
            for shadow in &ray.shadows {
                let told = self.shadow(shadow, ray, sample, first + number);
                self.told.rays.push(told);
            }
            for cut in &ray.cuts {
                let end = match cut.why {
                    Cut::Depth => End::DepthLimit,
                    Cut::Weight => End::TooLittleWeight,
                    Cut::Number => End::TooManyRays,
                    Cut::Chance => End::Chance,
                };
                let told = ExplainedRay {
                    kind: kind(cut.kind),
                    depth: u32::from(ray.task.depth) + 1,
                    ..self.unknown(ray, sample, Some(first + number), end, cut.weight)
                };
                self.told.rays.push(told);
            }
        }
        for share in &self.tree.shares {
            self.add_term(share, first, &shadows);
        }
        self.add_blocked(first, &shadows);
    }

    /// A ray of which only its end is known.
    fn unknown(
        &self,
        ray: &TracedRay,
        sample: usize,
        parent: Option<usize>,
        end: End,
        throughput: Rgb,
    ) -> ExplainedRay {
        let alone = if let [hero] = ray.wavelengths[..] { Some(hero) } else { None };
        let wavelength_nm = alone.or_else(|| ray.task.band.and_then(|band| self.watch.wavelength_nm(band)));
        ExplainedRay {
            sample,
            parent,
            kind: kind(ray.task.kind),
            light: None,
            depth: u32::from(ray.task.depth),
            wavelength_nm,
            origin: None,
            direction: None,
            end,
            distance: None,
            throughput,
            medium: self.medium(ray.medium, wavelength_nm.or_else(|| hero(ray))),
            absorption: Rgb::WHITE,
            surface: None,
            blockers: Vec::new(),
            transmittance: None,
            share: [0.0; 3],
        }
    }

    fn traced(&self, ray: &TracedRay, sample: usize, first: usize) -> ExplainedRay {
        let task = &ray.task;
        let parent = (task.parent != task.id).then(|| first + task.parent as usize);
        let surface = ray.hit.as_ref().and_then(Option::as_ref);
        let surface = surface.filter(|_| ray.scattered.is_none());
        let end = match (surface, &ray.bsdf) {
            _ if ray.scattered.is_some() => End::Scattered,
            (None, _) => End::Background,
            (Some(_), None) => End::NoEffect,
            (Some(_), Some(bsdf)) if !bsdf.emission.is_black() => End::Light,
            (Some(_), Some(_)) => End::Surface,
        };
        let distance = ray.scattered.unwrap_or_else(|| surface.map_or(f64::INFINITY, |surface| surface.t));
        ExplainedRay {
            origin: Some(task.ray.origin),
            direction: Some(task.ray.direction),
            distance: Some(distance),
            absorption: ray.transmittance,
            surface: surface.map(|surface| self.surface(surface, ray)),
            ..self.unknown(ray, sample, parent, end, task.throughput)
        }
    }

    fn surface(&self, surface: &SurfaceInteraction, ray: &TracedRay) -> ExplainedSurface {
        let scene = self.watch.scene;
        let wo = -ray.task.ray.direction;
        ExplainedSurface {
            point: surface.point,
            object: object_name(scene, surface),
            object_number: surface.object,
            material: material_name(scene, surface.material),
            normal: surface.geometric_normal,
            shading_normal: surface.shading_normal,
            incidence: angle_between(surface.shading_normal, wo),
            mirror: ray.bsdf.map_or(Rgb::BLACK, |bsdf| bsdf.mirror),
            boundaries: ray.boundaries.iter().map(|boundary| self.boundary(boundary, ray)).collect(),
        }
    }

    fn boundary(&self, crossing: &BoundaryCrossing, ray: &TracedRay) -> Boundary {
        let wo = -ray.task.ray.direction;
        let [before, beyond] = crossing.indices;
        let medium = |side: usize| ExplainedMedium {
            material: crossing.media[side].map(|inside| material_name(self.watch.scene, inside.material)),
            index: crossing.indices[side],
        };
        Boundary {
            media: [medium(0), medium(1)],
            wavelength_nm: hero(ray).or_else(|| crossing.band.and_then(|band| self.watch.wavelength_nm(band))),
            part: crossing.share,
            incidence: angle_between(crossing.normal, wo),
            refraction: crossing.refracted.map(|direction| angle_between(crossing.normal, -direction)),
            critical: critical_angle(before, beyond),
            reflectance: crossing.reflectance,
            transmittance: 1.0 - crossing.reflectance,
            fresnel: crossing.fresnel,
            reflected_weight: crossing.weights[0],
            refracted_weight: crossing.weights[1],
        }
    }

    fn medium(&self, inside: Option<Inside>, wavelength_nm: Option<f64>) -> ExplainedMedium {
        let scene = self.watch.scene;
        let index = inside.map_or(1.0, |inside| {
            let wavelength = wavelength_nm.or(self.watch.settings.wavelength_nm);
            match (&scene.materials[inside.material as usize].body, wavelength) {
                (Some(body), Some(wavelength)) if self.watch.is_path() => body.path_ior().index(wavelength),
                (Some(body), Some(wavelength)) => body.ior.index(wavelength),
                _ => scene.index_d(Some(inside)),
            }
        });
        ExplainedMedium { material: inside.map(|inside| material_name(scene, inside.material)), index }
    }

    fn shadow(&self, shadow: &AnsweredShadow, ray: &TracedRay, sample: usize, parent: usize) -> ExplainedRay {
        let AnsweredShadow { question, transmittance, steps } = shadow;
        let is_blocked = transmittance.is_black();
        let blockers: Vec<Blocker> = steps.iter().filter_map(|step| self.blocker(step)).collect();
        let last = blockers.last().filter(|_| is_blocked).map(|blocker| blocker.distance);
        let absorption = steps.iter().fold(Rgb::WHITE, |left, step| left * step.absorption);
        let first_medium = steps.first().and_then(|step| step.medium);
        let end = if is_blocked { End::Blocked } else { End::Light };
        ExplainedRay {
            kind: Kind::Shadow,
            light: light_of(question.terms[0].0).map(|light| self.watch.light_name(light).to_owned()),
            origin: Some(question.ray.origin),
            direction: Some(question.ray.direction),
            distance: Some(last.unwrap_or(question.distance)),
            medium: self.medium(first_medium, hero(ray)),
            absorption,
            blockers,
            transmittance: Some(*transmittance),
            ..self.unknown(ray, sample, Some(parent), end, ray.task.throughput * ray.transmittance)
        }
    }

    fn blocker(&self, step: &ShadowStep) -> Option<Blocker> {
        let surface = step.surface.as_ref()?;
        Some(Blocker {
            point: surface.point,
            object: object_name(self.watch.scene, surface),
            object_number: surface.object,
            material: material_name(self.watch.scene, surface.material),
            distance: surface.t,
            absorption: step.absorption,
            reflectance: step.reflectance,
            transmittance: step.transmittance,
        })
    }

    fn add_term(&mut self, share: &Share, first: usize, shadows: &[usize]) {
        let ray = share.task as usize;
        let answered = share.shadow.map(|number| &self.tree.rays[ray].shadows[number as usize]);
        let unblocked = answered.and_then(|shadow| {
            shadow.question.terms.iter().find(|(term, _)| *term == share.term).map(|(_, value)| *value)
        });
        let value = if self.counts { share.value } else { Rgb::BLACK };
        self.told.terms.push(ExplainedTerm {
            ray: Some(first + ray),
            kind: term_kind(share.term),
            light: light_of(share.term).map(|light| self.watch.light_name(light).to_owned()),
            shadow_ray: share.shadow.map(|number| shadows[ray] + number as usize),
            unblocked,
            value: share.value,
            share: value.to_array().map(|component| f64::from(component) * self.weight),
        });
    }

    /// The terms of lights that something blocks altogether: nothing was added for them.
    fn add_blocked(&mut self, first: usize, shadows: &[usize]) {
        for (number, ray) in self.tree.rays.iter().enumerate() {
            for (shadow_number, shadow) in ray.shadows.iter().enumerate() {
                if !shadow.transmittance.is_black() {
                    continue;
                }
                for (term, unblocked) in shadow.question.terms.iter().filter(|(_, value)| !value.is_black()) {
                    self.told.terms.push(ExplainedTerm {
                        ray: Some(first + number),
                        kind: term_kind(*term),
                        light: light_of(*term).map(|light| self.watch.light_name(light).to_owned()),
                        shadow_ray: Some(shadows[number] + shadow_number),
                        unblocked: Some(*unblocked),
                        value: Rgb::BLACK,
                        share: [0.0; 3],
                    });
                }
            }
        }
    }
}

/// Adds what lies between the sum of the shares and the pixel as it is stored: samples are sums of `f32`, and pixels whole numbers
/// of 2⁻³⁰, see [`crate::film`].
fn add_rounding(told: &mut Explanation) {
    let pixel = told.pixel.to_array().map(f64::from);
    let mut sum = told.terms.iter().fold([0.0; 3], |sum, term| [0, 1, 2].map(|i: usize| sum[i] + term.share[i]));
    for _ in 0..MOST_ROUNDINGS {
        if sum == pixel {
            return;
        }
        let share = [0, 1, 2].map(|i: usize| pixel[i] - sum[i]);
        sum = [0, 1, 2].map(|i: usize| sum[i] + share[i]);
        let value = Rgb::from(share.map(|component| component as f32));
        let (ray, light, shadow_ray, unblocked) = (None, None, None, None);
        told.terms.push(ExplainedTerm { ray, kind: TermKind::Rounding, light, shadow_ray, unblocked, value, share });
    }
}

/// Gives every ray the sum of its own terms and of those that followed from it.
fn add_up(told: &mut Explanation) {
    for term in &told.terms {
        for ray in [term.ray, term.shadow_ray].into_iter().flatten() {
            for (sum, share) in told.rays[ray].share.iter_mut().zip(term.share) {
                *sum += share;
            }
        }
    }
    // Children come after their parents. What a shadow ray brings is its parent's already.
    for child in (0..told.rays.len()).rev() {
        let ray = &told.rays[child];
        if let (Some(parent), false) = (ray.parent, ray.kind == Kind::Shadow) {
            let share = ray.share;
            for (sum, share) in told.rays[parent].share.iter_mut().zip(share) {
                *sum += share;
            }
        }
    }
}

fn kind(kind: RayKind) -> Kind {
    match kind {
        RayKind::Camera => Kind::Camera,
        RayKind::Reflected => Kind::Reflected,
        RayKind::Refracted => Kind::Refracted,
        RayKind::Scattered => Kind::Scattered,
    }
}

fn term_kind(term: Term) -> TermKind {
    match term {
        Term::Background => TermKind::Background,
        Term::Emission => TermKind::Emission,
        Term::Ambient => TermKind::Ambient,
        Term::Diffuse(_) => TermKind::Diffuse,
        Term::Specular(_) => TermKind::Specular,
        Term::Scattering(_) => TermKind::Scattering,
        Term::Photons => TermKind::Photons,
    }
}

fn light_of(term: Term) -> Option<u32> {
    match term {
        Term::Diffuse(light) | Term::Specular(light) | Term::Scattering(light) => Some(light),
        Term::Background | Term::Emission | Term::Ambient | Term::Photons => None,
    }
}

fn object_name(scene: &CompiledScene, surface: &SurfaceInteraction) -> String {
    scene.object_names.get(surface.object).unwrap_or_default().into_owned()
}

fn material_name(scene: &CompiledScene, material: u32) -> String {
    scene.material_names.get(material as usize).cloned().unwrap_or_default()
}

/// The wavelength by which a path's ray is bent, nanometres; `None` of other rays.
fn hero(ray: &TracedRay) -> Option<f64> {
    ray.wavelengths.first().copied()
}

/// The angle between two directions, the normal's sign left out: exact also where it is small.
fn angle_between(normal: Normal3, direction: Vector3) -> f64 {
    let normal = normal.as_vector();
    portable::atan2(normal.cross(direction).length(), normal.dot(direction).abs())
}

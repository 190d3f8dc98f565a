//! Recursive ray tracing: the lecture's `RT_shade`, with Fresnel's equations, nested bodies, absorption and dispersion.
//!
//! Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980; `shade` follows the order of the lecture:
//! the ambient term, then each light, then reflection, then refraction. World space; `wo` leads to the viewer, `wi` to a
//! light, both leaving the surface.

use snell_math::{Normal3, Rgb, Vector3};
use snell_scene::scene::Medium;

use super::dispersion::Dispersion;
use super::{Integrator, Sink, Spawn, scattering};
use crate::camera::{Camera, Projection, Window};
use crate::compile::CompiledScene;
use crate::geometry::{Geometry, Hit};
use crate::interaction::SurfaceInteraction;
use crate::light::Light;
use crate::material::{Bsdf, Interface};
use crate::observe::Observer;
use crate::optics::{beer_lambert, fresnel_dielectric, reflect, refract};
use crate::task::{Band, Crossing, Inside, RayKind, RayTask, ShadowQuestion, Term};
use crate::texture::ViewProjection;

/// Recursive ray tracing over lights without extent.
#[derive(Clone, Debug)]
pub struct Whitted {
    dispersion: Dispersion,
    camera: Camera,
    view: ViewProjection,
}

impl Whitted {
    /// For a scene seen by a camera, splitting white light into at most `bands` wavelength bands at dispersive surfaces.
    pub fn new(scene: &CompiledScene, camera: &Camera, bands: u32) -> Self {
        let [u, v, w] = camera.axes();
        let Window { left, right, bottom, top } = camera.window();
        let view = match camera.projection() {
            Projection::Perspective => ViewProjection { u, v, w, left, right, bottom, top },
            Projection::Orthographic => ViewProjection::for_orthographic(u, v, w, (right - left) / (top - bottom)),
        };
        let dispersion = Dispersion::new(scene, bands, camera.pixel_angle());
        Self { dispersion, camera: camera.clone(), view }
    }

    /// What a ray sees that leaves the scene.
    fn background(&self, scene: &CompiledScene, task: &RayTask) -> Rgb {
        // The parallel rays of an orthographic camera see a photograph by where they are, not by where they go.
        if task.kind == RayKind::Camera && self.camera.projection() == Projection::Orthographic {
            let position = self.camera.picture_position(task.ray.origin);
            return scene.background.evaluate_at_pixel(position, task.ray.direction);
        }
        scene.background.evaluate(task.ray.direction, &self.view)
    }
}

impl Integrator for Whitted {
    fn shade<O: Observer>(&self, scene: &CompiledScene, task: &RayTask, hit: Option<&Hit>, out: &mut Sink<'_, O>) {
        // What the body that the ray travels in does to it on the way.
        match medium_around(scene, task, out) {
            None => self.shade_end(scene, task, hit, out),
            Some(medium) => {
                let distance = hit.map_or(f64::INFINITY, |hit| hit.t);
                let weakened = travel(scene, task, medium, distance, out);
                self.shade_end(scene, &weakened, hit, out);
            }
        }
    }
}

// Code that runs for nearly every ray stands in functions of its own here and there, that are not inlined: what the compiler
// makes of one large function keeps less in registers than it moves to and fro.
impl Whitted {
    /// What is at the end of a ray, whose throughput is what is left there.
    #[inline(never)]
    fn shade_end<O: Observer>(&self, scene: &CompiledScene, task: &RayTask, hit: Option<&Hit>, out: &mut Sink<'_, O>) {
        let Some(hit) = hit else {
            out.met(task, None);
            out.add(task, Term::Background, self.background(scene, task));
            return;
        };
        let interaction = scene.interaction(&task.ray, hit);
        out.met(task, Some(&interaction));
        let material = &scene.materials[interaction.material as usize];
        let evaluated;
        let bsdf = match material.constant_bsdf() {
            Some(constant) if interaction.vertex_color.is_none() => constant,
            _ => {
                evaluated = material.bsdf(&scene.textures, &interaction);
                &evaluated
            }
        };

        let leaving = interaction.is_outward(task.ray.direction);
        let crossing = material.body.as_ref().map(|body| {
            let inside = Inside { solid: interaction.solid, material: interaction.material, priority: body.priority };
            out.media.cross(task.media, inside, leaving, Geometry::is_at_origin(&task.ray, hit))
        });
        // A boundary that a body of higher priority covers is not there.
        if let Some(crossing) = crossing
            && crossing.is_without_effect()
        {
            out.pass(task, interaction.spawn_ray(task.ray.direction), crossing.after);
            return;
        }

        let wo = -task.ray.direction;
        add_local_terms(scene, task, &interaction, bsdf, wo, out);
        if !bsdf.mirror.is_black() {
            spawn_reflected(task, &interaction, wo, bsdf.mirror, out);
        }
        if let (Some(interface), Some(crossing)) = (bsdf.interface, crossing) {
            self.spawn_at_interface(scene, task, &interaction, wo, interface, crossing, out);
        }
    }

    /// Reflection and refraction at the boundary of a transparent body.
    #[expect(clippy::too_many_arguments, reason = "the parts of one hit; a struct of them would have this one user")]
    fn spawn_at_interface<O: Observer>(
        &self,
        scene: &CompiledScene,
        task: &RayTask,
        interaction: &SurfaceInteraction,
        wo: Vector3,
        interface: Interface,
        crossing: Crossing,
        out: &mut Sink<'_, O>,
    ) {
        let boundary = Boundary { interaction, crossing, interface, wo, normal: consistent_normal(interaction, wo) };
        let sides = [crossing.before, crossing.beyond];
        let split = match task.band {
            Some(_) => None,
            None => self.dispersion.split(scene, sides, wo, boundary.normal, task.split),
        };
        let reflected = match split {
            // Each band for itself: the reflected shares come together again, since reflection does not disperse.
            Some(bands) => bands.fold(Rgb::BLACK, |sum, (band, weight)| {
                sum + weight * self.refract_band(scene, task, &boundary, Some(band), weight, out)
            }),
            None => self.refract_band(scene, task, &boundary, task.band, Rgb::WHITE, out),
        };
        spawn_reflected(task, interaction, wo, reflected, out);
    }

    /// Spawns the refracted ray of a band, or of all light, with a weight; returns the coefficient of the reflected one.
    fn refract_band<O: Observer>(
        &self,
        scene: &CompiledScene,
        task: &RayTask,
        boundary: &Boundary<'_>,
        band: Option<Band>,
        weight: Rgb,
        out: &mut Sink<'_, O>,
    ) -> Rgb {
        let Boundary { interaction, crossing, wo, normal, .. } = *boundary;
        let eta_before = self.dispersion.index(scene, crossing.before, band);
        let eta_beyond = self.dispersion.index(scene, crossing.beyond, band);
        let direction = refract(wo, normal, eta_before / eta_beyond);
        let (reflect_share, transmit_share) = boundary.shares(eta_before, eta_beyond, direction.is_some());
        let Some(direction) = direction else {
            out.total_internal_reflection(task);
            return reflect_share;
        };
        let weight = weight * transmit_share;
        out.spawn(task, Spawn { kind: RayKind::Refracted, weight, media: crossing.after, band }, || {
            let geometric = interaction.geometric_normal.face_forward(wo);
            // On a smooth mesh the shading normal may send it back to the side it came from; then the flat one decides.
            interaction.spawn_ray(if geometric.dot(direction) < 0.0 {
                direction
            } else {
                refract(wo, geometric, eta_before / eta_beyond).unwrap_or(-wo)
            })
        });
        reflect_share
    }
}

/// What the body that a ray travels in is filled with, where light does not pass it unchanged.
#[inline]
fn medium_around<'a, O>(scene: &'a CompiledScene, task: &RayTask, out: &Sink<'_, O>) -> Option<&'a Medium> {
    let inside = out.media.current(task.media)?;
    let body = scene.materials[inside.material as usize].body.as_ref()?;
    (!body.medium.is_clear()).then_some(&body.medium)
}

/// Scatters over the stretch up to the hit, and gives the ray with what absorption leaves of it.
#[inline(never)]
fn travel<O: Observer>(
    scene: &CompiledScene,
    task: &RayTask,
    medium: &Medium,
    distance: f64,
    out: &mut Sink<'_, O>,
) -> RayTask {
    if !medium.scattering.is_black() {
        scattering::gather(scene, task, medium, distance, out);
    }
    let left = beer_lambert(medium.absorption + medium.scattering, distance);
    RayTask { throughput: task.throughput * left, ..*task }
}

/// A boundary as one ray meets it.
struct Boundary<'a> {
    interaction: &'a SurfaceInteraction,
    crossing: Crossing,
    interface: Interface,
    wo: Vector3,
    /// On the side of `wo`.
    normal: Normal3,
}

impl Boundary<'_> {
    /// The coefficients of the reflected and the refracted ray.
    ///
    /// Under total internal reflection all that either would carry is reflected: the lecture's function has no transmitted
    /// ray there and says nothing of its share, but light does not vanish.
    fn shares(&self, eta_before: f64, eta_beyond: f64, refracts: bool) -> (Rgb, Rgb) {
        let Interface { fresnel, reflect, transmit } = self.interface;
        match (fresnel, refracts) {
            (true, true) => {
                let reflectance = fresnel_dielectric(self.normal.dot(self.wo), eta_before, eta_beyond) as f32;
                (reflect * reflectance, transmit * (1.0 - reflectance))
            }
            (true, false) => (reflect, Rgb::BLACK),
            (false, true) => (reflect, transmit),
            (false, false) => (reflect + transmit, Rgb::BLACK),
        }
    }
}

/// Emission, the ambient term, and a question to each light that may show.
fn add_local_terms<O: Observer>(
    scene: &CompiledScene,
    task: &RayTask,
    interaction: &SurfaceInteraction,
    bsdf: &Bsdf,
    wo: Vector3,
    out: &mut Sink<'_, O>,
) {
    if !bsdf.emission.is_black() {
        out.add(task, Term::Emission, bsdf.emission);
    }
    let ambient = bsdf.ambient * scene.ambient;
    if !ambient.is_black() {
        out.add(task, Term::Ambient, ambient);
    }
    if !bsdf.is_lit() {
        return;
    }
    // The side that is lit: the viewer's, or the outward one of surfaces that have but one.
    let side = if bsdf.one_sided || interaction.is_outward(wo) { 1.0 } else { -1.0 };
    for (light, number) in scene.lights.iter().zip(0..) {
        ask_light(light, number, task, interaction, bsdf, side, out);
    }
}

/// The question to one light, with the terms that it would add; `side` is 1 where the outward side is lit, −1 where the other is.
#[inline(never)]
fn ask_light<O: Observer>(
    light: &Light,
    number: u32,
    task: &RayTask,
    interaction: &SurfaceInteraction,
    bsdf: &Bsdf,
    side: f64,
    out: &mut Sink<'_, O>,
) {
    let Some(arriving) = light.illuminate(interaction.point) else { return };
    let wi = arriving.to_light;
    let normal = interaction.shading_normal.as_vector() * side;
    // No question where the surface itself is in the way.
    if normal.dot(wi) <= 0.0 || interaction.geometric_normal.dot(wi) * side <= 0.0 {
        return;
    }
    let local = bsdf.reflect_light(normal, -task.ray.direction, wi);
    let weight = task.throughput * arriving.irradiance;
    let (diffuse, specular) = (weight * local.diffuse, weight * local.specular);
    if out.needs_no_answer(diffuse, specular) {
        return;
    }
    let ray = interaction.spawn_ray(wi);
    // From where the ray really starts: the light may be as near as the offset.
    let distance = arriving.distance - (ray.origin - interaction.point).dot(wi);
    out.ask(ShadowQuestion {
        ray,
        distance,
        terms: [(Term::Diffuse(number), diffuse), (Term::Specular(number), specular)],
        sample: task.sample,
        task: task.id,
        media: task.media,
        extinction_scale: 1.0,
    });
}

/// The mirrored ray, on the side it came from.
fn spawn_reflected<O: Observer>(
    task: &RayTask,
    interaction: &SurfaceInteraction,
    wo: Vector3,
    weight: Rgb,
    out: &mut Sink<'_, O>,
) {
    if weight.is_black() && !out.rules.weightless_rays {
        return;
    }
    let (media, band) = (task.media, task.band);
    out.spawn(task, Spawn { kind: RayKind::Reflected, weight, media, band }, || {
        let direction = reflect(wo, consistent_normal(interaction, wo));
        let flat = interaction.geometric_normal.face_forward(wo);
        // On a smooth mesh the shading normal may send it through the surface; then the flat one decides.
        interaction.spawn_ray(if flat.dot(direction) > 0.0 { direction } else { reflect(wo, flat) })
    });
}

/// The shading normal on the viewer's side; the geometric one where the shading normal is seen from behind.
fn consistent_normal(interaction: &SurfaceInteraction, wo: Vector3) -> Normal3 {
    let side = if interaction.is_outward(wo) { 1.0 } else { -1.0 };
    let shading = interaction.shading_normal * side;
    if shading.dot(wo) > 0.0 { shading } else { interaction.geometric_normal * side }
}

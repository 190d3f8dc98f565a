//! Milky bodies: light scattered towards the viewer along a ray's way through a scattering medium.
//!
//! The model, deterministic as everything in this room:
//! - *Single scattering.* Along the ray, at points chosen so that each stands for the same share of what the ray loses
//!   (equi-spaced in 1 − exp(−σ t), their strata's middles), each light is asked, straight through the body's boundary as for
//!   any shadow ray. What arrives is turned towards the viewer by Henyey and Greenstein's phase function.
//! - *Multiple scattering*, after Wrenninge, Kulla and Lundqvist, "Oz: The Great and Volumetric" (SIGGRAPH 2013 Talks):
//!   further orders are single scattering again, each on its way from the light in a medium of half the extinction and half
//!   the anisotropy of the order before. That carries light around and through the body where direct light no longer comes,
//!   which is what makes milk glow on the side away from the light.
//!
//! Radiance is in the lecture's units, where a white, matt surface facing a light of intensity one is one: π times the
//! physical. In them a white, isotropic, thick body facing that light has Σ ¼ / (1 + 2⁻ᵏ) = 0.71 over the four orders: soft
//! white, and less than all of the light, since some leaves elsewhere.

use snell_math::{Rgb, portable};
use snell_scene::scene::Medium;

use super::Sink;
use crate::compile::CompiledScene;
use crate::observe::Observer;
use crate::optics::{beer_lambert, henyey_greenstein};
use crate::task::{RayTask, ShadowQuestion, Term};

/// Points along a ray's way through a body.
const POINTS: u32 = 8;
/// Orders of scattering.
const ORDERS: u32 = 4;
/// Each order's extinction and anisotropy over those of the order before.
const FALL: f32 = 0.5;

/// Asks for the light scattered towards the viewer on the first `distance` of a ray's way. `task` is the ray as it enters
/// the stretch.
pub fn gather<O: Observer>(
    scene: &CompiledScene,
    task: &RayTask,
    medium: &Medium,
    distance: f64,
    out: &mut Sink<'_, O>,
) {
    let extinction = medium.absorption + medium.scattering;
    let mean = f64::from(extinction.mean());
    if mean <= 0.0 {
        return;
    }
    let wo = -task.ray.direction;
    // The share of the light that is lost on the whole stretch; a stretch without end loses all.
    let lost = 1.0 - portable::exp(-mean * distance);
    for point in 0..POINTS {
        let quantile = (f64::from(point) + 0.5) / f64::from(POINTS) * lost;
        let t = -portable::ln(1.0 - quantile) / mean;
        // The measure of this point: ∫ dt over its stratum is lost / (POINTS · σ · exp(−σ t)).
        let length = lost / (f64::from(POINTS) * mean * (1.0 - quantile));
        let position = task.ray.at(t);
        let seen = task.throughput * beer_lambert(extinction, t) * medium.scattering * length as f32;
        for (number, light) in scene.lights.iter().enumerate() {
            let Some(arriving) = light.illuminate(position) else { continue };
            let (mut extinction_scale, mut anisotropy) = (1.0, medium.anisotropy);
            for _ in 0..ORDERS {
                let cosine = -wo.dot(arriving.to_light);
                let phase = std::f64::consts::PI * henyey_greenstein(cosine, f64::from(anisotropy));
                let value = seen * arriving.irradiance * phase as f32;
                out.ask(ShadowQuestion {
                    ray: snell_math::Ray::new(position, arriving.to_light),
                    distance: arriving.distance,
                    terms: [(Term::Scattering(number as u32), value), (Term::Scattering(number as u32), Rgb::BLACK)],
                    sample: task.sample,
                    task: task.id,
                    media: task.media,
                    extinction_scale,
                });
                extinction_scale *= FALL;
                anisotropy *= FALL;
            }
        }
    }
}

//! Answers to shadow questions: how much of a light arrives, through everything that is in the way.
//!
//! A shadow ray is straight, also through glass: at every boundary of a transparent body on the way it loses what the
//! boundary reflects and what its colour keeps, and inside what the body absorbs. The reflected share is taken as for light
//! that comes from the rarer side, which is symmetric: a straight ray can not meet total internal reflection. Bodies nest as
//! they do for other rays, by the same stack.

use snell_math::{Ray, Rgb};
use snell_scene::scene::Shadows;

use crate::compile::CompiledScene;
use crate::geometry::{Geometry, Hit, QueryScratch};
use crate::optics;
use crate::statistics::Statistics;
use crate::task::{Inside, MediumStacks, ShadowQuestion};

/// Where the hits of one shadow ray are gathered.
#[derive(Debug, Default)]
pub struct ShadowScratch {
    hits: Vec<Hit>,
}

/// The share of a light that arrives, in [0, 1] for each colour.
pub fn transmittance(
    scene: &CompiledScene,
    shadows: Shadows,
    question: &ShadowQuestion,
    media: &mut MediumStacks,
    scratch: &mut ShadowScratch,
    query: &mut QueryScratch,
    statistics: &mut Statistics,
) -> Rgb {
    if shadows == Shadows::None {
        return Rgb::WHITE;
    }
    statistics.shadow_rays += 1;
    let ShadowQuestion { ray, distance, .. } = question;
    if shadows == Shadows::Opaque {
        return if scene.geometry.is_blocked(ray, *distance, query) { Rgb::BLACK } else { Rgb::WHITE };
    }
    scratch.hits.clear();
    if scene.geometry.gather_blockers(ray, *distance, &mut scratch.hits, query) {
        return Rgb::BLACK;
    }
    if scratch.hits.is_empty() && question.media == Default::default() {
        return Rgb::WHITE;
    }
    scratch.hits.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.order().cmp(&b.order())));
    filter(scene, ray, *distance, question, &scratch.hits, media)
}

/// Walks along a shadow ray from boundary to boundary.
fn filter(
    scene: &CompiledScene,
    ray: &Ray,
    distance: f64,
    question: &ShadowQuestion,
    hits: &[Hit],
    media: &mut MediumStacks,
) -> Rgb {
    let mut share = Rgb::WHITE;
    let mut stack = question.media;
    let mut from = 0.0;
    for hit in hits {
        let before = media.current(stack);
        if let Some(inside) = before {
            share *= extinction(scene, inside.material, hit.t - from, question.extinction_scale);
        }
        from = hit.t;
        let interaction = scene.interaction(ray, hit);
        let material = &scene.materials[interaction.material as usize];
        let (Some(body), Some(interface)) = (&material.body, material.bsdf(&scene.textures, &interaction).interface)
        else {
            return Rgb::BLACK;
        };
        let inside = Inside { solid: interaction.solid, material: interaction.material, priority: body.priority };
        let leaving = interaction.is_outward(ray.direction);
        let crossing = media.cross(stack, inside, leaving, Geometry::is_at_origin(ray, hit));
        stack = crossing.after;
        if crossing.is_without_effect() {
            continue;
        }
        share *= interface.transmit;
        if interface.fresnel {
            let (a, b) = (scene.index_d(crossing.before), scene.index_d(crossing.beyond));
            let cosine = interaction.shading_normal.dot(ray.direction).abs();
            share = share * (1.0 - optics::fresnel_dielectric(cosine, a.min(b), a.max(b))) as f32;
        }
        if share.is_black() {
            return Rgb::BLACK;
        }
    }
    if let Some(inside) = media.current(stack) {
        share *= extinction(scene, inside.material, distance - from, question.extinction_scale);
    }
    share
}

/// What is left after a stretch inside a body.
fn extinction(scene: &CompiledScene, material: u32, distance: f64, scattering_scale: f32) -> Rgb {
    match &scene.materials[material as usize].body {
        Some(body) if !body.medium.is_clear() => {
            let coefficient = body.medium.absorption + body.medium.scattering;
            let scale = if body.medium.scattering.is_black() { 1.0 } else { scattering_scale };
            optics::beer_lambert(coefficient * scale, distance)
        }
        _ => Rgb::WHITE,
    }
}

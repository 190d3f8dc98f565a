//! Answers to shadow questions: how much of a light arrives, through everything that is in the way.
//!
//! A shadow ray is straight, also through glass: at every boundary of a transparent body on the way it loses what the
//! boundary reflects and what its colour keeps, and inside what the body absorbs. The reflected share is taken as for light
//! that comes from the rarer side, which is symmetric: a straight ray can not meet total internal reflection. Bodies nest as
//! they do for other rays, by the same stack.

use snell_math::lanes::{Bits, LaneColor, Lanes, WIDTH};
use snell_math::{Ray, Rgb};
use snell_scene::scene::Shadows;

use crate::compile::CompiledScene;
use crate::geometry::{Blockers, Geometry, Hit, QueryScratch};
use crate::observe::Observer;
use crate::optics;
use crate::statistics::Statistics;
use crate::task::{Inside, MediumStack, MediumStacks, QuestionRows, ShadowQuestion, column, set_column};

/// Where the hits of shadow rays are gathered.
#[derive(Debug, Default)]
pub struct ShadowScratch {
    blockers: Blockers,
    /// Those of one ray.
    hits: Vec<Hit>,
}

/// What answers depend on.
pub struct Context<'a> {
    /// The scene.
    pub scene: &'a CompiledScene,
    /// What blocks light.
    pub shadows: Shadows,
    /// The stacks of bodies that questions refer to.
    pub media: &'a mut MediumStacks,
    /// Buffers.
    pub query: &'a mut QueryScratch,
}

/// Answers questions side by side, those of `rows` from place `at` on that are `active`: how much of each light arrives. Adds it
/// to the samples, in the order of the questions.
#[expect(clippy::too_many_arguments, reason = "a step of the tracing loop, which is its only caller")]
#[inline(always)]
pub fn answer<L: Lanes, O: Observer>(
    mut context: Context<'_>,
    rows: &QuestionRows,
    at: usize,
    active: Bits,
    scratch: &mut ShadowScratch,
    sums: &mut [Rgb],
    statistics: &mut Statistics,
    observer: &mut O,
) {
    let mut blocked = Bits::NONE;
    let mut transmittance = [[1.0; WIDTH]; 3];
    if context.shadows != Shadows::None {
        statistics.shadow_rays += u64::from(active.count());
        let any_blocks = context.shadows == Shadows::Opaque;
        let ShadowScratch { blockers, hits } = scratch;
        let geometry = &context.scene.geometry;
        geometry.block_lanes::<L>(rows, at, active, any_blocks, blockers, context.query);
        blocked = blockers.blocked;
        if !any_blocks {
            let is_filtered = |lane: &usize| rows.media[at + lane] != MediumStack::EMPTY;
            if !blockers.hits.is_empty() || active.lanes().any(|lane| is_filtered(&lane)) {
                for lane in active.without(blocked).lanes() {
                    hits.clear();
                    let of_lane = blockers.hits.iter().filter(|(of, _)| usize::from(*of) == lane);
                    hits.extend(of_lane.map(|(_, hit)| *hit));
                    if !hits.is_empty() || is_filtered(&lane) {
                        hits.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.order().cmp(&b.order())));
                        let share = context.filter(&rows.question(at + lane), hits);
                        set_column(&mut transmittance, lane, share.to_array());
                    }
                }
            }
        }
    }
    let transmitted = LaneColor::<L::Floats>::load(&transmittance, 0);
    let (mut arriving, mut adding) = ([[[0.0; WIDTH]; 3]; 2], [Bits::NONE; 2]);
    for term in 0..2 {
        let share = LaneColor::<L::Floats>::load(&rows.shares[term], at);
        (share * transmitted).store(&mut arriving[term], 0);
        adding[term] = L::all().without(share.is_black());
    }
    let open = active.without(blocked | transmitted.is_black());
    for lane in active.lanes() {
        if O::WATCHES {
            let is_blocked = blocked.has(lane);
            let transmittance = if is_blocked { Rgb::BLACK } else { Rgb::from(column(&transmittance, lane)) };
            observer.shadow(&rows.question(at + lane), transmittance);
        }
        if !open.has(lane) {
            continue;
        }
        let notes = &rows.notes[at + lane];
        for ((arriving, adding), term) in arriving.iter().zip(adding).zip(notes.terms) {
            if adding.has(lane) {
                let share = Rgb::from(column(arriving, lane));
                sums[rows.sample[at + lane] as usize] += share;
                observer.term(notes.task, term, share);
            }
        }
    }
}

impl Context<'_> {
    /// The share of a light that arrives through the transparent surfaces in its way, in the order in which they are met.
    #[inline(never)]
    fn filter(&mut self, question: &ShadowQuestion, hits: &[Hit]) -> Rgb {
        let ShadowQuestion { ray, distance, .. } = question;
        filter(self.scene, ray, *distance, question, hits, self.media)
    }
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
        let crossing = media.cross(stack, inside, leaving, Geometry::is_at_origin(ray, hit.t));
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

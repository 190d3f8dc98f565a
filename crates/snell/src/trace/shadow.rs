//! Answers to shadow questions: how much of a light arrives, through everything that is in the way.
//!
//! A shadow ray is straight, also through glass: at every boundary of a transparent body on the way it loses what the
//! boundary reflects and what its colour keeps, and inside what the body absorbs. The reflected share is taken as for light
//! that comes from the rarer side, which is symmetric: a straight ray can not meet total internal reflection. Bodies nest as
//! they do for other rays, by the same stack.

use snell_math::Rgb;
use snell_math::lanes::{Bits, LaneColor, LaneVector, Lanes, WIDTH};
use snell_scene::scene::{Medium, Shadows};

use crate::compile::CompiledScene;
use crate::geometry::{Blockers, Geometry, Hit, HitRows, QueryScratch, RayRow};
use crate::interaction::{LaneSurface, SurfaceRows, Surroundings};
use crate::observe::{Observer, ShadowStep};
use crate::optics::{Stretches, beer_lambert, fresnel_dielectric_lanes};
use crate::statistics::Statistics;
use crate::task::{Inside, MediumStack, MediumStacks, QuestionRows, SampleSums, column, set_column};

/// Where the hits of shadow rays are gathered.
#[derive(Debug)]
pub struct ShadowScratch {
    blockers: Blockers,
    /// Those of each ray, in the order in which they are met.
    hits: [Vec<Hit>; WIDTH],
    /// The surfaces that the rays have come to.
    met: HitRows,
    surfaces: SurfaceRows,
}

impl Default for ShadowScratch {
    fn default() -> Self {
        Self {
            blockers: Blockers::default(),
            hits: [const { Vec::new() }; WIDTH],
            met: HitRows::NOTHING,
            surfaces: SurfaceRows::default(),
        }
    }
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
    sums: &mut SampleSums,
    statistics: &mut Statistics,
    observer: &mut O,
) {
    let mut blocked = Bits::NONE;
    let mut transmitted = LaneColor::splat(Rgb::WHITE);
    if context.shadows != Shadows::None {
        statistics.shadow_rays += u64::from(active.count());
        let any_blocks = context.shadows == Shadows::Opaque;
        let geometry = &context.scene.geometry;
        geometry.block_lanes::<L>(rows, at, active, any_blocks, &mut scratch.blockers, context.query);
        blocked = scratch.blockers.blocked;
        if !any_blocks {
            let open = active.without(blocked);
            let is_inside = open.lanes().any(|lane| rows.media[at + lane] != MediumStack::EMPTY);
            if is_inside || !scratch.blockers.hits.is_empty() {
                transmitted = context.filter::<L, O>(rows, at, open, scratch, observer);
            }
        }
    }
    let open = active.without(blocked | transmitted.is_black());
    let (first, second) = (LaneColor::load(&rows.shares[0], at), LaneColor::load(&rows.shares[1], at));
    let terms: [(Bits, LaneColor<L::Floats>); 2] = [
        (open.without(first.is_black()), first * transmitted),
        (open.without(second.is_black()), second * transmitted),
    ];
    sums.add::<L, 2>(&rows.sample, at, terms);
    if O::WATCHES {
        let mut shares = [[[0.0; WIDTH]; 3]; 3];
        for (color, shares) in [transmitted, terms[0].1, terms[1].1].iter().zip(&mut shares) {
            color.store(shares, 0);
        }
        let [transmitted, arriving @ ..] = &shares;
        // Question by question, however many are answered together: a watcher adds in the order in which samples do.
        for lane in active.lanes() {
            if O::DETAILS && blocked.has(lane) {
                context.tell_blocker(rows, at + lane, observer);
            }
            let transmittance = if blocked.has(lane) { Rgb::BLACK } else { Rgb::from(column(transmitted, lane)) };
            observer.shadow(&rows.question(at + lane), transmittance);
            let notes = &rows.notes[at + lane];
            for ((term, (adding, _)), shares) in notes.terms.iter().zip(&terms).zip(arriving) {
                if adding.has(lane) {
                    observer.term(notes.task, *term, Rgb::from(column(shares, lane)));
                }
            }
        }
    }
}

/// How many transparent surfaces the search for a blocker goes through: it is a watcher's alone.
const MOST_BEFORE_BLOCKER: u32 = 256;

/// How far shadow rays have come.
struct Way<L: Lanes> {
    /// The share of the light that is left.
    share: LaneColor<L::Floats>,
    /// The bodies around the rays.
    media: [MediumStack; WIDTH],
    /// The distance of the last surface.
    from: [f64; WIDTH],
}

impl Context<'_> {
    /// The shares of lights that arrive in some lanes through the transparent surfaces in their way.
    #[inline(always)]
    fn filter<L: Lanes, O: Observer>(
        &mut self,
        rows: &QuestionRows,
        at: usize,
        lanes: Bits,
        scratch: &mut ShadowScratch,
        observer: &mut O,
    ) -> LaneColor<L::Floats> {
        let ShadowScratch { blockers, hits, met, surfaces } = scratch;
        hits.iter_mut().for_each(Vec::clear);
        for (lane, hit) in &blockers.hits {
            hits[usize::from(*lane)].push(*hit);
        }
        let mut way =
            Way::<L> { share: LaneColor::splat(Rgb::WHITE), media: [MediumStack::EMPTY; WIDTH], from: [0.0; WIDTH] };
        for lane in lanes.lanes() {
            hits[lane].sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.order().cmp(&b.order())));
            way.media[lane] = rows.media[at + lane];
        }
        for step in 0.. {
            let mut meeting = 0;
            for lane in lanes.without(way.share.is_black()).lanes() {
                if let Some(hit) = hits[lane].get(step) {
                    met.set(at + lane, Some(*hit));
                    meeting |= 1 << lane;
                }
            }
            if meeting == 0 {
                break;
            }
            let row = RayRow { origin: &rows.origin, direction: &rows.direction };
            self.scene.geometry.surfaces::<L>(row, at, met, Bits(meeting), surfaces);
            self.go_through(rows, at, Bits(meeting), met, surfaces, &mut way, observer);
        }
        let before = way.share;
        self.travel(rows, at, lanes, &rows.distance, &mut way);
        if O::DETAILS {
            for lane in lanes.without(before.is_black()).lanes() {
                let medium = self.media.current(way.media[lane]);
                let absorption = self.absorption(rows, at + lane, medium, rows.distance[at + lane] - way.from[lane]);
                let (surface, transmittance, reflectance) = (None, Rgb::WHITE, 0.0);
                observer.shadow_step(&ShadowStep { surface, medium, absorption, transmittance, reflectance });
            }
        }
        way.share
    }

    /// What a body leaves of a shadow ray's light over a distance.
    fn absorption(&self, rows: &QuestionRows, place: usize, medium: Option<Inside>, distance: f64) -> Rgb {
        let body = medium.and_then(|inside| self.scene.materials[inside.material as usize].body.as_ref());
        match body.filter(|body| !body.medium.is_clear()) {
            Some(body) => beer_lambert(extinction(&body.medium, rows.notes[place].extinction_scale), distance),
            None => Rgb::WHITE,
        }
    }

    /// Tells a watcher which surface it is that blocks all of a light: the nearest one that nothing goes through.
    #[inline(never)]
    fn tell_blocker<O: Observer>(&mut self, rows: &QuestionRows, place: usize, observer: &mut O) {
        let (mut ray, mut left) = (rows.ray(place), rows.distance[place]);
        for _ in 0..MOST_BEFORE_BLOCKER {
            let Some(hit) = self.scene.geometry.intersect(&ray, left, self.query) else { return };
            let surface = self.scene.interaction(&ray, &hit);
            let is_passed =
                self.shadows == Shadows::Filtered && self.scene.materials[surface.material as usize].body.is_some();
            if !is_passed {
                observer.shadow_step(&ShadowStep {
                    surface: Some(surface),
                    medium: self.media.current(rows.media[place]),
                    absorption: Rgb::WHITE,
                    transmittance: Rgb::BLACK,
                    reflectance: 0.0,
                });
                return;
            }
            ray = surface.spawn_ray(ray.direction);
            left -= hit.t;
        }
    }

    /// Each of some rays goes on to a surface, and through it.
    #[expect(clippy::too_many_arguments, reason = "a private step of the function above")]
    #[inline(always)]
    fn go_through<L: Lanes, O: Observer>(
        &mut self,
        rows: &QuestionRows,
        at: usize,
        lanes: Bits,
        met: &HitRows,
        surfaces: &SurfaceRows,
        way: &mut Way<L>,
        observer: &mut O,
    ) {
        let scene = self.scene;
        let before = (way.media, way.from);
        self.travel(rows, at, lanes, &met.t, way);
        let surface = LaneSurface::<L>::load(surfaces, at);
        let direction = LaneVector::load(&rows.direction, at);
        let leaving = surface.is_outward(direction);
        let at_origin = Geometry::are_at_origin(LaneVector::load(&rows.origin, at), L::load(&met.t, at));
        let (mut transmit, mut rarer, mut denser) = ([[1.0; WIDTH]; 3], [1.0; WIDTH], [1.0; WIDTH]);
        for lane in lanes.lanes() {
            way.from[lane] = met.t[at + lane];
            let number = surfaces.material[at + lane];
            let material = &scene.materials[number as usize];
            let interface = match material.constant_bsdf() {
                Some(bsdf) => bsdf.interface,
                None => {
                    let interaction = scene.geometry.interaction_of(met, surfaces, at + lane);
                    material.bsdf(&scene.textures, &interaction, &Surroundings::NONE.footprint).interface
                }
            };
            let (Some(body), Some(interface)) = (&material.body, interface) else {
                set_column(&mut transmit, lane, [0.0; 3]);
                continue;
            };
            let inside = Inside { solid: surfaces.solid[at + lane], material: number, priority: body.priority };
            let crossing = self.media.cross(way.media[lane], inside, leaving.has(lane), at_origin.has(lane));
            way.media[lane] = crossing.after;
            if crossing.is_without_effect() {
                continue;
            }
            set_column(&mut transmit, lane, interface.transmit.to_array());
            if interface.fresnel {
                let (before, beyond) = (scene.index_d(crossing.before), scene.index_d(crossing.beyond));
                (rarer[lane], denser[lane]) = (before.min(beyond), before.max(beyond));
            }
        }
        // Where both indices are the same, nothing is reflected.
        let cosine = surface.shading_normal.dot(direction).abs();
        let reflectance = fresnel_dielectric_lanes(cosine, L::load(&rarer, 0), L::load(&denser, 0));
        let through = way.share * LaneColor::load(&transmit, 0) * (L::splat(1.0) - reflectance).to_floats();
        way.share = through.or_where_not(lanes, way.share);
        if O::WATCHES {
            for lane in lanes.without(through.is_black()).lanes() {
                let notes = &rows.notes[at + lane];
                observer.filtered(notes.task, notes.terms[0]);
            }
        }
        if O::DETAILS {
            let mut reflectances = [0.0; WIDTH];
            reflectance.store(&mut reflectances, 0);
            for lane in lanes.lanes() {
                let (media, from) = (before.0[lane], before.1[lane]);
                let medium = self.media.current(media);
                let absorption = self.absorption(rows, at + lane, medium, met.t[at + lane] - from);
                let reflectance = reflectances[lane];
                let transmittance = Rgb::from(column(&transmit, lane)) * (1.0 - reflectance) as f32;
                let surface = Some(scene.geometry.interaction_of(met, surfaces, at + lane));
                observer.shadow_step(&ShadowStep { surface, medium, absorption, transmittance, reflectance });
            }
        }
    }

    /// Each of some rays travels up to a distance in what it is in.
    #[inline(always)]
    fn travel<L: Lanes>(&self, rows: &QuestionRows, at: usize, lanes: Bits, to: &[f64; WIDTH], way: &mut Way<L>) {
        let mut stretches = Stretches::NONE;
        for lane in lanes.lanes() {
            if let Some(inside) = self.media.current(way.media[lane])
                && let Some(body) = &self.scene.materials[inside.material as usize].body
                && !body.medium.is_clear()
            {
                let coefficient = extinction(&body.medium, rows.notes[at + lane].extinction_scale);
                stretches.put(lane, coefficient, to[at + lane] - way.from[lane]);
            }
        }
        if stretches.any() {
            let mut light = [[0.0; WIDTH]; 3];
            way.share.store(&mut light, 0);
            stretches.absorb::<L>(&mut light, 0);
            way.share = LaneColor::load(&light, 0);
        }
    }
}

/// How much of light is lost per length inside a body.
fn extinction(medium: &Medium, scattering_scale: f32) -> Rgb {
    let scale = if medium.scattering.is_black() { 1.0 } else { scattering_scale };
    (medium.absorption + medium.scattering) * scale
}

//! The loop over generations of rays, and what travels through it.
//!
//! A tile's camera rays are the first generation. Each generation is intersected as a whole, then each ray is shaded: its
//! local terms are added to its sample, the lights it asks for become questions, the rays it spawns become the next
//! generation. Then the questions are answered as a whole. It ends when no ray was spawned. This is Whitted's recursion
//! ("An Improved Illumination Model for Shaded Display", CACM 23(6), 1980) as a work list: nothing overflows a stack, what
//! is not followed is known, and both queues can be answered in whichever way is fastest.
//!
//! Queues are answered and shaded eight rays at a time, see [`snell_math::lanes`]; each ray for itself, and by the same code, where
//! somebody watches.
//!
//! The order of additions to a sample depends only on the sample: its rays keep their order from queue to queue, whatever other
//! samples share the tile, and rays side by side belong to different samples. So a picture's bits do not depend on tiles, threads
//! or instructions.

mod shadow;
#[cfg(test)]
mod tests;

use snell_math::lanes::{Bits, InstructionSet, Lanes, WIDTH, Work, dispatch};
use snell_math::{Point3, Ray, Rgb};

use crate::compile::CompiledScene;
use crate::differential::RayDifferential;
use crate::geometry::{Hit, HitRows, QueryScratch};
use crate::integrator::{Integrator, QUEUES, Rules, Sink};
use crate::interaction::SurfaceRows;
use crate::observe::Observer;
use crate::statistics::Statistics;
use crate::task::{
    Differentials, MediumStack, MediumStacks, QuestionQueue, RayKind, RayNotes, RayQueue, RayRows, SampleSums, column,
    set_column,
};

/// The queues and buffers of one worker, reused from tile to tile so that rays cost no allocation.
#[derive(Debug, Default)]
pub struct Scratch {
    current: [RayQueue; QUEUES],
    next: [RayQueue; QUEUES],
    /// For each row of rays of the generation, what they meet.
    hits: Vec<HitRows>,
    surfaces: SurfaceRows,
    questions: QuestionQueue,
    sums: SampleSums,
    /// What the sums came to.
    colors: Vec<Rgb>,
    spawned: Vec<u32>,
    media: MediumStacks,
    shadow: shadow::ShadowScratch,
    query: QueryScratch,
    differentials: Differentials,
}

/// A scene, an algorithm and its rules: what camera rays are given to.
#[derive(Clone, Copy, Debug)]
pub struct Tracer<'a, I> {
    /// The scene.
    pub scene: &'a CompiledScene,
    /// What happens where a ray meets a surface.
    pub integrator: &'a I,
    /// The rules.
    pub rules: Rules,
    /// By which instructions; what comes of it does not depend on them.
    pub instructions: InstructionSet,
}

impl<I: Integrator<State = ()>> Tracer<'_, I> {
    /// As [`Tracer::trace_with`], for an integrator that remembers nothing.
    pub fn trace<'s, O: Observer>(
        &self,
        camera_rays: &(impl CameraRays + ?Sized),
        scratch: &'s mut Scratch,
        statistics: &mut Statistics,
        observer: &mut O,
        first_hits: Option<&mut FirstHitWatch<'_>>,
    ) -> &'s [Rgb] {
        self.trace_with(camera_rays, &mut (), scratch, statistics, observer, first_hits)
    }
}

impl<I: Integrator> Tracer<'_, I> {
    /// Traces camera rays, one a sample, each with the number of its place to split white light, and all that follows from
    /// them; gives the samples' colours in the same order.
    ///
    /// `first_hits` is shown what each camera ray met, and may take it away: what lies beyond the far plane, say. `None` where
    /// there is nothing to be shown. `state` is what the integrator remembers of these samples.
    pub fn trace_with<'s, O: Observer>(
        &self,
        camera_rays: &(impl CameraRays + ?Sized),
        state: &mut I::State,
        scratch: &'s mut Scratch,
        statistics: &mut Statistics,
        observer: &mut O,
        first_hits: Option<&mut FirstHitWatch<'_>>,
    ) -> &'s [Rgb] {
        let count = camera_rays.count();
        scratch.current[0].fill(count);
        scratch.media.clear();
        scratch.sums.reset(count);
        statistics.camera_rays += count as u64;
        statistics.max_depth = statistics.max_depth.max(u32::from(count > 0));
        let next_id = count as u32;
        let generations = Generations { tracer: self, state, scratch: &mut *scratch, statistics, observer, next_id };
        let whole = Whole { camera_rays, generations, first_hits };
        if O::DETAILS {
            // Who wants to know all is told of one ray after the other.
            whole.run::<f64>();
        } else {
            dispatch(self.instructions, whole);
        }
        let Scratch { sums, colors, .. } = scratch;
        colors.clear();
        colors.extend(sums.iter());
        colors
    }
}

/// What is left to do once the camera rays are in the first queue: generation after generation.
struct Generations<'t, 'a, I: Integrator, O> {
    tracer: &'t Tracer<'a, I>,
    state: &'t mut I::State,
    scratch: &'t mut Scratch,
    statistics: &'t mut Statistics,
    observer: &'t mut O,
    next_id: u32,
}

/// All there is to do: camera rays, then generation after generation.
struct Whole<'c, 't, 'a, 'f, 'w, C: ?Sized, I: Integrator, O> {
    camera_rays: &'c C,
    generations: Generations<'t, 'a, I, O>,
    first_hits: Option<&'f mut FirstHitWatch<'w>>,
}

impl<C: CameraRays + ?Sized, I: Integrator, O: Observer> Work for Whole<'_, '_, '_, '_, '_, C, I, O> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { camera_rays, mut generations, mut first_hits } = self;
        L::stage(Begin(camera_rays, &mut generations));
        while generations.scratch.current.iter().any(|queue| !queue.is_empty()) {
            L::stage(Intersect(&mut generations));
            if let Some(first_hits) = first_hits.take() {
                generations.show_first_hits(first_hits);
            }
            L::stage(Shade(&mut generations));
            L::stage(Answer(&mut generations));
            let Scratch { current, next, differentials, .. } = &mut *generations.scratch;
            std::mem::swap(current, next);
            differentials.advance(generations.next_id);
        }
    }
}

impl<I: Integrator, O: Observer> Generations<'_, '_, I, O> {
    /// Makes the camera rays, the first generation, which carry all light.
    #[inline(always)]
    fn begin<L: Lanes>(&mut self, camera_rays: &(impl CameraRays + ?Sized)) {
        let Scratch { current, media, query, differentials, .. } = &mut *self.scratch;
        let scene = self.tracer.scene;
        let numbers = scene.sees_pictures().then(|| 0..camera_rays.count());
        differentials.begin(numbers.map(|numbers| numbers.map(|number| camera_rays.differential(number))));
        let mut before: Option<(Point3, MediumStack)> = None;
        let mut first = 0;
        for rows in current[0].rows_mut() {
            rows.throughput = [[1.0; WIDTH]; 3];
            let mut split = [0; WIDTH];
            for at in (0..WIDTH).step_by(L::COUNT) {
                camera_rays.generate::<L>(first + at, rows, &mut split, at);
            }
            for lane in 0..WIDTH {
                let number = (first + lane) as u32;
                rows.sample[lane] = number;
                let (band, kind, split) = (None, RayKind::Camera, split[lane]);
                rows.notes[lane] = RayNotes { id: number, parent: number, split, depth: 1, passes: 0, band, kind };
                // The rays of a perspective camera share their origin.
                let origin = Point3::from(column(&rows.origin, lane));
                rows.media[lane] = match before {
                    Some((same, media)) if same == origin => media,
                    _ => scene.media_around(origin, media, query),
                };
                before = Some((origin, rows.media[lane]));
            }
            first += WIDTH;
        }
        if O::WATCHES {
            for (rows, active) in current[0].rows() {
                active.lanes().for_each(|lane| self.observer.ray(&rows.task(lane)));
            }
        }
    }

    /// Finds what every ray of the generation meets.
    #[inline(always)]
    fn intersect<L: Lanes>(&mut self) {
        let geometry = &self.tracer.scene.geometry;
        let Scratch { current, hits, query, .. } = &mut *self.scratch;
        let mut number = 0;
        for queue in current {
            for (rays, active) in queue.rows() {
                if number == hits.len() {
                    hits.push(HitRows::NOTHING);
                }
                for (at, lanes) in parts::<L>(active) {
                    geometry.intersect_lanes::<L>(rays, at, lanes, &mut hits[number], query);
                }
                number += 1;
            }
        }
    }

    /// Shows the hits of camera rays, which are in the first queue alone.
    fn show_first_hits(&mut self, first_hits: &mut FirstHitWatch<'_>) {
        let Scratch { current, hits, .. } = &mut *self.scratch;
        for ((rays, active), hits) in current[0].rows().zip(hits) {
            for lane in active.lanes() {
                let mut hit = if hits.met().has(lane) { hits.hit(lane) } else { None };
                first_hits(rays.sample[lane] as usize, &rays.ray(lane), &mut hit);
                hits.set(lane, hit);
            }
        }
    }

    /// Shades: local terms, questions to lights, rays of the next generation.
    #[inline(always)]
    fn shade<L: Lanes>(&mut self) {
        let Tracer { scene, integrator, rules, .. } = *self.tracer;
        let Scratch { current, next, hits, surfaces, questions, sums, spawned, media, differentials, .. } =
            &mut *self.scratch;
        next.iter_mut().for_each(RayQueue::clear);
        questions.clear();
        spawned.clear();
        spawned.resize(sums.count(), 0);
        let (statistics, observer, state) = (&mut *self.statistics, &mut *self.observer, &mut *self.state);
        let next_id = &mut self.next_id;
        let mut sink =
            Sink { sums, questions, next, spawned, media, statistics, observer, rules, next_id, differentials };
        let mut hits = hits.iter();
        for (number, queue) in current.iter().enumerate() {
            for ((rays, active), hits) in queue.rows().zip(&mut hits) {
                for (at, lanes) in parts::<L>(active) {
                    let mut rest = lanes;
                    while rest.any() {
                        // In the last queue several may belong to one sample.
                        let together = if number + 1 < QUEUES { rest } else { Bits::lane(rest.lowest()) };
                        integrator.shade::<L, O>(scene, state, rays, at, together, hits, surfaces, &mut sink);
                        rest = rest.without(together);
                    }
                }
            }
        }
    }

    /// Answers the questions and adds what arrives.
    #[inline(always)]
    fn answer<L: Lanes>(&mut self) {
        let Tracer { scene, rules, .. } = *self.tracer;
        let Scratch { questions, sums, media, shadow, query, .. } = &mut *self.scratch;
        for (rows, active) in questions.rows() {
            for (at, lanes) in parts::<L>(active) {
                let context = shadow::Context { scene, shadows: rules.shadows, media, query };
                shadow::answer::<L, O>(context, rows, at, lanes, shadow, sums, self.statistics, self.observer);
            }
        }
    }
}

/// Is shown the number of each camera ray, the ray and what it met, and may take that away.
pub type FirstHitWatch<'f> = dyn FnMut(usize, &Ray, &mut Option<Hit>) + 'f;

/// Rays from the camera, one a sample.
pub trait CameraRays {
    /// How many.
    fn count(&self) -> usize;
    /// Writes rays from number `first` on to rows from place `at` on, with the numbers of their places to split white light; what
    /// it writes for numbers beyond the count is not looked at, but finite.
    fn generate<L: Lanes>(&self, first: usize, rows: &mut RayRows, split: &mut [u32; WIDTH], at: usize);
    /// How the neighbours of a ray differ from it. Asked only where pictures are seen.
    fn differential(&self, number: usize) -> RayDifferential {
        let _ = number;
        RayDifferential::NONE
    }
}

impl CameraRays for [(Ray, u32)] {
    fn count(&self) -> usize {
        self.len()
    }

    #[inline(always)]
    fn generate<L: Lanes>(&self, first: usize, rows: &mut RayRows, split: &mut [u32; WIDTH], at: usize) {
        for lane in 0..L::COUNT {
            if let Some((ray, number)) = self.get(first + lane).or(self.last()) {
                set_column(&mut rows.origin, at + lane, ray.origin.to_array());
                set_column(&mut rows.direction, at + lane, ray.direction.to_array());
                split[at + lane] = *number;
            }
        }
    }
}

/// The steps of a generation, and the one before all, each compiled as a whole for the instructions at hand.
struct Begin<'c, 'g, C: ?Sized, G>(&'c C, &'g mut G);
struct Intersect<'g, G>(&'g mut G);
struct Shade<'g, G>(&'g mut G);
struct Answer<'g, G>(&'g mut G);

impl<C: CameraRays + ?Sized, I: Integrator, O: Observer> Work for Begin<'_, '_, C, Generations<'_, '_, I, O>> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        self.1.begin::<L>(self.0);
    }
}

impl<I: Integrator, O: Observer> Work for Intersect<'_, Generations<'_, '_, I, O>> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        self.0.intersect::<L>();
    }
}

impl<I: Integrator, O: Observer> Work for Shade<'_, Generations<'_, '_, I, O>> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        self.0.shade::<L>();
    }
}

impl<I: Integrator, O: Observer> Work for Answer<'_, Generations<'_, '_, I, O>> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        self.0.answer::<L>();
    }
}

/// The places of rows from which on lanes are taken, with those that are active, counted from there.
#[inline(always)]
fn parts<L: Lanes>(active: Bits) -> impl Iterator<Item = (usize, Bits)> {
    (0..WIDTH).step_by(L::COUNT).map(move |at| (at, Bits(active.0 >> at) & L::all())).filter(|(_, lanes)| lanes.any())
}

//! The loop over generations of rays, and what travels through it.
//!
//! A tile's camera rays are the first generation. Each generation is intersected as a whole, then each ray is shaded: its
//! local terms are added to its sample, the lights it asks for become questions, the rays it spawns become the next
//! generation. Then the questions are answered as a whole. It ends when no ray was spawned. This is Whitted's recursion
//! ("An Improved Illumination Model for Shaded Display", CACM 23(6), 1980) as a work list: nothing overflows a stack, what
//! is not followed is known, and both queues can be answered in whichever way is fastest.
//!
//! The order of additions to a sample depends only on the sample: its rays keep their order in every queue, whatever other
//! samples share the tile. So a picture's bits do not depend on tiles or threads.

mod media;
mod shadow;
mod statistics;
mod task;

use snell_math::{Ray, Rgb};
use snell_scene::scene::Shadows;

pub use media::{Crossing, Inside, MediumStack, MediumStacks};
pub use statistics::Statistics;
pub use task::{Band, RayKind, RayTask, ShadowQuestion};

use crate::compile::CompiledScene;
use crate::geometry::{Hit, QueryScratch};
use crate::integrator::Integrator;
use crate::observe::{Cut, Observer, Term};

/// The rules of the recursion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// The depth of the deepest ray; camera rays have depth 1.
    pub depth: u16,
    /// Rays whose throughput is below this in every component are not followed.
    pub min_weight: f32,
    /// What blocks light.
    pub shadows: Shadows,
}

/// How many boundaries without effect a ray may go through before it counts as lost: a guard against scenes that are
/// infinitely thin, not a limit that a real one meets.
pub const MAX_PASSES: u16 = 4096;

/// The queues and buffers of one worker, reused from tile to tile so that rays cost no allocation.
#[derive(Debug, Default)]
pub struct Scratch {
    current: Vec<RayTask>,
    next: Vec<RayTask>,
    hits: Vec<Option<Hit>>,
    questions: Vec<ShadowQuestion>,
    sums: Vec<Rgb>,
    media: MediumStacks,
    shadow: shadow::ShadowScratch,
    query: QueryScratch,
}

/// What `shade` gives its results to: terms to the sample, questions to the lights, rays to the next generation.
#[derive(Debug)]
pub struct Sink<'a, O> {
    sums: &'a mut [Rgb],
    questions: &'a mut Vec<ShadowQuestion>,
    next: &'a mut Vec<RayTask>,
    /// The stacks of transparent bodies that tasks refer to.
    pub media: &'a mut MediumStacks,
    /// What is counted.
    pub statistics: &'a mut Statistics,
    observer: &'a mut O,
    rules: Rules,
    next_id: &'a mut u32,
}

/// A ray to be spawned by a surface; see [`Sink::spawn`].
#[derive(Clone, Copy, Debug)]
pub struct Spawn {
    /// Reflected or refracted.
    pub kind: RayKind,
    /// The ray.
    pub ray: Ray,
    /// The share of the parent's throughput that it carries.
    pub weight: Rgb,
    /// The bodies it travels in.
    pub media: MediumStack,
    /// The band it carries.
    pub band: Option<Band>,
}

impl<O: Observer> Sink<'_, O> {
    /// Adds a term to the ray's sample: `radiance` as seen along the ray, scaled here by its throughput.
    #[inline]
    pub fn add(&mut self, task: &RayTask, term: Term, radiance: Rgb) {
        let share = task.throughput * radiance;
        self.sums[task.sample as usize] += share;
        self.observer.term(task.id, term, share);
    }

    /// Tells the observer what the ray met.
    #[inline]
    pub fn met(&mut self, task: &RayTask, interaction: Option<&crate::interaction::SurfaceInteraction>) {
        self.observer.hit(task, interaction);
    }

    /// Asks how much of a light arrives; the answer is added to the sample after the generation.
    #[inline]
    pub fn ask(&mut self, question: ShadowQuestion) {
        self.questions.push(question);
    }

    /// Counts a total internal reflection.
    #[inline]
    pub fn total_internal_reflection(&mut self, task: &RayTask) {
        self.statistics.total_internal_reflections += 1;
        self.observer.total_internal_reflection(task.id);
    }

    /// Adds a ray to the next generation, one deeper than its parent, unless the limits cut it.
    #[inline]
    pub fn spawn(&mut self, parent: &RayTask, spawn: Spawn) {
        let throughput = parent.throughput * spawn.weight;
        // A share that is nothing at all is no ray: an interface with a black coefficient spawns none.
        if throughput.is_black() {
            return;
        }
        let cut = if parent.depth >= self.rules.depth {
            Some(Cut::Depth)
        } else if throughput.max_abs() < self.rules.min_weight {
            Some(Cut::Weight)
        } else {
            None
        };
        if let Some(cut) = cut {
            self.cut(parent, cut, throughput);
            return;
        }
        match spawn.kind {
            RayKind::Reflected => self.statistics.reflected_rays += 1,
            RayKind::Refracted => self.statistics.refracted_rays += 1,
            RayKind::Camera => self.statistics.camera_rays += 1,
        }
        self.statistics.max_depth = self.statistics.max_depth.max(u32::from(parent.depth) + 1);
        let Spawn { kind, ray, media, band, .. } = spawn;
        let depth = parent.depth + 1;
        self.push(RayTask { ray, throughput, media, depth, passes: 0, kind, band, ..*parent }, parent.id);
    }

    /// Lets a ray go on behind a boundary without effect, as the ray it was.
    #[inline]
    pub fn pass(&mut self, task: &RayTask, ray: Ray, media: MediumStack) {
        if task.passes >= MAX_PASSES {
            self.cut(task, Cut::Depth, task.throughput);
            return;
        }
        self.push(RayTask { ray, media, passes: task.passes + 1, ..*task }, task.id);
    }

    fn push(&mut self, mut task: RayTask, parent: u32) {
        task.id = *self.next_id;
        task.parent = parent;
        *self.next_id = self.next_id.wrapping_add(1);
        self.observer.ray(&task);
        self.next.push(task);
    }

    fn cut(&mut self, parent: &RayTask, why: Cut, weight: Rgb) {
        self.statistics.add_cut_weight(weight);
        self.observer.cut(parent.id, why, weight);
    }
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
}

impl<I: Integrator> Tracer<'_, I> {
    /// Traces camera rays, one a sample, and all that follows from them; gives the samples' colours in the same order.
    ///
    /// `first_hits` is shown what each camera ray met, and may take it away: what lies beyond the far plane, say.
    pub fn trace<'s, O: Observer>(
        &self,
        camera_rays: impl IntoIterator<Item = Ray>,
        scratch: &'s mut Scratch,
        statistics: &mut Statistics,
        observer: &mut O,
        mut first_hits: impl FnMut(usize, &Ray, &mut Option<Hit>),
    ) -> &'s [Rgb] {
        let scene = self.scene;
        let Scratch { current, next, hits, questions, sums, media, shadow, query } = scratch;
        let mut next_id = 0;
        current.clear();
        media.clear();
        for ray in camera_rays {
            let task = camera_task(scene, ray, next_id, current.last(), media, query);
            next_id += 1;
            observer.ray(&task);
            current.push(task);
        }
        sums.clear();
        sums.resize(current.len(), Rgb::BLACK);
        statistics.camera_rays += current.len() as u64;
        statistics.max_depth = statistics.max_depth.max(u32::from(!current.is_empty()));

        let mut is_first = true;
        while !current.is_empty() {
            // Find what every ray of the generation meets.
            scene.geometry.intersect_queue(current, hits, query);
            if std::mem::take(&mut is_first) {
                for (sample, (task, hit)) in current.iter().zip(hits.iter_mut()).enumerate() {
                    first_hits(sample, &task.ray, hit);
                }
            }

            // Shade: local terms, questions to lights, rays of the next generation.
            next.clear();
            questions.clear();
            let rules = self.rules;
            let mut sink = Sink { sums, questions, next, media, statistics, observer, rules, next_id: &mut next_id };
            for (task, hit) in current.iter().zip(hits.iter()) {
                self.integrator.shade(scene, task, hit.as_ref(), &mut sink);
            }

            // Answer the questions and add what arrives.
            for question in questions.iter() {
                let transmittance =
                    shadow::transmittance(scene, rules.shadows, question, media, shadow, query, statistics);
                observer.shadow(question, transmittance);
                if transmittance.is_black() {
                    continue;
                }
                for (term, unblocked) in question.terms {
                    if !unblocked.is_black() {
                        let share = unblocked * transmittance;
                        sums[question.sample as usize] += share;
                        observer.term(question.task, term, share);
                    }
                }
            }
            std::mem::swap(current, next);
        }
        sums
    }
}

/// A ray from the camera, with all light and in the bodies that its origin is in.
fn camera_task(
    scene: &CompiledScene,
    ray: Ray,
    number: u32,
    before: Option<&RayTask>,
    media: &mut MediumStacks,
    query: &mut QueryScratch,
) -> RayTask {
    let media = match before {
        // The rays of a perspective camera share their origin.
        Some(before) if before.ray.origin == ray.origin => before.media,
        _ => scene.media_around(ray.origin, media, query),
    };
    RayTask {
        ray,
        throughput: Rgb::WHITE,
        sample: number,
        id: number,
        parent: number,
        media,
        depth: 1,
        passes: 0,
        kind: RayKind::Camera,
        band: None,
    }
}

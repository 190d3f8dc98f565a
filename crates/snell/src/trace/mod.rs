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

mod shadow;
#[cfg(test)]
mod tests;

use snell_math::{Point3, Ray, Rgb};

use crate::compile::CompiledScene;
use crate::geometry::{Hit, QueryScratch};
use crate::integrator::{Integrator, Rules, Sink};
use crate::observe::Observer;
use crate::statistics::Statistics;
use crate::task::{MediumStack, MediumStacks, RayKind, RayTask, ShadowQuestion};

/// The queues and buffers of one worker, reused from tile to tile so that rays cost no allocation.
#[derive(Debug, Default)]
pub struct Scratch {
    current: Vec<RayTask>,
    next: Vec<RayTask>,
    hits: Vec<Option<Hit>>,
    questions: Vec<ShadowQuestion>,
    sums: Vec<Rgb>,
    spawned: Vec<u32>,
    media: MediumStacks,
    shadow: shadow::ShadowScratch,
    query: QueryScratch,
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
    /// Traces camera rays, one a sample, each with the number of its place to split white light, and all that follows from
    /// them; gives the samples' colours in the same order.
    ///
    /// `first_hits` is shown what each camera ray met, and may take it away: what lies beyond the far plane, say.
    pub fn trace<'s, O: Observer>(
        &self,
        camera_rays: impl IntoIterator<Item = (Ray, u32)>,
        scratch: &'s mut Scratch,
        statistics: &mut Statistics,
        observer: &mut O,
        mut first_hits: impl FnMut(usize, &Ray, &mut Option<Hit>),
    ) -> &'s [Rgb] {
        let scene = self.scene;
        let Scratch { current, next, hits, questions, sums, spawned, media, shadow, query } = scratch;
        let mut next_id = 0;
        current.clear();
        media.clear();
        for (ray, split) in camera_rays {
            let media = media_at(scene, ray.origin, current.last(), media, query);
            let task = camera_task(ray, next_id, split, media);
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
            spawned.clear();
            spawned.resize(sums.len(), 0);
            let rules = self.rules;
            let mut sink =
                Sink { sums, questions, next, spawned, media, statistics, observer, rules, next_id: &mut next_id };
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

/// The bodies that a camera ray begins in.
fn media_at(
    scene: &CompiledScene,
    origin: Point3,
    before: Option<&RayTask>,
    media: &mut MediumStacks,
    query: &mut QueryScratch,
) -> MediumStack {
    match before {
        // The rays of a perspective camera share their origin.
        Some(before) if before.ray.origin == origin => before.media,
        _ => scene.media_around(origin, media, query),
    }
}

/// A ray from the camera, with all light.
fn camera_task(ray: Ray, number: u32, split: u32, media: MediumStack) -> RayTask {
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
        split,
    }
}

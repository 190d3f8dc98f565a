//! Watching rays: the same code that renders a pixel tells what it did.
//!
//! The tracing loop reports every ray, hit, term and answer to an [`Observer`]. [`NoObserver`] compiles away; a
//! [`RayTree`] remembers all, and its shares add up to the pixel, since each is recorded where it is added.

use snell_math::Rgb;

use crate::interaction::SurfaceInteraction;
use crate::task::{Cut, RayTask, ShadowQuestion, Term};

/// Sees everything the tracing loop does, in order. All methods do nothing by default.
pub trait Observer {
    /// False where nothing is seen, so that what would only be seen need not be computed.
    const WATCHES: bool = true;

    /// A ray was spawned; its parent is known already.
    fn ray(&mut self, task: &RayTask) {
        let _ = task;
    }
    /// A ray met a surface, or nothing.
    fn hit(&mut self, task: &RayTask, interaction: Option<&SurfaceInteraction>) {
        let _ = (task, interaction);
    }
    /// A term was added to a sample: the share has the ray's throughput in it.
    fn term(&mut self, task: u32, term: Term, share: Rgb) {
        let _ = (task, term, share);
    }
    /// A shadow question was answered: the share of the light that arrives.
    fn shadow(&mut self, question: &ShadowQuestion, transmittance: Rgb) {
        let _ = (question, transmittance);
    }
    /// A ray was not followed, and this weight is lost to the sample.
    fn cut(&mut self, parent: u32, why: Cut, weight: Rgb) {
        let _ = (parent, why, weight);
    }
    /// Light met total internal reflection.
    fn total_internal_reflection(&mut self, task: u32) {
        let _ = task;
    }
}

/// Sees nothing and costs nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoObserver;

impl Observer for NoObserver {
    const WATCHES: bool = false;
}

/// Remembers everything that happened to the rays of one sample.
#[derive(Clone, Debug, Default)]
pub struct RayTree {
    /// The rays in the order in which they were spawned: generation by generation, the camera's first.
    pub rays: Vec<TracedRay>,
    /// The shares of the sample in the order in which they were added to it.
    pub shares: Vec<Share>,
}

/// One term's part of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// The id of the ray's task.
    pub task: u32,
    /// Where it comes from.
    pub term: Term,
    /// The value, the ray's throughput in it.
    pub value: Rgb,
}

/// One ray of a [`RayTree`].
#[derive(Clone, Debug)]
pub struct TracedRay {
    /// The ray as it was spawned.
    pub task: RayTask,
    /// What it met: `None` while unknown, `Some(None)` where it left the scene.
    pub hit: Option<Option<SurfaceInteraction>>,
    /// The lights that were asked for: which, whether the highlight would matter, and the share that arrived.
    pub shadows: Vec<AnsweredShadow>,
    /// Rays that were not followed.
    pub cuts: Vec<(Cut, Rgb)>,
    /// It met total internal reflection.
    pub total_internal_reflection: bool,
}

/// A shadow question with its answer.
#[derive(Clone, Copy, Debug)]
pub struct AnsweredShadow {
    /// The question.
    pub question: ShadowQuestion,
    /// The share of the light that arrives, by colour.
    pub transmittance: Rgb,
}

impl RayTree {
    /// The sum of all shares: the sample's colour, to the last bit, since it is summed in the order in which they were added.
    pub fn sum(&self) -> Rgb {
        self.shares.iter().fold(Rgb::BLACK, |sum, share| sum + share.value)
    }

    /// The shares that one ray added.
    pub fn shares_of(&self, task: u32) -> impl Iterator<Item = &Share> {
        self.shares.iter().filter(move |share| share.task == task)
    }

    fn entry(&mut self, id: u32) -> Option<&mut TracedRay> {
        self.rays.iter_mut().rev().find(|ray| ray.task.id == id)
    }
}

impl Observer for RayTree {
    fn ray(&mut self, task: &RayTask) {
        self.rays.push(TracedRay {
            task: *task,
            hit: None,
            shadows: Vec::new(),
            cuts: Vec::new(),
            total_internal_reflection: false,
        });
    }
    fn hit(&mut self, task: &RayTask, interaction: Option<&SurfaceInteraction>) {
        if let Some(entry) = self.entry(task.id) {
            entry.hit = Some(interaction.copied());
        }
    }
    fn term(&mut self, task: u32, term: Term, share: Rgb) {
        self.shares.push(Share { task, term, value: share });
    }
    fn shadow(&mut self, question: &ShadowQuestion, transmittance: Rgb) {
        if let Some(entry) = self.entry(question.task) {
            entry.shadows.push(AnsweredShadow { question: *question, transmittance });
        }
    }
    fn cut(&mut self, parent: u32, why: Cut, weight: Rgb) {
        if let Some(entry) = self.entry(parent) {
            entry.cuts.push((why, weight));
        }
    }
    fn total_internal_reflection(&mut self, task: u32) {
        if let Some(entry) = self.entry(task) {
            entry.total_internal_reflection = true;
        }
    }
}

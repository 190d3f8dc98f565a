//! Where an integrator's `shade` puts its results, and the rules that decide which rays are followed.

use snell_math::{Ray, Rgb};
use snell_scene::scene::Shadows;

use crate::interaction::SurfaceInteraction;
use crate::observe::Observer;
use crate::statistics::Statistics;
use crate::task::{Band, Cut, MediumStack, MediumStacks, RayKind, RayTask, ShadowQuestion, Term};

/// The rules of the recursion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// The depth of the deepest ray; camera rays have depth 1.
    pub depth: u16,
    /// Rays whose throughput is below this in every component are not followed.
    pub min_weight: f32,
    /// Rays are spawned even where they carry nothing.
    pub weightless_rays: bool,
    /// What blocks light.
    pub shadows: Shadows,
}

/// How many boundaries without effect a ray may go through before it counts as lost: a guard against scenes that are
/// infinitely thin, not a limit that a real one meets.
const MAX_PASSES: u16 = 4096;

/// The most rays of one generation that belong to one sample. Shares that add up to more than one double them with every
/// generation; no scene that keeps light together comes near it.
const MAX_SPAWNED: u32 = 2048;

/// What `shade` gives its results to: terms to the sample, questions to the lights, rays to the next generation.
#[derive(Debug)]
pub struct Sink<'a, O> {
    pub(crate) sums: &'a mut [Rgb],
    pub(crate) questions: &'a mut Vec<ShadowQuestion>,
    pub(crate) next: &'a mut Vec<RayTask>,
    /// How many of those belong to each sample.
    pub(crate) spawned: &'a mut [u32],
    /// The stacks of transparent bodies that tasks refer to.
    pub media: &'a mut MediumStacks,
    /// What is counted.
    pub statistics: &'a mut Statistics,
    pub(crate) observer: &'a mut O,
    pub(crate) rules: Rules,
    pub(crate) next_id: &'a mut u32,
}

/// A ray to be spawned by a surface; see [`Sink::spawn`].
#[derive(Clone, Copy, Debug)]
pub struct Spawn {
    /// Reflected or refracted.
    pub kind: RayKind,
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
    pub fn met(&mut self, task: &RayTask, interaction: Option<&SurfaceInteraction>) {
        self.observer.hit(task, interaction);
    }

    /// Whether a question to a light that would add these terms is without consequence, and then counts it as asked. It is
    /// where neither term adds anything, most often on glass outside of its highlight, unless somebody watches.
    #[inline]
    pub fn needs_no_answer(&mut self, diffuse: Rgb, specular: Rgb) -> bool {
        let is_idle = !O::WATCHES && diffuse.is_black() && specular.is_black();
        if is_idle {
            self.statistics.shadow_rays += u64::from(self.rules.shadows != Shadows::None);
        }
        is_idle
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

    /// Adds a ray to the next generation, one deeper than its parent, unless the limits cut it. Where they do, the ray is
    /// not even asked for.
    #[inline]
    pub fn spawn(&mut self, parent: &RayTask, spawn: Spawn, ray: impl FnOnce() -> Ray) {
        let throughput = parent.throughput * spawn.weight;
        // A share that is nothing at all is no ray: an interface with a black coefficient spawns none, unless rays are counted.
        if throughput.is_black() && !self.rules.weightless_rays {
            return;
        }
        let cut = if parent.depth >= self.rules.depth {
            Some(Cut::Depth)
        } else if self.spawned[parent.sample as usize] >= MAX_SPAWNED {
            Some(Cut::Number)
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
        let Spawn { kind, media, band, .. } = spawn;
        let depth = parent.depth + 1;
        self.push(RayTask { ray: ray(), throughput, media, depth, passes: 0, kind, band, ..*parent }, parent.id);
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

    #[inline]
    fn push(&mut self, mut task: RayTask, parent: u32) {
        task.id = *self.next_id;
        task.parent = parent;
        *self.next_id = self.next_id.wrapping_add(1);
        self.spawned[task.sample as usize] += 1;
        self.observer.ray(&task);
        self.next.push(task);
    }

    fn cut(&mut self, parent: &RayTask, why: Cut, weight: Rgb) {
        self.statistics.add_cut_weight(weight);
        self.observer.cut(parent.id, why, weight);
    }
}

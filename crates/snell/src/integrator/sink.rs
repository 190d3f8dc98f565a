//! Where an integrator's `shade` puts its results, and the rules that decide which rays are followed.

use snell_math::lanes::{Bits, Floats, LaneColor, LaneVector, Lanes, WIDTH};
use snell_math::{Ray, Rgb};
use snell_scene::scene::Shadows;

use crate::interaction::SurfaceInteraction;
use crate::observe::Observer;
use crate::statistics::Statistics;
use crate::task::{
    Band, Cut, MediumStack, MediumStacks, QuestionNotes, QuestionQueue, RayKind, RayNotes, RayQueue, RayRows, RayTask,
    ShadowQuestion, Term, column, set_column,
};

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

/// How many queues the rays of a generation wait in: each sample's first ray in the first, its second in the second, and so on,
/// all further ones in the last. So rays side by side belong to different samples, and what they add to them does so in the order
/// in which it would be added one ray after the other.
pub(crate) const QUEUES: usize = 32;

/// The most rays of one generation that belong to one sample. Shares that add up to more than one double them with every
/// generation; no scene that keeps light together comes near it.
const MAX_SPAWNED: u32 = 2048;

/// Rays being shaded side by side: those of rows from a place on.
#[derive(Clone, Copy, Debug)]
pub struct ShadedRays<'a> {
    /// The rows.
    pub rows: &'a RayRows,
    /// The place of lane 0.
    pub at: usize,
    /// What the rays carry at the end of their way, where bodies have absorbed some: in place of the rows' own throughput.
    pub throughput: &'a [[f32; WIDTH]; 3],
}

impl ShadedRays<'_> {
    /// What they carry.
    #[inline(always)]
    pub fn throughput<L: Lanes>(&self) -> LaneColor<L::Floats> {
        LaneColor::load(self.throughput, self.at)
    }

    /// Where they go.
    #[inline(always)]
    pub fn direction<L: Lanes>(&self) -> LaneVector<L> {
        LaneVector::load(&self.rows.direction, self.at)
    }

    /// One of them as a task, with what it carries at the end of its way.
    #[inline]
    pub fn task(&self, lane: usize) -> RayTask {
        let throughput = Rgb::from(column(self.throughput, self.at + lane));
        RayTask { throughput, ..self.rows.task(self.at + lane) }
    }

    /// One of them alone.
    #[inline]
    #[must_use]
    pub fn only(&self, lane: usize) -> Self {
        Self { at: self.at + lane, ..*self }
    }
}

/// What `shade` gives its results to: terms to the sample, questions to the lights, rays to the next generation.
#[derive(Debug)]
pub struct Sink<'a, O> {
    pub(crate) sums: &'a mut [Rgb],
    pub(crate) questions: &'a mut QuestionQueue,
    pub(crate) next: &'a mut [RayQueue; QUEUES],
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

/// Rays to be spawned by surfaces; see [`Sink::spawn`].
#[derive(Clone, Copy, Debug)]
pub struct Spawn<'a, L: Lanes> {
    /// Reflected or refracted.
    pub kind: RayKind,
    /// Where they begin.
    pub origin: LaneVector<L>,
    /// Where they go, unit length.
    pub direction: LaneVector<L>,
    /// What they carry.
    pub throughput: LaneColor<L::Floats>,
    /// The bodies they travel in; their parents' where `None`. Lanes count from 0.
    pub media: Option<&'a [MediumStack; WIDTH]>,
    /// The band that they carry where their parents carry all light.
    pub band: Option<Band>,
}

/// A question to one light, side by side; see [`ShadowQuestion`].
#[derive(Clone, Copy, Debug)]
pub struct LaneQuestions<L: Lanes> {
    /// Where the shadow rays begin.
    pub origin: LaneVector<L>,
    /// Where they go, unit length.
    pub direction: LaneVector<L>,
    /// How far the light is.
    pub distance: L,
    /// What the diffuse lobe and the highlight would add.
    pub shares: [LaneColor<L::Floats>; 2],
    /// The number of the light.
    pub light: u32,
}

impl<O: Observer> Sink<'_, O> {
    /// Adds a term to the samples of some rays: `radiance` as seen along the rays, scaled here by their throughput.
    #[inline(always)]
    pub fn add<L: Lanes>(&mut self, rays: &ShadedRays<'_>, lanes: Bits, term: Term, radiance: LaneColor<L::Floats>) {
        let mut shares = [[0.0; WIDTH]; 3];
        (rays.throughput::<L>() * radiance).store(&mut shares, 0);
        for lane in lanes.lanes() {
            let share = Rgb::from(column(&shares, lane));
            self.sums[rays.rows.sample[rays.at + lane] as usize] += share;
            self.observer.term(rays.rows.notes[rays.at + lane].id, term, share);
        }
    }

    /// Tells the observer what a ray met.
    #[inline]
    pub fn met(&mut self, task: &RayTask, interaction: Option<&SurfaceInteraction>) {
        self.observer.hit(task, interaction);
    }

    /// True where somebody watches, and what only a watcher would see is to be worked out.
    #[inline(always)]
    pub fn is_watched(&self) -> bool {
        O::WATCHES
    }

    /// Asks how much of a light arrives; the answer is added to the sample after the generation.
    #[inline]
    pub fn ask(&mut self, question: ShadowQuestion) {
        self.questions.push(&question);
    }

    /// As [`Sink::ask`], for surfaces side by side. A question without consequence counts as asked: where neither term adds
    /// anything, most often on glass outside of its highlight, unless somebody watches.
    #[inline(always)]
    pub fn ask_light<L: Lanes>(&mut self, rays: &ShadedRays<'_>, lanes: Bits, questions: &LaneQuestions<L>) {
        let [diffuse, specular] = questions.shares;
        let idle = if O::WATCHES { Bits::NONE } else { lanes & diffuse.is_black() & specular.is_black() };
        if self.rules.shadows != Shadows::None {
            self.statistics.shadow_rays += u64::from(idle.count());
        }
        let asked = lanes.without(idle);
        if asked.is_empty() {
            return;
        }
        let (mut origin, mut direction, mut distance) = ([[0.0; WIDTH]; 3], [[0.0; WIDTH]; 3], [0.0; WIDTH]);
        let mut shares = [[[0.0; WIDTH]; 3]; 2];
        questions.origin.store(&mut origin, 0);
        questions.direction.store(&mut direction, 0);
        questions.distance.store(&mut distance, 0);
        diffuse.store(&mut shares[0], 0);
        specular.store(&mut shares[1], 0);
        for lane in asked.lanes() {
            let (rows, to) = self.questions.next_place();
            let from = rays.at + lane;
            set_column(&mut rows.origin, to, column(&origin, lane));
            set_column(&mut rows.direction, to, column(&direction, lane));
            rows.distance[to] = distance[lane];
            set_column(&mut rows.shares[0], to, column(&shares[0], lane));
            set_column(&mut rows.shares[1], to, column(&shares[1], lane));
            rows.sample[to] = rays.rows.sample[from];
            rows.media[to] = rays.rows.media[from];
            let terms = [Term::Diffuse(questions.light), Term::Specular(questions.light)];
            rows.notes[to] = QuestionNotes { terms, task: rays.rows.notes[from].id, extinction_scale: 1.0 };
        }
    }

    /// Counts total internal reflections.
    #[inline(always)]
    pub fn total_internal_reflection(&mut self, rays: &ShadedRays<'_>, lanes: Bits) {
        self.statistics.total_internal_reflections += u64::from(lanes.count());
        for lane in lanes.lanes() {
            self.observer.total_internal_reflection(rays.rows.notes[rays.at + lane].id);
        }
    }

    /// Which of some rays are followed that are to be spawned with shares of their parents' throughput, and what they carry; the
    /// limits cut the others.
    #[inline(always)]
    pub fn follow<L: Lanes>(
        &mut self,
        parents: &ShadedRays<'_>,
        lanes: Bits,
        weight: LaneColor<L::Floats>,
    ) -> (Bits, LaneColor<L::Floats>) {
        let throughput = parents.throughput::<L>() * weight;
        // A share that is nothing at all is no ray: an interface with a black coefficient spawns none, unless rays are counted.
        let wanted = if self.rules.weightless_rays { lanes } else { lanes.without(throughput.is_black()) };
        if wanted.is_empty() {
            return (wanted, throughput);
        }
        let light = throughput.max_abs().lt(L::Floats::splat(self.rules.min_weight));
        let mut weights = [[0.0; WIDTH]; 3];
        throughput.store(&mut weights, 0);
        let mut followed = Bits::NONE;
        for lane in wanted.lanes() {
            let (notes, sample) = (&parents.rows.notes[parents.at + lane], parents.rows.sample[parents.at + lane]);
            let cut = if notes.depth >= self.rules.depth {
                Cut::Depth
            } else if self.spawned[sample as usize] >= MAX_SPAWNED {
                Cut::Number
            } else if light.has(lane) {
                Cut::Weight
            } else {
                followed |= Bits::lane(lane);
                continue;
            };
            self.cut(notes.id, cut, Rgb::from(column(&weights, lane)));
        }
        (followed, throughput)
    }

    /// Adds rays that are followed to the next generation, one deeper than their parents; see [`Sink::follow`].
    #[inline(always)]
    pub fn spawn<L: Lanes>(&mut self, parents: &ShadedRays<'_>, followed: Bits, spawn: &Spawn<'_, L>) {
        let count = u64::from(followed.count());
        match spawn.kind {
            RayKind::Reflected => self.statistics.reflected_rays += count,
            RayKind::Refracted => self.statistics.refracted_rays += count,
            RayKind::Camera => self.statistics.camera_rays += count,
        }
        let (mut origins, mut directions) = ([[0.0; WIDTH]; 3], [[0.0; WIDTH]; 3]);
        let mut weights = [[0.0; WIDTH]; 3];
        spawn.origin.store(&mut origins, 0);
        spawn.direction.store(&mut directions, 0);
        spawn.throughput.store(&mut weights, 0);
        for lane in followed.lanes() {
            let from = parents.at + lane;
            let notes = &parents.rows.notes[from];
            self.statistics.max_depth = self.statistics.max_depth.max(u32::from(notes.depth) + 1);
            let (id, parent) = (self.take_id(), notes.id);
            let (band, depth) = (notes.band.or(spawn.band), notes.depth + 1);
            let notes = RayNotes { id, parent, depth, passes: 0, kind: spawn.kind, band, split: notes.split };
            let sample = parents.rows.sample[from];
            let (rows, to) = self.place_of(sample);
            set_column(&mut rows.origin, to, column(&origins, lane));
            set_column(&mut rows.direction, to, column(&directions, lane));
            set_column(&mut rows.throughput, to, column(&weights, lane));
            rows.sample[to] = sample;
            rows.media[to] = spawn.media.map_or(parents.rows.media[from], |media| media[lane]);
            rows.notes[to] = notes;
            if O::WATCHES {
                let task = rows.task(to);
                self.observer.ray(&task);
            }
        }
    }

    /// Lets a ray go on behind a boundary without effect, as the ray it was.
    #[inline]
    pub fn pass(&mut self, task: &RayTask, ray: Ray, media: MediumStack) {
        if task.passes >= MAX_PASSES {
            self.cut(task.id, Cut::Depth, task.throughput);
            return;
        }
        let id = self.take_id();
        let task = RayTask { ray, media, id, parent: task.id, passes: task.passes + 1, ..*task };
        let (rows, lane) = self.place_of(task.sample);
        rows.set(lane, &task);
        self.observer.ray(&task);
    }

    #[inline(always)]
    fn take_id(&mut self) -> u32 {
        let id = *self.next_id;
        *self.next_id = id.wrapping_add(1);
        id
    }

    /// A place in the queue that the next ray of a sample waits in.
    #[inline(always)]
    fn place_of(&mut self, sample: u32) -> (&mut RayRows, usize) {
        let before = &mut self.spawned[sample as usize];
        let queue = (*before as usize).min(QUEUES - 1);
        *before += 1;
        self.next[queue].next_place()
    }

    fn cut(&mut self, parent: u32, why: Cut, weight: Rgb) {
        self.statistics.add_cut_weight(weight);
        self.observer.cut(parent, why, weight);
    }
}

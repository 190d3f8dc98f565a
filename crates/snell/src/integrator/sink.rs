//! Where an integrator's `shade` puts its results, and the rules that decide which rays are followed.

use snell_math::lanes::{Bits, End, Floats, LaneColor, LaneVector, Lanes, WIDTH};
use snell_math::{Ray, Rgb, Vector3};
use snell_scene::scene::Shadows;

use crate::differential::RayDifferential;
use crate::interaction::{SurfaceInteraction, SurfaceRows};
use crate::observe::Observer;
use crate::statistics::Statistics;
use crate::task::{
    Band, Cut, Differentials, MediumStack, MediumStacks, QuestionNotes, QuestionQueue, RayKind, RayNotes, RayQueue,
    RayRows, RayTask, SampleSums, ShadowQuestion, Term, column,
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
pub(super) const MAX_PASSES: u16 = 4096;

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
    pub(crate) sums: &'a mut SampleSums,
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
    /// How the rays' neighbours differ from them.
    pub(crate) differentials: &'a mut Differentials,
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
    /// Where their parents met surfaces.
    pub surfaces: &'a SurfaceRows,
    /// Of refracted ones the index before over the one beyond.
    pub eta: L,
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
        let shares = rays.throughput::<L>() * radiance;
        self.sums.add::<L, 1>(&rays.rows.sample, rays.at, [(lanes, shares)]);
        if O::WATCHES {
            let mut rows = [[0.0; WIDTH]; 3];
            shares.store(&mut rows, 0);
            for lane in lanes.lanes() {
                self.observer.term(rays.rows.notes[rays.at + lane].id, term, Rgb::from(column(&rows, lane)));
            }
        }
    }

    /// Tells the observer what a ray met.
    #[inline]
    pub fn met(&mut self, task: &RayTask, interaction: Option<&SurfaceInteraction>) {
        self.observer.hit(task, interaction, self.media.current(task.media));
    }

    /// Who watches, to be told of what only the integrator knows; where nobody does, nothing should be worked out for it, see
    /// [`Sink::is_watched`].
    #[inline]
    pub fn observer(&mut self) -> &mut O {
        self.observer
    }

    /// True where somebody watches, and what only a watcher would see is to be worked out.
    #[inline(always)]
    pub fn is_watched(&self) -> bool {
        O::WATCHES
    }

    /// True where somebody wants to know of surfaces and boundaries.
    #[inline(always)]
    pub fn is_detailed(&self) -> bool {
        O::DETAILS
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
        let ([first, second], from) = self.questions.extend(asked.count() as usize);
        let end = End { lanes: asked, from };
        questions.origin.append(end, [&mut first.origin, &mut second.origin]);
        questions.direction.append(end, [&mut first.direction, &mut second.direction]);
        questions.distance.append(end, [&mut first.distance, &mut second.distance]);
        let ([first_diffuse, first_specular], [second_diffuse, second_specular]) =
            (&mut first.shares, &mut second.shares);
        diffuse.append::<L>(end, [first_diffuse, second_diffuse]);
        specular.append::<L>(end, [first_specular, second_specular]);
        L::append_words(&rays.rows.sample, rays.at, end, [&mut first.sample, &mut second.sample]);
        let media = [&mut first.media, &mut second.media].map(bytemuck::cast_mut);
        L::append_words(bytemuck::cast_ref(&rays.rows.media), rays.at, end, media);
        let terms = [Term::Diffuse(questions.light), Term::Specular(questions.light)];
        for (lane, number, place) in end.places() {
            let notes = if number == 0 { &mut first.notes } else { &mut second.notes };
            notes[place] = QuestionNotes { terms, task: rays.rows.notes[rays.at + lane].id, extinction_scale: 1.0 };
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

    /// Which of some rays of a kind are followed that are to be spawned with shares of their parents' throughput, and what they carry; the
    /// limits cut the others.
    #[inline(always)]
    pub fn follow<L: Lanes>(
        &mut self,
        parents: &ShadedRays<'_>,
        kind: RayKind,
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
            self.cut(notes.id, kind, cut, Rgb::from(column(&weights, lane)));
        }
        (followed, throughput)
    }

    /// Adds rays that are followed to the next generation, one deeper than their parents; see [`Sink::follow`].
    #[inline(always)]
    pub fn spawn<L: Lanes>(&mut self, parents: &ShadedRays<'_>, followed: Bits, spawn: &Spawn<'_, L>) {
        let count = u64::from(followed.count());
        self.count_ray(spawn.kind, count);
        let mut ids = [0; WIDTH];
        let mut queues = [0; WIDTH];
        for lane in followed.lanes() {
            ids[lane] = self.take_id();
            queues[lane] = self.take_queue(parents.rows.sample[parents.at + lane]);
        }
        let mut rest = followed;
        while rest.any() {
            // Most often all of them.
            let queue = queues[rest.lowest()];
            let mut same = Bits::NONE;
            for lane in rest.lanes() {
                same |= Bits(u8::from(queues[lane] == queue) << lane);
            }
            rest = rest.without(same);
            self.spawn_into(queue, parents, same, spawn, &ids);
        }
        if self.differentials.are_wanted() {
            let mut eta = [1.0; WIDTH];
            spawn.eta.store(&mut eta, 0);
            self.differ(parents, followed, spawn.kind, spawn.surfaces, &eta, &ids);
        }
    }

    /// Keeps how the neighbours of rays differ that were spawned; see [`Spawn`].
    #[inline(never)]
    fn differ(
        &mut self,
        parents: &ShadedRays<'_>,
        followed: Bits,
        kind: RayKind,
        surfaces: &SurfaceRows,
        eta: &[f64; WIDTH],
        ids: &[u32; WIDTH],
    ) {
        for lane in followed.lanes() {
            let place = parents.at + lane;
            let direction = Vector3::from(column(&parents.rows.direction, place));
            let surface = &surfaces.around[place].differential;
            let differential = match kind {
                RayKind::Refracted => surface.refracted(direction, eta[lane]),
                _ => surface.reflected(direction),
            };
            self.differentials.set(ids[lane], differential);
        }
    }

    /// How the neighbours of a ray differ from it, where that is of use.
    #[inline(always)]
    pub fn differential(&self, id: u32) -> Option<RayDifferential> {
        self.differentials.are_wanted().then(|| self.differentials.of(id))
    }

    /// As above, those that go to one queue, with their numbers.
    #[inline(always)]
    fn spawn_into<L: Lanes>(
        &mut self,
        queue: usize,
        parents: &ShadedRays<'_>,
        lanes: Bits,
        spawn: &Spawn<'_, L>,
        ids: &[u32; WIDTH],
    ) {
        let ([first, second], from) = self.next[queue].extend(lanes.count() as usize);
        let end = End { lanes, from };
        spawn.origin.append(end, [&mut first.origin, &mut second.origin]);
        spawn.direction.append(end, [&mut first.direction, &mut second.direction]);
        spawn.throughput.append::<L>(end, [&mut first.throughput, &mut second.throughput]);
        L::append_words(&parents.rows.sample, parents.at, end, [&mut first.sample, &mut second.sample]);
        let media = [&mut first.media, &mut second.media].map(bytemuck::cast_mut);
        match spawn.media {
            Some(own) => L::append_words(bytemuck::cast_ref(own), 0, end, media),
            None => L::append_words(bytemuck::cast_ref(&parents.rows.media), parents.at, end, media),
        }
        for (lane, number, place) in end.places() {
            let RayNotes { id: parent, split, depth, band, .. } = parents.rows.notes[parents.at + lane];
            let (band, depth) = (band.or(spawn.band), depth + 1);
            self.statistics.max_depth = self.statistics.max_depth.max(u32::from(depth));
            let rows = if number == 0 { &mut *first } else { &mut *second };
            rows.notes[place] = RayNotes { id: ids[lane], parent, depth, passes: 0, kind: spawn.kind, band, split };
            if O::WATCHES {
                self.observer.ray(&rows.task(place));
            }
        }
    }

    /// Lets a ray go on behind a boundary without effect, as the ray it was.
    #[inline]
    pub fn pass(&mut self, task: &RayTask, ray: Ray, media: MediumStack) {
        if task.passes >= MAX_PASSES {
            self.cut(task.id, task.kind, Cut::Depth, task.throughput);
            return;
        }
        let id = self.take_id();
        let from = task.ray.origin;
        let task = RayTask { ray, media, id, parent: task.id, passes: task.passes + 1, ..*task };
        if let Some(differential) = self.differential(task.parent) {
            let way = (task.ray.origin - from).dot(task.ray.direction);
            self.differentials.set(id, differential.at(way));
        }
        let queue = self.take_queue(task.sample);
        self.next[queue].push(&task);
        self.observer.ray(&task);
    }

    /// The depth of the deepest ray.
    #[inline]
    pub fn depth(&self) -> u16 {
        self.rules.depth
    }

    /// Adds a term to the sample of one ray, its throughput in it.
    #[inline]
    pub fn add_one(&mut self, task: &RayTask, term: Term, share: Rgb) {
        self.sums.add_one(task.sample, share);
        self.observer.term(task.id, term, share);
    }

    /// Sends a path on by one ray, one deeper than its parent, with how its neighbours differ from it.
    #[inline]
    pub fn send(
        &mut self,
        parent: &RayTask,
        kind: RayKind,
        ray: Ray,
        media: MediumStack,
        differential: Option<RayDifferential>,
    ) {
        self.count_ray(kind, 1);
        let depth = parent.depth + 1;
        self.statistics.max_depth = self.statistics.max_depth.max(u32::from(depth));
        let id = self.take_id();
        let task = RayTask { ray, media, id, parent: parent.id, depth, passes: 0, kind, ..*parent };
        if let Some(differential) = differential {
            self.differentials.set(id, differential);
        }
        let queue = self.take_queue(task.sample);
        self.next[queue].push(&task);
        self.observer.ray(&task);
    }

    /// Tells that a path was not followed by a ray of a kind, and what it carried.
    pub fn cut_path(&mut self, task: &RayTask, kind: RayKind, why: Cut, weight: Rgb) {
        match why {
            // Others that go on stand for it: nothing is lost.
            Cut::Chance => self.observer.cut(task.id, kind, why, weight),
            Cut::Depth | Cut::Weight | Cut::Number => self.cut(task.id, kind, why, weight),
        }
    }

    /// As [`Sink::ask`], of a question whose answer is known: what arrives of its first term, and which part of the light that is.
    pub fn answer(&mut self, question: &ShadowQuestion, arriving: Rgb, transmittance: Rgb) {
        self.statistics.shadow_rays += 1;
        self.observer.shadow(question, transmittance);
        if !arriving.is_black() {
            self.sums.add_one(question.sample, arriving);
            self.observer.term(question.task, question.terms[0].0, arriving);
        }
    }

    /// As [`Sink::total_internal_reflection`], of one ray.
    pub fn total_internal_reflection_of(&mut self, task: &RayTask) {
        self.statistics.total_internal_reflections += 1;
        self.observer.total_internal_reflection(task.id);
    }

    /// Counts rays by what made them.
    #[inline(always)]
    fn count_ray(&mut self, kind: RayKind, count: u64) {
        match kind {
            RayKind::Reflected => self.statistics.reflected_rays += count,
            RayKind::Refracted => self.statistics.refracted_rays += count,
            RayKind::Scattered => self.statistics.scattered_rays += count,
            RayKind::Camera => self.statistics.camera_rays += count,
        }
    }

    #[inline(always)]
    fn take_id(&mut self) -> u32 {
        let id = *self.next_id;
        *self.next_id = id.wrapping_add(1);
        id
    }

    /// The queue that the next ray of a sample waits in.
    #[inline(always)]
    fn take_queue(&mut self, sample: u32) -> usize {
        let before = &mut self.spawned[sample as usize];
        let queue = (*before as usize).min(QUEUES - 1);
        *before += 1;
        queue
    }

    fn cut(&mut self, parent: u32, kind: RayKind, why: Cut, weight: Rgb) {
        self.statistics.add_cut_weight(weight);
        self.observer.cut(parent, kind, why, weight);
    }
}

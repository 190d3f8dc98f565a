//! Rays and meshes: the closest hit, any hit, all hits.
//!
//! What is met, and where, is decided by [`RaySpace::meet`] in `f64`, and by nothing else. The filter of [`blocks`] spares most
//! triangles that test: those that are surely missed, and those that are surely met so far away that another one is surely
//! nearer. A query for the closest hit keeps those surely met whose distances are too close to be told apart; about one triangle
//! a ray is tested in `f64`. A query for any hit needs no `f64` at all where something is surely met in the range.
//!
//! [`blocks`]: super::blocks

use std::ops::ControlFlow;

use snell_math::Ray;
use snell_math::lanes::{Eight, Floats, Lanes, WIDTH, Work, dispatch};

use super::blocks::{BlockRay, TriangleBlock};
use super::spaces::RaySpaces;
use super::watertight::{Meeting, RaySpace};
use super::{MeshHit, TriangleMesh};
use crate::accel::wide::{Approach, BoxRay, Measure, NONE, Probe, Slabs, Stack, Visited, number, take_lane};

/// How many triangles that are surely met wait for the decision, at most.
const WAITING: usize = 8;

/// A triangle that is surely met.
#[derive(Clone, Copy)]
struct Waiting {
    /// Not in front of this measure of the ray parameter.
    low: f32,
    block: u32,
    lane: u32,
}

/// What a search needs of the mesh and of its ray.
#[derive(Clone, Copy)]
pub(super) struct Question<'a, S> {
    pub(super) blocks: &'a [TriangleBlock],
    pub(super) space: S,
    pub(super) measure: Measure,
}

/// Where the space of a ray is known, to be looked up where it is needed, which is seldom.
pub(super) trait KnownSpace: Copy {
    fn look_up(self) -> RaySpace;
}

impl KnownSpace for &RaySpace {
    #[inline(always)]
    fn look_up(self) -> RaySpace {
        *self
    }
}

/// The space of one of the rays side by side.
#[derive(Clone, Copy)]
pub(super) struct LaneSpace<'a>(pub(super) &'a RaySpaces, pub(super) usize);

impl KnownSpace for LaneSpace<'_> {
    #[inline(always)]
    fn look_up(self) -> RaySpace {
        self.0.space(self.1)
    }
}

/// A search for the closest hit.
pub(super) struct Search {
    t_min: f64,
    /// Falls as hits are decided.
    t_max: f64,
    best: Option<(u32, Meeting)>,
    waiting: Stack<Waiting, WAITING>,
    count: usize,
}

impl Search {
    /// Between two ray parameters, the second included.
    #[inline(always)]
    pub(super) const fn new(t_min: f64, t_max: f64) -> Self {
        Self { t_min, t_max, best: None, waiting: Stack::new(), count: 0 }
    }

    /// Puts another end to the range.
    #[inline(always)]
    pub(super) fn restrict(&mut self, t_max: f64) {
        self.t_max = t_max;
    }

    /// Decides about one triangle.
    #[inline]
    fn decide<L: Lanes>(&mut self, question: &Question<impl KnownSpace>, block: &TriangleBlock, lane: usize) {
        if let Some(meeting) = question.space.look_up().meet::<L>(block.corners(lane)) {
            self.take(number(block.triangles[lane]), meeting);
        }
    }

    /// Takes one triangle that is surely met.
    #[inline(always)]
    fn take_surely<L: Lanes>(&mut self, question: &Question<impl KnownSpace>, block: &TriangleBlock, lane: usize) {
        let space = question.space.look_up();
        if let Some(meeting) = space.meet_surely::<L>(&block.corners_on(space.axes(), lane)) {
            self.take(number(block.triangles[lane]), meeting);
        }
    }

    /// Takes a meeting for the best where it is.
    #[inline(always)]
    pub(super) fn take(&mut self, triangle: u32, meeting: Meeting) {
        let wins_tie = || meeting.t == self.t_max && self.best.is_none_or(|(other, _)| triangle < other);
        if self.t_min < meeting.t && (meeting.t < self.t_max || wins_tie()) {
            self.t_max = meeting.t;
            self.best = Some((triangle, meeting));
        }
    }

    /// The place, block and lane, of one that waits and is not surely beyond the limit; it waits no more.
    #[inline(always)]
    pub(super) fn next_waiting(&mut self, limit: f32) -> Option<(usize, usize)> {
        while let Some(Waiting { low, block, lane }) = self.waiting.pop(&mut self.count) {
            if low <= limit {
                return Some((block as usize, lane as usize));
            }
        }
        None
    }

    /// Decides about those that wait and are not surely beyond the limit.
    #[inline(always)]
    fn settle<L: Lanes>(&mut self, question: &Question<impl KnownSpace>, limit: f32) {
        while let Some((block, lane)) = self.next_waiting(limit) {
            self.take_surely::<L>(question, &question.blocks[block], lane);
        }
    }

    /// Looks at a leaf, and lowers the limit by what is found.
    #[inline(always)]
    pub(super) fn leaf<L: Lanes>(
        &mut self,
        question: &Question<impl KnownSpace>,
        ray: &BlockRay<L::Eight>,
        leaf: u32,
        limit: &mut f32,
    ) {
        let block = &question.blocks[leaf as usize];
        let Some(verdict) = ray.look(block, L::Eight::splat(*limit)) else { return };
        let (low, high) = (verdict.low.to_array(), verdict.high.to_array());
        let (mut sure, mut unsure) = (verdict.sure, verdict.unsure);
        while sure != 0 {
            let lane = take_lane(&mut sure);
            if low[lane] > *limit {
                continue;
            }
            if low[lane] <= 0.0 {
                // It may lie in front of the range, and must not shorten it; it surely does where all of it is behind the probe's
                // origin, since there either the range begins or the mesh.
                if high[lane] >= 0.0 {
                    self.take_surely::<L>(question, block, lane);
                    *limit = limit.min(question.measure.limit(self.t_max));
                }
                continue;
            }
            let end = Measure::widened(high[lane]);
            if end < *limit {
                *limit = end;
            }
            if self.count == WAITING {
                self.make_room::<L>(question, *limit);
                *limit = limit.min(question.measure.limit(self.t_max));
            }
            self.waiting.push(&mut self.count, Waiting { low: low[lane], block: leaf, lane: lane as u32 });
        }
        while unsure != 0 {
            self.decide::<L>(question, block, take_lane(&mut unsure));
            *limit = limit.min(question.measure.limit(self.t_max));
        }
    }

    /// Forgets those that are surely beyond the limit; decides where that leaves no room.
    #[cold]
    fn make_room<L: Lanes>(&mut self, question: &Question<impl KnownSpace>, limit: f32) {
        let (mut kept, mut count) = (Stack::new(), 0);
        while let Some(waiting) = self.waiting.pop(&mut self.count) {
            if waiting.low <= limit {
                kept.push(&mut count, waiting);
            }
        }
        (self.waiting, self.count) = (kept, count);
        if count == WAITING {
            self.settle::<L>(question, limit);
        }
    }

    /// The closest hit, after all leaves have been looked at.
    #[inline(always)]
    pub(super) fn finish<L: Lanes>(&mut self, question: &Question<impl KnownSpace>, limit: f32) -> Option<MeshHit> {
        // As with most rays that hit: what is met need not be written down to be compared with another.
        if self.count == 1 && self.best.is_none() {
            let Waiting { block, lane, .. } = self.waiting.pop(&mut self.count)?;
            let (block, lane) = (&question.blocks[block as usize], lane as usize);
            let space = question.space.look_up();
            let meeting = space.meet_surely::<L>(&block.corners_on(space.axes(), lane))?;
            let is_in_range = meeting.is_within(self.t_min, self.t_max);
            return is_in_range.then(|| MeshHit::new(number(block.triangles[lane & (WIDTH - 1)]), meeting));
        }
        self.settle::<L>(question, limit);
        self.hit()
    }

    /// The closest hit of those that have been decided about.
    #[inline(always)]
    pub(super) fn hit(&self) -> Option<MeshHit> {
        self.best.map(|(triangle, meeting)| MeshHit::new(triangle, meeting))
    }
}

struct Closest<'a> {
    mesh: &'a TriangleMesh,
    ray: &'a Ray,
    t_min: f64,
    t_max: f64,
}

impl Work for Closest<'_> {
    type Output = Option<MeshHit>;
    #[inline(always)]
    fn run<L: Lanes>(self) -> Option<MeshHit> {
        let Self { mesh, ray, t_min, t_max } = self;
        let space = &RaySpace::new(ray)?;
        let probe = &match mesh.tree.approach(ray, t_min, t_max) {
            Approach::Missed => return None,
            Approach::Plain(probe) => probe,
            Approach::Strange(slabs) => return closest_strange(mesh, space, &slabs, t_min, t_max),
        };
        let question = Question { blocks: &mesh.blocks, space, measure: probe.measure };
        let mut search = Search::new(t_min, t_max);
        let (boxes, triangles) = (BoxRay::<L::Eight>::new(probe), BlockRay::<L::Eight>::new(probe, space));
        let limit = mesh.tree.nearest(&boxes, question.measure.limit(t_max), |leaf, limit| {
            search.leaf::<L>(&question, &triangles, leaf, limit);
        });
        search.finish::<L>(&question, limit)
    }
}

/// See [`TriangleMesh::intersect`].
#[inline]
pub(super) fn closest(mesh: &TriangleMesh, ray: &Ray, t_min: f64, t_max: f64) -> Option<MeshHit> {
    dispatch(mesh.set, Closest { mesh, ray, t_min, t_max })
}

/// The same, all in `f64`.
#[cold]
fn closest_strange(mesh: &TriangleMesh, space: &RaySpace, slabs: &Slabs, t_min: f64, t_max: f64) -> Option<MeshHit> {
    let question = Question { blocks: &mesh.blocks, space, measure: Probe::NOTHING.measure };
    let mut search = Search::new(t_min, t_max);
    // It never breaks, so there is nothing to know from its end.
    let _ = mesh.tree.each_strange(slabs, t_min, t_max, &mut |leaf| {
        let block = &mesh.blocks[leaf as usize];
        for lane in filled(block) {
            search.decide::<f64>(&question, block, lane);
        }
        ControlFlow::Continue(())
    });
    search.finish::<f64>(&question, 0.0)
}

/// The lanes of a block that have a triangle.
#[inline]
fn filled(block: &TriangleBlock) -> impl Iterator<Item = usize> {
    (0..WIDTH).take_while(|lane| block.triangles[*lane] != NONE)
}

/// Whether a ray meets a triangle of a block between two parameters. `limit` and `surely_before` are measures of the second.
#[inline(always)]
pub(super) fn is_met_in<L: Lanes>(
    block: &TriangleBlock,
    ray: &BlockRay<L::Eight>,
    space: impl KnownSpace,
    limit: L::Eight,
    surely_before: L::Eight,
    t_min: f64,
    t_max: f64,
) -> bool {
    let Some(verdict) = ray.look(block, limit) else { return false };
    let zero = L::Eight::splat(0.0);
    if verdict.sure & (zero.lt(verdict.low) & verdict.high.le(surely_before)).mask() != 0 {
        return true;
    }
    // Those surely in front of the range or behind it are left out.
    let mut sure = verdict.sure & zero.le(verdict.high.lesser(limit - verdict.low)).mask();
    let mut unsure = verdict.unsure;
    if sure | unsure == 0 {
        return false;
    }
    let space = space.look_up();
    while sure != 0 {
        let meeting = space.meet_surely::<L>(&block.corners_on(space.axes(), take_lane(&mut sure)));
        if meeting.is_some_and(|meeting| meeting.is_within(t_min, t_max)) {
            return true;
        }
    }
    while unsure != 0 {
        let meeting = space.meet::<L>(block.corners(take_lane(&mut unsure)));
        if meeting.is_some_and(|meeting| meeting.is_within(t_min, t_max)) {
            return true;
        }
    }
    false
}

struct Any<'a> {
    mesh: &'a TriangleMesh,
    ray: &'a Ray,
    t_min: f64,
    t_max: f64,
}

impl Work for Any<'_> {
    type Output = bool;
    #[inline(always)]
    fn run<L: Lanes>(self) -> bool {
        let Self { mesh, ray, t_min, t_max } = self;
        let Some(space) = &RaySpace::new(ray) else { return false };
        let probe = &match mesh.tree.approach(ray, t_min, t_max) {
            Approach::Missed => return false,
            Approach::Plain(probe) => probe,
            Approach::Strange(_) => return each(mesh, ray, t_min, t_max, |_| ControlFlow::Break(())).is_break(),
        };
        let (boxes, triangles) = (BoxRay::<L::Eight>::new(probe), BlockRay::<L::Eight>::new(probe, space));
        let limit = probe.measure.limit(t_max);
        let surely_before = L::Eight::splat(probe.measure.surely_before(t_max));
        let visit = |leaf: u32| {
            let block = &mesh.blocks[leaf as usize];
            let is_met = is_met_in::<L>(block, &triangles, space, L::Eight::splat(limit), surely_before, t_min, t_max);
            if is_met { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        mesh.tree.each(&boxes, limit, visit).is_break()
    }
}

/// See [`TriangleMesh::any`].
#[inline]
pub(super) fn any(mesh: &TriangleMesh, ray: &Ray, t_min: f64, t_max: f64) -> bool {
    dispatch(mesh.set, Any { mesh, ray, t_min, t_max })
}

/// Finds all hits, each once.
struct Once<'a, V> {
    space: &'a RaySpace,
    t_min: f64,
    t_max: f64,
    visited: Visited,
    visit: V,
}

impl<V: FnMut(MeshHit) -> ControlFlow<()>> Once<'_, V> {
    #[inline(always)]
    fn decide<L: Lanes>(&mut self, block: &TriangleBlock, lane: usize) -> ControlFlow<()> {
        match self.space.meet::<L>(block.corners(lane)) {
            Some(meeting)
                if meeting.is_within(self.t_min, self.t_max) && self.visited.is_new(0, block.triangles[lane]) =>
            {
                (self.visit)(MeshHit::new(number(block.triangles[lane]), meeting))
            }
            _ => ControlFlow::Continue(()),
        }
    }
}

struct Each<'a, 'b, V> {
    mesh: &'a TriangleMesh,
    probe: &'a Probe,
    once: &'b mut Once<'a, V>,
}

impl<V: FnMut(MeshHit) -> ControlFlow<()>> Work for Each<'_, '_, V> {
    type Output = ControlFlow<()>;
    #[inline(always)]
    fn run<L: Lanes>(self) -> ControlFlow<()> {
        let Self { mesh, probe, once } = self;
        let (boxes, triangles) = (BoxRay::<L::Eight>::new(probe), BlockRay::<L::Eight>::new(probe, once.space));
        let limit = probe.measure.limit(once.t_max);
        mesh.tree.each(&boxes, limit, |leaf| {
            let block = &mesh.blocks[leaf as usize];
            let Some(verdict) = triangles.look(block, L::Eight::splat(limit)) else { return ControlFlow::Continue(()) };
            let mut candidates = verdict.sure | verdict.unsure;
            while candidates != 0 {
                once.decide::<L>(block, take_lane(&mut candidates))?;
            }
            ControlFlow::Continue(())
        })
    }
}

/// See [`TriangleMesh::for_each_hit`].
#[inline]
pub(super) fn each(
    mesh: &TriangleMesh,
    ray: &Ray,
    t_min: f64,
    t_max: f64,
    visit: impl FnMut(MeshHit) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let Some(space) = &RaySpace::new(ray) else { return ControlFlow::Continue(()) };
    let mut once = Once { space, t_min, t_max, visited: Visited::default(), visit };
    match mesh.tree.approach(ray, t_min, t_max) {
        Approach::Missed => ControlFlow::Continue(()),
        Approach::Plain(probe) => dispatch(mesh.set, Each { mesh, probe: &probe, once: &mut once }),
        Approach::Strange(slabs) => mesh.tree.each_strange(&slabs, t_min, t_max, &mut |leaf| {
            let block = &mesh.blocks[leaf as usize];
            filled(block).try_for_each(|lane| once.decide::<f64>(block, lane))
        }),
    }
}

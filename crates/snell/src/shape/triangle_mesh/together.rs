//! Rays side by side and a mesh: through its hierarchy together, and each triangle by the same tests as one ray alone.

use std::mem::MaybeUninit;
use std::ops::ControlFlow;

use snell_math::lanes::{Bits, Eight, Floats, Lanes, WIDTH, Work};

use super::blocks::{BlockLines, BlockRay, TriangleBlock};
use super::many;
use super::queries::{LaneSpace, Question, Search, is_met_in};
use super::sight::{Shared, Sight};
use super::spaces::{Corners, RaySpaces};
use super::{MeshHit, TriangleMesh};
use crate::accel::wide::{Finder, Group, Path, Seeker, Visited, number, take_lane};
use crate::shape::{LaneRay, RayRow};

/// Rays side by side, made ready for a mesh: what is known of them stands with whoever asks, since it is too large to be moved.
#[derive(Clone, Copy)]
struct Ready<'a> {
    mesh: &'a TriangleMesh,
    group: &'a Group,
    spaces: &'a RaySpaces,
    triangles: &'a BlockLines,
}

/// What is made ready for one mesh alone.
struct Own {
    group: Group,
    spaces: RaySpaces,
    triangles: BlockLines,
}

impl<'a> Ready<'a> {
    /// Makes rays ready for a mesh, by what is known of them in its space, or else in a place for it; with those that come near the mesh,
    /// none where nothing is ready, and those that have to be asked for one by one.
    #[inline(always)]
    fn new<L: Lanes>(
        mesh: &'a TriangleMesh,
        row: RayRow,
        shared: Option<Shared<'a>>,
        active: Bits,
        t_max: L,
        own: &'a mut MaybeUninit<Own>,
    ) -> (Option<Self>, Bits, Bits) {
        if let Some(shared) = shared {
            let rays = shared.passing(mesh, row, active, t_max);
            let Shared { group, spaces, triangles, .. } = shared;
            let ready = Self { mesh, group, spaces, triangles };
            return (if rays.any() { Some(ready) } else { None }, rays, Bits::NONE);
        }
        let LaneRay { origin, direction } = row.lanes::<L>(0);
        let probes = mesh.tree.approach_together(origin, direction, active, t_max);
        if probes.plain.is_empty() {
            return (None, Bits::NONE, probes.strange);
        }
        let spaces = RaySpaces::new(origin, direction);
        let (group, triangles) = (Group::new(&probes, t_max), BlockLines::of(&probes, spaces.axes));
        let Own { group, spaces, triangles } = own.write(Own { group, spaces, triangles });
        (Some(Self { mesh, group, spaces, triangles }), probes.plain & spaces.usable, probes.strange)
    }

    #[inline(always)]
    fn block(&self, leaf: u32) -> &'a TriangleBlock {
        &self.mesh.blocks[leaf as usize]
    }

    /// One of the rays, for the filter.
    #[inline(always)]
    fn ray<F: Eight>(&self, lane: usize) -> BlockRay<F> {
        self.triangles.spread(self.spaces.axes, lane)
    }

    /// Puts in the corners of a triangle that one of the rays is to be tested with.
    #[inline(always)]
    fn put(&self, corners: &mut Corners, lane: usize, block: &TriangleBlock, place: usize) {
        corners.put(lane, &block.corners_on(self.spaces.axes.of(lane), place));
    }
}

/// The question for the closest hits; where the rays fly, each goes its own way, see [`ClosestAtLeaves::in_flight`].
struct Closest<'a, const FLIES: bool> {
    mesh: &'a TriangleMesh,
    row: RayRow<'a>,
    shared: Option<Shared<'a>>,
    active: Bits,
    t_max: &'a [f64; WIDTH],
    hits: &'a mut [Option<MeshHit>; WIDTH],
}

struct ClosestAtLeaves<'r, L: Lanes> {
    ready: Ready<'r>,
    searches: &'r mut [Search; WIDTH],
    lanes: std::marker::PhantomData<L>,
}

impl<L: Lanes> Seeker for ClosestAtLeaves<'_, L> {
    #[inline(always)]
    fn prefetch(&self, leaf: u32) {
        L::Eight::prefetch(self.ready.block(leaf));
    }

    #[inline(always)]
    fn leaf(&mut self, leaf: u32, rays: Bits, limits: &mut [f32; WIDTH]) {
        for lane in rays.lanes() {
            self.look(leaf, lane, limits);
        }
    }
}

impl<L: Lanes> ClosestAtLeaves<'_, L> {
    /// Looks at a leaf for one ray.
    #[inline(always)]
    fn look(&mut self, leaf: u32, lane: usize, limits: &mut [f32; WIDTH]) {
        let ray = self.ready.ray::<L::Eight>(lane);
        let Ready { mesh, group, spaces, .. } = self.ready;
        let (space, measure) = (LaneSpace(spaces, lane), group.measure(lane));
        let question = Question { blocks: &mesh.blocks, space, measure };
        self.searches[lane].leaf::<L>(&question, &ray, leaf, &mut limits[lane]);
    }

    /// Each ray by itself, but a step of each in turn, so that they wait for memory together.
    #[inline(always)]
    fn in_flight(&mut self, mut rays: Bits, limits: &mut [f32; WIDTH]) {
        let (tree, blocks) = (&self.ready.mesh.tree, &self.ready.mesh.blocks);
        let mut paths = [const { Path::new() }; WIDTH];
        while rays.any() {
            for lane in rays.lanes() {
                let path = &mut paths[lane];
                let goes_on = match path.leaf() {
                    None => path.descend(tree, &self.ready.group.ray::<L::Eight>(lane), limits[lane]),
                    Some(leaf) => {
                        self.look(leaf, lane, limits);
                        path.leave(limits[lane])
                    }
                };
                if goes_on {
                    path.prefetch::<L::Eight>(tree, |leaf| L::Eight::prefetch(&blocks[leaf as usize]));
                } else {
                    rays = rays.without(Bits::lane(lane));
                }
            }
        }
    }

    /// Decides about what waits, a triangle of each ray at a time.
    #[inline(always)]
    fn settle(&mut self, mut rays: Bits, limits: &[f32; WIDTH]) {
        let (mut corners, mut triangles) = (Corners::NOTHING, [0; WIDTH]);
        loop {
            for lane in rays.lanes() {
                match self.searches[lane].next_waiting(limits[lane]) {
                    Some((block, place)) => {
                        let block = &self.ready.mesh.blocks[block];
                        self.ready.put(&mut corners, lane, block, place);
                        triangles[lane] = number(block.triangles[place]);
                    }
                    None => rays = rays.without(Bits::lane(lane)),
                }
            }
            if rays.is_empty() {
                return;
            }
            let meetings = self.ready.spaces.meet::<L>(corners.lanes()).rows();
            for lane in rays.lanes() {
                if let Some(meeting) = meetings.of(lane, self.ready.spaces, &corners) {
                    self.searches[lane].take(triangles[lane], meeting);
                }
            }
        }
    }
}

/// Whether the first and the last of some rays go much the same way.
#[inline(always)]
fn are_coherent(row: RayRow, rays: Bits) -> bool {
    let last = (u32::BITS - 1).saturating_sub(rays.mask().leading_zeros());
    many::go_the_same_way(&row.ray(rays.lowest() & (WIDTH - 1)), &row.ray(last as usize & (WIDTH - 1)))
}

impl<const FLIES: bool> Work for Closest<'_, FLIES> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { mesh, row, shared, active, t_max, hits } = self;
        let (end, mut own) = (L::load(t_max, 0), MaybeUninit::uninit());
        let (ready, rays, strange) = Ready::new(mesh, row, shared, active, end, &mut own);
        for lane in strange.lanes() {
            hits[lane] = mesh.intersect(&row.ray(lane), 0.0, t_max[lane]);
        }
        let Some(ready) = ready else { return };
        let mut limits = ready.group.limits_at(end);
        let searches = &mut [const { Search::new(0.0, 0.0) }; WIDTH];
        for lane in rays.lanes() {
            searches[lane].restrict(t_max[lane]);
        }
        let lanes = std::marker::PhantomData;
        let mut seeker = ClosestAtLeaves::<L> { ready, searches, lanes };
        if FLIES {
            seeker.in_flight(rays, &mut limits);
        } else {
            ready.group.nearest_in::<L::Eight>(&mesh.tree, rays, &mut limits, &mut seeker);
        }
        seeker.settle(rays, &limits);
        for lane in rays.lanes() {
            hits[lane] = seeker.searches[lane].hit();
        }
    }
}

/// The question whether anything is met.
struct Any<'a> {
    mesh: &'a TriangleMesh,
    row: RayRow<'a>,
    shared: Option<Shared<'a>>,
    active: Bits,
    t_max: &'a [f64; WIDTH],
}

struct AnyAtLeaves<'a, 'r, L: Lanes> {
    ready: Ready<'r>,
    t_max: &'a [f64; WIDTH],
    met: Bits,
    lanes: std::marker::PhantomData<L>,
}

impl<L: Lanes> Finder for AnyAtLeaves<'_, '_, L> {
    #[inline(always)]
    fn prefetch(&self, leaf: u32) {
        L::Eight::prefetch(self.ready.block(leaf));
    }

    #[inline(always)]
    fn leaf(&mut self, leaf: u32, rays: Bits) -> Bits {
        let block = self.ready.block(leaf);
        let mut met = Bits::NONE;
        for lane in rays.lanes() {
            let ray = self.ready.ray::<L::Eight>(lane);
            let t_max = self.t_max[lane];
            let limit = L::Eight::splat(self.ready.group.limits[lane]);
            let surely_before = L::Eight::splat(self.ready.group.measure(lane).surely_before(t_max));
            let space = LaneSpace(self.ready.spaces, lane);
            if is_met_in::<L>(block, &ray, space, limit, surely_before, 0.0, t_max) {
                met |= Bits::lane(lane);
            }
        }
        self.met |= met;
        met
    }
}

impl Work for Any<'_> {
    type Output = Bits;
    #[inline(always)]
    fn run<L: Lanes>(self) -> Bits {
        let Self { mesh, row, shared, active, t_max } = self;
        let (end, mut own) = (L::load(t_max, 0), MaybeUninit::uninit());
        let (ready, rays, strange) = Ready::new(mesh, row, shared, active, end, &mut own);
        let mut met = Bits::NONE;
        for lane in strange.lanes() {
            met |= Bits::all_if(mesh.any(&row.ray(lane), 0.0, t_max[lane])) & Bits::lane(lane);
        }
        let Some(ready) = ready else { return met };
        let lanes = std::marker::PhantomData;
        let mut finder = AnyAtLeaves::<L> { ready, t_max, met, lanes };
        ready.group.each_in::<L::Eight>(&mesh.tree, rays, &mut finder);
        finder.met
    }
}

/// The question for all hits.
struct Each<'a, V> {
    mesh: &'a TriangleMesh,
    row: RayRow<'a>,
    shared: Option<Shared<'a>>,
    active: Bits,
    t_max: &'a [f64; WIDTH],
    visit: V,
}

struct EachAtLeaves<'a, 'r, L: Lanes, V> {
    ready: Ready<'r>,
    t_max: &'a [f64; WIDTH],
    visited: Visited,
    visit: V,
    broken: Bits,
    lanes: std::marker::PhantomData<L>,
}

impl<L: Lanes, V: FnMut(usize, MeshHit) -> ControlFlow<()>> EachAtLeaves<'_, '_, L, V> {
    /// Decides about the triangles of a block that rays may meet, one of each ray at a time; the rays that break off.
    #[inline(always)]
    fn decide(&mut self, block: &TriangleBlock, mut rays: Bits, candidates: &mut [u32; WIDTH]) -> Bits {
        let (mut corners, mut places, mut broken) = (Corners::NOTHING, [0; WIDTH], Bits::NONE);
        while rays.any() {
            for lane in rays.lanes() {
                places[lane] = take_lane(&mut candidates[lane]);
                self.ready.put(&mut corners, lane, block, places[lane]);
            }
            let meeting = self.ready.spaces.meet::<L>(corners.lanes());
            let (seen, rows) = (meeting.seen(), meeting.rows());
            for lane in rays.lanes() {
                let meeting = if seen.has(lane) {
                    rows.of(lane, self.ready.spaces, &corners)
                } else {
                    self.ready.spaces.space(lane).meet::<L>(block.corners(places[lane]))
                };
                if let Some(meeting) = meeting
                    && meeting.is_within(0.0, self.t_max[lane])
                    && self.visited.is_new(lane, block.triangles[places[lane]])
                    && (self.visit)(lane, MeshHit::new(number(block.triangles[places[lane]]), meeting)).is_break()
                {
                    broken |= Bits::lane(lane);
                    candidates[lane] = 0;
                }
                if candidates[lane] == 0 {
                    rays = rays.without(Bits::lane(lane));
                }
            }
        }
        broken
    }
}

impl<L: Lanes, V: FnMut(usize, MeshHit) -> ControlFlow<()>> Finder for EachAtLeaves<'_, '_, L, V> {
    #[inline(always)]
    fn prefetch(&self, leaf: u32) {
        L::Eight::prefetch(self.ready.block(leaf));
    }

    #[inline(always)]
    fn leaf(&mut self, leaf: u32, rays: Bits) -> Bits {
        let block = self.ready.block(leaf);
        let (mut candidates, mut open) = ([0; WIDTH], Bits::NONE);
        for lane in rays.lanes() {
            let ray = self.ready.ray::<L::Eight>(lane);
            if let Some(verdict) = ray.look(block, L::Eight::splat(self.ready.group.limits[lane])) {
                candidates[lane] = verdict.sure | verdict.unsure;
                open |= Bits::lane(lane) & Bits::all_if(candidates[lane] != 0);
            }
        }
        if open.is_empty() {
            return Bits::NONE;
        }
        let broken = self.decide(block, open, &mut candidates);
        self.broken |= broken;
        broken
    }
}

impl<V: FnMut(usize, MeshHit) -> ControlFlow<()>> Work for Each<'_, V> {
    type Output = Bits;
    #[inline(always)]
    fn run<L: Lanes>(self) -> Bits {
        let Self { mesh, row, shared, active, t_max, mut visit } = self;
        let (end, mut own) = (L::load(t_max, 0), MaybeUninit::uninit());
        let (ready, rays, strange) = Ready::new(mesh, row, shared, active, end, &mut own);
        let mut broken = Bits::NONE;
        for lane in strange.lanes() {
            let is_broken = mesh.for_each_hit(&row.ray(lane), 0.0, t_max[lane], |hit| visit(lane, hit)).is_break();
            broken |= Bits::all_if(is_broken) & Bits::lane(lane);
        }
        let Some(ready) = ready else { return broken };
        let visited = Visited::default();
        let lanes = std::marker::PhantomData;
        let mut finder = EachAtLeaves::<L, _> { ready, t_max, visited, visit, broken, lanes };
        ready.group.each_in::<L::Eight>(&mesh.tree, rays, &mut finder);
        finder.broken
    }
}

impl TriangleMesh {
    /// Asks for what says where the corners of a triangle that was met are.
    #[inline(always)]
    pub(crate) fn prefetch_triangle<F: Eight>(&self, triangle: u32) {
        if let Some(triangle) = self.triangles.get(triangle as usize) {
            F::prefetch(triangle);
        }
    }

    /// Asks for the corners themselves.
    #[inline(always)]
    pub(crate) fn prefetch_corners<F: Eight>(&self, triangle: u32) {
        for vertex in self.triangles.get(triangle as usize).into_iter().flatten() {
            if let Some(position) = self.positions.get(*vertex as usize) {
                F::prefetch(position);
            }
            if let Some(normal) = self.normals.get(*vertex as usize) {
                F::prefetch(normal);
            }
        }
    }

    /// [`TriangleMesh::intersect`] of the active ones of rays side by side, from t > 0 on. Where the mesh stands in a space with others,
    /// `sight` is what is known of the rays there, of which the active ones are plain.
    #[inline(always)]
    pub(crate) fn intersect_together<L: Lanes>(
        &self,
        row: RayRow,
        sight: Option<&Sight>,
        active: Bits,
        t_max: &[f64; WIDTH],
        hits: &mut [Option<MeshHit>; WIDTH],
    ) {
        let flies = many::is_large(self) && !are_coherent(row, active);
        self.closest_together::<L>(row, sight, active, t_max, hits, flies);
    }

    /// The same, in flight or not.
    #[inline(always)]
    pub(super) fn closest_together<L: Lanes>(
        &self,
        row: RayRow,
        sight: Option<&Sight>,
        active: Bits,
        t_max: &[f64; WIDTH],
        hits: &mut [Option<MeshHit>; WIDTH],
        flies: bool,
    ) {
        let shared = sight.and_then(|sight| sight.of::<L>(self));
        // Two functions, since meshes that the caches hold should not carry around what the others need.
        if flies {
            L::stage(Closest::<true> { mesh: self, row, shared, active, t_max, hits });
        } else {
            L::stage(Closest::<false> { mesh: self, row, shared, active, t_max, hits });
        }
    }

    /// [`TriangleMesh::any`] of the active ones of rays side by side, from t > 0 on. What is known of rays in a space is known of them up
    /// to the same t here.
    #[inline(always)]
    pub(crate) fn any_together<L: Lanes>(
        &self,
        row: RayRow,
        sight: Option<&Sight>,
        active: Bits,
        t_max: &[f64; WIDTH],
    ) -> Bits {
        let shared = sight.and_then(|sight| sight.of::<L>(self));
        L::stage(Any { mesh: self, row, shared, active, t_max })
    }

    /// [`TriangleMesh::for_each_hit`] of the active ones of rays side by side, from t > 0 on; returns those for which `visit` broke. As
    /// for [`TriangleMesh::any_together`].
    #[inline(always)]
    pub(crate) fn each_together<L: Lanes>(
        &self,
        row: RayRow,
        sight: Option<&Sight>,
        active: Bits,
        t_max: &[f64; WIDTH],
        visit: impl FnMut(usize, MeshHit) -> ControlFlow<()>,
    ) -> Bits {
        let shared = sight.and_then(|sight| sight.of::<L>(self));
        L::stage(Each { mesh: self, row, shared, active, t_max, visit })
    }
}

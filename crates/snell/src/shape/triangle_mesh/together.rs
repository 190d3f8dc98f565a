//! Rays side by side and a mesh: through its hierarchy together, and each triangle by the same tests as one ray alone.

use snell_math::Ray;
use snell_math::lanes::{Bits, Eight, Floats, LaneVector, Lanes, WIDTH, Work};

use super::blocks::{BlockLine, BlockRay};
use super::queries::{Question, Search, is_met_in};
use super::watertight::RaySpace;
use super::{MeshHit, TriangleMesh};
use crate::accel::wide::{Finder, Group, Seeker};

/// Rays side by side, in the space of the mesh: each by itself, and all in rows.
#[derive(Clone, Copy)]
pub(crate) struct RayRow<'a> {
    pub(crate) rays: &'a [Ray; WIDTH],
    pub(crate) origin: &'a [[f64; WIDTH]; 3],
    pub(crate) direction: &'a [[f64; WIDTH]; 3],
}

/// Rays made ready for a mesh.
struct Ready {
    group: Group,
    spaces: [RaySpace; WIDTH],
    triangles: [BlockLine; WIDTH],
}

impl Ready {
    #[inline(always)]
    fn new<L: Lanes>(mesh: &TriangleMesh, row: &RayRow, active: Bits, t_max: &[f64; WIDTH]) -> Self {
        let (origin, direction) = (LaneVector::<L>::load(row.origin, 0), LaneVector::load(row.direction, 0));
        let mut ready = Self {
            group: Group::new(&mesh.tree, origin, direction, active, t_max),
            spaces: [RaySpace::NOTHING; WIDTH],
            triangles: [BlockLine::NOTHING; WIDTH],
        };
        for lane in ready.group.plain.lanes() {
            match RaySpace::new(&row.rays[lane]) {
                Some(space) => {
                    ready.triangles[lane] = BlockLine::new(&ready.group.probe(lane), &space);
                    ready.spaces[lane] = space;
                }
                None => ready.group.plain = ready.group.plain.without(Bits::lane(lane)),
            }
        }
        ready
    }

    #[inline(always)]
    fn question<'a>(&'a self, mesh: &'a TriangleMesh, lane: usize) -> Question<'a> {
        Question { blocks: &mesh.blocks, space: &self.spaces[lane], measure: self.group.measure(lane) }
    }
}

/// The question for the closest hits.
struct Closest<'a> {
    mesh: &'a TriangleMesh,
    row: RayRow<'a>,
    active: Bits,
    t_max: &'a [f64; WIDTH],
    hits: &'a mut [Option<MeshHit>; WIDTH],
}

struct ClosestAtLeaves<'a, 'r, L: Lanes> {
    mesh: &'a TriangleMesh,
    ready: &'r Ready,
    searches: [Search; WIDTH],
    lanes: std::marker::PhantomData<L>,
}

impl<L: Lanes> Seeker for ClosestAtLeaves<'_, '_, L> {
    #[inline(always)]
    fn prefetch(&self, leaf: u32) {
        L::Eight::prefetch(&self.mesh.blocks[leaf as usize]);
    }

    #[inline(always)]
    fn leaf(&mut self, leaf: u32, rays: Bits, limits: &mut [f32; WIDTH]) {
        for lane in rays.lanes() {
            let ray = BlockRay::<L::Eight>::spread(&self.ready.triangles[lane]);
            let question = self.ready.question(self.mesh, lane);
            self.searches[lane].leaf::<L>(&question, &ray, leaf, &mut limits[lane]);
        }
    }
}

impl Work for Closest<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { mesh, row, active, t_max, hits } = self;
        let ready = Ready::new::<L>(mesh, &row, active, t_max);
        let mut searches = [const { Search::new(0.0, 0.0) }; WIDTH];
        for lane in ready.group.plain.lanes() {
            searches[lane].restrict(t_max[lane]);
        }
        let mut seeker = ClosestAtLeaves::<L> { mesh, ready: &ready, searches, lanes: std::marker::PhantomData };
        let mut limits = ready.group.limits;
        ready.group.nearest_in::<L::Eight>(&mesh.tree, &mut limits, &mut seeker);
        for lane in ready.group.plain.lanes() {
            hits[lane] = seeker.searches[lane].finish::<L>(&ready.question(mesh, lane), limits[lane]);
        }
        for lane in ready.group.strange.lanes() {
            hits[lane] = mesh.intersect(&row.rays[lane], 0.0, t_max[lane]);
        }
    }
}

/// The question whether anything is met.
struct Any<'a> {
    mesh: &'a TriangleMesh,
    row: RayRow<'a>,
    active: Bits,
    t_max: &'a [f64; WIDTH],
}

struct AnyAtLeaves<'a, 'r, L: Lanes> {
    mesh: &'a TriangleMesh,
    ready: &'r Ready,
    t_max: &'a [f64; WIDTH],
    met: Bits,
    lanes: std::marker::PhantomData<L>,
}

impl<L: Lanes> Finder for AnyAtLeaves<'_, '_, L> {
    #[inline(always)]
    fn prefetch(&self, leaf: u32) {
        L::Eight::prefetch(&self.mesh.blocks[leaf as usize]);
    }

    #[inline(always)]
    fn leaf(&mut self, leaf: u32, rays: Bits) -> Bits {
        let Ready { group, spaces, triangles } = self.ready;
        let block = &self.mesh.blocks[leaf as usize];
        let mut met = Bits::NONE;
        for lane in rays.lanes() {
            let ray = BlockRay::<L::Eight>::spread(&triangles[lane]);
            let t_max = self.t_max[lane];
            let limit = L::Eight::splat(group.limits[lane]);
            let surely_before = L::Eight::splat(group.measure(lane).surely_before(t_max));
            if is_met_in::<L>(block, &ray, &spaces[lane], limit, surely_before, 0.0, t_max) {
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
        let Self { mesh, row, active, t_max } = self;
        let ready = Ready::new::<L>(mesh, &row, active, t_max);
        let lanes = std::marker::PhantomData;
        let mut finder = AnyAtLeaves::<L> { mesh, ready: &ready, t_max, met: Bits::NONE, lanes };
        ready.group.each_in::<L::Eight>(&mesh.tree, &mut finder);
        let mut met = finder.met;
        for lane in ready.group.strange.lanes() {
            if mesh.any(&row.rays[lane], 0.0, t_max[lane]) {
                met |= Bits::lane(lane);
            }
        }
        met
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

    /// [`TriangleMesh::intersect`] of the active ones of rays side by side, from t > 0 on.
    #[inline(always)]
    pub(crate) fn intersect_together<L: Lanes>(
        &self,
        row: RayRow,
        active: Bits,
        t_max: &[f64; WIDTH],
        hits: &mut [Option<MeshHit>; WIDTH],
    ) {
        L::stage(Closest { mesh: self, row, active, t_max, hits });
    }

    /// [`TriangleMesh::any`] of the active ones of rays side by side, from t > 0 on.
    #[inline(always)]
    pub(crate) fn any_together<L: Lanes>(&self, row: RayRow, active: Bits, t_max: &[f64; WIDTH]) -> Bits {
        L::stage(Any { mesh: self, row, active, t_max })
    }
}

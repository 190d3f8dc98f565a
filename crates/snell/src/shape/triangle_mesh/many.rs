//! Many rays and a mesh: eight side by side where neighbours go the same way; else sixteen in flight where the mesh is larger than the
//! caches, and one by one where it is not.
//!
//! In flight, each ray does a step, one node or one leaf, and asks for the memory that its next step needs; then the next ray has
//! its turn. The steps are those of a ray by itself, in the same order, so the hits are the same.

use snell_math::Ray;
use snell_math::lanes::{Bits, Eight, Lanes, WIDTH, Work, dispatch};

use super::blocks::{BlockLine, BlockRay};
use super::queries::{Question, Search};
use super::watertight::RaySpace;
use super::{MeshHit, TriangleMesh};
use crate::accel::wide::{Approach, BoxLine, BoxRay, Measure, Path, Probe};
use crate::shape::RayRow;

/// How many rays are in flight: enough to wait for memory together, few enough for the nearest cache to hold what is known of them.
const IN_FLIGHT: usize = 16;

/// From how many bytes of nodes and blocks on memory is worth waiting for together. Measured with one thread on a processor with
/// 1 MiB of second-level and 32 MiB of third-level cache.
const LARGE: usize = 24 << 20;

/// A ray in flight.
struct Flight {
    /// Its place among the rays.
    place: usize,
    limit: f32,
    boxes: BoxLine,
    triangles: BlockLine,
    measure: Measure,
    space: RaySpace,
    search: Search,
    path: Path,
}

/// Rays to be traced, and where their hits go.
struct Many<'a, 'b> {
    mesh: &'a TriangleMesh,
    rays: &'b [Ray],
    t_min: f64,
    t_max: &'b [f64],
    hits: &'b mut [Option<MeshHit>],
    /// The first ray that has not taken off yet.
    next: usize,
}

impl Many<'_, '_> {
    /// The next ray that has something before it; the others have no hit, or are traced by themselves.
    #[inline(always)]
    fn take_off(&mut self) -> Option<(usize, Probe, RaySpace)> {
        while let (Some(ray), Some(&t_max)) = (self.rays.get(self.next), self.t_max.get(self.next)) {
            let place = self.next;
            self.next += 1;
            let Some(space) = RaySpace::new(ray) else {
                self.hits[place] = None;
                continue;
            };
            match self.mesh.tree.approach(ray, self.t_min, t_max) {
                Approach::Missed => self.hits[place] = None,
                Approach::Strange(_) => self.hits[place] = self.mesh.intersect(ray, self.t_min, t_max),
                Approach::Plain(probe) => {
                    return Some((place, probe, space));
                }
            }
        }
        None
    }
}

impl Flight {
    #[inline(always)]
    fn new((place, probe, space): (usize, Probe, RaySpace), t_min: f64, t_max: f64) -> Self {
        let (boxes, triangles) = (BoxLine::new(&probe), BlockLine::new(&probe, &space));
        let (measure, search) = (probe.measure, Search::new(t_min, t_max));
        Self { place, limit: measure.limit(t_max), boxes, triangles, measure, space, search, path: Path::new() }
    }

    /// One step; false where it was the last.
    #[inline(always)]
    fn step<L: Lanes>(&mut self, mesh: &TriangleMesh) -> bool {
        match self.path.leaf() {
            None => self.path.descend(&mesh.tree, &BoxRay::<L::Eight>::spread(&self.boxes), self.limit),
            Some(leaf) => {
                let question = Question { blocks: &mesh.blocks, space: &self.space, measure: self.measure };
                self.search.leaf::<L>(&question, &BlockRay::spread(&self.triangles), leaf, &mut self.limit);
                self.path.leave(self.limit)
            }
        }
    }
}

impl Work for Many<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        let mesh = self.mesh;
        let mut flights: Vec<Flight> = Vec::with_capacity(IN_FLIGHT);
        while flights.len() < IN_FLIGHT
            && let Some(start) = self.take_off()
        {
            let t_max = self.t_max[start.0];
            flights.push(Flight::new(start, self.t_min, t_max));
        }
        let mut turn = 0;
        while let Some(flight) = flights.get_mut(turn) {
            if flight.step::<L>(mesh) {
                flight.path.prefetch::<L::Eight>(&mesh.tree, |leaf| L::Eight::prefetch(&mesh.blocks[leaf as usize]));
                turn += 1;
            } else {
                let question = Question { blocks: &mesh.blocks, space: &flight.space, measure: flight.measure };
                self.hits[flight.place] = flight.search.finish::<L>(&question, flight.limit);
                match self.take_off() {
                    Some((place, probe, space)) => {
                        let t_max = self.t_max[place];
                        flight.limit = probe.measure.limit(t_max);
                        flight.boxes = BoxLine::new(&probe);
                        flight.triangles = BlockLine::new(&probe, &space);
                        (flight.place, flight.measure, flight.space) = (place, probe.measure, space);
                        flight.search = Search::new(self.t_min, t_max);
                        flight.path.restart();
                    }
                    None => {
                        flights.swap_remove(turn);
                    }
                }
            }
            if turn >= flights.len() {
                turn = 0;
            }
        }
    }
}

/// See [`TriangleMesh::intersect_many`].
pub(super) fn closest(mesh: &TriangleMesh, rays: &[Ray], t_min: f64, t_max: &[f64], hits: &mut [Option<MeshHit>]) {
    if t_min == 0.0 && are_coherent(rays) {
        side_by_side(mesh, rays, t_max, hits);
    } else if is_large(mesh) {
        in_flight(mesh, rays, t_min, t_max, hits);
    } else {
        one_by_one(mesh, rays, t_min, t_max, hits);
    }
}

/// Whether nodes and blocks are more than the caches hold.
#[inline(always)]
pub(super) fn is_large(mesh: &TriangleMesh) -> bool {
    mesh.tree.bytes() + size_of_val(mesh.blocks.as_slice()) >= LARGE
}

/// Whether two rays go less than 15 degrees apart.
#[inline(always)]
pub(super) fn go_the_same_way(a: &Ray, b: &Ray) -> bool {
    let (a, b) = (a.direction, b.direction);
    a.dot(b) > 0.966 * (a.length_squared() * b.length_squared()).sqrt()
}

fn one_by_one(mesh: &TriangleMesh, rays: &[Ray], t_min: f64, t_max: &[f64], hits: &mut [Option<MeshHit>]) {
    for ((ray, t_max), hit) in rays.iter().zip(t_max).zip(hits) {
        *hit = mesh.intersect(ray, t_min, *t_max);
    }
}

/// Whether neighbours go much the same way, as far as some of them show: in three of four rows of eight.
fn are_coherent(rays: &[Ray]) -> bool {
    let rows = rays.chunks_exact(WIDTH);
    let stride = (rows.len() / 16).max(1);
    let (mut alike, mut asked) = (0, 0);
    for row in rows.step_by(stride) {
        alike += usize::from(go_the_same_way(&row[0], &row[WIDTH - 1]));
        asked += 1;
    }
    asked > 0 && alike * 4 >= asked * 3
}

/// The same from t > 0 on, eight side by side whatever way they go.
pub(super) fn side_by_side(mesh: &TriangleMesh, rays: &[Ray], t_max: &[f64], hits: &mut [Option<MeshHit>]) {
    dispatch(mesh.set, SideBySide { mesh, rays, t_max, hits });
}

/// Rays to be traced eight by eight.
struct SideBySide<'a, 'b> {
    mesh: &'a TriangleMesh,
    rays: &'b [Ray],
    t_max: &'b [f64],
    hits: &'b mut [Option<MeshHit>],
}

impl Work for SideBySide<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { mesh, rays, t_max, hits } = self;
        // One lane has no sides.
        if L::COUNT < WIDTH {
            return one_by_one(mesh, rays, 0.0, t_max, hits);
        }
        let rows = rays.chunks(WIDTH).zip(t_max.chunks(WIDTH)).zip(hits.chunks_mut(WIDTH));
        for ((some, limits), hits) in rows {
            let (mut t_max, mut found) = ([0.0; WIDTH], [None; WIDTH]);
            let (mut origin, mut direction) = ([[0.0; WIDTH]; 3], [[0.0; WIDTH]; 3]);
            t_max[..some.len()].copy_from_slice(limits);
            for (lane, ray) in some.iter().enumerate() {
                for axis in 0..3 {
                    (origin[axis][lane], direction[axis][lane]) = (ray.origin[axis], ray.direction[axis]);
                }
            }
            let row = RayRow { origin: &origin, direction: &direction };
            mesh.intersect_together::<L>(row, None, Bits::first(some.len()), &t_max, &mut found);
            hits.copy_from_slice(&found[..some.len()]);
        }
    }
}

/// The same, in flight whatever the size.
pub(super) fn in_flight(mesh: &TriangleMesh, rays: &[Ray], t_min: f64, t_max: &[f64], hits: &mut [Option<MeshHit>]) {
    dispatch(mesh.set, Many { mesh, rays, t_min, t_max, hits, next: 0 });
}

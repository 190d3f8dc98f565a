//! Rays side by side, made ready once for all meshes that stand in one space as they are.
//!
//! What filters boxes and triangles knows of a ray is where it enters a tree, and how large the tree is; and what holds for a tree holds
//! for one inside it. So where meshes stand among others, as the parts of a machine do, rays are made ready for the hierarchy over all of
//! them, and each mesh is asked with that, unless it is so much smaller that its filters would let too much through.

use std::cell::OnceCell;

use snell_math::lanes::{Bits, LaneVector, Lanes, WIDTH, Work};

use super::TriangleMesh;
use super::blocks::BlockLines;
use super::spaces::RaySpaces;
use crate::accel::wide::{Group, Probes, reciprocal};
use crate::shape::RayRow;

/// How much larger than a mesh the space may be: bounds on errors grow by that. Triangles are then still larger than what their filters
/// do not know, by far where there are fewer than some millions.
const LARGER: f64 = 8.0;

/// Rays in the space of a hierarchy, and what is made of them where a mesh of it is met.
pub(crate) struct Sight<'g> {
    group: &'g Group,
    row: RayRow<'g>,
    /// Of the probes.
    origin: [[f64; WIDTH]; 3],
    direction: [[f64; WIDTH]; 3],
    error: [f64; WIDTH],
    extent: f64,
    made: OnceCell<Made>,
}

/// What triangles ask for.
struct Made {
    spaces: RaySpaces,
    triangles: BlockLines,
    /// Of the directions.
    inverse: [[f64; WIDTH]; 3],
}

/// What is known of rays in a space, for one of its meshes.
#[derive(Clone, Copy)]
pub(super) struct Shared<'a> {
    pub(super) group: &'a Group,
    pub(super) spaces: &'a RaySpaces,
    pub(super) triangles: &'a BlockLines,
    inverse: &'a [[f64; WIDTH]; 3],
}

impl<'g> Sight<'g> {
    /// Of rays and the probes that were made of them for the space's hierarchy.
    #[inline(always)]
    pub(crate) fn new<L: Lanes>(row: RayRow<'g>, probes: &Probes<L>, group: &'g Group) -> Self {
        let (rows, extent) = ([[0.0; WIDTH]; 3], probes.extent);
        let (origin, direction, error) = (rows, rows, [0.0; WIDTH]);
        let mut sight = Self { group, row, origin, direction, error, extent, made: OnceCell::new() };
        probes.origin.store(&mut sight.origin, 0);
        probes.direction.store(&mut sight.direction, 0);
        probes.error.store(&mut sight.error, 0);
        sight
    }

    /// What serves a mesh that stands in the space as it is; `None` where it is much smaller than that.
    #[inline(always)]
    pub(super) fn of<L: Lanes>(&self, mesh: &TriangleMesh) -> Option<Shared<'_>> {
        if self.extent > LARGER * mesh.tree.extent() {
            return None;
        }
        let Made { spaces, triangles, inverse } = self.made.get_or_init(|| L::stage(Make(self)));
        Some(Shared { group: self.group, spaces, triangles, inverse })
    }
}

impl Shared<'_> {
    /// Those of the rays that come near a mesh before some parameters.
    #[inline(always)]
    pub(super) fn passing<L: Lanes>(&self, mesh: &TriangleMesh, row: RayRow, rays: Bits, t_max: L) -> Bits {
        let (ray, inverse) = (row.lanes::<L>(0), LaneVector::load(self.inverse, 0));
        mesh.tree.passed(ray.origin, ray.direction, inverse, rays & self.spaces.usable, t_max)
    }
}

/// The question what is needed for triangles.
struct Make<'a>(&'a Sight<'a>);

impl Work for Make<'_> {
    type Output = Made;
    #[inline(always)]
    fn run<L: Lanes>(self) -> Made {
        let Sight { row, origin, direction, error, extent, .. } = self.0;
        let ray = row.lanes::<L>(0);
        let spaces = RaySpaces::new(ray.origin, ray.direction);
        let (origin, direction) = (LaneVector::load(origin, 0), LaneVector::load(direction, 0));
        let triangles = BlockLines::new(origin, direction, L::load(error, 0), *extent, spaces.axes);
        let mut made = Made { spaces, triangles, inverse: [[0.0; WIDTH]; 3] };
        reciprocal(ray.direction).store(&mut made.inverse, 0);
        made
    }
}

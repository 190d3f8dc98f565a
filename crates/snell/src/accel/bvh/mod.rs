//! A binary bounding volume hierarchy over axis-aligned boxes.
//!
//! Built top down by the binned surface area heuristic (Wald, "On fast Construction of SAH-based Bounding Volume
//! Hierarchies", IEEE RT 2007), stored depth first in 32-byte nodes. Rays are traced through the tree of eight children a
//! node that is made of it, see [`crate::accel::wide`].
//!
//! Units and spaces: boxes, points and rays share one space and its unit of length, whichever the caller chose. `t` is
//! the ray parameter; it is a length only where the direction has unit length. Boxes are stored in `f32`, rounded
//! outward.

pub(in crate::accel) mod box32;
mod build;
mod clip;
mod item;
mod partition;
mod places;
mod presplit;
mod refit;
mod reinsert;
mod split;
mod subtree;
mod validate;

#[cfg(test)]
pub(in crate::accel) mod tests;

pub use build::{BuildError, BuildOptions, BuildQuality};
pub use validate::Defect;

pub(in crate::accel) use box32::Box32;
use places::Places;
use snell_math::Bounds3;

/// The most primitives a leaf holds, and are tested at once.
pub(in crate::accel) const MAX_LEAF: usize = 8;

/// The depth of the deepest leaf, the root being at depth 0, is at most this; the builder takes care of it (see
/// [`build`]), and the traversal's stack, which holds one node a level at most, is this long.
pub(in crate::accel) const MAX_DEPTH: usize = 64;

/// A bounding volume hierarchy. Primitives are known by their place in the slice of boxes it was built from.
///
/// ```
/// use snell::accel::Bvh;
/// use snell_math::{Bounds3, Point3};
///
/// let row: Vec<Bounds3> =
///     (0..3).map(|i| Bounds3::new(Point3::new(i as f64, 0.0, 0.0), Point3::new(i as f64 + 1.0, 1.0, 1.0))).collect();
/// let bvh = Bvh::build(&row)?;
/// assert_eq!(bvh.bounds().max, Point3::new(3.0, 1.0, 1.0));
/// assert_eq!(bvh.statistics().primitives, 3);
/// # Ok::<(), snell::accel::BuildError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Bvh {
    /// Depth first: the first child of an inner node follows it at once. Empty where there is no primitive.
    pub(in crate::accel) nodes: Vec<Node>,
    /// What the leaves refer to: places in the caller's list.
    pub(in crate::accel) primitives: Vec<u32>,
    /// The largest absolute coordinate of the root's box: what the rounding error of a box test scales with.
    pub(in crate::accel) extent: f64,
    /// How many primitives are tested at once, at the cost of one.
    block: usize,
    /// The primitives that may be in several leaves, cut in pieces, each leaf having the box of its pieces.
    repeated: Places,
}

/// A node, 32 bytes so that none lies across two cache lines.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(in crate::accel) struct Node {
    /// Around everything below.
    pub(in crate::accel) bounds: Box32,
    /// Inner: how many nodes after this one the second child is. Leaf: the first of its places in `primitives`.
    pub(in crate::accel) link: u32,
    /// How many primitives the leaf has; 0 marks an inner node.
    pub(in crate::accel) count: u32,
}

const _: () = assert!(size_of::<Node>() == 32);

impl Node {
    pub(in crate::accel) fn is_leaf(&self) -> bool {
        self.count > 0
    }

    /// A leaf's places in `primitives`.
    #[inline]
    pub(in crate::accel) fn range(&self) -> std::ops::Range<usize> {
        let first = self.link as usize;
        first..first + self.count as usize
    }
}

/// What a hierarchy is like, for reports and tuning.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Statistics {
    /// How many nodes, leaves included.
    pub nodes: usize,
    /// How many leaves.
    pub leaves: usize,
    /// How many primitives the leaves refer to, those with an empty box left out, and those in several leaves once for each.
    pub primitives: usize,
    /// The depth of the deepest leaf; a lone root has depth 0.
    pub depth: usize,
    /// The memory of all that belongs to it, in bytes.
    pub bytes: usize,
    /// The expected number of steps of a random line that meets the root's box, by the surface area heuristic: a node
    /// visited counts 1, a block of primitives tested counts 1.
    pub sah_cost: f64,
}

impl Bvh {
    /// The box around all primitives, rounded outward to `f32`; empty where there is none.
    pub fn bounds(&self) -> Bounds3 {
        self.nodes.first().map_or(Bounds3::EMPTY, |root| root.bounds.to_bounds())
    }

    /// True where it holds no primitive.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The memory it takes, in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.primitives.as_slice()) + self.repeated.bytes()
    }

    /// Counts nodes and estimates the cost of a ray.
    pub fn statistics(&self) -> Statistics {
        let mut statistics = Statistics {
            nodes: self.nodes.len(),
            primitives: self.primitives.len(),
            bytes: self.bytes(),
            ..Statistics::default()
        };
        let Some(root) = self.nodes.first() else { return statistics };
        let root_area = root.bounds.half_area();
        let mut pending = vec![(0_usize, 0_usize)];
        while let Some((index, depth)) = pending.pop() {
            let node = &self.nodes[index];
            // A line that meets a box without area, as one of collinear points, meets every box inside.
            let share = node.bounds.half_area() / root_area;
            statistics.sah_cost +=
                if share.is_finite() { share } else { 1.0 } * (1 + node.range().len().div_ceil(self.block)) as f64;
            statistics.depth = statistics.depth.max(depth);
            if node.is_leaf() {
                statistics.leaves += 1;
            } else {
                pending.push((index + 1, depth + 1));
                pending.push((index + node.link as usize, depth + 1));
            }
        }
        statistics
    }
}

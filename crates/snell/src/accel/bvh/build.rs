//! Building the hierarchy, top down and in parallel; the same tree from any number of threads.
//!
//! Every set of primitives is cut where [`split`](super::split) says. What bounds the depth: with n items left at depth
//! d, the surface area heuristic may cut where d + 1 + ⌈log₂ n⌉ ≤ [`MAX_DEPTH`]; elsewhere the set is halved, which
//! takes ⌈log₂ n⌉ levels at most. So d + ⌈log₂ n⌉ ≤ [`MAX_DEPTH`] holds at every node if it holds at the root, which it
//! does for n ≤ 2³¹, and at a leaf it says d ≤ [`MAX_DEPTH`]. The recursion is no deeper either.

use rayon::prelude::*;
use snell_math::Bounds3;

use super::box32::Box32;
use super::item::{Hull, Item, hulls};
use super::partition::{partition, partition_many};
use super::places::Places;
use super::presplit::presplit;
use super::reinsert::reinserted;
use super::split::{CHUNK, Split, best_split, best_split_of_many, median_split};
use super::subtree::{Part, Subtree};
use super::{Bvh, MAX_DEPTH, MAX_LEAF, Node};

/// From how many items on the two parts of a set are built by different threads.
const PARALLEL_ITEMS: usize = 1 << 13;

/// From how many items on a set is cut in two by several threads.
const PARALLEL_PARTITION: usize = 1 << 16;

/// So many primitives may share a leaf even where they are tested one by one.
const SMALL_LEAF: usize = 4;

/// The most boxes and pieces a hierarchy is built over: with more, nodes could not be counted in 32 bits.
pub(super) const MAX_PRIMITIVES: usize = 1 << 31;

/// Why a hierarchy cannot be built. The caller is to blame, or the scene he was given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BuildError {
    /// A corner is not a number.
    #[error("the box of primitive {0} has a corner that is not a number")]
    NotANumber(u32),
    /// A side is infinite: unbounded primitives, as planes, are kept apart by the caller and tested one by one.
    #[error("the box of primitive {0} is unbounded")]
    Unbounded(u32),
    /// More boxes than 32-bit indices can serve.
    #[error("{0} primitives are too many for one hierarchy")]
    TooMany(usize),
    /// A hierarchy can only be refitted to the primitives it was built from.
    #[error("primitive {0} has a box now and had none, or the other way round")]
    Changed(u32),
}

/// How much work goes into a hierarchy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum BuildQuality {
    /// Built once, by the binned surface area heuristic.
    #[default]
    Medium,
    /// And then improved by taking parts out and putting them in again where they fit better, see
    /// `bvh/reinsert.rs`. No query has another answer; it has it sooner.
    High,
}

/// What the builder should know about how the hierarchy is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuildOptions {
    /// How many primitives are tested at once, at the cost of one, between 1 and 8: leaves are then filled up to so many.
    pub block: usize,
    /// Triangles that are large, or long and across the axes, are cut in pieces that may be in several leaves. Rays meet them
    /// sooner, but a hierarchy that is refitted loses that, and more.
    pub presplit: bool,
    /// How much work goes into it.
    pub quality: BuildQuality,
}

impl Default for BuildOptions {
    /// Primitives are tested one by one, and triangles may be cut.
    fn default() -> Self {
        Self { block: 1, presplit: true, quality: BuildQuality::Medium }
    }
}

impl Bvh {
    /// Builds a hierarchy over primitives, known from here on by their place in `bounds`. An empty box is left out: no
    /// query reports its primitive.
    ///
    /// # Errors
    /// Where a box has a NaN or infinite corner (the first such box is named), or there are more than 2³¹ boxes.
    pub fn build(bounds: &[Bounds3]) -> Result<Self, BuildError> {
        Self::over_boxes(bounds, BuildOptions::default())
    }

    /// As [`Bvh::build`], with options; boxes are not cut in pieces.
    ///
    /// # Errors
    /// As [`Bvh::build`].
    pub fn over_boxes(bounds: &[Bounds3], options: BuildOptions) -> Result<Self, BuildError> {
        if bounds.len() > MAX_PRIMITIVES {
            return Err(BuildError::TooMany(bounds.len()));
        }
        if let Some(error) = bounds.par_iter().enumerate().find_map_first(|(i, b)| refuse(i as u32, b)) {
            return Err(error);
        }
        let item = |(i, b): (usize, &Bounds3)| {
            let bounds = if b.is_empty() { Box32::EMPTY } else { Box32::enclosing(b) };
            Item::new(&bounds, i as u32)
        };
        let mut items = bounds.par_iter().enumerate().map(item).collect();
        retain_filled(&mut items);
        Ok(Self::over_items(items, options))
    }

    /// Builds a hierarchy over triangles, known from here on by their number, which is less than `count`. One with two
    /// equal corners is left out: no query reports it, as none reports one whose box is not finite.
    ///
    /// # Errors
    /// Where there are more than 2³¹ triangles.
    pub fn over_triangles(
        count: usize,
        corners: impl Fn(u32) -> [[f32; 3]; 3] + Sync,
        options: BuildOptions,
    ) -> Result<Self, BuildError> {
        if count > MAX_PRIMITIVES {
            return Err(BuildError::TooMany(count));
        }
        let item = |i: u32| {
            let corners @ [a, b, c] = corners(i);
            let bounds = Box32::around(&corners);
            let is_met = a != b && b != c && c != a && bounds.is_finite();
            Item::new(if is_met { &bounds } else { &Box32::EMPTY }, i)
        };
        let mut items: Vec<Item> = (0..count as u32).into_par_iter().map(item).collect();
        retain_filled(&mut items);
        let repeated = if options.presplit { presplit(&mut items, corners) } else { Vec::new() };
        Ok(Self { repeated: Places::new(count, &repeated), ..Self::over_items(items, options) })
    }

    /// Builds it over items, none of them empty.
    fn over_items(mut items: Vec<Item>, options: BuildOptions) -> Self {
        let block = options.block.clamp(1, MAX_LEAF);
        if items.is_empty() {
            return Self { block, ..Self::default() };
        }
        let [bounds, centers] = hulls_of_many(&items);
        // Every cut copies a set from the one list to the other.
        let mut scratch: Vec<Item> = items.par_iter().copied().collect();
        let set = Set { items: &mut items, scratch: &mut scratch, bounds, centers };
        let Subtree { mut nodes, primitives } = Builder { block }.build(set, 0).gather();
        if options.quality == BuildQuality::High
            && let Some(better) = reinserted(&nodes)
        {
            nodes = better;
        }
        Self { nodes, primitives, extent: bounds.to_box().max_abs(), block, ..Self::default() }
    }
}

/// Leaves out items without a box, which are few.
fn retain_filled(items: &mut Vec<Item>) {
    if items.par_iter().any(Item::is_empty) {
        items.retain(|item| !item.is_empty());
    }
}

pub(super) fn refuse(primitive: u32, bounds: &Bounds3) -> Option<BuildError> {
    if bounds.min.0.is_nan() || bounds.max.0.is_nan() {
        Some(BuildError::NotANumber(primitive))
    } else if bounds.is_empty() || bounds.is_finite() {
        None
    } else {
        Some(BuildError::Unbounded(primitive))
    }
}

/// The boxes of [`hulls`] by several threads.
pub(super) fn hulls_of_many(items: &[Item]) -> [Hull; 2] {
    items.par_chunks(CHUNK).map(hulls).reduce(|| [Hull::EMPTY; 2], |a, b| [a[0].union(&b[0]), a[1].union(&b[1])])
}

/// The items of one subtree.
struct Set<'a> {
    items: &'a mut [Item],
    /// As long as `items`.
    scratch: &'a mut [Item],
    /// Around the items' boxes.
    bounds: Hull,
    /// Around their half centres.
    centers: Hull,
}

impl<'a> Set<'a> {
    /// Cuts it where the heuristic says, or else in halves. The part that is more likely to be met comes first: a query for
    /// any hit, which takes the children as they come, is then more likely to find one soon (Nah and Manocha, "SATO:
    /// Surface Area Traversal Order for Shadow Ray Tracing", CGF 33(6), 2014).
    fn cut(self, split: Option<Chosen>) -> [Set<'a>; 2] {
        let Set { items, scratch, centers, .. } = self;
        let (items, scratch, count, boxes, centers) = match split {
            Some(Chosen { split, counts }) => {
                let (count, centers) = match counts {
                    None => partition(items, scratch, &split),
                    Some(counts) => partition_many(items, scratch, &split, &counts),
                };
                (scratch, items, count, split.boxes, centers)
            }
            None => {
                let half = median_split(items, &centers);
                let [[a, b], [c, d]] = [hulls(&items[..half]), hulls(&items[half..])];
                (items, scratch, half, [a, c], [b, d])
            }
        };
        let (left, right) = items.split_at_mut(count);
        let (left_scratch, right_scratch) = scratch.split_at_mut(count);
        let left = Set { items: left, scratch: left_scratch, bounds: boxes[0], centers: centers[0] };
        let right = Set { items: right, scratch: right_scratch, bounds: boxes[1], centers: centers[1] };
        if right.bounds.half_area() > left.bounds.half_area() { [right, left] } else { [left, right] }
    }
}

/// A split, and for a set that threads cut together how many items of each portion belong to the first part.
struct Chosen {
    split: Split,
    counts: Option<Vec<usize>>,
}

struct Builder {
    /// How many primitives are tested at once.
    block: usize,
}

impl Builder {
    /// Builds a subtree by several threads, if it is large.
    fn build(&self, set: Set, depth: usize) -> Part {
        if set.items.len() < PARALLEL_ITEMS {
            // Leaves are half full, or fuller.
            let leaves = 2 * set.items.len() / self.block.max(2);
            let nodes = Vec::with_capacity(2 * leaves);
            let mut subtree = Subtree { nodes, primitives: Vec::with_capacity(set.items.len()) };
            self.append(set, depth, &mut subtree);
            return Part::Whole(subtree);
        }
        let chosen = if !may_choose(set.items.len(), depth) {
            None
        } else if set.items.len() < PARALLEL_PARTITION {
            self.choose(&set)
        } else {
            best_split_of_many(set.items, &set.bounds, &set.centers, self.block)
                .map(|(split, counts)| Chosen { split, counts: Some(counts) })
        };
        let bounds = set.bounds.to_box();
        let [first, second] = set.cut(chosen);
        let (first, second) = rayon::join(|| self.build(first, depth + 1), || self.build(second, depth + 1));
        Part::join(bounds, [first, second])
    }

    /// Appends the nodes of a subtree, its root first.
    fn append(&self, set: Set, depth: usize, subtree: &mut Subtree) {
        let count = set.items.len();
        // One block costs no more than a visit to the node that would divide it.
        let chosen = if count <= self.block || !may_choose(count, depth) { None } else { self.choose(&set) };
        let cost = count.div_ceil(self.block) as f64;
        let bounds = set.bounds.to_box();
        if count <= self.block.max(SMALL_LEAF) && chosen.as_ref().is_none_or(|chosen| cost <= chosen.split.cost) {
            subtree.push_leaf(bounds, set.items.iter().map(Item::primitive));
            return;
        }
        let [first, second] = set.cut(chosen);
        let place = subtree.nodes.len();
        subtree.nodes.push(Node { bounds, link: 0, count: 0 });
        self.append(first, depth + 1, subtree);
        subtree.nodes[place].link = (subtree.nodes.len() - place) as u32;
        self.append(second, depth + 1, subtree);
    }

    fn choose(&self, set: &Set) -> Option<Chosen> {
        best_split(set.items, &set.bounds, &set.centers, self.block).map(|split| Chosen { split, counts: None })
    }
}

/// Whether a set may be cut where the heuristic says, or must be halved to keep within the depth.
fn may_choose(count: usize, depth: usize) -> bool {
    let levels_of_halving = count.next_power_of_two().trailing_zeros() as usize;
    depth + 1 + levels_of_halving <= MAX_DEPTH
}

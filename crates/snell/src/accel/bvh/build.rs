//! Building the hierarchy, top down and in parallel; the same tree from any number of threads.
//!
//! Every set of primitives is cut where [`split`](super::split) says. What bounds the depth: with n items left at depth
//! d, the surface area heuristic may cut where d + 1 + ⌈log₂ n⌉ ≤ [`MAX_DEPTH`]; elsewhere the set is halved, which
//! takes ⌈log₂ n⌉ levels at most. So d + ⌈log₂ n⌉ ≤ [`MAX_DEPTH`] holds at every node if it holds at the root, which it
//! does for n ≤ 2³¹, and at a leaf it says d ≤ [`MAX_DEPTH`]. The recursion is no deeper either.

use rayon::prelude::*;
use snell_math::Bounds3;

use super::box32::Box32;
use super::split::{Item, best_split, bounds_of, median_split};
use super::{Bvh, MAX_DEPTH, MAX_LEAF, Node};

/// From how many items on the two parts of a set are built by different threads.
const PARALLEL_ITEMS: usize = 1 << 12;

/// From how many items on a set is cut in two by several threads, and in what portions.
const PARALLEL_PARTITION: usize = 1 << 16;
const CHUNK: usize = 1 << 13;

/// The most boxes a hierarchy is built over: with more, nodes could not be counted in 32 bits.
const MAX_PRIMITIVES: usize = 1 << 31;

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
}

impl Bvh {
    /// Builds a hierarchy over primitives, known from here on by their place in `bounds`. An empty box is left out: no
    /// query reports its primitive.
    ///
    /// # Errors
    /// Where a box has a NaN or infinite corner (the first such box is named), or there are more than 2³¹ boxes.
    pub fn build(bounds: &[Bounds3]) -> Result<Self, BuildError> {
        if bounds.len() > MAX_PRIMITIVES {
            return Err(BuildError::TooMany(bounds.len()));
        }
        if let Some(error) = bounds.par_iter().enumerate().find_map_first(|(i, b)| refuse(i as u32, b)) {
            return Err(error);
        }
        let mut items: Vec<Item> = bounds
            .par_iter()
            .enumerate()
            .filter(|(_, b)| !b.is_empty())
            .map(|(i, b)| Item { bounds: Box32::enclosing(b), primitive: i as u32 })
            .collect();
        if items.is_empty() {
            return Ok(Self { nodes: Vec::new(), primitives: Vec::new(), extent: 0.0 });
        }
        let mut scratch = if items.len() < PARALLEL_PARTITION { Vec::new() } else { items.clone() };
        let mut primitives = vec![0; items.len()];
        let mut nodes = Vec::with_capacity(items.len());
        let bounds = bounds_of(&items);
        let set = Set { items: &mut items, scratch: &mut scratch, primitives: &mut primitives, first: 0 };
        build_subtree(set, bounds, 0, &mut nodes);
        nodes.shrink_to_fit();
        Ok(Self { nodes, primitives, extent: bounds.max_abs() })
    }
}

fn refuse(primitive: u32, bounds: &Bounds3) -> Option<BuildError> {
    if bounds.min.0.is_nan() || bounds.max.0.is_nan() {
        Some(BuildError::NotANumber(primitive))
    } else if bounds.is_empty() || bounds.is_finite() {
        None
    } else {
        Some(BuildError::Unbounded(primitive))
    }
}

/// The items of one subtree and where its leaves' primitives go.
struct Set<'a> {
    items: &'a mut [Item],
    /// As long as `items` while these are many enough for a parallel partition, else of any length.
    scratch: &'a mut [Item],
    primitives: &'a mut [u32],
    /// The place of `primitives[0]` in the whole list.
    first: u32,
}

impl<'a> Set<'a> {
    /// The sets of the first `count` items and of the rest.
    fn split_at(self, count: usize) -> [Set<'a>; 2] {
        let (left, right) = self.items.split_at_mut(count);
        let (left_scratch, right_scratch) = self.scratch.split_at_mut(count.min(self.scratch.len()));
        let (left_primitives, right_primitives) = self.primitives.split_at_mut(count);
        [
            Set { items: left, scratch: left_scratch, primitives: left_primitives, first: self.first },
            Set {
                items: right,
                scratch: right_scratch,
                primitives: right_primitives,
                first: self.first + count as u32,
            },
        ]
    }

    /// Brings the items for which `is_first` holds to the front; returns the set and their number.
    fn partition(self, is_first: impl Fn(&Item) -> bool + Sync) -> (Self, usize) {
        if self.items.len() < PARALLEL_PARTITION {
            let count = partition_in_place(self.items, is_first);
            (self, count)
        } else {
            let count = partition_into(self.items, self.scratch, is_first);
            (Set { items: self.scratch, scratch: self.items, ..self }, count)
        }
    }
}

/// Appends the nodes of a subtree, its root first.
fn build_subtree(set: Set, bounds: Box32, depth: usize, nodes: &mut Vec<Node>) {
    let count = set.items.len();
    let levels_of_halving = count.next_power_of_two().trailing_zeros() as usize;
    let may_choose = depth + 1 + levels_of_halving <= MAX_DEPTH;
    let split = if count > 1 && may_choose { best_split(set.items, &bounds) } else { None };
    if count <= MAX_LEAF && split.is_none_or(|split| count as f64 <= split.cost) {
        for (place, item) in set.primitives.iter_mut().zip(set.items.iter()) {
            *place = item.primitive;
        }
        set.primitives.sort_unstable();
        nodes.push(Node { bounds, link: set.first, count: count as u32 });
        return;
    }

    let (set, first_count, boxes) = match split {
        Some(split) => {
            let (set, first_count) = set.partition(|item| split.is_first(item));
            (set, first_count, split.boxes)
        }
        None => {
            let half = median_split(set.items);
            let boxes = [bounds_of(&set.items[..half]), bounds_of(&set.items[half..])];
            (set, half, boxes)
        }
    };
    let [left, right] = set.split_at(first_count);
    let [mut first, mut second] = [(left, boxes[0]), (right, boxes[1])];
    // The larger child comes first: a query for any hit, which takes the children as they come, is then more likely to
    // find one soon (Nah and Manocha, "SATO: Surface Area Traversal Order for Shadow Ray Tracing", CGF 33(6), 2014).
    if boxes[1].half_area() > boxes[0].half_area() {
        std::mem::swap(&mut first, &mut second);
    }

    let place = nodes.len();
    nodes.push(Node { bounds, link: 0, count: 0 });
    if count < PARALLEL_ITEMS {
        build_subtree(first.0, first.1, depth + 1, nodes);
        nodes[place].link = (nodes.len() - place) as u32;
        build_subtree(second.0, second.1, depth + 1, nodes);
    } else {
        // Links are relative, so that a subtree built elsewhere is appended as it is.
        let mut second_nodes = Vec::new();
        rayon::join(
            || build_subtree(first.0, first.1, depth + 1, nodes),
            || build_subtree(second.0, second.1, depth + 1, &mut second_nodes),
        );
        nodes[place].link = (nodes.len() - place) as u32;
        nodes.append(&mut second_nodes);
    }
}

fn partition_in_place(items: &mut [Item], is_first: impl Fn(&Item) -> bool) -> usize {
    let (mut low, mut high) = (0, items.len());
    while low < high {
        if is_first(&items[low]) {
            low += 1;
        } else {
            high -= 1;
            items.swap(low, high);
        }
    }
    low
}

/// Copies the items to `target`, those for which `is_first` holds to its front, portion by portion in parallel.
fn partition_into(items: &[Item], target: &mut [Item], is_first: impl Fn(&Item) -> bool + Sync) -> usize {
    let counts: Vec<usize> =
        items.par_chunks(CHUNK).map(|chunk| chunk.iter().filter(|item| is_first(item)).count()).collect();
    let first_count = counts.iter().sum();
    // Every portion gets a slice of its own in both parts.
    let (mut front, mut back) = target.split_at_mut(first_count);
    let mut jobs = Vec::with_capacity(counts.len());
    for (chunk, count) in items.chunks(CHUNK).zip(counts) {
        let (mine_in_front, front_rest) = front.split_at_mut(count);
        let (mine_in_back, back_rest) = back.split_at_mut(chunk.len() - count);
        jobs.push((chunk, mine_in_front, mine_in_back));
        (front, back) = (front_rest, back_rest);
    }
    jobs.into_par_iter().for_each(|(chunk, front, back)| {
        let (mut front, mut back) = (front.iter_mut(), back.iter_mut());
        for item in chunk {
            let place = if is_first(item) { front.next() } else { back.next() };
            if let Some(place) = place {
                *place = *item;
            }
        }
    });
    first_count
}

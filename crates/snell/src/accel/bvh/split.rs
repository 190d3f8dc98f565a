//! Where to cut a set of primitives in two: the binned surface area heuristic, with the object median to fall back on.
//!
//! Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", IEEE RT 2007; all three axes are binned at once.
//! What is chosen depends on the set alone, not on the order of its items: minima, maxima and counts are exact, and ties
//! go to the lower axis and bin.

use rayon::prelude::*;
use wide::f32x4;

use super::item::{Hull, Item};

/// The cost of visiting a node, where testing a block of primitives costs 1. Measured with triangles: half of it traces
/// 5 % faster and takes a third more memory, twice of it is 5 % slower and takes a third less.
const TRAVERSAL_COST: f64 = 1.0;

/// What a cut costs for each block more than the items of both parts together would fill, where a test of a block in the parent's box
/// costs 1. So leaves are fuller: meshes take 2 to 3 % less memory with it, and are traced as fast.
const BLOCK_COST: f64 = 1.0;

/// The most bins an axis.
const BINS: usize = 16;

/// How many bins an axis are used for so many items. Most nodes of a tree have few items, and for them fewer bins give
/// as good a tree in less time.
fn bins_for(items: usize) -> usize {
    (4 + items / 2).min(BINS)
}

/// In what portions one node's items are shared among threads.
pub(super) const CHUNK: usize = 1 << 13;

/// A way to cut a set of items in two, with the boxes of both parts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Split {
    /// The expected cost of a ray that meets the parent's box, and what blocks cost.
    pub(super) cost: f64,
    pub(super) boxes: [Hull; 2],
    axis: usize,
    /// Items of this bin and higher go to the second part.
    bin: usize,
    grid: Grid,
}

impl Split {
    /// True where the item with this half centre belongs to the first part.
    #[inline]
    pub(super) fn is_first(&self, half_center: f32x4) -> bool {
        self.grid.bins(half_center)[self.axis] < self.bin
    }
}

/// The bins: equal slabs of the box around the half centres of all items.
#[derive(Clone, Copy, Debug)]
struct Grid {
    low: f32x4,
    scale: f32x4,
}

impl Grid {
    fn new(centers: &Hull, bins: usize) -> Self {
        let extent = (centers.high - centers.low).to_array();
        // By less than one part in a million too small, so that the highest centre is in the last bin and not beyond it.
        // Where an axis has no extent, or hardly any, all items fall into its first bin.
        let scale = [0, 1, 2].map(|axis| 0.999_999 * bins as f32 / extent[axis]);
        let [x, y, z] = scale.map(|scale| if scale.is_finite() { scale } else { 0.0 });
        Self { low: centers.low, scale: f32x4::from([x, y, z, 0.0]) }
    }

    /// The bins of a half centre on the three axes; the fourth has no meaning. The remainder shows that an index is in
    /// range; it changes nothing.
    #[inline]
    fn bins(&self, half_center: f32x4) -> [usize; 4] {
        ((half_center - self.low) * self.scale).fast_trunc_int().to_array().map(|bin| bin as usize % BINS)
    }
}

/// What fell into the bins of the three axes.
#[derive(Clone)]
pub(super) struct Bins {
    boxes: [[Hull; BINS]; 3],
    counts: [[u32; BINS]; 3],
}

impl Bins {
    fn of(items: &[Item], grid: &Grid) -> Self {
        let mut bins = Self { boxes: [[Hull::EMPTY; BINS]; 3], counts: [[0; BINS]; 3] };
        for item in items {
            for (axis, bin) in grid.bins(item.half_center()).into_iter().take(3).enumerate() {
                bins.boxes[axis][bin].grow_item(item);
                bins.counts[axis][bin] += 1;
            }
        }
        bins
    }

    fn merge(mut self, other: &Self) -> Self {
        for axis in 0..3 {
            for bin in 0..BINS {
                self.boxes[axis][bin].grow(&other.boxes[axis][bin]);
                self.counts[axis][bin] += other.counts[axis][bin];
            }
        }
        self
    }

    /// How many of the items belong to the first part of a split.
    fn first_count(&self, split: &Split) -> usize {
        self.counts[split.axis][..split.bin].iter().map(|&count| count as usize).sum()
    }
}

/// The cheapest of the cuts between bins; `None` where no cut has a finite cost, as where all centres coincide or the
/// box has no area. Primitives are tested `block` at a time.
pub(super) fn best_split(items: &[Item], bounds: &Hull, centers: &Hull, block: usize) -> Option<Split> {
    let count = bins_for(items.len());
    let grid = Grid::new(centers, count);
    choose(&Bins::of(items, &grid), grid, count, items.len(), bounds.half_area(), block)
}

/// As [`best_split`] by several threads; with how many items of each portion of [`CHUNK`] items belong to the first part.
pub(super) fn best_split_of_many(
    items: &[Item],
    bounds: &Hull,
    centers: &Hull,
    block: usize,
) -> Option<(Split, Vec<usize>)> {
    let grid = Grid::new(centers, BINS);
    let portions: Vec<Bins> = items.par_chunks(CHUNK).map(|items| Bins::of(items, &grid)).collect();
    let (first, rest) = portions.split_first()?;
    let bins = rest.iter().fold(first.clone(), Bins::merge);
    let split = choose(&bins, grid, BINS, items.len(), bounds.half_area(), block)?;
    Some((split, portions.iter().map(|bins| bins.first_count(&split)).collect()))
}

fn choose(bins: &Bins, grid: Grid, count: usize, items: usize, area: f64, block: usize) -> Option<Split> {
    let mut best: Option<(f64, usize, usize)> = None;
    let mut best_boxes = [Hull::EMPTY; 2];
    for axis in 0..3 {
        let boxes = &bins.boxes[axis][..count];
        let counts = &bins.counts[axis][..count];
        if counts[0] as usize == items {
            continue;
        }
        // Suffix unions first, then one sweep from the left.
        let mut right = [Hull::EMPTY; BINS];
        let mut so_far = Hull::EMPTY;
        for (right, bounds) in right.iter_mut().zip(boxes).skip(1).rev() {
            so_far.grow(bounds);
            *right = so_far;
        }
        let mut left = Hull::EMPTY;
        let mut left_count = 0;
        for bin in 1..count {
            left.grow(&boxes[bin - 1]);
            left_count += counts[bin - 1] as usize;
            // A cut behind an empty bin is the one before it over again.
            if counts[bin - 1] == 0 || left_count == items {
                continue;
            }
            let blocks = [left_count.div_ceil(block), (items - left_count).div_ceil(block)];
            let more = (blocks[0] + blocks[1] - items.div_ceil(block)) as f64;
            let cost = left.half_area() * blocks[0] as f64
                + right[bin].half_area() * blocks[1] as f64
                + BLOCK_COST * area * more;
            if cost.is_finite() && best.is_none_or(|(best, ..)| cost < best) {
                best = Some((cost, axis, bin));
                best_boxes = [left, right[bin]];
            }
        }
    }
    let (tests, axis, bin) = best?;
    let cost = TRAVERSAL_COST + tests / area;
    cost.is_finite().then_some(Split { cost, boxes: best_boxes, axis, bin, grid })
}

/// Sorts the half with the lower centres, on the axis where they extend farthest, to the front, and returns its length.
/// Items of equal centre are told apart by their primitive, so that the halves do not depend on the order of the items.
pub(super) fn median_split(items: &mut [Item], centers: &Hull) -> usize {
    let extent = (centers.high - centers.low).to_array();
    let mut axis = 0;
    for candidate in 1..3 {
        if extent[candidate] > extent[axis] {
            axis = candidate;
        }
    }
    let half = items.len() / 2;
    let center = |item: &Item| item.half_center().to_array()[axis];
    items.select_nth_unstable_by(half, |a, b| center(a).total_cmp(&center(b)).then(a.primitive().cmp(&b.primitive())));
    half
}

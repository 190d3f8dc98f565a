//! Pieces for large and slanted triangles, before the hierarchy is built: each has a box of its own.
//!
//! Karras and Aila, "Fast Parallel Construction of High-Quality Bounding Volume Hierarchies", HPG 2013, section 4. A box
//! is mostly empty around a long triangle that lies across the axes; nodes with it overlap others, and rays meet it in
//! vain. The triangles for which that is worst are cut, more often the worse it is, along planes that cut all of space in
//! halves, quarters and so on, for along these the boxes of others are likely to be cut too. Where the triangles are small
//! and alike, as in scans, nothing is gained, and nothing is cut.
//!
//! All is in the space of the mesh. What is cut where depends on the triangles alone.

#[cfg(test)]
mod tests;

use rayon::prelude::*;
use snell_math::portable::cbrt;

use super::box32::Box32;
use super::build::{MAX_PRIMITIVES, hulls_of_many};
use super::clip::Piece;
use super::item::Item;
use super::split::CHUNK;

/// How many pieces are made at most, for each triangle there is.
const BUDGET: f64 = 0.3;

/// A triangle may be cut where the empty part of its box's surface is so many times that of the whole mesh, shared out to all
/// triangles.
const WORTHWHILE: f64 = 8.0;

/// A triangle is cut no more often than this.
const MAX_SPLITS: u64 = 1 << 12;

/// How often the factor is doubled at most, and then halved towards the one that keeps within the budget.
const DOUBLINGS: usize = 10;
const HALVINGS: usize = 4;

/// Into how many slabs the finest planes cut space, as a power of two.
const LEVELS: u32 = 20;

/// A triangle that may be cut.
struct Candidate {
    /// Its place among the items.
    place: usize,
    corners: [[f32; 3]; 3],
    /// In proportion to how often it should be cut, compared with others.
    priority: f64,
    /// How often it is worth while at most.
    most: u64,
}

impl Candidate {
    fn splits(&self, factor: f64) -> u64 {
        // The conversion saturates.
        ((factor * self.priority) as u64).min(self.most)
    }
}

/// Replaces items of triangles by those of their pieces where that pays; returns the triangles that have several, in
/// rising order of their places.
pub(super) fn presplit(items: &mut Vec<Item>, corners: impl Fn(u32) -> [[f32; 3]; 3] + Sync) -> Vec<u32> {
    let bounds = hulls_of_many(items)[0].to_box();
    let planes = Planes::new(&bounds);
    let count = items.len();
    let enough = WORTHWHILE * bounds.half_area() / count as f64;
    let candidate = |place: usize, item: &Item| {
        let around = item.bounds();
        let area = around.half_area();
        // Most triangles end here.
        if area <= enough {
            return None;
        }
        let corners = corners(item.primitive());
        let full = projected_areas(&corners);
        let empty = area - full;
        let priority = cbrt(planes.importance(&around) * empty / bounds.half_area());
        // In n pieces, the empty part is at best an n-th; but rays that meet the full part go log₂ n levels deeper for it. The
        // sum is least for about as many pieces as the empty part is larger than the full one.
        let most = ((empty / full) as u64).min(MAX_SPLITS);
        (empty > enough && most > 0 && priority.is_finite()).then_some(Candidate { place, corners, priority, most })
    };
    let candidates: Vec<Candidate> = items
        .par_chunks(CHUNK)
        .enumerate()
        .flat_map_iter(|(chunk, items)| {
            items.iter().enumerate().filter_map(move |(i, item)| candidate(chunk * CHUNK + i, item))
        })
        .collect();
    let factor = factor_for(&candidates, ((BUDGET * count as f64) as u64).min((MAX_PRIMITIVES - count) as u64));
    let cut: Vec<(usize, Vec<Item>)> = candidates
        .par_iter()
        .filter(|candidate| candidate.splits(factor) > 0)
        .map(|candidate| {
            let primitive = items[candidate.place].primitive();
            let boxes = planes.pieces(&candidate.corners, candidate.splits(factor));
            (candidate.place, boxes.iter().map(|bounds| Item::new(bounds, primitive)).collect())
        })
        .collect();
    let mut repeated = Vec::new();
    for (place, pieces) in cut {
        if let Some((first, others @ [_, ..])) = pieces.split_first() {
            repeated.push(first.primitive());
            items[place] = *first;
            items.extend_from_slice(others);
        }
    }
    repeated
}

/// Half the surface that a box around the triangle would have if it could be cut as often as one likes.
fn projected_areas([a, b, c]: &[[f32; 3]; 3]) -> f64 {
    let side = |to: &[f32; 3]| [0, 1, 2].map(|axis| f64::from(to[axis]) - f64::from(a[axis]));
    let ([x, y, z], [u, v, w]) = (side(b), side(c));
    0.5 * ((y * w - z * v).abs() + (z * u - x * w).abs() + (x * v - y * u).abs())
}

/// The largest factor to the priorities that keeps within the budget, nearly.
fn factor_for(candidates: &[Candidate], budget: u64) -> f64 {
    let fits = |factor: f64| {
        let splits = candidates.par_chunks(CHUNK).map(|chunk| chunk.iter().map(|c| c.splits(factor)).sum::<u64>());
        splits.sum::<u64>() <= budget
    };
    // What is rounded down, once for each, is all that lies between this factor and the one looked for.
    let sum: f64 = candidates.iter().map(|candidate| candidate.priority).sum();
    let mut low = budget as f64 / sum.max(f64::MIN_POSITIVE);
    let mut high = 2.0 * low;
    for _ in 0..DOUBLINGS {
        if !fits(high) {
            break;
        }
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if fits(middle) { low = middle } else { high = middle }
    }
    low
}

/// The planes that cut the box of all triangles in halves, quarters and so on.
struct Planes {
    low: [f64; 3],
    extent: [f64; 3],
}

impl Planes {
    fn new(bounds: &Box32) -> Self {
        let [low, high] = bounds.corners.map(|corner| corner.map(f64::from));
        Self { low, extent: [0, 1, 2].map(|axis| high[axis] - low[axis]) }
    }

    /// The coarsest plane between two coordinates: how coarse it is, the first being `LEVELS`, and where. `None` where even
    /// the finest are too far apart.
    fn between(&self, axis: usize, low: f64, high: f64) -> Option<(u32, f64)> {
        let slabs = f64::from(1_u32 << LEVELS);
        // The conversion saturates, and takes NaN, where there is no extent, to 0.
        let slab = |x: f64| (((x - self.low[axis]) / self.extent[axis] * slabs) as u32).min((1 << LEVELS) - 1);
        let (low, high) = (slab(low), slab(high));
        let coarseness = u32::BITS - (low ^ high).leading_zeros();
        let shift = coarseness.checked_sub(1)?;
        let last = high >> shift << shift;
        Some((coarseness, self.low[axis] + self.extent[axis] * (f64::from(last) / slabs)))
    }

    /// How much it matters to cut a box, by the coarsest plane through it: 1 for the finest, twice as much for each level.
    fn importance(&self, bounds: &Box32) -> f64 {
        let [low, high] = bounds.corners.map(|corner| corner.map(f64::from));
        let coarseness = (0..3).filter_map(|axis| self.between(axis, low[axis], high[axis])).map(|(level, _)| level);
        f64::from(1_u32 << coarseness.max().unwrap_or(0))
    }

    /// The boxes of a triangle's pieces after so many cuts, or fewer.
    fn pieces(&self, corners: &[[f32; 3]; 3], splits: u64) -> Vec<Box32> {
        let whole = Box32::around(corners);
        let mut boxes = Vec::with_capacity(splits as usize + 1);
        let mut pending = vec![(Piece::whole(corners), splits)];
        while let Some((piece, splits)) = pending.pop() {
            let plane = if splits > 0 && piece.may_be_cut() { self.best(&piece.corners_of_box()) } else { None };
            let Some((axis, plane)) = plane else {
                boxes.push(piece.bounds(&whole));
                continue;
            };
            let parts = piece.cut(axis, plane);
            let [below, above] = [0, 1].map(|i| length(&parts[i]));
            // What is left is shared out by length.
            let left = splits - 1;
            let share = ((left as f64 * (below / (below + above)) + 0.5) as u64).min(left);
            let shares = [share, left - share];
            pending.extend(parts.into_iter().zip(shares).filter(|(part, _)| !part.is_empty()));
        }
        boxes
    }

    /// Where a piece with this box is best cut; `None` where it is a point.
    fn best(&self, [low, high]: &[[f64; 3]; 2]) -> Option<(usize, f64)> {
        let extent = [0, 1, 2].map(|axis| high[axis] - low[axis]);
        let coarsest = (0..3)
            .filter_map(|axis| self.between(axis, low[axis], high[axis]).map(|(level, plane)| (level, axis, plane)))
            .filter(|&(_, axis, plane)| low[axis] < plane && plane < high[axis])
            .max_by(|a, b| a.0.cmp(&b.0).then(extent[a.1].total_cmp(&extent[b.1])));
        if let Some((_, axis, plane)) = coarsest {
            return Some((axis, plane));
        }
        let longest = (0..3).max_by(|a, b| extent[*a].total_cmp(&extent[*b]))?;
        let middle = 0.5 * (low[longest] + high[longest]);
        (low[longest] < middle && middle < high[longest]).then_some((longest, middle))
    }
}

/// The longest side of a piece's box; 0 where it has no corners.
fn length(piece: &Piece) -> f64 {
    let [low, high] = piece.corners_of_box();
    (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max)
}

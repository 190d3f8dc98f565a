//! The crossings of a line with a solid, from those of its parts.
//!
//! A line is inside a union where it is inside one part at least, inside an intersection where it is inside all, and a
//! difference is the intersection of its first part with the complements of the others. So one rule serves all three:
//! walk along the crossings of all parts in order, count the parts that hold the line, and keep the crossings where the
//! count passes the number required. The parts of a part are done before; the work that is still open is on a stack of
//! our own, the crossings of all of it in one list, each operation's at the end when its turn comes.

use std::cmp::Ordering;

use snell_math::{Bounds3, Ray};
use snell_scene::scene::CsgOperation;

use super::{CsgHit, CsgSolid, NodeKind};
use crate::shape::Crossing;
use crate::shape::rounding::gamma;

/// Crossings that differ in t by less than this, relative to t, are at the same place: rounding alone makes coincident
/// surfaces of different shapes differ by as much.
const COINCIDENCE: f64 = gamma(16);

/// Memory that [`CsgSolid::intersect`] uses again for each ray.
#[derive(Clone, Debug, Default)]
pub struct CsgScratch {
    /// What is found so far, grouped by the open operations.
    hits: Vec<CsgHit>,
    open: Vec<Open>,
    /// Those of one leaf.
    crossings: Vec<Crossing>,
}

/// An operation whose parts are being evaluated.
#[derive(Clone, Copy, Debug)]
struct Open {
    operation: CsgOperation,
    /// The child to come next, among the children of all, and the end of them.
    next: u32,
    end: u32,
    count: u32,
    /// Where its hits begin, and those of the current child.
    begin: usize,
    child_begin: usize,
    /// How many children hold the line where it begins.
    inside: i64,
}

impl CsgSolid {
    /// The nearest place with `t_min < t < t_max` where the ray goes into the solid or out of it. Does not allocate once
    /// `scratch` has grown.
    pub fn intersect(&self, ray: &Ray, t_min: f64, t_max: f64, scratch: &mut CsgScratch) -> Option<CsgHit> {
        self.sweep(ray, t_min, t_max, scratch);
        scratch.hits.iter().copied().find(|hit| hit.t > t_min && hit.t < t_max)
    }

    /// Every place where the ray's whole line, also behind its origin, passes through the surface, in increasing order of
    /// t, by turns entering and leaving. Before the first the line is inside where that one leaves.
    pub fn crossings<'a>(&self, ray: &Ray, scratch: &'a mut CsgScratch) -> &'a [CsgHit] {
        self.sweep(ray, f64::NEG_INFINITY, f64::INFINITY, scratch);
        &scratch.hits
    }

    /// Leaves in `scratch.hits` what is right between `t_min` and `t_max`; parts whose bounds the line misses there are
    /// taken as not there at all.
    fn sweep(&self, ray: &Ray, t_min: f64, t_max: f64, scratch: &mut CsgScratch) {
        scratch.hits.clear();
        scratch.open.clear();
        let mut visited = self.nodes.len() - 1;
        loop {
            let node = &self.nodes[visited];
            let mut inside = match node.kind {
                _ if !overlaps(&node.bounds, ray, t_min, t_max) => false,
                NodeKind::Leaf(leaf) => self.leaf_crossings(leaf, ray, scratch),
                NodeKind::Operation { operation, first, end } => {
                    let (begin, count) = (scratch.hits.len(), end - first);
                    visited = self.children[first as usize] as usize;
                    let next = first + 1;
                    scratch.open.push(Open { operation, next, end, count, begin, child_begin: begin, inside: 0 });
                    continue;
                }
            };
            // What is done is handed to the operation that waits for it; if that is complete, it is handed on in turn.
            loop {
                let Some(open) = scratch.open.last_mut() else { return };
                let is_first = open.end - open.next == open.count - 1;
                if open.operation == CsgOperation::Difference && !is_first {
                    inside = !inside;
                    for hit in &mut scratch.hits[open.child_begin..] {
                        hit.entering = !hit.entering;
                        hit.flipped = !hit.flipped;
                    }
                }
                open.inside += i64::from(inside);
                let nowhere = !inside && scratch.hits.len() == open.child_begin;
                if nowhere && open.operation != CsgOperation::Union {
                    // Whatever the other parts are, nothing is in all.
                    scratch.hits.truncate(open.begin);
                } else if open.next < open.end {
                    open.child_begin = scratch.hits.len();
                    visited = self.children[open.next as usize] as usize;
                    open.next += 1;
                    break;
                } else {
                    let required = if open.operation == CsgOperation::Union { 1 } else { i64::from(open.count) };
                    inside = merge(&mut scratch.hits, open.begin, open.inside, required);
                }
                scratch.open.pop();
            }
        }
    }

    /// Appends the crossings of one leaf; true where the line begins inside it.
    fn leaf_crossings(&self, index: u32, ray: &Ray, scratch: &mut CsgScratch) -> bool {
        let (shape, solid_from_traced) = self.leaves[index as usize].traced();
        let ray = solid_from_traced.map_or(*ray, |map| map.inverse_ray(ray));
        scratch.crossings.clear();
        shape.crossings(&ray, &mut scratch.crossings);
        scratch.hits.extend(scratch.crossings.iter().map(|&Crossing { t, entering, part }| CsgHit {
            t,
            leaf: index,
            part,
            flipped: false,
            entering,
        }));
        match scratch.crossings.first() {
            Some(first) => !first.entering,
            // Only along a plane a line can be inside without ever crossing the surface.
            None => !shape.bounds().is_finite() && shape.contains(ray.origin),
        }
    }
}

/// Replaces the hits from `begin` on, those of several parts, by those where the number of parts that hold the line
/// passes `required`; true where the line begins inside. Of surfaces that coincide only the change in all matters, so
/// neither walls nor gaps without thickness are left; the hit then shown is that of the lowest leaf.
fn merge(hits: &mut Vec<CsgHit>, begin: usize, inside_at_start: i64, required: i64) -> bool {
    hits[begin..].sort_unstable_by(order);
    let mut inside = inside_at_start;
    let (mut read, mut write) = (begin, begin);
    while read < hits.len() {
        let was_inside = inside >= required;
        let first = hits[read];
        let mut end = read;
        while end < hits.len() && (end == read || hits[end].t - first.t <= COINCIDENCE * first.t.abs()) {
            inside += if hits[end].entering { 1 } else { -1 };
            end += 1;
        }
        let entering = inside >= required;
        if entering != was_inside {
            let shown = hits[read..end].iter().filter(|hit| hit.entering == entering).min_by_key(|hit| hit.leaf);
            hits[write] = *shown.unwrap_or(&first);
            write += 1;
        }
        read = end;
    }
    hits.truncate(write);
    inside_at_start >= required
}

/// By place, then by leaf: total, so that the order does not depend on how parts were combined before.
fn order(a: &CsgHit, b: &CsgHit) -> Ordering {
    a.t.total_cmp(&b.t).then(a.leaf.cmp(&b.leaf)).then(a.part.cmp(&b.part))
}

/// False only where the ray between `t_min` and `t_max` surely misses the box. Slabs, as for [`crate::shape::Cuboid`],
/// with room for the rounding of the quotients.
#[inline]
fn overlaps(bounds: &Bounds3, ray: &Ray, t_min: f64, t_max: f64) -> bool {
    let (mut near, mut far) = (t_min, t_max);
    for axis in 0..3 {
        let (o, d) = (ray.origin[axis], ray.direction[axis]);
        if d == 0.0 {
            if o < bounds.min[axis] || o > bounds.max[axis] {
                return false;
            }
            continue;
        }
        let (low, high) = ((bounds.min[axis] - o) / d, (bounds.max[axis] - o) / d);
        near = near.max(low.min(high));
        far = far.min(low.max(high));
    }
    near <= far || near - far <= gamma(8) * near.abs().min(far.abs()).min(f64::MAX)
}

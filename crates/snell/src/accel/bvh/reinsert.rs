//! A better tree out of a built one: parts are taken out and put back where they make the others' boxes smaller.
//!
//! Meister and Bittner, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization", CGF 37(2), 2018: the best new place of
//! each of many nodes is searched for at once, in the tree as it is, by branch and bound. Unlike there, no node is locked:
//! the moves are made one after the other, those of most gain first, each is measured by the boxes that it really changes,
//! and one that gains nothing any more is taken back. So the tree depends on nothing but the tree before, and the cost of a
//! ray by the surface area heuristic never rises.
//!
//! Leaves stay as they are, with their boxes; what changes is what stands above them.

use std::cmp::Ordering;

use rayon::prelude::*;

use super::box32::Box32;
use super::{MAX_DEPTH, Node};

/// How often places are searched for.
const PASSES: usize = 8;

/// Of how many nodes in each pass: those with the largest boxes, one in so many.
const SHARE: usize = 2;

/// Passes end when one gains less than this part of the cost.
const WORTHWHILE: f64 = 2e-3;

/// At how many nodes one search looks at most. Of good trees it seldom looks at a tenth of that; of boxes that all lie within each
/// other it would look at all.
const MOST_LOOKED_AT: usize = 4096;

/// What a move must gain at least, in parts of the root's surface: more than what rounding can feign.
const LEAST_GAIN: f64 = 1e-12;

/// No node.
const NONE: u32 = u32::MAX;

/// A node that can be moved.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
struct Knot {
    bounds: Box32,
    /// A leaf has [`NONE`] and its place in the list of nodes that was given.
    children: [u32; 2],
}

impl Knot {
    fn is_leaf(&self) -> bool {
        self.children[0] == NONE
    }
}

/// A node that could be moved: next to which other, and what that gains.
#[derive(Clone, Copy)]
struct Move {
    node: u32,
    beside: u32,
    gain: f64,
}

/// What is left of a search: a node beside or below which the place may be, and the gain before the boxes on the way to it grow.
type Pending = Vec<(f64, u32)>;

/// The tree while it changes. The root has the number 0 for good.
struct Tree {
    knots: Vec<Knot>,
    parents: Vec<u32>,
}

/// The better tree, depth first; `None` where it would not be better, or deeper than [`MAX_DEPTH`].
pub(super) fn reinserted(nodes: &[Node]) -> Option<Vec<Node>> {
    let mut tree = Tree::new(nodes);
    let root_area = tree.area(0);
    if nodes.len() < 7 || !(root_area > 0.0 && root_area.is_finite()) {
        return None;
    }
    let mut cost = tree.cost();
    let mut gained = false;
    for _ in 0..PASSES {
        let gain = tree.pass(LEAST_GAIN * root_area);
        gained |= gain > 0.0;
        if gain < WORTHWHILE * cost {
            break;
        }
        cost -= gain;
    }
    if gained { tree.depth_first(nodes) } else { None }
}

impl Tree {
    fn new(nodes: &[Node]) -> Self {
        let mut parents = vec![NONE; nodes.len()];
        let mut knots = Vec::with_capacity(nodes.len());
        for (place, node) in nodes.iter().enumerate() {
            let own = place as u32;
            let children = if node.is_leaf() { [NONE, own] } else { [own + 1, own + node.link] };
            if !node.is_leaf() {
                for child in children {
                    parents[child as usize] = own;
                }
            }
            knots.push(Knot { bounds: node.bounds, children });
        }
        Self { knots, parents }
    }

    fn bounds(&self, node: u32) -> &Box32 {
        &self.knots[node as usize].bounds
    }

    fn area(&self, node: u32) -> f64 {
        self.bounds(node).half_area()
    }

    fn parent(&self, node: u32) -> u32 {
        self.parents[node as usize]
    }

    fn sibling(&self, node: u32) -> u32 {
        let [a, b] = self.knots[self.parent(node) as usize].children;
        if a == node { b } else { a }
    }

    /// The surface of all inner nodes: all of the cost that moves can change.
    fn cost(&self) -> f64 {
        self.knots.iter().filter(|knot| !knot.is_leaf()).map(|knot| knot.bounds.half_area()).sum()
    }

    /// Searches places for the largest nodes and moves them; returns the gain.
    fn pass(&mut self, least: f64) -> f64 {
        // A child of the root stays: without it the root would be gone.
        let mut candidates: Vec<(f64, u32)> = (1..self.knots.len() as u32)
            .into_par_iter()
            .filter(|&node| self.parent(node) != 0)
            .map(|node| (self.area(node), node))
            .collect();
        let larger = |a: &(f64, u32), b: &(f64, u32)| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1));
        let count = candidates.len().div_ceil(SHARE);
        if count < candidates.len() {
            candidates.select_nth_unstable_by(count, larger);
            candidates.truncate(count);
        }
        let tree = &*self;
        let mut moves: Vec<Move> = candidates
            .par_iter()
            .map_init(Vec::new, |pending, &(_, node)| tree.best_move(node, least, pending))
            .flatten()
            .collect();
        moves.par_sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.node.cmp(&b.node)));
        moves.into_iter().map(|one| self.make(one, least)).sum()
    }

    /// Where a node that is no child of the root is best put, if that gains more than `least`.
    ///
    /// Outward from the node, the trees beside the way to the root are searched. To take the node out makes its parent
    /// superfluous and the boxes on the way smaller, up to where the node is put in again; from there down to its
    /// place they grow. No place below a node can gain more than what is left there, less the node's own surface.
    fn best_move(&self, node: u32, least: f64, pending: &mut Pending) -> Option<Move> {
        let bounds = *self.bounds(node);
        let own_area = bounds.half_area();
        let mut best = Move { node, beside: NONE, gain: least };
        let mut pivot = self.parent(node);
        let mut gain = self.area(pivot);
        // What is left of the pivot without the node.
        let mut rest = *self.bounds(self.sibling(node));
        pending.clear();
        pending.push((gain, self.sibling(node)));
        let mut looked_at = 0;
        loop {
            while let Some((gain, place)) = pending.pop().filter(|_| looked_at <= MOST_LOOKED_AT) {
                if gain - own_area <= best.gain {
                    continue;
                }
                looked_at += 1;
                let knot = &self.knots[place as usize];
                let with = knot.bounds.union(&bounds).half_area();
                if gain - with > best.gain {
                    best = Move { node, beside: place, gain: gain - with };
                }
                if !knot.is_leaf() {
                    let below = gain - (with - knot.bounds.half_area());
                    if below - own_area > best.gain {
                        pending.extend(knot.children.map(|child| (below, child)));
                    }
                }
            }
            let above = self.parent(pivot);
            if above == NONE || looked_at > MOST_LOOKED_AT {
                break;
            }
            let beside = self.sibling(pivot);
            // Up to the parent of the pivot, all has shrunk; the parent itself would have the node in it again.
            pending.push((gain, beside));
            rest = rest.union(self.bounds(beside));
            pivot = above;
            gain += self.area(pivot) - rest.half_area();
            // Beside the pivot itself, where a new node would have the box that it has now.
            if gain - self.area(pivot) > best.gain && pivot != 0 {
                best = Move { node, beside: pivot, gain: gain - self.area(pivot) };
            }
        }
        (best.beside != NONE).then_some(best)
    }

    /// Makes a move, if it still can be made and gains more than `least`; returns the gain.
    fn make(&mut self, Move { node, beside, .. }: Move, least: f64) -> f64 {
        let (parent, sibling) = (self.parent(node), self.sibling(node));
        if parent == 0 || beside == 0 || beside == parent || beside == sibling || self.is_within(beside, node) {
            return 0.0;
        }
        let gain = self.take_out(node) + self.put_in(node, beside);
        if gain > least {
            return gain;
        }
        self.take_out(node);
        self.put_in(node, sibling);
        0.0
    }

    /// Whether a node is another one or somewhere below it, or too deep to tell.
    fn is_within(&self, mut node: u32, outer: u32) -> bool {
        for _ in 0..MAX_DEPTH {
            if node == NONE {
                return false;
            }
            if node == outer {
                return true;
            }
            node = self.parent(node);
        }
        true
    }

    /// Takes a node out of the tree, and with it its parent, whose place its sibling takes; returns by how much less surface there is.
    fn take_out(&mut self, node: u32) -> f64 {
        let (parent, sibling) = (self.parent(node), self.sibling(node));
        let above = self.parent(parent);
        self.replace(above, parent, sibling);
        self.area(parent) + self.refit(above)
    }

    /// Puts a node that was taken out beside another, below its old parent; returns by how much less surface there is.
    fn put_in(&mut self, node: u32, beside: u32) -> f64 {
        let (parent, above) = (self.parent(node), self.parent(beside));
        self.replace(above, beside, parent);
        self.parents[beside as usize] = parent;
        let bounds = self.bounds(beside).union(self.bounds(node));
        self.knots[parent as usize] = Knot { bounds, children: [beside, node] };
        self.refit(above) - bounds.half_area()
    }

    /// Makes another node the child of a node.
    fn replace(&mut self, parent: u32, old: u32, new: u32) {
        let children = &mut self.knots[parent as usize].children;
        children[usize::from(children[0] != old)] = new;
        self.parents[new as usize] = parent;
    }

    /// Fits the boxes from a node up to the root; returns by how much less surface there is.
    fn refit(&mut self, mut node: u32) -> f64 {
        let mut less = 0.0;
        while node != NONE {
            let [a, b] = self.knots[node as usize].children;
            let bounds = self.bounds(a).union(self.bounds(b));
            if bounds == *self.bounds(node) {
                break;
            }
            less += self.area(node) - bounds.half_area();
            self.knots[node as usize].bounds = bounds;
            node = self.parent(node);
        }
        less
    }

    /// The nodes depth first, the larger child first, as the builder has them; `None` where a leaf is too deep.
    fn depth_first(&self, before: &[Node]) -> Option<Vec<Node>> {
        let mut nodes: Vec<Node> = Vec::with_capacity(before.len());
        // A node, its depth, and the place of the parent whose second child it is.
        let mut pending = vec![(0, 0, None)];
        while let Some((node, depth, parent)) = pending.pop() {
            if depth > MAX_DEPTH {
                return None;
            }
            let place = nodes.len();
            if let Some(parent) = parent {
                let parent: usize = parent;
                nodes[parent].link = (place - parent) as u32;
            }
            let knot: &Knot = &self.knots[node as usize];
            if knot.is_leaf() {
                nodes.push(before[knot.children[1] as usize]);
                continue;
            }
            nodes.push(Node { bounds: knot.bounds, link: 0, count: 0 });
            let [a, b] = knot.children;
            let order = self.area(b).total_cmp(&self.area(a));
            let [first, second] = if order == Ordering::Greater { [b, a] } else { [a, b] };
            pending.extend([(second, depth + 1, Some(place)), (first, depth + 1, None)]);
        }
        Some(nodes)
    }
}

#[cfg(test)]
mod tests {
    use snell_math::{Bounds3, Point3, Vector3};

    use super::*;
    use crate::accel::bvh::tests::{cube, nasty_inputs};
    use crate::accel::random::Random;
    use crate::accel::{BuildOptions, BuildQuality, Bvh};

    const HIGH: BuildOptions = BuildOptions { block: 1, presplit: true, quality: BuildQuality::High };

    /// Boxes that cuts along planes serve badly: long, and lying across each other.
    fn sticks(count: usize) -> Vec<Bounds3> {
        let mut random = Random(31);
        let stick = |i: usize, random: &mut Random| {
            let half = [0, 1, 2].map(|axis| if axis == i % 3 { 0.4 * random.number().abs() } else { 0.004 });
            let (center, half) = (random.point(), Vector3::from(half));
            Bounds3::new(center - half, center + half)
        };
        (0..count).map(|i| stick(i, &mut random)).collect()
    }

    #[test]
    fn nasty_inputs_give_valid_trees_that_are_no_worse() {
        for (name, bounds) in nasty_inputs() {
            let before = Bvh::build(&bounds).expect(name);
            let after = Bvh::over_boxes(&bounds, HIGH).expect(name);
            assert_eq!(after.validate(&bounds), Ok(()), "{name}");
            let [before, after] = [before, after].map(|bvh| bvh.statistics());
            assert!(after.sah_cost <= before.sah_cost * (1.0 + 1e-12), "{name}: {before:?} {after:?}");
            assert_eq!((after.nodes, after.primitives), (before.nodes, before.primitives), "{name}");
        }
    }

    #[test]
    fn what_overlaps_is_put_apart() {
        let bounds = sticks(5000);
        let before = Bvh::build(&bounds).expect("finite boxes").statistics().sah_cost;
        let bvh = Bvh::over_boxes(&bounds, HIGH).expect("finite boxes");
        let after = bvh.statistics().sah_cost;
        assert!(after < 0.9 * before, "{before} {after}");
        assert_eq!(bvh.validate(&bounds), Ok(()));
    }

    #[test]
    fn the_same_tree_from_any_number_of_threads() {
        // Quantised, so that there are ties in abundance.
        let mut random = Random(32);
        let quantised = |v: Vector3| Point3::from(v.to_array().map(|x| (x * 20.0).round()));
        let mut bounds: Vec<Bounds3> = (0..20_000).map(|_| cube(quantised(random.vector()), 1.0)).collect();
        bounds.extend(sticks(5000));
        let build = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| Bvh::over_boxes(&bounds, HIGH)).expect("finite boxes")
        };
        let one = build(1);
        assert!(one != Bvh::build(&bounds).expect("finite boxes"), "the twin: something is moved");
        assert!(one == build(2) && one == build(7));
    }

    #[test]
    fn a_move_gains_what_the_search_promised_and_can_be_taken_back() {
        let bounds = sticks(300);
        let bvh = Bvh::build(&bounds).expect("finite boxes");
        let mut tree = Tree::new(&bvh.nodes);
        let mut made = 0;
        for node in 1..bvh.nodes.len() as u32 {
            let before = tree.cost();
            let Some(one) = tree.best_move(node, 1e-9, &mut Vec::new()).filter(|_| tree.parent(node) != 0) else {
                continue;
            };
            let old_sibling = tree.sibling(node);
            let gain = tree.make(one, 1e-9);
            assert!((gain - one.gain).abs() < 1e-9 * before, "promised {}, gained {gain}", one.gain);
            assert!((before - tree.cost() - gain).abs() < 1e-9 * before);
            made += 1;
            // What gains less than it must is taken back.
            let (sibling, cost) = (tree.sibling(node), tree.cost());
            assert_eq!(tree.make(Move { beside: old_sibling, ..one }, f64::INFINITY), 0.0);
            assert_eq!(tree.sibling(node), sibling);
            assert!((tree.cost() - cost).abs() < 1e-9 * before);
        }
        assert!(made > 50, "only {made} moves");
    }

    #[test]
    fn nothing_goes_below_itself() {
        let bounds = sticks(100);
        let bvh = Bvh::build(&bounds).expect("finite boxes");
        let mut tree = Tree::new(&bvh.nodes);
        let node =
            (1..bvh.nodes.len() as u32).find(|&node| tree.parent(node) != 0 && !tree.knots[node as usize].is_leaf());
        let node = node.expect("inner nodes");
        let below = tree.knots[node as usize].children[1];
        assert_eq!(tree.make(Move { node, beside: below, gain: 1.0 }, f64::NEG_INFINITY), 0.0);
        assert!(tree.depth_first(&bvh.nodes).is_some_and(|nodes| nodes.len() == bvh.nodes.len()));
    }
}

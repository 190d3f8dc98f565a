//! Making the wide tree out of a binary one, by several threads; the same tree from any number of them.
//!
//! Which nodes of the binary tree become nodes of the wide one is chosen so that the sum of their surfaces, and with it the number
//! of nodes that a ray opens, is least: Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
//! BVHs", HPG 2017, section 3.1. Leaves are what they are: the largest parts whose primitives fit into one.

use rayon::prelude::*;

use super::shared::{NONE, mark_shared};
use super::{Box32, LEAF, WIDTH, WideNode, WideTree, memory};
use crate::accel::bvh::{Bvh, MAX_LEAF, Node};

const _: () = assert!(MAX_LEAF <= WIDTH);

/// Parts of the binary tree with fewer nodes are the work of one thread.
const PORTION: usize = 1 << 12;

/// More primitives than a leaf holds.
const MANY: u32 = WIDTH as u32 + 1;

/// What is known of the binary tree's nodes.
struct Parts<'a> {
    bvh: &'a Bvh,
    /// How many primitives are below each node, or [`MANY`].
    below: Vec<u8>,
    /// How many children a wide node takes from the first of two parts: for each node three bits for each number of trees, from 1
    /// to 8, that its part may become at most: how many of them are for the first child's part; 0 where it is best left one.
    shares: Vec<u32>,
}

/// The least cost of making a part of the binary tree into at most 1, 2, ... 7 trees.
type Costs = [f64; WIDTH - 1];

/// Wide nodes, depth first, and their leaves, by their places here.
#[derive(Default)]
struct Made {
    nodes: Vec<WideNode>,
    leaves: Vec<[u32; WIDTH]>,
}

/// A piece of the wide tree, in depth-first order: one node near the root, or all of a smaller part.
struct Piece {
    /// The piece and lane that refer to it; none for the root.
    parent: Option<(usize, usize)>,
    /// The root of a part of the binary tree that is still to be made.
    whole: Option<usize>,
    made: Made,
}

/// A child of a wide node.
#[derive(Clone, Copy)]
struct Child {
    bounds: Box32,
    area: f64,
    /// Its place in the binary tree, unless it is a leaf.
    inner: Option<usize>,
    entries: [u32; WIDTH],
    /// How many entries there are.
    count: usize,
}

impl WideTree {
    /// The wide tree over the primitives of a binary one, and its leaves: numbers of primitives, each once in a leaf, in
    /// ascending order and filled up with [`NONE`]; marked where other leaves have them too.
    pub fn new(bvh: &Bvh) -> (Self, Vec<[u32; WIDTH]>) {
        let Some(root) = bvh.nodes.first() else {
            return (Self { nodes: Vec::new(), bounds: Box32::EMPTY, extent: 0.0 }, Vec::new());
        };
        let parts = Parts::new(bvh);
        let mut pieces = parts.pieces();
        pieces.par_iter_mut().for_each(|piece| {
            if let Some(binary) = piece.whole {
                parts.make(binary, &mut piece.made);
            }
        });
        let (nodes, mut leaves) = gather(&pieces);
        let count = bvh.primitives.par_iter().max().map_or(0, |last| *last as usize + 1);
        mark_shared(&mut leaves, count);
        (Self { nodes, bounds: root.bounds, extent: root.bounds.max_abs() }, leaves)
    }
}

/// All pieces in one list of nodes and one of leaves.
fn gather(pieces: &[Piece]) -> (Vec<WideNode>, Vec<[u32; WIDTH]>) {
    let firsts: Vec<[usize; 2]> = pieces
        .iter()
        .scan([0; 2], |next, piece| {
            let first = *next;
            *next = [first[0] + piece.made.nodes.len(), first[1] + piece.made.leaves.len()];
            Some(first)
        })
        .collect();
    let total = |of: fn(&Made) -> usize| pieces.iter().map(|piece| of(&piece.made)).sum();
    let count = total(|made| made.nodes.len());
    let mut nodes = memory::roomy(count);
    nodes.resize(count, WideNode::EMPTY);
    let mut leaves = vec![[NONE; WIDTH]; total(|made| made.leaves.len())];
    // Every piece gets a slice of its own of both.
    let (mut free_nodes, mut free_leaves) = (nodes.as_mut_slice(), leaves.as_mut_slice());
    let mut jobs = Vec::with_capacity(pieces.len());
    for (piece, first) in pieces.iter().zip(&firsts) {
        let (own_nodes, rest_of_nodes) = free_nodes.split_at_mut(piece.made.nodes.len());
        let (own_leaves, rest_of_leaves) = free_leaves.split_at_mut(piece.made.leaves.len());
        jobs.push((&piece.made, first, own_nodes, own_leaves));
        (free_nodes, free_leaves) = (rest_of_nodes, rest_of_leaves);
    }
    jobs.into_par_iter().for_each(|(made, first, nodes, leaves)| {
        leaves.copy_from_slice(&made.leaves);
        for (place, node) in nodes.iter_mut().zip(&made.nodes) {
            *place = *node;
            for (lane, child) in place.children.iter_mut().enumerate().filter(|(lane, _)| node.has(*lane)) {
                *child += first[usize::from(node.children[lane] & LEAF != 0)] as u32;
            }
        }
    });
    for (piece, first) in pieces.iter().zip(&firsts) {
        if let Some((parent, lane)) = piece.parent {
            nodes[firsts[parent][0]].children[lane] = first[0] as u32;
        }
    }
    (nodes, leaves)
}

impl<'a> Parts<'a> {
    fn new(bvh: &'a Bvh) -> Self {
        let count = bvh.nodes.len();
        let (mut below, mut shares) = (vec![0; count], vec![0; count]);
        evaluate(&bvh.nodes, &mut below, &mut shares);
        Self { bvh, below, shares }
    }

    /// The pieces of the wide tree, of which those that are larger than one node are still to be made.
    fn pieces(&self) -> Vec<Piece> {
        let mut pieces: Vec<Piece> = Vec::new();
        // With how many nodes are below each, itself included.
        let mut pending = vec![(0, self.bvh.nodes.len(), None)];
        while let Some((binary, size, parent)) = pending.pop() {
            let place = pieces.len();
            let mut made = Made::default();
            let mut whole = Some(binary);
            if size >= PORTION {
                whole = None;
                let children = self.add(binary, &mut made);
                // The first child comes next, so it is pushed last.
                for (lane, child) in children.into_iter().enumerate().rev() {
                    if let Some(child) = child {
                        pending.push((child, self.size_below(binary, size, child), Some((place, lane))));
                    }
                }
            }
            pieces.push(Piece { parent, whole, made });
        }
        pieces
    }

    /// How many nodes a part of the binary tree has, which is below a node of so many.
    fn size_below(&self, mut node: usize, mut size: usize, part: usize) -> usize {
        while node < part {
            let second = node + self.bvh.nodes[node].link as usize;
            (node, size) = if part < second { (node + 1, second - node - 1) } else { (second, node + size - second) };
        }
        size
    }

    /// Makes a part of the binary tree into wide nodes.
    fn make(&self, binary: usize, made: &mut Made) {
        let mut pending: Vec<(usize, Option<(usize, usize)>)> = vec![(binary, None)];
        while let Some((binary, parent)) = pending.pop() {
            let place = made.nodes.len();
            if let Some((parent, lane)) = parent {
                made.nodes[parent].children[lane] = place as u32;
            }
            let children = self.add(binary, made);
            for (lane, child) in children.into_iter().enumerate().rev() {
                if let Some(child) = child {
                    pending.push((child, Some((place, lane))));
                }
            }
        }
    }

    /// Adds the wide node that takes a binary node's place, and its leaves; returns the lanes' parts of the binary tree that are
    /// to be nodes.
    fn add(&self, binary: usize, made: &mut Made) -> [Option<usize>; WIDTH] {
        let mut inner = [None; WIDTH];
        let mut node = WideNode::EMPTY;
        let (children, count) = self.open(binary);
        for (lane, child) in children[..count].iter().enumerate() {
            node.set(lane, &child.bounds);
            inner[lane] = child.inner;
            if child.inner.is_none() {
                node.children[lane] = LEAF | made.leaves.len() as u32;
                made.leaves.push(child.entries);
            }
        }
        made.nodes.push(node);
        inner
    }

    /// Of so many trees at most that a node's part becomes, how many are for the first child's; 0 where it becomes one.
    fn share(&self, node: usize, trees: usize) -> usize {
        (self.shares[node] >> (3 * (trees - 1)) & 0b111) as usize
    }

    /// Whether the part of the binary tree below a node becomes one leaf.
    fn is_leaf(&self, binary: usize) -> bool {
        usize::from(self.below[binary]) <= WIDTH
    }

    /// The children of the wide node that takes a binary node's place, in order of falling surface, and their number.
    fn open(&self, binary: usize) -> ([Child; WIDTH], usize) {
        let (mut children, mut count) = ([Child::NONE; WIDTH], 0);
        // Parts that become so many trees at most.
        let mut pending = [(binary, WIDTH); WIDTH];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (part, trees) = pending[height];
            let share = self.share(part, trees);
            if share > 0 {
                let [first, second] = [part + 1, part + self.bvh.nodes[part].link as usize];
                pending[height] = (second, trees - share);
                pending[height + 1] = (first, share);
                height += 2;
                continue;
            }
            children[count] = self.child(part);
            count += 1;
        }
        // By insertion: those of equal surface stay in their order.
        for end in 1..count {
            let mut place = end;
            while place > 0 && children[place - 1].area < children[place].area {
                children.swap(place - 1, place);
                place -= 1;
            }
        }
        (children, count)
    }

    fn child(&self, binary: usize) -> Child {
        let bounds = self.bvh.nodes[binary].bounds;
        let mut child = Child { bounds, area: bounds.half_area(), inner: Some(binary), ..Child::NONE };
        if self.is_leaf(binary) {
            child.inner = None;
            // The nodes below follow in depth-first order.
            let (mut next, mut open) = (binary, 1);
            while open > 0 {
                let node = &self.bvh.nodes[next];
                if node.is_leaf() {
                    for &primitive in &self.bvh.primitives[node.range()] {
                        child.entries[child.count] = primitive;
                        child.count += 1;
                    }
                    open -= 1;
                } else {
                    open += 1;
                }
                next += 1;
            }
            child.settle();
        }
        child
    }
}

impl Child {
    const NONE: Self = Self { bounds: Box32::EMPTY, area: 0.0, inner: None, entries: [NONE; WIDTH], count: 0 };

    /// Puts a leaf's entries in order, and one that is there twice there once.
    fn settle(&mut self) {
        self.entries.sort_unstable();
        let mut kept = 0;
        for place in 0..self.count {
            let entry = self.entries[place];
            if kept == 0 || entry != self.entries[kept - 1] {
                self.entries[kept] = entry;
                kept += 1;
            }
        }
        self.entries[kept..].fill(NONE);
        self.count = kept;
    }
}

/// Counts what is below each node of a part of the binary tree, of which these are the nodes, and finds the shares. Returns what
/// the part costs.
fn evaluate(nodes: &[Node], below: &mut [u8], shares: &mut [u32]) -> Costs {
    let Some((root, rest)) = nodes.split_first() else { return Costs::default() };
    if nodes.len() < PORTION {
        // From the last node to the first, so that what the children cost stands on a stack, the first one's on top.
        let mut costs: Vec<Costs> = Vec::new();
        for (place, node) in nodes.iter().enumerate().rev() {
            let children = if node.is_leaf() { None } else { costs.pop().zip(costs.pop()) };
            let count = match children {
                None => node.count,
                Some(_) => u32::from(below[place + 1]) + u32::from(below[place + node.link as usize]),
            };
            below[place] = count.min(MANY) as u8;
            let (share, cost) = weigh(node, count, children);
            shares[place] = share;
            costs.push(cost);
        }
        return costs.pop().unwrap_or_default();
    }
    let (root_below, below) = below.split_at_mut(1);
    let (root_shares, shares) = shares.split_at_mut(1);
    let middle = root.link as usize - 1;
    let (first_nodes, second_nodes) = rest.split_at(middle);
    let (first_below, second_below) = below.split_at_mut(middle);
    let (first_shares, second_shares) = shares.split_at_mut(middle);
    let (first, second) = rayon::join(
        || evaluate(first_nodes, first_below, first_shares),
        || evaluate(second_nodes, second_below, second_shares),
    );
    let count = u32::from(first_below[0]) + u32::from(second_below[0]);
    root_below[0] = count.min(MANY) as u8;
    let cost;
    (root_shares[0], cost) = weigh(root, count, Some((first, second)));
    cost
}

/// The shares of one node with so many primitives below, and what it costs, by what its children do.
fn weigh(node: &Node, below: u32, children: Option<(Costs, Costs)>) -> (u32, Costs) {
    let Some((first, second)) = children.filter(|_| below >= MANY) else {
        // All leaves are there whatever is chosen, so they cost nothing here.
        return (0, Costs::default());
    };
    // Of so many trees, the second child's part the rest: the least cost, and how many for the first.
    let apart = |trees: usize| {
        let mut best = (f64::INFINITY, 1);
        for of_first in 1..trees {
            let cost = first[of_first - 1] + second[trees - of_first - 1];
            if cost < best.0 {
                best = (cost, of_first as u32);
            }
        }
        best
    };
    // A wide node's own children are apart in any case.
    let (cost_of_children, share_of_children) = apart(WIDTH);
    let mut cost = [node.bounds.half_area() + cost_of_children; WIDTH - 1];
    let mut share = 0;
    let mut shares = share_of_children << (3 * (WIDTH - 1));
    for trees in 2..WIDTH {
        let (cost_apart, share_apart) = apart(trees);
        if cost_apart < cost[trees - 2] {
            share = share_apart;
        }
        cost[trees - 1] = cost[trees - 2].min(cost_apart);
        shares |= share << (3 * (trees - 1));
    }
    (shares, cost)
}

#[cfg(test)]
mod tests {
    use snell_math::{Bounds3, Vector3};

    use super::*;
    use crate::accel::random::Random;

    /// Boxes of all sizes, here and there.
    fn boxes(seed: u64, count: usize) -> Vec<Bounds3> {
        let mut random = Random(seed);
        let mut one = || {
            let (center, shrink) = (random.point(), random.number().abs());
            let size = shrink * shrink * shrink * shrink;
            let half = Vector3::new(0.1 + random.number().abs(), 0.1 + random.number().abs(), 0.1) * size;
            Bounds3::new(center - half, center + half)
        };
        (0..count).map(|_| one()).collect()
    }

    /// The sum of the surfaces of the wide tree's nodes.
    fn surfaces(tree: &WideTree) -> f64 {
        let below = |node: &WideNode| -> f64 {
            let inner = (0..WIDTH).filter(|&lane| node.has(lane) && node.children[lane] & LEAF == 0);
            inner.map(|lane| node.bounds(lane).half_area()).sum()
        };
        tree.bounds.half_area() + tree.nodes.iter().map(below).sum::<f64>()
    }

    /// The least sum for a part that becomes at most so many trees: by trying everything.
    fn least(bvh: &Bvh, below: &[u8], node: usize, trees: usize) -> f64 {
        if usize::from(below[node]) <= WIDTH {
            return 0.0;
        }
        let [first, second] = [node + 1, node + bvh.nodes[node].link as usize];
        let apart = |trees: usize| {
            let cost = |share| least(bvh, below, first, share) + least(bvh, below, second, trees - share);
            (1..trees).map(cost).fold(f64::INFINITY, f64::min)
        };
        apart(trees).min(bvh.nodes[node].bounds.half_area() + apart(WIDTH))
    }

    #[test]
    fn no_other_choice_of_nodes_has_less_surface() {
        let mut gains = 0;
        for seed in 1..=12 {
            let bounds = boxes(seed, 90);
            let bvh = Bvh::build(&bounds).expect("finite boxes");
            let below = Parts::new(&bvh).below;
            let (tree, _) = WideTree::new(&bvh);
            let (found, expected) = (surfaces(&tree), least(&bvh, &below, 0, 1));
            assert!((found - expected).abs() <= 1e-9 * expected, "{seed}: {found}, not {expected}");
            // The twin: opening the largest box until there are eight is not always best.
            let greedy = greedy_surfaces(&bvh, &below, 0);
            assert!(greedy >= expected * (1.0 - 1e-9));
            gains += usize::from(greedy > expected * 1.001);
        }
        assert!(gains > 0);
    }

    #[test]
    fn pieces_come_together_as_one_thread_would_have_made_them() {
        let bvh = Bvh::build(&boxes(1, 30_000)).expect("finite boxes");
        let parts = Parts::new(&bvh);
        let pieces = parts.pieces();
        assert!(pieces.iter().filter(|piece| piece.whole.is_some()).count() > 20, "{}", pieces.len());
        let mut whole = Made::default();
        parts.make(0, &mut whole);
        let (tree, leaves) = WideTree::new(&bvh);
        assert!(tree.nodes == whole.nodes && leaves == whole.leaves);
        // The twin: pieces in another order are another tree.
        let mut moved = pieces;
        for piece in &mut moved {
            if let Some(binary) = piece.whole {
                parts.make(binary, &mut piece.made);
            }
        }
        assert!(gather(&moved).0 == whole.nodes);
        moved.iter_mut().find(|piece| piece.made.nodes.len() > 1).expect("a piece").made.nodes.reverse();
        assert!(gather(&moved).0 != whole.nodes);
    }

    fn greedy_surfaces(bvh: &Bvh, below: &[u8], node: usize) -> f64 {
        let area = |node: &usize| bvh.nodes[*node].bounds.half_area();
        let mut children = vec![node];
        while children.len() < WIDTH {
            let inner = children.iter().enumerate().filter(|(_, child)| usize::from(below[**child]) > WIDTH);
            let Some((place, &largest)) = inner.max_by(|(_, a), (_, b)| area(a).total_cmp(&area(b))) else { break };
            children[place] = largest + 1;
            children.push(largest + bvh.nodes[largest].link as usize);
        }
        let inner = children.iter().filter(|child| usize::from(below[**child]) > WIDTH);
        area(&node) + inner.map(|child| greedy_surfaces(bvh, below, *child)).sum::<f64>()
    }
}

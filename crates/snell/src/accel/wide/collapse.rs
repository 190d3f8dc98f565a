//! Making the wide tree out of a binary one.
//!
//! Which nodes of the binary tree become nodes of the wide one is chosen so that the sum of their surfaces, and with it the number
//! of nodes that a ray opens, is least: Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
//! BVHs", HPG 2017, section 3.1. Leaves are what they are: the largest parts whose primitives fit into one.

use super::shared::{NONE, mark_shared};
use super::{Box32, LEAF, WIDTH, WideNode, WideTree, memory};
use crate::accel::bvh::{Bvh, MAX_LEAF};

const _: () = assert!(MAX_LEAF <= WIDTH);

/// Where a wide node is still to be made.
struct Pending {
    /// A place in the binary tree.
    binary: usize,
    /// The wide node and lane that refer to it; none for the root.
    parent: Option<(usize, usize)>,
}

/// The leaf's entries while it is made, and all leaves so far.
struct Leaves<'a> {
    bvh: &'a Bvh,
    /// How many primitives are below each node of the binary tree, or more than [`WIDTH`].
    below: Vec<u8>,
    cuts: Cuts,
    leaves: Vec<[u32; WIDTH]>,
}

/// How many children a wide node takes from the first of two parts of the binary tree.
struct Cuts {
    /// For each node three bits for each number of trees, from 1 to 8, that its part may become at most: how many of them are for the
    /// first child's part; 0 where it is best left one.
    shares: Vec<u32>,
}

/// The least cost of making a part of the binary tree into at most 1, 2, ... 7 trees.
type Costs = [f64; WIDTH - 1];

impl WideTree {
    /// The wide tree over the primitives of a binary one, and its leaves: numbers of primitives, each once in a leaf, in
    /// ascending order and filled up with [`NONE`]; marked where other leaves have them too.
    pub fn new(bvh: &Bvh) -> (Self, Vec<[u32; WIDTH]>) {
        let Some(root) = bvh.nodes.first() else {
            return (Self { nodes: Vec::new(), bounds: Box32::EMPTY, extent: 0.0 }, Vec::new());
        };
        let mut nodes: Vec<WideNode> = Vec::with_capacity(bvh.nodes.len() / 8 + 1);
        let below = count_below(bvh);
        let cuts = Cuts::new(bvh, &below);
        let mut leaves = Leaves { bvh, below, cuts, leaves: Vec::with_capacity(bvh.primitives.len() / 4) };
        let mut pending = vec![Pending { binary: 0, parent: None }];
        while let Some(Pending { binary, parent }) = pending.pop() {
            let place = nodes.len();
            if let Some((parent, lane)) = parent {
                nodes[parent].children[lane] = place as u32;
            }
            let (children, count) = leaves.open(binary);
            let mut node = WideNode::EMPTY;
            for (lane, &child) in children[..count].iter().enumerate() {
                node.set(lane, &bvh.nodes[child].bounds);
                if leaves.is_leaf(child) {
                    node.children[lane] = LEAF | leaves.push(child);
                }
            }
            nodes.push(node);
            // The first child's node comes next, so it is pushed last.
            for (lane, &child) in children[..count].iter().enumerate().rev() {
                if !leaves.is_leaf(child) {
                    pending.push(Pending { binary: child, parent: Some((place, lane)) });
                }
            }
        }
        let mut leaves = leaves.leaves;
        let count = bvh.primitives.iter().max().map_or(0, |last| *last as usize + 1);
        mark_shared(&mut leaves, count);
        (Self { nodes: memory::settled(nodes), bounds: root.bounds, extent: root.bounds.max_abs() }, leaves)
    }
}

/// From the last node to the first, so that children come before their parents.
fn count_below(bvh: &Bvh) -> Vec<u8> {
    const MANY: u32 = WIDTH as u32 + 1;
    let mut below = vec![0_u8; bvh.nodes.len()];
    for (place, node) in bvh.nodes.iter().enumerate().rev() {
        let count = match node.count {
            0 => u32::from(below[place + 1]) + u32::from(below[place + node.link as usize]),
            count => count,
        };
        below[place] = count.min(MANY) as u8;
    }
    below
}

impl Cuts {
    /// From the last node to the first, so that what the children cost stands on a stack, the first one's on top.
    fn new(bvh: &Bvh, below: &[u8]) -> Self {
        let mut shares = vec![0_u32; bvh.nodes.len()];
        let mut costs: Vec<Costs> = Vec::new();
        for (place, node) in bvh.nodes.iter().enumerate().rev() {
            let children = if node.is_leaf() { None } else { costs.pop().zip(costs.pop()) };
            let Some((first, second)) = children.filter(|_| usize::from(below[place]) > WIDTH) else {
                // All leaves are there whatever is chosen, so they cost nothing here.
                costs.push([0.0; WIDTH - 1]);
                continue;
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
            shares[place] = share_of_children << (3 * (WIDTH - 1));
            for trees in 2..WIDTH {
                let (cost_apart, share_apart) = apart(trees);
                if cost_apart < cost[trees - 2] {
                    share = share_apart;
                }
                cost[trees - 1] = cost[trees - 2].min(cost_apart);
                shares[place] |= share << (3 * (trees - 1));
            }
            costs.push(cost);
        }
        Self { shares }
    }

    /// Of so many trees at most that a node's part becomes, how many are for the first child's; 0 where it becomes one.
    fn share(&self, node: usize, trees: usize) -> usize {
        (self.shares[node] >> (3 * (trees - 1)) & 0b111) as usize
    }
}

impl Leaves<'_> {
    /// Whether the part of the binary tree below a node becomes one leaf.
    fn is_leaf(&self, binary: usize) -> bool {
        usize::from(self.below[binary]) <= WIDTH
    }

    /// The children of the wide node that takes a binary node's place, in order of falling surface, and their number.
    fn open(&self, binary: usize) -> ([usize; WIDTH], usize) {
        let (mut children, mut areas, mut count) = ([binary; WIDTH], [0.0; WIDTH], 0);
        // Parts that become so many trees at most.
        let mut pending = [(binary, WIDTH); WIDTH];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (part, trees) = pending[height];
            let share = self.cuts.share(part, trees);
            if share > 0 {
                let [first, second] = [part + 1, part + self.bvh.nodes[part].link as usize];
                pending[height] = (second, trees - share);
                pending[height + 1] = (first, share);
                height += 2;
                continue;
            }
            let area = self.bvh.nodes[part].bounds.half_area();
            let mut place = count;
            while place > 0 && areas[place - 1] < area {
                (areas[place], children[place]) = (areas[place - 1], children[place - 1]);
                place -= 1;
            }
            (areas[place], children[place]) = (area, part);
            count += 1;
        }
        (children, count)
    }

    /// Makes a leaf of all primitives below a node; returns its place.
    fn push(&mut self, binary: usize) -> u32 {
        let mut entries = [NONE; WIDTH];
        let mut count = 0;
        // The nodes below follow in depth-first order.
        let (mut next, mut open) = (binary, 1);
        while open > 0 {
            let node = &self.bvh.nodes[next];
            if node.is_leaf() {
                for &primitive in &self.bvh.primitives[node.range()] {
                    entries[count] = primitive;
                    count += 1;
                }
                open -= 1;
            } else {
                open += 1;
            }
            next += 1;
        }
        entries.sort_unstable();
        // One that is here twice needs to be here once.
        let mut kept = 0;
        for place in 0..WIDTH {
            let entry = entries[place];
            if kept == 0 || entry != entries[kept - 1] {
                entries[kept] = entry;
                kept += 1;
            }
        }
        entries[kept..].fill(NONE);
        self.leaves.push(entries);
        (self.leaves.len() - 1) as u32
    }
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
            let below = count_below(&bvh);
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

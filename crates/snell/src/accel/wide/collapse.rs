//! Making the wide tree out of a binary one.

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
    leaves: Vec<[u32; WIDTH]>,
}

impl WideTree {
    /// The wide tree over the primitives of a binary one, and its leaves: numbers of primitives, each once in a leaf, in
    /// ascending order and filled up with [`NONE`]; marked where other leaves have them too.
    pub fn new(bvh: &Bvh) -> (Self, Vec<[u32; WIDTH]>) {
        let Some(root) = bvh.nodes.first() else {
            return (Self { nodes: Vec::new(), bounds: Box32::EMPTY, extent: 0.0 }, Vec::new());
        };
        let mut nodes: Vec<WideNode> = Vec::with_capacity(bvh.nodes.len() / 8 + 1);
        let mut leaves = Leaves { bvh, below: count_below(bvh), leaves: Vec::with_capacity(bvh.primitives.len() / 4) };
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

impl Leaves<'_> {
    /// Whether the part of the binary tree below a node becomes one leaf.
    fn is_leaf(&self, binary: usize) -> bool {
        usize::from(self.below[binary]) <= WIDTH
    }

    /// The children of the wide node that takes a binary node's place, in order of falling surface, and their number.
    fn open(&self, binary: usize) -> ([usize; WIDTH], usize) {
        let mut children = [binary; WIDTH];
        let mut areas = [0.0; WIDTH];
        let mut count = 1;
        areas[0] = self.bvh.nodes[binary].bounds.half_area();
        while count < WIDTH {
            let inner = (0..count).filter(|lane| !self.is_leaf(children[*lane]));
            let Some(largest) = inner.reduce(|best, lane| if areas[lane] > areas[best] { lane } else { best }) else {
                break;
            };
            let opened = children[largest];
            let pair = [opened + 1, opened + self.bvh.nodes[opened].link as usize];
            let pair_areas = pair.map(|child| self.bvh.nodes[child].bounds.half_area());
            (children[largest], areas[largest]) = (pair[0], pair_areas[0]);
            (children[count], areas[count]) = (pair[1], pair_areas[1]);
            count += 1;
        }
        for lane in 1..count {
            let mut place = lane;
            while place > 0 && areas[place - 1] < areas[place] {
                areas.swap(place - 1, place);
                children.swap(place - 1, place);
                place -= 1;
            }
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

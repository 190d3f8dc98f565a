//! Nodes on their way into the hierarchy: subtrees that were built apart, and how they come together.
//!
//! A thread writes the nodes of a small subtree one after the other into a list of its own. When all are there, their
//! numbers say where each belongs, and every one is copied to its place once, by several threads.

use super::Node;
use super::box32::Box32;

/// The nodes of a subtree, its root first, and what its leaves refer to, counted from its own first reference.
#[derive(Debug, Default)]
pub(super) struct Subtree {
    pub(super) nodes: Vec<Node>,
    pub(super) primitives: Vec<u32>,
}

impl Subtree {
    /// Adds a leaf; a primitive that is named twice, by two of its pieces, is in it once.
    pub(super) fn push_leaf(&mut self, bounds: Box32, primitives: impl Iterator<Item = u32>) {
        let first = self.primitives.len();
        self.primitives.extend(primitives);
        self.primitives[first..].sort_unstable();
        let mut end = first;
        for place in first..self.primitives.len() {
            if place == first || self.primitives[place] != self.primitives[end - 1] {
                self.primitives[end] = self.primitives[place];
                end += 1;
            }
        }
        self.primitives.truncate(end);
        self.nodes.push(Node { bounds, link: first as u32, count: (end - first) as u32 });
    }
}

/// A subtree in one list or in several.
#[derive(Debug)]
pub(super) enum Part {
    Whole(Subtree),
    Joined(Box<Joint>),
}

/// An inner node over two parts.
#[derive(Debug)]
pub(super) struct Joint {
    bounds: Box32,
    parts: [Part; 2],
    nodes: usize,
    primitives: usize,
}

impl Part {
    pub(super) fn join(bounds: Box32, parts: [Part; 2]) -> Self {
        let [[a, b], [c, d]] = [0, 1].map(|i| parts[i].sizes());
        Self::Joined(Box::new(Joint { bounds, parts, nodes: 1 + a + c, primitives: b + d }))
    }

    /// How many nodes and references there are.
    fn sizes(&self) -> [usize; 2] {
        match self {
            Self::Whole(subtree) => [subtree.nodes.len(), subtree.primitives.len()],
            Self::Joined(joint) => [joint.nodes, joint.primitives],
        }
    }

    /// All in one list, depth first.
    pub(super) fn gather(self) -> Subtree {
        if let Self::Whole(subtree) = self {
            return subtree;
        }
        let [nodes, primitives] = self.sizes();
        let nothing = Node { bounds: Box32::EMPTY, link: 0, count: 0 };
        let mut all = Subtree { nodes: vec![nothing; nodes], primitives: vec![0; primitives] };
        self.place(&mut all.nodes, &mut all.primitives, 0);
        all
    }

    /// Copies all to its place; `first` is that of `primitives[0]` in the whole list.
    fn place(self, nodes: &mut [Node], primitives: &mut [u32], first: u32) {
        match self {
            Self::Whole(subtree) => {
                primitives.copy_from_slice(&subtree.primitives);
                for (place, node) in nodes.iter_mut().zip(subtree.nodes) {
                    // Links between nodes are relative.
                    let link = if node.is_leaf() { node.link + first } else { node.link };
                    *place = Node { link, ..node };
                }
            }
            Self::Joined(joint) => {
                let Joint { bounds, parts: [left, right], .. } = *joint;
                let [left_nodes, left_primitives] = left.sizes();
                let Some((root, nodes)) = nodes.split_first_mut() else { return };
                *root = Node { bounds, link: 1 + left_nodes as u32, count: 0 };
                let (nodes, right_nodes) = nodes.split_at_mut(left_nodes);
                let (primitives, right_primitives) = primitives.split_at_mut(left_primitives);
                rayon::join(
                    || left.place(nodes, primitives, first),
                    || right.place(right_nodes, right_primitives, first + left_primitives as u32),
                );
            }
        }
    }
}

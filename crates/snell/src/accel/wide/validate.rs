//! Checking a wide tree and its leaves against the boxes of the primitives.

use snell_math::Bounds3;

use super::shared::{NONE, SHARED, number};
use super::{Box32, LEAF, STACK, WIDTH, WideBvh, WideTree};

/// What is wrong with a wide tree. Nodes and leaves are named by their places.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WideDefect {
    /// A child is not where depth-first order puts it, or beyond the end.
    #[error("node {0} is not the next in depth-first order")]
    OutOfOrder(usize),
    /// Nodes or leaves that cannot be reached from the root.
    #[error("only {reached} of {total} nodes and leaves can be reached")]
    Unreachable {
        /// How many can.
        reached: usize,
        /// How many there are.
        total: usize,
    },
    /// A leaf is deeper than the traversal's stack allows.
    #[error("node {0} is too deep")]
    TooDeep(usize),
    /// A lane without a child is in front of one with a child, or has a box that can be entered.
    #[error("node {0} has a gap between its children")]
    Gap(usize),
    /// A child's box is not inside its parent's.
    #[error("the box of child {lane} of node {node} is not inside its parent's")]
    OutsideParent {
        /// The node.
        node: usize,
        /// The child.
        lane: usize,
    },
    /// A leaf has a primitive twice, none at all, a gap, or is not in ascending order.
    #[error("the entries of leaf {0} are not in order")]
    LeafOrder(usize),
    /// A primitive's box is not inside that of its leaf, or, where several leaves have it, of them together.
    #[error("the box of primitive {0} is not inside its leaves")]
    OutsideLeaf(u32),
    /// A primitive that several leaves have is not marked everywhere, or one is marked that only one leaf has.
    #[error("primitive {0} is not marked right")]
    Mark(u32),
    /// A primitive that is empty or unknown is in a leaf.
    #[error("primitive {0} is in a leaf where it should not be")]
    Unexpected(u32),
    /// A primitive is in no leaf.
    #[error("primitive {0} is in no leaf")]
    Missing(u32),
    /// The coordinate that the margins of box tests are made from is not the largest one, or a child is outside of all.
    #[error("the extent is not that of the root's box")]
    Extent,
}

/// What is found of a primitive.
#[derive(Clone, Copy)]
struct Found {
    leaves: u32,
    marked: u32,
    around: Box32,
}

impl WideBvh {
    /// Checks that this is a hierarchy over just these boxes.
    ///
    /// # Errors
    /// The first defect found.
    pub fn validate(&self, bounds: &[Bounds3]) -> Result<(), WideDefect> {
        self.tree.validate(&self.leaves, bounds)
    }
}

impl WideTree {
    /// Checks that this is a tree over just these leaves, and they have just the primitives of these boxes, each in one
    /// leaf, or in several and marked.
    ///
    /// # Errors
    /// The first defect found.
    pub fn validate(&self, leaves: &[[u32; WIDTH]], bounds: &[Bounds3]) -> Result<(), WideDefect> {
        let mut found = vec![Found { leaves: 0, marked: 0, around: Box32::EMPTY }; bounds.len()];
        let (mut nodes_reached, mut leaves_reached) = (0, 0);
        if !self.nodes.is_empty() {
            let mut pending = vec![(0_usize, 0_usize, self.bounds)];
            while let Some((place, depth, parent)) = pending.pop() {
                // The tree is walked in depth-first order, so this holds for every node, and the walk must end.
                if place != nodes_reached || place >= self.nodes.len() {
                    return Err(WideDefect::OutOfOrder(place));
                }
                nodes_reached += 1;
                if (depth + 1) * (WIDTH - 1) > STACK {
                    return Err(WideDefect::TooDeep(place));
                }
                let node = &self.nodes[place];
                let count = (0..WIDTH).take_while(|lane| node.has(*lane)).count();
                if count == 0 || (count..WIDTH).any(|lane| node.bounds(lane) != Box32::EMPTY) {
                    return Err(WideDefect::Gap(place));
                }
                for lane in (0..count).rev() {
                    let around = node.bounds(lane);
                    if !parent.contains_box(&around) {
                        return Err(WideDefect::OutsideParent { node: place, lane });
                    }
                    let child = node.children[lane];
                    if child & LEAF == 0 {
                        pending.push((child as usize, depth + 1, around));
                    } else {
                        let leaf = (child & !LEAF) as usize;
                        let entries = leaves.get(leaf).ok_or(WideDefect::OutOfOrder(place))?;
                        check_leaf(leaf, entries, &around, &mut found)?;
                        leaves_reached += 1;
                    }
                }
            }
        }
        let (reached, total) = (nodes_reached + leaves_reached, self.nodes.len() + leaves.len());
        if reached != total {
            return Err(WideDefect::Unreachable { reached, total });
        }
        for ((found, bounds), primitive) in found.iter().zip(bounds).zip(0..) {
            match found.leaves {
                0 if bounds.is_empty() => continue,
                0 => return Err(WideDefect::Missing(primitive)),
                _ if bounds.is_empty() => return Err(WideDefect::Unexpected(primitive)),
                count if found.marked != if count == 1 { 0 } else { count } => return Err(WideDefect::Mark(primitive)),
                _ => {}
            }
            let around = found.around.to_bounds();
            if !(around.contains(bounds.min) && around.contains(bounds.max)) {
                return Err(WideDefect::OutsideLeaf(primitive));
            }
        }
        if self.extent != self.bounds.max_abs() && !self.nodes.is_empty() {
            return Err(WideDefect::Extent);
        }
        Ok(())
    }
}

fn check_leaf(leaf: usize, entries: &[u32; WIDTH], around: &Box32, found: &mut [Found]) -> Result<(), WideDefect> {
    let count = entries.iter().take_while(|entry| **entry != NONE).count();
    let in_order = entries[..count].is_sorted_by(|a, b| number(*a) < number(*b));
    if count == 0 || !in_order || entries[count..].iter().any(|entry| *entry != NONE) {
        return Err(WideDefect::LeafOrder(leaf));
    }
    for &entry in &entries[..count] {
        let found = found.get_mut(number(entry) as usize).ok_or(WideDefect::Unexpected(number(entry)))?;
        found.leaves += 1;
        found.marked += u32::from(entry & SHARED != 0);
        found.around.grow(around);
    }
    Ok(())
}

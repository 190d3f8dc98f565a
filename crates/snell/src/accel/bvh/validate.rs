//! Checking a hierarchy against the boxes it was built from.

use snell_math::Bounds3;

use super::{Bvh, MAX_DEPTH, MAX_LEAF};

/// What is wrong with a hierarchy. Nodes are named by their place in depth-first order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Defect {
    /// A child is not where depth-first order puts it, or beyond the end.
    #[error("node {0} is not the next in depth-first order")]
    OutOfOrder(usize),
    /// Nodes that cannot be reached from the root.
    #[error("only {reached} of {total} nodes can be reached")]
    Unreachable {
        /// How many can.
        reached: usize,
        /// How many there are.
        total: usize,
    },
    /// A leaf is deeper than the traversal's stack allows.
    #[error("node {0} is too deep")]
    TooDeep(usize),
    /// A leaf refers to too many primitives, or beyond the end of the list.
    #[error("leaf {0} has a wrong number of primitives")]
    LeafSize(usize),
    /// A child's box is not inside its parent's.
    #[error("the box of node {0} is not inside its parent's")]
    OutsideParent(usize),
    /// A primitive's box is not inside its leaf's.
    #[error("the box of primitive {primitive} is not inside that of leaf {leaf}")]
    OutsideLeaf {
        /// The primitive.
        primitive: u32,
        /// Its leaf.
        leaf: usize,
    },
    /// A primitive is in two leaves, or one that is empty or unknown is in a leaf.
    #[error("primitive {0} is in a leaf where it should not be")]
    Unexpected(u32),
    /// A primitive is in no leaf.
    #[error("primitive {0} is in no leaf")]
    Missing(u32),
    /// The coordinate that the margins of box tests are made from is not the largest one of the root's box.
    #[error("the extent is not that of the root's box")]
    Extent,
}

impl Bvh {
    /// Checks that this is a hierarchy over just these boxes: every primitive once, boxes inside boxes, leaves and depth
    /// within their limits, every node reached.
    ///
    /// # Errors
    /// The first defect found.
    pub fn validate(&self, bounds: &[Bounds3]) -> Result<(), Defect> {
        // A primitive still to be found. The empty ones are not in the tree.
        let mut expected: Vec<bool> = bounds.iter().map(|b| !b.is_empty()).collect();
        if let Some(root) = self.nodes.first() {
            let mut reached = 0;
            let mut pending = vec![(0_usize, 0_usize, root.bounds)];
            while let Some((index, depth, parent)) = pending.pop() {
                // The tree is walked in depth-first order, so this holds for every node, and the walk must end.
                if index != reached || index >= self.nodes.len() {
                    return Err(Defect::OutOfOrder(index));
                }
                reached += 1;
                let node = &self.nodes[index];
                if !parent.contains_box(&node.bounds) {
                    return Err(Defect::OutsideParent(index));
                }
                if depth > MAX_DEPTH {
                    return Err(Defect::TooDeep(index));
                }
                if node.is_leaf() {
                    self.validate_leaf(index, bounds, &mut expected)?;
                } else {
                    pending.push((index.saturating_add(node.link as usize), depth + 1, node.bounds));
                    pending.push((index + 1, depth + 1, node.bounds));
                }
            }
            if reached != self.nodes.len() {
                return Err(Defect::Unreachable { reached, total: self.nodes.len() });
            }
            if self.extent != root.bounds.max_abs() {
                return Err(Defect::Extent);
            }
        }
        match expected.iter().position(|&missing| missing) {
            Some(primitive) => Err(Defect::Missing(primitive as u32)),
            None => Ok(()),
        }
    }

    fn validate_leaf(&self, leaf: usize, bounds: &[Bounds3], expected: &mut [bool]) -> Result<(), Defect> {
        let node = &self.nodes[leaf];
        let range = node.range();
        if range.len() > MAX_LEAF || range.end > self.primitives.len() {
            return Err(Defect::LeafSize(leaf));
        }
        let around = node.bounds.to_bounds();
        for &primitive in &self.primitives[range] {
            match expected.get_mut(primitive as usize) {
                Some(expected) if *expected => *expected = false,
                _ => return Err(Defect::Unexpected(primitive)),
            }
            let inner = &bounds[primitive as usize];
            if !(around.contains(inner.min) && around.contains(inner.max)) {
                return Err(Defect::OutsideLeaf { primitive, leaf });
            }
        }
        Ok(())
    }
}

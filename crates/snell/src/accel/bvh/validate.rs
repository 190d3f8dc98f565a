//! Checking a hierarchy against the boxes it was built from.

use snell_math::{Bounds3, Point3};

use super::box32::Box32;
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
    /// A primitive is in two leaves, and is not one in pieces, or is twice in one; or one that is empty or unknown is in a leaf.
    #[error("primitive {0} is in a leaf where it should not be")]
    Unexpected(u32),
    /// A primitive is in no leaf.
    #[error("primitive {0} is in no leaf")]
    Missing(u32),
    /// The leaves of a triangle in pieces leave some of it out.
    #[error("the leaves of triangle {0} do not cover it")]
    Uncovered(u32),
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
        self.validate_nodes()?;
        self.validate_primitives(
            |primitive| bounds.get(primitive as usize).is_some_and(|b| !b.is_empty()),
            bounds.len(),
            |primitive, leaves| {
                let inner = &bounds[primitive as usize];
                match leaves {
                    [(leaf, around)] if !around.contains(inner.min) || !around.contains(inner.max) => {
                        Err(Defect::OutsideLeaf { primitive, leaf: *leaf })
                    }
                    [_] => Ok(()),
                    _ => Err(Defect::Unexpected(primitive)),
                }
            },
        )
    }

    /// Checks that this is a hierarchy over just these triangles: every one that can be met is in a leaf whose box has it
    /// inside, or in several that together cover it; and the rest as [`Bvh::validate`] does.
    ///
    /// # Errors
    /// The first defect found.
    pub fn validate_triangles(&self, count: usize, corners: impl Fn(u32) -> [[f32; 3]; 3]) -> Result<(), Defect> {
        self.validate_nodes()?;
        let can_be_met = |triangle: u32| {
            let corners @ [a, b, c] = corners(triangle);
            a != b && b != c && c != a && Box32::around(&corners).is_finite()
        };
        self.validate_primitives(
            |triangle| (triangle as usize) < count && can_be_met(triangle),
            count,
            |triangle, leaves| {
                let corners = corners(triangle).map(|corner| Point3::from(corner.map(f64::from)));
                match leaves {
                    [(leaf, around)] if !corners.iter().all(|corner| around.contains(*corner)) => {
                        Err(Defect::OutsideLeaf { primitive: triangle, leaf: *leaf })
                    }
                    [_, _, ..] if !self.repeated.contains(triangle) => Err(Defect::Unexpected(triangle)),
                    leaves if !is_covered(corners, leaves, COVER_LEVELS) => Err(Defect::Uncovered(triangle)),
                    _ => Ok(()),
                }
            },
        )
    }

    fn validate_nodes(&self) -> Result<(), Defect> {
        let Some(root) = self.nodes.first() else { return Ok(()) };
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
                if node.range().len() > MAX_LEAF || node.range().end > self.primitives.len() {
                    return Err(Defect::LeafSize(index));
                }
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
        Ok(())
    }

    /// Checks that just the expected primitives are in leaves; `check` is given each with its leaves, by number and box.
    fn validate_primitives(
        &self,
        is_expected: impl Fn(u32) -> bool,
        count: usize,
        check: impl Fn(u32, &[(usize, Bounds3)]) -> Result<(), Defect>,
    ) -> Result<(), Defect> {
        let mut found: Vec<(u32, usize)> = Vec::with_capacity(self.primitives.len());
        for (leaf, node) in self.nodes.iter().enumerate().filter(|(_, node)| node.is_leaf()) {
            found.extend(self.primitives[node.range()].iter().map(|&primitive| (primitive, leaf)));
        }
        found.sort_unstable();
        if let Some((unexpected, _)) = found.iter().find(|(primitive, _)| !is_expected(*primitive)) {
            return Err(Defect::Unexpected(*unexpected));
        }
        if let Some(pair) = found.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(Defect::Unexpected(pair[0].0));
        }
        let mut found = found.chunk_by(|a, b| a.0 == b.0);
        for primitive in (0..count as u32).filter(|primitive| is_expected(*primitive)) {
            // Nothing else is found, so what is not the next is missing.
            let leaves = found.next().filter(|leaves| leaves[0].0 == primitive).ok_or(Defect::Missing(primitive))?;
            let leaves: Vec<(usize, Bounds3)> =
                leaves.iter().map(|&(_, leaf)| (leaf, self.nodes[leaf].bounds.to_bounds())).collect();
            check(primitive, &leaves)?;
        }
        Ok(())
    }
}

/// How often a triangle in pieces is divided until each part is in one box, or else its middle is.
const COVER_LEVELS: usize = 7;

/// True where every point of a triangle is in one of the boxes, as far as one can see by dividing it.
fn is_covered(corners: [Point3; 3], boxes: &[(usize, Bounds3)], levels: usize) -> bool {
    let around = corners.iter().fold(Bounds3::EMPTY, |around, corner| around.including(*corner));
    let near: Vec<(usize, Bounds3)> =
        boxes.iter().copied().filter(|(_, b)| !b.intersection(&around).is_empty()).collect();
    if near.iter().any(|(_, b)| b.contains(around.min) && b.contains(around.max)) {
        return true;
    }
    let [a, b, c] = corners;
    let [ab, bc, ca] = [a.lerp(b, 0.5), b.lerp(c, 0.5), c.lerp(a, 0.5)];
    if levels == 0 {
        return near.iter().any(|(_, b)| b.contains(ab.lerp(c, 1.0 / 3.0)));
    }
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]].into_iter().all(|part| is_covered(part, &near, levels - 1))
}

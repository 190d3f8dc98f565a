//! Constructive solid geometry: solids made of solids by union, intersection and difference.
//!
//! Along a line every solid is a set of intervals, and the operations are those of sets on the line: Roth, "Ray Casting for
//! Modeling Solids", Computer Graphics and Image Processing 18(2), 1982; Glassner (ed.), An Introduction to Ray Tracing
//! (1989), section 2.6. The intervals of the parts are kept as crossings and merged by one sweep per operation, see
//! `sweep.rs`. Neither building nor tracing recurses, so trees may be of any depth.
//!
//! Everything is in the solid's space but for shapes with a transform of their own, and in units of length there.

mod sweep;
#[cfg(test)]
mod tests;

use snell_math::{Bounds3, Point3, Ray, Transform};
use snell_scene::scene::CsgOperation;

use crate::shape::rounding::gamma;
use crate::shape::{Shape, SurfacePoint};
pub use sweep::CsgScratch;

/// One node of a solid to be compiled.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "nodes of this kind live only while a solid is being built")]
pub enum CsgNode {
    /// A solid shape.
    Leaf {
        /// The shape.
        shape: Shape,
        /// From the shape's space to the solid's; the same where absent.
        solid_from_leaf: Option<Transform>,
        /// Whatever the caller wants to know a hit by, as its material.
        tag: u32,
    },
    /// Several nodes combined.
    Operation {
        /// How.
        operation: CsgOperation,
        /// Which nodes, at least one, each earlier in the list than this one.
        children: Vec<u32>,
    },
}

/// Why nodes are no solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CsgError {
    /// There is no node, or more than can be numbered.
    #[error("a solid needs from 1 to 2^32 - 1 nodes")]
    NodeCount,
    /// A shape without inside.
    #[error("the shape of node {0} has no inside")]
    NotSolid(u32),
    /// An operation on nothing.
    #[error("the operation of node {0} has no parts")]
    NoParts(u32),
    /// A child that does not come before its parent, or is the child of two.
    #[error("node {child} cannot be a part of node {node}")]
    Child {
        /// The parent.
        node: u32,
        /// The child.
        child: u32,
    },
    /// A node other than the last that is part of nothing.
    #[error("node {0} is part of nothing")]
    Unused(u32),
}

/// Where a ray passes through the surface of a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CsgHit {
    /// The ray parameter.
    pub t: f64,
    /// Which leaf's surface it is, in the order of the leaves among the nodes.
    pub leaf: u32,
    /// Which part of the leaf's shape.
    pub part: u32,
    /// The leaf is taken away there: its inside is the solid's outside.
    pub flipped: bool,
    /// The ray goes into the solid here.
    pub entering: bool,
}

/// A solid, compiled for tracing.
///
/// ```
/// use snell::csg::{CsgNode, CsgScratch, CsgSolid};
/// use snell::math::{Point3, Ray, Vector3};
/// use snell::scene::scene::CsgOperation;
/// use snell::shape::{Shape, Sphere};
/// // A bubble: a ball without its inside.
/// let ball = |radius, tag| CsgNode::Leaf {
///     shape: Shape::Sphere(Sphere::new(Point3::ORIGIN, radius)),
///     solid_from_leaf: None,
///     tag,
/// };
/// let difference = CsgNode::Operation { operation: CsgOperation::Difference, children: vec![0, 1] };
/// let bubble = CsgSolid::new(vec![ball(1.0, 7), ball(0.5, 8), difference])?;
/// let ray = Ray::new(Point3::ORIGIN, Vector3::X);
/// let hit = bubble.intersect(&ray, 0.0, f64::INFINITY, &mut CsgScratch::default()).expect("from inside");
/// assert_eq!((hit.t, bubble.tag(hit.leaf), hit.flipped, hit.entering), (0.5, 8, true, true));
/// // The normal points out of the glass, towards the centre.
/// assert_eq!(bubble.surface(&ray, hit).geometric_normal.x(), -1.0);
/// # Ok::<(), snell::csg::CsgError>(())
/// ```
#[derive(Clone, Debug)]
pub struct CsgSolid {
    /// Children before parents; the last is the root.
    nodes: Vec<Node>,
    /// The children of all operations, one after another.
    children: Vec<u32>,
    leaves: Vec<Leaf>,
    /// What coordinates of any leaf can be wrong by, as counted in `shape/rounding.rs`: where surfaces of two parts
    /// coincide, rays spawned on one of them must clear the other too.
    rounding: f64,
}

#[derive(Clone, Debug)]
struct Node {
    bounds: Bounds3,
    kind: NodeKind,
}

#[derive(Clone, Copy, Debug)]
enum NodeKind {
    /// The place among the leaves.
    Leaf(u32),
    /// The places of its children's places.
    Operation { operation: CsgOperation, first: u32, end: u32 },
}

#[derive(Clone, Debug)]
struct Leaf {
    shape: Shape,
    solid_from_leaf: Option<Transform>,
    /// The shape in the solid's space, where it keeps its kind there.
    carried: Option<Shape>,
    tag: u32,
}

impl Leaf {
    fn new(shape: Shape, solid_from_leaf: Option<Transform>, tag: u32) -> Self {
        let carried = solid_from_leaf.and_then(|map| shape.transformed(&map));
        Self { shape, solid_from_leaf, carried, tag }
    }

    /// What is traced, and the map into its space where that is not the solid's.
    #[inline]
    fn traced(&self) -> (&Shape, Option<&Transform>) {
        match &self.carried {
            Some(carried) => (carried, None),
            None => (&self.shape, self.solid_from_leaf.as_ref()),
        }
    }

    fn bounds(&self) -> Bounds3 {
        let (shape, solid_from_traced) = self.traced();
        let bounds = shape.bounds();
        let Some(map) = solid_from_traced else { return bounds };
        if !bounds.is_finite() {
            return Bounds3::EVERYTHING;
        }
        let bounds = map.bounds(&bounds);
        let largest = bounds.min.max_abs().max(bounds.max.max_abs()).max(map.affine().translation.abs().max_element());
        bounds.grown(gamma(16) * largest)
    }

    fn contains(&self, point: Point3) -> bool {
        let (shape, solid_from_traced) = self.traced();
        shape.contains(solid_from_traced.map_or(point, |map| map.inverse_point(point)))
    }

    fn surface(&self, ray: &Ray, hit: CsgHit) -> SurfacePoint {
        let hit = crate::shape::ShapeHit { t: hit.t, part: hit.part };
        match (&self.carried, &self.solid_from_leaf) {
            (Some(carried), Some(map)) => {
                let surface = carried.surface_geometry(ray, hit);
                SurfacePoint { uv: self.shape.uv(map.inverse_point(surface.point), hit.part), ..surface }
            }
            (None, Some(map)) => self.shape.surface(&map.inverse_ray(ray), hit).carried(map),
            (_, None) => self.shape.surface(ray, hit),
        }
    }
}

impl CsgSolid {
    /// Compiles a tree, given as a list with children before their parents; the last node is the whole.
    ///
    /// # Errors
    /// Where the list is no such tree, or one of its shapes is not solid.
    pub fn new(nodes: Vec<CsgNode>) -> Result<Self, CsgError> {
        let count = u32::try_from(nodes.len()).ok().filter(|&count| count > 0).ok_or(CsgError::NodeCount)?;
        let mut solid =
            Self { nodes: Vec::with_capacity(nodes.len()), children: Vec::new(), leaves: Vec::new(), rounding: 0.0 };
        let mut used = vec![false; nodes.len()];
        for (node, index) in nodes.into_iter().zip(0_u32..) {
            let node = match node {
                CsgNode::Leaf { shape, .. } if !shape.is_solid() => return Err(CsgError::NotSolid(index)),
                CsgNode::Leaf { shape, solid_from_leaf, tag } => solid.leaf(Leaf::new(shape, solid_from_leaf, tag)),
                CsgNode::Operation { children, .. } if children.is_empty() => return Err(CsgError::NoParts(index)),
                CsgNode::Operation { operation, children } => {
                    for &child in &children {
                        // Not earlier, or already a part of something.
                        if child >= index || std::mem::replace(&mut used[child as usize], true) {
                            return Err(CsgError::Child { node: index, child });
                        }
                    }
                    solid.operation(operation, &children)
                }
            };
            solid.nodes.push(node);
        }
        match used.iter().zip(0..count - 1).find(|(used, _)| !**used) {
            Some((_, unused)) => Err(CsgError::Unused(unused)),
            None => Ok(solid),
        }
    }

    fn leaf(&mut self, leaf: Leaf) -> Node {
        let bounds = leaf.bounds();
        let corners = [bounds.min, bounds.max].map(Point3::to_array);
        let finite = corners.as_flattened().iter().map(|c| c.abs()).filter(|c| c.is_finite());
        self.rounding = finite.fold(self.rounding, |largest, c| largest.max(gamma(64) * c));
        self.leaves.push(leaf);
        Node { bounds, kind: NodeKind::Leaf(self.leaves.len() as u32 - 1) }
    }

    fn operation(&mut self, operation: CsgOperation, children: &[u32]) -> Node {
        let mut each = children.iter().map(|&child| self.nodes[child as usize].bounds);
        let first_bounds = each.next().unwrap_or(Bounds3::EMPTY);
        let bounds = match operation {
            CsgOperation::Union => each.fold(first_bounds, |sum, bounds| sum.union(&bounds)),
            CsgOperation::Intersection => each.fold(first_bounds, |common, bounds| common.intersection(&bounds)),
            CsgOperation::Difference => first_bounds,
        };
        let first = self.children.len() as u32;
        self.children.extend_from_slice(children);
        Node { bounds, kind: NodeKind::Operation { operation, first, end: self.children.len() as u32 } }
    }

    /// How many leaves it has.
    pub(crate) fn leaf_count(&self) -> u32 {
        self.leaves.len() as u32
    }

    /// The shape of a leaf, and the map from its space to the solid's where that is another.
    pub(crate) fn leaf_shape(&self, leaf: u32) -> (&Shape, Option<&Transform>) {
        self.leaves[leaf as usize].traced()
    }

    /// The tag of a leaf.
    pub fn tag(&self, leaf: u32) -> u32 {
        self.leaves[leaf as usize].tag
    }

    /// The axis-aligned box that holds the solid, as small as the boxes of its parts tell; empty where parts that are
    /// intersected lie apart.
    pub fn bounds(&self) -> Bounds3 {
        self.nodes.last().map_or(Bounds3::EMPTY, |root| root.bounds)
    }

    /// True where the point is inside. Allocates a byte for each node: it is not for use along rays.
    pub fn contains(&self, point: Point3) -> bool {
        let mut inside: Vec<bool> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            inside.push(match node.kind {
                NodeKind::Leaf(leaf) => self.leaves[leaf as usize].contains(point),
                NodeKind::Operation { operation, first, end } => {
                    let mut parts =
                        self.children[first as usize..end as usize].iter().map(|&child| inside[child as usize]);
                    match operation {
                        CsgOperation::Union => parts.any(|inside| inside),
                        CsgOperation::Intersection => parts.all(|inside| inside),
                        CsgOperation::Difference => parts.next() == Some(true) && !parts.any(|inside| inside),
                    }
                }
            });
        }
        inside.last() == Some(&true)
    }

    /// The surface at a hit of this ray. Its normals point out of the whole solid.
    pub fn surface(&self, ray: &Ray, hit: CsgHit) -> SurfacePoint {
        let mut surface = self.leaves[hit.leaf as usize].surface(ray, hit);
        if hit.flipped {
            surface.geometric_normal = -surface.geometric_normal;
            surface.shading_normal = -surface.shading_normal;
        }
        SurfacePoint { error: surface.error.max(self.rounding), ..surface }
    }
}

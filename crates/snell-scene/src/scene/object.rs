//! What stands in the world: shapes, solids made of them, groups, instances and grids.

use snell_math::{Point3, Transform, Vector3};

use super::material::Material;
use super::mesh::Mesh;
use crate::diagnostic::Span;
use crate::table::Id;

/// A thing in the world, or a part of one.
#[derive(Clone, Debug)]
pub struct Object {
    /// Its name, where the author gave one.
    pub name: Option<String>,
    /// Its material; where absent, that of the group or solid it is part of.
    pub material: Option<Id<Material>>,
    /// From its own space to that of what it is part of.
    pub parent_from_object: Transform,
    /// What it is.
    pub kind: ObjectKind,
    /// Where the scene says so, for messages.
    pub span: Option<Span>,
}

impl Object {
    /// A shape without name or material, in place.
    pub fn shape(shape: Shape) -> Self {
        Self {
            name: None,
            material: None,
            parent_from_object: Transform::IDENTITY,
            kind: ObjectKind::Shape(shape),
            span: None,
        }
    }
}

/// What an object is.
#[derive(Clone, Debug)]
pub enum ObjectKind {
    /// One shape.
    Shape(Shape),
    /// Several objects, placed and named together.
    Group(Vec<Object>),
    /// One solid made of several. The parts are solid shapes, other such solids, or groups of one of them; a part's own
    /// material shows on the surface that it gives to the whole.
    Csg {
        /// How they are combined, from the first to the last.
        operation: CsgOperation,
        /// At least one.
        parts: Vec<Object>,
    },
    /// A prototype, placed.
    Instance(Id<Prototype>),
    /// The same object many times.
    Grid(Grid),
}

/// How solids are combined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CsgOperation {
    /// What is in any.
    Union,
    /// What is in all.
    Intersection,
    /// What is in the first and in no other.
    Difference,
}

/// `count[0] × count[1] × count[2]` copies; copy (i, j, k) is moved by `i step[0] + j step[1] + k step[2]`.
#[derive(Clone, Debug)]
pub struct Grid {
    /// How many in each direction, from 1.
    pub count: [u32; 3],
    /// From one to the next in each direction.
    pub step: [Vector3; 3],
    /// What is repeated.
    pub of: Box<Object>,
}

/// Objects defined once, to be placed many times.
#[derive(Clone, Debug)]
pub struct Prototype {
    /// Its name.
    pub name: String,
    /// What it consists of.
    pub objects: Vec<Object>,
}

/// A shape in its object's space. All sizes are finite and positive, all directions of unit length. Solid ones (marked)
/// have an inside and can be parts of a CSG solid. Normals point outward.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Solid. u around +y from +x by −z… in [0, 1], v from −y (0) to +y (1).
    Sphere {
        /// The centre.
        center: Point3,
        /// The radius.
        radius: f64,
    },
    /// All points p with (p − point) · normal = 0. Solid: its inside is below, where the product is negative. (u, v) in
    /// units of length along two tangents, for normal +y along +x and −z.
    Plane {
        /// A point on it.
        point: Point3,
        /// Its normal.
        normal: Vector3,
    },
    /// A flat disk, with a hole where `inner_radius` is above 0. u around in [0, 1], v from the inner radius to the outer.
    Disk {
        /// The centre.
        center: Point3,
        /// Its normal.
        normal: Vector3,
        /// The outer radius.
        radius: f64,
        /// The hole's radius, 0 for none.
        inner_radius: f64,
    },
    /// A flat rectangle `corner + u edges[0] + v edges[1]`, (u, v) in [0, 1]²; its normal is `edges[0] × edges[1]`.
    Rectangle {
        /// The corner at (0, 0).
        corner: Point3,
        /// The two edges from there, perpendicular, of any positive length.
        edges: [Vector3; 2],
    },
    /// Solid. An axis-aligned box. (u, v) on each face in units of length.
    Box {
        /// The corner of smallest coordinates.
        min: Point3,
        /// The corner of largest coordinates.
        max: Point3,
    },
    /// Solid where capped. u around the axis in [0, 1], v from base (0) to top (1).
    Cylinder {
        /// The middle of the base.
        base: Point3,
        /// The middle of the top.
        top: Point3,
        /// The radius.
        radius: f64,
        /// Closed by disks at both ends.
        capped: bool,
    },
    /// Solid where capped. A cone, or a truncated one. The radii differ; one of them may be 0. (u, v) as the cylinder's.
    Cone {
        /// The middle of the base.
        base: Point3,
        /// The radius there.
        base_radius: f64,
        /// The middle of the top.
        top: Point3,
        /// The radius there.
        top_radius: f64,
        /// Closed by disks at both ends.
        capped: bool,
    },
    /// Solid. All points at distance `minor_radius` or less from a circle. u around the axis, v around the tube, in [0, 1].
    Torus {
        /// The circle's centre.
        center: Point3,
        /// The circle's axis.
        axis: Vector3,
        /// The circle's radius.
        major_radius: f64,
        /// The tube's radius, at most `major_radius`.
        minor_radius: f64,
    },
    /// Triangles.
    Mesh(Id<Mesh>),
}

//! Shapes as the author writes them, in the object's own space. Lengths in world units before the object's scale.

use schemars::JsonSchema;
use serde::Deserialize;

use super::value::{Located, Scale, Triple};

/// A ball. Solid.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Sphere {
    /// The centre.
    #[schemars(extend("x-unit" = "world units"))]
    pub center: Triple,
    /// The radius.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "world units"))]
    pub radius: f64,
}

impl Default for Sphere {
    fn default() -> Self {
        Self { center: [0.0; 3], radius: 1.0 }
    }
}

/// An endless plane: by one of `x`, `y` and `z`, or by `normal` and `point`. Without any, `y = 0`. Solid: its inside is on
/// the side from which the normal points away.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(
    extend("x-at-most-one" = [["x", "y", "z", "normal"], ["x", "y", "z", "point"]]),
    extend("x-example" = "[[object]]\nplane = { y = 0 }\n\n[[object]]\nplane = { normal = [1, 1, 0], point = [-4, 0, 0] }\n"),
)]
pub struct Plane {
    /// All points of this x; the normal is +x.
    #[schemars(extend("x-unit" = "world units"))]
    pub x: Option<f64>,
    /// All points of this y; the normal is +y.
    #[schemars(extend("x-unit" = "world units"))]
    pub y: Option<f64>,
    /// All points of this z; the normal is +z.
    #[schemars(extend("x-unit" = "world units"))]
    pub z: Option<f64>,
    /// The normal, of any length but 0. The default is [0, 1, 0].
    pub normal: Option<Located<Triple>>,
    /// A point on it. The default is the origin.
    #[schemars(extend("x-unit" = "world units"))]
    pub point: Option<Triple>,
}

/// A flat disk, with a hole where `inner_radius` is above 0.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Disk {
    /// The centre.
    #[schemars(extend("x-unit" = "world units"))]
    pub center: Triple,
    /// The normal, of any length but 0.
    pub normal: Located<Triple>,
    /// The radius.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "world units"))]
    pub radius: f64,
    /// The radius of the hole, below `radius`.
    #[schemars(range(min = 0), extend("x-unit" = "world units"))]
    pub inner_radius: Located<f64>,
}

impl Default for Disk {
    fn default() -> Self {
        Self { center: [0.0; 3], normal: [0.0, 1.0, 0.0].into(), radius: 1.0, inner_radius: 0.0.into() }
    }
}

/// A flat rectangle from a corner along two perpendicular edges; its normal is `edge_u` × `edge_v`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("x-example" = "[[object]]\nrectangle = { corner = [-2, 0, -3], edge_u = [4, 0, 0], edge_v = [0, 3, 0] }\n"))]
pub struct Rectangle {
    /// The corner.
    #[schemars(extend("x-unit" = "world units"))]
    pub corner: Triple,
    /// The edge from the corner along which u increases.
    #[schemars(extend("x-unit" = "world units"))]
    pub edge_u: Located<Triple>,
    /// The edge from the corner along which v increases, perpendicular to the other.
    #[schemars(extend("x-unit" = "world units"))]
    pub edge_v: Located<Triple>,
}

impl Default for Rectangle {
    fn default() -> Self {
        Self { corner: [0.0; 3], edge_u: [1.0, 0.0, 0.0].into(), edge_v: [0.0, 1.0, 0.0].into() }
    }
}

/// A box along the axes: by two corners `min` and `max`, or by `size` and `center`. Without any, the cube of edge 1 around
/// the origin. Solid.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(
    extend("x-at-most-one" = [["min", "size"], ["min", "center"], ["max", "size"], ["max", "center"]]),
    extend("x-example" = "[[object]]\nbox = { size = [2, 1, 2], center = [0, 0.5, 0] }\n\n[[object]]\nbox = { min = [3, 0, -1], max = [4, 2, 1] }\n"),
)]
pub struct AxisBox {
    /// The corner of smallest coordinates.
    #[schemars(extend("x-unit" = "world units"))]
    pub min: Option<Triple>,
    /// The corner of largest coordinates.
    #[schemars(extend("x-unit" = "world units"))]
    pub max: Option<Triple>,
    /// The edge of a cube, or the edges along x, y and z.
    #[schemars(extend("x-unit" = "world units"))]
    pub size: Option<Located<Scale>>,
    /// The middle.
    #[schemars(extend("x-unit" = "world units"))]
    pub center: Option<Triple>,
}

/// A cylinder. Solid where it is capped.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Cylinder {
    /// The middle of the base.
    #[schemars(extend("x-unit" = "world units"))]
    pub base: Triple,
    /// The middle of the top.
    #[schemars(extend("x-unit" = "world units"))]
    pub top: Triple,
    /// The radius.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "world units"))]
    pub radius: f64,
    /// Closed by disks at both ends.
    pub capped: bool,
}

impl Default for Cylinder {
    fn default() -> Self {
        Self { base: [0.0; 3], top: [0.0, 1.0, 0.0], radius: 1.0, capped: true }
    }
}

/// A cone, truncated where both radii are above 0. Solid where it is capped.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Cone {
    /// The middle of the base.
    #[schemars(extend("x-unit" = "world units"))]
    pub base: Triple,
    /// The radius there.
    #[schemars(range(min = 0), extend("x-unit" = "world units"))]
    pub base_radius: f64,
    /// The middle of the top.
    #[schemars(extend("x-unit" = "world units"))]
    pub top: Triple,
    /// The radius there, not that of the base.
    #[schemars(range(min = 0), extend("x-unit" = "world units"))]
    pub top_radius: f64,
    /// Closed by disks at both ends.
    pub capped: bool,
}

impl Default for Cone {
    fn default() -> Self {
        Self { base: [0.0; 3], base_radius: 1.0, top: [0.0, 1.0, 0.0], top_radius: 0.0, capped: true }
    }
}

/// A ring: all points within `minor_radius` of a circle. Solid.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Torus {
    /// The centre of the circle.
    #[schemars(extend("x-unit" = "world units"))]
    pub center: Triple,
    /// The axis of the circle, of any length but 0.
    pub axis: Located<Triple>,
    /// The radius of the circle.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "world units"))]
    pub major_radius: f64,
    /// The radius of the tube, at most `major_radius`.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "world units"))]
    pub minor_radius: Located<f64>,
}

impl Default for Torus {
    fn default() -> Self {
        Self { center: [0.0; 3], axis: [0.0, 1.0, 0.0].into(), major_radius: 1.0, minor_radius: 0.25.into() }
    }
}

/// A lens around the origin. Light that travels along its axis meets the surface of `radius1` first. Radii have the signs of
/// the lensmaker's equation: positive where the centre of curvature lies farther along the axis, so that a biconvex lens has
/// a positive `radius1` and a negative `radius2`. A surface without a radius is flat. Solid.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-example" = "[[object]]\nname = \"magnifier\"\nlens = { radius1 = 4, radius2 = -4, thickness = 0.6, diameter = 2 }\nmaterial = { dielectric = { ior = \"N-BK7\" } }\n"))]
pub struct Lens {
    /// The radius of curvature of the first surface: positive is convex, negative concave.
    #[schemars(extend("x-unit" = "world units"))]
    pub radius1: Option<Located<f64>>,
    /// The radius of curvature of the second surface: negative is convex, positive concave.
    #[schemars(extend("x-unit" = "world units"))]
    pub radius2: Option<Located<f64>>,
    /// The thickness on the axis.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "world units"))]
    pub thickness: Located<f64>,
    /// The diameter of the rim.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "world units"))]
    pub diameter: Located<f64>,
    /// The axis, of any length but 0.
    #[serde(default = "along_z")]
    pub axis: Located<Triple>,
}

fn along_z() -> Located<Triple> {
    [0.0, 0.0, 1.0].into()
}

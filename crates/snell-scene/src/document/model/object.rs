//! Objects as the author writes them: one shape, solid, group, instance or grid each, with a place and a material.

use schemars::JsonSchema;
use serde::Deserialize;

use super::material::MaterialChoice;
use super::mesh::Mesh;
use super::shape::{AxisBox, Cone, Cylinder, Disk, Lens, Plane, Rectangle, Sphere, Torus};
use super::value::{Either, Located, PrototypeName, Rotation, Scale, Triple};

/// An object: exactly one of the shapes, solids, `group`, `instance` and `grid`, with a place and a material. It is scaled
/// first, then rotated, then moved; what it is part of is placed after that.
// Everything is boxed: reading nested objects recurses, and this type is what it keeps on the stack.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[derive(Default)]
#[schemars(
    extend("oneOf" = [
        {"required": ["sphere"]}, {"required": ["plane"]}, {"required": ["disk"]}, {"required": ["rectangle"]},
        {"required": ["box"]}, {"required": ["cylinder"]}, {"required": ["cone"]}, {"required": ["torus"]},
        {"required": ["mesh"]}, {"required": ["lens"]}, {"required": ["union"]}, {"required": ["intersection"]},
        {"required": ["difference"]}, {"required": ["group"]}, {"required": ["instance"]}, {"required": ["grid"]}
    ]),
    extend("x-example" = "[material.glass]\ndielectric = { ior = 1.5 }\n\n[[object]]\nname = \"bubble\"\nmaterial = \"glass\"\ndifference = [\n  { sphere = { radius = 1.0 } },\n  { sphere = { radius = 0.9 } },\n]\ntranslate = [0, 1, 0]\n"),
)]
pub struct Object {
    /// Its name, for `--set` and for messages.
    pub name: Option<Box<Located<String>>>,
    /// The name of its material, or a material in place. A part without one has that of what it is part of.
    pub material: Option<Box<MaterialChoice>>,
    /// A ball.
    pub sphere: Option<Box<Sphere>>,
    /// An endless plane; as a part of a solid, all that is below it.
    pub plane: Option<Box<Located<Plane>>>,
    /// A flat disk, with or without a hole.
    pub disk: Option<Box<Disk>>,
    /// A flat rectangle.
    pub rectangle: Option<Box<Rectangle>>,
    /// A box along the axes.
    #[serde(rename = "box")]
    pub axis_box: Option<Box<Located<AxisBox>>>,
    /// A cylinder.
    pub cylinder: Option<Box<Located<Cylinder>>>,
    /// A cone, whole or truncated.
    pub cone: Option<Box<Located<Cone>>>,
    /// A ring.
    pub torus: Option<Box<Torus>>,
    /// Triangles and polygons, from a file or in place.
    pub mesh: Option<Box<Located<Mesh>>>,
    /// A lens, solid.
    pub lens: Option<Box<Located<Lens>>>,
    /// The solid of what is in any of the parts.
    pub union: Option<Box<Located<Vec<Located<Object>>>>>,
    /// The solid of what is in all of the parts.
    pub intersection: Option<Box<Located<Vec<Located<Object>>>>>,
    /// The solid of what is in the first part and in none of the others.
    pub difference: Option<Box<Located<Vec<Located<Object>>>>>,
    /// Several objects, placed together.
    pub group: Option<Vec<Located<Object>>>,
    /// The name of a prototype, to be placed here.
    pub instance: Option<Box<Located<PrototypeName>>>,
    /// The same object many times, in rows.
    pub grid: Option<Box<Located<Grid>>>,
    /// How much larger it becomes: one factor, or one along each axis, not 0. Negative factors mirror.
    #[schemars(extend("default" = 1))]
    pub scale: Option<Box<Located<Scale>>>,
    /// How it is turned: `[x, y, z]`, about x, then y, then z; or an axis and an angle.
    #[schemars(extend("default" = [0, 0, 0], "x-unit" = "degrees"))]
    pub rotate: Option<Box<Located<Rotation>>>,
    /// How it is moved.
    #[schemars(extend("default" = [0, 0, 0], "x-unit" = "world units"))]
    pub translate: Option<Triple>,
}

/// The same object many times: copy (i, j, k) is moved by i, j and k steps.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-example" = "[[object]]\ngrid = { count = [5, 1, 5], step = [2.5, 0, 2.5], of = { sphere = {} } }\n"))]
pub struct Grid {
    /// How many copies there are in each direction.
    #[schemars(inner(range(min = 1, max = 10000000)))]
    pub count: Located<[u32; 3]>,
    /// From one copy to the next: the distances along x, y and z, or three vectors.
    #[serde(default = "unit_steps")]
    #[schemars(extend("default" = [1, 1, 1], "x-unit" = "world units"))]
    pub step: Step,
    /// What is repeated.
    pub of: Located<Object>,
}

/// From one copy to the next.
pub type Step = Either<Triple, StepVectors>;

fn unit_steps() -> Step {
    Either::A([1.0; 3])
}

/// The steps of a grid that is not along the axes.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct StepVectors {
    /// The step of the first count.
    #[schemars(extend("x-unit" = "world units"))]
    pub x: Triple,
    /// The step of the second count.
    #[schemars(extend("x-unit" = "world units"))]
    pub y: Triple,
    /// The step of the third count.
    #[schemars(extend("x-unit" = "world units"))]
    pub z: Triple,
}

impl Default for StepVectors {
    fn default() -> Self {
        Self { x: [1.0, 0.0, 0.0], y: [0.0, 1.0, 0.0], z: [0.0, 0.0, 1.0] }
    }
}

//! Meshes as the author writes them: a file, or vertices and faces in place.

use schemars::JsonSchema;
use serde::Deserialize;

use super::value::{Located, Triple};

/// Triangles and polygons: from a `file`, or by `vertices` and `faces`. Faces are counter-clockwise as seen from outside.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(
    extend("oneOf" = [{"required": ["file"]}, {"required": ["vertices"]}]),
    extend("x-at-most-one" = [["file", "faces"], ["file", "normals"], ["file", "uvs"], ["file", "colors"], ["normals", "smooth"]]),
    extend("x-example" = "[[object]]\nmesh = { vertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], faces = [[0, 1, 2, 3]] }\n"),
)]
pub struct Mesh {
    /// The mesh file, relative to the scene file: OBJ, PLY or STL.
    pub file: Option<Located<String>>,
    /// The positions of the vertices.
    #[schemars(length(min = 3), extend("x-unit" = "world units"))]
    pub vertices: Option<Located<Vec<Triple>>>,
    /// The faces: for each, the numbers of three or more of the vertices, from 0.
    #[schemars(inner(length(min = 3)))]
    pub faces: Option<Vec<Located<Vec<u32>>>>,
    /// One normal for each vertex, for smooth shading.
    pub normals: Option<Located<Vec<Triple>>>,
    /// One (u, v) for each vertex, for textures.
    pub uvs: Option<Located<Vec<[f64; 2]>>>,
    /// One colour for each vertex, a factor on the diffuse colour.
    pub colors: Option<Located<Vec<Triple>>>,
    /// Shades it smoothly: edges between faces that meet at less than this angle are rounded off, sharper ones stay sharp.
    /// 0 shows every face flat, 180 rounds all. Without it, the normals of the file or of `normals` hold.
    #[schemars(range(min = 0, max = 180), extend("x-unit" = "degrees"))]
    pub smooth: Option<f64>,
    /// Scales and moves it so that its longest side has this length, it stands on y = 0, and its middle is above the origin.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "world units"))]
    pub fit: Option<Located<f64>>,
}

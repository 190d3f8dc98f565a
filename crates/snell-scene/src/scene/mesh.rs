//! Triangle meshes as files bring them.

use super::material::Material;
use crate::table::Id;

/// Triangles over shared vertices, in the object's space. Front faces are counter-clockwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Its name: the file's, or the author's.
    pub name: String,
    /// Vertex positions, all finite.
    pub positions: Vec<[f32; 3]>,
    /// Three indices into `positions` a triangle, all in range. Triangles of no area are allowed.
    pub triangles: Vec<[u32; 3]>,
    /// One normal a vertex, not necessarily unit length, for smooth shading; or none.
    pub normals: Vec<[f32; 3]>,
    /// One (u, v) a vertex, v up; or none.
    pub uvs: Vec<[f32; 2]>,
    /// One linear colour a vertex, a factor on the diffuse colour; or none.
    pub colors: Vec<[f32; 3]>,
    /// One place in `materials` a triangle; or none, where one material serves all.
    pub triangle_materials: Vec<u16>,
    /// The materials that `triangle_materials` and, where that is empty, all triangles use, where the file brings its own.
    /// An object's own material goes before these.
    pub materials: Vec<Id<Material>>,
}

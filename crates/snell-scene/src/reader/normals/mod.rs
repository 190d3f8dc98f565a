//! Vertex normals for meshes that bring none, or broken ones.
//!
//! A vertex normal is the sum of its triangles' normals weighted by their angles at the vertex (Thürmer and Wüthrich,
//! "Computing vertex normals from polygonal facets", Journal of Graphics Tools 3(1), 1998), so that it does not depend on
//! how flat faces were cut into triangles. Edges sharper than a crease angle stay sharp, as VRML97's `creaseAngle` has it:
//! two triangles are shaded as one surface around a vertex where a chain of shared edges, none of them sharper, joins them.
//! Angles in radians; triangles sharing an edge are found by equal positions, so seams of texture coordinates stay smooth.

mod groups;

use std::collections::HashMap;

use foldhash::fast::RandomState;
use rayon::prelude::*;
use snell_math::{Bounds3, Point3, Vector3, portable};

use crate::scene::Mesh;
use groups::Groups;

/// Gives a mesh smooth normals in place of those it has. Vertices on edges whose triangles' normals differ by more than
/// `crease_angle` are split, so that each side keeps its own; all other vertices keep their places in the tables.
///
/// Triangles without area count for nothing. Takes time in proportion to the mesh's size times its logarithm.
///
/// ```
/// use snell_scene::reader::smooth_normals;
/// use snell_scene::scene::Mesh;
/// let mut roof = Mesh {
///     positions: vec![[0.0, 1.0, 0.0], [0.0, 1.0, 1.0], [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
///     triangles: vec![[0, 2, 1], [0, 1, 3]],
///     ..Mesh::default()
/// };
/// smooth_normals(&mut roof, 1.0); // its sides meet at a right angle
/// assert_eq!(roof.positions.len(), 6);
/// ```
pub fn smooth_normals(mesh: &mut Mesh, crease_angle: f64) {
    let cos_crease = portable::cos(crease_angle.clamp(0.0, std::f64::consts::PI));
    let Groups { of_corner, normals } = groups::of_corners(mesh, &face_normals(mesh), cos_crease);

    // A vertex goes to the first group that uses it and is copied for every further one.
    let mut owner: Vec<u32> = vec![u32::MAX; mesh.positions.len()];
    let mut copies: HashMap<(u32, u32), u32, RandomState> = HashMap::default();
    mesh.normals = vec![[0.0, 1.0, 0.0]; mesh.positions.len()];
    for triangle in 0..mesh.triangles.len() {
        for corner in 0..3 {
            let (vertex, group) = (mesh.triangles[triangle][corner], of_corner[triangle * 3 + corner]);
            let owner = &mut owner[vertex as usize];
            if *owner == group {
                continue;
            }
            let new = if *owner == u32::MAX {
                *owner = group;
                vertex
            } else {
                *copies.entry((vertex, group)).or_insert_with(|| copy_vertex(mesh, vertex))
            };
            mesh.normals[new as usize] = normals[group as usize];
            mesh.triangles[triangle][corner] = new;
        }
    }
}

/// Replaces normals that are zero or not finite by smooth ones of the triangles around. Says how many there were.
pub(crate) fn repair_normals(mesh: &mut Mesh) -> usize {
    let good = |n: &[f32; 3]| n.iter().all(|c| c.is_finite()) && n.iter().any(|&c| c != 0.0);
    let broken = mesh.normals.iter().filter(|n| !good(n)).count();
    if broken == 0 {
        return 0;
    }
    let mut sums = vec![Vector3::ZERO; mesh.positions.len()];
    for (triangle, direction) in face_normals(mesh).into_iter().enumerate() {
        for corner in 0..3 {
            let vertex = mesh.triangles[triangle][corner] as usize;
            sums[vertex] += direction * corner_angle(mesh, triangle, corner);
        }
    }
    for (normal, sum) in mesh.normals.iter_mut().zip(sums).filter(|(n, _)| !good(n)) {
        *normal = unit(sum);
    }
    broken
}

/// The box around all triangles; empty where there are none.
pub fn mesh_bounds(mesh: &Mesh) -> Bounds3 {
    mesh.triangles.iter().flatten().fold(Bounds3::EMPTY, |sum, &vertex| sum.including(position(mesh, vertex)))
}

fn position(mesh: &Mesh, vertex: u32) -> Point3 {
    Point3::from(mesh.positions[vertex as usize].map(f64::from))
}

/// The bits of a position, the same for both zeros.
pub(crate) fn position_key(position: [f32; 3]) -> [u32; 3] {
    position.map(|c| (c + 0.0).to_bits())
}

/// Every triangle's unit normal, zero where it has no area.
fn face_normals(mesh: &Mesh) -> Vec<Vector3> {
    mesh.triangles
        .par_iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| position(mesh, v));
            (b - a).cross(c - a).try_normalize().unwrap_or(Vector3::ZERO)
        })
        .collect()
}

/// The angle of a triangle at one of its corners.
fn corner_angle(mesh: &Mesh, triangle: usize, corner: usize) -> f64 {
    let t = mesh.triangles[triangle];
    let [here, next, last] = [0, 1, 2].map(|i| position(mesh, t[(corner + i) % 3]));
    let (a, b) = (next - here, last - here);
    portable::atan2(a.cross(b).length(), a.dot(b))
}

fn unit(sum: Vector3) -> [f32; 3] {
    sum.try_normalize().map_or([0.0, 1.0, 0.0], |n| n.to_array().map(|c| c as f32))
}

fn copy_vertex(mesh: &mut Mesh, vertex: u32) -> u32 {
    let (new, vertex) = (mesh.positions.len() as u32, vertex as usize);
    mesh.positions.push(mesh.positions[vertex]);
    mesh.normals.push(mesh.normals[vertex]);
    if let Some(&uv) = mesh.uvs.get(vertex) {
        mesh.uvs.push(uv);
    }
    if let Some(&color) = mesh.colors.get(vertex) {
        mesh.colors.push(color);
    }
    new
}

#[cfg(test)]
mod tests;

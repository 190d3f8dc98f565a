//! Vertex normals for meshes that bring none, or broken ones.
//!
//! A vertex normal is the sum of its triangles' normals weighted by their angles at the vertex (Thürmer and Wüthrich,
//! "Computing vertex normals from polygonal facets", Journal of Graphics Tools 3(1), 1998), so that it does not depend on
//! how flat faces were cut into triangles. Edges sharper than a crease angle stay sharp, as VRML97's `creaseAngle` has it:
//! two triangles are shaded as one surface around a vertex where a chain of shared edges, none of them sharper, joins them.
//! Angles in radians; triangles sharing an edge are found by equal positions, so seams of texture coordinates stay smooth.

use std::collections::HashMap;

use snell_math::{Bounds3, Point3, Vector3, portable};

use crate::scene::Mesh;

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
    let welded = weld(&mesh.positions);
    let directions = face_normals(mesh);
    let groups =
        group_corners(mesh, &welded, &directions, portable::cos(crease_angle.clamp(0.0, std::f64::consts::PI)));

    // Each group's normal is summed over its corners, whichever vertices they have.
    let mut sums = vec![Vector3::ZERO; groups.count];
    for (triangle, direction) in directions.iter().enumerate() {
        for corner in 0..3 {
            let group = groups.of_corner[triangle * 3 + corner] as usize;
            sums[group] += *direction * corner_angle(mesh, triangle, corner);
        }
    }

    // A vertex goes to the first group that uses it and is copied for every further one.
    let mut owner: Vec<u32> = vec![u32::MAX; mesh.positions.len()];
    let mut copies: HashMap<(u32, u32), u32> = HashMap::new();
    mesh.normals = vec![[0.0, 1.0, 0.0]; mesh.positions.len()];
    for triangle in 0..mesh.triangles.len() {
        for corner in 0..3 {
            let (vertex, group) = (mesh.triangles[triangle][corner], groups.of_corner[triangle * 3 + corner]);
            let normal = unit(sums[group as usize]);
            let new = if owner[vertex as usize] == u32::MAX || owner[vertex as usize] == group {
                owner[vertex as usize] = group;
                vertex
            } else {
                *copies.entry((vertex, group)).or_insert_with(|| copy_vertex(mesh, vertex))
            };
            mesh.normals[new as usize] = normal;
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

/// For every vertex, the first one at the same place.
fn weld(positions: &[[f32; 3]]) -> Vec<u32> {
    let mut first: HashMap<[u32; 3], u32> = HashMap::with_capacity(positions.len());
    (0u32..).zip(positions).map(|(i, &p)| *first.entry(position_key(p)).or_insert(i)).collect()
}

/// Every triangle's unit normal, zero where it has no area.
fn face_normals(mesh: &Mesh) -> Vec<Vector3> {
    mesh.triangles
        .iter()
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

/// Which corners (3 · triangle + corner) are shaded as one.
struct Groups {
    of_corner: Vec<u32>,
    count: usize,
}

fn group_corners(mesh: &Mesh, welded: &[u32], directions: &[Vector3], cos_crease: f64) -> Groups {
    let corners = mesh.triangles.len() * 3;
    let mut parent: Vec<u32> = (0..corners as u32).collect();
    let at = |corner: u32| welded[mesh.triangles[corner as usize / 3][corner as usize % 3] as usize];

    // Edges as seen from each end: (this end, other end, corner at this end). Sorted, those of one edge are neighbours.
    let mut ends: Vec<(u32, u32, u32)> = Vec::with_capacity(corners * 2);
    for corner in 0..corners as u32 {
        let triangle = corner - corner % 3;
        for step in [1, 2] {
            ends.push((at(corner), at(triangle + (corner % 3 + step) % 3), corner));
        }
    }
    ends.sort_unstable();
    for pair in ends.windows(2) {
        let [(from, to, a), (from_b, to_b, b)] = [pair[0], pair[1]];
        let smooth = directions[a as usize / 3].dot(directions[b as usize / 3]) >= cos_crease;
        if (from, to) == (from_b, to_b) && smooth {
            let (root_a, root_b) = (find(&mut parent, a), find(&mut parent, b));
            parent[root_a.max(root_b) as usize] = root_a.min(root_b);
        }
    }

    // Roots are the smallest of their group, so numbering in order meets a root before its members.
    let mut of_corner = vec![0; corners];
    let mut count = 0;
    for corner in 0..corners as u32 {
        let root = find(&mut parent, corner);
        of_corner[corner as usize] = if root == corner {
            count += 1;
            count - 1
        } else {
            of_corner[root as usize]
        };
    }
    Groups { of_corner, count: count as usize }
}

/// The representative of a set, shortening the way to it (Tarjan's path halving).
fn find(parent: &mut [u32], mut member: u32) -> u32 {
    while parent[member as usize] != member {
        let above = parent[member as usize];
        parent[member as usize] = parent[above as usize];
        member = above;
    }
    member
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A unit cube whose corners are shared by its three faces.
    fn cube() -> Mesh {
        let positions = (0..8u8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f32::from)).collect();
        let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Mesh { positions, triangles, ..Mesh::default() }
    }

    #[test]
    fn a_cube_stays_sharp_below_its_crease_angle_and_becomes_round_above() {
        let mut sharp = cube();
        smooth_normals(&mut sharp, portable::radians(40.0));
        assert_eq!(sharp.positions.len(), 24);
        for (triangle, direction) in face_normals(&sharp).iter().enumerate() {
            for &v in &sharp.triangles[triangle] {
                let n = Vector3::from(sharp.normals[v as usize].map(f64::from));
                assert!((n - *direction).length() < 1e-6);
            }
        }
        let mut round = cube();
        smooth_normals(&mut round, portable::radians(120.0));
        assert_eq!(round.positions.len(), 8);
        // Angle weights make the normals point along the diagonals, however the faces were cut.
        for (p, n) in round.positions.iter().zip(&round.normals) {
            for i in 0..3 {
                assert!((n[i] - (2.0 * p[i] - 1.0) / 3f32.sqrt()).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn seams_are_smooth_though_their_vertices_are_not_shared() {
        let mut soup = cube();
        soup.positions = soup.triangles.iter().flatten().map(|&v| soup.positions[v as usize]).collect();
        soup.uvs = (0..soup.positions.len()).map(|i| [i as f32, 0.0]).collect();
        soup.triangles = (0..12).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        smooth_normals(&mut soup, 2.0);
        assert_eq!(soup.positions.len(), 36);
        let mut shared = cube();
        smooth_normals(&mut shared, 2.0);
        for (p, n) in soup.positions.iter().zip(&soup.normals) {
            let same = shared.positions.iter().position(|q| q == p).unwrap();
            assert_eq!(*n, shared.normals[same]);
        }
    }

    #[test]
    fn broken_normals_are_repaired_and_good_ones_left_alone() {
        let mut mesh = cube();
        mesh.normals = vec![[3.0, 0.0, 0.0]; 8];
        mesh.normals[0] = [0.0; 3];
        mesh.normals[7] = [f32::NAN; 3];
        assert_eq!(repair_normals(&mut mesh), 2);
        assert_eq!(mesh.normals[1], [3.0, 0.0, 0.0]);
        for i in 0..3 {
            assert!((mesh.normals[0][i] + 1.0 / 3f32.sqrt()).abs() < 1e-6);
            assert!((mesh.normals[7][i] - 1.0 / 3f32.sqrt()).abs() < 1e-6);
        }
    }

    #[test]
    fn triangles_without_area_do_no_harm() {
        let mut mesh = cube();
        mesh.triangles.push([0, 0, 1]);
        mesh.triangles.push([3, 3, 3]);
        smooth_normals(&mut mesh, 2.0);
        assert!(mesh.normals.iter().flatten().all(|c| c.is_finite()));
    }

    #[test]
    fn many_triangles_around_one_vertex_take_no_quadratic_time() {
        let count = 100_000u32;
        let mut mesh = Mesh { positions: vec![[0.0; 3]], ..Mesh::default() };
        for i in 0..count {
            let a = f64::from(i);
            mesh.positions.push([portable::cos(a) as f32, portable::sin(a) as f32, i as f32 * 1e-6]);
            mesh.triangles.push([0, i + 1, (i + 1) % count + 1]);
        }
        smooth_normals(&mut mesh, 1.0);
    }
}

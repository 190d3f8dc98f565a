//! Smooth normals in closed forms, and against the plain way of grouping corners.

use proptest::prelude::*;
use snell_math::{Vector3, portable};

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

/// As [`smooth_normals`], in the plainest way: corners that share an edge smoothly get the same number until nothing changes.
fn plain_smooth_normals(mesh: &mut Mesh, crease_angle: f64, keep_creases: bool) {
    let at = |corner: usize| mesh.positions[mesh.triangles[corner / 3][corner % 3] as usize].map(|c| c + 0.0);
    let other = |corner: usize, step: usize| at(corner / 3 * 3 + (corner + step) % 3);
    let directions = face_normals(mesh);
    let corners = mesh.triangles.len() * 3;
    let mut shared: Vec<(usize, usize)> = Vec::new();
    for a in 0..corners {
        // With the next one at the same edge, which suffices where edges have one or two sides.
        let mut ends: Vec<usize> = Vec::new();
        for step in [1, 2] {
            ends.clear();
            let same = |b: usize| at(b) == at(a) && (other(b, 1) == other(a, step) || other(b, 2) == other(a, step));
            ends.extend((a + 1..corners).filter(|&b| same(b)));
            shared.extend(ends.first().map(|&b| (a, b)));
        }
    }
    let cos_crease = portable::cos(crease_angle);
    shared.retain(|&(a, b)| !keep_creases || directions[a / 3].dot(directions[b / 3]) >= cos_crease);
    let mut group: Vec<usize> = (0..corners).collect();
    loop {
        let before = group.clone();
        for &(a, b) in &shared {
            let least = group[a].min(group[b]);
            (group[a], group[b]) = (least, least);
        }
        if group == before {
            break;
        }
    }
    let mut sums = vec![Vector3::ZERO; corners];
    for corner in 0..corners {
        sums[group[corner]] += directions[corner / 3] * corner_angle(mesh, corner / 3, corner % 3);
    }
    mesh.normals = vec![[0.0, 1.0, 0.0]; mesh.positions.len()];
    let mut taken: Vec<(u32, usize, u32)> = Vec::new();
    for corner in 0..corners {
        let vertex = mesh.triangles[corner / 3][corner % 3];
        let known = taken.iter().find(|&&(v, g, _)| (v, g) == (vertex, group[corner])).map(|&(.., new)| new);
        let new = known.unwrap_or_else(|| {
            let first = taken.iter().all(|&(v, ..)| v != vertex);
            let new = if first { vertex } else { copy_vertex(mesh, vertex) };
            taken.push((vertex, group[corner], new));
            new
        });
        mesh.normals[new as usize] = unit(sums[group[corner]]);
        mesh.triangles[corner / 3][corner % 3] = new;
    }
}

/// Triangles between the points of a small grid of bumps, whole or torn, some without area.
fn meshes() -> impl Strategy<Value = Mesh> {
    let point =
        (0..4i8, 0..4i8, -1..2i8).prop_map(|(x, y, z)| [x, y, z].map(|c| f32::from(c) * if c < 0 { 0.3 } else { 1.0 }));
    (prop::collection::vec(point, 1..12), prop::collection::vec([any::<u8>(), any::<u8>(), any::<u8>()], 0..30))
        .prop_map(|(positions, triangles)| {
            let count = positions.len() as u32;
            let triangles = triangles.into_iter().map(|t| t.map(|v| u32::from(v) % count)).collect();
            let uvs = (0..count).map(|i| [i as f32, 0.5]).collect();
            Mesh { positions, triangles, uvs, ..Mesh::default() }
        })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]
    #[test]
    fn normals_are_those_of_the_plain_way(mesh in meshes(), crease_angle in 0.0..3.1f64) {
        let (mut fast, mut plain) = (mesh.clone(), mesh);
        smooth_normals(&mut fast, crease_angle);
        plain_smooth_normals(&mut plain, crease_angle, true);
        prop_assert_eq!(fast, plain);
    }
}

#[test]
fn normals_that_pass_over_creases_are_not_those_of_the_plain_way() {
    let (mut fast, mut plain) = (cube(), cube());
    smooth_normals(&mut fast, 1.0);
    plain_smooth_normals(&mut plain, 1.0, false);
    assert_ne!(fast, plain);
}

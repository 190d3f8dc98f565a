//! The edges of a mesh: which faces meet there, and which are open.
//!
//! Corners are taken for one where their positions are equal, whatever their indices: a mesh whose faces have corners of
//! their own, for the sake of normals or texture coordinates, is closed if it looks closed.

use rayon::prelude::*;

/// How many directed edges have no opposite edge to match: 0 for a closed surface, however many parts it has. A border
/// edge counts 1, and an edge that two triangles run along in the same direction 2.
pub(super) fn boundary_edges(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> usize {
    let welded = weld(positions);
    let mut edges: Vec<(u32, u32, bool)> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
        .map(|(from, to)| (welded[from as usize], welded[to as usize]))
        .filter(|(from, to)| from != to)
        .map(|(from, to)| (from.min(to), from.max(to), from < to))
        .collect();
    edges.par_sort_unstable();
    edges
        .chunk_by(|a, b| (a.0, a.1) == (b.0, b.1))
        .map(|same| {
            let upward = same.iter().filter(|edge| edge.2).count();
            upward.abs_diff(same.len() - upward)
        })
        .sum()
}

/// An edge of a mesh and the faces along it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshEdge {
    /// Its vertices, each the lowest of those at the same position.
    pub vertices: [u32; 2],
    /// The triangles along it.
    pub faces: EdgeFaces,
}

/// The triangles along an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeFaces {
    /// One: the mesh ends there.
    One(u32),
    /// Two; with opposite directions along the edge, so that their fronts are the same side, or not.
    Two([u32; 2], bool),
    /// More.
    Many,
}

/// All edges of a mesh, each once, in the order of their vertices. Triangles with two corners at one place have none.
pub(super) fn edges(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<MeshEdge> {
    let welded = weld(positions);
    let mut sides: Vec<(u32, u32, u32, bool)> = triangles
        .par_iter()
        .enumerate()
        .flat_map_iter(|(triangle, corners)| {
            let [a, b, c] = corners.map(|vertex| welded[vertex as usize]);
            let is_whole = a != b && b != c && c != a;
            let sides =
                [(a, b), (b, c), (c, a)].map(|(from, to)| (from.min(to), from.max(to), triangle as u32, from < to));
            sides.into_iter().filter(move |_| is_whole)
        })
        .collect();
    sides.par_sort_unstable();
    sides
        .chunk_by(|a, b| (a.0, a.1) == (b.0, b.1))
        .map(|same| {
            let faces = match same {
                [one] => EdgeFaces::One(one.2),
                [one, two] => EdgeFaces::Two([one.2, two.2], one.3 != two.3),
                _ => EdgeFaces::Many,
            };
            MeshEdge { vertices: [same[0].0, same[0].1], faces }
        })
        .collect()
}

/// For every vertex the lowest vertex of the same position.
fn weld(positions: &[[f32; 3]]) -> Vec<u32> {
    // Adding 0 makes one of 0 and −0.
    let key = |vertex: u32| positions[vertex as usize].map(|x| (x + 0.0).to_bits());
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.par_sort_unstable_by_key(|&vertex| (key(vertex), vertex));
    let mut welded = vec![0; positions.len()];
    for same in order.chunk_by(|&a, &b| key(a) == key(b)) {
        for &vertex in same {
            welded[vertex as usize] = same[0];
        }
    }
    welded
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_know_their_faces_across_seams() {
        // A tent of two triangles whose corners at the ridge are doubled, and a third that hangs on the ridge too.
        let positions = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, -1.0, 1.0],
            [-0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, -1.0, -1.0],
            [0.0, -2.0, 0.0],
        ];
        let two = edges(&positions, &[[0, 1, 2], [4, 3, 5]]);
        assert_eq!(two.len(), 5);
        let ridge = MeshEdge { vertices: [0, 1], faces: EdgeFaces::Two([0, 1], true) };
        assert_eq!(two[0], ridge);
        assert_eq!(two.iter().filter(|edge| matches!(edge.faces, EdgeFaces::One(_))).count(), 4);
        // Turned over, its front is the other side.
        assert_eq!(edges(&positions, &[[0, 1, 2], [3, 4, 5]])[0].faces, EdgeFaces::Two([0, 1], false));
        assert_eq!(edges(&positions, &[[0, 1, 2], [4, 3, 5], [0, 1, 6]])[0].faces, EdgeFaces::Many);
        assert_eq!(edges(&positions, &[[0, 3, 2]]), [], "both corners are at one place");
    }
}

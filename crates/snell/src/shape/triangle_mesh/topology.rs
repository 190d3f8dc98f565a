//! The edges of a mesh: which faces meet there, and which are open.
//!
//! Corners are taken for one where their positions are equal, whatever their indices: a mesh whose faces have corners of
//! their own, for the sake of normals or texture coordinates, is closed if it looks closed.

use rayon::prelude::*;

/// How many directed edges have no opposite edge to match: 0 for a closed surface, however many parts it has. A border
/// edge counts 1, and an edge that two triangles run along in the same direction 2.
pub(super) fn boundary_edges(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> usize {
    // By the corners' indices first, since edges that are matched by these are matched whatever else is at their places.
    let open = unmatched(positions.len(), triangles);
    let mut is_open = vec![false; positions.len()];
    open.iter().flat_map(|side| [side.low, side.high]).for_each(|vertex| is_open[vertex as usize] = true);
    let corners: Vec<u32> = (0..positions.len() as u32).filter(|vertex| is_open[*vertex as usize]).collect();
    let mut places = vec![0; positions.len()];
    corners.iter().zip(weld(&corners, positions)).for_each(|(corner, place)| places[*corner as usize] = place);
    let place = |vertex| places[vertex as usize];
    let mut sides: Vec<Sides> = open
        .par_iter()
        .map(|side| Sides::new(place(side.low), place(side.high), side.upward))
        .filter(|side| side.low != side.high)
        .collect();
    sides.par_sort_unstable_by_key(|side| (side.low, side.high));
    let same = sides.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high));
    same.map(|same| same.iter().map(|side| side.upward).sum::<i64>().unsigned_abs() as usize).sum()
}

/// Sides of triangles between two vertices.
#[derive(Clone, Copy)]
struct Sides {
    low: u32,
    high: u32,
    /// How many more of them run from the lower to the higher vertex than back.
    upward: i64,
}

impl Sides {
    /// From one vertex to another.
    fn new(from: u32, to: u32, count: i64) -> Self {
        let upward = if from < to { count } else { -count };
        Self { low: from.min(to), high: from.max(to), upward }
    }
}

/// Those between vertices, by their indices, that are not as many one way as the other; in linear time.
fn unmatched(vertices: usize, triangles: &[[u32; 3]]) -> Vec<Sides> {
    let sides = || triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).filter(|(from, to)| from != to);
    // What stands behind each vertex: the sides that have it for their lower one. First how many, then where the next one goes.
    let mut next = vec![0; vertices];
    sides().for_each(|(from, to)| next[from.min(to) as usize] += 1);
    let mut total = 0;
    for next in &mut next {
        total += std::mem::replace(next, total);
    }
    // The higher vertex, and whether it is where the side ends.
    let mut entries = vec![0_u64; total];
    for (from, to) in sides() {
        let next = &mut next[from.min(to) as usize];
        entries[*next] = u64::from(from.max(to)) << 1 | u64::from(from < to);
        *next += 1;
    }
    // Each vertex's entries end where the next one's begin.
    let (mut open, mut begin) = (Vec::new(), 0);
    for (low, &end) in next.iter().enumerate() {
        let behind = &mut entries[begin..end];
        behind.sort_unstable();
        for same in behind.chunk_by(|a, b| a >> 1 == b >> 1) {
            let upward = same.iter().map(|entry| if entry & 1 == 1 { 1 } else { -1 }).sum();
            if upward != 0 {
                open.push(Sides { low: low as u32, high: (same[0] >> 1) as u32, upward });
            }
        }
        begin = end;
    }
    open
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
    let vertices: Vec<u32> = (0..positions.len() as u32).collect();
    let welded = weld(&vertices, positions);
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

/// For each of some vertices, in rising order, the lowest of them that is at the same position.
fn weld(vertices: &[u32], positions: &[[f32; 3]]) -> Vec<u32> {
    // Adding 0 makes one of 0 and −0.
    let key = |place: u32| positions[vertices[place as usize] as usize].map(|x| (x + 0.0).to_bits());
    let mut order: Vec<u32> = (0..vertices.len() as u32).collect();
    order.par_sort_unstable_by_key(|&place| (key(place), place));
    let mut welded = vec![0; vertices.len()];
    for same in order.chunk_by(|&a, &b| key(a) == key(b)) {
        for &place in same {
            welded[place as usize] = vertices[same[0] as usize];
        }
    }
    welded
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same by looking at every pair of places.
    fn boundary_edges_of_all(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> usize {
        let mut sides = std::collections::BTreeMap::new();
        for [a, b, c] in triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let [from, to] = [from, to].map(|vertex| positions[*vertex as usize].map(|x| (x + 0.0).to_bits()));
                if from != to {
                    *sides.entry((from.min(to), from.max(to))).or_insert(0_i64) += if from < to { 1 } else { -1 };
                }
            }
        }
        sides.values().map(|upward| upward.unsigned_abs() as usize).sum()
    }

    #[test]
    fn open_edges_are_counted() {
        let mut random = crate::accel::random::Random(9);
        let mut seen = [0; 3];
        for round in 0..300 {
            // Few places, some of them doubled, so that all kinds of edges come up; and closed ones, of which some are cut open.
            let count = 4 + round % 9;
            let mut positions: Vec<[f32; 3]> =
                (0..count).map(|i| [(i / 2 * 2 % 7) as f32 - 0.0, i as f32 / 2.0, 1.0]).collect();
            positions.extend_from_within(..count / 2);
            positions[0][2] = -0.0;
            positions[count][2] = 0.0;
            let vertex = |random: &mut crate::accel::random::Random| {
                (random.number().abs() * positions.len() as f64) as u32 % positions.len() as u32
            };
            let mut triangles = Vec::new();
            for _ in 0..1 + round % 5 {
                let [a, b, c, d] = [0; 4].map(|_| vertex(&mut random));
                triangles.extend([[a, b, c], [a, c, d], [a, d, b], [b, d, c]]);
            }
            if round % 3 > 0 {
                triangles.truncate(triangles.len() - round % 3);
            }
            let expected = boundary_edges_of_all(&positions, &triangles);
            assert_eq!(boundary_edges(&positions, &triangles), expected, "{positions:?} {triangles:?}");
            seen[expected.min(2)] += 1;
        }
        assert!(seen[0] > 90 && seen[2] > 90, "{seen:?}");
    }

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

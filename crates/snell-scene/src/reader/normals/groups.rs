//! Which corners around a vertex are shaded as one surface, and the normal of each such group.
//!
//! Every vertex is looked at by itself: the corners at its place, by Tarjan's union-find over the edges that they share. So
//! places are worked through in parallel, and the sums are added in the order of the corners whatever the threads do.

use std::collections::HashMap;
use std::ops::Range;

use foldhash::fast::RandomState;
use rayon::prelude::*;
use snell_math::Vector3;

use super::{corner_angle, position_key, unit};
use crate::scene::Mesh;

/// How many vertices are worked through at once.
const BATCH: usize = 4096;

/// The groups of a mesh's corners (3 · triangle + corner).
pub(super) struct Groups {
    /// The group of each corner.
    pub of_corner: Vec<u32>,
    /// The normal of each group.
    pub normals: Vec<[f32; 3]>,
}

/// Groups all corners; `directions` are the triangles' unit normals. Two triangles with a common edge are in one group where
/// the cosine of the angle between them is at least `cos_crease`.
pub(super) fn of_corners(mesh: &Mesh, directions: &[Vector3], cos_crease: f64) -> Groups {
    let welded = weld(&mesh.positions);
    let Places { starts, corners } = Places::new(mesh, &welded);
    let batches: Vec<Range<usize>> = (0..mesh.positions.len())
        .step_by(BATCH)
        .map(|first| first..(first + BATCH).min(mesh.positions.len()))
        .collect();
    let grouped: Vec<Batch> = batches
        .into_par_iter()
        .map(|places| {
            let mut batch = Batch::default();
            for place in places {
                let corners = &corners[starts[place] as usize..starts[place + 1] as usize];
                batch.group(mesh, &welded, directions, cos_crease, corners);
            }
            batch
        })
        .collect();

    let mut of_corner = vec![0; corners.len()];
    let mut normals = Vec::with_capacity(grouped.iter().map(|batch| batch.normals.len()).sum());
    let mut corners = corners.into_iter();
    for batch in grouped {
        let before = normals.len() as u32;
        for (group, corner) in batch.groups.iter().zip(&mut corners) {
            of_corner[corner as usize] = before + group;
        }
        normals.extend(batch.normals);
    }
    Groups { of_corner, normals }
}

/// For every vertex, the first one at the same place.
fn weld(positions: &[[f32; 3]]) -> Vec<u32> {
    // The hashes differ from run to run, so that nobody can write a file in which all are the same; what is found does not.
    let mut first: HashMap<[u32; 3], u32, RandomState> =
        HashMap::with_capacity_and_hasher(positions.len(), RandomState::default());
    (0u32..).zip(positions).map(|(i, &p)| *first.entry(position_key(p)).or_insert(i)).collect()
}

/// The corners at each place, in order: those of place `p` are at `starts[p]..starts[p + 1]` in `corners`.
struct Places {
    starts: Vec<u32>,
    corners: Vec<u32>,
}

impl Places {
    /// Counts first and then fills.
    fn new(mesh: &Mesh, welded: &[u32]) -> Self {
        let place = |vertex: &u32| welded[*vertex as usize] as usize;
        let vertices = || mesh.triangles.iter().flatten();
        let mut starts = vec![0; mesh.positions.len() + 1];
        vertices().for_each(|vertex| starts[place(vertex) + 1] += 1);
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        // Filled from where each begins; then each start has become the next one's, and is set back.
        let mut corners = vec![0; mesh.triangles.len() * 3];
        for (corner, vertex) in (0..).zip(vertices()) {
            let next = &mut starts[place(vertex)];
            corners[*next as usize] = corner;
            *next += 1;
        }
        starts.rotate_right(1);
        starts[0] = 0;
        Self { starts, corners }
    }
}

/// The groups of some places, one after the other.
#[derive(Default)]
struct Batch {
    /// For each corner, which of the groups here.
    groups: Vec<u32>,
    normals: Vec<[f32; 3]>,
    sums: Vec<Vector3>,
    /// Edges as seen from here: the place of the other end, and which of the corners here; both in one number, to be sorted.
    edges: Vec<u64>,
    parent: Vec<u32>,
}

impl Batch {
    /// Groups the corners at one place.
    fn group(&mut self, mesh: &Mesh, welded: &[u32], directions: &[Vector3], cos_crease: f64, corners: &[u32]) {
        self.edges.clear();
        for (i, &corner) in (0u64..).zip(corners) {
            let triangle = mesh.triangles[corner as usize / 3];
            for step in [1, 2] {
                let to = welded[triangle[(corner as usize + step) % 3] as usize];
                self.edges.push(u64::from(to) << 32 | i);
            }
        }
        self.edges.sort_unstable();
        self.parent.clear();
        self.parent.extend(0..corners.len() as u32);
        for pair in self.edges.windows(2) {
            let [(to_a, a), (to_b, b)] = [pair[0], pair[1]].map(|edge| (edge >> 32, edge as u32));
            let direction = |i: u32| directions[corners[i as usize] as usize / 3];
            if to_a == to_b && direction(a).dot(direction(b)) >= cos_crease {
                let (root_a, root_b) = (find(&mut self.parent, a), find(&mut self.parent, b));
                self.parent[root_a.max(root_b) as usize] = root_a.min(root_b);
            }
        }

        // Roots are the first of their group, so numbering in order meets a root before its members.
        let (first_group, first_corner) = (self.normals.len() as u32, self.groups.len());
        self.sums.clear();
        for (i, &corner) in (0u32..).zip(corners) {
            let root = find(&mut self.parent, i);
            let group = if root == i {
                self.sums.push(Vector3::ZERO);
                self.sums.len() as u32 - 1
            } else {
                self.groups[first_corner + root as usize] - first_group
            };
            let triangle = corner as usize / 3;
            self.sums[group as usize] += directions[triangle] * corner_angle(mesh, triangle, corner as usize % 3);
            self.groups.push(first_group + group);
        }
        self.normals.extend(self.sums.iter().map(|sum| unit(*sum)));
    }
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

//! Meshes: in place or from a file, smoothed and fitted as asked.

use snell_math::{Bounds3, Point3, Transform, Vector3, portable};

use super::{Resolver, polygon};
use crate::assets::Assets;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::model::{self, Located, Triple};
use crate::scene::Mesh;
use crate::table::Id;

impl Resolver<'_> {
    /// A mesh, and the map that fits it as asked.
    pub(super) fn mesh(&mut self, located: &Located<model::Mesh>, name: Option<&str>) -> (Id<Mesh>, Transform) {
        let given = &located.value;
        let id = match &given.file {
            Some(file) => {
                let path = self.assets.resolve(self.base, &file.value);
                let key = (path, given.smooth.map(f64::to_bits));
                match self.meshes.get(&key) {
                    Some(id) => *id,
                    None => {
                        let mesh = self.mesh_from_file(file).map(|mesh| smoothed(mesh, given.smooth));
                        let id = self.scene.meshes.push(mesh.unwrap_or_default());
                        self.meshes.insert(key, id);
                        id
                    }
                }
            }
            None => {
                let mesh = self.mesh_in_place(given, name.unwrap_or("mesh"));
                self.scene.meshes.push(smoothed(mesh, given.smooth))
            }
        };
        let fit = given.fit.as_ref().map_or(Transform::IDENTITY, |size| self.fit(id, size));
        (id, fit)
    }

    fn mesh_from_file(&mut self, file: &Located<String>) -> Option<Mesh> {
        let (path, bytes) = self.file(file)?;
        read_mesh_file(&path, &bytes, self.assets, file, self.diagnostics)
    }

    fn mesh_in_place(&mut self, given: &model::Mesh, name: &str) -> Mesh {
        let mut mesh = Mesh { name: name.to_owned(), ..Mesh::default() };
        let Some(vertices) = &given.vertices else { return mesh };
        let count = vertices.value.len();
        mesh.positions = vertices.value.iter().map(|vertex| single(*vertex)).collect();
        let Some(faces) = &given.faces else {
            self.error(&vertices.span, format!("the mesh {name:?} has vertices but no `faces`"), "between these");
            return mesh;
        };
        for (number, face) in faces.iter().enumerate() {
            if let Some(index) = face.value.iter().find(|index| **index as usize >= count) {
                let message = format!(
                    "face {number} of the mesh {name:?} has the vertex {index}, but there are only {count} vertices"
                );
                self.error(&face.span, message, format!("vertices are numbered from 0 to {}", count - 1));
                continue;
            }
            let corners: Vec<Vector3> = face.value.iter().map(|i| vertices.value[*i as usize].into()).collect();
            let triangles = polygon::triangulate(&corners).into_iter();
            mesh.triangles.extend(triangles.map(|triangle| triangle.map(|corner| face.value[corner])));
        }
        mesh.normals = self.per_vertex(&given.normals, count, name, "normals").iter().map(|n| single(*n)).collect();
        mesh.colors = self.per_vertex(&given.colors, count, name, "colors").iter().map(|c| single(*c)).collect();
        let uvs = self.per_vertex(&given.uvs, count, name, "uvs").iter();
        mesh.uvs = uvs.map(|uv| uv.map(|x| x as f32)).collect();
        mesh
    }

    /// Values of which there must be one for each vertex.
    fn per_vertex<'a, T>(
        &mut self,
        values: &'a Option<Located<Vec<T>>>,
        count: usize,
        name: &str,
        key: &str,
    ) -> &'a [T] {
        let Some(values) = values else { return &[] };
        if values.value.len() != count {
            let message = format!("the mesh {name:?} has {count} vertices but {} {key}", values.value.len());
            self.error(&values.span, message, format!("must be {count}, one for each vertex"));
        }
        &values.value
    }

    /// Scales the longest side to a size, puts the lowest point on y = 0 and the middle above the origin.
    fn fit(&mut self, id: Id<Mesh>, size: &Located<f64>) -> Transform {
        let mesh = &self.scene.meshes[id];
        let point = |p: &[f32; 3]| Point3::from(p.map(f64::from));
        let bounds = mesh.positions.iter().fold(Bounds3::EMPTY, |sum, p| sum.including(point(p)));
        // What is empty has been told already.
        if bounds.is_empty() {
            return Transform::IDENTITY;
        }
        let factor = size.value / bounds.diagonal().max_abs();
        if !(1e-30..=1e30).contains(&factor) {
            let message = format!("the mesh {:?} has no extent to be fitted", mesh.name);
            self.error(&size.span, message, "cannot be scaled to this");
            return Transform::IDENTITY;
        }
        let middle = bounds.center();
        let stand = Vector3::new(-middle.x(), -bounds.min.y(), -middle.z());
        Transform::scale(Vector3::new(factor, factor, factor)) * Transform::translate(stand)
    }
}

/// Reads a mesh file. The one place where the scene format meets the readers of meshes.
fn read_mesh_file(
    path: &str,
    _bytes: &[u8],
    _assets: &dyn Assets,
    named: &Located<String>,
    diagnostics: &mut Diagnostics,
) -> Option<Mesh> {
    let message = format!("the mesh file {path:?} is of no known format");
    diagnostics.push(Diagnostic::error(message).at_optional(named.span.clone(), "named here"));
    None
}

fn single(triple: Triple) -> [f32; 3] {
    triple.map(|x| x as f32)
}

/// A mesh with the normals of faces that meet at less than an angle (degrees) rounded off; vertices on sharper edges are
/// doubled. Normals are the means of the faces' normals, weighted by their angles at the vertex (Thürmer and Wüthrich,
/// "Computing vertex normals from polygonal facets", 1998). As it is, where no angle is given.
fn smoothed(mesh: Mesh, angle: Option<f64>) -> Mesh {
    let Some(angle) = angle else { return mesh };
    if angle == 0.0 {
        return Mesh { normals: Vec::new(), ..mesh };
    }
    let limit = portable::cos(portable::radians(angle));
    let position = |i: u32| Vector3::from(mesh.positions[i as usize].map(f64::from));
    let faces: Vec<Vector3> = mesh
        .triangles
        .iter()
        .map(|[a, b, c]| {
            let normal = (position(*b) - position(*a)).cross(position(*c) - position(*a));
            normal.try_normalize().unwrap_or(Vector3::ZERO)
        })
        .collect();
    // The corners of all triangles, sorted by position, so that vertices doubled for their (u, v) are smoothed together.
    let key = |i: u32| mesh.positions[i as usize].map(|x| (x + 0.0).to_bits());
    let mut corners: Vec<([u32; 3], usize, usize)> = Vec::with_capacity(3 * mesh.triangles.len());
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        corners.extend((0..3).map(|k| (key(triangle[k]), t, k)));
    }
    corners.sort_unstable();
    let weight = |t: usize, k: usize| {
        let [a, b, c] = [0, 1, 2].map(|j| position(mesh.triangles[t][(k + j) % 3]));
        match ((b - a).try_normalize(), (c - a).try_normalize()) {
            (Some(u), Some(v)) => portable::acos(u.dot(v).clamp(-1.0, 1.0)),
            _ => 0.0,
        }
    };
    let mut builder = Doubled::new(&mesh);
    for group in corners.chunk_by(|a, b| a.0 == b.0) {
        let weights: Vec<f64> = group.iter().map(|(_, t, k)| weight(*t, *k)).collect();
        for (_, t, k) in group {
            let same = |other: usize| other == *t || faces[other].dot(faces[*t]) >= limit;
            // A fan around one vertex of very many triangles is averaged whole: looking at all pairs would take too long.
            let all = group.len() > MAX_PAIRS;
            let sum = group.iter().zip(&weights).fold(Vector3::ZERO, |sum, ((_, other, _), weight)| {
                if all || same(*other) { sum + faces[*other] * *weight } else { sum }
            });
            let normal = sum.try_normalize().unwrap_or(faces[*t]);
            builder.corner(*t, *k, single(normal.to_array()));
            if all {
                // All corners have this normal.
                group.iter().for_each(|(_, t, k)| builder.corner(*t, *k, single(normal.to_array())));
                break;
            }
        }
    }
    builder.mesh
}

/// The most triangles around a vertex of which all pairs are compared.
const MAX_PAIRS: usize = 256;

/// A mesh whose vertices are doubled where their corners have different normals.
struct Doubled<'a> {
    old: &'a Mesh,
    mesh: Mesh,
    /// For each old vertex, the new ones made of it.
    made: Vec<Vec<u32>>,
}

impl<'a> Doubled<'a> {
    fn new(old: &'a Mesh) -> Self {
        let empty = Vec::new;
        let mesh = Mesh { positions: empty(), normals: Vec::new(), uvs: Vec::new(), colors: Vec::new(), ..old.clone() };
        Self { old, mesh, made: vec![Vec::new(); old.positions.len()] }
    }

    fn corner(&mut self, triangle: usize, corner: usize, normal: [f32; 3]) {
        let vertex = self.old.triangles[triangle][corner] as usize;
        let found = self.made[vertex].iter().copied().find(|new| self.mesh.normals[*new as usize] == normal);
        let new = found.unwrap_or_else(|| {
            let new = self.mesh.positions.len() as u32;
            self.mesh.positions.push(self.old.positions[vertex]);
            self.mesh.normals.push(normal);
            self.mesh.uvs.extend(self.old.uvs.get(vertex));
            self.mesh.colors.extend(self.old.colors.get(vertex));
            self.made[vertex].push(new);
            new
        });
        self.mesh.triangles[triangle][corner] = new;
    }
}

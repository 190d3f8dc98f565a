//! Meshes: in place or from a file, smoothed and fitted as asked.

use snell_math::{Bounds3, Point3, Transform, Vector3, portable};

use super::Resolver;
use crate::document::model::{self, Located, Triple};
use crate::reader::{self, polygon, smooth_normals};
use crate::scene::Mesh;
use crate::table::Id;

impl Resolver<'_> {
    /// A mesh, and the map that fits it as asked.
    pub(super) fn mesh(&mut self, located: &Located<model::Mesh>, name: Option<&str>) -> (Id<Mesh>, Transform) {
        let given = &located.value;
        let id = match &given.file {
            Some(file) => {
                let path = self.assets.resolve(&self.base, &file.value);
                let key = (path, given.smooth.map(f64::to_bits));
                match self.meshes.get(&key) {
                    Some(id) => *id,
                    None => {
                        let id = self.mesh_from_file(file, given.smooth);
                        self.meshes.insert(key, id);
                        id
                    }
                }
            }
            None => {
                let mut mesh = self.mesh_in_place(given, name.unwrap_or("mesh"));
                smooth(&mut mesh, given.smooth);
                self.scene.meshes.push(mesh)
            }
        };
        let fit = given.fit.as_ref().map_or(Transform::IDENTITY, |size| self.fit(id, size));
        (id, fit)
    }

    /// The mesh of a file, with the materials that it brings. Where it cannot be had, an empty one: the scene is not given
    /// out then.
    fn mesh_from_file(&mut self, named: &Located<String>, crease_angle: Option<f64>) -> Id<Mesh> {
        let said_before = self.diagnostics.list.len();
        let file =
            self.file(named).and_then(|(path, bytes)| reader::read_mesh(&path, &bytes, self.assets, self.diagnostics));
        // What is wrong inside the file is told with the place in the scene that names it.
        if let Some(span) = &named.span {
            for diagnostic in &mut self.diagnostics.list[said_before..] {
                match diagnostic.place {
                    None => diagnostic.place = Some((span.clone(), "named here".to_owned())),
                    Some((ref place, _)) if place != span => {
                        diagnostic.related.push((span.clone(), "named here".to_owned()));
                    }
                    Some(_) => {}
                }
            }
        }
        match file {
            Some(mut file) => {
                smooth(&mut file.mesh, crease_angle);
                file.add_to(&mut self.scene)
            }
            None => self.scene.meshes.push(Mesh::default()),
        }
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
            let corners: Vec<Point3> = face.value.iter().map(|i| vertices.value[*i as usize].into()).collect();
            match polygon::triangulate(&corners) {
                Ok(triangles) => {
                    let of_mesh = |triangle: [u32; 3]| triangle.map(|corner| face.value[corner as usize]);
                    mesh.triangles.extend(triangles.into_iter().map(of_mesh));
                }
                Err(polygon::TooComplex) => {
                    let message = format!("face {number} of the mesh {name:?} has too many corners");
                    self.error(&face.span, message, format!("{} corners", corners.len()));
                }
            }
        }
        mesh.normals = self.per_vertex(&given.normals, count, name, "normals").iter().map(|n| single(*n)).collect();
        let normals = given.normals.as_ref();
        if let Some(number) =
            normals.and_then(|n| n.value.iter().position(|n| Vector3::from(*n).try_normalize().is_none()))
        {
            let span = normals.and_then(|normals| normals.span.clone());
            let message = format!("normal {number} of the mesh {name:?} has no length, and so no direction");
            self.error(&span, message, "one of these");
        }
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

fn single(triple: Triple) -> [f32; 3] {
    triple.map(|x| x as f32)
}

/// Rounds off edges of less than an angle in degrees; 0 shows every face flat. Without an angle, all stays as it is.
fn smooth(mesh: &mut Mesh, crease_angle: Option<f64>) {
    match crease_angle {
        None => {}
        Some(0.0) => mesh.normals.clear(),
        Some(angle) => smooth_normals(mesh, portable::radians(angle)),
    }
}

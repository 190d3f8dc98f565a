//! The lines of triangle meshes: silhouettes, borders, creases, and where materials meet. World space.

use rayon::prelude::*;
use snell_math::{Homogeneous3, Point3, Vector3, portable};

use crate::geometry::WorldSurface;
use crate::outline::{Curve, Feature, FeatureKind};
use crate::shape::triangle_mesh::{EdgeFaces, TriangleMesh};

/// What of a mesh is drawn.
#[derive(Debug)]
pub struct MeshLines {
    /// The lines that a drawing shows.
    pub drawn: Vec<Feature>,
    /// Of them, those that both of its faces turn away from the eye on a closed mesh: hidden by the mesh itself.
    pub surely_hidden: Vec<bool>,
}

/// The lines of a mesh as it is seen from `eye`, a point or the direction towards the viewer; edges at which the faces turn by more
/// than `crease_angle` radians are creases. `from_outside` says that nothing cuts the mesh open between it and the eye.
pub fn mesh_lines(
    surface: &WorldSurface<'_>,
    mesh: &TriangleMesh,
    eye: Homogeneous3,
    crease_angle: f64,
    from_outside: bool,
) -> MeshLines {
    let to_world = |p: Point3| surface.world_from_own.as_ref().map_or(p, |map| map.point(p));
    // Worked out in the world: under a skewing placement angles are other ones than in the mesh's own space.
    let normals: Vec<(Vector3, bool)> = (0..mesh.triangle_count() as u32)
        .into_par_iter()
        .map(|triangle| {
            let [a, b, c] = mesh.triangle(triangle).map(to_world);
            let normal = (b - a).cross(c - a);
            // n · (e − h a): above 0 where the front is seen. A face seen exactly edge on counts as turned away.
            let towards = eye.vector() - a.to_vector() * eye.h();
            (normal.try_normalize().unwrap_or(Vector3::ZERO), normal.dot(towards) > 0.0)
        })
        .collect();
    let edges = mesh.edges();
    let is_closed = edges.iter().all(|edge| matches!(edge.faces, EdgeFaces::Two(_, true)));
    let hides_its_back = is_closed && from_outside && !is_inside(surface, mesh, eye);
    let threshold = portable::cos(crease_angle);
    let lines: Vec<(Feature, bool)> = edges
        .into_par_iter()
        .filter_map(|edge| {
            let (kind, turned_away) = match edge.faces {
                EdgeFaces::One(_) => (FeatureKind::Boundary, false),
                EdgeFaces::Many => (FeatureKind::Crease, false),
                EdgeFaces::Two([first, second], alike) => {
                    let ((n1, front1), (n2, front2)) = (normals[first as usize], normals[second as usize]);
                    let (n2, front2) = if alike { (n2, front2) } else { (-n2, !front2) };
                    let borders = mesh.material_index(first) != mesh.material_index(second);
                    if front1 != front2 {
                        (FeatureKind::Boundary, false)
                    } else if n1.dot(n2) < threshold || borders {
                        (FeatureKind::Crease, hides_its_back && !front1)
                    } else {
                        return None;
                    }
                }
            };
            let [a, b] = edge.vertices.map(|vertex| Homogeneous3::from(to_world(mesh.vertex(vertex))));
            Some((Feature::new(kind, Curve::Segment { a, b }), turned_away))
        })
        .collect();
    let (drawn, surely_hidden) = lines.into_iter().unzip();
    MeshLines { drawn, surely_hidden }
}

/// Whether the eye is inside of a closed mesh.
fn is_inside(surface: &WorldSurface<'_>, mesh: &TriangleMesh, eye: Homogeneous3) -> bool {
    let Ok(eye) = eye.homogenize() else { return false };
    mesh.contains(surface.world_from_own.as_ref().map_or(eye, |map| map.inverse_point(eye)))
}

//! What the targets share: reading whatever comes, and the promises that the result must keep.

use std::sync::Arc;

use snell_scene::assets::{AssetError, Assets};
use snell_scene::document::read_scene as read_document;
use snell_scene::reader::{mesh_bounds, mesh_scene};
use snell_scene::scene::{Mesh, ObjectKind, Shape};
use snell_scene::{Diagnostics, Scene};

/// Gives the same material library under every name that ends in `.mtl`, a few bytes under `.png`, and nothing else.
pub struct Library<'a>(pub &'a [u8]);

impl Assets for Library<'_> {
    fn read(&self, resolved: &str) -> Result<Arc<[u8]>, AssetError> {
        match resolved.rsplit_once('.') {
            Some((_, "mtl")) => Ok(self.0.into()),
            Some((_, "png")) => Ok(b"pixels".as_slice().into()),
            _ => Err(AssetError::NotFound),
        }
    }
}

/// Reads a mesh, puts a scene around it and checks both.
pub fn read_mesh(name: &str, bytes: &[u8], library: &[u8]) {
    let (scene, diagnostics) = mesh_scene(name, bytes, &Library(library));
    check(scene.as_ref(), &diagnostics);
}

/// A scene or an error, never both; every message says something, and every place is in its text.
fn check_diagnostics(scene: Option<&Scene>, diagnostics: &Diagnostics) {
    assert_ne!(scene.is_some(), diagnostics.has_errors());
    assert!(diagnostics.list.len() < 1000);
    for diagnostic in &diagnostics.list {
        assert!(!diagnostic.message.is_empty());
        if let Some((span, _)) = &diagnostic.place {
            assert!(span.range.end <= diagnostics.sources.get(span.source).text.len());
            diagnostics.sources.location(span);
        }
    }
}

/// What [`check_diagnostics`] asks, and everything in its range.
pub fn check(scene: Option<&Scene>, diagnostics: &Diagnostics) {
    check_diagnostics(scene, diagnostics);
    let Some(scene) = scene else { return };
    assert!(scene.camera.eye.is_finite() && scene.camera.gaze.is_finite() && scene.camera.gaze.length() > 0.0);
    assert!(!scene.objects.is_empty());
    scene.meshes.iter().for_each(|mesh| check_mesh(mesh, scene));
    for object in &scene.objects {
        let ObjectKind::Shape(shape) = &object.kind else { continue };
        match shape {
            Shape::Sphere { center, radius } => assert!(center.is_finite() && *radius > 0.0),
            Shape::Cylinder { base, top, radius, .. } => assert!(base != top && *radius > 0.0),
            Shape::Cone { base, base_radius, top, top_radius, .. } => {
                assert!(base != top && *base_radius >= 0.0 && *top_radius >= 0.0 && base_radius != top_radius);
            }
            _ => {}
        }
    }
    for light in &scene.lights {
        assert!(light.intensity.is_finite());
    }
}

fn check_mesh(mesh: &Mesh, scene: &Scene) {
    let count = mesh.positions.len();
    assert!(!mesh.triangles.is_empty());
    assert!(mesh.triangles.iter().flatten().all(|&v| (v as usize) < count));
    assert!(mesh.positions.iter().flatten().all(|c| c.is_finite()));
    for length in [mesh.normals.len(), mesh.uvs.len(), mesh.colors.len()] {
        assert!(length == 0 || length == count);
    }
    assert!(mesh.normals.iter().all(|n| n.iter().all(|c| c.is_finite()) && n.iter().any(|&c| c != 0.0)));
    assert!(mesh.uvs.iter().flatten().chain(mesh.colors.iter().flatten()).all(|c| c.is_finite()));
    assert!(mesh.triangle_materials.is_empty() || mesh.triangle_materials.len() == mesh.triangles.len());
    assert!(mesh.triangle_materials.iter().all(|&m| usize::from(m) < mesh.materials.len()));
    assert!(mesh.materials.iter().all(|m| m.index() < scene.materials.len()));
    assert!(mesh_bounds(mesh).is_finite());
}

/// The files that a fuzzed scene may name: a mesh under every name that ends in `.obj`, and a few bytes under `.png`.
struct Beside;

impl Assets for Beside {
    fn read(&self, resolved: &str) -> Result<Arc<[u8]>, AssetError> {
        match resolved.rsplit_once('.') {
            Some((_, "obj")) => Ok(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".as_slice().into()),
            Some((_, "png")) => Ok(b"pixels".as_slice().into()),
            _ => Err(AssetError::NotFound),
        }
    }
}

/// Reads a scene file and checks that there is a scene or an error, never both, and that places lie in their text.
pub fn read_scene(name: &str, bytes: &[u8]) {
    let (scene, diagnostics) = read_document(name, bytes, &Beside, &[]);
    check_diagnostics(scene.as_ref(), &diagnostics);
}

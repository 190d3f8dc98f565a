//! Every mesh under the shared assets loads or is refused in words; of some, the number of triangles is known.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::assets::{AssetError, Assets};
use crate::reader::{MeshFile, MeshFormat, mesh_scene, read_mesh};
use crate::scene::{Mesh, ObjectKind, Shape};
use crate::{Diagnostics, Severity};

/// Files of the disk, for tests alone.
pub(in crate::reader) struct Disk;

impl Assets for Disk {
    fn read(&self, resolved: &str) -> Result<Arc<[u8]>, AssetError> {
        match std::fs::read(resolved) {
            Ok(bytes) => Ok(bytes.into()),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Err(AssetError::NotFound),
            Err(error) => Err(AssetError::Unreadable(error.to_string())),
        }
    }
}

/// The folder of shared test files, where it is there.
pub(in crate::reader) fn shared() -> Option<PathBuf> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/assets"));
    if path.is_dir() {
        return Some(path.to_owned());
    }
    println!("skipped: {} is not there", path.display());
    None
}

/// All files in a folder and the folders in it, in order.
fn walk(folder: &Path, files: &mut Vec<PathBuf>) {
    let mut entries: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    entries.sort();
    for entry in entries {
        if entry.is_dir() {
            walk(&entry, files);
        } else {
            files.push(entry);
        }
    }
}

/// What the description of [`Mesh`] promises to everyone.
pub(in crate::reader) fn check_mesh(file: &MeshFile) {
    let Mesh { positions, triangles, normals, uvs, colors, triangle_materials, .. } = &file.mesh;
    assert!(!triangles.is_empty());
    assert!(triangles.iter().flatten().all(|&v| (v as usize) < positions.len()));
    assert!(positions.iter().flatten().all(|c| c.is_finite()));
    for (what, count) in [("normals", normals.len()), ("uvs", uvs.len()), ("colors", colors.len())] {
        assert!(count == 0 || count == positions.len(), "{count} {what} for {} vertices", positions.len());
    }
    assert!(normals.iter().all(|n| n.iter().all(|c| c.is_finite()) && n.iter().any(|&c| c != 0.0)));
    assert!(uvs.iter().flatten().chain(colors.iter().flatten()).all(|c| c.is_finite()));
    assert!(triangle_materials.is_empty() || triangle_materials.len() == triangles.len());
    assert!(triangle_materials.iter().all(|&m| usize::from(m) < file.materials.len()));
}

#[test]
fn every_mesh_at_hand_loads_or_is_refused_in_words() {
    let Some(shared) = shared() else { return };
    let mut files = Vec::new();
    for folder in ["meshes", "obj-tests", "ply-tests", "stl-tests", "bad", "scenes"] {
        walk(&shared.join(folder), &mut files);
    }
    let (mut loaded, mut refused) = (0, 0);
    for path in files {
        let (name, bytes) = (path.to_str().unwrap(), std::fs::read(&path).unwrap());
        // Files of other kinds go through as well: they must be refused in words.
        let mut diagnostics = Diagnostics::default();
        let file = read_mesh(name, &bytes, &Disk, &mut diagnostics);
        let verbose = std::env::var_os("SNELL_SHOW").is_some() && MeshFormat::from_name(name).is_some();
        if verbose {
            println!("== {name} {:?}", file.as_ref().map(|f| (f.mesh.triangles.len(), f.materials.len())));
            for d in &diagnostics.list {
                let place = d.place.as_ref().map(|(span, _)| diagnostics.sources.location(span).rsplit('/').next().unwrap().to_owned());
                println!("   {:?} {place:?} {} ({:?})", d.severity, d.message, d.help);
            }
        }
        match file {
            Some(file) => {
                loaded += 1;
                assert!(!diagnostics.has_errors(), "{name}");
                check_mesh(&file);
                let (scene, _) = mesh_scene(name, &bytes, &Disk);
                assert!(scene.unwrap().camera.eye.is_finite());
            }
            None => {
                refused += 1;
                let first = diagnostics.list.iter().find(|d| d.severity == Severity::Error).expect(name);
                assert!(first.message.len() > 10 && !first.message.ends_with('.'), "{}", first.message);
            }
        }
    }
    println!("{loaded} loaded, {refused} refused");
}

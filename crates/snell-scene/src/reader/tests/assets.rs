//! Every mesh under the shared assets loads or is refused in words; of some, the number of triangles is known.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::assets::{AssetError, Assets};
use crate::reader::{MeshFile, mesh_scene, nff, read_mesh};
use crate::scene::Mesh;
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

#[test]
fn files_have_the_triangles_that_other_programs_count() {
    let Some(shared) = shared() else { return };
    for (path, triangles, positions) in [
        ("meshes/spot.obj", 5856, 3225),
        ("meshes/bitterli-cornell-box/glass_sphere.obj", 15872, 0),
        ("meshes/cornell_box_embree.obj", 34, 0),
        ("obj-tests/assimp/box.obj", 12, 8),
        ("obj-tests/assimp/spider.obj", 1368, 0),
        ("obj-tests/assimp/WusonOBJ.obj", 3732, 0),
        ("obj-tests/tinyobjloader/catmark_torus_creases0.obj", 64, 128),
        ("obj-tests/tobj/quad.obj", 5, 0),
        ("ply-tests/assimp/cube.ply", 12, 8),
        ("ply-tests/assimp/cube_binary.ply", 12, 8),
        ("ply-tests/assimp/cube_binary_header_with_RN_newline.ply", 12, 8),
        ("ply-tests/assimp/cube_binary_starts_with_nl.ply", 12, 8),
        ("ply-tests/assimp/cube_uv.ply", 12, 24),
        ("ply-tests/assimp/Wuson.ply", 3732, 11184),
        ("ply-tests/happly/platonic_shelf.ply", 80, 50),
        ("ply-tests/happly/platonic_shelf_ascii.ply", 80, 50),
        ("ply-tests/happly/platonic_shelf_big_endian.ply", 80, 50),
        ("stl-tests/assimp/Spider_ascii.stl", 1368, 0),
        ("stl-tests/assimp/Spider_binary.stl", 1368, 0),
        ("stl-tests/assimp/Wuson.stl", 3732, 0),
        ("stl-tests/assimp/formatDetection", 1, 3),
        ("stl-tests/assimp/triangle_with_two_solids.stl", 2, 0),
    ] {
        let path = shared.join(path);
        let mut diagnostics = Diagnostics::default();
        let file = read_mesh(path.to_str().unwrap(), &std::fs::read(&path).unwrap(), &Disk, &mut diagnostics);
        let mesh = file.unwrap_or_else(|| panic!("{path:?}: {:?}", diagnostics.list)).mesh;
        assert_eq!(mesh.triangles.len(), triangles, "{path:?}");
        assert!(positions == 0 || mesh.positions.len() == positions, "{path:?}: {}", mesh.positions.len());
    }
}

/// Every edge belongs to two triangles, once in each direction.
fn is_closed(mesh: &Mesh) -> bool {
    let mut edges: Vec<[u32; 2]> =
        mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).filter(|[a, b]| a != b).collect();
    edges.sort_unstable();
    edges.windows(2).all(|w| w[0] != w[1]) && edges.iter().all(|&[a, b]| edges.binary_search(&[b, a]).is_ok())
}

#[test]
fn closed_bodies_stay_closed() {
    let Some(shared) = shared() else { return };
    for (path, closed) in [
        ("ply-tests/assimp/cube_binary.ply", true),
        ("meshes/spot.obj", false), // split along the seams of its texture
        ("stl-tests/assimp/sphereWithHole.stl", false),
    ] {
        let path = shared.join(path);
        let file =
            read_mesh(path.to_str().unwrap(), &std::fs::read(&path).unwrap(), &Disk, &mut Diagnostics::default());
        assert_eq!(is_closed(&file.unwrap().mesh), closed, "{path:?}");
    }
}

#[test]
fn every_procedural_database_loads() {
    let Some(shared) = shared() else { return };
    let mut files = Vec::new();
    walk(&shared.join("spd-nff"), &mut files);
    files.retain(|path| path.extension().is_some_and(|e| e == "nff"));
    assert_eq!(files.len(), 15);
    for path in files {
        let (scene, diagnostics) = nff::read(path.to_str().unwrap(), &std::fs::read(&path).unwrap());
        // The smallest teapot has four patches without area.
        let expected = if path.ends_with("teapot-s1.nff") { 4 } else { 0 };
        assert_eq!(diagnostics.list.len(), expected, "{path:?}: {:?}", diagnostics.list);
        let scene = scene.unwrap();
        for mesh in scene.meshes.iter() {
            check_mesh(&MeshFile { mesh: mesh.clone(), ..MeshFile::default() });
        }
    }
}

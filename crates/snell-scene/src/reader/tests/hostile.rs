//! Files cut off at many places, with bytes changed, or with promises that they do not keep: no panic, no hang, and
//! every refusal in words.

use proptest::prelude::*;

use super::assets::{check_mesh, shared};
use crate::Diagnostics;
use crate::assets::MemoryAssets;
use crate::reader::{nff, read_mesh};

/// Reads a file in memory; whatever comes must be sound.
fn read(name: &str, bytes: &[u8]) -> Result<usize, String> {
    let mut diagnostics = Diagnostics::default();
    let file = read_mesh(name, bytes, &MemoryAssets::default(), &mut diagnostics);
    assert!(diagnostics.list.len() < 400, "too many messages");
    for (span, _) in diagnostics.list.iter().filter_map(|d| d.place.as_ref()) {
        assert!(!diagnostics.sources.location(span).is_empty());
    }
    match file {
        Some(file) => {
            check_mesh(&file);
            Ok(file.mesh.triangles.len())
        }
        None => Err(diagnostics.list.first().expect("a refusal has a reason").message.clone()),
    }
}

#[test]
fn files_cut_off_anywhere_are_read_or_refused() {
    let Some(shared) = shared() else { return };
    for (path, step) in [
        ("ply-tests/assimp/cube.ply", 1),
        ("ply-tests/assimp/cube_binary.ply", 1),
        ("ply-tests/happly/platonic_shelf_big_endian.ply", 3),
        ("obj-tests/assimp/cube_usemtl.obj", 1),
        ("obj-tests/tinyobjloader/issue-295-trianguation-failure.obj", 1),
        ("stl-tests/assimp/triangle_with_two_solids.stl", 1),
        ("stl-tests/assimp/Spider_binary.stl", 977),
        ("meshes/spot.obj", 9973),
    ] {
        let bytes = std::fs::read(shared.join(path)).unwrap();
        for end in (0..bytes.len()).step_by(step) {
            let _ = read(path, &bytes[..end]);
        }
    }
    for (path, step) in [("spd-nff/tree-s2.nff", 1), ("spd-nff/teapot-s1.nff", 7), ("spd-nff/balls-s1.nff", 1)] {
        let bytes = std::fs::read(shared.join(path)).unwrap();
        for end in (0..bytes.len()).step_by(step) {
            let (scene, diagnostics) = nff::read(path, &bytes[..end]);
            assert!(scene.is_some() != diagnostics.has_errors());
        }
    }
}

#[test]
fn a_binary_file_that_is_cut_off_is_refused() {
    let Some(shared) = shared() else { return };
    for path in ["ply-tests/assimp/cube_binary.ply", "stl-tests/assimp/Spider_binary.stl"] {
        let bytes = std::fs::read(shared.join(path)).unwrap();
        assert!(read(path, &bytes).is_ok());
        assert!(read(path, &bytes[..bytes.len() - 1]).is_err());
        assert!(read(path, &bytes[..bytes.len() / 2]).is_err());
    }
}

#[test]
fn promises_that_the_bytes_do_not_keep_are_refused_at_once() {
    let ply = |format: &str, vertices: &str, faces: &str| {
        format!(
            "ply\nformat {format} 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
             element face {faces}\nproperty list uint uint vertex_indices\nend_header\n"
        )
    };
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        for (vertices, faces) in
            [("4000000000", "1"), ("0", "4000000000"), ("999999999999999999", "0"), ("0", "99999999999999999999")]
        {
            let error = read("a.ply", ply(format, vertices, faces).as_bytes()).unwrap_err();
            assert!(error.contains("promises") || error.contains("no count") || error.contains("32-bit"), "{error}");
        }
    }
    // A list that promises four thousand million corners, and one of negative length.
    let mut list = ply("binary_little_endian", "1", "1").into_bytes();
    list.extend([0; 12]);
    list.extend([0xff; 4]);
    assert!(read("a.ply", &list).unwrap_err().contains("ends within row 0"));
    let negative = ply("ascii", "1", "1").replace("list uint", "list char") + "0 0 0\n-7 0 0 0\n";
    assert!(read("a.ply", negative.as_bytes()).unwrap_err().contains("no count"));
    let mut stl = vec![b' '; 84];
    stl[80..].copy_from_slice(&4_000_000_000u32.to_le_bytes());
    assert!(read("a.stl", &stl).unwrap_err().contains("promises 4000000000 triangles"));
    assert!(nff::read("a.nff", b"p 4000000000\n0 0 0\n").1.has_errors());
}

/// Inputs on which fuzzing once found a reader to fail.
#[test]
fn what_once_failed_does_not_fail_again() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/fuzz");
    let mut count = 0;
    for target in std::fs::read_dir(folder).unwrap() {
        let target = target.unwrap();
        for file in std::fs::read_dir(target.path()).unwrap() {
            let bytes = std::fs::read(file.unwrap().path()).unwrap();
            let split = bytes.iter().position(|&b| b == 0xff).unwrap_or(bytes.len());
            match target.file_name().to_str().unwrap() {
                "nff" => _ = nff::read("a.nff", &bytes),
                "obj" => _ = read("a.obj", &bytes[..split]),
                other => _ = read(&format!("a.{other}"), &bytes),
            }
            count += 1;
        }
    }
    assert!(count > 0);
}

#[test]
fn a_million_mistakes_give_a_short_list() {
    let text = "f 1 2 3\nv x y z\nunknown\nf 1 2\n".repeat(50_000);
    assert!(read("a.obj", text.as_bytes()).is_err());
    let nff = "s 0 0\nq\nf 1 1\n".repeat(50_000);
    let (scene, diagnostics) = nff::read("a.nff", nff.as_bytes());
    assert!(scene.is_none() && diagnostics.list.len() < 200);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]
    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..300), kind in 0usize..4) {
        let name = ["a.ply", "a.obj", "a.stl", "a"][kind];
        let prefix: &[u8] = [b"ply\nformat ascii 1.0\n" as &[u8], b"v 0 0 0\nf ", b"solid\n", b""][kind];
        let _ = read(name, &[prefix, &bytes].concat());
        let _ = nff::read("a.nff", &bytes);
    }

    #[test]
    fn words_of_the_formats_in_any_order_are_read_or_refused(
        words in prop::collection::vec(prop::sample::select(vec![
            "v", "vt", "vn", "f", "1", "2/2", "-1//1", "0", "1e38", "-3.5", "\n", "\n", "\\\n", "usemtl", "mtllib", "a.mtl", "#",
            "solid", "facet", "outer", "vertex", "endfacet", "from", "at", "up", "angle", "s", "c", "p", "pp", "3", "4", "b", "l",
        ]), 0..120),
    ) {
        let text = words.join(" ");
        let _ = read("a.obj", text.as_bytes());
        let _ = read("a.stl", format!("solid\n{text}").as_bytes());
        let _ = nff::read("a.nff", text.as_bytes());
    }
}

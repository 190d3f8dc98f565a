//! What STL files mean, in small ones written here.

use super::*;
use crate::Diagnostics;
use crate::assets::MemoryAssets;
use crate::reader::read_mesh;

fn read_all(bytes: &[u8]) -> (Option<MeshFile>, Vec<String>) {
    let mut diagnostics = Diagnostics::default();
    let file = read_mesh("a.stl", bytes, &MemoryAssets::default(), &mut diagnostics);
    let told = diagnostics.list.iter().map(|d| match &d.place {
        Some((span, _)) => format!("{} {}", diagnostics.sources.location(span), d.message),
        None => d.message.clone(),
    });
    (file, told.collect())
}

/// A binary file of a tetrahedron's faces.
fn tetrahedron(header: &[u8]) -> Vec<u8> {
    let p = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -0.0, 1.0]];
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(4u32.to_le_bytes());
    for face in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] {
        bytes.extend([0; 12]);
        for c in face.iter().flat_map(|&v| p[v as usize]) {
            // Zeros of either sign are the same place.
            let c: f32 = if c == 0.0 && face[0] == 1 { -0.0 } else { c };
            bytes.extend(c.to_le_bytes());
        }
        bytes.extend([0xff; 2]);
    }
    bytes
}

#[test]
fn equal_corners_become_one_vertex() {
    for header in [b"anything".as_slice(), b"solid that lies", b""] {
        let (file, told) = read_all(&tetrahedron(header));
        let mesh = file.unwrap().mesh;
        assert!(told.is_empty());
        assert_eq!(mesh.positions.len(), 4);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [2, 1, 3], [1, 0, 3]]);
    }
}

#[test]
fn a_wrong_count_is_told() {
    let mut long = tetrahedron(b"x");
    long.extend([0; 70]);
    let (file, told) = read_all(&long);
    assert_eq!(file.unwrap().mesh.triangles.len(), 4);
    assert_eq!(told, ["a.stl, byte 80: the header promises 4 triangles, but the file has bytes for 5"]);
    let (file, told) = read_all(&tetrahedron(b"x")[..200]);
    assert!(file.is_none());
    assert_eq!(told, ["a.stl, byte 80: the header promises 4 triangles, but the file has bytes for 2"]);
}

const TEXT: &str = "solid one\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n  endloop\n endfacet\nendsolid one\n";

#[test]
fn several_solids_are_one_mesh() {
    let (file, told) = read_all(format!("{TEXT}{}solid empty\nendsolid\n", TEXT.to_uppercase()).as_bytes());
    let mesh = file.unwrap().mesh;
    assert!(told.is_empty(), "{told:?}");
    assert_eq!((mesh.triangles.len(), mesh.positions.len()), (2, 3));
}

#[test]
fn problems_are_told_with_their_places() {
    let text = TEXT.replace("vertex 1 0 0", "vertex 1 0")
        + &TEXT.replace("   vertex 0 0 0\n", "")
        + "facte\nvertex 0 0 0\nfacet";
    let (file, told) = read_all(text.as_bytes());
    assert!(file.is_none());
    assert_eq!(
        told,
        [
            "a.stl:5:4 a vertex needs three numbers",
            "a.stl:11:2 this facet has 2 vertices instead of three",
            "a.stl:18:1 unknown word `facte`",
            "a.stl:19:1 a vertex outside of any facet",
            "a.stl:20:1 the file ends within this facet",
        ]
    );
}

#[test]
fn corners_that_are_not_finite_are_refused() {
    let mut bytes = tetrahedron(b"x");
    bytes[84 + 50 + 12..84 + 50 + 16].copy_from_slice(&f32::NAN.to_le_bytes());
    let (file, told) = read_all(&bytes);
    assert!(file.is_none());
    assert_eq!(told, ["a.stl, byte 134: triangle 1 has a corner that is not finite"]);
}

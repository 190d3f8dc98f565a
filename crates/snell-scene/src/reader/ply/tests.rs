//! What PLY files mean, in small ones written here.

use crate::assets::MemoryAssets;
use crate::reader::{MeshFile, read_mesh};
use crate::{Diagnostics, Severity};

fn read(bytes: &[u8]) -> (Option<MeshFile>, Diagnostics) {
    let mut diagnostics = Diagnostics::default();
    let file = read_mesh("a.ply", bytes, &MemoryAssets::default(), &mut diagnostics);
    (file, diagnostics)
}

fn good(text: &str) -> MeshFile {
    let (file, diagnostics) = read(text.as_bytes());
    assert!(diagnostics.list.is_empty(), "{:?}", diagnostics.list);
    file.unwrap()
}

/// Message and `line:column` of every problem.
fn problems(text: &str) -> Vec<(String, String)> {
    let (_, diagnostics) = read(text.as_bytes());
    let place = |d: &crate::Diagnostic| d.place.as_ref().map(|(span, _)| diagnostics.sources.location(span));
    diagnostics.list.iter().map(|d| (d.message.clone(), place(d).unwrap_or_default())).collect()
}

const FULL: &str = "ply
format ascii 1.0
comment everything at once
element vertex 4
property double x
property double y
property double z
property float confidence
property float nx
property float ny
property float nz
property float s
property float t
property uchar red
property uchar green
property uchar blue
property list uchar int extra
element edge 2
property int a
element face 2
property uchar flag
property list uchar int vertex_index
property list uchar float texcoord
end_header
0 0 0 9 0 0 1 0 0 255 0 0 2 7 7
1 0 0 9 0 0 1 1 0 0 255 0 0
1 1 0 9 0 0 1 1 1 0 0 255 1 5

0 1 0 9 0 0 1 0 1 128 128 128 0
5
6
1 4 0 1 2 3 2 0.5 0.5
2 3 0 1 2 0
";

#[test]
fn all_that_a_vertex_can_have_is_read_and_the_rest_skipped() {
    let file = good(FULL);
    let mesh = &file.mesh;
    assert_eq!(mesh.positions[2], [1.0, 1.0, 0.0]);
    assert_eq!(mesh.normals[3], [0.0, 0.0, 1.0]);
    assert_eq!(mesh.uvs, [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    assert_eq!(mesh.colors[1], [0.0, 1.0, 0.0]);
    // sRGB 128 is 21.6 % of the light.
    assert!((mesh.colors[3][0] - 0.215_860_5).abs() < 1e-6);
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 2]]);
}

/// Binary twins of a small ascii file, of either byte order.
fn binary(big: bool) -> Vec<u8> {
    let order = if big { "big" } else { "little" };
    let mut bytes = format!(
        "ply\r\nformat binary_{order}_endian 1.0\r\nelement other 2\r\nproperty short a\r\nproperty list ushort double b\r\n\
         element vertex 4\r\nproperty short x\r\nproperty float y\r\nproperty double z\r\nproperty ushort red\r\n\
         property ushort green\r\nproperty ushort blue\r\nelement face 1\r\nproperty list char ushort vertex_indices\r\nend_header\r\n"
    )
    .into_bytes();
    let mut put = |little: &[u8]| {
        if big { bytes.extend(little.iter().rev()) } else { bytes.extend(little) }
    };
    for row in 0..2u16 {
        put(&7i16.to_le_bytes());
        put(&row.to_le_bytes());
        (0..row).for_each(|_| put(&1.5f64.to_le_bytes()));
    }
    for (x, y, z) in [(-10i16, 0.5f32, 2.25f64), (10, 0.5, 2.25), (10, 300.0, 2.25), (-10, 300.0, 2.25)] {
        put(&x.to_le_bytes());
        put(&y.to_le_bytes());
        put(&z.to_le_bytes());
        [65535u16, 0, 0].iter().for_each(|c| put(&c.to_le_bytes()));
    }
    put(&[4]);
    [0u16, 1, 2, 3].iter().for_each(|i| put(&i.to_le_bytes()));
    bytes
}

#[test]
fn both_byte_orders_mean_the_same() {
    for big in [false, true] {
        let (file, diagnostics) = read(&binary(big));
        assert!(diagnostics.list.is_empty(), "{:?}", diagnostics.list);
        let mesh = file.unwrap().mesh;
        assert_eq!(mesh.positions[3], [-10.0, 300.0, 2.25]);
        assert_eq!(mesh.colors[0], [1.0, 0.0, 0.0]);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    }
}

#[test]
fn binary_problems_name_the_byte() {
    let mut bytes = binary(false);
    let end = bytes.len();
    bytes[end - 2] = 9;
    let (file, diagnostics) = read(&bytes);
    assert!(file.is_none());
    let message = &diagnostics.list[0].message;
    assert_eq!(*message, format!("a.ply, byte {}: face 0 names vertex 9, but there are 4 vertices", end - 2));
}

#[test]
fn strips_turn_every_second_triangle_and_begin_again_at_minus_one() {
    let text = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
        element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
        0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 -1 2 3 4 -1\n";
    assert_eq!(good(text).mesh.triangles, [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
}

#[test]
fn floating_point_colours_are_linear() {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property float red\nproperty float green\nproperty float blue\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n\
        0 0 0 0.5 0 0\n1 0 0 0 2 0\n0 1 0 0 0 -1\n3 0 1 2\n";
    assert_eq!(good(text).mesh.colors, [[0.5, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 0.0]]);
}

#[test]
fn problems_of_the_header_are_told_all_at_once() {
    let text = "ply\nformat ascii 1.0\nelement vertex three\nelement vertex 3\nproprety float x\nproperty flaot y\n\
        property list float int z\nsomething else\nend_header\n";
    let all = problems(text);
    let expected = [
        ("`three` is no count of elements", "a.ply:3:16"),
        ("unknown word `proprety` in the header", "a.ply:5:1"),
        ("unknown type of a property", "a.ply:6:10"),
        ("the count of a list must be of an integer type", "a.ply:7:1"),
        ("unknown word `something` in the header: this line is left out", "a.ply:8:1"),
    ];
    assert_eq!(all, expected.map(|(m, p)| (m.to_owned(), p.to_owned())));
}

#[test]
fn problems_of_the_rows_are_told_with_their_places() {
    let (head, rows) = FULL.split_once("end_header\n").unwrap();
    let line = |n: usize| format!("a.ply:{}", head.lines().count() + 1 + n);
    let changed = |from: &str, to: &str| problems(&format!("{head}end_header\n{}", rows.replacen(from, to, 1)));
    assert_eq!(changed("1 0 0 9", "1 0 0,5 9"), [("`0,5` is no number".to_owned(), line(2) + ":5")]);
    assert_eq!(
        changed("1 0 0 9", "1 1e99 0 9"),
        [("the position of vertex 1 is 1e99, which is not finite or too large".to_owned(), line(2) + ":3")]
    );
    assert_eq!(
        changed("0 0 0 9 ", "0 0 0 9 8 "),
        [("more on this line than the header declares: it is ignored".to_owned(), line(1) + ":29")]
    );
    let short = changed("3 0 1 2 0", "3 0 1");
    assert_eq!(short, [("row 1 of `face` has fewer numbers than the header declares".to_owned(), line(9) + ":1")]);
    let (_, diagnostics) = read(FULL.replace("3 0 1 2 0", "2 0 1 0").as_bytes());
    assert_eq!(diagnostics.list[0].severity, Severity::Warning);
}

//! What OBJ and MTL files mean, in small ones written here.

mod parallel;

use snell_math::Rgb;

use crate::assets::MemoryAssets;
use crate::reader::{ColorFile, MaterialFile, MeshFile, read_mesh};
use crate::scene::{Pattern, Space};
use crate::{Diagnostics, Scene};

const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn read_with(assets: &MemoryAssets, text: &str) -> (Option<MeshFile>, Diagnostics) {
    let mut diagnostics = Diagnostics::default();
    let file = read_mesh("dir/a.obj", text.as_bytes(), assets, &mut diagnostics);
    (file, diagnostics)
}

fn good(text: &str) -> MeshFile {
    let (file, diagnostics) = read_with(&MemoryAssets::default(), text);
    assert!(diagnostics.list.is_empty(), "{:?}", diagnostics.list);
    file.unwrap()
}

/// The material that a library gives.
fn material(statements: &str) -> MaterialFile {
    let assets = MemoryAssets::default().with("dir/a.mtl", format!("newmtl m\n{statements}\n").as_bytes());
    let (file, diagnostics) = read_with(&assets, &format!("mtllib a.mtl\n{CORNERS}usemtl m\nf 1 2 3\n"));
    assert!(diagnostics.list.is_empty(), "{:?}", diagnostics.list);
    file.unwrap().materials.remove(0)
}

fn problems(text: &str) -> Vec<(String, String)> {
    let (_, diagnostics) = read_with(&MemoryAssets::default(), text);
    let place = |d: &crate::Diagnostic| d.place.as_ref().map(|(span, _)| diagnostics.sources.location(span));
    diagnostics.list.iter().map(|d| (d.message.clone(), place(d).unwrap_or_default())).collect()
}

const fn gray(value: f32) -> ColorFile {
    ColorFile::Constant(Rgb::gray(value))
}

#[test]
fn corners_may_be_written_in_all_forms() {
    let text = format!(
        "{CORNERS}vt 0 0\nvt 1 0 7\nvt 0.5\nvn 0 0 1\nf 1 2 3\nf -4/1 2/2 3/3\nf 1//1 -3//-1 3//1\nf 1/1/1 2/2/1 3/3/1\n"
    );
    let mesh = good(&text).mesh;
    assert_eq!(mesh.triangles.len(), 4);
    for triangle in &mesh.triangles {
        assert_eq!(triangle.map(|v| mesh.positions[v as usize]), [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]);
        assert!(triangle.iter().all(|&v| mesh.normals[v as usize] == [0.0, 0.0, 1.0]));
    }
    assert_eq!(mesh.triangles[3].map(|v| mesh.uvs[v as usize]), [[0.0, 0.0], [1.0, 0.0], [0.5, 0.0]]);
}

#[test]
fn equal_triples_share_a_vertex_in_order_of_first_use() {
    let text = format!("{CORNERS}vt 0 0\nvt 1 0\nf 3/1 1/1 2/2\nf 1/1 2/1 3/1\nf 2/2 2/1 1/1\n");
    let mesh = good(&text).mesh;
    assert_eq!(mesh.triangles, [[0, 1, 2], [1, 3, 0], [2, 3, 1]]);
    assert_eq!(mesh.positions.len(), 4);
    assert_eq!(good(&format!("{CORNERS}f 4 2 1\n")).mesh.triangles, [[3, 1, 0]]);
}

#[test]
fn triangles_without_normals_among_others_are_flat() {
    let text = format!("{CORNERS}v 0 0 1\nvn 1 0 0\nf 1//1 2//1 3//1\nf 1 2 5\nf 1 5 4\n");
    let mesh = good(&text).mesh;
    assert_eq!(mesh.triangles[1].map(|v| mesh.normals[v as usize]), [[0.0, -1.0, 0.0]; 3]);
    assert_eq!(mesh.triangles[2].map(|v| mesh.normals[v as usize]), [[-1.0, 0.0, 0.0]; 3]);
}

#[test]
fn polygons_of_any_shape_are_cut_into_triangles() {
    let text = "v 0 0 5\nv 2 -1 5\nv 0 3 5\nv -2 -1 5\nf 1 2 3 4\nf 2 3 4\n";
    let mesh = good(text).mesh;
    assert_eq!(mesh.triangles.len(), 3);
    let area: f32 = mesh.triangles[..2]
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
            0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
        })
        .sum();
    assert_eq!(area, 6.0);
}

#[test]
fn lines_go_on_after_a_backslash_and_may_end_in_comments() {
    let text = "v 0 0 \\\n0 # one\nv 1 \\\r\n 0 0\nv 1 1 0#\nf 1 2 \\\n3 # face\n".replace("0#", "0 #");
    assert_eq!(good(&text).mesh.triangles, [[0, 1, 2]]);
}

#[test]
fn vertices_may_have_a_weight_or_a_colour() {
    let mesh = good("v 0 0 0 1.0\nv 1 0 0 1 0 0.5\nv 1 1 0 0 1 0 1\nf 1 2 3\n").mesh;
    assert_eq!(mesh.colors[0], [1.0; 3]);
    assert_eq!(mesh.colors[2], [0.0, 1.0, 0.0]);
    assert!((mesh.colors[1][2] - 0.214_041_14).abs() < 1e-6);
}

#[test]
fn names_may_hold_spaces_and_libraries_may_be_several() {
    let assets = MemoryAssets::default()
        .with("dir/my file.mtl", b"newmtl dark red  \nKd 0.5 0 0\n")
        .with("dir/b.mtl", b"newmtl b\nKd 0.25\nnewmtl dark red\nKd 1 1 1\n");
    let text = format!(
        "{CORNERS}f 1 2 3\nusemtl dark red\nf 1 2 3 4\nmtllib my file.mtl\nmtllib b.mtl my\nusemtl b\nf 1 2 3\n"
    );
    let (file, diagnostics) = read_with(&assets, &text);
    let file = file.unwrap();
    assert_eq!(file.mesh.triangle_materials, [2, 0, 0, 1]);
    assert_eq!(file.materials[0].diffuse, Some(ColorFile::Constant(Rgb::new(0.5, 0.0, 0.0))));
    assert_eq!(file.materials[1].diffuse, Some(gray(0.25)));
    assert_eq!(file.materials[2].diffuse, Some(gray(0.8)));
    let messages: Vec<_> = diagnostics.list.iter().map(|d| d.message.as_str()).collect();
    assert_eq!(
        messages,
        [
            "the material `dark red` is defined before: this definition is left out",
            "`dir/my` is left out: there is no such file",
        ]
    );
}

#[test]
fn one_material_needs_no_table() {
    let file = good(&format!("{CORNERS}usemtl m\nf 1 2 3\nusemtl m\nf 1 3 4\n"));
    assert!(file.mesh.triangle_materials.is_empty());
    assert_eq!(file.materials.len(), 1);
    assert!(good(&format!("{CORNERS}f 1 2 3\n")).materials.is_empty());
}

#[test]
fn illumination_models_become_terms() {
    let m = material("Ka 0.1\nKd 0.5\nKs 0.25\nNs 60");
    assert_eq!(
        (m.ambient, m.diffuse, m.specular, m.shininess),
        (Some(gray(0.1)), Some(gray(0.5)), Some(gray(0.25)), 60.0)
    );
    assert!(m.mirror.is_none() && m.dielectric.is_none());
    assert!(material("Kd 1\nKs 1\nillum 1").specular.is_none());
    assert_eq!(material("Kd 0.5\nillum 0").emission, Some(gray(0.5)));
    assert_eq!(material("Ks 0.5\nillum 3").mirror, Some(gray(0.5)));
    assert_eq!(material("Ks 0.5\nillum 8").mirror, None);
    assert_eq!(material("Ka 0 0 0\nKd 1").ambient, Some(gray(0.0)));
    assert_eq!(material("Ke 1 2 3").emission, Some(ColorFile::Constant(Rgb::new(1.0, 2.0, 3.0))));
}

#[test]
fn glass_is_what_lets_light_through() {
    let clear = material("Kd 1\nd 0.25").dielectric.unwrap();
    assert_eq!((clear.ior, clear.fresnel, clear.reflect, clear.transmit), (1.0, false, gray(0.0), gray(0.75)));
    assert_eq!(material("Kd 1\nd 0.25").diffuse, Some(gray(0.25)));
    assert_eq!(material("Kd 1\nTr 0.25").dielectric.unwrap().transmit, gray(0.25));
    let glass = material("Kd 0\nKs 0.5\nTf 0.9 0.9 0.9\nNi 1.5\nillum 7\nd -halo 1.0");
    let dielectric = glass.dielectric.unwrap();
    assert!(dielectric.fresnel && glass.mirror.is_none() && glass.specular == Some(gray(0.5)));
    assert_eq!((dielectric.ior, dielectric.reflect, dielectric.transmit), (1.5, gray(1.0), gray(0.9)));
    let fixed = material("Kd 0\nKs 0.1\nNi 1.3\nillum 6\nd 0.5").dielectric.unwrap();
    assert_eq!((fixed.fresnel, fixed.reflect, fixed.transmit), (false, gray(0.1), gray(0.5)));
    // Glass in name alone is a mirror: nothing says that light passes.
    let opaque = material("Kd 0.5\nKs 0.2\nillum 4");
    assert!(opaque.dielectric.is_none() && opaque.mirror == Some(gray(0.2)));
}

#[test]
fn pictures_are_read_once_and_placed_by_their_options() {
    let assets = MemoryAssets::default()
        .with("dir/a.mtl", b"newmtl m\nKd 1 0 0\nmap_Kd -s 2 3 1 -o 0.5 -clamp on -bm 2 tex/my wood.png\nmap_Ks tex/my wood.png\nmap_Ke no.png\nmap_Bump b.png\n")
        .with("dir/tex/my wood.png", b"pixels");
    let (file, diagnostics) = read_with(&assets, &format!("mtllib a.mtl\n{CORNERS}usemtl m\nf 1 2 3\n"));
    let messages: Vec<_> = diagnostics.list.iter().map(|d| d.message.as_str()).collect();
    assert_eq!(
        messages,
        ["`map_Bump` is not used: the picture is left out", "`dir/no.png` is left out: there is no such file"]
    );
    let file = file.unwrap();
    assert_eq!(file.images.len(), 1);
    assert_eq!(file.images[0].name, "dir/tex/my wood.png");
    let span = file.images[0].span.clone().unwrap();
    assert_eq!(diagnostics.sources.location(&span), "dir/a.mtl:3:40");

    let mut scene = Scene::default();
    let mesh = file.add_to(&mut scene);
    let material = &scene.materials[scene.meshes[mesh].materials[0]];
    let texture = &scene.textures[material.diffuse.unwrap()];
    assert!(matches!(texture.pattern, Pattern::Image { repeat: false, smooth: true, .. }));
    assert_eq!(texture.mapping.space, Space::Uv);
    let moved = texture.mapping.texture_from_space.point(snell_math::Point3::new(1.0, 1.0, 0.0));
    assert_eq!(moved.to_array(), [2.5, 3.0, 0.0]);
}

#[test]
fn problems_are_told_all_at_once_with_their_places() {
    let all = problems(
        "v 0 0\nv 1 0 zero\nv 1 1 1e99\nv 0 0 0\nf 1 2 3\nf 1 1/a 1\nf 0 1 1\nf 1/1/1/1 1 1\nvertx 1\nf 1 1\n",
    );
    let expected = [
        ("`v` needs at least 3 numbers, but here are 2", "1:1"),
        ("`zero` is no number", "2:7"),
        ("`1e99` is not finite or too large", "3:7"),
        ("there is no vertex 2: there are 1 up to this line", "5:5"),
        ("there is no vertex 3: there are 1 up to this line", "5:7"),
        ("`a` is no number of a texture coordinate", "6:7"),
        ("there is no vertex 0: there are 1 up to this line", "7:3"),
        ("there is no texture coordinate 1: there are 0 up to this line", "8:5"),
        ("there is no normal 1: there are 0 up to this line", "8:7"),
        ("`1/1/1/1` is no corner of a face", "8:3"),
        ("unknown word `vertx`: this line is left out", "9:1"),
        ("this face has 2 corners: it is left out", "10:1"),
    ];
    assert_eq!(all, expected.map(|(m, p)| (m.to_owned(), format!("dir/a.obj:{p}"))));
}

#[test]
fn problems_of_a_library_point_into_it() {
    let assets = MemoryAssets::default().with("dir/a.mtl", b"Kd 1\nnewmtl m\nKd red\nkd 1\nd 7\n");
    let (file, diagnostics) = read_with(&assets, &format!("mtllib a.mtl\n{CORNERS}usemtl n\nf 1 2 3\n"));
    assert!(file.is_none());
    let places: Vec<_> = diagnostics
        .list
        .iter()
        .map(|d| diagnostics.sources.location(&d.place.as_ref().unwrap().0) + " " + &d.message)
        .collect();
    assert_eq!(
        places,
        [
            "dir/a.mtl:1:1 a statement before the first `newmtl` is left out",
            "dir/a.mtl:3:4 `red` is no finite number",
            "dir/a.mtl:4:1 unknown word `kd`: this line is left out",
            "dir/a.mtl:5:3 7 is out of range: 1 is taken",
            "dir/a.obj:6:8 the material `n` is in no library: a plain grey one is taken",
        ]
    );
}

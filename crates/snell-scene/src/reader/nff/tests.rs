//! What NFF files mean, in small ones and in the databases.

use snell_math::{Dispersion, Point3, Rgb};

use super::*;
use crate::reader::tests::assets::shared;
use crate::scene::{Background, Frame, Material, Object, Pattern};

const VIEW: &str = "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 512 256\n";

fn good(text: &str) -> Scene {
    let (scene, diagnostics) = read("a.nff", text.as_bytes());
    assert!(diagnostics.list.is_empty(), "{:?}", diagnostics.list);
    scene.unwrap()
}

fn told(text: &str) -> Vec<String> {
    let (scene, diagnostics) = read("a.nff", text.as_bytes());
    assert_eq!(scene.is_none(), diagnostics.has_errors());
    let place = |d: &Diagnostic| d.place.as_ref().map(|(span, _)| diagnostics.sources.location(span));
    diagnostics.list.iter().map(|d| place(d).map_or(d.message.clone(), |p| format!("{p} {}", d.message))).collect()
}

fn shape(object: &Object) -> &Shape {
    match &object.kind {
        ObjectKind::Shape(shape) => shape,
        other => panic!("{other:?}"),
    }
}

fn material<'a>(scene: &'a Scene, object: &Object) -> &'a Material {
    &scene.materials[object.material.unwrap()]
}

fn color(scene: &Scene, texture: Option<Id<crate::scene::Texture>>) -> Option<Rgb> {
    texture.map(|id| match scene.textures[id].pattern {
        Pattern::Constant(color) => color,
        ref other => panic!("{other:?}"),
    })
}

#[test]
fn every_entity_becomes_what_it_says() {
    let scene = good(&format!(
        "# a comment\nb 0.1 0.2 0.3\n{VIEW}l 1 2 3\nl 4 5 6 0.5 0.25 1\n\
         f 1 0.5 0.25 0.5 0.25 30 0 1#glued\ns 1 2 3 4\nc 0 0 0 1\n0 0 2 1\nc\n0 0 0 1 0 0 2 0\n\
         p 4\n0 0 0 1 0 0\n1 1 0 0 1 0\npp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 1 0\n\
         f 1 0.5 0 0.5 0.1 30 0.5 1.5\ns 0 0 0 1\n"
    ));
    assert_eq!(scene.background, Background::Color(Rgb::from_srgb([0.1, 0.2, 0.3])));
    assert_eq!((scene.settings.width, scene.settings.height), (512, 256));
    let Frame::VerticalFov(fov) = scene.camera.frame else { panic!("{:?}", scene.camera.frame) };
    // 255 of the 256 rows are within 45 degrees.
    let [whole, inner] = [0.5 * fov, std::f64::consts::FRAC_PI_8].map(snell_math::portable::tan);
    assert!((whole / inner - 256.0 / 255.0).abs() < 1e-12);
    // Two lights: √2 / 4 each, unless they say otherwise.
    let suggested = Rgb::gray((2f64.sqrt() / 4.0) as f32);
    assert_eq!((scene.ambient, scene.lights[0].intensity), (suggested, suggested));
    assert_eq!(scene.lights[1].intensity, Rgb::new(0.5, 0.25, 1.0));

    let shapes: Vec<_> = scene.objects.iter().map(shape).collect();
    let p = Point3::new;
    assert_eq!(*shapes[0], Shape::Sphere { center: p(1.0, 2.0, 3.0), radius: 4.0 });
    let (base, top) = (Point3::ORIGIN, p(0.0, 0.0, 2.0));
    assert_eq!(*shapes[1], Shape::Cylinder { base, top, radius: 1.0, capped: false });
    assert_eq!(*shapes[2], Shape::Cone { base, base_radius: 1.0, top, top_radius: 0.0, capped: false });
    let meshes: Vec<_> = scene.meshes.iter().collect();
    assert_eq!((meshes[0].triangles.len(), meshes[0].positions.len(), meshes[0].normals.len()), (2, 4, 0));
    assert_eq!(meshes[1].normals, [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]);

    let opaque = material(&scene, &scene.objects[0]);
    assert!(opaque.one_sided && opaque.dielectric.is_none() && opaque.shininess == 30.0);
    assert_eq!(color(&scene, opaque.diffuse), Some(Rgb::from_srgb([1.0, 0.5, 0.25]) * 0.5));
    assert_eq!(color(&scene, opaque.mirror), Some(Rgb::gray(0.25)));
    assert_eq!(color(&scene, opaque.specular), Some(Rgb::gray(0.25)));
    let glass = material(&scene, &scene.objects[5]);
    let dielectric = glass.dielectric.as_ref().unwrap();
    assert!(!glass.one_sided && glass.mirror.is_none() && !dielectric.fresnel);
    assert_eq!(dielectric.ior, Dispersion::Constant(1.5));
    assert_eq!(color(&scene, Some(dielectric.reflect)), Some(Rgb::gray(0.1)));
    assert_eq!(color(&scene, Some(dielectric.transmit)), Some(Rgb::from_srgb([1.0, 0.5, 0.0]) * 0.5));
}

#[test]
fn negative_radii_show_the_inside() {
    let scene = good(&format!("{VIEW}l 0 0 9\ns 0 0 0 -2\nc 0 0 0 -1 0 0 1 -1\ns 0 0 0 1\n"));
    let sides: Vec<_> = scene.objects.iter().map(|o| material(&scene, o).one_sided).collect();
    assert_eq!(sides, [false, false, true]);
    assert_eq!(*shape(&scene.objects[0]), Shape::Sphere { center: Point3::ORIGIN, radius: 2.0 });
}

#[test]
fn problems_are_told_all_at_once_and_reading_goes_on() {
    assert_eq!(
        told(&format!(
            "{VIEW}l 0 0 9\nq 1\ns 0 0 x 1\ns 0 0\nf 1 1 1 1 0 0 0 0\nangel 45\np 2.5\nc 0 0 0 1 0 0 1 -1\ns 0 0 0 0\ns 0 0 0"
        )),
        [
            "a.nff:9:1 unknown entity `q`",
            "a.nff:10:7 `x` is no number, but a sphere's centre or radius should be here",
            "a.nff:12:1 `f` is no number, but a sphere's centre or radius should be here",
            "a.nff:13:1 unknown entity `angel`",
            "a.nff:14:3 the number of corners must be whole",
            "a.nff:15:1 one radius of this cone is negative and the other is not",
            "a.nff:16:1 a sphere of radius 0 is left out",
            "a.nff:17:7 the file ends before a sphere's centre or radius",
        ]
    );
    assert_eq!(told("s 0 0 0 1\nl 1 1 1\n"), ["a.nff: this file has no viewpoint (entity `v`)"]);
    assert_eq!(
        told(VIEW),
        ["a.nff: there is no light: everything has its ambient colour", "a.nff: there is nothing in this scene"]
    );
    assert_eq!(
        told(&VIEW.replace("up 0 1", "up 0 0")),
        ["a.nff:1:1 this viewpoint has no direction: `from` is `at`, or `up` points along the view"]
    );
    assert_eq!(told(&VIEW.replace("angle", "angel"))[0], "a.nff:5:1 `angel` is no part of a viewpoint");
}

#[test]
fn databases_have_their_published_numbers_of_primitives() {
    let Some(shared) = shared() else { return };
    // Primitives and lights from the table in the SPD's Readme, polygons counted as triangles where they are others.
    for (name, solids, triangles, lights) in [
        ("balls", 7381, 2, 3),
        ("gears", 0, 128 * 142 + 9217 * 2, 5),
        ("mount", 4, 8192, 1),
        ("rings", 8400, 2, 3),
        // The file at hand is of size 6, the table's of size 12.
        ("teapot", 0, 2256 + 2 * 36, 2),
        ("tetra", 0, 4096, 1),
        ("tree", 8190, 2, 7),
    ] {
        let path = shared.join(format!("spd-nff/{name}-default.nff"));
        let (scene, _) = read(name, &std::fs::read(path).unwrap());
        let mut scene = scene.unwrap();
        let count = scene.objects.iter().filter(|o| !matches!(shape(o), Shape::Mesh(_))).count();
        let in_meshes: usize = scene.meshes.iter().map(|m| m.triangles.len()).sum();
        assert_eq!((count, in_meshes, scene.lights.len()), (solids, triangles, lights), "{name}");
        if name == "rings" {
            // Seven fills, used again and again.
            assert_eq!(scene.materials.len(), 7);
        }
        spd_rules(&mut scene);
        assert_eq!((scene.settings.width, scene.settings.depth), (513, 5));
        let two_sided = scene.materials.iter().filter(|m| !m.one_sided && m.dielectric.is_none()).count();
        assert_eq!(two_sided, usize::from(name == "teapot"), "{name}");
    }
}

/// Faces of a database's opaque polygons must look outward for one-sided rendering: a tetrahedron's away from its middle.
#[test]
fn polygons_look_outward() {
    let Some(shared) = shared() else { return };
    let (scene, _) = read("tetra", &std::fs::read(shared.join("spd-nff/tetra-s1.nff")).unwrap());
    let scene = scene.unwrap();
    let mesh = scene.meshes.iter().next().unwrap();
    let corner = |v: u32| Point3::from(mesh.positions[v as usize].map(f64::from));
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(corner);
        assert!((b - a).cross(c - a).dot(a.to_vector()) > 0.0);
    }
}

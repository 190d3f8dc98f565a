//! Scenes that cannot be rendered are told why, and what is odd is a warning.

use std::sync::Arc;

use snell::compile::{CompileError, CompiledScene, overlapping_bodies};
use snell::math::{Point3, Rgb, Transform, Vector3};
use snell::scene::scene::{
    Background, CsgOperation, Dielectric, Grid, ImageAsset, Material, Medium, Mesh, Object, ObjectKind, Pattern,
    Prototype, Scene, Shape, Texture,
};
use snell::scene::{Id, Severity};

use crate::files::scene_of_text;

fn messages(error: &CompileError) -> Vec<String> {
    error.diagnostics.iter().map(|diagnostic| diagnostic.message.clone()).collect()
}

fn error(scene: &Scene) -> Vec<String> {
    let error = CompiledScene::build(scene).expect_err("it must not compile");
    assert!(error.diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error));
    assert_eq!(error.to_string(), error.diagnostics[0].message);
    messages(&error)
}

fn picture(scene: &mut Scene, name: &str, bytes: &[u8]) -> Id<ImageAsset> {
    scene.images.push(ImageAsset { name: name.to_owned(), bytes: Arc::from(bytes), span: None })
}

#[test]
fn broken_pictures_are_told_all_at_once() {
    let mut scene = Scene::default();
    let first = picture(&mut scene, "sky.png", b"\x89PNG\r\n\x1a\nand no more");
    picture(&mut scene, "wall.jpg", b"no picture at all");
    picture(&mut scene, "void.exr", b"");
    scene.background = Background::Photograph { image: first, intensity: 1.0 };
    let told = error(&scene);
    assert_eq!(told.len(), 3, "{told:?}");
    for (message, name) in told.iter().zip(["sky.png", "wall.jpg", "void.exr"]) {
        assert!(message.starts_with(&format!("the picture \"{name}\" cannot be used: ")), "{message}");
    }
}

#[test]
fn absurd_numbers_of_objects_are_refused_at_once() {
    let ball = || Object::shape(Shape::Sphere { center: Point3::ORIGIN, radius: 0.1 });
    let grid = |count: [u32; 3], of: Object| Object {
        kind: ObjectKind::Grid(Grid { count, step: [Vector3::X, Vector3::Y, Vector3::Z], of: Box::new(of) }),
        ..Object::shape(Shape::Sphere { center: Point3::ORIGIN, radius: 1.0 })
    };
    let is_told = |scene: &Scene| {
        let told = error(scene);
        assert!(told.len() == 1 && told[0].contains("more than 20000000 objects"), "{told:?}");
    };
    // One grid, grids in grids, and products beyond any integer.
    for object in [
        grid([u32::MAX; 3], ball()),
        grid([100_000, 1000, 1], ball()),
        grid([1000; 3], grid([1000; 3], grid([u32::MAX; 3], ball()))),
        grid([6000, 1, 1], grid([6000, 1, 1], ball())),
    ] {
        is_told(&Scene { objects: vec![object], ..Scene::default() });
    }
    // Each prototype places the one before it ten times: 10^12 in the end.
    let mut scene = Scene::default();
    let mut last = scene.prototypes.push(Prototype { name: "0".to_owned(), objects: vec![ball()] });
    for level in 1..=12 {
        let instance = || Object { kind: ObjectKind::Instance(last), ..ball() };
        let objects = (0..10).map(|_| instance()).collect();
        last = scene.prototypes.push(Prototype { name: level.to_string(), objects });
    }
    scene.objects.push(Object { kind: ObjectKind::Instance(last), ..ball() });
    is_told(&scene);
    // A large scene that is not absurd.
    let scene = Scene { objects: vec![grid([100, 10, 10], ball())], ..Scene::default() };
    assert_eq!(CompiledScene::build(&scene).expect("it compiles").size().primitives, 10_000);
}

#[test]
fn textures_in_a_circle_and_broken_meshes_are_told() {
    let mut scene = Scene::default();
    let own = Id::from_index(0);
    scene.textures.push(Texture { pattern: Pattern::Checker([own, own]), ..Texture::constant(Rgb::WHITE) });
    assert_eq!(error(&scene).len(), 1);

    let mut scene = Scene::default();
    scene.meshes.push(Mesh {
        name: "torn".to_owned(),
        positions: vec![[0.0; 3]],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    });
    let told = error(&scene);
    assert!(told.len() == 1 && told[0].contains("\"torn\""), "{told:?}");
}

#[test]
fn solids_of_what_is_not_solid_are_told() {
    let sheet =
        Object::shape(Shape::Disk { center: Point3::ORIGIN, normal: Vector3::Y, radius: 1.0, inner_radius: 0.0 });
    for parts in [vec![sheet], vec![]] {
        let kind = ObjectKind::Csg { operation: CsgOperation::Union, parts };
        let object = Object { kind, ..Object::shape(Shape::Sphere { center: Point3::ORIGIN, radius: 1.0 }) };
        let told = error(&Scene { objects: vec![object], ..Scene::default() });
        assert!(told.len() == 1 && told[0].starts_with("this solid cannot be made"), "{told:?}");
    }
}

/// Two of the four faces of a tetrahedron, or all of them, of glass.
fn glass_mesh(faces: usize) -> Scene {
    let mut scene = Scene::default();
    let white = scene.textures.push(Texture::constant(Rgb::WHITE));
    let dielectric = Dielectric {
        ior: snell::math::Dispersion::Constant(1.5),
        fresnel: true,
        reflect: white,
        transmit: white,
        roughness: 0.0,
        film: None,
        medium: Medium::default(),
        measured_ior: None,
        extinction: None,
        priority: 0,
    };
    let material = scene.materials.push(Material { dielectric: Some(dielectric), ..Material::default() });
    let mesh = scene.meshes.push(Mesh {
        name: "tetrahedron".to_owned(),
        positions: vec![[0.0, 1.0, 0.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 0.0, -1.0]],
        triangles: [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]][..faces].to_vec(),
        ..Mesh::default()
    });
    scene.objects.push(Object {
        name: Some("gem".to_owned()),
        material: Some(material),
        parent_from_object: Transform::IDENTITY,
        kind: ObjectKind::Shape(Shape::Mesh(mesh)),
        span: None,
    });
    scene
}

#[test]
fn glass_with_holes_is_a_warning() {
    let compiled = CompiledScene::build(&glass_mesh(2)).expect("it renders");
    let told: Vec<_> = compiled.warnings.iter().map(|warning| (warning.severity, warning.message.as_str())).collect();
    assert_eq!(
        told,
        [(Severity::Warning, "the transparent mesh \"gem\" is not closed: 4 of its edges have one side only")]
    );
    assert!(CompiledScene::build(&glass_mesh(4)).expect("it renders").warnings.is_empty());
    // Opaque ones may be open.
    let text = b"[[object]]\nmesh = { vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], faces = [[0, 1, 2]] }\n";
    assert!(CompiledScene::build(&scene_of_text("sheet.toml", text)).expect("it renders").warnings.is_empty());
}

#[test]
fn glass_that_is_inside_out_is_a_warning() {
    let mut scene = glass_mesh(4);
    let mut mesh = scene.meshes.iter().next().expect("one").clone();
    mesh.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    scene.objects[0].kind = ObjectKind::Shape(Shape::Mesh(scene.meshes.push(mesh)));
    let compiled = CompiledScene::build(&scene).expect("it renders");
    let told: Vec<&str> = compiled.warnings.iter().map(|warning| warning.message.as_str()).collect();
    assert_eq!(told, ["the transparent mesh \"gem\" is inside out: its faces look inwards"]);
    // A mirrored copy of a right one is right.
    let mut mirrored = glass_mesh(4);
    mirrored.objects[0].parent_from_object = Transform::scale(Vector3::new(-1.0, 1.0, 1.0));
    assert!(CompiledScene::build(&mirrored).expect("it renders").warnings.is_empty());
}

/// What is told of two bodies, glass and water, with a priority of the water.
fn overlaps(glass: &str, water: &str, priority: i32) -> Vec<String> {
    let text = format!(
        "[material.glass]\ndielectric = {{}}\n[material.water]\ndielectric = {{ ior = 1.33, priority = {priority} }}\n\
         [[object]]\nname = 'glass'\n{glass}\nmaterial = 'glass'\n[[object]]\nname = 'water'\n{water}\nmaterial = 'water'\n"
    );
    let scene = CompiledScene::build(&scene_of_text("overlap.toml", text.as_bytes())).expect("it compiles");
    let told = overlapping_bodies(&scene);
    assert!(told.iter().all(|warning| warning.place.is_some() && warning.related.len() == 1 && warning.help.is_some()));
    told.into_iter().map(|warning| warning.message).collect()
}

#[test]
fn bodies_that_cross_without_priority_are_a_warning() {
    let cube = |half: f64| {
        format!(
            "mesh = {{ vertices = [[-{half}, -{half}, -{half}], [{half}, -{half}, -{half}], [{half}, {half}, -{half}], [-{half}, {half}, -{half}], \
             [-{half}, -{half}, {half}], [{half}, -{half}, {half}], [{half}, {half}, {half}], [-{half}, {half}, {half}]], \
             faces = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [2, 3, 7, 6], [1, 2, 6, 5], [0, 4, 7, 3]] }}"
        )
    };
    let bowl = "difference = [{ sphere = {} }, { sphere = { radius = 0.8 } }, { box = { min = [-2, 0.2, -2], max = [2, 2, 2] } }]";
    let crossing = [
        ("sphere = {}".to_owned(), "sphere = { center = [1.5, 0, 0] }".to_owned()),
        ("sphere = {}".to_owned(), "box = { min = [0, -0.1, -0.1], max = [3, 0.1, 0.1] }".to_owned()),
        (cube(1.0), "sphere = { radius = 1.2 }".to_owned()),
        (cube(1.0), format!("{}\nrotate = [0, 45, 0]", cube(0.9))),
        // Water that is a little too wide for its bowl.
        (
            bowl.to_owned(),
            "difference = [{ sphere = { radius = 0.82 } }, { box = { min = [-2, 0, -2], max = [2, 2, 2] } }]"
                .to_owned(),
        ),
        (
            "torus = { major_radius = 1, minor_radius = 0.3 }".to_owned(),
            "cylinder = { base = [1, -1, 0], top = [1, 1, 0], radius = 0.1 }".to_owned(),
        ),
        ("sphere = {}".to_owned(), "plane = { y = 0.5 }".to_owned()),
    ];
    for (glass, water) in &crossing {
        let told = overlaps(glass, water, 0);
        assert_eq!(
            told,
            ["the transparent bodies \"glass\" and \"water\" cross, and neither has priority"],
            "{glass} {water}"
        );
        assert!(overlaps(glass, water, 1).is_empty(), "with a priority: {glass} {water}");
    }
    let apart = [
        ("sphere = {}".to_owned(), "sphere = { center = [0.2, 0, 0], radius = 0.7 }".to_owned()),
        ("sphere = {}".to_owned(), "sphere = { center = [2, 0, 0] }".to_owned()),
        (cube(1.0), "sphere = { radius = 0.99 }".to_owned()),
        (cube(1.0), "box = { min = [-1, 1, -1], max = [1, 2, 1] }".to_owned()),
        (
            bowl.to_owned(),
            "difference = [{ sphere = { radius = 0.8 } }, { box = { min = [-2, 0, -2], max = [2, 2, 2] } }]".to_owned(),
        ),
        ("torus = { major_radius = 1, minor_radius = 0.3 }".to_owned(), "sphere = { radius = 0.6 }".to_owned()),
        ("plane = { y = 3 }".to_owned(), "sphere = {}".to_owned()),
    ];
    for (glass, water) in &apart {
        assert!(overlaps(glass, water, 0).is_empty(), "{glass} {water}");
    }
}

#[test]
fn an_empty_scene_is_its_background() {
    let scene = Scene { background: Background::Color(Rgb::new(0.25, 0.5, 1.0)), ..Scene::default() };
    let stage = crate::stage::Stage::of(&scene).sized(3, 2);
    assert!(stage.picture().pixels().iter().all(|color| *color == Rgb::new(0.25, 0.5, 1.0)));
}

//! Flattening: what becomes of groups, grids, prototypes and materials.

use snell_math::{Point3, Ray, Rgb, Transform, Vector3};
use snell_scene::scene::{Grid, Material, Mesh, Object, ObjectKind, Prototype, Scene, Shape, Texture};
use snell_scene::{Id, Severity};

use super::CompiledScene;
use crate::geometry::QueryScratch;

fn ball(name: &str, x: f64) -> Object {
    let sphere = Shape::Sphere { center: Point3::ORIGIN, radius: 0.4 };
    let parent_from_object = Transform::translate(Vector3::X * x);
    Object { name: (!name.is_empty()).then(|| name.to_owned()), parent_from_object, ..Object::shape(sphere) }
}

fn of(kind: ObjectKind, x: f64, material: Option<Id<Material>>) -> Object {
    Object { kind, material, ..ball("", x) }
}

/// The name and the material of what is met going down at (x, ·, 0).
fn below(compiled: &CompiledScene, x: f64) -> Option<(&str, u32)> {
    let ray = Ray::new(Point3::new(x, 9.0, 0.0), -Vector3::Y);
    let hit = compiled.geometry.intersect(&ray, f64::INFINITY, &mut QueryScratch::default())?;
    let surface = compiled.interaction(&ray, &hit);
    Some((&compiled.object_names[surface.object as usize], surface.material))
}

fn materials(scene: &mut Scene, count: usize) -> Vec<Id<Material>> {
    let white = scene.textures.push(Texture::constant(Rgb::WHITE));
    (0..count).map(|_| scene.materials.push(Material { diffuse: Some(white), ..Material::default() })).collect()
}

#[test]
fn groups_and_grids_are_flattened_with_their_names() {
    let mut scene = Scene::default();
    let step = [Vector3::X, Vector3::Y, Vector3::Z];
    let grid = Grid { count: [3, 1, 1], step, of: Box::new(ball("pawn", 0.0)) };
    let inner = of(ObjectKind::Group(vec![ball("left", -1.0), ball("", 0.0)]), 2.0, None);
    scene.objects =
        vec![of(ObjectKind::Group(vec![inner, ball("right", 4.0)]), 10.0, None), of(ObjectKind::Grid(grid), 0.0, None)];
    let compiled = CompiledScene::build(&scene).expect("it compiles");
    assert_eq!(compiled.size().primitives, 6);
    let name = |x| below(&compiled, x).map(|(name, _)| name);
    assert_eq!([0.0, 1.0, 2.0].map(name), [Some("pawn"); 3], "all copies are one object");
    assert_eq!([11.0, 12.0, 14.0].map(name), [Some("left"), Some("sphere 2"), Some("right")]);
    assert_eq!(name(5.0), None);
}

#[test]
fn a_part_takes_the_nearest_material_around_it() {
    let mut scene = Scene::default();
    let [group, own, instance, file] = materials(&mut scene, 4)[..] else { panic!("four materials") };
    let triangle = |materials| Mesh {
        positions: vec![[-0.5, 0.0, 0.5], [0.5, 0.0, 0.5], [0.0, 0.0, -0.5]],
        triangles: vec![[0, 1, 2]],
        materials,
        ..Mesh::default()
    };
    let bare = Shape::Mesh(scene.meshes.push(triangle(vec![])));
    let filed = Shape::Mesh(scene.meshes.push(triangle(vec![file])));
    let members = vec![
        Object { material: Some(own), ..ball("", 0.0) },
        ball("", 1.0),
        of(ObjectKind::Shape(filed.clone()), 2.0, None),
    ];
    // Enough of them that it is not copied.
    let mut objects: Vec<Object> = (0..8).map(|i| ball("", f64::from(i) + 20.0)).collect();
    objects.push(of(ObjectKind::Shape(filed.clone()), 0.0, None));
    objects.push(of(ObjectKind::Shape(bare.clone()), 1.0, None));
    objects.push(Object { material: Some(own), ..ball("", 2.0) });
    let prototype = scene.prototypes.push(Prototype { name: "p".to_owned(), objects });
    scene.objects = vec![
        of(ObjectKind::Group(members), 0.0, Some(group)),
        of(ObjectKind::Instance(prototype), 100.0, Some(instance)),
        of(ObjectKind::Instance(prototype), 200.0, None),
        of(ObjectKind::Shape(filed), 300.0, None),
        of(ObjectKind::Shape(bare), 301.0, None),
    ];
    let compiled = CompiledScene::build(&scene).expect("it compiles");
    let plain = compiled.materials.len() as u32 - 1;
    let [group, own, instance, file] = [group, own, instance, file].map(|id| id.index() as u32);
    for (x, expected) in [
        (0.0, own),
        (1.0, group),
        (2.0, group),
        (100.0, file),
        (101.0, instance),
        (102.0, own),
        (120.0, instance),
        (200.0, file),
        (201.0, plain),
        (202.0, own),
        (220.0, plain),
        (300.0, file),
        (301.0, plain),
    ] {
        assert_eq!(below(&compiled, x).map(|(_, material)| material), Some(expected), "at {x}");
    }
}

#[test]
fn prototypes_are_shared_unless_they_are_small() {
    let sizes = |count: u32| {
        let mut scene = Scene::default();
        let objects = (0..count).map(|i| ball("", f64::from(i))).collect();
        let prototype = scene.prototypes.push(Prototype { name: "p".to_owned(), objects });
        scene.objects = (0..10).map(|i| of(ObjectKind::Instance(prototype), f64::from(i) * 100.0, None)).collect();
        let compiled = CompiledScene::build(&scene).expect("it compiles");
        assert!(
            below(&compiled, 900.0).is_some() && below(&compiled, 100.0 * f64::from(count)).is_none_or(|_| count < 10)
        );
        compiled.size().primitives
    };
    // The prototype's own, and a copy of each in ten places; or else ten places.
    assert_eq!(sizes(4), 4 + 40);
    assert_eq!(sizes(5), 5 + 10);
}

#[test]
fn a_prototype_within_a_prototype_stands_where_both_say() {
    let mut scene = Scene::default();
    let row = (0..5).map(|i| ball("", f64::from(i))).collect();
    let row = scene.prototypes.push(Prototype { name: "row".to_owned(), objects: row });
    let rows = vec![of(ObjectKind::Instance(row), 0.0, None), of(ObjectKind::Instance(row), 10.0, None)];
    let rows = scene.prototypes.push(Prototype { name: "rows".to_owned(), objects: rows });
    scene.objects = vec![of(ObjectKind::Instance(rows), 100.0, None)];
    let compiled = CompiledScene::build(&scene).expect("it compiles");
    for x in 0..200 {
        let expected = matches!(x, 100..=104 | 110..=114);
        assert_eq!(below(&compiled, f64::from(x)).is_some(), expected, "at {x}");
    }
}

#[test]
fn errors_name_what_is_wrong_and_warnings_let_it_render() {
    let mut scene = Scene { objects: vec![of(ObjectKind::Group(vec![]), 0.0, None)], ..Scene::default() };
    let compiled = CompiledScene::build(&scene).expect("nothing to see");
    assert!(compiled.warnings.is_empty() && below(&compiled, 0.0).is_none());
    let broken = Mesh { name: "torn".to_owned(), triangles: vec![[0, 1, 2]], ..Mesh::default() };
    scene.meshes.push(broken);
    let error = CompiledScene::build(&scene).expect_err("a vertex is missing");
    assert!(error.to_string().contains("torn") && error.diagnostics[0].severity == Severity::Error);
}

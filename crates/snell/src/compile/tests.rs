//! Flattening: what becomes of groups, grids, prototypes and materials.

use std::borrow::Cow;

use snell_math::{Point3, Ray, Rgb, Transform, Vector3};
use snell_scene::scene::{
    CsgOperation, Grid, Mapping, Material, Mesh, Object, ObjectKind, Pattern, Prototype, Scene, Shape, Space, Texture,
};
use snell_scene::{Id, Severity};

use super::CompiledScene;
use crate::geometry::{Primitive, QueryScratch};

fn ball(name: &str, x: f64) -> Object {
    let sphere = Shape::Sphere { center: Point3::ORIGIN, radius: 0.4 };
    let parent_from_object = Transform::translate(Vector3::X * x);
    Object { name: (!name.is_empty()).then(|| name.to_owned()), parent_from_object, ..Object::shape(sphere) }
}

fn of(kind: ObjectKind, x: f64, material: Option<Id<Material>>) -> Object {
    Object { kind, material, ..ball("", x) }
}

/// The name and the material of what is met going down at (x, ·, 0).
fn below(compiled: &CompiledScene, x: f64) -> Option<(Cow<'_, str>, u32)> {
    let ray = Ray::new(Point3::new(x, 9.0, 0.0), -Vector3::Y);
    let hit = compiled.geometry.intersect(&ray, f64::INFINITY, &mut QueryScratch::default())?;
    let surface = compiled.interaction(&ray, &hit);
    Some((compiled.object_names.get(surface.object)?, surface.material))
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
    assert_eq!([0.0, 1.0, 2.0].map(name), [(); 3].map(|()| Some("pawn".into())), "all copies are one object");
    assert_eq!([11.0, 12.0, 14.0].map(name), ["left", "sphere 2", "right"].map(|name| Some(name.into())));
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
    // A copy of each in ten places; or else the prototype's own and ten places.
    assert_eq!(sizes(4), 40);
    assert_eq!(sizes(5), 5 + 10);
}

#[test]
fn a_nest_of_prototypes_that_stands_once_is_part_of_the_world() {
    let mut scene = Scene::default();
    let row = |scene: &mut Scene| {
        let objects = (0..9).map(|i| ball("", f64::from(i))).collect();
        scene.prototypes.push(Prototype { name: "row".to_owned(), objects })
    };
    let (inner, twice, once) = (row(&mut scene), row(&mut scene), row(&mut scene));
    let objects = vec![of(ObjectKind::Group(vec![of(ObjectKind::Instance(inner), 0.0, None)]), 0.0, None)];
    let nest = scene.prototypes.push(Prototype { name: "nest".to_owned(), objects });
    scene.objects = [(nest, 0.0), (twice, 100.0), (twice, 200.0), (once, 300.0)]
        .map(|(prototype, x)| of(ObjectKind::Instance(prototype), x, None))
        .to_vec();
    let compiled = CompiledScene::build(&scene).expect("it compiles");
    assert_eq!(compiled.size().primitives, 9 + (9 + 2) + (9 + 1));
    assert_eq!((compiled.geometry.prototypes.len(), compiled.object_names.len()), (2, 30));
    for x in 0..400 {
        assert_eq!(below(&compiled, f64::from(x)).is_some(), x % 100 < 9, "at {x}");
    }
    assert_eq!(below(&compiled, 3.0).map(|(name, _)| name), Some("sphere 22".into()), "after the shared ones");
}

/// Balls on a ball and so on, as prototypes of prototypes.
fn flake(scene: &mut Scene, depth: usize) -> Id<Prototype> {
    let mut of_depth: Option<Id<Prototype>> = None;
    for _ in 0..=depth {
        let mut objects = vec![ball("", 0.0)];
        for turn in of_depth.iter().flat_map(|smaller| (0..5).map(move |i| (smaller, i))) {
            let (smaller, angle) = (*turn.0, f64::from(turn.1));
            let parent_from_object = Transform::rotate(Vector3::Z, angle)
                * Transform::translate(Vector3::X)
                * Transform::scale(Vector3::new(0.4, 0.4, 0.4));
            objects.push(Object { parent_from_object, ..of(ObjectKind::Instance(smaller), 0.0, None) });
        }
        of_depth = Some(scene.prototypes.push(Prototype { name: "flake".to_owned(), objects }));
    }
    of_depth.expect("at least one")
}

#[test]
fn prototypes_of_prototypes_become_plain_spheres() {
    let mut scene = Scene::default();
    let whole = flake(&mut scene, 4);
    scene.objects = vec![of(ObjectKind::Instance(whole), 0.0, None)];
    let compiled = CompiledScene::build(&scene).expect("it compiles");
    let balls = (5_u64.pow(5) - 1) / 4;
    assert_eq!(compiled.size().primitives, balls);
    let world = &compiled.geometry.world;
    assert!(world.primitives.iter().all(|primitive| matches!(primitive, Primitive::Sphere(_))));
    assert!(world.placements.is_empty(), "nothing keeps a transform");

    // With a pattern on the balls, where each was must be known.
    let colors = [Rgb::BLACK, Rgb::WHITE].map(|color| scene.textures.push(Texture::constant(color)));
    let mapping = Mapping { space: Space::Object, texture_from_space: Transform::IDENTITY };
    let checks = scene.textures.push(Texture { pattern: Pattern::Checker(colors), mapping });
    for (texture, kept) in [(colors[0], 0), (checks, balls - 1)] {
        let material = scene.materials.push(Material { diffuse: Some(texture), ..Material::default() });
        scene.objects = vec![of(ObjectKind::Instance(whole), 0.0, Some(material))];
        let compiled = CompiledScene::build(&scene).expect("it compiles");
        assert_eq!(compiled.geometry.world.object_spaces.len() as u64, kept);
    }
}

#[test]
fn prototypes_that_refer_to_themselves_or_later_ones_end() {
    let mut scene = Scene::default();
    for later in [0, 1, 9] {
        let objects = vec![ball("", 0.0), of(ObjectKind::Instance(Id::from_index(later)), 1.0, None)];
        scene.prototypes.push(Prototype { name: "p".to_owned(), objects });
    }
    scene.objects = (0..4).map(|i| of(ObjectKind::Instance(Id::from_index(i)), f64::from(i), None)).collect();
    let compiled = CompiledScene::build(&scene).expect("it compiles");
    assert_eq!(compiled.size().primitives, 3);
}

#[test]
fn a_solid_that_cannot_be_made_is_told_once() {
    let mut scene = Scene::default();
    let solid = of(ObjectKind::Csg { operation: CsgOperation::Union, parts: vec![] }, 0.0, None);
    let prototype = scene.prototypes.push(Prototype { name: "p".to_owned(), objects: vec![solid.clone()] });
    for objects in [vec![], (0..9).map(|i| of(ObjectKind::Instance(prototype), f64::from(i), None)).collect()] {
        scene.objects = objects;
        let error = CompiledScene::build(&scene).expect_err("no parts");
        assert_eq!(error.diagnostics.len(), 1, "{error:?}");
    }
    scene.prototypes = Default::default();
    let grid = Grid { count: [100, 100, 1], step: [Vector3::ZERO; 3], of: Box::new(solid) };
    scene.objects = vec![of(ObjectKind::Grid(grid), 0.0, None)];
    assert_eq!(CompiledScene::build(&scene).expect_err("no parts").diagnostics.len(), 1);
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

//! All questions against the plainest way to answer them: every object in a scene of its own, asked one after the other.

mod hulls;
mod packets;

use snell_math::{Point3, Ray, Rgb, Transform, Vector3};
use snell_scene::scene::{
    CsgOperation, Dielectric, Material, Medium, Mesh, Object, ObjectKind, Prototype, Scene, Shape, Texture,
};
use snell_scene::{Id, Table};
use snell_testkit::{TestRng, must_fail};

use super::{Geometry, QueryScratch};
use crate::compile::CompiledScene;

/// Glass, and a matt material, in that order.
fn materials(scene: &mut Scene) -> [Id<Material>; 2] {
    let white = scene.textures.push(Texture::constant(Rgb::WHITE));
    let dielectric = Dielectric {
        ior: snell_math::Dispersion::Constant(1.5),
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
    let glass = scene.materials.push(Material { dielectric: Some(dielectric), ..Material::default() });
    [glass, scene.materials.push(Material { diffuse: Some(white), ..Material::default() })]
}

fn shape(rng: &mut TestRng, mesh: Id<Mesh>) -> ObjectKind {
    let point = Point3::ORIGIN + rng.vector(0.3);
    let ball = |radius| Object::shape(Shape::Sphere { center: point, radius });
    ObjectKind::Shape(match rng.below(8) {
        0 | 1 => Shape::Sphere { center: point, radius: rng.range(0.1, 0.8) },
        2 => Shape::Box { min: point - Vector3::new(0.4, 0.3, 0.5), max: point + Vector3::new(0.3, 0.3, 0.2) },
        3 => Shape::Cylinder { base: point, top: point + Vector3::Y * 0.8, radius: 0.3, capped: rng.coin() },
        4 => Shape::Torus { center: point, axis: rng.direction(), major_radius: 0.5, minor_radius: 0.2 },
        5 => Shape::Disk { center: point, normal: rng.direction(), radius: 0.7, inner_radius: 0.1 },
        6 => Shape::Mesh(mesh),
        _ => {
            let parts = vec![ball(0.7), Object::shape(Shape::Plane { point, normal: rng.direction() })];
            return ObjectKind::Csg { operation: CsgOperation::Intersection, parts };
        }
    })
}

fn placement(rng: &mut TestRng) -> Transform {
    let scale = Transform::scale(Vector3::new(rng.range(0.5, 1.5), rng.range(0.5, 1.5), rng.range(0.5, 1.5)));
    let moved = Transform::translate(rng.vector(2.5));
    if rng.coin() { moved * Transform::rotate(rng.direction(), rng.range(0.0, 6.0)) * scale } else { moved }
}

/// A scene of objects of all kinds, of glass and not, some of them instances, some without bounds.
fn jumble(rng: &mut TestRng, count: usize) -> Scene {
    let mut scene = Scene::default();
    let materials = materials(&mut scene);
    let mesh = scene.meshes.push(Mesh {
        positions: vec![[0.0, 0.7, 0.0], [-0.6, -0.4, 0.5], [0.6, -0.4, 0.5], [0.0, -0.4, -0.7]],
        triangles: vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],
        ..Mesh::default()
    });
    let object = |rng: &mut TestRng, kind, material: bool| Object {
        material: material.then(|| *rng.pick(&materials)),
        parent_from_object: placement(rng),
        kind,
        ..Object::shape(Shape::Sphere { center: Point3::ORIGIN, radius: 1.0 })
    };
    let objects = (0..6)
        .map(|_| {
            let kind = shape(rng, mesh);
            let material = rng.coin();
            object(rng, kind, material)
        })
        .collect();
    let prototype = scene.prototypes.push(Prototype { name: "cluster".to_owned(), objects });
    for _ in 0..count {
        let kind = match rng.below(10) {
            0 => ObjectKind::Shape(Shape::Plane { point: Point3::ORIGIN + rng.vector(5.0), normal: rng.direction() }),
            1 | 2 => ObjectKind::Instance(prototype),
            _ => shape(rng, mesh),
        };
        scene.objects.push(object(rng, kind, true));
    }
    scene
}

/// The geometries of scenes with one object each.
fn one_by_one(scene: &Scene) -> Vec<Geometry> {
    let alone = |object: &Object| Scene { objects: vec![object.clone()], ..scene.clone() };
    scene.objects.iter().map(|object| CompiledScene::build(&alone(object)).expect("it compiles").geometry).collect()
}

/// Rays through the middle of things.
fn rays(rng: &mut TestRng, count: usize) -> Vec<Ray> {
    let mut ray = || {
        let (from, to) = (Point3::ORIGIN + rng.vector(4.0), Point3::ORIGIN + rng.vector(2.5));
        Ray::new(from, (to - from).normalize())
    };
    (0..count).map(|_| ray()).collect()
}

fn check(whole: &Geometry, alone: &[&Geometry], rays: &[Ray]) -> usize {
    let mut scratch = QueryScratch::default();
    let mut met = 0;
    for ray in rays {
        let distances = alone.iter().map(|one| one.intersect(ray, f64::INFINITY, &mut scratch).map(|hit| hit.t));
        let nearest = distances.flatten().fold(f64::INFINITY, f64::min);
        let hit = whole.intersect(ray, f64::INFINITY, &mut scratch);
        assert_eq!(hit.map_or(f64::INFINITY, |hit| hit.t), nearest, "{ray:?}");
        let limit = 3.0;
        assert_eq!(whole.is_blocked(ray, limit, &mut scratch), nearest < limit, "{ray:?}");
        // All transparent surfaces on the way, unless something opaque is.
        let (mut all, mut each) = (Vec::new(), Vec::new());
        let blocked = whole.gather_blockers(ray, limit, &mut all, &mut scratch);
        let mut some_block = false;
        for one in alone {
            some_block |= one.gather_blockers(ray, limit, &mut each, &mut scratch);
        }
        assert_eq!(blocked, some_block, "{ray:?}");
        if !blocked {
            let sorted = |hits: &[super::Hit]| {
                let mut distances: Vec<f64> = hits.iter().map(|hit| hit.t).collect();
                distances.sort_by(f64::total_cmp);
                distances
            };
            assert_eq!(sorted(&all), sorted(&each), "{ray:?}");
        }
        met += usize::from(hit.is_some());
    }
    met
}

#[test]
fn questions_are_answered_as_one_object_at_a_time_would() {
    let mut rng = TestRng::new(17);
    let mut scratch = QueryScratch::default();
    for count in [1, 3, 5, 30, 120] {
        let scene = jumble(&mut rng, count);
        let compiled = CompiledScene::build(&scene).expect("it compiles");
        let alone = one_by_one(&scene);
        let rays = rays(&mut rng, 150);
        let mut alone: Vec<&Geometry> = alone.iter().collect();
        let met = check(&compiled.geometry, &alone, &rays);
        assert!(met > count.min(50) && (count > 5 || met < rays.len()), "{met} rays met {count} objects");
        // One that is seen is left out.
        let mut nearest = |ray: &Ray, geometry: &Geometry| {
            geometry.intersect(ray, f64::INFINITY, &mut scratch).map_or(f64::INFINITY, |hit| hit.t)
        };
        let seen = rays.iter().find(|ray| nearest(ray, &compiled.geometry).is_finite()).expect("some are met");
        let distance = nearest(seen, &compiled.geometry);
        alone.retain(|one| nearest(seen, one) > distance);
        must_fail("an object is missing", || check(&compiled.geometry, &alone, &rays));
    }
}

#[test]
fn interactions_lie_on_the_ray_and_know_their_object() {
    let mut rng = TestRng::new(5);
    let scene = jumble(&mut rng, 40);
    let compiled = CompiledScene::build(&scene).expect("it compiles");
    let mut scratch = QueryScratch::default();
    for ray in rays(&mut rng, 400) {
        let Some(hit) = compiled.geometry.intersect(&ray, f64::INFINITY, &mut scratch) else { continue };
        let surface = compiled.interaction(&ray, &hit);
        assert!(surface.point.distance(ray.at(hit.t)) < 1e-9, "{surface:?}");
        assert!((surface.geometric_normal.as_vector().length() - 1.0).abs() < 1e-12);
        assert!(surface.error < 1e-9 && (surface.object as usize) < compiled.object_names.len());
        // What is spawned there does not meet the same place again.
        for direction in [surface.geometric_normal.as_vector(), -surface.geometric_normal.as_vector()] {
            let next = compiled.geometry.intersect(&surface.spawn_ray(direction), f64::INFINITY, &mut scratch);
            assert!(next.is_none_or(|next| next.t > 1e-12), "{surface:?} along {direction:?}");
        }
    }
}

#[test]
fn of_touching_surfaces_the_opaque_one_is_met_in_either_order() {
    for glass_first in [true, false] {
        let mut scene = Scene { materials: Table::default(), ..Scene::default() };
        let [glass, matt] = materials(&mut scene);
        let block = Shape::Box { min: Point3::new(-1.0, 0.0, -1.0), max: Point3::new(1.0, 1.0, 1.0) };
        let table = Shape::Plane { point: Point3::ORIGIN, normal: Vector3::Y };
        let mut pair = [(block, glass), (table, matt)];
        if !glass_first {
            pair.reverse();
        }
        scene.objects = pair.map(|(shape, id)| Object { material: Some(id), ..Object::shape(shape) }).into();
        let compiled = CompiledScene::build(&scene).expect("it compiles");
        let mut scratch = QueryScratch::default();
        // From within the block, and from below the table.
        for (origin, direction) in
            [(Point3::new(0.1, 0.5, 0.2), -Vector3::Y), (Point3::new(0.1, -0.5, 0.2), Vector3::Y)]
        {
            let ray = Ray::new(origin, direction);
            let hit = compiled.geometry.intersect(&ray, f64::INFINITY, &mut scratch).expect("both are there");
            assert_eq!((hit.t, compiled.interaction(&ray, &hit).material), (0.5, matt.index() as u32));
        }
        // A glass surface that is nearer by more than rounding is met first.
        let ray = Ray::new(Point3::new(0.1, 1.0 + 1e-9, 0.2), -Vector3::Y);
        let hit = compiled.geometry.intersect(&ray, f64::INFINITY, &mut scratch).expect("the upper face");
        assert_eq!(compiled.interaction(&ray, &hit).material, glass.index() as u32);
    }
}

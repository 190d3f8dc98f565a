//! Bounds, surface coordinates, normals, and shapes carried into other spaces.

use snell_math::{Point3, Ray, Transform, Vector3};
use snell_scene::scene::Shape as Description;
use snell_scene::table::Id;

use super::super::{Cuboid, Frustum, Plane, Rectangle, Shape, Sphere, Torus};
use super::{Random, fixture, ray_at};

#[test]
fn bounds_hold_every_hit_and_are_tight() {
    let mut random = Random(31);
    for i in 0..140_u64 {
        let kind = [0, 2, 3, 4, 5, 6, 7][(i % 7) as usize];
        let fixture = fixture(&mut random, kind, Point3::new(1.0, 2.0, -3.0), 1.0);
        let bounds = fixture.shape.bounds();
        let (mut held, mut hits) = (snell_math::Bounds3::EMPTY, 0);
        for _ in 0..4000 {
            let ray = ray_at(&mut random, &fixture, 4.0);
            if let Some(hit) = fixture.shape.intersect(&ray, 0.0, f64::INFINITY) {
                let point = fixture.shape.surface(&ray, hit).point;
                assert!(bounds.contains(point), "{:?} {point:?}", fixture.shape);
                held = held.including(point);
                hits += 1;
            }
        }
        let slack = (held.min - bounds.min).max_abs().max((bounds.max - held.max).max_abs());
        assert!(slack < 0.25 * fixture.size || hits < 500, "{:?}: {held:?} in {bounds:?}", fixture.shape);
    }
}

#[test]
fn normals_point_out_and_agree_with_the_distance_function() {
    let mut random = Random(32);
    for i in 0..12_000_u64 {
        let fixture = fixture(&mut random, i % 8, Point3::ORIGIN, 1.0);
        let ray = ray_at(&mut random, &fixture, 4.0);
        let Some(hit) = fixture.shape.intersect(&ray, 0.0, f64::INFINITY) else { continue };
        let surface = fixture.shape.surface(&ray, hit);
        let step = surface.geometric_normal.as_vector() * 1e-6;
        let outside = (fixture.distance)(surface.point + step);
        assert!((outside - 1e-6).abs() < 1e-8, "{:?}: {outside}", fixture.shape);
        // And the point is the ray's, not another one of the surface.
        assert!(surface.point.distance(ray.at(hit.t)) < 1e-6);
    }
}

#[test]
fn coordinates_follow_the_description() {
    let near = |found: [f64; 2], expected: [f64; 2]| {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}, expected {expected:?}");
    };
    let sphere = Shape::Sphere(Sphere::new(Point3::new(1.0, 1.0, 1.0), 2.0));
    near(sphere.uv(Point3::new(3.0, 1.0, 1.0), 0), [0.0, 0.5]);
    near(sphere.uv(Point3::new(1.0, 1.0, -1.0), 0), [0.25, 0.5]);
    near(sphere.uv(Point3::new(1.0, 1.0, 3.0), 0), [0.75, 0.5]);
    near(sphere.uv(Point3::new(1.0, 3.0, 1.0), 0), [0.0, 1.0]);
    near(sphere.uv(Point3::new(1.0, -1.0, 1.0), 0), [0.0, 0.0]);
    let plane = Shape::Plane(Plane::new(Point3::ORIGIN, Vector3::Y));
    near(plane.uv(Point3::new(3.0, 0.0, -4.0), 0), [3.0, 4.0]);
    for radius in [1.0, 0.5] {
        let frustum = Frustum::new(Point3::ORIGIN, 1.0, Point3::new(0.0, 4.0, 0.0), radius, true);
        let cone = if radius == 1.0 { Shape::Cylinder(frustum) } else { Shape::Cone(frustum) };
        near(cone.uv(Point3::new(0.0, 1.0, -1.0), 0), [0.25, 0.25]);
        near(cone.uv(Point3::new(-1.0, 4.0, 0.0), 2), [0.5, 1.0]);
    }
    let torus = Shape::Torus(Torus::new(Point3::ORIGIN, Vector3::Y, 2.0, 1.0));
    near(torus.uv(Point3::new(0.0, 1.0, -2.0), 0), [0.25, 0.25]);
    near(torus.uv(Point3::new(-3.0, 0.0, 0.0), 0), [0.5, 0.0]);
    let rectangle = Shape::Rectangle(Rectangle::new(Point3::ORIGIN, [Vector3::X * 2.0, Vector3::Z * 4.0]));
    near(rectangle.uv(Point3::new(1.0, 0.0, 1.0), 0), [0.5, 0.25]);
    // Each face of a box: u × v is the outward normal.
    let cuboid = Shape::Box(Cuboid::new(Point3::ORIGIN, Point3::new(2.0, 3.0, 4.0)));
    for part in 0..6_u32 {
        let axis = (part / 2) as usize;
        let mut outward = Vector3::ZERO;
        outward.0[axis] = if part % 2 == 1 { 1.0 } else { -1.0 };
        let slope = |v: Vector3| {
            let (a, b) = (cuboid.uv(Point3::new(1.0, 1.0, 1.0), part), cuboid.uv(Point3::new(1.0, 1.0, 1.0) + v, part));
            [b[0] - a[0], b[1] - a[1]]
        };
        let slopes = [Vector3::X, Vector3::Y, Vector3::Z].map(slope);
        let [u, v] = [0, 1].map(|i| Vector3::new(slopes[0][i], slopes[1][i], slopes[2][i]));
        assert_eq!(u.cross(v), outward, "part {part}");
    }
}

#[test]
fn carried_shapes_are_hit_at_the_same_parameter_by_the_carried_ray() {
    let mut random = Random(33);
    let mut hits = 0;
    for i in 0..8000_u64 {
        let fixture = fixture(&mut random, i % 8, Point3::new(0.3, 0.0, 1.0), 1.0);
        let is_box = matches!(fixture.shape, Shape::Box(_));
        let map = if is_box {
            Transform::translate(random.vector_in_ball(10.0)) * Transform::scale(Vector3::new(2.0, 0.5, 3.0))
        } else {
            let mirror = if random.below(2) == 0 { -1.0 } else { 1.0 };
            Transform::translate(random.vector_in_ball(10.0))
                * Transform::rotate(random.direction(), random.range(0.0, 6.0))
                * Transform::scale(Vector3::new(0.5 * mirror, 0.5, 0.5))
        };
        let carried = fixture.shape.transformed(&map).expect("keeps its kind");
        let ray = ray_at(&mut random, &fixture, 4.0);
        let outer = Ray::new(map.point(ray.origin), map.vector(ray.direction));
        let found = [fixture.shape.intersect(&ray, 0.0, 1e9), carried.intersect(&outer, 0.0, 1e9)];
        // Grazing rays may fall on either side of rounding.
        if let [Some(hit), Some(other)] = found {
            hits += 1;
            assert!((hit.t - other.t).abs() < 1e-5 * (1.0 + hit.t), "{:?}", fixture.shape);
            let there = carried.surface_geometry(&outer, other);
            let here = fixture.shape.surface_geometry(&ray, hit).carried(&map);
            assert!(there.point.distance(here.point) < 1e-5);
            let agree = there.geometric_normal.dot(here.geometric_normal.as_vector()) > 0.99;
            assert!(agree || hit.part != other.part, "{carried:?}");
        }
    }
    assert!(hits > 3000);
    let skewed = Transform::scale(Vector3::new(1.0, 2.0, 1.0));
    assert!(Shape::Sphere(Sphere::new(Point3::ORIGIN, 1.0)).transformed(&skewed).is_none());
    assert!(Shape::Plane(Plane::new(Point3::ORIGIN, Vector3::Y)).transformed(&skewed).is_some());
    let cube = Shape::Box(Cuboid::new(Point3::ORIGIN, Point3::new(1.0, 1.0, 1.0)));
    for map in [Transform::rotate(Vector3::Z, 0.5), Transform::scale(Vector3::new(1.0, -1.0, 1.0))] {
        assert!(cube.transformed(&map).is_none());
    }
}

#[test]
fn descriptions_become_shapes() {
    let description = Description::Cone {
        base: Point3::ORIGIN,
        base_radius: 1.0,
        top: Point3::new(0.0, 2.0, 0.0),
        top_radius: 0.0,
        capped: false,
    };
    let shape = Shape::new(&description).expect("analytic");
    assert!(matches!(shape, Shape::Cone(_)) && !shape.is_solid());
    let bounds = shape.bounds();
    assert!((bounds.min - Point3::new(-1.0, 0.0, -1.0)).max_abs() < 1e-14);
    assert!((bounds.max - Point3::new(1.0, 2.0, 1.0)).max_abs() < 1e-14);
    assert!(Shape::new(&Description::Mesh(Id::from_index(0))).is_none());
    let floor = Shape::new(&Description::Plane { point: Point3::ORIGIN, normal: Vector3::Y }).expect("analytic");
    assert!(floor.bounds().max.y().abs() < 1e-300 && floor.bounds().min.y() == f64::NEG_INFINITY);
}

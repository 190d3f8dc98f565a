//! Rays and shapes at the edge of meaning: no panic, no NaN, no hit from nowhere.

use snell_math::{Point3, Ray, Vector3};

use super::super::{Cuboid, Disk, Frustum, Plane, Rectangle, Shape, Sphere, Torus};
use super::{Random, fixture};

/// Everything that a shape can be asked, with the answers checked for being numbers.
fn ask(shape: &Shape, ray: &Ray) -> bool {
    let mut crossings = Vec::new();
    shape.crossings(ray, &mut crossings);
    assert!(crossings.iter().all(|crossing| !crossing.t.is_nan()));
    let hit = shape.intersect(ray, f64::NEG_INFINITY, f64::INFINITY);
    if let Some(hit) = hit {
        assert!(hit.t.is_finite());
        let _ = shape.surface(ray, hit);
    }
    let _ = (shape.contains(ray.origin), shape.bounds());
    hit.is_some() || crossings.iter().any(|crossing| crossing.t.is_finite())
}

#[test]
fn broken_rays_hit_nothing() {
    let mut random = Random(21);
    let (nan, good) = (f64::NAN, Vector3::new(0.3, -0.8, 0.1));
    for i in 0..400 {
        let shape = fixture(&mut random, i % 8, Point3::ORIGIN, 1.0).shape;
        for axis in 0..3 {
            let mut broken = Vector3::new(0.1, 0.2, -0.3);
            broken.0[axis] = nan;
            assert!(!ask(&shape, &Ray::new(Point3::new(0.1, 0.0, 2.0), broken)), "{shape:?}");
            assert!(!ask(&shape, &Ray::new(Point3(broken.0), good)), "{shape:?}");
            broken.0[axis] = f64::INFINITY;
            ask(&shape, &Ray::new(Point3::ORIGIN, broken));
            ask(&shape, &Ray::new(Point3(broken.0), good));
        }
        for zero in [Vector3::ZERO, -Vector3::ZERO] {
            assert!(!ask(&shape, &Ray::new(Point3::ORIGIN, zero)), "{shape:?}");
            assert!(!ask(&shape, &Ray::new(Point3::new(1.0, 2.0, 3.0), zero)), "{shape:?}");
        }
        let ray = Ray::new(Point3::new(0.0, 0.0, 5.0), -Vector3::Z);
        assert!(shape.intersect(&ray, nan, 1.0).is_none() && shape.intersect(&ray, 0.0, nan).is_none());
        assert!(shape.intersect(&ray, 7.0, 3.0).is_none());
    }
}

#[test]
fn extreme_numbers_do_no_harm() {
    let values = [0.0, -0.0, 5e-324, 1e-300, 1e-160, 1.0, 1e160, 1e300, f64::MAX, f64::INFINITY, f64::NAN];
    let mut random = Random(22);
    let mut pick = |n: usize| -> Vec<f64> { (0..n).map(|_| values[random.below(11) as usize]).collect() };
    for _ in 0..2000 {
        let v = pick(9);
        let (p, q, d) = (Point3::new(v[0], v[1], v[2]), Point3::new(v[3], v[4], v[5]), Vector3::new(v[6], v[7], v[8]));
        for shape in [
            Shape::Sphere(Sphere::new(p, v[3])),
            Shape::Plane(Plane::new(p, d)),
            Shape::Disk(Disk::new(p, d, v[3], v[4])),
            Shape::Rectangle(Rectangle::new(p, [d, q - p])),
            Shape::Box(Cuboid::new(p, q)),
            Shape::Cylinder(Frustum::new(p, v[6], q, v[6], true)),
            Shape::Cone(Frustum::new(p, v[6], q, v[7], v[8] > 1.0)),
            Shape::Torus(Torus::new(p, d, v[3], v[4])),
        ] {
            let w = pick(6);
            ask(&shape, &Ray::new(Point3::new(w[0], w[1], w[2]), Vector3::new(w[3], w[4], w[5])));
            ask(&shape, &Ray::new(Point3::new(1.0, 2.0, 3.0), Vector3::new(0.1, -0.7, 0.2)));
        }
    }
}

fn hits(shape: &Shape, origin: [f64; 3], direction: [f64; 3]) -> Vec<(f64, u32)> {
    let mut crossings = Vec::new();
    shape.crossings(&Ray::new(Point3::from(origin), Vector3::from(direction)), &mut crossings);
    crossings.iter().map(|crossing| (crossing.t, crossing.part)).collect()
}

#[test]
fn touches_are_no_hits() {
    let sphere = Shape::Sphere(Sphere::new(Point3::ORIGIN, 1.0));
    assert!(hits(&sphere, [1.0, 0.0, -5.0], [0.0, 0.0, 1.0]).is_empty());
    let cylinder = Shape::Cylinder(Frustum::new(Point3::ORIGIN, 1.0, Point3::new(0.0, 2.0, 0.0), 1.0, true));
    assert!(hits(&cylinder, [1.0, 1.0, -5.0], [0.0, 0.0, 1.0]).is_empty());
    // Along its side.
    assert!(hits(&cylinder, [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]).is_empty());
    let torus = Shape::Torus(Torus::new(Point3::ORIGIN, Vector3::Y, 2.0, 1.0));
    // Where roots are searched, a touch may also be a pair.
    assert!(hits(&torus, [3.0, 0.0, -5.0], [0.0, 0.0, 1.0]).len().is_multiple_of(2));
    assert!(hits(&torus, [-5.0, 1.0, 0.0], [1.0, 0.0, 0.0]).len().is_multiple_of(2));
}

#[test]
fn cones_at_the_apex_and_along_the_side() {
    let cone = Shape::Cone(Frustum::new(Point3::ORIGIN, 1.0, Point3::new(0.0, 1.0, 0.0), 0.0, true));
    // Through the apex across: a touch. Down the axis: from the apex to the base.
    assert!(hits(&cone, [-5.0, 1.0, 0.0], [1.0, 0.0, 0.0]).is_empty());
    assert_eq!(hits(&cone, [0.0, 3.0, 0.0], [0.0, -1.0, 0.0]), [(2.0, 0), (3.0, 1)]);
    // Parallel to the side, inside by half: in through the base, out through the other side.
    let parallel = hits(&cone, [0.0, -0.5, 0.0], [-1.0, 1.0, 0.0]);
    assert_eq!(parallel, [(0.5, 1), (0.75, 0)]);
    // On the other nappe there is nothing.
    assert!(hits(&cone, [-5.0, 1.5, 0.0], [1.0, 0.0, 0.0]).is_empty());
    assert_eq!(hits(&cone, [-5.0, 0.5, 0.0], [1.0, 0.0, 0.0]), [(4.5, 0), (5.5, 0)]);
    // Standing on its tip it is the same cone.
    let tip = Shape::Cone(Frustum::new(Point3::new(0.0, 1.0, 0.0), 0.0, Point3::ORIGIN, 1.0, true));
    assert_eq!(hits(&tip, [0.0, 3.0, 0.0], [0.0, -1.0, 0.0]), [(2.0, 0), (3.0, 2)]);
}

#[test]
fn box_edges_and_faces_belong_to_one_of_two_neighbours() {
    let left = Shape::Box(Cuboid::new(Point3::ORIGIN, Point3::new(1.0, 1.0, 1.0)));
    let right = Shape::Box(Cuboid::new(Point3::new(1.0, 0.0, 0.0), Point3::new(2.0, 1.0, 1.0)));
    for zero in [0.0, -0.0] {
        let both = [&left, &right].map(|shape| hits(shape, [1.0, 0.5, -1.0], [zero, zero, 1.0]));
        assert_eq!(both, [vec![], vec![(1.0, 4), (2.0, 5)]]);
    }
    // Through opposite corners, and through one edge only.
    let corners = hits(&left, [-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]);
    assert_eq!((corners[0].0, corners[1].0), (1.0, 2.0));
    assert!(hits(&left, [-1.0, 0.5, 1.0], [1.0, 0.0, 1.0]).is_empty());
    // Starting on a face, going in, the face itself does not count.
    let ray = Ray::new(Point3::new(0.0, 0.5, 0.5), Vector3::X);
    assert_eq!(left.intersect(&ray, 0.0, f64::INFINITY).map(|hit| hit.t), Some(1.0));
    // A box without thickness is never crossed.
    let flat = Shape::Box(Cuboid::new(Point3::ORIGIN, Point3::new(1.0, 0.0, 1.0)));
    assert!(hits(&flat, [0.5, 1.0, 0.5], [0.0, -1.0, 0.0]).is_empty());
}

#[test]
fn a_horn_torus_is_crossed_four_times_across_and_touches_itself_in_the_middle() {
    let horn = Shape::Torus(Torus::new(Point3::ORIGIN, Vector3::Y, 1.0, 1.0));
    let across = hits(&horn, [-5.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    let ends = (across[0].0, across[across.len() - 1].0);
    assert!((ends.0 - 3.0).abs() < 1e-12 && (ends.1 - 7.0).abs() < 1e-12 && across.len().is_multiple_of(2));
    let ring = Shape::Torus(Torus::new(Point3::ORIGIN, Vector3::Y, 3.0, 0.5));
    let four = hits(&ring, [-5.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    let expected = [1.5, 2.5, 7.5, 8.5];
    assert_eq!(four.len(), 4);
    assert!(four.iter().zip(expected).all(|(hit, t)| (hit.0 - t).abs() < 1e-14));
}

//! Special places of the eye, broken numbers, and the kinds of features each shape has.

use snell_math::{Homogeneous3, Point3, Vector3};

use super::super::{Curve, Feature, FeatureKind};
use super::{KINDS, of_shape, random_placement, random_shape, samples};
use crate::shape::tests::Random;
use crate::shape::{Cuboid, Disk, Frustum, Plane, Rectangle, Shape, Sphere, Torus};

fn count(features: &[Feature], kind: FeatureKind) -> usize {
    features.iter().filter(|feature| feature.kind == kind).count()
}

fn frustum(bottom: f64, top: f64, capped: bool) -> Shape {
    Shape::Cone(Frustum::new(Point3::ORIGIN, bottom, Point3::new(0.0, 2.0, 0.0), top, capped))
}

/// [creases, boundaries, contours, horizons, parameter lines for 3 of each].
fn kinds(shape: &Shape, eye: [f64; 4]) -> [usize; 5] {
    let [x, y, z, h] = eye;
    let features = of_shape(shape, None, Homogeneous3::new(x, y, z, h), 3);
    assert_eq!(count(&features, FeatureKind::Intersection), 0);
    use FeatureKind::{Boundary, Contour, Crease, Horizon, Parameter};
    [Crease, Boundary, Contour, Horizon, Parameter].map(|kind| count(&features, kind))
}

#[test]
fn each_shape_has_its_features() {
    let afar = [3.0, 4.0, 5.0, 1.0];
    let torus = |major, minor| Shape::Torus(Torus::new(Point3::ORIGIN, Vector3::Y, major, minor));
    let ball = Shape::Sphere(Sphere::new(Point3::ORIGIN, 1.0));
    let plane = Shape::Plane(Plane::new(Point3::ORIGIN, Vector3::Y));
    let disk = |inner| Shape::Disk(Disk::new(Point3::ORIGIN, Vector3::Y, 1.0, inner));
    let table: &[(Shape, [f64; 4], [usize; 5])] = &[
        (ball, afar, [0, 0, 1, 0, 6]),
        // From inside, from the surface, from the centre.
        (ball, [0.1, 0.2, 0.3, 1.0], [0, 0, 0, 0, 6]),
        (ball, [1.0, 0.0, 0.0, 1.0], [0, 0, 0, 0, 6]),
        (ball, [0.0, 0.0, 0.0, 1.0], [0, 0, 0, 0, 6]),
        // No eye at all.
        (ball, [0.0, 0.0, 0.0, 0.0], [0, 0, 0, 0, 6]),
        (ball, [f64::NAN, 0.0, 0.0, 1.0], [0, 0, 0, 0, 6]),
        (plane, afar, [0, 0, 0, 1, 0]),
        // Along it: it is seen edge on and ends at the horizon all the same; in parallel there is none.
        (plane, [1.0, 0.0, 0.0, 1.0], [0, 0, 0, 1, 0]),
        (plane, [1.0, 1.0, 0.0, 0.0], [0, 0, 0, 0, 0]),
        (disk(0.0), afar, [0, 1, 0, 0, 6]),
        (disk(0.5), afar, [0, 2, 0, 0, 6]),
        (Shape::Rectangle(Rectangle::new(Point3::ORIGIN, [Vector3::X, Vector3::Y * 2.0])), afar, [0, 4, 0, 0, 6]),
        (Shape::Box(Cuboid::new(Point3::ORIGIN, Point3::new(1.0, 2.0, 3.0))), afar, [12, 0, 0, 0, 36]),
        (frustum(1.0, 1.0, true), afar, [2, 0, 2, 0, 6]),
        (frustum(1.0, 1.0, false), afar, [0, 2, 2, 0, 6]),
        (frustum(1.0, 0.0, true), afar, [1, 0, 2, 0, 6]),
        (frustum(0.0, 1.0, true), afar, [1, 0, 2, 0, 6]),
        // Above the apex, within the cone of its own kind there, and straight along the axis.
        (frustum(1.0, 0.0, true), [0.1, 5.0, 0.0, 1.0], [1, 0, 0, 0, 6]),
        (frustum(1.0, 1.0, true), [0.0, 1.0, 0.0, 0.0], [2, 0, 0, 0, 6]),
        (frustum(1.0, 1.0, true), [0.5, 9.0, 0.0, 1.0], [2, 0, 0, 0, 6]),
        // On the side's own surface.
        (frustum(1.0, 1.0, true), [1.0, 9.0, 0.0, 1.0], [2, 0, 0, 0, 6]),
        (torus(1.0, 0.3), afar, [0, 0, 2, 0, 6]),
        // On the axis above, in the centre, and along the axis.
        (torus(1.0, 0.3), [0.0, 3.0, 0.0, 1.0], [0, 0, 2, 0, 6]),
        (torus(1.0, 0.3), [0.0, 0.0, 0.0, 1.0], [0, 0, 2, 0, 6]),
        (torus(1.0, 0.3), [0.0, 1.0, 0.0, 0.0], [0, 0, 2, 0, 6]),
        // Edge on, and along the plane from nearby: before and behind the hole.
        (torus(1.0, 0.3), [1.0, 0.0, 0.0, 0.0], [0, 0, 4, 0, 6]),
        (torus(1.0, 0.3), [3.0, 0.0, 0.0, 1.0], [0, 0, 2, 0, 6]),
        // Within the tube one looks around the bend.
        (torus(1.0, 0.3), [1.0, 0.0, 0.0, 1.0], [0, 0, 1, 0, 6]),
        // Without a hole.
        (torus(1.0, 1.0), [0.0, 5.0, 0.0, 1.0], [0, 0, 1, 0, 6]),
        (torus(1.0, 1.0), [0.0, 0.0, 0.0, 1.0], [0, 0, 0, 0, 6]),
        (torus(1.0, 1.0), [3.0, 0.5, 0.0, 1.0], [0, 0, 2, 0, 6]),
    ];
    for (shape, eye, expected) in table {
        assert_eq!(kinds(shape, *eye), *expected, "{shape:?} from {eye:?}");
    }
}

#[test]
fn a_torus_on_the_axis_is_circles() {
    let torus = Shape::Torus(Torus::new(Point3::ORIGIN, Vector3::Y, 2.0, 0.5));
    for eye in [Homogeneous3::new(0.0, 5.0, 0.0, 1.0), Homogeneous3::new(0.0, 5.0, 0.0, 0.0)] {
        let features = of_shape(&torus, None, eye, 0);
        assert!(features.len() == 2 && features.iter().all(|f| matches!(f.curve, Curve::Conic { .. })));
    }
    let radius = |f: &Feature| samples(&f.curve, 1)[0].distance(Point3::ORIGIN);
    let along = of_shape(&torus, None, Homogeneous3::new(0.0, 5.0, 0.0, 0.0), 0);
    let mut radii: Vec<f64> = along.iter().map(radius).collect();
    radii.sort_by(f64::total_cmp);
    assert!((radii[0] - 1.5).abs() < 1e-15 && (radii[1] - 2.5).abs() < 1e-15, "{radii:?}");
}

#[test]
fn broken_and_extreme_numbers_give_finite_curves_or_none() {
    let mut random = Random(53);
    let extremes = [0.0, 1e-300, 1e-150, 1e-20, 1.0, 1e20, 1e150, 1e300, f64::INFINITY, f64::NAN, -1.0];
    for round in 0..4000 {
        let number = |random: &mut Random| extremes[random.below(11) as usize] * random.range(0.1, 1.0);
        let mut three = || Vector3::new(number(&mut random), number(&mut random), number(&mut random));
        let (center, axis, sizes, at) = (Point3::ORIGIN + three(), three(), three(), three());
        let shape = match round % 7 {
            0 => Shape::Sphere(Sphere::new(center, sizes.x())),
            1 => Shape::Plane(Plane::new(center, axis)),
            2 => Shape::Disk(Disk::new(center, axis, sizes.x(), sizes.y())),
            3 => Shape::Rectangle(Rectangle::new(center, [axis, sizes])),
            4 => Shape::Box(Cuboid::new(center, center + sizes)),
            5 => Shape::Cone(Frustum::new(center, sizes.x(), center + axis, sizes.y(), round % 2 == 0)),
            _ => Shape::Torus(Torus::new(center, axis, sizes.x(), sizes.y())),
        };
        let eye = Homogeneous3(at.0.extend([0.0, 1.0, -2.0][random.below(3) as usize]));
        let map = random_placement(&mut random);
        for feature in of_shape(&shape, [None, Some(&map)][random.below(2) as usize], eye, 2) {
            let [start, end] = feature.curve.domain();
            for i in 0..=4 {
                let p = feature.curve.point(start + (end - start) * f64::from(i) / 4.0);
                assert!(p.0.is_finite() && p.h() >= 0.0, "{feature:?}");
            }
        }
    }
}

#[test]
fn curves_keep_their_points_when_carried() {
    let mut random = Random(54);
    for kind in (0..KINDS).cycle().take(60) {
        let shape = random_shape(&mut random, kind, Point3::ORIGIN);
        let map = random_placement(&mut random);
        let eye = Homogeneous3::new(3.0, 1.0, 2.0, 1.0);
        for feature in of_shape(&shape, None, eye, 1) {
            let carried = feature.curve.transformed(&map);
            assert_eq!((carried.domain(), carried.is_closed()), (feature.curve.domain(), feature.curve.is_closed()));
            for (p, q) in samples(&feature.curve, 2).into_iter().zip(samples(&carried, 2)) {
                assert!(map.point(p).distance(q) < 1e-13 * (1.0 + q.max_abs()));
            }
        }
    }
}

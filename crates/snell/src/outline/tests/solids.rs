//! Points of a solid's curves, one by one, and solids whose parts coincide.

use snell_math::{Homogeneous3, Point3, Vector3};
use snell_scene::scene::CsgOperation::{Difference, Intersection, Union};

use super::super::{Body, Curve, Feature, FeatureKind, Form, OutlineOptions, features, intersections};
use super::pictures::{options, random_solid, solid_of};
use super::{random_placement, samples};
use crate::csg::CsgSolid;
use crate::shape::tests::Random;
use crate::shape::{Cuboid, Frustum, Plane, Shape, Sphere, Torus};

fn of_solid(solid: &CsgSolid, eye: [f64; 4]) -> Vec<Feature> {
    let [x, y, z, h] = eye;
    let body = Body { form: Form::Solid(solid), space_from_body: None };
    features(&body, Homogeneous3::new(x, y, z, h), &options())
}

fn ball(x: f64, radius: f64) -> Shape {
    Shape::Sphere(Sphere::new(Point3::new(x, 0.0, 0.0), radius))
}

fn cuboid(min: [f64; 3], max: [f64; 3]) -> Shape {
    Shape::Box(Cuboid::new(Point3::from(min), Point3::from(max)))
}

fn rod(from: [f64; 3], to: [f64; 3], radius: f64) -> Shape {
    Shape::Cylinder(Frustum::new(Point3::from(from), radius, Point3::from(to), radius, true))
}

fn count(features: &[Feature], kind: FeatureKind) -> usize {
    features.iter().filter(|feature| feature.kind == kind).count()
}

#[test]
fn curves_of_solids_are_on_their_surfaces() {
    let mut random = Random(63);
    let (mut creases, mut contours, mut lines) = (0, 0, 0);
    for round in 0..150 {
        let solid = random_solid(&mut random);
        let map = random_placement(&mut random);
        let body = Body { form: Form::Solid(&solid), space_from_body: Some(&map) };
        let at = Point3::ORIGIN + random.direction() * 8.0;
        let options = OutlineOptions { parameter_lines: 2, tolerance: &|_| 1e-3 };
        for feature in features(&body, at.into(), &options) {
            let is_inside = |p: Point3| solid.contains(map.inverse_point(p));
            let points = samples(&feature.curve, 3);
            // Of a polyline only the corners are on the curve.
            let points = if let Curve::Polyline(points) = &feature.curve { points.clone() } else { points };
            for &p in points.iter().skip(1).rev().skip(1) {
                assert!(p.is_finite());
                match feature.kind {
                    FeatureKind::Crease => {
                        creases += 1;
                        // Wedges may be sharp: flat cones have rims of little more than a degree.
                        let mut around = (0..20_000).map(|_| is_inside(p + random.direction() * 1e-7));
                        let first = around.next();
                        assert!(around.any(|inside| Some(inside) != first), "round {round}: {p:?} {feature:?}");
                    }
                    FeatureKind::Contour | FeatureKind::Parameter => {
                        let normal = feature.outward(p).expect("a normal");
                        if feature.kind == FeatureKind::Contour {
                            contours += 1;
                            let sight = (at - p).normalize();
                            assert!(normal.dot(sight).abs() < 1e-9);
                        } else {
                            lines += 1;
                        }
                        let [out, inside] = [p + normal * 1e-7, p - normal * 1e-7].map(is_inside);
                        assert!(!out && inside, "round {round}: {p:?} {feature:?} of {solid:?}");
                    }
                    _ => {}
                }
            }
        }
    }
    assert!(creases > 3000 && contours > 500 && lines > 5000, "{creases} {contours} {lines}");
}

#[test]
fn solids_have_their_features() {
    use FeatureKind::{Contour, Crease, Horizon};
    let block = cuboid([-1.0; 3], [1.0; 3]);
    let third = 1.0 / 3.0;
    // Solid, creases, contours seen from afar.
    let table = [
        // Two balls, apart, crossing, one in the other, the same, touching.
        (solid_of(&[ball(0.0, 1.0), ball(3.0, 1.0)], Union), 0, 2),
        (solid_of(&[ball(0.0, 1.0), ball(1.0, 1.0)], Union), 1, 2),
        (solid_of(&[ball(0.0, 1.0), ball(1.0, 1.0)], Intersection), 1, 2),
        (solid_of(&[ball(0.0, 1.0), ball(0.1, 0.5)], Union), 0, 1),
        (solid_of(&[ball(0.0, 1.0), ball(0.1, 0.5)], Difference), 0, 2),
        (solid_of(&[ball(0.0, 1.0), ball(0.0, 1.0)], Union), 0, 1),
        (solid_of(&[ball(0.0, 1.0), ball(0.0, 1.0)], Difference), 0, 0),
        (solid_of(&[ball(0.0, 1.0), ball(2.0, 1.0)], Union), 0, 2),
        // A hole through a block: longer than it, and flush.
        (solid_of(&[block, rod([0.0, -2.0, 0.0], [0.0, 2.0, 0.0], 0.5)], Difference), 14, 2),
        (solid_of(&[block, rod([0.0, -1.0, 0.0], [0.0, 1.0, 0.0], 0.5)], Difference), 14, 2),
        (solid_of(&[block, rod([0.0, -1.0, 0.0], [0.0, 1.0, 0.0], 0.5)], Union), 12, 0),
        // Two rods in a row are one; a thinner one is a step; a pencil has one rim at its point.
        (solid_of(&[rod([0.0; 3], [0.0, 1.0, 0.0], 0.5), rod([0.0, 1.0, 0.0], [0.0, 2.0, 0.0], 0.5)], Union), 2, 4),
        (solid_of(&[rod([0.0; 3], [0.0, 1.0, 0.0], 0.5), rod([0.0, 1.0, 0.0], [0.0, 2.0, 0.0], 0.4)], Union), 4, 4),
        (
            solid_of(
                &[
                    rod([0.0; 3], [0.0, 1.0, 0.0], 0.5),
                    Shape::Cone(Frustum::new(Point3::new(0.0, 1.0, 0.0), 0.5, Point3::new(0.0, 2.0, 0.0), 0.0, true)),
                ],
                Union,
            ),
            2,
            4,
        ),
        // Blocks side by side are one block: edges along the seam are none, those across go on.
        (solid_of(&[block, cuboid([1.0, -1.0, -1.0], [3.0, 1.0, 1.0])], Union), 16, 0),
        (solid_of(&[block, block], Union), 12, 0),
        (solid_of(&[block, block], Difference), 0, 0),
        // Coincident only up to rounding.
        (
            solid_of(
                &[cuboid([0.0; 3], [third, 1.0, 1.0]), rod([0.1 + 0.7 / 3.0, 0.5, 0.5], [1.0, 0.5, 0.5], 0.2)],
                Union,
            ),
            14,
            2,
        ),
        // A ring through a block's face: two curves without a formula, and the ring's own two contours, each cut.
        (
            solid_of(
                &[block, Shape::Torus(Torus::new(Point3::new(1.0, 0.0, 0.0), Vector3::new(0.1, 0.2, 1.0), 0.6, 0.1))],
                Union,
            ),
            14,
            2,
        ),
        // A floor with a dent, and two floors of which one is below.
        (solid_of(&[Shape::Plane(Plane::new(Point3::ORIGIN, Vector3::Y)), ball(0.0, 1.0)], Difference), 1, 1),
        (
            solid_of(
                &[
                    Shape::Plane(Plane::new(Point3::ORIGIN, Vector3::Y)),
                    Shape::Plane(Plane::new(Point3::new(0.0, -1.0, 0.0), Vector3::Y)),
                ],
                Union,
            ),
            0,
            0,
        ),
    ];
    for (row, (solid, creases, contours)) in table.iter().enumerate() {
        let features = of_solid(solid, [7.0, 6.0, 5.0, 1.0]);
        let found = [count(&features, Crease), count(&features, Contour)];
        assert_eq!(found, [*creases, *contours], "row {row}: {features:?}");
    }
    // A wedge of space between two walls: the horizon of each is cut in half, and two lines without end meet in between.
    let wall = |x: f64, z: f64| Shape::Plane(Plane::new(Point3::ORIGIN, Vector3::new(x, 0.0, z)));
    let wedge = of_solid(&solid_of(&[wall(1.0, 0.0), wall(1.0, 1.0)], Intersection), [7.0, 6.0, 5.0, 1.0]);
    assert_eq!([Crease, Horizon].map(|kind| count(&wedge, kind)), [2, 2]);
    for horizon in wedge.iter().filter(|feature| feature.kind == Horizon) {
        let [start, end] = horizon.curve.domain();
        assert!((end - start - std::f64::consts::PI).abs() < 1e-9);
        let middle = horizon.curve.point(0.5 * (start + end)).vector();
        assert!(middle.x() <= 1e-9 && middle.x() + middle.z() <= 1e-9, "{horizon:?}");
    }
}

#[test]
fn common_intersections_are_exact() {
    let floor = Shape::Plane(Plane::new(Point3::ORIGIN, Vector3::Y));
    let tilted = Shape::Plane(Plane::new(Point3::new(0.0, 0.9, 0.0), Vector3::new(0.2, 1.0, 0.3)));
    let steep = Shape::Plane(Plane::new(Point3::new(0.3, 0.0, 0.0), Vector3::new(1.0, 0.1, 0.0)));
    let cone = Shape::Cone(Frustum::new(Point3::new(0.0, -0.1, 0.0), 1.0, Point3::new(0.0, 2.0, 0.0), 0.0, true));
    let torus = Shape::Torus(Torus::new(Point3::ORIGIN, Vector3::Y, 1.0, 0.3));
    let block = cuboid([-0.5; 3], [0.5; 3]);
    let upright = rod([0.0, -1.0, 0.0], [0.0, 2.0, 0.0], 0.5);
    let table = [
        (floor, ball(0.0, 1.0), 1),
        (floor, block, 4),
        (floor, upright, 1),
        (tilted, upright, 1),
        // Through the side twice and through both caps.
        (steep, upright, 4),
        (tilted, cone, 1),
        // A hyperbola and the line across the cap.
        (steep, cone, 2),
        (floor, torus, 2),
        (ball(0.0, 1.0), ball(0.5, 1.0), 1),
        (ball(0.0, 1.0), upright, 2),
        // Through the side twice and through the cap.
        (ball(0.0, 1.0), cone, 3),
        (torus, ball(0.0, 1.0), 2),
        (block, ball(0.0, 0.6), 6),
        (floor, steep, 2),
    ];
    for (row, (a, b, expected)) in table.into_iter().enumerate() {
        for (a, b) in [(a, b), (b, a)] {
            let [first, second] = [&a, &b].map(|shape| Body { form: Form::Shape(shape), space_from_body: None });
            let found = intersections(&first, &second, &options());
            assert_eq!(found.len(), expected, "row {row}: {found:?}");
            assert!(found.iter().all(|f| !matches!(f.curve, Curve::Polyline(_))), "row {row}");
        }
    }
}

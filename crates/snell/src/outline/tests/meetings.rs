//! Curves in which two surfaces meet: on both, within tolerance, all of them, and quickly for whatever numbers.

use snell_math::{Homogeneous3, Point3, Transform, Vector3};
use snell_scene::scene::CsgOperation::{Difference, Union};

use super::super::patch::{Patch, patches};
use super::super::strand::Strand;
use super::super::trace::stretch;
use super::super::{Body, Curve, Form, OutlineOptions, features, intersections, meet};
use super::pictures::{options, random_solid, solid_of};
use super::{KINDS, distance_to_chords, is_round, random_placement, random_shape, samples, surface_point};
use crate::csg::{CsgNode, CsgSolid};
use crate::shape::tests::Random;
use crate::shape::{Cuboid, Frustum, Plane, Rectangle, Shape, Sphere, Torus};

/// Two pieces of random shapes in random placements that may meet, at least one of them round.
fn random_pair(random: &mut Random) -> [Patch; 2] {
    loop {
        let pair = [(); 2].map(|()| {
            let kind = random.below(KINDS);
            let center = Point3::ORIGIN + random.vector_in_ball(0.7);
            let shape = random_shape(random, kind, center);
            let stretch = Vector3::new(random.range(0.6, 1.4), -1.0, random.range(0.6, 1.4));
            let map = Transform::rotate(random.direction(), random.range(0.0, 6.0)) * Transform::scale(stretch);
            let all = patches(&shape);
            all[random.below(all.len() as u64) as usize].carried((random.below(2) == 0).then_some(&map))
        });
        if pair.iter().any(is_round) {
            return pair;
        }
    }
}

/// How far a point is from the surface and from its limits, relative to its size.
fn off(patch: &Patch, p: Point3) -> f64 {
    let size = patch.size().max(p.max_abs());
    (patch.height(p).abs() * stretch(&patch.space_from_patch) / size).max(-patch.margin(p))
}

/// How many edges of a grid on the first round surface pass through the other within its limits with no curve near; how many
/// pass.
fn missed(pair: &[Patch; 2], strands: &[Strand]) -> (usize, usize) {
    const N: usize = 50;
    let [on, other] = if is_round(&pair[0]) { [&pair[0], &pair[1]] } else { [&pair[1], &pair[0]] };
    let lines: Vec<Vec<Point3>> = strands.iter().map(|strand| samples(&strand.curve, 24)).collect();
    let at = |i: usize, j: usize| surface_point(on, i as f64 / N as f64, j as f64 / N as f64);
    let (mut missed, mut passed) = (0, 0);
    for (i, j) in (0..N).flat_map(|i| (0..N).map(move |j| (i, j))) {
        let here = at(i, j);
        for there in [at(i + 1, j), at(i, j + 1)] {
            let [a, b] = [here, there].map(|p| other.height(p));
            let step = here.distance(there);
            // Where the surfaces only just pass, or a border is near, the chord of a grid's edge says nothing.
            let is_clear = a.abs().min(b.abs()) > 0.02 * step && other.margin(here) > 0.1 && other.margin(there) > 0.1;
            if (a > 0.0) != (b > 0.0) && is_clear {
                passed += 1;
                let near = lines.iter().map(|line| distance_to_chords(here, line)).fold(f64::INFINITY, f64::min);
                missed += usize::from(near > 1.1 * step + 2e-3);
            }
        }
    }
    (missed, passed)
}

#[test]
fn meetings_are_on_both_surfaces_and_complete() {
    let mut random = Random(71);
    let (mut traced, mut exact, mut passed, mut noticed) = (0, 0, 0, 0);
    for round in 0..700 {
        let pair = random_pair(&mut random);
        let mut strands = meet::meet(&pair[0], &pair[1], &|_| 1e-3);
        for strand in &strands {
            let points = match &strand.curve {
                Curve::Polyline(points) => points.clone(),
                curve => samples(curve, 7),
            };
            let is_exact = strand.onto.is_none();
            *if is_exact { &mut exact } else { &mut traced } += points.len();
            let bound = if is_exact { 1e-11 } else { 1e-9 };
            for &p in &points {
                let worst = off(&pair[0], p).max(off(&pair[1], p));
                assert!(worst < bound, "round {round}: {worst} at {p:?} of {pair:?}");
            }
            // The true curve is near the middle of each chord.
            if let Curve::Polyline(points) = &strand.curve {
                for (i, chord) in points.windows(2).enumerate() {
                    let middle = chord[0].lerp(chord[1], 0.5);
                    let on_curve = strand.point(i as f64 + 0.5).expect("a finite point");
                    assert!(on_curve.distance(middle) < 1e-3, "round {round}: {chord:?} {on_curve:?} of {pair:?}");
                }
            }
        }
        let (lost, all) = missed(&pair, &strands);
        assert_eq!(lost, 0, "round {round}: of {all} for {pair:?} {strands:?}");
        passed += all;
        // The twin: one curve less.
        if !strands.is_empty() {
            strands.pop();
            noticed += usize::from(missed(&pair, &strands).0 > 0);
        }
    }
    assert!(traced > 3000 && exact > 2000 && passed > 10_000, "{traced} {exact} {passed}");
    assert!(noticed > 100, "{noticed}");
}

#[test]
fn small_bodies_on_large_ones_are_not_lost() {
    // A small ball, stretched so that there is no formula, on a large one, a long thin rod, a ring.
    let large = [
        Shape::Sphere(Sphere::new(Point3::ORIGIN, 1.0)),
        Shape::Cylinder(Frustum::new(Point3::new(1.0, -300.0, 0.0), 0.01, Point3::new(1.0, 500.0, 0.0), 0.01, true)),
        Shape::Torus(Torus::new(Point3::ORIGIN, Vector3::Y, 1.0, 0.002)),
    ];
    let small = Shape::Sphere(Sphere::new(Point3::ORIGIN, 0.003));
    let stretch = Transform::translate(Vector3::X) * Transform::scale(Vector3::new(1.0, 1.2, 1.5));
    for (shape, expected) in large.iter().zip([1, 0, 2]) {
        let first = Body { form: Form::Shape(shape), space_from_body: None };
        let second = Body { form: Form::Shape(&small), space_from_body: Some(&stretch) };
        let tolerance: &(dyn Fn(Point3) -> f64 + Sync) = &|_| 1e-6;
        let options = OutlineOptions { parameter_lines: 0, tolerance };
        let found = intersections(&first, &second, &options);
        assert_eq!(found.len(), expected, "{shape:?}");
        assert!(found.iter().all(|feature| feature.curve.is_closed()));
    }
    // Two rods that cross.
    let across =
        Shape::Cylinder(Frustum::new(Point3::new(-40.0, 0.0, 0.0), 0.02, Point3::new(60.0, 0.1, 0.0), 0.02, true));
    let [first, second] = [&large[1], &across].map(|shape| Body { form: Form::Shape(shape), space_from_body: None });
    assert_eq!(intersections(&first, &second, &options()).len(), 2);
}

#[test]
fn what_touches_or_coincides_has_no_curve() {
    let ball = |x: f64, radius: f64| Shape::Sphere(Sphere::new(Point3::new(x, 0.0, 0.0), radius));
    let ring = |z: f64| Shape::Torus(Torus::new(Point3::new(0.0, 0.0, z), Vector3::Z, 1.0, 0.25));
    let rod = |x: f64, top: f64| {
        Shape::Cylinder(Frustum::new(Point3::new(x, 0.0, 0.0), 0.5, Point3::new(x, top, 0.0), 0.5, true))
    };
    let floor = |y: f64| Shape::Plane(Plane::new(Point3::new(0.0, y, 0.0), Vector3::Y));
    let block = Shape::Box(Cuboid::new(Point3::ORIGIN, Point3::new(1.0, 1.0, 1.0)));
    let flat = Shape::Rectangle(Rectangle::new(Point3::ORIGIN, [Vector3::X * 9.0, Vector3::Z * 9.0]));
    let table = [
        (ball(0.0, 1.0), ball(0.0, 1.0)),
        (ball(0.0, 1.0), ball(2.0, 1.0)),
        (ball(0.0, 1.0), ball(0.25, 0.75)),
        (ball(0.0, 1.0), floor(1.0)),
        (ball(0.0, 1.0), floor(-1.0)),
        (ring(0.0), ring(0.0)),
        (ring(0.0), ring(0.5)),
        (rod(0.0, 1.0), rod(0.0, 1.0)),
        (rod(0.0, 1.0), rod(0.0, 2.0)),
        (rod(0.0, 1.0), rod(1.0, 1.0)),
        (floor(0.0), floor(0.0)),
        (floor(0.0), floor(1.0)),
        // Standing flush: the bodies' own rims are drawn.
        (floor(0.0), rod(0.0, 1.0)),
        (floor(0.0), block),
        (flat, block),
        (flat, floor(0.0)),
        (block, block),
        (rod(0.0, 1.0), floor(1.0)),
    ];
    for (row, (a, b)) in table.iter().enumerate() {
        for map in [None, Some(Transform::rotate(Vector3::X, 0.7) * Transform::scale(Vector3::new(1.0, 1.3, 0.7)))] {
            let [first, second] = [a, b].map(|shape| Body { form: Form::Shape(shape), space_from_body: map.as_ref() });
            let found = intersections(&first, &second, &options());
            assert!(found.is_empty(), "row {row} {map:?}: {found:?}");
        }
    }
}

#[test]
fn extreme_bodies_end_and_stay_finite() {
    let mut random = Random(73);
    let extremes = [0.0, 1e-300, 1e-20, 1e-6, 1.0, 1.0, 1.0, 1e6, 1e20, 1e300, f64::INFINITY, f64::NAN];
    for round in 0..600 {
        let mut shapes = Vec::new();
        for _ in 0..2 {
            let mut number = || extremes[random.below(12) as usize] * random.range(-1.0, 1.0);
            let mut three = || Vector3::new(number(), number(), number());
            let (center, axis, sizes) = (Point3::ORIGIN + three(), three(), three());
            let (x, y) = (sizes.x().abs(), sizes.y().abs());
            shapes.push(match random.below(6) {
                0 => Shape::Sphere(Sphere::new(center, x)),
                1 => Shape::Plane(Plane::new(center, axis)),
                2 => Shape::Box(Cuboid::new(center, center + Vector3::new(x, y, x))),
                3 => Shape::Cylinder(Frustum::new(center, x, center + axis, x, true)),
                4 => Shape::Cone(Frustum::new(center, x, center + axis, y, true)),
                _ => Shape::Torus(Torus::new(center, axis, x, y)),
            });
        }
        let map = random_placement(&mut random);
        let [first, second] = [(&shapes[0], None), (&shapes[1], Some(&map))]
            .map(|(shape, space_from_body)| Body { form: Form::Shape(shape), space_from_body });
        let mut found = intersections(&first, &second, &options());
        let solid = solid_of(&shapes, [Union, Difference][round % 2]);
        let whole = Body { form: Form::Solid(&solid), space_from_body: Some(&map) };
        found.extend(features(&whole, Homogeneous3::new(3.0, 4.0, 5.0, 1.0), &options()));
        for feature in found {
            let [start, end] = feature.curve.domain();
            for i in 0..=4 {
                let p = feature.curve.point(start + (end - start) * f64::from(i) / 4.0);
                assert!(p.0.is_finite() && p.h() >= 0.0, "{feature:?}");
            }
        }
    }
}

#[test]
fn curves_of_moved_solids_are_moved() {
    let mut random = Random(74);
    for _ in 0..40 {
        let solid = random_solid(&mut random);
        let map = Transform::translate(Vector3::new(3.0, 1.0, -2.0)) * Transform::rotate(random.direction(), 2.0);
        let eye = Point3::ORIGIN + random.direction() * 7.0;
        let kinds = |space_from_body: Option<&Transform>, eye: Point3| {
            let body = Body { form: Form::Solid(&solid), space_from_body };
            let found = features(&body, eye.into(), &options());
            let mut lengths: Vec<f64> = found
                .iter()
                .map(|feature| samples(&feature.curve, 8).windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>())
                .collect();
            lengths.sort_by(f64::total_cmp);
            lengths
        };
        let (here, there) = (kinds(None, eye), kinds(Some(&map), map.point(eye)));
        assert_eq!(here.len(), there.len());
        let total = |lengths: &[f64]| lengths.iter().sum::<f64>();
        assert!((total(&here) - total(&there)).abs() <= 1e-2 * total(&here));
    }
}

#[test]
fn a_row_of_many_parts_takes_no_long_time() {
    let ball = |i: u32| CsgNode::Leaf {
        shape: Shape::Sphere(Sphere::new(Point3::new(f64::from(i), 0.0, 0.0), 0.6)),
        solid_from_leaf: None,
        tag: i,
    };
    let mut nodes: Vec<CsgNode> = (0..300).map(ball).collect();
    nodes.push(CsgNode::Operation { operation: Union, children: (0..300).collect() });
    let solid = CsgSolid::new(nodes).expect("a row of balls");
    let body = Body { form: Form::Solid(&solid), space_from_body: None };
    let found = features(&body, Homogeneous3::new(0.0, 0.0, 1.0, 0.0), &options());
    // A circle between neighbours; two arcs of each ball, and one at each end.
    assert_eq!(found.len(), 299 + 2 * 298 + 2);
}

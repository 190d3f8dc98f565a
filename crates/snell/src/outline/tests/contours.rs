//! Contours against their definition, point by point, and against brute force over the whole surface.

use proptest::prelude::*;
use snell_math::{Homogeneous3, Point3};

use super::super::patch::{Patch, Surface, patches};
use super::super::trace::stretch;
use super::super::{Curve, Feature, FeatureKind};
use super::{
    KINDS, distance_to_chords, is_round, of_shape, random_eye, random_placement, random_shape, samples, surface_point,
};
use crate::shape::tests::Random;

/// N · (e − h p) for the unit vector towards the eye: the cosine between the line of sight and the normal.
fn cosine(patch: &Patch, p: Point3, eye: Homogeneous3) -> f64 {
    let sight = eye.vector() - (p - Point3::ORIGIN) * eye.h();
    patch.normal(p).expect("a regular point").dot(sight) / sight.length()
}

/// The largest distance from touching, and from the surface relative to its size, of all points of all contours.
fn errors(patch: &Patch, contours: &[&Curve], eye: Homogeneous3) -> (f64, f64) {
    let mut worst = (0.0_f64, 0.0_f64);
    for p in contours.iter().flat_map(|curve| samples(curve, 7)) {
        let size = patch.size().max(p.max_abs());
        let local = patch.local(p);
        // A tip has no normal, and near it the normal is worth as much less.
        let from_axis = (local.x() * local.x() + local.y() * local.y()).sqrt() * stretch(&patch.space_from_patch);
        if from_axis < 1e-3 * size && matches!(patch.surface, Surface::Side { .. }) {
            continue;
        }
        worst.0 = worst.0.max(cosine(patch, p, eye).abs());
        worst.1 = worst.1.max(patch.height(p).abs() * stretch(&patch.space_from_patch) / size);
    }
    worst
}

fn contours_on<'f>(patch: &Patch, features: &'f [Feature]) -> Vec<&'f Curve> {
    let on = |feature: &&Feature| {
        feature.kind == FeatureKind::Contour && feature.facing.as_ref().is_some_and(|facing| facing.0 == *patch)
    };
    features.iter().filter(on).map(|feature| &feature.curve).collect()
}

/// How many edges of a grid on the surface pass from the front to the back with no contour near, and how many pass.
fn missed(patch: &Patch, contours: &[&Curve], eye: Homogeneous3) -> (usize, usize) {
    const N: usize = 40;
    let lines: Vec<Vec<Point3>> = contours.iter().map(|curve| samples(curve, 24)).collect();
    let at = |i: usize, j: usize| surface_point(patch, i as f64 / N as f64, j as f64 / N as f64);
    let side = |p: Point3| cosine(patch, p, eye) > 0.0;
    let (mut missed, mut passed) = (0, 0);
    // Not on the poles and tips, which have no normal.
    for (i, j) in (0..N).flat_map(|i| (1..N).map(move |j| (i, j))) {
        let here = at(i, j);
        for (k, l) in [(i + 1, j), (i, j + 1)] {
            let there = at(k, l);
            if l < N && side(here) != side(there) {
                passed += 1;
                let near = lines.iter().map(|line| distance_to_chords(here, line)).fold(f64::INFINITY, f64::min);
                missed += usize::from(near > 1.05 * here.distance(there) + 1e-5 * patch.size());
            }
        }
    }
    (missed, passed)
}

#[test]
fn contours_touch_lines_of_sight_and_none_is_missing() {
    let mut random = Random(51);
    let (mut points_wrong_from_elsewhere, mut missed_from_elsewhere, mut passed) = (0, 0, 0);
    for round in 0..500 {
        let shape = random_shape(&mut random, round % KINDS, Point3::ORIGIN);
        let map = random_placement(&mut random);
        let map = (random.below(2) == 0).then_some(&map);
        let eye = random_eye(&mut random);
        let features = of_shape(&shape, map, eye, 0);
        for patch in patches(&shape).iter().map(|patch| patch.carried(map)).filter(is_round) {
            let contours = contours_on(&patch, &features);
            let (touch, off) = errors(&patch, &contours, eye);
            assert!(touch < 1e-11 && off < 1e-13, "{shape:?} {map:?} {eye:?}: {touch} {off}");
            let (lost, all) = missed(&patch, &contours, eye);
            assert_eq!(lost, 0, "of {all}: {shape:?} {map:?} {eye:?} {contours:?}");
            passed += all;
            // The twins: the same curves, seen from a little aside.
            let aside = Homogeneous3(eye.0 + random.direction().0.extend(0.0) * (0.3 * eye.vector().length()));
            points_wrong_from_elsewhere += usize::from(errors(&patch, &contours, aside).0 > 1e-3);
            missed_from_elsewhere += missed(&patch, &contours, aside).0;
        }
    }
    assert!(passed > 10_000, "{passed}");
    assert!(points_wrong_from_elsewhere > 150, "{points_wrong_from_elsewhere}");
    assert!(missed_from_elsewhere > 1000, "{missed_from_elsewhere}");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
    /// At any scale, from any place, also within the shape.
    #[test]
    fn no_point_of_a_contour_is_off(seed: u64, kind in 0..KINDS, exponent in -6..7i32, inside: bool) {
        let mut random = Random(seed);
        let unit = (0..exponent.abs()).fold(1.0, |p, _| p * if exponent < 0 { 0.1 } else { 10.0 });
        let shape = random_shape(&mut random, kind, Point3::ORIGIN);
        let scale = snell_math::Transform::scale(snell_math::Vector3::new(unit, unit, unit));
        let map = scale * random_placement(&mut random);
        let near = if inside { map.point(Point3::ORIGIN + random.vector_in_ball(1.0)).into() } else { random_eye(&mut random) };
        let eye = if inside { near } else { Homogeneous3((near.vector() * unit).0.extend(near.h())) };
        let features = of_shape(&shape, Some(&map), eye, 3);
        for patch in patches(&shape).iter().map(|patch| patch.carried(Some(&map))).filter(is_round) {
            let (touch, off) = errors(&patch, &contours_on(&patch, &features), eye);
            prop_assert!(touch < 1e-10 && off < 1e-12, "{} {} {:?}", touch, off, features);
        }
        for feature in features.iter().filter(|feature| feature.kind == FeatureKind::Parameter) {
            let patch = feature.facing.as_ref().expect("on a surface").0;
            for p in samples(&feature.curve, 3) {
                prop_assert!(patch.height(p).abs() < 1e-12 * (patch.size() + p.max_abs()) / stretch(&patch.space_from_patch));
                let normal = feature.outward(p).expect("a regular point");
                prop_assert!((normal.length() - 1.0).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn parameters_of_a_torus_run_evenly() {
    // Nearly edge on, nearly touched, and seen from afar: no step is long or turns by more than a few degrees.
    for (x, z, h) in [(1.0, 1e-7, 0.0), (1.0, 1e-3, 0.0), (5.0, 0.3001, 1.0), (5.0, 0.2999, 1.0), (1.31, 0.0, 1.0)] {
        for curve in super::super::torus::contour(1.0, 0.3, Homogeneous3::new(x, 0.0, z, h)) {
            let points = samples(&curve, 1);
            assert!(points.len() < 1000, "{} for {x} {z} {h}", points.len());
            for step in points.windows(3) {
                let (a, b) = (step[1] - step[0], step[2] - step[1]);
                let is_short = a.length().min(b.length()) < 2e-6;
                assert!(is_short || a.dot(b) > 0.4 * a.length() * b.length(), "{step:?} for {x} {z} {h}");
                assert!(a.length() < 0.4);
            }
            assert!(curve.is_closed() && points[0].distance(points[points.len() - 1]) < 1e-12);
        }
    }
}

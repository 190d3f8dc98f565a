//! Triangles cover what their polygon covers, whatever its shape and plane.

use proptest::prelude::*;
use snell_math::{Point3, Transform, Vector3, portable};

use super::*;

/// The vector area of a closed polygon: half the sum of its corners' cross products.
fn polygon_area(corners: &[Point3]) -> Vector3 {
    let origin = corners[0];
    corners
        .iter()
        .zip(corners.iter().cycle().skip(1))
        .fold(Vector3::ZERO, |sum, (&a, &b)| sum + (a - origin).cross(b - origin) * 0.5)
}

fn triangles_area(corners: &[Point3], triangles: &[[u32; 3]]) -> Vector3 {
    triangles.iter().fold(Vector3::ZERO, |sum, t| {
        let [a, b, c] = t.map(|i| corners[i as usize]);
        sum + (b - a).cross(c - a) * 0.5
    })
}

/// Twin of the comparison below: it must see a triangle that is missing or turned around.
fn covers(corners: &[Point3], triangles: &[[u32; 3]]) -> bool {
    let area = polygon_area(corners);
    let sum: f64 = triangles.iter().map(|&t| triangles_area(corners, &[t]).length()).sum();
    (triangles_area(corners, triangles) - area).length() < 1e-9 * (1.0 + area.length())
        && (sum - area.length()).abs() < 1e-9 * (1.0 + area.length())
}

/// A star-shaped polygon in a plane that is turned any way.
fn star(radii: &[f64], axis: Vector3, angle: f64) -> Vec<Point3> {
    let turn = Transform::rotate(axis.normalize(), angle);
    let step = std::f64::consts::TAU / radii.len() as f64;
    radii
        .iter()
        .enumerate()
        .map(|(i, r)| {
            let a = i as f64 * step;
            turn.point(Point3::new(r * portable::cos(a), r * portable::sin(a), 3.0))
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]
    #[test]
    fn star_shapes_are_covered_exactly(
        radii in prop::collection::vec(0.2f64..2.0, 3..200),
        axis in (-1.0f64..1.0, -1.0f64..1.0, 0.1f64..1.0),
        angle in -3.0f64..3.0,
    ) {
        let corners = star(&radii, Vector3::new(axis.0, axis.1, axis.2), angle);
        let triangles = triangulate(&corners).unwrap();
        prop_assert!(covers(&corners, &triangles));
        prop_assert!(triangles.len() <= corners.len() - 2);
    }

    #[test]
    fn any_numbers_at_all_give_triples_in_range(points in prop::collection::vec(prop::array::uniform3(prop::num::f64::ANY), 0..40)) {
        let corners: Vec<_> = points.iter().map(|&p| Point3::from(p)).collect();
        for t in triangulate(&corners).unwrap() {
            prop_assert!(t.iter().all(|&i| (i as usize) < corners.len()));
        }
    }
}

#[test]
fn the_comparison_sees_planted_defects() {
    let corners = star(&[1.0, 0.3, 1.0, 0.3, 1.0, 0.3, 1.0, 0.3], Vector3::X, 0.7);
    let good = triangulate(&corners).unwrap();
    assert!(covers(&corners, &good));
    assert!(!covers(&corners, &good[1..]));
    let mut turned = good.clone();
    turned[0].swap(0, 1);
    assert!(!covers(&corners, &turned));
}

#[test]
fn degenerate_polygons_give_nothing() {
    let p = |x: f64, y: f64| Point3::new(x, y, 1.0);
    assert_eq!(triangulate(&[]).unwrap().len(), 0);
    assert_eq!(triangulate(&[p(0.0, 0.0), p(1.0, 0.0)]).unwrap().len(), 0);
    assert_eq!(triangulate(&[p(0.0, 0.0), p(1.0, 1.0), p(2.0, 2.0), p(3.0, 3.0)]).unwrap().len(), 0);
    assert_eq!(triangulate(&[p(1.0, 1.0); 9]).unwrap().len(), 0);
}

#[test]
fn repeated_corners_are_harmless() {
    let p = |x: f64, y: f64| Point3::new(x, y, 1.0);
    let corners = [p(0.0, 0.0), p(0.0, 0.0), p(2.0, 0.0), p(2.0, 2.0), p(2.0, 2.0), p(1.0, 0.5), p(0.0, 2.0)];
    assert!(covers(&corners, &triangulate(&corners).unwrap()));
}

#[test]
fn huge_and_tiny_coordinates_are_as_good_as_any() {
    for scale in [1e-150, 1e150] {
        let corners: Vec<_> =
            star(&[1.0, 0.3, 1.0, 0.3, 1.0, 0.3], Vector3::Y, 0.4).iter().map(|p| Point3(p.0 * scale)).collect();
        assert_eq!(triangulate(&corners).unwrap().len(), 4);
    }
}

#[test]
fn a_large_polygon_that_is_not_convex_is_refused_and_a_convex_one_is_not() {
    let count = MAX_CONCAVE_CORNERS + 1;
    let round = star(&vec![1.0; count], Vector3::X, 0.0);
    assert_eq!(triangulate(&round).unwrap().len(), count - 2);
    let jagged: Vec<f64> = (0..count).map(|i| if i % 2 == 0 { 1.0 } else { 0.9 }).collect();
    assert_eq!(triangulate(&star(&jagged, Vector3::X, 0.0)), Err(TooComplex));
}

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
    fn a_polygon_does_not_depend_on_those_before_it(
        polygons in prop::collection::vec(prop::collection::vec(prop::array::uniform3(-3i8..3), 0..30), 0..8),
    ) {
        let mut triangulator = Triangulator::default();
        for polygon in polygons {
            let corners: Vec<_> = polygon.iter().map(|p| Point3::from(p.map(f64::from))).collect();
            let mut triangles = Vec::new();
            triangulator.triangulate(corners.iter().map(|p| p.to_array()), &mut triangles).unwrap();
            prop_assert_eq!(triangles, triangulate(&corners).unwrap());
        }
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
fn a_hole_joined_to_the_border_stays_open() {
    let p = |x: f64, y: f64| Point3::new(x, y, 1.0);
    let border = [p(0.0, 0.0), p(9.0, 0.0), p(9.0, 9.0), p(0.0, 9.0), p(0.0, 0.0)];
    let hole = [p(3.0, 3.0), p(3.0, 6.0), p(6.0, 6.0), p(6.0, 3.0), p(3.0, 3.0)];
    let corners = [border.as_slice(), hole.as_slice()].concat();
    let triangles = triangulate(&corners).unwrap();
    assert!(covers(&corners, &triangles));
    assert!((polygon_area(&corners).length() - 72.0).abs() < 1e-12);
}

#[test]
fn spirals_and_combs_are_covered_exactly() {
    let p = |x: f64, y: f64| Point3::new(x, y, 1.0);
    let arm = |i: usize, width: f64| {
        let (angle, radius) = (i as f64 * 0.1, 1.0 + i as f64 * 0.02 + width);
        p(radius * portable::cos(angle), radius * portable::sin(angle))
    };
    let spiral: Vec<_> = (0..800).map(|i| arm(i, 0.3)).chain((0..800).rev().map(|i| arm(i, 0.0))).collect();
    assert!(covers(&spiral, &triangulate(&spiral).unwrap()));
    let teeth = (0..500).flat_map(|i| [p(f64::from(i), 1.0), p(f64::from(i) + 0.5, 9.0 + f64::from(i % 7))]);
    let comb: Vec<_> = [p(499.5, 0.0), p(0.0, 0.0)].into_iter().chain(teeth).rev().collect();
    assert!(covers(&comb, &triangulate(&comb).unwrap()));
}

#[test]
fn a_convex_polygon_may_have_any_number_of_corners_and_a_jagged_one_many() {
    let round = star(&vec![1.0; 100_000], Vector3::X, 0.0);
    assert_eq!(triangulate(&round).unwrap().len(), 99_998);
    let jagged: Vec<f64> = (0..8192).map(|i| if i % 2 == 0 { 1.0 } else { 0.9 }).collect();
    let corners = star(&jagged, Vector3::X, 0.0);
    assert!(covers(&corners, &triangulate(&corners).unwrap()));
}

/// What fuzzing found: the same few corners over and over.
#[test]
fn a_polygon_that_crosses_itself_everywhere_ends_soon() {
    let cube = |i: usize| Point3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2 & 1) as f64 * 0.5);
    let mut state = 1u32;
    let corners: Vec<_> = (0..3000)
        .map(|_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            cube((state >> 24) as usize % 8)
        })
        .collect();
    let mut triangulator = Triangulator::default();
    let mut triangles = Vec::new();
    triangulator.triangulate(corners.iter().map(|p| p.to_array()), &mut triangles).unwrap();
    assert!(triangulator.work < (WORK_PER_SQUARE + 1) * 3000 * 3000);
}

#[test]
fn too_much_work_for_one_file_is_refused() {
    let jagged: Vec<f64> = (0..4096).map(|i| if i % 2 == 0 { 1.0 } else { 0.9 }).collect();
    let corners = star(&jagged, Vector3::X, 0.0);
    let mut triangulator = Triangulator { work: BASE_WORK + 10_000_000, ..Triangulator::default() };
    let refused = triangulator.triangulate(corners.iter().map(|p| p.to_array()), &mut Vec::new());
    assert_eq!(refused, Err(TooComplex));
}

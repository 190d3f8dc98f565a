//! Warps against the densities beside them: places.

use snell_math::warp::{
    Aperture, PiecewiseConstant, PiecewiseConstantPlane, SphericalRectangle, UNIFORM_DISK_DENSITY, exponential,
    exponential_density, triangle, triangle_density, truncated_exponential, truncated_exponential_density,
    uniform_disk,
};
use snell_math::{Point3, Vector3};
use snell_testkit::chi_square::{Histogram, assert_counts};
use snell_testkit::{TestRng, must_fail};

const SQUARE: [[f64; 2]; 2] = [[0.0, 1.0], [0.0, 1.0]];

/// Places of a disk as (radius squared, angle): uniform in both.
fn polar([x, y]: [f64; 2]) -> Option<[f64; 2]> {
    Some([x * x + y * y, snell_math::portable::atan2(y, x)])
}

#[test]
fn disk() {
    use std::f64::consts::PI;
    let grid = Histogram::over([[0.0, 1.0], [-PI, PI]]);
    // dx dy = ½ d(r²) dφ.
    grid.assert("disk", |u| polar(uniform_disk(u)), |_| 0.5 * UNIFORM_DISK_DENSITY);
    must_fail("radii that are uniform", || {
        let [radius, turn] = [0, 1];
        let wrong = |u: [f64; 2]| Some([u[radius] * u[radius], PI * (2.0 * u[turn] - 1.0)]);
        grid.assert("disk", wrong, |_| 0.5 * UNIFORM_DISK_DENSITY);
    });
}

#[test]
fn triangles() {
    // Barycentric coordinates over their square; half of it is outside, whose cells on the diagonal are halved.
    let grid = Histogram::over(SQUARE).with_cells([16, 16]);
    let density = |[a, b]: [f64; 2]| if a + b < 1.0 { 2.0 } else { 0.0 };
    grid.assert("triangle", |u| Some(triangle(u)), density);
    must_fail("a square folded along the wrong diagonal", || {
        grid.assert("triangle", |[u, v]| Some([u * v, v * (1.0 - u)]), density);
    });
    let corners = [Point3::new(1.0, 2.0, 3.0), Point3::new(1.0, 2.0, 5.0), Point3::new(1.0, 5.0, 3.0)];
    assert!((triangle_density(corners) - 1.0 / 3.0).abs() < 1e-15);
}

/// A rectangle in an oblique frame, its place in its own coordinates, and the density per unit of their area.
fn check_rectangle(from: Point3, tests: u32, density_factor: impl Fn([f64; 2]) -> f64) {
    let axis_x = Vector3::new(1.0, 2.0, 0.5).normalize();
    let axis_y = axis_x.cross(Vector3::new(0.0, 0.3, 1.0)).normalize();
    let normal = axis_x.cross(axis_y);
    let (corner, size) = (Point3::new(0.3, -0.2, 0.1), [1.5, 0.7]);
    let rectangle = SphericalRectangle::new(from, corner, axis_x * size[0], axis_y * size[1]).expect("it is seen");
    let grid = Histogram::over([[0.0, size[0]], [0.0, size[1]]]).one_of(tests);
    let place = |[x, y]: [f64; 2]| corner + (axis_x * x + axis_y * y);
    let sample = |u| {
        let from_corner = rectangle.sample(u) - corner;
        assert!(from_corner.dot(normal).abs() < 1e-9);
        Some([from_corner.dot(axis_x), from_corner.dot(axis_y)])
    };
    let density = |coordinates| {
        let towards = place(coordinates) - from;
        let squared = towards.length_squared();
        let cos = towards.dot(normal).abs() / squared.sqrt();
        rectangle.density(place(coordinates)) * cos / squared * density_factor(coordinates)
    };
    grid.assert("spherical rectangle", sample, density);
}

#[test]
fn spherical_rectangles() {
    let places = [[0.5, 0.3, 0.6], [1.0, 0.1, -0.4], [3.0, 4.0, 5.0], [0.31, -0.2, 0.3], [20.0, 70.0, -90.0]];
    for from in places {
        check_rectangle(Point3::from(from), places.len() as u32, |_| 1.0);
    }
    must_fail("a density of places in area", || {
        check_rectangle(Point3::from(places[0]), 1, |[x, _]| 1.0 + 0.1 * (x - 0.75));
    });
}

#[test]
fn solid_angles_of_rectangles_are_exact_and_go_over_smoothly() {
    // A pyramid over a × b of height h: 4 asin(ab / √((a² + 4h²) (b² + 4h²))).
    let exact = |a: f64, b: f64, h: f64| {
        4.0 * snell_math::portable::asin(a * b / ((a * a + 4.0 * h * h) * (b * b + 4.0 * h * h)).sqrt())
    };
    let seen = |a: f64, b: f64, h: f64| {
        let corner = Point3::new(-0.5 * a, -0.5 * b, h);
        SphericalRectangle::new(Point3::ORIGIN, corner, Vector3::new(a, 0.0, 0.0), Vector3::new(0.0, b, 0.0))
            .map(|rectangle| rectangle.solid_angle())
    };
    for (a, b, h) in [(2.0, 2.0, 1.0), (2.0, 1.0, 0.01), (1.0, 3.0, 7.0), (1.0, 1.0, 95.0), (1.0, 1.0, 105.0)] {
        let ours = seen(a, b, h).expect("seen");
        assert!((ours / exact(a, b, h) - 1.0).abs() < 1e-4, "{a} {b} {h}: {ours}");
        assert!((seen(a, b, -h).expect("seen from behind") - ours).abs() < 1e-12);
    }
    assert_eq!(seen(1.0, 1.0, 0.0), None, "edge-on");
    assert_eq!(seen(1.0, 0.0, 1.0), None, "no area");
}

#[test]
fn any_view_of_a_rectangle_gives_places_in_it() {
    let mut rng = TestRng::new(21);
    let mut seen = 0;
    for _ in 0..3000 {
        // Sizes and distances of all orders, also from nearly in the plane, and numbers at the ends.
        let mut size = || snell_math::portable::pow(10.0, rng.range(-3.0, 3.0));
        let (width, height, far, aside) = (size(), size(), size(), size());
        let flat = rng.coin();
        let from = Point3::new(aside * rng.range(-1.0, 1.0), far, if flat { 1e-6 * far } else { aside });
        let corner = Point3::new(rng.range(-1.0, 1.0), rng.range(-1.0, 1.0), 0.0);
        let (edge_x, edge_y) = (Vector3::new(width, 0.0, 0.0), Vector3::new(0.0, height, 0.0));
        let Some(rectangle) = SphericalRectangle::new(from, corner, edge_x, edge_y) else { continue };
        seen += 1;
        assert!(rectangle.solid_angle() > 0.0 && rectangle.solid_angle() <= 2.0 * std::f64::consts::PI + 1e-9);
        for u in [[0.0, 0.0], [0.0, 0.999_999_999], [0.999_999_999, 0.0], [0.5, 0.5], [rng.unit(), rng.unit()]] {
            let place = rectangle.sample(u);
            let off = place - corner;
            let slack = 1e-9 * (1.0 + width + height + from.max_abs());
            let inside = (-slack..=width + slack).contains(&off.x()) && (-slack..=height + slack).contains(&off.y());
            assert!(inside && off.z().abs() <= slack, "{rectangle:?} {u:?}: {place:?}");
            let density = rectangle.density(place);
            assert!(density > 0.0 && density.is_finite(), "{rectangle:?} {u:?}: {density}");
        }
    }
    assert!(seen > 2500, "{seen}");
}

#[test]
fn distances() {
    let grid = Histogram::over([[0.0, 6.0], [0.0, 1.0]]).with_cells([60, 2]).one_of(3);
    grid.assert("free paths", |[u, v]| Some([exponential(u, 0.8), v]), |[t, _]| exponential_density(t, 0.8));
    for coefficient in [0.3, 1e-7] {
        let sample = |[u, v]: [f64; 2]| Some([truncated_exponential(u, coefficient, 6.0), v]);
        let density = |[t, _]: [f64; 2]| truncated_exponential_density(t, coefficient, 6.0);
        grid.assert("cut off", sample, density);
    }
    must_fail("another coefficient", || {
        grid.assert("free paths", |[u, v]| Some([exponential(u, 0.83), v]), |[t, _]| exponential_density(t, 0.8));
    });
    assert_eq!(exponential_density(-1.0, 0.8) + truncated_exponential_density(6.1, 0.8, 6.0), 0.0);
}

#[test]
fn apertures() {
    use snell_math::portable::{atan2, cos};
    use std::f64::consts::PI;
    for (test, blades) in [3, 6, 7].into_iter().enumerate() {
        let aperture = Aperture::new(blades, PI);
        // How far the edge is in a direction; places are counted by direction and by (r / that)², so that cells end at edges.
        let edge = |angle: f64| {
            let side = 2.0 * PI / f64::from(blades);
            cos(0.5 * side) / cos((angle + PI).rem_euclid(side) - 0.5 * side)
        };
        let grid = Histogram::over([[-PI, PI], [0.0, 1.0]]).with_cells([6 * blades as usize, 10]).one_of(3);
        let grid = Histogram { seed: test as u64, ..grid };
        let coordinates = |[x, y]: [f64; 2]| {
            let angle = atan2(y, x);
            Some([angle, (x * x + y * y) / (edge(angle) * edge(angle))])
        };
        let density = |[angle, _]: [f64; 2]| aperture.density() * 0.5 * edge(angle) * edge(angle);
        grid.assert("aperture", |u| coordinates(aperture.sample(u)), density);
        must_fail("a turned aperture", || {
            grid.assert("aperture", |u| coordinates(Aperture::new(blades, 0.2).sample(u)), density);
        });
    }
    let circle = Aperture::new(0, 1.0);
    assert_eq!(circle.sample([0.3, 0.9]), uniform_disk([0.3, 0.9]));
    assert_eq!(circle.density(), UNIFORM_DISK_DENSITY);
}

#[test]
fn choices() {
    let weights = [0.0, 3.0, 1.0, 0.0, 0.5, -2.0, f64::NAN, 4.0, 0.0];
    let choice = PiecewiseConstant::new(&weights).expect("some are positive");
    assert!((choice.integral() - 8.5 / 9.0).abs() < 1e-15);
    let count = |choose: &dyn Fn(f64) -> usize| {
        let mut rng = TestRng::new(6);
        let mut counts = [0; 9];
        (0..50_000).for_each(|_| counts[choose(rng.unit())] += 1);
        counts
    };
    let expected: Vec<f64> = (0..9).map(|i| 50_000.0 * choice.probability(i)).collect();
    assert_counts("choices", &count(&|u| choice.sample(u).index), &expected, 1);
    must_fail("the neighbour", || assert_counts("", &count(&|u| choice.sample(u).index.max(1) - 1), &expected, 1));
    must_fail("a small bias", || assert_counts("", &count(&|u| choice.sample(u * 0.98).index), &expected, 1));

    // What is left of the number is uniform again, and places have their density.
    let place = |[u, v]: [f64; 2]| {
        let piece = choice.sample(u);
        Some([(piece.index as f64 + piece.within) / 9.0, v])
    };
    Histogram::over(SQUARE).with_cells([45, 2]).assert("places", place, |[x, _]| choice.density(x));
    // The ends, and pieces of weight 0 there.
    assert_eq!(choice.sample(0.0).index, 1);
    assert_eq!(choice.sample(1.0 - f64::EPSILON).index, 7);
    assert_eq!(choice.sample(1.0).index, 7);
    assert_eq!((choice.probability(9), choice.density(1.0), choice.density(-0.1)), (0.0, 0.0, 0.0));
    for hopeless in [&[][..], &[0.0, -1.0], &[f64::NAN], &[f64::INFINITY, 1.0]] {
        assert_eq!(PiecewiseConstant::new(hopeless), None);
    }
}

#[test]
fn environment_maps() {
    let mut rng = TestRng::new(8);
    let weights: Vec<f64> = (0..12 * 7).map(|i| if (36..48).contains(&i) { 0.0 } else { rng.unit() - 0.2 }).collect();
    let map = PiecewiseConstantPlane::new(12, &weights).expect("some are positive");
    let grid = Histogram::over(SQUARE).with_cells([24, 14]);
    let sample = |u| {
        let spot = map.sample(u);
        assert!((spot.density - map.density(spot.place)).abs() < 1e-9 * spot.density, "{spot:?}");
        assert!(weights[spot.row * 12 + spot.column] > 0.0);
        Some(spot.place)
    };
    grid.assert("map", sample, |place| map.density(place));
    let mut other = weights.clone();
    other[5] += 1.0;
    let other = PiecewiseConstantPlane::new(12, &other).expect("some are positive");
    must_fail("one pixel brighter", || grid.assert("map", |u| Some(other.sample(u).place), |place| map.density(place)));
    assert_eq!(PiecewiseConstantPlane::new(0, &[]), None);
    assert_eq!(PiecewiseConstantPlane::new(2, &[1.0, 1.0, 1.0]), None);
    assert_eq!(PiecewiseConstantPlane::new(2, &[0.0, 0.0, f64::INFINITY, 1.0]), None);
    assert_eq!(map.density([0.5, 1.5]), 0.0);
}

//! Warps against the densities beside them: directions.

use snell_math::warp::{
    Cone, UNIFORM_SPHERE_DENSITY, cosine_hemisphere, cosine_hemisphere_density, henyey_greenstein,
    henyey_greenstein_density, uniform_cone, uniform_cone_density, uniform_sphere,
};
use snell_math::{Point3, Vector3};
use snell_testkit::chi_square::Histogram;
use snell_testkit::{TestRng, must_fail};
use std::f64::consts::PI;

#[test]
fn sphere_and_hemisphere() {
    let grid = Histogram::of_directions();
    grid.assert_directions("sphere", |u| Some(uniform_sphere(u)), |_| UNIFORM_SPHERE_DENSITY);
    grid.assert_directions("cosine", |u| Some(cosine_hemisphere(u)), |d| cosine_hemisphere_density(d.z()));
    must_fail("a hemisphere without its cosine", || {
        let folded = |u| {
            let d = uniform_sphere(u);
            Some(Vector3::new(d.x(), d.y(), d.z().abs()))
        };
        grid.assert_directions("cosine", folded, |d| cosine_hemisphere_density(d.z()));
    });
}

#[test]
fn directions_are_unit() {
    let mut rng = TestRng::new(1);
    for _ in 0..1000 {
        let u = [rng.unit(), rng.unit()];
        let g = rng.range(-1.0, 1.0);
        for direction in
            [uniform_sphere(u), cosine_hemisphere(u), uniform_cone(u, u[0] * u[1]), henyey_greenstein(u, g)]
        {
            assert!((direction.length() - 1.0).abs() < 1e-14, "{direction:?}");
        }
    }
    for u in [[0.0, 0.0], [0.5, 0.5], [0.0, 0.5], [1.0 - f64::EPSILON, 1.0 - f64::EPSILON]] {
        assert!((uniform_sphere(u).length() - 1.0).abs() < 1e-14);
    }
}

#[test]
fn cones() {
    for (test, one_minus_cos) in [2.0, 0.7, 1e-3, 1e-12].into_iter().enumerate() {
        // By the share of the cone's height, so that narrow cones fill the histogram; 1 − cos = 2 sin²(θ/2).
        let grid = Histogram { seed: test as u64, ..Histogram::over([[0.0, 1.0], [-PI, PI]]).one_of(4) };
        let sample = |u| {
            let d = uniform_cone(u, one_minus_cos);
            let chord = d - Vector3::Z;
            let share = 0.5 * chord.length_squared() / one_minus_cos;
            Some([share, Histogram::coordinates(d)[1]])
        };
        grid.assert("cone", sample, |_| uniform_cone_density(one_minus_cos) * one_minus_cos);
        must_fail("a cone that is too wide", || {
            let wide = |u| sample(u).map(|[share, angle]| [share * 1.05, angle]);
            grid.assert("cone", wide, |_| uniform_cone_density(one_minus_cos) * one_minus_cos);
        });
    }
}

#[test]
fn lights_that_are_spheres() {
    let mut rng = TestRng::new(12);
    for (center, radius) in [([2.0, 1.0, -3.0], 1.5), ([-200.0, 10.0, 0.0], 1.0), ([0.1, 0.0, 0.0], 1.0)] {
        let center = Point3::from(center);
        let cone = Cone::around_sphere(Point3::ORIGIN, center, radius).expect("it is seen");
        for _ in 0..1000 {
            let direction = cone.sample([rng.unit(), rng.unit()]);
            // It meets the sphere: the distance of the centre from the ray is at most the radius.
            let to_center = center - Point3::ORIGIN;
            let off = to_center.cross(direction).length();
            assert!(off <= radius * (1.0 + 1e-9));
            assert!((cone.density(direction) * cone.solid_angle() - 1.0).abs() < 1e-9);
        }
    }
    let outside = Cone::around_sphere(Point3::ORIGIN, Point3::new(0.0, 0.0, 2.0), 1.0).expect("it is seen");
    assert!((outside.half_angle() - PI / 6.0).abs() < 1e-14);
    assert_eq!(outside.density(Histogram::direction([0.8, 0.0])), 0.0);
    let grid = Histogram::over([[3.0_f64.sqrt() / 2.0, 1.0], [-PI, PI]]);
    grid.assert_directions("sphere light", |u| Some(outside.sample(u)), |_| 1.0 / outside.solid_angle());
    must_fail("sampled by the sphere's area", || {
        let front = |u| {
            let place = Point3::new(0.0, 0.0, 2.0) + uniform_sphere(u) * 1.0;
            Some((place - Point3::ORIGIN).normalize())
        };
        grid.assert_directions("sphere light", front, |_| 1.0 / outside.solid_angle());
    });
    assert_eq!(Cone::around_sphere(Point3::ORIGIN, Point3::ORIGIN, 0.0), None);
    assert_eq!(Cone::around_sphere(Point3::ORIGIN, Point3::new(f64::NAN, 0.0, 0.0), 1.0), None);
    let inside = Cone::around_sphere(Point3::ORIGIN, Point3::ORIGIN, 1.0).expect("from inside");
    assert!((inside.solid_angle() - 4.0 * PI).abs() < 1e-14);
}

#[test]
fn phase_function() {
    let anisotropies = [0.0, 1e-9, 0.3, -0.6, 0.9];
    let grid = Histogram::of_directions().one_of(anisotropies.len() as u32);
    for g in anisotropies {
        grid.assert_directions("phase", |u| Some(henyey_greenstein(u, g)), |d| henyey_greenstein_density(d.z(), g));
        must_fail("another anisotropy", || {
            let density = |d: Vector3| henyey_greenstein_density(d.z(), g + 0.03);
            grid.assert_directions("phase", |u| Some(henyey_greenstein(u, g)), density);
        });
        // g is the mean cosine.
        let mut rng = TestRng::new(3);
        let mean = (0..40_000).map(|_| henyey_greenstein([rng.unit(), rng.unit()], g).z()).sum::<f64>() / 40_000.0;
        assert!((mean - g).abs() < 0.01, "{mean} {g}");
    }
    // The end of the range, where a difference of squares would have no digits.
    let narrow = henyey_greenstein([0.5, 0.1], 1.0);
    assert!(narrow.z() > 0.999_999 && narrow.x() > 0.0);
    assert!((henyey_greenstein([0.5, 0.1], -1.0).z() + 1.0).abs() < 1e-5);
}

//! Values that geometry and parsers meet rarely and must survive: zeros of both signs, denormal, huge, infinite, NaN; and
//! rays made of them.

use snell_math::{Point3, Ray, Vector3};

use crate::TestRng;

/// Nasty numbers: every kind of float, and the neighbours of one.
pub const NUMBERS: [f64; 24] = [
    0.0,
    -0.0,
    f64::from_bits(1), // the smallest denormal
    -f64::from_bits(1),
    f64::MIN_POSITIVE,
    -f64::MIN_POSITIVE,
    1e-300,
    1e-160, // its square is denormal
    -1e-16,
    f64::EPSILON,
    1.0,
    -1.0,
    1.0 + f64::EPSILON,
    1.0 - f64::EPSILON / 2.0,
    1e7,
    9_007_199_254_740_992.0, // 2^53: whole numbers end
    -1e16,
    1e154, // its square is finite, the sum of two such squares is not far from the end
    1e160, // its square is infinite
    f64::MAX,
    f64::MIN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

/// Those of [`NUMBERS`] that are finite.
pub fn finite() -> impl Iterator<Item = f64> {
    NUMBERS.into_iter().filter(|number| number.is_finite())
}

/// `count` rays, the same for a seed: origins and directions of nasty numbers, ordinary numbers, and axes; directions are not
/// unit, and may be zero, infinite or NaN.
pub fn rays(seed: u64, count: usize) -> impl Iterator<Item = Ray> {
    let mut rng = TestRng::new(seed);
    (0..count).map(move |_| {
        let origin = triple(&mut rng);
        let direction = match rng.below(4) {
            0 => *rng.pick(&[Vector3::X, Vector3::Y, Vector3::Z, -Vector3::X, -Vector3::Y, -Vector3::Z]),
            1 => rng.direction(),
            _ => Vector3::from(triple(&mut rng)),
        };
        Ray::new(Point3::from(origin), direction)
    })
}

/// `count` rays with finite origins and unit directions, the same for a seed: what a tracer may be asked for. Many run
/// along axes, or nearly; origins reach from −0 to 1e16.
pub fn unit_rays(seed: u64, count: usize) -> impl Iterator<Item = Ray> {
    let mut rng = TestRng::new(seed);
    let sizes = [0.0, -0.0, 1e-300, 1e-9, 0.5, 1.0, -1.0, 3.0, 1e4, -1e8, 1e16];
    (0..count).map(move |_| {
        let mut number = || *rng.pick(&sizes);
        let origin = Point3::new(number(), number(), number());
        let axis = *rng.pick(&[Vector3::X, Vector3::Y, Vector3::Z, -Vector3::X, -Vector3::Y, -Vector3::Z]);
        let direction = match rng.below(4) {
            0 => axis,
            1 => axis + rng.direction() * 1e-9,
            2 => axis + rng.direction() * 1e-3,
            _ => rng.direction(),
        };
        Ray::new(origin, direction * (1.0 / direction.length()))
    })
}

fn triple(rng: &mut TestRng) -> [f64; 3] {
    [(); 3].map(|()| if rng.coin() { *rng.pick(&NUMBERS) } else { rng.range(-10.0, 10.0) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::num::FpCategory;

    #[test]
    fn every_kind_of_number_is_there() {
        for kind in [FpCategory::Zero, FpCategory::Subnormal, FpCategory::Normal, FpCategory::Infinite, FpCategory::Nan]
        {
            assert!(NUMBERS.iter().any(|number| number.classify() == kind), "{kind:?}");
        }
        assert!(NUMBERS[1].is_sign_negative() && NUMBERS[1] == 0.0);
        assert!(finite().all(f64::is_finite) && finite().count() == 21);
    }

    #[test]
    fn rays_are_the_same_in_every_run_and_some_are_hopeless() {
        let bits = |seed| rays(seed, 200).map(|ray| ray.direction.to_array().map(f64::to_bits)).collect::<Vec<_>>();
        assert_eq!(bits(5), bits(5));
        assert_ne!(bits(5), bits(6));
        let hopeless = |ray: &Ray| !ray.direction.is_finite() || ray.direction.length_squared() == 0.0;
        let count = rays(5, 200).filter(hopeless).count();
        assert!((10..150).contains(&count), "{count}");
    }

    #[test]
    fn unit_rays_are_unit() {
        for ray in unit_rays(9, 500) {
            assert!(ray.origin.is_finite() && (ray.direction.length() - 1.0).abs() < 1e-12, "{ray:?}");
        }
    }
}

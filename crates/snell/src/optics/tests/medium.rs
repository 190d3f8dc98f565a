//! Absorption and scattering against their closed forms.

use std::f64::consts::PI;

use proptest::prelude::*;
use snell_math::lanes::{InstructionSet, Lanes, WIDTH, Work, dispatch};
use snell_math::{Rgb, portable};

use super::config;
use crate::optics::{Stretches, beer_lambert, henyey_greenstein};

/// ∫ f(cos) dω over the sphere, by Gauss's three-point rule in many pieces.
fn over_sphere(f: impl Fn(f64) -> f64) -> f64 {
    let pieces = 40_000;
    let half = 1.0 / f64::from(pieces);
    let node = 0.6_f64.sqrt() * half;
    (0..pieces)
        .map(|i| {
            let middle = -1.0 + (2.0 * f64::from(i) + 1.0) * half;
            2.0 * PI * half * (5.0 * f(middle - node) + 8.0 * f(middle) + 5.0 * f(middle + node)) / 9.0
        })
        .sum()
}

#[test]
fn the_phase_function_is_normalised_and_has_its_mean_cosine() {
    for g in [-0.95, -0.5, -0.1, 0.0, 0.3, 0.8, 0.95] {
        assert!((over_sphere(|cos| henyey_greenstein(cos, g)) - 1.0).abs() < 1e-9, "{g}");
        assert!((over_sphere(|cos| cos * henyey_greenstein(cos, g)) - g).abs() < 1e-9, "{g}");
        // Its higher moments are the powers of g, by Legendre's polynomials.
        let second = over_sphere(|cos| 0.5 * (3.0 * cos * cos - 1.0) * henyey_greenstein(cos, g));
        assert!((second - g * g).abs() < 1e-9, "{g}");
    }
    // The twin: an angle measured the other way.
    assert!((over_sphere(|cos| cos * henyey_greenstein(-cos, 0.3)) - 0.3).abs() > 0.1);
}

#[test]
fn the_phase_function_is_a_number_for_any_argument() {
    for g in [-f64::INFINITY, -1.0, 1.0, 2.0] {
        for cos in [-2.0, -1.0, 0.0, 1.0, 2.0] {
            assert!(henyey_greenstein(cos, g).is_finite() && henyey_greenstein(cos, g) >= 0.0, "{cos} {g}");
        }
    }
}

#[test]
fn a_clear_channel_passes_exactly_everything() {
    for distance in [0.0, 1.0, 1e300, f64::INFINITY] {
        assert_eq!(beer_lambert(Rgb::BLACK, distance), Rgb::WHITE);
        assert_eq!(beer_lambert(Rgb::new(0.0, 1e30, 0.0), distance).r, 1.0);
    }
    assert_eq!(beer_lambert(Rgb::gray(1.0), f64::INFINITY), Rgb::BLACK);
    assert_eq!(beer_lambert(Rgb::gray(3.0), 0.0), Rgb::WHITE);
    assert_eq!(beer_lambert(Rgb::gray(f32::MAX), f64::MAX), Rgb::BLACK);
    assert_eq!(beer_lambert(Rgb::gray(1.0), -1.0), Rgb::WHITE);
}

/// Eight rays of which each travels in a body of its own.
struct Bodies {
    coefficients: [Rgb; WIDTH],
    distances: [f64; WIDTH],
}

impl Work for &Bodies {
    type Output = [[u32; 3]; WIDTH];
    /// What is left of white light.
    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        let (mut stretches, mut light) = (Stretches::NONE, [[1.0; WIDTH]; 3]);
        for lane in 0..WIDTH {
            stretches.put(lane, self.coefficients[lane], self.distances[lane]);
        }
        for at in (0..WIDTH).step_by(L::COUNT) {
            stretches.absorb::<L>(&mut light, at);
        }
        std::array::from_fn(|lane| light.map(|row| row[lane].to_bits()))
    }
}

impl Bodies {
    fn one_by_one(&self) -> [[u32; 3]; WIDTH] {
        let left = |lane: usize| beer_lambert(self.coefficients[lane], self.distances[lane]);
        std::array::from_fn(|lane| left(lane).to_array().map(f32::to_bits))
    }
}

#[test]
fn side_by_side_as_much_is_absorbed_as_of_one_ray() {
    let special = [0.0, 1e-30, 0.3, 1.0, 40.0, 1e30, f32::MAX, f32::INFINITY];
    let distances = [0.0, -1.0, 1e-9, 0.7, 100.0, 1e300, f64::INFINITY, f64::NAN];
    for shift in 0..WIDTH {
        let channel = |lane: usize, step: usize| special[(lane * step + shift) % WIDTH];
        let coefficients = std::array::from_fn(|lane| Rgb::new(channel(lane, 1), channel(lane, 3), channel(lane, 5)));
        let bodies = Bodies { coefficients, distances };
        for set in InstructionSet::available() {
            assert_eq!(dispatch(set, &bodies), bodies.one_by_one(), "{set:?} {shift}");
        }
        // The twin: rays that took each other's way.
        let mut exchanged = Bodies { coefficients, distances };
        exchanged.distances.swap(3, 4);
        assert_ne!(dispatch(InstructionSet::best(), &exchanged), bodies.one_by_one(), "{shift}");
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn absorption_is_exponential(coefficient in 0.0..5.0f32, a in 0.0..3.0f64, b in 0.0..3.0f64) {
        let left = |distance| f64::from(beer_lambert(Rgb::gray(coefficient), distance).g);
        let expected = portable::exp(-f64::from(coefficient) * a);
        prop_assert!((left(a) - expected).abs() <= 6e-8 * expected);
        prop_assert!((left(a) * left(b) - left(a + b)).abs() <= 2e-7 * left(a + b), "two stretches are one");
        prop_assert!(left(a + b) <= left(a));
    }
}

//! The noise against what is promised of it: its bound, its smoothness, its statistics, and that it never repeats.

use proptest::prelude::*;

use super::*;

/// Points spread evenly and without a pattern: the fractional parts of multiples of the generalised golden ratio.
fn spread(count: u32, extent: f64) -> impl Iterator<Item = [f64; 3]> {
    (1..=count).map(move |i| {
        [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3]
            .map(|step| ((f64::from(i) * step).fract() - 0.5) * extent)
    })
}

/// The largest value at a point of a cell, over all choices of the eight gradients.
fn largest(point: [f64; 3]) -> f64 {
    (0..8)
        .map(|corner| {
            let far = [corner & 1, corner >> 1 & 1, corner >> 2].map(f64::from);
            let weight: f64 =
                (0..3).map(|i| if far[i] == 1.0 { fade(point[i]) } else { 1.0 - fade(point[i]) }).product();
            let d = [0, 1, 2].map(|i| point[i] - far[i]);
            let best = GRADIENTS.iter().map(|g| g[0] * d[0] + g[1] * d[1] + g[2] * d[2]).fold(f64::MIN, f64::max);
            weight * best
        })
        .sum()
}

#[test]
fn the_bound_is_the_largest_blend() {
    let steps = 48;
    let coordinate = |i: i32| f64::from(i) / f64::from(steps);
    let mut found = (0.0, [0.0; 3]);
    for (x, y, z) in (0..=steps).flat_map(|x| (0..=x).flat_map(move |y| (0..=y).map(move |z| (x, y, z)))) {
        let point = [x, y, z].map(coordinate);
        if largest(point) > found.0 {
            found = (largest(point), point);
        }
    }
    // Refined by ever smaller steps in all directions.
    let mut step = coordinate(1);
    while step > 1e-9 {
        let moves = (0..27).map(|m| [m % 3 - 1, m / 3 % 3 - 1, m / 9 - 1].map(f64::from));
        let points = moves.map(|m| [0, 1, 2].map(|i| found.1[i] + m[i] * step));
        let best = points.map(|p| (largest(p), p)).fold(found, |a, b| if b.0 > a.0 { b } else { a });
        if best.0 == found.0 {
            step *= 0.5;
        }
        found = best;
    }
    assert!((found.0 - 1.036_353_811_211_803).abs() < 1e-12, "{found:?}");
}

#[test]
fn mean_and_deviation_are_as_documented_and_both_signs_alike() {
    for seed in [0, 1, 0xDEAD_BEEF] {
        let (mut sum, mut squares, mut positive, count) = (0.0, 0.0, 0, 200_000_u32);
        for point in spread(count, 400.0) {
            let value = gradient_noise(seed, point);
            assert!(value.abs() <= 1.037);
            sum += value;
            squares += value * value;
            positive += u32::from(value > 0.0);
        }
        let (mean, deviation) = (sum / f64::from(count), (squares / f64::from(count)).sqrt());
        // Each lattice cell gives about one independent value: a standard error of 0.27 / √count = 0.0006.
        assert!(mean.abs() < 0.003, "mean {mean}");
        assert!((deviation - 0.265).abs() < 0.01, "deviation {deviation}");
        assert!((f64::from(positive) / f64::from(count) - 0.5).abs() < 0.006);
    }
}

#[test]
fn gradients_are_chosen_evenly_and_independently_of_the_neighbours() {
    // 24³ lattice points: how often each gradient, and each pair along every axis, comes.
    let index = |p: [i64; 3]| {
        let sum = (0..3).fold(7_u64, |sum, i| sum.wrapping_add((p[i] as u64).wrapping_mul(SPREAD[i])));
        (((mix(sum) >> 32) * 12) >> 32) as usize
    };
    let chi_square = |counts: &[u32]| {
        let expected = f64::from(counts.iter().sum::<u32>()) / counts.len() as f64;
        counts.iter().map(|c| (f64::from(*c) - expected) * (f64::from(*c) - expected) / expected).sum::<f64>()
    };
    let mut single = [0; 12];
    let mut pairs = [[0; 144]; 3];
    for p in (-12..12).flat_map(|x| (-12..12).flat_map(move |y| (-12..12).map(move |z| [x, y, z]))) {
        single[index(p)] += 1;
        for axis in 0..3 {
            let mut next = p;
            next[axis] += 1;
            pairs[axis][index(p) * 12 + index(next)] += 1;
        }
    }
    // 11 and 143 degrees of freedom: the 0.9999 quantiles are 38 and 213.
    assert!(chi_square(&single) < 38.0, "{}", chi_square(&single));
    for pairs in &pairs {
        assert!(chi_square(pairs) < 213.0, "{}", chi_square(pairs));
    }
    // The twin: the hash's sum without mixing is caught.
    let mut planted = [0; 144];
    let unmixed = |x: u64| (((x.wrapping_mul(SPREAD[0]) >> 32) * 12) >> 32) as usize;
    for x in 0..13_824 {
        planted[unmixed(x) * 12 + unmixed(x + 1)] += 1;
    }
    assert!(chi_square(&planted) > 213.0);
}

#[test]
fn it_does_not_repeat_after_perlins_256_cells() {
    let differs = |step: [f64; 3]| {
        spread(1000, 50.0)
            .filter(|p| {
                (gradient_noise(3, *p) - gradient_noise(3, [p[0] + step[0], p[1] + step[1], p[2] + step[2]])).abs()
                    > 0.01
            })
            .count()
    };
    for period in [256.0, 512.0, 65536.0, 4_294_967_296.0] {
        for step in [[period, 0.0, 0.0], [0.0, period, 0.0], [0.0, 0.0, period]] {
            assert!(differs(step) > 900, "{step:?}");
        }
    }
    // The twin: a step of nothing is no difference.
    assert_eq!(differs([0.0; 3]), 0);
}

#[test]
fn seeds_give_different_noise() {
    let same = spread(1000, 50.0).filter(|p| (gradient_noise(1, *p) - gradient_noise(2, *p)).abs() < 0.01).count();
    assert!(same < 60, "{same}");
}

#[test]
fn far_and_broken_coordinates_give_zero() {
    for c in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e16, LATTICE_LIMIT] {
        for point in [[c, 0.3, 0.4], [0.3, c, 0.4], [0.3, 0.4, c]] {
            assert_eq!(gradient_noise(1, point), 0.0);
        }
    }
    assert!(gradient_noise(1, [1e9 + 0.3, -1e9 - 0.4, 0.4]).abs() > 1e-3);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn lattice_points_are_zeros_and_have_their_own_slopes(seed: u64, x in -1000..1000i32, y in -1000..1000i32, z in -1000..1000i32) {
        let p = [x, y, z].map(f64::from);
        prop_assert_eq!(gradient_noise(seed, p), 0.0);
        // The gradient there has two components of size 1: the noise does not flatten at the lattice.
        let slopes = slopes(seed, p, 1e-5);
        let sum: f64 = slopes.iter().map(|s| s.abs()).sum();
        prop_assert!((sum - 2.0).abs() < 1e-6, "{:?}", slopes);
    }

    /// Across the faces of cells, value and slope continue.
    #[test]
    fn value_and_slope_are_continuous(seed: u64, x in -100..100i32, y in -50.0..50.0f64, z in -50.0..50.0f64, axis in 0..3usize) {
        let mut on_face = [y, z, y + z];
        on_face[axis] = f64::from(x);
        let side = |offset: f64| {
            let mut p = on_face;
            p[axis] += offset;
            p
        };
        let (below, above) = (side(-1e-7), side(1e-7));
        prop_assert!((gradient_noise(seed, below) - gradient_noise(seed, above)).abs() < 1e-6);
        let (a, b) = (slopes(seed, side(-1e-4), 1e-5), slopes(seed, side(1e-4), 1e-5));
        for (a, b) in a.iter().zip(&b) {
            // The second derivative is below 50, so over 2e-4 the slope moves by less than 1e-2; a kink would move it by more.
            prop_assert!((a - b).abs() < 1e-2, "{} {}", a, b);
        }
    }
}

/// Central differences.
fn slopes(seed: u64, p: [f64; 3], h: f64) -> [f64; 3] {
    [0, 1, 2].map(|axis| {
        let side = |offset: f64| {
            let mut p = p;
            p[axis] += offset;
            gradient_noise(seed, p)
        };
        (side(h) - side(-h)) / (2.0 * h)
    })
}

//! Owen-scrambled Sobol' points: stratified as theory says, uniform, independent between pixels and sets, and better than
//! random numbers for smooth integrands.

use snell_math::sampler::{SET, Sampler};
use snell_math::sampling::{hash, pixel_sample, to_unit_f64};
use snell_testkit::chi_square::assert_counts;
use snell_testkit::must_fail;

/// The smallest t for which aligned blocks of 2ᵐ points, up to `largest` m, are (t, m, s)-nets in base 2: every box of
/// volume 2ᵗ⁻ᵐ with sides of 2⁻ᵏ holds 2ᵗ points (Niederreiter 1992, definition 4.1).
fn quality<const S: usize>(point: impl Fn(u32) -> [f64; S], largest: u32) -> u32 {
    (0..=largest)
        .flat_map(|m| (0..2).map(move |block| (m, block)))
        .map(|(m, block)| net(&point, m, block))
        .max()
        .expect("there are blocks")
}

fn net<const S: usize>(point: &impl Fn(u32) -> [f64; S], m: u32, block: u32) -> u32 {
    let points: Vec<[f64; S]> = ((block << m)..((block + 1) << m)).map(point).collect();
    (0..=m)
        .find(|t| splits::<S>(m - t).iter().all(|split| is_even(&points, split, 1 << t)))
        .expect("t = m is always enough")
}

/// All ways to cut the coordinates into 2ᵏ parts with so many cuts in all.
fn splits<const S: usize>(cuts: u32) -> Vec<[u32; S]> {
    let mut all = vec![[0; S]];
    for axis in 0..S {
        all = all
            .into_iter()
            .flat_map(|split| {
                let left = cuts - split.iter().sum::<u32>();
                let range = if axis + 1 == S { left..=left } else { 0..=left };
                range.map(move |k| {
                    let mut split = split;
                    split[axis] = k;
                    split
                })
            })
            .collect();
    }
    all
}

fn is_even<const S: usize>(points: &[[f64; S]], split: &[u32; S], each: u32) -> bool {
    let mut counts = vec![0; 1 << split.iter().sum::<u32>()];
    for point in points {
        let cell = (0..S)
            .fold(0, |cell, axis| (cell << split[axis]) + (point[axis] * f64::from(1_u32 << split[axis])) as usize);
        counts[cell] += 1;
    }
    counts.iter().all(|count| *count == each)
}

fn choose<const S: usize>(seed: u32, set: u32, axes: [usize; S]) -> impl Fn(u32) -> [f64; S] {
    move |sample| axes.map(|axis| Sampler::new(seed, [3, 5], sample).set(set)[axis])
}

#[test]
fn blocks_of_samples_are_nets() {
    for set in [0, 1, 77] {
        assert_eq!(quality(choose(set, set, [0, 1]), 9), 0);
        assert!(quality(choose(set, set, [2, 3]), 9) <= 3);
        assert!(quality(choose(set, set, [0, 1, 2]), 9) <= 1);
        assert!(quality(choose(set, set, [0, 1, 2, 3]), 9) <= 3);
        for axis in 0..4 {
            assert_eq!(quality(choose(set, set, [axis]), 9), 0);
        }
    }
    // The twins: random numbers, samples in an order that does not keep blocks, and scrambling that is not nested.
    let random = |i| [0, 1].map(|dimension| to_unit_f64(hash(0, 3, 5, i, dimension)));
    assert!(quality(random, 9) > 4);
    let disordered = |i: u32| Sampler::new(0, [3, 5], i * 3).pair(0);
    assert!(quality(disordered, 9) > 0);
    let shifted = |i| Sampler::new(0, [3, 5], i).pair(0).map(|x| (x + 0.3).fract());
    assert!(quality(shifted, 9) > 0);
}

/// Two numbers for a place of a grid.
type Numbers<'n> = &'n dyn Fn(u32, u32) -> [f64; 2];

/// Two numbers for each place of a grid of 256 × 256, counted in 16 × 16 cells.
fn counts(numbers: impl Fn(u32, u32) -> [f64; 2]) -> Vec<u64> {
    let mut counts = vec![0; 256];
    for (x, y) in (0..256).flat_map(|x| (0..256).map(move |y| (x, y))) {
        let [u, v] = numbers(x, y);
        counts[(u * 16.0) as usize * 16 + (v * 16.0) as usize] += 1;
    }
    counts
}

#[test]
fn pixels_are_uniform_and_independent() {
    let at = |x, y, sample| Sampler::new(9, [x, y], sample);
    let even = [256.0; 256];
    let tests: [(&str, Numbers); 7] = [
        ("the first pair over pixels", &|x, y| at(x, y, 0).pair(0)),
        ("the second pair over pixels", &|x, y| at(x, y, 1).pair(2)),
        ("a pair of a late set", &|x, y| at(x, y, 5).pair(4000)),
        ("neighbours in x", &|x, y| [at(x, y, 0).single(0), at(x + 1, y, 0).single(0)]),
        ("neighbours in y", &|x, y| [at(x, y, 0).single(1), at(x, y + 1, 0).single(1)]),
        ("two seeds", &|x, y| [Sampler::new(1, [x, y], 3).single(2), Sampler::new(2, [x, y], 3).single(2)]),
        ("two sets", &|x, y| [at(x, y, 2).single(0), at(x, y, 2).single(SET)]),
    ];
    for (what, numbers) in tests {
        assert_counts(what, &counts(numbers), &even, tests.len() as u32);
    }
    // The twins: every sixteenth pixel has the same numbers; and both dimensions are scrambled alike.
    must_fail("few scramblings", || assert_counts("", &counts(|x, y| at(x % 16, y % 16, 0).pair(0)), &even, 1));
    must_fail("two dimensions that are one", || {
        assert_counts("", &counts(|x, y| [at(x, y, 0).single(0), at(x, y, 0).single(0)]), &even, 1);
    });
}

#[test]
fn sets_of_one_pixel_are_independent() {
    // Over samples of one pixel: dimension 0 against dimension 4, whose order is another. Counts of such points are as
    // random as random ones, or more even.
    let even = [256.0; 256];
    let pair = |i: u32| [Sampler::new(3, [7, 7], i).single(0), Sampler::new(3, [7, 7], i).single(4)];
    assert_counts("two sets over samples", &counts(|x, y| pair(256 * x + y)), &even, 1);
    // The twin: padding by the same order.
    let padded = |i: u32| [pixel_sample(i)[0], (pixel_sample(i)[0] * 3.0).fract()];
    must_fail("padding by the same order", || assert_counts("", &counts(|x, y| padded(256 * x + y)), &even, 1));
}

/// The root of the mean square error, over 64 pixels, of the mean of `count` samples of a smooth integrand whose
/// integral is 1.
fn error<const S: usize>(count: u32, numbers: impl Fn(u32, u32) -> [f64; S]) -> f64 {
    let integrand =
        |point: [f64; S]| point.iter().map(|x| 1.5 - 1.5 * (x - 0.5 / S as f64) * (x - 0.5)).product::<f64>();
    let mean_of = |pixel| (0..count).map(|i| integrand(numbers(pixel, i))).sum::<f64>() / f64::from(count);
    let exact = (0..S)
        .map(|_| {
            let shift = 0.5 / S as f64;
            // ∫ 1.5 − 1.5 (x − s) (x − ½) dx over [0, 1].
            1.5 - 1.5 * (1.0 / 3.0 - 0.5 * (shift + 0.5) + 0.5 * shift)
        })
        .product::<f64>();
    let square = (0..64).map(|pixel| (mean_of(pixel) - exact) * (mean_of(pixel) - exact)).sum::<f64>() / 64.0;
    square.sqrt()
}

#[test]
fn smooth_integrands_converge_faster_than_with_random_numbers() {
    let pair = |pixel, i| Sampler::new(5, [pixel, 0], i).pair(0);
    let four = |pixel, i| Sampler::new(5, [pixel, 0], i).set(1);
    let random = |pixel, i| [0, 1].map(|dimension| to_unit_f64(hash(5, pixel, 0, i, dimension)));
    // From 16 to 1024 samples the error falls to 1/8 with random numbers, to about 1/500 with nets.
    let gain = |few: f64, many: f64| few / many;
    let planar = gain(error(16, pair), error(1024, pair));
    let spatial = gain(error(16, four), error(1024, four));
    let plain = gain(error(16, random), error(1024, random));
    assert!(planar > 200.0, "{planar}");
    assert!(spatial > 60.0, "{spatial}");
    // The twin, and the rate that random numbers are known for.
    assert!((5.0..13.0).contains(&plain), "{plain}");
}

#[test]
fn numbers_are_the_same_on_every_machine() {
    let bits = |x: f64| (x * 4_294_967_296.0) as u32;
    let sampler = Sampler::new(1, [2, 3], 4);
    let expected = sampler.set(5);
    for (dimension, x) in (20..24).zip(expected) {
        assert_eq!(sampler.single(dimension), x);
        assert_eq!(f64::from(bits(x)) / 4_294_967_296.0, x);
    }
    assert_eq!(sampler.pair(23), [expected[3], sampler.single(24)]);
    assert_eq!(expected.map(bits), [1_193_564_161, 1_364_648_546, 2_880_103_296, 3_074_266_933]);
}

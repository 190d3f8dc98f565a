//! No order, no grouping and no instructions change a pixel; what is no number is told.

use proptest::prelude::*;

use super::*;

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn no_order_of_adding_or_merging_changes_a_bit(samples in prop::collection::vec(prop::array::uniform3(-2.0..1e6f32), 1..40), cut in 0..40usize) {
        let sum = |samples: &mut dyn Iterator<Item = &[f32; 3]>| {
            let mut pixel = PixelSum::default();
            for sample in samples {
                assert!(pixel.add(Rgb::from(*sample)));
            }
            pixel
        };
        let forward = sum(&mut samples.iter());
        let backward = sum(&mut samples.iter().rev());
        let cut = cut.min(samples.len());
        let mut merged = sum(&mut samples[cut..].iter());
        merged.merge(&sum(&mut samples[..cut].iter()));
        prop_assert_eq!(forward, backward);
        prop_assert_eq!(forward, merged);
        let plain: f64 = samples.iter().map(|s| f64::from(s[0])).sum::<f64>() / samples.len() as f64;
        prop_assert!((f64::from(forward.mean().r) - plain).abs() <= 1e-7 * plain.abs().max(1.0));
    }
}

#[test]
fn what_is_not_finite_is_black_and_told() {
    let mut pixel = PixelSum::default();
    assert!(!pixel.add(Rgb::new(f32::NAN, 1.0, 1.0)));
    assert!(!pixel.add(Rgb::new(1.0, f32::INFINITY, 1.0)));
    assert!(pixel.add(Rgb::gray(3.0)));
    assert_eq!(pixel.mean(), Rgb::gray(1.0));
}

/// Samples of all sizes, and some that are no numbers.
fn odd_samples(count: usize) -> Vec<Rgb> {
    let odd = [f32::NAN, f32::INFINITY, -0.0, 1e-12, -1e-12, 3e6, -3e6, f32::MIN_POSITIVE, 7e-10];
    let component = |i: usize| match i % 97 {
        n if n < odd.len() && i / 97 % 2 == 1 => odd[n],
        _ => {
            let bits = (i as u32).wrapping_mul(2_654_435_761);
            // From 2^-32 to 2^20, of either sign.
            f32::from_bits((95 + bits % 52) << 23 | bits >> 9 | bits & 1 << 31)
        }
    };
    (0..count).map(|i| Rgb::from([0, 1, 2].map(|c| component(3 * i + c)))).collect()
}

/// The film's means are those of sums that are added by hand, whatever instructions and passes.
fn film_is_its_sums(change: impl Fn(&mut Film)) -> bool {
    let (width, height) = (53, 70);
    let all: Vec<u32> = (0..width * height).collect();
    let some: Vec<u32> = all.iter().copied().filter(|pixel| pixel % 7 < 3).collect();
    let few: Vec<u32> = some.iter().copied().filter(|pixel| pixel % 5 == 1).collect();
    let passes = [(all, 1), (some, 3), (few, 12)];
    InstructionSet::available().into_iter().all(|instructions| {
        [1, 3].into_iter().all(|number_of_passes| {
            let mut film =
                if number_of_passes == 1 { Film::of_one_pass(width, height) } else { Film::new(width, height) };
            let mut sums = vec![PixelSum::default(); (width * height) as usize];
            let (mut nonfinite, mut told) = (0, 0);
            for (pixels, per_pixel) in &passes[..number_of_passes] {
                let samples = odd_samples(pixels.len() * per_pixel);
                let tiles = FilmTiles { instructions, ..film.tiles() };
                for (pixels, samples) in pixels.chunks(61).zip(samples.chunks(61 * per_pixel)) {
                    told += tiles.add(pixels, samples);
                }
                for (&pixel, samples) in pixels.iter().zip(samples.chunks(*per_pixel)) {
                    for &sample in samples {
                        nonfinite += u64::from(!sums[pixel as usize].add(sample));
                    }
                }
            }
            change(&mut film);
            let image = film.into_image();
            let same = |(mean, sum): (&Rgb, &PixelSum)| {
                mean.to_array().map(f32::to_bits) == sum.mean().to_array().map(f32::to_bits)
            };
            told == nonfinite && nonfinite > 0 && image.pixels().iter().zip(&sums).all(same)
        })
    })
}

#[test]
fn tiles_and_passes_give_the_means_of_all_samples() {
    assert!(film_is_its_sums(|_| ()));
}

#[test]
fn a_mean_that_is_off_by_a_bit_would_be_seen() {
    assert!(!film_is_its_sums(|film| film.means[1234].g = film.means[1234].g.next_up()));
}

#[test]
fn films_without_pixels_become_pictures_without() {
    for (width, height) in [(0, 0), (0, 9), (9, 0)] {
        let mut film = Film::new(width, height);
        assert_eq!(film.tiles().add(&[], &[]), 0);
        assert_eq!(film.into_image().size(), (width, height));
    }
}

#[test]
fn one_sample_comes_back_as_it_was() {
    for value in [0.0_f32, 1.0, 0.5, 0.123_456_79, 1234.567, -0.25] {
        let mut pixel = PixelSum::default();
        assert!(pixel.add(Rgb::gray(value)));
        assert_eq!(pixel.mean().r, value);
    }
}

//! Pictures: exact at the centres of pixels, without seams, for all coordinates; and their smaller versions.

use proptest::prelude::*;
use snell_math::Rgb;

use super::{NASTY, picture};
use crate::texture::{TextureImage, TextureImageError};

/// The footprint of a point.
const POINT: [[f64; 2]; 2] = [[0.0; 2]; 2];

/// A square one.
fn square(side: f64) -> [[f64; 2]; 2] {
    [[side, 0.0], [0.0, side]]
}

fn centre(i: u32, size: u32) -> f64 {
    (f64::from(i) + 0.5) / f64::from(size)
}

#[test]
fn centres_are_exact_in_every_copy() {
    // Sizes whose reciprocals are not exact.
    for (width, height) in [(1, 1), (2, 3), (7, 5), (49, 13)] {
        let image = picture(width, height);
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            for smooth in [false, true] {
                let position = [centre(x, width), centre(y, height)];
                assert_eq!(image.color(position, false, smooth, POINT), image.pixel(x, y));
                for copy in [-1000.0, -1.0, 0.0, 1.0, 3.0, 1000.0] {
                    let position = [position[0] + copy, position[1] - copy];
                    assert_eq!(
                        image.color(position, true, smooth, POINT),
                        image.pixel(x, y),
                        "{width}x{height} {copy}"
                    );
                }
            }
        }
    }
}

#[test]
fn blending_is_linear_between_centres() {
    let image = picture(8, 4);
    for i in 0..=28 {
        let t = f64::from(i) / 28.0;
        let x = (0.5 + 7.0 * t) / 8.0;
        let color = image.color([x, centre(2, 4)], false, true, POINT);
        assert!((f64::from(color.r) - 7.0 * t).abs() < 1e-6);
        assert_eq!(color.g, 2.0);
    }
}

#[test]
fn outside_is_the_border_or_a_copy() {
    let image = picture(4, 3);
    for smooth in [false, true] {
        assert_eq!(image.color([-9.0, -9.0], false, smooth, POINT), image.pixel(0, 0));
        assert_eq!(image.color([9.0, 9.0], false, smooth, POINT), image.pixel(3, 2));
        assert_eq!(image.color([1.0, 0.0], false, smooth, POINT), image.pixel(3, 0));
    }
    // Half-way over the seam, both sides count alike.
    let [a, b] = [image.pixel(3, 1), image.pixel(0, 1)];
    for x in [0.0, 1.0, -1.0, 7.0] {
        assert_eq!(image.color([x, 0.5], true, true, POINT), a.lerp(b, 0.5));
    }
    // The twin: a border that is not wrapped shows a seam.
    assert_ne!(image.color([1.0, 0.5], false, true, POINT), image.color([0.0, 0.5], false, true, POINT));
}

#[test]
fn sizes_and_numbers_are_checked() {
    let black = |count| vec![Rgb::BLACK; count];
    assert_eq!(TextureImage::new(0, 3, vec![]), Err(TextureImageError::Empty { width: 0, height: 3 }));
    assert_eq!(TextureImage::new(2, 3, black(5)), Err(TextureImageError::Size { width: 2, height: 3, pixels: 5 }));
    let huge = TextureImage::new(u32::MAX, u32::MAX, black(1));
    assert_eq!(huge, Err(TextureImageError::Size { width: u32::MAX, height: u32::MAX, pixels: 1 }));
    let mut pixels = black(6);
    pixels[5].g = f32::NAN;
    assert_eq!(TextureImage::new(2, 3, pixels), Err(TextureImageError::NotFinite { x: 1, y: 2 }));
}

#[test]
fn nasty_coordinates_give_finite_colours() {
    let image = picture(5, 3).with_levels();
    for (x, y) in NASTY.iter().flat_map(|x| NASTY.iter().map(move |y| (*x, *y))) {
        for (repeat, smooth) in [(false, false), (false, true), (true, false), (true, true)] {
            for (footprint, other) in NASTY.into_iter().flat_map(|a| NASTY.iter().map(move |b| (a, b))) {
                assert!(image.color([x, y], repeat, smooth, [[footprint, *other], [*other, footprint]]).is_finite());
            }
        }
    }
}

#[test]
fn levels_keep_the_mean_and_a_wide_footprint_sees_it() {
    for (width, height) in [(16, 16), (5, 3), (1, 9), (31, 2), (2, 1)] {
        let image = picture(width, height).with_levels();
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let sum = pixels.fold(Rgb::BLACK, |sum, (x, y)| sum + image.pixel(x, y));
        let mean = sum / (width * height) as f32;
        for position in [[0.0, 0.0], [0.3, 0.9], [-8.0, 77.0]] {
            for footprint in [50.0, 1e30, f64::INFINITY] {
                let color = image.color(position, true, true, square(footprint));
                assert!(
                    (color - mean).max_abs() < 1e-5 * (1.0 + mean.max_abs()),
                    "{width}x{height}: {color:?} {mean:?}"
                );
            }
        }
        // Made again, they are the same.
        assert_eq!(image.clone().with_levels(), image);
    }
}

#[test]
fn a_footprint_blurs_by_degrees() {
    // Stripes of one pixel: the contrast falls from all to nothing while the footprint grows from one pixel to two.
    let stripes = (0..64).map(|i| Rgb::gray((i % 2) as f32)).collect();
    let sharp = TextureImage::new(64, 1, stripes).unwrap();
    let image = sharp.clone().with_levels();
    let contrast = |image: &TextureImage, pixels: f64| {
        let color = |x| image.color([centre(x, 64), 0.5], true, true, [[pixels / 64.0, 0.0], [0.0, pixels]]).r;
        color(33) - color(32)
    };
    let contrasts: Vec<f32> = (0..=10).map(|i| contrast(&image, 1.0 + f64::from(i) / 10.0)).collect();
    assert_eq!(contrasts[0], 1.0);
    assert_eq!(contrasts[10], 0.0);
    assert!(contrasts.windows(2).all(|pair| pair[1] < pair[0]));
    // Without levels it stays sharp.
    assert_eq!(contrast(&sharp, 2.0), 1.0);
}

#[test]
fn levels_cost_a_third() {
    for (width, height) in [(64, 64), (37, 21), (100, 7)] {
        let image = picture(width, height).with_levels();
        let all: usize = image.levels().iter().map(|level| level.pixels.len()).sum();
        assert!(3 * all <= 4 * (width * height) as usize, "{width}x{height}: {all}");
    }
}

#[test]
fn a_long_footprint_averages_along_itself_alone() {
    // Stripes along a diagonal, four pixels wide as the axes see them.
    let stripes = |x: u32, y: u32| Rgb::gray(if (x + y) % 8 < 4 { 0.0 } else { 1.0 });
    let pixels = (0..64).flat_map(|y| (0..64).map(move |x| stripes(x, y))).collect();
    let image = TextureImage::new(64, 64, pixels).unwrap().with_levels();
    let seen = |x: f64, y: f64| image.color([33.5 / 64.0; 2], true, true, [[x / 64.0, y / 64.0], [0.7 / 64.0, 0.0]]).r;
    let sharp = seen(0.0, 0.0);
    assert!(sharp == 0.0 || sharp == 1.0, "{sharp}");
    // Along a stripe, however long, and across the stripes.
    assert_eq!(seen(8.0, -8.0), sharp);
    assert!((seen(8.0, 8.0) - 0.5).abs() < 0.1, "{}", seen(8.0, 8.0));
    // One that is as wide as long averages all.
    let wide = image.color([0.5; 2], true, true, square(16.0 / 64.0)).r;
    assert!((wide - 0.5).abs() < 0.1, "{wide}");
}

#[test]
fn one_colour_stays_itself_to_the_bit() {
    let color = Rgb::new(0.1, 0.7, 1.0 / 3.0);
    let image = TextureImage::new(7, 5, vec![color; 35]).unwrap().with_levels();
    for (i, side) in NASTY.into_iter().chain([0.01, 0.3, 2.0]).enumerate() {
        let place = [0.37 * i as f64, 0.11];
        assert_eq!(image.color(place, true, true, [[side, 0.1], [0.02, side]]), color);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// Against a direct sum of tent functions over all pixels of all copies nearby.
    #[test]
    fn blending_agrees_with_tents(x in -2.0..3.0f64, y in -2.0..3.0f64, width in 1..6u32, height in 1..6u32) {
        let image = picture(width, height);
        let mut sum = [0.0; 3];
        for (j, i) in (-3 * height as i64..4 * height as i64).flat_map(|j| (-3 * width as i64..4 * width as i64).map(move |i| (j, i))) {
            let tent = |position: f64, size: u32, i: i64| (1.0 - (position * f64::from(size) - 0.5 - i as f64).abs()).max(0.0);
            let weight = tent(x, width, i) * tent(y, height, j);
            let pixel = image.pixel(i.rem_euclid(width.into()) as u32, j.rem_euclid(height.into()) as u32);
            for (sum, c) in sum.iter_mut().zip(pixel.to_array()) {
                *sum += weight * f64::from(c);
            }
        }
        let color = image.color([x, y], true, true, POINT).to_array();
        for (found, expected) in color.iter().zip(sum) {
            prop_assert!((f64::from(*found) - expected).abs() < 1e-5);
        }
    }
}

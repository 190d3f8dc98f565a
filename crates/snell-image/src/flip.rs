//! ꟻLIP, how far apart two pictures look to someone who flips between them: Andersson, Nilsson, Akenine-Möller, Oskarsson,
//! Åström and Fairchild 2020, "ꟻLIP: A Difference Evaluator for Alternating Images" (Proc. ACM Comput. Graph. Interact.
//! Tech. 3, 2). This is its form for display pictures; equation numbers are the paper's.
//!
//! The result is a number for each pixel: 0 where no difference is seen, up to 1. It depends on how many pixels the viewer
//! has in a degree of the visual field. All convolutions are separable and repeat the picture's border.

use std::f64::consts::PI;

use rayon::prelude::*;
use snell_math::{Rgb, portable};

use crate::metrics::Incomparable;
use crate::{DisplayImage, Image};

/// Pixels in a degree for the paper's viewer: 0.7 m from a display 0.7 m wide with 3840 columns.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// What is seen of the difference at each pixel, from 0 to 1. The two pictures' order does not matter.
///
/// `pixels_per_degree` is taken between 1 and 1000; the paper's where it is NaN.
///
/// # Errors
/// Where the sizes differ. Bits may differ.
///
/// ```
/// use snell_image::{BitDepth, DisplayImage, Image, ToneCurve, flip::{PIXELS_PER_DEGREE, flip, mean}};
/// use snell_math::Rgb;
/// let gray = |level| {
///     let light = Image::filled(16, 16, Rgb::gray(level));
///     DisplayImage::develop(&light, ToneCurve::None, 0.0, BitDepth::Eight)
/// };
/// let seen = |a, b| flip(&gray(a), &gray(b), PIXELS_PER_DEGREE).map(|map| mean(&map));
/// assert_eq!(seen(0.5, 0.5)?, 0.0);
/// assert!(seen(0.5, 0.51)? < seen(0.5, 0.6)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn flip(reference: &DisplayImage, test: &DisplayImage, pixels_per_degree: f64) -> Result<Image<f32>, Incomparable> {
    if reference.size() != test.size() {
        return Err(Incomparable::Sizes(reference.size(), test.size()));
    }
    let pixels_per_degree =
        if pixels_per_degree.is_nan() { PIXELS_PER_DEGREE } else { pixels_per_degree.clamp(1.0, 1000.0) };
    let pictures = [reference, test].map(Opponent::of);
    let [reference_color, test_color] = pictures.each_ref().map(|picture| perceived(picture, pixels_per_degree));
    let [reference_features, test_features] = pictures.each_ref().map(|picture| features(picture, pixels_per_degree));

    let largest = largest_color_difference();
    let mut pixel = 0;
    Ok(Image::from_fn(reference.width(), reference.height(), |_, _| {
        let color = color_difference(reference_color[pixel], test_color[pixel], largest);
        let feature = feature_difference(reference_features[pixel], test_features[pixel]);
        pixel += 1;
        // Equation 3.
        portable::pow(color, 1.0 - feature) as f32
    }))
}

/// The mean of a difference map; 0 for one without pixels.
#[must_use]
pub fn mean(map: &Image<f32>) -> f64 {
    let sum: f64 = map.pixels().iter().copied().map(f64::from).sum();
    sum / map.pixels().len().max(1) as f64
}

/// White D65 in CIE XYZ, as the paper's matrix gives it for full light.
const WHITE: [f64; 3] = [0.950_428_545, 1.0, 1.088_900_371];

/// CIE XYZ of linear light with Rec. 709 primaries, relative to white.
fn relative_xyz([red, green, blue]: [f64; 3]) -> [f64; 3] {
    let x = (10_135_552.0 * red + 8_788_810.0 * green + 4_435_075.0 * blue) / 24_577_794.0;
    let y = (2_613_072.0 * red + 8_788_810.0 * green + 887_015.0 * blue) / 12_288_897.0;
    let z = (1_425_312.0 * red + 8_788_810.0 * green + 70_074_185.0 * blue) / 73_733_382.0;
    [x / WHITE[0], y / WHITE[1], z / WHITE[2]]
}

/// The inverse of [`relative_xyz`].
fn linear_light([x, y, z]: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = [x * WHITE[0], y * WHITE[1], z * WHITE[2]];
    [
        3.241_003_232_976_358 * x - 1.537_398_969_488_785 * y - 0.498_615_881_996_363 * z,
        -0.969_224_252_202_516 * x + 1.875_929_983_695_176 * y + 0.041_554_226_340_084 * z,
        0.055_639_419_851_975 * x - 0.204_011_206_123_91 * y + 1.057_148_977_187_533 * z,
    ]
}

/// A picture's planes of the linear opponent space YCxCz (equations in section 4.1.1): luminance, red-green, blue-yellow.
struct Opponent {
    width: usize,
    planes: [Vec<f64>; 3],
}

impl Opponent {
    fn of(picture: &DisplayImage) -> Self {
        let light = picture.to_linear();
        let plane = |get: fn([f64; 3]) -> f64| {
            let value = |pixel: &Rgb| get(relative_xyz(pixel.to_array().map(f64::from)));
            light.pixels().iter().map(value).collect::<Vec<_>>()
        };
        let planes = [
            plane(|[_, y, _]| 116.0 * y - 16.0),
            plane(|[x, y, _]| 500.0 * (x - y)),
            plane(|[_, y, z]| 200.0 * (y - z)),
        ];
        Self { width: picture.width().max(1) as usize, planes }
    }
}

/// The picture as the eye resolves it, as Hunt-adjusted CIELAB: filtered by the contrast sensitivity of each opponent
/// channel (section 4.1.1), clipped to what a display shows, and converted (section 4.1.2).
fn perceived(picture: &Opponent, pixels_per_degree: f64) -> Vec<[f64; 3]> {
    // Table 1: sums of Gaussians a √(π/b) exp(−π² x²/b), x in degrees.
    const SENSITIVITY: [&[(f64, f64)]; 3] = [&[(1.0, 0.0047)], &[(1.0, 0.0053)], &[(34.1, 0.04), (13.5, 0.025)]];
    const WIDEST: f64 = 0.04;
    let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil();

    let filtered: Vec<Vec<f64>> = picture
        .planes
        .iter()
        .zip(SENSITIVITY)
        .map(|(plane, gaussians)| {
            let kernels: Vec<_> = gaussians
                .iter()
                .map(|(a, b)| {
                    let kernel = kernel(radius, |x| {
                        let degrees = x / pixels_per_degree;
                        portable::exp(-PI * PI * degrees * degrees / b)
                    });
                    let sum: f64 = kernel.iter().sum();
                    (a * (PI / b).sqrt() * sum * sum, normalized(kernel, sum))
                })
                .collect();
            let total: f64 = kernels.iter().map(|(weight, _)| weight).sum();
            let mut result = vec![0.0; plane.len()];
            for (weight, kernel) in &kernels {
                let part = convolve(plane, picture.width, kernel, kernel);
                result.iter_mut().zip(part).for_each(|(sum, value)| *sum += weight / total * value);
            }
            result
        })
        .collect();

    (0..filtered[0].len())
        .map(|pixel| {
            let y = (filtered[0][pixel] + 16.0) / 116.0;
            let xyz = [filtered[1][pixel] / 500.0 + y, y, y - filtered[2][pixel] / 200.0];
            hunt_lab(linear_light(xyz).map(|light| light.clamp(0.0, 1.0)))
        })
        .collect()
}

/// CIELAB of linear light, its chroma scaled by lightness (the Hunt effect, section 4.1.2).
fn hunt_lab(light: [f64; 3]) -> [f64; 3] {
    const DELTA: f64 = 6.0 / 29.0;
    let [x, y, z] = relative_xyz(light)
        .map(|t| if t > DELTA * DELTA * DELTA { portable::cbrt(t) } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 });
    let lightness = 116.0 * y - 16.0;
    [lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)]
}

/// The HyAB distance (Abasi et al. 2020) to the power 0.7 (section 4.1.3).
fn compressed_distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [l, a, b] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    portable::pow(l.abs() + (a * a + b * b).sqrt(), 0.7)
}

/// That of pure green and pure blue, the largest that a display shows.
fn largest_color_difference() -> f64 {
    compressed_distance(hunt_lab([0.0, 1.0, 0.0]), hunt_lab([0.0, 0.0, 1.0]))
}

/// Colour difference from 0 to 1: distances up to two fifths of the largest take 95 % of the range (section 4.1.3).
fn color_difference(a: [f64; 3], b: [f64; 3], largest: f64) -> f64 {
    const KNEE: f64 = 0.4;
    const KNEE_VALUE: f64 = 0.95;
    let share = compressed_distance(a, b) / largest;
    if share < KNEE {
        share * KNEE_VALUE / KNEE
    } else {
        // Distances that the paper did not foresee, beyond that of green and blue, count as the largest.
        (KNEE_VALUE + (share - KNEE) / (1.0 - KNEE) * (1.0 - KNEE_VALUE)).min(1.0)
    }
}

/// The strengths of edges and points in the luminance plane (section 4.2): magnitudes of its first and second derivatives,
/// taken with Gaussians as wide as the eye's feature detectors.
fn features(picture: &Opponent, pixels_per_degree: f64) -> Vec<[f64; 2]> {
    /// Width of a feature in degrees.
    const WIDTH: f64 = 0.082;
    let deviation = 0.5 * WIDTH * pixels_per_degree;
    let radius = (3.0 * deviation).ceil();
    let gaussian = |x: f64| portable::exp(-x * x / (2.0 * deviation * deviation));
    let smooth = kernel(radius, gaussian);
    let smooth_sum = smooth.iter().sum();
    let smooth = normalized(smooth, smooth_sum);
    let edge = balanced(kernel(radius, |x| -x * gaussian(x)));
    let point = balanced(kernel(radius, |x| (x * x / (deviation * deviation) - 1.0) * gaussian(x)));

    let luminance: Vec<f64> = picture.planes[0].iter().map(|y| (y + 16.0) / 116.0).collect();
    let magnitudes = |derivative: &[f64]| -> Vec<f64> {
        let along_x = convolve(&luminance, picture.width, derivative, &smooth);
        let along_y = convolve(&luminance, picture.width, &smooth, derivative);
        along_x.iter().zip(along_y).map(|(x, y)| (x * x + y * y).sqrt()).collect()
    };
    magnitudes(&edge).into_iter().zip(magnitudes(&point)).map(|(edge, point)| [edge, point]).collect()
}

/// Feature difference from 0 to 1 (equation 2).
fn feature_difference([edge_a, point_a]: [f64; 2], [edge_b, point_b]: [f64; 2]) -> f64 {
    let larger = (edge_a - edge_b).abs().max((point_a - point_b).abs());
    (larger / std::f64::consts::SQRT_2).sqrt().min(1.0)
}

/// A function at whole numbers from −radius to radius.
fn kernel(radius: f64, f: impl Fn(f64) -> f64) -> Vec<f64> {
    let radius = radius as i32;
    (-radius..=radius).map(|x| f(f64::from(x))).collect()
}

fn normalized(mut kernel: Vec<f64>, sum: f64) -> Vec<f64> {
    kernel.iter_mut().for_each(|weight| *weight /= sum);
    kernel
}

/// Scales the positive weights to sum one and the negative ones to sum minus one.
fn balanced(mut kernel: Vec<f64>) -> Vec<f64> {
    let positive: f64 = kernel.iter().filter(|&&weight| weight > 0.0).sum();
    let negative: f64 = kernel.iter().filter(|&&weight| weight < 0.0).sum();
    kernel.iter_mut().for_each(|weight| *weight /= if *weight > 0.0 { positive } else { -negative });
    kernel
}

/// The correlation with a kernel along rows and one along columns, each of odd length.
fn convolve(plane: &[f64], width: usize, along_rows: &[f64], along_columns: &[f64]) -> Vec<f64> {
    let height = plane.len() / width;
    let mut horizontal = vec![0.0; plane.len()];
    horizontal.par_chunks_mut(width).zip(plane.par_chunks(width)).for_each(|(out, row)| {
        for (x, out) in out.iter_mut().enumerate() {
            *out = taps(along_rows, x, width).map(|(from, weight)| row[from] * weight).sum();
        }
    });
    let mut result = vec![0.0; plane.len()];
    result.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        for (from, weight) in taps(along_columns, y, height) {
            let row = &horizontal[from * width..][..width];
            out.iter_mut().zip(row).for_each(|(sum, value)| *sum += value * weight);
        }
    });
    result
}

/// The kernel's weights around `center`, each with its place within `0..count`.
fn taps(kernel: &[f64], center: usize, count: usize) -> impl Iterator<Item = (usize, f64)> {
    let radius = kernel.len() / 2;
    kernel.iter().enumerate().map(move |(i, &weight)| ((center + i).saturating_sub(radius).min(count - 1), weight))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BitDepth, ToneCurve};

    fn picture(codes: impl Fn(u32, u32) -> [u32; 3]) -> DisplayImage {
        let light = Image::from_fn(48, 40, |x, y| Rgb::from_srgb(codes(x, y).map(|code| code as f32 / 255.0)));
        DisplayImage::develop(&light, ToneCurve::None, 0.0, BitDepth::Eight)
    }

    /// Noise above, a smooth ramp below; the second with swapped and inverted squares and a tint.
    fn pair() -> [DisplayImage; 2] {
        let noise = |x: u32, y: u32| [(x * 37 + y * 11) % 256, (x * x + y * 5) % 256, (x * 3 + y * y) % 256];
        let first = picture(|x, y| if y >= 24 { [x * 4, 128, y * 4] } else { noise(x, y) });
        let second = picture(|x, y| match noise(x, y) {
            _ if y >= 24 => [x * 4 + 3, 120, y * 4],
            [red, green, blue] if (x / 8 + y / 8) % 3 == 0 => [255 - red, blue, green],
            same => same,
        });
        [first, second]
    }

    #[test]
    fn the_numbers_are_those_of_the_authors_program() {
        // flip-evaluator 1.7 by the paper's authors, on the same two pictures.
        let [a, b] = pair();
        let places = [(0, 0), (20, 5), (47, 39), (10, 30), (30, 23), (5, 17)];
        for (pixels_per_degree, expected_mean, expected) in [
            (67.0206, 0.301_198, [0.971_061, 0.176_701, 0.171_176, 0.231_566, 0.179_535, 0.207_872]),
            (30.0, 0.302_763, [0.974_931, 0.068_090, 0.169_151, 0.199_202, 0.139_349, 0.092_101]),
        ] {
            let map = flip(&a, &b, pixels_per_degree).unwrap();
            assert!((mean(&map) - expected_mean).abs() < 2e-5, "{} for {expected_mean}", mean(&map));
            for ((x, y), expected) in places.into_iter().zip(expected) {
                let found = f64::from(*map.get(x, y).unwrap());
                assert!((found - expected).abs() < 2e-4, "{found} for {expected} at ({x}, {y})");
            }
        }
    }

    #[test]
    fn equal_pictures_look_equal_and_order_does_not_matter() {
        let [a, b] = pair();
        assert!(flip(&a, &a, PIXELS_PER_DEGREE).unwrap().pixels().iter().all(|&seen| seen == 0.0));
        assert_eq!(flip(&a, &b, PIXELS_PER_DEGREE), flip(&b, &a, PIXELS_PER_DEGREE));
    }

    #[test]
    fn black_against_white_is_the_most() {
        let map = flip(&picture(|_, _| [0; 3]), &picture(|_, _| [255; 3]), PIXELS_PER_DEGREE).unwrap();
        assert!(map.pixels().iter().all(|&seen| seen > 0.95 && seen <= 1.0));
    }

    #[test]
    fn unlike_sizes_are_refused_and_nothing_gives_nothing() {
        let [a, _] = pair();
        let empty = DisplayImage::develop(&Image::filled(0, 4, Rgb::BLACK), ToneCurve::None, 0.0, BitDepth::Eight);
        assert!(flip(&a, &empty, PIXELS_PER_DEGREE).is_err());
        assert_eq!(mean(&flip(&empty, &empty, f64::NAN).unwrap()), 0.0);
    }
}

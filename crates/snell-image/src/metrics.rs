//! How far two pictures are apart, in numbers: mean squared error, PSNR, the largest difference, the count of different
//! pixels. For how far they *look* apart see [`crate::flip`].
//!
//! Sums run in a fixed order, in double precision. Scene-linear pictures are compared as they are, display pictures by
//! their codes.

use snell_math::Rgb;

use crate::{DisplayImage, Image};

/// The difference of two pictures of one size, in the units of their components: light, or codes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Mean over all components of the squared difference; infinite where [`Self::largest`] is.
    pub mean_squared: f64,
    /// The largest absolute difference of a component; infinite where one of the two is NaN or infinite and the other is
    /// something else.
    pub largest: f64,
    /// Where the largest is first met in reading order: column and row.
    pub largest_at: Option<(u32, u32)>,
    /// Pixels in which a component differs at all.
    pub pixels: usize,
    /// The first such pixel in reading order: column and row.
    pub first_at: Option<(u32, u32)>,
}

/// Two pictures cannot be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Incomparable {
    /// Their sizes differ.
    #[error("one picture is {} × {} pixels, the other {} × {}", .0.0, .0.1, .1.0, .1.1)]
    Sizes((u32, u32), (u32, u32)),
    /// One has 8 bit codes, the other 16 bit codes.
    #[error("one picture has 8 bit codes, the other 16 bit codes")]
    Depths,
}

impl Difference {
    /// True where no component differs.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.pixels == 0
    }

    /// The root of the mean squared difference.
    #[must_use]
    pub fn root_mean_squared(&self) -> f64 {
        self.mean_squared.sqrt()
    }

    /// Peak signal-to-noise ratio in decibels, for components up to `peak`: infinite for equal pictures.
    #[must_use]
    pub fn peak_signal_to_noise(&self, peak: f64) -> f64 {
        10.0 * snell_math::portable::ln(peak * peak / self.mean_squared) / std::f64::consts::LN_10
    }
}

/// Compares scene-linear pictures. NaN equals NaN here: a picture equals itself.
///
/// # Errors
/// Where their sizes differ.
///
/// ```
/// use snell_image::{Image, metrics::compare};
/// use snell_math::Rgb;
/// let a = Image::filled(4, 4, Rgb::gray(0.5));
/// let mut b = a.clone();
/// b.get_mut(3, 1).unwrap().g += 0.25;
/// let difference = compare(&a, &b)?;
/// assert_eq!((difference.pixels, difference.first_at, difference.largest), (1, Some((3, 1)), 0.25));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compare(a: &Image<Rgb>, b: &Image<Rgb>) -> Result<Difference, Incomparable> {
    if a.size() != b.size() {
        return Err(Incomparable::Sizes(a.size(), b.size()));
    }
    let pairs = a.pixels().iter().zip(b.pixels());
    Ok(measure(a.width(), pairs.map(|(a, b)| [0, 1, 2].map(|i| apart(a.to_array()[i], b.to_array()[i])))))
}

/// Compares display pictures by their codes.
///
/// # Errors
/// Where their sizes or bits differ.
pub fn compare_display(a: &DisplayImage, b: &DisplayImage) -> Result<Difference, Incomparable> {
    if a.size() != b.size() {
        return Err(Incomparable::Sizes(a.size(), b.size()));
    }
    if a.depth() != b.depth() {
        return Err(Incomparable::Depths);
    }
    let count = a.width() as usize * a.height() as usize;
    let differences = (0..count).map(|pixel| {
        let (a, b) = (a.code_at(pixel), b.code_at(pixel));
        [0, 1, 2].map(|i| f64::from(a[i].abs_diff(b[i])))
    });
    Ok(measure(a.width(), differences))
}

fn apart(a: f32, b: f32) -> f64 {
    if a == b || (a.is_nan() && b.is_nan()) {
        return 0.0;
    }
    let difference = (f64::from(a) - f64::from(b)).abs();
    if difference.is_nan() { f64::INFINITY } else { difference }
}

fn measure(width: u32, pixels: impl Iterator<Item = [f64; 3]>) -> Difference {
    let mut squares = 0.0;
    let mut count = 0_usize;
    let mut difference = Difference { mean_squared: 0.0, largest: 0.0, largest_at: None, pixels: 0, first_at: None };
    for pixel in pixels {
        let place = ((count % width as usize) as u32, (count / width as usize) as u32);
        let largest = pixel.into_iter().fold(0.0, f64::max);
        if largest > 0.0 {
            difference.pixels += 1;
            difference.first_at.get_or_insert(place);
            if largest > difference.largest {
                difference.largest = largest;
                difference.largest_at = Some(place);
            }
            squares += pixel.into_iter().map(|x| x * x).sum::<f64>();
        }
        count += 1;
    }
    if count > 0 {
        difference.mean_squared = squares / (3 * count) as f64;
    }
    difference
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BitDepth, ToneCurve};
    use snell_math::portable;

    fn picture() -> Image<Rgb> {
        Image::from_fn(5, 4, |x, y| Rgb::new(x as f32, y as f32, 1.0) / 8.0)
    }

    #[test]
    fn a_picture_does_not_differ_from_itself() {
        let mut image = picture();
        image.pixels_mut()[7].r = f32::NAN;
        image.pixels_mut()[8].r = f32::INFINITY;
        let difference = compare(&image, &image).unwrap();
        assert!(difference.is_none());
        assert_eq!(difference.peak_signal_to_noise(1.0), f64::INFINITY);
        let empty = Image::filled(0, 3, Rgb::BLACK);
        assert!(compare(&empty, &empty).unwrap().is_none());
    }

    #[test]
    fn the_numbers_are_those_of_the_formulas() {
        let a = picture();
        let mut b = a.clone();
        b.get_mut(1, 2).unwrap().r += 0.5;
        b.get_mut(4, 3).unwrap().b -= 1.0;
        let difference = compare(&a, &b).unwrap();
        assert_eq!(difference.mean_squared, 1.25 / 60.0);
        assert_eq!((difference.largest, difference.largest_at), (1.0, Some((4, 3))));
        assert_eq!((difference.pixels, difference.first_at), (2, Some((1, 2))));
        let expected = 10.0 * portable::log2(60.0 / 1.25) / portable::log2(10.0);
        assert!((difference.peak_signal_to_noise(1.0) - expected).abs() < 1e-12);
    }

    #[test]
    fn what_is_not_a_number_differs_infinitely() {
        let a = picture();
        let mut b = a.clone();
        b.pixels_mut()[3].g = f32::NAN;
        let difference = compare(&a, &b).unwrap();
        assert_eq!((difference.largest, difference.pixels), (f64::INFINITY, 1));
    }

    #[test]
    fn one_code_is_seen() {
        for depth in [BitDepth::Eight, BitDepth::Sixteen] {
            let a = DisplayImage::develop(&picture(), ToneCurve::None, 0.0, depth);
            let code = f32::from(a.code(2, 2)[1]) + 1.0;
            let mut light = a.to_linear();
            light.pixels_mut()[12].g = snell_math::color::srgb_to_linear(code / f32::from(depth.max_code()));
            let b = DisplayImage::develop(&light, ToneCurve::None, 0.0, depth);
            let difference = compare_display(&a, &b).unwrap();
            assert_eq!((difference.largest, difference.first_at), (1.0, Some((2, 2))), "{depth:?}");
            assert!(compare_display(&a, &a).unwrap().is_none());
        }
    }

    #[test]
    fn unlike_pictures_are_refused() {
        let a = picture();
        assert_eq!(compare(&a, &Image::filled(4, 5, Rgb::BLACK)), Err(Incomparable::Sizes((5, 4), (4, 5))));
        let develop = |depth| DisplayImage::develop(&a, ToneCurve::None, 0.0, depth);
        assert_eq!(compare_display(&develop(BitDepth::Eight), &develop(BitDepth::Sixteen)), Err(Incomparable::Depths));
    }
}

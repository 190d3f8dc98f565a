//! Pictures in other sizes, by area: each new pixel is the mean of what it covers in the old picture (a box filter of
//! exactly its size). Light is preserved; it must be scene-linear, as [`Image<Rgb>`](Image) is.

use rayon::prelude::*;
use snell_math::Rgb;

use crate::Image;

/// The picture in another size. A pixel that is NaN makes those NaN that see it.
///
/// ```
/// use snell_image::{Image, resize::resize};
/// use snell_math::Rgb;
/// let stripes = Image::from_fn(4, 2, |x, _| Rgb::gray((x % 2) as f32));
/// assert_eq!(resize(&stripes, 2, 1), Image::filled(2, 1, Rgb::gray(0.5)));
/// ```
#[must_use]
pub fn resize(image: &Image<Rgb>, width: u32, height: u32) -> Image<Rgb> {
    if image.is_empty() || width == 0 || height == 0 {
        return Image::filled(width, height, Rgb::BLACK);
    }
    if image.size() == (width, height) {
        return image.clone();
    }
    let columns = shares(image.width(), width);
    let rows = shares(image.height(), height);

    let mut pixels = vec![Rgb::BLACK; width as usize * height as usize];
    pixels.par_chunks_mut(width as usize).zip(rows).for_each(|(out, row_share)| {
        // The covered rows as one, then the covered columns of it.
        let mut line = vec![[0.0_f64; 3]; image.width() as usize];
        for (y, weight) in row_share.weights() {
            for (sum, pixel) in line.iter_mut().zip(image.row(y)) {
                add(sum, pixel.to_array().map(f64::from), weight);
            }
        }
        for (out, share) in out.iter_mut().zip(&columns) {
            let mut sum = [0.0; 3];
            for (x, weight) in share.weights() {
                add(&mut sum, line[x as usize], weight);
            }
            *out = Rgb::from(sum.map(|component| component as f32));
        }
    });
    Image::from_pixels(width, height, pixels).unwrap_or_else(|_| Image::filled(width, height, Rgb::BLACK))
}

/// The largest size of the same shape within `max_width × max_height`, at least one pixel on each side; never larger than
/// the picture.
#[must_use]
pub fn fit((width, height): (u32, u32), max_width: u32, max_height: u32) -> (u32, u32) {
    let [w, h, max_w, max_h] = [width, height, max_width, max_height].map(u64::from);
    if w <= max_w && h <= max_h {
        return (width, height);
    }
    // Rounded to nearest; each quotient is at most the maximum that it is bounded by.
    let scaled = |side: u64, by: u64, of: u64| ((side * by + of / 2) / of.max(1)).max(1) as u32;
    if w * max_h > h * max_w {
        (max_width.max(1), scaled(h, max_w, w).min(max_height.max(1)))
    } else {
        (scaled(w, max_h, h).min(max_width.max(1)), max_height.max(1))
    }
}

fn add(sum: &mut [f64; 3], value: [f64; 3], weight: f64) {
    for (sum, value) in sum.iter_mut().zip(value) {
        *sum += value * weight;
    }
}

/// What a new pixel covers along one axis, in units of old pixels: an interval.
#[derive(Clone, Copy)]
struct Share {
    start: f64,
    end: f64,
    /// Old pixels there are.
    count: u32,
}

fn shares(old: u32, new: u32) -> Vec<Share> {
    let edge = |i: u32| f64::from(i) * f64::from(old) / f64::from(new);
    (0..new).map(|i| Share { start: edge(i), end: edge(i + 1), count: old }).collect()
}

impl Share {
    /// The old pixels and how much of the interval each fills; these sum to one but for rounding.
    fn weights(self) -> impl Iterator<Item = (u32, f64)> {
        let length = self.end - self.start;
        let first = (self.start as u32).min(self.count - 1);
        let last = (self.end.ceil() as u32).clamp(first + 1, self.count);
        (first..last).map(move |i| {
            let covered = self.end.min(f64::from(i) + 1.0) - self.start.max(f64::from(i));
            (i, covered.max(0.0) / length)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_is_preserved() {
        let image = Image::from_fn(31, 17, |x, y| Rgb::new((x * 7 % 13) as f32, (y * y % 11) as f32, 1.0));
        let mean = |image: &Image<Rgb>| {
            let sum = image.pixels().iter().fold([0.0; 3], |mut sum, pixel| {
                add(&mut sum, pixel.to_array().map(f64::from), 1.0);
                sum
            });
            sum.map(|sum| sum / image.pixels().len() as f64)
        };
        for (width, height) in [(1, 1), (7, 5), (31, 3), (10, 17), (62, 34), (100, 100)] {
            let resized = resize(&image, width, height);
            assert_eq!(resized.size(), (width, height));
            for (a, b) in mean(&resized).iter().zip(mean(&image)) {
                assert!((a - b).abs() < 1e-5, "{width} × {height}: {a} for {b}");
            }
        }
        assert_eq!(resize(&image, 31, 17), image);
    }

    #[test]
    fn whole_multiples_are_plain_means() {
        let image = Image::from_fn(6, 4, |x, y| Rgb::gray((x + 10 * y) as f32));
        let small = resize(&image, 2, 2);
        assert_eq!(small.get(1, 1), Some(&Rgb::gray((3 + 4 + 5 + 3 * 20 + 3 + 4 + 5 + 3 * 30) as f32 / 6.0)));
        let doubled = resize(&image, 12, 8);
        assert_eq!(doubled.get(7, 3), image.get(3, 1));
    }

    #[test]
    fn sizes_are_fitted_in_shape() {
        assert_eq!(fit((640, 480), 80, 1000), (80, 60));
        assert_eq!(fit((640, 480), 1000, 48), (64, 48));
        assert_eq!(fit((640, 480), 1000, 1000), (640, 480));
        assert_eq!(fit((10_000, 1), 80, 60), (80, 1));
        assert_eq!(fit((1, u32::MAX), 80, 60), (1, 60));
        assert_eq!(fit((5, 5), 0, 0), (1, 1));
    }

    #[test]
    fn nothing_resizes_to_black() {
        assert_eq!(resize(&Image::filled(0, 4, Rgb::WHITE), 2, 2), Image::filled(2, 2, Rgb::BLACK));
        assert!(resize(&Image::filled(4, 4, Rgb::WHITE), 0, 2).is_empty());
    }
}

//! Ever smaller versions of a picture, and the blend of two of them that a footprint asks for.
//!
//! L. Williams, "Pyramidal Parametrics", SIGGRAPH 1983. Each level is the one before, averaged over boxes; sizes that are odd
//! are halved downwards and the boxes then overlap pixels in part, so that the mean of the picture is kept on every level.

use snell_math::{Rgb, portable};

use super::image::Level;

/// The next smaller level; none below a single pixel.
pub(super) fn halve(level: &Level) -> Option<Level> {
    if level.width == 1 && level.height == 1 {
        return None;
    }
    let (width, height) = ((level.width / 2).max(1), (level.height / 2).max(1));
    // One axis after the other: boxes are products.
    let mut narrow = Vec::with_capacity(width as usize * level.height as usize);
    for row in level.pixels.chunks_exact(level.width as usize) {
        narrow.extend((0..width).map(|x| average(x, level.width, width, |i| row[i])));
    }
    let mut pixels = Vec::with_capacity(width as usize * height as usize);
    for y in 0..height {
        let column = |x: usize| average(y, level.height, height, |i| narrow[i * width as usize + x]);
        pixels.extend((0..width as usize).map(column));
    }
    Some(Level { width, height, pixels })
}

/// The mean over box number `index` of `boxes` that divide `size` pixels evenly.
fn average(index: u32, size: u32, boxes: u32, pixel: impl Fn(usize) -> Rgb) -> Rgb {
    let width = f64::from(size) / f64::from(boxes);
    let (start, end) = (f64::from(index) * width, f64::from(index + 1) * width);
    let mut sum = [0.0_f64; 3];
    for i in start as u32..(end.ceil() as u32).min(size) {
        let covered = end.min(f64::from(i) + 1.0) - start.max(f64::from(i));
        for (sum, component) in sum.iter_mut().zip(pixel(i as usize).to_array()) {
            *sum += covered * f64::from(component);
        }
    }
    Rgb::from(sum.map(|component| (component / width) as f32))
}

/// The colour at a position where `pixels_seen` (above 1) pixels of the full picture are seen at once, along its longer
/// side: trilinear interpolation.
pub(super) fn color(levels: &[Level], position: [f64; 2], repeat: bool, pixels_seen: f64) -> Rgb {
    let last = levels.len() - 1;
    let height = portable::log2(pixels_seen);
    if height >= last as f64 {
        return levels[last].blended(position, repeat);
    }
    let fine = height as usize;
    let weight = (height - fine as f64) as f32;
    levels[fine].blended(position, repeat).lerp(levels[fine + 1].blended(position, repeat), weight)
}

//! Ever smaller versions of a picture, and the means of them that a footprint asks for.
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
    if level.width.is_multiple_of(2) && level.height.is_multiple_of(2) {
        return Some(Level { width, height, pixels: means_of_four(level) });
    }
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

/// The means of two by two pixels, where sizes are even: the same boxes, and many times as fast.
fn means_of_four(level: &Level) -> Vec<Rgb> {
    let rows = level.pixels.chunks_exact(2 * level.width as usize);
    let means = rows.flat_map(|rows| {
        let (above, below) = rows.split_at(level.width as usize);
        above.chunks_exact(2).zip(below.chunks_exact(2)).map(|(above, below)| {
            let four = [above[0], above[1], below[0], below[1]].map(|color| color.to_array().map(f64::from));
            let mean = |i: usize| (0.25 * ((four[0][i] + four[1][i]) + (four[2][i] + four[3][i]))) as f32;
            Rgb::new(mean(0), mean(1), mean(2))
        })
    });
    means.collect()
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

/// The most places at which a picture is looked up for one footprint.
const MAX_PROBES: f64 = 16.0;

/// How a footprint is averaged: probes along its longer axis, each as wide as the shorter one.
///
/// McCormack, Perry, Farkas and Jouppi, "Feline: Fast Elliptical Lines for Anisotropic Texture Mapping", SIGGRAPH 1999, with
/// equal weights, since the footprint is that of a square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Probes {
    count: u32,
    /// From the middle to the last one, in units of the position.
    reach: [f64; 2],
    /// The binary logarithm of how many pixels each is wide, from 0.
    height: f64,
}

impl Probes {
    /// Of a parallelogram by its sides, in units of a position over a picture of some size; `None` where it is at most one
    /// pixel long.
    fn new(sides: [[f64; 2]; 2], [width, height]: [u32; 2]) -> Option<Self> {
        let size = [f64::from(width), f64::from(height)];
        // Beyond this all of any picture is seen, and squares of squares are still numbers.
        let in_pixels = |length: f64, size: f64| if length.is_nan() { 0.0 } else { (length * size).clamp(-1e12, 1e12) };
        let [[ax, ay], [bx, by]] = sides.map(|[x, y]| [in_pixels(x, size[0]), in_pixels(y, size[1])]);
        // The axes of the ellipse that the sides make of the unit circle: eigenvectors of a symmetric matrix.
        let (xx, xy, yy) = (ax * ax + bx * bx, ax * ay + bx * by, ay * ay + by * by);
        let half = 0.5 * (xx - yy);
        let root = (half * half + xy * xy).sqrt();
        let longer = (0.5 * (xx + yy) + root).sqrt();
        if longer <= 1.0 {
            return None;
        }
        let shorter = ((ax * by - ay * bx).abs() / longer).max(longer / MAX_PROBES).max(1.0);
        let count = (longer / shorter).ceil().clamp(1.0, MAX_PROBES) as u32;
        let along = if half >= 0.0 { [half + root, xy] } else { [xy, root - half] };
        let length = (along[0] * along[0] + along[1] * along[1]).sqrt();
        // Their own width reaches to the ends.
        let scale = if length > 0.0 { 0.5 * (longer - shorter) / length } else { 0.0 };
        let reach = [0, 1].map(|axis: usize| along[axis] * scale / size[axis]);
        Some(Self { count, reach, height: portable::log2(shorter) })
    }

    /// The mean of what `look` finds at the probes around a position on two of some levels: trilinear interpolation.
    fn mean(&self, position: [f64; 2], last: usize, look: impl Fn(usize, [f64; 2]) -> Rgb) -> Rgb {
        let fine = (self.height as usize).min(last);
        let weight = if fine == last { 0.0 } else { (self.height - fine as f64) as f32 };
        let mut sum = [0.0_f64; 3];
        for i in 0..self.count {
            let along = if self.count > 1 { f64::from(2 * i) / f64::from(self.count - 1) - 1.0 } else { 0.0 };
            let place = [0, 1].map(|axis: usize| position[axis] + self.reach[axis] * along);
            let mut color = look(fine, place);
            if weight > 0.0 {
                color = color.lerp(look(fine + 1, place), weight);
            }
            for (sum, component) in sum.iter_mut().zip(color.to_array()) {
                *sum += f64::from(component);
            }
        }
        Rgb::from(sum.map(|component| (component / f64::from(self.count)) as f32))
    }
}

/// The mean colour over a parallelogram around a position, by its sides; `look` gives the colour of a level at a position.
#[inline]
pub(super) fn average_over(
    levels: &[Level],
    position: [f64; 2],
    sides: [[f64; 2]; 2],
    look: impl Fn(usize, [f64; 2]) -> Rgb,
) -> Rgb {
    let Level { width, height, .. } = levels[0];
    match Probes::new(sides, [width, height]) {
        Some(probes) if levels.len() > 1 => probes.mean(position, levels.len() - 1, look),
        _ => look(0, position),
    }
}

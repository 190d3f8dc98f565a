//! The film: sums of samples, exact, so that no order of adding or merging changes a bit.
//!
//! A sample is rounded once to a whole number of 2⁻³⁰, and sums are integers. That is finer than the steps of an `f32`
//! for every value above 2⁻⁷, far below what a display shows for the rest, and leaves room for thousands of samples at
//! the brightest value there is.

#[cfg(test)]
mod tests;

use std::sync::Mutex;

use snell_image::Image;
use snell_math::Rgb;
use snell_math::lanes::{Floats, InstructionSet, Lanes, WIDTH, Work, dispatch};

/// The value of one unit: 2⁻³⁰.
const UNIT: f64 = 1.0 / 1_073_741_824.0;
/// Samples beyond this radiance count as this much: 2²⁰, a thousand times the sun's disk in a picture of its sky.
const BRIGHTEST: f64 = 1_048_576.0;

/// The sum of the samples of one pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PixelSum {
    sum: [i64; 3],
    count: u32,
}

impl PixelSum {
    /// Adds a sample. One that is not finite counts as black; the result says whether it was.
    #[must_use = "samples that are not finite are to be counted"]
    pub fn add(&mut self, sample: Rgb) -> bool {
        self.count += 1;
        let finite = sample.is_finite();
        if finite {
            for (sum, component) in self.sum.iter_mut().zip(sample.to_array()) {
                let value = f64::from(component).clamp(-BRIGHTEST, BRIGHTEST);
                *sum = sum.saturating_add(round(value / UNIT));
            }
        }
        finite
    }

    /// From the mean of a single sample, which is exact.
    fn of_one(mean: Rgb) -> Self {
        Self { sum: mean.to_array().map(|component| round(f64::from(component) / UNIT)), count: 1 }
    }

    /// Adds the samples of another part of the same pixel.
    pub fn merge(&mut self, other: &Self) {
        for (sum, more) in self.sum.iter_mut().zip(other.sum) {
            *sum = sum.saturating_add(more);
        }
        self.count += other.count;
    }

    /// How many samples it holds.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// The mean of the samples; black where there are none.
    pub fn mean(&self) -> Rgb {
        if self.count == 0 {
            return Rgb::BLACK;
        }
        let [r, g, b] = self.sum.map(|sum| (sum as f64 * UNIT / f64::from(self.count)) as f32);
        Rgb::new(r, g, b)
    }
}

/// The nearest whole number, of two the even one, for magnitudes up to 2⁵⁰.
///
/// Adding a number whose last bit is worth one makes the addition itself round; there is an instruction for that on every
/// machine, which there is not for `round_ties_even`.
#[inline]
fn round(value: f64) -> i64 {
    (value + LAST_BIT_IS_ONE - LAST_BIT_IS_ONE) as i64
}

const LAST_BIT_IS_ONE: f64 = 1.5 * (1_u64 << 52) as f64;

/// The pixels of a picture in the making.
///
/// ```
/// use snell::film::Film;
/// use snell::math::Rgb;
/// let mut film = Film::new(4, 2);
/// let tiles = film.tiles();
/// std::thread::scope(|scope| {
///     scope.spawn(|| tiles.add(&[0, 1, 4, 5], &[Rgb::WHITE; 4]));
///     // Two samples in each of these.
///     scope.spawn(|| tiles.add(&[2, 6], &[0.0, 0.5, 1.0, 3.0].map(Rgb::gray)));
/// });
/// drop(tiles);
/// let image = film.into_image();
/// assert_eq!(image.row(0), [1.0, 1.0, 0.25, 0.0].map(Rgb::gray));
/// assert_eq!(image.row(1), [1.0, 1.0, 2.0, 0.0].map(Rgb::gray));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    width: u32,
    height: u32,
    /// The mean of each pixel's samples. Of a single sample it is the sum itself: a multiple of 2⁻³⁰ that an `f32` can say, for
    /// from 2⁻⁷ up an `f32` is such a multiple, and below there are no more than 2²³ of them.
    means: Vec<Rgb>,
    /// What is needed to add to pixels that have samples already.
    sums: Option<Sums>,
}

/// How many samples pixels have, and the sums of those that have several. Memory that is never written to is never there.
#[derive(Clone, Debug, PartialEq)]
struct Sums {
    counts: Vec<u32>,
    sums: Vec<[i64; 3]>,
}

impl Film {
    /// Without a sample yet.
    pub fn new(width: u32, height: u32) -> Self {
        let count = width as usize * height as usize;
        Self {
            sums: Some(Sums { counts: vec![0; count], sums: vec![[0; 3]; count] }),
            ..Self::of_one_pass(width, height)
        }
    }

    /// Without a sample yet, where all samples of a pixel come at once: of those that come later for the same pixel, the last
    /// ones would count alone.
    pub fn of_one_pass(width: u32, height: u32) -> Self {
        // Zeros as numbers, which come from the system for nothing.
        let means = bytemuck::cast_vec(vec![[0.0_f32; 3]; width as usize * height as usize]);
        Self { width, height, means, sums: None }
    }

    /// Pixels in x.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Pixels in y.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Lets any number of threads add samples.
    pub fn tiles(&mut self) -> FilmTiles<'_> {
        let band_length = (self.width as usize * BAND_ROWS).max(1);
        let means = self.means.chunks_mut(band_length);
        let bands: Vec<Mutex<Band<'_>>> = match &mut self.sums {
            None => means.map(|means| Mutex::new(Band { means, sums: None })).collect(),
            Some(Sums { counts, sums }) => {
                let sums = counts.chunks_mut(band_length).zip(sums.chunks_mut(band_length));
                means.zip(sums).map(|(means, sums)| Mutex::new(Band { means, sums: Some(sums) })).collect()
            }
        };
        FilmTiles { band_length, bands, instructions: InstructionSet::best() }
    }

    /// Scene-linear colours: each pixel the mean of its samples, black where there are none.
    pub fn into_image(self) -> Image<Rgb> {
        // As many means as pixels, always.
        Image::from_pixels(self.width, self.height, self.means).unwrap_or_else(|_| Image::filled(0, 0, Rgb::BLACK))
    }
}

/// Rows that are locked together: as many as a tile has, so that tiles side by side wait for each other, and no others do. A lock
/// is held as long as it takes to copy what a tile has.
const BAND_ROWS: usize = 32;

/// A film while samples are added to it, by any number of threads.
#[derive(Debug)]
pub struct FilmTiles<'a> {
    /// Pixels in a band.
    band_length: usize,
    bands: Vec<Mutex<Band<'a>>>,
    instructions: InstructionSet,
}

/// Some rows of a film.
#[derive(Debug)]
struct Band<'a> {
    means: &'a mut [Rgb],
    sums: Option<(&'a mut [u32], &'a mut [[i64; 3]])>,
}

impl FilmTiles<'_> {
    /// Adds samples to pixels, which are given by their places in rows from the top, in ascending order; as many samples to each,
    /// those of the first pixel first. Samples that are not finite count as black; the result says how many they were.
    ///
    /// # Panics
    /// Where there is no such pixel, as indexing a slice does.
    #[must_use = "samples that are not finite are to be counted"]
    pub fn add(&self, pixels: &[u32], samples: &[Rgb]) -> u64 {
        debug_assert!(pixels.is_sorted_by(|a, b| a < b), "pixels in ascending order, none of them twice");
        let per_pixel = samples.len() / pixels.len().max(1);
        if per_pixel == 0 {
            return 0;
        }
        let mut nonfinite = 0;
        let (mut pixels, mut samples) = (pixels, samples);
        while let Some(&first) = pixels.first() {
            let number = first as usize / self.band_length;
            let end = (number + 1) * self.band_length;
            let count = pixels.partition_point(|&pixel| (pixel as usize) < end);
            let (here, there) = pixels.split_at(count);
            let (here_samples, there_samples) = samples.split_at(count * per_pixel);
            // A panic in another tile is passed on by the one who made the threads; what is on the film is whole.
            let mut band = self.bands[number].lock().unwrap_or_else(|poisoned| poisoned.into_inner());
            let begin = (number * self.band_length) as u32;
            nonfinite += band.add(begin, here, here_samples, per_pixel, self.instructions);
            (pixels, samples) = (there, there_samples);
        }
        nonfinite
    }
}

impl Band<'_> {
    /// Adds samples to pixels of a band that begins at place `begin`.
    fn add(
        &mut self,
        begin: u32,
        pixels: &[u32],
        samples: &[Rgb],
        per_pixel: usize,
        instructions: InstructionSet,
    ) -> u64 {
        let mut nonfinite = 0;
        let (mut pixels, mut samples) = (pixels, samples);
        if per_pixel == 1 {
            let done =
                dispatch(instructions, SingleSamples { band: self, begin, pixels, samples, nonfinite: &mut nonfinite });
            (pixels, samples) = (&pixels[done..], &samples[done..]);
        }
        for (&pixel, samples) in pixels.iter().zip(samples.chunks_exact(per_pixel)) {
            nonfinite += self.add_pixel((pixel - begin) as usize, samples);
        }
        nonfinite
    }

    fn add_pixel(&mut self, pixel: usize, samples: &[Rgb]) -> u64 {
        let mut pixel_sum = PixelSum::default();
        let mut nonfinite = 0;
        for &sample in samples {
            nonfinite += u64::from(!pixel_sum.add(sample));
        }
        if let Some((counts, sums)) = &mut self.sums {
            let before = match counts[pixel] {
                0 => PixelSum::default(),
                1 => PixelSum::of_one(self.means[pixel]),
                count => PixelSum { sum: sums[pixel], count },
            };
            pixel_sum.merge(&before);
            counts[pixel] = pixel_sum.count;
            if pixel_sum.count > 1 {
                sums[pixel] = pixel_sum.sum;
            }
        }
        self.means[pixel] = pixel_sum.mean();
        nonfinite
    }
}

/// Pixels that get one sample each and had none, eight at a time where eight stand side by side.
struct SingleSamples<'b, 'a> {
    band: &'b mut Band<'a>,
    begin: u32,
    pixels: &'b [u32],
    samples: &'b [Rgb],
    nonfinite: &'b mut u64,
}

impl Work for SingleSamples<'_, '_> {
    /// How many pixels have their sample.
    type Output = usize;

    #[inline(always)]
    fn run<L: Lanes>(self) -> usize {
        let Self { band, begin, pixels, samples, nonfinite } = self;
        let mut done = 0;
        for (eight, samples) in pixels.as_chunks::<WIDTH>().0.iter().zip(samples.as_chunks::<WIDTH>().0) {
            let at = (eight[0] - begin) as usize;
            // They ascend, so the first and the last tell whether any is missing between.
            let is_whole = eight[WIDTH - 1] - eight[0] == WIDTH as u32 - 1;
            let is_fresh =
                |band: &Band<'_>| band.sums.as_ref().is_none_or(|(counts, _)| counts[at..][..WIDTH] == [0; WIDTH]);
            if let (true, Some(means)) = (is_whole && is_fresh(band), exact_means::<L>(samples)) {
                band.means[at..][..WIDTH].copy_from_slice(&means);
                if let Some((counts, _)) = &mut band.sums {
                    counts[at..][..WIDTH].fill(1);
                }
            } else {
                for (&pixel, sample) in eight.iter().zip(samples) {
                    *nonfinite += band.add_pixel((pixel - begin) as usize, std::slice::from_ref(sample));
                }
            }
            done += WIDTH;
        }
        done
    }
}

/// The means of eight pixels with one sample each; `None` where one is not finite or so bright that it would be cut.
#[inline(always)]
fn exact_means<L: Lanes>(samples: &[Rgb; WIDTH]) -> Option<[Rgb; WIDTH]> {
    let rows: &[[f32; WIDTH]; 3] = bytemuck::cast_ref(samples);
    let mut means = [[0.0; WIDTH]; 3];
    let mut is_ordinary = true;
    for (row, means) in rows.iter().zip(&mut means) {
        for at in (0..WIDTH).step_by(L::COUNT) {
            let floats = L::Floats::load(row, at);
            is_ordinary &= floats.abs().lt(L::Floats::splat(BRIGHTEST as f32)) == L::all();
            // As `round`, in multiples of the unit, which only changes exponents.
            let last_bit_is_unit = L::splat(LAST_BIT_IS_ONE * UNIT);
            let rounded = L::from_floats(floats) + last_bit_is_unit - last_bit_is_unit;
            rounded.to_floats().store(means, at);
        }
    }
    is_ordinary.then(|| bytemuck::cast(means))
}

//! Pictures ready for a display: 8 or 16 bit sRGB codes, red, green and blue in turn, row 0 at the top.

use rayon::prelude::*;
use snell_math::Rgb;

use crate::tone::{ToneCurve, exposure_scale};
use crate::transfer::{ByteEncoder, Encoder};
use crate::{Image, transfer};

/// How many bits a component has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum BitDepth {
    /// Codes 0 to 255.
    #[default]
    Eight,
    /// Codes 0 to 65535.
    Sixteen,
}

impl BitDepth {
    /// The code of full light.
    #[must_use]
    pub const fn max_code(self) -> u16 {
        match self {
            Self::Eight => u8::MAX as u16,
            Self::Sixteen => u16::MAX,
        }
    }
}

/// All components of a display picture: red, green, blue of the first pixel, then of the next.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Samples {
    /// 8 bit codes.
    Eight(Vec<u8>),
    /// 16 bit codes.
    Sixteen(Vec<u16>),
}

/// A picture of sRGB codes. It comes from developing scene-linear light, or from a file that holds such codes; there is
/// no way from it back into a tone curve.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DisplayImage {
    width: u32,
    height: u32,
    samples: Samples,
}

impl DisplayImage {
    /// Develops scene-linear light: times 2 to the power `exposure` (in stops), through the tone curve, clipped to [0, 1],
    /// sRGB-encoded (always) and rounded to the nearest code.
    ///
    /// NaN becomes 0, infinite light full; count them with [`Image::count_non_finite`]. Rows are developed in parallel;
    /// the result is the same for any number of threads.
    ///
    /// ```
    /// use snell_image::{BitDepth, DisplayImage, Image, ToneCurve};
    /// use snell_math::Rgb;
    /// let light = Image::filled(1, 1, Rgb::gray(0.125));
    /// let display = DisplayImage::develop(&light, ToneCurve::None, 3.0, BitDepth::Sixteen);
    /// assert_eq!(display.code(0, 0), [65535; 3]);
    /// ```
    #[must_use]
    pub fn develop(light: &Image<Rgb>, tone: ToneCurve, exposure: f32, depth: BitDepth) -> Self {
        let samples = match depth {
            BitDepth::Eight => {
                let developer = Developer::new(tone, exposure);
                Samples::Eight(develop_rows(light, |row, codes| developer.develop(row, codes)))
            }
            BitDepth::Sixteen => {
                let scale = exposure_scale(exposure);
                let encoder = Encoder::new(depth.max_code());
                Samples::Sixteen(develop_rows(light, |row, codes| {
                    for (pixel, codes) in row.iter().zip(codes.as_chunks_mut().0) {
                        *codes = tone.apply(*pixel * scale).to_array().map(|linear| encoder.code(linear));
                    }
                }))
            }
        };
        Self { width: light.width(), height: light.height(), samples }
    }

    /// Takes 8 bit sRGB codes, of the pixels in reading order; `None` where there is not one triple for every pixel.
    ///
    /// ```
    /// use snell_image::DisplayImage;
    /// let picture = DisplayImage::from_codes(2, 1, vec![[0, 0, 0], [255, 128, 0]]).expect("two pixels");
    /// assert_eq!(picture.code(1, 0), [255, 128, 0]);
    /// assert!(DisplayImage::from_codes(2, 2, vec![[0; 3]]).is_none());
    /// ```
    pub fn from_codes(width: u32, height: u32, codes: Vec<[u8; 3]>) -> Option<Self> {
        let is_whole = u64::from(width) * u64::from(height) == codes.len() as u64;
        is_whole.then(|| Self { width, height, samples: Samples::Eight(codes.into_flattened()) })
    }

    /// Takes codes that a decoder read; three for every pixel.
    pub(crate) fn from_samples(width: u32, height: u32, samples: Samples) -> Self {
        let count = match &samples {
            Samples::Eight(codes) => codes.len(),
            Samples::Sixteen(codes) => codes.len(),
        };
        debug_assert_eq!(count, width as usize * height as usize * 3, "three codes for every pixel");
        Self { width, height, samples }
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// (width, height).
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Bits of a component.
    pub fn depth(&self) -> BitDepth {
        match self.samples {
            Samples::Eight(_) => BitDepth::Eight,
            Samples::Sixteen(_) => BitDepth::Sixteen,
        }
    }

    /// All codes, interleaved, row after row.
    pub fn samples(&self) -> &Samples {
        &self.samples
    }

    /// Red, green and blue code of the pixel at column `x`, row `y`.
    ///
    /// # Panics
    /// Where there is no such pixel, as indexing a slice does.
    pub fn code(&self, x: u32, y: u32) -> [u16; 3] {
        assert!(x < self.width && y < self.height, "pixel ({x}, {y}) of a {} × {} picture", self.width, self.height);
        self.code_at(y as usize * self.width as usize + x as usize)
    }

    /// Red, green and blue code of a pixel by its place in reading order.
    pub(crate) fn code_at(&self, pixel: usize) -> [u16; 3] {
        let at = pixel * 3;
        match &self.samples {
            Samples::Eight(codes) => [codes[at].into(), codes[at + 1].into(), codes[at + 2].into()],
            Samples::Sixteen(codes) => [codes[at], codes[at + 1], codes[at + 2]],
        }
    }

    /// The light that a display gives for these codes: display-linear, in [0, 1]. Developing it with
    /// [`ToneCurve::None`] at the same depth gives this picture again, exactly.
    #[must_use]
    pub fn to_linear(&self) -> Image<Rgb> {
        let table = transfer::linear_table(self.depth().max_code());
        let width = self.width as usize;
        Image::from_fn(self.width, self.height, |x, y| {
            Rgb::from(self.code_at(y as usize * width + x as usize).map(|code| table[usize::from(code)]))
        })
    }
}

/// Develops scene-linear light straight into 8 bit codes, a stretch of pixels at a time: what [`DisplayImage::develop`] does
/// for a whole picture.
///
/// ```
/// use snell_image::{Developer, ToneCurve};
/// use snell_math::Rgb;
/// let mut codes = [0; 6];
/// Developer::new(ToneCurve::None, -1.0).develop(&[Rgb::WHITE, Rgb::new(0.0, 2.0, 9.0)], &mut codes);
/// assert_eq!(codes, [188, 188, 188, 0, 255, 255]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Developer {
    tone: ToneCurve,
    /// The factor before the tone curve.
    scale: f32,
    encoder: ByteEncoder,
}

impl Developer {
    /// For one tone curve and exposure, in stops.
    #[must_use]
    pub fn new(tone: ToneCurve, exposure: f32) -> Self {
        Self { tone, scale: exposure_scale(exposure), encoder: ByteEncoder::new() }
    }

    /// Three codes for each pixel, of as many pixels as there is room for.
    pub fn develop(&self, light: &[Rgb], codes: &mut [u8]) {
        if self.tone == ToneCurve::None {
            return self.encoder.encode(bytemuck::cast_slice(light), self.scale, codes);
        }
        // In pieces, so that what the tone curve makes of them stays in the nearest cache.
        let mut toned = [Rgb::BLACK; 64];
        for (light, codes) in light.chunks(toned.len()).zip(codes.chunks_mut(toned.len() * 3)) {
            for (toned, pixel) in toned.iter_mut().zip(light) {
                *toned = self.tone.apply(*pixel * self.scale);
            }
            self.encoder.encode(bytemuck::cast_slice(&toned[..light.len()]), 1.0, codes);
        }
    }
}

/// Rows at a time for one thread.
const ROWS: usize = 16;

fn develop_rows<S: Copy + Default + Send + Sync>(
    light: &Image<Rgb>,
    develop: impl Fn(&[Rgb], &mut [S]) + Sync,
) -> Vec<S> {
    let pixels = light.width().max(1) as usize * ROWS;
    let mut samples = vec![S::default(); light.pixels().len() * 3];
    let rows = samples.par_chunks_mut(pixels * 3).zip(light.pixels().par_chunks(pixels));
    rows.for_each(|(codes, light)| develop(light, codes));
    samples
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_the_light_is_code_188() {
        let display =
            DisplayImage::develop(&Image::filled(3, 2, Rgb::gray(0.5)), ToneCurve::None, 0.0, BitDepth::Eight);
        assert_eq!(display.samples(), &Samples::Eight(vec![188; 18]), "sRGB encoding is on by default");
        assert_eq!(display.size(), (3, 2));
    }

    #[test]
    fn what_is_not_a_number_is_black_and_what_is_out_of_range_is_clipped() {
        let light = Image::filled(1, 1, Rgb::new(f32::NAN, -3.0, f32::INFINITY));
        for depth in [BitDepth::Eight, BitDepth::Sixteen] {
            let display = DisplayImage::develop(&light, ToneCurve::None, 0.0, depth);
            assert_eq!(display.code(0, 0), [0, 0, depth.max_code()]);
        }
        for exposure in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e9] {
            let _ = DisplayImage::develop(&light, ToneCurve::Filmic, exposure, BitDepth::Eight);
        }
    }

    #[test]
    fn every_tone_curve_is_applied_and_encoded_as_the_references_say() {
        let light: Vec<Rgb> =
            (0..200).map(|i| Rgb::new(i as f32 / 90.0 - 0.1, f32::NAN, 1.0 / (i as f32 - 30.0))).collect();
        for tone in [ToneCurve::None, ToneCurve::Reinhard, ToneCurve::Filmic] {
            let mut codes = vec![7; 600];
            Developer::new(tone, -0.3).develop(&light, &mut codes);
            let expected = light.iter().flat_map(|pixel| tone.apply(*pixel * exposure_scale(-0.3)).to_array());
            assert!(expected.zip(codes).all(|(linear, code)| transfer::code_reference(linear, 255) == code.into()));
        }
    }

    #[test]
    fn any_number_of_threads_gives_the_same_codes() {
        let light = Image::from_fn(67, 45, |x, y| Rgb::new(x as f32 / 60.0, y as f32 / 40.0, (x * y) as f32 / 900.0));
        let develop = || DisplayImage::develop(&light, ToneCurve::Reinhard, 0.5, BitDepth::Sixteen);
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(develop);
        let four = rayon::ThreadPoolBuilder::new().num_threads(4).build().unwrap().install(develop);
        assert_eq!(alone, four);
    }

    #[test]
    fn pictures_without_pixels_develop_into_such() {
        for (width, height) in [(0, 0), (0, 5), (5, 0)] {
            let display =
                DisplayImage::develop(&Image::filled(width, height, Rgb::WHITE), ToneCurve::None, 0.0, BitDepth::Eight);
            assert_eq!(display.size(), (width, height));
        }
    }

    #[test]
    fn codes_go_to_light_and_back() {
        for depth in [BitDepth::Eight, BitDepth::Sixteen] {
            let light = Image::from_fn(256, 2, |x, y| Rgb::new(x as f32 / 255.0, y as f32, 0.3));
            let display = DisplayImage::develop(&light, ToneCurve::None, 0.0, depth);
            assert_eq!(DisplayImage::develop(&display.to_linear(), ToneCurve::None, 0.0, depth), display);
        }
    }
}

//! Where the picture needs more samples: where a neighbour or another sample of the same pixel looks different.
//!
//! "Different" is judged as the viewer will see it, after exposure and tone and in the sRGB encoding, whose steps are about
//! equally visible. A pixel is unsettled after the first pass where the samples in it and its eight neighbours differ by more
//! than a threshold in any component, and after later ones where its own do.

use snell_image::tone::{ToneCurve, exposure_scale};
use snell_math::Rgb;
use snell_math::color::linear_to_srgb;

use super::settings::RenderSettings;

/// The least difference between display values, in [0, 1], that calls for more samples: about eight steps of 255.
const THRESHOLD: f32 = 0.03;
/// The slope of the sRGB encoding at black, which is its largest.
const STEEPEST: f32 = 12.92;

/// How samples will be shown.
#[derive(Clone, Copy, Debug)]
pub struct Display {
    tone: ToneCurve,
    /// The factor before the tone curve.
    exposure: f32,
}

/// The least and the largest value of some samples, component by component: display-linear and clipped to [0, 1], so before the
/// sRGB encoding.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    low: [f32; 3],
    high: [f32; 3],
}

/// The range of each pixel's samples.
#[derive(Clone, Debug)]
pub struct Contrast {
    width: usize,
    height: usize,
    ranges: Vec<Range>,
}

impl Display {
    pub fn new(settings: &RenderSettings) -> Self {
        Self { tone: settings.tone_curve(), exposure: exposure_scale(settings.exposure) }
    }

    /// The range of samples as they are shown.
    pub fn range(&self, samples: &[Rgb]) -> Range {
        samples.iter().fold(Range::EMPTY, |range, &sample| {
            let shown = self.tone.apply(sample * self.exposure).map(|c| c.clamp(0.0, 1.0)).to_array();
            range.including(&Range { low: shown, high: shown })
        })
    }
}

impl Range {
    const EMPTY: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    #[inline]
    fn including(mut self, other: &Self) -> Self {
        // Written so that NaN changes nothing.
        for i in 0..3 {
            self.low[i] = if other.low[i] < self.low[i] { other.low[i] } else { self.low[i] };
            self.high[i] = if other.high[i] > self.high[i] { other.high[i] } else { self.high[i] };
        }
        self
    }

    /// Whether the values, sRGB-encoded, differ by more than the threshold in any component.
    fn is_wide(&self) -> bool {
        (0..3).any(|i| {
            let (low, high) = (self.low[i], self.high[i]);
            // The encoding is nowhere steeper than where it begins, so most differences are too small without asking it.
            high - low > 0.99 * THRESHOLD / STEEPEST && linear_to_srgb(high) - linear_to_srgb(low) > THRESHOLD
        })
    }
}

impl Contrast {
    /// Without a sample yet.
    pub fn new(width: u32, height: u32) -> Self {
        let pixels = width as usize * height as usize;
        Self { width: width as usize, height: height as usize, ranges: vec![Range::EMPTY; pixels] }
    }

    /// Takes note of the range of samples of one pixel.
    pub fn add(&mut self, pixel: usize, range: &Range) {
        self.ranges[pixel] = self.ranges[pixel].including(range);
    }

    /// Which pixels need the next pass. After the first one, of a single sample, all depends on the neighbours; later a pixel's
    /// own samples tell better, and a neighbour's edge is not its own.
    pub fn unsettled(&self, pass: usize) -> Vec<bool> {
        if pass > 1 {
            return self.ranges.iter().map(|range| range.is_wide()).collect();
        }
        let mut unsettled = Vec::with_capacity(self.ranges.len());
        // Of each pixel with the ones above and below it; then those of three columns together.
        let mut columns = vec![Range::EMPTY; self.width];
        for y in 0..self.height {
            columns.fill(Range::EMPTY);
            for row in y.saturating_sub(1)..(y + 2).min(self.height) {
                let row = &self.ranges[row * self.width..][..self.width];
                for (column, range) in columns.iter_mut().zip(row) {
                    *column = column.including(range);
                }
            }
            unsettled.extend((0..self.width).map(|x| {
                let neighbours = &columns[x.saturating_sub(1)..(x + 2).min(self.width)];
                neighbours.iter().fold(Range::EMPTY, |sum, column| sum.including(column)).is_wide()
            }));
        }
        unsettled
    }
}

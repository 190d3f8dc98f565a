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

/// The range of each pixel's samples as displayed.
#[derive(Clone, Debug)]
pub struct Contrast {
    width: usize,
    height: usize,
    tone: ToneCurve,
    /// The factor before the tone curve.
    exposure: f32,
    ranges: Vec<Range>,
}

/// The least and the largest display value of a pixel's samples, component by component.
#[derive(Clone, Copy, Debug)]
struct Range {
    low: [f32; 3],
    high: [f32; 3],
}

impl Range {
    const EMPTY: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    fn including(mut self, other: &Self) -> Self {
        for i in 0..3 {
            self.low[i] = self.low[i].min(other.low[i]);
            self.high[i] = self.high[i].max(other.high[i]);
        }
        self
    }

    fn spread(&self) -> f32 {
        (0..3).map(|i| self.high[i] - self.low[i]).fold(0.0, f32::max)
    }
}

impl Contrast {
    /// Without a sample yet.
    pub fn new(width: u32, height: u32, settings: &RenderSettings) -> Self {
        let pixels = width as usize * height as usize;
        Self {
            width: width as usize,
            height: height as usize,
            tone: settings.tone_curve(),
            exposure: exposure_scale(settings.exposure),
            ranges: vec![Range::EMPTY; pixels],
        }
    }

    /// Takes note of samples of one pixel.
    pub fn add(&mut self, pixel: usize, samples: &[Rgb]) {
        for &sample in samples {
            let toned = self.tone.apply(sample * self.exposure);
            let shown = toned.map(|c| linear_to_srgb(c.clamp(0.0, 1.0))).to_array();
            self.ranges[pixel] = self.ranges[pixel].including(&Range { low: shown, high: shown });
        }
    }

    /// Which pixels need the next pass. After the first one, of a single sample, all depends on the neighbours; later a pixel's
    /// own samples tell better, and a neighbour's edge is not its own.
    pub fn unsettled(&self, pass: usize) -> Vec<bool> {
        if pass > 1 {
            return self.ranges.iter().map(|range| range.spread() > THRESHOLD).collect();
        }
        let mut unsettled = vec![false; self.ranges.len()];
        for y in 0..self.height {
            for x in 0..self.width {
                let mut range = Range::EMPTY;
                for ny in y.saturating_sub(1)..(y + 2).min(self.height) {
                    for nx in x.saturating_sub(1)..(x + 2).min(self.width) {
                        range = range.including(&self.ranges[ny * self.width + nx]);
                    }
                }
                unsettled[y * self.width + x] = range.spread() > THRESHOLD;
            }
        }
        unsettled
    }
}

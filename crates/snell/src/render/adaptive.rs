//! Where the picture needs more samples: where a neighbour or another sample of the same pixel looks different.
//!
//! "Different" is judged as the viewer will see it, after exposure and tone and in the sRGB encoding, whose steps are about
//! equally visible. A pixel is unsettled after the first pass where the samples in it and its eight neighbours differ by more
//! than a threshold in any component, and after later ones where its own do: then its own samples tell better, and a neighbour's
//! edge is not its own. Of an edge, n well-spread samples give a mean that is wrong by about an n-th of their range, so that is compared.

use rayon::prelude::*;
use snell_image::Image;
use snell_image::tone::{ToneCurve, exposure_scale};
use snell_image::transfer::EncodedDifference;
use snell_math::Rgb;

use super::settings::RenderSettings;

/// The least error in display values, in [0, 1], that calls for more samples: about eight steps of 255. With more, print that falls
/// between the first samples goes missing.
const THRESHOLD: f32 = 0.03;
/// Rows of a picture that are judged together.
const ROWS: usize = 16;

/// How samples will be shown.
#[derive(Clone, Copy, Debug)]
pub struct Display {
    tone: ToneCurve,
    /// The factor before the tone curve.
    exposure: f32,
    /// What differs too much.
    threshold: EncodedDifference,
}

/// The least and the largest value of some samples, component by component: display-linear and clipped to [0, 1], so before the
/// sRGB encoding.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    low: [f32; 3],
    high: [f32; 3],
}

impl Display {
    /// For pixels of so many samples.
    pub fn new(settings: &RenderSettings, samples: u32) -> Self {
        Self {
            tone: settings.tone_curve(),
            exposure: exposure_scale(settings.exposure),
            threshold: EncodedDifference::new(THRESHOLD * samples as f32),
        }
    }

    /// The range of samples as they are shown.
    pub fn range(&self, samples: &[Rgb]) -> Range {
        samples.iter().fold(Range::EMPTY, |range, &sample| {
            let shown = self.tone.apply(sample * self.exposure).map(|c| c.clamp(0.0, 1.0)).to_array();
            range.including(&Range { low: shown, high: shown })
        })
    }

    /// Whether the values of a range, sRGB-encoded, differ by more than the threshold in any component.
    pub fn is_wide(&self, range: &Range) -> bool {
        (0..3).any(|i| self.threshold.is_exceeded(range.low[i], range.high[i]))
    }
}

impl Range {
    const EMPTY: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    #[inline]
    pub fn including(mut self, other: &Self) -> Self {
        // Written so that NaN changes nothing.
        for i in 0..3 {
            self.low[i] = if other.low[i] < self.low[i] { other.low[i] } else { self.low[i] };
            self.high[i] = if other.high[i] > self.high[i] { other.high[i] } else { self.high[i] };
        }
        self
    }
}

/// Which pixels of a picture of one sample each are unsettled.
pub fn unsettled(picture: &Image<Rgb>, display: &Display) -> Vec<bool> {
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let mut unsettled = vec![false; width * height];
    let row_of = |y: usize| &picture.pixels()[y * width..][..width];
    unsettled.par_chunks_mut((ROWS * width).max(1)).enumerate().for_each(|(part, unsettled)| {
        let first = part * ROWS;
        // The values of three rows at a time, then the range of each column of three pixels, then of three columns.
        let mut shown: Vec<Vec<Range>> = vec![vec![Range::EMPTY; width]; 3];
        let mut columns = vec![Range::EMPTY; width];
        let show = |y: usize, shown: &mut [Vec<Range>]| {
            for (range, sample) in shown[y % 3].iter_mut().zip(row_of(y)) {
                *range = display.range(std::slice::from_ref(sample));
            }
        };
        (first.saturating_sub(1)..=first).for_each(|y| show(y, &mut shown));
        for (y, unsettled) in (first..).zip(unsettled.chunks_mut(width)) {
            if y + 1 < height {
                show(y + 1, &mut shown);
            }
            columns.copy_from_slice(&shown[y % 3]);
            for neighbour in [y.checked_sub(1), (y + 1 < height).then_some(y + 1)].into_iter().flatten() {
                for (column, range) in columns.iter_mut().zip(&shown[neighbour % 3]) {
                    *column = column.including(range);
                }
            }
            for (x, unsettled) in unsettled.iter_mut().enumerate() {
                let neighbours = &columns[x.saturating_sub(1)..(x + 2).min(width)];
                let around = neighbours.iter().fold(Range::EMPTY, |sum, column| sum.including(column));
                *unsettled = display.is_wide(&around);
            }
        }
    });
    unsettled
}

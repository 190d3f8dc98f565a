//! The second pass of adaptive antialiasing: more samples in pixels that the first one left unsettled, until each is settled.

use std::sync::Mutex;

use rayon::prelude::*;
use snell_math::Ray;

use super::adaptive::{self, Display, Range};
use super::{Gathered, Job, MAX_QUEUE, Pixel, Progress, Samples, Tile, TileRays, Worker, lock};
use crate::film::PixelSum;
use crate::geometry::Hit;
use crate::integrator::Integrator;
use crate::observe::NoObserver;
use crate::statistics::Statistics;
use crate::trace::{FirstHitWatch, Scratch};

/// How many pixels are settled together: enough for few queues that are partly full, few enough that none is waited for long.
const PORTION: usize = 512;

/// Samples of the second pass, and what is shown wrong after them.
struct Step {
    samples: Samples,
    display: Display,
}

/// A pixel that needs more samples than those of the first pass.
#[derive(Clone, Copy)]
pub(super) struct Refined {
    pixel: Pixel,
    sum: PixelSum,
    /// Of all its samples.
    range: Range,
}

impl<I: Integrator<State = ()>> Job<'_, I> {
    /// Takes more samples where the picture needs them.
    pub(super) fn refine(
        &self,
        passes: impl Iterator<Item = std::ops::Range<u32>>,
        tiles: &[Tile],
        gathered: &Mutex<Gathered>,
        progress: &dyn Progress,
    ) {
        let width = self.settings.width;
        let unsettled = adaptive::unsettled(&lock(gathered).image, &Display::new(self.settings, 1));
        // In the order of tiles, so that neighbours are traced together.
        let is_unsettled = |pixel: &Pixel| unsettled[pixel.place(width)];
        let pixels: Vec<Pixel> = tiles.par_iter().flat_map_iter(|tile| tile.pixels().filter(is_unsettled)).collect();
        progress.pass(1, pixels.len() as u64);
        let steps: Vec<Step> = passes
            .map(|samples| Step { display: Display::new(self.settings, samples.end), samples: Samples::new(samples) })
            .collect();
        pixels.chunks(PORTION).par_bridge().for_each_init(Box::<Worker>::default, |worker, portion| {
            if !progress.is_cancelled() {
                self.refine_portion(portion, &steps, worker, gathered, progress);
            }
        });
    }

    /// Takes more samples in some pixels, until each is settled.
    fn refine_portion(
        &self,
        portion: &[Pixel],
        steps: &[Step],
        worker: &mut Worker,
        gathered: &Mutex<Gathered>,
        progress: &dyn Progress,
    ) {
        let Some(Step { display, .. }) = steps.first() else { return };
        let width = self.settings.width;
        let Worker { scratch, pixels, refined, .. } = worker;
        refined.clear();
        {
            let image = &lock(gathered).image;
            refined.extend(portion.iter().map(|&pixel| {
                let mean = image.pixels()[pixel.place(width)];
                Refined { pixel, sum: PixelSum::of_one(mean), range: display.range(&[mean]) }
            }));
        }
        let mut statistics = Statistics::default();
        // Those that are still unsettled stand in front.
        let mut open = refined.len();
        for step in steps {
            for part in refined[..open].chunks_mut((MAX_QUEUE / step.samples.places.len()).max(1)) {
                if !progress.is_cancelled() {
                    self.take_samples(part, step, scratch, pixels, &mut statistics);
                }
            }
            let mut kept = 0;
            for place in 0..open {
                if step.display.is_wide(&refined[place].range) {
                    refined.swap(kept, place);
                    kept += 1;
                }
            }
            open = kept;
        }
        let mut gathered = lock(gathered);
        gathered.statistics.merge(&statistics);
        for Refined { pixel, sum, .. } in refined {
            gathered.image.pixels_mut()[pixel.place(width)] = sum.mean();
        }
        drop(gathered);
        progress.advance(portion.len() as u64, statistics.rays());
    }

    /// Takes the samples of a step in some pixels.
    fn take_samples(
        &self,
        refined: &mut [Refined],
        Step { samples, display }: &Step,
        scratch: &mut Scratch,
        pixels: &mut Vec<Pixel>,
        statistics: &mut Statistics,
    ) {
        pixels.clear();
        pixels.extend(refined.iter().map(|refined| refined.pixel));
        let rays = TileRays { camera: self.camera, pixels, samples };
        let mut watch = |_: usize, ray: &Ray, hit: &mut Option<Hit>| self.cut_far(ray, hit);
        let watch: Option<&mut FirstHitWatch<'_>> = if self.has_far_plane() { Some(&mut watch) } else { None };
        let colors = self.tracer().trace(&rays, scratch, statistics, &mut NoObserver, watch);
        for (refined, colors) in refined.iter_mut().zip(colors.chunks_exact(samples.places.len())) {
            for (sample, &color) in (samples.first..).zip(colors) {
                if !refined.sum.add(color) {
                    statistics.add_nonfinite(refined.pixel.sample(sample));
                }
            }
            refined.range = refined.range.including(&display.range(colors));
        }
    }
}

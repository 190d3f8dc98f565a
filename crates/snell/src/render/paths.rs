//! Path tracing, pass by pass: each gives one sample to every pixel that is not finished yet.
//!
//! A pixel is finished when the error of its mean is small enough, where that is asked for; what a pass decides, it decides from the
//! finished passes before, so tiles and threads do not matter. What is kept of a pixel does not grow with its samples.

use std::sync::Mutex;

use rayon::prelude::*;
use snell_image::Image;
use snell_math::lanes::{Lanes, WIDTH};
use snell_math::{Ray, Rgb};
use snell_scene::scene::Shadows;

use super::layers::{FirstHit, FirstHits};
use super::{Job, MAX_QUEUE, Pixel, Progress, RenderSettings, Rendering, Tile, lock, on_threads, spacing};
use crate::camera::Camera;
use crate::compile::CompiledScene;
use crate::differential::RayDifferential;
use crate::film::PixelSum;
use crate::geometry::Hit;
use crate::integrator::{Path, PathSample, PhotonPasses, Purpose, Rules};
use crate::observe::NoObserver;
use crate::statistics::{SamplePlace, Statistics};
use crate::task::{RayRows, set_column};
use crate::trace::{CameraRays, FirstHitWatch, Scratch, Tracer};
use crate::viewing::ViewingError;

/// How long paths are traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSettings {
    /// The most samples of a pixel, from 1.
    pub samples: u32,
    /// A pixel is finished when the standard error of its brightness is below this share of it, or of [`DARK`] where it is darker.
    pub noise: Option<f64>,
    /// The depth of the deepest ray; camera rays have depth 1.
    pub depth: u16,
    /// Light that comes to surfaces through glass and off mirrors is sent out by lights too, and not only looked for.
    pub photons: bool,
    /// What random numbers depend on, besides the pixel, the sample and what they are for.
    pub seed: u32,
}

impl Default for PathSettings {
    fn default() -> Self {
        Self { samples: 64, noise: None, depth: 64, photons: true, seed: 0 }
    }
}

/// Pixels darker than this may have the error of this brightness.
pub const DARK: f64 = 0.05;
/// More samples than these stand for no smaller part of a pixel each, since how many there will be is not always known.
const MANY_SAMPLES: u32 = 64;
/// So many samples are taken before a pixel's error is believed.
const FIRST_SAMPLES: u32 = 16;
/// And so many between one look at the errors and the next.
const SAMPLES_BETWEEN: u32 = 8;

/// Renders a scene by path tracing: see [`Path`].
///
/// The picture depends on the scene and the settings alone, and on how many passes `progress` lets be; not on the number of threads,
/// nor on the size of tiles.
///
/// # Errors
/// [`ViewingError`], where the scene's camera is degenerate.
///
/// ```
/// use snell::compile::CompiledScene;
/// use snell::render::{NoProgress, PathSettings, RenderSettings, render_paths};
/// use snell::scene::scene::{Background, Object, Scene, Shape};
/// use snell::math::{Point3, Rgb};
///
/// // A grey ball in a white world: each point sends on 0.8 of the light.
/// let mut scene = Scene { background: Background::Color(Rgb::WHITE), ..Scene::default() };
/// scene.objects.push(Object::shape(Shape::Sphere { center: Point3::ORIGIN, radius: 1.0 }));
/// let compiled = CompiledScene::build(&scene).unwrap();
/// let settings = RenderSettings { width: 5, height: 5, ..RenderSettings::from(&scene.settings) };
/// let paths = PathSettings { samples: 256, ..PathSettings::default() };
/// let picture = render_paths(&compiled, &settings, &paths, &NoProgress).unwrap().image;
/// assert!((picture.get(2, 2).unwrap().g - 0.8).abs() < 0.02);
/// ```
pub fn render_paths(
    scene: &CompiledScene,
    settings: &RenderSettings,
    paths: &PathSettings,
    progress: &dyn Progress,
) -> Result<Rendering, ViewingError> {
    let camera = settings.camera(scene)?;
    Ok(on_threads(settings, || run_paths(scene, &camera, settings, paths, progress)))
}

/// A pixel, and what its samples have given.
#[derive(Clone, Copy)]
struct Estimate {
    pixel: Pixel,
    sum: PixelSum,
    /// The sum of the squares of its samples' brightness.
    squares: f64,
    is_finished: bool,
}

impl Estimate {
    /// The standard error of the brightness over the brightness.
    fn error(&self) -> f64 {
        let count = f64::from(self.sum.count());
        let mean = brightness(self.sum.mean());
        let variance = ((self.squares / count - mean * mean) * count / (count - 1.0)).max(0.0);
        (variance / count).sqrt() / mean.max(DARK)
    }
}

/// One number for a colour, that cancels nothing.
fn brightness(color: Rgb) -> f64 {
    color.to_array().into_iter().map(|component| f64::from(component.abs())).sum::<f64>() / 3.0
}

/// The camera rays of paths.
pub(super) struct PathRays<'a> {
    camera: &'a Camera,
    pixels: &'a [Pixel],
    /// Where in its pixel each is, and where on the lens.
    places: Vec<[f64; 4]>,
    /// The rays themselves, where they come through a lens; else none.
    through_lens: Vec<Ray>,
    /// How far apart samples are, in pixels.
    spacing: f64,
}

impl CameraRays for PathRays<'_> {
    fn count(&self) -> usize {
        self.pixels.len()
    }

    #[inline(always)]
    fn generate<L: Lanes>(&self, first: usize, rows: &mut RayRows, split: &mut [u32; WIDTH], at: usize) {
        let (mut xs, mut ys) = ([0.0; WIDTH], [0.0; WIDTH]);
        for lane in 0..L::COUNT {
            // Beyond the last one it is the last one again.
            let number = (first + lane).min(self.pixels.len() - 1);
            let (Pixel { x, y }, [dx, dy, ..]) = (self.pixels[number], self.places[number]);
            (xs[lane], ys[lane]) = (f64::from(x) + dx, f64::from(y) + dy);
            // The number of its path.
            split[at + lane] = number as u32;
        }
        if !self.through_lens.is_empty() {
            for lane in 0..L::COUNT {
                let ray = self.through_lens[(first + lane).min(self.pixels.len() - 1)];
                set_column(&mut rows.origin, at + lane, ray.origin.to_array());
                set_column(&mut rows.direction, at + lane, ray.direction.to_array());
            }
            return;
        }
        let [origin, direction] = self.camera.generate_rays(L::load(&xs, 0), L::load(&ys, 0));
        origin.store(&mut rows.origin, at);
        direction.store(&mut rows.direction, at);
    }

    fn differential(&self, number: usize) -> RayDifferential {
        // Also behind a lens: rays through one place of it go apart as those through a small hole do.
        let (Pixel { x, y }, [dx, dy, ..]) = (self.pixels[number], self.places[number]);
        self.camera.ray_differential(f64::from(x) + dx, f64::from(y) + dy, self.spacing)
    }
}

/// The buffers of one worker.
#[derive(Default)]
struct Worker {
    scratch: Scratch,
    pixels: Vec<Pixel>,
    state: Vec<PathSample>,
    first_hits: Vec<FirstHit>,
}

/// The passes of photons for a picture.
pub(super) fn photon_passes(
    integrator: &Path,
    settings: &RenderSettings,
    paths: &PathSettings,
) -> Option<PhotonPasses> {
    let pixels = u64::from(settings.width) * u64::from(settings.height);
    if paths.photons { integrator.photon_passes(paths.seed, pixels) } else { None }
}

fn run_paths(
    scene: &CompiledScene,
    camera: &Camera,
    settings: &RenderSettings,
    paths: &PathSettings,
    progress: &dyn Progress,
) -> Rendering {
    let RenderSettings { width, height, layers, .. } = *settings;
    let mut integrator = Path::new(scene, camera);
    let mut passes = photon_passes(&integrator, settings, paths);
    // In the order of tiles, so that neighbours are traced together.
    let tiles = Job { scene, integrator: &integrator, camera, settings }.tiles();
    let mut estimates: Vec<Estimate> = tiles
        .iter()
        .flat_map(Tile::pixels)
        .map(|pixel| Estimate { pixel, sum: PixelSum::default(), squares: 0.0, is_finished: false })
        .collect();
    let first_hits = Mutex::new(layers.then(|| FirstHits::new(width, height)));
    let mut statistics = Statistics::default();
    let mut finished: Vec<Estimate> = Vec::new();
    for sample in 0..paths.samples {
        if estimates.is_empty() || progress.is_cancelled() || sample > 0 && !progress.wants_more() {
            break;
        }
        progress.pass(sample, estimates.len() as u64);
        if let Some(passes) = &mut passes {
            passes.set_out(sample, &mut integrator, scene);
        }
        let job = Job { scene, integrator: &integrator, camera, settings };
        let counted = estimates
            .chunks_mut(MAX_QUEUE)
            .par_bridge()
            .map_init(Box::<Worker>::default, |worker, portion| {
                job.trace_portion(portion, paths, sample, worker, &first_hits, progress)
            })
            .reduce(Statistics::default, |mut sum, part| {
                sum.merge(&part);
                sum
            });
        statistics.merge(&counted);
        let taken = sample + 1;
        if let Some(noise) = paths.noise
            && taken >= FIRST_SAMPLES
            && (taken - FIRST_SAMPLES).is_multiple_of(SAMPLES_BETWEEN)
        {
            finish(&mut estimates, noise, [width, height]);
            finished.extend(estimates.iter().filter(|estimate| estimate.is_finished));
            estimates.retain(|estimate| !estimate.is_finished);
        }
    }
    let mut image = Image::filled(width, height, Rgb::BLACK);
    for Estimate { pixel, sum, .. } in finished.iter().chain(&estimates) {
        image.pixels_mut()[pixel.place(width)] = sum.mean();
    }
    let first_hits = first_hits.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
    let layers = first_hits.map(FirstHits::into_layers);
    Rendering { image, layers, statistics, complete: !progress.is_cancelled() }
}

impl Job<'_, Path> {
    /// What traces paths. Glass blocks straight ways to lights: light comes through it by refraction.
    pub(super) fn path_tracer(&self, paths: &PathSettings) -> Tracer<'_, Path> {
        let rules = Rules { depth: paths.depth, min_weight: 0.0, weightless_rays: false, shadows: Shadows::Opaque };
        Tracer { scene: self.scene, integrator: self.integrator, rules, instructions: self.settings.instructions }
    }

    /// The paths of a sample of some pixels: their states, and their rays.
    pub(super) fn begin_paths<'a>(
        &'a self,
        pixels: &'a [Pixel],
        paths: &PathSettings,
        sample: u32,
        state: &mut Vec<PathSample>,
    ) -> PathRays<'a> {
        state.clear();
        state.extend(pixels.iter().map(|pixel| self.integrator.begin(paths.seed, [pixel.x, pixel.y], sample)));
        let places: Vec<[f64; 4]> = state.iter().map(|path| path.draw(Purpose::Camera)).collect();
        let through_lens = pixels.iter().zip(&places).zip(state);
        let through_lens = through_lens.filter_map(|((&Pixel { x, y }, &[dx, dy, u, v]), path)| {
            self.integrator.begin_behind_lens([f64::from(x) + dx, f64::from(y) + dy], [u, v], path)
        });
        let spacing = spacing(paths.samples.min(MANY_SAMPLES));
        PathRays { camera: self.camera, pixels, through_lens: through_lens.collect(), places, spacing }
    }

    /// Takes one sample in some pixels.
    fn trace_portion(
        &self,
        portion: &mut [Estimate],
        paths: &PathSettings,
        sample: u32,
        worker: &mut Worker,
        all_first_hits: &Mutex<Option<FirstHits>>,
        progress: &dyn Progress,
    ) -> Statistics {
        let mut statistics = Statistics::default();
        if progress.is_cancelled() {
            return statistics;
        }
        let Worker { scratch, pixels, state, first_hits } = worker;
        pixels.clear();
        pixels.extend(portion.iter().map(|estimate| estimate.pixel));
        let rays = self.begin_paths(pixels, paths, sample, state);
        let wants_layers = self.settings.layers && sample == 0;
        first_hits.clear();
        let mut watch = |_: usize, ray: &Ray, hit: &mut Option<Hit>| {
            self.cut_far(ray, hit);
            if wants_layers {
                first_hits.push(FirstHit::new(self.scene, self.camera, ray, hit.as_ref()));
            }
        };
        let is_watched = wants_layers || self.has_far_plane();
        let watch: Option<&mut FirstHitWatch<'_>> = if is_watched { Some(&mut watch) } else { None };
        let colors = self.path_tracer(paths).trace_with(&rays, state, scratch, &mut statistics, &mut NoObserver, watch);
        for (estimate, &color) in portion.iter_mut().zip(colors) {
            if estimate.sum.add(color) {
                let brightness = brightness(color);
                estimate.squares += brightness * brightness;
            } else {
                let Pixel { x, y } = estimate.pixel;
                statistics.add_nonfinite(SamplePlace { y, x, sample });
            }
        }
        if wants_layers && let Some(all) = &mut *lock(all_first_hits) {
            for (pixel, first) in pixels.iter().zip(first_hits.drain(..)) {
                all.set(pixel.place(self.settings.width), first);
            }
        }
        progress.advance(portion.len() as u64, statistics.rays());
        statistics
    }
}

/// Marks the pixels whose error is small enough, and that of their neighbours.
fn finish(estimates: &mut [Estimate], noise: f64, [width, height]: [u32; 2]) {
    let mut is_noisy = vec![false; width as usize * height as usize];
    for estimate in estimates.iter() {
        is_noisy[estimate.pixel.place(width)] = estimate.error() > noise;
    }
    for estimate in estimates {
        let Pixel { x, y } = estimate.pixel;
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        let columns = x.saturating_sub(1)..(x + 2).min(width);
        estimate.is_finished =
            rows.into_iter().all(|y| columns.clone().all(|x| !is_noisy[Pixel { x, y }.place(width)]));
    }
}

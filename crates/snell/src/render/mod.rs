//! The main loop: passes over tiles, in parallel, with progress and cancelling.
//!
//! A first pass gives every pixel its first samples. With adaptive antialiasing, a second one gives more to those pixels whose
//! neighbourhood differs, and again more where a pixel's own samples do, always the next ones of the same fixed sequence. The
//! second pass decides from the finished first one, and then for each pixel by itself, so tiles and threads do not matter.

mod adaptive;
mod layers;
mod paths;
mod refine;
mod settings;
#[cfg(test)]
mod tests;
mod warnings;
mod watch;

use std::sync::Mutex;

use rayon::prelude::*;
use snell_image::{Image, Layers};
use snell_math::lanes::{Lanes, WIDTH};
use snell_math::{Ray, Rgb, sampling};

pub use paths::{DARK, PathSettings, render_paths};
pub use settings::RenderSettings;
pub use warnings::warnings;
pub use watch::{Watch, explain, explain_path};

use crate::camera::Camera;
use crate::compile::CompiledScene;
use crate::differential::RayDifferential;
use crate::film::{self, PixelSum};
use crate::geometry::Hit;
use crate::integrator::{Integrator, Rules};
use crate::observe::NoObserver;
use crate::render::layers::{FirstHit, FirstHits};
use crate::render::refine::Refined;
use crate::statistics::{SamplePlace, Statistics};
use crate::task::RayRows;
use crate::trace::{CameraRays, FirstHitWatch, Scratch, Tracer};
use crate::viewing::ViewingError;

/// Told how far rendering is, and asked whether to go on. Called from several threads.
pub trait Progress: Sync {
    /// A pass begins, of that many pixels.
    fn pass(&self, number: u32, pixels: u64) {
        let _ = (number, pixels);
    }
    /// Pixels of this pass were finished.
    fn advance(&self, pixels: u64, rays: u64) {
        let _ = (pixels, rays);
    }
    /// Asked after each pass of path tracing: whether another one is wanted. What there is counts as complete where it is not.
    fn wants_more(&self) -> bool {
        true
    }
    /// True where the rest is not wanted any more.
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// Watches nothing and never cancels.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoProgress;

impl Progress for NoProgress {}

/// A rendered picture.
#[derive(Clone, Debug)]
pub struct Rendering {
    /// Scene-linear colours.
    pub image: Image<Rgb>,
    /// Depth, normal and object of each pixel, where asked for.
    pub layers: Option<Layers>,
    /// What was counted.
    pub statistics: Statistics,
    /// False where it was cancelled: pixels without a sample are black.
    pub complete: bool,
}

/// Renders a scene by recursive ray tracing.
///
/// The picture depends on the scene and the settings alone: not on the number of threads, nor on the size of tiles.
///
/// # Errors
/// [`ViewingError`], where the scene's camera is degenerate.
///
/// ```
/// use snell::compile::CompiledScene;
/// use snell::render::{NoProgress, RenderSettings, render};
/// use snell::scene::scene::{Antialiasing, Object, Scene, Shape};
/// use snell::math::{Point3, Rgb};
///
/// let mut scene = Scene { ambient: Rgb::WHITE, ..Scene::default() };
/// scene.objects.push(Object::shape(Shape::Sphere { center: Point3::ORIGIN, radius: 1.0 }));
/// let compiled = CompiledScene::build(&scene).unwrap();
/// let antialiasing = Antialiasing::None;
/// let settings = RenderSettings { width: 15, height: 7, antialiasing, ..RenderSettings::from(&scene.settings) };
/// let picture = render(&compiled, &settings, &NoProgress).unwrap().image;
/// let rows: Vec<String> = (0..7)
///     .map(|y| (0..15).map(|x| if picture.get(x, y).is_some_and(|color| color.r > 0.35) { '#' } else { '.' }).collect())
///     .collect();
/// assert_eq!(rows, [
///     ".....#####.....",
///     "....#######....",
///     "...#########...",
///     "...#########...",
///     "...#########...",
///     "....#######....",
///     ".....#####.....",
/// ]);
/// ```
pub fn render(
    scene: &CompiledScene,
    settings: &RenderSettings,
    progress: &dyn Progress,
) -> Result<Rendering, ViewingError> {
    let camera = settings.camera(scene)?;
    let integrator = settings.integrator(scene, &camera);
    let job = Job { scene, integrator: &integrator, camera: &camera, settings };
    Ok(on_threads(settings, || job.run(progress)))
}

/// Does some work in a pool of its own where a number of threads is asked for; else in that of the process, with a thread for every
/// core.
fn on_threads<T: Send>(settings: &RenderSettings, work: impl FnOnce() -> T + Send) -> T {
    match settings.threads.map(|threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build()) {
        Some(Ok(pool)) => pool.install(work),
        _ => work(),
    }
}

/// One rendering: what every tile needs.
struct Job<'a, I> {
    scene: &'a CompiledScene,
    integrator: &'a I,
    camera: &'a Camera,
    settings: &'a RenderSettings,
}

/// The samples that a pass takes in each of its pixels.
struct Samples {
    /// The first one's place in the sequence.
    first: u32,
    /// Where in the pixel they are.
    places: Vec<[f64; 2]>,
    /// How far apart, in pixels: the side of the square that each stands for.
    spacing: f64,
}

impl Samples {
    fn new(numbers: std::ops::Range<u32>) -> Self {
        let spacing = spacing(numbers.end);
        Self { first: numbers.start, places: numbers.map(sampling::pixel_sample).collect(), spacing }
    }
}

/// How far apart samples of a pixel are, in pixels, where it has so many.
fn spacing(samples: u32) -> f64 {
    1.0 / f64::from(samples.max(1)).sqrt()
}

/// A pixel of the picture; (0, 0) is the one at the top left.
#[derive(Clone, Copy)]
struct Pixel {
    x: u32,
    y: u32,
}

impl Pixel {
    /// Its place in rows from the top.
    fn place(self, width: u32) -> usize {
        self.y as usize * width as usize + self.x as usize
    }

    /// One of its samples.
    fn sample(self, sample: u32) -> SamplePlace {
        SamplePlace { y: self.y, x: self.x, sample }
    }
}

/// The camera rays of some pixels, sample by sample in each.
struct TileRays<'a> {
    camera: &'a Camera,
    pixels: &'a [Pixel],
    samples: &'a Samples,
}

impl CameraRays for TileRays<'_> {
    fn count(&self) -> usize {
        self.pixels.len() * self.samples.places.len()
    }

    #[inline(always)]
    fn generate<L: Lanes>(&self, first: usize, rows: &mut RayRows, split: &mut [u32; WIDTH], at: usize) {
        let (mut xs, mut ys) = ([0.0; WIDTH], [0.0; WIDTH]);
        let per_pixel = self.samples.places.len();
        let (mut pixel, mut sample) = if per_pixel == 1 { (first, 0) } else { (first / per_pixel, first % per_pixel) };
        for lane in 0..L::COUNT {
            // Beyond the last one it is the last one again.
            let Pixel { x, y } = self.pixels[pixel.min(self.pixels.len() - 1)];
            let [dx, dy] = self.samples.places[sample];
            (xs[lane], ys[lane]) = (f64::from(x) + dx, f64::from(y) + dy);
            split[at + lane] = split_place([x, y], self.samples.first + sample as u32);
            sample += 1;
            if sample == per_pixel {
                (pixel, sample) = (pixel + 1, 0);
            }
        }
        let [origin, direction] = self.camera.generate_rays(L::load(&xs, 0), L::load(&ys, 0));
        origin.store(&mut rows.origin, at);
        direction.store(&mut rows.direction, at);
    }

    fn differential(&self, number: usize) -> RayDifferential {
        let Samples { places, spacing, .. } = self.samples;
        let (Pixel { x, y }, [dx, dy]) = (self.pixels[number / places.len()], places[number % places.len()]);
        self.camera.ray_differential(f64::from(x) + dx, f64::from(y) + dy, *spacing)
    }
}

/// The number of the place where a sample of a pixel splits white light.
#[inline]
fn split_place([x, y]: [u32; 2], sample: u32) -> u32 {
    // Neighbours begin at different places, so that what one sample alone cannot show, a few of them show together.
    BAYER[y as usize % 4][x as usize % 4] + sample
}

/// What the tiles have given so far.
struct Gathered {
    /// The mean of the samples of each pixel.
    image: Image<Rgb>,
    first_hits: Option<FirstHits>,
    statistics: Statistics,
}

/// The buffers of one worker. To be kept in a box where it is handed from one piece of work to the next, since it is large.
#[derive(Default)]
struct Worker {
    scratch: Scratch,
    pixels: Vec<Pixel>,
    means: Vec<Rgb>,
    first_hits: Vec<FirstHit>,
    refined: Vec<Refined>,
}

impl<I: Integrator<State = ()>> Job<'_, I> {
    fn run(&self, progress: &dyn Progress) -> Rendering {
        let RenderSettings { width, height, .. } = *self.settings;
        let mut passes = self.settings.passes().into_iter();
        let gathered = Mutex::new(Gathered {
            image: Image::filled(width, height, Rgb::BLACK),
            first_hits: self.settings.layers.then(|| FirstHits::new(width, height)),
            statistics: Statistics::default(),
        });
        let tiles = self.tiles();
        let samples = Samples::new(passes.next().unwrap_or(0..1));
        progress.pass(0, u64::from(width) * u64::from(height));
        // One after the other, whichever thread is free: some tiles take much longer than others.
        tiles.iter().par_bridge().for_each_init(Box::<Worker>::default, |worker, tile| {
            if !progress.is_cancelled() {
                self.render_tile(tile, &samples, worker, &gathered, progress);
            }
        });
        if self.settings.is_adaptive() && !progress.is_cancelled() {
            self.refine(passes, &tiles, &gathered, progress);
        }
        let Gathered { image, first_hits, statistics } =
            gathered.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
        let layers = first_hits.map(FirstHits::into_layers);
        Rendering { image, layers, statistics, complete: !progress.is_cancelled() }
    }

    /// Takes the samples of the first pass in the pixels of a tile.
    fn render_tile(
        &self,
        tile: &Tile,
        samples: &Samples,
        worker: &mut Worker,
        gathered: &Mutex<Gathered>,
        progress: &dyn Progress,
    ) {
        let per_pixel = samples.places.len();
        let Worker { scratch, pixels, means, first_hits, .. } = worker;
        tile.list(pixels);
        means.clear();
        first_hits.clear();
        let mut statistics = Statistics::default();
        // As many pixels at once as keep the queues in the caches.
        for pixels in pixels.chunks((MAX_QUEUE / per_pixel).max(1)) {
            if progress.is_cancelled() {
                break;
            }
            let rays = TileRays { camera: self.camera, pixels, samples };
            let mut watch = |number: usize, ray: &Ray, hit: &mut Option<Hit>| {
                self.cut_far(ray, hit);
                if self.settings.layers && number.is_multiple_of(per_pixel) {
                    first_hits.push(FirstHit::new(self.scene, self.camera, ray, hit.as_ref()));
                }
            };
            let is_watched = self.settings.layers || self.has_far_plane();
            let watch: Option<&mut FirstHitWatch<'_>> = if is_watched { Some(&mut watch) } else { None };
            let colors = self.tracer().trace(&rays, scratch, &mut statistics, &mut NoObserver, watch);
            let place = |pixel: Pixel, sample: usize| pixel.sample(samples.first + sample as u32);
            if per_pixel == 1 {
                if !film::means_of_ones(colors, means) {
                    let broken = colors.iter().zip(pixels).filter(|(color, _)| !color.is_finite());
                    broken.for_each(|(_, &pixel)| statistics.add_nonfinite(place(pixel, 0)));
                }
                continue;
            }
            means.extend(colors.chunks_exact(per_pixel).zip(pixels).map(|(colors, &pixel)| {
                let mut sum = PixelSum::default();
                for (sample, &color) in colors.iter().enumerate() {
                    if !sum.add(color) {
                        statistics.add_nonfinite(place(pixel, sample));
                    }
                }
                sum.mean()
            }));
        }
        let mut gathered = lock(gathered);
        gathered.statistics.merge(&statistics);
        tile.put(means, &mut gathered.image);
        if let Some(all) = &mut gathered.first_hits {
            for (&pixel, first) in pixels.iter().zip(first_hits.drain(..)) {
                all.set(pixel.place(self.settings.width), first);
            }
        }
        drop(gathered);
        progress.advance(pixels.len() as u64, statistics.rays());
    }

    /// The ray of a sample through a place in a pixel, and the number of the place where it splits white light.
    #[inline]
    fn camera_sample(&self, [x, y]: [u32; 2], [dx, dy]: [f64; 2], number: u32) -> (Ray, u32) {
        let ray = self.camera.generate_ray(f64::from(x) + dx, f64::from(y) + dy);
        (ray, split_place([x, y], number))
    }
}

impl<I: Integrator> Job<'_, I> {
    fn has_far_plane(&self) -> bool {
        self.camera.planes()[1] > f64::NEG_INFINITY
    }

    /// What lies beyond the far plane is not there.
    fn cut_far(&self, ray: &Ray, hit: &mut Option<Hit>) {
        let far = self.camera.far_distance(ray);
        *hit = hit.filter(|hit| hit.t <= far);
    }

    fn tracer(&self) -> Tracer<'_, I> {
        let RenderSettings { depth, min_weight, weightless_rays, shadows, instructions, .. } = *self.settings;
        let rules = Rules { depth, min_weight, weightless_rays, shadows };
        Tracer { scene: self.scene, integrator: self.integrator, rules, instructions }
    }

    /// The picture in square tiles.
    fn tiles(&self) -> Vec<Tile> {
        let RenderSettings { width, height, tile_size, .. } = *self.settings;
        let size = tile_size.max(1);
        let mut tiles = Vec::new();
        for top in (0..height).step_by(size as usize) {
            for left in (0..width).step_by(size as usize) {
                let rows = top..top.saturating_add(size).min(height);
                let columns = left..left.saturating_add(size).min(width);
                tiles.push(Tile { rows, columns });
            }
        }
        tiles
    }
}

/// A part of the picture that is rendered by one thread.
struct Tile {
    rows: std::ops::Range<u32>,
    columns: std::ops::Range<u32>,
}

impl Tile {
    /// Its pixels, row by row from the top.
    fn pixels(&self) -> impl Iterator<Item = Pixel> {
        let columns = self.columns.clone();
        self.rows.clone().flat_map(move |y| columns.clone().map(move |x| Pixel { x, y }))
    }

    /// The same, in place of what is in the list.
    fn list(&self, pixels: &mut Vec<Pixel>) {
        pixels.clear();
        for y in self.rows.clone() {
            pixels.extend(self.columns.clone().map(|x| Pixel { x, y }));
        }
    }

    /// Puts its colours, or as many of the first as there are, into the picture.
    fn put(&self, colors: &[Rgb], image: &mut Image<Rgb>) {
        let width = image.width() as usize;
        for (y, colors) in self.rows.clone().zip(colors.chunks(self.columns.len())) {
            let first = y as usize * width + self.columns.start as usize;
            image.pixels_mut()[first..][..colors.len()].copy_from_slice(colors);
        }
    }
}

/// The order of ordered dithering in four by four pixels (Bayer 1973): neighbours are far apart in it.
const BAYER: [[u32; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];

/// The longest queue of camera rays at once.
const MAX_QUEUE: usize = 1024;

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    // A panic in another tile is passed on by rayon; what was gathered is still whole.
    mutex.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

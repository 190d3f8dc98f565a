//! One pixel, sample or ray at a time, watched, by the code and the settings that render the picture.

use snell_image::Image;
use snell_math::lanes::{Lanes, WIDTH};
use snell_math::{Ray, Rgb, sampling};

use super::adaptive::{self, Display};
use super::paths::photon_passes;
use super::{Job, PathSettings, Pixel, RenderSettings, spacing, split_place};
use crate::camera::Camera;
use crate::compile::CompiledScene;
use crate::differential::RayDifferential;
use crate::film::PixelSum;
use crate::geometry::Hit;
use crate::integrator::{Path, PathSample, PhotonPasses, Purpose, Whitted};
use crate::observe::{NoObserver, Observer, RayTree};
use crate::statistics::Statistics;
use crate::task::{Band, RayRows};
use crate::trace::{CameraRays, Scratch};
use crate::viewing::ViewingError;

/// A picture whose rays can be watched.
#[derive(Debug)]
pub struct Watch<'a> {
    /// The scene.
    pub scene: &'a CompiledScene,
    /// How its picture is rendered.
    pub settings: &'a RenderSettings,
    camera: Camera,
    engine: Engine,
    /// See [`Term`](crate::task::Term).
    light_names: Vec<String>,
}

/// What renders it.
#[derive(Debug)]
enum Engine {
    Whitted(Box<Whitted>),
    Path(Box<PathEngine>),
}

/// Path tracing, with the photons of one sample of all pixels.
#[derive(Debug)]
struct PathEngine {
    integrator: Path,
    settings: PathSettings,
    passes: Option<PhotonPasses>,
    /// Which sample the photons are of; `None` before there are any.
    ready: Option<u32>,
}

impl<'a> Watch<'a> {
    /// Of a scene's picture as [`render`](super::render) makes it.
    ///
    /// # Errors
    /// [`ViewingError`], where the scene's camera is degenerate.
    pub fn new(scene: &'a CompiledScene, settings: &'a RenderSettings) -> Result<Self, ViewingError> {
        let camera = settings.camera(scene)?;
        let engine = Engine::Whitted(Box::new(settings.integrator(scene, &camera)));
        Ok(Self { scene, settings, camera, engine, light_names: scene.light_names.clone() })
    }

    /// Of a scene's picture as [`render_paths`](super::render_paths) makes it, without its target of noise.
    ///
    /// # Errors
    /// [`ViewingError`], where the scene's camera is degenerate.
    pub fn paths(
        scene: &'a CompiledScene,
        settings: &'a RenderSettings,
        paths: &PathSettings,
    ) -> Result<Self, ViewingError> {
        let camera = settings.camera(scene)?;
        let integrator = Path::new(scene, &camera);
        let light_names = integrator.light_names(scene);
        let passes = photon_passes(&integrator, settings, paths);
        let engine = Engine::Path(Box::new(PathEngine { integrator, settings: *paths, passes, ready: None }));
        Ok(Self { scene, settings, camera, engine, light_names })
    }

    /// True where paths are traced.
    pub fn is_path(&self) -> bool {
        matches!(self.engine, Engine::Path(_))
    }

    /// The name of a light, by its number in terms; empty where there is none of that number.
    pub fn light_name(&self, number: u32) -> &str {
        self.light_names.get(number as usize).map_or("", String::as_str)
    }

    /// The names of all lights, by their numbers in terms.
    pub fn light_names(&self) -> &[String] {
        &self.light_names
    }

    /// How many samples a pixel has at most where each of them has photons of its own, and is to be made [ready](Self::ready) for; `None`
    /// where all can be traced at any time.
    pub fn passes(&self) -> Option<u32> {
        match &self.engine {
            Engine::Whitted(_) => None,
            Engine::Path(paths) => Some(paths.settings.samples),
        }
    }

    /// Makes ready for samples of a number: with paths, their photons set out.
    pub fn ready(&mut self, number: u32) {
        let Engine::Path(paths) = &mut self.engine else { return };
        if paths.ready == Some(number) {
            return;
        }
        if let Some(passes) = &mut paths.passes {
            passes.set_out(number, &mut paths.integrator, self.scene);
        }
        paths.ready = Some(number);
    }

    /// The picture's camera.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The wavelength that stands for a band, in nanometres.
    pub fn wavelength_nm(&self, band: Band) -> Option<f64> {
        match &self.engine {
            Engine::Whitted(integrator) => integrator.wavelength_nm(band),
            Engine::Path(_) => None,
        }
    }

    /// Where in its pixel a sample is: both in [0, 1), from the upper left corner.
    pub fn sample_place(&self, pixel: [u32; 2], number: u32) -> [f64; 2] {
        match &self.engine {
            Engine::Whitted(_) => sampling::pixel_sample(number),
            Engine::Path(paths) => {
                let [x, y, ..] = paths.begin(pixel, number).draw(Purpose::Camera);
                [x, y]
            }
        }
    }

    /// Traces one sample of a pixel and gives its colour, which may be no number; see [`Self::samples`].
    pub fn sample<O: Observer>(&self, pixel: [u32; 2], number: u32, scratch: &mut Scratch, observer: &mut O) -> Rgb {
        self.samples(&[(pixel, number)], scratch, observer)[0]
    }

    /// Traces one sample of a pixel and remembers everything.
    fn tree(&mut self, pixel: [u32; 2], number: u32) -> RayTree {
        let mut tree = RayTree::default();
        self.ready(number);
        self.sample(pixel, number, &mut Scratch::default(), &mut tree);
        tree
    }

    /// Traces samples, each of a pixel, together; gives their colours. Of paths, all have the number that the watch is
    /// [ready](Self::ready) for.
    pub fn samples<'s, O: Observer>(
        &self,
        samples: &[([u32; 2], u32)],
        scratch: &'s mut Scratch,
        observer: &mut O,
    ) -> &'s [Rgb] {
        let mut statistics = Statistics::default();
        match &self.engine {
            Engine::Whitted(integrator) => {
                let job = self.job(&**integrator);
                let ray = |&(pixel, number): &([u32; 2], u32)| {
                    job.camera_sample(pixel, self.sample_place(pixel, number), number)
                };
                let rays = WatchedRays { job: &job, samples, rays: samples.iter().map(ray).collect() };
                let mut to_far = |_: usize, ray: &Ray, hit: &mut Option<Hit>| job.cut_far(ray, hit);
                job.tracer().trace(&rays, scratch, &mut statistics, observer, Some(&mut to_far))
            }
            Engine::Path(paths) => {
                let job = self.job(&paths.integrator);
                debug_assert!(samples.iter().all(|(_, number)| paths.ready == Some(*number)), "made ready for them");
                let pixels: Vec<Pixel> = samples.iter().map(|&([x, y], _)| Pixel { x, y }).collect();
                let number = samples.first().map_or(0, |(_, number)| *number);
                let mut state = Vec::new();
                let rays = job.begin_paths(&pixels, &paths.settings, number, &mut state);
                let mut to_far = |_: usize, ray: &Ray, hit: &mut Option<Hit>| job.cut_far(ray, hit);
                let tracer = job.path_tracer(&paths.settings);
                tracer.trace_with(&rays, &mut state, scratch, &mut statistics, observer, Some(&mut to_far))
            }
        }
    }

    /// Traces a ray as if it came from the camera, with the random numbers of that sample of the first pixel; its direction has unit
    /// length. The watch is [ready](Self::ready) for the sample.
    pub fn ray<O: Observer>(&self, ray: Ray, number: u32, scratch: &mut Scratch, observer: &mut O) -> Rgb {
        let mut statistics = Statistics::default();
        match &self.engine {
            Engine::Whitted(integrator) => {
                let rays = [(ray, split_place([0, 0], number))];
                self.job(&**integrator).tracer().trace(rays.as_slice(), scratch, &mut statistics, observer, None)[0]
            }
            Engine::Path(paths) => {
                let mut state = vec![paths.begin([0, 0], number)];
                let rays = [(ray, 0)];
                let tracer = self.job(&paths.integrator);
                let tracer = tracer.path_tracer(&paths.settings);
                tracer.trace_with(rays.as_slice(), &mut state, scratch, &mut statistics, observer, None)[0]
            }
        }
    }

    /// How many samples the picture has in a pixel: with adaptive antialiasing, what its neighbourhood and its own samples ask for.
    pub fn sample_count(&self, [x, y]: [u32; 2], scratch: &mut Scratch) -> u32 {
        if let Some(samples) = self.passes() {
            return samples;
        }
        let settings = self.settings;
        let mut count = 0;
        for (number, pass) in settings.passes().into_iter().enumerate() {
            let goes_on = match number {
                0 => true,
                1 => self.is_unsettled([x, y], scratch),
                _ => {
                    let samples: Vec<_> = (0..count).map(|sample| ([x, y], sample)).collect();
                    let display = Display::new(settings, count);
                    // The first pass keeps a mean, which is what the range begins with.
                    let colors = self.samples(&samples, scratch, &mut NoObserver);
                    let mut range = display.range(&[PixelSum::mean_of_one(colors[0]).0]);
                    range = range.including(&display.range(&colors[1..]));
                    display.is_wide(&range)
                }
            };
            if !goes_on {
                break;
            }
            count = pass.end;
        }
        count
    }

    /// Whether the first pass leaves a pixel unsettled, by the first samples of it and of its neighbours.
    fn is_unsettled(&self, [x, y]: [u32; 2], scratch: &mut Scratch) -> bool {
        let RenderSettings { width, height, .. } = *self.settings;
        let (left, top) = (x.saturating_sub(1), y.saturating_sub(1));
        let columns = left..(x + 2).min(width);
        let rows = top..(y + 2).min(height);
        let size = (columns.end - left, rows.end - top);
        let samples: Vec<_> = rows.flat_map(|y| columns.clone().map(move |x| ([x, y], 0))).collect();
        let colors = self.samples(&samples, scratch, &mut NoObserver);
        let mut around = Image::filled(size.0, size.1, Rgb::BLACK);
        for (pixel, &color) in around.pixels_mut().iter_mut().zip(colors) {
            *pixel = PixelSum::mean_of_one(color).0;
        }
        let unsettled = adaptive::unsettled(&around, &Display::new(self.settings, 1));
        unsettled[((y - top) * size.0 + (x - left)) as usize]
    }

    fn job<'b, I>(&'b self, integrator: &'b I) -> Job<'b, I> {
        Job { scene: self.scene, integrator, camera: &self.camera, settings: self.settings }
    }
}

impl PathEngine {
    fn begin(&self, pixel: [u32; 2], number: u32) -> PathSample {
        self.integrator.begin(self.settings.seed, pixel, number)
    }
}

/// The camera rays of some samples of the lecture's picture.
struct WatchedRays<'a> {
    job: &'a Job<'a, Whitted>,
    samples: &'a [([u32; 2], u32)],
    rays: Vec<(Ray, u32)>,
}

impl CameraRays for WatchedRays<'_> {
    fn count(&self) -> usize {
        self.rays.len()
    }

    #[inline(always)]
    fn generate<L: Lanes>(&self, first: usize, rows: &mut RayRows, split: &mut [u32; WIDTH], at: usize) {
        self.rays.as_slice().generate::<L>(first, rows, split, at);
    }

    fn differential(&self, number: usize) -> RayDifferential {
        let ([x, y], sample) = self.samples[number];
        let [dx, dy] = sampling::pixel_sample(sample);
        let Job { camera, settings, .. } = self.job;
        camera.ray_differential(f64::from(x) + dx, f64::from(y) + dy, spacing(settings.pass_of(sample).end))
    }
}

/// Traces one sample of one pixel with the code that renders it, and remembers everything.
///
/// # Errors
/// [`ViewingError`], where the scene's camera is degenerate.
pub fn explain(
    scene: &CompiledScene,
    settings: &RenderSettings,
    pixel: [u32; 2],
    sample: u32,
) -> Result<RayTree, ViewingError> {
    Ok(Watch::new(scene, settings)?.tree(pixel, sample))
}

/// As [`explain`], of a picture whose paths are traced.
///
/// # Errors
/// [`ViewingError`], where the scene's camera is degenerate.
pub fn explain_path(
    scene: &CompiledScene,
    settings: &RenderSettings,
    paths: &PathSettings,
    pixel: [u32; 2],
    sample: u32,
) -> Result<RayTree, ViewingError> {
    Ok(Watch::paths(scene, settings, paths)?.tree(pixel, sample))
}

//! One pixel, sample or ray at a time, watched, by the code and the settings that render the picture.

use snell_image::Image;
use snell_math::{Ray, Rgb, sampling};

use super::adaptive::{self, Display};
use super::{Job, RenderSettings, split_place};
use crate::camera::Camera;
use crate::compile::CompiledScene;
use crate::film::PixelSum;
use crate::geometry::Hit;
use crate::integrator::Whitted;
use crate::observe::{NoObserver, Observer, RayTree};
use crate::statistics::Statistics;
use crate::task::Band;
use crate::trace::Scratch;
use crate::viewing::ViewingError;

/// A picture whose rays can be watched.
#[derive(Debug)]
pub struct Watch<'a> {
    /// The scene.
    pub scene: &'a CompiledScene,
    /// How its picture is rendered.
    pub settings: &'a RenderSettings,
    camera: Camera,
    integrator: Whitted,
}

impl<'a> Watch<'a> {
    /// Of a scene's picture.
    ///
    /// # Errors
    /// [`ViewingError`], where the scene's camera is degenerate.
    pub fn new(scene: &'a CompiledScene, settings: &'a RenderSettings) -> Result<Self, ViewingError> {
        let camera = settings.camera(scene)?;
        let integrator = settings.integrator(scene, &camera);
        Ok(Self { scene, settings, camera, integrator })
    }

    /// The picture's camera.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The wavelength that stands for a band, in nanometres.
    pub fn wavelength_nm(&self, band: Band) -> Option<f64> {
        self.integrator.wavelength_nm(band)
    }

    /// Where in its pixel a sample is: both in [0, 1), from the upper left corner.
    pub fn sample_place(number: u32) -> [f64; 2] {
        sampling::pixel_sample(number)
    }

    /// Traces one sample of a pixel and gives its colour, which may be no number.
    pub fn sample<O: Observer>(&self, pixel: [u32; 2], number: u32, scratch: &mut Scratch, observer: &mut O) -> Rgb {
        self.samples(&[(pixel, number)], scratch, observer)[0]
    }

    /// Traces samples, each of a pixel, together; gives their colours.
    pub fn samples<'s, O: Observer>(
        &self,
        samples: &[([u32; 2], u32)],
        scratch: &'s mut Scratch,
        observer: &mut O,
    ) -> &'s [Rgb] {
        let job = self.job();
        let ray = |&(pixel, number): &([u32; 2], u32)| job.camera_sample(pixel, Self::sample_place(number), number);
        let rays: Vec<(Ray, u32)> = samples.iter().map(ray).collect();
        let mut to_far = |_: usize, ray: &Ray, hit: &mut Option<Hit>| job.cut_far(ray, hit);
        let mut statistics = Statistics::default();
        job.tracer().trace(rays.as_slice(), scratch, &mut statistics, observer, Some(&mut to_far))
    }

    /// Traces a ray as if it came from the camera; its direction has unit length.
    pub fn ray<O: Observer>(&self, ray: Ray, scratch: &mut Scratch, observer: &mut O) -> Rgb {
        let rays = [(ray, split_place([0, 0], 0))];
        self.job().tracer().trace(rays.as_slice(), scratch, &mut Statistics::default(), observer, None)[0]
    }

    /// How many samples the picture has in a pixel: with adaptive antialiasing, what its neighbourhood and its own samples ask for.
    pub fn sample_count(&self, [x, y]: [u32; 2], scratch: &mut Scratch) -> u32 {
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

    fn job(&self) -> Job<'_, Whitted> {
        Job { scene: self.scene, integrator: &self.integrator, camera: &self.camera, settings: self.settings }
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
    let mut tree = RayTree::default();
    Watch::new(scene, settings)?.sample(pixel, sample, &mut Scratch::default(), &mut tree);
    Ok(tree)
}

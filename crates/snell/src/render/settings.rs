//! How a picture is to be rendered: the scene's own settings, and what only the one who renders knows.

use std::ops::Range;

use snell_image::tone::ToneCurve;
use snell_math::lanes::InstructionSet;
use snell_scene::scene::{self, Antialiasing, PixelGrid, Shadows};

use crate::camera::Camera;
use crate::compile::CompiledScene;
use crate::integrator::Whitted;
use crate::viewing::ViewingError;

/// Settings of one rendering.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderSettings {
    /// Pixels in x, from 1.
    pub width: u32,
    /// Pixels in y, from 1.
    pub height: u32,
    /// The depth of the deepest ray; camera rays have depth 1.
    pub depth: u16,
    /// Rays whose weight is below this in every component are not followed.
    pub min_weight: f32,
    /// As [`scene::Settings::weightless_rays`].
    pub weightless_rays: bool,
    /// How pixels are sampled.
    pub antialiasing: Antialiasing,
    /// What blocks light.
    pub shadows: Shadows,
    /// How many bands white light splits into, 1 to 64.
    pub bands: u32,
    /// Bends all light as it is bent at this wavelength, in nanometres; `None` for that of the sodium D line, and bands where white
    /// light splits.
    pub wavelength_nm: Option<f64>,
    /// Where rays pass through pixels.
    pub pixel_grid: PixelGrid,
    /// The edge of a tile in pixels. The picture does not depend on it.
    pub tile_size: u32,
    /// How many threads; one for each core where `None`. The picture does not depend on it.
    pub threads: Option<usize>,
    /// By which instructions rays are traced side by side. The picture does not depend on it.
    pub instructions: InstructionSet,
    /// Whether depth, normals and objects are wanted too.
    pub layers: bool,
    /// How the picture will be shown: what adaptive antialiasing takes for different.
    pub tone: scene::Tone,
    /// As [`scene::Settings::exposure`], to the same end.
    pub exposure: f32,
}

impl From<&scene::Settings> for RenderSettings {
    /// The scene's wishes, in tiles of 32 pixels on all cores.
    fn from(settings: &scene::Settings) -> Self {
        Self {
            width: settings.width,
            height: settings.height,
            depth: u16::try_from(settings.depth).unwrap_or(u16::MAX),
            min_weight: settings.min_weight,
            weightless_rays: settings.weightless_rays,
            antialiasing: settings.antialiasing,
            shadows: settings.shadows,
            bands: settings.bands,
            wavelength_nm: None,
            pixel_grid: settings.pixel_grid,
            tile_size: 32,
            threads: None,
            instructions: InstructionSet::best(),
            layers: false,
            tone: settings.tone,
            exposure: settings.exposure,
        }
    }
}

impl RenderSettings {
    /// The scene's camera for a picture of this size.
    ///
    /// # Errors
    /// [`ViewingError`], where it is degenerate.
    pub fn camera(&self, scene: &CompiledScene) -> Result<Camera, ViewingError> {
        Camera::new(&scene.camera, self.width, self.height, self.pixel_grid)
    }

    /// The algorithm that renders it.
    pub(super) fn integrator(&self, scene: &CompiledScene, camera: &Camera) -> Whitted {
        Whitted::at_wavelength(scene, camera, self.bands, self.wavelength_nm)
    }

    /// The tone curve under its name in [`snell_image`].
    pub fn tone_curve(&self) -> ToneCurve {
        match self.tone {
            scene::Tone::None => ToneCurve::None,
            scene::Tone::Reinhard => ToneCurve::Reinhard,
            scene::Tone::Filmic => ToneCurve::Filmic,
        }
    }

    /// Whether there are passes that depend on what the ones before have shown.
    pub(super) fn is_adaptive(&self) -> bool {
        self.antialiasing == Antialiasing::Adaptive
    }

    /// The pass that takes a sample, or the last one.
    pub(super) fn pass_of(&self, sample: u32) -> Range<u32> {
        let passes = self.passes();
        passes.iter().find(|pass| pass.contains(&sample)).or(passes.last()).cloned().unwrap_or(0..1)
    }

    /// Which samples of the sequence each pass takes; all pixels take part in the first.
    pub(super) fn passes(&self) -> Vec<Range<u32>> {
        let borders: &[u32] = match self.antialiasing {
            Antialiasing::None => &[0, 1],
            Antialiasing::Samples(count) => &[0, count.max(1)],
            Antialiasing::Adaptive => &[0, 1, 4, 16],
        };
        borders.windows(2).map(|pair| pair[0]..pair[1]).collect()
    }
}

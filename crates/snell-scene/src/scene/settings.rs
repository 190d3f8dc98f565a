//! How the author of a scene wants it rendered.

/// Picture size, limits of the recursion, antialiasing and tone. Each has a default that is right for most scenes.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Pixels in x, from 1.
    pub width: u32,
    /// Pixels in y, from 1.
    pub height: u32,
    /// The depth of the deepest ray; a camera ray has depth 1.
    pub depth: u32,
    /// A ray whose weight to its pixel is below this in every component is not followed but counted as cut; 0 follows all.
    pub min_weight: f32,
    /// Whether a surface spawns its rays even where they carry nothing, as at a boundary that reflects no light. The picture is
    /// the same; what is counted is what the Standard Procedural Databases' rules count.
    pub weightless_rays: bool,
    /// How pixels are sampled.
    pub antialiasing: Antialiasing,
    /// What blocks light.
    pub shadows: Shadows,
    /// How many wavelength bands white light splits into at a dispersive surface, in each sample of a pixel; the samples of
    /// one pixel split it at different places.
    pub bands: u32,
    /// From scene-linear colour to display colour.
    pub tone: Tone,
    /// The tone curve's exposure: colours are multiplied by 2 to this power before it.
    pub exposure: f32,
    /// Where in the window the rays of pixels pass.
    pub pixel_grid: PixelGrid,
    /// How light is followed.
    pub integrator: IntegratorKind,
    /// The most samples of a pixel where paths are traced, from 1.
    pub samples: u32,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            width: 640,
            height: 480,
            depth: 12,
            min_weight: 1.0 / 1024.0,
            weightless_rays: false,
            antialiasing: Antialiasing::Adaptive,
            shadows: Shadows::Filtered,
            bands: 8,
            tone: Tone::None,
            exposure: 0.0,
            pixel_grid: PixelGrid::Centers,
            integrator: IntegratorKind::Whitted,
            samples: 64,
        }
    }
}

/// How light is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IntegratorKind {
    /// Recursive ray tracing, as the lecture has it.
    Whitted,
    /// Path tracing: light as it is.
    Path,
}

/// How pixels are sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Antialiasing {
    /// One ray through the pixel's centre.
    None,
    /// More rays where the picture needs them.
    Adaptive,
    /// That many rays in every pixel, from 1.
    Samples(u32),
}

/// What blocks a shadow ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shadows {
    /// Opaque surfaces block all, transparent ones filter: by their transmission, colour and absorption.
    Filtered,
    /// Every surface blocks all.
    Opaque,
    /// Nothing blocks; no shadow ray is traced.
    None,
}

/// The curve from scene-linear colour to display colour. The sRGB encoding follows it always.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// Clipped at one.
    None,
    /// Reinhard's, on luminance, white at 4 (Reinhard et al. 2002, equation 4).
    Reinhard,
    /// A filmic curve (Narkowicz's fit of the ACES reference).
    Filmic,
}

/// Where in the window the rays of pixels pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PixelGrid {
    /// Pixels tile the window; rays pass through their centres.
    Centers,
    /// The rays of the outermost pixels pass through the window's border: (width − 1) × (height − 1) cells, a ray at each
    /// corner, as the Standard Procedural Databases ask.
    Corners,
}

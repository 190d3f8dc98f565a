//! What a ray sees that hits nothing, compiled. Directions are in world space and of any length; colours are scene-linear
//! radiance.

use std::f64::consts::TAU;
use std::sync::Arc;

use snell_math::{Rgb, Vector3, portable};
use snell_scene::Id;
use snell_scene::scene::{self, ImageAsset};

use super::image::{Level, Neighbours, TextureImage};
use super::pyramid;
use super::ramp::{Ramp, RampError};
use super::view::ViewProjection;

/// The background of a compiled scene. Never changed; shared by all threads.
///
/// ```
/// use snell::math::{Rgb, Vector3};
/// use snell::texture::{Background, SeenAtOnce, ViewProjection};
/// let sky = snell::scene::scene::Background::Gradient(vec![(-1.0, Rgb::BLACK), (1.0, Rgb::WHITE)]);
/// let view = ViewProjection::for_orthographic(Vector3::X, Vector3::Y, Vector3::Z, 1.5);
/// let background = Background::compile(&sky, &[]).unwrap();
/// assert_eq!(background.evaluate(Vector3::Y, &SeenAtOnce::POINT, &view), Rgb::WHITE);
/// assert_eq!(background.evaluate(Vector3::X, &SeenAtOnce::POINT, &view), Rgb::gray(0.5));
/// ```
#[derive(Clone, Debug)]
pub struct Background(Kind);

/// How much of the background one sample of the picture stands for. Pictures are averaged over it, the rest is not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenAtOnce {
    /// The steps from a unit direction to those of the neighbouring samples.
    pub directions: [Vector3; 2],
    /// The steps between positions of the picture, where these are known.
    pub positions: [[f64; 2]; 2],
}

impl SeenAtOnce {
    /// A point.
    pub const POINT: Self = Self { directions: [Vector3::ZERO; 2], positions: [[0.0; 2]; 2] };
}

#[derive(Clone, Debug)]
enum Kind {
    Color(Rgb),
    Gradient(Ramp),
    Photograph { image: Arc<TextureImage>, intensity: f32 },
    Panorama(Panorama),
}

/// An equirectangular picture of all directions.
#[derive(Clone, Debug)]
struct Panorama {
    image: Arc<TextureImage>,
    intensity: f32,
    /// Whole turns, in [0, 1).
    rotation: f64,
    /// The colour straight up and straight down: where all of a row's pixels meet, so their mean.
    poles: [Rgb; 2],
}

/// What makes a background impossible to evaluate.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum BackgroundError {
    /// There is no such picture in the scene.
    #[error("the background refers to picture {image:?}, but the scene has {count}")]
    UnknownImage {
        /// What is not there.
        image: Id<ImageAsset>,
        /// How many there are.
        count: usize,
    },
    /// The colour is NaN or infinite.
    #[error("the background's colour is not finite")]
    BadColor,
    /// The gradient's stops make no ramp.
    #[error("the background's gradient: {0}")]
    BadGradient(#[from] RampError),
    /// The intensity is NaN or infinite.
    #[error("the background's intensity {0} is not finite")]
    BadIntensity(f32),
    /// The rotation is NaN or infinite.
    #[error("the background's rotation {0} is not finite")]
    BadRotation(f64),
}

impl Background {
    /// Compiles a scene's background. `images` are the scene's pictures, decoded, in the order of its table of images.
    ///
    /// # Errors
    /// [`BackgroundError`] where it cannot be evaluated.
    pub fn compile(background: &scene::Background, images: &[Arc<TextureImage>]) -> Result<Self, BackgroundError> {
        let picture = |image: &Id<ImageAsset>, intensity: f32| {
            if !intensity.is_finite() {
                return Err(BackgroundError::BadIntensity(intensity));
            }
            let found = images.get(image.index()).cloned();
            found.ok_or(BackgroundError::UnknownImage { image: *image, count: images.len() })
        };
        Ok(Self(match background {
            scene::Background::Color(color) if color.is_finite() => Kind::Color(*color),
            scene::Background::Color(_) => return Err(BackgroundError::BadColor),
            scene::Background::Gradient(stops) => {
                let ramp = Ramp::new(stops, false)?;
                ramp.constant().map_or(Kind::Gradient(ramp), Kind::Color)
            }
            scene::Background::Photograph { image, intensity } => {
                Kind::Photograph { image: picture(image, *intensity)?, intensity: *intensity }
            }
            scene::Background::Panorama { image, intensity, rotation } => {
                if !rotation.is_finite() {
                    return Err(BackgroundError::BadRotation(*rotation));
                }
                Kind::Panorama(Panorama::new(picture(image, *intensity)?, *intensity, *rotation))
            }
        }))
    }

    /// Into how many columns and rows directions are to be cut so that most of it is seen: those of a panorama's picture, at most
    /// 2048 and 1024.
    #[must_use]
    pub fn detail(&self) -> [usize; 2] {
        match &self.0 {
            Kind::Panorama(Panorama { image, .. }) => {
                [image.width().clamp(8, 2048) as usize, image.height().clamp(4, 1024) as usize]
            }
            Kind::Photograph { .. } => [512, 256],
            Kind::Color(_) | Kind::Gradient(_) => [1, 256],
        }
    }

    /// What is seen in a direction. The view is the camera's, which only a photograph looks at.
    #[must_use]
    pub fn evaluate(&self, direction: Vector3, seen: &SeenAtOnce, view: &ViewProjection) -> Rgb {
        match &self.0 {
            Kind::Color(color) => *color,
            Kind::Gradient(ramp) => ramp.color(unit(direction).y()),
            Kind::Photograph { .. } => {
                let direction = unit(direction);
                let position = view.position(direction);
                let positions = seen.directions.map(|step| difference(view.position(direction + step), position));
                self.evaluate_at_pixel(position, direction, &SeenAtOnce { positions, ..*seen })
            }
            Kind::Panorama(panorama) => panorama.color(unit(direction), seen.directions),
        }
    }

    /// What a ray of the camera itself sees that leaves from a known position of the picture (x to the right and y down, the
    /// picture being [0, 1]²): a photograph's colour at that position, and everything else by direction.
    ///
    /// For an orthographic camera this is how its photograph fills the view; for a perspective one with a point for an eye
    /// both ways agree.
    #[must_use]
    pub fn evaluate_at_pixel(&self, position: [f64; 2], direction: Vector3, seen: &SeenAtOnce) -> Rgb {
        match &self.0 {
            Kind::Color(color) => *color,
            Kind::Gradient(ramp) => ramp.color(unit(direction).y()),
            Kind::Photograph { image, intensity } => image.color(position, false, true, seen.positions) * *intensity,
            Kind::Panorama(panorama) => panorama.color(unit(direction), seen.directions),
        }
    }

    /// True where how much is seen at once matters.
    #[must_use]
    pub fn is_picture(&self) -> bool {
        matches!(self.0, Kind::Photograph { .. } | Kind::Panorama(_))
    }

    /// The colour of a background that is the same everywhere.
    #[inline]
    #[must_use]
    pub fn constant(&self) -> Option<Rgb> {
        match &self.0 {
            Kind::Color(color) => Some(*color),
            _ => None,
        }
    }
}

fn difference(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// A direction in unit length; straight ahead of the default camera where there is none.
fn unit(direction: Vector3) -> Vector3 {
    direction.try_normalize().unwrap_or(Vector3::new(0.0, 0.0, -1.0))
}

impl Panorama {
    fn new(image: Arc<TextureImage>, intensity: f32, rotation: f64) -> Self {
        let turns = rotation / TAU;
        let full = &image.levels()[0];
        let poles = [full.row_mean(0), full.row_mean(full.height - 1)];
        Self { image, intensity, rotation: turns - turns.floor(), poles }
    }

    /// What is seen in a unit direction and as far around it as some steps lead.
    fn color(&self, direction: Vector3, steps: [Vector3; 2]) -> Rgb {
        let levels = self.image.levels();
        let place = self.place(direction);
        let look = |level: usize, [right, down]: [f64; 2]| levels[level].panorama(right, down, self.poles);
        if steps == [Vector3::ZERO; 2] {
            return look(0, place) * self.intensity;
        }
        let sides = steps.map(|step| Self::change_of_place(direction, step));
        pyramid::average_over(levels, place, sides, look) * self.intensity
    }

    /// Where in the picture a direction is: to the right and down.
    fn place(&self, direction: Vector3) -> [f64; 2] {
        let [x, y, z] = direction.to_array();
        // The azimuth from −z towards +x, which is to the right in the picture. Turning the picture counter-clockwise moves
        // every direction clockwise in it, that is to the right.
        let right = 0.5 + portable::atan2(x, -z) / TAU + self.rotation;
        // The angle from the top, by both its sine and its cosine: exact at the poles too.
        let down = portable::atan2((x * x + z * z).sqrt(), y) / (0.5 * TAU);
        [right, down]
    }

    /// How the place changes by a step from a unit direction: its derivatives. At the poles infinite or no number to the right.
    fn change_of_place(direction: Vector3, step: Vector3) -> [f64; 2] {
        let ([x, y, z], [dx, dy, dz]) = (direction.to_array(), step.to_array());
        let level_squared = x * x + z * z;
        let level = level_squared.sqrt();
        let right = (x * dz - z * dx) / level_squared;
        let down = y * (x * dx + z * dz) / level - level * dy;
        [right / TAU, down / (0.5 * TAU)]
    }
}

impl Level {
    fn row_mean(&self, y: u32) -> Rgb {
        let mut sum = [0.0_f64; 3];
        for x in 0..self.width {
            for (sum, component) in sum.iter_mut().zip(self.pixel(x, y).to_array()) {
                *sum += f64::from(component);
            }
        }
        Rgb::from(sum.map(|sum| (sum / f64::from(self.width)) as f32))
    }

    /// Bilinear interpolation that goes round, and at the top and bottom on to the poles' colours.
    fn panorama(&self, right: f64, down: f64, [top, bottom]: [Rgb; 2]) -> Rgb {
        let columns = Neighbours::new(right, self.width, true);
        let rows = Neighbours::new(down, self.height, false);
        // How far beyond the centres of the outermost rows, in pixels: 0.5 at the poles themselves.
        let in_pixels = down * f64::from(self.height);
        let beyond = (0.5 - in_pixels, in_pixels - (f64::from(self.height) - 0.5));
        let color = self.row_color(columns, rows.low).lerp(self.row_color(columns, rows.high), rows.weight);
        match beyond {
            (above, _) if above > 0.0 => color.lerp(top, (2.0 * above).min(1.0) as f32),
            (_, below) if below > 0.0 => color.lerp(bottom, (2.0 * below).min(1.0) as f32),
            _ => color,
        }
    }
}

//! The lecture's figure of rays for any pixel of any scene: the scene as lines, the rays that made the pixel over it, coloured and
//! numbered, with normals and angles, and beside it what happened to each of them.

mod frame;
mod labels;
mod panel;
mod rays;

use snell_math::{Point3, Rgb};
use snell_scene::scene::{self, Drawing, HiddenLines, PixelGrid};

use super::Explanation;
use crate::camera::Camera;
use crate::compile::CompiledScene;
use crate::drawing::{DrawingSettings, draw_from};
use crate::render::RenderSettings;
use crate::vector::{Group, Item, Page};
use crate::viewing::{Rectangle, ViewingError};

/// From where a figure sees the scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum View {
    /// Across the plane of incidence at the first surface, in which angles are true; from the side where that is no plane.
    #[default]
    Plane,
    /// From the right of the ray, level.
    Side,
    /// From straight above.
    Above,
    /// Along the camera's gaze, without perspective.
    Front,
    /// As the camera sees it.
    Camera,
    /// From a point of the world, towards what the rays meet, without perspective.
    From(Point3),
    /// As another camera sees it.
    Given(Box<scene::Camera>),
}

/// What a figure is to be like.
#[derive(Clone, Debug)]
pub struct FigureSettings {
    /// From where.
    pub view: View,
    /// The width of the picture of the scene in millimetres; the list of rays is beside it.
    pub width: f64,
    /// What is written above it, in the markup of [`crate::vector::Text`].
    pub title: Option<String>,
    /// Rays that carry less than this share of their sample are left out, shares that are less of the pixel are not listed.
    pub least: f64,
    /// The list of rays is left out.
    pub without_list: bool,
}

impl Default for FigureSettings {
    fn default() -> Self {
        Self { view: View::Plane, width: 150.0, title: None, least: 0.01, without_list: false }
    }
}

/// The most rays of a figure.
const MOST_RAYS: usize = 12;
/// Height over width of the picture of the scene, where the camera does not say it.
const ASPECT: f64 = 0.72;
/// Pixels of the picture that lines are found in: visibility changes are as fine as this.
const PIXELS: f64 = 1500.0;
/// The grey of the scene's own lines.
const SCENE: [u8; 3] = [128, 128, 128];

/// Where things of the world are on the page.
struct Sheet {
    camera: Camera,
    /// The picture on the page, millimetres, y down.
    place: Rectangle,
    /// Millimetres of a pixel.
    scale: f64,
}

impl Sheet {
    /// The place of a point of the world; `None` behind the camera.
    fn at(&self, point: Point3) -> Option<[f64; 2]> {
        let raster = self.camera.project(point)?;
        let at = [self.place.left + raster.x * self.scale, self.place.top + raster.y * self.scale];
        at.iter().all(|x| x.is_finite()).then_some(at)
    }

    /// The part of a straight line that is in the picture.
    fn line(&self, from: Point3, to: Point3) -> Option<[[f64; 2]; 2]> {
        let [from, to] = self.before_the_camera(from, to)?;
        self.place.clip(self.at(from)?, self.at(to)?)
    }

    /// The part of a line that is well before a perspective camera.
    fn before_the_camera(&self, from: Point3, to: Point3) -> Option<[Point3; 2]> {
        if self.camera.projection() == crate::camera::Projection::Orthographic {
            return Some([from, to]);
        }
        let depth = |p: Point3| -(p - self.camera.eye()).dot(self.camera.axes()[2]);
        let nearest = 1e-3 * (from.distance(to) + 1e-9);
        let (a, b) = (depth(from), depth(to));
        if a < nearest && b < nearest {
            return None;
        }
        let at = |t: f64| from.lerp(to, t);
        let cut = (nearest - a) / (b - a);
        Some(if a < nearest {
            [at(cut), to]
        } else if b < nearest {
            [from, at(cut)]
        } else {
            [from, to]
        })
    }
}

/// Draws an explanation: its first sample, where it has several.
///
/// # Errors
/// [`ViewingError`], where the camera that looks at it is degenerate.
pub fn figure(
    scene: &CompiledScene,
    settings: &RenderSettings,
    told: &Explanation,
    figure: &FigureSettings,
) -> Result<Page, ViewingError> {
    let chosen = rays::choose(told, figure.least, MOST_RAYS);
    let looking = frame::camera(scene, settings, told, &chosen, figure)?;
    let (aspect, description) = (looking.aspect, looking.camera);
    let pixels = [PIXELS, (PIXELS * aspect).round().max(1.0)].map(|pixels| pixels as u32);
    let hidden = HiddenLines::Dashed;
    let drawing = Drawing { width: figure.width, line_width: 0.25, hidden, ..Drawing::default() };
    let drawn = DrawingSettings {
        width: pixels[0],
        height: pixels[1],
        pixel_grid: PixelGrid::Centers,
        drawing,
        plots: Vec::new(),
        under: None,
    };
    let mut page = draw_from(scene, &description, &drawn)?;
    page.groups.iter_mut().for_each(gray);
    let sheet = Sheet {
        camera: Camera::new(&description, pixels[0], pixels[1], PixelGrid::Centers)?,
        place: Rectangle { left: 0.0, right: page.width, bottom: page.height, top: 0.0 },
        scale: page.width / f64::from(pixels[0]),
    };
    rays::draw(scene, told, &chosen, &sheet, looking.size, &mut page);
    panel::border(&sheet.place, &mut page);
    if !figure.without_list {
        panel::list(told, &chosen, figure.least, &mut page);
    }
    if let Some(title) = &figure.title {
        panel::title(title, &mut page);
    }
    Ok(page)
}

/// The scene's own lines step back behind the rays.
fn gray(group: &mut Group) {
    for item in &mut group.items {
        if let Item::Path(path) = item
            && let Some(stroke) = &mut path.stroke
        {
            stroke.color = SCENE;
        }
    }
}

/// A scene-linear colour as it is shown.
fn shown(color: Rgb) -> [u8; 3] {
    color.to_array().map(|c| (snell_math::color::linear_to_srgb(c.clamp(0.0, 1.0)) * 255.0).round() as u8)
}

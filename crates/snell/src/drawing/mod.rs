//! Line drawings of a scene: every edge and outline through M = M_o M_p M_v, clipped before the division, hidden lines found by the
//! ray tracer's own visibility, and written as a page of vector graphics.
//!
//! The lecture: "for each line segment (a, b): p = M a, q = M b, drawline(p, q)". The lines come from what the tracer meets
//! (`outline`, `mesh`), their pictures from the camera that the tracer sees with (`screen`), and what hides them is what its
//! rays meet (`visibility`): so a drawing lies on the rendering of the same scene.

mod crossings;
mod duplicates;
mod furniture;
mod lines;
mod marks;
mod meetings;
mod mesh;
mod pen;
mod screen;
mod sheet;
mod stages;
#[cfg(test)]
mod tests;
mod visibility;

use snell_math::Bounds3;
use snell_scene::scene::{self, Plot};

pub use stages::{StagePicture, draw_stages};

use crate::camera::Camera;
use crate::compile::CompiledScene;
use crate::plot::plot_groups;
use crate::vector::{Backdrop, Page};
use crate::viewing::{Device, Fit, Rectangle, RectangleMap, Viewing2, ViewingError};
use lines::{LineOptions, SeenLine};
use marks::Mark;
use screen::Screen;
use sheet::Style;

/// What is drawn, and how. The picture's pixels are those of the rendering: lines are found in them and agree with it.
#[derive(Clone, Debug)]
pub struct DrawingSettings {
    /// Pixels in x of the rendering that the drawing agrees with.
    pub width: u32,
    /// Pixels in y.
    pub height: u32,
    /// Where rays pass through pixels.
    pub pixel_grid: scene::PixelGrid,
    /// How lines are drawn, and what is drawn besides the scene.
    pub drawing: scene::Drawing,
    /// Two-dimensional pictures on the same page.
    pub plots: Vec<Plot>,
    /// An encoded PNG that lies under the drawing and fills the picture.
    pub under: Option<Vec<u8>>,
}

impl DrawingSettings {
    /// As the scene's author wants it.
    pub fn new(scene: &scene::Scene) -> Self {
        let settings = &scene.settings;
        Self {
            width: settings.width,
            height: settings.height,
            pixel_grid: settings.pixel_grid,
            drawing: scene.drawing.clone(),
            plots: scene.plots.clone(),
            under: None,
        }
    }
}

/// Draws a scene.
///
/// # Errors
/// [`ViewingError`], where a camera or a window is degenerate: it names the value.
///
/// ```
/// use snell::compile::CompiledScene;
/// use snell::drawing::{DrawingSettings, draw};
/// use snell::math::Point3;
/// use snell::scene::scene::{Object, Scene, Shape};
/// use snell::vector::encode_svg;
///
/// let mut scene = Scene::default();
/// scene.objects.push(Object::shape(Shape::Sphere { center: Point3::ORIGIN, radius: 1.0 }));
/// let compiled = CompiledScene::build(&scene).unwrap();
/// let page = draw(&compiled, &DrawingSettings::new(&scene))?;
/// // The outline of a sphere is one curve.
/// assert_eq!(encode_svg(&page).unwrap().matches("<circle").count(), 1);
/// # Ok::<(), snell::viewing::ViewingError>(())
/// ```
pub fn draw(scene: &CompiledScene, settings: &DrawingSettings) -> Result<Page, ViewingError> {
    draw_from(scene, &scene.camera, settings)
}

/// As [`draw`], seen by another camera than the scene's own.
///
/// # Errors
/// As [`draw`].
pub fn draw_from(
    scene: &CompiledScene,
    from: &scene::Camera,
    settings: &DrawingSettings,
) -> Result<Page, ViewingError> {
    let drawing = &settings.drawing;
    let camera = Camera::new(from, settings.width, settings.height, settings.pixel_grid)?;
    let mut page = new_page(settings);
    let picture_height = page.height;
    let title_height = furniture::title_height(drawing);
    page.height += title_height;
    let device = Device { width: page.width, height: picture_height, y_down: true };
    let raster =
        Rectangle { left: 0.0, right: f64::from(settings.width), bottom: f64::from(settings.height), top: 0.0 };
    let scene::Extent { left, right, bottom, top } = drawing.viewport;
    let viewing = Viewing2::new(&raster, &Rectangle::new(left, right, bottom, top), &device, Fit::Keep)?;
    let place = |p: [f64; 2]| {
        let [x, y] = viewing.point(p);
        [x, y + title_height]
    };
    let ([x0, y0], [x1, y1]) = (place([raster.left, raster.top]), place([raster.right, raster.bottom]));
    let on_page = Rectangle { left: x0, right: x1, bottom: y1, top: y0 };
    let page_from_raster = RectangleMap::new(&raster, &on_page)?;
    page.backdrop = settings.under.clone().map(|png| Backdrop { png, place: [x0, y0, x1 - x0, y1 - y0] });

    let bounds = lines::finite_bounds(&scene.geometry);
    let marks = marks::all(scene, settings, &bounds)?;
    let screen = Screen::new(&camera, &marks.iter().fold(bounds, |all, mark| all.union(&mark.bounds())))?;
    let seen = seen_lines(scene, &screen, drawing, &marks);
    let style = Style {
        hidden: drawing.hidden,
        stroke: drawing.stroke,
        line_width: drawing.line_width,
        depths: depth_range(&camera, &bounds),
    };
    let name = |object: u32| scene.object_names.get(object).unwrap_or_default().into_owned();
    page.groups = sheet::groups(&seen, &screen, &style, &page_from_raster, name);
    page.groups.extend(marks::groups(&marks, &seen, &screen, &page_from_raster));
    for plot in &settings.plots {
        let mut groups = plot_groups(plot, page.width, picture_height)?;
        groups.iter_mut().for_each(|group| group.shift([0.0, title_height]));
        page.groups.extend(groups);
    }
    page.groups.extend(furniture::groups(drawing, &screen, &bounds, &page_from_raster, page.width));
    Ok(page)
}

/// Whether a scene's drawn cameras and plots are sound, without drawing it.
///
/// # Errors
/// [`ViewingError`], where a drawn camera or a plot's window is degenerate.
pub fn check(scene: &CompiledScene, settings: &DrawingSettings) -> Result<(), ViewingError> {
    let bounds = lines::finite_bounds(&scene.geometry);
    let drawing = scene::Drawing {
        cameras: settings.drawing.cameras.iter().map(|c| scene::CameraMark { picture: false, ..c.clone() }).collect(),
        ..settings.drawing.clone()
    };
    marks::all(scene, &DrawingSettings { drawing, ..settings.clone() }, &bounds)?;
    let page = new_page(settings);
    settings.plots.iter().try_for_each(|plot| plot_groups(plot, page.width, page.height).map(drop))
}

/// The box around all that is finite in a scene.
pub fn finite_bounds(scene: &CompiledScene) -> Bounds3 {
    lines::finite_bounds(&scene.geometry)
}

/// The box around each object that is finite, by its number.
pub fn object_bounds(scene: &CompiledScene, object: u32) -> Option<Bounds3> {
    let surfaces = scene.geometry.world_surfaces();
    let of_object = surfaces.iter().filter(|surface| surface.object == object);
    let bounds = of_object.fold(Bounds3::EMPTY, |all, surface| all.union(&surface.bounds));
    bounds.is_finite().then_some(bounds)
}

/// The planes n and f that a camera's matrices are shown with: its own ones, or else such that they hold the scene.
pub fn shown_planes(scene: &CompiledScene, camera: &Camera) -> [f64; 2] {
    screen::shown_planes(camera, &lines::finite_bounds(&scene.geometry))
}

fn new_page(settings: &DrawingSettings) -> Page {
    let drawing = &settings.drawing;
    let aspect = f64::from(settings.height) / f64::from(settings.width);
    Page { width: drawing.width, height: drawing.width * aspect, title: drawing.title.clone(), ..Page::default() }
}

/// The lines of the scene and of the marks that it may hide, divided.
fn seen_lines(scene: &CompiledScene, screen: &Screen<'_>, drawing: &scene::Drawing, marks: &[Mark]) -> Vec<SeenLine> {
    let options = LineOptions { crease_angle: drawing.crease_angle, parameter_lines: drawing.parameter_lines };
    let mut all = lines::gather(&scene.geometry, screen, &options);
    for (index, mark) in marks.iter().enumerate().filter(|(_, mark)| mark.can_be_hidden) {
        all.extend(mark.features.iter().map(|feature| lines::Line::of_mark(feature.clone(), index)));
    }
    lines::see(all, &scene.geometry, screen)
}

/// The depths along the gaze between which a scene is; from 0 to 1 where it is empty.
fn depth_range(camera: &Camera, bounds: &Bounds3) -> [f64; 2] {
    if !bounds.is_finite() {
        return [0.0, 1.0];
    }
    let depths = (0..8).map(|corner| -(bounds.corner(corner) - camera.eye()).dot(camera.axes()[2]));
    let (near, far) = depths.fold((f64::INFINITY, f64::NEG_INFINITY), |(n, f), d| (n.min(d), f.max(d)));
    [near.max(0.0), far.max(near.max(0.0) + 1e-9)]
}

//! What is drawn into a scene that is not of it: axes, grids, points, lines and cameras, each with its labels. World space.

use snell_math::{Bounds3, Homogeneous3, Point3, Rgb, Vector3};
use snell_scene::scene::{self, AxesLength, CameraMark, PixelGrid};

use super::furniture::{label_text, round_length};
use super::lines::{self, LineOptions, SeenLine, segment};
use super::screen::Screen;
use super::sheet::on_page;
use super::{DrawingSettings, pen};
use crate::camera::{Camera, Projection};
use crate::compile::CompiledScene;
use crate::outline::{Curve, Feature, FeatureKind};
use crate::vector::{self, Group, Horizontal, Item, Path, Stroke, Text, Vertical};
use crate::viewing::{RectangleMap, ViewingError};

/// The height of labels in millimetres.
pub const LABEL: f64 = 3.4;
/// Colours of the axes x, y, z.
const AXES: [[u8; 3]; 3] = [[176, 48, 32], [24, 120, 56], [32, 72, 168]];

/// Lines of one look, with labels.
#[derive(Debug)]
pub struct Mark {
    /// What it is called in the picture's file.
    pub name: String,
    /// Its lines.
    pub features: Vec<Feature>,
    /// Things of the scene hide it.
    pub can_be_hidden: bool,
    color: [u8; 3],
    /// Millimetres.
    width: f64,
    dashed: bool,
    /// Its last line ends in a head.
    arrow: bool,
    /// A dot at a place, with its diameter in millimetres.
    dots: Vec<(Point3, f64)>,
    labels: Vec<Label>,
}

/// A text at a place of the world.
#[derive(Debug)]
struct Label {
    markup: String,
    at: Point3,
    /// From there, on the page: millimetres, x to the right, y up. Without it, a little beyond the tip of the mark's arrow.
    offset: Option<[f64; 2]>,
}

/// How far beyond the tip of an arrow its label is, in millimetres.
const BEYOND: f64 = 2.6;

impl Mark {
    fn new(name: impl Into<String>, color: [u8; 3], width: f64) -> Self {
        Self {
            name: name.into(),
            features: Vec::new(),
            can_be_hidden: false,
            color,
            width,
            dashed: false,
            arrow: false,
            dots: Vec::new(),
            labels: Vec::new(),
        }
    }

    fn line(mut self, a: impl Into<Homogeneous3>, b: impl Into<Homogeneous3>) -> Self {
        self.features.push(segment(a, b));
        self
    }

    fn arrow(self, a: Point3, b: Point3) -> Self {
        Self { arrow: true, ..self.line(a, b) }
    }

    fn chain(mut self, points: &[Point3]) -> Self {
        self.features.extend(points.windows(2).map(|pair| segment(pair[0], pair[1])));
        self
    }

    fn dashed(self) -> Self {
        Self { dashed: true, ..self }
    }

    fn hidden_by_things(self, can_be_hidden: bool) -> Self {
        Self { can_be_hidden, ..self }
    }

    fn label(mut self, markup: Option<&str>, at: Point3, offset: [f64; 2]) -> Self {
        self.labels.extend(markup.map(|markup| Label { markup: markup.to_owned(), at, offset: Some(offset) }));
        self
    }

    /// With a label beyond the tip of its arrow.
    fn named(mut self, markup: Option<&str>, tip: Point3) -> Self {
        self.labels.extend(markup.map(|markup| Label { markup: markup.to_owned(), at: tip, offset: None }));
        self
    }

    fn is_point(&self) -> bool {
        self.dots.len() == 1 && self.features.len() <= 1 && !self.arrow
    }

    /// Whether the end of its last line is seen, where that can be hidden.
    fn shows_end(&self, index: usize, seen: &[SeenLine]) -> bool {
        if !self.can_be_hidden {
            return true;
        }
        let Some(end) = self.features.last().map(|feature| feature.curve.domain()[1]) else { return true };
        let last = seen.iter().rfind(|seen| seen.line.mark == Some(index));
        last.and_then(|line| line.parts.last()).is_some_and(|part| part.visible && part.to >= end)
    }

    /// The box around it.
    pub fn bounds(&self) -> Bounds3 {
        let ends = self.features.iter().flat_map(|feature| feature.curve.domain().map(|t| feature.curve.point(t)));
        let points = ends.filter_map(|p| p.homogenize().ok()).chain(self.dots.iter().map(|(p, _)| *p));
        points.fold(Bounds3::EMPTY, |all, p| all.including(p))
    }
}

/// All marks that a drawing asks for. `bounds` holds what is finite of the scene.
///
/// # Errors
/// [`ViewingError`], where a camera that is to be drawn is degenerate.
pub fn all(scene: &CompiledScene, settings: &DrawingSettings, bounds: &Bounds3) -> Result<Vec<Mark>, ViewingError> {
    let drawing = &settings.drawing;
    let thin = 0.6 * drawing.line_width;
    let mut marks = Vec::new();
    if let Some(grid) = &drawing.ground_grid {
        marks.push(ground_grid(grid, 0.4 * drawing.line_width));
    }
    if let Some(length) = &drawing.axes {
        let length = match length {
            AxesLength::Length(length) => *length,
            AxesLength::Fitting if bounds.is_finite() => round_length(0.4 * bounds.diagonal().length()),
            AxesLength::Fitting => 1.0,
        };
        for ((axis, color), name) in [Vector3::X, Vector3::Y, Vector3::Z].into_iter().zip(AXES).zip(["x", "y", "z"]) {
            let tip = Point3::ORIGIN + axis * length;
            let mark = Mark::new(format!("axis {name}"), color, drawing.line_width).arrow(Point3::ORIGIN, tip);
            marks.push(mark.hidden_by_things(true).named(Some(&format!("*{name}*")), tip));
        }
    }
    for grid in &drawing.grids {
        let name = grid.label.as_deref().unwrap_or("grid");
        let mark =
            ruled(Mark::new(name, code(grid.color), grid.width.unwrap_or(thin)), grid.corner, grid.edges, grid.count);
        let far = grid.corner + grid.edges[0] + grid.edges[1];
        marks.push(mark.hidden_by_things(grid.can_be_hidden).label(grid.label.as_deref(), far, [1.2, 1.2]));
    }
    let mut windows = Vec::new();
    for camera in &drawing.cameras {
        let drawn = DrawnCamera::new(camera)?;
        drawn.marks(camera, scene, settings, &mut marks);
        windows.push(drawn);
    }
    for line in &drawing.lines {
        let (Some(&first), Some(&last)) = (line.points.first(), line.points.last()) else { continue };
        let color = code(line.color);
        let mut mark =
            Mark::new(line.label.as_deref().unwrap_or("line"), color, line.width.unwrap_or(drawing.line_width));
        (mark.arrow, mark.dashed, mark.can_be_hidden) = (line.arrow, line.dashed, line.can_be_hidden);
        let mark = mark.chain(&line.points);
        let steps = (0..=line.steps).map(|step| f64::from(step) / f64::from(line.steps.max(1)));
        let places: Vec<Point3> =
            if line.steps > 0 { steps.map(|s| along(&line.points, s)).collect() } else { Vec::new() };
        let mut mark = mark.label(line.label.as_deref(), along(&line.points, line.label_at), line.offset);
        mark.dots.extend(places.iter().map(|p| (*p, 3.0 * mark.width)));
        marks.push(mark);
        let Some(window) = line.project_to.and_then(|index| windows.get(index)) else { continue };
        let image: Vec<Point3> = line.points.iter().filter_map(|p| window.image(*p)).collect();
        let name = format!("image of {}", line.label.as_deref().unwrap_or("line"));
        let mut mark = Mark::new(name, color, line.width.unwrap_or(drawing.line_width)).chain(&image);
        mark.dots.extend(places.iter().filter_map(|p| window.image(*p)).map(|p| (p, 3.0 * mark.width)));
        marks.push(mark);
        let ends: Vec<Point3> = if places.is_empty() { vec![first, last] } else { places };
        let rays =
            ends.into_iter().fold(Mark::new("projecting rays", [130; 3], thin).dashed(), |mark, end| {
                match window.eye {
                    Some(eye) => mark.line(eye, end),
                    None => window.image(end).into_iter().fold(mark, |mark, image| mark.line(image, end)),
                }
            });
        marks.push(rays);
    }
    for point in &drawing.points {
        let mut mark = Mark::new(point.label.as_deref().unwrap_or("point"), code(point.color), drawing.line_width);
        mark.dots.push((point.position, point.size));
        if point.can_be_hidden {
            // Without length, but it is asked whether it is seen.
            mark = mark.line(point.position, point.position).hidden_by_things(true);
        }
        marks.push(mark.label(point.label.as_deref(), point.position, point.offset));
    }
    Ok(marks)
}

fn ground_grid(grid: &scene::GroundGrid, width: f64) -> Mark {
    let count = (2.0 * grid.extent / grid.spacing).round().clamp(1.0, 1000.0);
    let reach = 0.5 * count * grid.spacing;
    let corner = Point3::new(grid.center[0] - reach, grid.height, grid.center[1] - reach);
    let edges = [Vector3::X * (2.0 * reach), Vector3::Z * (2.0 * reach)];
    // A count of whole cells, at most a thousand.
    ruled(Mark::new("ground grid", [150; 3], width), corner, edges, [count as u32; 2]).hidden_by_things(true)
}

/// A rectangle ruled into `count` cells along its edges.
fn ruled(mut mark: Mark, corner: Point3, edges: [Vector3; 2], count: [u32; 2]) -> Mark {
    for (axis, across) in [(0, 1), (1, 0)] {
        for index in 0..=count[axis] {
            let start = corner + edges[axis] * (f64::from(index) / f64::from(count[axis].max(1)));
            mark = mark.line(start, start + edges[across]);
        }
    }
    mark
}

/// The point at a share of the length of a chain.
fn along(points: &[Point3], share: f64) -> Point3 {
    let total: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let mut left = share * total;
    for pair in points.windows(2) {
        let length = pair[0].distance(pair[1]);
        if left <= length && length > 0.0 {
            return pair[0].lerp(pair[1], left / length);
        }
        left -= length;
    }
    points.last().copied().unwrap_or(Point3::ORIGIN)
}

/// A camera that is drawn.
struct DrawnCamera {
    camera: Camera,
    /// `None` for a parallel projection.
    eye: Option<Point3>,
    near: f64,
    far: f64,
}

impl DrawnCamera {
    fn new(mark: &CameraMark) -> Result<Self, ViewingError> {
        // As many pixels as it is to show, or a fine raster of the same proportions.
        let [width, height] = mark.pixels.unwrap_or_else(|| {
            let (w, h) =
                if mark.aspect >= 1.0 { (1200.0, 1200.0 / mark.aspect) } else { (1200.0 * mark.aspect, 1200.0) };
            [w, h].map(|pixels| pixels.round().clamp(1.0, 65_536.0) as u32)
        });
        let camera = Camera::new(&mark.camera, width, height, PixelGrid::Centers)?;
        camera.pipeline(mark.near, mark.far)?;
        let eye = (camera.projection() == Projection::Perspective).then_some(camera.eye());
        Ok(Self { camera, eye, near: mark.near, far: mark.far })
    }

    /// The point of a plane z of eye space at a raster position.
    fn at(&self, [x, y]: [f64; 2], z: f64) -> Point3 {
        let ray = self.camera.generate_ray(x, y);
        let back = self.camera.axes()[2];
        let start = (ray.origin - self.camera.eye()).dot(back);
        ray.at((z - start) / ray.direction.dot(back))
    }

    /// Where a point appears on the near plane's window.
    fn image(&self, p: Point3) -> Option<Point3> {
        let raster = self.camera.project(p)?;
        Some(self.at([raster.x, raster.y], self.near))
    }

    fn corners(&self, z: f64) -> [Point3; 4] {
        let [w, h] = self.camera.pixels().map(f64::from);
        [[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]].map(|corner| self.at(corner, z))
    }

    fn marks(&self, mark: &CameraMark, scene: &CompiledScene, settings: &DrawingSettings, marks: &mut Vec<Mark>) {
        let color = code(mark.color);
        let width = settings.drawing.line_width;
        let name = mark.name.as_deref().unwrap_or("camera");
        let ([u, v, w], eye) = (self.camera.axes(), self.camera.eye());
        let (near, far) = (self.corners(self.near), self.corners(self.far));
        let labels = |text: &'static str| mark.labels.then_some(text);
        if mark.frustum {
            let mut frame = Mark::new(format!("{name} frustum"), color, 0.6 * width).hidden_by_things(true);
            for index in 0..4 {
                let next = (index + 1) % 4;
                frame = frame.line(near[index], near[next]).line(far[index], far[next]).line(near[index], far[index]);
            }
            marks.push(frame);
            if let Some(eye) = self.eye {
                let to_window = Mark::new(format!("{name} eye to window"), color, 0.4 * width).hidden_by_things(true);
                marks.push(near.into_iter().fold(to_window, |mark, corner| mark.line(eye, corner)));
            }
        } else if mark.picture || mark.pixels.is_some() {
            let frame = Mark::new(format!("{name} window"), color, 0.6 * width).hidden_by_things(true);
            marks.push((0..4).fold(frame, |mark, index| mark.line(near[index], near[(index + 1) % 4])));
        }
        if let Some(count) = mark.pixels {
            let grid = Mark::new(format!("{name} pixels"), [150; 3], 0.35 * width);
            marks.push(ruled(grid, near[3], [near[2] - near[3], near[0] - near[3]], count));
        }
        if mark.picture {
            marks.push(self.picture(name, scene, settings));
        }
        // Arrows as long as the window is wide, but for cameras that are far from it.
        let length = 0.5 * near[0].distance(near[1]).max(near[1].distance(near[2])).max(0.25 * -self.near);
        if mark.axes {
            for ((axis, text), color) in [(u, "*u*"), (v, "*v*"), (w, "*w*")].into_iter().zip(AXES) {
                let arrow = Mark::new(format!("{name} {}", text.trim_matches('*')), color, width);
                marks.push(arrow.arrow(eye, eye + axis * length).named(labels(text), eye + axis * length));
            }
        }
        if mark.up {
            let up = mark.camera.up.normalize() * (1.2 * length);
            let arrow = Mark::new(format!("{name} up"), [90, 90, 90], width).arrow(eye, eye + up);
            marks.push(arrow.named(labels("*t*"), eye + up));
        }
        if mark.gaze {
            let tip = eye - w * (1.5 * length);
            let arrow = Mark::new(format!("{name} gaze"), color, 1.3 * width).arrow(eye, tip);
            marks.push(arrow.named(labels("*g*"), tip));
        }
        let mut dot = Mark::new(format!("{name} eye"), color, width);
        dot.dots.push((eye, 1.6));
        marks.push(dot.label(labels("*e*"), eye, [-2.6, -2.8]));
    }

    /// The scene's visible lines as this camera sees them, on its window.
    fn picture(&self, name: &str, scene: &CompiledScene, settings: &DrawingSettings) -> Mark {
        let drawing = &settings.drawing;
        let mut mark = Mark::new(format!("{name} picture"), code(Rgb::BLACK), 0.6 * drawing.line_width);
        let Ok(screen) = Screen::new(&self.camera, &lines::finite_bounds(&scene.geometry)) else { return mark };
        let options = LineOptions { crease_angle: drawing.crease_angle, parameter_lines: drawing.parameter_lines };
        let seen = lines::see(lines::gather(&scene.geometry, &screen, &options), &scene.geometry, &screen);
        for line in &seen {
            let curve = &line.line.feature.curve;
            for part in line.parts.iter().filter(|part| part.visible) {
                let track = screen.track(curve, [part.from, part.to]);
                let points = track.into_iter().map(|sample| self.at(sample.at, self.near)).collect();
                mark.features.push(Feature::new(FeatureKind::Crease, Curve::Polyline(points)));
            }
        }
        mark
    }
}

/// The marks as groups on the page: those that can be hidden by what was seen of them.
pub fn groups(marks: &[Mark], seen: &[SeenLine], screen: &Screen<'_>, page_from_raster: &RectangleMap) -> Vec<Group> {
    let place = |p: Point3| {
        let clip = screen.clip(p.into());
        let is_before_the_eye = crate::viewing::outside(clip).all(|side| side == crate::viewing::Side::Far);
        is_before_the_eye.then(|| page_from_raster.point(screen.raster(clip)))
    };
    let group = |(index, mark): (usize, &Mark)| {
        let mut subpaths = Vec::new();
        let mut put = |feature: &Feature, from: f64, to: f64| {
            subpaths.push(on_page(&pen::write(screen, &feature.curve, from, to), page_from_raster));
        };
        if mark.can_be_hidden {
            for line in seen.iter().filter(|seen| seen.line.mark == Some(index)) {
                for part in line.parts.iter().filter(|part| part.visible) {
                    put(&line.line.feature, part.from, part.to);
                }
            }
        } else {
            for feature in &mark.features {
                screen.intervals(&feature.curve).into_iter().for_each(|[from, to]| put(feature, from, to));
            }
        }
        let dashes = if mark.dashed { vec![5.0 * mark.width, 4.0 * mark.width] } else { Vec::new() };
        let stroke = Stroke { color: mark.color, width: mark.width, dashes };
        let mut items = Vec::new();
        let subpaths = vector::join(subpaths, 1e-4);
        if !subpaths.is_empty() {
            items.push(Item::Path(Path { subpaths, stroke: Some(stroke), fill: None }));
        }
        if mark.arrow
            && mark.shows_end(index, seen)
            && let Some([tail, tip]) = mark.features.last().and_then(|feature| ends(&feature.curve))
            && let (Some(from), Some(to)) = (place(tail), place(tip))
        {
            items.push(Item::Path(vector::arrow_head(
                to,
                [to[0] - from[0], to[1] - from[1]],
                6.0 * mark.width.max(0.3),
                mark.color,
            )));
        }
        for &(at, diameter) in mark.dots.iter().filter(|_| !mark.is_point() || mark.shows_end(index, seen)) {
            if let Some(center) = place(at) {
                let disk = vector::Subpath::ellipse(center, [0.5 * diameter; 2], 0.0);
                items.push(Item::Path(Path { subpaths: vec![disk], stroke: None, fill: Some(mark.color) }));
            }
        }
        Group { name: mark.name.clone(), items }
    };
    let mut groups: Vec<Group> = marks.iter().enumerate().map(group).collect();
    // After all lines, so that none runs through them.
    let mut labels = Group { name: "labels".to_owned(), items: Vec::new() };
    for (index, mark) in marks.iter().enumerate() {
        // The name of an arrow or a point goes with it.
        let is_shown = !(mark.arrow || mark.is_point()) || mark.shows_end(index, seen);
        for label in mark.labels.iter().filter(|_| is_shown) {
            let Some([x, y]) = place(label.at) else { continue };
            let [dx, dy] = label.offset.unwrap_or_else(|| {
                let tail =
                    mark.features.last().and_then(|feature| ends(&feature.curve)).and_then(|[tail, _]| place(tail));
                let [tx, ty] = tail.unwrap_or([x, y + 1.0]);
                let (dx, dy) = (x - tx, ty - y);
                let length = (dx * dx + dy * dy).sqrt().max(1e-9);
                [BEYOND * dx / length, BEYOND * dy / length]
            });
            if label.offset.is_none() {
                let (horizontal, vertical) = (Horizontal::Center, Vertical::Middle);
                let text = Text { at: [x + dx, y - dy], horizontal, vertical, ..label_text(&label.markup, mark.color) };
                labels.items.push(Item::Text(text));
                continue;
            }
            let horizontal = if dx > 0.3 {
                Horizontal::Left
            } else if dx < -0.3 {
                Horizontal::Right
            } else {
                Horizontal::Center
            };
            let vertical = if dy > 0.3 {
                Vertical::Baseline
            } else if dy < -0.3 {
                Vertical::Top
            } else {
                Vertical::Middle
            };
            let text = Text { at: [x + dx, y - dy], horizontal, vertical, ..label_text(&label.markup, mark.color) };
            labels.items.push(Item::Text(text));
        }
    }
    groups.push(labels);
    groups.retain(|group| !group.items.is_empty());
    groups
}

/// The ends of a straight line that has two.
fn ends(curve: &Curve) -> Option<[Point3; 2]> {
    let [start, end] = curve.domain();
    Some([curve.point(start).homogenize().ok()?, curve.point(end).homogenize().ok()?])
}

/// A scene-linear colour as codes.
pub fn code(color: Rgb) -> [u8; 3] {
    [color.r, color.g, color.b].map(|c| (snell_math::color::linear_to_srgb(c.clamp(0.0, 1.0)) * 255.0).round() as u8)
}

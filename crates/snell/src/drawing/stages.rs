//! The lecture's two volumes side by side: what a camera sees, in eye space, and the same in the canonical volume [−1, 1]³.
//!
//! The scene's visible lines are followed from one to the other, and a point or a segment with them. Both are drawn by a second
//! camera that looks at them from outside.

use snell_math::{Homogeneous3, Matrix4, Point3, Vector3, portable};
use snell_scene::scene::{self, PixelGrid};

use super::furniture::label_text;
use super::lines::{self, LineOptions};
use super::marks::LABEL;
use super::pen;
use super::screen::{Screen, shown_planes};
use super::sheet::on_page;
use crate::camera::{Camera, Projection};
use crate::compile::CompiledScene;
use crate::outline::{Curve, Feature, FeatureKind};
use crate::vector::{self, Group, Horizontal, Item, Page, Path, Stroke, Subpath, Text, Vertical};
use crate::viewing::{Pipeline, Rectangle, RectangleMap, ViewingError};

/// What the two volumes are drawn of.
#[derive(Clone, Debug)]
pub struct StagePicture {
    /// Pixels of the scene's picture.
    pub pixels: [u32; 2],
    /// n and f, where they are not to be chosen or the camera's own.
    pub planes: Option<[f64; 2]>,
    /// Edges of meshes are creases where their faces turn by more than this, radians.
    pub crease_angle: f64,
    /// Points of the world to be followed.
    pub points: Vec<Point3>,
    /// Segments of the world to be followed, as far as they are inside.
    pub segments: Vec<[Point3; 2]>,
    /// The width of the page in millimetres.
    pub width: f64,
}

/// One of the two volumes: how points of the world come into it.
struct Panel<'a> {
    title: &'a str,
    /// From the canonical volume, as homogeneous coordinates, into the space that is shown.
    shown_from_canonical: Matrix4,
    with_eye: bool,
}

/// What is followed, in the canonical volume before the division.
struct Followed {
    points: Vec<Homogeneous3>,
    segments: Vec<[Homogeneous3; 2]>,
}

/// Draws both volumes.
///
/// # Errors
/// [`ViewingError`], where the scene's camera is degenerate, or the planes are.
pub fn draw_stages(scene: &CompiledScene, picture: &StagePicture) -> Result<Page, ViewingError> {
    let [width, height] = picture.pixels;
    let camera = Camera::new(&scene.camera, width, height, PixelGrid::Centers)?;
    let bounds = lines::finite_bounds(&scene.geometry);
    let screen = Screen::new(&camera, &bounds)?;
    let [near, far] = picture.planes.unwrap_or_else(|| shown_planes(&camera, &bounds));
    let pipeline = camera.pipeline(near, far)?;
    let options = LineOptions { crease_angle: picture.crease_angle, parameter_lines: 0 };
    let seen = lines::see(lines::gather(&scene.geometry, &screen, &options), &scene.geometry, &screen);
    // Chains of homogeneous points in the canonical volume, clipped to it.
    let into = pipeline.clip_from_world();
    let mut chains: Vec<Vec<Homogeneous3>> = Vec::new();
    for line in &seen {
        let curve = &line.line.feature.curve;
        for part in line.parts.iter().filter(|part| part.visible) {
            let track = screen.track(curve, [part.from, part.to]);
            let points: Vec<Homogeneous3> = track.iter().map(|sample| into.map(curve.point(sample.t))).collect();
            chains.extend(clipped_chain(&points));
        }
    }
    let followed = Followed {
        points: picture.points.iter().map(|p| into.map(*p)).collect(),
        segments: picture.segments.iter().map(|ends| ends.map(|p| into.map(p))).collect(),
    };
    let eye_from_canonical = eye_from_canonical(&pipeline);
    let panels = [
        Panel { title: "what the camera sees", shown_from_canonical: eye_from_canonical, with_eye: true },
        Panel { title: "the canonical volume", shown_from_canonical: Matrix4::IDENTITY, with_eye: false },
    ];
    let (panel_width, gap) = (0.48 * picture.width, 0.04 * picture.width);
    let panel_height = 0.85 * panel_width;
    let mut page = Page { width: picture.width, height: panel_height + 9.0, ..Page::default() };
    for (index, panel) in panels.iter().enumerate() {
        let left = index as f64 * (panel_width + gap);
        let place = Rectangle { left, right: left + panel_width, bottom: panel_height, top: 0.0 };
        draw_panel(panel, &pipeline, &chains, &followed, &place, &mut page)?;
    }
    Ok(page)
}

/// The map from the canonical volume to eye space, up to a factor.
fn eye_from_canonical(pipeline: &Pipeline) -> Matrix4 {
    let to_eye = pipeline.view * pipeline.world_from_canonical().unwrap_or(Matrix4::IDENTITY);
    // Either sign of h is the same point; inside of the volume it is to be positive.
    if to_eye.map(Point3::ORIGIN).h() < 0.0 { Matrix4(-to_eye.0) } else { to_eye }
}

/// The parts of a chain inside of the canonical volume.
fn clipped_chain(points: &[Homogeneous3]) -> Vec<Vec<Homogeneous3>> {
    let mut chains: Vec<Vec<Homogeneous3>> = Vec::new();
    let mut goes_on = false;
    for pair in points.windows(2) {
        let Some(part) = crate::viewing::clip_segment(pair[0], pair[1]) else {
            goes_on = false;
            continue;
        };
        let end = pair[0].lerp(pair[1], part.to);
        match chains.last_mut() {
            Some(chain) if goes_on && part.from == 0.0 => chain.push(end),
            _ => chains.push(vec![pair[0].lerp(pair[1], part.from), end]),
        }
        goes_on = part.to == 1.0;
    }
    chains
}

fn draw_panel(
    panel: &Panel<'_>,
    pipeline: &Pipeline,
    chains: &[Vec<Homogeneous3>],
    followed: &Followed,
    place: &Rectangle,
    page: &mut Page,
) -> Result<(), ViewingError> {
    let show = |p: Homogeneous3| panel.shown_from_canonical.map(p).homogenize().ok();
    let corner = |index: usize| {
        let sign = |bit: usize| if index >> bit & 1 == 1 { 1.0 } else { -1.0 };
        show(Point3::new(sign(0), sign(1), sign(2)).into())
    };
    let corners: Vec<Point3> = (0..8).filter_map(corner).collect();
    if corners.len() < 8 {
        return Ok(());
    }
    let is_perspective = pipeline.projection == Projection::Perspective;
    let eye = (panel.with_eye && is_perspective).then_some(Point3::ORIGIN);
    // From the right, from above and from behind the volume's near side, at everything.
    let all: Vec<Point3> = corners.iter().copied().chain(eye).collect();
    let center = all.iter().fold(Vector3::ZERO, |sum, p| sum + p.to_vector()) * (1.0 / all.len() as f64);
    let center = Point3::ORIGIN + center;
    let [x, y] = [portable::radians(38.0), portable::radians(24.0)];
    let toward =
        Vector3::new(portable::sin(x) * portable::cos(y), portable::sin(y), portable::cos(x) * portable::cos(y));
    let raster = Rectangle { left: 0.0, right: 1000.0, bottom: 850.0, top: 0.0 };
    let size = all.iter().map(|p| p.distance(center)).fold(0.0, f64::max);
    let looking = |width: f64, center: Point3| {
        let eye = center + toward * (4.0 * size);
        let frame = scene::Frame::OrthographicWidth(width);
        Camera::new(
            &scene::Camera { eye, gaze: -toward, up: Vector3::Y, frame, lens: None },
            1000,
            850,
            PixelGrid::Centers,
        )
    };
    // Fitted to what is to be seen, with room for labels.
    let first = looking(2.0 * size, center)?;
    let seen: Vec<[f64; 2]> = all.iter().filter_map(|p| first.project(*p).map(|r| [r.x, r.y])).collect();
    let extent = |axis: usize| {
        seen.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p[axis]), high.max(p[axis])))
    };
    let ((x0, x1), (y0, y1)) = (extent(0), extent(1));
    let unit = 2.0 * size / 1000.0;
    let [right, up, _] = first.axes();
    let center = center + right * (unit * (0.5 * (x0 + x1) - 500.0)) - up * (unit * (0.5 * (y0 + y1) - 425.0));
    let share = ((x1 - x0) / 1000.0).max((y1 - y0) / 850.0);
    let camera = looking(2.0 * size * share / 0.82, center)?;
    let bounds = all.iter().fold(snell_math::Bounds3::EMPTY, |all, p| all.including(*p));
    let screen = Screen::new(&camera, &bounds)?;
    let map = RectangleMap::new(&raster, place)?;
    let on = |p: Point3| {
        let raster = screen.raster(screen.clip(p.into()));
        map.point(raster)
    };

    let stroke = |color: [u8; 3], width: f64, dashes: &[f64]| Some(Stroke { color, width, dashes: dashes.to_vec() });
    let line = |a: Point3, b: Point3| Subpath::polyline(&[on(a), on(b)]);
    let mut volume = Group { name: format!("{}: volume", panel.title), items: Vec::new() };
    // Corner bits are x, y, z; z = 1 is the near side.
    let edges = |keep: &dyn Fn(usize, usize) -> bool| -> Vec<Subpath> {
        let pairs =
            (0..8_usize).flat_map(|a| (0..3).map(move |bit| (a, a | 1 << bit))).filter(|(a, b)| a != b && keep(*a, *b));
        pairs.map(|(a, b)| line(corners[a], corners[b])).collect()
    };
    let is_near = |a: usize, b: usize| a & b & 4 != 0;
    volume.items.push(Item::Path(Path {
        subpaths: edges(&|a, b| !is_near(a, b)),
        stroke: stroke([32, 72, 168], 0.25, &[]),
        fill: None,
    }));
    volume.items.push(Item::Path(Path {
        subpaths: edges(&is_near),
        stroke: stroke([32, 72, 168], 0.5, &[]),
        fill: None,
    }));
    if let Some(eye) = eye {
        let rays = [4, 5, 6, 7].map(|index| line(eye, corners[index]));
        volume.items.push(Item::Path(Path {
            subpaths: rays.to_vec(),
            stroke: stroke([32, 72, 168], 0.2, &[1.2, 1.0]),
            fill: None,
        }));
        volume.items.push(Item::Path(Path {
            subpaths: vec![Subpath::ellipse(on(eye), [0.8; 2], 0.0)],
            stroke: None,
            fill: Some([32, 72, 168]),
        }));
    }
    page.groups.push(volume);

    let shown: Vec<Subpath> = chains
        .iter()
        .map(|chain| {
            let points: Vec<Point3> = chain.iter().filter_map(|p| show(*p)).collect();
            let curve = Feature::new(FeatureKind::Crease, Curve::Polyline(points.clone()));
            let end = points.len().saturating_sub(1) as f64;
            on_page(&pen::write(&screen, &curve.curve, 0.0, end), &map)
        })
        .collect();
    let lines = Path { subpaths: vector::join(shown, 1e-3), stroke: stroke([0; 3], 0.3, &[]), fill: None };
    page.groups.push(Group { name: format!("{}: scene", panel.title), items: vec![Item::Path(lines)] });

    let blue = [32, 72, 168];
    let mut labels = Group { name: format!("{}: labels", panel.title), items: Vec::new() };
    let mut text = |markup: &str, at: [f64; 2], horizontal: Horizontal, color: [u8; 3], size: f64| {
        // What is followed lies within the lines of the scene, which its names should not wipe out.
        let halo = color == blue;
        let text = Text { at, horizontal, vertical: Vertical::Middle, size, halo, ..label_text(markup, color) };
        labels.items.push(Item::Text(text));
    };
    let beside = |p: Point3, dx: f64, dy: f64| {
        let [x, y] = on(p);
        [x + dx, y + dy]
    };
    let number = |z: f64| short(z);
    let volume_of = &pipeline.volume;
    let (near, far) = if panel.with_eye {
        (format!("*n* = {}", number(volume_of.near)), format!("*f* = {}", number(volume_of.far)))
    } else {
        ("*z* = 1".to_owned(), "*z* = −1".to_owned())
    };
    text(&near, beside(corners[4], 0.0, 3.4), Horizontal::Center, blue, LABEL);
    text(&far, beside(corners[1], 0.0, 3.4), Horizontal::Center, blue, LABEL);
    if let Some(eye) = eye {
        text("*e*", beside(eye, 2.0, 1.2), Horizontal::Left, blue, LABEL);
    }
    text(panel.title, [0.5 * (place.left + place.right), place.bottom + 4.5], Horizontal::Center, [0; 3], 4.0);
    let red = [196, 40, 28];
    let mut put = |name: String, at: Homogeneous3, groups: &mut Vec<Group>| {
        let Some(shown) = show(at).filter(|_| crate::viewing::outside(at).next().is_none()) else { return };
        page_dot(groups, on(shown), red);
        text(&name, beside(shown, 1.4, -1.6), Horizontal::Left, red, LABEL);
    };
    for (index, p) in followed.points.iter().enumerate() {
        put(format!("*p*_{}", index + 1), *p, &mut page.groups);
    }
    for (index, [a, b]) in followed.segments.iter().enumerate() {
        put(format!("*a*_{}", index + 1), *a, &mut page.groups);
        put(format!("*b*_{}", index + 1), *b, &mut page.groups);
        let Some(part) = crate::viewing::clip_segment(*a, *b) else { continue };
        let (Some(from), Some(to)) = (show(a.lerp(*b, part.from)), show(a.lerp(*b, part.to))) else { continue };
        let path = Path { subpaths: vec![line(from, to)], stroke: stroke(red, 0.45, &[]), fill: None };
        page.groups.push(Group { name: format!("{}: segment", panel.title), items: vec![Item::Path(path)] });
    }
    page.groups.push(labels);
    Ok(())
}

fn page_dot(groups: &mut Vec<Group>, at: [f64; 2], color: [u8; 3]) {
    let dot = Path { subpaths: vec![Subpath::ellipse(at, [0.8; 2], 0.0)], stroke: None, fill: Some(color) };
    groups.push(Group { name: "followed point".to_owned(), items: vec![Item::Path(dot)] });
}

/// A number to four digits, with a minus sign as it is printed.
fn short(x: f64) -> String {
    let text = format!("{x:.3}");
    text.trim_end_matches('0').trim_end_matches('.').replace('-', "−")
}

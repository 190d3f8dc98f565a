//! `snell view`: the viewing matrices of a scene's camera, and points and segments on their way through them.

use std::fmt::Write;

use serde_json::{Value, json};
use snell::camera::Camera;
use snell::drawing::{StagePicture, draw_stages, shown_planes};
use snell::math::{Homogeneous3, HomogenizeError, Matrix4, Point3};
use snell::scene::Diagnostic;
use snell::vector::encode_svg;
use snell::viewing::{Pipeline, PointStages, Projection, SegmentStages};

use crate::arguments::{ViewArguments, ViewFormat};
use crate::assets::FileAssets;
use crate::builtin;
use crate::console::write_stdout;
use crate::diagnostics;
use crate::failure::{FINE, Failure};
use crate::load::Place;
use crate::output::{check_writable, spare_sources, write_file};
use crate::render::compile;
use crate::settings;

/// A scene's view and what is followed through it.
struct View<'a> {
    name: &'a str,
    camera: &'a Camera,
    pipeline: &'a Pipeline,
    /// The planes were not the camera's own.
    planes_are_chosen: bool,
    points: Vec<PointStages>,
    segments: Vec<SegmentStages>,
}

/// Prints, and returns the exit code.
pub fn run(arguments: &ViewArguments) -> Result<u8, Failure> {
    let place = Place::find(arguments.scene.as_deref().unwrap_or(builtin::DEFAULT))?;
    if let Some(path) = &arguments.output {
        check_writable(path)?;
    }
    let assets = FileAssets::default();
    let (scene, mut told) = place.read(&arguments.set, &assets)?;
    let Some(mut scene) = scene else { return Err(Failure::scene(told)) };
    settings::apply_size((arguments.width, arguments.height), &mut scene.settings)?;
    if let Some(path) = &arguments.output {
        spare_sources(path, &assets)?;
    }
    let compiled = compile(&scene, &mut told)?;
    diagnostics::print(&told);
    let wrong = |error: snell::viewing::ViewingError| Failure::input(Diagnostic::error(error.to_string()));
    let pixels = [scene.settings.width, scene.settings.height];
    let camera = Camera::new(&scene.camera, pixels[0], pixels[1], scene.settings.pixel_grid).map_err(wrong)?;
    let shown = shown_planes(&compiled, &camera);
    let far = arguments.far.unwrap_or(shown[1]);
    let near = arguments.near.unwrap_or_else(|| if shown[0] > far { shown[0] } else { 0.1 * far });
    let pipeline = camera.pipeline(near, far).map_err(wrong)?;

    let at = |[x, y, z]: [f64; 3]| Point3::new(x, y, z);
    let points: Vec<Point3> = arguments.point.iter().copied().map(at).collect();
    let ends = |[a, b, c, d, e, f]: [f64; 6]| [at([a, b, c]), at([d, e, f])];
    let segments: Vec<[Point3; 2]> = arguments.segment.iter().copied().map(ends).collect();
    let view = View {
        name: place.name(),
        camera: &camera,
        pipeline: &pipeline,
        planes_are_chosen: arguments.near.is_none() && camera.planes()[0] == 0.0 || camera.planes()[1].is_infinite(),
        points: points.iter().map(|p| pipeline.follow(*p)).collect(),
        segments: segments.iter().map(|[a, b]| pipeline.follow_segment(*a, *b)).collect(),
    };
    let text = match arguments.format {
        ViewFormat::Text => as_text(&view),
        ViewFormat::Json => format!("{:#}\n", as_json(&view)),
        ViewFormat::Svg => {
            let crease_angle = scene.drawing.crease_angle;
            let picture = StagePicture {
                pixels,
                planes: Some([near, far]),
                crease_angle,
                points,
                segments,
                width: scene.drawing.width.max(160.0),
            };
            let page = draw_stages(&compiled, &picture).map_err(wrong)?;
            encode_svg(&page).map_err(|error| Failure::input(Diagnostic::error(error.to_string())))?
        }
    };
    match &arguments.output {
        None => write_stdout(text.as_bytes())?,
        Some(path) => write_file(path, text.as_bytes())?,
    }
    Ok(FINE)
}

/// A number for people: six digits, and nothing that is mere rounding.
fn number(x: f64) -> String {
    if x.abs() < 1e-12 {
        return "0".to_owned();
    }
    if !(1e-4..1e7).contains(&x.abs()) {
        return format!("{x:.5e}");
    }
    let text = format!("{x:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn triple(numbers: impl IntoIterator<Item = f64>) -> String {
    let numbers: Vec<String> = numbers.into_iter().map(number).collect();
    format!("({})", numbers.join(", "))
}

fn matrix(text: &mut String, name: &str, meaning: &str, matrix: &Matrix4) {
    let _ = writeln!(text, "\n{name:<4} {meaning}");
    let cells = matrix.rows().map(|row| row.map(number));
    let width = cells.as_flattened().iter().map(String::len).max().unwrap_or(0);
    for row in cells {
        let row: Vec<String> = row.iter().map(|cell| format!("{cell:>width$}")).collect();
        let _ = writeln!(text, "     | {} |", row.join("  "));
    }
}

fn as_text(view: &View<'_>) -> String {
    let View { camera, pipeline, .. } = view;
    let [width, height] = pipeline.pixels;
    let is_perspective = pipeline.projection == Projection::Perspective;
    let kind = if is_perspective { "perspective" } else { "orthographic" };
    let mut text = format!("The view of {}: {kind}, {width} x {height} pixels\n\n", view.name);
    let [u, v, w] = camera.axes();
    for (name, value, meaning) in [
        ("e", camera.eye().to_array(), "the eye"),
        ("u", u.to_array(), "to the right"),
        ("v", v.to_array(), "up"),
        ("w", w.to_array(), "back, against the gaze"),
    ] {
        let _ = writeln!(text, "  {name}  {:<36} {meaning}", triple(value));
    }
    let window = pipeline.volume.window;
    let sides = [window.left, window.right, window.bottom, window.top].map(number);
    let (near, far) = (number(pipeline.volume.near), number(pipeline.volume.far));
    let _ = writeln!(text, "  [l, r] x [b, t] = [{}, {}] x [{}, {}]", sides[0], sides[1], sides[2], sides[3]);
    let chosen = if view.planes_are_chosen { ", chosen around the scene: the camera has no such planes" } else { "" };
    let _ = writeln!(text, "  n = {near}, f = {far}{chosen}");

    matrix(&mut text, "M_v", "world to eye space: rows u, v, w, after a move by -e", &pipeline.view);
    let meaning = if is_perspective {
        "perspective: (x, y, z, 1) to (n x, n y, (n + f) z - f n, z)"
    } else {
        "nothing to do: the projection is parallel"
    };
    matrix(&mut text, "M_p", meaning, &pipeline.perspective);
    matrix(
        &mut text,
        "M_o",
        "the box [l, r] x [b, t] x [f, n] to pixels, centres at whole numbers, y up",
        &pipeline.orthographic(),
    );
    matrix(&mut text, "M", "M_o M_p M_v: world to pixels, to be divided by h", &pipeline.all());

    for (index, point) in view.points.iter().enumerate() {
        let _ = writeln!(text, "\nPoint {}", index + 1);
        point_text(&mut text, point, camera);
        let _ = writeln!(text, "  {}", verdict(point));
    }
    for (index, segment) in view.segments.iter().enumerate() {
        let _ = writeln!(text, "\nSegment {}", index + 1);
        for (name, end) in ["from", "to"].into_iter().zip(&segment.ends) {
            let _ = writeln!(text, " {name}");
            point_text(&mut text, end, camera);
        }
        let _ = writeln!(text, "{}", clip_text(segment, camera));
    }
    text
}

fn point_text(text: &mut String, point: &PointStages, camera: &Camera) {
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:<12} {value}");
    };
    line("world", triple(point.world.to_array()));
    line("eye space", triple(point.eye.to_array()));
    line("projected", homogeneous(point.projected));
    line("canonical", divided(&point.canonical));
    line("pixel", divided_2(&point.pixel));
    if let Ok(pixel) = &point.pixel
        && point.clip.h() > 0.0
    {
        let raster = camera.raster_from_pixel([pixel.x(), pixel.y()]);
        line("raster", format!("{}  from the upper left corner, y down", triple(raster)));
    }
}

fn homogeneous(p: Homogeneous3) -> String {
    let [x, y, z, h] = p.to_array().map(number);
    format!("({x}, {y}, {z}; h = {h})")
}

fn divided(point: &Result<Point3, HomogenizeError>) -> String {
    match point {
        Ok(point) => triple(point.to_array()),
        Err(error) => error.to_string(),
    }
}

fn divided_2(point: &Result<Point3, HomogenizeError>) -> String {
    match point {
        Ok(point) => triple([point.x(), point.y()]),
        Err(_) => "none".to_owned(),
    }
}

/// Whether a point is seen.
fn verdict(point: &PointStages) -> String {
    if point.outside.is_empty() {
        return "inside of the view volume".to_owned();
    }
    if point.clip.h() <= 0.0 {
        return if point.clip.h() == 0.0 { "in the eye's plane: clipped" } else { "behind the eye: clipped" }
            .to_owned();
    }
    let sides: Vec<&str> = point.outside.iter().map(|side| side.name()).collect();
    format!("outside, beyond the {} side{}: clipped", sides.join(" and the "), if sides.len() == 1 { "" } else { "s" })
}

fn clip_text(segment: &SegmentStages, camera: &Camera) -> String {
    let (Some(clipped), Some(visible)) = (segment.clipped, &segment.visible) else {
        return "  clipped as a whole: no part of it is inside of the view volume".to_owned();
    };
    let mut text = String::new();
    for (end, t, side) in [("beginning", clipped.from, clipped.entered), ("end", clipped.to, clipped.left)] {
        if let Some(side) = side {
            let _ = writeln!(text, "  its {end} is clipped by the {} side, at t = {}", side.name(), number(t));
        }
    }
    if text.is_empty() {
        text = "  inside of the view volume as a whole\n".to_owned();
    }
    let at = |point: &PointStages| match &point.pixel {
        Ok(pixel) => triple(camera.raster_from_pixel([pixel.x(), pixel.y()])),
        Err(error) => error.to_string(),
    };
    let _ = write!(text, "  drawn from raster {} to {}", at(&visible[0]), at(&visible[1]));
    text
}

fn as_json(view: &View<'_>) -> Value {
    let View { camera, pipeline, .. } = view;
    let [u, v, w] = camera.axes().map(|axis| axis.to_array());
    let window = pipeline.volume.window;
    let projection = if pipeline.projection == Projection::Perspective { "perspective" } else { "orthographic" };
    json!({
        "scene": view.name,
        "pixels": pipeline.pixels,
        "projection": projection,
        "eye": camera.eye().to_array(),
        "u": u,
        "v": v,
        "w": w,
        "window": { "left": window.left, "right": window.right, "bottom": window.bottom, "top": window.top },
        "near": pipeline.volume.near,
        "far": pipeline.volume.far,
        "matrices": {
            "view": pipeline.view.rows(),
            "perspective": pipeline.perspective.rows(),
            "canonical": pipeline.canonical.rows(),
            "pixel": pipeline.pixel.rows(),
            "orthographic": pipeline.orthographic().rows(),
            "all": pipeline.all().rows(),
        },
        "points": view.points.iter().map(|point| point_json(point, camera)).collect::<Vec<_>>(),
        "segments": view.segments.iter().map(|segment| segment_json(segment, camera)).collect::<Vec<_>>(),
    })
}

fn point_json(point: &PointStages, camera: &Camera) -> Value {
    let divided = |p: &Result<Point3, HomogenizeError>| p.as_ref().ok().map(|p| p.to_array());
    let pixel = point.pixel.as_ref().ok().map(|p| [p.x(), p.y()]);
    json!({
        "world": point.world.to_array(),
        "eye": point.eye.to_array(),
        "projected": point.projected.to_array(),
        "clip": point.clip.to_array(),
        "canonical": divided(&point.canonical),
        "pixel": pixel,
        "raster": pixel.map(|pixel| camera.raster_from_pixel(pixel)),
        "outside": point.outside.iter().map(|side| side.name()).collect::<Vec<_>>(),
    })
}

fn segment_json(segment: &SegmentStages, camera: &Camera) -> Value {
    let ends = |ends: &[PointStages; 2]| json!([point_json(&ends[0], camera), point_json(&ends[1], camera)]);
    json!({
        "ends": ends(&segment.ends),
        "clipped": segment.clipped.map(|part| json!({
            "from": part.from,
            "to": part.to,
            "entered": part.entered.map(|side| side.name()),
            "left": part.left.map(|side| side.name()),
        })),
        "visible": segment.visible.as_ref().map(ends),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_say_nothing_of_rounding() {
        for (x, text) in
            [(0.5, "0.5"), (-1.0, "-1"), (1e-17, "0"), (319.5, "319.5"), (1.5e-7, "1.50000e-7"), (2e9, "2.00000e9")]
        {
            assert_eq!(number(x), text);
        }
    }
}

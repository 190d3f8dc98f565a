//! `snell draw`: a scene as lines, written as SVG, PDF or PNG.

use std::path::{Path, PathBuf};

use snell::compile::CompiledScene;
use snell::drawing::{DrawingSettings, draw};
use snell::image::{Limits, PngOptions, decode_display, encode_png};
use snell::scene::scene::{AxesLength, CameraMark, Drawing, GroundGrid, HiddenLines, StrokeBy};
use snell::scene::{Diagnostic, Scene};
use snell::vector::{Page, encode_pdf, encode_svg, rasterize};

use crate::arguments::{DrawArguments, HiddenName, StrokeName};
use crate::assets::FileAssets;
use crate::builtin;
use crate::console::{count, quoted, say, write_stdout};
use crate::diagnostics;
use crate::failure::{FINE, Failure};
use crate::load::Place;
use crate::output::{SOFTWARE, check_writable, spare_sources, write_file};
use crate::render::compile;
use crate::settings;
use crate::statistics::{Stopwatch, seconds_text};

/// The format of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Scalable Vector Graphics.
    Svg,
    /// Portable Document Format.
    Pdf,
    /// Pixels.
    Png,
}

/// Draws as the command line says, and returns the exit code.
pub fn run(arguments: &DrawArguments, watch: Stopwatch) -> Result<u8, Failure> {
    let place = Place::find(arguments.scene.as_deref().unwrap_or(builtin::DEFAULT))?;
    let (path, format) = target(arguments, &place.stem())?;
    if let Some(path) = &path {
        check_writable(path)?;
    }
    let assets = FileAssets::default();
    let (scene, mut told) = place.read(&arguments.set, &assets)?;
    let Some(mut scene) = scene else { return Err(Failure::scene(told)) };
    let pixels = (arguments.width, arguments.height);
    settings::apply_size(pixels, &mut scene.settings)?;
    apply(arguments, &mut scene, &assets)?;
    let under = arguments.over.as_deref().map(|path| backdrop(path, &scene, &assets)).transpose()?;
    if let Some(path) = &path {
        spare_sources(path, &assets)?;
    }
    let compiled: CompiledScene = compile(&scene, &mut told)?;
    diagnostics::print(&told);
    let drawing = DrawingSettings { under, ..DrawingSettings::new(&scene) };
    let page = draw(&compiled, &drawing).map_err(|error| Failure::input(Diagnostic::error(error.to_string())))?;
    let bytes = encode(&page, format, drawing.width)?;
    match &path {
        None => write_stdout(&bytes)?,
        Some(path) => write_file(path, &bytes)?,
    }
    if let (Some(path), false) = (&path, arguments.quiet) {
        let size = format!("{:.0} x {:.0} mm", page.width, page.height);
        let groups = count(page.groups.len(), "group");
        say(format_args!("wrote {} ({size}, {groups}, {})", path.display(), seconds_text(watch.total())));
    }
    Ok(FINE)
}

/// Where the drawing goes, and as what; no path is standard output.
fn target(arguments: &DrawArguments, stem: &str) -> Result<(Option<PathBuf>, Format), Failure> {
    let Some(path) = &arguments.output else { return Ok((Some(PathBuf::from(format!("{stem}.svg"))), Format::Svg)) };
    if path.as_os_str() == "-" {
        return Ok((None, Format::Svg));
    }
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    let format = match ending.as_deref() {
        Some("svg") => Format::Svg,
        Some("pdf") => Format::Pdf,
        Some("png") => Format::Png,
        _ => {
            let shown = quoted(&path.to_string_lossy());
            let message = format!("the ending of {shown} says no format that a drawing can have");
            let help = "end it with .svg, .pdf or .png; `-o -` writes an SVG to standard output";
            return Err(Failure::usage(Diagnostic::error(message).help(help)));
        }
    };
    Ok((Some(path.clone()), format))
}

/// The command line's word over the scene's own drawing.
fn apply(arguments: &DrawArguments, scene: &mut Scene, assets: &FileAssets) -> Result<(), Failure> {
    let drawing: &mut Drawing = &mut scene.drawing;
    if let Some(hidden) = arguments.hidden {
        drawing.hidden = match hidden {
            HiddenName::Removed => HiddenLines::Removed,
            HiddenName::Dashed => HiddenLines::Dashed,
            HiddenName::Kept => HiddenLines::Kept,
        };
    }
    if let Some(stroke) = arguments.stroke {
        drawing.stroke = match stroke {
            StrokeName::Uniform => StrokeBy::Uniform,
            StrokeName::Object => StrokeBy::Object,
            StrokeName::Material => StrokeBy::Material,
            StrokeName::Depth => StrokeBy::Depth,
        };
    }
    if let Some(width) = arguments.page_width {
        drawing.width = width;
    }
    if let Some(width) = arguments.line_width {
        drawing.line_width = width;
    }
    if let Some(angle) = arguments.crease {
        drawing.crease_angle = snell::math::portable::radians(angle);
    }
    if let Some(lines) = arguments.parameter_lines {
        drawing.parameter_lines = lines;
    }
    if arguments.axes {
        drawing.axes = Some(AxesLength::Fitting);
    }
    if let Some(spacing) = arguments.grid {
        drawing.ground_grid = Some(GroundGrid { spacing, extent: 10.0 * spacing, height: 0.0, center: [0.0, 0.0] });
    }
    if let Some(title) = &arguments.title {
        drawing.title = Some(title.clone());
    }
    drawing.scale_bar |= arguments.scale;
    drawing.frame |= arguments.frame;
    if let Some(name) = &arguments.frustum {
        let mark = frustum(name, assets)?;
        drawing.cameras.push(mark);
    }
    Ok(())
}

/// The camera of another scene, to be drawn.
fn frustum(name: &str, assets: &FileAssets) -> Result<CameraMark, Failure> {
    let (scene, told) = Place::find(name)?.read(&[], assets)?;
    let Some(scene) = scene else { return Err(Failure::scene(told)) };
    let compiled = CompiledScene::build(&scene)
        .map_err(|error| Failure::input(Diagnostic::error(format!("{}: {error}", quoted(name)))))?;
    let (width, height) = (scene.settings.width, scene.settings.height);
    let camera = snell::camera::Camera::new(&scene.camera, width, height, scene.settings.pixel_grid)
        .map_err(|error| Failure::input(Diagnostic::error(format!("{}: {error}", quoted(name)))))?;
    let [near, far] = snell::drawing::shown_planes(&compiled, &camera);
    let aspect = f64::from(width) / f64::from(height);
    Ok(CameraMark { name: Some(Place::find(name)?.stem()), ..CameraMark::new(scene.camera.clone(), aspect, near, far) })
}

/// The picture that the drawing is laid over: a PNG of the same proportions.
fn backdrop(path: &Path, scene: &Scene, assets: &FileAssets) -> Result<Vec<u8>, Failure> {
    let shown = quoted(&path.to_string_lossy());
    let wrong = |problem: String| Failure::input(Diagnostic::error(format!("{shown} cannot be drawn over: {problem}")));
    let bytes = assets.read_named(&path.to_string_lossy()).map_err(|error| wrong(error.to_string()))?;
    let picture = decode_display(&bytes, &Limits::default()).map_err(|error| wrong(error.to_string()))?;
    if !bytes.starts_with(b"\x89PNG") {
        return Err(wrong("it is no PNG".to_owned()));
    }
    let (width, height) = picture.size();
    let (w, h) = (scene.settings.width, scene.settings.height);
    let aspect = |w: u32, h: u32| f64::from(w) / f64::from(h);
    // Sizes are rounded to pixels, so proportions may be off by that.
    if (aspect(width, height) / aspect(w, h) - 1.0).abs() > 1.0 / f64::from(width.min(height).max(2) - 1) {
        let message = format!("it has {width}x{height} pixels and the scene {w}x{h}, which is another proportion");
        return Err(wrong(message));
    }
    Ok(bytes.to_vec())
}

/// The bytes of a page; a PNG has `width` pixels from left to right.
pub fn encode(page: &Page, format: Format, width: u32) -> Result<Vec<u8>, Failure> {
    let failed = |error: &dyn std::fmt::Display| Failure::input(Diagnostic::error(error.to_string()));
    match format {
        Format::Svg => encode_svg(page).map(String::into_bytes).map_err(|error| failed(&error)),
        Format::Pdf => encode_pdf(page).map_err(|error| failed(&error)),
        Format::Png => {
            let picture = rasterize(page, width).map_err(|error| failed(&error))?;
            let text = vec![("Software".to_owned(), SOFTWARE.to_owned())];
            encode_png(&picture, &PngOptions { text, ..PngOptions::default() }).map_err(|error| failed(&error))
        }
    }
}

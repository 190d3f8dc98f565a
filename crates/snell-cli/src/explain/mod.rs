//! `snell explain`: why a pixel looks as it does.

mod draw;
mod find;
mod json;
mod text;

use std::path::Path;

use snell::explain::{Explanation, Subject, explain_watched};
use snell::math::{Point3, Ray, Vector3};
use snell::render::{RenderSettings, Watch};
use snell::scene::Diagnostic;
use snell::trace::Scratch;

use crate::arguments::{ExplainArguments, ExplainFormat};
use crate::assets::FileAssets;
use crate::console::{quoted, write_stdout, write_styled};
use crate::diagnostics;
use crate::failure::{FINE, Failure};
use crate::load::Place;
use crate::output::{check_writable, spare_sources, write_file};
use crate::paths;
use crate::render::{compile, picture_settings, read};

/// A scene's picture, watched.
struct Picture<'a> {
    /// As messages call the scene.
    name: &'a str,
    watch: Watch<'a>,
}

/// Explains as the command line says, and returns the exit code.
pub fn run(arguments: &ExplainArguments) -> Result<u8, Failure> {
    if arguments.find.as_deref() == Some("list") {
        find::list()?;
        return Ok(FINE);
    }
    let Some(scene) = &arguments.scene else {
        let message = "--find looks for pixels of a scene, and none is given";
        return Err(Failure::usage(
            Diagnostic::error(message).help("name a scene, such as `snell explain lens --find tir`"),
        ));
    };
    let place = Place::find(scene)?;
    let format = format(arguments)?;
    if let Some(path) = &arguments.output {
        check_writable(path)?;
    }
    let assets = FileAssets::default();
    let (scene, mut told) = read(&arguments.picture, &place, &assets)?;
    if let Some(path) = &arguments.output {
        spare_sources(path, &assets)?;
    }
    let compiled = compile(&scene, &mut told)?;
    diagnostics::print(&told);
    let settings = picture_settings(&arguments.picture, &scene);
    let paths = paths::settings(&arguments.paths, &arguments.picture, &scene, &[])?;
    let subject = subject(arguments, &settings)?;
    let mut picture = Picture { name: place.name(), watch: paths::watch(&compiled, &settings, paths.as_ref())? };
    match subject {
        Some(subject) => {
            let told = explained(&mut picture, subject);
            put(arguments, format, &picture, &told, arguments.output.as_deref())?;
        }
        None if arguments.find.is_some() => find::run(arguments, format, &mut picture)?,
        None => find::seven_rays(arguments, &mut picture, &place.stem())?,
    }
    Ok(FINE)
}

/// The explanation of something in a picture.
fn explained(picture: &mut Picture<'_>, subject: Subject) -> Explanation {
    explain_watched(&mut picture.watch, subject, &mut Scratch::default())
}

fn failure(error: &dyn std::fmt::Display) -> Failure {
    Failure::input(Diagnostic::error(error.to_string()))
}

/// Writes an explanation where it is to go.
fn put(
    arguments: &ExplainArguments,
    format: ExplainFormat,
    picture: &Picture<'_>,
    explanation: &Explanation,
    output: Option<&Path>,
) -> Result<(), Failure> {
    let bytes = match format {
        ExplainFormat::Text => {
            let styled = text::text(picture, explanation, arguments.details);
            match output {
                None => return write_styled(&styled),
                Some(_) => anstream::adapter::strip_str(&styled).to_string().into_bytes(),
            }
        }
        ExplainFormat::Json => format!("{:#}\n", json::json(picture, explanation)).into_bytes(),
        ExplainFormat::Svg | ExplainFormat::Pdf | ExplainFormat::Png => {
            draw::bytes(arguments, format, picture, explanation, None)?
        }
    };
    match output {
        None => write_stdout(&bytes),
        Some(path) => write_file(path, &bytes),
    }
}

/// What the command line asks for, or what the file's ending says.
fn format(arguments: &ExplainArguments) -> Result<ExplainFormat, Failure> {
    let ending =
        arguments.output.as_ref().and_then(|path| path.extension()).map(|e| e.to_string_lossy().to_lowercase());
    if let Some(format) = arguments.format {
        return Ok(format);
    }
    Ok(match (ending.as_deref(), &arguments.output) {
        (_, None) | (Some("txt"), _) => ExplainFormat::Text,
        (Some("json"), _) => ExplainFormat::Json,
        (Some("svg"), _) => ExplainFormat::Svg,
        (Some("pdf"), _) => ExplainFormat::Pdf,
        (Some("png"), _) => ExplainFormat::Png,
        (_, Some(path)) => {
            let shown = quoted(&path.to_string_lossy());
            let message = format!("the ending of {shown} says no format that an explanation can have");
            let help = "end it with .txt, .json, .svg, .pdf or .png, or say --format";
            return Err(Failure::usage(Diagnostic::error(message).help(help)));
        }
    })
}

/// What is to be explained; `None` where that is to be found first.
fn subject(arguments: &ExplainArguments, settings: &RenderSettings) -> Result<Option<Subject>, Failure> {
    if let Some([x, y, z, dx, dy, dz]) = arguments.ray {
        let direction = Vector3::new(dx, dy, dz);
        if direction.try_normalize().is_none() {
            let message = "--ray has a direction without length: its last three numbers say where it goes";
            return Err(Failure::usage(Diagnostic::error(message)));
        }
        let ray = Ray::new(Point3::new(x, y, z), direction);
        return Ok(Some(Subject::Ray(ray, arguments.sample.unwrap_or(0))));
    }
    let Some(pixel) = arguments.pixel else {
        if arguments.sample.is_some() {
            let message = "--sample says which sample of a pixel, and there is no --pixel";
            return Err(Failure::usage(Diagnostic::error(message).help("add --pixel X,Y, or --ray")));
        }
        return Ok(None);
    };
    let [x, y] = pixel;
    let RenderSettings { width, height, .. } = *settings;
    if x >= width || y >= height {
        let message = format!("the pixel {x},{y} is outside of the picture, which has {width}x{height} pixels");
        let help = format!("the last pixel is {},{}; --width and --height change the picture", width - 1, height - 1);
        return Err(Failure::usage(Diagnostic::error(message).help(help)));
    }
    Ok(Some(match arguments.sample {
        Some(sample) => Subject::Sample(pixel, sample),
        None => Subject::Pixel(pixel),
    }))
}

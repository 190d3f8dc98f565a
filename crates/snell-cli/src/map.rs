//! `snell render --map`: one property of every pixel, in false colours.

use std::fmt::Write;
use std::path::Path;

use snell::explain::{MapError, PROPERTIES, Property, false_colors, map};
use snell::image::{ExrOptions, Layers, PngOptions, encode_exr, encode_png};
use snell::math::Rgb;
use snell::render::{Progress, Watch};
use snell::scene::Diagnostic;
use snell::scene::diagnostic::did_you_mean;

use crate::console::{quoted, write_stdout};
use crate::failure::Failure;
use crate::output::{Format, SOFTWARE, Target, write_file};

/// Prints which maps there are.
pub fn list() -> Result<(), Failure> {
    let mut text = String::new();
    for (name, what) in PROPERTIES {
        let _ = writeln!(text, "{name:<20}{what}");
    }
    write_stdout(text.as_bytes())
}

/// What the command line asks for.
pub fn property(name: &str) -> Result<Property, Failure> {
    name.parse().map_err(|error: MapError| {
        let help = match did_you_mean(name, PROPERTIES.iter().map(|(name, _)| *name)) {
            Some(near) => format!("did you mean {}?", quoted(near)),
            None => "`--map list` tells which there are".to_owned(),
        };
        Failure::usage(Diagnostic::error(error.to_string()).help(help))
    })
}

/// Makes the map and writes it: in false colours with their bar as a PNG, as plain numbers in all three components of an EXR.
pub fn render(
    watch: &mut Watch<'_>,
    property: &Property,
    target: &Target,
    progress: &dyn Progress,
) -> Result<(), Failure> {
    let failed = |error: &dyn std::fmt::Display| Failure::input(Diagnostic::error(error.to_string()));
    let values = map(watch, property, progress).map_err(|error| {
        let diagnostic = Diagnostic::error(error.to_string());
        let near = match &error {
            MapError::NoObject(name) => {
                let names = &watch.scene.object_names;
                let all: Vec<String> =
                    (0..names.len() as u32).filter_map(|number| Some(names.get(number)?.into_owned())).collect();
                did_you_mean(name, all.iter().map(String::as_str)).map(str::to_owned)
            }
            MapError::NoLight(name) => {
                did_you_mean(name, watch.light_names().iter().map(String::as_str)).map(str::to_owned)
            }
            MapError::Unknown(_) => None,
        };
        Failure::input(match near {
            Some(near) => diagnostic.help(format!("did you mean {}?", quoted(&near))),
            None => diagnostic,
        })
    })?;
    let format = match target {
        Target::Nowhere => return Ok(()),
        Target::Stdout(format) | Target::File(_, format) => *format,
    };
    let bytes = match format {
        Format::Png(_) => {
            let picture = false_colors(&values, property).map_err(|error| failed(&error))?;
            let text = vec![("Software".to_owned(), SOFTWARE.to_owned())];
            encode_png(&picture, &PngOptions { text, ..PngOptions::default() }).map_err(|error| failed(&error))?
        }
        Format::Exr => {
            let options = ExrOptions { software: Some(SOFTWARE.to_owned()), ..ExrOptions::default() };
            encode_exr(&values.map(|value| Rgb::gray(*value)), &Layers::default(), &options)
                .map_err(|error| failed(&error))?
        }
    };
    match target {
        Target::File(path, _) => write_file(Path::new(path), &bytes),
        _ => write_stdout(&bytes),
    }
}

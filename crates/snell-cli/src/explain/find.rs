//! Pixels that show something: listed, explained, or drawn as the lecture's seven rays.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use snell::explain::{PHENOMENA, Phenomenon, SEVEN_RAYS, Subject, find};
use snell::scene::Diagnostic;
use snell::scene::diagnostic::did_you_mean;

use super::{Picture, draw, explained, put};
use crate::arguments::{ExplainArguments, ExplainFormat};
use crate::console::{quoted, say, write_stdout};
use crate::failure::Failure;
use crate::output::{check_writable, write_file};

/// How many pixels are found unless the command line says it.
const COUNT: u32 = 5;

/// What the lecture calls its seven rays.
const SEVEN_TITLES: [&str; 7] = [
    "1. Specular highlight on the outside of the sphere",
    "2. Specular highlight on the inside of the sphere",
    "3. Reflection and refraction of the checkerboard",
    "4. Refraction that hits the background",
    "5. Local diffuse plus a reflection of the checkerboard",
    "6. Local diffuse in complete shadow",
    "7. Local diffuse in the shadow of the transparent sphere",
];

/// Prints what can be looked for.
pub fn list() -> Result<(), Failure> {
    let mut text = String::new();
    for (name, what) in PHENOMENA {
        let _ = writeln!(text, "{name:<27}{what}");
    }
    write_stdout(text.as_bytes())
}

/// Looks for what the command line asks for; lists the pixels, or, where a file or a format is wanted, explains the clearest one.
pub fn run(arguments: &ExplainArguments, format: ExplainFormat, picture: &mut Picture<'_>) -> Result<(), Failure> {
    let name = arguments.find.as_deref().unwrap_or_default();
    let phenomenon: Phenomenon = name.parse().map_err(|error: snell::explain::UnknownPhenomenon| {
        let names = PHENOMENA.iter().map(|(name, _)| *name);
        let help = match did_you_mean(name, names) {
            Some(near) => format!("did you mean {}?", quoted(near)),
            None => "`--find list` tells what there is".to_owned(),
        };
        Failure::usage(Diagnostic::error(error.to_string()).help(help))
    })?;
    if let Phenomenon::Object(object) = &phenomenon {
        check_object(picture, object)?;
    }
    let count = arguments.count.unwrap_or(COUNT) as usize;
    let found = find(&mut picture.watch, &phenomenon, count);
    let Some(best) = found.first() else {
        return Err(Failure::input(Diagnostic::error(format!(
            "no pixel of {} shows {}",
            quoted(picture.name),
            quoted(name)
        ))));
    };
    if arguments.output.is_some() || arguments.format.is_some() {
        let told = explained(picture, Subject::Sample(best.pixel, 0));
        return put(arguments, format, picture, &told, arguments.output.as_deref());
    }
    let mut text = String::new();
    for one in &found {
        let [x, y] = one.pixel;
        let _ = writeln!(text, "--pixel {:<12}{:.4}", format!("{x},{y}"), one.clearness);
    }
    write_stdout(text.as_bytes())
}

fn check_object(picture: &Picture<'_>, object: &str) -> Result<(), Failure> {
    let names = &picture.watch.scene.object_names;
    let all: Vec<String> = (0..names.len() as u32).filter_map(|number| Some(names.get(number)?.into_owned())).collect();
    if all.iter().any(|name| name == object) {
        return Ok(());
    }
    let diagnostic = Diagnostic::error(format!("the scene has no object called {}", quoted(object)));
    let near =
        did_you_mean(object, all.iter().map(String::as_str)).map(|near| format!("did you mean {}?", quoted(near)));
    Err(Failure::usage(match near {
        Some(help) => diagnostic.help(help),
        None => diagnostic,
    }))
}

/// The lecture's seven rays of a scene, each in a file of its own, or, as text, one after the other.
pub fn seven_rays(arguments: &ExplainArguments, picture: &mut Picture<'_>, stem: &str) -> Result<(), Failure> {
    let format = match (arguments.format, &arguments.output) {
        (Some(format), _) => format,
        (None, None) => ExplainFormat::Svg,
        (None, Some(_)) => super::format(arguments)?,
    };
    let mut missing = 0;
    for (number, (phenomenon, title)) in (1..).zip(SEVEN_RAYS.iter().zip(SEVEN_TITLES)) {
        let found = find(&mut picture.watch, phenomenon, 1);
        let Some(best) = found.first() else {
            say(format_args!("{title}: no pixel of {} shows it", quoted(picture.name)));
            missing += 1;
            continue;
        };
        let told = explained(picture, Subject::Sample(best.pixel, 0));
        let [x, y] = best.pixel;
        if format == ExplainFormat::Text && arguments.output.is_none() {
            write_stdout(format!("{}{title}\n\n", if number > 1 { "\n" } else { "" }).as_bytes())?;
            put(arguments, format, picture, &told, None)?;
            continue;
        }
        let path = numbered(arguments.output.as_deref(), stem, number, format);
        check_writable(&path)?;
        match format {
            ExplainFormat::Text | ExplainFormat::Json => put(arguments, format, picture, &told, Some(&path))?,
            _ => write_file(&path, &draw::bytes(arguments, format, picture, &told, Some(title.to_owned()))?)?,
        }
        say(format_args!("wrote {} (pixel {x},{y}: {title})", path.display()));
    }
    if missing == SEVEN_RAYS.len() {
        let message = format!("{} shows none of the lecture's seven rays", quoted(picture.name));
        let help = "say --pixel X,Y, --ray or --find, or look at the built-in scene seven-rays";
        return Err(Failure::input(Diagnostic::error(message).help(help)));
    }
    Ok(())
}

/// `NAME-3.svg` for the third of the files that belong to `NAME.svg`.
fn numbered(output: Option<&Path>, stem: &str, number: u32, format: ExplainFormat) -> PathBuf {
    let ending = match format {
        ExplainFormat::Text => "txt",
        ExplainFormat::Json => "json",
        ExplainFormat::Svg => "svg",
        ExplainFormat::Pdf => "pdf",
        ExplainFormat::Png => "png",
    };
    match output {
        None => PathBuf::from(format!("{stem}-{number}.{ending}")),
        Some(path) => {
            let name = path.file_stem().map_or_else(|| stem.to_owned(), |name| name.to_string_lossy().into_owned());
            let ending = path.extension().map_or_else(|| ending.to_owned(), |e| e.to_string_lossy().into_owned());
            path.with_file_name(format!("{name}-{number}.{ending}"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_numbered_before_their_ending() {
        let named = |output: Option<&str>| numbered(output.map(Path::new), "lens", 3, ExplainFormat::Svg);
        assert_eq!(named(None), Path::new("lens-3.svg"));
        assert_eq!(named(Some("a/b.pdf")), Path::new("a/b-3.pdf"));
        assert_eq!(named(Some("a/b")), Path::new("a/b-3.svg"));
    }
}

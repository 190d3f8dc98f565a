//! `snell glass`: the catalogue of transparent materials, listed and searched; one material with all that is known of it; its
//! index at a wavelength, and drawn.

mod draw;
mod report;

use snell::math::Dispersion;
use snell::math::dispersion::{air_index, air_wavelength, vacuum_wavelength};
use snell::scene::assets::Assets;
use snell::scene::catalogue::{self, Glass, Medium};
use snell::scene::diagnostic::did_you_mean;
use snell::scene::{Diagnostic, Diagnostics};

use crate::arguments::{GlassArguments, GlassFormat, MediumName};
use crate::assets::FileAssets;
use crate::console::{quoted, write_stdout};
use crate::diagnostics;
use crate::failure::{FINE, Failure};
use crate::output::{check_writable, spare_sources, write_file};

/// The index at a wavelength that was asked for.
struct Answer {
    air_nm: f64,
    vacuum_nm: f64,
    /// What the wavelength was given in, and the index is relative to.
    medium: Medium,
    index: f64,
}

impl Answer {
    /// The index of a glass at a wavelength measured in a medium, relative to that medium.
    fn new(glass: &Glass, nm: f64, medium: Medium) -> Self {
        let (air_nm, vacuum_nm) = match medium {
            Medium::Air => (nm, vacuum_wavelength(nm)),
            Medium::Vacuum => (air_wavelength(nm), nm),
        };
        let own = match glass.reference {
            Medium::Air => air_nm,
            Medium::Vacuum => vacuum_nm,
        };
        let index = glass.dispersion.index(own);
        let index = match (glass.reference, medium) {
            // A number of a table is what it is.
            _ if matches!(glass.dispersion, Dispersion::Constant(_)) => index,
            (Medium::Air, Medium::Vacuum) => index * air_index(vacuum_nm),
            (Medium::Vacuum, Medium::Air) => index / air_index(vacuum_nm),
            _ => index,
        };
        Self { air_nm, vacuum_nm, medium, index }
    }

    /// The wavelength as it was given.
    fn given_nm(&self) -> f64 {
        match self.medium {
            Medium::Air => self.air_nm,
            Medium::Vacuum => self.vacuum_nm,
        }
    }

    /// The wavelength as the glass's formula has it.
    fn own_nm(&self, glass: &Glass) -> f64 {
        match glass.reference {
            Medium::Air => self.air_nm,
            Medium::Vacuum => self.vacuum_nm,
        }
    }
}

/// A medium's name.
fn medium_name(medium: Medium) -> &'static str {
    match medium {
        Medium::Air => "air",
        Medium::Vacuum => "vacuum",
    }
}

/// Lists, or tells about one material.
pub fn run(arguments: &GlassArguments) -> Result<u8, Failure> {
    if let Some(path) = &arguments.output {
        check_writable(path)?;
    }
    let format = format(arguments)?;
    let assets = FileAssets::default();
    let glasses = chosen(arguments, &assets)?;
    let text = match &glasses[..] {
        [glass] if arguments.name.is_some() => {
            let answers = answers(glass, arguments);
            match format {
                GlassFormat::Text => report::text(glass, &answers, arguments.thickness),
                GlassFormat::Json => format!("{:#}\n", report::json(glass, &answers, arguments.thickness)),
                GlassFormat::Svg => draw::svg(glass)?,
            }
        }
        _ => {
            if !arguments.at.is_empty() || format == GlassFormat::Svg {
                let message = "--at and a drawing are for one material";
                return Err(Failure::usage(Diagnostic::error(message).help("name it, such as `snell glass N-BK7`")));
            }
            match format {
                GlassFormat::Json => {
                    let all = glasses.iter().map(|glass| report::json(glass, &[], arguments.thickness)).collect();
                    format!("{:#}\n", serde_json::Value::Array(all))
                }
                _ => report::list(&glasses),
            }
        }
    };
    match &arguments.output {
        None => write_stdout(text.as_bytes())?,
        Some(path) => {
            spare_sources(path, &assets)?;
            write_file(path, text.as_bytes())?;
        }
    }
    Ok(FINE)
}

fn format(arguments: &GlassArguments) -> Result<GlassFormat, Failure> {
    let Some(path) = &arguments.output else { return Ok(arguments.format.unwrap_or(GlassFormat::Text)) };
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    let by_ending = match ending.as_deref() {
        Some("svg") => Some(GlassFormat::Svg),
        Some("json") => Some(GlassFormat::Json),
        Some("txt") => Some(GlassFormat::Text),
        _ => None,
    };
    arguments.format.or(by_ending).ok_or_else(|| {
        let message = format!("the ending of {} says no format", quoted(&path.to_string_lossy()));
        Failure::usage(Diagnostic::error(message).help("end it with .svg, .json or .txt, or say --format"))
    })
}

/// The materials that are meant: one of that name, those of a file, or all; those among them that are searched for.
fn chosen(arguments: &GlassArguments, assets: &FileAssets) -> Result<Vec<Glass>, Failure> {
    let mut glasses = match &arguments.name {
        None => catalogue::entries().map(Glass::from).collect(),
        Some(name) if catalogue::is_glass_file(name) => of_file(name, assets)?,
        Some(name) => vec![named(name)?],
    };
    if let Some(search) = &arguments.search {
        let search = search.to_lowercase();
        let has = |text: &str| text.to_lowercase().contains(&search);
        glasses.retain(|glass| has(&glass.name) || has(&glass.description) || has(&glass.source));
        if glasses.is_empty() {
            let message = format!("no material has {} in its name, description or source", quoted(&search));
            return Err(Failure::input(Diagnostic::error(message).help("`snell glass` lists all")));
        }
    }
    Ok(glasses)
}

fn named(name: &str) -> Result<Glass, Failure> {
    catalogue::lookup(name).map(Glass::from).ok_or_else(|| {
        let diagnostic = Diagnostic::error(format!("there is no material {} in the catalogue", quoted(name)));
        Failure::input(match catalogue::suggest(name) {
            Some(near) => diagnostic.help(format!("did you mean {}?", quoted(near))),
            None => diagnostic.help("`snell glass` lists all; `--search` looks for words"),
        })
    })
}

/// The glasses of a file, or the one of it that is named. What is wrong in the file is told.
fn of_file(name: &str, assets: &FileAssets) -> Result<Vec<Glass>, Failure> {
    let (path, wanted) = match name.rsplit_once('#') {
        Some((path, wanted)) if catalogue::is_glass_file(path) => (path, Some(wanted)),
        _ => (name, None),
    };
    let bytes = assets.read(path).map_err(|error| {
        Failure::input(Diagnostic::error(format!("the file {} cannot be had: {error}", quoted(path))))
    })?;
    let mut file = catalogue::read_glass_file(path, &bytes);
    let mut told = Diagnostics::default();
    for problem in &file.problems {
        let what = if problem.glass.is_empty() { String::new() } else { format!("{}: ", problem.glass) };
        told.push(Diagnostic::warning(format!("{path}:{}: {what}{}", problem.line, problem.message)));
    }
    diagnostics::print(&told);
    if let Some(wanted) = wanted {
        let names: Vec<String> = file.glasses.iter().map(|glass| glass.name.clone()).collect();
        file.glasses.retain(|glass| glass.name.eq_ignore_ascii_case(wanted));
        file.glasses.truncate(1);
        if file.glasses.is_empty() {
            let message = format!("the file {} has no glass {}", quoted(path), quoted(wanted));
            let diagnostic = Diagnostic::error(message);
            return Err(Failure::input(match did_you_mean(wanted, names.iter().map(String::as_str)) {
                Some(near) => diagnostic.help(format!("did you mean {}?", quoted(near))),
                None => diagnostic,
            }));
        }
    }
    if file.glasses.is_empty() {
        let message = format!("there is no glass that can be used in {}", quoted(path));
        return Err(Failure::input(Diagnostic::error(message)));
    }
    Ok(file.glasses)
}

/// What was asked for by wavelength; a formula asked outside of its range is told of.
fn answers(glass: &Glass, arguments: &GlassArguments) -> Vec<Answer> {
    let medium = match arguments.medium {
        Some(MediumName::Air) => Medium::Air,
        Some(MediumName::Vacuum) => Medium::Vacuum,
        None => glass.reference,
    };
    let answers: Vec<Answer> = arguments.at.iter().map(|nm| Answer::new(glass, *nm, medium)).collect();
    let mut told = Diagnostics::default();
    for answer in answers.iter().filter(|answer| !glass.covers(answer.own_nm(glass))) {
        if let Some(outside) = glass.outside() {
            told.push(Diagnostic::warning(format!("{outside}: {} nm is outside", answer.given_nm())));
        }
    }
    diagnostics::print(&told);
    answers
}

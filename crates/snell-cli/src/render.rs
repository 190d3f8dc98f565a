//! `snell render`: from the scene's name to the picture, one step after the other.

use std::time::Duration;

use snell::accel::BuildQuality;
use snell::compile::CompiledScene;
use snell::render::{PathSettings, RenderSettings, Rendering, render, render_paths, warnings};
use snell::scene::reader::nff;
use snell::scene::{Diagnostic, Diagnostics, Scene};
use snell::statistics::SamplePlace;

use crate::arguments::{PictureArguments, Preset, RenderArguments, StopArguments, word};
use crate::assets::FileAssets;
use crate::builtin;
use crate::console::{quoted, say, write_stdout};
use crate::diagnostics;
use crate::failure::{FINE, Failure};
use crate::interrupt::Interrupt;
use crate::load::Place;
use crate::map;
use crate::output::Target;
use crate::paths;
use crate::preview::{self, Kind};
use crate::progress::RenderProgress;
use crate::settings;
use crate::statistics::{Report, Stopwatch, Times, advice, seconds_text};

/// Samples of a pixel where something else is to end them.
const MOST_SAMPLES: u32 = 1 << 24;

/// Renders as the command line says, and returns the exit code.
pub fn run(arguments: &RenderArguments, mut watch: Stopwatch) -> Result<u8, Failure> {
    if arguments.map.as_deref() == Some("list") {
        map::list()?;
        return Ok(FINE);
    }
    // All that can be refused is refused before the work.
    let property = arguments.map.as_deref().map(map::property).transpose()?;
    let place = Place::find(arguments.scene.as_deref().unwrap_or(builtin::DEFAULT))?;
    let flags = [("--noise", arguments.stop.noise.is_some()), ("--time", arguments.stop.time.is_some())];
    if let (Some(_), Some((flag, _))) = (&property, flags.iter().find(|(_, is_given)| *is_given)) {
        let message = format!("{flag} ends pictures, not maps");
        return Err(Failure::usage(Diagnostic::error(message).help("say --samples N")));
    }
    let target = Target::new(arguments, &place.stem())?;
    let preview = if arguments.preview { Some(Kind::of_stdout()?) } else { None };
    target.check()?;
    start_threads(arguments.threads)?;

    let assets = FileAssets::default();
    let (scene, mut told) = read(&arguments.picture, &place, &assets)?;
    target.spares(&assets)?;
    let load = watch.lap();

    let compiled = compile_with(&scene, arguments.quality.into(), &mut told)?;
    let settings = render_settings(arguments, &scene);
    let paths = paths::settings(&arguments.paths, &arguments.picture, &scene, &flags)?;
    let paths = paths.map(|paths| until(paths, arguments));
    drop(scene);
    told.list.extend(warnings(&compiled, paths.as_ref()));
    diagnostics::print(&told);
    let build = watch.lap();

    let interrupt = Interrupt::listen()
        .map_err(|error| Failure::input(Diagnostic::error(format!("signals cannot be listened to: {error}"))))?;
    let progress = RenderProgress::start(interrupt.clone(), !arguments.quiet, arguments.stop.time);
    if let Some(property) = &property {
        let mut watched = paths::watch(&compiled, &settings, paths.as_ref())?;
        map::render(&mut watched, property, &target, &progress)?;
        drop(progress);
        if let (Some(name), false) = (target.name(), arguments.quiet) {
            say(format_args!("wrote {name} ({}, {})", property.title(), seconds_text(watch.total())));
        }
        return Ok(interrupt.code().unwrap_or(FINE));
    }
    let rendered = match &paths {
        Some(paths) => render_paths(&compiled, &settings, paths, &progress),
        None => render(&compiled, &settings, &progress),
    };
    let rendering = rendered.map_err(|error| Failure::input(Diagnostic::error(error.to_string())))?;
    let covered = progress.percent_covered();
    drop(progress);
    let render = watch.lap();

    target.write(&rendering, &settings)?;
    if let Some(kind) = preview {
        write_stdout(preview::text(kind, &rendering.image, &settings)?.as_bytes())?;
    }
    let write = watch.lap();

    let counted = Diagnostics {
        list: advice(&rendering.statistics, &settings, paths.as_ref(), &replay(arguments, &place, &rendering)),
        ..Diagnostics::default()
    };
    diagnostics::print(&counted);
    let times = Times { load, build, render, write, total: watch.total() };
    if !arguments.quiet {
        say_closing_line(arguments, &target, &rendering, times.total, covered);
    }
    if arguments.json {
        told.list.extend(counted.list);
        let report = Report {
            scene: place.name(),
            output: target.name(),
            settings: &settings,
            times,
            statistics: &rendering.statistics,
            size: compiled.size(),
            threads: rayon::current_num_threads(),
            complete: rendering.complete,
            warnings: told.list.iter().map(|one| diagnostics::one_line(one, &told.sources)).collect(),
        };
        write_stdout(format!("{:#}\n", report.json()).as_bytes())?;
    }
    Ok(interrupt.code().unwrap_or(FINE))
}

/// The command that explains the first sample that is no number.
fn replay(arguments: &RenderArguments, place: &Place, rendering: &Rendering) -> String {
    let Some(SamplePlace { x, y, sample }) = rendering.statistics.first_nonfinite else { return String::new() };
    let (words, of_paths) = (arguments.picture.words(), arguments.paths.words());
    format!("snell explain {} --pixel {x},{y} --sample {sample}{words}{of_paths}", word(place.name()))
}

/// One pool for all that runs in parallel, where a number of threads is asked for; else it is made when first needed.
fn start_threads(threads: Option<usize>) -> Result<(), Failure> {
    let Some(threads) = threads else { return Ok(()) };
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()
        .map_err(|error| Failure::input(Diagnostic::error(format!("{threads} threads cannot be started: {error}"))))
}

/// The scene with the command line's word over its settings, and its warnings.
pub fn read(arguments: &PictureArguments, place: &Place, assets: &FileAssets) -> Result<(Scene, Diagnostics), Failure> {
    let (scene, told) = place.read(&arguments.set, assets)?;
    let Some(mut scene) = scene else { return Err(Failure::scene(told)) };
    if arguments.preset == Some(Preset::Spd) {
        nff::spd_rules(&mut scene);
    }
    if scene.objects.is_empty() && !scene.plots.is_empty() {
        let name = place.name();
        let message = format!("{} has plots and no objects: there is nothing to render", quoted(name));
        let help = format!("`snell draw {name}` draws its plots");
        return Err(Failure::input(Diagnostic::error(message).help(help)));
    }
    settings::apply(arguments, &mut scene.settings)?;
    Ok((scene, told))
}

/// As [`compile_with`], with the usual work for hierarchies.
pub fn compile(scene: &Scene, told: &mut Diagnostics) -> Result<CompiledScene, Failure> {
    compile_with(scene, BuildQuality::Medium, told)
}

/// Compiles, and adds the engine's warnings to those of the reader.
fn compile_with(scene: &Scene, quality: BuildQuality, told: &mut Diagnostics) -> Result<CompiledScene, Failure> {
    match CompiledScene::with_quality(scene, quality) {
        Ok(mut compiled) => {
            told.list.append(&mut compiled.warnings);
            Ok(compiled)
        }
        Err(error) => {
            told.list.extend(error.diagnostics);
            Err(Failure::scene(std::mem::take(told)))
        }
    }
}

fn render_settings(arguments: &RenderArguments, scene: &Scene) -> RenderSettings {
    let defaults = picture_settings(&arguments.picture, scene);
    RenderSettings { tile_size: arguments.tile.unwrap_or(defaults.tile_size), layers: arguments.layers, ..defaults }
}

/// Samples without end where something else is to end them.
fn until(paths: PathSettings, arguments: &RenderArguments) -> PathSettings {
    let StopArguments { noise, time } = arguments.stop;
    let has_end = arguments.paths.samples.is_some() || (noise.is_none() && time.is_none());
    PathSettings { noise, samples: if has_end { paths.samples } else { MOST_SAMPLES }, ..paths }
}

/// How a picture is rendered, from a scene that [`read`] gave.
pub fn picture_settings(arguments: &PictureArguments, scene: &Scene) -> RenderSettings {
    RenderSettings { wavelength_nm: arguments.wavelength, ..RenderSettings::from(&scene.settings) }
}

/// `wrote x.png (1024x768, 0.21 s)`.
fn say_closing_line(
    arguments: &RenderArguments,
    target: &Target,
    rendering: &Rendering,
    total: Duration,
    covered: u64,
) {
    let (width, height) = rendering.image.size();
    let what = match target {
        Target::Nowhere => "rendered".to_owned(),
        Target::Stdout(_) => "wrote a PNG to standard output".to_owned(),
        Target::File(path, _) => format!("wrote {}", path.display()),
    };
    let end = match (rendering.complete, covered) {
        (true, _) => String::new(),
        (false, 100) => ", interrupted: its edges are not smooth everywhere".to_owned(),
        (false, covered) => format!(", interrupted: {} % of it is black", 100 - covered),
    };
    say(format_args!("{what} ({width}x{height}, {}){end}", seconds_text(total)));
    if arguments.scene.is_none() && arguments.output.is_none() && rendering.complete {
        say(format_args!("This is the built-in scene {}; `snell scenes` lists the others.", builtin::DEFAULT));
    }
}

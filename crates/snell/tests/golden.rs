//! Golden pictures: every scene in `scenes/` that has a light, or is for paths, is rendered small and must equal `goldens/NAME.png` in every bit.
//! The others are figures, to be drawn and not rendered.
//!
//! A test for each scene, named after it, so that `cargo xtask golden NAME` runs one of them. A scene without a picture fails,
//! and so does a picture without a scene. `cargo xtask golden --bless` renders all pictures anew.

#[path = "support/files.rs"]
mod files;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use libtest_mimic::{Arguments, Failed, Trial};
use snell::compile::CompiledScene;
use snell::image::{BitDepth, DisplayImage, ToneCurve};
use snell::math::color::srgb_to_linear;
use snell::render::{NoProgress, PathSettings, RenderSettings, render, render_paths};
use snell::scene::scene::IntegratorKind;
use snell_testkit::assert_golden;
use snell_testkit::golden::{Failure, check, is_blessing};

/// Pixels from left to right of a golden picture; its height follows from the scene's own proportions.
const WIDTH: u32 = 160;
/// The samples of a pixel where paths are traced.
const PATH_SAMPLES: u32 = 8;

fn main() {
    let arguments = Arguments::from_args();
    let scenes = rendered_scenes();
    let mut trials: Vec<Trial> = scenes.iter().map(|name| of_scene(name.clone())).collect();
    trials.push(Trial::test("every-golden-has-its-scene", || orphans(&rendered_scenes(), &stems(&goldens(), "png"))));
    trials.push(Trial::test("a-golden-without-scene-is-told", || {
        let names = |names: &[&str]| names.iter().map(ToString::to_string).collect();
        let failed = orphans(&names(&["a", "b"]), &names(&["b", "c"])).err().ok_or("an orphan was not told")?;
        if failed.message().is_some_and(|message| message.contains("`c`")) { Ok(()) } else { Err(failed) }
    }));
    // Where references are being written, nothing is compared, and so no defect can be caught.
    if !is_blessing() {
        trials.push(Trial::test("a-picture-that-is-off-by-one-is-told", move || {
            let name = scenes.first().ok_or("there is no scene")?;
            let report = Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden-report");
            match check(name, &off_by_one(&picture(name)), &goldens(), &report, false) {
                Err(Failure::Different { difference, .. }) if difference.pixels == 1 => Ok(()),
                other => Err(format!("one step in one pixel is told as {other:?}").into()),
            }
        }));
    }
    libtest_mimic::run(&arguments, trials).exit();
}

fn of_scene(name: String) -> Trial {
    Trial::test(name.clone(), move || {
        assert_golden(&name, &picture(&name), goldens());
        Ok(())
    })
}

fn goldens() -> PathBuf {
    files::root().join("goldens")
}

fn rendered_scenes() -> BTreeSet<String> {
    let mut names = stems(&files::root().join("scenes"), "toml");
    names.retain(|name| {
        let scene = files::scene_of_file(&format!("scenes/{name}.toml"));
        !scene.lights.is_empty() || scene.settings.integrator == IntegratorKind::Path
    });
    names
}

/// A scene as its golden picture shows it: with its own settings, but small, and where paths are traced with few samples.
fn picture(name: &str) -> DisplayImage {
    let scene = files::scene_of_file(&format!("scenes/{name}.toml"));
    let compiled = CompiledScene::build(&scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    let own = RenderSettings::from(&scene.settings);
    let height = (f64::from(own.height) * f64::from(WIDTH) / f64::from(own.width)).round().max(1.0) as u32;
    let settings = RenderSettings { width: WIDTH, height, ..own };
    let rendering = match scene.settings.integrator {
        IntegratorKind::Whitted => render(&compiled, &settings, &NoProgress),
        IntegratorKind::Path => {
            let paths = PathSettings { samples: PATH_SAMPLES, ..PathSettings::default() };
            render_paths(&compiled, &settings, &paths, &NoProgress)
        }
    };
    let rendering = rendering.unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(rendering.statistics.nonfinite_samples, 0, "{name}: samples that are no numbers");
    DisplayImage::develop(&rendering.image, settings.tone_curve(), settings.exposure, BitDepth::Eight)
}

/// The picture with one pixel brighter or darker by one step of the encoding.
fn off_by_one(picture: &DisplayImage) -> DisplayImage {
    let mut light = picture.to_linear();
    if let Some(pixel) = light.get_mut(0, 0) {
        let code = picture.code(0, 0)[0];
        let next = if code == 255 { 254 } else { code + 1 };
        pixel.r = srgb_to_linear(f32::from(next) / 255.0);
    }
    DisplayImage::develop(&light, ToneCurve::None, 0.0, BitDepth::Eight)
}

/// The names of a folder's files with an extension, without it.
fn stems(folder: &Path, extension: &str) -> BTreeSet<String> {
    let Ok(entries) = std::fs::read_dir(folder) else { return BTreeSet::new() };
    let paths = entries.filter_map(Result::ok).map(|entry| entry.path());
    let paths = paths.filter(|path| path.extension().is_some_and(|end| end == extension));
    paths.filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned())).collect()
}

/// Fails where a golden picture is of no scene.
fn orphans(scenes: &BTreeSet<String>, goldens: &BTreeSet<String>) -> Result<(), Failed> {
    let orphans: Vec<String> = goldens.difference(scenes).map(|name| format!("`{name}`")).collect();
    if orphans.is_empty() {
        Ok(())
    } else {
        Err(format!("golden pictures without a scene: {}", orphans.join(", ")).into())
    }
}

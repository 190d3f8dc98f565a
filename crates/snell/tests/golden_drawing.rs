//! Golden drawings: every scene in `scenes/` is drawn small, and its SVG must equal `goldens/drawings/NAME.svg` in every byte.
//!
//! A test for each scene, named after it. A difference is told by lines: which group of which drawing has gained or lost what, and
//! both drawings are left in `target/golden-report/` to be laid side by side. `cargo xtask golden --bless` writes all anew.

#[path = "support/files.rs"]
mod files;

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use libtest_mimic::{Arguments, Failed, Trial};
use snell::compile::CompiledScene;
use snell::drawing::{DrawingSettings, draw};
use snell::vector::encode_svg;
use snell_testkit::golden::is_blessing;

/// Pixels from left to right of the rendering that a golden drawing agrees with, and its width in millimetres.
const WIDTH: (u32, f64) = (320, 80.0);
/// How many different lines are told of one drawing.
const TOLD: usize = 12;

fn main() {
    let arguments = Arguments::from_args();
    let scenes = stems(&files::root().join("scenes"), "toml");
    let mut trials: Vec<Trial> = scenes.iter().map(|name| of_scene(name.clone())).collect();
    trials.push(Trial::test("every-golden-drawing-has-its-scene", move || {
        let drawings = stems(&folder(), "svg");
        let orphans: Vec<&String> = drawings.difference(&scenes).collect();
        if orphans.is_empty() { Ok(()) } else { Err(format!("golden drawings without a scene: {orphans:?}").into()) }
    }));
    trials.push(Trial::test("a-line-that-moved-is-told-with-its-group", || {
        let was = "<svg>\n<g id=\"ball\">\n<path d=\"M1 1L2 2\"/>\n</g>\n</svg>\n";
        let told = difference(was, &was.replace("L2 2", "L2 2.1")).ok_or("a moved line was not told")?;
        let has_both = told.contains("M1 1L2 2\"") && told.contains("M1 1L2 2.1") && told.contains("ball");
        if has_both && difference(was, was).is_none() { Ok(()) } else { Err(told.into()) }
    }));
    libtest_mimic::run(&arguments, trials).exit();
}

fn of_scene(name: String) -> Trial {
    Trial::test(name.clone(), move || {
        let actual = drawing(&name);
        let path = folder().join(format!("{name}.svg"));
        if is_blessing() {
            std::fs::create_dir_all(folder()).map_err(|error| error.to_string())?;
            return std::fs::write(&path, actual).map_err(|error| format!("{}: {error}", path.display()).into());
        }
        let Ok(expected) = std::fs::read_to_string(&path) else {
            return Err(format!("there is no {}; `cargo xtask golden --bless` writes it", path.display()).into());
        };
        compare(&name, &expected, &actual)
    })
}

fn compare(name: &str, expected: &str, actual: &str) -> Result<(), Failed> {
    let Some(told) = difference(expected, actual) else { return Ok(()) };
    let report = Path::new(env!("CARGO_TARGET_TMPDIR")).join("../golden-report");
    let left = std::fs::create_dir_all(&report).is_ok()
        && std::fs::write(report.join(format!("{name}-expected.svg")), expected).is_ok()
        && std::fs::write(report.join(format!("{name}-actual.svg")), actual).is_ok();
    let place = if left { format!("\nboth drawings are in {}", report.display()) } else { String::new() };
    Err(format!("the drawing differs:\n{told}{place}").into())
}

/// What one text has that the other has not, line by line, each with the group that it is in; `None` where they are the same.
fn difference(expected: &str, actual: &str) -> Option<String> {
    if expected == actual {
        return None;
    }
    let lines = |text: &str| -> Vec<(String, String)> {
        let mut group = String::new();
        let with_group = |line: &str| {
            if let Some((_, rest)) = line.split_once("<g id=\"") {
                group = rest.split('"').next().unwrap_or_default().to_owned();
            }
            (group.clone(), line.to_owned())
        };
        text.lines().map(with_group).collect()
    };
    let (expected, actual) = (lines(expected), lines(actual));
    let mut told = String::new();
    let mut count = 0;
    for (mark, these, those) in [('-', &expected, &actual), ('+', &actual, &expected)] {
        let known: BTreeSet<&(String, String)> = those.iter().collect();
        for (group, line) in these.iter().filter(|line| !known.contains(line)) {
            count += 1;
            if count <= TOLD {
                let short: String = line.chars().take(160).collect();
                let _ = writeln!(told, "{mark} [{group}] {short}");
            }
        }
    }
    let _ = match count {
        0 => writeln!(told, "the same lines in another order or number"),
        count => writeln!(told, "{count} lines differ"),
    };
    Some(told)
}

/// A scene as its golden drawing shows it: by its own wishes, but small.
fn drawing(name: &str) -> String {
    let scene = files::scene_of_file(&format!("scenes/{name}.toml"));
    let compiled = CompiledScene::build(&scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    let mut settings = DrawingSettings::new(&scene);
    let height = f64::from(settings.height) * f64::from(WIDTH.0) / f64::from(settings.width);
    (settings.width, settings.height) = (WIDTH.0, height.round().max(1.0) as u32);
    settings.drawing.width = WIDTH.1;
    let page = draw(&compiled, &settings).unwrap_or_else(|error| panic!("{name}: {error}"));
    encode_svg(&page).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn folder() -> PathBuf {
    files::root().join("goldens").join("drawings")
}

/// The names of a folder's files with an extension, without it.
fn stems(folder: &Path, extension: &str) -> BTreeSet<String> {
    let Ok(entries) = std::fs::read_dir(folder) else { return BTreeSet::new() };
    let paths = entries.filter_map(Result::ok).map(|entry| entry.path());
    let paths = paths.filter(|path| path.extension().is_some_and(|end| end == extension));
    paths.filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned())).collect()
}

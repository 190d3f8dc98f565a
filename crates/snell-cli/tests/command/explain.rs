//! `snell explain`, `snell render --map`, and the command that replays a sample that is no number.

use std::path::{Path, PathBuf};

use serde_json::Value;
use snell_testkit::golden::{assert_golden_text, is_blessing};
use snell_testkit::must_fail;

use crate::schema::problems;
use crate::support::Folder;

/// A pixel of the glass ball in which all kinds of rays come together.
const PIXEL: &str = "explain seven-rays --width 256 --pixel 82,105 --sample 0";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn schema() -> Value {
    let text = std::fs::read(root().join("docs/explain.schema.json")).unwrap();
    serde_json::from_slice(&text).unwrap()
}

/// Compares with a stored text, or stores it where that is asked for.
fn compare(name: &str, actual: &str) {
    assert_golden_text(&root().join("goldens/explanations").join(name), actual);
}

#[test]
fn texts_are_what_they_were() {
    let folder = Folder::new();
    for (name, line) in [
        ("seven-rays.txt", PIXEL.to_owned()),
        ("seven-rays-details.txt", format!("{PIXEL} --details")),
        ("lens-paths.txt", "explain lens --width 64 --pixel 30,20 --aa 8".to_owned()),
        ("prism.txt", "explain refraction-and-wavelength --width 64 --pixel 30,20 --aa none".to_owned()),
        ("path.txt", "explain caustic --width 64 --pixel 18,21 --sample 3 --details".to_owned()),
        ("path-ways.txt", "explain caustic --width 64 --pixel 18,21 --samples 32".to_owned()),
    ] {
        let run = folder.good(&line);
        assert!(!run.text().contains('\x1b'), "no colours where nobody sees them");
        compare(name, run.text());
    }
    if is_blessing() {
        return;
    }
    must_fail("a share is another", || compare("seven-rays.txt", &folder.good(PIXEL).text().replace("100.0", "99.9")));
}

#[test]
fn drawings_have_every_format_and_view() {
    let folder = Folder::new();
    for view in ["plane", "side", "above", "front", "camera", "4,3,9"] {
        let run = folder.good(&format!("{PIXEL} --format svg --view {view}"));
        assert!(run.text().contains("<g id=\"ray-1\"") && run.text().contains("<g id=\"list\""), "{view}");
    }
    folder.good(&format!("{PIXEL} -o a.pdf"));
    assert!(folder.read("a.pdf").starts_with(b"%PDF"));
    folder.good(&format!("{PIXEL} --view side -o a.png"));
    assert!(folder.picture("a.png").size().0 > 1000);
}

/// The terms' shares, added in order.
fn sum_of_terms(json: &Value) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for term in json["terms"].as_array().unwrap() {
        for (i, sum) in sum.iter_mut().enumerate() {
            *sum += term["share"][i].as_f64().unwrap();
        }
    }
    sum
}

fn is_sound(json: &Value) {
    assert_eq!(problems(&schema(), json), Vec::<String>::new());
    assert_eq!(sum_of_terms(json), [0, 1, 2].map(|i| json["pixel"][i].as_f64().unwrap()));
}

#[test]
fn json_is_as_its_schema_says_and_adds_up() {
    let folder = Folder::new();
    for line in [
        PIXEL,
        "explain seven-rays --width 64 --pixel 20,26",
        "explain milky-sphere --width 64 --pixel 32,24 --aa none",
        "explain refraction-and-wavelength --width 64 --pixel 30,20 --aa 3",
        "explain lens --width 64 --pixel 2,2",
        "explain lens --ray 0,1,9,0,0,-1",
        "explain caustic --width 64 --pixel 39,30 --samples 5",
        "explain lens --integrator path --width 64 --pixel 30,20 --sample 7 --seed 3",
        "explain caustic --ray 0,3,7,0,-0.2,-1 --sample 2",
    ] {
        is_sound(&folder.good(&format!("{line} --format json")).json());
    }
    let json = folder.good(&format!("{PIXEL} --format json")).json();
    must_fail("a term is missing", || {
        let mut json = json.clone();
        json["terms"].as_array_mut().unwrap().remove(0);
        is_sound(&json);
    });
    must_fail("a key is new", || {
        let mut json = json.clone();
        json["rays"][0]["colour"] = Value::Null;
        is_sound(&json);
    });
}

#[test]
fn a_wavelength_bends_as_its_index_says() {
    let folder = Folder::new();
    folder.write("ball.toml", "[[object]]\nsphere = {}\nmaterial = { dielectric = { ior = \"N-BK7\" } }\n");
    let index = |options: &str| {
        let run = folder.good(&format!("explain ball.toml --ray 0,0.5,5,0,0,-1 --format json {options}"));
        run.json()["rays"][0]["surface"]["boundaries"][0]["media"][1]["index"].as_f64().unwrap()
    };
    assert!((index("--wavelength 486.1327") - 1.522_38).abs() < 1e-5);
    assert!((index("--wavelength 656.2725nm") - 1.514_32).abs() < 1e-5);
}

#[test]
fn what_is_looked_for_is_found() {
    let folder = Folder::new();
    let list = folder.good("explain --find list");
    assert!(list.text().lines().count() > 10 && list.text().contains("tir"), "{list:?}");
    let found = folder.good("explain seven-rays --width 200 --find shadow-through-glass --count 3");
    assert_eq!(found.text().lines().count(), 3, "{found:?}");
    let pixel = found.text().split_whitespace().nth(1).unwrap().to_owned();
    let told = folder.good(&format!("explain seven-rays --width 200 --pixel {pixel} --sample 0"));
    assert!(told.text().contains("arrives through transparent ball"), "{told:?}");
    folder.good("explain seven-rays --width 200 --find depth=4 --format json -o a.json");
    let json: Value = serde_json::from_slice(&folder.read("a.json")).unwrap();
    assert!(json["rays"].as_array().unwrap().iter().any(|ray| ray["depth"] == 4 && ray["origin"].is_array()));
}

#[test]
fn the_seven_rays_are_drawn() {
    let folder = Folder::new();
    let run = folder.good("explain seven-rays --width 200");
    let names: Vec<String> = (1..=7).map(|number| format!("seven-rays-{number}.svg")).collect();
    assert_eq!(folder.names(), names, "{run:?}");
    for name in names {
        let svg = String::from_utf8(folder.read(&name)).unwrap();
        assert!(svg.contains("<g id=\"ray-1\"") && svg.contains("<title>"), "{name}");
    }
    let texts = folder.good("explain seven-rays --width 200 --format text");
    assert_eq!(texts.text().matches("camera ray").count(), 7);
}

#[test]
fn maps_are_false_colours_with_a_bar() {
    let folder = Folder::new();
    for map in ["depth", "rays", "tir", "caustic", "share:reflected", "share:light=key"] {
        folder.good(&format!("render seven-rays --width 64 --map {map} -o a.png"));
        let (width, height) = folder.picture("a.png").size();
        assert!(width == 64 && height > 48, "{map}: {height}");
    }
    assert!(folder.good("render --map list").text().contains("share:object=NAME"));
    folder.good("render seven-rays --width 64 --map depth -o a.exr");
    folder.good("render caustic --width 64 --samples 4 --map share:photons -o a.png");
    let wrong = folder.run("render seven-rays --width 64 --map dept -o a.png");
    assert!(wrong.code == Some(2) && wrong.stderr.contains("did you mean \"depth\"?"), "{wrong:?}");
    let wrong = folder.run("render seven-rays --width 64 --map share:object=bord -o a.png");
    assert!(wrong.code == Some(1) && wrong.stderr.contains("did you mean \"board\"?"), "{wrong:?}");
}

/// Renders a scene of which some samples are no numbers, with options, and runs what it says to see the first of them.
fn replays(options: &str, expected: &str) {
    let folder = Folder::new();
    folder.write(
        "hot scene.toml",
        "[camera]\neye = [0, 0, 5e-5]\n\
         [[light]]\npoint = { position = [0, 0, 3e-5], intensity = 1e30, falloff = \"inverse-square\" }\n\
         [[object]]\nsphere = { radius = 1e-5 }\nmaterial = { diffuse = 1 }\n",
    );
    let mut command = folder.command(&format!("render --width 40 --height 30 --set camera.fov=30 {options}"));
    let output = command.arg("hot scene.toml").output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap().split_whitespace().collect::<Vec<_>>().join(" ");
    // However the terminal breaks its lines.
    let told = told.replace(" | ", " ");
    let start = told.find("snell explain").unwrap_or_else(|| panic!("{told}"));
    let line = told[start..].split('`').next().unwrap();
    assert!(line.starts_with("snell explain 'hot scene.toml' --pixel "), "{line}");
    assert!(line.ends_with(&format!("--set camera.fov=30 --width 40 --height 30{expected}")), "{line}");
    let words = line.replace("snell explain 'hot scene.toml'", "explain --format json");
    let output = folder.command(&words).arg("hot scene.toml").output().unwrap();
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    is_sound(&json);
    assert_eq!(json["samples"][0]["color"][0], Value::Null, "it is no number");
}

#[test]
fn a_sample_that_is_no_number_is_replayed() {
    replays("--aa 2", " --aa 2");
    replays("--integrator path --samples 3 --seed 5", " --integrator path --seed 5");
}

#[test]
fn mistakes_are_told() {
    let folder = Folder::new();
    for (line, code, part) in [
        ("explain seven-rays --pixel 2000,3", 2, "outside of the picture"),
        ("explain seven-rays --pixel 3", 2, "two whole numbers"),
        ("explain seven-rays --ray 0,0,0,0,0,0", 2, "direction without length"),
        ("explain seven-rays --sample 1", 2, "--pixel"),
        ("explain seven-rays --pixel 1,1 --samples 4", 2, "--samples is for path tracing"),
        ("explain caustic --pixel 1,1 --aa 4", 2, "--aa is for `whitted`"),
        ("render caustic --map rays --noise 0.1 -o a.png", 2, "--noise"),
        ("explain seven-rays --pixel 3,3 -o a.doc", 2, "no format"),
        ("explain seven-rays --find tirr", 2, "did you mean \"tir\"?"),
        ("explain --find tir", 2, "none is given"),
        ("explain --pixel 1,1", 2, "SCENE"),
        ("explain seven-rays --width 64 --find dispersion", 1, "no pixel"),
        ("explain seven-rays --width 64 --find object=bord", 2, "did you mean \"board\"?"),
        ("explain cosine-plot --pixel 1,1", 1, "nothing to render"),
        ("explain nine-red-ball --pixel 1,1", 1, "did you mean"),
    ] {
        let run = folder.run(line);
        assert_eq!(run.code, Some(code), "{run:?}");
        let told = run.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(told.contains(part) && run.stdout.is_empty(), "{line}: {told}");
    }
    assert_eq!(folder.names(), Vec::<String>::new(), "nothing is written");
}

//! Pictures: their names, sizes and contents, and what `--json` says about them.

use serde_json::Value;
use snell::image::BitDepth;

use crate::support::Folder;

const BALL_NFF: &str = "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 64 48\nb 0.1 0.2 0.3\nl 5 5 5\n\
                        f 1 0.5 0.2 0.8 0.2 10 0 1\ns 0 0 0 1\n";

const TETRAHEDRON_OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

#[test]
fn a_first_picture_needs_no_scene() {
    let folder = Folder::new();
    let run = folder.good("render --width 64");
    assert_eq!(folder.picture("nine-red-balls.png").size(), (64, 48));
    assert_eq!(folder.names(), ["nine-red-balls.png"], "nothing else is left");
    assert!(run.stdout.is_empty());
    let (first, second) = run.stderr.split_once('\n').unwrap();
    assert!(first.starts_with("wrote nine-red-balls.png (64x48, ") && first.ends_with(" s)"), "{first}");
    assert_eq!(second, "This is the built-in scene nine-red-balls; `snell scenes` lists the others.\n");
    // Red balls in the middle, blue sky above them.
    let [red, green, blue] = folder.picture("nine-red-balls.png").code(32, 24);
    assert!(red > green + 50 && red > blue + 50, "{red} {green} {blue}");
    let [red, _, blue] = folder.picture("nine-red-balls.png").code(32, 1);
    assert!(blue > red, "{red} {blue}");
}

#[test]
fn quiet_is_quiet() {
    let run = Folder::new().good("render lens --width 8 --aa none --quiet");
    assert!(run.stderr.is_empty() && run.stdout.is_empty(), "{run:?}");
}

#[test]
fn one_side_takes_the_other_along() {
    let folder = Folder::new();
    for (options, size) in [("--height 24", (32, 24)), ("--width 20", (20, 15)), ("--width 9 --height 20", (9, 20))] {
        folder.good(&format!("render one-glass-sphere --aa none -o a.png {options}"));
        assert_eq!(folder.picture("a.png").size(), size, "{options}");
    }
}

#[test]
fn json_has_all_that_is_promised_and_nothing_else() {
    let folder = Folder::new();
    let run = folder.good("render one-glass-sphere --width 40 --threads 2 --json");
    let json = run.json();
    let keys = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    let mut expected = vec![
        "scene",
        "output",
        "width",
        "height",
        "seconds",
        "rays",
        "max_depth",
        "total_internal_reflections",
        "cut_weight",
        "nonfinite_samples",
        "triangles",
        "primitives",
        "peak_bytes",
        "threads",
        "complete",
        "warnings",
    ];
    let mut all = keys(&json);
    expected.sort_unstable();
    all.sort();
    assert_eq!(all, expected);

    assert_eq!(json["scene"], "one-glass-sphere");
    assert_eq!(json["output"], "one-glass-sphere.png");
    assert_eq!((&json["width"], &json["height"], &json["threads"]), (&40.into(), &30.into(), &2.into()));
    assert_eq!((&json["complete"], &json["nonfinite_samples"]), (&true.into(), &0.into()));
    let seconds = |key: &str| json["seconds"][key].as_f64().unwrap();
    let parts: f64 = ["load", "build", "render", "write"].map(seconds).iter().sum();
    assert!(parts > 0.0 && parts <= seconds("total") + 1e-5 && seconds("total") < 60.0, "{json:#}");
    let rays = |key: &str| json["rays"][key].as_u64().unwrap();
    assert!(rays("camera") >= 1200 && rays("camera") <= 1200 * 16, "{json:#}");
    assert!(rays("reflected") > 0 && rays("refracted") > 0 && rays("shadow") > 0, "{json:#}");
    assert!((3..=12).contains(&json["max_depth"].as_u64().unwrap()), "{json:#}");
    assert!((0.0..0.01).contains(&json["cut_weight"].as_f64().unwrap()), "{json:#}");
    assert!(json["primitives"].as_u64().unwrap() >= 1);
    if cfg!(unix) {
        assert!((1 << 20..1 << 33).contains(&json["peak_bytes"].as_u64().unwrap()), "{json:#}");
    }
}

#[test]
fn threads_and_tiles_do_not_matter() {
    let folder = Folder::new();
    folder.good("render seven-rays --width 60 -o first.png");
    let first = folder.read("first.png");
    for options in ["--threads 1", "--threads 2", "--threads 7", "--tile 5", "--tile 32", "--tile 1000 --threads 3"] {
        folder.good(&format!("render seven-rays --width 60 -o other.png {options}"));
        assert!(folder.read("other.png") == first, "{options} changes the picture");
    }
    // The comparison can fail.
    folder.good("render seven-rays --width 60 -o other.png --depth 3 -q");
    assert!(folder.read("other.png") != first);
}

#[test]
fn settings_of_the_command_line_count() {
    let folder = Folder::new();
    let rays = |options: &str| {
        let json = folder.good(&format!("render one-glass-sphere --width 16 --json {options}")).json();
        let count = |key: &str| json["rays"][key].as_u64().unwrap();
        (count("camera"), count("shadow"), json["max_depth"].as_u64().unwrap())
    };
    assert_eq!(rays("--aa none").0, 16 * 12);
    assert_eq!(rays("--aa 9").0, 16 * 12 * 9);
    assert_eq!(rays("--shadows none").1, 0);
    assert_eq!(rays("--depth 2").2, 2);
    assert!(rays("--min-weight 0").2 >= rays("--min-weight 0.5").2);

    let mean = |options: &str| {
        folder.good(&format!("render one-glass-sphere --width 16 --aa none -o a.png {options}"));
        let picture = folder.picture("a.png");
        let codes = (0..12).flat_map(|y| (0..16).map(move |x| (x, y))).map(|(x, y)| u32::from(picture.code(x, y)[1]));
        codes.sum::<u32>()
    };
    assert!(mean("--exposure 1") > mean("") && mean("--exposure -1") < mean(""));
    assert_ne!(mean("--tone filmic"), mean("--tone reinhard"));
}

#[test]
fn a_scene_is_changed_from_outside() {
    let folder = Folder::new();
    folder.good("render nine-red-balls --width 16 -o red.png");
    folder.good("render nine-red-balls --width 16 -o green.png --set material.red.diffuse=[0,0.6,0]");
    let [red, green, _] = folder.picture("green.png").code(8, 6);
    assert!(green > red);
    assert_ne!(folder.read("red.png"), folder.read("green.png"));
}

#[test]
fn meshes_and_other_formats_render_by_themselves() {
    let folder = Folder::new();
    folder.write("tetra hedron.obj", TETRAHEDRON_OBJ);
    let mut command = folder.command("render");
    let output = command.arg("tetra hedron.obj").args(["--width", "40", "--json"]).output().unwrap();
    let run = crate::support::Run::new("tetra hedron.obj", output);
    assert_eq!(run.json()["triangles"], 4, "{run:?}");
    assert_eq!(folder.picture("tetra hedron.png").size().0, 40);

    folder.write("ball.nff", BALL_NFF);
    folder.good("render ball.nff");
    assert_eq!(folder.picture("ball.png").size(), (64, 48));
    let spd = folder.good("render ball.nff --preset spd --json").json();
    assert_eq!((&spd["width"], &spd["height"], &spd["rays"]["camera"]), (&513.into(), &513.into(), &263_169.into()));
    let small = folder.good("render ball.nff --preset spd --json --width 10").json();
    assert_eq!((&small["width"], &small["height"]), (&10.into(), &10.into()), "the command line has the last word");
}

#[test]
fn sixteen_bits_are_sixteen_bits() {
    let folder = Folder::new();
    folder.good("render nine-red-balls --width 16 --bits 16 -o deep.png");
    folder.good("render nine-red-balls --width 16 -o flat.png");
    let (deep, flat) = (folder.picture("deep.png"), folder.picture("flat.png"));
    assert_eq!((deep.depth(), flat.depth()), (BitDepth::Sixteen, BitDepth::Eight));
    let near = |deep: u16, flat: u16| (i32::from(deep) - i32::from(flat) * 257).abs() <= 129;
    assert!((0..16).all(|x| near(deep.code(x, 6)[0], flat.code(x, 6)[0])));
}

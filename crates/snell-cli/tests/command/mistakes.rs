//! Wrong scenes, names and options: what the user reads, word for word where it matters.

use crate::support::Folder;

const WRONG_SCENE: &str = r#"[camera]
fov = 400
look_to = [0, 0, 0]

[material.glass]
dielectric = { ior = 1.5 }

[[object]]
sphere = { radius = 1 }
material = "glas"
"#;

const WRONG_SCENE_SAID: &str = r#"error: `camera.fov` is 400, but must be from 0.0001 to 179.9
 --> wrong.toml:2:7
  |
2 | fov = 400
  |       ^^^ expected a number from 0.0001 to 179.9, in degrees

error: there is no key `look_to` in `camera`
 --> wrong.toml:3:1
  |
3 | look_to = [0, 0, 0]
  | ^^^^^^^ unknown key
  |
  = help: did you mean `look_at`?

error: there is no material "glas"
  --> wrong.toml:10:12
   |
10 | material = "glas"
   |            ^^^^^^ not defined anywhere
   |
   = help: did you mean "glass"?

3 errors
"#;

#[test]
fn all_mistakes_are_told_at_once_with_their_places() {
    let folder = Folder::new();
    folder.write("wrong.toml", WRONG_SCENE);
    let run = folder.run("render wrong.toml");
    assert_eq!(run.code, Some(1));
    assert_eq!(run.stderr, WRONG_SCENE_SAID);
    assert!(run.stdout.is_empty());
    assert_eq!(folder.names(), ["wrong.toml"]);
}

#[test]
fn mistakes_in_set_point_into_it() {
    let run = Folder::new().run("render lens --set camera.fv=30");
    let said = "error: there is no key `fv` in `camera`\n --> --set:1:8\n  |\n1 | camera.fv=30\n  |        ^^ unknown key\n  \
                |\n  = help: did you mean `fov`?\n\n";
    assert_eq!((run.code, run.stderr.as_str()), (Some(1), said));
}

#[test]
fn set_is_for_our_own_format() {
    let folder = Folder::new();
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let run = folder.run("render a.obj --set camera.fov=30");
    assert_eq!(run.code, Some(2));
    assert_eq!(run.stderr, "error: --set changes scenes in TOML or JSON; \"a.obj\" is neither\n");
}

#[test]
fn unknown_names_get_a_suggestion() {
    let folder = Folder::new();
    folder.write("kitchen-table.toml", "");
    std::fs::create_dir(folder.path("models")).unwrap();
    for (line, said) in [
        (
            "render nine-red-bals",
            "error: \"nine-red-bals\" is no file and no built-in scene\nhelp: did you mean \"nine-red-balls\"?\n",
        ),
        (
            "render kitchen-tabel.toml",
            "error: \"kitchen-tabel.toml\" is no file and no built-in scene\nhelp: did you mean \"kitchen-table.toml\"?\n",
        ),
        (
            "render kitchen-table",
            "error: \"kitchen-table\" is no file and no built-in scene\nhelp: did you mean \"kitchen-table.toml\"?\n",
        ),
        (
            "render zebra",
            "error: \"zebra\" is no file and no built-in scene\nhelp: `snell scenes` lists the built-in scenes\n",
        ),
        (
            "render models",
            "error: \"models\" is a folder, not a scene\nhelp: `snell scenes` lists the built-in scenes\n",
        ),
        ("scenes lenz", "error: \"lenz\" is no file and no built-in scene\nhelp: did you mean \"lens\"?\n"),
    ] {
        let run = folder.run(line);
        assert_eq!((run.code, run.stderr.as_str()), (Some(1), said), "{line}");
    }
    folder.write("notes.txt", "");
    let run = folder.run("render notes.txt");
    assert_eq!(run.code, Some(1));
    assert!(
        run.stderr.starts_with("error: \"notes.txt\" does not end like a scene or a mesh: \".txt\"\nhelp: "),
        "{run:?}"
    );
}

#[test]
fn wrong_options_are_a_matter_of_usage() {
    let folder = Folder::new();
    for line in
        ["", "rendr", "render --width 0", "render --aa maybe", "render --json --preview", "render a b", "man nothing"]
    {
        let run = folder.run(line);
        assert_eq!(run.code, Some(2), "{run:?}");
        assert!(run.stdout.is_empty() && !run.stderr.is_empty(), "{run:?}");
    }
}

#[test]
fn missing_pictures_are_looked_for() {
    let folder = Folder::new();
    folder.write("sky.toml", "[background]\nphotograph = { file = \"hils.png\" }\n[[object]]\nsphere = {}\n");
    folder.good("render lens --width 4 --aa none -o hills.png");
    let run = folder.run("render sky.toml");
    assert_eq!(run.code, Some(1));
    assert!(
        run.stderr.contains("there is no such file") && run.stderr.contains("did you mean \"hills.png\"?"),
        "{run:?}"
    );

    // A picture that is none is found when the scene is compiled, and told at the place that names it.
    folder.write("hils.png", "no picture");
    for line in ["render sky.toml", "check sky.toml"] {
        let run = folder.run(line);
        assert_eq!(run.code, Some(1));
        assert!(run.stderr.contains("hils.png") && run.stderr.contains(" --> sky.toml:2:"), "{run:?}");
    }
}

#[test]
fn check_reads_all_and_renders_nothing() {
    let folder = Folder::new();
    folder.write("wrong.toml", WRONG_SCENE);
    folder.write("right.toml", "[[object]]\nsphere = {}\n");
    let run = folder.run("check wrong.toml right.toml lens");
    assert_eq!(run.code, Some(1));
    assert_eq!(run.text(), "wrong.toml: 3 errors\nright.toml: no mistakes\nlens: no mistakes\n");
    assert_eq!(run.stderr, WRONG_SCENE_SAID.strip_suffix("3 errors\n").unwrap());
    assert_eq!(folder.good("check right.toml").text(), "right.toml: no mistakes\n");
    assert_eq!(folder.run("check nothing-like-it").code, Some(1));
    assert_eq!(folder.names(), ["right.toml", "wrong.toml"]);
}

#[test]
fn every_built_in_scene_is_clean_and_crossing_glass_is_told() {
    let folder = Folder::new();
    let scenes = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes")).unwrap();
    let names: Vec<String> = scenes
        .filter_map(|entry| Some(entry.unwrap().file_name().to_str()?.strip_suffix(".toml")?.to_owned()))
        .collect();
    assert!(names.len() > 20);
    let run = folder.good(&format!("check {}", names.join(" ")));
    assert_eq!(run.text(), names.iter().map(|name| format!("{name}: no mistakes\n")).collect::<String>());
    folder.write(
        "crossing.toml",
        "[material.a]\ndielectric = {}\n[material.b]\ndielectric = { ior = 1.33 }\n\
         [[object]]\nsphere = {}\nmaterial = \"a\"\n[[object]]\nsphere = { center = [1, 0, 0] }\nmaterial = \"b\"\n",
    );
    let run = folder.good("check crossing.toml");
    assert_eq!(run.text(), "crossing.toml: no errors, 1 warning\n");
    assert!(
        run.stderr.contains("cross, and neither has priority") && run.stderr.contains("crossing.toml:5:"),
        "{run:?}"
    );
}

#[test]
fn lost_light_is_told_with_what_to_do() {
    let folder = Folder::new();
    let run = folder.good("render one-glass-sphere --width 16 --depth 2 --json");
    assert!(run.stderr.starts_with("warning: up to "), "{run:?}");
    assert!(run.stderr.contains("\nhelp: use --depth 4 or more"), "{run:?}");
    let warnings = run.json()["warnings"].clone();
    assert_eq!(warnings.as_array().map(Vec::len), Some(1), "{warnings}");
    assert!(folder.good("render one-glass-sphere --width 16 --json").json()["warnings"].as_array().unwrap().is_empty());
}

#[test]
fn colours_are_for_terminals() {
    let folder = Folder::new();
    let said = |variables: &[(&str, &str)]| {
        let mut command = folder.command("render zebra");
        command.envs(variables.iter().copied());
        String::from_utf8(command.output().unwrap().stderr).unwrap()
    };
    assert!(!said(&[("TERM", "xterm")]).contains('\x1b'));
    assert!(said(&[("TERM", "xterm"), ("CLICOLOR_FORCE", "1")]).contains('\x1b'));
    assert!(!said(&[("TERM", "xterm"), ("CLICOLOR_FORCE", "1"), ("NO_COLOR", "1")]).contains('\x1b'));
}

#[test]
fn plots_are_not_rendered_to_a_black_picture() {
    let folder = Folder::new();
    let run = folder.run("render cosine-plot");
    assert_eq!(run.code, Some(1), "{run:?}");
    assert!(run.stderr.contains("`snell draw cosine-plot` draws its plots"), "{}", run.stderr);
    assert!(folder.names().is_empty());
}

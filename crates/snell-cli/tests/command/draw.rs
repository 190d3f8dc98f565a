//! `snell draw`: where drawings go, what they have on them, and what is refused.

use crate::support::Folder;

const SCENE: &str = "[camera]\neye = [0, 1, 6]\nlook_at = [0, 0.8, 0]\n\n[image]\nwidth = 120\nheight = 90\n\n[[light]]\npoint = { position = [3, 5, 4] }\n\n\
                     [[object]]\nname = \"ball\"\nsphere = { center = [0, 1, 0], radius = 1 }\n\n\
                     [[object]]\nname = \"die\"\nbox = { min = [-2, 0, -2], max = [-1, 1, -1] }\n";

/// A folder with a scene, `s.toml`.
fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("s.toml", SCENE);
    folder
}

/// The SVG that a command line makes.
fn svg(folder: &Folder, options: &str) -> String {
    String::from_utf8(folder.good(&format!("draw s.toml -o - {options}")).stdout).unwrap()
}

#[test]
fn the_ending_says_the_format() {
    let folder = folder();
    let run = folder.good("draw s.toml");
    assert!(run.stdout.is_empty());
    assert!(run.stderr.starts_with("wrote s.svg (160 x 120 mm, 2 groups, "), "{}", run.stderr);
    assert!(folder.read("s.svg").starts_with(b"<svg "));
    folder.good("draw s.toml -o s.PDF --quiet");
    assert!(folder.read("s.PDF").starts_with(b"%PDF-"));
    folder.good("draw s.toml -o s.png");
    assert_eq!(folder.picture("s.png").size(), (120, 90));
    assert_eq!(folder.names(), ["s.PDF", "s.png", "s.svg", "s.toml"], "nothing else is left");
    assert_eq!(svg(&folder, "").into_bytes(), folder.read("s.svg"), "the same bytes");
}

#[test]
fn options_change_what_they_say() {
    let folder = folder();
    let plain = svg(&folder, "");
    assert!(
        plain.contains("<g id=\"ball\"") && plain.contains("<g id=\"die\"") && plain.contains("<ellipse"),
        "{plain}"
    );
    assert!(!plain.contains("stroke-dasharray"));
    let count = |text: &str, what: &str| text.matches(what).count();
    assert!(svg(&folder, "--hidden dashed").contains("stroke-dasharray"));
    assert!(svg(&folder, "--hidden kept").len() > plain.len());
    assert!(count(&svg(&folder, "--parameter-lines 4"), "<path") > count(&plain, "<path"));
    assert!(count(&svg(&folder, "--stroke object"), "stroke=\"#0") > 0);
    assert_ne!(svg(&folder, "--stroke material"), svg(&folder, "--stroke depth"));
    let titled = svg(&folder, "--title Plan --scale --frame --axes --grid 1");
    for part in
        ["<title>Plan</title>", "id=\"title\"", "id=\"scale\"", "id=\"frame\"", "id=\"axis-x\"", "id=\"ground-grid\""]
    {
        assert!(titled.contains(part), "{part}");
    }
    assert!(svg(&folder, "--frustum s.toml --set camera.eye=[4,4,8]").contains("id=\"s-frustum\""));
    assert!(svg(&folder, "--page-width 80").contains("width=\"80mm\" height=\"60mm\""));
    assert!(svg(&folder, "--line-width 1mm").contains("stroke-width=\"1\""));
    let crease = "--set object.die.box={min=[-2,0,-2],max=[-1,2,-1]}";
    assert_ne!(svg(&folder, crease), plain);
}

#[test]
fn a_drawing_lies_over_a_rendering() {
    let folder = folder();
    folder.good("render s.toml -o r.png --aa none");
    folder.good("draw s.toml --over r.png -o both.png");
    let (rendered, both) = (folder.picture("r.png"), folder.picture("both.png"));
    assert_eq!(both.size(), rendered.size());
    let same =
        (0..90).flat_map(|y| (0..120).map(move |x| (x, y))).filter(|(x, y)| both.code(*x, *y) == rendered.code(*x, *y));
    let same = same.count();
    assert!(same > 120 * 90 * 8 / 10 && same < 120 * 90, "{same} pixels are those of the rendering");
    assert!(svg(&folder, "--over r.png").contains("href=\"data:image/png;base64,iVBOR"));
    folder.good("draw s.toml --over r.png -o both.pdf");
}

#[test]
fn what_cannot_be_drawn_is_told_and_nothing_is_written() {
    let folder = folder();
    folder.good("render s.toml -o r.png --aa none --quiet");
    folder.good("render s.toml -o wide.png --aa none --width 120 --height 30 --quiet");
    folder.write("text.png", "no picture");
    let before = folder.names();
    for (line, code, message) in [
        ("draw s.toml -o a.jpg", 2, "says no format"),
        ("draw s.toml -o nowhere/a.svg", 1, "there is no folder"),
        ("draw s.toml -o s.toml", 2, "says no format"),
        ("draw s.toml --over r.png -o r.png", 1, "the scene itself uses that file"),
        ("draw s.toml --over wide.png -o a.svg", 1, "it has 120x30 pixels and the scene 120x90"),
        ("draw s.toml --over text.png -o a.svg", 1, "cannot be drawn over"),
        ("draw s.toml --over none.png -o a.svg", 1, "cannot be drawn over"),
        ("draw s.tml", 1, "did you mean \"s.toml\"?"),
        ("draw s.toml --hidden some -o a.svg", 2, "invalid value"),
        ("draw s.toml --page-width 0 -o a.svg", 2, "a length from 0.001"),
        ("draw s.toml --crease 200 -o a.svg", 2, "an angle from 0 to 180"),
        ("draw s.toml --grid nan -o a.svg", 2, "a number above 0"),
        (
            "draw s.toml --set camera.up=[0,0.2,6] --set camera.gaze=[0,-0.2,-6] --set camera.look_at=[0,0,0] -o a.svg",
            1,
            "error",
        ),
        ("draw s.toml --frustum none.toml -o a.svg", 1, "none.toml"),
    ] {
        let run = folder.run(line);
        assert_eq!(run.code, Some(code), "{run:?}");
        assert!(run.stderr.contains(message), "{line}: {}", run.stderr);
        assert_eq!(folder.names(), before, "{line}");
    }
}

//! `snell view`: matrices and stages, by numbers that can be worked out by hand.

use serde_json::Value;

use crate::support::Folder;

/// From (0, 0, 5) along −z, the window [−1, 1]² on the plane z = −1 and the far plane z = −9, 100 × 100 pixels.
const SCENE: &str = "[camera]\neye = [0, 0, 5]\nwindow = { left = -1, right = 1, bottom = -1, top = 1, near = -1, far = -9 }\n\n\
                     [image]\nwidth = 100\nheight = 100\n\n[[object]]\nsphere = { radius = 1 }\n";

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("s.toml", SCENE);
    folder
}

fn text(folder: &Folder, options: &str) -> String {
    String::from_utf8(folder.good(&format!("view s.toml {options}")).stdout).unwrap()
}

#[test]
fn text_has_the_matrices_and_follows_points() {
    let folder = folder();
    let told = text(&folder, "--point 1,2,1");
    for part in [
        "The view of s.toml: perspective, 100 x 100 pixels",
        "e  (0, 0, 5)",
        "n = -1, f = -9\n",
        "M_v  world to eye space",
        "M_p  perspective",
        "|   0    0  -10   -9 |",
        "M_o  the box",
        "M    M_o M_p M_v",
        "eye space    (1, 2, -4)",
        "projected    (-1, -2, 31; h = -4)",
        "canonical    (0.25, 0.5, -0.6875)",
        "pixel        (62, 74.5)",
        "raster       (62.5, 25)",
        "inside of the view volume",
    ] {
        assert!(told.contains(part), "{part}\n{told}");
    }
    assert!(text(&folder, "--point 0,0,5").contains("in the eye's plane: clipped"));
    assert!(text(&folder, "--point 0,0,6").contains("behind the eye: clipped"));
    assert!(text(&folder, "--point -9,0,0").contains("outside, beyond the left side: clipped"));
}

#[test]
fn segments_are_clipped_before_the_division() {
    let folder = folder();
    // From the middle of what is seen to behind the eye: it leaves through the near plane, four fifths of the way.
    let told = text(&folder, "--segment 0,0,0,0,0,5");
    assert!(told.contains("its end is clipped by the near side, at t = 0.8"), "{told}");
    let through = text(&folder, "--segment 0,0,0,0,0,10");
    assert!(through.contains("its end is clipped by the near side, at t = 0.4"), "{through}");
    assert!(text(&folder, "--segment 0,0,6,1,1,9").contains("clipped as a whole"));
    assert!(text(&folder, "--segment 0,0,0,0,0,0").contains("inside of the view volume as a whole"));
}

#[test]
fn json_has_everything_in_full() {
    let folder = folder();
    let json = folder.good("view s.toml --format json --point 0.1,0.2,0.3 --segment 0,0,0,0,0,10").json();
    assert_eq!(json["matrices"]["perspective"][2], serde_json::json!([0.0, 0.0, -10.0, -9.0]));
    for name in ["view", "perspective", "canonical", "pixel", "orthographic", "all"] {
        assert_eq!(json["matrices"][name].as_array().map(Vec::len), Some(4), "{name}");
    }
    let point = &json["points"][0];
    assert_eq!(point["world"], serde_json::json!([0.1, 0.2, 0.3]));
    let x = point["canonical"][0].as_f64().unwrap();
    assert!((x - 0.1 / 4.7).abs() < 1e-16, "{x}");
    assert_eq!(point["outside"], serde_json::json!([]));
    let clipped = &json["segments"][0]["clipped"];
    assert_eq!((clipped["to"].as_f64(), clipped["left"].as_str()), (Some(0.4), Some("near")));
    assert_eq!(clipped["entered"], Value::Null);
}

#[test]
fn the_drawing_of_both_volumes_is_an_svg() {
    let folder = folder();
    let run = folder.good("view s.toml --format svg --point 0.5,0.5,0 -o v.svg");
    assert!(run.stdout.is_empty());
    let svg = String::from_utf8(folder.read("v.svg")).unwrap();
    assert!(
        svg.starts_with("<svg ") && svg.ends_with("</svg>\n") && svg.contains("aria-label=\"the canonical volume\"")
    );
}

#[test]
fn degenerate_planes_and_numbers_are_told() {
    let folder = folder();
    for (options, code, message) in [
        ("--near 0", 1, "the near plane z = 0 is not before the eye"),
        ("--near -5 --far -1", 1, "the far plane z = -1 is not beyond the near plane z = -5"),
        ("--near nan", 1, "the near plane is NaN"),
        ("--point 1,nan,2", 2, "3 finite numbers"),
        ("--point 1,2", 2, "3 finite numbers"),
        ("--segment 1,2,3", 2, "6 finite numbers"),
        ("--set camera.up=[0,0,1]", 1, "looks along its own `up`"),
        ("--format pdf", 2, "invalid value"),
        ("-o nowhere/v.txt", 1, "there is no folder"),
    ] {
        let run = folder.run(&format!("view s.toml {options}"));
        assert_eq!(run.code, Some(code), "{run:?}");
        assert!(run.stderr.contains(message), "{options}: {}", run.stderr);
    }
}

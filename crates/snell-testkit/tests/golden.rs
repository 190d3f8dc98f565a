//! Golden pictures are held to every code, and a mismatch leaves a report to look at.

#![allow(clippy::unwrap_used, reason = "the helpers of a test fail it as the test itself does")]

use std::path::{Path, PathBuf};

use snell_image::{BitDepth, DisplayImage, Image, Limits, ToneCurve, decode_display};
use snell_math::Rgb;
use snell_testkit::golden::{Failure, check};
use snell_testkit::{assert_golden, must_fail};

fn picture() -> Image<Rgb> {
    Image::from_fn(20, 12, |x, y| Rgb::new(x as f32 / 19.0, y as f32 / 11.0, 0.25))
}

/// The picture with one code of one pixel one higher.
fn defect(depth: BitDepth) -> DisplayImage {
    let display = DisplayImage::develop(&picture(), ToneCurve::None, 0.0, depth);
    let mut light = display.to_linear();
    let code = f32::from(display.code(7, 5)[2] + 1) / f32::from(depth.max_code());
    light.get_mut(7, 5).unwrap().b = snell_math::color::srgb_to_linear(code);
    DisplayImage::develop(&light, ToneCurve::None, 0.0, depth)
}

/// An empty folder of the test's own.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn a_picture_equals_its_reference() {
    let folder = folder("equal");
    for depth in [BitDepth::Eight, BitDepth::Sixteen] {
        let display = DisplayImage::develop(&picture(), ToneCurve::Filmic, 0.0, depth);
        let name = format!("display-{depth:?}");
        check(&name, &display, &folder, &folder, true).unwrap();
        check(&name, &display, &folder, &folder, false).unwrap();
    }
    check("light", &picture(), &folder, &folder, true).unwrap();
    check("light", &picture(), &folder, &folder, false).unwrap();
    assert_golden("light", &picture(), &folder);
}

#[test]
fn one_code_in_one_pixel_is_caught() {
    let (references, report) = (folder("one-code"), folder("one-code-report"));
    for depth in [BitDepth::Eight, BitDepth::Sixteen] {
        let display = DisplayImage::develop(&picture(), ToneCurve::None, 0.0, depth);
        check("picture", &display, &references, &report, true).unwrap();
        let failure = check("picture", &defect(depth), &references, &report, false).unwrap_err();
        let Failure::Different { difference, first, expected, actual, report: page } = failure else {
            panic!("{failure}")
        };
        assert_eq!((difference.pixels, difference.largest, first), (1, 1.0, (7, 5)), "{depth:?}");
        assert_eq!(actual, [expected[0], expected[1], expected[2] + 1]);

        let html = std::fs::read_to_string(&page).unwrap();
        assert!(html.contains("1 pixels differ") && html.contains("(7, 5)"), "{html}");
        assert!(std::fs::read_to_string(report.join("index.html")).unwrap().contains("picture.html"));
        let read = |part: &str| {
            let bytes = std::fs::read(report.join(format!("picture-{part}.png"))).unwrap();
            decode_display(&bytes, &Limits::default()).unwrap()
        };
        assert_eq!(read("expected"), display);
        assert_eq!(read("actual"), defect(depth));
        let difference = read("difference");
        let red = |x, y| difference.code(x, y)[0] > 100 && difference.code(x, y)[1] == 0;
        assert!(red(7, 5) && !red(8, 5) && !red(7, 6));
        assert_eq!(read("triptych").size(), (3 * 20 + 8, 12));
    }
}

#[test]
fn the_message_says_what_and_where() {
    let folder = folder("says");
    check("picture", &picture(), &folder, &folder, true).unwrap();
    let message = check("picture", &defect(BitDepth::Eight), &folder, &folder, false).unwrap_err().to_string();
    assert!(message.starts_with("1 pixels differ, by up to 1 codes; the first is (7, 5), expected ["), "{message}");
    assert!(message.ends_with("picture.html"), "{message}");
}

#[test]
fn a_missing_reference_fails_with_instructions() {
    if std::env::var_os("SNELL_BLESS").is_some() {
        println!("skipped: references are being written");
        return;
    }
    let folder = folder("missing");
    let message = must_fail("no reference", || assert_golden("nothing", &picture(), &folder));
    assert!(message.contains("SNELL_BLESS=1") && message.contains("nothing.png"), "{message}");
}

#[test]
fn another_size_or_depth_is_caught_and_reported() {
    let (references, report) = (folder("size"), folder("size-report"));
    check("size", &picture(), &references, &report, true).unwrap();
    let larger = Image::filled(21, 12, Rgb::WHITE);
    assert!(matches!(check("size", &larger, &references, &report, false), Err(Failure::Shape(..))));
    assert!(report.join("size-triptych.png").is_file());
    let deeper = DisplayImage::develop(&picture(), ToneCurve::None, 0.0, BitDepth::Sixteen);
    assert!(matches!(check("size", &deeper, &references, &report, false), Err(Failure::Shape(..))));
    let empty = Image::filled(0, 0, Rgb::WHITE);
    assert!(matches!(check("size", &empty, &references, &report, false), Err(Failure::Shape(..))));
}

#[test]
fn broken_references_and_names_are_refused() {
    let folder = folder("broken");
    std::fs::write(folder.join("broken.png"), b"not a picture").unwrap();
    assert!(matches!(check("broken", &picture(), &folder, &folder, false), Err(Failure::Unreadable(..))));
    for name in ["", "../up", "a b", "a/b"] {
        assert!(matches!(check(name, &picture(), &folder, &folder, true), Err(Failure::Name)), "{name}");
    }
}

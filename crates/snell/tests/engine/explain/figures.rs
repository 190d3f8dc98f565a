//! Figures of rays are what they were: what is on their pages, in words, is stored in `goldens/explanations/`.

use std::fmt::Write;

use snell::explain::{FigureSettings, Subject, View, explain, figure};
use snell::math::Point3;
use snell::scene::scene::Antialiasing;
use snell::vector::{Item, Page, Piece};
use snell_testkit::golden::{assert_golden_text, is_blessing};
use snell_testkit::must_fail;

use crate::files::{root, scene_of_file};
use crate::stage::Stage;

fn page(scene: &str, pixel: [u32; 2], view: View) -> Page {
    let mut stage = Stage::of(&scene_of_file(&format!("scenes/{scene}.toml"))).sized(256, 192);
    stage.settings.antialiasing = Antialiasing::None;
    let told = explain(&stage.scene, &stage.settings, Subject::Sample(pixel, 0)).expect("a camera");
    let settings = FigureSettings { view, title: Some("*A* title".to_owned()), ..FigureSettings::default() };
    figure(&stage.scene, &stage.settings, &told, &settings).expect("a camera")
}

/// What is on a page, a line for each thing: to a hundredth of a millimetre, so that pictures are the same where lines are.
fn in_words(page: &Page) -> String {
    let mut text = format!("{:.2} x {:.2} mm\n", page.width, page.height);
    for group in &page.groups {
        let _ = writeln!(text, "{}", group.name);
        for item in &group.items {
            match item {
                Item::Text(line) => {
                    let _ = writeln!(text, "  {:.2} {:.2} {}", line.at[0], line.at[1], line.markup);
                }
                Item::Path(path) => {
                    let _ = write!(text, "  {:?} {:?}", path.stroke.as_ref().map(|stroke| stroke.color), path.fill);
                    for subpath in &path.subpaths {
                        let _ = write!(text, " | {:.2} {:.2}", subpath.start[0], subpath.start[1]);
                        let ends = subpath.pieces.iter().map(|piece| match piece {
                            Piece::Line { to } | Piece::Cubic { to, .. } => *to,
                            Piece::Arc(arc) => arc.point(arc.end),
                        });
                        ends.for_each(|[x, y]| {
                            let _ = write!(text, ", {x:.2} {y:.2}");
                        });
                    }
                    text.push('\n');
                }
            }
        }
    }
    // No minus sign before a zero.
    text.replace("-0.00", "0.00")
}

fn compare(name: &str, actual: &str) {
    assert_golden_text(&root().join("goldens/explanations").join(name), actual);
}

#[test]
fn figures_are_what_they_were() {
    for (name, view) in [
        ("plane", View::Plane),
        ("above", View::Above),
        ("camera", View::Camera),
        ("point", View::From(Point3::new(4.0, 3.0, 9.0))),
    ] {
        compare(&format!("figure-{name}.txt"), &in_words(&page("seven-rays", [94, 120], view)));
    }
    compare("figure-shadow.txt", &in_words(&page("seven-rays", [42, 137], View::Side)));
    if !is_blessing() {
        must_fail("a ray is somewhere else", || {
            compare("figure-plane.txt", &in_words(&page("seven-rays", [94, 121], View::Plane)));
        });
    }
}

#[test]
fn every_scene_and_view_has_a_figure() {
    for name in super::rendered_scenes() {
        for view in [View::Plane, View::Side, View::Above, View::Front, View::Camera] {
            let page = page(&name, [128, 110], view.clone());
            snell::vector::encode_svg(&page).unwrap_or_else(|error| panic!("{name}, {view:?}: {error}"));
            let has_ray = page.groups.iter().any(|group| group.name == "ray 1");
            assert!(has_ray, "{name}, {view:?}");
        }
    }
}

//! What plots look like: numbers of the lecture, clipping, accuracy, poles.

use std::f64::consts::FRAC_PI_2;

use proptest::prelude::*;
use snell_scene::assets::MemoryAssets;
use snell_scene::document::read_scene;
use snell_scene::scene::{Expression, Plot};

use super::sample::{distance_to_segment, sample};
use super::*;
use crate::vector::{Path, Piece, Text};

fn plot(text: &str) -> Plot {
    let (scene, diagnostics) = read_scene("plot.toml", text.as_bytes(), &MemoryAssets::default(), &[]);
    scene.unwrap_or_else(|| panic!("{:#?}", diagnostics.list)).plots.remove(0)
}

/// All groups of a plot on a page of 160 mm × 100 mm.
fn groups(text: &str) -> Vec<Group> {
    plot_groups(&plot(text), 160.0, 100.0).unwrap()
}

fn part<'a>(groups: &'a [Group], name: &str) -> &'a [Item] {
    groups.iter().find(|group| group.name.ends_with(name)).map_or(&[], |group| &group.items)
}

fn paths(items: &[Item]) -> Vec<&Path> {
    let mut found = Vec::new();
    for item in items {
        if let Item::Path(path) = item {
            found.push(path);
        }
    }
    found
}

fn texts(items: &[Item]) -> Vec<&Text> {
    let mut found = Vec::new();
    for item in items {
        if let Item::Text(text) = item {
            found.push(text);
        }
    }
    found
}

fn labels(items: &[Item]) -> Vec<&str> {
    texts(items).into_iter().map(|text| &*text.markup).collect()
}

/// The corners of lines.
fn points(path: &Path) -> Vec<Vec<[f64; 2]>> {
    let line = |subpath: &crate::vector::Subpath| {
        let ends =
            subpath.pieces.iter().filter_map(|piece| if let Piece::Line { to } = piece { Some(*to) } else { None });
        std::iter::once(subpath.start).chain(ends).collect()
    };
    path.subpaths.iter().map(line).collect()
}

/// The lines of the first curve.
fn curve(groups: &[Group]) -> Vec<Vec<[f64; 2]>> {
    paths(part(groups, "curves")).first().map(|path| points(path)).unwrap_or_default()
}

fn near(a: [f64; 2], b: [f64; 2]) -> bool {
    (a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9
}

const WAVE: &str = "[[plot]]\nname = \"wave\"\nwindow = [0, \"2*pi\", -1, 1]\nviewport = [0.25, 0.75, 0.5, 1]\nx = { pi = true, label = \"*x*\" }\n[[plot.curve]]\nfunction = { y = \"cos(x)\" }\nlabel = \"cos\"\n";

#[test]
fn the_cosine_of_the_lecture_lies_in_its_viewport() {
    let groups = groups(WAVE);
    let lines = curve(&groups);
    let [line] = lines.as_slice() else { panic!("{} lines", lines.len()) };
    // cos 0 = 1 at the upper left corner, cos 2π = 1 at the upper right, cos π = −1 in the middle of the lower side.
    assert!(near(line[0], [40.0, 0.0]) && near(line[line.len() - 1], [120.0, 0.0]));
    let lowest = line.iter().copied().reduce(|a, b| if a[1] > b[1] { a } else { b }).unwrap();
    assert!(near(lowest, [80.0, 50.0]), "{lowest:?}");
    assert_eq!(labels(part(&groups, "axes")), ["π/2", "π", "3π/2", "2π", "*x*", "−1", "−0.5", "0", "0.5", "1"]);
    assert_eq!(labels(part(&groups, "labels")), ["cos"]);
}

#[test]
fn empty_pages_are_told() {
    assert!(plot_groups(&plot(WAVE), 0.0, 100.0).is_err());
    assert!(plot_groups(&plot(WAVE), 160.0, f64::NAN).is_err());
}

/// How far dense points of a function are from lines, mm; only those that are in the window.
fn worst(text: &str, from: f64, to: f64, viewing: &Viewing2, lines: &[Vec<[f64; 2]>]) -> f64 {
    let formula = Expression::parse(text, Some("x")).unwrap();
    let mut worst = 0.0_f64;
    for i in 0..=20_000 {
        let x = from + (to - from) * f64::from(i) / 20_000.0;
        let p = [x, formula.evaluate(x)];
        if viewing.window().contains(p) {
            let page = |p: [f64; 2]| viewing.point(p);
            // x increases along the lines, and nothing is steep in both directions: those near by are enough.
            let reach = 0.01 * viewing.window().width();
            let segments = lines.iter().flat_map(|line| line.windows(2));
            let around = segments.filter(|ends| ends[0][0] <= x + reach && ends[1][0] >= x - reach);
            let distances = around.map(|ends| distance_to_segment(page(p), page(ends[0]), page(ends[1])));
            worst = worst.max(distances.fold(f64::INFINITY, f64::min));
        }
    }
    worst
}

fn sheet(window: Rectangle) -> Viewing2 {
    let device = Device { width: 160.0, height: 100.0, y_down: true };
    Viewing2::new(&window, &Rectangle::UNIT, &device, Fit::Stretch).unwrap()
}

#[test]
fn lines_are_true_to_the_curve() {
    let formulas =
        ["cos(x)", "sin(40*x)", "sqrt(x)", "exp(-x^2*200)", "abs(x - 0.3)", "1/x", "tan(3*x)", "x^0.1", "mod(3*x, 1)"];
    for text in formulas {
        let viewing = sheet(Rectangle::new(-1.0, 2.0, -1.5, 1.5));
        let formula = Expression::parse(text, Some("x")).unwrap();
        let lines = sample(|x| [x, formula.evaluate(x)], -1.0, 2.0, &viewing, 200_000);
        let found = worst(text, -1.0, 2.0, &viewing, &lines);
        assert!(found <= 0.02, "{text}: {found} mm");
        let count: usize = lines.iter().map(Vec::len).sum();
        assert!(count < 6000, "{text}: {count} points");
    }
}

/// The measure itself: too few points must not pass.
#[test]
fn coarse_lines_are_noticed() {
    let viewing = sheet(Rectangle::new(-1.0, 2.0, -1.5, 1.5));
    let formula = Expression::parse("cos(x)", Some("x")).unwrap();
    let coarse: Vec<[f64; 2]> = (0..=30).map(|i| -1.0 + 0.1 * f64::from(i)).map(|x| [x, formula.evaluate(x)]).collect();
    assert!(worst("cos(x)", -1.0, 2.0, &viewing, &[coarse]) > 0.02);
}

#[test]
fn poles_and_jumps_leave_gaps() {
    let cases = [
        ("tan(x)", 5, true),
        ("1/x", 2, true),
        ("1/(x - 0.123)", 2, true),
        ("1/x^2", 2, false),
        ("floor(x)", 10, true),
        ("sign(x)", 2, true),
        ("ln(x)", 1, true),
        ("sqrt(4 - x^2)", 1, true),
        ("atan(1000*x)", 1, false),
        ("cbrt(x)", 1, true),
        ("0/0", 0, true),
    ];
    for (formula, count, monotone) in cases {
        let text = format!("[[plot]]\nwindow = [-5, 5, -6, 6]\n[[plot.curve]]\nfunction = {{ y = \"{formula}\" }}\n");
        let lines = curve(&groups(&text));
        assert_eq!(lines.len(), count, "{formula}");
        // Nowhere does a line lead from one side of a pole to the other.
        if monotone && formula != "ln(x)" && count > 1 {
            let leaps = lines
                .iter()
                .flat_map(|line| line.windows(2))
                .filter(|ends| (ends[1][0] - ends[0][0]).abs() < 0.01 && (ends[1][1] - ends[0][1]).abs() > 60.0);
            assert_eq!(leaps.count(), 0, "{formula}");
        }
    }
    // Both branches of a pole lead to the window's border.
    let lines = curve(&groups("[[plot]]\nwindow = [-5, 5, -6, 6]\n[[plot.curve]]\nfunction = { y = \"tan(x)\" }\n"));
    for pair in lines.windows(2) {
        let (end, start) = (pair[0][pair[0].len() - 1], pair[1][0]);
        assert!(near([0.0, end[1]], [0.0, 0.0]) && near([0.0, start[1]], [0.0, 100.0]), "{end:?} {start:?}");
        let pole = (end[0] / 16.0 - 5.0) / FRAC_PI_2;
        assert!((pole - pole.round()).abs() < 0.12 && (end[0] - start[0]).abs() < 6.0, "{pole}");
    }
}

#[test]
fn wild_functions_take_bounded_work() {
    for formula in [
        "sin(1/x)",
        "sin(1e9*x)",
        "tan(1e6*x)",
        "mod(1e7*x, 1)",
        "exp(exp(exp(x)))",
        "x^x^x^x",
        "1e300*x",
        "-1e300*tan(x)",
    ] {
        let text = format!("[[plot]]\nwindow = [-1, 1, -1, 1]\n[[plot.curve]]\nfunction = {{ y = \"{formula}\" }}\n");
        let lines = curve(&groups(&text));
        assert!(lines.iter().map(Vec::len).sum::<usize>() < 300_000, "{formula}");
        assert!(
            lines
                .iter()
                .flatten()
                .all(|p| (-1e-9..=160.0 + 1e-9).contains(&p[0]) && (-1e-9..=100.0 + 1e-9).contains(&p[1]))
        );
    }
}

#[test]
fn many_wild_curves_share_the_work() {
    let wild = "[[plot.curve]]\nfunction = { y = \"tan(1e6*x)\" }\nlabel = \"*t*\"\n".repeat(200);
    let groups = groups(&format!("[[plot]]\nwindow = [-1, 1, -1, 1]\n{wild}"));
    let count: usize = paths(part(&groups, "curves")).iter().flat_map(|path| points(path)).map(|line| line.len()).sum();
    assert!(count < 2_000_000, "{count}");
}

#[test]
fn numbers_stand_beside_axes_that_cross_the_picture() {
    let with = |more: &str| groups(&format!("[[plot]]\nwindow = [-4, 4, -2, 2]\n{more}"));
    let beside = with("");
    let zeros = labels(part(&beside, "axes")).into_iter().filter(|label| *label == "0").count();
    assert_eq!(zeros, 0, "where the axes cross, a number would lie on one of them");
    let below = |groups: &[Group]| texts(part(groups, "axes")).iter().filter(|text| text.at[1] > 100.0).count();
    assert_eq!(below(&beside), 0);
    // A frame sends them out.
    let framed = with("frame = true\n");
    assert_eq!(below(&framed), 9);
    assert_eq!(part(&framed, "frame").len(), 1);
    assert!(part(&with("x = { show = false }\ny = { show = false }\n"), "axes").is_empty());
}

#[test]
fn circles_are_closed_and_filled() {
    let text = "[[plot]]\nwindow = [-2, 2, -2, 2]\nfit = \"keep\"\n[[plot.curve]]\nparametric = { x = \"cos(t)\", y = \"sin(t)\", to = \"2*pi\" }\nfill = \"gold\"\n";
    let groups = groups(text);
    let found = paths(part(&groups, "curves"));
    assert_eq!((found.len(), found[0].fill), (2, Some([255, 215, 0])));
    let radius = |p: [f64; 2]| ((p[0] - 80.0) * (p[0] - 80.0) + (p[1] - 50.0) * (p[1] - 50.0)).sqrt();
    for line in points(found[1]) {
        assert!(line.iter().all(|p| (radius(*p) - 25.0).abs() < 1e-9));
    }
}

#[test]
fn fills_of_functions_end_at_zero() {
    let text = "[[plot]]\nwindow = [0, 2, -1, 1]\n[[plot.curve]]\nfunction = { y = \"4*x - 4\" }\nfill = \"red\"\n";
    let area = points(paths(part(&groups(text), "curves"))[0]);
    // Twice the area of a triangle with its point cut off, above and below, in mm².
    let polygon = &area[0];
    let cross = |(a, b): (&[f64; 2], &[f64; 2])| a[0] * b[1] - b[0] * a[1];
    let next = polygon.iter().skip(1).chain(&polygon[..1]);
    let signed: f64 = polygon.iter().zip(next).map(cross).sum::<f64>() * 0.5;
    assert!(signed.abs() < 1e-6, "the parts above and below have opposite signs: {signed}");
    let [low, high] = [f64::min, f64::max].map(|f| polygon.iter().map(|p| p[1]).fold(50.0, f));
    assert!((low, high) == (0.0, 100.0));
}

#[test]
fn arrows_and_dots_and_dashes() {
    let text = "[[plot]]\nwindow = [0, 4, 0, 4]\nx = { arrow = true }\n[[plot.curve]]\ndata = { points = [[0, 0], [1, 2], [9, 9]], marks = true }\narrow = true\ndashed = true\n[[plot.label]]\nat = [5, 5]\ntext = \"outside\"\n";
    let groups = groups(text);
    let found = paths(part(&groups, "curves"));
    assert!(!found[0].stroke.as_ref().unwrap().dashes.is_empty());
    assert!(found[1].fill.is_some() && found[1].subpaths.len() == 1, "the arrowhead");
    assert_eq!(found[2].subpaths.len(), 2, "the dots in the window");
    assert_eq!(labels(part(&groups, "labels")), ["outside"]);
    let tip = points(found[1])[0][0];
    assert!(tip[0] <= 160.0 && tip[1] >= 0.0);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 200, ..ProptestConfig::default() })]
    #[test]
    fn nothing_of_a_curve_is_outside_of_the_window(
        points in prop::collection::vec(any::<[i8; 2]>(), 1..20),
        closed in any::<bool>(),
        window in (-9.0..9.0f64, 0.1..9.0f64, -9.0..9.0f64, 0.1..9.0f64),
    ) {
        let mut plot = plot("[[plot]]\nwindow = [0, 1, 0, 1]\nviewport = [0.25, 0.75, 0.25, 0.75]\n[[plot.curve]]\ndata = { points = [[0, 0]], marks = true }\nfill = \"red\"\n");
        plot.window = Extent { left: window.0, right: window.0 + window.1, bottom: window.2, top: window.2 + window.3 };
        let scaled: Vec<[f64; 2]> = points.iter().map(|p| p.map(|c| f64::from(c) * 0.125)).collect();
        plot.curves[0].kind = snell_scene::scene::CurveKind::Data { points: scaled.clone(), closed, line: true, marks: false };
        let groups = plot_groups(&plot, 160.0, 100.0).unwrap();
        let inside = |p: &[f64; 2]| (40.0 - 1e-9..=120.0 + 1e-9).contains(&p[0]) && (25.0 - 1e-9..=75.0 + 1e-9).contains(&p[1]);
        for path in paths(part(&groups, "curves")) {
            prop_assert!(points_of(path).iter().all(inside));
        }
        // And what is in the window is there: the middle of each segment, where it is inside.
        let viewing = Viewing2::new(
            &sides(plot.window), &sides(plot.viewport), &Device { width: 160.0, height: 100.0, y_down: true }, Fit::Stretch,
        ).unwrap();
        let drawn: Vec<Vec<[f64; 2]>> = paths(part(&groups, "curves"))
            .iter().filter(|path| path.stroke.is_some()).flat_map(|path| {
                path.subpaths.iter().map(|subpath| {
                    let mut line: Vec<[f64; 2]> = points_of(&Path { subpaths: vec![subpath.clone()], ..Path::default() });
                    line.extend(subpath.closed.then(|| line[0]));
                    line
                }).collect::<Vec<_>>()
            }).collect();
        for ends in scaled.windows(2).filter(|ends| ends[0] != ends[1]) {
            let middle = [0.5 * (ends[0][0] + ends[1][0]), 0.5 * (ends[0][1] + ends[1][1])];
            if viewing.window().contains(middle) {
                let page = viewing.point(middle);
                let found = drawn.iter().flat_map(|line| line.windows(2))
                    .map(|ends| distance_to_segment(page, ends[0], ends[1])).fold(f64::INFINITY, f64::min);
                prop_assert!(found < 1e-9, "{found}");
            }
        }
    }
}

fn points_of(path: &Path) -> Vec<[f64; 2]> {
    points(path).concat()
}

/// What the property tells: lines that are not clipped lead out.
#[test]
fn lines_that_are_not_clipped_are_noticed() {
    let plot = plot("[[plot]]\nwindow = [0, 1, 0, 1]\n[[plot.curve]]\ndata = { points = [[0.5, 0.5], [2, 0.5]] }\n");
    let viewing = sheet(sides(plot.window));
    let snell_scene::scene::CurveKind::Data { points, .. } = &plot.curves[0].kind else { panic!() };
    assert!(points.iter().map(|p| viewing.point(*p)).any(|p| p[0] > 160.0 + 1e-9));
    let groups = plot_groups(&plot, 160.0, 100.0).unwrap();
    assert_eq!(curve(&groups), [[[80.0, 50.0], [160.0, 50.0]]]);
}

#[test]
fn a_label_of_a_curve_is_on_what_is_seen_of_it() {
    let text = "[[plot]]\nwindow = [0, 1, 0, 1]\n[[plot.curve]]\nfunction = { y = \"2*x\" }\nlabel = \"double\"\nlabel_at = 1\noffset = [0, 0]\n";
    let groups = groups(text);
    let label = texts(part(&groups, "labels"))[0];
    assert!(near(label.at, [80.0, 0.0]), "{:?}", label.at);
}

//! Pages of vector graphics in three formats, each seen by a viewer of its own: SVG by `resvg`, PDF by `hayro`, pixels by ourselves.

use std::f64::consts::{PI, TAU};

use hayro::hayro_interpret::InterpreterSettings;
use hayro::hayro_syntax::Pdf;
use hayro::vello_cpu::color::palette::css::WHITE;
use hayro::{PixmapSettings, RenderCache, RenderSettings};
use proptest::prelude::*;
use resvg::{tiny_skia, usvg};
use snell::vector::{
    Arc, Group, Horizontal, Item, Page, Path, Piece, Stroke, Subpath, Text, VectorError, Vertical, arrow_head,
    encode_pdf, encode_svg, join, rasterize,
};

const WIDTH: u32 = 480;

fn stroke(width: f64, dashes: &[f64]) -> Option<Stroke> {
    Some(Stroke { color: [0, 0, 0], width, dashes: dashes.to_vec() })
}

fn arc(center: [f64; 2], rotation: f64, start: f64, end: f64) -> Subpath {
    let arc = Arc { center, radii: [9.0, 5.0], rotation, start, end };
    Subpath { start: arc.point(start), pieces: vec![Piece::Arc(arc)], closed: false }
}

/// A page with something of everything, moved to the right by `moved` millimetres in one line.
fn page(moved: f64) -> Page {
    let path = |subpaths: Vec<Subpath>, stroke, fill| Item::Path(Path { subpaths, stroke, fill });
    let zigzag = Subpath::polyline(&[[5.0 + moved, 5.0], [25.0 + moved, 8.0], [12.0 + moved, 14.0]]);
    let wave = Subpath {
        start: [5.0, 25.0],
        pieces: vec![
            Piece::Cubic { first: [10.0, 15.0], second: [15.0, 35.0], to: [20.0, 25.0] },
            Piece::Line { to: [28.0, 25.0] },
        ],
        closed: false,
    };
    let arcs = vec![
        arc([45.0, 12.0], 0.5, 0.3, 2.0),
        arc([65.0, 12.0], 0.5, 2.0, 0.3),
        arc([85.0, 12.0], -1.0, 0.0, 1.3 * PI),
        arc([105.0, 12.0], 1.0, 1.0, 1.0 - 1.5 * PI),
        arc([45.0, 30.0], 2.0, 0.2, 0.2 + 1.97 * PI),
        arc([65.0, 30.0], 0.0, 3.0, 3.0 - 0.999 * PI),
    ];
    let ellipses =
        vec![Subpath::ellipse([88.0, 30.0], [9.0, 4.0], 0.7), Subpath::ellipse([107.0, 30.0], [6.0, 6.0], 0.0)];
    let mut triangle = Subpath::polyline(&[[5.0, 55.0], [20.0, 42.0], [30.0, 57.0]]);
    triangle.closed = true;
    let text = |markup: &str, at, rotation, halo| {
        Item::Text(Text {
            markup: markup.to_owned(),
            at,
            size: 6.0,
            color: [10, 40, 120],
            horizontal: Horizontal::Center,
            vertical: Vertical::Middle,
            rotation,
            halo,
        })
    };
    let group = |name: &str, items: Vec<Item>| Group { name: name.to_owned(), items };
    Page {
        width: 120.0,
        height: 80.0,
        title: Some("A page with *everything* & more".to_owned()),
        backdrop: None,
        groups: vec![
            group("lines", vec![path(vec![zigzag, wave], stroke(0.8, &[]), None)]),
            group("lines", vec![path(arcs, stroke(0.6, &[]), None), path(ellipses, stroke(0.6, &[2.0]), None)]),
            group("<fill> \"&\" 'x'\u{7}", vec![path(vec![triangle], stroke(0.5, &[]), Some([220, 180, 40]))]),
            group("", vec![Item::Path(arrow_head([60.0, 50.0], [1.0, 0.3], 6.0, [200, 0, 0]))]),
            group(
                "文字",
                vec![
                    text("*M* = *M*_o *M*_{pv}^2 − π/2", [80.0, 58.0], 0.0, true),
                    text("up", [110.0, 60.0], 1.2, false),
                ],
            ),
        ],
    }
}

/// Grey values, row after row.
struct Grey {
    size: (u32, u32),
    values: Vec<u8>,
}

fn ours(page: &Page) -> Grey {
    let picture = rasterize(page, WIDTH).expect("pixels");
    let (width, height) = picture.size();
    let value = |x: u32, y: u32| (picture.code(x, y).into_iter().sum::<u16>() / 3) as u8;
    Grey {
        size: (width, height),
        values: (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| value(x, y)).collect(),
    }
}

fn seen_by_resvg(page: &Page) -> Grey {
    let svg = encode_svg(page).expect("an SVG");
    let tree = usvg::Tree::from_str(&svg, &usvg::Options::default()).expect("well-formed");
    let scale = WIDTH as f32 / tree.size().width();
    let (width, height) = (WIDTH, (tree.size().height() * scale).round() as u32);
    let mut pixmap = tiny_skia::Pixmap::new(width, height).expect("pixels");
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    let grey = |p: &tiny_skia::PremultipliedColorU8| {
        ((u16::from(p.red()) + u16::from(p.green()) + u16::from(p.blue())) / 3) as u8
    };
    Grey { size: (width, height), values: pixmap.pixels().iter().map(grey).collect() }
}

fn seen_by_hayro(page: &Page) -> Grey {
    let pdf = Pdf::new(encode_pdf(page).expect("a PDF")).expect("a valid PDF");
    let pages = pdf.pages();
    assert_eq!(pages.len(), 1);
    let points = page.width * 72.0 / 25.4;
    let scale = (f64::from(WIDTH) + 0.01) as f32 / points as f32;
    let settings = PixmapSettings { x_scale: scale, y_scale: scale, bg_color: WHITE };
    let pixmap = hayro::render(
        &pages[0],
        &RenderCache::new(),
        &InterpreterSettings::default(),
        &RenderSettings::default(),
        &settings,
    );
    let size = (u32::from(pixmap.width()), u32::from(pixmap.height()));
    let bytes = pixmap.data_as_u8_slice();
    let values =
        bytes.chunks_exact(4).map(|p| ((u16::from(p[0]) + u16::from(p[1]) + u16::from(p[2])) / 3) as u8).collect();
    Grey { size, values }
}

/// The share of pixels that differ by more than a quarter of the range.
fn difference(a: &Grey, b: &Grey) -> f64 {
    assert_eq!(a.size.0, b.size.0);
    assert!(a.size.1.abs_diff(b.size.1) <= 1, "{:?} {:?}", a.size, b.size);
    let differs = a.values.iter().zip(&b.values).filter(|(a, b)| a.abs_diff(**b) > 64).count();
    differs as f64 / a.values.len() as f64
}

/// Of the pixels, the share that two viewers may draw differently.
const SAME: f64 = 0.0005;

#[test]
fn an_svg_looks_the_same_in_another_viewer() {
    let off = difference(&ours(&page(0.0)), &seen_by_resvg(&page(0.0)));
    assert!(off <= SAME, "{off}");
    // The twin: one line that is moved by a third of a millimetre.
    let moved = difference(&ours(&page(0.0)), &seen_by_resvg(&page(0.33)));
    assert!(moved > SAME, "{moved}");
}

#[test]
fn a_pdf_looks_the_same_in_another_viewer() {
    let off = difference(&ours(&page(0.0)), &seen_by_hayro(&page(0.0)));
    assert!(off <= SAME, "{off}");
    let moved = difference(&ours(&page(0.0)), &seen_by_hayro(&page(0.33)));
    assert!(moved > SAME, "{moved}");
}

#[test]
fn the_same_page_gives_the_same_bytes() {
    assert!(encode_svg(&page(0.0)) == encode_svg(&page(0.0)));
    assert!(encode_pdf(&page(0.0)) == encode_pdf(&page(0.0)));
    assert!(encode_pdf(&page(0.0)) != encode_pdf(&page(0.1)));
}

#[test]
fn names_become_ids_of_their_own() {
    let svg = encode_svg(&page(0.0)).expect("an SVG");
    let ids: Vec<&str> = svg.split("<g id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert_eq!(ids, ["lines", "lines-2", "fill-------x", "group", "文字"]);
    assert!(svg.contains("<title>&lt;fill&gt; &quot;&amp;&quot; 'x'</title>"), "{svg}");
    assert!(svg.contains("<title>A page with everything &amp; more</title>"));
    assert_eq!((svg.matches("<ellipse").count(), svg.matches("<circle").count()), (1, 1));
}

#[test]
fn what_is_no_number_is_never_written() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let pieces = [
            Piece::Line { to: [bad, 0.0] },
            Piece::Cubic { first: [0.0, bad], second: [0.0; 2], to: [1.0; 2] },
            Piece::Arc(Arc { center: [0.0; 2], radii: [1.0, bad], rotation: 0.0, start: 0.0, end: 1.0 }),
            Piece::Arc(Arc { center: [0.0; 2], radii: [1.0; 2], rotation: bad, start: 0.0, end: 1.0 }),
        ];
        for piece in pieces {
            let subpath = Subpath { start: [0.0; 2], pieces: vec![piece], closed: false };
            let item = Item::Path(Path { subpaths: vec![subpath], stroke: stroke(1.0, &[]), fill: None });
            let groups = vec![Group { name: "bad one".to_owned(), items: vec![item] }];
            let page = Page { width: 10.0, height: 10.0, groups, ..Page::default() };
            let expected = VectorError::NotFinite { group: "bad one".to_owned() };
            assert_eq!(encode_svg(&page), Err(expected.clone()), "{piece:?}");
            assert_eq!(encode_pdf(&page), Err(expected.clone()));
            assert_eq!(rasterize(&page, 10), Err(expected));
        }
        let page = Page { width: bad, height: 10.0, ..Page::default() };
        assert!(matches!(encode_svg(&page), Err(VectorError::Page { .. })));
    }
    let page = Page { width: 10.0, height: 10.0, ..Page::default() };
    assert!(matches!(rasterize(&page, 0), Err(VectorError::TooLarge { .. })));
    assert!(matches!(rasterize(&page, 65_536), Err(VectorError::TooLarge { .. })));
}

/// The point of a Bézier curve.
fn bezier(start: [f64; 2], [first, second, to]: [[f64; 2]; 3], t: f64) -> [f64; 2] {
    let s = 1.0 - t;
    [0, 1].map(|k| s * s * s * start[k] + 3.0 * s * s * t * first[k] + 3.0 * s * t * t * second[k] + t * t * t * to[k])
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn arcs_as_curves_stay_on_the_ellipse(
        a in 0.5..9.0f64, b in 0.5..9.0f64, rotation in -3.0..3.0f64, start in -9.0..9.0f64, swept in -TAU..TAU,
    ) {
        let arc = Arc { center: [3.0, -2.0], radii: [a, b], rotation, start, end: start + swept };
        let mut from = arc.point(start);
        for cubic in arc.cubics() {
            for step in 0..=8 {
                let p = bezier(from, cubic, f64::from(step) / 8.0);
                let (x, y) = (p[0] - 3.0, p[1] + 2.0);
                let (c, s) = (snell::math::portable::cos(rotation), snell::math::portable::sin(rotation));
                let radius = ((c * x + s * y) / a) * ((c * x + s * y) / a) + ((c * y - s * x) / b) * ((c * y - s * x) / b);
                prop_assert!((radius.sqrt() - 1.0).abs() < 1e-6, "{}", radius.sqrt());
            }
            from = cubic[2];
        }
        let end = arc.point(start + swept);
        prop_assert!((from[0] - end[0]).abs() < 1e-9 && (from[1] - end[1]).abs() < 1e-9);
    }

    #[test]
    fn joined_lines_draw_the_same_and_nothing_twice(
        segments in prop::collection::vec(((0..6i32, 0..6i32), any::<bool>(), any::<bool>()), 0..60),
    ) {
        // Unit segments of a grid, some of them more than once and either way around.
        let ends: Vec<[[f64; 2]; 2]> = segments.iter().map(|((x, y), level, turned)| {
            let a = [f64::from(*x), f64::from(*y)];
            let b = if *level { [a[0] + 1.0, a[1]] } else { [a[0], a[1] + 1.0] };
            if *turned { [b, a] } else { [a, b] }
        }).collect();
        let key = |a: [f64; 2], b: [f64; 2]| {
            let (a, b) = (a.map(|c| c.round() as i32), b.map(|c| c.round() as i32));
            if a < b { (a, b) } else { (b, a) }
        };
        let mut wanted: Vec<_> = ends.iter().map(|[a, b]| key(*a, *b)).collect();
        wanted.sort_unstable();
        wanted.dedup();
        let before: Vec<Subpath> = ends.iter().map(|line| Subpath::polyline(line)).collect();
        let joined = join(before.clone(), 1e-6);
        let mut drawn = Vec::new();
        for subpath in &joined {
            let mut at = subpath.start;
            for piece in &subpath.pieces {
                let to = piece.end();
                let steps = (to[0] - at[0]).abs().max((to[1] - at[1]).abs()).round() as i32;
                for step in 0..steps {
                    let between = |s: i32| [0, 1].map(|k| at[k] + (to[k] - at[k]) * f64::from(s) / f64::from(steps));
                    drawn.push(key(between(step), between(step + 1)));
                }
                at = to;
            }
        }
        drawn.sort_unstable();
        prop_assert_eq!(&drawn, &wanted);
        prop_assert!(joined.len() <= wanted.len());
        prop_assert_eq!(join(before, 1e-6), joined);
    }
}

#[test]
fn halves_of_an_ellipse_become_one() {
    let half = |start: f64, end: f64| arc([10.0, 10.0], 0.3, start, end);
    let joined = join(vec![half(0.5, 0.5 + PI), half(0.5 + PI, 0.5 + TAU), half(0.5 + PI, 0.5)], 1e-6);
    let [Subpath { pieces, closed: true, .. }] = &joined[..] else { panic!("{joined:?}") };
    assert!(matches!(pieces[..], [Piece::Arc(arc)] if arc.is_full()), "{pieces:?}");
}

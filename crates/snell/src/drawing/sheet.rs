//! From seen lines to groups of strokes on a page: one group for each object by its name, no line twice, joined for a pen.

use std::collections::BTreeMap;

use snell_scene::scene::{HiddenLines, StrokeBy};

use super::duplicates::uncovered;
use super::lines::{Line, SeenLine};
use super::pen;
use super::screen::Screen;
use super::visibility::Part;
use crate::outline::{Curve, FeatureKind};
use crate::vector::{self, Arc, Group, Item, Path, Piece, Stroke, Subpath};
use crate::viewing::RectangleMap;

/// Ends nearer than this are one, in pixels.
const TOGETHER: f64 = 0.02;
/// How many steps a stroke by depth has.
const DEPTHS: usize = 6;

/// How lines are drawn.
#[derive(Clone, Debug)]
pub struct Style {
    /// What becomes of hidden lines.
    pub hidden: HiddenLines,
    /// What a stroke's colour tells.
    pub stroke: StrokeBy,
    /// Width of outlines in millimetres; other lines are thinner.
    pub line_width: f64,
    /// Depths along the gaze between which strokes by depth go from strong to faint.
    pub depths: [f64; 2],
}

/// Colours that can be told from each other, also by those who see fewer: after Okabe and Ito, darkened for lines on white.
const PALETTE: [[u8; 3]; 8] = [
    [0, 0, 0],
    [0, 92, 152],
    [196, 72, 0],
    [0, 126, 92],
    [150, 66, 122],
    [150, 108, 0],
    [44, 130, 186],
    [110, 110, 110],
];

/// What distinguishes strokes within one object.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Pen {
    /// Hidden lines are drawn first, then parameter lines, creases, outlines.
    weight: Weight,
    color: [u8; 3],
    /// The step of depth, where the stroke tells it.
    depth: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Weight {
    Hidden,
    Parameter,
    Crease,
    Outline,
}

impl Weight {
    fn of(kind: FeatureKind) -> Self {
        match kind {
            FeatureKind::Parameter => Self::Parameter,
            FeatureKind::Crease | FeatureKind::Intersection => Self::Crease,
            FeatureKind::Boundary | FeatureKind::Contour | FeatureKind::Horizon => Self::Outline,
        }
    }

    /// Relative to the style's own width.
    fn width(self) -> f64 {
        match self {
            Self::Hidden | Self::Parameter => 0.45,
            Self::Crease => 0.7,
            Self::Outline => 1.0,
        }
    }
}

impl Pen {
    fn stroke(self, style: &Style) -> Stroke {
        let fade = self.depth as f64 / (DEPTHS - 1) as f64;
        let faint = |c: u8| (f64::from(c) + (200.0 - f64::from(c)) * fade).round() as u8;
        let color = self.color.map(|c| if fade > 0.0 { faint(c) } else { c });
        let color = if self.weight == Weight::Parameter { color.map(|c| c.max(120)) } else { color };
        let width = style.line_width * self.weight.width() * (1.0 - 0.4 * fade);
        let dashed = self.weight == Weight::Hidden && style.hidden == HiddenLines::Dashed;
        let dashes = if dashed { vec![4.0 * style.line_width, 3.0 * style.line_width] } else { Vec::new() };
        Stroke { color, width, dashes }
    }
}

/// The lines of a scene as groups on a page, the objects in the scene's order. `name` says what an object is called.
pub fn groups(
    seen: &[SeenLine],
    screen: &Screen<'_>,
    style: &Style,
    page_from_raster: &RectangleMap,
    name: impl Fn(u32) -> String,
) -> Vec<Group> {
    // Strongest first, so that of two lines in one place the stronger one stays.
    let mut strokes: Vec<(u32, Pen, Subpath)> = Vec::new();
    for line in seen.iter().filter(|seen| seen.line.mark.is_none()) {
        for part in &line.parts {
            if part.visible || style.hidden != HiddenLines::Removed {
                write_part(line, part, screen, style, &mut strokes);
            }
        }
    }
    let mut order: Vec<usize> = (0..strokes.len()).collect();
    order.sort_by_key(|&index| (std::cmp::Reverse(strokes[index].1.weight), index));
    let straight: Vec<usize> = order.into_iter().filter(|&index| line_of(&strokes[index].2).is_some()).collect();
    let ends: Vec<[[f64; 2]; 2]> = straight.iter().filter_map(|&index| line_of(&strokes[index].2)).collect();
    let mut left: Vec<Option<Vec<[f64; 2]>>> = vec![None; strokes.len()];
    for (index, parts) in straight.into_iter().zip(uncovered(&ends)) {
        left[index] = Some(parts);
    }
    let mut by_object: BTreeMap<u32, BTreeMap<Pen, Vec<Subpath>>> = BTreeMap::new();
    for ((object, pen, subpath), left) in strokes.into_iter().zip(left) {
        let subpaths = by_object.entry(object).or_default().entry(pen).or_default();
        match (left, line_of(&subpath)) {
            (Some(parts), Some([a, b])) => subpaths.extend(parts.into_iter().map(|part| {
                let [from, to] = part.map(|share| [0, 1].map(|k| a[k] + (b[k] - a[k]) * share));
                Subpath { start: from, pieces: vec![Piece::Line { to }], closed: false }
            })),
            _ => subpaths.push(subpath),
        }
    }
    let group = |(object, pens): (u32, BTreeMap<Pen, Vec<Subpath>>)| {
        let items = pens.into_iter().filter_map(|(pen, subpaths)| {
            let joined = vector::join(subpaths, TOGETHER);
            let subpaths: Vec<Subpath> = joined.iter().map(|subpath| on_page(subpath, page_from_raster)).collect();
            let path = Path { subpaths, stroke: Some(pen.stroke(style)), fill: None };
            (!path.subpaths.is_empty()).then_some(Item::Path(path))
        });
        Group { name: name(object), items: items.collect() }
    };
    by_object.into_iter().map(group).filter(|group| !group.items.is_empty()).collect()
}

/// Both ends of what is one straight line.
fn line_of(subpath: &Subpath) -> Option<[[f64; 2]; 2]> {
    match subpath.pieces.as_slice() {
        [Piece::Line { to }] => Some([subpath.start, *to]),
        _ => None,
    }
}

fn write_part(
    seen: &SeenLine,
    part: &Part,
    screen: &Screen<'_>,
    style: &Style,
    strokes: &mut Vec<(u32, Pen, Subpath)>,
) {
    let Line { feature, object, material, .. } = &seen.line;
    let Part { from, to, visible, is_outline } = *part;
    let color = match style.stroke {
        StrokeBy::Uniform | StrokeBy::Depth => PALETTE[0],
        StrokeBy::Object => PALETTE[*object as usize % PALETTE.len()],
        StrokeBy::Material => PALETTE[*material as usize % PALETTE.len()],
    };
    let weight = match visible {
        false => Weight::Hidden,
        true if is_outline => Weight::Outline,
        true => Weight::of(feature.kind),
    };
    let mut put = |from: f64, to: f64, depth: usize| {
        strokes.push((*object, Pen { weight, color, depth }, pen::write(screen, &feature.curve, from, to)));
    };
    if style.stroke != StrokeBy::Depth {
        put(from, to, 0);
        return;
    }
    // Cut where the curve passes from one step of depth to the next.
    let step = |t: f64| depth_step(&feature.curve, t, screen, style.depths);
    let pieces = 32;
    let at = |index: u32| from + (to - from) * f64::from(index) / f64::from(pieces);
    let (mut start, mut current) = (from, step(at(0)));
    for index in 1..=pieces {
        let (mut low, high) = (at(index - 1), at(index));
        // A curve may go to and fro between steps, but not without end.
        for _ in 0..2 * DEPTHS {
            if step(high) == current {
                break;
            }
            let (mut a, mut b) = (low, high);
            for _ in 0..40 {
                let middle = 0.5 * (a + b);
                if step(middle) == current { a = middle } else { b = middle }
            }
            put(start, b, current);
            (start, low, current) = (b, b, step(b));
        }
    }
    if start < to {
        put(start, to, current);
    }
}

/// The step of depth of a curve's point: 0 is nearest.
fn depth_step(curve: &Curve, t: f64, screen: &Screen<'_>, [near, far]: [f64; 2]) -> usize {
    let Ok(point) = curve.point(t).homogenize() else { return DEPTHS - 1 };
    let depth = -(point - screen.camera.eye()).dot(screen.camera.axes()[2]);
    let share = (depth - near) / (far - near);
    if share > 0.0 { ((share * DEPTHS as f64) as usize).min(DEPTHS - 1) } else { 0 }
}

/// A line of the raster on the page. The map keeps proportions, so ellipses keep their angles.
pub fn on_page(subpath: &Subpath, page_from_raster: &RectangleMap) -> Subpath {
    let point = |p: [f64; 2]| page_from_raster.point(p);
    let scale = page_from_raster.scale()[0].abs();
    let pieces = subpath.pieces.iter().map(|piece| match *piece {
        Piece::Line { to } => Piece::Line { to: point(to) },
        Piece::Cubic { first, second, to } => {
            Piece::Cubic { first: point(first), second: point(second), to: point(to) }
        }
        Piece::Arc(arc) => Piece::Arc(Arc { center: point(arc.center), radii: arc.radii.map(|r| r * scale), ..arc }),
    });
    Subpath { start: point(subpath.start), pieces: pieces.collect(), closed: subpath.closed }
}

//! Curves: what is seen of them in the window, as lines on the page, with fills, dots, arrowheads and labels.

use snell_scene::scene::{CurveKind, PlotCurve};

use super::Sheet;
use super::pen::{self, ARROW, LETTERS, color, dot, filled, lines, polyline, stroke, text};
use super::sample::sample;
use crate::vector::Item;
use crate::viewing::{Rectangle, Viewing2};

/// Dashes and gaps, in widths of the line.
const DASHES: [f64; 2] = [4.5, 3.5];

impl Sheet<'_> {
    pub(super) fn curves(&self) -> Vec<Item> {
        let curves = self.plot.curves.iter().zip(&self.lines);
        curves.flat_map(|(curve, lines)| self.curve(curve, lines)).collect()
    }

    /// What is seen of lines, on the page.
    pub(super) fn clipped(&self, world: &[Vec<[f64; 2]>]) -> Vec<Vec<[f64; 2]>> {
        let mut seen: Vec<Vec<[f64; 2]>> = Vec::new();
        for line in world {
            let mut current: Vec<[f64; 2]> = Vec::new();
            for ends in line.windows(2) {
                match self.viewing.segment(ends[0], ends[1]) {
                    Some([from, to]) => {
                        if current.last() != Some(&from) {
                            seen.extend(Some(std::mem::take(&mut current)).filter(|line| line.len() > 1));
                            current.push(from);
                        }
                        if from != to {
                            current.push(to);
                        }
                    }
                    None => seen.extend(Some(std::mem::take(&mut current)).filter(|line| line.len() > 1)),
                }
            }
            seen.extend(Some(current).filter(|line| line.len() > 1));
        }
        seen
    }

    fn curve(&self, curve: &PlotCurve, world: &[Vec<[f64; 2]>]) -> Vec<Item> {
        let mut items = Vec::new();
        let ink = color(curve.color);
        if let Some(fill) = curve.fill {
            let areas = world.iter().filter_map(|line| self.area(curve, line));
            let areas: Vec<_> = areas.collect();
            items.extend((!areas.is_empty()).then(|| filled(areas, color(fill))));
        }
        let is_line = !matches!(curve.kind, CurveKind::Data { line: false, .. });
        if is_line {
            self.line(curve, self.clipped(world), &mut items);
        }
        if let CurveKind::Data { points, marks: true, .. } = &curve.kind {
            let window = self.viewing.window();
            let radius = curve.width.max(0.3) * 1.4;
            let inside = points.iter().filter(|point| window.contains(**point));
            let dots: Vec<_> = inside.map(|point| dot(self.viewing.point(*point), radius)).collect();
            items.extend((!dots.is_empty()).then(|| filled(dots, ink)));
        }
        items
    }

    fn line(&self, curve: &PlotCurve, mut seen: Vec<Vec<[f64; 2]>>, items: &mut Vec<Item>) {
        let ink = color(curve.color);
        let mut head = None;
        if curve.arrow
            && let Some(last) = seen.last_mut()
            && let Some(tip) = last.last().copied()
        {
            let length = ARROW.max(4.0 * curve.width);
            pen::shorten(last, 0.7 * length);
            head = last.last().and_then(|from| pen::arrow_head(tip, *from, length, ink));
        }
        let subpaths: Vec<_> = seen.iter().filter_map(|line| closed_polyline(line)).collect();
        if !subpaths.is_empty() {
            let mut stroke = stroke(ink, curve.width);
            if curve.dashed {
                stroke.dashes = DASHES.map(|widths| widths * curve.width.max(0.25)).to_vec();
            }
            items.push(lines(subpaths, stroke));
        }
        items.extend(head);
    }

    /// The area that a line encloses, or a function with y = 0, clipped to the window, on the page.
    fn area(&self, curve: &PlotCurve, line: &[[f64; 2]]) -> Option<crate::vector::Subpath> {
        let mut polygon = line.to_vec();
        if let (CurveKind::Function { .. }, Some(first), Some(last)) = (&curve.kind, line.first(), line.last()) {
            polygon.extend([[last[0], 0.0], [first[0], 0.0]]);
        }
        let polygon = clip_polygon(&polygon, &self.viewing.window());
        let page: Vec<[f64; 2]> = polygon.into_iter().map(|point| self.viewing.point(point)).collect();
        polyline(&page, true)
    }

    /// Where the label of a curve belongs: on what is seen of its lines, or at one of its points where it has no lines.
    fn label_place(&self, curve: &PlotCurve, world: &[Vec<[f64; 2]>]) -> Option<[f64; 2]> {
        if let CurveKind::Data { points, line, .. } = &curve.kind
            && (!line || points.len() == 1)
        {
            let window = self.viewing.window();
            let seen: Vec<_> = points.iter().filter(|point| window.contains(**point)).collect();
            let last = seen.len().checked_sub(1)?;
            return Some(self.viewing.point(*seen[(curve.label_at * last as f64).round() as usize]));
        }
        along(&self.clipped(world), curve.label_at)
    }

    pub(super) fn curve_labels(&self) -> Vec<Item> {
        let mut items = Vec::new();
        for (curve, lines) in self.plot.curves.iter().zip(&self.lines) {
            let Some(label) = &curve.label else { continue };
            let Some([x, y]) = self.label_place(curve, lines) else { continue };
            let at = [x + curve.offset[0], y - curve.offset[1]];
            items.push(text(label, at, LETTERS, color(curve.color), pen::anchor(curve.offset)));
        }
        items
    }
}

/// A curve in world coordinates, in as many lines as it has without lifting the pen.
pub(super) fn world_lines(curve: &PlotCurve, viewing: &Viewing2, evaluations: usize) -> Vec<Vec<[f64; 2]>> {
    let window = viewing.window();
    match &curve.kind {
        CurveKind::Function { y, from, to } => {
            let (from, to) = (from.max(window.left), to.min(window.right));
            if from >= to {
                return Vec::new();
            }
            sample(|x| [x, y.evaluate(x)], from, to, viewing, evaluations)
        }
        CurveKind::Parametric { x, y, from, to } => {
            sample(|t| [x.evaluate(t), y.evaluate(t)], *from, *to, viewing, evaluations)
        }
        CurveKind::Data { points, closed, .. } => {
            let mut line = points.clone();
            if *closed {
                line.extend(points.first());
            }
            vec![line]
        }
    }
}

/// A line that is closed where it ends as it begins.
fn closed_polyline(line: &[[f64; 2]]) -> Option<crate::vector::Subpath> {
    match line {
        [first, middle @ .., last] if middle.len() >= 2 && first == last => polyline(&line[..line.len() - 1], true),
        _ => polyline(line, false),
    }
}

/// The point at a share of the length of lines.
fn along(lines: &[Vec<[f64; 2]>], share: f64) -> Option<[f64; 2]> {
    let segments = || lines.iter().flat_map(|line| line.windows(2));
    let length = |ends: &[[f64; 2]]| {
        let [dx, dy] = [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
        (dx * dx + dy * dy).sqrt()
    };
    let mut rest = share * segments().map(length).sum::<f64>();
    for ends in segments() {
        let here = length(ends);
        if rest <= here && here > 0.0 {
            let t = rest / here;
            return Some([0, 1].map(|i| ends[0][i] + (ends[1][i] - ends[0][i]) * t));
        }
        rest -= here;
    }
    lines.last()?.last().copied()
}

/// A polygon's part within a rectangle. Sutherland and Hodgman, "Reentrant Polygon Clipping", CACM 17(1), 1974: parts may be joined
/// by lines along the border, which enclose nothing.
fn clip_polygon(polygon: &[[f64; 2]], window: &Rectangle) -> Vec<[f64; 2]> {
    let sides = [
        (0, window.left.min(window.right), 1.0),
        (0, window.left.max(window.right), -1.0),
        (1, window.bottom.min(window.top), 1.0),
        (1, window.bottom.max(window.top), -1.0),
    ];
    let mut polygon = polygon.to_vec();
    for (axis, side, sign) in sides {
        let mut clipped = Vec::with_capacity(polygon.len() + 4);
        for (i, b) in polygon.iter().enumerate() {
            let a = polygon[(i + polygon.len() - 1) % polygon.len()];
            let (from, to) = (sign * (a[axis] - side), sign * (b[axis] - side));
            if (from < 0.0) != (to < 0.0) {
                let t = from / (from - to);
                let mut cut = [0, 1].map(|i| a[i] + (b[i] - a[i]) * t);
                cut[axis] = side;
                clipped.push(cut);
            }
            if to >= 0.0 {
                clipped.push(*b);
            }
        }
        polygon = clipped;
    }
    polygon
}

//! Items of a page, made short: lines, dots, arrowheads, texts. Millimetres of the page.

use std::f64::consts::TAU;

use snell_math::Rgb;
use snell_math::color::linear_to_srgb;

use crate::vector::{Arc, Horizontal, Item, Path, Piece, Stroke, Subpath, Text, Vertical};
use crate::viewing::Rectangle;

/// The colour of axes and their labels.
pub(super) const INK: [u8; 3] = [0; 3];
/// Height of the letters of labels, mm.
pub(super) const LETTERS: f64 = 3.2;
/// Length of an arrowhead, mm.
pub(super) const ARROW: f64 = 2.4;

/// A scene-linear colour as sRGB codes.
pub(super) fn color(color: Rgb) -> [u8; 3] {
    color.to_array().map(|linear| (255.0 * linear_to_srgb(linear.clamp(0.0, 1.0))).round() as u8)
}

pub(super) fn stroke(color: [u8; 3], width: f64) -> Stroke {
    Stroke { color, width, dashes: Vec::new() }
}

/// A line through points; none where there are fewer than two.
pub(super) fn polyline(points: &[[f64; 2]], closed: bool) -> Option<Subpath> {
    let [start, rest @ ..] = points else { return None };
    let pieces: Vec<Piece> = rest.iter().map(|to| Piece::Line { to: *to }).collect();
    (!pieces.is_empty()).then_some(Subpath { start: *start, pieces, closed })
}

pub(super) fn lines(subpaths: Vec<Subpath>, stroke: Stroke) -> Item {
    Item::Path(Path { subpaths, stroke: Some(stroke), fill: None })
}

/// Straight lines of one look.
pub(super) fn segments(ends: &[[[f64; 2]; 2]], stroke: Stroke) -> Option<Item> {
    let subpaths: Vec<Subpath> = ends.iter().filter_map(|ends| polyline(ends, false)).collect();
    (!subpaths.is_empty()).then(|| lines(subpaths, stroke))
}

pub(super) fn rectangle(r: &Rectangle, stroke: Stroke) -> Item {
    let corners = [[r.left, r.bottom], [r.right, r.bottom], [r.right, r.top], [r.left, r.top]];
    lines(polyline(&corners, true).into_iter().collect(), stroke)
}

/// A disk.
pub(super) fn dot(center: [f64; 2], radius: f64) -> Subpath {
    let arc = Arc { center, radii: [radius; 2], rotation: 0.0, start: 0.0, end: TAU };
    Subpath { start: arc.point(0.0), pieces: vec![Piece::Arc(arc)], closed: true }
}

pub(super) fn filled(subpaths: Vec<Subpath>, color: [u8; 3]) -> Item {
    Item::Path(Path { subpaths, stroke: None, fill: Some(color) })
}

/// A narrow head with a hollow back, its tip at a point; `from` is anywhere behind it.
pub(super) fn arrow_head(tip: [f64; 2], from: [f64; 2], length: f64, color: [u8; 3]) -> Option<Item> {
    let [dx, dy] = [tip[0] - from[0], tip[1] - from[1]];
    let distance = (dx * dx + dy * dy).sqrt();
    if distance <= 0.0 || !distance.is_finite() {
        return None;
    }
    let [ux, uy] = [dx / distance, dy / distance];
    let at = |back: f64, side: f64| [tip[0] - back * ux - side * uy, tip[1] - back * uy + side * ux];
    let corners = [tip, at(length, 0.32 * length), at(0.72 * length, 0.0), at(length, -0.32 * length)];
    Some(filled(polyline(&corners, true).into_iter().collect(), color))
}

/// Takes a length off a line's end, so that it ends within the arrowhead there and not at its tip.
pub(super) fn shorten(points: &mut Vec<[f64; 2]>, mut by: f64) {
    while let [.., before, last] = points.as_slice() {
        let [dx, dy] = [before[0] - last[0], before[1] - last[1]];
        let length = (dx * dx + dy * dy).sqrt();
        let (last, before) = (*last, *before);
        points.pop();
        if length > by {
            points.push([last[0] + dx * (by / length), last[1] + dy * (by / length)]);
            return;
        }
        by -= length;
        if points.len() < 2 {
            points.push(before);
            return;
        }
    }
}

pub(super) fn text(
    markup: &str,
    at: [f64; 2],
    size: f64,
    color: [u8; 3],
    (horizontal, vertical): (Horizontal, Vertical),
) -> Item {
    Item::Text(Text { markup: markup.to_owned(), at, size, color, horizontal, vertical, rotation: 0.0, halo: true })
}

/// The point of a text that is nearest to what it names, by where it stands beside that: `offset` in mm, y up.
pub(super) fn anchor(offset: [f64; 2]) -> (Horizontal, Vertical) {
    let horizontal = if offset[0] > 0.2 {
        Horizontal::Left
    } else if offset[0] < -0.2 {
        Horizontal::Right
    } else {
        Horizontal::Center
    };
    let vertical = if offset[1] > 0.2 {
        Vertical::Baseline
    } else if offset[1] < -0.2 {
        Vertical::Top
    } else {
        Vertical::Middle
    };
    (horizontal, vertical)
}

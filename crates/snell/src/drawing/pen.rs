//! From the seen parts of curves to what is written: straight lines as lines, conics as arcs of ellipses, all others as cubic
//! Bézier curves as near as [`NEAR`]. Raster coordinates.

use std::f64::consts::TAU;

use snell_math::{Homogeneous3, portable};

use super::screen::{Sample, Screen};
use crate::outline::Curve;
use crate::vector::{Arc, Piece, Subpath};

/// How far what is written may be from the curve, in pixels.
const NEAR: f64 = 0.01;
/// How often a piece is halved at most to come that close.
const MOST_HALVINGS: u32 = 10;

/// The picture of a curve between two parameters, inside of the view volume.
pub fn write(screen: &Screen<'_>, curve: &Curve, from: f64, to: f64) -> Subpath {
    let (start, end) = (screen.sample(curve, from), screen.sample(curve, to));
    match curve {
        Curve::Segment { .. } => Subpath { start: start.at, pieces: vec![Piece::Line { to: end.at }], closed: false },
        Curve::Polyline(_) => simplified(&screen.track(curve, [from, to])),
        Curve::Conic { center, cos, sin, .. } => {
            let arc =
                ellipse(screen, [*center, *cos, *sin]).and_then(|ellipse| arc(screen, curve, &ellipse, start, end));
            match arc {
                Some(arc) => {
                    Subpath { start: arc.point(arc.start), closed: arc.is_full(), pieces: vec![Piece::Arc(arc)] }
                }
                None => fitted(screen, curve, start, end),
            }
        }
        Curve::Torus(_) => fitted(screen, curve, start, end),
    }
}

/// The ellipse that a conic's picture is a part of; `None` where it is none (the conic runs through the eye's plane, or is seen edge
/// on). Its arc is left at a full turn.
///
/// With M the matrix that takes (1, cos θ, sin θ) to homogeneous raster coordinates, the picture is all p with pᵀ Q p = 0 for
/// Q = M⁻ᵀ diag(−1, 1, 1) M⁻¹.
fn ellipse(screen: &Screen<'_>, conic: [Homogeneous3; 3]) -> Option<Arc> {
    let columns = conic.map(|p| screen.raster_times_h(screen.clip(p)));
    let [[xc, yc, hc], [xa, ya, ha], [xb, yb, hb]] = columns;
    if hc * hc <= (ha * ha + hb * hb) * (1.0 + 1e-9) {
        return None;
    }
    // About the picture of the conic's own middle, so that coordinates are no larger than the ellipse.
    let (ox, oy) = (xc / hc, yc / hc);
    let m = [[0.0, xa - ox * ha, xb - ox * hb], [0.0, ya - oy * ha, yb - oy * hb], [hc, ha, hb]];
    // The rows of M⁻¹ up to its determinant.
    let minor = |r: [usize; 2], c: [usize; 2]| m[r[0]][c[0]] * m[r[1]][c[1]] - m[r[0]][c[1]] * m[r[1]][c[0]];
    let others = [[1, 2], [0, 2], [0, 1]];
    let sign = |i: usize, j: usize| if (i + j).is_multiple_of(2) { 1.0 } else { -1.0 };
    let inverse: [[f64; 3]; 3] =
        std::array::from_fn(|row| std::array::from_fn(|column| sign(row, column) * minor(others[column], others[row])));
    let q = |i: usize, j: usize| {
        inverse[1][i] * inverse[1][j] + inverse[2][i] * inverse[2][j] - inverse[0][i] * inverse[0][j]
    };
    let (a, b, c, d, e, f) = (q(0, 0), q(0, 1), q(1, 1), q(0, 2), q(1, 2), q(2, 2));
    let determinant = a * c - b * b;
    let center = [(b * e - c * d) / determinant, (b * d - a * e) / determinant];
    // What is left at the middle, by which the form is divided.
    let rest = -(f + d * center[0] + e * center[1]);
    let (a, b, c) = (a / rest, b / rest, c / rest);
    let (mean, half) = (0.5 * (a + c), 0.5 * (a - c));
    let spread = (half * half + b * b).sqrt();
    let radii = [1.0 / (mean - spread).sqrt(), 1.0 / (mean + spread).sqrt()];
    // The longer axis is along the eigenvector of the smaller eigenvalue.
    let rotation = if spread > 1e-12 * mean { 0.5 * portable::atan2(-2.0 * b, -(a - c)) } else { 0.0 };
    let center = [center[0] + ox, center[1] + oy];
    let numbers = [center[0], center[1], radii[0], radii[1], rotation];
    // A sliver of an ellipse is a line, twice.
    let is_sound = numbers.iter().all(|n| n.is_finite()) && radii[1] > 1e-6 * radii[0];
    is_sound.then_some(Arc { center, radii, rotation, start: 0.0, end: TAU })
}

/// The part of an ellipse between two points of the conic that it is the picture of; `None` where rounding has spoilt it.
fn arc(screen: &Screen<'_>, curve: &Curve, ellipse: &Arc, start: Sample, end: Sample) -> Option<Arc> {
    let angle = |p: [f64; 2]| {
        let (x, y) = (p[0] - ellipse.center[0], p[1] - ellipse.center[1]);
        let (c, s) = (portable::cos(ellipse.rotation), portable::sin(ellipse.rotation));
        portable::atan2((c * y - s * x) / ellipse.radii[1], (c * x + s * y) / ellipse.radii[0])
    };
    // All around in small steps of the parameter: the sum of the small turns is the angle, with its direction.
    let steps = 16;
    let mut swept = 0.0;
    let mut last = angle(start.at);
    let first = last;
    for index in 1..=steps {
        let t = start.t + (end.t - start.t) * f64::from(index) / f64::from(steps);
        let sample = if index == steps { end } else { screen.sample(curve, t) };
        let next = angle(sample.at);
        let turn = (next - last + 1.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
        swept += turn;
        last = next;
        let on_ellipse = ellipse.point(next);
        if ((on_ellipse[0] - sample.at[0]).abs()).max((on_ellipse[1] - sample.at[1]).abs()) > NEAR {
            return None;
        }
    }
    let is_whole = (end.t - start.t).abs() >= TAU * (1.0 - 1e-9);
    let swept = if is_whole { TAU.copysign(swept) } else { swept };
    Some(Arc { start: first, end: first + swept, ..*ellipse })
}

/// A curve by cubic Bézier pieces whose ends lie on it and that run along it there.
fn fitted(screen: &Screen<'_>, curve: &Curve, start: Sample, end: Sample) -> Subpath {
    let mut pieces = Vec::new();
    let count = 8;
    let mut last = start;
    for index in 1..=count {
        let t = start.t + (end.t - start.t) * f64::from(index) / f64::from(count);
        let next = if index == count { end } else { screen.sample(curve, t) };
        fit(screen, curve, last, next, 0, &mut pieces);
        last = next;
    }
    Subpath { start: start.at, pieces, closed: false }
}

fn fit(screen: &Screen<'_>, curve: &Curve, a: Sample, b: Sample, depth: u32, pieces: &mut Vec<Piece>) {
    let span = b.t - a.t;
    // Derivatives from within the piece: beyond its end there may be nothing.
    let slope = |at: Sample, step: f64| {
        let (one, two) = (screen.sample(curve, at.t + step), screen.sample(curve, at.t + 2.0 * step));
        [0, 1].map(|k| (4.0 * one.at[k] - two.at[k] - 3.0 * at.at[k]) / (2.0 * step))
    };
    let step = span * (1.0 / 256.0);
    let (da, db) = (slope(a, step), slope(b, -step));
    let first = [0, 1].map(|k| a.at[k] + da[k] * span / 3.0);
    let second = [0, 1].map(|k| b.at[k] - db[k] * span / 3.0);
    let off = [0.25, 0.5, 0.75].into_iter().map(|share| {
        let (s, r) = (share, 1.0 - share);
        let weights = [r * r * r, 3.0 * r * r * s, 3.0 * r * s * s, s * s * s];
        let on_piece = [0, 1]
            .map(|k| weights[0] * a.at[k] + weights[1] * first[k] + weights[2] * second[k] + weights[3] * b.at[k]);
        let on_curve = screen.sample(curve, a.t + span * share).at;
        (on_piece[0] - on_curve[0]).abs().max((on_piece[1] - on_curve[1]).abs())
    });
    let off = off.fold(0.0, f64::max);
    if off > NEAR && depth < MOST_HALVINGS {
        let middle = screen.sample(curve, 0.5 * (a.t + b.t));
        fit(screen, curve, a, middle, depth + 1, pieces);
        fit(screen, curve, middle, b, depth + 1, pieces);
    } else {
        pieces.push(Piece::Cubic { first, second, to: b.at });
    }
}

/// A chain of points without those that a straight line between others passes nearly: Douglas and Peucker, The Canadian
/// Cartographer 10(2), 1973.
fn simplified(track: &[Sample]) -> Subpath {
    let points: Vec<[f64; 2]> = track.iter().map(|sample| sample.at).collect();
    let Some((first, last)) = points.first().zip(points.len().checked_sub(1)) else { return Subpath::default() };
    let mut keep = vec![false; points.len()];
    keep[last] = true;
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        let (a, b) = (points[from], points[to]);
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = (dx * dx + dy * dy).sqrt();
        let off = |p: [f64; 2]| {
            let (px, py) = (p[0] - a[0], p[1] - a[1]);
            if length > 1e-9 { (dx * py - dy * px).abs() / length } else { (px * px + py * py).sqrt() }
        };
        let farthest = (from + 1..to).map(|index| (index, off(points[index]))).max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((index, distance)) = farthest
            && distance > NEAR
        {
            keep[index] = true;
            open.extend([(from, index), (index, to)]);
        }
    }
    let pieces = points.iter().zip(keep).skip(1).filter(|(_, keep)| *keep).map(|(p, _)| Piece::Line { to: *p });
    Subpath { start: *first, pieces: pieces.collect(), closed: false }
}

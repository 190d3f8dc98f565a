//! The contour of a torus: where lines of sight touch it.
//!
//! In the torus's coordinates, with its circle of radius R in z = 0, a point of it is R (cos φ, sin φ, 0) + r N with the normal
//! N = (cos φ cos ψ, sin φ cos ψ, sin ψ). Seen from (e, h) it is on the contour where N · (e − h P) = 0, which is
//! A cos ψ + B sin ψ = C with A = eₓ cos φ + e_y sin φ − h R, B = e_z, C = h r. So each φ with A² + B² ≥ C² has two points,
//! (cos ψ, sin ψ) = (A C ∓ B √D, B C ± A √D) / (A² + B²), D = A² + B² − C².
//! Where D is positive all around these are two closed curves. Otherwise D is (A − K) (A + K) with K = √(C² − B²), and each
//! interval of φ with D ≥ 0 carries one closed curve: there φ is its middle plus half its length times cos τ, and the sign of
//! sin τ tells the point.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

use snell_math::{Homogeneous3, Point3, Transform, Vector3, portable};

use super::curve::Curve;

/// Eyes nearer to the axis, or directions nearer to the plane of the circle, are on it: relative to all lengths.
const EXACT: f64 = 1e-14;
/// How many parts of φ or τ the search for a good parameter begins with.
const FIRST_PARTS: u32 = 32;
/// Each part's chord is nearer than this to the curve, relative to both radii, and turns from its neighbour by less than the
/// angle of this cosine.
const SAG: f64 = 4e-3;
const TURN: f64 = 0.85;
/// The most parts, and the most halvings of one of the first.
const MAX_PARTS: usize = 2048;
const MAX_HALVINGS: u32 = 44;

/// One closed curve of the contour of a torus, or a part of it; exact at every parameter.
///
/// The curve may turn sharply where a torus is seen nearly edge on. Its parameter is made so that one unit of it is a piece
/// that is nearly straight.
#[derive(Clone, Debug, PartialEq)]
pub struct TorusContour {
    line: Line,
    /// φ or τ where each unit of the parameter begins, and at the end.
    nodes: Arc<[f64]>,
    start: f64,
    end: f64,
    space_from_torus: Transform,
}

/// What is seen from where, and how the points are numbered.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Line {
    major: f64,
    minor: f64,
    eye: Vector3,
    h: f64,
    sweep: Sweep,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Sweep {
    /// φ all around, always with the same sign of the root.
    Turn { sign: f64 },
    /// φ = middle + half cos τ.
    Interval { middle: f64, half: f64 },
}

impl Line {
    fn point(&self, s: f64) -> Vector3 {
        let (b, c) = (self.eye.z(), self.h * self.minor);
        let rest = (c - b) * (c + b);
        let (angle, sweep_root) = match self.sweep {
            Sweep::Turn { .. } => (s, None),
            Sweep::Interval { middle, half } => {
                // D without cancelling: cos x − cos half = 2 sin ((half + x)/2) sin ((half − x)/2), x = half cos τ; with the
                // sign of sin τ, and 0 at both ends, so that the curve closes.
                let (cos, sin) = (portable::cos(0.5 * s), portable::sin(0.5 * s));
                let axial = (self.eye.x() * self.eye.x() + self.eye.y() * self.eye.y()).sqrt();
                let beyond = 2.0 * axial * portable::sin(half * cos * cos) * portable::sin(half * sin * sin);
                let square = beyond.max(0.0) * (beyond.max(0.0) + 2.0 * rest.max(0.0).sqrt());
                (middle + half * (cos - sin) * (cos + sin), Some(square.sqrt().copysign(sin)))
            }
        };
        let (cos, sin) = (portable::cos(angle), portable::sin(angle));
        let a = self.eye.x() * cos + self.eye.y() * sin - self.h * self.major;
        let root = match (sweep_root, self.sweep) {
            (None, Sweep::Turn { sign }) => {
                // (a − k) (a + k) cancels less where the root is 0.
                let square = if rest > 0.0 { (a - rest.sqrt()) * (a + rest.sqrt()) } else { a * a - rest };
                sign * square.max(0.0).sqrt()
            }
            (root, _) => root.unwrap_or(0.0),
        };
        // Brought to unit length: where the root was cut off at 0 it is not quite.
        let (x, z) = (a * c - b * root, b * c + a * root);
        let length = (x * x + z * z).sqrt();
        let (x, z) = if length > 0.0 { (x / length, z / length) } else { (1.0, 0.0) };
        let axial = self.major + self.minor * x;
        Vector3::new(axial * cos, axial * sin, self.minor * z)
    }

    /// The parameters between which it is nearly straight.
    fn nodes(&self) -> Arc<[f64]> {
        let size = self.major + self.minor;
        let step = TAU / f64::from(FIRST_PARTS);
        let mut nodes = vec![-PI];
        // Parts still to be done, the next one on top.
        let mut open: Vec<(f64, f64, u32)> = Vec::new();
        for first in (0..FIRST_PARTS).rev() {
            open.push((f64::from(first) * step - PI, f64::from(first + 1) * step - PI, 0));
        }
        while let Some((low, high, halvings)) = open.pop() {
            let middle = 0.5 * (low + high);
            let [a, b, c] = [low, middle, high].map(|s| self.point(s));
            let (first, second) = (b - a, c - b);
            let sag = (first - second).length() * 0.5;
            let (p, q) = (first.length(), second.length());
            // A part so short that it cannot be seen may turn as it likes.
            let is_short = p + q < 1e-6 * size;
            let is_straight = sag < SAG * size && first.dot(second) > TURN * p * q;
            let is_enough = halvings == MAX_HALVINGS || nodes.len() + open.len() > MAX_PARTS;
            if is_short || is_straight || is_enough {
                nodes.push(high);
            } else {
                open.push((middle, high, halvings + 1));
                open.push((low, middle, halvings + 1));
            }
        }
        nodes.into()
    }
}

impl TorusContour {
    fn new(line: Line) -> Self {
        let nodes = line.nodes();
        let end = (nodes.len() - 1) as f64;
        Self { line, nodes, start: 0.0, end, space_from_torus: Transform::IDENTITY }
    }

    pub(super) fn domain(&self) -> [f64; 2] {
        [self.start, self.end]
    }

    /// A full turn of the parameter.
    pub(super) fn period(&self) -> f64 {
        (self.nodes.len() - 1) as f64
    }

    pub(super) fn is_closed(&self) -> bool {
        self.end - self.start >= self.period() * (1.0 - 1e-12)
    }

    pub(super) fn is_finite(&self) -> bool {
        let [a, b] = [self.start, self.end].map(|t| self.point(t));
        a.is_finite() && b.is_finite() && self.space_from_torus.affine().is_finite()
    }

    /// In the caller's space.
    pub(super) fn point(&self, t: f64) -> Point3 {
        let period = self.period();
        let within = if (0.0..=period).contains(&t) { t } else { t - (t / period).floor() * period };
        let first = (within.max(0.0) as usize).min(self.nodes.len() - 2);
        let (low, high) = (self.nodes[first], self.nodes[first + 1]);
        let local = self.line.point(low + (high - low) * (within - first as f64));
        self.space_from_torus.point(Point3::ORIGIN + local)
    }

    pub(super) fn transformed(&self, map: &Transform) -> Self {
        Self { space_from_torus: *map * self.space_from_torus, ..self.clone() }
    }

    /// The part between two parameters, `start` below `end`.
    pub(super) fn part(&self, start: f64, end: f64) -> Self {
        Self { start, end, ..self.clone() }
    }
}

/// The contour in the torus's coordinates, seen from `eye`, with h of 1 or 0.
pub(super) fn contour(major: f64, minor: f64, eye: Homogeneous3) -> Vec<Curve> {
    let (v, h) = (eye.vector(), eye.h());
    let axial = (v.x() * v.x() + v.y() * v.y()).sqrt();
    let circle = |radius: f64, z: f64| {
        Curve::ellipse(Point3::new(0.0, 0.0, z), Vector3::new(radius, 0.0, 0.0), Vector3::new(0.0, radius, 0.0))
    };
    if axial <= EXACT * (v.z().abs() + h * major) {
        // From the axis everything is round.
        let line =
            |sign: f64| Line { major, minor, eye: Vector3::new(0.0, 0.0, v.z()), h, sweep: Sweep::Turn { sign } };
        let square = h * (major * major - minor * minor) + v.z() * v.z();
        if square <= 0.0 {
            return Vec::new();
        }
        let points = [line(1.0), line(-1.0)].map(|line| line.point(0.0));
        return points.into_iter().filter(|p| p.x() > EXACT * (major + minor)).map(|p| circle(p.x(), p.z())).collect();
    }
    let azimuth = portable::atan2(v.y(), v.x());
    if h == 0.0 && v.z().abs() <= EXACT * axial {
        // Edge on: the uppermost and the lowest circle, and the two that the tube is cut in across the view.
        let across = |angle: f64| {
            let out = Vector3::new(portable::cos(angle), portable::sin(angle), 0.0);
            Curve::ellipse(Point3::ORIGIN + out * major, out * minor, Vector3::new(0.0, 0.0, minor))
        };
        return vec![
            circle(major, minor),
            circle(major, -minor),
            across(azimuth + FRAC_PI_2),
            across(azimuth - FRAC_PI_2),
        ];
    }
    let with = |sweep| Curve::Torus(TorusContour::new(Line { major, minor, eye: v, h, sweep }));
    let both = || vec![with(Sweep::Turn { sign: 1.0 }), with(Sweep::Turn { sign: -1.0 })];
    let rest = (h * minor - v.z()) * (h * minor + v.z());
    if rest <= 0.0 {
        return both();
    }
    let root = rest.sqrt();
    // D ≥ 0 where cos (φ − azimuth) is above the first or below the second.
    let (above, below) = ((major + root) / axial, (major - root) / axial);
    if below >= 1.0 {
        return both();
    }
    let mut curves = Vec::new();
    if above < 1.0 {
        curves.push(with(Sweep::Interval { middle: azimuth, half: portable::acos(above) }));
    }
    if below > -1.0 {
        curves.push(with(Sweep::Interval { middle: azimuth + PI, half: portable::acos(-below) }));
    }
    curves
}

//! A curve while it is being cut: where it meets surfaces, and which of the pieces between are kept.
//!
//! Along a segment or a conic a plane's equation is a polynomial of degree 1 in the parameter or in its sine and cosine, and that
//! of a sphere, cylinder or cone one of degree 2. With the tangent of half the angle the latter become polynomials too, so these
//! meetings are all found; those with other curves and surfaces are looked for between samples.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use snell_math::{Homogeneous3, Point3, Ray, Vector3, portable, roots};

use super::curve::Curve;
use super::patch::{Limits, Patch, Surface};
use crate::shape::{Shape, Torus};

/// Pieces shorter than this, relative to the domain, are none.
const SHORTEST: f64 = 1e-10;
/// Samples for each part of a curve where meetings are looked for.
const SAMPLES_PER_PART: usize = 4;

/// A curve, and the surfaces that the true curve lies on where it is a polyline.
#[derive(Clone, Debug)]
pub(super) struct Strand {
    pub(super) curve: Curve,
    pub(super) onto: Option<Box<[Patch; 2]>>,
}

/// A place on a strand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) point: Point3,
    /// The unit direction the strand runs in.
    pub(super) direction: Vector3,
}

impl From<Curve> for Strand {
    fn from(curve: Curve) -> Self {
        Self { curve, onto: None }
    }
}

impl Strand {
    /// The point of the true curve; `None` at infinity.
    pub(super) fn point(&self, t: f64) -> Option<Point3> {
        let point = self.curve.point(t);
        let point = if point.h() > 0.0 { point.homogenize().ok()? } else { return None };
        match (&self.onto, &self.curve) {
            (Some(onto), Curve::Polyline(points)) if t.fract() != 0.0 && points.len() > 1 => {
                let first = (t.max(0.0) as usize).min(points.len() - 2);
                Some(project(onto, point, points[first + 1] - points[first]).unwrap_or(point))
            }
            _ => Some(point),
        }
    }

    /// A place in an interval, not exactly its middle: what is special likes to be there.
    pub(super) fn place(&self, low: f64, high: f64, fraction: f64) -> Option<Place> {
        let t = low + (high - low) * fraction;
        let step = (high - low) * 1e-4;
        let [before, after] = [t - step, t + step].map(|t| self.curve.point(t).homogenize().ok());
        Some(Place { point: self.point(t)?, direction: (after? - before?).try_normalize()? })
    }

    /// Appends the parameters where it meets a piece of surface, roughly within its limits, and perhaps some more.
    pub(super) fn meetings(&self, patch: &Patch, out: &mut Vec<f64>) {
        let begin = out.len();
        self.surface_meetings(patch, out);
        let bounds = patch.local_bounds();
        let margin = if bounds.is_finite() { 1e-6 * bounds.diagonal().length() } else { 0.0 };
        let bounds = bounds.grown(margin);
        let mut kept = begin;
        for i in begin..out.len() {
            let near = self.point(out[i]).is_none_or(|p| bounds.contains(Point3::ORIGIN + patch.local(p)));
            if near {
                out[kept] = out[i];
                kept += 1;
            }
        }
        out.truncate(kept);
    }

    fn surface_meetings(&self, patch: &Patch, out: &mut Vec<f64>) {
        let form = match patch.surface {
            Surface::Plane => Form::Plane(Homogeneous3::new(0.0, 0.0, 1.0, 0.0)),
            Surface::Sphere { radius } => Form::Sphere { radius },
            Surface::Side { thin, slope } => Form::Side { thin, slope },
            Surface::Torus { major, minor } => {
                return match self.curve.transformed(&patch.space_from_patch.inverse()) {
                    Curve::Segment { a, b } => segment_with_torus(a, b, major, minor, out),
                    _ => self.sampled_meetings(|p| patch.height(p), out),
                };
            }
        };
        self.form_meetings(patch, form, out);
    }

    /// Appends the parameters where it meets the borders of a piece of surface.
    pub(super) fn border_meetings(&self, patch: &Patch, out: &mut Vec<f64>) {
        let plane = |x: f64, y: f64, z: f64, h: f64| Form::Plane(Homogeneous3::new(x, y, z, h));
        let round = |radius: f64| Form::Side { thin: radius, slope: 0.0 };
        let forms: Vec<Form> = match patch.limits {
            Limits::None => Vec::new(),
            Limits::Rectangle { width, height } => vec![
                plane(1.0, 0.0, 0.0, 0.0),
                plane(1.0, 0.0, 0.0, -width),
                plane(0.0, 1.0, 0.0, 0.0),
                plane(0.0, 1.0, 0.0, -height),
            ],
            Limits::Ring { inner, outer } => vec![round(inner), round(outer)],
            Limits::Length(length) => vec![plane(0.0, 0.0, 1.0, 0.0), plane(0.0, 0.0, 1.0, -length)],
        };
        for form in forms {
            self.form_meetings(patch, form, out);
        }
    }

    fn form_meetings(&self, patch: &Patch, form: Form, out: &mut Vec<f64>) {
        match self.curve {
            Curve::Segment { .. } | Curve::Conic { .. } => {}
            _ => {
                return self
                    .sampled_meetings(|p| form.square(Homogeneous3::from(Point3::ORIGIN + patch.local(p))), out);
            }
        }
        match self.curve.transformed(&patch.space_from_patch.inverse()) {
            Curve::Segment { a, b } => {
                if let Form::Plane(_) = form {
                    let (from, to) = (form.linear(a), form.linear(b));
                    out.extend(roots::in_interval(&[from, to - from], 0.0, 1.0));
                } else {
                    let (aa, ab, bb) = (form.product(a, a), form.product(a, b), form.product(b, b));
                    out.extend(roots::in_interval(&[aa, 2.0 * (ab - aa), aa - 2.0 * ab + bb], 0.0, 1.0));
                }
            }
            Curve::Conic { center, cos, sin, start, end } => {
                let coefficients = if let Form::Plane(_) = form {
                    [form.linear(center), form.linear(cos), form.linear(sin), 0.0, 0.0, 0.0]
                } else {
                    [
                        form.product(center, center),
                        2.0 * form.product(center, cos),
                        2.0 * form.product(center, sin),
                        form.product(cos, cos),
                        2.0 * form.product(cos, sin),
                        form.product(sin, sin),
                    ]
                };
                angles(&coefficients, start, end, out);
            }
            _ => {}
        }
    }

    /// Where a function of the points changes its sign; also twice between samples, where it comes close to 0.
    fn sampled_meetings(&self, function: impl Fn(Point3) -> f64, out: &mut Vec<f64>) {
        let [start, end] = self.curve.domain();
        let per_part = if self.onto.is_some() { 1 } else { SAMPLES_PER_PART };
        let count = (self.curve.parts() * per_part).max(8);
        let at = |t: f64| self.point(t).map_or(f64::NAN, &function);
        let parameter = |i: usize| if i == count { end } else { start + (end - start) * (i as f64 / count as f64) };
        let values: Vec<f64> = (0..=count).map(|i| at(parameter(i))).collect();
        for i in 0..count {
            let (low, high) = (parameter(i), parameter(i + 1));
            if (values[i] > 0.0) != (values[i + 1] > 0.0) {
                out.push(bisect(at, low, high, values[i] > 0.0));
            }
            // A dip between samples of one sign: the function's least distance from 0 is looked for.
            if i > 0 {
                let [a, b, c] = [values[i - 1], values[i], values[i + 1]];
                let dips = (a > 0.0) == (b > 0.0) && (b > 0.0) == (c > 0.0) && b.abs() <= a.abs().min(c.abs());
                if dips && b.abs() < 2.0 * (a - b).abs().max((c - b).abs()) {
                    let (first, last) = (parameter(i - 1), high);
                    let bottom = least(|t| if b > 0.0 { at(t) } else { -at(t) }, first, last);
                    if (at(bottom) > 0.0) != (b > 0.0) {
                        out.push(bisect(at, first, bottom, b > 0.0));
                        out.push(bisect(at, bottom, last, b <= 0.0));
                    }
                }
            }
        }
    }

    /// The pieces between cuts that `keep` has a label for, joined where neighbours have the same one.
    pub(super) fn pieces<L: PartialEq + Copy>(
        &self,
        mut cuts: Vec<f64>,
        keep: impl Fn(Place) -> Option<L>,
    ) -> Vec<(Self, L)> {
        let [start, end] = self.curve.domain();
        let shortest = SHORTEST * (end - start);
        cuts.retain(|&t| t > start + shortest && t < end - shortest);
        cuts.push(end);
        cuts.sort_by(f64::total_cmp);
        let mut kept: Vec<(f64, f64, L)> = Vec::new();
        let mut low = start;
        for high in cuts {
            if high - low <= shortest {
                continue;
            }
            if let Some(label) = self.place(low, high, 0.487).and_then(&keep) {
                match kept.last_mut() {
                    Some(last) if last.1 == low && last.2 == label => last.1 = high,
                    _ => kept.push((low, high, label)),
                }
            }
            low = high;
        }
        if let [first, .., last] = kept[..]
            && self.curve.is_closed()
            && first.0 == start
            && last.1 >= end - shortest
            && first.2 == last.2
        {
            kept[0] = (last.0, first.1 + (end - start), first.2);
            kept.pop();
        }
        kept.into_iter().map(|(low, high, label)| (self.part(low, high), label)).collect()
    }

    /// Between two parameters; beyond the domain's end a closed curve goes on from its beginning.
    fn part(&self, low: f64, high: f64) -> Self {
        let [start, end] = self.curve.domain();
        if low == start && high == end {
            return self.clone();
        }
        let curve = match &self.curve {
            Curve::Segment { .. } => {
                let at = |t: f64| {
                    let p = self.curve.point(t);
                    p.homogenize().map_or(p, Homogeneous3::from)
                };
                Curve::Segment { a: at(low), b: at(high) }
            }
            &Curve::Conic { center, cos, sin, .. } => Curve::Conic { center, cos, sin, start: low, end: high },
            Curve::Torus(contour) => Curve::Torus(contour.part(low, high)),
            Curve::Polyline(points) => {
                let period = points.len().saturating_sub(1).max(1);
                let at = |t: f64| self.point(if t > end { t - end } else { t });
                let inner = (low.floor() as usize + 1)..(high.ceil() as usize);
                let inner = inner.map(|i| points[if i > period { i - period } else { i }]);
                Curve::Polyline(at(low).into_iter().chain(inner).chain(at(high)).collect())
            }
        };
        Self { curve, onto: self.onto.clone() }
    }
}

/// A surface as an equation in homogeneous coordinates.
#[derive(Clone, Copy, Debug)]
enum Form {
    /// The product with these coefficients is 0.
    Plane(Homogeneous3),
    Sphere {
        radius: f64,
    },
    Side {
        thin: f64,
        slope: f64,
    },
}

impl Form {
    /// The linear form of a plane.
    fn linear(&self, p: Homogeneous3) -> f64 {
        match self {
            Self::Plane(plane) => plane.0.dot(p.0),
            _ => 0.0,
        }
    }

    /// The symmetric form whose value for a point with itself is 0 on the surface.
    fn product(&self, p: Homogeneous3, q: Homogeneous3) -> f64 {
        let across = p.x() * q.x() + p.y() * q.y();
        match *self {
            Self::Plane(_) => self.linear(p) * self.linear(q),
            Self::Sphere { radius } => across + p.z() * q.z() - (radius * p.h()) * (radius * q.h()),
            Self::Side { thin, slope } => {
                let reach = |p: Homogeneous3| thin * p.h() + slope * p.z();
                across - reach(p) * reach(q)
            }
        }
    }

    /// What changes its sign at the surface.
    fn square(&self, p: Homogeneous3) -> f64 {
        if let Self::Plane(_) = self { self.linear(p) } else { self.product(p, p) }
    }
}

/// Appends the angles in [start, end] at which k₀ + k₁ c + k₂ s + k₃ c² + k₄ c s + k₅ s² changes its sign, c and s the cosine and
/// the sine: times (1 + t²)², t the tangent of half the angle, it is a quartic, taken on both half circles for |t| ≤ 1.
fn angles(k: &[f64; 6], start: f64, end: f64, out: &mut Vec<f64>) {
    for (middle, sign) in [(0.0, 1.0), (PI, -1.0)] {
        let [k0, k1, k2, k3, k4, k5] = [k[0], sign * k[1], sign * k[2], k[3], k[4], k[5]];
        let quartic = [k0 + k1 + k3, 2.0 * (k2 + k4), 2.0 * (k0 - k3) + 4.0 * k5, 2.0 * (k2 - k4), k0 - k1 + k3];
        for t in roots::in_interval(&quartic, -1.0, 1.0) {
            let angle = middle + 2.0 * portable::atan(t);
            // Into the arc, also where that begins after more than a turn.
            let angle = angle + ((start - angle) / TAU).ceil() * TAU;
            if angle <= end {
                out.push(angle);
            }
        }
        // A root on the border of both half circles is on neither side of it by rounding; a cut too many does no harm.
        let border = middle + FRAC_PI_2;
        let border = border + ((start - border) / TAU).ceil() * TAU;
        if border <= end {
            out.push(border);
        }
    }
}

/// Appends where a segment passes through a torus, both in its coordinates.
fn segment_with_torus(a: Homogeneous3, b: Homogeneous3, major: f64, minor: f64, out: &mut Vec<f64>) {
    let torus = Shape::Torus(Torus::new(Point3::ORIGIN, Vector3::Z, major, minor));
    let mut crossings = Vec::new();
    let mut along = |from: Point3, direction: Vector3| {
        torus.crossings(&Ray::new(from, direction), &mut crossings);
        crossings.iter().map(|crossing| crossing.t).filter(|&t| t >= 0.0).collect::<Vec<_>>()
    };
    match (a.homogenize(), b.homogenize()) {
        // Of end points of any h: a + t (b − a) is at s = t b.h / (a.h + t (b.h − a.h)) of the way.
        (Ok(from), Ok(to)) => {
            let ts = along(from, to - from).into_iter().filter(|&s| s <= 1.0);
            out.extend(ts.map(|s| s * a.h() / (b.h() + s * (a.h() - b.h()))));
        }
        (Ok(from), Err(_)) => {
            out.extend(along(from, b.vector()).into_iter().map(|s| s * a.h() / (1.0 + s * a.h())));
        }
        (Err(_), Ok(to)) => {
            out.extend(along(to, a.vector()).into_iter().map(|s| 1.0 / (1.0 + s * b.h())));
        }
        (Err(_), Err(_)) => {}
    }
}

/// The place between `low` and `high`, where the sign differs, to the last bit.
fn bisect(function: impl Fn(f64) -> f64, low: f64, high: f64, low_positive: bool) -> f64 {
    let (mut low, mut high) = (low, high);
    for _ in 0..64 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if (function(middle) > 0.0) == low_positive {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Where a function that falls and rises is least, by the golden section; ends early where it is below 0.
fn least(function: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut low, mut high) = (low, high);
    let (mut a, mut b) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut fa, mut fb) = (function(a), function(b));
    for _ in 0..50 {
        if fa <= 0.0 {
            return a;
        }
        if fb <= 0.0 {
            return b;
        }
        if fa < fb {
            (high, b, fb) = (b, a, fa);
            a = high - GOLDEN * (high - low);
            fa = function(a);
        } else {
            (low, a, fa) = (a, b, fb);
            b = low + GOLDEN * (high - low);
            fb = function(b);
        }
    }
    if fa < fb { a } else { b }
}

/// The point on both surfaces in the plane through `from` across `direction`, by Newton's method from there.
pub(super) fn project(onto: &[Patch; 2], from: Point3, direction: Vector3) -> Option<Point3> {
    let direction = direction.try_normalize()?;
    let mut p = from;
    let mut last_step = f64::INFINITY;
    for _ in 0..12 {
        let [(f, u), (g, v)] = onto.each_ref().map(|patch| patch.height_and_gradient(p));
        // Rows u, v, direction; the third keeps the point in the plane.
        let (vd, du, uv) = (v.cross(direction), direction.cross(u), u.cross(v));
        let determinant = u.dot(vd);
        let along = (p - from).dot(direction);
        let step = (vd * f + du * g + uv * along) * (1.0 / determinant);
        if !step.is_finite() || determinant.abs() < 1e-9 * u.length() * v.length() {
            return None;
        }
        p = p - step;
        let length = step.length();
        if length <= 4.0 * f64::EPSILON * p.max_abs() || length >= last_step {
            break;
        }
        last_step = length;
    }
    p.is_finite().then_some(p)
}

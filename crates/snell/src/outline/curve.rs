//! Curves in space: segments, conics, contours of tori, and polylines for what has no simpler form.
//!
//! Points are homogeneous, so that lines may end at infinity and conics may be hyperbolas. Every curve runs over an interval
//! of a parameter, and keeps it when it is carried by an affine map.

use std::f64::consts::{FRAC_PI_4, TAU};

use snell_math::{Homogeneous3, Point3, Transform, portable};

use super::torus::TorusContour;

/// A curve in space. Its points are homogeneous, so that the ends of lines may be at infinity; h is nowhere negative.
///
/// ```
/// use snell::math::{Homogeneous3, Point3, Vector3};
/// use snell::outline::Curve;
/// // From the origin along +x without end.
/// let ray = Curve::Segment { a: Point3::ORIGIN.into(), b: Homogeneous3::direction(Vector3::X) };
/// assert_eq!(ray.point(0.5).homogenize(), Ok(Point3::new(1.0, 0.0, 0.0)));
/// assert_eq!(ray.point(1.0).h(), 0.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// `a + t (b − a)`, t in [0, 1].
    Segment {
        /// Where it begins: a point, or a direction.
        a: Homogeneous3,
        /// Where it ends.
        b: Homogeneous3,
    },
    /// `center + cos θ cos + sin θ sin`, θ in [start, end], in homogeneous coordinates: the arc of an ellipse where h of `cos`
    /// and `sin` is 0, of any conic otherwise. A plane's horizon has a centre of zeros, and is directions only.
    Conic {
        /// What stays.
        center: Homogeneous3,
        /// What goes with the cosine.
        cos: Homogeneous3,
        /// What goes with the sine.
        sin: Homogeneous3,
        /// Where it begins, in radians.
        start: f64,
        /// Where it ends: above `start`, by a full turn at most.
        end: f64,
    },
    /// The contour of a torus, or a part of it.
    Torus(TorusContour),
    /// Straight from point to point, two at least. Each point lies on the true curve, and no chord is farther from it than the
    /// tolerance that was asked for.
    Polyline(Vec<Point3>),
}

impl Curve {
    /// A straight line between points.
    pub(super) fn line(a: Point3, b: Point3) -> Self {
        Self::Segment { a: a.into(), b: b.into() }
    }

    /// A whole ellipse.
    pub(super) fn ellipse(center: Point3, cos: snell_math::Vector3, sin: snell_math::Vector3) -> Self {
        Self::Conic {
            center: center.into(),
            cos: Homogeneous3::direction(cos),
            sin: Homogeneous3::direction(sin),
            start: 0.0,
            end: TAU,
        }
    }

    /// The interval of its parameter: [0, 1] for a segment, [start, end] for a conic, one unit for each chord of a polyline.
    pub fn domain(&self) -> [f64; 2] {
        match self {
            Self::Segment { .. } => [0.0, 1.0],
            Self::Conic { start, end, .. } => [*start, *end],
            Self::Torus(contour) => contour.domain(),
            Self::Polyline(points) => [0.0, points.len().saturating_sub(1) as f64],
        }
    }

    /// The point at a parameter.
    pub fn point(&self, t: f64) -> Homogeneous3 {
        match self {
            // At the end it is `b` itself.
            Self::Segment { a, b } => Homogeneous3(a.0 * (1.0 - t) + b.0 * t),
            Self::Conic { center, cos, sin, .. } => {
                Homogeneous3(center.0 + cos.0 * portable::cos(t) + sin.0 * portable::sin(t))
            }
            Self::Torus(contour) => contour.point(t).into(),
            Self::Polyline(points) => {
                let Some(last) = points.len().checked_sub(1) else { return Homogeneous3::new(0.0, 0.0, 0.0, 0.0) };
                let first = (t.max(0.0) as usize).min(last.saturating_sub(1));
                let (from, to) = (points[first], points[(first + 1).min(last)]);
                from.lerp(to, t - first as f64).into()
            }
        }
    }

    /// True where it ends where it begins.
    pub fn is_closed(&self) -> bool {
        match self {
            Self::Segment { .. } => false,
            Self::Conic { start, end, .. } => end - start >= TAU * (1.0 - 1e-12),
            Self::Torus(contour) => contour.is_closed(),
            Self::Polyline(points) => points.len() > 3 && points.first() == points.last(),
        }
    }

    /// Into how many equal parts of its domain it can be cut so that each is smooth and turns by about an eighth of a turn at
    /// most, seen in its own plane or by the shape it lies on: where to begin sampling.
    pub fn parts(&self) -> usize {
        let [start, end] = self.domain();
        let parts = match self {
            Self::Segment { .. } => 1.0,
            Self::Conic { .. } => ((end - start) / FRAC_PI_4 - 1e-9).ceil(),
            Self::Torus(_) | Self::Polyline(_) => (end - start).ceil(),
        };
        // The numbers are small; a cast of NaN would be 0.
        (parts as usize).max(1)
    }

    /// The curve that an affine map makes of it; parameters keep their meaning.
    #[must_use]
    pub fn transformed(&self, map: &Transform) -> Self {
        let carried = |p: &Homogeneous3| {
            let affine = map.affine();
            let v = affine.matrix3 * p.0.truncate() + affine.translation * p.0.w;
            Homogeneous3(v.extend(p.0.w))
        };
        match self {
            Self::Segment { a, b } => Self::Segment { a: carried(a), b: carried(b) },
            Self::Conic { center, cos, sin, start, end } => {
                Self::Conic { center: carried(center), cos: carried(cos), sin: carried(sin), start: *start, end: *end }
            }
            Self::Torus(contour) => Self::Torus(contour.transformed(map)),
            Self::Polyline(points) => Self::Polyline(points.iter().map(|&p| map.point(p)).collect()),
        }
    }

    /// Carried by a map, where there is one.
    pub(super) fn carried(self, map: Option<&Transform>) -> Self {
        map.map_or_else(|| self.clone(), |map| self.transformed(map))
    }

    /// False where a number in it is NaN or infinite.
    pub(super) fn is_finite(&self) -> bool {
        match self {
            Self::Segment { a, b } => a.0.is_finite() && b.0.is_finite(),
            Self::Conic { center, cos, sin, start, end } => {
                [center, cos, sin].iter().all(|p| p.0.is_finite()) && start.is_finite() && end.is_finite()
            }
            Self::Torus(contour) => contour.is_finite(),
            Self::Polyline(points) => points.len() > 1 && points.iter().all(|p| p.is_finite()),
        }
    }
}

//! The torus.
//!
//! In own coordinates the circle lies in z = 0. The quartic of Hanrahan (in Glassner (ed.), An Introduction to Ray Tracing,
//! 1989, section 3.4) is used only for what it is good at: the zeros of its derivative, which after moving the ray's
//! origin to the point closest to the centre is the depressed cubic s³ + p s + q, split the line into pieces with one
//! root at most. In each piece the root is found on g = (ρ − R)² + z² − r², ρ the distance from the axis, which has the
//! sign of the quartic and does not cancel where the tube is thin.

use snell_math::{Bounds3, Normal3, Point3, Ray, Transform, Vector3, roots};

use super::frame::{Frame, turn};
use super::rounding::gamma;
use super::{Crossing, ShapeHit, SurfacePoint};

/// How far outside the torus the search begins and ends, relative to its size: there g is positive beyond doubt.
const MARGIN: f64 = 1.0 / 1024.0;

/// All points within the minor radius of a circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    frame: Frame,
    major: f64,
    minor: f64,
}

/// A line with its origin moved to the point closest to the torus's centre, in its coordinates, of unit direction.
struct Line {
    origin: Vector3,
    direction: Vector3,
    /// The length of the ray's direction, and the moved origin's own parameter, in units of length.
    length: f64,
    shift: f64,
}

impl Line {
    #[inline]
    fn t(&self, s: f64) -> f64 {
        (self.shift + s) / self.length
    }

    #[inline]
    fn s(&self, t: f64) -> f64 {
        t * self.length - self.shift
    }
}

impl Torus {
    /// From its circle, and the radius of the tube around it.
    pub fn new(center: Point3, axis: Vector3, major_radius: f64, minor_radius: f64) -> Self {
        Self { frame: Frame::around(center, axis), major: major_radius, minor: minor_radius }
    }

    /// Its frame, and the major and the minor radius.
    pub(crate) fn frame_and_radii(&self) -> (Frame, f64, f64) {
        (self.frame, self.major, self.minor)
    }

    /// The ray's line, and the part of it where the torus can be: within a sphere around it and between two planes.
    #[inline]
    fn clip(&self, ray: &Ray) -> Option<(Line, f64, f64)> {
        let (o, d) = self.frame.ray(ray);
        let length = d.length();
        let direction = d * (1.0 / length);
        // Twice, for origins so far away that one projection leaves an error.
        let first = -o.dot(direction);
        let near = o + direction * first;
        let second = -near.dot(direction);
        let origin = near + direction * second;
        let reach = (self.major + self.minor) * (1.0 + MARGIN);
        let squared = reach * reach - origin.length_squared();
        // Negated, so that NaN from a broken ray ends here too.
        if !(squared > 0.0 && length > 0.0) {
            return None;
        }
        let half = squared.sqrt();
        let (mut low, mut high) = (-half, half);
        let height = self.minor * (1.0 + MARGIN);
        if direction.z() != 0.0 {
            let (a, b) = ((-height - origin.z()) / direction.z(), (height - origin.z()) / direction.z());
            low = low.max(a.min(b));
            high = high.min(a.max(b));
        } else if origin.z().abs() > height {
            return None;
        }
        (low < high).then_some((Line { origin, direction, length, shift: first + second }, low, high))
    }

    /// Where the line passes through the surface between `low` and `high`, in increasing order.
    #[inline]
    fn parameters(&self, line: &Line, low: f64, high: f64) -> impl Iterator<Item = f64> {
        let (o, d) = (line.origin, line.direction);
        let (major, minor) = (self.major, self.minor);
        // A quarter of the quartic's derivative.
        let across = d.x() * d.x() + d.y() * d.y();
        let linear = o.length_squared() + major * major - minor * minor - 2.0 * major * major * across;
        let constant = -2.0 * major * major * (o.x() * d.x() + o.y() * d.y());
        let critical = roots::in_interval(&[constant, linear, 0.0, 1.0], low, high);
        roots::sign_changes(low, critical, high, move |s| {
            let (x, y, z) = (o.x() + s * d.x(), o.y() + s * d.y(), o.z() + s * d.z());
            let axial = (x * x + y * y).sqrt();
            let from_circle = axial - major;
            let value = from_circle * from_circle + z * z - minor * minor;
            let slope = 2.0 * (from_circle * (x * d.x() + y * d.y()) / axial + z * d.z());
            (value, slope)
        })
    }

    /// See [`super::Shape::intersect`]. The search begins at `t_min` itself, so that a ray which starts outside by more
    /// than rounding is known to start outside.
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        let (line, low, high) = self.clip(ray)?;
        let (low, high) = (low.max(line.s(t_min)), high.min(line.s(t_max)));
        if low.is_nan() || high.is_nan() || low >= high {
            return None;
        }
        let hits = self.parameters(&line, low, high).map(|s| line.t(s));
        hits.filter(|&t| t > t_min && t < t_max).map(|t| ShapeHit { t, part: 0 }).next()
    }

    pub(super) fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        if let Some((line, low, high)) = self.clip(ray) {
            let mut entering = false;
            out.extend(self.parameters(&line, low, high).map(|s| {
                entering = !entering;
                Crossing { t: line.t(s), entering, part: 0 }
            }));
        }
    }

    /// The point is brought back along the tube's radius, which is the normal.
    #[inline]
    pub(super) fn surface_geometry(&self, ray: &Ray, hit: ShapeHit) -> SurfacePoint {
        let p = self.frame.ray_point(ray, hit.t);
        let axial = (p.x() * p.x() + p.y() * p.y()).sqrt();
        let (x, y) = if axial > 0.0 { (p.x() / axial, p.y() / axial) } else { (1.0, 0.0) };
        let radial = Vector3::new(axial - self.major, 0.0, p.z()).try_normalize().unwrap_or(Vector3::Z);
        let normal = Vector3::new(x * radial.x(), y * radial.x(), radial.z());
        let local = Vector3::new(x * self.major, y * self.major, 0.0) + normal * self.minor;
        let error = gamma(64) * (self.frame.origin.max_abs() + self.major + self.minor);
        SurfacePoint::flat(self.frame.point_out(local), Normal3::from(self.frame.vector_out(normal)), error)
    }

    pub(super) fn uv(&self, p: Point3) -> [f64; 2] {
        let local = self.frame.point(p);
        let axial = (local.x() * local.x() + local.y() * local.y()).sqrt();
        [turn(local.x(), local.y()), turn(axial - self.major, local.z())]
    }

    pub(super) fn contains(&self, p: Point3) -> bool {
        let local = self.frame.point(p);
        let from_circle = (local.x() * local.x() + local.y() * local.y()).sqrt() - self.major;
        from_circle * from_circle + local.z() * local.z() < self.minor * self.minor
    }

    pub(super) fn bounds(&self) -> Bounds3 {
        let reach = self.frame.circle_extent() * self.major;
        Bounds3::new(self.frame.origin - reach, self.frame.origin + reach).grown(self.minor)
    }

    pub(super) fn transformed(&self, map: &Transform) -> Option<Self> {
        let scale = map.uniform_scale()?;
        let frame = self.frame.transformed(map);
        Some(Self { frame, major: self.major * scale, minor: self.minor * scale })
    }
}

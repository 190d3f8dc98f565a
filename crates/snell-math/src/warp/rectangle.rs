//! The places of a rectangle as they are seen from a point: uniform in solid angle.
//!
//! Follows: Ureña, Fajardo and King, "An Area-Preserving Parametrization for Spherical Rectangles", Computer Graphics Forum
//! 32(4) (EGSR), 2013. The rectangle is z = z₀ < 0, [x₀, x₁] × [y₀, y₁] in a frame about the point; the solid angle is the
//! excess of the four angles of the spherical quadrangle, and the first number cuts it by a meridian.

use std::f64::consts::PI;

use crate::{Point3, Vector3, portable};

/// Below this solid angle (steradians) the excess of angles has lost its digits: the places are then taken uniform in area.
const SMALLEST: f64 = 1e-4;

/// A rectangle seen from a point.
///
/// ```
/// use snell_math::{Point3, Vector3, warp::SphericalRectangle};
/// // One face of a cube, from its middle.
/// let face = SphericalRectangle::new(
///     Point3::ORIGIN,
///     Point3::new(-1.0, -1.0, 1.0),
///     Vector3::new(2.0, 0.0, 0.0),
///     Vector3::new(0.0, 2.0, 0.0),
/// )
/// .unwrap();
/// assert!((face.solid_angle() - 4.0 * std::f64::consts::PI / 6.0).abs() < 1e-12);
/// let place = face.sample([0.5, 0.5]);
/// assert!((place - Point3::new(0.0, 0.0, 1.0)).length() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphericalRectangle {
    from: Point3,
    /// The local axes; z leads from the rectangle to the point.
    axes: [Vector3; 3],
    x: [f64; 2],
    y: [f64; 2],
    z: f64,
    /// The cosines of the first two edges' normals with z.
    b: [f64; 2],
    /// 2π less the angles of the second half.
    k: f64,
    solid_angle: f64,
    is_small: bool,
}

impl SphericalRectangle {
    /// The rectangle with these perpendicular edges from a corner, seen from a point; `None` where it has no area or is seen
    /// edge-on, that is, under no solid angle.
    #[must_use]
    pub fn new(from: Point3, corner: Point3, edge_x: Vector3, edge_y: Vector3) -> Option<Self> {
        let axis_x = edge_x.try_normalize()?;
        let axis_y = edge_y.try_normalize()?;
        let towards = corner - from;
        let mut axis_z = axis_x.cross(axis_y).try_normalize()?;
        let mut z = towards.dot(axis_z);
        if z > 0.0 {
            (axis_z, z) = (-axis_z, -z);
        }
        let x = [towards.dot(axis_x), towards.dot(axis_x) + edge_x.length()];
        let y = [towards.dot(axis_y), towards.dot(axis_y) + edge_y.length()];
        // The normals of the planes through the point and an edge; only their components along z are needed.
        let along_z = |side: f64| -side / (side * side + z * z).sqrt();
        let n = [along_z(y[0]), -along_z(x[1]), -along_z(y[1]), along_z(x[0])];
        let angle = |a: f64, b: f64| portable::acos((-a * b).clamp(-1.0, 1.0));
        let angles = [angle(n[0], n[1]), angle(n[1], n[2]), angle(n[2], n[3]), angle(n[3], n[0])];
        let k = 2.0 * PI - angles[2] - angles[3];
        let excess = angles[0] + angles[1] - k;
        let middle = Vector3::new(0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]), z);
        let squared = middle.length_squared();
        // The solid angle of a small piece: area times cosine over the square of the distance.
        let small = edge_x.length() * edge_y.length() * -z / (squared * squared.sqrt());
        let is_small = small.min(excess) < SMALLEST;
        let solid_angle = if is_small { small } else { excess };
        (z < 0.0 && solid_angle > 0.0 && solid_angle.is_finite()).then_some(Self {
            from,
            axes: [axis_x, axis_y, axis_z],
            x,
            y,
            z,
            b: [n[0], n[2]],
            k,
            solid_angle,
            is_small,
        })
    }

    /// Its solid angle in steradians.
    #[inline]
    #[must_use]
    pub fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// The density of [`Self::sample`] per steradian, at the place which it gave: one over the solid angle. A rectangle seen
    /// under less than 10⁻⁴ sr is sampled by area, whose density in solid angle differs from place to place.
    #[inline]
    #[must_use]
    pub fn density(&self, place: Point3) -> f64 {
        if self.is_small {
            let squared = (place - self.from).length_squared();
            let area = (self.x[1] - self.x[0]) * (self.y[1] - self.y[0]);
            squared * squared.sqrt() / (area * -self.z)
        } else {
            1.0 / self.solid_angle
        }
    }

    /// A place of the rectangle; each direction in which it is seen is as likely as the others.
    #[must_use]
    pub fn sample(&self, [u, v]: [f64; 2]) -> Point3 {
        let [x, y] = if self.is_small {
            [self.x[0] + u * (self.x[1] - self.x[0]), self.y[0] + v * (self.y[1] - self.y[0])]
        } else {
            self.local(u, v)
        };
        let [axis_x, axis_y, axis_z] = self.axes;
        self.from + (axis_x * x + axis_y * y + axis_z * self.z)
    }

    /// Where the two numbers lead in the rectangle's plane.
    fn local(&self, u: f64, v: f64) -> [f64; 2] {
        let [b0, b1] = self.b;
        // The meridian that leaves a share u of the solid angle on its left.
        let angle = u * self.solid_angle + self.k;
        let (sin, cos) = (portable::sin(angle), portable::cos(angle));
        let f = (cos * b0 - b1) / sin;
        let c = ((1.0 / (f * f + b0 * b0).sqrt()).copysign(f)).clamp(-1.0, 1.0);
        let x = (-c * self.z / (1.0 - c * c).max(1e-300).sqrt()).clamp(self.x[0], self.x[1]);
        // Along the meridian heights are uniform (Archimedes).
        let distance = (x * x + self.z * self.z).sqrt();
        let height = |y: f64| y / (distance * distance + y * y).sqrt();
        let h = height(self.y[0]) + v * (height(self.y[1]) - height(self.y[0]));
        let rest = 1.0 - h * h;
        let y = if rest > 1e-12 { h * distance / rest.sqrt() } else { self.y[1] };
        [x, y.clamp(self.y[0], self.y[1])]
    }
}

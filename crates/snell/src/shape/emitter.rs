//! Surfaces that give off light, as places that light can be sampled from: by the solid angle in which a point sees them,
//! and by area. World space; densities are per steradian, or per unit of area where their name says so.
//!
//! Rectangles are sampled by the solid angle that they are seen under (Ureña, Fajardo and King 2013), spheres by the cone around them,
//! disks and triangles by area. See [`snell_math::warp`].

use std::f64::consts::PI;

use snell_math::warp::{Cone, PiecewiseConstant, SphericalRectangle, triangle, uniform_disk, uniform_sphere};
use snell_math::{Point3, Vector3};

use super::{Disk, Rectangle, Shape, Sphere};

/// A surface that can be sampled.
#[derive(Clone, Debug)]
pub struct EmitterSurface {
    kind: Kind,
    area: f64,
    center: Point3,
    radius: f64,
}

#[derive(Clone, Debug)]
enum Kind {
    /// Perpendicular edges.
    Rectangle {
        corner: Point3,
        edges: [Vector3; 2],
        normal: Vector3,
    },
    Disk {
        center: Point3,
        axes: [Vector3; 2],
        normal: Vector3,
        radius: f64,
        inner_radius: f64,
    },
    Sphere(Sphere),
    Triangles {
        triangles: Vec<[Point3; 3]>,
        choice: PiecewiseConstant,
    },
}

/// A place of an [`EmitterSurface`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmitterPoint {
    /// The place.
    pub point: Point3,
    /// The outward normal there, unit length.
    pub normal: Vector3,
    /// The density with which it was chosen; which one, the function says that gives it.
    pub density: f64,
}

impl EmitterSurface {
    /// From a shape in world space; `None` for shapes that light is found on, but not sampled from.
    #[must_use]
    pub fn from_shape(shape: &Shape) -> Option<Self> {
        match shape {
            Shape::Sphere(sphere) => Some(Self {
                kind: Kind::Sphere(*sphere),
                area: 4.0 * PI * sphere.radius * sphere.radius,
                center: sphere.center,
                radius: sphere.radius,
            }),
            Shape::Rectangle(rectangle) => Self::from_rectangle(rectangle),
            Shape::Disk(disk) => Some(Self::from_disk(disk)),
            _ => None,
        }
    }

    fn from_rectangle(rectangle: &Rectangle) -> Option<Self> {
        let (corner, edges) = rectangle.corner_and_edges();
        let normal = rectangle.normal();
        let [x, y] = edges;
        let half = (x + y) * 0.5;
        let area = x.cross(y).length();
        let (center, radius) = (corner + half, half.length().max((x - y).length() * 0.5));
        // Rounding apart; others are two triangles.
        if x.dot(y).abs() > 1e-9 * area {
            let far = corner + x + y;
            return Self::from_triangles(vec![[corner, corner + x, far], [corner, far, corner + y]]);
        }
        (area > 0.0).then_some(Self { kind: Kind::Rectangle { corner, edges, normal }, area, center, radius })
    }

    fn from_disk(disk: &Disk) -> Self {
        let (frame, inner_radius, radius) = disk.frame_and_radii();
        let (center, normal, axes) = (frame.origin, frame.z, [frame.x, frame.y]);
        let area = PI * (radius - inner_radius) * (radius + inner_radius);
        Self { kind: Kind::Disk { center, axes, normal, radius, inner_radius }, area, center, radius }
    }

    /// From triangles; `None` where they have no area.
    #[must_use]
    pub fn from_triangles(triangles: Vec<[Point3; 3]>) -> Option<Self> {
        let areas: Vec<f64> = triangles.iter().map(|[a, b, c]| 0.5 * (*b - *a).cross(*c - *a).length()).collect();
        let area: f64 = areas.iter().sum();
        let choice = PiecewiseConstant::new(&areas)?;
        let (mut low, mut high) = (triangles.first()?[0], triangles.first()?[0]);
        for corner in triangles.iter().flatten() {
            low = Point3::new(low.x().min(corner.x()), low.y().min(corner.y()), low.z().min(corner.z()));
            high = Point3::new(high.x().max(corner.x()), high.y().max(corner.y()), high.z().max(corner.z()));
        }
        let center = low.lerp(high, 0.5);
        Some(Self { kind: Kind::Triangles { triangles, choice }, area, center, radius: center.distance(high) })
    }

    /// Its area, in square world units.
    #[inline]
    #[must_use]
    pub fn area(&self) -> f64 {
        self.area
    }

    /// A sphere around it: centre and radius.
    #[inline]
    #[must_use]
    pub fn bounding_sphere(&self) -> (Point3, f64) {
        (self.center, self.radius)
    }

    /// A place of it to be seen from a point, by two numbers in [0, 1), with its density per steradian there; `None` where it is
    /// not sampled from there: from inside a sphere, from within its own plane.
    #[must_use]
    pub fn sample_from(&self, from: Point3, [u, v]: [f64; 2]) -> Option<EmitterPoint> {
        match &self.kind {
            Kind::Rectangle { corner, edges: [x, y], normal } => {
                let seen = SphericalRectangle::new(from, *corner, *x, *y)?;
                let point = seen.sample([u, v]);
                Some(EmitterPoint { point, normal: *normal, density: seen.density(point) })
            }
            Kind::Sphere(sphere) => {
                let cone = Self::cone(sphere, from)?;
                let direction = cone.sample([u, v]);
                let towards = sphere.center - from;
                let middle = towards.dot(direction);
                // The first of the two places on the sphere; on its rim, rounding may leave none.
                let beside = towards - direction * middle;
                let half = (sphere.radius * sphere.radius - beside.length_squared()).max(0.0).sqrt();
                let point = from + direction * (middle - half);
                let normal = (point - sphere.center).try_normalize()?;
                Some(EmitterPoint { point, normal, density: cone.density(direction) })
            }
            _ => {
                let sampled = self.sample_area([u, v])?;
                let density = self.solid_angle_density(from, sampled.point, sampled.normal)?;
                Some(EmitterPoint { density, ..sampled })
            }
        }
    }

    /// The density per steradian with which [`Self::sample_from`] chooses a place of it from a point; `normal` is the one at the place.
    #[must_use]
    pub fn density_from(&self, from: Point3, place: Point3, normal: Vector3) -> f64 {
        match &self.kind {
            Kind::Rectangle { corner, edges: [x, y], .. } => {
                SphericalRectangle::new(from, *corner, *x, *y).map_or(0.0, |seen| seen.density(place))
            }
            Kind::Sphere(sphere) => {
                let Some(cone) = Self::cone(sphere, from) else { return 0.0 };
                1.0 / cone.solid_angle()
            }
            _ => self.solid_angle_density(from, place, normal).unwrap_or(0.0),
        }
    }

    /// A place of it, each piece of area as likely as another, by two numbers in [0, 1), with its density per unit of area.
    #[must_use]
    pub fn sample_area(&self, [u, v]: [f64; 2]) -> Option<EmitterPoint> {
        let density = 1.0 / self.area;
        Some(match &self.kind {
            Kind::Rectangle { corner, edges: [x, y], normal } => {
                EmitterPoint { point: *corner + *x * u + *y * v, normal: *normal, density }
            }
            Kind::Disk { center, axes: [x, y], normal, radius, inner_radius } => {
                let [a, b] = uniform_disk([u, v]);
                let squared = a * a + b * b;
                // A ring is the disk with its radii moved outward, so that areas stay in proportion.
                let (inner, outer) = (inner_radius * inner_radius, radius * radius);
                let factor = if squared > 0.0 { ((inner + (outer - inner) * squared) / squared).sqrt() } else { 0.0 };
                EmitterPoint { point: *center + *x * (a * factor) + *y * (b * factor), normal: *normal, density }
            }
            Kind::Sphere(sphere) => {
                let normal = uniform_sphere([u, v]);
                EmitterPoint { point: sphere.center + normal * sphere.radius, normal, density }
            }
            Kind::Triangles { triangles, choice } => {
                let piece = choice.sample(u);
                let [a, b, c] = triangles[piece.index];
                let [first, second] = triangle([piece.within, v]);
                let point = a + (b - a) * first + (c - a) * second;
                EmitterPoint { point, normal: (b - a).cross(c - a).try_normalize()?, density }
            }
        })
    }

    /// The density of [`Self::sample_area`] as seen from a point: per steradian.
    fn solid_angle_density(&self, from: Point3, place: Point3, normal: Vector3) -> Option<f64> {
        let towards = place - from;
        let squared = towards.length_squared();
        let density = squared * squared.sqrt() / (self.area * towards.dot(normal).abs());
        density.is_finite().then_some(density)
    }

    /// The cone that a sphere is seen in from outside.
    fn cone(sphere: &Sphere, from: Point3) -> Option<Cone> {
        let outside = (sphere.center - from).length_squared() > sphere.radius * sphere.radius;
        if outside { Cone::around_sphere(from, sphere.center, sphere.radius) } else { None }
    }
}

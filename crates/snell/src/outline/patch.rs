//! The pieces that the surfaces of shapes are made of: parts of planes, spheres, sides of cylinders and cones, tori.
//!
//! Each is given in coordinates of its own, in which its equation is shortest, and by the affine map from there. In these a
//! plane is z = 0, a sphere is centred at the origin with its poles on z, and a side and a torus have z for their axis. Every
//! question about a piece is asked in them: affine maps keep straight lines, conics and what touches what.

use snell_math::{Bounds3, Normal3, Point3, Transform, Vector3};

use crate::shape::frame::Frame;
use crate::shape::{Cuboid, Disk, Frustum, Plane, Rectangle, Shape, Sphere, Torus};

/// A surface without end, in its own coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Surface {
    /// z = 0, outward +z.
    Plane,
    /// Around the origin.
    Sphere { radius: f64 },
    /// At a distance thin + slope z from the z axis.
    Side { thin: f64, slope: f64 },
    /// Around the circle of the major radius in z = 0.
    Torus { major: f64, minor: f64 },
}

/// Which part of a surface there is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Limits {
    /// All of it.
    None,
    /// Of a plane: 0 ≤ x ≤ width, 0 ≤ y ≤ height.
    Rectangle { width: f64, height: f64 },
    /// Of a plane: between two distances from the origin.
    Ring { inner: f64, outer: f64 },
    /// Of a side: 0 ≤ z ≤ length.
    Length(f64),
}

/// A piece of surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Patch {
    pub(super) surface: Surface,
    pub(super) limits: Limits,
    pub(super) space_from_patch: Transform,
}

impl Patch {
    fn new(surface: Surface, limits: Limits, frame: &Frame) -> Option<Self> {
        let space_from_patch = Transform::from_columns(frame.x, frame.y, frame.z, frame.origin)?;
        Some(Self { surface, limits, space_from_patch })
    }

    /// Carried to another space.
    pub(super) fn carried(&self, map: Option<&Transform>) -> Self {
        map.map_or(*self, |&map| Self { space_from_patch: map * self.space_from_patch, ..*self })
    }

    /// A point of space in the patch's coordinates.
    pub(super) fn local(&self, point: Point3) -> Vector3 {
        self.space_from_patch.inverse_point(point).to_vector()
    }

    /// The outward unit normal at a point of the surface, or near it.
    pub(super) fn normal(&self, point: Point3) -> Option<Vector3> {
        let local = self.surface.normal(self.local(point));
        self.space_from_patch.normal(Normal3::from(local)).as_vector().try_normalize()
    }

    /// The distance from the surface without its limits, positive outside: in the patch's units of length.
    pub(super) fn height(&self, point: Point3) -> f64 {
        self.surface.height(self.local(point))
    }

    /// As [`Patch::height`], with its gradient in space.
    pub(super) fn height_and_gradient(&self, point: Point3) -> (f64, Vector3) {
        let local = self.local(point);
        let normal = Normal3::from(self.surface.normal(local));
        (self.surface.height(local), self.space_from_patch.normal(normal).as_vector())
    }

    /// How far within its limits a point of the surface is, relative to its size; negative outside.
    pub(super) fn margin(&self, point: Point3) -> f64 {
        let p = self.local(point);
        match self.limits {
            Limits::None => f64::INFINITY,
            Limits::Rectangle { width, height } => {
                p.x().min(width - p.x()).min(p.y()).min(height - p.y()) / (width + height)
            }
            Limits::Ring { inner, outer } => {
                let distance = (p.x() * p.x() + p.y() * p.y()).sqrt();
                let within = if inner > 0.0 { distance - inner } else { f64::INFINITY };
                within.min(outer - distance) / outer
            }
            Limits::Length(length) => p.z().min(length - p.z()) / length,
        }
    }

    /// A box around it in its own coordinates.
    pub(super) fn local_bounds(&self) -> Bounds3 {
        let around =
            |x: f64, y: f64, low: f64, high: f64| Bounds3::new(Point3::new(-x, -y, low), Point3::new(x, y, high));
        match (self.surface, self.limits) {
            (Surface::Plane, Limits::Rectangle { width, height }) => {
                Bounds3::new(Point3::ORIGIN, Point3::new(width, height, 0.0))
            }
            (Surface::Plane, Limits::Ring { outer, .. }) => around(outer, outer, 0.0, 0.0),
            (Surface::Sphere { radius }, _) => around(radius, radius, -radius, radius),
            (Surface::Side { thin, slope }, Limits::Length(length)) => {
                let radius = thin + slope * length;
                around(radius, radius, 0.0, length)
            }
            (Surface::Torus { major, minor }, _) => around(major + minor, major + minor, -minor, minor),
            _ => Bounds3::EVERYTHING,
        }
    }

    /// A box around it in space.
    pub(super) fn bounds(&self) -> Bounds3 {
        let local = self.local_bounds();
        if local.is_finite() { self.space_from_patch.bounds(&local) } else { Bounds3::EVERYTHING }
    }

    /// Its size in space: half the diagonal of a box around it; 0 for what is infinite.
    pub(super) fn size(&self) -> f64 {
        let bounds = self.bounds();
        if bounds.is_finite() { 0.5 * bounds.diagonal().length() } else { 0.0 }
    }
}

impl Surface {
    /// The distance, exact or from below, positive outside.
    pub(super) fn height(&self, p: Vector3) -> f64 {
        let axial = (p.x() * p.x() + p.y() * p.y()).sqrt();
        match *self {
            Self::Plane => p.z(),
            Self::Sphere { radius } => p.length() - radius,
            Self::Side { thin, slope } => (axial - (thin + slope * p.z())) / (1.0 + slope * slope).sqrt(),
            Self::Torus { major, minor } => {
                let from_circle = axial - major;
                (from_circle * from_circle + p.z() * p.z()).sqrt() - minor
            }
        }
    }

    /// The gradient of the height: the outward unit normal at points of the surface.
    pub(super) fn normal(&self, p: Vector3) -> Vector3 {
        let axial = (p.x() * p.x() + p.y() * p.y()).sqrt();
        // On the axis any direction is as good.
        let (x, y) = if axial > 0.0 { (p.x() / axial, p.y() / axial) } else { (1.0, 0.0) };
        match *self {
            Self::Plane => Vector3::Z,
            Self::Sphere { .. } => p.try_normalize().unwrap_or(Vector3::Z),
            Self::Side { slope, .. } => Vector3::new(x, y, -slope) * (1.0 / (1.0 + slope * slope).sqrt()),
            Self::Torus { major, .. } => {
                let radial = Vector3::new(axial - major, 0.0, p.z()).try_normalize().unwrap_or(Vector3::Z);
                Vector3::new(x * radial.x(), y * radial.x(), radial.z())
            }
        }
    }
}

/// The pieces of a shape's surface, in its own space. A shape whose numbers are broken has none.
pub(super) fn patches(shape: &Shape) -> Vec<Patch> {
    let patches: Vec<Option<Patch>> = match shape {
        Shape::Sphere(sphere) => vec![of_sphere(sphere)],
        Shape::Plane(plane) => vec![of_plane(plane)],
        Shape::Disk(disk) => vec![of_disk(disk)],
        Shape::Rectangle(rectangle) => vec![of_rectangle(rectangle)],
        Shape::Box(cuboid) => of_box(cuboid),
        Shape::Cylinder(frustum) | Shape::Cone(frustum) => of_frustum(frustum),
        Shape::Torus(torus) => vec![of_torus(torus)],
    };
    patches.into_iter().flatten().collect()
}

/// The poles are where the shape's own v is 0 and 1.
fn of_sphere(sphere: &Sphere) -> Option<Patch> {
    let frame = Frame { origin: sphere.center, x: Vector3::X, y: -Vector3::Z, z: Vector3::Y };
    Patch::new(Surface::Sphere { radius: sphere.radius }, Limits::None, &frame)
}

fn of_plane(plane: &Plane) -> Option<Patch> {
    let (point, normal) = plane.point_and_normal();
    Patch::new(Surface::Plane, Limits::None, &Frame::around(point, normal))
}

fn of_disk(disk: &Disk) -> Option<Patch> {
    let (frame, inner, outer) = disk.frame_and_radii();
    Patch::new(Surface::Plane, Limits::Ring { inner, outer }, &frame)
}

fn of_rectangle(rectangle: &Rectangle) -> Option<Patch> {
    let (corner, [along, up]) = rectangle.corner_and_edges();
    flat_rectangle(corner, along, up, rectangle.normal())
}

/// With perpendicular edges.
fn flat_rectangle(corner: Point3, along: Vector3, up: Vector3, normal: Vector3) -> Option<Patch> {
    let frame = Frame { origin: corner, x: along.try_normalize()?, y: up.try_normalize()?, z: normal };
    Patch::new(Surface::Plane, Limits::Rectangle { width: along.length(), height: up.length() }, &frame)
}

fn of_box(cuboid: &Cuboid) -> Vec<Option<Patch>> {
    let (min, max) = cuboid.corners();
    let axes = [Vector3::X, Vector3::Y, Vector3::Z];
    let faces = (0..3).flat_map(|axis| [(axis, false), (axis, true)]);
    let face = |(axis, is_high): (usize, bool)| {
        let edge = |other: usize| axes[other] * (max[other] - min[other]);
        let (along, up) = (edge((axis + 1) % 3), edge((axis + 2) % 3));
        let mut corner = min;
        let normal = if is_high {
            corner.0[axis] = max[axis];
            axes[axis]
        } else {
            -axes[axis]
        };
        flat_rectangle(corner, along, up, normal)
    };
    faces.map(face).collect()
}

fn of_frustum(frustum: &Frustum) -> Vec<Option<Patch>> {
    let ((frame, length), (thin, slope)) = (frustum.frame_and_length(), frustum.radius_and_slope());
    let mut all = vec![Patch::new(Surface::Side { thin, slope }, Limits::Length(length), &frame)];
    if frustum.is_capped() {
        let cap = |outer: f64, frame: Frame| Patch::new(Surface::Plane, Limits::Ring { inner: 0.0, outer }, &frame);
        if thin > 0.0 {
            all.push(cap(thin, Frame { z: -frame.z, ..frame }));
        }
        all.push(cap(thin + slope * length, Frame { origin: frame.origin + frame.z * length, ..frame }));
    }
    all
}

fn of_torus(torus: &Torus) -> Option<Patch> {
    let (frame, major, minor) = torus.frame_and_radii();
    Patch::new(Surface::Torus { major, minor }, Limits::None, &frame)
}

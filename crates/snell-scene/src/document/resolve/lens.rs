//! A lens by the numbers that opticians give, as a solid of spheres, planes and a cylinder.
//!
//! The axis is z here and light travels to +z. The first surface meets the axis at −thickness/2, the second at +thickness/2.
//! A surface of radius R through the axis at z₀ has its centre at z₀ + R, and at distance r from the axis it lies at
//! z₀ + sag(r), sag(r) = R − sign(R) √(R² − r²) (Hecht, Optics, section 5.2, with the signs of the lensmaker's equation).

use snell_math::{Point3, Vector3};

use super::Resolver;
use crate::document::model::{self, Located};
use crate::scene::{CsgOperation, Object, ObjectKind, Shape};

impl Resolver<'_> {
    pub(super) fn lens(&mut self, located: &Located<model::Lens>) -> ObjectKind {
        let lens = &located.value;
        let axis = self.direction(&lens.axis, "the lens's axis", Vector3::Z);
        let (thickness, diameter) = (lens.thickness.value, lens.diameter.value);
        let mut fits = true;
        for (key, radius) in [("radius1", &lens.radius1), ("radius2", &lens.radius2)] {
            let Some(radius) = radius else { continue };
            let size = radius.value.abs();
            if size < 0.5 * diameter {
                let message = format!("the lens's diameter {diameter} does not fit its `{key}` of {}", radius.value);
                let label = format!("a surface of this radius is at most {} wide", 2.0 * size);
                self.error(&radius.span, message, label);
                fits = false;
            }
        }
        let radius = |radius: &Option<Located<f64>>| radius.as_ref().map(|radius| radius.value);
        let profile = Profile { radii: [radius(&lens.radius1), radius(&lens.radius2)], thickness, rim: 0.5 * diameter };
        if fits {
            let edge = profile.thickness_at(profile.rim);
            // Sharp edges come out as some rounding error around 0.
            if edge < -1e-12 * (thickness + diameter) {
                let message = format!(
                    "the lens's surfaces cross before its rim: at diameter {diameter} its edge would be {edge:.6} thick"
                );
                let label = format!("must be at least {:.6} for this diameter", thickness - edge);
                self.error(&lens.thickness.span, message, label);
                fits = false;
            }
        }
        if fits {
            profile.solid(axis)
        } else {
            ObjectKind::Shape(Shape::Sphere { center: Point3::ORIGIN, radius: 1.0 })
        }
    }
}

/// The cross-section of a lens.
struct Profile {
    /// The signed radii of curvature; flat where there is none.
    radii: [Option<f64>; 2],
    /// On the axis.
    thickness: f64,
    /// The radius of the rim, at most either radius.
    rim: f64,
}

impl Profile {
    /// How far a surface lies along the axis at a distance from it, from where it meets it.
    fn sag(&self, surface: usize, distance: f64) -> f64 {
        match self.radii[surface] {
            None => 0.0,
            Some(radius) => {
                // R − sign(R) √(R² − r²) without cancellation.
                let root = ((radius.abs() - distance) * (radius.abs() + distance)).max(0.0).sqrt();
                distance * distance / (radius.abs() + root) * radius.signum()
            }
        }
    }

    fn thickness_at(&self, distance: f64) -> f64 {
        self.thickness + self.sag(1, distance) - self.sag(0, distance)
    }

    /// The solid. Where the cylinder of the rim ends beyond a curved surface, its ends must lie outside the lens but inside
    /// the sphere that is taken away: the plane through that sphere's centre does, for it lies beyond the rim.
    fn solid(&self, axis: Vector3) -> ObjectKind {
        let half = 0.5 * self.thickness;
        let at = |z: f64| Point3::ORIGIN + axis * z;
        let mut inside = Vec::new();
        let mut outside = Vec::new();
        let mut ends = [-half, half];
        for surface in 0..2 {
            // Along the way out of the lens through this surface.
            let out = if surface == 0 { -1.0 } else { 1.0 };
            let vertex = out * half;
            let Some(radius) = self.radii[surface] else { continue };
            let center = vertex + radius;
            let sphere = Shape::Sphere { center: at(center), radius: radius.abs() };
            if radius * out < 0.0 {
                // Convex. The cylinder ends somewhere beyond the vertex.
                ends[surface] = vertex + out * (half + self.rim);
                let other = 1 - surface;
                let far =
                    -out * half + if self.sag(other, self.rim) * out < 0.0 { self.sag(other, self.rim) } else { 0.0 };
                let other_center = self.radii[other].map(|other_radius| -out * half + other_radius);
                if self.radii[other] == Some(-radius) && other_center == Some(center) {
                    // A ball: both surfaces are of the same sphere.
                    if surface == 0 {
                        inside.push(Object::shape(sphere));
                    }
                } else if (far - center) * out >= 0.0 {
                    inside.push(Object::shape(sphere));
                } else {
                    // The lens goes beyond the middle of this sphere, where the cylinder alone bounds it.
                    let beyond = Shape::Plane { point: at(center), normal: axis * out };
                    let parts = vec![Object::shape(sphere), Object::shape(beyond)];
                    let kind = ObjectKind::Csg { operation: CsgOperation::Union, parts };
                    inside.push(part(kind));
                }
            } else {
                ends[surface] = center;
                outside.push(Object::shape(sphere));
            }
        }
        let cylinder = Shape::Cylinder { base: at(ends[0]), top: at(ends[1]), radius: self.rim, capped: true };
        inside.insert(0, Object::shape(cylinder.clone()));
        let body = if inside.len() == 1 {
            ObjectKind::Shape(cylinder)
        } else {
            ObjectKind::Csg { operation: CsgOperation::Intersection, parts: inside }
        };
        if outside.is_empty() {
            return body;
        }
        let mut parts = vec![part(body)];
        parts.extend(outside);
        ObjectKind::Csg { operation: CsgOperation::Difference, parts }
    }
}

/// An unnamed part in place.
fn part(kind: ObjectKind) -> Object {
    Object { name: None, material: None, parent_from_object: snell_math::Transform::IDENTITY, kind, span: None }
}

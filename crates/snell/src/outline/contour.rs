//! Contours: where lines of sight touch a surface, N · (e − h p) = 0 for the eye (e, h) and a point p with normal N.
//!
//! What touches what is kept by affine maps, so contours are found in a piece's own coordinates, with the eye carried there,
//! and carried out again.

use snell_math::{Homogeneous3, Point3, Transform, Vector3};

use super::curve::Curve;
use super::patch::{Limits, Patch, Surface};
use super::torus;

/// What is nearer than this to touching, relative to the sizes involved, has no contour worth the name.
const TOUCH: f64 = 1e-12;

/// The point or direction with h of 1 or 0; `None` where it is neither.
pub(super) fn standard(eye: Homogeneous3) -> Option<Homogeneous3> {
    let eye = if eye.h() == 0.0 { Homogeneous3::direction(eye.vector()) } else { Homogeneous3(eye.0 / eye.h()) };
    (eye.0.is_finite() && (eye.h() != 0.0 || eye.vector() != Vector3::ZERO)).then_some(eye)
}

/// The eye in the space that `map` comes from.
fn carried_back(eye: Homogeneous3, map: &Transform) -> Option<Homogeneous3> {
    standard(if eye.h() == 0.0 {
        Homogeneous3::direction(map.inverse_vector(eye.vector()))
    } else {
        map.inverse_point(Point3::ORIGIN + eye.vector()).into()
    })
}

/// The contours of a piece of surface, in space, seen from `eye` as [`standard`] gives it.
pub(super) fn contours(patch: &Patch, eye: Homogeneous3) -> Vec<Curve> {
    let Some(eye) = carried_back(eye, &patch.space_from_patch) else { return Vec::new() };
    let local = match (patch.surface, patch.limits) {
        (Surface::Plane, _) => Vec::new(),
        (Surface::Sphere { radius }, _) => sphere(radius, eye).into_iter().collect(),
        (Surface::Side { thin, slope }, Limits::Length(length)) => side(thin, slope, length, eye),
        (Surface::Side { .. }, _) => Vec::new(),
        (Surface::Torus { major, minor }, _) => torus::contour(major, minor, eye),
    };
    local.iter().map(|curve| curve.transformed(&patch.space_from_patch)).filter(Curve::is_finite).collect()
}

/// The circle in the eye's polar plane.
fn sphere(radius: f64, eye: Homogeneous3) -> Option<Curve> {
    let towards = eye.vector().try_normalize()?;
    // The cosine of the angle between the direction to the eye and the normals of the circle.
    let cosine = if eye.h() == 0.0 { 0.0 } else { radius / eye.vector().length() };
    let square = (1.0 - cosine) * (1.0 + cosine);
    if square.is_nan() || square <= TOUCH {
        return None;
    }
    let (x, y) = towards.orthonormal_basis();
    let r = radius * square.sqrt();
    Some(Curve::ellipse(Point3::ORIGIN + towards * (radius * cosine), x * r, y * r))
}

/// The two rulings whose normals (cos φ, sin φ, −slope) have eₓ cos φ + e_y sin φ = slope e_z + h thin.
fn side(thin: f64, slope: f64, length: f64, eye: Homogeneous3) -> Vec<Curve> {
    let across = Vector3::new(eye.x(), eye.y(), 0.0);
    let Some(towards) = across.try_normalize() else { return Vec::new() };
    let cosine = (slope * eye.z() + eye.h() * thin) / across.length();
    let square = (1.0 - cosine) * (1.0 + cosine);
    if square.is_nan() || square <= TOUCH {
        return Vec::new();
    }
    let aside = Vector3::new(-towards.y(), towards.x(), 0.0) * square.sqrt();
    let ruling = |out: Vector3| {
        let at = |z: f64| Point3::ORIGIN + out * (thin + slope * z) + Vector3::Z * z;
        Curve::line(at(0.0), at(length))
    };
    vec![ruling(towards * cosine + aside), ruling(towards * cosine - aside)]
}

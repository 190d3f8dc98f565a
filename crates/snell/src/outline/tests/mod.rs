//! Random bodies and eyes, and distances to curves by brute force, for the tests of this folder.

mod contours;
mod degenerate;
mod meetings;
mod pictures;
mod solids;

use snell_math::{Homogeneous3, Point3, Transform, Vector3};

use super::patch::{Limits, Patch, Surface};
use super::{Body, Curve, Feature, Form, OutlineOptions, features};
use crate::shape::tests::{Random, fixture};
use crate::shape::{Frustum, Shape};

/// The kinds of [`fixture`] and an open cone.
const KINDS: u64 = 9;

fn random_shape(random: &mut Random, kind: u64, center: Point3) -> Shape {
    if kind < 8 {
        return fixture(random, kind, center, 1.0).shape;
    }
    let axis = random.direction();
    let (thin, thick) = (random.range(0.0, 0.5), random.range(0.5, 1.0));
    Shape::Cone(Frustum::new(center - axis * 0.7, thick, center + axis * 0.6, thin, false))
}

/// Turned, moved, and often stretched or mirrored.
fn random_placement(random: &mut Random) -> Transform {
    let stretch = Vector3::new(random.range(0.5, 1.5), -random.range(0.5, 1.5), random.range(0.5, 1.5));
    let factors = [Vector3::new(0.7, 0.7, 0.7), stretch][random.below(2) as usize];
    let turn = Transform::rotate(random.direction(), random.range(0.0, 6.0));
    Transform::translate(random.vector_in_ball(2.0)) * turn * Transform::scale(factors)
}

/// A point at some distance, or a direction.
fn random_eye(random: &mut Random) -> Homogeneous3 {
    let direction = random.direction();
    if random.below(3) == 0 {
        return Homogeneous3::direction(direction * random.range(0.1, 10.0));
    }
    let distance = [1.5, 6.0, 100.0][random.below(3) as usize];
    (Point3::ORIGIN + direction * distance + random.vector_in_ball(1.0)).into()
}

fn of_shape(shape: &Shape, map: Option<&Transform>, eye: Homogeneous3, parameter_lines: u32) -> Vec<Feature> {
    let body = Body { form: Form::Shape(shape), space_from_body: map };
    features(&body, eye, &OutlineOptions { parameter_lines, tolerance: &|_| 1e-3 })
}

/// Points along a curve, `per_part` for each of its parts; not those at infinity.
fn samples(curve: &Curve, per_part: usize) -> Vec<Point3> {
    let [start, end] = curve.domain();
    let count = curve.parts() * per_part;
    let at = |i: usize| curve.point(start + (end - start) * (i as f64 / count as f64));
    (0..=count).map(at).filter(|p| p.h() > 1e-6).filter_map(|p| p.homogenize().ok()).collect()
}

/// The distance of a point from the chords between points.
fn distance_to_chords(p: Point3, chords: &[Point3]) -> f64 {
    let to_chord = |pair: &[Point3]| {
        let (along, from) = (pair[1] - pair[0], p - pair[0]);
        let t = (from.dot(along) / along.length_squared().max(1e-300)).clamp(0.0, 1.0);
        (from - along * t).length()
    };
    chords.windows(2).map(to_chord).fold(f64::INFINITY, f64::min)
}

/// The point of a round piece of surface at (u, v) in [0, 1]², in the caller's space.
fn surface_point(patch: &Patch, u: f64, v: f64) -> Point3 {
    use snell_math::portable::{cos, sin};
    let angle = std::f64::consts::TAU * u;
    let out = Vector3::new(cos(angle), sin(angle), 0.0);
    let local = match (patch.surface, patch.limits) {
        (Surface::Sphere { radius }, _) => {
            let latitude = std::f64::consts::PI * (v - 0.5);
            (out * cos(latitude) + Vector3::Z * sin(latitude)) * radius
        }
        (Surface::Side { thin, slope }, Limits::Length(length)) => {
            let z = length * v;
            out * (thin + slope * z) + Vector3::Z * z
        }
        (Surface::Torus { major, minor }, _) => {
            let around = std::f64::consts::TAU * v;
            out * (major + minor * cos(around)) + Vector3::Z * (minor * sin(around))
        }
        _ => unreachable!("a flat piece"),
    };
    patch.space_from_patch.point(Point3::ORIGIN + local)
}

fn is_round(patch: &Patch) -> bool {
    patch.surface != Surface::Plane
}

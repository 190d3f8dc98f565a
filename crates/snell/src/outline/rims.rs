//! Rims, creases and the lines of constant u and v: all that does not depend on the eye, and a plane's horizon.

use std::f64::consts::{FRAC_PI_2, TAU};

use snell_math::{Homogeneous3, Point3, Vector3, portable};

use super::FeatureKind;
use super::curve::Curve;
use super::patch::{Limits, Patch, Surface, patches};
use crate::shape::Shape;

/// Edges, rims and boundaries of a shape, in its own space. The horizon of a plane is not among them.
pub(super) fn rims(shape: &Shape) -> Vec<(FeatureKind, Curve)> {
    match shape {
        Shape::Sphere(_) | Shape::Plane(_) | Shape::Torus(_) => Vec::new(),
        Shape::Disk(_) | Shape::Rectangle(_) => {
            let edges = patches(shape).iter().flat_map(outline).collect::<Vec<_>>();
            edges.into_iter().map(|curve| (FeatureKind::Boundary, curve)).collect()
        }
        Shape::Box(cuboid) => {
            let (min, max) = cuboid.corners();
            let corner = |bits: usize| {
                let pick = |axis: usize| if bits >> axis & 1 == 1 { max[axis] } else { min[axis] };
                Point3::new(pick(0), pick(1), pick(2))
            };
            // From each corner along each axis on which it is the lower one.
            let edges = (0..8_usize).flat_map(|bits| [1, 2, 4].map(|axis| (bits, axis)));
            let edges = edges.filter(|(bits, axis)| bits & axis == 0);
            edges.map(|(bits, axis)| (FeatureKind::Crease, Curve::line(corner(bits), corner(bits | axis)))).collect()
        }
        Shape::Cylinder(frustum) | Shape::Cone(frustum) => {
            let kind = if frustum.is_capped() { FeatureKind::Crease } else { FeatureKind::Boundary };
            let sides = patches(shape);
            sides.first().map(outline).unwrap_or_default().into_iter().map(|curve| (kind, curve)).collect()
        }
    }
}

/// Where a piece of surface ends, in space.
fn outline(patch: &Patch) -> Vec<Curve> {
    let circle = |radius: f64, z: f64| (radius > 0.0).then(|| circle(radius, z));
    let local = match (patch.surface, patch.limits) {
        (Surface::Plane, Limits::Rectangle { width, height }) => {
            let corners = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
            let corners = corners.map(|[x, y]| Point3::new(x, y, 0.0));
            (0..4).map(|i| Some(Curve::line(corners[i], corners[(i + 1) % 4]))).collect()
        }
        (Surface::Plane, Limits::Ring { inner, outer }) => vec![circle(inner, 0.0), circle(outer, 0.0)],
        (Surface::Side { thin, slope }, Limits::Length(length)) => {
            vec![circle(thin, 0.0), circle(thin + slope * length, length)]
        }
        _ => Vec::new(),
    };
    local.into_iter().flatten().map(|curve| curve.transformed(&patch.space_from_patch)).collect()
}

/// Around the z axis.
fn circle(radius: f64, z: f64) -> Curve {
    Curve::ellipse(Point3::new(0.0, 0.0, z), Vector3::X * radius, Vector3::Y * radius)
}

/// The directions of a plane without end, in space.
pub(super) fn horizon(patch: &Patch) -> Option<Curve> {
    let map = &patch.space_from_patch;
    let direction = |v: Vector3| Homogeneous3::direction(map.vector(v));
    (patch.surface == Surface::Plane && patch.limits == Limits::None).then(|| Curve::Conic {
        center: Homogeneous3::direction(Vector3::ZERO),
        cos: direction(Vector3::X),
        sin: direction(Vector3::Y),
        start: 0.0,
        end: TAU,
    })
}

/// So many lines of constant u and as many of constant v on a piece of surface, in space: on caps none.
pub(super) fn parameter_lines(patch: &Patch, count: u32, is_cap: bool) -> Vec<Curve> {
    // Where a coordinate runs around there is a line at 0; where it does not, the lines keep away from both ends.
    let around = || (0..count).map(|k| TAU * f64::from(k) / f64::from(count));
    let between = || (1..=count).map(|k| f64::from(k) / f64::from(count + 1));
    let at_angle = |angle: f64| Vector3::new(portable::cos(angle), portable::sin(angle), 0.0);
    let at = |v: Vector3| Point3::ORIGIN + v;
    let local: Vec<Curve> = match (patch.surface, patch.limits) {
        (Surface::Plane, Limits::Rectangle { width, height }) => {
            let up = between().map(|u| u * width).map(|x| (Vector3::X * x, Vector3::new(x, height, 0.0)));
            let along = between().map(|v| v * height).map(|y| (Vector3::Y * y, Vector3::new(width, y, 0.0)));
            up.chain(along).map(|(a, b)| Curve::line(at(a), at(b))).collect()
        }
        (Surface::Plane, Limits::Ring { inner, outer }) if !is_cap => {
            let out = around().map(|u| Curve::line(at(at_angle(u) * inner), at(at_angle(u) * outer)));
            out.chain(between().map(|v| circle(inner + (outer - inner) * v, 0.0))).collect()
        }
        (Surface::Plane, _) => Vec::new(),
        (Surface::Sphere { radius }, _) => {
            let meridian = |u: f64| Curve::Conic {
                center: Point3::ORIGIN.into(),
                cos: Homogeneous3::direction(at_angle(u) * radius),
                sin: Homogeneous3::direction(Vector3::Z * radius),
                start: -FRAC_PI_2,
                end: FRAC_PI_2,
            };
            let parallel = |v: f64| {
                let latitude = (v - 0.5) * std::f64::consts::PI;
                circle(radius * portable::cos(latitude), radius * portable::sin(latitude))
            };
            around().map(meridian).chain(between().map(parallel)).collect()
        }
        (Surface::Side { thin, slope }, limits) => {
            let Limits::Length(length) = limits else { return Vec::new() };
            let thick = thin + slope * length;
            let ruling = |u: f64| Curve::line(at(at_angle(u) * thin), at(at_angle(u) * thick + Vector3::Z * length));
            let rings = between().map(|v| circle(thin + slope * length * v, length * v));
            around().map(ruling).chain(rings).collect()
        }
        (Surface::Torus { major, minor }, _) => {
            let section = |u: f64| {
                let out = at_angle(u);
                Curve::ellipse(at(out * major), out * minor, Vector3::Z * minor)
            };
            let ring = |v: f64| circle(major + minor * portable::cos(v), minor * portable::sin(v));
            around().map(section).chain(around().map(ring)).collect()
        }
    };
    local.iter().map(|curve| curve.transformed(&patch.space_from_patch)).collect()
}

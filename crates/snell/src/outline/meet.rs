//! Where two pieces of surface meet: exactly where that is a line or a conic, and else by [`super::trace`].
//!
//! A plane cuts everything of degree 2 in conics, in any placement, since it stays a plane in the other's coordinates. Spheres,
//! and round surfaces around one axis, meet in circles, which their profiles tell: a profile is a circle or a line in the half
//! plane of distances from the axis and heights along it.

use snell_math::{Homogeneous3, Normal3, Point3, Transform, Vector3};

use super::curve::Curve;
use super::patch::{Limits, Patch, Surface};
use super::strand::Strand;
use super::trace;

/// What is nearer than this to touching or coinciding, relative to the sizes involved, does so.
const TOUCH: f64 = 1e-12;
/// Directions that differ by less are the same.
const PARALLEL: f64 = 1e-10;
/// A plane that runs through a cone's tip, or along a cylinder's axis, to this is taken to do so exactly: the general form would
/// lose as many digits.
const THROUGH: f64 = 1e-8;
/// What runs along a border, to this, is left to that.
const BORDER: f64 = 1e-9;

/// The curves in which two pieces of surface run through each other, within both. Where they only touch there is none, nor where
/// they coincide, nor along a border of either.
pub(super) fn meet(a: &Patch, b: &Patch, tolerance: &dyn Fn(Point3) -> f64) -> Vec<Strand> {
    if a.bounds().intersection(&b.bounds()).is_empty() {
        return Vec::new();
    }
    let whole: Vec<Strand> = match (a.surface, b.surface) {
        (Surface::Plane, Surface::Plane) => exact(planes(a, b)),
        (Surface::Plane, _) => plane_with_round(a, b).map_or_else(|| trace::trace(a, b, tolerance), exact),
        (_, Surface::Plane) => plane_with_round(b, a).map_or_else(|| trace::trace(a, b, tolerance), exact),
        _ => around_one_axis(a, b).map_or_else(|| trace::trace(a, b, tolerance), exact),
    };
    let mut within = Vec::new();
    for strand in whole {
        let mut cuts = Vec::new();
        strand.border_meetings(a, &mut cuts);
        strand.border_meetings(b, &mut cuts);
        let is_within = |point: Point3| [a, b].iter().all(|patch| patch.margin(point) > BORDER);
        let pieces = strand.pieces(cuts, |place| is_within(place.point).then_some(()));
        within.extend(pieces.into_iter().map(|(strand, ())| strand));
    }
    within
}

fn exact(curves: Vec<Curve>) -> Vec<Strand> {
    curves.into_iter().filter(Curve::is_finite).map(Strand::from).collect()
}

/// A plane in the coordinates of another patch: unit normal n and d, n · p = d.
fn plane_in(plane: &Patch, patch: &Patch) -> Option<(Vector3, f64)> {
    let origin = patch.local(plane.space_from_patch.point(Point3::ORIGIN));
    let normal = plane.space_from_patch.normal(Normal3::from(Vector3::Z)).as_vector();
    let normal = patch.space_from_patch.inverse().normal(Normal3::from(normal)).as_vector().try_normalize()?;
    Some((normal, normal.dot(origin)))
}

/// The straight line that two planes have in common: as much of it as the smaller one can reach, or two halves without end.
fn planes(a: &Patch, b: &Patch) -> Vec<Curve> {
    let in_space = |patch: &Patch| {
        let normal = patch.space_from_patch.normal(Normal3::from(Vector3::Z)).as_vector().try_normalize()?;
        Some((patch.space_from_patch.point(Point3::ORIGIN), normal))
    };
    let (Some((a_point, a_normal)), Some((b_point, b_normal))) = (in_space(a), in_space(b)) else { return Vec::new() };
    let across = a_normal.cross(b_normal);
    let square = across.length_squared();
    if square < PARALLEL * PARALLEL {
        return Vec::new();
    }
    let sizes = [a, b].map(Patch::size);
    let smaller = if sizes[0] > 0.0 && (sizes[0] <= sizes[1] || sizes[1] == 0.0) { a } else { b };
    let size = smaller.size();
    let center = if size > 0.0 { smaller.bounds().center() } else { a_point };
    // The point of both planes that is nearest to the centre.
    let (u, v) = ((a_point - center).dot(a_normal), (b_point - center).dot(b_normal));
    let offset = (b_normal.cross(across) * u + across.cross(a_normal) * v) * (1.0 / square);
    let direction = across * (1.0 / square.sqrt());
    let middle = center + offset;
    if size > 0.0 {
        let reach = direction * (1.01 * size);
        return if offset.length() > size { Vec::new() } else { vec![Curve::line(middle - reach, middle + reach)] };
    }
    let half = |direction| Curve::Segment { a: middle.into(), b: Homogeneous3::direction(direction) };
    vec![half(direction), half(-direction)]
}

/// The curves of a plane and a round surface, without limits but that of a side's length; `None` where they are no conics.
fn plane_with_round(plane: &Patch, round: &Patch) -> Option<Vec<Curve>> {
    let Some((normal, d)) = plane_in(plane, round) else { return Some(Vec::new()) };
    let local = match (round.surface, round.limits) {
        (Surface::Sphere { radius }, _) => plane_with_sphere(normal, d, radius),
        (Surface::Side { thin, slope }, Limits::Length(length)) => plane_with_side(normal, d, thin, slope, length),
        (Surface::Torus { major, minor }, _) => plane_with_torus(normal, d, major, minor)?,
        _ => Vec::new(),
    };
    Some(local.iter().map(|curve| curve.transformed(&round.space_from_patch)).collect())
}

fn plane_with_sphere(normal: Vector3, d: f64, radius: f64) -> Vec<Curve> {
    let square = (radius - d) * (radius + d);
    if square.is_nan() || square <= TOUCH * radius * radius {
        return Vec::new();
    }
    let (x, y) = normal.orthonormal_basis();
    vec![Curve::ellipse(Point3::ORIGIN + normal * d, x * square.sqrt(), y * square.sqrt())]
}

/// With φ around the axis, ν = nₓ cos φ + n_y sin φ and the radius R = thin + slope z, the plane is ν R + n_z z = d, so that
/// z = (d − thin ν) / (n_z + slope ν) and R = κ / (n_z + slope ν), κ = thin n_z + slope d: a conic in homogeneous coordinates. Where
/// κ is 0 the plane runs along the axis or through the tip, and cuts rulings.
fn plane_with_side(normal: Vector3, d: f64, thin: f64, slope: f64, length: f64) -> Vec<Curve> {
    let thick = thin + slope * length;
    let kappa = thin * normal.z() + slope * d;
    if kappa.abs() > THROUGH * thick {
        // The nappe with positive radius has positive h.
        let sign = 1.0_f64.copysign(kappa);
        let (nx, ny, nz, d, kappa) = (sign * normal.x(), sign * normal.y(), sign * normal.z(), sign * d, kappa.abs());
        let mut forms = [
            Homogeneous3::new(0.0, 0.0, d, nz),
            Homogeneous3::new(kappa, 0.0, -thin * nx, slope * nx),
            Homogeneous3::new(0.0, kappa, -thin * ny, slope * ny),
        ];
        if slope == 0.0 {
            // An ellipse, with h = 1.
            forms = forms.map(|p| Homogeneous3(p.0 / nz));
        }
        let [center, cos, sin] = forms;
        return vec![Curve::Conic { center, cos, sin, start: 0.0, end: std::f64::consts::TAU }];
    }
    let Some(towards) = Vector3::new(normal.x(), normal.y(), 0.0).try_normalize() else { return Vec::new() };
    let across = (normal.x() * normal.x() + normal.y() * normal.y()).sqrt();
    // Of ν thin = d and ν slope = −n_z the better one, or both.
    let weight = thin / length;
    let cosine = (weight * d / length - slope * normal.z()) / ((weight * weight + slope * slope) * across);
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

/// Circles where the plane is across the axis or contains it; `None` elsewhere.
fn plane_with_torus(normal: Vector3, d: f64, major: f64, minor: f64) -> Option<Vec<Curve>> {
    let across = (normal.x() * normal.x() + normal.y() * normal.y()).sqrt();
    if across < PARALLEL {
        let z = d.copysign(d * normal.z());
        let square = (minor - z) * (minor + z);
        if square.is_nan() || square <= TOUCH * minor * minor {
            return Some(Vec::new());
        }
        return Some(circles([major + square.sqrt(), major - square.sqrt()].map(|radius| (radius, z))));
    }
    if normal.z().abs() < PARALLEL && d.abs() < PARALLEL * major {
        let out = Vector3::new(-normal.y(), normal.x(), 0.0).try_normalize()?;
        let section = |out: Vector3| Curve::ellipse(Point3::ORIGIN + out * major, out * minor, Vector3::Z * minor);
        return Some(vec![section(out), section(-out)]);
    }
    // Far away there is nothing to be traced.
    let reach = major * across + minor;
    (d.abs() > reach * (1.0 + TOUCH)).then(Vec::new)
}

/// Circles around the axis, of radius and height.
fn circles(of: impl IntoIterator<Item = (f64, f64)>) -> Vec<Curve> {
    let circle =
        |(radius, z): (f64, f64)| Curve::ellipse(Point3::new(0.0, 0.0, z), Vector3::X * radius, Vector3::Y * radius);
    of.into_iter().filter(|&(radius, _)| radius > 0.0).map(circle).collect()
}

/// A profile: a line or a circle in the half plane of distances and heights.
#[derive(Clone, Copy, Debug)]
enum Profile {
    /// The distance is thin + slope z.
    Line { thin: f64, slope: f64 },
    /// Around a point at this distance and height.
    Circle { distance: f64, z: f64, radius: f64 },
}

impl Profile {
    /// That of a surface with its axis on z, after a scale, a turn upside down where `sign` is −1, and a move to height `z`.
    fn new(surface: Surface, scale: f64, sign: f64, z: f64) -> Option<Self> {
        Some(match surface {
            Surface::Plane => return None,
            Surface::Sphere { radius } => Self::Circle { distance: 0.0, z, radius: radius * scale },
            Surface::Torus { major, minor } => Self::Circle { distance: major * scale, z, radius: minor * scale },
            Surface::Side { thin, slope } => Self::Line { thin: thin * scale - slope * sign * z, slope: slope * sign },
        })
    }

    fn size(&self) -> f64 {
        match *self {
            Self::Line { thin, slope } => thin.abs() + slope.abs(),
            Self::Circle { distance, radius, .. } => distance + radius,
        }
    }
}

/// Circles, where both are round around one axis, or spheres; `None` elsewhere.
fn around_one_axis(a: &Patch, b: &Patch) -> Option<Vec<Curve>> {
    let is_sphere = |patch: &Patch| matches!(patch.surface, Surface::Sphere { .. });
    // A sphere takes any axis, so the other one leads; of two spheres it is the line of their centres.
    let (a, b) = if is_sphere(a) { (b, a) } else { (a, b) };
    let relative = a.space_from_patch.inverse() * b.space_from_patch;
    let scale = relative.uniform_scale()?;
    let origin = relative.point(Point3::ORIGIN).to_vector();
    if let (Surface::Sphere { radius: first }, Surface::Sphere { radius: second }) = (a.surface, b.surface) {
        return Some(
            spheres(first, origin, second * scale).iter().map(|c| c.transformed(&a.space_from_patch)).collect(),
        );
    }
    let up = relative.vector(Vector3::Z) * (1.0 / scale);
    let size = a.local_bounds().diagonal().length().min(b.local_bounds().diagonal().length() * scale);
    if let (Surface::Side { thin, slope: 0.0 }, Surface::Side { thin: other, slope: 0.0 }) = (a.surface, b.surface)
        && up.x().abs().max(up.y().abs()) < PARALLEL
    {
        let local = parallel_sides(thin, origin, other * scale, a.limits);
        return Some(local.iter().map(|curve| curve.transformed(&a.space_from_patch)).collect());
    }
    let is_along = is_sphere(b) || up.x().abs().max(up.y().abs()) < PARALLEL;
    let is_on_axis = origin.x().abs().max(origin.y().abs()) < PARALLEL * size;
    if !(is_along && is_on_axis) {
        return None;
    }
    let first = Profile::new(a.surface, 1.0, 1.0, 0.0)?;
    let second = Profile::new(b.surface, scale, 1.0_f64.copysign(up.z()), origin.z())?;
    let local = circles(profiles(first, second));
    Some(local.iter().map(|curve| curve.transformed(&a.space_from_patch)).collect())
}

/// The two lines of cylinders with parallel axes, the first one's on z: where two circles cross.
fn parallel_sides(first: f64, center: Vector3, second: f64, limits: Limits) -> Vec<Curve> {
    let Limits::Length(length) = limits else { return Vec::new() };
    let circle = |at: [f64; 2], radius| Profile::Circle { distance: at[0], z: at[1], radius };
    let crossings = profiles(circle([0.0, 0.0], first), circle([center.x(), center.y()], second));
    let line = |(x, y)| Curve::line(Point3::new(x, y, 0.0), Point3::new(x, y, length));
    crossings.into_iter().map(line).collect()
}

/// The circle of two spheres, the first one around the origin.
fn spheres(first: f64, center: Vector3, second: f64) -> Vec<Curve> {
    let distance = center.length();
    let Some(direction) = center.try_normalize().filter(|_| distance > PARALLEL * first.min(second)) else {
        return Vec::new();
    };
    let along = 0.5 * (distance + (first - second) * (first + second) / distance);
    plane_with_sphere(direction, along, first)
}

/// Where two profiles cross, as distances and heights; distances may be negative.
fn profiles(first: Profile, second: Profile) -> Vec<(f64, f64)> {
    let size = first.size().max(second.size());
    match (first, second) {
        (Profile::Line { thin, slope }, Profile::Line { thin: other, slope: steeper }) => {
            let z = (other - thin) / (slope - steeper);
            if (slope - steeper).abs() > PARALLEL { vec![(thin + slope * z, z)] } else { Vec::new() }
        }
        (Profile::Line { thin, slope }, Profile::Circle { distance, z, radius })
        | (Profile::Circle { distance, z, radius }, Profile::Line { thin, slope }) => {
            // From the circle's centre the line is reached across it, at this height over the centre.
            let steep = 1.0 + slope * slope;
            let gap = thin + slope * z - distance;
            let square = radius * radius - gap * gap / steep;
            if square.is_nan() || square <= TOUCH * radius * radius {
                return Vec::new();
            }
            let (middle, half) = (-gap * slope / steep, (square / steep).sqrt());
            [middle - half, middle + half].map(|up| (thin + slope * (z + up), z + up)).to_vec()
        }
        (Profile::Circle { distance, z, radius }, Profile::Circle { distance: far, z: high, radius: other }) => {
            let (dx, dz) = (far - distance, high - z);
            let apart = (dx * dx + dz * dz).sqrt();
            if apart <= PARALLEL * size {
                return Vec::new();
            }
            let along = 0.5 * (apart + (radius - other) * (radius + other) / apart);
            let square = (radius - along) * (radius + along);
            if square.is_nan() || square <= TOUCH * radius * radius {
                return Vec::new();
            }
            let (ux, uz, half) = (dx / apart, dz / apart, square.sqrt());
            [half, -half].map(|side| (distance + ux * along - uz * side, z + uz * along + ux * side)).to_vec()
        }
    }
}

/// The map between the coordinates of two pieces.
pub(super) fn between(from: &Patch, to: &Patch) -> Transform {
    to.space_from_patch.inverse() * from.space_from_patch
}

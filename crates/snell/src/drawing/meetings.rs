//! Where bodies run through each other: an edge in the rendering, and so a line in the drawing. World space.
//!
//! Between shapes and solids the curves are `outline`'s. Where a mesh is one of the two, its triangles are cut by the border of the
//! other one, which has to have an inside: along each side of a triangle the place is found by bisection.

use rayon::prelude::*;
use snell_math::{Bounds3, Homogeneous3, Point3};

use super::screen::Screen;
use crate::geometry::{Form, WorldSurface};
use crate::outline::{self, Body, Curve, Feature, FeatureKind, OutlineOptions};
use crate::shape::triangle_mesh::{EdgeFaces, TriangleMesh};
use crate::viewing::Side;

/// Bodies are looked at for where they run through each other only where there are at most so many pairs of them.
const MOST_PAIRS: usize = 10_000;
/// What two boxes have in common is worth a look only where it is larger than this in the picture, in pixels.
const WORTH: f64 = 2.0;
/// A mesh is cut by another body where at most so many of its triangles are in that one's box.
const MOST_TRIANGLES: usize = 400_000;
/// Triangles are halved until their sides are shorter than this many pixels, or than this share of the other body.
const SIDE: (f64, f64) = (6.0, 1.0 / 48.0);
/// How often at most.
const MOST_HALVINGS: u32 = 8;

/// The curves in which the surfaces of a scene meet, each with the first of the two.
pub fn meetings(
    surfaces: &[WorldSurface<'_>],
    screen: &Screen<'_>,
    options: &OutlineOptions<'_>,
) -> Vec<(usize, Feature)> {
    let closed: Vec<bool> = surfaces
        .par_iter()
        .map(|surface| match surface.form {
            Form::Mesh(mesh, _) => {
                mesh.triangle_count() <= MOST_TRIANGLES
                    && mesh.edges().iter().all(|edge| matches!(edge.faces, EdgeFaces::Two(_, true)))
            }
            Form::Shape(shape) => shape.is_solid(),
            Form::Solid(_) => true,
        })
        .collect();
    let features = |(a, b): (usize, usize)| -> Vec<(usize, Feature)> {
        let (one, other) = (&surfaces[a], &surfaces[b]);
        let features = match (body(one), body(other)) {
            (Some(one), Some(other)) => outline::intersections(&one, &other, options),
            _ => match (one.form, other.form) {
                (Form::Mesh(mesh, _), _) if closed[b] => cut(one, mesh, other, screen),
                (_, Form::Mesh(mesh, _)) if closed[a] => cut(other, mesh, one, screen),
                _ => Vec::new(),
            },
        };
        features.into_iter().map(|feature| (a, feature)).collect()
    };
    meeting_pairs(surfaces, screen).into_par_iter().flat_map_iter(features).collect()
}

/// A shape or a solid as `outline` takes it.
pub fn body<'s>(surface: &'s WorldSurface<'_>) -> Option<Body<'s>> {
    let form = match &surface.form {
        Form::Shape(shape) => outline::Form::Shape(shape),
        Form::Solid(solid) => outline::Form::Solid(solid),
        Form::Mesh(..) => return None,
    };
    Some(Body { form, space_from_body: surface.world_from_own.as_ref() })
}

/// The pairs of surfaces whose boxes overlap where it can be seen: found by a sweep along x. None at all where there are too many.
fn meeting_pairs(surfaces: &[WorldSurface<'_>], screen: &Screen<'_>) -> Vec<(usize, usize)> {
    let mut order: Vec<usize> = (0..surfaces.len()).collect();
    order.sort_by(|&a, &b| surfaces[a].bounds.min.x().total_cmp(&surfaces[b].bounds.min.x()).then(a.cmp(&b)));
    let mut pairs = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    for &index in &order {
        let bounds = &surfaces[index].bounds;
        open.retain(|&other| surfaces[other].bounds.max.x() >= bounds.min.x());
        for &other in &open {
            let common = surfaces[other].bounds.intersection(bounds);
            if !common.is_empty() && is_worth(&common, screen) {
                pairs.push((index.min(other), index.max(other)));
            }
        }
        if pairs.len() > MOST_PAIRS {
            return Vec::new();
        }
        open.push(index);
    }
    pairs.sort_unstable();
    pairs
}

/// Whether a box is in the picture and large enough there.
fn is_worth(bounds: &Bounds3, screen: &Screen<'_>) -> bool {
    if !bounds.is_finite() {
        return true;
    }
    let clip: Vec<Homogeneous3> = (0..8).map(|corner| screen.clip(bounds.corner(corner).into())).collect();
    let is_beyond = |side: &Side| clip.iter().all(|p| side.distance(*p) < 0.0);
    let across = bounds.diagonal().length();
    // Of what reaches behind the eye the size says nothing.
    let is_before = clip.iter().all(|p| p.h() > 0.0);
    let nearest = (0..8).map(|corner| screen.pixel_length(bounds.corner(corner))).fold(f64::INFINITY, f64::min);
    !Side::ALL.iter().filter(|side| **side != Side::Far).any(is_beyond) && (!is_before || across > WORTH * nearest)
}

/// Whether a point is inside of a body.
fn contains(body: &WorldSurface<'_>, p: Point3) -> bool {
    let own = body.world_from_own.as_ref().map_or(p, |map| map.inverse_point(p));
    match body.form {
        Form::Shape(shape) => shape.contains(own),
        Form::Solid(solid) => solid.contains(own),
        Form::Mesh(mesh, _) => mesh.contains(own),
    }
}

/// Where the triangles of a mesh go through the border of another body.
fn cut(surface: &WorldSurface<'_>, mesh: &TriangleMesh, other: &WorldSurface<'_>, screen: &Screen<'_>) -> Vec<Feature> {
    let to_world = |p: Point3| surface.world_from_own.as_ref().map_or(p, |map| map.point(p));
    let within: Vec<[Point3; 3]> = (0..mesh.triangle_count() as u32)
        .into_par_iter()
        .map(|triangle| mesh.triangle(triangle).map(to_world))
        .filter(|corners| !around(corners).intersection(&other.bounds).is_empty())
        .collect();
    if within.len() > MOST_TRIANGLES {
        return Vec::new();
    }
    let size = if other.bounds.is_finite() { other.bounds.diagonal().length() } else { f64::INFINITY };
    within
        .into_par_iter()
        .flat_map_iter(|corners| {
            let mut segments = Vec::new();
            let small = (SIDE.0 * screen.pixel_length(around(&corners).center())).max(SIDE.1 * size.min(1e300));
            let small = if size.is_finite() { small } else { f64::INFINITY };
            divide(corners, other, small, 0, &mut segments);
            segments
        })
        .map(|[a, b]| {
            let curve = Curve::Segment { a: Homogeneous3::from(a), b: Homogeneous3::from(b) };
            Feature::new(FeatureKind::Intersection, curve)
        })
        .collect()
}

fn around(corners: &[Point3; 3]) -> Bounds3 {
    corners.iter().fold(Bounds3::EMPTY, |all, p| all.including(*p))
}

/// Cuts a triangle, or the four quarters of one that is too large to be cut as a whole.
fn divide(corners: [Point3; 3], other: &WorldSurface<'_>, small: f64, depth: u32, segments: &mut Vec<[Point3; 2]>) {
    let bounds = around(&corners);
    if bounds.intersection(&other.bounds).is_empty() {
        return;
    }
    let [a, b, c] = corners;
    if depth < MOST_HALVINGS && bounds.diagonal().length() > small {
        let (ab, bc, ca) = (a.lerp(b, 0.5), b.lerp(c, 0.5), c.lerp(a, 0.5));
        for quarter in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            divide(quarter, other, small, depth + 1, segments);
        }
        return;
    }
    let inside = corners.map(|p| contains(other, p));
    let crossing = |i: usize, j: usize| {
        let (mut low, mut high) = (corners[i], corners[j]);
        for _ in 0..50 {
            let middle = low.lerp(high, 0.5);
            if contains(other, middle) == inside[i] { low = middle } else { high = middle }
        }
        low.lerp(high, 0.5)
    };
    let sides: Vec<(usize, usize)> =
        [(0, 1), (1, 2), (2, 0)].into_iter().filter(|(i, j)| inside[*i] != inside[*j]).collect();
    if let [(i, j), (k, l)] = sides[..] {
        segments.push([crossing(i, j), crossing(k, l)]);
    }
}

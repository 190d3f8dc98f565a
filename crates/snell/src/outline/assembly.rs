//! The curves of solids made of shapes, and those where bodies run through each other.
//!
//! What may be drawn of a solid is on the surface of a leaf: the leaf's own curves, and those in which two leaves meet. Each is cut
//! where it passes through any other leaf's surface, and one place of each piece tells for all of it whether the solid's surface
//! is there: a contour where the solid is on one side of the leaf's surface only; an edge where the parts of space around the
//! curve, between all surfaces that contain it, are not simply solid on one side of a smooth surface and empty on the other.
//! So surfaces of several leaves that coincide, as those of a hole flush with a face, leave no line too many.

use std::f64::consts::{PI, TAU};

use snell_math::{Bounds3, Homogeneous3, Point3, Transform, Vector3, portable};

use super::curve::Curve;
use super::meet::meet;
use super::patch::{Limits, Patch, Surface, patches};
use super::strand::{Place, Strand};
use super::{Body, Feature, FeatureKind, Form, MAX_PARAMETER_LINES, OutlineOptions, contour, rims};
use crate::csg::CsgSolid;
use crate::shape::Shape;

/// How far from a curve membership is asked, relative to the smallest size nearby and to the coordinates.
const STEP: f64 = 1e-8;
const ROUNDING_STEP: f64 = 1e-11;
/// Surfaces within this part of a step contain the curve.
const CONTAINED: f64 = 0.05;
/// Directions around a curve that differ by less, in radians, are one.
const SAME_ANGLE: f64 = 1e-5;
/// How far away, in sizes of a solid, a plane's horizon is taken to be.
const FAR: f64 = 1e6;

/// A shape of a body, in the caller's space.
struct Leaf {
    patches: Vec<Patch>,
    rims: Vec<(FeatureKind, Curve)>,
    bounds: Bounds3,
    /// 0 where it has no end.
    size: f64,
    /// Its further flat patches are caps.
    has_caps: bool,
}

impl Leaf {
    fn new(shape: &Shape, space_from_shape: Option<&Transform>) -> Self {
        let patches: Vec<Patch> = patches(shape).iter().map(|patch| patch.carried(space_from_shape)).collect();
        let rims = rims::rims(shape).into_iter().map(|(kind, curve)| (kind, curve.carried(space_from_shape)));
        let rims = rims.filter(|(_, curve)| curve.is_finite()).collect();
        let bounds = patches.iter().fold(Bounds3::EMPTY, |sum, patch| sum.union(&patch.bounds()));
        let size = if bounds.is_finite() { 0.5 * bounds.diagonal().length() } else { 0.0 };
        // A point on a flat box's border must not fall out of it.
        let bounds = if bounds.is_finite() { bounds.grown(1e-6 * size) } else { bounds };
        let has_caps = matches!(shape, Shape::Cylinder(_) | Shape::Cone(_));
        Self { patches, rims, bounds, size, has_caps }
    }
}

/// A body taken apart.
pub(super) struct Assembly<'a> {
    leaves: Vec<Leaf>,
    /// Absent for a single shape, all of whose surface is there.
    solid: Option<&'a CsgSolid>,
    space_from_body: Option<&'a Transform>,
    /// The size of the smallest part.
    least: f64,
}

/// A piece that is drawn.
struct Drawn {
    curve: Curve,
    bounds: Bounds3,
}

impl<'a> Assembly<'a> {
    pub(super) fn new(body: &Body<'a>) -> Self {
        let (leaves, solid): (Vec<Leaf>, _) = match body.form {
            Form::Shape(shape) => (vec![Leaf::new(shape, body.space_from_body)], None),
            Form::Solid(solid) => {
                let leaf = |index| {
                    let (shape, solid_from_leaf) = solid.leaf_shape(index);
                    let map = match (body.space_from_body, solid_from_leaf) {
                        (Some(&outer), Some(&inner)) => Some(outer * inner),
                        (outer, inner) => outer.or(inner).copied(),
                    };
                    Leaf::new(shape, map.as_ref())
                };
                ((0..solid.leaf_count()).map(leaf).collect(), Some(solid))
            }
        };
        let sizes = leaves.iter().map(|leaf| leaf.size).filter(|&size| size > 0.0);
        let least = sizes.fold(f64::INFINITY, f64::min);
        Self { leaves, solid, space_from_body: body.space_from_body, least }
    }

    /// True inside the solid.
    fn contains(&self, point: Point3) -> bool {
        let point = self.space_from_body.map_or(point, |map| map.inverse_point(point));
        self.solid.is_some_and(|solid| solid.contains(point))
    }

    /// A length that is small against everything, and large against rounding.
    fn step(&self, point: Point3) -> f64 {
        let least = if self.least.is_finite() { self.least } else { point.max_abs().max(1.0) };
        (STEP * least).max(ROUNDING_STEP * point.max_abs())
    }

    /// Whether a point of a leaf's surface is on the solid's: then `Some`, true where the solid's inside is the leaf's outside.
    fn side(&self, point: Point3, patch: &Patch) -> Option<bool> {
        if self.solid.is_none() {
            return Some(false);
        }
        let normal = patch.normal(point)? * self.step(point);
        let [outside, inside] = [point + normal, point - normal].map(|p| self.contains(p));
        (outside != inside).then_some(outside)
    }

    /// All pieces of surface that contain a point but for their limits, with their leaves and normals.
    fn surfaces_at(&self, point: Point3) -> impl Iterator<Item = (usize, &Patch, Vector3)> {
        let near = CONTAINED * self.step(point);
        let leaves = self.leaves.iter().enumerate().filter(move |(_, leaf)| leaf.bounds.contains(point));
        leaves.flat_map(move |(index, leaf)| {
            let contains = move |patch: &&Patch| {
                let (height, gradient) = patch.height_and_gradient(point);
                height.abs() <= near * gradient.length()
            };
            leaf.patches.iter().filter(contains).filter_map(move |patch| Some((index, patch, patch.normal(point)?)))
        })
    }

    /// True where a leaf before this one, another than `partner`, has the same surface there: its curves are drawn.
    fn is_doubled(&self, place: Place, leaf: usize, patch: &Patch, partner: usize) -> bool {
        let Some(normal) = patch.normal(place.point) else { return false };
        let mut earlier = self.surfaces_at(place.point).take_while(|(index, ..)| *index < leaf);
        earlier.any(|(index, other, direction)| {
            index != partner && direction.cross(normal).length() < SAME_ANGLE && other.margin(place.point) > 0.0
        })
    }

    /// True where the solid has an edge along a curve: neither all nor nothing around it is solid, nor just one half.
    fn is_edge(&self, place: Place) -> bool {
        let (x, y) = place.direction.orthonormal_basis();
        let mut angles: Vec<f64> = Vec::new();
        for (_, _, normal) in self.surfaces_at(place.point) {
            let along = place.direction.cross(normal);
            if along.length() > SAME_ANGLE {
                let angle = portable::atan2(along.dot(y), along.dot(x));
                angles.extend([angle, if angle > 0.0 { angle - PI } else { angle + PI }]);
            }
        }
        angles.sort_by(f64::total_cmp);
        angles.dedup_by(|a, b| *a - *b < SAME_ANGLE);
        if let [first, .., last] = angles[..]
            && first + TAU - last < SAME_ANGLE
        {
            angles.pop();
        }
        let step = self.step(place.point);
        let is_solid = |i: usize| {
            let next = angles.get(i + 1).copied().unwrap_or(angles[0] + TAU);
            let middle = 0.5 * (angles[i] + next);
            self.contains(place.point + (x * portable::cos(middle) + y * portable::sin(middle)) * step)
        };
        let sectors: Vec<bool> = (0..angles.len()).map(is_solid).collect();
        let before = |i: usize| sectors[(i + sectors.len() - 1) % sectors.len()];
        let changes: Vec<f64> = (0..sectors.len()).filter(|&i| sectors[i] != before(i)).map(|i| angles[i]).collect();
        match changes[..] {
            [] => false,
            [a, b] => (b - a - PI).abs() > 4.0 * SAME_ANGLE,
            _ => true,
        }
    }

    /// The leaf curve's cuts by all other leaves.
    fn cuts(&self, strand: &Strand, leaves: &[usize]) -> Vec<f64> {
        let bounds = bounds_of(&strand.curve);
        let mut cuts = Vec::new();
        for (index, other) in self.leaves.iter().enumerate() {
            if !leaves.contains(&index) && !other.bounds.intersection(&bounds).is_empty() {
                for patch in &other.patches {
                    strand.meetings(patch, &mut cuts);
                }
            }
        }
        cuts
    }

    /// The curves of a solid, seen from `eye`.
    pub(super) fn features(&self, eye: Homogeneous3, options: &OutlineOptions) -> Vec<Feature> {
        let mut features = self.edges(options);
        let eye = contour::standard(eye);
        for (index, leaf) in self.leaves.iter().enumerate() {
            for (number, patch) in leaf.patches.iter().enumerate() {
                let contours = eye.map(|eye| contour::contours(patch, eye)).unwrap_or_default();
                let count = options.parameter_lines.min(MAX_PARAMETER_LINES);
                let lines = rims::parameter_lines(patch, count, leaf.has_caps && number > 0);
                let contours = contours.into_iter().map(|curve| (FeatureKind::Contour, curve));
                let lines = lines.into_iter().map(|curve| (FeatureKind::Parameter, curve));
                for (kind, curve) in contours.chain(lines).filter(|(_, curve)| curve.is_finite()) {
                    let strand = Strand::from(curve);
                    let keep = |place: Place| {
                        self.side(place.point, patch).filter(|_| !self.is_doubled(place, index, patch, index))
                    };
                    for (piece, is_flipped) in strand.pieces(self.cuts(&strand, &[index]), keep) {
                        let facing = Some((*patch, is_flipped));
                        features.push(Feature { kind, curve: piece.curve, leaf: index as u32, facing });
                    }
                }
                if eye.is_some_and(|eye| eye.h() != 0.0) {
                    let pieces = self.horizon(patch).into_iter();
                    let kind = FeatureKind::Horizon;
                    features.extend(pieces.map(|curve| Feature { kind, curve, leaf: index as u32, facing: None }));
                }
            }
        }
        features
    }

    /// The parts of a plane's horizon at which it is the solid's surface: far away only planes count.
    fn horizon(&self, patch: &Patch) -> Vec<Curve> {
        let Some(Curve::Conic { center, cos, sin, start, end }) = rims::horizon(patch) else { return Vec::new() };
        let planes = self.leaves.iter().flat_map(|leaf| &leaf.patches).filter(|patch| patch.limits == Limits::None);
        let planes: Vec<&Patch> = planes.filter(|patch| patch.surface == Surface::Plane).collect();
        let origin = |patch: &Patch| patch.space_from_patch.point(Point3::ORIGIN);
        let finite = self.leaves.iter().filter(|leaf| leaf.size > 0.0);
        let reach = finite.map(|leaf| leaf.bounds.min.max_abs().max(leaf.bounds.max.max_abs()));
        let size = planes.iter().map(|plane| origin(plane).max_abs()).chain(reach).fold(0.0, f64::max);
        let size = if size > 0.0 { size } else { 1.0 };
        let Some(normal) = patch.normal(origin(patch)) else { return Vec::new() };
        // The same curve, as a circle on the plane that is as good as at infinity.
        let unit = cos.vector().length();
        let far = |direction: Homogeneous3| direction.vector() * (FAR * size / unit);
        let circle = Strand::from(Curve::ellipse(origin(patch), far(cos), far(sin)));
        let mut cuts = Vec::new();
        for other in planes.iter().filter(|other| **other != patch) {
            circle.meetings(other, &mut cuts);
        }
        let keep = |place: Place| {
            let offset = normal * (1e-4 * size);
            (self.contains(place.point + offset) != self.contains(place.point - offset)).then_some(())
        };
        let pieces = circle.pieces(cuts, keep).into_iter();
        let arc = |curve: &Curve| match *curve {
            Curve::Conic { start, end, .. } => Curve::Conic { center, cos, sin, start, end },
            _ => Curve::Conic { center, cos, sin, start, end },
        };
        pieces.map(|(piece, ())| arc(&piece.curve)).collect()
    }

    /// Where the solid's faces meet: rims of leaves, and where two leaves run through each other.
    fn edges(&self, options: &OutlineOptions) -> Vec<Feature> {
        let mut drawn: Vec<Drawn> = Vec::new();
        let mut features = Vec::new();
        let mut draw = |strand: Strand, leaves: &[usize], cuts: Vec<f64>, is_single: &dyn Fn(Place) -> bool| {
            let keep = |place: Place| (self.is_edge(place) && is_single(place)).then_some(());
            for (piece, ()) in strand.pieces(cuts, keep) {
                if !is_drawn(&piece, &drawn, self) {
                    let (kind, leaf) = (FeatureKind::Crease, leaves[0] as u32);
                    features.push(Feature { kind, curve: piece.curve.clone(), leaf, facing: None });
                    drawn.push(Drawn { bounds: bounds_of(&piece.curve), curve: piece.curve });
                }
            }
        };
        for (index, leaf) in self.leaves.iter().enumerate() {
            for (_, rim) in &leaf.rims {
                let strand = Strand::from(rim.clone());
                let cuts = self.cuts(&strand, &[index]);
                draw(strand, &[index], cuts, &|_| true);
            }
        }
        for (i, j) in self.pairs() {
            for (a, b) in self.leaves[i].patches.iter().flat_map(|a| self.leaves[j].patches.iter().map(move |b| (a, b)))
            {
                for strand in meet(a, b, options.tolerance) {
                    let cuts = self.cuts(&strand, &[i, j]);
                    let is_single = |place: Place| !self.is_doubled(place, i, a, j) && !self.is_doubled(place, j, b, i);
                    draw(strand, &[i, j], cuts, &is_single);
                }
            }
        }
        features
    }

    /// The pairs of leaves whose boxes overlap, found along x.
    fn pairs(&self) -> Vec<(usize, usize)> {
        let mut order: Vec<usize> = (0..self.leaves.len()).collect();
        let low = |i: usize| self.leaves[i].bounds.min.x();
        order.sort_by(|&i, &j| low(i).total_cmp(&low(j)));
        let mut pairs = Vec::new();
        for (place, &i) in order.iter().enumerate() {
            for &j in order[place + 1..].iter().take_while(|&&j| low(j) <= self.leaves[i].bounds.max.x()) {
                if !self.leaves[i].bounds.intersection(&self.leaves[j].bounds).is_empty() {
                    pairs.push((i.min(j), i.max(j)));
                }
            }
        }
        pairs.sort_unstable();
        pairs
    }
}

/// True where all of a piece lies on one that is drawn already.
fn is_drawn(piece: &Strand, drawn: &[Drawn], assembly: &Assembly) -> bool {
    let [start, end] = piece.curve.domain();
    let points: Option<Vec<Point3>> =
        [0.1, 0.48, 0.93].map(|f| piece.point(start + (end - start) * f)).into_iter().collect();
    let Some(points) = points else { return false };
    let is_on = |other: &Drawn| {
        points.iter().all(|&point| {
            let near = CONTAINED * assembly.step(point);
            other.bounds.grown(near).contains(point) && distance(&other.curve, point) <= near
        })
    };
    drawn.iter().any(is_on)
}

/// The distance of a point from a segment or from an ellipse's arc where it is small; from other curves infinite but for points
/// of a polyline.
fn distance(curve: &Curve, point: Point3) -> f64 {
    match curve {
        Curve::Segment { a, b } => match (a.homogenize(), b.homogenize()) {
            (Ok(a), Ok(b)) => {
                let along = b - a;
                let t = ((point - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
                (point - (a + along * t)).length()
            }
            (Ok(from), Err(_)) | (Err(_), Ok(from)) => {
                let direction = if a.h() == 0.0 { a.vector() } else { b.vector() };
                let t = ((point - from).dot(direction) / direction.length_squared()).max(0.0);
                (point - (from + direction * t)).length()
            }
            _ => f64::INFINITY,
        },
        &Curve::Conic { center, cos, sin, start, end } => {
            // The angle of the point as a combination of both, by the normal equations.
            let Ok(middle) = center.homogenize() else { return f64::INFINITY };
            if cos.h() != 0.0 || sin.h() != 0.0 {
                return f64::INFINITY;
            }
            let (u, v, w) = (cos.vector(), sin.vector(), point - middle);
            let (uu, uv, vv, uw, vw) = (u.dot(u), u.dot(v), v.dot(v), u.dot(w), v.dot(w));
            let determinant = uu * vv - uv * uv;
            let angle = portable::atan2((uu * vw - uv * uw) / determinant, (vv * uw - uv * vw) / determinant);
            let angle = angle + ((start - 1e-9 - angle) / TAU).ceil() * TAU;
            if angle > end + 1e-9 {
                return f64::INFINITY;
            }
            curve.point(angle).homogenize().map_or(f64::INFINITY, |p| p.distance(point))
        }
        Curve::Torus(_) | Curve::Polyline(_) => f64::INFINITY,
    }
}

/// A box around a curve, a little too large; everything where it has no end.
fn bounds_of(curve: &Curve) -> Bounds3 {
    let bounds = match curve {
        Curve::Segment { a, b } => match (a.homogenize(), b.homogenize()) {
            (Ok(a), Ok(b)) => Bounds3::EMPTY.including(a).including(b),
            _ => return Bounds3::EVERYTHING,
        },
        Curve::Conic { center, cos, sin, .. } => {
            let Ok(middle) = center.homogenize() else { return Bounds3::EVERYTHING };
            if cos.h() != 0.0 || sin.h() != 0.0 {
                return Bounds3::EVERYTHING;
            }
            let squares = cos.0.truncate() * cos.0.truncate() + sin.0.truncate() * sin.0.truncate();
            let reach = Vector3::new(squares.x.sqrt(), squares.y.sqrt(), squares.z.sqrt());
            Bounds3::new(middle - reach, middle + reach)
        }
        Curve::Torus(_) | Curve::Polyline(_) => {
            let [start, end] = curve.domain();
            let count = curve.parts();
            let at = |i: usize| curve.point(start + (end - start) * (i as f64 / count as f64)).homogenize();
            let bounds = (0..=count).filter_map(|i| at(i).ok()).fold(Bounds3::EMPTY, |sum, p| sum.including(p));
            // Between these points it may bulge out by the sag of a part.
            bounds.grown(0.02 * bounds.diagonal().length())
        }
    };
    bounds.grown(1e-9 * (bounds.diagonal().length() + bounds.max.max_abs()))
}

/// The curves in which the surfaces of two bodies run through each other.
pub(super) fn intersections(a: &Assembly, b: &Assembly, options: &OutlineOptions) -> Vec<Feature> {
    let mut features = Vec::new();
    for (index, first) in a.leaves.iter().enumerate() {
        for (other, second) in b.leaves.iter().enumerate() {
            if first.bounds.intersection(&second.bounds).is_empty() {
                continue;
            }
            for (p, q) in first.patches.iter().flat_map(|p| second.patches.iter().map(move |q| (p, q))) {
                for strand in meet(p, q, options.tolerance) {
                    let mut cuts = a.cuts(&strand, &[index]);
                    cuts.extend(b.cuts(&strand, &[other]));
                    let on_both = |place: Place| {
                        let is_on = a.side(place.point, p).is_some() && b.side(place.point, q).is_some();
                        let is_doubled = a.is_doubled(place, index, p, index) || b.is_doubled(place, other, q, other);
                        (is_on && !is_doubled).then_some(())
                    };
                    let (kind, leaf) = (FeatureKind::Intersection, index as u32);
                    let pieces = strand.pieces(cuts, on_both).into_iter();
                    features.extend(pieces.map(|(piece, ())| Feature { kind, curve: piece.curve, leaf, facing: None }));
                }
            }
        }
    }
    features
}

//! The curves that shapes and solids are drawn by: edges, rims, contours, and where surfaces meet.
//!
//! All are exact, segments and conics wherever they can be: the outline of a sphere is a circle in space, that of a cone two
//! straight lines. What depends on the eye is found in homogeneous coordinates, so that a parallel projection is no special
//! case. Which parts of a curve are seen is not asked here.
//!
//! Spaces and units are the caller's: a [`Body`] says how its own space lies in that.

mod assembly;
mod contour;
mod curve;
mod meet;
mod patch;
mod rims;
mod strand;
#[cfg(test)]
mod tests;
mod torus;
mod trace;

use snell_math::{Homogeneous3, Point3, Transform, Vector3};

use crate::csg::CsgSolid;
use crate::shape::Shape;
use assembly::Assembly;
pub use curve::Curve;
use patch::Patch;
pub use torus::TorusContour;

/// What a curve is to the body it is drawn for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FeatureKind {
    /// Two faces meet in an edge.
    Crease,
    /// An open surface ends.
    Boundary,
    /// A smooth surface turns away from the eye.
    Contour,
    /// The line at infinity of a plane without end.
    Horizon,
    /// Two bodies run through each other.
    Intersection,
    /// A surface coordinate, u or v, is constant.
    Parameter,
}

/// A curve and what it is.
#[derive(Clone, Debug)]
pub struct Feature {
    /// What it is.
    pub kind: FeatureKind,
    /// The curve, in the caller's space.
    pub curve: Curve,
    /// Which leaf of a solid it comes from, for its material; 0 for a shape, the lower one where two leaves meet.
    pub leaf: u32,
    /// The surface that a contour lies on, and whether its inside is the solid's outside.
    facing: Option<(Patch, bool)>,
}

impl Feature {
    /// A curve that is no contour.
    pub fn new(kind: FeatureKind, curve: Curve) -> Self {
        Self { kind, curve, leaf: 0, facing: None }
    }

    /// The outward unit normal of the body's surface at a point of a contour or a parameter line, in the caller's space; `None`
    /// for other kinds.
    pub fn outward(&self, point: Point3) -> Option<Vector3> {
        let (patch, is_flipped) = self.facing.as_ref()?;
        let normal = patch.normal(point)?;
        Some(if *is_flipped { -normal } else { normal })
    }
}

/// What is drawn: a shape or a solid.
#[derive(Clone, Copy, Debug)]
pub enum Form<'a> {
    /// A shape.
    Shape(&'a Shape),
    /// A solid made of shapes.
    Solid(&'a CsgSolid),
}

/// A form, and where it stands.
#[derive(Clone, Copy, Debug)]
pub struct Body<'a> {
    /// The form, in its own space.
    pub form: Form<'a>,
    /// From there to the caller's space; in place where absent.
    pub space_from_body: Option<&'a Transform>,
}

/// What is wanted of the curves.
#[derive(Clone, Copy)]
pub struct OutlineOptions<'a> {
    /// How many lines of constant u, and as many of constant v, are drawn on each surface.
    pub parameter_lines: u32,
    /// How far a polyline's chord may be from the curve near a point, in units of length of the caller's space; about a twentieth
    /// of a pixel there.
    pub tolerance: &'a (dyn Fn(Point3) -> f64 + Sync),
}

impl std::fmt::Debug for OutlineOptions<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("OutlineOptions").field("parameter_lines", &self.parameter_lines).finish_non_exhaustive()
    }
}

/// The curves of a body that is seen from `eye`: the point rays come from (h ≠ 0) or, for a parallel projection, the direction
/// towards the viewer (h = 0), in the caller's space.
///
/// ```
/// use snell::math::{Homogeneous3, Point3, Vector3};
/// use snell::outline::{Body, Curve, FeatureKind, Form, OutlineOptions, features};
/// use snell::shape::{Shape, Sphere};
/// let sphere = Shape::Sphere(Sphere::new(Point3::ORIGIN, 1.0));
/// let body = Body { form: Form::Shape(&sphere), space_from_body: None };
/// let options = OutlineOptions { parameter_lines: 0, tolerance: &|_| 1e-3 };
/// let [contour] = &features(&body, Point3::new(0.0, 0.0, 2.0).into(), &options)[..] else { unreachable!() };
/// assert_eq!(contour.kind, FeatureKind::Contour);
/// let Curve::Conic { center, .. } = &contour.curve else { unreachable!() };
/// assert_eq!(*center, Homogeneous3::new(0.0, 0.0, 0.5, 1.0));
/// ```
pub fn features(body: &Body, eye: Homogeneous3, options: &OutlineOptions) -> Vec<Feature> {
    match body.form {
        Form::Shape(shape) => shape_features(shape, body.space_from_body, eye, options),
        Form::Solid(_) => Assembly::new(body).features(eye, options),
    }
}

/// The most parameter lines of a kind: more would fill the surface.
const MAX_PARAMETER_LINES: u32 = 1024;

/// The curves of a shape that stands alone.
fn shape_features(
    shape: &Shape,
    space_from_shape: Option<&Transform>,
    eye: Homogeneous3,
    options: &OutlineOptions,
) -> Vec<Feature> {
    let plain = |(kind, curve): (FeatureKind, Curve)| Feature {
        kind,
        curve: curve.carried(space_from_shape),
        leaf: 0,
        facing: None,
    };
    let mut features: Vec<Feature> = rims::rims(shape).into_iter().map(plain).collect();
    let eye = contour::standard(eye);
    let round = matches!(shape, Shape::Cylinder(_) | Shape::Cone(_));
    for (index, patch) in patch::patches(shape).iter().enumerate() {
        let patch = patch.carried(space_from_shape);
        let with = |kind, curve| Feature { kind, curve, leaf: 0, facing: Some((patch, false)) };
        if let Some(eye) = eye {
            features.extend(contour::contours(&patch, eye).into_iter().map(|curve| with(FeatureKind::Contour, curve)));
            // Seen along parallel rays, what is at infinity is nowhere.
            let horizon = rims::horizon(&patch).filter(|_| eye.h() != 0.0);
            features.extend(horizon.map(|curve| Feature { facing: None, ..with(FeatureKind::Horizon, curve) }));
        }
        let count = options.parameter_lines.min(MAX_PARAMETER_LINES);
        let lines = rims::parameter_lines(&patch, count, round && index > 0);
        features.extend(lines.into_iter().map(|curve| with(FeatureKind::Parameter, curve)));
    }
    features.retain(|feature| feature.curve.is_finite());
    features
}

/// The curves in which the surfaces of two bodies run through each other.
pub fn intersections(a: &Body, b: &Body, options: &OutlineOptions) -> Vec<Feature> {
    assembly::intersections(&Assembly::new(a), &Assembly::new(b), options)
}

//! The camera that looks at rays: across the plane of incidence, from the side, from above, or as it is told; near enough that
//! what they meet fills the picture.

use snell_math::{Bounds3, Point3, Vector3};
use snell_scene::scene::{self, Frame};

use super::rays::Chosen;
use super::{ASPECT, FigureSettings, View};
use crate::compile::CompiledScene;
use crate::drawing::{finite_bounds, object_bounds};
use crate::explain::{Explanation, Kind};
use crate::render::RenderSettings;
use crate::viewing::ViewingError;

/// An object larger than what the rays span by this factor does not count for the frame: the ground is not to be seen as a whole.
const LARGE: f64 = 2.5;
/// The same for what stands in the way of a light, which may be near to the shadow.
const LARGE_BLOCKER: f64 = 6.0;
/// Height over width of a picture of what is wide and low.
const LEAST_ASPECT: f64 = 0.55;
/// The room around what is to be seen.
const MARGIN: f64 = 1.3;

/// A camera and what it is for.
pub struct Looking {
    /// The camera.
    pub camera: scene::Camera,
    /// Height over width of its picture.
    pub aspect: f64,
    /// How large what it looks at is, world units.
    pub size: f64,
}

/// The camera of a figure.
///
/// # Errors
/// [`ViewingError`], where the scene's camera is degenerate.
pub fn camera(
    scene: &CompiledScene,
    settings: &RenderSettings,
    told: &Explanation,
    chosen: &[Chosen],
    figure: &FigureSettings,
) -> Result<Looking, ViewingError> {
    let own = settings.camera(scene)?;
    let bounds = seen(scene, told, chosen);
    let size = bounds.diagonal().length();
    let pixels = own.pixels().map(f64::from);
    let looking = |camera: scene::Camera, aspect: f64| Looking { camera, aspect, size };
    let along = told.rays.first().and_then(|ray| ray.direction).unwrap_or(-own.axes()[2]);
    let flat = Vector3::new(along.x(), 0.0, along.z());
    let forward = flat.try_normalize().unwrap_or(Vector3::X);
    let right_of = forward.cross(Vector3::Y).try_normalize().unwrap_or(Vector3::Z);
    let (back, up) = match &figure.view {
        View::Camera => return Ok(looking(scene.camera.clone(), pixels[1] / pixels[0])),
        View::Given(camera) => return Ok(looking((**camera).clone(), pixels[1] / pixels[0])),
        View::Plane => across(told, chosen, forward, right_of).unwrap_or((right_of, Vector3::Y)),
        View::Side => (right_of, Vector3::Y),
        View::Above => (Vector3::Y, Vector3::Y.cross(forward)),
        View::Front => (own.axes()[2], own.axes()[1]),
        View::From(point) => {
            let back = (*point - bounds.center()).try_normalize().unwrap_or(own.axes()[2]);
            // From straight above or below, what is before the eye is to the right.
            (back, if back.y().abs() < 0.999 { Vector3::Y } else { back.cross(forward) })
        }
    };
    let right = up.cross(back).normalize();
    let up = back.cross(right);
    // The extent of what is to be seen, across and up.
    let center = bounds.center();
    let extent = |axis: Vector3| {
        let reach = (0..8).map(|corner| (bounds.corner(corner) - center).dot(axis).abs());
        2.0 * reach.fold(0.0, f64::max)
    };
    let aspect = (extent(up) / extent(right).max(1e-9)).clamp(LEAST_ASPECT, ASPECT);
    let width = MARGIN * extent(right).max(extent(up) / aspect).max(1e-6);
    // Before everything that the scene has, so that nothing is behind it.
    let all = finite_bounds(scene);
    let reach = if all.is_finite() { all.union(&bounds).diagonal().length() } else { size };
    let eye = center + back * (2.0 * (reach + width));
    let camera = scene::Camera { eye, gaze: -back, up, frame: Frame::OrthographicWidth(width), lens: None };
    Ok(looking(camera, aspect))
}

/// The direction towards the viewer across the plane of incidence at the first surface that bends or mirrors light, and what is up
/// then; `None` where the ray stands upright on it, or nothing was met.
fn across(told: &Explanation, chosen: &[Chosen], forward: Vector3, side: Vector3) -> Option<(Vector3, Vector3)> {
    let has_children = |ray: usize| chosen.iter().any(|other| told.rays[other.ray].parent == Some(ray));
    let first = chosen.iter().find(|one| told.rays[one.ray].surface.is_some() && has_children(one.ray));
    let ray = &told.rays[first.or(chosen.first())?.ray];
    let (direction, surface) = (ray.direction?, ray.surface.as_ref()?);
    let across = direction.cross(surface.shading_normal.as_vector());
    if across.length() < 1e-6 {
        return None;
    }
    let across = across.normalize();
    // From above rather than from below, where the ground would hide everything.
    let is_turned = if across.y().abs() > 0.1 { across.y() < 0.0 } else { across.dot(side) < 0.0 };
    let back = if is_turned { -across } else { across };
    // As upright as it can be; where the plane lies flat, what is before the eye is to the right.
    let upright = Vector3::Y - back * back.y();
    let up = if upright.length() > 0.3 { upright.normalize() } else { back.cross(forward).normalize() };
    Some((back, up))
}

/// The box around what the rays meet, the eye left out, which is far away most often.
fn seen(scene: &CompiledScene, told: &Explanation, chosen: &[Chosen]) -> Bounds3 {
    let mut points: Vec<Point3> = Vec::new();
    // Each with how large it may be.
    let mut objects: Vec<(u32, f64)> = Vec::new();
    for one in chosen {
        let ray = &told.rays[one.ray];
        if ray.kind != Kind::Camera {
            points.extend(ray.origin);
        }
        if let Some(surface) = &ray.surface {
            points.push(surface.point);
            if !objects.iter().any(|(number, _)| *number == surface.object_number) {
                objects.push((surface.object_number, LARGE));
            }
        }
        // What stands in the way of a light belongs to it.
        let asked = told.rays.iter().filter(|other| other.parent == Some(one.ray) && other.kind == Kind::Shadow);
        for blocker in asked.flat_map(|asked| &asked.blockers) {
            points.push(blocker.point);
            if !objects.iter().any(|(number, _)| *number == blocker.object_number) {
                objects.push((blocker.object_number, LARGE_BLOCKER));
            }
        }
    }
    let mut bounds = points.iter().fold(Bounds3::EMPTY, |all, p| all.including(*p));
    let bounds_of = |(object, large): &(u32, f64)| Some((object_bounds(scene, *object)?, *large));
    let mut around: Vec<(Bounds3, f64)> = objects.iter().filter_map(bounds_of).collect();
    around.sort_by(|(a, _), (b, _)| a.diagonal().length().total_cmp(&b.diagonal().length()));
    for (object, large) in around {
        let span = if bounds.is_empty() { 0.0 } else { bounds.diagonal().length() };
        let is_point = span < 1e-3 * object.diagonal().length();
        if is_point || object.diagonal().length() <= large * span {
            // What was met at one place of a large thing is seen with its neighbourhood alone.
            let part = if is_point && points.len() == 1 { near(&object, points[0]) } else { object };
            bounds = bounds.union(&part);
        }
    }
    if bounds.is_empty() || bounds.diagonal().length() < 1e-9 {
        let at = points.first().copied().or(told.rays.first().and_then(|ray| ray.origin)).unwrap_or(Point3::ORIGIN);
        let reach = told.rays.first().and_then(|ray| ray.distance).filter(|d| d.is_finite()).unwrap_or(4.0);
        bounds = Bounds3::EMPTY.including(at).grown(0.15 * reach.max(1e-6));
    }
    bounds
}

/// The part of a box around one of its points that is a third of it at most.
fn near(object: &Bounds3, at: Point3) -> Bounds3 {
    let around = Bounds3::EMPTY.including(at).grown(0.35 * object.diagonal().length());
    let part = around.intersection(object);
    if part.is_empty() { *object } else { part }
}

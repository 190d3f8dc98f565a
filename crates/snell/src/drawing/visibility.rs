//! Which parts of a curve are seen: asked of the ray tracer, with the camera's own rays.
//!
//! Visibility changes only where the curve's picture crosses an outline or the curve goes through a surface. Between two crossings
//! a ray or more decide, never farther apart than [`SPACING`], for surfaces that are gone through; where two neighbours differ,
//! the change is between them, at the crossing if there is one, else found by bisection, to [`PRECISION`] of a pixel.

use snell_math::{Homogeneous3, Ray, Vector3};

use super::crossings::Crossings;
use super::screen::{Sample, Screen};
use crate::geometry::{Geometry, QueryScratch};
use crate::outline::{Curve, Feature, FeatureKind};

/// How exactly changes are found, in pixels.
pub const PRECISION: f64 = 0.01;
/// How far apart rays are at most along a curve, in pixels.
const SPACING: f64 = 4.0;
/// By how much a contour's rays pass it on the outside, in pixels: there they do not graze the surface itself.
const BESIDE: f64 = 0.01;
/// How much nearer than a point a surface must be to hide it, relative to its distance.
const BEFORE: f64 = 1e-7;
/// How much nearer in pixels where the curve is known by points of it alone, and chords between them lie a little inside.
const BEFORE_CHORD: f64 = 0.5;
/// How far beside an edge one looks for what is behind it, in pixels.
const LOOK_BESIDE: f64 = 0.75;
/// How much farther than the edge that must be, in pixels there: a surface seen at an angle is farther too.
const BEHIND: f64 = 12.0;

/// A part of a curve that is seen as a whole, or hidden as a whole: from one parameter to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// Whether it is seen.
    pub visible: bool,
    /// Whether something ends there, so that beside it one sees what is behind: of an edge, that it is a part of the outline.
    pub is_outline: bool,
}

/// Asks the rays.
#[derive(Debug)]
pub struct Visibility<'a> {
    /// The picture.
    pub screen: &'a Screen<'a>,
    /// What may be in the way.
    pub geometry: &'a Geometry,
    /// The outlines.
    pub crossings: &'a Crossings,
}

impl Visibility<'_> {
    /// The parts of a curve along one of its tracks, from its beginning to its end, seen and hidden by turns.
    pub fn parts(&self, feature: &Feature, track: &[Sample], scratch: &mut QueryScratch) -> Vec<Part> {
        let (Some(first), Some(last)) = (track.first(), track.last()) else { return Vec::new() };
        let route = Route::new(track);
        let breaks = self.breaks(track, &route);
        let mut probes: Vec<(f64, bool)> = Vec::new();
        for pair in breaks.windows(2) {
            let length = pair[1] - pair[0];
            // Shorter ones are within what changes are found to; but a curve that is short itself is asked about.
            if length < PRECISION && breaks.len() > 2 {
                continue;
            }
            let count = (length / SPACING).ceil().max(1.0);
            let mut index = 0.5;
            while index < count {
                let t = route.parameter(pair[0] + length * (index / count));
                probes.push((t, self.is_visible(feature, t, scratch)));
                index += 1.0;
            }
        }
        // A point, or a line that is seen end on.
        if probes.is_empty() {
            probes.push((first.t, self.is_visible(feature, first.t, scratch)));
        }
        let Some(&(_, start)) = probes.first() else { return Vec::new() };
        let break_parameters: Vec<f64> = breaks.iter().map(|length| route.parameter(*length)).collect();
        let mut parts = vec![Part { from: first.t, to: last.t, visible: start, is_outline: false }];
        for pair in probes.windows(2) {
            let [(before, was), (after, is)] = *pair else { continue };
            if was == is {
                continue;
            }
            let at = self.change(feature, before, after, was, &break_parameters, scratch);
            if let Some(part) = parts.last_mut() {
                part.to = at;
            }
            parts.push(Part { from: at, to: last.t, visible: is, is_outline: false });
        }
        for part in parts.iter_mut().filter(|part| part.visible && feature.kind == FeatureKind::Crease) {
            part.is_outline = self.is_outline(feature, 0.5 * (part.from + part.to), scratch);
        }
        parts
    }

    /// Where visibility may change along a track, as lengths of the picture from its beginning; with both ends, in order.
    fn breaks(&self, track: &[Sample], route: &Route) -> Vec<f64> {
        let mut breaks = vec![0.0];
        let mut shares = Vec::new();
        for (pair, lengths) in track.windows(2).zip(route.lengths.windows(2)) {
            self.crossings.along(pair[0].at, pair[1].at, &mut shares);
            breaks.extend(shares.drain(..).map(|share| lengths[0] + (lengths[1] - lengths[0]) * share));
        }
        let total = route.total();
        breaks.push(total);
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| *a - *b < 1e-6);
        // The end itself may have gone with what was almost the same.
        if let Some(last) = breaks.last_mut() {
            *last = total;
        }
        breaks
    }

    /// The parameter at which visibility changes between two.
    fn change(
        &self,
        feature: &Feature,
        before: f64,
        after: f64,
        was: bool,
        breaks: &[f64],
        scratch: &mut QueryScratch,
    ) -> f64 {
        let (mut low, mut high) = (before, after);
        // A crossing in between is most often the place: then two rays beside it will say so.
        let first = breaks.partition_point(|t| *t <= before);
        if let Some(&guess) = breaks.get(first).filter(|t| **t < after) {
            let curve = &feature.curve;
            let step = |to: f64| {
                let (a, b) = (self.screen.sample(curve, guess).at, self.screen.sample(curve, to).at);
                guess + (to - guess) * (0.5 * PRECISION / distance(a, b).max(1e-12)).min(0.5)
            };
            let (just_before, just_after) = (step(before), step(after));
            if self.is_visible(feature, just_before, scratch) == was {
                low = just_before;
            } else {
                high = just_before;
            }
            if low == just_before {
                if self.is_visible(feature, just_after, scratch) == was {
                    low = just_after;
                } else {
                    return guess;
                }
            }
        }
        for _ in 0..60 {
            let (a, b) = (self.screen.sample(&feature.curve, low).at, self.screen.sample(&feature.curve, high).at);
            let middle = 0.5 * (low + high);
            if distance(a, b) < PRECISION || middle == low || middle == high {
                break;
            }
            if self.is_visible(feature, middle, scratch) == was {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }

    /// Whether a point of a curve is seen.
    pub fn is_visible(&self, feature: &Feature, t: f64, scratch: &mut QueryScratch) -> bool {
        let p = feature.curve.point(t);
        let Ok(point) = p.homogenize() else { return self.is_direction_clear(feature, p, scratch) };
        let pixel = self.screen.pixel_length(point);
        let target = match feature.outward(point).filter(|_| feature.kind == FeatureKind::Contour) {
            Some(outward) => point + outward * (BESIDE * pixel),
            None => point,
        };
        let Some(ray) = self.ray_to(target.into()) else { return false };
        let distance = (target - ray.origin).dot(ray.direction);
        let margin = match (&feature.curve, feature.kind) {
            (Curve::Polyline(_), _) | (_, FeatureKind::Intersection) => BEFORE_CHORD * pixel,
            _ => 0.0,
        };
        !self.geometry.is_blocked(&ray, distance - (BEFORE * distance + margin), scratch)
    }

    /// Whether on one side of an edge one sees past it.
    fn is_outline(&self, feature: &Feature, t: f64, scratch: &mut QueryScratch) -> bool {
        let Ok(point) = feature.curve.point(t).homogenize() else { return true };
        let [start, end] = feature.curve.domain();
        let step = 1e-4 * (end - start);
        let (a, b) = (self.screen.sample(&feature.curve, t - step).at, self.screen.sample(&feature.curve, t + step).at);
        let length = distance(a, b);
        if length.is_nan() || length <= 0.0 {
            return false;
        }
        let across = [(a[1] - b[1]) / length * LOOK_BESIDE, (b[0] - a[0]) / length * LOOK_BESIDE];
        let [x, y] = self.screen.sample(&feature.curve, t).at;
        [1.0, -1.0].into_iter().any(|side| {
            let ray = self.screen.camera.generate_ray(x + side * across[0], y + side * across[1]);
            let limit = (point - ray.origin).dot(ray.direction) + BEHIND * self.screen.pixel_length(point);
            self.geometry.intersect(&ray, limit, scratch).is_none()
        })
    }

    /// Whether nothing at all is seen in a direction: for a plane's horizon, just beside it, on that side where the plane is not.
    fn is_direction_clear(&self, feature: &Feature, p: Homogeneous3, scratch: &mut QueryScratch) -> bool {
        let direction = p.vector().normalize();
        let lift = match feature.curve {
            Curve::Conic { cos, sin, .. } => {
                cos.vector().cross(sin.vector()).normalize() * (BESIDE * self.screen.camera.pixel_angle())
            }
            _ => Vector3::ZERO,
        };
        [direction + lift, direction - lift].into_iter().any(|direction| {
            let ray = self.ray_to(Homogeneous3::direction(direction));
            ray.is_some_and(|ray| !self.geometry.is_blocked(&ray, f64::INFINITY, scratch))
        })
    }

    /// The camera's ray through the picture of a point.
    fn ray_to(&self, p: Homogeneous3) -> Option<Ray> {
        let clip = self.screen.clip(p);
        let [x, y] = self.screen.raster(clip);
        (clip.h() > 0.0 && x.is_finite() && y.is_finite()).then(|| self.screen.camera.generate_ray(x, y))
    }
}

/// A track by the length of its picture.
struct Route<'a> {
    track: &'a [Sample],
    /// From the beginning to each sample.
    lengths: Vec<f64>,
}

impl<'a> Route<'a> {
    fn new(track: &'a [Sample]) -> Self {
        let mut lengths = vec![0.0];
        let mut sum = 0.0;
        for pair in track.windows(2) {
            sum += distance(pair[0].at, pair[1].at);
            lengths.push(sum);
        }
        Self { track, lengths }
    }

    fn total(&self) -> f64 {
        self.lengths.last().copied().unwrap_or(0.0)
    }

    /// The curve's parameter at a length. On a straight picture equal lengths are not equal steps of the parameter, but their
    /// homogeneous coordinates say how they go together.
    fn parameter(&self, length: f64) -> f64 {
        let index = self.lengths.partition_point(|l| *l <= length).clamp(1, self.lengths.len().max(2) - 1);
        let (Some(a), Some(b)) = (self.track.get(index - 1), self.track.get(index)) else { return self.track[0].t };
        let span = self.lengths[index] - self.lengths[index - 1];
        let share = if span > 0.0 { ((length - self.lengths[index - 1]) / span).clamp(0.0, 1.0) } else { 0.0 };
        let weighted = share * a.h / ((1.0 - share) * b.h + share * a.h);
        a.t + (b.t - a.t) * if weighted.is_finite() { weighted } else { share }
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let (x, y) = (b[0] - a[0], b[1] - a[1]);
    (x * x + y * y).sqrt()
}

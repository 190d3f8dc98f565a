//! From curves in the world to their pictures: clipped in homogeneous coordinates, divided, and followed in the raster.
//!
//! Raster coordinates as [`Camera`] has them: pixels, x to the right, y down, (0, 0) the upper left corner.

use std::f64::consts::TAU;

use snell_math::{Bounds3, Homogeneous3, Matrix4, Point3, portable};

use crate::camera::{Camera, Projection};
use crate::outline::Curve;
use crate::viewing::{Pipeline, Rectangle, RectangleMap, Side, ViewingError, clip_segment_to};

/// How far the picture of a curve may be from the straight pieces that it is followed by, in pixels.
const FLATNESS: f64 = 0.02;
/// How often a piece is halved at most to come that close.
const MOST_HALVINGS: u32 = 12;
/// How near to the eye things are drawn where the camera has no near plane, relative to the scene's size.
const NEAREST: f64 = 1e-6;
/// In how many pieces a curve is looked at first that is no line and no conic.
const FIRST_PIECES: usize = 192;

/// A camera's picture, as curves are drawn on it.
#[derive(Debug)]
pub struct Screen<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// Its matrices, between the planes that were chosen.
    pub pipeline: Pipeline,
    clip_from_world: Matrix4,
    raster_from_canonical: RectangleMap,
    sides: Vec<Side>,
}

/// A point on the picture of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The curve's parameter.
    pub t: f64,
    /// Raster position.
    pub at: [f64; 2],
    /// What its homogeneous coordinates were divided by: shares of a straight picture and of the parameter differ by it.
    pub h: f64,
}

impl<'a> Screen<'a> {
    /// Of a camera, for a scene whose finite part is in a box.
    ///
    /// # Errors
    /// [`ViewingError`], where the camera's own planes make no volume.
    pub fn new(camera: &'a Camera, scene: &Bounds3) -> Result<Self, ViewingError> {
        let [near, far] = planes(camera, scene);
        let pipeline = camera.pipeline(near, far)?;
        // Without a far plane, what is beyond the one that was chosen is drawn too, up to the horizon.
        let has_far = camera.planes()[1].is_finite();
        let sides = Side::ALL.into_iter().filter(|side| has_far || *side != Side::Far).collect();
        let [low, high] = [[-1.0, -1.0], [1.0, 1.0]].map(|corner| {
            let pixel = pipeline.pixel.map(Point3::new(corner[0], corner[1], 0.0));
            camera.raster_from_pixel([pixel.x(), pixel.y()])
        });
        let raster = Rectangle { left: low[0], right: high[0], bottom: low[1], top: high[1] };
        let raster_from_canonical = RectangleMap::new(&Rectangle::new(-1.0, 1.0, -1.0, 1.0), &raster)?;
        Ok(Self { camera, clip_from_world: pipeline.clip_from_world(), raster_from_canonical, sides, pipeline })
    }

    /// The point that rays come from, or the direction towards the viewer.
    pub fn eye(&self) -> Homogeneous3 {
        match self.camera.projection() {
            Projection::Perspective => self.camera.eye().into(),
            Projection::Orthographic => Homogeneous3::direction(self.camera.axes()[2]),
        }
    }

    /// How long a pixel is at a point of the world, across the view.
    pub fn pixel_length(&self, p: Point3) -> f64 {
        let window = self.camera.window();
        let per_pixel = window.width() / f64::from(self.pipeline.pixels[0]);
        match self.camera.projection() {
            Projection::Perspective => per_pixel * -(p - self.camera.eye()).dot(self.camera.axes()[2]).min(-1e-300),
            Projection::Orthographic => per_pixel,
        }
    }

    /// A point before it is divided.
    #[inline]
    pub fn clip(&self, p: Homogeneous3) -> Homogeneous3 {
        self.clip_from_world.map(p)
    }

    /// Where what was clipped appears.
    #[inline]
    pub fn raster(&self, clip: Homogeneous3) -> [f64; 2] {
        self.raster_from_canonical.point([clip.x() / clip.h(), clip.y() / clip.h()])
    }

    /// The raster coordinates times h, and h, of coordinates before the division: linear, for whoever wants the picture of a conic.
    pub fn raster_times_h(&self, clip: Homogeneous3) -> [f64; 3] {
        let [sx, sy] = self.raster_from_canonical.scale();
        let [x, y] = self.raster_from_canonical.point([0.0, 0.0]);
        [sx * clip.x() + x * clip.h(), sy * clip.y() + y * clip.h(), clip.h()]
    }

    /// The picture of a curve's point.
    #[inline]
    pub fn sample(&self, curve: &Curve, t: f64) -> Sample {
        let clip = self.clip(curve.point(t));
        Sample { t, at: self.raster(clip), h: clip.h() }
    }

    fn is_inside(&self, clip: Homogeneous3) -> bool {
        clip.h() > 0.0 && self.sides.iter().all(|side| side.distance(clip) >= 0.0)
    }

    /// The parts of a curve inside of the view volume, as parameters, in order.
    pub fn intervals(&self, curve: &Curve) -> Vec<[f64; 2]> {
        match curve {
            Curve::Segment { a, b } => {
                let clipped = clip_segment_to(self.clip(*a), self.clip(*b), &self.sides);
                clipped.map(|part| [part.from, part.to]).into_iter().collect()
            }
            Curve::Conic { center, cos, sin, start, end } => {
                let [c, a, b] = [center, cos, sin].map(|p| self.clip(*p));
                let mut cuts = Vec::new();
                for side in &self.sides {
                    let [c, a, b] = [c, a, b].map(|p| side.distance(p));
                    cuts.extend(circle_roots(c, a, b, *start, *end));
                }
                self.between_cuts(curve, cuts, [*start, *end])
            }
            Curve::Polyline(points) => {
                let clip: Vec<Homogeneous3> = points.iter().map(|p| self.clip((*p).into())).collect();
                let mut parts: Vec<[f64; 2]> = Vec::new();
                for (index, pair) in clip.windows(2).enumerate() {
                    let Some(part) = clip_segment_to(pair[0], pair[1], &self.sides) else { continue };
                    let [from, to] = [part.from, part.to].map(|t| index as f64 + t);
                    match parts.last_mut() {
                        Some(last) if last[1] == from => last[1] = to,
                        _ => parts.push([from, to]),
                    }
                }
                parts
            }
            Curve::Torus(_) => {
                let [start, end] = curve.domain();
                let at = |index: usize| start + (end - start) * index as f64 / FIRST_PIECES as f64;
                let inside = |t: f64| self.is_inside(self.clip(curve.point(t)));
                let mut cuts = Vec::new();
                let mut before = inside(start);
                for index in 1..=FIRST_PIECES {
                    let after = inside(at(index));
                    if before != after {
                        let (mut low, mut high) = (at(index - 1), at(index));
                        for _ in 0..60 {
                            let middle = 0.5 * (low + high);
                            if inside(middle) == before { low = middle } else { high = middle }
                        }
                        cuts.push(if before { low } else { high });
                    }
                    before = after;
                }
                self.between_cuts(curve, cuts, [start, end])
            }
        }
    }

    /// The parts between cuts whose middle is inside, joined where they meet.
    fn between_cuts(&self, curve: &Curve, mut cuts: Vec<f64>, [start, end]: [f64; 2]) -> Vec<[f64; 2]> {
        cuts.extend([start, end]);
        cuts.sort_by(f64::total_cmp);
        let mut parts: Vec<[f64; 2]> = Vec::new();
        for pair in cuts.windows(2).filter(|pair| pair[0] < pair[1]) {
            if !self.is_inside(self.clip(curve.point(0.5 * (pair[0] + pair[1])))) {
                continue;
            }
            match parts.last_mut() {
                Some(last) if last[1] == pair[0] => last[1] = pair[1],
                _ => parts.push([pair[0], pair[1]]),
            }
        }
        parts
    }

    /// A part of a curve, followed in the picture by pieces that are straight but for [`FLATNESS`]: the pieces' ends.
    pub fn track(&self, curve: &Curve, [from, to]: [f64; 2]) -> Vec<Sample> {
        let first = self.sample(curve, from);
        let mut samples = vec![first];
        match curve {
            Curve::Segment { .. } => samples.push(self.sample(curve, to)),
            Curve::Polyline(_) => {
                let mut index = (from.floor() + 1.0).min(to);
                while index < to {
                    samples.push(self.sample(curve, index));
                    index += 1.0;
                }
                samples.push(self.sample(curve, to));
            }
            Curve::Conic { .. } | Curve::Torus(_) => {
                let whole = if let Curve::Conic { .. } = curve { 16.0 } else { 64.0 };
                let pieces = (whole * (to - from) / TAU).ceil().clamp(1.0, whole) as usize;
                let mut last = first;
                for index in 1..=pieces {
                    let t = if index == pieces { to } else { from + (to - from) * index as f64 / pieces as f64 };
                    let next = self.sample(curve, t);
                    self.halve(curve, last, next, 0, &mut samples);
                    last = next;
                }
            }
        }
        samples
    }

    /// Appends the samples after `a` up to `b`.
    fn halve(&self, curve: &Curve, a: Sample, b: Sample, depth: u32, samples: &mut Vec<Sample>) {
        let middle = self.sample(curve, 0.5 * (a.t + b.t));
        if depth < MOST_HALVINGS && off_chord(middle.at, a.at, b.at) > FLATNESS {
            self.halve(curve, a, middle, depth + 1, samples);
            self.halve(curve, middle, b, depth + 1, samples);
        } else {
            samples.push(b);
        }
    }
}

/// The distance of a point from the straight line through two others; from one of them where they are one.
fn off_chord(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let (px, py) = (p[0] - a[0], p[1] - a[1]);
    let squared = dx * dx + dy * dy;
    if squared < 1e-12 { (px * px + py * py).sqrt() } else { (dx * py - dy * px).abs() / squared.sqrt() }
}

/// Between which planes the matrices of a camera are taken: its own ones, or else such that the scene is between them.
pub fn planes(camera: &Camera, scene: &Bounds3) -> [f64; 2] {
    let [own_near, own_far] = camera.planes();
    let depth = |index: usize| (scene.corner(index) - camera.eye()).dot(camera.axes()[2]);
    let (mut nearest, mut farthest) = (f64::NEG_INFINITY, f64::INFINITY);
    if scene.is_finite() {
        for index in 0..8 {
            nearest = nearest.max(depth(index));
            farthest = farthest.min(depth(index));
        }
    }
    let size = if farthest.is_finite() { farthest.abs().max(nearest.abs()).max(1e-9) } else { 1.0 };
    let near = match camera.projection() {
        Projection::Perspective if own_near >= 0.0 => -NEAREST * size,
        _ => own_near,
    };
    let far = if own_far.is_finite() { own_far } else { farthest.min(near - size) };
    [near, if far < near { far } else { near - size }]
}

/// The planes that a camera's matrices are shown with: its own ones, or else round about the scene, not too close to the eye.
pub fn shown_planes(camera: &Camera, scene: &Bounds3) -> [f64; 2] {
    let [own_near, own_far] = camera.planes();
    let [_, far] = planes(camera, scene);
    let far = if own_far.is_finite() { own_far } else { 1.05 * far };
    let is_perspective = camera.projection() == Projection::Perspective;
    let depth = |index: usize| (scene.corner(index) - camera.eye()).dot(camera.axes()[2]);
    let nearest = if scene.is_finite() { (0..8).map(depth).fold(f64::NEG_INFINITY, f64::max) } else { far };
    match own_near {
        near if near < 0.0 || !is_perspective => [near, far],
        // The scene may reach behind the eye.
        _ => [(0.95 * nearest).min(0.02 * far), far],
    }
}

/// Where c + a cos θ + b sin θ is 0 within an interval of at most a full turn.
fn circle_roots(c: f64, a: f64, b: f64, start: f64, end: f64) -> Vec<f64> {
    let radius = (a * a + b * b).sqrt();
    if radius.is_nan() || radius <= c.abs() {
        return Vec::new();
    }
    let (middle, half) = (portable::atan2(b, a), portable::acos(-c / radius));
    let mut roots = Vec::new();
    for root in [middle - half, middle + half] {
        let turned = root + ((start - root) / TAU).ceil() * TAU;
        if turned <= end {
            roots.push(turned);
        }
    }
    roots
}

//! Points along a curve, so many that the lines between them are true to it on the page, with breaks where it has poles, jumps or
//! no value.
//!
//! Intervals of the parameter are halved until the curve between their ends is straight. What does not become straight, however
//! small the interval, is a jump if halving leaves the distance of its ends as large as it was. World coordinates in and out;
//! straightness is measured on the page, in millimetres.

use crate::viewing::{Rectangle, Viewing2};

/// How far the lines may be from the curve, mm: half of what is promised, as it is measured at some points only.
const TOLERANCE: f64 = 0.008;
/// Intervals at the beginning.
const INTERVALS: u32 = 300;
/// How often one of them is halved.
const HALVINGS: u32 = 12;
/// Jumps of less than fifty times this are drawn as if they were none, mm.
const SMALLEST_JUMP: f64 = 0.001;

/// A point of a curve and its parameter; `None` where it has no value.
#[derive(Clone, Copy, Debug)]
struct Sample {
    t: f64,
    world: Option<[f64; 2]>,
}

/// Points of a curve.
pub(super) struct Sampler<'a, F> {
    point: F,
    viewing: &'a Viewing2,
    window: Rectangle,
    evaluations: usize,
    most: usize,
    lines: Vec<Vec<[f64; 2]>>,
}

/// The curve t ↦ `point(t)` as lines in world coordinates, each in one stroke. Parts outside of the window may be coarse; so
/// may be all once `most` points have been computed.
pub(super) fn sample<F: Fn(f64) -> [f64; 2]>(
    point: F,
    from: f64,
    to: f64,
    viewing: &Viewing2,
    most: usize,
) -> Vec<Vec<[f64; 2]>> {
    let mut sampler =
        Sampler { point, viewing, window: viewing.window(), evaluations: 0, most, lines: vec![Vec::new()] };
    let mut before = sampler.at(from);
    sampler.emit(before);
    for i in 1..=INTERVALS {
        let t = if i == INTERVALS { to } else { from + (to - from) * (f64::from(i) / f64::from(INTERVALS)) };
        let next = sampler.at(t);
        sampler.interval(before, next, HALVINGS);
        before = next;
    }
    sampler.lines.retain(|line| line.len() >= 2);
    sampler.lines
}

impl<F: Fn(f64) -> [f64; 2]> Sampler<'_, F> {
    fn at(&mut self, t: f64) -> Sample {
        self.evaluations += 1;
        let world = (self.point)(t);
        if !world.iter().all(|coordinate| coordinate.is_finite()) {
            return Sample { t, world: None };
        }
        // Far outside of the window it does not matter how far, but differences must stay finite.
        let limit = |value: f64, low: f64, high: f64| {
            let far = 1e9 * (high - low).abs();
            value.clamp(low.min(high) - far, low.max(high) + far)
        };
        let w = &self.window;
        Sample { t, world: Some([limit(world[0], w.left, w.right), limit(world[1], w.bottom, w.top)]) }
    }

    fn emit(&mut self, sample: Sample) {
        match (sample.world, self.lines.last_mut()) {
            (Some(world), Some(line)) => line.push(world),
            _ => self.lift(),
        }
    }

    /// Ends the line.
    fn lift(&mut self) {
        if self.lines.last().is_some_and(|line| !line.is_empty()) {
            self.lines.push(Vec::new());
        }
    }

    /// All points after `a` up to `b`.
    fn interval(&mut self, a: Sample, b: Sample, halvings: u32) {
        let (Some(pa), Some(pb)) = (a.world, b.world) else {
            if a.world.is_none() && b.world.is_none() {
                return self.lift();
            }
            let (inside, outside) = self.bisect(a, b, |_, _, middle| middle.world.is_some() == a.world.is_some());
            // `inside` is like a, `outside` like b; the one with a value is the curve's end.
            if a.world.is_some() {
                self.interval(a, inside, halvings);
                self.lift();
            } else {
                self.lift();
                self.emit(outside);
                self.interval(outside, b, halvings);
            }
            return;
        };
        if a.t >= b.t || self.outside(pa, pb) || self.evaluations > self.most {
            return self.emit(b);
        }
        let middle = self.at(0.5 * (a.t + b.t));
        if halvings == 0 {
            return self.jump_or_line(a, b);
        }
        if let Some(pm) = middle.world
            && self.is_between(pm, pa, pb)
        {
            let quarters = [self.at(0.75 * a.t + 0.25 * b.t), self.at(0.25 * a.t + 0.75 * b.t)];
            let is_straight = [middle, quarters[0], quarters[1]]
                .iter()
                .all(|sample| sample.world.is_some_and(|p| self.distance(p, pa, pb) < TOLERANCE));
            if is_straight {
                return self.emit(b);
            }
        }
        self.interval(a, middle, halvings - 1);
        self.interval(middle, b, halvings - 1);
    }

    /// An interval that is as small as it may become and still not straight.
    fn jump_or_line(&mut self, a: Sample, b: Sample) {
        let gap = |this: &Self, a: Sample, b: Sample| match (a.world, b.world) {
            (Some(a), Some(b)) => this.length(a, b),
            _ => f64::INFINITY,
        };
        let (before, after) =
            self.bisect(a, b, |this, [low, high], middle| gap(this, middle, high) >= gap(this, low, middle));
        if gap(self, before, after) > 0.5 * gap(self, a, b).min(1.0) {
            // Steep parts on both sides lead to the border of the window, or to the step's ends.
            if before.world.is_some() {
                self.emit(before);
            }
            self.lift();
            if after.world.is_some() {
                self.emit(after);
            }
        }
        self.emit(b);
    }

    /// Two parameters next to each other, at the end of halving the interval and going on with its upper half where `upper` says so.
    fn bisect(&mut self, a: Sample, b: Sample, upper: impl Fn(&Self, [Sample; 2], Sample) -> bool) -> (Sample, Sample) {
        let (mut low, mut high) = (a, b);
        for _ in 0..80 {
            let t = 0.5 * (low.t + high.t);
            if t <= low.t || t >= high.t {
                break;
            }
            let middle = self.at(t);
            if upper(self, [low, high], middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        (low, high)
    }

    /// True where a segment is on the far side of one side of the window.
    fn outside(&self, a: [f64; 2], b: [f64; 2]) -> bool {
        let w = &self.window;
        let beyond = |a: f64, b: f64, low: f64, high: f64| a.max(b) < low.min(high) || a.min(b) > low.max(high);
        beyond(a[0], b[0], w.left, w.right) || beyond(a[1], b[1], w.bottom, w.top)
    }

    /// True where the middle of an interval is not at one of its ends on the page, as it is with a jump in it.
    fn is_between(&self, middle: [f64; 2], a: [f64; 2], b: [f64; 2]) -> bool {
        let least = 0.02 * self.length(a, b);
        least < SMALLEST_JUMP || self.length(a, middle) > least && self.length(middle, b) > least
    }

    /// The distance of two points on the page.
    fn length(&self, a: [f64; 2], b: [f64; 2]) -> f64 {
        let (a, b) = (self.viewing.point(a), self.viewing.point(b));
        let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        (dx * dx + dy * dy).sqrt()
    }

    /// How far a point is from a segment on the page.
    fn distance(&self, p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
        distance_to_segment(self.viewing.point(p), self.viewing.point(a), self.viewing.point(b))
    }
}

pub(super) fn distance_to_segment(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (u, v) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = u[0] * u[0] + u[1] * u[1];
    let along = if square > 0.0 { ((u[0] * v[0] + u[1] * v[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    let [dx, dy] = [v[0] - along * u[0], v[1] - along * u[1]];
    (dx * dx + dy * dy).sqrt()
}

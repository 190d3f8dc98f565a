//! Axes, ticks, their labels, and the grid.
//!
//! Where an axis crosses the picture, numbers stand beside it as in textbooks; where the plot has a frame, or the axis lies at the
//! window's border, they stand outside of the window.

use snell_scene::scene::{Axis, AxisPlace};

use super::Sheet;
use super::pen::{self, ARROW, INK, LETTERS, segments, stroke, text};
use super::ticks::{Tick, ticks};
use crate::vector::{Horizontal, Item, Vertical};

/// The width of axes, mm.
const AXIS: f64 = 0.3;
/// Half the length of ticks, mm.
const TICK: f64 = 0.8;
/// From ticks to their labels, mm.
const GAP: f64 = 0.9;
/// How far an axis with an arrowhead goes beyond the window, mm.
const BEYOND: f64 = 5.0;
/// The least distance of ticks along x and along y, mm.
const DISTANCE: [f64; 2] = [14.0, 9.0];
/// The colour of the grid.
const GRID: [u8; 3] = [205; 3];

/// Where an axis lies.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    /// The other coordinate, in the world.
    world: f64,
    /// And on the page.
    page: f64,
    /// At the window's lower or left border, and at its upper or right one.
    border: [bool; 2],
}

impl Sheet<'_> {
    /// The ticks along an axis, 0 for x and 1 for y.
    fn ticks(&self, along: usize) -> Vec<Tick> {
        let window = &self.plot.window;
        let (axis, from, to, length) = if along == 0 {
            (&self.plot.x, window.left, window.right, self.place.width().abs())
        } else {
            (&self.plot.y, window.bottom, window.top, self.place.height().abs())
        };
        ticks(&axis.ticks, axis.pi, from, to, (to - from) * (DISTANCE[along] / length).min(1.0))
    }

    /// Where on the page, along an axis, something is.
    fn page(&self, along: usize, at: f64) -> f64 {
        let window = &self.plot.window;
        self.viewing.point(if along == 0 { [at, window.bottom] } else { [window.left, at] })[along]
    }

    fn place_of(&self, along: usize) -> Place {
        let window = &self.plot.window;
        let (axis, low, high) = if along == 0 {
            (&self.plot.x, window.bottom, window.top)
        } else {
            (&self.plot.y, window.left, window.right)
        };
        let world = match axis.at {
            AxisPlace::At(at) => at.clamp(low, high),
            AxisPlace::Border => low,
        };
        Place { world, page: self.page(1 - along, world), border: [world == low, world == high] }
    }

    pub(super) fn grid(&self) -> Vec<Item> {
        if !self.plot.grid {
            return Vec::new();
        }
        let place = &self.place;
        let mut ends = Vec::new();
        for tick in self.ticks(0) {
            let x = self.page(0, tick.at);
            ends.push([[x, place.bottom], [x, place.top]]);
        }
        for tick in self.ticks(1) {
            let y = self.page(1, tick.at);
            ends.push([[place.left, y], [place.right, y]]);
        }
        segments(&ends, stroke(GRID, 0.15)).into_iter().collect()
    }

    pub(super) fn axes(&self) -> Vec<Item> {
        let mut items = Vec::new();
        for (along, axis) in [&self.plot.x, &self.plot.y].into_iter().enumerate() {
            if axis.show {
                self.axis(along, axis, &mut items);
            }
        }
        items
    }

    /// How far above the window the name of the y axis stands, mm.
    pub(super) fn name_above(&self) -> f64 {
        if self.plot.y.arrow { BEYOND + 1.2 } else { 3.0 }
    }

    fn axis(&self, along: usize, axis: &Axis, items: &mut Vec<Item>) {
        let place = self.place_of(along);
        // A point of the page by how far along the axis and how far across.
        let point = |a: f64, b: f64| if along == 0 { [a, b] } else { [b, a] };
        // Page coordinates along y run down.
        let (from, to, onward) = if along == 0 {
            (self.place.left, self.place.right, 1.0)
        } else {
            (self.place.bottom, self.place.top, -1.0)
        };
        let tip = if axis.arrow { to + onward * BEYOND } else { to };
        let line_end = if axis.arrow { tip - onward * 0.7 * ARROW } else { tip };
        let mut ends = vec![[point(from, place.page), point(line_end, place.page)]];
        let ticks = self.ticks(along);
        let outside = self.plot.frame || place.border != [false, false];
        // Labels are below or to the left, unless the axis lies at the other side.
        let (label_border, label_side) = match (outside, place.border, along) {
            (true, [false, true], 0) => (self.place.top, -1.0),
            (true, [false, true], _) => (self.place.right, 1.0),
            (true, _, 0) => (self.place.bottom, 1.0),
            (true, ..) => (self.place.left, -1.0),
            (false, _, 0) => (place.page, 1.0),
            (false, ..) => (place.page, -1.0),
        };
        for tick in &ticks {
            let at = self.page(along, tick.at);
            ends.push([point(at, place.page - TICK), point(at, place.page + TICK)]);
            if label_border != place.page {
                ends.push([point(at, label_border), point(at, label_border + label_side * TICK)]);
            }
            if !outside && self.crossed_at(along, tick.at) {
                continue;
            }
            let label_at = point(at, label_border + label_side * (TICK + GAP));
            let anchor = match (along, label_side > 0.0) {
                (0, true) => (Horizontal::Center, Vertical::Top),
                (0, false) => (Horizontal::Center, Vertical::Baseline),
                (_, true) => (Horizontal::Left, Vertical::Middle),
                (_, false) => (Horizontal::Right, Vertical::Middle),
            };
            items.push(text(&tick.label, label_at, LETTERS, INK, anchor));
        }
        items.splice(0..0, segments(&ends, stroke(INK, AXIS)));
        if axis.arrow {
            items.extend(pen::arrow_head(point(tip, place.page), point(from, place.page), ARROW, INK));
        }
        if let Some(name) = &axis.label {
            items.push(if along == 0 {
                let gap = if axis.arrow { 1.4 } else { 2.0 };
                let anchor = (Horizontal::Left, Vertical::Middle);
                text(name, [tip + gap, place.page], LETTERS, INK, anchor)
            } else {
                let anchor = (Horizontal::Center, Vertical::Baseline);
                text(name, [place.page, self.place.top - self.name_above()], LETTERS, INK, anchor)
            });
        }
    }

    /// True where the other axis crosses this one, so that a label there would lie on it.
    fn crossed_at(&self, along: usize, at: f64) -> bool {
        let other = if along == 0 { &self.plot.y } else { &self.plot.x };
        let place = self.place_of(1 - along);
        other.show && (self.page(along, at) - place.page).abs() < 0.5
    }
}

//! Two-dimensional viewing: windows, viewports and devices, and the map of one rectangle onto another that joins them.
//!
//! A *window* is a rectangle of world coordinates, a *viewport* one of normalized device coordinates, [0, 1]² with y up, and a
//! *device* has physical coordinates, in whatever unit it counts.

use snell_math::lanes::Lanes;

/// A rectangle with sides along the axes. A map onto it takes `left` to `left` and `bottom` to `bottom`, so one that is turned
/// over (`bottom` above `top` in numbers, as on a device whose y runs down) is as good as any.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// x of the left side.
    pub left: f64,
    /// x of the right side.
    pub right: f64,
    /// y of the bottom side.
    pub bottom: f64,
    /// y of the top side.
    pub top: f64,
}

/// What keeps a viewing transformation from being made; names the value that is wrong.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ViewingError {
    /// A number is NaN or infinite.
    #[error("{what} is {value}, which is no finite number")]
    NotFinite {
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A side has no length, or both ends are so close that they are one.
    #[error("{what} is empty: it goes from {from} to {to}")]
    Empty {
        /// Which extent.
        what: &'static str,
        /// Where it begins.
        from: f64,
        /// Where it ends.
        to: f64,
    },
    /// A picture without pixels.
    #[error("the picture has {width} × {height} pixels")]
    NoPixels {
        /// Pixels in x.
        width: f64,
        /// Pixels in y.
        height: f64,
    },
    /// The near plane is not before the eye.
    #[error("the near plane z = {near} is not before the eye: it must be negative, as the camera looks along −z")]
    NearNotBeforeEye {
        /// n.
        near: f64,
    },
    /// The far plane is not beyond the near plane.
    #[error(
        "the far plane z = {far} is not beyond the near plane z = {near}: it must be below it, as the camera looks along −z"
    )]
    FarNotBeyondNear {
        /// n.
        near: f64,
        /// f.
        far: f64,
    },
    /// The eye is on the image plane or on its wrong side.
    #[error("the eye is {distance} before the image plane, but must be before it by a positive, finite distance")]
    EyeNotBeforePlane {
        /// n.
        distance: f64,
    },
    /// A vector without a direction.
    #[error("{what} is ({x}, {y}, {z}), which has no direction")]
    NoDirection {
        /// Which vector.
        what: &'static str,
        /// Its x.
        x: f64,
        /// Its y.
        y: f64,
        /// Its z.
        z: f64,
    },
    /// Gaze and up are parallel.
    #[error("the gaze ({}, {}, {}) is parallel to the up vector ({}, {}, {})", gaze[0], gaze[1], gaze[2], up[0], up[1], up[2])]
    Parallel {
        /// g.
        gaze: [f64; 3],
        /// t.
        up: [f64; 3],
    },
}

impl Rectangle {
    /// The unit square: all of a device in normalized device coordinates.
    pub const UNIT: Self = Self { left: 0.0, right: 1.0, bottom: 0.0, top: 1.0 };

    /// From its sides, in the order of the lecture's [l, r] × [b, t].
    pub const fn new(left: f64, right: f64, bottom: f64, top: f64) -> Self {
        Self { left, right, bottom, top }
    }

    /// right − left; negative where it is turned around.
    #[inline]
    pub fn width(&self) -> f64 {
        self.right - self.left
    }

    /// top − bottom; negative where it is turned over.
    #[inline]
    pub fn height(&self) -> f64 {
        self.top - self.bottom
    }

    /// True where a point lies inside or on the border.
    pub fn contains(&self, [x, y]: [f64; 2]) -> bool {
        let within = |v: f64, a: f64, b: f64| a.min(b) <= v && v <= a.max(b);
        within(x, self.left, self.right) && within(y, self.bottom, self.top)
    }

    /// The part of the segment from `a` to `b` inside this rectangle, border included; `None` where there is none. A segment of no
    /// length is a point. Liang and Barsky, "A New Concept and Method for Line Clipping", ACM TOG 3(1), 1984.
    ///
    /// ```
    /// use snell::viewing::Rectangle;
    /// let window = Rectangle::new(0.0, 4.0, 0.0, 2.0);
    /// assert_eq!(window.clip([-2.0, 1.0], [6.0, 1.0]), Some([[0.0, 1.0], [4.0, 1.0]]));
    /// assert_eq!(window.clip([-2.0, 1.0], [1.0, 5.0]), None);
    /// ```
    pub fn clip(&self, a: [f64; 2], b: [f64; 2]) -> Option<[[f64; 2]; 2]> {
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        let sides = [
            (0, self.left.min(self.right), 1.0),
            (0, self.left.max(self.right), -1.0),
            (1, self.bottom.min(self.top), 1.0),
            (1, self.bottom.max(self.top), -1.0),
        ];
        for (axis, side, sign) in sides {
            // Distances into the rectangle from its side, which run linearly along the segment.
            let (from, to) = (sign * (a[axis] - side), sign * (b[axis] - side));
            if from.is_nan() || to.is_nan() || from < 0.0 && to < 0.0 {
                return None;
            }
            if from < 0.0 {
                enter = enter.max(from / (from - to));
            } else if to < 0.0 {
                leave = leave.min(from / (from - to));
            }
        }
        if enter > leave {
            return None;
        }
        let at = |t: f64| {
            if t == 0.0 {
                a
            } else if t == 1.0 {
                b
            } else {
                [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t]
            }
        };
        Some([at(enter), at(leave)])
    }

    fn check(&self, horizontal: &'static str, vertical: &'static str) -> Result<(), ViewingError> {
        for (value, what) in [(self.left, "left"), (self.right, "right"), (self.bottom, "bottom"), (self.top, "top")] {
            if !value.is_finite() {
                return Err(ViewingError::NotFinite { what, value });
            }
        }
        for (what, from, to) in [(horizontal, self.left, self.right), (vertical, self.bottom, self.top)] {
            let size = to - from;
            if size == 0.0 || !size.is_finite() || !(1.0 / size).is_finite() {
                return Err(ViewingError::Empty { what, from, to });
            }
        }
        Ok(())
    }
}

/// The map of one rectangle onto another: move its corner to the origin, scale, move out.
///
/// The lecture's example: y = cos x from 0 to 2π, its window [0, 2π] × [−1, 1], into a viewport of a device.
///
/// ```
/// use std::f64::consts::PI;
/// use snell::viewing::{Rectangle, RectangleMap};
/// let window = Rectangle::new(0.0, 2.0 * PI, -1.0, 1.0);
/// let viewport = Rectangle::new(0.25, 0.75, 0.5, 1.0);
/// let map = RectangleMap::new(&window, &viewport)?;
/// assert_eq!(map.point([0.0, 1.0]), [0.25, 1.0]); // cos 0 = 1
/// assert_eq!(map.point([PI, -1.0]), [0.5, 0.5]); // cos π = −1
/// assert_eq!(map.inverse().point([0.5, 0.5]), [PI, -1.0]);
/// # Ok::<(), snell::viewing::ViewingError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RectangleMap {
    from: Rectangle,
    to: Rectangle,
}

impl RectangleMap {
    /// Takes `from.left` to `to.left`, `from.right` to `to.right`, `from.bottom` to `to.bottom`, `from.top` to `to.top`.
    ///
    /// # Errors
    /// [`ViewingError`] where one of them is empty or not finite.
    pub fn new(from: &Rectangle, to: &Rectangle) -> Result<Self, ViewingError> {
        from.check("the width to be mapped", "the height to be mapped")?;
        to.check("the width to map onto", "the height to map onto")?;
        Ok(Self { from: *from, to: *to })
    }

    /// Where a point goes.
    #[inline]
    pub fn point(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        self.point_lanes([x, y])
    }

    /// As [`RectangleMap::point`], side by side.
    #[inline(always)]
    pub(crate) fn point_lanes<L: Lanes>(&self, [x, y]: [L; 2]) -> [L; 2] {
        let Self { from, to } = self;
        [
            L::splat(to.left) + L::splat(to.width()) * ((x - L::splat(from.left)) / L::splat(from.width())),
            L::splat(to.bottom) + L::splat(to.height()) * ((y - L::splat(from.bottom)) / L::splat(from.height())),
        ]
    }

    /// The map back.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self { from: self.to, to: self.from }
    }

    /// By how much lengths along x and along y grow.
    pub fn scale(&self) -> [f64; 2] {
        [self.to.width() / self.from.width(), self.to.height() / self.from.height()]
    }

    /// The 3 × 3 matrix that does the same to (x, y, 1): rows.
    ///
    /// ```
    /// use snell::viewing::{Rectangle, RectangleMap};
    /// let map = RectangleMap::new(&Rectangle::new(1.0, 3.0, 2.0, 4.0), &Rectangle::new(0.0, 8.0, 0.0, 6.0))?;
    /// assert_eq!(map.matrix(), [[4.0, 0.0, -4.0], [0.0, 3.0, -6.0], [0.0, 0.0, 1.0]]);
    /// # Ok::<(), snell::viewing::ViewingError>(())
    /// ```
    pub fn matrix(&self) -> [[f64; 3]; 3] {
        let [x, y] = self.scale();
        let move_x = (self.to.left * self.from.right - self.to.right * self.from.left) / self.from.width();
        let move_y = (self.to.bottom * self.from.top - self.to.top * self.from.bottom) / self.from.height();
        [[x, 0.0, move_x], [0.0, y, move_y], [0.0, 0.0, 1.0]]
    }
}

/// What happens where a window and its viewport have different proportions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fit {
    /// The window fills the viewport; circles become ellipses.
    #[default]
    Stretch,
    /// The window keeps its proportions, as large as fits, in the middle of the viewport.
    Keep,
}

/// A surface to draw on: its size, and the way its y runs. Physical device coordinates begin at 0 in a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Device {
    /// Its extent in x, in the device's unit: millimetres, pixels.
    pub width: f64,
    /// Its extent in y.
    pub height: f64,
    /// y = 0 is at the top, as on screens and pages; else at the bottom, as on plotters.
    pub y_down: bool,
}

impl Device {
    /// All of it, as a rectangle of its own coordinates.
    pub fn rectangle(&self) -> Rectangle {
        let (bottom, top) = if self.y_down { (self.height, 0.0) } else { (0.0, self.height) };
        Rectangle { left: 0.0, right: self.width, bottom, top }
    }
}

/// The two-dimensional viewing transformation: world coordinates → window → viewport → device.
///
/// ```
/// use snell::viewing::{Device, Fit, Rectangle, Viewing2};
/// let device = Device { width: 200.0, height: 100.0, y_down: true };
/// let window = Rectangle::new(-1.0, 1.0, -1.0, 1.0);
/// let left_half = Rectangle::new(0.0, 0.5, 0.0, 1.0);
/// let viewing = Viewing2::new(&window, &left_half, &device, Fit::Stretch)?;
/// assert_eq!(viewing.point([0.0, 1.0]), [50.0, 0.0]);
/// assert_eq!(viewing.segment([-5.0, 0.0], [5.0, 0.0]), Some([[0.0, 50.0], [100.0, 50.0]]));
/// # Ok::<(), snell::viewing::ViewingError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewing2 {
    window: Rectangle,
    /// What the window fills of the viewport, in normalized device coordinates.
    viewport: Rectangle,
    viewport_from_window: RectangleMap,
    device_from_viewport: RectangleMap,
}

impl Viewing2 {
    /// From a window in world coordinates, a viewport in normalized device coordinates, and the device.
    ///
    /// # Errors
    /// [`ViewingError`] where one of them is empty or not finite.
    pub fn new(window: &Rectangle, viewport: &Rectangle, device: &Device, fit: Fit) -> Result<Self, ViewingError> {
        let device_from_viewport = RectangleMap::new(&Rectangle::UNIT, &device.rectangle())?;
        // Also examines the viewport, before anything is computed with it.
        let mut viewport_from_window = RectangleMap::new(window, viewport)?;
        let mut viewport = *viewport;
        if fit == Fit::Keep {
            let [x, y] = viewport_from_window.scale();
            let (x, y) = ((x * device.width).abs(), (y * device.height).abs());
            let (shrink_x, shrink_y) = ((y / x).min(1.0), (x / y).min(1.0));
            let shrink = |from: f64, to: f64, by: f64| {
                let (middle, half) = (0.5 * (from + to), 0.5 * (to - from) * by);
                (middle - half, middle + half)
            };
            let (left, right) = shrink(viewport.left, viewport.right, shrink_x);
            let (bottom, top) = shrink(viewport.bottom, viewport.top, shrink_y);
            viewport = Rectangle { left, right, bottom, top };
            viewport_from_window = RectangleMap::new(window, &viewport)?;
        }
        Ok(Self { window: *window, viewport, viewport_from_window, device_from_viewport })
    }

    /// The window.
    pub fn window(&self) -> Rectangle {
        self.window
    }

    /// What the window fills of its viewport, in normalized device coordinates.
    pub fn viewport(&self) -> Rectangle {
        self.viewport
    }

    /// Where a point of the world appears on the device, also outside of the window.
    pub fn point(&self, p: [f64; 2]) -> [f64; 2] {
        self.device_from_viewport.point(self.viewport_from_window.point(p))
    }

    /// What is seen of a segment of the world, clipped to the window, on the device.
    pub fn segment(&self, a: [f64; 2], b: [f64; 2]) -> Option<[[f64; 2]; 2]> {
        self.window.clip(a, b).map(|ends| ends.map(|end| self.point(end)))
    }

    /// The point of the world at a place of the device.
    pub fn inverse_point(&self, p: [f64; 2]) -> [f64; 2] {
        self.viewport_from_window.inverse().point(self.device_from_viewport.inverse().point(p))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn rectangles() -> impl Strategy<Value = Rectangle> {
        (-9.0..9.0f64, 0.01..9.0f64, -9.0..9.0f64, 0.01..9.0f64, any::<[bool; 2]>()).prop_map(|(l, w, b, h, turned)| {
            let (left, right) = if turned[0] { (l + w, l) } else { (l, l + w) };
            let (bottom, top) = if turned[1] { (b + h, b) } else { (b, b + h) };
            Rectangle { left, right, bottom, top }
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn maps_lead_there_and_back(from in rectangles(), to in rectangles(), x in -20.0..20.0f64, y in -20.0..20.0f64) {
            let map = RectangleMap::new(&from, &to).expect("not empty");
            let image = map.point([x, y]);
            let back = map.inverse().point(image);
            prop_assert!((back[0] - x).abs() < 1e-10 && (back[1] - y).abs() < 1e-10);
            let [[a, _, c], [_, e, f], _] = map.matrix();
            prop_assert!((a * x + c - image[0]).abs() < 1e-7 && (e * y + f - image[1]).abs() < 1e-7);
            prop_assert_eq!(from.contains([x, y]), to.contains(image));
        }

        #[test]
        fn clipped_segments_are_what_lies_inside(window in rectangles(), ends in any::<[[i8; 2]; 2]>()) {
            let [a, b] = ends.map(|p| p.map(|c| f64::from(c) * 0.125));
            let clipped = window.clip(a, b);
            for i in 0..=64 {
                let t = f64::from(i) / 64.0;
                let p = [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t];
                if window.contains(p) {
                    let [from, to] = clipped.expect("a point inside");
                    let along = |q: [f64; 2]| (q[0] - a[0]) * (b[0] - a[0]) + (q[1] - a[1]) * (b[1] - a[1]);
                    prop_assert!(along(from) - 1e-9 <= along(p) && along(p) <= along(to) + 1e-9);
                }
            }
            if let Some(clipped) = clipped {
                let near = |q: [f64; 2]| {
                    window.left.min(window.right) - 1e-9 <= q[0] && q[0] <= window.left.max(window.right) + 1e-9
                        && window.bottom.min(window.top) - 1e-9 <= q[1] && q[1] <= window.bottom.max(window.top) + 1e-9
                };
                prop_assert!(clipped.into_iter().all(near));
            }
        }

        #[test]
        fn kept_proportions_make_circles_circles(window in rectangles(), viewport in rectangles(), w in 1.0..99.0f64) {
            let device = Device { width: w, height: 50.0, y_down: true };
            let viewing = Viewing2::new(&window, &viewport, &device, Fit::Keep).expect("not empty");
            let [o, x, y] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|p| viewing.point(p));
            prop_assert!(((x[0] - o[0]).abs() - (y[1] - o[1]).abs()).abs() < 1e-9 * w.max(50.0));
            let inside = viewing.viewport();
            for corner in [[inside.left, inside.bottom], [inside.right, inside.top]] {
                let near = [0, 1].map(|axis| corner[axis] * (1.0 - 1e-12));
                prop_assert!(viewport.contains(near) || viewport.contains(corner) || (corner[0] - near[0]).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn empty_and_infinite_rectangles_are_told_by_value() {
        let message = |r: Rectangle| RectangleMap::new(&r, &Rectangle::UNIT).unwrap_err().to_string();
        assert_eq!(message(Rectangle::new(2.0, 2.0, 0.0, 1.0)), "the width to be mapped is empty: it goes from 2 to 2");
        assert_eq!(message(Rectangle::new(0.0, 1.0, 0.0, f64::NAN)), "top is NaN, which is no finite number");
        assert_eq!(message(Rectangle::new(0.0, f64::INFINITY, 0.0, 1.0)), "right is inf, which is no finite number");
        let flat = Device { width: 0.0, height: 3.0, y_down: false };
        assert!(Viewing2::new(&Rectangle::UNIT, &Rectangle::UNIT, &flat, Fit::Keep).is_err());
    }

    #[test]
    fn a_segment_of_no_length_is_clipped_as_a_point() {
        assert_eq!(Rectangle::UNIT.clip([0.5, 0.5], [0.5, 0.5]), Some([[0.5, 0.5]; 2]));
        assert_eq!(Rectangle::UNIT.clip([1.5, 0.5], [1.5, 0.5]), None);
        assert_eq!(Rectangle::UNIT.clip([f64::NAN, 0.5], [0.5, 0.5]), None);
    }
}

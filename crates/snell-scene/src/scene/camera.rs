//! From where a scene is seen.

use snell_math::{Point3, Vector3};

use super::lens::CameraLens;

/// Position, orientation and frame. World space; right-handed; the picture's up is the projection of `up`.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// The centre of projection, which for a real lens is the middle of its entrance pupil; for an orthographic camera the point in the middle of the picture.
    pub eye: Point3,
    /// Where it looks, any positive length.
    pub gaze: Vector3,
    /// What is up, any positive length, not parallel to the gaze.
    pub up: Vector3,
    /// The projection and what of the world is in the picture.
    pub frame: Frame,
    /// A lens, which is sharp at one distance alone, where paths are traced; `None` for a pinhole. `frame` is what it shows of the
    /// plane on which it is focused, seen from `eye`.
    pub lens: Option<CameraLens>,
}

/// The projection and its window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Frame {
    /// Perspective by the angle between the picture's left and right borders, in radians, in (0, π). The height follows from
    /// the picture's aspect, with square pixels.
    HorizontalFov(f64),
    /// Perspective by the angle between the bottom and top borders, in radians.
    VerticalFov(f64),
    /// Orthographic by the width of the picture in world units; the height follows from the aspect.
    OrthographicWidth(f64),
    /// Perspective through the lecture's window [l, r] × [b, t] on the plane z = near in eye space, near < 0: l < r, b < t;
    /// pixels are as stretched as the window asks.
    PerspectiveWindow {
        /// Left border, eye space x.
        left: f64,
        /// Right border.
        right: f64,
        /// Bottom border, eye space y.
        bottom: f64,
        /// Top border.
        top: f64,
        /// The window's plane in eye space, negative. Nothing nearer to the eye is seen.
        near: f64,
        /// The far plane in eye space, below `near`. Nothing beyond is seen by a camera ray; −∞ where not given.
        far: f64,
    },
    /// Orthographic through the window [l, r] × [b, t], seeing what lies between near and far.
    OrthographicWindow {
        /// Left border, eye space x.
        left: f64,
        /// Right border.
        right: f64,
        /// Bottom border, eye space y.
        bottom: f64,
        /// Top border.
        top: f64,
        /// Where rays begin, in eye space: at most 0 as the lecture has it, though positive values work.
        near: f64,
        /// Where they end, below `near`; −∞ where not given.
        far: f64,
    },
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            eye: Point3::new(0.0, 0.0, 5.0),
            gaze: Vector3::new(0.0, 0.0, -1.0),
            up: Vector3::Y,
            frame: Frame::HorizontalFov(snell_math::portable::radians(40.0)),
            lens: None,
        }
    }
}

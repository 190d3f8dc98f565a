//! One camera: rays for the tracer ([`Camera::generate_ray`]) and the way back for drawing ([`Camera::project`]).
//!
//! Raster coordinates are continuous, x to the right and y down, (0, 0) at the picture's top left corner; pixel (i, j)
//! covers [i, i + 1) × [j, j + 1). Eye space is right-handed: x right (u), y up (v), looking along −z (w = −gaze), as in
//! Shirley et al., *Fundamentals of Computer Graphics*, chapter 7.

use snell_math::{Point3, Ray, Vector3, portable};
use snell_scene::scene;

/// A camera for a picture of a given size. World space.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    eye: Point3,
    right: Vector3,
    up: Vector3,
    back: Vector3,
    projection: Projection,
    window: Window,
    near: f64,
    far: f64,
    cells: [f64; 2],
    shift: f64,
}

/// How points reach the window's plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// Along lines through the eye; the window lies on the plane z = −1 of eye space.
    Perspective,
    /// Along lines parallel to the gaze.
    Orthographic,
}

/// The part of the window's plane that the picture shows, in eye space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// x of the left border.
    pub left: f64,
    /// x of the right border.
    pub right: f64,
    /// y of the bottom border.
    pub bottom: f64,
    /// y of the top border.
    pub top: f64,
}

/// Where a world point appears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RasterPoint {
    /// Raster x, to the right.
    pub x: f64,
    /// Raster y, down.
    pub y: f64,
    /// Distance from the eye along the gaze, in world units: positive before the camera.
    pub depth: f64,
}

/// What makes a camera unusable; readers of scenes refuse these before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CameraError {
    /// The gaze is zero or not finite, or parallel to the up vector.
    #[error("the camera's gaze must not be zero or parallel to its up vector")]
    DegenerateOrientation,
    /// The window has no area, or the picture no pixels.
    #[error("the camera's window is empty")]
    EmptyWindow,
}

impl Camera {
    /// The camera of a scene for a picture of `width` × `height` pixels.
    ///
    /// # Errors
    /// [`CameraError`], where the orientation or the window is degenerate.
    ///
    /// ```
    /// use snell::camera::Camera;
    /// use snell::scene::scene::{self, PixelGrid};
    /// let camera = Camera::new(&scene::Camera::default(), 640, 480, PixelGrid::Centers).unwrap();
    /// let ray = camera.generate_ray(123.25, 45.5);
    /// let back = camera.project(ray.at(3.0)).unwrap();
    /// assert!((back.x - 123.25).abs() < 1e-9 && (back.y - 45.5).abs() < 1e-9);
    /// ```
    pub fn new(
        description: &scene::Camera,
        width: u32,
        height: u32,
        grid: scene::PixelGrid,
    ) -> Result<Self, CameraError> {
        use CameraError::{DegenerateOrientation, EmptyWindow};
        let back = (-description.gaze).try_normalize().ok_or(DegenerateOrientation)?;
        let up = description.up.try_normalize().ok_or(DegenerateOrientation)?;
        let right = up.cross(back);
        // Below this the right-hand direction is mere rounding noise.
        if right.length() < 1e-9 {
            return Err(DegenerateOrientation);
        }
        let right = right.normalize();
        let (w, h) = (f64::from(width), f64::from(height));
        if width == 0 || height == 0 {
            return Err(EmptyWindow);
        }
        let aspect = h / w;
        let symmetric = |half_width: f64, half_height: f64| Window {
            left: -half_width,
            right: half_width,
            bottom: -half_height,
            top: half_height,
        };
        let (projection, window, near, far) = match description.frame {
            scene::Frame::HorizontalFov(angle) => {
                let half = portable::tan(0.5 * angle);
                (Projection::Perspective, symmetric(half, half * aspect), 0.0, f64::NEG_INFINITY)
            }
            scene::Frame::VerticalFov(angle) => {
                let half = portable::tan(0.5 * angle);
                (Projection::Perspective, symmetric(half / aspect, half), 0.0, f64::NEG_INFINITY)
            }
            scene::Frame::OrthographicWidth(full) => {
                (Projection::Orthographic, symmetric(0.5 * full, 0.5 * full * aspect), 0.0, f64::NEG_INFINITY)
            }
            scene::Frame::PerspectiveWindow { left, right, bottom, top, near, far } => {
                let unit = -1.0 / near;
                let window = Window { left: left * unit, right: right * unit, bottom: bottom * unit, top: top * unit };
                (Projection::Perspective, window, near, far)
            }
            scene::Frame::OrthographicWindow { left, right, bottom, top, near, far } => {
                (Projection::Orthographic, Window { left, right, bottom, top }, near, far)
            }
        };
        let (spread_x, spread_y) = (window.right - window.left, window.top - window.bottom);
        if !(spread_x > 0.0 && spread_y > 0.0 && spread_x.is_finite() && spread_y.is_finite()) {
            return Err(EmptyWindow);
        }
        // With rays at the corners of the cells there is one ray more than cells, and the first lies on the border.
        let (cells, shift) = match grid {
            scene::PixelGrid::Centers => ([w, h], 0.0),
            scene::PixelGrid::Corners => ([(w - 1.0).max(1.0), (h - 1.0).max(1.0)], 0.5),
        };
        let eye = description.eye;
        Ok(Self { eye, right, up: back.cross(right), back, projection, window, near, far, cells, shift })
    }

    /// The ray through a raster position. Its direction has unit length; it starts at the eye, on the near plane where the
    /// window gives one, and on the plane through the eye for an orthographic camera.
    #[inline]
    pub fn generate_ray(&self, x: f64, y: f64) -> Ray {
        let [window_x, window_y] = self.window_point(x, y);
        let across = self.right * window_x + self.up * window_y;
        match self.projection {
            Projection::Perspective => {
                let to_window = across - self.back;
                Ray::new(self.eye + to_window * -self.near, to_window.normalize())
            }
            Projection::Orthographic => Ray::new(self.eye + across + self.back * self.near, -self.back),
        }
    }

    /// How far along a ray of [`Camera::generate_ray`] the far plane is; infinite where there is none.
    #[inline]
    pub fn far_distance(&self, ray: &Ray) -> f64 {
        if self.far == f64::NEG_INFINITY {
            return f64::INFINITY;
        }
        let depth_of_origin = (ray.origin - self.eye).dot(self.back);
        (self.far - depth_of_origin) / ray.direction.dot(self.back)
    }

    /// Where a world point appears in the picture (perhaps outside its borders); `None` where it is in the eye's plane or
    /// behind it, which has no image in perspective.
    #[inline]
    pub fn project(&self, point: Point3) -> Option<RasterPoint> {
        let from_eye = point - self.eye;
        let depth = -from_eye.dot(self.back);
        let scale = match self.projection {
            Projection::Perspective if depth > 0.0 => 1.0 / depth,
            Projection::Perspective => return None,
            Projection::Orthographic => 1.0,
        };
        let [x, y] = self.raster_point([from_eye.dot(self.right) * scale, from_eye.dot(self.up) * scale]);
        Some(RasterPoint { x, y, depth })
    }

    /// Where in the window the projection of a point is, x to the right and y down, the window being [0, 1]²; for a camera that
    /// is perspective, of a point before it.
    pub fn picture_position(&self, point: Point3) -> [f64; 2] {
        let from_eye = point - self.eye;
        let scale = match self.projection {
            Projection::Perspective => -1.0 / from_eye.dot(self.back),
            Projection::Orthographic => 1.0,
        };
        let (x, y, w) = (from_eye.dot(self.right) * scale, from_eye.dot(self.up) * scale, &self.window);
        [(x - w.left) / (w.right - w.left), (w.top - y) / (w.top - w.bottom)]
    }

    /// The angle in radians that a pixel in the middle of the picture is seen under; for an orthographic camera, whose pixels
    /// have none, that of a picture which is 40° wide.
    pub fn pixel_angle(&self) -> f64 {
        match self.projection {
            Projection::Perspective => (self.window.right - self.window.left) / self.cells[0],
            Projection::Orthographic => portable::radians(40.0) / self.cells[0],
        }
    }

    /// The unit axes of eye space in the world: right (u), up (v), back (w).
    pub fn axes(&self) -> [Vector3; 3] {
        [self.right, self.up, self.back]
    }

    /// The eye.
    pub fn eye(&self) -> Point3 {
        self.eye
    }

    /// Perspective or orthographic.
    pub fn projection(&self) -> Projection {
        self.projection
    }

    /// The window, on the plane z = −1 of eye space in perspective.
    pub fn window(&self) -> Window {
        self.window
    }

    /// From raster coordinates to the window's plane.
    #[inline]
    fn window_point(&self, x: f64, y: f64) -> [f64; 2] {
        let w = &self.window;
        [
            w.left + (w.right - w.left) * ((x - self.shift) / self.cells[0]),
            w.top - (w.top - w.bottom) * ((y - self.shift) / self.cells[1]),
        ]
    }

    /// From the window's plane to raster coordinates.
    #[inline]
    fn raster_point(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let w = &self.window;
        [
            (x - w.left) / (w.right - w.left) * self.cells[0] + self.shift,
            (w.top - y) / (w.top - w.bottom) * self.cells[1] + self.shift,
        ]
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use snell_scene::scene::{Frame, PixelGrid};

    use super::*;

    fn frames() -> impl Strategy<Value = Frame> {
        let window = (-3.0..0.5f64, 0.1..4.0f64, -3.0..0.5f64, 0.1..4.0f64, -9.0..-0.01f64);
        prop_oneof![
            (0.01..3.1f64).prop_map(Frame::HorizontalFov),
            (0.01..3.1f64).prop_map(Frame::VerticalFov),
            (1e-3..1e4f64).prop_map(Frame::OrthographicWidth),
            window.clone().prop_map(|(left, width, bottom, height, near)| Frame::PerspectiveWindow {
                left,
                right: left + width,
                bottom,
                top: bottom + height,
                near,
                far: near * 100.0
            }),
            window.prop_map(|(left, width, bottom, height, near)| Frame::OrthographicWindow {
                left,
                right: left + width,
                bottom,
                top: bottom + height,
                near,
                far: f64::NEG_INFINITY
            }),
        ]
    }

    fn vectors() -> impl Strategy<Value = Vector3> {
        [-1.0..1.0f64, -1.0..1.0, -1.0..1.0].prop_map(Vector3::from)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn projection_undoes_generation(
            frame in frames(), gaze in vectors(), up in vectors(), eye in vectors(),
            size in (1..2000u32, 1..2000u32), x in -0.1..1.1f64, y in -0.1..1.1f64, t in 1e-3..1e3f64, corners in any::<bool>(),
        ) {
            prop_assume!(gaze.cross(up).length() > 1e-3);
            let grid = if corners { PixelGrid::Corners } else { PixelGrid::Centers };
            let description = scene::Camera { eye: Point3::ORIGIN + eye * 10.0, gaze, up, frame };
            let camera = Camera::new(&description, size.0, size.1, grid).expect("not degenerate");
            let (x, y) = (x * f64::from(size.0), y * f64::from(size.1));
            let ray = camera.generate_ray(x, y);
            prop_assert!((ray.direction.length() - 1.0).abs() < 1e-14);
            let back = camera.project(ray.at(t)).expect("before the camera");
            let tolerance = 1e-7 * f64::from(size.0.max(size.1));
            prop_assert!((back.x - x).abs() < tolerance && (back.y - y).abs() < tolerance, "{back:?} for {x}, {y}");
        }
    }

    #[test]
    fn corner_rays_touch_the_border() {
        let camera = Camera::new(&scene::Camera::default(), 513, 513, PixelGrid::Corners).expect("camera");
        let [x, _] = camera.window_point(0.5, 0.5);
        assert_eq!(x, camera.window().left);
        let [x, _] = camera.window_point(512.5, 0.5);
        assert_eq!(x, camera.window().right);
    }

    #[test]
    fn degenerate_cameras_are_refused() {
        let base = scene::Camera::default();
        let parallel = scene::Camera { up: base.gaze, ..base.clone() };
        let still = scene::Camera { gaze: Vector3::ZERO, ..base.clone() };
        let flat = scene::Camera { frame: Frame::OrthographicWidth(0.0), ..base };
        for (camera, error) in [
            (parallel, CameraError::DegenerateOrientation),
            (still, CameraError::DegenerateOrientation),
            (flat, CameraError::EmptyWindow),
        ] {
            assert_eq!(Camera::new(&camera, 4, 4, PixelGrid::Centers), Err(error));
        }
    }

    #[test]
    fn a_far_plane_is_found_along_each_ray() {
        let frame = Frame::PerspectiveWindow { left: -1.0, right: 1.0, bottom: -1.0, top: 1.0, near: -1.0, far: -10.0 };
        let camera = Camera::new(&scene::Camera { frame, ..scene::Camera::default() }, 8, 8, PixelGrid::Centers)
            .expect("camera");
        for (x, y) in [(4.0, 4.0), (0.0, 0.0), (8.0, 1.0)] {
            let ray = camera.generate_ray(x, y);
            let end = camera.project(ray.at(camera.far_distance(&ray))).expect("before the camera");
            assert!((end.depth - 10.0).abs() < 1e-12, "{end:?}");
            assert!((camera.project(ray.origin).expect("before the camera").depth - 1.0).abs() < 1e-12);
        }
    }
}

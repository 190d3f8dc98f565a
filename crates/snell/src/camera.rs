//! One camera: rays for the tracer ([`Camera::generate_ray`]) and the way back for drawing ([`Camera::project`]).
//!
//! Raster coordinates are continuous, x to the right and y down, (0, 0) at the picture's top left corner; pixel (i, j)
//! covers [i, i + 1) × [j, j + 1). Eye space is right-handed: x right (u), y up (v), looking along −z (w = −gaze), as in
//! Shirley et al., *Fundamentals of Computer Graphics*, chapter 7.

mod lens;

use snell_math::lanes::{LaneVector, Lanes};
use snell_math::warp::Aperture;
use snell_math::{Point3, Ray, Vector3, portable};
use snell_scene::scene;

use self::lens::LensFrame;
pub use self::lens::RealLens;
use crate::differential::RayDifferential;
use crate::viewing::{Pipeline, Rectangle, RectangleMap, ViewVolume, ViewingError, view_axes};
pub use crate::viewing::{Projection, Rectangle as Window};

/// A camera for a picture of a given size. World space.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    eye: Point3,
    right: Vector3,
    up: Vector3,
    back: Vector3,
    projection: Projection,
    /// In eye space; in perspective on the plane z = −1.
    window: Rectangle,
    near: f64,
    far: f64,
    pixels: [u32; 2],
    cells: [f64; 2],
    shift: f64,
    window_from_raster: RectangleMap,
    raster_from_window: RectangleMap,
    lens: Option<scene::CameraLens>,
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

impl Camera {
    /// The camera of a scene for a picture of `width` × `height` pixels.
    ///
    /// # Errors
    /// [`ViewingError`], where the orientation or the window is degenerate.
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
    ) -> Result<Self, ViewingError> {
        let [right, up, back] = view_axes(description.gaze, description.up)?;
        let (w, h) = (f64::from(width), f64::from(height));
        if width == 0 || height == 0 {
            return Err(ViewingError::NoPixels { width: w, height: h });
        }
        let aspect = h / w;
        let symmetric = |x: f64, y: f64| Rectangle { left: -x, right: x, bottom: -y, top: y };
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
                let window =
                    Rectangle { left: left * unit, right: right * unit, bottom: bottom * unit, top: top * unit };
                (Projection::Perspective, window, near, far)
            }
            scene::Frame::OrthographicWindow { left, right, bottom, top, near, far } => {
                (Projection::Orthographic, Rectangle { left, right, bottom, top }, near, far)
            }
        };
        // With rays at the corners of the cells there is one ray more than cells, and the first lies on the border.
        let (cells, shift) = match grid {
            scene::PixelGrid::Centers => ([w, h], 0.0),
            scene::PixelGrid::Corners => ([(w - 1.0).max(1.0), (h - 1.0).max(1.0)], 0.5),
        };
        // Raster y runs down: the window's top is at the raster's smaller y.
        let raster = Rectangle { left: shift, right: cells[0] + shift, bottom: shift, top: cells[1] + shift };
        let turned_over = Rectangle { bottom: window.top, top: window.bottom, ..window };
        let window_from_raster = RectangleMap::new(&raster, &turned_over)?;
        let raster_from_window = window_from_raster.inverse();
        let eye = description.eye;
        Ok(Self {
            eye,
            right,
            up,
            back,
            projection,
            window,
            near,
            far,
            pixels: [width, height],
            cells,
            shift,
            window_from_raster,
            raster_from_window,
            lens: description.lens.clone(),
        })
    }

    /// The ray through a raster position. Its direction has unit length; it starts at the eye, on the near plane where the
    /// window gives one, and on the plane through the eye for an orthographic camera.
    #[inline]
    pub fn generate_ray(&self, x: f64, y: f64) -> Ray {
        let [origin, direction] = self.generate_rays::<f64>(x, y);
        Ray::new(origin.into(), direction.into())
    }

    /// As [`Camera::generate_ray`], side by side: origins and directions.
    #[inline(always)]
    pub fn generate_rays<L: Lanes>(&self, x: L, y: L) -> [LaneVector<L>; 2] {
        let [window_x, window_y] = self.window_from_raster.point_lanes([x, y]);
        let (right, up) = (LaneVector::splat(self.right.to_array()), LaneVector::splat(self.up.to_array()));
        let (eye, back) = (LaneVector::splat(self.eye.to_array()), LaneVector::splat(self.back.to_array()));
        let across = right * window_x + up * window_y;
        match self.projection {
            Projection::Perspective => {
                let to_window = across - back;
                [eye + to_window * L::splat(-self.near), to_window.normalize()]
            }
            Projection::Orthographic => [eye + across + back * L::splat(self.near), -back],
        }
    }

    /// A ray through a raster position and a place on a thin lens, by two numbers in [0, 1): all of one position meet where the lens
    /// is sharp. (Cook, Porter and Carpenter, "Distributed Ray Tracing", SIGGRAPH 1984.) `None` without a thin lens; for the rays of a
    /// real one see [`Camera::real_lens`].
    #[inline]
    pub fn generate_lens_ray(&self, x: f64, y: f64, u: [f64; 2]) -> Option<Ray> {
        let Some(scene::CameraLens::Thin(scene::ThinLens { radius, focus, blades })) = self.lens else { return None };
        let ray = self.generate_ray(x, y);
        let [a, b] = Aperture::new(blades, 0.0).sample(u);
        let across = self.right * (a * radius) + self.up * (b * radius);
        let sharp = self.eye + ray.direction * (focus / -ray.direction.dot(self.back));
        let origin = ray.origin + across;
        Some(Ray::new(origin, (sharp - origin).normalize()))
    }

    /// Its real lens, ready to be traced, which takes a tenth of a second; `None` where it has none.
    pub fn real_lens(&self) -> Option<RealLens> {
        let Some(scene::CameraLens::System(lens)) = &self.lens else { return None };
        let prescription = &lens.prescription;
        let surfaces = &prescription.surfaces;
        let length: f64 = surfaces[..surfaces.len() - 1].iter().map(|surface| surface.thickness).sum();
        let pupil_from_last = length - prescription.paraxial_d().entrance_pupil();
        let millimetre = 1.0 / lens.unit_mm;
        // The image on the film is turned over, and stands as large there as the window's width says.
        let scale = -lens.film_width / (self.window.right - self.window.left);
        let at = |x: f64, y: f64| self.window_from_raster.point([x, y]).map(|x| scale * x);
        let ([x0, y0], [x1, y1]) = (at(0.0, 0.0), at(1.0, 1.0));
        let frame = LensFrame {
            origin: self.eye + self.back * (pupil_from_last * millimetre),
            axes: self.axes(),
            millimetre,
            film_from_raster: [[x1 - x0, x0], [y1 - y0, y0]],
        };
        let film = [
            lens.film_width,
            lens.film_width * (self.window.top - self.window.bottom) / (self.window.right - self.window.left),
        ];
        Some(RealLens::new(lens, frame, film))
    }

    /// How the ray through a raster position differs from those through positions some pixels to the right and down.
    #[must_use]
    pub fn ray_differential(&self, x: f64, y: f64, spacing: f64) -> RayDifferential {
        let neighbours = [self.generate_ray(x + spacing, y), self.generate_ray(x, y + spacing)];
        RayDifferential::between(&self.generate_ray(x, y), [&neighbours[0], &neighbours[1]])
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
        let across = [from_eye.dot(self.right) * scale, from_eye.dot(self.up) * scale];
        let [x, y] = self.raster_from_window.point(across);
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
    pub fn window(&self) -> Rectangle {
        self.window
    }

    /// The camera's own near and far planes, as z in eye space: 0 and −∞ for one that has none.
    pub fn planes(&self) -> [f64; 2] {
        [self.near, self.far]
    }

    /// The lecture's matrices for this camera, with what it sees between the planes `near` and `far` in eye space; those that the
    /// camera has itself are within its reach alone. Its pixel coordinates have y up; [`Camera::raster_from_pixel`] turns them
    /// over.
    ///
    /// ```
    /// use snell::camera::Camera;
    /// use snell::math::Point3;
    /// use snell::scene::scene::{self, PixelGrid};
    /// let camera = Camera::new(&scene::Camera::default(), 640, 480, PixelGrid::Centers)?;
    /// let point = Point3::new(0.25, 0.5, 1.0);
    /// let pixel = camera.pipeline(-1.0, -50.0)?.follow(point).pixel.unwrap();
    /// let [x, y] = camera.raster_from_pixel([pixel.x(), pixel.y()]);
    /// let drawn = camera.project(point).unwrap();
    /// assert!((drawn.x - x).abs() < 1e-10 && (drawn.y - y).abs() < 1e-10);
    /// # Ok::<(), snell::viewing::ViewingError>(())
    /// ```
    ///
    /// # Errors
    /// [`ViewingError`] where the planes are not finite, in the wrong order, or in perspective not before the eye.
    pub fn pipeline(&self, near: f64, far: f64) -> Result<Pipeline, ViewingError> {
        let window = match self.projection {
            Projection::Perspective => {
                let Rectangle { left, right, bottom, top } = self.window;
                Rectangle { left: left * -near, right: right * -near, bottom: bottom * -near, top: top * -near }
            }
            Projection::Orthographic => self.window,
        };
        let volume = ViewVolume { window, near, far };
        let pixels = self.pixels();
        let pipeline = Pipeline::new(self.eye, self.axes(), self.projection, &volume, pixels)?;
        // The window's border in the lecture's pixel coordinates: from −½ on, or with rays at the corners of cells from 0.
        let start = self.shift - 0.5;
        Ok(pipeline.onto(&Rectangle::new(start, self.cells[0] + start, start, self.cells[1] + start)))
    }

    /// Raster coordinates (y down, (0, 0) the upper left corner) of the lecture's pixel coordinates (y up, centres at integers).
    pub fn raster_from_pixel(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x + 0.5, self.cells[1] + 2.0 * self.shift - 0.5 - y]
    }

    /// The picture's size in pixels.
    pub fn pixels(&self) -> [u32; 2] {
        self.pixels
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
            let description = scene::Camera { eye: Point3::ORIGIN + eye * 10.0, gaze, up, frame, lens: None };
            let camera = Camera::new(&description, size.0, size.1, grid).expect("not degenerate");
            let (x, y) = (x * f64::from(size.0), y * f64::from(size.1));
            let ray = camera.generate_ray(x, y);
            prop_assert!((ray.direction.length() - 1.0).abs() < 1e-14);
            let back = camera.project(ray.at(t)).expect("before the camera");
            let tolerance = 1e-7 * f64::from(size.0.max(size.1));
            prop_assert!((back.x - x).abs() < tolerance && (back.y - y).abs() < tolerance, "{back:?} for {x}, {y}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn the_matrices_are_those_of_the_camera(
            frame in frames(), gaze in vectors(), up in vectors(), size in (1..2000u32, 1..2000u32), x in -0.1..1.1f64,
            y in -0.1..1.1f64, depth in 0.0..1.0f64, corners in any::<bool>(),
        ) {
            prop_assume!(gaze.cross(up).length() > 1e-3);
            let grid = if corners { PixelGrid::Corners } else { PixelGrid::Centers };
            let description = scene::Camera { eye: Point3::new(1.0, -2.0, 3.0), gaze, up, frame, lens: None };
            let camera = Camera::new(&description, size.0, size.1, grid).expect("not degenerate");
            prop_assert_eq!(camera.pixels(), [size.0, size.1]);
            let pipeline = camera.pipeline(-1.0, -20.0).expect("in order");
            let ray = camera.generate_ray(x * f64::from(size.0), y * f64::from(size.1));
            let step = |z: f64| (z - camera.project(ray.origin).map_or(0.0, |p| p.depth)) / -ray.direction.dot(camera.back);
            let point = ray.at(step(1.0 + 19.0 * depth));
            let stages = pipeline.follow(point);
            let pixel = stages.pixel.expect("before the eye");
            let raster = camera.raster_from_pixel([pixel.x(), pixel.y()]);
            let direct = camera.project(point).expect("before the eye");
            let tolerance = 1e-9 * f64::from(size.0.max(size.1)) * (1.0 + 1.0 / camera.window.width().min(1.0));
            prop_assert!((raster[0] - direct.x).abs() < tolerance, "{:?} {:?}", raster, direct);
            prop_assert!((raster[1] - direct.y).abs() < tolerance, "{:?} {:?}", raster, direct);
            // What is in the picture is what clipping lets pass.
            let margin = |v: f64| v.abs().min((v - 1.0).abs());
            if !corners && margin(x) > 1e-6 && margin(y) > 1e-6 && margin(depth) > 1e-6 {
                let inside = (0.0..1.0).contains(&x) && (0.0..1.0).contains(&y);
                prop_assert_eq!(stages.outside.is_empty(), inside, "{:?}", stages);
            }
        }

        #[test]
        fn every_camera_reduces_to_the_simplest_view(
            gaze in vectors(), up in vectors(), eye in vectors(), fov in 0.1..2.5f64, x in 0.0..640.0f64, y in 0.0..480.0f64,
        ) {
            prop_assume!(gaze.cross(up).length() > 1e-3);
            let eye = Point3::ORIGIN + eye * 10.0;
            let description = scene::Camera { eye, gaze, up, frame: Frame::HorizontalFov(fov), lens: None };
            let camera = Camera::new(&description, 640, 480, PixelGrid::Centers).expect("not degenerate");
            // The image plane is as far from the eye as makes a pixel one unit wide.
            let n = 640.0 / camera.window().width();
            let simplest = crate::viewing::ray_view(eye, gaze, up, 640.0, 480.0, n).expect("not degenerate");
            let ray = camera.generate_ray(x, y);
            let t = n / -ray.direction.dot(camera.back);
            let on_plane = simplest.map(ray.at(t)).homogenize().expect("a point");
            let expected = Point3::new(x, 480.0 - y, 0.0);
            prop_assert!(on_plane.distance(expected) < 1e-9 * n.max(640.0), "{:?} {:?}", on_plane, expected);
        }
    }

    #[test]
    fn corner_rays_touch_the_border() {
        let camera = Camera::new(&scene::Camera::default(), 513, 513, PixelGrid::Corners).expect("camera");
        let [x, _] = camera.window_from_raster.point([0.5, 0.5]);
        assert_eq!(x, camera.window().left);
        let [x, _] = camera.window_from_raster.point([512.5, 0.5]);
        assert_eq!(x, camera.window().right);
    }

    #[test]
    fn degenerate_cameras_are_refused() {
        let base = scene::Camera::default();
        let parallel = scene::Camera { up: base.gaze, ..base.clone() };
        let still = scene::Camera { gaze: Vector3::ZERO, ..base.clone() };
        let flat = scene::Camera { frame: Frame::OrthographicWidth(0.0), ..base.clone() };
        let nan = scene::Camera { frame: Frame::HorizontalFov(f64::NAN), ..base };
        for (camera, message) in [
            (parallel, "the gaze (0, 0, -1) is parallel to the up vector (0, 0, -1)"),
            (still, "the gaze is (0, 0, 0), which has no direction"),
            (flat, "the width to map onto is empty: it goes from -0 to 0"),
            (nan, "left is NaN, which is no finite number"),
        ] {
            let error = Camera::new(&camera, 4, 4, PixelGrid::Centers).expect_err(message);
            assert_eq!(error.to_string(), message);
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

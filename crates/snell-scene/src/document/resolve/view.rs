//! Camera and background.

use snell_math::{Point3, Rgb, Vector3, portable};

use super::Resolver;
use crate::document::model::{self, BackgroundGradient, Located, Projection, Triple};
use crate::scene::{Background, Camera, Frame};

/// The sine of the angle between gaze and up below which they count as parallel.
pub(super) const PARALLEL: f64 = 1e-9;

impl Resolver<'_> {
    pub(super) fn camera(&mut self, camera: &model::Camera) -> Camera {
        let eye = Point3::from(camera.eye.value);
        let fallback = Camera::default();
        let (gaze, gaze_span) = match (&camera.gaze, &camera.look_at) {
            (Some(gaze), _) => (Vector3::from(gaze.value), &gaze.span),
            (None, Some(look_at)) => (Point3::from(look_at.value) - eye, &look_at.span),
            (None, None) => (Point3::ORIGIN - eye, &camera.eye.span),
        };
        let Some(direction) = gaze.try_normalize() else {
            let message = if camera.gaze.is_some() {
                "the camera's gaze has no length, and so no direction"
            } else {
                "the camera looks at the very point where it is: `look_at` is `eye`"
            };
            self.error(gaze_span, message, "gives no direction to look in");
            return fallback;
        };
        let up = self.direction(&camera.up, "the camera's `up`", Vector3::Y);
        if direction.cross(up).length() < PARALLEL {
            let span = if camera.up.span.is_some() { &camera.up.span } else { gaze_span };
            let up = triple(camera.up.value);
            self.error(
                span,
                format!("the camera looks along its own `up` {up}, which leaves the picture without an upright"),
                "gaze and up are parallel",
            );
        }
        let frame = self.frame(camera);
        let (lens, frame) = match &camera.lens {
            Some(lens) => self.camera_lens(lens, camera, gaze, frame),
            None => (None, frame),
        };
        Camera { eye, gaze, up: camera.up.value.into(), frame, lens }
    }

    fn frame(&mut self, camera: &model::Camera) -> Frame {
        let projection = camera.projection.as_ref().map(|projection| projection.value);
        let perspective_keys = [("fov", &camera.fov), ("vertical_fov", &camera.vertical_fov)];
        if projection == Some(Projection::Orthographic) {
            for (key, value) in perspective_keys {
                if let Some(value) = value {
                    let message = format!("an orthographic camera has no angle of view, so `{key}` means nothing");
                    self.error(&value.span, message, "give `width` in world units instead");
                }
            }
        }
        if let (Some(Projection::Perspective), Some(width)) = (projection, &camera.width) {
            let message = "`width` is for orthographic cameras, but this one is a perspective camera";
            self.error(&width.span, message, "give `fov` in degrees instead");
        }
        if let Some(window) = &camera.window {
            return self.window(window, projection.unwrap_or(Projection::Perspective));
        }
        if let Some(width) = &camera.width {
            return Frame::OrthographicWidth(width.value);
        }
        match (projection, &camera.fov, &camera.vertical_fov) {
            (Some(Projection::Orthographic), ..) => Frame::OrthographicWidth(4.0),
            (_, _, Some(fov)) => Frame::VerticalFov(portable::radians(fov.value)),
            (_, fov, _) => Frame::HorizontalFov(portable::radians(fov.as_ref().map_or(40.0, |fov| fov.value))),
        }
    }

    fn window(&mut self, window: &Located<model::Window>, projection: Projection) -> Frame {
        let model::Window { left, right, bottom, top, near, far } = &window.value;
        for (low, low_name, high, high_name) in [(left, "left", right, "right"), (bottom, "bottom", top, "top")] {
            if low.value >= high.value {
                let size = if low.value == high.value { "has no size" } else { "is turned around" };
                let message = format!(
                    "the camera's window {size}: {low_name} is {} and {high_name} is {}",
                    low.value, high.value
                );
                self.error(&high.span, message, format!("must be above {low_name}"));
            }
        }
        if projection == Projection::Perspective && near.value >= 0.0 {
            let message = format!("the window's near plane z = {} is not before the eye", near.value);
            self.error(&near.span, message, "must be negative: the camera looks along −z");
        }
        if let Some(far) = far
            && far.value >= near.value
        {
            let message =
                format!("the window's far plane z = {} is not beyond its near plane z = {}", far.value, near.value);
            self.error(&far.span, message, "must be below `near`: the camera looks along −z");
        }
        let (left, right, bottom, top) = (left.value, right.value, bottom.value, top.value);
        let (near, far) = (near.value, far.as_ref().map_or(f64::NEG_INFINITY, |far| far.value));
        match projection {
            Projection::Perspective => Frame::PerspectiveWindow { left, right, bottom, top, near, far },
            Projection::Orthographic => Frame::OrthographicWindow { left, right, bottom, top, near, far },
        }
    }

    pub(super) fn background(&mut self, background: &model::Background) -> Background {
        if let Some(gradient) = &background.gradient {
            Background::Gradient(self.background_gradient(&gradient.value))
        } else if let Some(photograph) = &background.photograph {
            Background::Photograph { image: self.image(&photograph.file), intensity: photograph.intensity }
        } else if let Some(panorama) = &background.panorama {
            let rotation = portable::radians(panorama.rotation);
            Background::Panorama { image: self.image(&panorama.file), intensity: panorama.intensity, rotation }
        } else {
            Background::Color(background.color.map_or(Rgb::BLACK, |color| color.0))
        }
    }

    fn background_gradient(&mut self, gradient: &BackgroundGradient) -> Vec<(f64, Rgb)> {
        if let Some(stops) = &gradient.stops {
            let stops: Vec<_> = stops.iter().map(|stop| (stop.value.at, stop.value.color.0, &stop.span)).collect();
            return self.stops(&stops);
        }
        let horizon = gradient.horizon.map_or(Rgb::WHITE, |color| color.0);
        let or_horizon = |color: Option<model::Color>| color.map_or(horizon, |color| color.0);
        vec![(-1.0, or_horizon(gradient.nadir)), (0.0, horizon), (1.0, or_horizon(gradient.zenith))]
    }

    /// Stops, which must increase.
    pub(super) fn stops(&mut self, stops: &[(f64, Rgb, &Option<crate::diagnostic::Span>)]) -> Vec<(f64, Rgb)> {
        for pair in stops.windows(2) {
            if pair[1].0 <= pair[0].0 {
                let message = format!("the stop at {} comes after the one at {}", pair[1].0, pair[0].0);
                self.error(pair[1].2, message, "stops must increase");
            }
        }
        stops.iter().map(|(at, color, _)| (*at, *color)).collect()
    }
}

/// Three numbers as the author writes them.
fn triple([x, y, z]: Triple) -> String {
    format!("[{x}, {y}, {z}]")
}

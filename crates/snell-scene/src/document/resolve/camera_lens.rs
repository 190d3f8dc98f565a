//! Lenses of cameras: thin ones, and real ones with all that makes them impossible.

use std::ops::RangeInclusive;

use snell_math::{Dispersion, Point3, Vector3, portable};

use super::{Resolver, needs_unit};
use crate::diagnostic::{Diagnostic, Span, did_you_mean};
use crate::document::model::{self, Either, Located};
use crate::document::read_table;
use crate::lenses;
use crate::scene::{CameraLens, Frame, LensPrescription, LensSurface, LensSystem, ThinLens};

/// The width of film that a lens has where none is said, in millimetres: that of a small camera.
const DEFAULT_FILM: f64 = 36.0;

/// The angles that a picture may be wide, in degrees, as for `fov`.
const ANGLES: RangeInclusive<f64> = 1e-4..=179.9;

impl Resolver<'_> {
    /// The lens of a camera, and the frame that goes with it.
    pub(super) fn camera_lens(
        &mut self,
        choice: &Located<model::LensChoice>,
        camera: &model::Camera,
        gaze: Vector3,
        frame: Frame,
    ) -> (Option<CameraLens>, Frame) {
        if matches!(frame, Frame::OrthographicWidth(_) | Frame::OrthographicWindow { .. }) {
            let message = "an orthographic camera has no lens: all that it sees is sharp";
            self.error(&choice.span, message, "leave it out, or give `fov`");
            return (None, frame);
        }
        let by_name;
        let lens = match &choice.value {
            Either::A(name) => {
                let of = Located { value: Either::A(name.clone()), span: choice.span.clone() };
                by_name = model::CameraLens { of: Some(of), ..model::CameraLens::default() };
                &by_name
            }
            Either::B(lens) => lens,
        };
        let Some((focus, focus_span)) = self.focus(lens, camera, gaze) else { return (None, frame) };
        match (&lens.of, lens.radius) {
            (Some(of), _) => match self.lens_system(lens, of, &choice.span, camera, focus, &focus_span) {
                Some((system, frame)) => (Some(CameraLens::System(Box::new(system))), frame),
                None => (None, frame),
            },
            (None, radius) => {
                let radius = radius.unwrap_or(0.0);
                (Some(CameraLens::Thin(ThinLens { radius, focus, blades: lens.blades })), frame)
            }
        }
    }

    /// The distance along the gaze that is sharp, in world units, and the place that says so.
    fn focus(
        &mut self,
        lens: &model::CameraLens,
        camera: &model::Camera,
        gaze: Vector3,
    ) -> Option<(f64, Option<Span>)> {
        match (&lens.focus, &lens.focus_at) {
            (Some(focus), _) => Some((focus.value, focus.span.clone())),
            (None, Some(point)) => {
                let along = (Point3::from(point.value) - Point3::from(camera.eye.value)).dot(gaze.normalize());
                if along <= 0.0 {
                    let message = "the lens cannot be sharp at a point behind the camera";
                    self.error(&point.span, message, "behind the camera");
                    return None;
                }
                Some((along, point.span.clone()))
            }
            (None, None) => {
                let span = camera.look_at.as_ref().map(|look_at| look_at.span.clone());
                Some((gaze.length(), span.unwrap_or_default()))
            }
        }
    }

    /// A real lens, and the frame of what it sees.
    fn lens_system(
        &mut self,
        lens: &model::CameraLens,
        of: &Located<model::PrescriptionChoice>,
        span: &Option<Span>,
        camera: &model::Camera,
        focus: f64,
        focus_span: &Option<Span>,
    ) -> Option<(LensSystem, Frame)> {
        self.refuse_angles(camera);
        let prescription = self.prescription(of);
        let Some(unit_mm) = self.unit_mm else {
            self.diagnostics.push(needs_unit("a real lens is measured in millimetres", span));
            return None;
        };
        let prescription = prescription?;
        let paraxial = prescription.paraxial_d();
        let focal_length = paraxial.focal_length();
        let pupil = paraxial.entrance_pupil();
        if !(focal_length > 0.0 && focal_length < 1e9) {
            let message = "the lens makes no image: it does not gather light";
            self.error(&of.span, message, format!("its focal length is {focal_length:.4} mm"));
            return None;
        }
        if pupil.is_nan() || pupil.abs() >= 1e9 {
            let message =
                "the stop of the lens is in the focus of what is before it, and so nowhere as seen from the world";
            self.error(&of.span, message, "the camera's eye would be infinitely far away");
            return None;
        }
        let widest = prescription.widest_f_number();
        let stop_radius = match &lens.f_number {
            Some(f_number) if f_number.value < widest * (1.0 - 1e-3) => {
                let message =
                    format!("the lens does not open to f/{}: its stop is as wide as f/{widest:.2}", f_number.value);
                let diagnostic = Diagnostic::error(message).at_optional(f_number.span.clone(), "too wide");
                self.diagnostics.push(diagnostic.help("leave it out for the lens wide open"));
                return None;
            }
            Some(f_number) => {
                paraxial.stop_radius(f_number.value).min(prescription.surfaces[prescription.stop].clear_radius)
            }
            None => prescription.surfaces[prescription.stop].clear_radius,
        };
        let film_width = lens.film.as_ref().map_or(DEFAULT_FILM, |film| film.value);
        // The eye is in the pupil, so that is where distances of the world are counted from.
        let focus_mm = focus * unit_mm;
        let image = paraxial.image(focus_mm - pupil);
        if !(focus_mm - pupil > paraxial.front_focal_distance() && focus_mm > pupil.max(0.0) && image.distance > 0.0) {
            let rounded = (focus_mm * 1e3).round() / 1e3;
            let message = format!("the lens cannot be sharp at {rounded} mm, which is nearer than its focus");
            let diagnostic = Diagnostic::error(message).at_optional(focus_span.clone(), "too near");
            let nearest = (paraxial.front_focal_distance() + pupil).max(pupil).max(0.0);
            self.diagnostics.push(
                diagnostic.help(format!(
                    "a world unit is {unit_mm} mm here, and its focus is {nearest:.4} mm before the eye"
                )),
            );
            return None;
        }
        // What is as wide as the film on the plane of focus, as it is seen from the pupil.
        let half = 0.5 * film_width / (image.magnification.abs() * focus_mm);
        let angle = 2.0 * portable::atan(half);
        let degrees = portable::degrees(angle);
        if !ANGLES.contains(&degrees) {
            let message = format!("film of {film_width} mm behind this lens sees an angle of {degrees:.5}°");
            let film = lens.film.as_ref().and_then(|film| film.span.clone());
            self.error(
                &film.or_else(|| span.clone()),
                message,
                format!("must be between {} and {}", ANGLES.start(), ANGLES.end()),
            );
            return None;
        }
        let frame = Frame::HorizontalFov(angle);
        let (film_distance, blades) = (image.distance, lens.blades);
        let system = LensSystem { prescription, stop_radius, blades, film_width, film_distance, unit_mm };
        Some((system, frame))
    }

    /// The film decides how much a real lens sees.
    fn refuse_angles(&mut self, camera: &model::Camera) {
        let angles = [("fov", &camera.fov), ("vertical_fov", &camera.vertical_fov)];
        let angles = angles.into_iter().filter_map(|(key, angle)| Some((key, &angle.as_ref()?.span)));
        let window = camera.window.as_ref().map(|window| ("window", &window.span));
        for (key, span) in angles.chain(window) {
            let message = format!(
                "`{key}` means nothing beside a real lens: how much it sees follows from the width of its film"
            );
            let diagnostic = Diagnostic::error(message).at_optional(span.clone(), "not possible here");
            self.diagnostics
                .push(diagnostic.help("leave it out, or write the lens as `lens = { of = \"…\", film = 24 }`"));
        }
    }

    /// What a lens is made of: by name, from a file, or in place.
    fn prescription(&mut self, of: &Located<model::PrescriptionChoice>) -> Option<LensPrescription> {
        let name = match &of.value {
            Either::A(name) => name,
            Either::B(prescription) => return self.surfaces(prescription, &of.span),
        };
        let (path, bytes) = if lenses::is_lens_file(name) {
            self.file(&Located { value: name.clone(), span: of.span.clone() })?
        } else if let Some(lens) = lenses::find(name) {
            (format!("built-in:lenses/{name}.toml"), lens.text.as_bytes().into())
        } else {
            let diagnostic =
                Diagnostic::error(format!("there is no lens {name:?}")).at_optional(of.span.clone(), "not built in");
            let known = || lenses::all().map(|lens| lens.name);
            self.diagnostics.push(diagnostic.help(match did_you_mean(name, known()) {
                Some(near) => format!("did you mean {near:?}?"),
                None => {
                    format!("there are {}; or name a file that ends with .toml", known().collect::<Vec<_>>().join(", "))
                }
            }));
            return None;
        };
        let said_before = self.diagnostics.list.len();
        // Glasses that the file names are looked for beside it.
        let scene = std::mem::replace(&mut self.base, path.clone());
        let read = read_table(&path, &bytes, ["LensPrescription", "the lens"], self.diagnostics);
        let prescription = read.and_then(|read: model::LensPrescription| self.surfaces(&read, &of.span));
        self.base = scene;
        if let Some(span) = &of.span {
            for diagnostic in &mut self.diagnostics.list[said_before..] {
                if diagnostic.place.as_ref().is_none_or(|(place, _)| place != span) {
                    diagnostic.related.push((span.clone(), "named here".to_owned()));
                }
            }
        }
        prescription
    }

    /// The surfaces of a lens, with what is wrong with them.
    fn surfaces(&mut self, given: &model::LensPrescription, span: &Option<Span>) -> Option<LensPrescription> {
        let said_before = self.diagnostics.list.len();
        let surfaces: Vec<LensSurface> =
            given.surfaces.iter().map(|surface| self.lens_surface(&surface.value)).collect();
        let mut stops = (0..).zip(&given.surfaces).filter(|(_, surface)| surface.value.stop);
        let stop = match (stops.next(), stops.next()) {
            (Some((stop, _)), None) => Some(stop),
            (Some(_), Some((_, second))) => {
                self.error(&second.span, "the lens has two stops", "the second one is here");
                None
            }
            (None, _) => {
                let diagnostic = Diagnostic::error("the lens has no stop, by which its f-number is counted")
                    .at_optional(span.clone(), "none of its surfaces is the stop");
                self.diagnostics.push(diagnostic.help(
                    "write `stop = true` in the surface that bounds the light, or add one for it: `{ stop = true, thickness = 1, diameter = 10 }`",
                ));
                None
            }
        };
        if let Some(last) = given.surfaces.last()
            && let Some(glass) = &last.value.glass
        {
            self.error(
                &glass.span,
                "the lens ends inside glass: behind its last surface is the film, in air",
                "leave it out",
            );
        }
        for (number, pair) in surfaces.windows(2).enumerate() {
            // Where both let light pass, the one behind must be behind.
            let rim = pair[0].clear_radius.min(pair[1].clear_radius);
            let gap = pair[0].thickness + sag(pair[1].radius, rim) - sag(pair[0].radius, rim);
            if gap < -1e-9 {
                let message = format!(
                    "surfaces {} and {} of the lens cross: {rim} mm from the axis the second is {:.4} mm before the first",
                    number + 1,
                    number + 2,
                    -gap
                );
                let diagnostic =
                    Diagnostic::error(message).at_optional(given.surfaces[number + 1].span.clone(), "cross here");
                self.diagnostics
                    .push(diagnostic.help("make the `thickness` between them larger, or a `diameter` smaller"));
            }
        }
        let is_right = self.diagnostics.list[said_before..].iter().all(|d| d.severity < crate::Severity::Error);
        stop.filter(|_| is_right).map(|stop| LensPrescription { surfaces, stop })
    }

    fn lens_surface(&mut self, surface: &model::LensSurface) -> LensSurface {
        let model::LensSurface { radius, thickness, glass, diameter, .. } = surface;
        let clear_radius = 0.5 * diameter.value;
        let curvature_radius = match radius {
            Some(radius) if radius.value == 0.0 => {
                let diagnostic =
                    Diagnostic::error("a surface of radius 0 is none").at_optional(radius.span.clone(), "here");
                self.diagnostics.push(diagnostic.help("leave `radius` out where the surface is flat"));
                f64::INFINITY
            }
            Some(radius) => radius.value,
            None => f64::INFINITY,
        };
        if clear_radius > curvature_radius.abs() {
            let message =
                format!("the diameter {} of a surface does not fit its radius of {curvature_radius}", diameter.value);
            self.error(&diameter.span, message, format!("must be at most {}", 2.0 * curvature_radius.abs()));
        }
        let behind = match glass {
            None => Dispersion::Constant(1.0),
            Some(Located { value: Either::A(model::IndexAndAbbeNumber([index, abbe])), .. }) => {
                Dispersion::from_abbe_number(*index, *abbe)
            }
            Some(Located { value: Either::B(ior), span }) => {
                self.ior(&Located { value: ior.clone(), span: span.clone() })
            }
        };
        LensSurface { radius: curvature_radius, thickness: *thickness, behind, clear_radius }
    }
}

/// How far a surface lies behind its vertex at a height, at most its radius.
fn sag(radius: f64, height: f64) -> f64 {
    let ratio = height / radius;
    // Without a difference of like numbers, and 0 for a flat one.
    height * ratio / (1.0 + (1.0 - ratio * ratio).max(0.0).sqrt())
}

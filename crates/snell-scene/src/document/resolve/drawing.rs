//! How the scene is drawn as lines, and the marks in a drawing.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use snell_math::{Point3, Vector3, portable};

use super::Resolver;
use crate::diagnostic::{Diagnostic, Span, did_you_mean};
use crate::document::check::number::{SMALLEST, show};
use crate::document::model::{self, Either, Located};
use crate::scene::{self, Extent, Frame};

/// The most lines along one side of a ground grid.
const MOST_GRID_LINES: f64 = 2000.0;
/// The distance to what a camera looks at where it only has a direction.
const USUAL_DISTANCE: f64 = 4.0;

impl Resolver<'_> {
    pub(super) fn drawing(&mut self, drawing: &model::Drawing, picture_aspect: f64) -> scene::Drawing {
        let names = self.camera_names(&drawing.camera);
        scene::Drawing {
            title: drawing.title.clone(),
            width: drawing.width,
            hidden: match drawing.hidden {
                model::HiddenLines::Removed => scene::HiddenLines::Removed,
                model::HiddenLines::Dashed => scene::HiddenLines::Dashed,
                model::HiddenLines::Kept => scene::HiddenLines::Kept,
            },
            stroke: match drawing.stroke {
                model::StrokeBy::Uniform => scene::StrokeBy::Uniform,
                model::StrokeBy::Object => scene::StrokeBy::Object,
                model::StrokeBy::Material => scene::StrokeBy::Material,
                model::StrokeBy::Depth => scene::StrokeBy::Depth,
            },
            line_width: drawing.line_width,
            crease_angle: portable::radians(drawing.crease_angle),
            parameter_lines: drawing.parameter_lines,
            axes: match drawing.axes {
                Either::A(false) => None,
                Either::A(true) => Some(scene::AxesLength::Fitting),
                Either::B(length) => Some(scene::AxesLength::Length(length)),
            },
            ground_grid: drawing.ground_grid.as_ref().map(|grid| self.ground_grid(grid)),
            scale_bar: drawing.scale_bar,
            frame: drawing.frame,
            viewport: self.extent(drawing.viewport.value, &drawing.viewport.span, "the drawing's viewport"),
            points: drawing.point.iter().map(point).collect(),
            lines: drawing.line.iter().map(|line| self.line_mark(line, &names)).collect(),
            grids: drawing.grid.iter().map(|grid| self.grid_mark(grid)).collect(),
            cameras: drawing.camera.iter().map(|camera| self.camera_mark(&camera.value, picture_aspect)).collect(),
        }
    }

    /// Left, right, bottom and top, which must increase, and by no less than the smallest size that anything has.
    pub(super) fn extent(&mut self, [left, right, bottom, top]: [f64; 4], span: &Option<Span>, what: &str) -> Extent {
        for (low, low_name, high, high_name) in [(left, "left", right, "right"), (bottom, "bottom", top, "top")] {
            if high - low < SMALLEST {
                let size = match low.partial_cmp(&high) {
                    Some(Ordering::Less) => "is too small",
                    Some(Ordering::Greater) => "is turned around",
                    _ => "has no size",
                };
                let message = format!("{what} {size}: {low_name} is {} and {high_name} is {}", show(low), show(high));
                self.error(span, message, "[left, right, bottom, top]");
            }
        }
        Extent { left, right, bottom, top }
    }

    fn ground_grid(&mut self, grid: &Located<model::GroundGrid>) -> scene::GroundGrid {
        let model::GroundGrid { spacing, extent, height, center } = grid.value;
        if 2.0 * extent / spacing > MOST_GRID_LINES {
            let lines = (2.0 * extent / spacing).ceil();
            let message = format!(
                "the ground grid would have {lines} lines in each direction, more than the limit of {MOST_GRID_LINES}"
            );
            self.error(&grid.span, message, "too fine for its extent");
        }
        scene::GroundGrid { spacing, extent, height, center }
    }

    /// Where each named camera is in its list.
    fn camera_names<'m>(&mut self, cameras: &'m [Located<model::CameraMark>]) -> BTreeMap<&'m str, usize> {
        let mut names: BTreeMap<&str, usize> = BTreeMap::new();
        for (index, camera) in cameras.iter().enumerate() {
            let Some(name) = &camera.value.name else { continue };
            if let Some(first) = names.get(&*name.value) {
                let diagnostic = Diagnostic::error(format!("two drawn cameras have the name {:?}", name.value))
                    .at_optional(name.span.clone(), "the same name again");
                let first = cameras[*first].value.name.as_ref().and_then(|name| name.span.clone());
                self.diagnostics.push(match first {
                    Some(span) => diagnostic.related(span, "first defined here"),
                    None => diagnostic,
                });
            } else {
                names.insert(&name.value, index);
            }
        }
        names
    }

    fn line_mark(&mut self, line: &model::LineMark, names: &BTreeMap<&str, usize>) -> scene::LineMark {
        let project_to = line.project_to.as_ref().and_then(|name| {
            let found = names.get(&*name.value).copied();
            if found.is_none() {
                // With very many mistakes of this kind, comparing all names with all takes too long.
                let candidates =
                    names.keys().copied().take(if self.diagnostics.list.len() < 100 { names.len() } else { 0 });
                let help = match did_you_mean(&name.value, candidates) {
                    Some(near) => format!("did you mean {near:?}?"),
                    None if names.is_empty() => "define it as `[[drawing.camera]]` with this `name`".to_owned(),
                    None => {
                        let listed: Vec<String> = names.keys().take(8).map(|name| format!("{name:?}")).collect();
                        format!("there is {}", listed.join(", "))
                    }
                };
                self.diagnostics.push(
                    Diagnostic::error(format!("there is no drawn camera {:?}", name.value))
                        .at_optional(name.span.clone(), "not the name of any `[[drawing.camera]]`")
                        .help(help),
                );
            }
            found
        });
        scene::LineMark {
            label: line.label.clone(),
            points: line.points.iter().map(|point| Point3::from(*point)).collect(),
            arrow: line.arrow,
            dashed: line.dashed,
            color: line.color.0,
            width: line.width,
            can_be_hidden: line.can_be_hidden,
            label_at: line.label_at,
            offset: line.offset,
            project_to,
            steps: line.steps,
        }
    }

    fn grid_mark(&mut self, grid: &model::GridMark) -> scene::GridMark {
        let edges = grid.edges.value.map(Vector3::from);
        match edges.map(Vector3::try_normalize) {
            [Some(first), Some(second)] if first.cross(second).length() < super::view::PARALLEL => {
                self.error(&grid.edges.span, "the grid's edges are parallel, and so it has no area", "same direction");
            }
            [Some(_), Some(_)] => {}
            _ => self.error(&grid.edges.span, "an edge of the grid has no length", "three zeros"),
        }
        scene::GridMark {
            label: grid.label.clone(),
            corner: grid.corner.into(),
            edges,
            count: grid.count,
            color: grid.color.0,
            width: grid.width,
            can_be_hidden: grid.can_be_hidden,
        }
    }

    fn camera_mark(&mut self, mark: &model::CameraMark, picture_aspect: f64) -> scene::CameraMark {
        let view = &mark.view.value;
        let camera = self.camera(view);
        let window = match camera.frame {
            Frame::PerspectiveWindow { left, right, bottom, top, near, far }
            | Frame::OrthographicWindow { left, right, bottom, top, near, far } => {
                Some(((right - left) / (top - bottom), near, far))
            }
            _ => None,
        };
        if window.is_some() {
            for (given, key) in [(&mark.aspect, "aspect"), (&mark.near, "near")] {
                if let Some(given) = given {
                    let message = format!("the camera's view has a window, which says its `{key}` already");
                    self.error(&given.span, message, "leave this out");
                }
            }
        }
        let distance = match (&view.gaze, &view.look_at) {
            (Some(_), _) => USUAL_DISTANCE,
            (None, look_at) => {
                let at = look_at.as_ref().map_or(Point3::ORIGIN, |at| at.value.into());
                at.distance(view.eye.value.into())
            }
        };
        let aspect = window
            .map(|(aspect, ..)| aspect)
            .or(mark.aspect.as_ref().map(|aspect| aspect.value))
            .or(mark.pixels.map(|[x, y]| f64::from(x) / f64::from(y)))
            .unwrap_or(picture_aspect);
        let near =
            window.map(|(_, near, _)| near).or(mark.near.as_ref().map(|near| near.value)).unwrap_or(-0.25 * distance);
        let chosen_far = (-1.5 * distance).min(2.0 * near).min(near - 0.5 * distance);
        let window_far = window.map(|(.., far)| far).filter(|far| far.is_finite());
        if let (Some(far), Some(_)) = (&mark.far, window_far) {
            let message = "the camera's view has a window, which says its `far` already";
            self.error(&far.span, message, "leave this out");
        }
        let far = window_far.or(mark.far.as_ref().map(|far| far.value)).unwrap_or(chosen_far);
        if let Some(given) = &mark.far
            && far >= near
        {
            let (far, near) = (show(far), show(near));
            let message = format!("the drawn camera's far plane z = {far} is not beyond its near plane z = {near}");
            self.error(&given.span, message, "must be below `near`: the camera looks along −z");
        }
        scene::CameraMark {
            name: mark.name.as_ref().map(|name| name.value.clone()),
            camera,
            aspect,
            near,
            far,
            labels: mark.labels,
            axes: mark.axes,
            gaze: mark.gaze,
            up: mark.up,
            frustum: mark.frustum,
            picture: mark.picture,
            pixels: mark.pixels,
            color: mark.color.0,
        }
    }
}

fn point(point: &model::PointMark) -> scene::PointMark {
    scene::PointMark {
        label: point.label.clone(),
        position: point.position.into(),
        color: point.color.0,
        offset: point.offset,
        can_be_hidden: point.can_be_hidden,
        size: point.size,
    }
}

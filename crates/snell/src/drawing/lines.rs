//! All lines of a scene as a camera sees it, each with whose it is: gathered, followed in the picture, and divided into what is
//! seen and what is hidden.

use rayon::prelude::*;
use snell_math::{Bounds3, Homogeneous3};

use super::crossings::Crossings;
use super::meetings::{body, meetings};
use super::mesh::mesh_lines;
use super::screen::{Sample, Screen};
use super::visibility::{Part, Visibility};
use crate::geometry::{Form, Geometry, QueryScratch, WorldSurface};
use crate::outline::{self, Feature, FeatureKind, OutlineOptions};

/// How near to its true curve a chain of points is asked to be, in pixels.
const CHAIN: f64 = 0.002;

/// A line of the scene, or one of those that are drawn into it.
#[derive(Debug)]
pub struct Line {
    /// Its curve, in the world.
    pub feature: Feature,
    /// Its object, as a place in the scene's list of names.
    pub object: u32,
    /// Its material, as a place in the scene's list.
    pub material: u32,
    /// Where it is not of the scene, what it is of, as a place in the list of marks.
    pub mark: Option<usize>,
    /// What it belongs to hides it, whatever else does.
    surely_hidden: bool,
}

impl Line {
    /// A line that is not of the scene, but that things of the scene may hide.
    pub fn of_mark(feature: Feature, mark: usize) -> Self {
        Self { feature, object: 0, material: 0, mark: Some(mark), surely_hidden: false }
    }
}

/// A line with its parts inside of the picture.
#[derive(Debug)]
pub struct SeenLine {
    /// The line.
    pub line: Line,
    /// Seen and hidden parts.
    pub parts: Vec<Part>,
}

/// What lines there are to be.
#[derive(Clone, Copy, Debug)]
pub struct LineOptions {
    /// Edges of meshes are creases where their faces turn by more than this, radians.
    pub crease_angle: f64,
    /// Lines of constant u and of constant v on each curved shape.
    pub parameter_lines: u32,
}

/// The lines of everything in the scene, in the scene's order.
pub fn gather(geometry: &Geometry, screen: &Screen<'_>, options: &LineOptions) -> Vec<Line> {
    let surfaces = geometry.world_surfaces();
    let eye = screen.eye();
    let tolerance = |p| CHAIN * screen.pixel_length(p);
    let outline_options = OutlineOptions { parameter_lines: options.parameter_lines, tolerance: &tolerance };
    // A camera with a near plane of its own looks into things that the plane cuts open.
    let from_outside = screen.camera.planes()[0] == 0.0;
    let of_surface = |surface: &WorldSurface<'_>| -> Vec<Line> {
        let line = |feature, surely_hidden| Line {
            feature,
            object: surface.object,
            material: surface.material,
            mark: None,
            surely_hidden,
        };
        match surface.form {
            Form::Mesh(mesh, _) => {
                let lines = mesh_lines(surface, mesh, eye, options.crease_angle, from_outside);
                lines.drawn.into_iter().zip(lines.surely_hidden).map(|(f, hidden)| line(f, hidden)).collect()
            }
            _ => body(surface).map_or_else(Vec::new, |body| {
                outline::features(&body, eye, &outline_options).into_iter().map(|f| line(f, false)).collect()
            }),
        }
    };
    let mut lines: Vec<Line> = surfaces.par_iter().flat_map_iter(of_surface).collect();
    let of_meeting = |(index, feature): (usize, Feature)| {
        let WorldSurface { object, material, .. } = surfaces[index];
        Line { feature, object, material, mark: None, surely_hidden: false }
    };
    lines.extend(meetings(&surfaces, screen, &outline_options).into_iter().map(of_meeting));
    lines
}

/// Divides lines into what is seen and what is hidden. Those without any part in the picture are left out.
pub fn see(lines: Vec<Line>, geometry: &Geometry, screen: &Screen<'_>) -> Vec<SeenLine> {
    let tracks: Vec<Vec<Vec<Sample>>> = lines
        .par_iter()
        .map(|line| {
            let curve = &line.feature.curve;
            screen.intervals(curve).into_iter().map(|interval| screen.track(curve, interval)).collect()
        })
        .collect();
    let bounding = lines.iter().zip(&tracks).filter(|(line, _)| {
        line.mark.is_none() && !matches!(line.feature.kind, FeatureKind::Parameter | FeatureKind::Horizon)
    });
    let pieces = bounding.flat_map(|(_, tracks)| tracks).flat_map(|track| track.windows(2)).filter_map(|pair| {
        let [a, b] = *pair else { return None };
        Some([a.at, b.at])
    });
    let size = screen.pipeline.pixels.map(f64::from);
    let crossings = Crossings::new(size, pieces);
    let visibility = Visibility { screen, geometry, crossings: &crossings };
    lines
        .into_par_iter()
        .zip(tracks)
        .map_init(QueryScratch::default, |scratch, (line, tracks)| {
            let mut parts: Vec<Part> = Vec::new();
            for track in &tracks {
                match (line.surely_hidden, track.first(), track.last()) {
                    (true, Some(a), Some(b)) => {
                        parts.push(Part { from: a.t, to: b.t, visible: false, is_outline: false })
                    }
                    _ => parts.extend(visibility.parts(&line.feature, track, scratch)),
                }
            }
            join_around(&line.feature, &mut parts);
            SeenLine { line, parts }
        })
        .filter(|seen| !seen.parts.is_empty())
        .collect()
}

/// Joins the last part of a closed curve to the first where they are alike and meet.
fn join_around(feature: &Feature, parts: &mut Vec<Part>) {
    let [start, end] = feature.curve.domain();
    let (Some(first), Some(last)) = (parts.first().copied(), parts.last().copied()) else { return };
    let meet = feature.curve.is_closed() && first.from == start && last.to == end;
    if parts.len() > 1 && meet && first.visible == last.visible {
        parts.remove(0);
        if let Some(last) = parts.last_mut() {
            // Closed curves go on beyond their ends.
            last.to = end + (first.to - start);
        }
    }
}

/// The box around all that is finite in a scene.
pub fn finite_bounds(geometry: &Geometry) -> Bounds3 {
    let surfaces = geometry.world_surfaces();
    surfaces.iter().filter(|surface| surface.bounds.is_finite()).fold(Bounds3::EMPTY, |all, s| all.union(&s.bounds))
}

/// A straight line between two points, of which one may be a direction.
pub fn segment(a: impl Into<Homogeneous3>, b: impl Into<Homogeneous3>) -> Feature {
    Feature::new(FeatureKind::Crease, outline::Curve::Segment { a: a.into(), b: b.into() })
}

//! Where two surfaces meet in a curve without a simple form: found on a grid over one of them, then brought onto both.
//!
//! The surface of one is laid out by (u, v), and the height over the other is a function of these. Heights are distances, or less,
//! so a cell from whose middle the other surface is farther than its corners holds no piece of the curve; what is left is
//! halved again and again. In cells that are small against both surfaces the curve passes between corners of different signs:
//! marching squares, as Lorensen and Cline, "Marching Cubes", SIGGRAPH 1987, have it one dimension up. Its crossings with the
//! cells' edges lie on both surfaces to the last digits. Chords farther from the curve than the tolerance are divided, and
//! points that it does not need are left out.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use snell_math::{Bounds3, Point3, Transform, Vector3, portable};

use super::curve::Curve;
use super::meet::between;
use super::patch::{Limits, Patch, Surface};
use super::strand::{Strand, project};

/// Cells over the tighter direction of a surface, at the end: this many, or a little more.
const CELLS: f64 = 96.0;
/// Cells are smaller than this part of the other surface's least radius.
const DETAIL: f64 = 0.25;
/// The most cells that are looked at on one level: bounds time and memory.
const MAX_CELLS: usize = 60_000;
/// The most halvings of cells, and of chords.
const MAX_HALVINGS: u32 = 12;
/// The most points of one curve.
const MAX_POINTS: usize = 20_000;
/// Surfaces that cross at no larger an angle, in radians, touch.
const TANGENT: f64 = 1e-6;
/// Heights below this, relative to size, are rounding.
const ZERO: f64 = 1e-14;

/// The curves in which the surfaces of two pieces run through each other, within the limits of one of them at least.
pub(super) fn trace(a: &Patch, b: &Patch, tolerance: &dyn Fn(Point3) -> f64) -> Vec<Strand> {
    let is_round = |patch: &Patch| patch.surface != Surface::Plane;
    // The grid is on the more tightly bent one, so that its cells are soon small against the other.
    let (on, other) = if is_round(a) && (!is_round(b) || tight(a) <= tight(b)) { (a, b) } else { (b, a) };
    let Some(grid) = Grid::new(on, other) else { return Vec::new() };
    let onto = [*on, *other];
    let mut strands = Vec::new();
    for chain in grid.chains() {
        // Surfaces that touch along a line run through each other by rounding.
        let crosses = |&p: &Point3| {
            let [u, v] = onto.each_ref().map(|patch| patch.normal(p).unwrap_or(Vector3::ZERO));
            u.cross(v).length() > TANGENT
        };
        if !chain.iter().any(crosses) {
            continue;
        }
        let curve = Curve::Polyline(refined(&onto, &thinned(&chain, tolerance), tolerance));
        if curve.is_finite() {
            strands.push(Strand { curve, onto: Some(Box::new(onto)) });
        }
    }
    strands
}

/// About the least radius by which a surface bends, in space.
fn tight(patch: &Patch) -> f64 {
    let radius = match (patch.surface, patch.limits) {
        (Surface::Sphere { radius }, _) => radius,
        (Surface::Side { thin, slope }, Limits::Length(length)) => thin.max(0.25 * (thin + slope * length)),
        (Surface::Torus { minor, .. }, _) => minor,
        _ => f64::INFINITY,
    };
    radius * stretch(&patch.space_from_patch)
}

/// The cosines and sines of equal parts of an angle: `count` parts of `turn`, from `start`, and the end.
fn directions(start: f64, turn: f64, count: u32) -> Vec<[f64; 2]> {
    let at = |i: u32| start + turn * (f64::from(i) / f64::from(count));
    (0..=count).map(at).map(|angle| [portable::cos(angle), portable::sin(angle)]).collect()
}

/// A surface laid out by coordinates that run from 0 to `cells`.
struct Grid<'p> {
    on: &'p Patch,
    other: &'p Patch,
    other_from_on: Transform,
    /// A box around the other piece, in its coordinates.
    bounds: Bounds3,
    /// The range of z on a side.
    z: [f64; 2],
    /// How many cells each way.
    cells: [u32; 2],
    /// Cosines and sines for half steps along u, and along v where that is an angle.
    tables: [Vec<[f64; 2]>; 2],
    /// Heights this small are 0.
    zero: f64,
}

/// The lower left corner of a cell, or one end of an edge.
type Corner = [u32; 2];
/// An edge from a corner along u (0) or v (1).
type Edge = (Corner, u8);

impl<'p> Grid<'p> {
    fn new(on: &'p Patch, other: &'p Patch) -> Option<Self> {
        let other_from_on = between(on, other);
        let bounds = other.bounds();
        let mut z = [0.0, 0.0];
        if let Limits::Length(length) = on.limits {
            z = [0.0, length];
            if bounds.is_finite() {
                let there = on.space_from_patch.inverse().bounds(&bounds);
                let margin = 1e-3 * length;
                z = [(there.min.z() - margin).max(0.0), (there.max.z() + margin).min(length)];
            }
            if z[0] >= z[1] {
                return None;
            }
        }
        // About square cells to begin with.
        let ratio = |long: f64, short: f64| ((8.0 * long / short).ceil().clamp(8.0, 512.0)) as u32;
        let cells = match on.surface {
            Surface::Plane => return None,
            Surface::Sphere { .. } => [16, 8],
            Surface::Side { thin, slope } => {
                let radius = (thin + slope * z[1]).max(thin + slope * z[0]);
                let [around, along] = [TAU * radius, (z[1] - z[0]) * (1.0 + slope * slope).sqrt()];
                if around > along { [ratio(around, along), 8] } else { [8, ratio(along, around)] }
            }
            Surface::Torus { major, minor } => [ratio(major + minor, minor), 8],
        };
        let size = on.local_bounds().diagonal().length();
        let zero = ZERO * stretch(&other_from_on) * size;
        let bounds = other.local_bounds();
        let mut grid = Self { on, other, other_from_on, bounds, z, cells, tables: [Vec::new(), Vec::new()], zero };
        grid.tabulate();
        Some(grid)
    }

    /// For the number of cells there is now.
    fn tabulate(&mut self) {
        let [along, up] = self.cells.map(|count| 2 * count);
        let up = match self.on.surface {
            Surface::Sphere { .. } => directions(-0.5 * PI, PI, up),
            Surface::Torus { .. } => directions(0.0, TAU, up),
            _ => Vec::new(),
        };
        self.tables = [directions(0.0, TAU, along), up];
    }

    /// The point at grid coordinates, in the coordinates of the surface it is on.
    fn local(&self, u: f64, v: f64) -> Vector3 {
        let [along, up] = [u / f64::from(self.cells[0]), v / f64::from(self.cells[1])];
        let direction = |angle: f64| [portable::cos(angle), portable::sin(angle)];
        let inclination = match self.on.surface {
            Surface::Sphere { .. } => direction(PI * (up - 0.5)),
            Surface::Torus { .. } => direction(TAU * up),
            _ => [0.0, 0.0],
        };
        self.laid_out(direction(TAU * along), inclination, up)
    }

    /// From the directions of both angles, and how far up it is on a side.
    #[inline]
    fn laid_out(&self, [cos, sin]: [f64; 2], [out, rise]: [f64; 2], up: f64) -> Vector3 {
        let (axial, z) = match self.on.surface {
            Surface::Plane => (0.0, 0.0),
            Surface::Sphere { radius } => (radius * out, radius * rise),
            Surface::Side { thin, slope } => {
                let z = self.z[0] + (self.z[1] - self.z[0]) * up;
                (thin + slope * z, z)
            }
            Surface::Torus { major, minor } => (major + minor * out, minor * rise),
        };
        Vector3::new(axial * cos, axial * sin, z)
    }

    /// The point at half steps of the grid, in the coordinates of the other surface.
    #[inline]
    fn there(&self, i: u32, j: u32) -> Vector3 {
        let inclination = self.tables[1].get(j as usize).copied().unwrap_or_default();
        let up = 0.5 * f64::from(j) / f64::from(self.cells[1]);
        let local = self.laid_out(self.tables[0][i as usize], inclination, up);
        self.other_from_on.point(Point3::ORIGIN + local).to_vector()
    }

    /// The height over the other surface at any grid coordinates.
    fn height(&self, u: f64, v: f64) -> f64 {
        let there = self.other_from_on.point(Point3::ORIGIN + self.local(u, v));
        self.other.surface.height(there.to_vector())
    }

    fn is_above(&self, [i, j]: Corner) -> bool {
        self.other.surface.height(self.there(2 * i, 2 * j)) > self.zero
    }

    /// Brought back into the grid where it runs around.
    fn wrapped(&self, [i, j]: Corner) -> Corner {
        let around = matches!(self.on.surface, Surface::Torus { .. });
        [i % self.cells[0], if around { j % self.cells[1] } else { j }]
    }

    /// How far the corners of a cell are from its middle, and at least how far that is from the other piece.
    fn reach_and_distance(&self, [i, j]: Corner) -> (f64, f64) {
        let (i, j) = (2 * i, 2 * j);
        let middle = self.there(i + 1, j + 1);
        // Of a surface that bends, also the middles of the sides.
        let around = [[0, 0], [1, 0], [2, 0], [0, 1], [2, 1], [0, 2], [1, 2], [2, 2]];
        let squared = |[di, dj]: [u32; 2]| (self.there(i + di, j + dj) - middle).length_squared();
        let reach = around.map(squared).into_iter().fold(0.0, f64::max).sqrt();
        let beside = (self.bounds.min.0 - middle.0).max(middle.0 - self.bounds.max.0).max_element();
        (reach, self.other.surface.height(middle).abs().max(beside))
    }

    /// The cells that the curve may pass through, after the grid was made fine enough.
    fn fine_cells(&mut self) -> Vec<Corner> {
        let all = (0..self.cells[0]).flat_map(|i| (0..self.cells[1]).map(move |j| [i, j]));
        let mut open: Vec<Corner> = all.collect();
        let detail = DETAIL * tight(self.other) / stretch(&self.other.space_from_patch);
        for _ in 0..MAX_HALVINGS {
            let mut largest = 0.0_f64;
            open.retain(|&cell| {
                let (reach, distance) = self.reach_and_distance(cell);
                // A margin for what bulges out between the points that were looked at.
                let stays = distance <= 1.25 * reach + self.zero;
                largest = largest.max(if stays { reach } else { 0.0 });
                stays
            });
            let is_fine = f64::from(self.cells[0].min(self.cells[1])) >= CELLS && largest <= detail;
            if is_fine || open.is_empty() || open.len() * 4 > MAX_CELLS {
                break;
            }
            self.cells = self.cells.map(|count| 2 * count);
            self.tabulate();
            open = open
                .iter()
                .flat_map(|&[i, j]| [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[a, b]| [2 * i + a, 2 * j + b]))
                .collect();
        }
        open
    }

    /// The curves as points on the grid's edges; closed ones end where they begin.
    fn chains(mut self) -> Vec<Vec<Point3>> {
        let cells = self.fine_cells();
        let mut neighbours: BTreeMap<Edge, [Option<Edge>; 2]> = BTreeMap::new();
        let mut join = |a: Edge, b: Edge| {
            for (from, to) in [(a, b), (b, a)] {
                let slots = neighbours.entry(from).or_default();
                if let Some(slot) = slots.iter_mut().find(|slot| slot.is_none()) {
                    *slot = Some(to);
                }
            }
        };
        for [i, j] in cells {
            // Corners and edges counter-clockwise; edge k is between corners k and k + 1.
            let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(|corner| self.wrapped(corner));
            let edges: [Edge; 4] = [(corners[0], 0), (corners[1], 1), (corners[3], 0), (corners[0], 1)];
            let above = corners.map(|corner| self.is_above(corner));
            let crossed: Vec<usize> = (0..4).filter(|&k| above[k] != above[(k + 1) % 4]).collect();
            match crossed[..] {
                [a, b] => join(edges[a], edges[b]),
                [_, _, _, _] => {
                    // A saddle: the middle tells which corners belong together.
                    let middle = self.other.surface.height(self.there(2 * i + 1, 2 * j + 1)) > self.zero;
                    let pairs = if middle == above[0] { [(0, 1), (2, 3)] } else { [(3, 0), (1, 2)] };
                    for (a, b) in pairs {
                        join(edges[a], edges[b]);
                    }
                }
                _ => {}
            }
        }
        self.linked(neighbours)
    }

    fn linked(&self, mut neighbours: BTreeMap<Edge, [Option<Edge>; 2]>) -> Vec<Vec<Point3>> {
        let ends: Vec<Edge> = neighbours.iter().filter(|(_, to)| to[1].is_none()).map(|(&edge, _)| edge).collect();
        let mut chains = Vec::new();
        let mut ends = ends.into_iter();
        loop {
            // Open ones first, then what is left is closed.
            let begin = ends.find(|edge| neighbours.contains_key(edge));
            let Some(begin) = begin.or_else(|| neighbours.keys().next().copied()) else { return chains };
            let mut chain = vec![self.crossing(begin)];
            let (mut edge, mut is_closed) = (begin, false);
            while let Some(next) = neighbours.remove(&edge) {
                let Some(to) = next.into_iter().flatten().find(|to| neighbours.contains_key(to)) else {
                    is_closed = chain.len() > 2 && next.contains(&Some(begin));
                    break;
                };
                chain.push(self.crossing(to));
                edge = to;
            }
            // Where the coordinates run together, at poles and tips, edges have no length.
            let is_same = |a: Point3, b: Point3| a.distance(b) <= 1e-13 * (a.max_abs() + self.on.size());
            chain.dedup_by(|a, b| is_same(*a, *b));
            if is_closed {
                while chain.len() > 1 && is_same(chain[0], chain[chain.len() - 1]) {
                    chain.pop();
                }
                chain.push(chain[0]);
            }
            if chain.len() > if is_closed { 3 } else { 1 } {
                chains.push(chain);
            }
        }
    }

    /// Where the curve crosses an edge, in space: false position with the Illinois rule, kept within the bracket.
    fn crossing(&self, (corner, along): Edge) -> Point3 {
        let [u, v] = corner.map(f64::from);
        let at = |t: f64| if along == 0 { [u + t, v] } else { [u, v + t] };
        let height = |t: f64| self.height(at(t)[0], at(t)[1]);
        let (mut low, mut high) = (0.0, 1.0);
        let (mut below, mut above) = (height(low), height(high));
        let mut t = 0.5;
        let mut last_side = 0;
        for turn in 0..80 {
            let guess = (low * above - high * below) / (above - below);
            // Every third turn halves, so that the end is sure.
            t = if turn % 3 < 2 && guess > low && guess < high { guess } else { 0.5 * (low + high) };
            let value = height(t);
            if value == 0.0 || high - low <= f64::EPSILON {
                break;
            }
            if (value > 0.0) == (above > 0.0) {
                (high, above) = (t, value);
                below *= if last_side == 1 { 0.5 } else { 1.0 };
                last_side = 1;
            } else {
                (low, below) = (t, value);
                above *= if last_side == -1 { 0.5 } else { 1.0 };
                last_side = -1;
            }
        }
        let [u, v] = at(t);
        self.on.space_from_patch.point(Point3::ORIGIN + self.local(u, v))
    }
}

/// About how much longer a map makes lengths.
pub(super) fn stretch(map: &Transform) -> f64 {
    let matrix = map.affine().matrix3;
    matrix.x_axis.length().max(matrix.y_axis.length()).max(matrix.z_axis.length())
}

/// The points with others between where a chord is too far from the curve.
fn refined(onto: &[Patch; 2], points: &[Point3], tolerance: &dyn Fn(Point3) -> f64) -> Vec<Point3> {
    let mut fine: Vec<Point3> = points.first().copied().into_iter().collect();
    for pair in points.windows(2) {
        let mut open = vec![(pair[0], pair[1], 0)];
        while let Some((from, to, halvings)) = open.pop() {
            let middle = from.lerp(to, 0.5);
            let on_curve = project(onto, middle, to - from);
            let bound = 0.5 * tolerance(middle);
            // A point that went astray says nothing.
            let sag = on_curve.map(|p| (p, p.distance(middle))).filter(|&(_, sag)| sag < from.distance(to));
            match sag {
                Some((p, sag)) if sag > bound && halvings < MAX_HALVINGS && fine.len() < MAX_POINTS => {
                    open.push((p, to, halvings + 1));
                    open.push((from, p, halvings + 1));
                }
                _ => fine.push(to),
            }
        }
    }
    fine
}

/// Without the points that no chord needs: Douglas and Peucker, "Algorithms for the reduction of the number of points", 1973.
fn thinned(points: &[Point3], tolerance: &dyn Fn(Point3) -> f64) -> Vec<Point3> {
    let Some(last) = points.len().checked_sub(1).filter(|&last| last > 1) else { return points.to_vec() };
    let is_closed = points[0] == points[last];
    let mut is_kept = vec![false; points.len()];
    (is_kept[0], is_kept[last]) = (true, true);
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        let (a, along) = (points[from], points[to] - points[from]);
        let square = along.length_squared();
        let distance = |p: Point3| {
            let v = p - a;
            let t = if square > 0.0 { (v.dot(along) / square).clamp(0.0, 1.0) } else { 0.0 };
            (v - along * t).length()
        };
        let farthest = (from + 1..to).map(|i| (distance(points[i]), i)).max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((far, i)) = farthest
            && (far > 0.5 * tolerance(points[i]) || is_closed && to - from == last)
        {
            is_kept[i] = true;
            open.extend([(from, i), (i, to)]);
        }
    }
    // A closed curve stays one: three corners at least.
    if is_closed && is_kept.iter().filter(|&&kept| kept).count() < 4 {
        is_kept[last / 3] = true;
        is_kept[2 * last / 3] = true;
    }
    points.iter().zip(is_kept).filter(|(_, kept)| *kept).map(|(&p, _)| p).collect()
}

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

use snell_math::{Point3, Transform, Vector3, portable};

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
/// Heights below this, relative to size, are rounding.
const ZERO: f64 = 1e-14;

/// The curves in which the surfaces of two pieces run through each other, within the limits of one of them at least.
pub(super) fn trace(a: &Patch, b: &Patch, tolerance: &dyn Fn(Point3) -> f64) -> Vec<Strand> {
    let is_round = |patch: &Patch| patch.surface != Surface::Plane;
    let (on, other) = if is_round(a) && (!is_round(b) || a.size() <= b.size()) { (a, b) } else { (b, a) };
    let Some(grid) = Grid::new(on, other) else { return Vec::new() };
    let onto = [*on, *other];
    let mut strands = Vec::new();
    for chain in grid.chains() {
        let points = refined(&onto, chain, tolerance);
        let curve = Curve::Polyline(thinned(&points, tolerance));
        if curve.is_finite() {
            strands.push(Strand { curve, onto: Some(Box::new(onto)) });
        }
    }
    strands
}

/// A surface laid out by coordinates that run from 0 to `cells`.
struct Grid<'p> {
    on: &'p Patch,
    other: &'p Patch,
    other_from_on: Transform,
    /// The range of z on a side.
    z: [f64; 2],
    /// How many cells each way.
    cells: [u32; 2],
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
                let [around, along] = [TAU * radius, z[1] - z[0]];
                if around > along { [ratio(around, along), 8] } else { [8, ratio(along, around)] }
            }
            Surface::Torus { major, minor } => [ratio(major + minor, minor), 8],
        };
        let size = on.local_bounds().diagonal().length();
        let zero = ZERO * stretch(&other_from_on) * size;
        Some(Self { on, other, other_from_on, z, cells, zero })
    }

    /// The point at grid coordinates, in the coordinates of the surface it is on.
    fn local(&self, u: f64, v: f64) -> Vector3 {
        let [along, up] = [u / f64::from(self.cells[0]), v / f64::from(self.cells[1])];
        let angle = TAU * along;
        let (cos, sin) = (portable::cos(angle), portable::sin(angle));
        match self.on.surface {
            Surface::Plane => Vector3::ZERO,
            Surface::Sphere { radius } => {
                let latitude = PI * (up - 0.5);
                let equator = portable::cos(latitude) * radius;
                Vector3::new(equator * cos, equator * sin, portable::sin(latitude) * radius)
            }
            Surface::Side { thin, slope } => {
                let z = self.z[0] + (self.z[1] - self.z[0]) * up;
                let radius = thin + slope * z;
                Vector3::new(radius * cos, radius * sin, z)
            }
            Surface::Torus { major, minor } => {
                let around = TAU * up;
                let axial = major + minor * portable::cos(around);
                Vector3::new(axial * cos, axial * sin, minor * portable::sin(around))
            }
        }
    }

    /// In the coordinates of the other surface.
    fn there(&self, u: f64, v: f64) -> Vector3 {
        self.other_from_on.point(Point3::ORIGIN + self.local(u, v)).to_vector()
    }

    fn height(&self, u: f64, v: f64) -> f64 {
        self.other.surface.height(self.there(u, v))
    }

    fn is_above(&self, [i, j]: Corner) -> bool {
        self.height(f64::from(i), f64::from(j)) > self.zero
    }

    /// Brought back into the grid where it runs around.
    fn wrapped(&self, [i, j]: Corner) -> Corner {
        let around = matches!(self.on.surface, Surface::Torus { .. });
        [i % self.cells[0], if around { j % self.cells[1] } else { j }]
    }

    /// How far the corners of a cell are from its middle, and that from the other surface.
    fn reach_and_height(&self, [i, j]: Corner) -> (f64, f64) {
        let [u, v] = [f64::from(i), f64::from(j)];
        let middle = self.there(u + 0.5, v + 0.5);
        // Of a surface that bends, also the middles of the sides.
        let around = [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [0.0, 0.5], [1.0, 0.5], [0.0, 1.0], [0.5, 1.0], [1.0, 1.0]];
        let reach = around.iter().map(|[du, dv]| (self.there(u + du, v + dv) - middle).length()).fold(0.0, f64::max);
        (reach, self.other.surface.height(middle))
    }

    /// The cells that the curve may pass through, after the grid was made fine enough.
    fn fine_cells(&mut self) -> Vec<Corner> {
        let all = (0..self.cells[0]).flat_map(|i| (0..self.cells[1]).map(move |j| [i, j]));
        let mut open: Vec<Corner> = all.collect();
        let tight = match self.other.surface {
            Surface::Plane => f64::INFINITY,
            Surface::Sphere { radius } => radius,
            Surface::Side { thin, slope } => match self.other.limits {
                Limits::Length(length) => thin.max(0.25 * (thin + slope * length)),
                _ => f64::INFINITY,
            },
            Surface::Torus { minor, .. } => minor,
        };
        for _ in 0..MAX_HALVINGS {
            let mut largest = 0.0_f64;
            open.retain(|&cell| {
                let (reach, height) = self.reach_and_height(cell);
                // A margin for what bulges out between the points that were looked at.
                let stays = height.abs() <= 1.25 * reach + self.zero;
                largest = largest.max(if stays { reach } else { 0.0 });
                stays
            });
            let is_fine = f64::from(self.cells[0].min(self.cells[1])) >= CELLS && largest <= DETAIL * tight;
            if is_fine || open.is_empty() || open.len() * 4 > MAX_CELLS {
                break;
            }
            self.cells = self.cells.map(|count| 2 * count);
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
                    let middle = self.height(f64::from(i) + 0.5, f64::from(j) + 0.5) > self.zero;
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
fn stretch(map: &Transform) -> f64 {
    let matrix = map.affine().matrix3;
    matrix.x_axis.length().max(matrix.y_axis.length()).max(matrix.z_axis.length())
}

/// The points with others between where a chord is too far from the curve.
fn refined(onto: &[Patch; 2], points: Vec<Point3>, tolerance: &dyn Fn(Point3) -> f64) -> Vec<Point3> {
    let mut fine: Vec<Point3> = points.first().copied().into_iter().collect();
    for pair in points.windows(2) {
        let mut open = vec![(pair[0], pair[1], 0)];
        while let Some((from, to, halvings)) = open.pop() {
            let middle = from.lerp(to, 0.5);
            let on_curve = project(onto, middle, to - from);
            let bound = 0.3 * tolerance(middle);
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
            && (far > 0.6 * tolerance(points[i]) || is_closed && to - from == last)
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

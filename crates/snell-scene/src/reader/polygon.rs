//! Polygons into triangles: of any shape and in any plane, without holes (but for ones joined to the border by a cut).
//!
//! The polygon is projected along the largest component of its normal, which is found by Newell's method (Sutherland et al.
//! 1974; Tampieri, "Newell's method for computing the plane equation of a polygon", Graphics Gems III, 1992). A convex one
//! becomes a fan; from any other one, ears are cut (Meisters 1975): corners whose triangle holds no reflex corner. Lengths
//! in the space of the points.
//!
//! A cut changes what its two neighbours are, so these are looked at again, and all others only once nothing is left to
//! look at (Eberly, "Triangulation by ear clipping", 1998). That takes time in proportion to the corners times the reflex ones
//! as a rule, but longer for polygons that cross themselves. So the steps are counted: a polygon that needs too many is
//! finished without looking, and [`Triangulator`] bounds the steps for all polygons of one file. (The `earcutr` crate has no
//! such bound: 1300 corners at eight places, as fuzzing found, take it half a minute.)

use std::collections::VecDeque;

use snell_math::Point3;

/// One polygon may take that many steps times the square of its number of corners; …
const WORK_PER_SQUARE: u64 = 8;
/// … all polygons of a file that many, …
const BASE_WORK: u64 = 2_000_000_000;
/// … and further steps for every corner that the file really has.
const WORK_PER_CORNER: u64 = 500;
/// The end of a list.
const NONE: u32 = u32::MAX;

/// Polygons that are not convex would take too long: they have too many corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("polygons that are not convex have too many corners to be cut into triangles")]
pub struct TooComplex;

/// Turns one polygon into triangles: triples of places in `corners`, turning the way the polygon does.
///
/// A polygon with fewer than three corners or without area gives nothing. Repeated and collinear corners are allowed. One
/// that is bent or crosses itself gives some triangles that cover about the same.
///
/// # Errors
/// [`TooComplex`] where it would take too long: possible beyond some ten thousand corners, unless it is convex.
///
/// ```
/// use snell_math::Point3;
/// use snell_scene::reader::polygon::triangulate;
/// let arrow = [[0.0, 0.0], [2.0, -1.0], [0.0, 1.0], [-2.0, -1.0]].map(|[x, y]| Point3::new(x, y, 0.0));
/// assert_eq!(triangulate(&arrow).unwrap().len(), 2);
/// ```
pub fn triangulate(corners: &[Point3]) -> Result<Vec<[u32; 3]>, TooComplex> {
    let mut triangles = Vec::new();
    Triangulator::default().triangulate(corners.iter().map(|p| p.to_array()), &mut triangles)?;
    Ok(triangles)
}

/// Turns the polygons of one file into triangles, within bounded time.
#[derive(Debug, Default)]
pub struct Triangulator {
    /// Corners seen and work done.
    corners: u64,
    work: u64,
    points: Vec<[f64; 3]>,
    flat: Vec<[f64; 2]>,
    /// The corners that are left, as a ring.
    next: Vec<u32>,
    previous: Vec<u32>,
    /// Those where the polygon does not turn left, in any order, and each corner's place among them or [`NONE`].
    reflex: Vec<u32>,
    place: Vec<u32>,
    /// Corners to look at, each at most once.
    queue: VecDeque<u32>,
    queued: Vec<bool>,
}

/// What may be an ear.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Care {
    /// No reflex corner in the triangle or on its border.
    Strict,
    /// Reflex corners at the triangle's own corners are allowed, as where a hole is joined to the border.
    Relaxed,
    /// Any corner where the polygon turns left: it crosses itself.
    None,
}

impl Triangulator {
    /// For one of so many parts of a file, of which none may use up the steps of another.
    pub(crate) fn with_share(parts: u64) -> Self {
        Self { work: BASE_WORK - BASE_WORK / parts.max(1), ..Self::default() }
    }

    /// Appends the triangles of one polygon as [`triangulate`] gives them.
    ///
    /// # Errors
    /// [`TooComplex`]: this polygon, or all of them so far, would take too long.
    pub fn triangulate(
        &mut self,
        corners: impl IntoIterator<Item = [f64; 3]>,
        triangles: &mut Vec<[u32; 3]>,
    ) -> Result<(), TooComplex> {
        self.points.clear();
        self.points.extend(corners);
        let count = self.points.len();
        self.corners += count as u64;
        if count < 3 || !self.flatten() {
            return Ok(());
        }
        if count == 3 || is_convex(&self.flat) {
            triangles.extend((1..count as u32 - 1).map(|i| [0, i, i + 1]));
            return Ok(());
        }
        if self.cut_ears(triangles) { Ok(()) } else { Err(TooComplex) }
    }

    /// Cuts ears off the flat polygon. False where the steps are used up.
    fn cut_ears(&mut self, triangles: &mut Vec<[u32; 3]>) -> bool {
        let count = self.flat.len() as u32;
        self.next.clear();
        self.next.extend((1..count).chain([0]));
        self.previous.clear();
        self.previous.extend([count - 1].into_iter().chain(0..count - 1));
        self.reflex.clear();
        self.place.clear();
        self.place.resize(count as usize, NONE);
        (0..count).for_each(|corner| self.classify(corner));

        self.queue.clear();
        self.queued.clear();
        self.queued.resize(count as usize, false);
        // Every second corner first: triangles become less thin than in the order of the ring.
        (0..count).step_by(2).chain((1..count).step_by(2)).for_each(|corner| self.look_at(corner));

        let enough = self.work + WORK_PER_SQUARE * u64::from(count) * u64::from(count);
        let limit = BASE_WORK + WORK_PER_CORNER * self.corners;
        let (mut left, mut corner, mut care, mut any_cut) = (count, 0, Care::Strict, false);
        while left >= 3 {
            let Some(candidate) = self.queue.pop_front() else {
                // Look at all again, less carefully if that has just been done in vain.
                care = match care {
                    _ if any_cut => care,
                    Care::Strict => Care::Relaxed,
                    Care::Relaxed => Care::None,
                    // It turns right everywhere: what is left has been gone round the other way.
                    Care::None => return true,
                };
                any_cut = false;
                for _ in 0..left {
                    self.look_at(corner);
                    corner = self.next[corner as usize];
                }
                continue;
            };
            self.work += 1;
            self.queued[candidate as usize] = false;
            if self.next[candidate as usize] == NONE {
                continue;
            }
            let (a, b, c) = (self.previous[candidate as usize], candidate, self.next[candidate as usize]);
            let turn = self.turn(b);
            let ear = turn > 0.0 && (care == Care::None || self.is_empty(a, b, c, care));
            if ear || turn == 0.0 {
                if ear {
                    triangles.push([a, b, c]);
                }
                self.remove(a, b, c);
                (left, corner, any_cut) = (left - 1, c, true);
                care = if self.work < enough { Care::Strict } else { Care::None };
                self.look_at(a);
                self.look_at(c);
            }
            if self.work > limit {
                return false;
            }
        }
        true
    }

    fn look_at(&mut self, corner: u32) {
        if !std::mem::replace(&mut self.queued[corner as usize], true) {
            self.queue.push_back(corner);
        }
    }

    /// How a corner turns: positive to the left, twice the area of its triangle.
    fn turn(&self, corner: u32) -> f64 {
        let [a, b, c] = [self.previous[corner as usize], corner, self.next[corner as usize]];
        cross(self.flat[a as usize], self.flat[b as usize], self.flat[c as usize])
    }

    /// Puts a corner on the list of reflex ones, or takes it off.
    fn classify(&mut self, corner: u32) {
        let (reflex, place) = (self.turn(corner) <= 0.0, self.place[corner as usize]);
        if reflex && place == NONE {
            self.place[corner as usize] = self.reflex.len() as u32;
            self.reflex.push(corner);
        } else if !reflex {
            self.forget(corner);
        }
    }

    fn forget(&mut self, corner: u32) {
        let place = std::mem::replace(&mut self.place[corner as usize], NONE);
        if place != NONE {
            self.reflex.swap_remove(place as usize);
            if let Some(&moved) = self.reflex.get(place as usize) {
                self.place[moved as usize] = place;
            }
        }
    }

    /// Takes b out of the ring.
    fn remove(&mut self, a: u32, b: u32, c: u32) {
        self.next[a as usize] = c;
        self.previous[c as usize] = a;
        self.next[b as usize] = NONE;
        self.forget(b);
        self.classify(a);
        self.classify(c);
    }

    /// True where no reflex corner of the ring is in the triangle.
    fn is_empty(&mut self, a: u32, b: u32, c: u32, care: Care) -> bool {
        self.work += self.reflex.len() as u64 + 1;
        let [pa, pb, pc] = [a, b, c].map(|corner| self.flat[corner as usize]);
        let low = [0, 1].map(|i| pa[i].min(pb[i]).min(pc[i]));
        let high = [0, 1].map(|i| pa[i].max(pb[i]).max(pc[i]));
        self.reflex.iter().all(|&corner| {
            let p = self.flat[corner as usize];
            p[0] < low[0]
                || p[0] > high[0]
                || p[1] < low[1]
                || p[1] > high[1]
                || cross(pa, pb, p) < 0.0
                || cross(pb, pc, p) < 0.0
                || cross(pc, pa, p) < 0.0
                || [a, b, c].contains(&corner)
                || care == Care::Relaxed && [pa, pb, pc].contains(&p)
        })
    }

    /// Projects the points so that the polygon turns counter-clockwise, with coordinates in [−1, 1]. False where it has no
    /// area or a point is not finite.
    fn flatten(&mut self) -> bool {
        let origin = self.points[0];
        let relative = |p: [f64; 3]| [0, 1, 2].map(|i| p[i] - origin[i]);
        let mut size = 0.0f64;
        for &p in &self.points {
            let relative = relative(p);
            if relative.iter().any(|c| !c.is_finite()) {
                return false;
            }
            size = relative.iter().fold(size, |size, c| size.max(c.abs()));
        }
        if size < f64::MIN_POSITIVE {
            return false;
        }
        let scaled = |p: [f64; 3]| relative(p).map(|c| c / size);
        let mut normal = [0.0f64; 3];
        let mut before = scaled(self.points[self.points.len() - 1]);
        for &p in &self.points {
            let here = scaled(p);
            for (i, n) in normal.iter_mut().enumerate() {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                *n += (before[j] - here[j]) * (before[k] + here[k]);
            }
            before = here;
        }
        let axis = (0..3).fold(0, |best, i| if normal[i].abs() > normal[best].abs() { i } else { best });
        if normal[axis] == 0.0 {
            return false;
        }
        let (u, v) =
            if normal[axis] > 0.0 { ((axis + 1) % 3, (axis + 2) % 3) } else { ((axis + 2) % 3, (axis + 1) % 3) };
        self.flat.clear();
        self.flat.extend(self.points.iter().map(|&p| scaled(p)).map(|p| [p[u], p[v]]));
        true
    }
}

/// Twice the signed area of a triangle in the plane.
fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])
}

/// True where a counter-clockwise polygon turns left everywhere and goes round once: each coordinate rises and falls once.
fn is_convex(points: &[[f64; 2]]) -> bool {
    let count = points.len();
    let mut turns = [0u32; 2];
    let mut direction = [0i8; 2];
    let mut first = [0i8; 2];
    let mut before = points[count - 1];
    let mut before_that = points[count - 2];
    for &here in points {
        if cross(before_that, before, here) < 0.0 {
            return false;
        }
        for i in 0..2 {
            let step = if here[i] > before[i] { 1 } else { -i8::from(here[i] < before[i]) };
            if step != 0 {
                turns[i] += u32::from(direction[i] != 0 && direction[i] != step);
                direction[i] = step;
                if first[i] == 0 {
                    first[i] = step;
                }
            }
        }
        (before_that, before) = (before, here);
    }
    (0..2).all(|i| turns[i] + u32::from(first[i] != direction[i]) <= 2)
}

#[cfg(test)]
#[path = "polygon_tests.rs"]
mod tests;

//! Polygons into triangles: of any shape and in any plane, without holes.
//!
//! The polygon is projected along the largest component of its normal, which is found by Newell's method (Sutherland et al.
//! 1974; Tampieri, "Newell's method for computing the plane equation of a polygon", Graphics Gems III, 1992). A convex one
//! becomes a fan, any other one goes through ear clipping (the `earcutr` crate, after Held's FIST, 2001). Lengths in the
//! space of the points.
//!
//! Ear clipping takes quadratic time in the worst case, so [`Triangulator`] bounds the work on all polygons of one file.

use snell_math::Point3;

/// The most corners of a polygon that is not convex.
const MAX_CONCAVE_CORNERS: usize = 16_384;
/// Steps that one file's polygons that are not convex may take together (the sum of their squared numbers of corners), …
const BASE_WORK: u64 = 1_000_000_000;
/// … and further steps for every corner that the file really has.
const WORK_PER_CORNER: u64 = 500;

/// The polygons that are not convex would take too long: too many corners, or too many such polygons.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "polygons that are not convex have too many corners (at most {MAX_CONCAVE_CORNERS} each, fewer where there are many)"
)]
pub struct TooComplex;

/// Turns one polygon into triangles: triples of places in `corners`, turning the way the polygon does.
///
/// A polygon with fewer than three corners or without area gives nothing. Repeated and collinear corners are allowed. One
/// that is bent or crosses itself gives some triangles that cover about the same.
///
/// # Errors
/// [`TooComplex`] beyond 16384 corners, unless it is convex.
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
}

impl Triangulator {
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
        self.work += (count * count) as u64;
        if count > MAX_CONCAVE_CORNERS || self.work > BASE_WORK + WORK_PER_CORNER * self.corners {
            return Err(TooComplex);
        }
        // The library fails for numbers that are not finite alone, and there are none.
        let Ok(indices) = earcutr::earcut(self.flat.as_flattened(), &[], 2) else { return Ok(()) };
        for triangle in indices.as_chunks::<3>().0 {
            let [a, b, c] = triangle.map(|i| i as u32);
            let area = cross(self.flat[a as usize], self.flat[b as usize], self.flat[c as usize]);
            triangles.push(if area < 0.0 { [a, c, b] } else { [a, b, c] });
        }
        Ok(())
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

//! Homogeneous coordinates: points of space as lines through the origin of 4-space, and the 4 × 4 matrices that map them.
//!
//! (x, y, z, h) with h ≠ 0 stands for the point (x/h, y/h, z/h), and every multiple of it for the same one; with h = 0 it is a
//! direction, a point at infinity. Perspective is linear in these coordinates: Shirley et al., *Fundamentals of Computer
//! Graphics*, 3rd ed., section 7.3; Blinn, "A Trip Down the Graphics Pipeline", IEEE CG&A 11(3), 1991.

use glam::{DMat4, DVec4};

use crate::{Point3, Vector3};

/// Homogeneous coordinates (x, y, z, h) of a point of space, or of a direction.
///
/// ```
/// use snell_math::{Homogeneous3, Point3};
/// let point = Point3::new(2.0, 11.0, 7.0);
/// assert_eq!(Homogeneous3::new(22.0, 121.0, 77.0, 11.0).homogenize(), Ok(point));
/// assert_eq!(Homogeneous3::new(1.0, 5.5, 3.5, 0.5).homogenize(), Ok(point));
/// assert!(Homogeneous3::new(1.0, 0.0, 0.0, 0.0).homogenize().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Homogeneous3(pub DVec4);

/// Homogeneous coordinates (x, y, h) of a point of the plane, or of a direction in it.
///
/// ```
/// use snell_math::Homogeneous2;
/// assert_eq!(Homogeneous2::new(6.0, 14.0, 2.0).homogenize(), Ok([3.0, 7.0]));
/// assert_eq!(Homogeneous2::new(27.0, 63.0, 9.0).homogenize(), Ok([3.0, 7.0]));
/// let direction = Homogeneous2::new(3.0, 7.0, 0.0);
/// assert_eq!(direction.homogenize().unwrap_err().to_string(), "(3, 7, 0) is a direction and not a point: its h is 0");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Homogeneous2 {
    /// h times the point's x.
    pub x: f64,
    /// h times the point's y.
    pub y: f64,
    /// What the point's coordinates are multiplied by.
    pub h: f64,
}

/// Why homogeneous coordinates are no point. Coordinates of the plane have a z of `None`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HomogenizeError {
    /// h is 0: a direction, which no point stands for.
    Direction {
        /// The coordinates.
        x: f64,
        /// The second.
        y: f64,
        /// The third, in space.
        z: Option<f64>,
    },
    /// A coordinate is NaN or infinite, or becomes so.
    NotFinite {
        /// h.
        h: f64,
    },
}

impl std::fmt::Display for HomogenizeError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Direction { x, y, z: None } => write!(f, "({x}, {y}, 0) is a direction and not a point: its h is 0"),
            Self::Direction { x, y, z: Some(z) } => {
                write!(f, "({x}, {y}, {z}, 0) is a direction and not a point: its h is 0")
            }
            Self::NotFinite { h } => write!(f, "homogeneous coordinates with h = {h} give no finite point"),
        }
    }
}

impl std::error::Error for HomogenizeError {}

impl Homogeneous2 {
    /// From its three coordinates.
    pub const fn new(x: f64, y: f64, h: f64) -> Self {
        Self { x, y, h }
    }

    /// The point (x/h, y/h).
    ///
    /// # Errors
    /// [`HomogenizeError`] where h is 0, or the result not finite.
    pub fn homogenize(self) -> Result<[f64; 2], HomogenizeError> {
        if self.h == 0.0 {
            return Err(HomogenizeError::Direction { x: self.x, y: self.y, z: None });
        }
        let point = [self.x / self.h, self.y / self.h];
        if point.iter().all(|c| c.is_finite()) { Ok(point) } else { Err(HomogenizeError::NotFinite { h: self.h }) }
    }
}

impl Homogeneous3 {
    /// From its four coordinates.
    #[inline]
    pub const fn new(x: f64, y: f64, z: f64, h: f64) -> Self {
        Self(DVec4::new(x, y, z, h))
    }

    /// The direction of a vector, with h = 0.
    #[inline]
    pub const fn direction(v: Vector3) -> Self {
        Self::new(v.x(), v.y(), v.z(), 0.0)
    }

    /// h times the point's x.
    #[inline]
    pub const fn x(self) -> f64 {
        self.0.x
    }

    /// h times the point's y.
    #[inline]
    pub const fn y(self) -> f64 {
        self.0.y
    }

    /// h times the point's z.
    #[inline]
    pub const fn z(self) -> f64 {
        self.0.z
    }

    /// What the point's coordinates are multiplied by; 0 for a direction.
    #[inline]
    pub const fn h(self) -> f64 {
        self.0.w
    }

    /// The first three coordinates: h times the point, or the direction.
    #[inline]
    pub const fn vector(self) -> Vector3 {
        Vector3::new(self.0.x, self.0.y, self.0.z)
    }

    /// As an array `[x, y, z, h]`.
    pub fn to_array(self) -> [f64; 4] {
        self.0.to_array()
    }

    /// The point (x/h, y/h, z/h).
    ///
    /// # Errors
    /// [`HomogenizeError`] where h is 0, or the result not finite.
    pub fn homogenize(self) -> Result<Point3, HomogenizeError> {
        if self.h() == 0.0 {
            return Err(HomogenizeError::Direction { x: self.x(), y: self.y(), z: Some(self.z()) });
        }
        let point = Point3::new(self.x() / self.h(), self.y() / self.h(), self.z() / self.h());
        if point.is_finite() { Ok(point) } else { Err(HomogenizeError::NotFinite { h: self.h() }) }
    }

    /// The coordinates at `t` between these (0) and others (1). Between two points of positive h it runs along the straight line
    /// between them, though not at constant speed.
    #[inline]
    #[must_use]
    pub fn lerp(self, other: Self, t: f64) -> Self {
        Self(self.0 + (other.0 - self.0) * t)
    }
}

impl From<Point3> for Homogeneous3 {
    /// With h = 1.
    #[inline]
    fn from(p: Point3) -> Self {
        Self::new(p.x(), p.y(), p.z(), 1.0)
    }
}

/// A 4 × 4 matrix that maps homogeneous coordinates, as columns to columns: `(a * b)` does `b` first.
///
/// ```
/// use snell_math::{Homogeneous3, Matrix4, Point3};
/// let move_and_halve = Matrix4::from_rows([
///     [1.0, 0.0, 0.0, 3.0],
///     [0.0, 1.0, 0.0, 0.0],
///     [0.0, 0.0, 1.0, 0.0],
///     [0.0, 0.0, 0.0, 2.0],
/// ]);
/// assert_eq!(move_and_halve.map(Point3::new(1.0, 2.0, 0.0)).homogenize(), Ok(Point3::new(2.0, 1.0, 0.0)));
/// let back = move_and_halve.inverse().expect("its determinant is 2");
/// assert_eq!((back * move_and_halve).rows(), Matrix4::IDENTITY.rows());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrix4(pub DMat4);

impl Matrix4 {
    /// The map that leaves everything where it is.
    pub const IDENTITY: Self = Self(DMat4::IDENTITY);

    /// From its rows, as matrices are printed.
    pub fn from_rows(rows: [[f64; 4]; 4]) -> Self {
        Self(DMat4::from_cols_array_2d(&rows).transpose())
    }

    /// Its rows.
    pub fn rows(&self) -> [[f64; 4]; 4] {
        self.0.transpose().to_cols_array_2d()
    }

    /// Moves by a vector.
    pub fn translation(v: Vector3) -> Self {
        Self(DMat4::from_translation(v.0))
    }

    /// Scales along the axes.
    pub fn scaling(x: f64, y: f64, z: f64) -> Self {
        Self(DMat4::from_diagonal(DVec4::new(x, y, z, 1.0)))
    }

    /// Where homogeneous coordinates, or a point with h = 1, go.
    #[inline]
    pub fn map(&self, p: impl Into<Homogeneous3>) -> Homogeneous3 {
        Homogeneous3(self.0 * p.into().0)
    }

    /// The map back; `None` where the matrix is singular or not finite.
    pub fn inverse(&self) -> Option<Self> {
        let determinant = self.0.determinant();
        if determinant == 0.0 || !determinant.is_finite() {
            return None;
        }
        let inverse = self.0.inverse();
        inverse.is_finite().then_some(Self(inverse))
    }
}

impl std::ops::Mul for Matrix4 {
    type Output = Self;
    /// Does the right-hand one first.
    fn mul(self, first: Self) -> Self {
        Self(self.0 * first.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_that_are_no_point_are_told_with_their_values() {
        let direction = Homogeneous3::direction(Vector3::new(1.0, 2.0, 3.0)).homogenize().unwrap_err();
        assert_eq!(direction.to_string(), "(1, 2, 3, 0) is a direction and not a point: its h is 0");
        let overflow = Homogeneous3::new(1e300, 0.0, 0.0, 1e-300).homogenize();
        assert_eq!(overflow, Err(HomogenizeError::NotFinite { h: 1e-300 }));
        assert!(Homogeneous3::new(f64::NAN, 0.0, 0.0, 1.0).homogenize().is_err());
        assert!(Homogeneous2::new(1.0, 0.0, f64::NAN).homogenize().is_err());
        assert!(Homogeneous2::new(0.0, 0.0, -0.0).homogenize().is_err());
    }

    #[test]
    fn rows_are_rows() {
        let rows = [[1.0, 2.0, 3.0, 4.0], [0.0, 1.0, 0.0, 5.0], [0.0, 0.0, 1.0, 6.0], [0.0, 0.0, 0.0, 1.0]];
        let matrix = Matrix4::from_rows(rows);
        assert_eq!(matrix.rows(), rows);
        assert_eq!(matrix.map(Point3::new(1.0, 1.0, 1.0)).to_array(), [10.0, 6.0, 7.0, 1.0]);
        // The twin: a matrix taken by columns maps otherwise.
        assert_ne!(Matrix4(matrix.0.transpose()).map(Point3::new(1.0, 1.0, 1.0)).x(), 10.0);
        assert_eq!(Matrix4::scaling(1.0, 0.0, 1.0).inverse(), None);
    }
}

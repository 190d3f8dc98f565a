//! Points, vectors and normals of 3-space: three types, so that a point is never added to a point and a normal is
//! never transformed as a vector. All `f64`, wrapping [`glam::DVec3`].

use std::ops::{Add, AddAssign, Index, Mul, Neg, Sub};

use glam::DVec3;

/// A position. Subtracting two gives a [`Vector3`]; adding a vector moves it.
///
/// ```
/// use snell_math::{Point3, Vector3};
/// let p = Point3::new(1.0, 2.0, 3.0) + Vector3::new(0.0, 0.0, 1.0);
/// assert_eq!(p, Point3::new(1.0, 2.0, 4.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Point3(pub DVec3);

/// A displacement or direction; unit length only where the documentation says so.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Vector3(pub DVec3);

/// A surface normal: transforms by the inverse transpose, see [`crate::Transform::normal`].
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Normal3(pub DVec3);

macro_rules! components {
    ($type:ident) => {
        impl $type {
            /// From its three components.
            #[inline]
            pub const fn new(x: f64, y: f64, z: f64) -> Self {
                Self(DVec3::new(x, y, z))
            }
            /// The x component.
            #[inline]
            pub const fn x(self) -> f64 {
                self.0.x
            }
            /// The y component.
            #[inline]
            pub const fn y(self) -> f64 {
                self.0.y
            }
            /// The z component.
            #[inline]
            pub const fn z(self) -> f64 {
                self.0.z
            }
            /// As an array `[x, y, z]`.
            #[inline]
            pub fn to_array(self) -> [f64; 3] {
                self.0.to_array()
            }
            /// True where no component is NaN or infinite.
            #[inline]
            pub fn is_finite(self) -> bool {
                self.0.is_finite()
            }
            /// The largest absolute value of a component: what error bounds scale with.
            #[inline]
            pub fn max_abs(self) -> f64 {
                // One instruction each, which `f64::max` with its care for NaN is not.
                let larger = |a: f64, b: f64| if a > b { a } else { b };
                larger(larger(self.0.x.abs(), self.0.y.abs()), self.0.z.abs())
            }
        }
        impl From<[f64; 3]> for $type {
            #[inline]
            fn from(a: [f64; 3]) -> Self {
                Self(DVec3::from_array(a))
            }
        }
        impl Index<usize> for $type {
            type Output = f64;
            /// Component 0, 1 or 2.
            ///
            /// # Panics
            /// Where the index is 3 or more.
            #[inline]
            fn index(&self, axis: usize) -> &f64 {
                &self.0[axis]
            }
        }
    };
}
components!(Point3);
components!(Vector3);
components!(Normal3);

impl Point3 {
    /// The origin (0, 0, 0).
    pub const ORIGIN: Self = Self(DVec3::ZERO);

    /// The vector from the origin to this point.
    #[inline]
    pub fn to_vector(self) -> Vector3 {
        Vector3(self.0)
    }

    /// The Euclidean distance to another point.
    #[inline]
    pub fn distance(self, other: Self) -> f64 {
        (self - other).length()
    }

    /// The point at `t` on the straight way from here (0) to `other` (1).
    #[inline]
    pub fn lerp(self, other: Self, t: f64) -> Self {
        self + (other - self) * t
    }
}

impl Vector3 {
    /// The zero vector.
    pub const ZERO: Self = Self(DVec3::ZERO);
    /// The unit vector along +x.
    pub const X: Self = Self(DVec3::X);
    /// The unit vector along +y.
    pub const Y: Self = Self(DVec3::Y);
    /// The unit vector along +z.
    pub const Z: Self = Self(DVec3::Z);

    /// The scalar product with another vector.
    #[inline]
    pub fn dot(self, other: Self) -> f64 {
        self.0.x * other.0.x + self.0.y * other.0.y + self.0.z * other.0.z
    }

    /// The vector product, right-handed.
    #[inline]
    pub fn cross(self, other: Self) -> Self {
        Self(self.0.cross(other.0))
    }

    /// The Euclidean length.
    #[inline]
    pub fn length(self) -> f64 {
        self.dot(self).sqrt()
    }

    /// The square of the length.
    #[inline]
    pub fn length_squared(self) -> f64 {
        self.dot(self)
    }

    /// Scaled to unit length; `None` where the length is zero or not finite.
    ///
    /// ```
    /// use snell_math::Vector3;
    /// assert_eq!(Vector3::new(0.0, 3.0, 0.0).try_normalize(), Some(Vector3::Y));
    /// assert_eq!(Vector3::ZERO.try_normalize(), None);
    /// ```
    #[inline]
    pub fn try_normalize(self) -> Option<Self> {
        let length_squared = self.length_squared();
        if USUAL_SQUARES.contains(&length_squared) {
            Some(self * (1.0 / length_squared.sqrt()))
        } else {
            self.try_normalize_extreme()
        }
    }

    /// As [`Vector3::try_normalize`], for vectors of any length.
    #[cold]
    fn try_normalize_extreme(self) -> Option<Self> {
        // Scaled first by a power of two, so that neither tiny nor huge vectors under- or overflow when squared.
        let largest = self.max_abs();
        if !(largest > 0.0 && largest.is_finite()) {
            return None;
        }
        let scaled = if (1e-100..1e100).contains(&largest) { self } else { Self(self.0 / largest) };
        Some(scaled * (1.0 / scaled.length()))
    }

    /// Scaled to unit length, for vectors known not to be zero (directions of rays, products of perpendicular units).
    /// A zero vector stays zero.
    #[inline]
    pub fn normalize(self) -> Self {
        let length_squared = self.length_squared();
        if length_squared > 0.0 { self * (1.0 / length_squared.sqrt()) } else { self }
    }

    /// Two unit vectors that complete this unit vector to a right-handed orthonormal basis `(a, b, self)`.
    ///
    /// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017, listing 3.
    #[inline]
    pub fn orthonormal_basis(self) -> (Self, Self) {
        let sign = 1.0_f64.copysign(self.0.z);
        let a = -1.0 / (sign + self.0.z);
        let b = self.0.x * self.0.y * a;
        (
            Self::new(1.0 + sign * self.0.x * self.0.x * a, sign * b, -sign * self.0.x),
            Self::new(b, sign + self.0.y * self.0.y * a, -self.0.y),
        )
    }
}

/// Squared lengths that neither under- nor overflowed on the way.
pub(crate) const USUAL_SQUARES: std::ops::Range<f64> = 1e-190..1e190;

impl Normal3 {
    /// The scalar product with a vector.
    #[inline]
    pub fn dot(self, v: Vector3) -> f64 {
        self.as_vector().dot(v)
    }

    /// The same components as a vector.
    #[inline]
    pub fn as_vector(self) -> Vector3 {
        Vector3(self.0)
    }

    /// Scaled to unit length; a zero normal stays zero.
    #[inline]
    pub fn normalize(self) -> Self {
        Self(self.as_vector().normalize().0)
    }

    /// This normal, or its opposite, whichever is on the same side as `v`.
    #[inline]
    pub fn face_forward(self, v: Vector3) -> Self {
        if self.dot(v) < 0.0 { -self } else { self }
    }
}

impl From<Vector3> for Normal3 {
    #[inline]
    fn from(v: Vector3) -> Self {
        Self(v.0)
    }
}

impl Add<Vector3> for Point3 {
    type Output = Self;
    #[inline]
    fn add(self, v: Vector3) -> Self {
        Self(self.0 + v.0)
    }
}
impl Sub<Vector3> for Point3 {
    type Output = Self;
    #[inline]
    fn sub(self, v: Vector3) -> Self {
        Self(self.0 - v.0)
    }
}
impl Sub for Point3 {
    type Output = Vector3;
    #[inline]
    fn sub(self, other: Self) -> Vector3 {
        Vector3(self.0 - other.0)
    }
}
impl Add for Vector3 {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}
impl AddAssign for Vector3 {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        self.0 += other.0;
    }
}
impl Sub for Vector3 {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}
impl Mul<f64> for Vector3 {
    type Output = Self;
    #[inline]
    fn mul(self, s: f64) -> Self {
        Self(self.0 * s)
    }
}
impl Mul<f64> for Normal3 {
    type Output = Self;
    #[inline]
    fn mul(self, s: f64) -> Self {
        Self(self.0 * s)
    }
}
impl Neg for Vector3 {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}
impl Neg for Normal3 {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn basis_is_orthonormal_and_right_handed(x in -1.0..1.0f64, y in -1.0..1.0f64, z in -1.0..1.0f64) {
            prop_assume!(x * x + y * y + z * z > 1e-6);
            let w = Vector3::new(x, y, z).normalize();
            let (u, v) = w.orthonormal_basis();
            for (a, b) in [(u, v), (v, w), (w, u)] {
                prop_assert!(a.dot(b).abs() < 1e-14);
                prop_assert!((a.length() - 1.0).abs() < 1e-14);
            }
            prop_assert!((u.cross(v) - w).length() < 1e-14);
        }
    }

    #[test]
    fn normalize_survives_extreme_lengths() {
        for scale in [5e-324, 1e-300, 1e-160, 1.0, 1e160, 1e300] {
            let v = Vector3::new(scale, 0.0, 0.0).try_normalize().expect("not zero");
            assert_eq!(v, Vector3::X);
        }
        assert_eq!(Vector3::new(f64::NAN, 0.0, 0.0).try_normalize(), None);
        assert_eq!(Vector3::new(f64::INFINITY, 0.0, 0.0).try_normalize(), None);
    }
}

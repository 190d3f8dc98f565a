//! Vectors and colours side by side. Every operation is that of [`Vector3`] and [`Rgb`], component by component and in the same
//! order, so that lanes have the bits of one number at a time.

use std::ops::{Add, Mul, Neg, Sub};

use super::{Bits, End, Floats, Lanes, WIDTH};
use crate::vector::USUAL_SQUARES;
use crate::{Normal3, Point3, Rgb, Vector3};

/// Vectors or points, one in each lane.
#[derive(Clone, Copy, Debug)]
pub struct LaneVector<L> {
    /// The x components.
    pub x: L,
    /// The y components.
    pub y: L,
    /// The z components.
    pub z: L,
}

impl<L: Lanes> LaneVector<L> {
    /// The same components in all lanes.
    #[inline(always)]
    #[must_use]
    pub fn splat([x, y, z]: [f64; 3]) -> Self {
        Self { x: L::splat(x), y: L::splat(y), z: L::splat(z) }
    }

    /// From three rows, see [`Lanes::load`].
    #[inline(always)]
    #[must_use]
    pub fn load([x, y, z]: &[[f64; WIDTH]; 3], at: usize) -> Self {
        Self { x: L::load(x, at), y: L::load(y, at), z: L::load(z, at) }
    }

    /// To three rows.
    #[inline(always)]
    pub fn store(self, [x, y, z]: &mut [[f64; WIDTH]; 3], at: usize) {
        self.x.store(x, at);
        self.y.store(y, at);
        self.z.store(z, at);
    }

    /// See [`Lanes::append`].
    #[inline(always)]
    pub fn append(self, end: End, [first, second]: [&mut [[f64; WIDTH]; 3]; 2]) {
        let ([x, y, z], [next_x, next_y, next_z]) = (first, second);
        self.x.append(end, [x, next_x]);
        self.y.append(end, [y, next_y]);
        self.z.append(end, [z, next_z]);
    }

    /// As [`Vector3::dot`].
    #[inline(always)]
    #[must_use]
    pub fn dot(self, other: Self) -> L {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// As [`Vector3::cross`].
    #[inline(always)]
    #[must_use]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - other.y * self.z,
            y: self.z * other.x - other.z * self.x,
            z: self.x * other.y - other.x * self.y,
        }
    }

    /// The magnitude of each component.
    #[inline(always)]
    #[must_use]
    pub fn abs(self) -> Self {
        Self { x: self.x.abs(), y: self.y.abs(), z: self.z.abs() }
    }

    /// The sum of the components.
    #[inline(always)]
    #[must_use]
    pub fn sum(self) -> L {
        self.x + self.y + self.z
    }

    /// Scaled to unit length, as [`Vector3::try_normalize`], and the lanes where it is: those of usual lengths. What stands in the
    /// others means nothing.
    #[inline(always)]
    #[must_use]
    pub fn normalize_usual(self) -> (Self, Bits) {
        let length_squared = self.length_squared();
        let usual = L::splat(USUAL_SQUARES.start).le(length_squared) & length_squared.lt(L::splat(USUAL_SQUARES.end));
        (self * (L::splat(1.0) / length_squared.sqrt()), usual)
    }

    /// As [`Vector3::length_squared`].
    #[inline(always)]
    #[must_use]
    pub fn length_squared(self) -> L {
        self.dot(self)
    }

    /// As [`Vector3::normalize`].
    #[inline(always)]
    #[must_use]
    pub fn normalize(self) -> Self {
        let length_squared = self.length_squared();
        let scaled = self * (L::splat(1.0) / length_squared.sqrt());
        scaled.or_where_not(length_squared.gt(L::splat(0.0)), self)
    }

    /// As [`Vector3::try_normalize`], with +y for what has no direction.
    #[inline(always)]
    #[must_use]
    pub fn try_normalize_or_y(self) -> Self {
        let (scaled, usual) = self.normalize_usual();
        let unusual = L::all().without(usual);
        if unusual.is_empty() { scaled } else { self.normalize_unusual(unusual, scaled) }
    }

    #[cold]
    #[inline(never)]
    fn normalize_unusual(self, unusual: Bits, scaled: Self) -> Self {
        let (mut all, mut done) = ([[0.0; WIDTH]; 3], [[0.0; WIDTH]; 3]);
        self.store(&mut all, 0);
        scaled.store(&mut done, 0);
        for lane in unusual.lanes() {
            let vector = Vector3::new(all[0][lane], all[1][lane], all[2][lane]);
            let unit = vector.try_normalize().unwrap_or(Vector3::Y);
            (0..3).for_each(|axis| done[axis][lane] = unit[axis]);
        }
        Self::load(&done, 0)
    }

    /// As [`Vector3::max_abs`].
    #[inline(always)]
    #[must_use]
    pub fn max_abs(self) -> L {
        let (x, y, z) = (self.x.abs(), self.y.abs(), self.z.abs());
        z.larger(y.larger(x))
    }

    /// `self` where a bit is set, `other` elsewhere.
    #[inline(always)]
    #[must_use]
    pub fn or_where_not(self, bits: Bits, other: Self) -> Self {
        Self {
            x: self.x.or_where_not(bits, other.x),
            y: self.y.or_where_not(bits, other.y),
            z: self.z.or_where_not(bits, other.z),
        }
    }
}

macro_rules! from_scalar {
    ($($type:ty),*) => {
        $(impl From<$type> for LaneVector<f64> {
            #[inline(always)]
            fn from(v: $type) -> Self {
                Self { x: v.x(), y: v.y(), z: v.z() }
            }
        }
        impl From<LaneVector<f64>> for $type {
            #[inline(always)]
            fn from(v: LaneVector<f64>) -> Self {
                Self::new(v.x, v.y, v.z)
            }
        })*
    };
}
from_scalar!(Point3, Vector3, Normal3);

impl<L: Lanes> Add for LaneVector<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<L: Lanes> Sub for LaneVector<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl<L: Lanes> Mul<L> for LaneVector<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: L) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl<L: Lanes> Neg for LaneVector<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y, z: -self.z }
    }
}

/// Colours, one in each lane.
#[derive(Clone, Copy, Debug)]
pub struct LaneColor<F> {
    /// Red.
    pub r: F,
    /// Green.
    pub g: F,
    /// Blue.
    pub b: F,
}

impl<F: Floats> LaneColor<F> {
    /// The same colour in all lanes.
    #[inline(always)]
    #[must_use]
    pub fn splat(color: Rgb) -> Self {
        Self { r: F::splat(color.r), g: F::splat(color.g), b: F::splat(color.b) }
    }

    /// From three rows.
    #[inline(always)]
    #[must_use]
    pub fn load([r, g, b]: &[[f32; WIDTH]; 3], at: usize) -> Self {
        Self { r: F::load(r, at), g: F::load(g, at), b: F::load(b, at) }
    }

    /// To three rows.
    #[inline(always)]
    pub fn store(self, [r, g, b]: &mut [[f32; WIDTH]; 3], at: usize) {
        self.r.store(r, at);
        self.g.store(g, at);
        self.b.store(b, at);
    }

    /// See [`Lanes::append`].
    #[inline(always)]
    pub fn append<L: Lanes<Floats = F>>(self, end: End, [first, second]: [&mut [[f32; WIDTH]; 3]; 2]) {
        let ([r, g, b], [next_r, next_g, next_b]) = (first, second);
        L::append_floats(self.r, end, [r, next_r]);
        L::append_floats(self.g, end, [g, next_g]);
        L::append_floats(self.b, end, [b, next_b]);
    }

    /// As [`Rgb::is_black`].
    #[inline(always)]
    #[must_use]
    pub fn is_black(self) -> Bits {
        self.r.is_zero() & self.g.is_zero() & self.b.is_zero()
    }

    /// As [`Rgb::max_abs`].
    #[inline(always)]
    #[must_use]
    pub fn max_abs(self) -> F {
        self.r.abs().max(self.g.abs()).max(self.b.abs())
    }

    /// `self` where a bit is set, `other` elsewhere.
    #[inline(always)]
    #[must_use]
    pub fn or_where_not(self, bits: Bits, other: Self) -> Self {
        Self {
            r: self.r.or_where_not(bits, other.r),
            g: self.g.or_where_not(bits, other.g),
            b: self.b.or_where_not(bits, other.b),
        }
    }
}

impl<F: Floats> Add for LaneColor<F> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { r: self.r + other.r, g: self.g + other.g, b: self.b + other.b }
    }
}

impl<F: Floats> Mul for LaneColor<F> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self { r: self.r * other.r, g: self.g * other.g, b: self.b * other.b }
    }
}

impl<F: Floats> Mul<F> for LaneColor<F> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: F) -> Self {
        Self { r: self.r * factor, g: self.g * factor, b: self.b * factor }
    }
}

//! Axis-aligned boxes.

use crate::{Point3, Vector3};

/// All points between two corners, both included. [`Bounds3::EMPTY`] holds none; an unbounded side is infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds3 {
    /// The corner of smallest coordinates.
    pub min: Point3,
    /// The corner of largest coordinates.
    pub max: Point3,
}

impl Bounds3 {
    /// Holds nothing: the neutral element of [`Bounds3::union`].
    pub const EMPTY: Self = Self {
        min: Point3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        max: Point3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
    };
    /// Holds all of space.
    pub const EVERYTHING: Self = Self {
        min: Point3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
        max: Point3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
    };

    /// From two corners, `min` not above `max` on any axis.
    pub const fn new(min: Point3, max: Point3) -> Self {
        Self { min, max }
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self { min: Point3(self.min.0.min(other.min.0)), max: Point3(self.max.0.max(other.max.0)) }
    }

    /// What both hold; empty where they do not meet.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        let both = Self { min: Point3(self.min.0.max(other.min.0)), max: Point3(self.max.0.min(other.max.0)) };
        if both.is_empty() { Self::EMPTY } else { both }
    }

    /// The smallest box around this one and a point.
    #[must_use]
    pub fn including(&self, p: Point3) -> Self {
        Self { min: Point3(self.min.0.min(p.0)), max: Point3(self.max.0.max(p.0)) }
    }

    /// Grown by `margin` on every side.
    #[must_use]
    pub fn grown(&self, margin: f64) -> Self {
        let m = Vector3::new(margin, margin, margin);
        Self { min: self.min - m, max: self.max + m }
    }

    /// True where it holds no point (also where a corner is NaN).
    pub fn is_empty(&self) -> bool {
        !(self.min.0.cmple(self.max.0)).all()
    }

    /// True where every side is finite and it is not empty.
    pub fn is_finite(&self) -> bool {
        !self.is_empty() && self.min.is_finite() && self.max.is_finite()
    }

    /// True where the point lies inside or on the border.
    pub fn contains(&self, p: Point3) -> bool {
        self.min.0.cmple(p.0).all() && p.0.cmple(self.max.0).all()
    }

    /// The middle point.
    pub fn center(&self) -> Point3 {
        self.min.lerp(self.max, 0.5)
    }

    /// The vector from `min` to `max`.
    pub fn diagonal(&self) -> Vector3 {
        self.max - self.min
    }

    /// Half the surface area, what the surface area heuristic compares; 0 where empty.
    pub fn half_area(&self) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        let d = self.diagonal();
        d.x() * d.y() + d.y() * d.z() + d.z() * d.x()
    }

    /// Corner 0 to 7: bit 0, 1, 2 of the index choose `max` on x, y, z.
    pub fn corner(&self, index: usize) -> Point3 {
        let pick = |axis: usize| if index >> axis & 1 == 1 { self.max[axis] } else { self.min[axis] };
        Point3::new(pick(0), pick(1), pick(2))
    }
}

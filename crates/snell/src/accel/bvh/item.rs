//! Primitives on their way into a leaf, and boxes that grow: four `f32` at once, in the space of the primitives.
//!
//! Building touches every primitive once a level, so this is written for the vector unit: `f32x4` is SSE2 on every x86-64,
//! NEON on ARM and plain arrays elsewhere. Minima, maxima and comparisons are exact, so all give the same tree.

use wide::f32x4;

use super::box32::Box32;

/// A primitive, or a piece of one, with its box: 32 bytes. The fourth lanes carry the halves of the primitive's number
/// as whole `f32`, which no arithmetic on the lanes can trip over; bits of a number read as `f32` would be subnormal.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Item {
    low: f32x4,
    high: f32x4,
}

const _: () = assert!(size_of::<Item>() == 32);

impl Item {
    #[inline]
    pub(super) fn new(bounds: &Box32, primitive: u32) -> Self {
        let [[a, b, c], [d, e, f]] = bounds.corners;
        Self {
            low: f32x4::from([a, b, c, (primitive >> 16) as f32]),
            high: f32x4::from([d, e, f, (primitive & 0xFFFF) as f32]),
        }
    }

    #[inline]
    pub(super) fn primitive(&self) -> u32 {
        let (upper, lower) = (self.low.to_array()[3] as u32, self.high.to_array()[3] as u32);
        upper << 16 | lower
    }

    #[inline]
    pub(super) fn bounds(&self) -> Box32 {
        Hull { low: self.low, high: self.high }.to_box()
    }

    pub(super) fn is_empty(&self) -> bool {
        let ([a, b, c, _], [d, e, f, _]) = (self.low.to_array(), self.high.to_array());
        a > d || b > e || c > f
    }

    /// Half of the middle of the box. It is finite even where the box is not, and so is the difference of two, which
    /// that of two middles need not be.
    #[inline]
    pub(super) fn half_center(&self) -> f32x4 {
        let (low, high) = (self.low.fast_max(f32x4::splat(f32::MIN)), self.high.fast_min(f32x4::splat(f32::MAX)));
        low * f32x4::splat(0.25) + high * f32x4::splat(0.25)
    }
}

/// A box that grows. What is in the fourth lanes has no meaning.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hull {
    pub(super) low: f32x4,
    pub(super) high: f32x4,
}

impl Hull {
    /// Holds nothing: the neutral element of the union.
    pub(super) const EMPTY: Self =
        Self { low: f32x4::new([f32::INFINITY; 4]), high: f32x4::new([f32::NEG_INFINITY; 4]) };

    #[inline]
    pub(super) fn grow(&mut self, other: &Self) {
        self.low = self.low.fast_min(other.low);
        self.high = self.high.fast_max(other.high);
    }

    #[inline]
    pub(super) fn union(mut self, other: &Self) -> Self {
        self.grow(other);
        self
    }

    #[inline]
    pub(super) fn grow_item(&mut self, item: &Item) {
        self.low = self.low.fast_min(item.low);
        self.high = self.high.fast_max(item.high);
    }

    #[inline]
    pub(super) fn grow_point(&mut self, point: f32x4) {
        self.low = self.low.fast_min(point);
        self.high = self.high.fast_max(point);
    }

    #[inline]
    pub(super) fn to_box(self) -> Box32 {
        let ([a, b, c, _], [d, e, f, _]) = (self.low.to_array(), self.high.to_array());
        Box32 { corners: [[a, b, c], [d, e, f]] }
    }

    #[inline]
    pub(super) fn half_area(&self) -> f64 {
        self.to_box().half_area()
    }
}

/// The box around the boxes of all items, and that around their half centres.
pub(super) fn hulls(items: &[Item]) -> [Hull; 2] {
    let [mut bounds, mut centers] = [Hull::EMPTY; 2];
    for item in items {
        bounds.grow_item(item);
        centers.grow_point(item.half_center());
    }
    [bounds, centers]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn carries_any_number_and_any_box() {
        // A box around finite numbers of `f64` may end at infinity, but not begin there.
        let values = [f32::MIN, -1.5, 0.0, 1e-45, 3.0, f32::MAX];
        for low in [f32::NEG_INFINITY].into_iter().chain(values) {
            for high in values.into_iter().chain([f32::INFINITY]).filter(|high| low <= *high) {
                let bounds = Box32 { corners: [[low; 3], [high; 3]] };
                for primitive in [0, 1, 0xFFFF, 0x1_0000, 0x7FFF_FFFF, u32::MAX] {
                    let item = Item::new(&bounds, primitive);
                    let [hull, _] = hulls(&[item]);
                    assert_eq!((item.primitive(), hull.to_box(), item.is_empty()), (primitive, bounds, false));
                    let center = item.half_center().to_array()[0];
                    assert!(center.is_finite() && (center - f32::MIN / 2.0).is_finite(), "{low} {high}: {center}");
                }
            }
        }
        assert!(Item::new(&Box32::EMPTY, 7).is_empty());
    }
}

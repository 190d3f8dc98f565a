//! The part of a line inside a convex solid: from one hit to another.

use super::{Crossing, ShapeHit};

/// Where a line enters a convex solid and where it leaves it; the ends may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub(super) enter: ShapeHit,
    pub(super) leave: ShapeHit,
}

impl Span {
    /// `None` where it has no length, or an end is NaN.
    #[inline]
    pub(super) fn new(enter: ShapeHit, leave: ShapeHit) -> Option<Self> {
        (enter.t < leave.t).then_some(Self { enter, leave })
    }

    /// The first end strictly between `t_min` and `t_max`.
    #[inline]
    pub(super) fn first_between(&self, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        let first = if self.enter.t > t_min { self.enter } else { self.leave };
        (first.t > t_min && first.t < t_max).then_some(first)
    }

    /// Appends both ends.
    #[inline]
    pub(super) fn push_to(&self, out: &mut Vec<Crossing>) {
        out.push(Crossing { t: self.enter.t, entering: true, part: self.enter.part });
        out.push(Crossing { t: self.leave.t, entering: false, part: self.leave.part });
    }
}

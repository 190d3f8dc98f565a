//! The part of a line inside a convex solid: from one hit to another.

use snell_math::lanes::{Bits, Lanes};

use super::{Crossing, ShapeHit};

/// Where a line enters a convex solid and where it leaves it; the ends may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub(super) enter: ShapeHit,
    pub(super) leave: ShapeHit,
}

impl Span {
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

/// Where lines side by side pass through a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passage<L> {
    /// The lanes that do.
    pub(crate) met: Bits,
    /// As [`ShapeHit::t`].
    pub(crate) t: L,
    /// As [`ShapeHit::part`].
    pub(crate) part: L,
}

impl<L: Lanes> Passage<L> {
    /// Nowhere.
    #[inline(always)]
    pub(super) fn none() -> Self {
        Self { met: Bits::NONE, t: L::splat(0.0), part: L::splat(0.0) }
    }

    /// Once, of a surface with one part.
    #[inline(always)]
    pub(super) fn one(met: Bits, t: L) -> [Self; 2] {
        [Self { met, t, part: L::splat(0.0) }, Self::none()]
    }

    /// `self` where a bit is set, `other` elsewhere; of those that meet something or not, whichever.
    #[inline(always)]
    pub(super) fn or_where_not(self, bits: Bits, other: Self) -> Self {
        let met = self.met & bits | other.met.without(bits);
        Self { met, t: self.t.or_where_not(bits, other.t), part: self.part.or_where_not(bits, other.part) }
    }

    /// The lanes that pass with 0 < t < `t_max`.
    #[inline(always)]
    pub(crate) fn before(&self, t_max: L) -> Bits {
        self.met & self.t.gt(L::splat(0.0)) & self.t.lt(t_max)
    }

    /// Of two passages, the nearer one first, the first with 0 < t < `t_max`.
    #[inline(always)]
    pub(crate) fn first_before([near, far]: [Self; 2], t_max: L) -> Self {
        let (first, second) = (near.before(t_max), far.before(t_max));
        Self { met: first | second, ..near.or_where_not(first, far) }
    }
}

/// The lines that have a part inside, and both its ends: none where it has no length, or an end is NaN.
#[inline(always)]
pub(super) fn ends<L: Lanes>(met: Bits, enter: (L, L), leave: (L, L)) -> [Passage<L>; 2] {
    let met = met & enter.0.lt(leave.0);
    [Passage { met, t: enter.0, part: enter.1 }, Passage { met, t: leave.0, part: leave.1 }]
}

impl Passage<f64> {
    /// Of two passages of one line, the nearer one first, the first strictly between `t_min` and `t_max`.
    #[inline]
    pub(super) fn first_between(passages: [Self; 2], t_min: f64, t_max: f64) -> Option<ShapeHit> {
        let is_there = |passage: &Self| passage.met.any() && passage.t > t_min && passage.t < t_max;
        passages.into_iter().find(is_there).map(ShapeHit::from)
    }
}

impl From<Passage<f64>> for ShapeHit {
    #[inline]
    fn from(passage: Passage<f64>) -> Self {
        Self { t: passage.t, part: passage.part as u32 }
    }
}

impl Span {
    /// Of one line.
    #[inline]
    pub(super) fn of_ends([enter, leave]: [Passage<f64>; 2]) -> Option<Self> {
        enter.met.any().then(|| Self { enter: enter.into(), leave: leave.into() })
    }
}

//! [`Probe`]s of rays side by side: the same formulas and the same bounds on errors, a ray in each lane.

use snell_math::lanes::{Bits, Eight, Floats, LaneVector, Lanes, WIDTH};

use super::WideTree;
use super::probe::{BoxRay, EXTENTS, LEAST};

/// As [`super::Probe`], a ray in each lane.
#[derive(Clone, Copy)]
pub struct Probes<L> {
    /// The lanes whose rays come near the tree, and are as most are.
    pub plain: Bits,
    /// Those whose rays have to be asked for one by one.
    pub strange: Bits,
    /// See [`super::Measure`].
    pub start: L,
    /// See [`super::Measure`].
    pub scale: L,
    /// See [`super::Probe`].
    pub origin: LaneVector<L>,
    /// See [`super::Probe`].
    pub direction: LaneVector<L>,
    inverse: LaneVector<L>,
    margin: L,
    /// See [`super::Probe`].
    pub error: L,
    /// See [`super::Probe`].
    pub extent: f64,
}

/// The lanes whose sign is negative, that of zero as well.
#[inline(always)]
fn negative<L: Lanes>(x: L) -> Bits {
    L::splat(1.0).copysign(x).lt(L::splat(0.0))
}

/// Componentwise reciprocals.
#[inline(always)]
pub fn reciprocal<L: Lanes>(v: LaneVector<L>) -> LaneVector<L> {
    let one = L::splat(1.0);
    LaneVector { x: one / v.x, y: one / v.y, z: one / v.z }
}

impl WideTree {
    /// Where rays enter the box around everything, not before 0, and leave it, not after `t_max`: as in `slabs.rs`; and those that
    /// begin in it, whose entry means nothing.
    #[inline(always)]
    fn span<L: Lanes>(
        &self,
        from: LaneVector<L>,
        along: LaneVector<L>,
        inverse: LaneVector<L>,
        t_max: L,
    ) -> (L, L, Bits) {
        let slack = L::splat(1.0 / (1_u64 << 48) as f64) * (from.max_abs() + L::splat(self.extent));
        let slack = slack + L::splat(f64::MIN_POSITIVE);
        let (mut start, mut leave, mut inside) = (L::splat(0.0), t_max, Bits::all_if(true));
        let [low, high] = self.bounds.corners;
        let axes = [(from.x, along.x, inverse.x), (from.y, along.y, inverse.y), (from.z, along.z, inverse.z)];
        for (axis, (from, along, inverse)) in axes.into_iter().enumerate() {
            let (low, high) = (L::splat(f64::from(low[axis])), L::splat(f64::from(high[axis])));
            inside &= low.le(from) & from.le(high);
            let (slack, back) = (slack.copysign(along), negative(along));
            let near = (high.or_where_not(back, low) - (from + slack)) * inverse;
            let far = (low.or_where_not(back, high) - (from - slack)) * inverse;
            // So written, NaN changes nothing.
            start = start.larger(near);
            leave = leave.smaller(far);
        }
        (start, leave, inside)
    }

    /// Those of some rays, plain ones of a tree that this one is inside of, that come near this one before `t_max`; `inverse` is that of
    /// their directions.
    #[inline(always)]
    pub fn passed<L: Lanes>(
        &self,
        from: LaneVector<L>,
        along: LaneVector<L>,
        inverse: LaneVector<L>,
        rays: Bits,
        t_max: L,
    ) -> Bits {
        let (start, leave, inside) = self.span(from, along, inverse, t_max);
        rays & L::splat(0.0).le(t_max) & (inside | start.le(leave))
    }

    /// As [`WideTree::approach`], from t = 0 on, of the active ones of rays side by side.
    #[inline(always)]
    pub fn approach_together<L: Lanes>(
        &self,
        from: LaneVector<L>,
        along: LaneVector<L>,
        active: Bits,
        t_max: L,
    ) -> Probes<L> {
        let (extent, zero) = (L::splat(self.extent), L::splat(0.0));
        let (reach, scale) = (from.max_abs(), along.max_abs());
        let error = L::splat(1.0 / (1_u64 << 45) as f64) * (reach + extent);
        let margin = L::splat(1.0 / (1_u64 << 21) as f64) * extent + error;
        let mut plain = Bits::all_if(EXTENTS.contains(&self.extent))
            & margin.lt(L::splat(0.125) * extent)
            & L::splat(f64::MIN_POSITIVE).le(scale)
            & scale.lt(L::splat(f64::INFINITY));
        let inverse = reciprocal(along);
        for along in [along.x, along.y, along.z] {
            // The inverse of a number that is too small is of no use.
            plain &= along.same(zero) | L::splat(f64::MIN_POSITIVE).le(along.abs());
        }
        let (mut start, leave, inside) = self.span(from, along, inverse, t_max);
        let ahead = active & zero.le(t_max) & (inside | start.le(leave));
        start = zero.or_where_not(inside, start);
        let origin = from + along * start;
        let LaneVector { x, y, z } = inverse;
        let direction = along * x.abs().smaller(y.abs()).smaller(z.abs());
        plain &= start.lt(L::splat(f64::INFINITY));
        plain &= origin.max_abs().le(L::splat(1.5) * extent) & L::splat(0.5).le(direction.max_abs());
        Probes {
            plain: ahead & plain,
            strange: ahead.without(plain),
            start,
            scale,
            origin,
            direction,
            inverse: inverse * scale,
            margin,
            error,
            extent: self.extent,
        }
    }
}

/// As [`super::BoxLine`], in rows.
pub(super) struct BoxLines {
    inverse: [[f32; WIDTH]; 3],
    near: [[f32; WIDTH]; 3],
    far: [[f32; WIDTH]; 3],
    /// The rays that go down on each axis, and meet the larger coordinate first.
    negative: [Bits; 3],
}

impl BoxLines {
    #[inline(always)]
    pub(super) fn new<L: Lanes>(probes: &Probes<L>) -> Self {
        let rows = [[0.0; WIDTH]; 3];
        let mut lines = Self { inverse: rows, near: rows, far: rows, negative: [Bits::NONE; 3] };
        let Probes { origin, direction, inverse, .. } = *probes;
        let axes = [
            (origin.x, direction.x, inverse.x),
            (origin.y, direction.y, inverse.y),
            (origin.z, direction.z, inverse.z),
        ];
        for (axis, (origin, direction, inverse)) in axes.into_iter().enumerate() {
            // Of a tiny component the largest inverse that there may be, with its sign.
            let magnitude = inverse.abs().smaller(L::splat(1.0 / f64::from(LEAST)));
            let inverse = magnitude.copysign(direction);
            inverse.to_floats().store(&mut lines.inverse[axis], 0);
            let (middle, margin) = (-(origin * inverse), probes.margin * magnitude);
            (middle - margin).to_floats().store(&mut lines.near[axis], 0);
            (middle + margin).to_floats().store(&mut lines.far[axis], 0);
            lines.negative[axis] = negative(direction);
        }
        lines
    }

    /// One of them in all lanes.
    #[inline(always)]
    pub(super) fn spread<F: Eight>(&self, lane: usize) -> BoxRay<F> {
        let lane = lane & (WIDTH - 1);
        BoxRay {
            inverse: spread(&self.inverse, lane),
            near: spread(&self.near, lane),
            far: spread(&self.far, lane),
            near_side: self.negative.map(|negative| usize::from(negative.has(lane))),
        }
    }
}

/// A column of three rows, each number in all lanes.
#[inline(always)]
pub fn spread<F: Eight>([x, y, z]: &[[f32; WIDTH]; 3], lane: usize) -> [F; 3] {
    let lane = lane & (WIDTH - 1);
    [F::splat(x[lane]), F::splat(y[lane]), F::splat(z[lane])]
}

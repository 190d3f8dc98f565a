//! Rays side by side in the spaces of [`watertight`]: the same formulas, a ray in each lane, with the same bits.
//!
//! [`watertight`]: super::watertight

use snell_math::lanes::{Bits, Floats, LaneVector, Lanes, WIDTH};

use super::watertight::{Meeting, RaySpace, SMALL, exact_difference};

/// The axes of space that become the first, second and third, by the one the ray is longest on.
const AXES: [[usize; 3]; 3] = [[1, 2, 0], [2, 0, 1], [0, 1, 2]];

/// On which axis rays are longest, where it is not x.
#[derive(Clone, Copy)]
pub(super) struct LongAxes {
    y: Bits,
    z: Bits,
}

impl LongAxes {
    #[inline(always)]
    fn new<L: Lanes>(direction: LaneVector<L>) -> Self {
        let (x, y, z) = (direction.x.abs(), direction.y.abs(), direction.z.abs());
        Self { y: y.gt(x), z: z.gt(x) & z.gt(y) }
    }

    /// Which axes of space one ray calls first, second and third.
    #[inline(always)]
    pub(super) fn of(&self, lane: usize) -> [usize; 3] {
        AXES[if self.z.has(lane) { 2 } else { usize::from(self.y.has(lane)) }]
    }

    /// Components in the order of each ray's axes.
    #[inline(always)]
    pub(super) fn in_order<L: Lanes>(&self, v: LaneVector<L>) -> LaneVector<L> {
        LaneVector {
            x: v.x.or_where_not(self.z, v.z.or_where_not(self.y, v.y)),
            y: v.y.or_where_not(self.z, v.x.or_where_not(self.y, v.z)),
            z: v.z.or_where_not(self.z, v.y.or_where_not(self.y, v.x)),
        }
    }
}

/// As [`RaySpace`], in rows.
pub(super) struct RaySpaces {
    pub(super) axes: LongAxes,
    /// The lanes whose rays have one.
    pub(super) usable: Bits,
    origin: [[f64; WIDTH]; 3],
    shear: [[f64; WIDTH]; 3],
}

impl RaySpaces {
    #[inline(always)]
    pub(super) fn new<L: Lanes>(origin: LaneVector<L>, direction: LaneVector<L>) -> Self {
        let axes = LongAxes::new(direction);
        let (o, d) = (axes.in_order(origin), axes.in_order(direction));
        // Zero times a number is zero, times anything else it is NaN.
        let zero = L::splat(0.0);
        let zeros = (o.x * zero + o.y * zero + o.z * zero) + (d.x * zero + d.y * zero + d.z * zero);
        let longest = d.z.abs();
        let normal = L::splat(f64::MIN_POSITIVE).le(longest) & longest.lt(L::splat(f64::INFINITY));
        let rows = [[0.0; WIDTH]; 3];
        let mut spaces = Self { axes, usable: normal & zeros.same(zeros), origin: rows, shear: rows };
        o.store(&mut spaces.origin, 0);
        LaneVector { x: d.x / d.z, y: d.y / d.z, z: L::splat(1.0) / d.z }.store(&mut spaces.shear, 0);
        spaces
    }

    /// That of one ray.
    #[inline(always)]
    pub(super) fn space(&self, lane: usize) -> RaySpace {
        let lane = lane & (WIDTH - 1);
        RaySpace::of_parts(self.origin.map(|row| row[lane]), self.axes.of(lane), self.shear.map(|row| row[lane]))
    }

    /// As [`RaySpace::meet_surely`], a triangle for each ray, the coordinates of its corners in the order of the ray's axes.
    #[inline(always)]
    pub(super) fn meet<L: Lanes>(&self, [p, q, r]: [LaneVector<L>; 3]) -> LaneMeeting<L> {
        let (origin, shear) = (LaneVector::load(&self.origin, 0), LaneVector::load(&self.shear, 0));
        let (p, q, r) = (sheared(p, origin, shear), sheared(q, origin, shear), sheared(r, origin, shear));
        let (a, b, c) = (exact_cross(q, r), exact_cross(r, p), exact_cross(p, q));
        let area = a + b + c;
        let weights = LaneVector { x: a / area, y: b / area, z: c / area };
        let (zero, small) = (L::splat(0.0), L::splat(SMALL));
        let (negative, ahead) = (area.lt(zero), zero.lt(shear.z));
        LaneMeeting {
            t: (weights.x * p.z + weights.y * q.z + weights.z * r.z) * shear.z,
            weights,
            front: negative & ahead | !(negative | ahead),
            missed: area.same(zero) | !area.same(area),
            small: a.abs().lt(small) | b.abs().lt(small) | c.abs().lt(small),
            one_sided: a.gt(zero) & b.gt(zero) & c.gt(zero) | a.lt(zero) & b.lt(zero) & c.lt(zero),
        }
    }
}

/// Where each ray meets a triangle that it surely meets.
pub(super) struct LaneMeeting<L> {
    t: L,
    pub(super) weights: LaneVector<L>,
    front: Bits,
    missed: Bits,
    /// The lanes of which nothing else is true: their products are too small, see [`SMALL`].
    small: Bits,
    /// The lanes whose edge functions have the same sign, and none is zero.
    one_sided: Bits,
}

impl<L: Lanes> LaneMeeting<L> {
    /// The lanes of which it can be seen here that the ray meets the triangle.
    #[inline(always)]
    pub(super) fn seen(&self) -> Bits {
        self.one_sided.without(self.missed | self.small)
    }

    /// In rows.
    #[inline(always)]
    pub(super) fn rows(&self) -> Meetings {
        let Self { front, missed, small, .. } = *self;
        let mut meetings = Meetings { t: [0.0; WIDTH], weights: [[0.0; WIDTH]; 3], front, missed, small };
        self.t.store(&mut meetings.t, 0);
        self.weights.store(&mut meetings.weights, 0);
        meetings
    }
}

/// What stands at the corners of a triangle, for each ray, in rows.
pub(super) struct Corners([[[f32; WIDTH]; 3]; 3]);

impl Corners {
    pub(super) const NOTHING: Self = Self([[[0.0; WIDTH]; 3]; 3]);

    /// Puts in those of one ray.
    #[inline(always)]
    pub(super) fn put(&mut self, lane: usize, corners: &[[f32; 3]; 3]) {
        for (rows, corner) in self.0.iter_mut().zip(corners) {
            for (row, x) in rows.iter_mut().zip(corner) {
                row[lane & (WIDTH - 1)] = *x;
            }
        }
    }

    /// Each corner's, in lanes.
    #[inline(always)]
    pub(super) fn lanes<L: Lanes>(&self) -> [LaneVector<L>; 3] {
        [load(&self.0[0]), load(&self.0[1]), load(&self.0[2])]
    }

    /// Those of one ray.
    #[inline(always)]
    fn of(&self, lane: usize) -> [[f32; 3]; 3] {
        self.0.map(|rows| rows.map(|row| row[lane & (WIDTH - 1)]))
    }
}

/// As [`LaneMeeting`].
pub(super) struct Meetings {
    t: [f64; WIDTH],
    weights: [[f64; WIDTH]; 3],
    front: Bits,
    missed: Bits,
    small: Bits,
}

impl Meetings {
    /// The meeting of one ray.
    #[inline(always)]
    pub(super) fn of(&self, lane: usize, spaces: &RaySpaces, corners: &Corners) -> Option<Meeting> {
        if self.small.has(lane) {
            return meet_small(lane, spaces, corners);
        }
        let at = lane & (WIDTH - 1);
        let weights = self.weights.map(|row| row[at]);
        (!self.missed.has(lane)).then(|| Meeting { t: self.t[at], weights, front: self.front.has(lane) })
    }
}

#[cold]
fn meet_small(lane: usize, spaces: &RaySpaces, corners: &Corners) -> Option<Meeting> {
    spaces.space(lane).meet_surely::<f64>(&corners.of(lane))
}

/// Three rows of numbers.
#[inline(always)]
fn load<L: Lanes>([x, y, z]: &[[f32; WIDTH]; 3]) -> LaneVector<L> {
    LaneVector {
        x: L::from_floats(L::Floats::load(x, 0)),
        y: L::from_floats(L::Floats::load(y, 0)),
        z: L::from_floats(L::Floats::load(z, 0)),
    }
}

/// A corner in the spaces of rays.
#[inline(always)]
fn sheared<L: Lanes>(corner: LaneVector<L>, origin: LaneVector<L>, shear: LaneVector<L>) -> LaneVector<L> {
    let LaneVector { x, y, z } = corner - origin;
    LaneVector { x: x - shear.x * z, y: y - shear.y * z, z }
}

/// The exact edge function from one corner to the next, in each lane.
#[inline(always)]
fn exact_cross<L: Lanes>(from: LaneVector<L>, to: LaneVector<L>) -> L {
    let (left, right) = (from.x * to.y, from.y * to.x);
    exact_difference(left, right, from.x.product_errors(to.y, left), from.y.product_errors(to.x, right))
}

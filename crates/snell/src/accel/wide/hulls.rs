//! Leaves of balls and tubes: a filter in `f32` that turns away most of those that a ray misses, and never one that it meets.
//!
//! Where primitives are known to lie in balls, or in tubes around an axis, a leaf has their centres, radii and axes side by side. A
//! ball is surely missed where the line passes it at more than its radius, or it lies behind the ray's origin or beyond the limit; a
//! tube is within a ball, and is surely missed too where the line passes its axis at more than its radius.
//!
//! With ε = 2⁻²⁴, E the tree's extent, η the error of `f64` (both see [`super::probe`]) and r the radius rounded up: the centre
//! relative to the origin, f, is at most 4.4 E long and errs by 5 ε E + η on each axis. With d the direction, rounded, and
//! m = f·d / d·d, the perpendicular f − m d errs by less than √3 (5 ε E + η) for that, 2 ε |f| for the direction's rounding
//! (twice: in m and in the product), and 12 ε |f| for the roundings of m, of the product and of the difference: by less than
//! 90 ε E + 2 η in all. So the line surely passes beyond the ball where the square of the perpendicular exceeds that of
//! r + δ, with δ = 128 ε E + 4 η for the roundings of squares too. Since |d| ≥ 1, the ball's part of the line lies within
//! m ± (r + δ).
//!
//! With a the unit vector of a tube's axis, n = d × a errs by less than 10 ε, since |d| ≤ √3. The line passes the axis at
//! |f·n| / |n|. f·n errs by less than 10 ε |f| + |n| √3 (5 ε E + η) + 3 ε |f| |n|, so by 82 ε E + 3 η; |n| times a radius, at most
//! 2 E, by 20 ε E; the axis turned by its rounding leaves the tube's middle by less than 6 ε E. So the tube is surely missed where
//! |f·n| − δ exceeds (r + δ) |n|.

use snell_math::lanes::{Bits, Eight, Floats, LaneVector, Lanes, WIDTH};
use snell_math::{Point3, Vector3};

use super::probe::{EPSILON, Probe, splat};
use super::probes::{Probes, spread};
use super::shared::{NONE, number};

/// What a primitive lies in, beside its box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hull {
    /// Nothing that is known.
    Unknown,
    /// A ball.
    Ball {
        /// Its middle.
        center: Point3,
        /// Its radius.
        radius: f64,
    },
    /// A tube, which ends where its axis does.
    Tube {
        /// The middle of the axis.
        center: Point3,
        /// From there to an end.
        half_axis: Vector3,
        /// The radius around the axis.
        radius: f64,
    },
}

/// Eight balls.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct BallBlock {
    center: [[f32; WIDTH]; 3],
    /// Rounded up, infinite of what has no ball. NaN where there is nothing, which no filter lets through.
    radius: [f32; WIDTH],
}

/// Eight tubes.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct TubeBlock {
    /// Unit vectors, zero where there is no tube: of such the filter says nothing.
    axis: [[f32; WIDTH]; 3],
    /// Rounded up.
    radius: [f32; WIDTH],
}

/// What primitives of leaves lie in; a list is empty where none of it is known.
#[derive(Clone, Debug, Default)]
pub(super) struct Hulls {
    balls: Vec<BallBlock>,
    tubes: Vec<TubeBlock>,
}

impl Hulls {
    /// Of the entries of all leaves, by the hulls of all primitives.
    pub(super) fn new(leaves: &[[u32; WIDTH]], hulls: &[Hull]) -> Self {
        let mut blocks = Self::default();
        if hulls.iter().any(|hull| *hull != Hull::Unknown) {
            blocks.balls = leaves.iter().map(|entries| BallBlock::new(entries, hulls)).collect();
        }
        if hulls.iter().any(|hull| matches!(hull, Hull::Tube { .. })) {
            blocks.tubes = leaves.iter().map(|entries| TubeBlock::new(entries, hulls)).collect();
        }
        blocks
    }

    /// The memory of all, in bytes.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.balls.as_slice()) + size_of_val(self.tubes.as_slice())
    }

    /// What is known of a leaf, if anything.
    #[inline(always)]
    pub(super) fn of(&self, leaf: u32) -> Option<LeafHulls<'_>> {
        let balls = self.balls.get(leaf as usize)?;
        Some(LeafHulls { balls, tubes: self.tubes.get(leaf as usize) })
    }
}

/// What is known of a leaf.
#[derive(Clone, Copy)]
pub(super) struct LeafHulls<'a> {
    balls: &'a BallBlock,
    tubes: Option<&'a TubeBlock>,
}

impl LeafHulls<'_> {
    /// Asks for the memory.
    #[inline(always)]
    pub(super) fn prefetch<F: Eight>(&self) {
        F::prefetch(self.balls);
        if let Some(tubes) = self.tubes {
            F::prefetch(tubes);
        }
    }
}

impl BallBlock {
    fn new(entries: &[u32; WIDTH], hulls: &[Hull]) -> Self {
        let mut block = Self { center: [[0.0; WIDTH]; 3], radius: [f32::NAN; WIDTH] };
        for (lane, entry) in entries.iter().enumerate().filter(|(_, entry)| **entry != NONE) {
            let (center, radius) = match hulls[number(*entry) as usize] {
                Hull::Unknown => (Point3::ORIGIN, f64::INFINITY),
                Hull::Ball { center, radius } => (center, radius),
                Hull::Tube { center, half_axis, radius } => {
                    (center, (half_axis.length_squared() + radius * radius).sqrt())
                }
            };
            for (axis, row) in block.center.iter_mut().enumerate() {
                row[lane] = center[axis] as f32;
            }
            block.radius[lane] = (radius as f32).next_up();
        }
        block
    }
}

impl TubeBlock {
    fn new(entries: &[u32; WIDTH], hulls: &[Hull]) -> Self {
        let mut block = Self { axis: [[0.0; WIDTH]; 3], radius: [0.0; WIDTH] };
        for (lane, entry) in entries.iter().enumerate().filter(|(_, entry)| **entry != NONE) {
            if let Hull::Tube { half_axis, radius, .. } = hulls[number(*entry) as usize]
                && let Some(unit) = half_axis.try_normalize()
            {
                for (axis, row) in block.axis.iter_mut().enumerate() {
                    row[lane] = unit[axis] as f32;
                }
                block.radius[lane] = (radius as f32).next_up();
            }
        }
        block
    }
}

/// Probes side by side, made ready for balls and tubes; see [`BallRay`].
pub(super) struct BallLines {
    origin: [[f32; WIDTH]; 3],
    direction: [[f32; WIDTH]; 3],
    scaled: [[f32; WIDTH]; 3],
    error: [f32; WIDTH],
}

impl BallLines {
    #[inline(always)]
    pub(super) fn new<L: Lanes>(probes: &Probes<L>) -> Self {
        let Probes { origin, direction, error, extent, .. } = *probes;
        let rows = [[0.0; WIDTH]; 3];
        let mut lines = Self { origin: rows, direction: rows, scaled: rows, error: [0.0; WIDTH] };
        store(origin, &mut lines.origin);
        store(direction, &mut lines.direction);
        let rounded = LaneVector {
            x: L::from_floats(direction.x.to_floats()),
            y: L::from_floats(direction.y.to_floats()),
            z: L::from_floats(direction.z.to_floats()),
        };
        store(rounded * (L::splat(1.0) / rounded.length_squared()), &mut lines.scaled);
        let error = L::splat(128.0 * f64::from(EPSILON) * extent) + L::splat(4.0) * error;
        error.to_floats().store(&mut lines.error, 0);
        lines
    }

    /// One of them in all lanes.
    #[inline(always)]
    pub(super) fn spread<F: Eight>(&self, lane: usize) -> BallRay<F> {
        let lane = lane & (WIDTH - 1);
        BallRay {
            origin: spread(&self.origin, lane),
            direction: spread(&self.direction, lane),
            scaled: spread(&self.scaled, lane),
            error: F::splat(self.error[lane]),
        }
    }
}

/// Rounds vectors to rows of `f32`.
#[inline(always)]
fn store<L: Lanes>(v: LaneVector<L>, [x, y, z]: &mut [[f32; WIDTH]; 3]) {
    v.x.to_floats().store(x, 0);
    v.y.to_floats().store(y, 0);
    v.z.to_floats().store(z, 0);
}

/// A probe in all lanes, for balls and tubes.
#[derive(Clone, Copy)]
pub(super) struct BallRay<F> {
    origin: [F; 3],
    direction: [F; 3],
    /// The direction over its squared length.
    scaled: [F; 3],
    /// δ.
    error: F,
}

impl<F: Eight> BallRay<F> {
    #[inline(always)]
    pub(super) fn new(probe: &Probe) -> Self {
        let direction = probe.direction.map(|x| x as f32);
        let squared = direction.iter().map(|x| x * x).sum::<f32>();
        let error = 128.0 * f64::from(EPSILON) * probe.extent + 4.0 * probe.error;
        Self {
            origin: splat(&probe.origin.map(|x| x as f32)),
            direction: splat(&direction),
            scaled: splat(&direction.map(|x| x / squared)),
            error: F::splat(error as f32),
        }
    }

    /// The lanes whose primitives the ray may meet before the limit.
    #[inline(always)]
    pub(super) fn look(&self, leaf: LeafHulls, limit: F) -> u32 {
        let mut f = self.origin;
        for (f, row) in f.iter_mut().zip(&leaf.balls.center) {
            *f = F::load(row, 0) - *f;
        }
        let middle = dot(f, self.scaled);
        let mut beside = f;
        for (beside, direction) in beside.iter_mut().zip(self.direction) {
            *beside = direction.multiply_add(-middle, *beside);
        }
        let reach = F::load(&leaf.balls.radius, 0) + self.error;
        let (front, back) = (middle - reach, middle + reach);
        let met = dot(beside, beside).le(reach * reach) & front.le(limit) & F::splat(0.0).le(back);
        match leaf.tubes {
            Some(tubes) => (met & self.passes(tubes, f)).mask(),
            None => met.mask(),
        }
    }

    /// The lanes whose tubes' axes, of middles `f` from the origin, the line may pass within their radii.
    #[inline(always)]
    fn passes(&self, tubes: &TubeBlock, f: [F; 3]) -> Bits {
        let axis = [F::load(&tubes.axis[0], 0), F::load(&tubes.axis[1], 0), F::load(&tubes.axis[2], 0)];
        let normal = cross(self.direction, axis);
        let apart = (dot(f, normal).abs() - self.error).greater(F::splat(0.0));
        let reach = F::load(&tubes.radius, 0) + self.error;
        // A little more, for the roundings of squares.
        let most = reach * reach * dot(normal, normal) * F::splat(1.0 + 64.0 * EPSILON);
        (apart * apart).le(most)
    }
}

// Functions and not closures, which cannot be marked to be inlined: left out of line, they would be compiled without the
// instructions.

#[inline(always)]
fn dot<F: Eight>(a: [F; 3], b: [F; 3]) -> F {
    a[0].multiply_add(b[0], a[1].multiply_add(b[1], a[2] * b[2]))
}

#[inline(always)]
fn cross<F: Eight>(a: [F; 3], b: [F; 3]) -> [F; 3] {
    [
        a[1].multiply_add(b[2], -(a[2] * b[1])),
        a[2].multiply_add(b[0], -(a[0] * b[2])),
        a[0].multiply_add(b[1], -(a[1] * b[0])),
    ]
}

//! Questions of many rays at once: eight side by side.
//!
//! Plain spheres and planes that stand in the world as they are, which most rays are tested with, are met by all lanes at once;
//! hierarchies, instances and meshes by rays together, see `packets.rs`; everything else by one ray after the other. What is found
//! is what [`Geometry::intersect`] and [`Geometry::gather_blockers`] find for each ray alone.

use snell_math::lanes::{Bits, LaneVector, Lanes, WIDTH};

use super::blocked::{BlockedInWorld, Shadows};
use super::packets::{Found, NearestInWorld};
use super::space::{NONE, Primitive};
use super::{Geometry, Hit, InnerHit, LocalPlace, QueryScratch, TOUCHING, Touching};
use crate::accel::Candidate;
use crate::shape::{LanePlanes, LaneSpheres, RayRow};
use crate::task::{QuestionRows, RayRows};

/// The nearest hits of eight rays.
#[derive(Clone, Copy, Debug)]
pub struct HitRows {
    /// See [`Hit::t`].
    pub t: [f64; WIDTH],
    /// The primitive of the world; [`NONE`] where a ray meets nothing.
    pub(super) primitive: [u32; WIDTH],
    pub(super) inner: [u32; WIDTH],
    pub(super) place: [LocalPlace; WIDTH],
}

impl HitRows {
    /// No hit in any lane.
    pub const NOTHING: Self = Self {
        t: [0.0; WIDTH],
        primitive: [NONE; WIDTH],
        inner: [NONE; WIDTH],
        place: [LocalPlace { part: 0, leaf: 0, flipped: false, entering: false }; WIDTH],
    };

    /// The lanes that have a hit.
    #[inline(always)]
    pub fn met(&self) -> Bits {
        let mut met = 0;
        for (lane, primitive) in self.primitive.iter().enumerate() {
            met |= u8::from(*primitive != NONE) << lane;
        }
        Bits(met)
    }

    /// Of some lanes, one at least, the primitive that the first has met, and all that have met the same.
    #[inline(always)]
    pub(super) fn alike(&self, lanes: Bits) -> (u32, Bits) {
        let primitive = self.primitive[lanes.lowest() & (WIDTH - 1)];
        let mut same = Bits::NONE;
        for lane in lanes.lanes() {
            same |= Bits(u8::from(self.primitive[lane] == primitive) << lane);
        }
        (primitive, same)
    }

    /// The hit of one lane.
    #[inline]
    pub fn hit(&self, lane: usize) -> Option<Hit> {
        let (primitive, inner, place) = (self.primitive[lane], self.inner[lane], self.place[lane]);
        (primitive != NONE).then_some(Hit { t: self.t[lane], primitive, inner, place })
    }

    /// Sets the hit of one lane.
    #[inline]
    pub fn set(&mut self, lane: usize, hit: Option<Hit>) {
        self.primitive[lane] = NONE;
        if let Some(Hit { t, primitive, inner, place }) = hit {
            (self.t[lane], self.primitive[lane], self.inner[lane], self.place[lane]) = (t, primitive, inner, place);
        }
    }
}

/// What is in the way of eight shadow rays.
#[derive(Debug, Default)]
pub struct Blockers {
    /// The lanes in whose way something opaque is.
    pub blocked: Bits,
    /// The meetings of the others with transparent surfaces, each with its lane, in no particular order.
    pub hits: Vec<(u8, Hit)>,
}

/// The nearest hits that are known so far.
struct Nearest<L> {
    /// What hits are compared by, see [`Touching`].
    key: L,
    t: L,
    /// The primitive, as a number; −1 where there is none yet.
    index: L,
    /// The lanes whose hit is no simple one: more of it stands in the rows.
    complex: Bits,
}

impl<L: Lanes> Nearest<L> {
    /// Takes over hits of one primitive at `t` where they come before what is known.
    #[inline(always)]
    fn take(&mut self, met: Bits, t: L, key: L, index: u32, ties: Bits) {
        let better = met & (key.lt(self.key) | key.same(self.key) & ties);
        self.key = key.or_where_not(better, self.key);
        self.t = t.or_where_not(better, self.t);
        self.index = L::splat(f64::from(index)).or_where_not(better, self.index);
        self.complex = self.complex.without(better);
    }

    /// The lanes that have no hit yet.
    #[inline(always)]
    fn without_hit(&self) -> Bits {
        self.index.lt(L::splat(0.0))
    }
}

/// What hits are compared by, see [`Touching::key`].
#[inline(always)]
pub(super) fn key_of<L: Lanes>(t: L, along: L, is_opaque: bool) -> L {
    if is_opaque { t } else { t + (L::splat(TOUCHING) * t + along) }
}

/// Reads one lane of a number.
#[inline(always)]
fn lane_of<L: Lanes>(number: L, lane: usize) -> f64 {
    let mut row = [0.0; WIDTH];
    number.store(&mut row, 0);
    row[lane]
}

impl Geometry {
    /// The nearest hits of rays side by side, from place `at` of the rows on; lanes that are not `active` get none.
    #[inline(always)]
    pub(crate) fn intersect_lanes<L: Lanes>(
        &self,
        rays: &RayRows,
        at: usize,
        active: Bits,
        hits: &mut HitRows,
        scratch: &mut QueryScratch,
    ) {
        let ray = RayRow { origin: &rays.origin, direction: &rays.direction }.lanes::<L>(at);
        let along = L::splat(TOUCHING) * ray.origin.max_abs();
        let infinity = L::splat(f64::INFINITY);
        let mut nearest = Nearest { key: infinity, t: infinity, index: L::splat(-1.0), complex: Bits::NONE };
        let world = &self.world;
        // The unbounded ones before the rest, since a floor shortens the way through it.
        for (primitive, index) in world.primitives[world.first_alone..].iter().zip(world.first_alone as u32..) {
            let is_opaque = world.attributes[index as usize].is_opaque;
            let (met, t) = match primitive {
                Primitive::Sphere(sphere) => LaneSpheres::from(sphere).intersect(&ray, infinity),
                Primitive::Plane(plane) => LanePlanes::from(plane).intersect(&ray, infinity),
                _ => {
                    self.meet_others(Some(index), rays, at, active, &mut nearest, hits, scratch);
                    continue;
                }
            };
            let met = met & active;
            if met.any() {
                let ties = nearest.without_hit();
                nearest.take(met, t, key_of(t, along, is_opaque), index, ties);
            }
        }
        if !world.handful.is_empty() {
            for (primitive, index) in world.primitives[..world.first_alone].iter().zip(0..) {
                let Primitive::Sphere(sphere) = primitive else { continue };
                let (met, t) = LaneSpheres::from(sphere).intersect(&ray, infinity);
                let met = met & active;
                if met.any() {
                    let is_opaque = world.attributes[index as usize].is_opaque;
                    // Of equals the lowest, which is not the one without bounds that was found before.
                    let ties = nearest.without_hit() | L::splat(f64::from(index)).lt(nearest.index);
                    nearest.take(met, t, key_of(t, along, is_opaque), index, ties);
                }
            }
        } else if world.first_alone > 0 {
            self.meet_others(None, rays, at, active, &mut nearest, hits, scratch);
        }

        let mut index = [0.0; WIDTH];
        nearest.index.store(&mut index, at);
        nearest.t.store(&mut hits.t, at);
        for lane in 0..L::COUNT {
            // The number −1 becomes NONE: 32 bits, all set.
            hits.primitive[at + lane] = index[at + lane] as i64 as u32;
            if !nearest.complex.has(lane) {
                hits.inner[at + lane] = NONE;
            }
        }
    }

    /// The nearest hits with a primitive that is no simple one, or where there is none, with all of the hierarchy.
    #[expect(clippy::too_many_arguments, reason = "a private step of the function above")]
    #[inline(always)]
    fn meet_others<L: Lanes>(
        &self,
        index: Option<u32>,
        rays: &RayRows,
        at: usize,
        active: Bits,
        nearest: &mut Nearest<L>,
        hits: &mut HitRows,
        scratch: &mut QueryScratch,
    ) {
        if L::COUNT < WIDTH {
            return self.meet_alone(index, rays, at, nearest, hits, scratch);
        }
        let (mut key, mut before) = ([0.0; WIDTH], [0.0; WIDTH]);
        nearest.key.store(&mut key, 0);
        nearest.index.store(&mut before, 0);
        nearest.t.store(&mut hits.t, 0);
        // The number −1 becomes NONE: 32 bits, all set.
        hits.primitive = before.map(|index| index as i64 as u32);
        let mut found = Found { key, hits, complex: nearest.complex };
        let rays = RayRow { origin: &rays.origin, direction: &rays.direction };
        L::stage(NearestInWorld { geometry: self, index, rays, active, found: &mut found, scratch });
        let index = found.hits.primitive.map(|index| if index == NONE { -1.0 } else { f64::from(index) });
        nearest.key = L::load(&found.key, 0);
        nearest.t = L::load(&found.hits.t, 0);
        nearest.index = L::load(&index, 0);
        nearest.complex = found.complex;
    }

    /// The same for one ray.
    #[inline(never)]
    fn meet_alone<L: Lanes>(
        &self,
        index: Option<u32>,
        rays: &RayRows,
        at: usize,
        nearest: &mut Nearest<L>,
        hits: &mut HitRows,
        scratch: &mut QueryScratch,
    ) {
        let ray = rays.ray(at);
        let touching = Touching::along(&ray);
        let limit = lane_of(nearest.key, 0);
        let mut meet = |primitive: &Primitive, is_opaque, limit| {
            self.meet_in(&self.world, primitive, is_opaque, &ray, touching, limit, scratch)
        };
        let found = match index {
            None => self.world.nearest_bounded(&ray, touching, limit, meet),
            Some(index) => {
                let is_opaque = self.world.attributes[index as usize].is_opaque;
                let hit = meet(&self.world.primitives[index as usize], is_opaque, limit);
                let wins = |hit: &InnerHit| hit.t() < limit || hit.t() == limit && nearest.without_hit().any();
                hit.filter(wins).map(|hit| (index, hit))
            }
        };
        if let Some((index, hit)) = found {
            nearest.keep(at, index, &hit, hits);
        }
    }

    /// What is in the way of shadow rays side by side, from place `at` of the rows on, as [`Geometry::gather_blockers`]; where
    /// `any_blocks`, everything blocks, as in [`Geometry::is_blocked`]. Lanes count from `at`.
    #[inline(always)]
    pub(crate) fn block_lanes<L: Lanes>(
        &self,
        rows: &QuestionRows,
        at: usize,
        active: Bits,
        any_blocks: bool,
        blockers: &mut Blockers,
        scratch: &mut QueryScratch,
    ) {
        let row = RayRow { origin: &rows.origin, direction: &rows.direction };
        let ray = &row.lanes::<L>(at);
        let distance = L::load(&rows.distance, at);
        blockers.blocked = Bits::NONE;
        blockers.hits.clear();
        let world = &self.world;
        let of_handful = if world.handful.is_empty() { 0 } else { world.first_alone };
        let alone = world.primitives[world.first_alone..].iter().zip(world.first_alone as u32..);
        for (primitive, index) in alone.chain(world.primitives[..of_handful].iter().zip(0..)) {
            let open = active.without(blockers.blocked);
            if open.is_empty() {
                return;
            }
            let is_opaque = any_blocks || world.attributes[index as usize].is_opaque;
            match primitive {
                Primitive::Plane(plane) => {
                    let (met, t) = LanePlanes::from(plane).intersect(ray, distance);
                    if is_opaque {
                        blockers.blocked |= met & open;
                    } else {
                        keep_met(&mut blockers.hits, met & open, t, index, NONE);
                    }
                }
                Primitive::Sphere(sphere) if is_opaque => {
                    blockers.blocked |= LaneSpheres::from(sphere).intersect(ray, distance).0 & open;
                }
                Primitive::Sphere(sphere) => {
                    for (met, t) in LaneSpheres::from(sphere).hits_before(ray, distance) {
                        keep_met(&mut blockers.hits, met & open, t, index, NONE);
                    }
                }
                _ => {
                    let blocked =
                        self.block_others::<L>(Some(index), rows, at, open, any_blocks, &mut blockers.hits, scratch);
                    blockers.blocked |= blocked;
                }
            }
        }
        if world.handful.is_empty() && world.first_alone > 0 {
            let open = active.without(blockers.blocked);
            if open.any() {
                let blocked = self.block_others::<L>(None, rows, at, open, any_blocks, &mut blockers.hits, scratch);
                blockers.blocked |= blocked;
            }
        }
    }

    /// Which shadow rays are blocked by a primitive that is no simple one, or where there is none, by those of the hierarchy.
    #[expect(clippy::too_many_arguments, reason = "a private step of the function above")]
    #[inline(always)]
    fn block_others<L: Lanes>(
        &self,
        index: Option<u32>,
        rows: &QuestionRows,
        at: usize,
        active: Bits,
        any_blocks: bool,
        hits: &mut Vec<(u8, Hit)>,
        scratch: &mut QueryScratch,
    ) -> Bits {
        if L::COUNT < WIDTH {
            let (ray, distance) = (rows.ray(at), rows.distance[at]);
            return Bits::all_if(match index {
                None => self.is_blocked_by_bounded(&ray, distance, any_blocks, hits, scratch),
                Some(index) => {
                    let primitive = &self.world.primitives[index as usize];
                    let keep = |hit| hits.push((0, hit));
                    self.is_blocked_by(index, primitive, &ray, distance, any_blocks, keep, scratch)
                }
            }) & L::all();
        }
        let shadows = &mut Shadows { distance: &rows.distance, any_blocks, hits, scratch };
        let rays = RayRow { origin: &rows.origin, direction: &rows.direction };
        L::stage(BlockedInWorld { geometry: self, index, rays, active, shadows })
    }

    /// As [`Geometry::is_at_origin`], side by side.
    #[inline(always)]
    pub(crate) fn are_at_origin<L: Lanes>(origin: LaneVector<L>, t: L) -> Bits {
        t.le(L::splat(TOUCHING) * origin.max_abs())
    }
}

impl<L: Lanes> Nearest<L> {
    /// Takes over the hit of a lane that is the only one, and that is no simple one.
    fn keep(&mut self, at: usize, index: u32, hit: &InnerHit, hits: &mut HitRows) {
        self.key = L::splat(hit.key);
        self.t = L::splat(hit.local.t);
        self.index = L::splat(f64::from(index));
        self.complex = L::all();
        hits.inner[at] = hit.inner;
        hits.place[at] = hit.local.place;
    }
}

/// Keeps a transparent surface, met at `t` by some lanes.
#[inline(always)]
pub(super) fn keep_met<L: Lanes>(hits: &mut Vec<(u8, Hit)>, met: Bits, t: L, primitive: u32, inner: u32) {
    if met.any() {
        let mut row = [0.0; WIDTH];
        t.store(&mut row, 0);
        for lane in met.lanes() {
            hits.push((lane as u8, Hit { t: row[lane], primitive, inner, place: LocalPlace::of_part(0) }));
        }
    }
}

//! Rays side by side against the same rays alone: the very bits, for all shapes and rays, by all instructions.

use snell_math::lanes::{InstructionSet, Lanes, WIDTH, Work, dispatch};
use snell_math::{Point3, Ray, Vector3};

use super::super::{Passage, RayRow, Shape, ShapeHit};
use super::{Random, fixture, ray_at};

/// The passages of a shape's surface with 0 < t < `t_max`: for each lane as (bits of t, part).
struct Passages<'a> {
    shape: &'a Shape,
    rays: &'a [Ray; WIDTH],
    t_max: f64,
}

/// For each lane: the first passage, and all.
type Found = [(Option<(u64, u32)>, Vec<(u64, u32)>); WIDTH];

impl Work for Passages<'_> {
    type Output = Found;
    #[inline(always)]
    fn run<L: Lanes>(self) -> Found {
        let (origin, direction) = rows(self.rays);
        let mut found = Found::default();
        for at in (0..WIDTH).step_by(L::COUNT) {
            let ray = RayRow { origin: &origin, direction: &direction }.lanes::<L>(at);
            let passages = self.shape.passages(&ray);
            let t_max = L::splat(self.t_max);
            let first = Passage::first_before(passages, t_max);
            for (number, passage) in [first, passages[0], passages[1]].into_iter().enumerate() {
                let (mut t, mut part) = ([0.0; WIDTH], [0.0; WIDTH]);
                passage.t.store(&mut t, at);
                passage.part.store(&mut part, at);
                let met = if number == 0 { passage.met } else { passage.before(t_max) };
                for lane in (0..L::COUNT).filter(|lane| met.has(*lane)) {
                    let here = (t[at + lane].to_bits(), part[at + lane] as u32);
                    match number {
                        0 => found[at + lane].0 = Some(here),
                        _ => found[at + lane].1.push(here),
                    }
                }
            }
        }
        found
    }
}

/// The surface at places that are known: for each lane the bits of the point, the normal and the error.
struct Surfaces<'a> {
    shape: &'a Shape,
    rays: &'a [Ray; WIDTH],
    hits: &'a [ShapeHit; WIDTH],
}

impl Work for Surfaces<'_> {
    type Output = [[u64; 7]; WIDTH];
    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        let (origin, direction) = rows(self.rays);
        let (t, part) = (self.hits.map(|hit| hit.t), self.hits.map(|hit| f64::from(hit.part)));
        let mut found = [[0; 7]; WIDTH];
        for at in (0..WIDTH).step_by(L::COUNT) {
            let ray = RayRow { origin: &origin, direction: &direction }.lanes::<L>(at);
            let (point, normal, error) = self.shape.surfaces(&ray, L::load(&t, at), L::load(&part, at));
            for (number, numbers) in
                [point.x, point.y, point.z, normal.x, normal.y, normal.z, error].into_iter().enumerate()
            {
                let mut row = [0.0; WIDTH];
                numbers.store(&mut row, at);
                (at..at + L::COUNT).for_each(|lane| found[lane][number] = row[lane].to_bits());
            }
        }
        found
    }
}

fn rows(rays: &[Ray; WIDTH]) -> ([[f64; WIDTH]; 3], [[f64; WIDTH]; 3]) {
    let (mut origin, mut direction) = ([[0.0; WIDTH]; 3], [[0.0; WIDTH]; 3]);
    for (lane, ray) in rays.iter().enumerate() {
        for axis in 0..3 {
            (origin[axis][lane], direction[axis][lane]) = (ray.origin[axis], ray.direction[axis]);
        }
    }
    (origin, direction)
}

/// What rays find alone, from one hit to the next.
fn alone(shape: &Shape, rays: &[Ray; WIDTH], t_max: f64) -> Found {
    std::array::from_fn(|lane| {
        let (mut all, mut t_min) = (Vec::new(), 0.0);
        while let Some(hit) = shape.intersect(&rays[lane], t_min, t_max) {
            all.push((hit.t.to_bits(), hit.part));
            t_min = hit.t;
        }
        (all.first().copied(), all)
    })
}

/// A ray at a fixture, or one that is good for nothing.
fn any_ray(random: &mut Random, good: Ray) -> Ray {
    let bad = [f64::NAN, f64::INFINITY, 0.0, -0.0, 1e-310, 1e300][random.below(6) as usize];
    let axis = random.below(3) as usize;
    let Ray { mut origin, mut direction, .. } = good;
    match random.below(24) {
        0 => origin.0[axis] = bad,
        1 => direction.0[axis] = bad,
        2 => direction = Vector3::new(bad, bad, bad),
        _ => {}
    }
    Ray::new(origin, direction)
}

#[test]
fn shapes_are_met_side_by_side_as_alone() {
    let mut random = Random(7);
    let (mut met, mut noticed) = (0, 0);
    for i in 0..16_000_u64 {
        let scale = [1.0, 1e-3, 1e6, 30.0][random.below(4) as usize];
        let center = Point3::ORIGIN + random.vector_in_ball(5.0 * scale);
        let fixture = fixture(&mut random, i % 8, center, scale);
        if matches!(fixture.shape, Shape::Torus(_)) {
            assert!(!fixture.shape.has_lanes());
            continue;
        }
        let open = match &fixture.shape {
            Shape::Cone(frustum) if random.below(2) == 0 => Shape::Cone(frustum.opened()),
            shape => *shape,
        };
        let from = [3.0, 100.0, 0.3][random.below(3) as usize] * scale;
        let rays: [Ray; WIDTH] = std::array::from_fn(|_| {
            let good = ray_at(&mut random, &fixture, from);
            any_ray(&mut random, good)
        });
        let t_max = [f64::INFINITY, 3.0 * scale][random.below(2) as usize];
        let expected = alone(&open, &rays, t_max);
        for set in InstructionSet::available() {
            let found = dispatch(set, Passages { shape: &open, rays: &rays, t_max });
            assert_eq!(found, expected, "{i}, {set:?}: {open:?} {rays:?} {t_max}");
        }
        met += expected.iter().filter(|(first, _)| first.is_some()).count();
        // The twin: one ray in another's place must be noticed where they do not meet the same.
        if expected[0] != expected[1] {
            let mut twisted = rays;
            twisted.swap(0, 1);
            let found = dispatch(InstructionSet::best(), Passages { shape: &open, rays: &twisted, t_max });
            assert_ne!(found, expected, "{i}");
            noticed += 1;
        }
    }
    assert!(met > 30_000 && noticed > 5_000, "{met} {noticed}");
}

#[test]
fn surfaces_are_worked_out_side_by_side_as_alone() {
    let mut random = Random(8);
    let (mut compared, mut noticed) = (0, 0);
    for i in 0..16_000_u64 {
        let scale = [1.0, 1e-3, 1e6, 30.0][random.below(4) as usize];
        let center = Point3::ORIGIN + random.vector_in_ball(5.0 * scale);
        let fixture = fixture(&mut random, i % 8, center, scale);
        let shape = &fixture.shape;
        let rays: [Ray; WIDTH] = std::array::from_fn(|_| ray_at(&mut random, &fixture, 3.0 * scale));
        let hits = rays.map(|ray| shape.intersect(&ray, 0.0, f64::INFINITY));
        let met: Vec<usize> = (0..WIDTH).filter(|lane| hits[*lane].is_some()).collect();
        if met.is_empty() || !shape.has_lanes() {
            continue;
        }
        let hits = hits.map(|hit| hit.unwrap_or(ShapeHit { t: 1.0, part: 0 }));
        for set in InstructionSet::available() {
            let found = dispatch(set, Surfaces { shape, rays: &rays, hits: &hits });
            for &lane in &met {
                let alone = shape.surface_geometry(&rays[lane], hits[lane]);
                let (point, normal) = (alone.point.to_array(), alone.geometric_normal.to_array());
                let expected = [point, normal].concat().into_iter().chain([alone.error]).map(f64::to_bits);
                assert!(expected.eq(found[lane]), "{i}, {set:?}: {shape:?} {:?} {:?}", rays[lane], hits[lane]);
                compared += 1;
            }
        }
        // The twin: a hit a little farther along its ray is another one.
        let farther = hits.map(|hit| ShapeHit { t: 1.001 * hit.t, ..hit });
        let [here, there] =
            [&hits, &farther].map(|hits| dispatch(InstructionSet::best(), Surfaces { shape, rays: &rays, hits }));
        noticed += met.iter().filter(|lane| here[**lane] != there[**lane]).count();
    }
    assert!(compared > 60_000 && noticed > 20_000, "{compared} {noticed}");
}

//! Rays side by side against the same rays alone: the very bits, for all shapes and rays, by all instructions.

use snell_math::lanes::{InstructionSet, Lanes, WIDTH, Work, dispatch};
use snell_math::{Point3, Ray, Vector3};

use super::super::{Passage, RayRow, Shape};
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
        let (mut origin, mut direction) = ([[0.0; WIDTH]; 3], [[0.0; WIDTH]; 3]);
        for (lane, ray) in self.rays.iter().enumerate() {
            for axis in 0..3 {
                (origin[axis][lane], direction[axis][lane]) = (ray.origin[axis], ray.direction[axis]);
            }
        }
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

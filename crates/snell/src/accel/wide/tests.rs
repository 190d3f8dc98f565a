//! The wide hierarchy against brute force by every instruction set, against nasty inputs, and its validator against planted
//! defects.

use std::ops::ControlFlow;

use proptest::prelude::*;
use snell_math::lanes::InstructionSet;
use snell_math::{Bounds3, Point3, Ray, Vector3};

use super::shared::{NONE, SHARED};
use super::*;
use crate::accel::bvh::Bvh;
use crate::accel::bvh::tests::{cube, halvings, nasty_inputs};
use crate::accel::random::Random;

/// A hierarchy for each instruction set there is.
fn every_way(bounds: &[Bounds3]) -> Vec<WideBvh> {
    let bvh = WideBvh::build(bounds).expect("finite boxes");
    assert_eq!(bvh.validate(bounds), Ok(()));
    InstructionSet::available().into_iter().map(|set| bvh.clone().with_instructions(set)).collect()
}

#[test]
fn nasty_inputs_give_valid_trees() {
    for (name, bounds) in nasty_inputs() {
        for bvh in every_way(&bounds) {
            let present = bounds.iter().filter(|b| !b.is_empty()).count();
            assert_eq!(bvh.is_empty(), present == 0, "{name}");
            // Every box is found again by a point of it and by a line through it.
            for (i, b) in bounds.iter().enumerate().step_by(97).filter(|(_, b)| !b.is_empty()) {
                let mut found = 0;
                bvh.point(b.center(), |primitive| found += usize::from(primitive == i as u32));
                assert_eq!(found, 1, "{name}: {i} by its centre");
                for t_max in [0.0, 1.0] {
                    let ray = Ray::new(b.center(), Vector3::new(0.5, -0.25, 1.0));
                    assert!(bvh.any(&ray, t_max, |primitive| primitive == i as u32), "{name}: {i} by a ray");
                }
            }
        }
    }
}

#[test]
fn the_stack_suffices_for_a_ray_that_meets_every_box() {
    // As the binary builder's own test: a greedy input. And one that is tested in `f32`.
    let mut greedy = Vec::new();
    let mut x = 1e38;
    for _ in 0..60 {
        greedy.push(cube(Point3::new(x, 0.0, 0.0), 0.1 * x));
        x /= 17.0;
    }
    greedy.extend(vec![cube(Point3::new(x, 0.0, 0.0), 0.1 * x); 4000]);
    let small = (0..4000).map(|i| cube(Point3::new(halvings(i % 40), 0.0, 0.0), 0.1 * halvings(i % 40))).collect();
    for bounds in [greedy, small] {
        for bvh in every_way(&bounds) {
            let mut count = 0;
            bvh.all(&Ray::new(Point3::ORIGIN, Vector3::X), f64::INFINITY, |_| count += 1);
            assert_eq!(count, bounds.len());
            let ray = Ray::new(Point3::new(-1.0, 0.0, 0.0), Vector3::X);
            assert_eq!(bvh.closest(&ray, f64::INFINITY, |_, _| None::<f64>), None);
        }
    }
}

/// Primitives of both kinds, tested in the plainest way.
enum Primitive {
    Sphere(Point3, f64),
    Triangle([Point3; 3]),
}

impl Primitive {
    fn random(random: &mut Random, scale: f64) -> Self {
        let center = Point3::ORIGIN + random.vector() * scale;
        let size = 0.2 * scale * random.number().abs();
        if random.bits().is_multiple_of(2) {
            Self::Sphere(center, size)
        } else {
            Self::Triangle([0, 1, 2].map(|_| center + random.vector() * size))
        }
    }

    fn bounds(&self) -> Bounds3 {
        match self {
            Self::Sphere(center, radius) => cube(*center, *radius),
            Self::Triangle(corners) => corners.iter().fold(Bounds3::EMPTY, |b, corner| b.including(*corner)),
        }
    }

    /// The smallest t in [0, t_max].
    fn hit(&self, ray: &Ray, t_max: f64) -> Option<f64> {
        let in_range = |t: f64| (0.0..=t_max).contains(&t);
        match self {
            Self::Sphere(center, radius) => {
                let to_center = *center - ray.origin;
                let a = ray.direction.length_squared();
                let middle = to_center.dot(ray.direction) / a;
                let across = (to_center - ray.direction * middle).length_squared();
                let half = ((radius * radius - across) / a).sqrt();
                [middle - half, middle + half].into_iter().find(|t| in_range(*t))
            }
            Self::Triangle([a, b, c]) => {
                let (e1, e2, s) = (*b - *a, *c - *a, ray.origin - *a);
                let p = ray.direction.cross(e2);
                let determinant = e1.dot(p);
                let (u, q) = (s.dot(p) / determinant, s.cross(e1));
                let (v, t) = (ray.direction.dot(q) / determinant, e2.dot(q) / determinant);
                (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && in_range(t)).then_some(t)
            }
        }
    }
}

/// A ray of a kind that depends on `i`: random, parallel to axes, from a side of a box, at a box's corner.
fn test_ray(i: usize, random: &mut Random, boxes: &[Bounds3], scale: f64) -> Ray {
    let b = &boxes[random.index(boxes.len())];
    let mut origin = Point3::ORIGIN + random.vector() * (2.0 * scale);
    let mut direction = random.vector().to_array();
    match i % 8 {
        0 => direction[i / 8 % 3] = 0.0,
        1 => direction[i / 8 % 3] = -0.0,
        2 => {
            // Along an axis, with zeros of either sign, straight at a box.
            let axis = i / 8 % 3;
            direction = [0, 1, 2].map(|k| if k == axis { direction[k] } else { 0.0_f64.copysign(direction[k]) });
            origin = b.center() - Vector3::from(direction) * (3.0 * scale);
        }
        // In the plane of a side, parallel to an axis.
        3 => {
            origin = b.corner(i / 8 % 8);
            direction = [0.0, 0.0, 0.0];
            direction[i / 64 % 3] = random.number();
        }
        4 => origin = b.corner(i / 8 % 8),
        5 => direction = (b.corner(i / 8 % 8) - origin).to_array(),
        6 => direction = direction.map(|x| x * halvings(random.index(100))),
        _ => {}
    }
    Ray::new(origin, Vector3::from(direction))
}

/// Compares every query with brute force on many rays.
fn check_rays(primitives: &[Primitive], rays: usize, scale: f64, random: &mut Random) {
    let bounds: Vec<Bounds3> = primitives.iter().map(Primitive::bounds).collect();
    let ways = every_way(&bounds);
    for i in 0..rays {
        let bvh = &ways[i % ways.len()];
        let ray = test_ray(i, random, &bounds, scale);
        let t_max = if i % 3 == 0 { scale * random.number().abs() / ray.direction.length() } else { f64::INFINITY };
        let hits =
            |t_max| primitives.iter().enumerate().filter_map(move |(id, p)| p.hit(&ray, t_max).map(|t| (id as u32, t)));
        let closest = hits(t_max).min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        let found = bvh.closest(&ray, t_max, |id, t_max| primitives[id as usize].hit(&ray, t_max));
        assert_eq!(found, closest, "ray {i} {ray:?}");
        let test = |id: u32| primitives[id as usize].hit(&ray, t_max).is_some();
        assert_eq!(bvh.any(&ray, t_max, test), closest.is_some(), "ray {i} {ray:?}");
        let mut visited = Vec::new();
        bvh.all(&ray, t_max, |id| visited.push(id));
        visited.sort_unstable();
        assert!(visited.is_sorted_by(|a, b| a < b), "visited twice: ray {i} {ray:?}");
        for (id, _) in hits(t_max) {
            assert!(visited.binary_search(&id).is_ok(), "{id} is missed: ray {i} {ray:?}");
        }
    }
}

#[test]
fn agrees_with_brute_force_at_all_scales() {
    for (seed, scale) in [1e-3, 1.0, 1e3, 1e6].into_iter().enumerate() {
        let mut random = Random(seed as u64);
        let primitives: Vec<Primitive> = (0..150).map(|_| Primitive::random(&mut random, scale)).collect();
        check_rays(&primitives, 25_000, scale, &mut random);
    }
}

/// Balls of all sizes, and their boxes.
fn balls(random: &mut Random, count: usize, scale: f64, far: f64) -> (Vec<(Point3, f64)>, Vec<Bounds3>) {
    let offset = random.vector() * (far * scale);
    let ball = |i: usize| {
        let size = if i.is_multiple_of(5) { halvings(i % 40) } else { 0.2 };
        (Point3::ORIGIN + offset + random.vector() * scale, size * scale)
    };
    let balls: Vec<(Point3, f64)> = (0..count).map(ball).collect();
    let bounds = balls.iter().map(|(center, radius)| cube(*center, *radius)).collect();
    (balls, bounds)
}

fn hulls(balls: &[(Point3, f64)]) -> Vec<Hull> {
    balls.iter().map(|&(center, radius)| Hull::Ball { center, radius }).collect()
}

/// A ray at a ball: at its middle, its rim, or past it; from near or far.
fn ray_at(i: usize, (center, radius): (Point3, f64), scale: f64, random: &mut Random) -> Ray {
    let along = random.vector().normalize();
    let (tangent, _) = along.orthonormal_basis();
    let aside = [0.0, 0.999_999, 1.0, 1.000_001, 0.5][i % 5] * radius;
    let far = [0.0, 1.0, 100.0, 1e6, 1e12][i / 5 % 5] * scale;
    Ray::new(center + tangent * aside - along * far, along * [1.0, 1e-100, 1e100][i / 25 % 3])
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn balls_are_not_missed(
        seed in any::<u64>(),
        count in 1..60_usize,
        scale in prop::sample::select(vec![1e-14, 1e-10, 1.0, 1e5, 1e14]),
        far in prop::sample::select(vec![0.0, 100.0]),
    ) {
        let mut random = Random(seed);
        let (balls, bounds) = balls(&mut random, count, scale, far);
        let primitives: Vec<Primitive> = balls.iter().map(|(center, radius)| Primitive::Sphere(*center, *radius)).collect();
        let ways: Vec<WideBvh> = every_way(&bounds).into_iter().map(|bvh| bvh.with_hulls(&hulls(&balls))).collect();
        for i in 0..200 {
            let ray = ray_at(i, balls[random.index(count)], scale, &mut random);
            let t_max = if i % 3 == 0 { scale / ray.direction.length() } else { f64::INFINITY };
            let hits = || (0..).zip(&primitives).filter_map(|(id, p)| Some((id, p.hit(&ray, t_max)?)));
            let closest = hits().min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
            for bvh in &ways {
                let found = bvh.closest(&ray, t_max, |id, t_max| primitives[id as usize].hit(&ray, t_max));
                prop_assert_eq!(found, closest);
                let mut visited = Vec::new();
                bvh.all(&ray, t_max, |id| visited.push(id));
                prop_assert!(hits().all(|(id, _)| visited.contains(&id)));
            }
        }
    }
}

/// The twin: with radii a ten thousandth too small they are; and with right ones few are visited in vain.
#[test]
fn smaller_balls_are_missed() {
    let mut random = Random(21);
    let (balls, bounds) = balls(&mut random, 60, 1.0, 0.0);
    let smaller: Vec<(Point3, f64)> = balls.iter().map(|(center, radius)| (*center, 0.999 * radius)).collect();
    let bvh = WideBvh::build(&bounds).expect("finite boxes");
    let [bad, good] = [smaller, balls.clone()].map(|balls| bvh.clone().with_hulls(&hulls(&balls)));
    let (mut missed, mut hits, mut visited) = (0, 0, 0);
    for i in 0..1000 {
        let ray = ray_at(i % 10, balls[i % 60], 1.0, &mut random);
        let is_met = |id: u32| {
            let (center, radius) = balls[id as usize];
            Primitive::Sphere(center, radius).hit(&ray, f64::INFINITY).is_some()
        };
        let count = |bvh: &WideBvh| {
            let mut count = [0, 0];
            bvh.all(&ray, f64::INFINITY, |id| count[usize::from(is_met(id))] += 1);
            count
        };
        let (bad, good) = (count(&bad), count(&good));
        missed += good[1] - bad[1];
        hits += good[1];
        visited += good[0];
    }
    assert!(missed > 50 && visited < hits, "{missed} {visited} {hits}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn agrees_with_brute_force_on_random_sets(seed in any::<u64>(), count in 1..40_usize, power in -10..20_i32) {
        let mut random = Random(seed);
        let scale = if power < 0 { halvings(-power as usize) } else { 1.0 / halvings(power as usize) };
        let primitives: Vec<Primitive> = (0..count).map(|_| Primitive::random(&mut random, scale)).collect();
        check_rays(&primitives, 200, scale, &mut random);
    }
}

/// The twin: with boxes a thousandth too small the same rays do find a difference to brute force.
#[test]
fn brute_force_catches_boxes_that_are_too_small() {
    let mut random = Random(9);
    let primitives: Vec<Primitive> = (0..150).map(|_| Primitive::random(&mut random, 1.0)).collect();
    let bounds: Vec<Bounds3> = primitives.iter().map(Primitive::bounds).collect();
    let mut bvh = WideBvh::build(&bounds).expect("finite boxes");
    for node in &mut bvh.tree.nodes {
        for lane in 0..WIDTH {
            let b = node.bounds(lane).to_bounds();
            let small = |corner: Point3| b.center().lerp(corner, 0.999);
            if node.has(lane) && node.children[lane] & LEAF != 0 {
                node.set(lane, &Box32::enclosing(&Bounds3::new(small(b.min), small(b.max))));
            }
        }
    }
    let missed = (0..10_000)
        .filter(|i| {
            let ray = test_ray(*i, &mut random, &bounds, 1.0);
            primitives.iter().any(|p| p.hit(&ray, f64::INFINITY).is_some())
                && !bvh.any(&ray, f64::INFINITY, |id| primitives[id as usize].hit(&ray, f64::INFINITY).is_some())
        })
        .count();
    assert!(missed > 10, "{missed}");
}

#[test]
fn a_primitive_that_only_the_margin_reaches_is_visited() {
    // The ray passes a hair, less than the rounding of its far origin, beside the box.
    let bounds = [cube(Point3::ORIGIN, 1.0)];
    let bvh = WideBvh::build(&bounds).expect("finite boxes");
    let ray = Ray::new(Point3::new(-1e6, 1.0 + 1e-10, 0.0), Vector3::X);
    assert!(bvh.any(&ray, f64::INFINITY, |_| true));
    // But not a ray that is clearly outside.
    let ray = Ray::new(Point3::new(-1e6, 1.0 + 1e-5, 0.0), Vector3::X);
    assert!(!bvh.any(&ray, f64::INFINITY, |_| true));
}

#[test]
fn ties_go_to_the_lowest_primitive() {
    // 60 copies of one plane of boxes: every ray along x meets all of them at the same t.
    let bounds: Vec<Bounds3> = (0..60).map(|i| cube(Point3::new(0.0, (i % 3) as f64, 0.0), 1.5)).collect();
    let bvh = WideBvh::build(&bounds).expect("finite boxes");
    for (y, lowest) in [(0.9, 0), (2.25, 1), (3.25, 2)] {
        for (x, direction, t) in [(-5.0, Vector3::X, 3.5), (7.0, -Vector3::X, 5.5)] {
            let ray = Ray::new(Point3::new(x, y, 0.25), direction);
            let test = |id: u32, _| (bounds[id as usize].min.y() < y && y < bounds[id as usize].max.y()).then_some(t);
            for t_max in [t, f64::INFINITY] {
                assert_eq!(bvh.closest(&ray, t_max, test), Some((lowest, t)));
            }
            assert_eq!(bvh.closest(&ray, 0.99 * t, test), None);
        }
    }
}

#[test]
fn lines_reach_behind_their_origin() {
    let bounds: Vec<Bounds3> = (-50..50).map(|i| cube(Point3::new(i as f64 + 0.5, 0.0, 0.0), 0.25)).collect();
    let bvh = WideBvh::build(&bounds).expect("finite boxes");
    let ray = Ray::new(Point3::ORIGIN, Vector3::X);
    let count = |t_min, t_max| {
        let mut count = 0;
        let _ = bvh.visit_between(&ray, t_min, t_max, |_| {
            count += 1;
            ControlFlow::Continue(())
        });
        count
    };
    assert_eq!(count(f64::NEG_INFINITY, f64::INFINITY), 100);
    assert!((50..54).contains(&count(f64::NEG_INFINITY, 0.0)));
    assert!((10..18).contains(&count(-10.0, 0.0)));
    assert!(count(5.0, -5.0) == 0 && count(f64::NAN, 1.0) <= 100 && count(0.0, f64::NAN) == 0);
    let first =
        bvh.closest_between(&ray, -10.0, 10.0, |id, _| Some(f64::from(id) - 49.5 - 0.25).filter(|t| *t >= -10.0));
    assert_eq!(first, Some((40, -9.75)));
}

#[test]
fn strange_rays_end() {
    let mut random = Random(5);
    let bounds: Vec<Bounds3> = (0..100).map(|_| cube(random.point(), 0.1)).collect();
    let bvh = WideBvh::build(&bounds).expect("finite boxes");
    let strange = [0.0, -0.0, 1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 5e-324, f64::MAX];
    for (i, x) in strange.iter().enumerate() {
        for y in strange {
            for t_max in strange {
                let ray = Ray::new(Point3::new(*x, y, 0.0), Vector3::new(y, *x, strange[(i + 3) % 8]));
                bvh.all(&ray, t_max, |_| ());
                bvh.closest(&ray, t_max, |_, t_max| Some(t_max));
                bvh.closest(&ray, t_max, |_, _| Some(f64::NAN));
            }
        }
    }
}

/// A tree over pieces of the same primitives: of each long one there are several.
fn pieces(count: u32) -> (Bvh, Vec<Bounds3>) {
    let boxes: Vec<Bounds3> = (0..count)
        .map(|i| Bounds3::new(Point3::new(0.0, i as f64, 0.0), Point3::new(8.0, i as f64 + 0.5, 1.0)))
        .collect();
    let cut = |b: &Bounds3, piece: f64| {
        Bounds3::new(Point3::new(2.0 * piece, b.min.y(), 0.0), Point3::new(2.0 * piece + 2.0, b.max.y(), 1.0))
    };
    let all: Vec<Bounds3> = boxes.iter().flat_map(|b| [0.0, 1.0, 2.0, 3.0].map(|piece| cut(b, piece))).collect();
    let bvh = Bvh::build(&all).expect("finite boxes").renumbered(|primitive| primitive / 4);
    (bvh, boxes)
}

#[test]
fn primitives_of_several_leaves_are_visited_once() {
    for count in [1, 3, 100] {
        let (bvh, boxes) = pieces(count);
        let wide = WideBvh::from_binary(&bvh);
        assert_eq!(wide.validate(&boxes), Ok(()));
        for y in 0..count {
            for along in [Vector3::X, Vector3::Y, Vector3::new(1.0, 0.1, 0.0)] {
                let ray = Ray::new(Point3::new(0.5, y as f64 + 0.25, 0.5), along);
                let mut visited = Vec::new();
                wide.all(&ray, f64::INFINITY, |primitive| visited.push(primitive));
                assert!(visited.contains(&y));
                visited.sort_unstable();
                assert!(visited.is_sorted_by(|a, b| a < b), "{visited:?}");
            }
        }
        let mut visited = Vec::new();
        wide.point(Point3::new(2.0, 0.25, 0.5), |primitive| visited.push(primitive));
        visited.sort_unstable();
        assert!(visited.contains(&0) && visited.is_sorted_by(|a, b| a < b), "{visited:?}");
    }
    // The twin: without marks they are visited more than once.
    let mut unmarked = WideBvh::from_binary(&pieces(100).0);
    for entry in unmarked.leaves.iter_mut().flatten().filter(|entry| **entry != NONE) {
        *entry &= !SHARED;
    }
    let mut visited = Vec::new();
    unmarked
        .all(&Ray::new(Point3::new(0.5, 0.25, 0.5), Vector3::X), f64::INFINITY, |primitive| visited.push(primitive));
    visited.sort_unstable();
    assert!(!visited.is_sorted_by(|a, b| a < b), "{visited:?}");
}

/// Every defect that the validator knows, planted into a good tree.
#[test]
fn planted_defects_are_caught() {
    let mut random = Random(3);
    let bounds: Vec<Bounds3> = (0..600).map(|_| cube(random.point(), 0.05)).collect();
    let good = WideBvh::build(&bounds).expect("finite boxes");
    let sabotage = |plant: &dyn Fn(&mut WideBvh)| {
        let mut bad = good.clone();
        plant(&mut bad);
        bad.validate(&bounds).expect_err("the defect is caught")
    };
    let (node, lane) = (0..good.tree.nodes.len())
        .flat_map(|node| (0..WIDTH).map(move |lane| (node, lane)))
        .find(|(node, lane)| good.tree.nodes[*node].has(*lane) && good.tree.nodes[*node].children[*lane] & LEAF != 0)
        .expect("a leaf");
    let shrunk = sabotage(&|bvh| {
        let plane = &mut bvh.tree.nodes[node].planes[2][1][lane];
        *plane = plane.next_down().next_down();
    });
    assert!(matches!(shrunk, WideDefect::OutsideLeaf(_)), "{shrunk}");
    let grown = sabotage(&|bvh| bvh.tree.nodes[0].planes[1][1][0] = 2.0);
    assert_eq!(grown, WideDefect::OutsideParent { node: 0, lane: 0 });
    let inner = (0..WIDTH).find(|lane| good.tree.nodes[0].children[*lane] & LEAF == 0).expect("an inner child");
    let second = sabotage(&|bvh| bvh.tree.nodes[0].children[inner] += 1);
    assert!(matches!(second, WideDefect::OutOfOrder(_)), "{second}");
    let beyond = sabotage(&|bvh| bvh.tree.nodes[node].children[lane] = LEAF | 100_000);
    assert_eq!(beyond, WideDefect::OutOfOrder(node));
    let cut = sabotage(&|bvh| bvh.tree.nodes.truncate(bvh.tree.nodes.len() - 1));
    assert!(matches!(cut, WideDefect::OutOfOrder(_)), "{cut}");
    let more = sabotage(&|bvh| bvh.leaves.push([NONE; WIDTH]));
    assert!(matches!(more, WideDefect::Unreachable { .. }), "{more}");
    let gap = sabotage(&|bvh| bvh.tree.nodes[0].set(0, &Box32::EMPTY));
    assert_eq!(gap, WideDefect::Gap(0));
    let leaf = (good.tree.nodes[node].children[lane] & !LEAF) as usize;
    let swapped = sabotage(&|bvh| bvh.leaves[leaf].swap(0, 1));
    assert_eq!(swapped, WideDefect::LeafOrder(leaf));
    let emptied = sabotage(&|bvh| bvh.leaves[leaf] = [NONE; WIDTH]);
    assert_eq!(emptied, WideDefect::LeafOrder(leaf));
    let marked = sabotage(&|bvh| bvh.leaves[leaf][0] |= SHARED);
    assert!(matches!(marked, WideDefect::Mark(_)), "{marked}");
    let unknown = sabotage(&|bvh| bvh.leaves[leaf] = [1000, NONE, NONE, NONE, NONE, NONE, NONE, NONE]);
    assert_eq!(unknown, WideDefect::Unexpected(1000));
    let last = |bvh: &WideBvh| bvh.leaves[leaf].iter().filter(|entry| **entry != NONE).count() - 1;
    let missing = sabotage(&|bvh| {
        let last = last(bvh);
        bvh.leaves[leaf][last] = NONE;
    });
    assert!(matches!(missing, WideDefect::Missing(_)), "{missing}");
    let extent = sabotage(&|bvh| bvh.tree.extent *= 0.5);
    assert_eq!(extent, WideDefect::Extent);
    assert!(good.validate(&bounds[1..]).is_err());
    let mut with_empty = bounds.clone();
    with_empty[7] = Bounds3::EMPTY;
    assert_eq!(good.validate(&with_empty), Err(WideDefect::Unexpected(7)));
}

#[test]
fn a_tree_that_is_too_deep_is_caught() {
    let bounds = cube(Point3::ORIGIN, 1.0);
    let around = Box32::enclosing(&bounds);
    let nodes: Vec<WideNode> = (0..MAX_DEPTH as u32 + 3)
        .map(|place| {
            let mut node = WideNode::EMPTY;
            node.set(0, &around);
            node.children[0] = place + 1;
            node
        })
        .collect();
    let tree = WideTree { nodes, bounds: around, extent: 1.0 };
    assert!(matches!(tree.validate(&[], &[bounds]), Err(WideDefect::TooDeep(_))));
}

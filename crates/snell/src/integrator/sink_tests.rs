//! Which rays are followed, and what becomes of those that are not.

use std::array::from_fn;

use snell_math::lanes::{Bits, LaneColor};
use snell_math::{Point3, Ray, Rgb, Vector3};
use snell_scene::scene::Shadows;

use super::{QUEUES, Rules, ShadedRays, Sink, Spawn};
use crate::interaction::SurfaceRows;
use crate::observe::{CutRay, RayTree};
use crate::statistics::Statistics;
use crate::task::{
    Cut, Differentials, MediumStack, MediumStacks, QuestionQueue, RayKind, RayQueue, RayTask, SampleSums, Term,
};

const RULES: Rules = Rules { depth: 3, min_weight: 0.01, weightless_rays: false, shadows: Shadows::Filtered };

fn task(depth: u16, throughput: f32) -> RayTask {
    RayTask {
        ray: Ray::new(Point3::ORIGIN, Vector3::X),
        throughput: Rgb::gray(throughput),
        sample: 0,
        id: 0,
        parent: 0,
        media: MediumStack::default(),
        depth,
        passes: 0,
        kind: RayKind::Camera,
        band: None,
        split: 0,
    }
}

/// What came of one call: the rays for the next generation, the watcher's notes, the counts and the sample.
fn with(
    rules: Rules,
    parent: &RayTask,
    call: impl FnOnce(&mut Sink<'_, RayTree>, &ShadedRays<'_>),
) -> (Vec<RayTask>, RayTree, Statistics, Rgb) {
    let (mut sums, mut questions) = (SampleSums::default(), QuestionQueue::default());
    sums.reset(1);
    let mut next: [RayQueue; QUEUES] = from_fn(|_| RayQueue::default());
    let mut parents = RayQueue::default();
    parents.push(parent);
    let rows = *parents.rows().next().expect("one ray").0;
    let (mut media, mut statistics, mut next_id) = (MediumStacks::default(), Statistics::default(), 1);
    let (mut tree, mut spawned, mut differentials) = (RayTree::default(), [0], Differentials::default());
    crate::observe::Observer::ray(&mut tree, parent);
    statistics.camera_rays = 1;
    let mut sink = Sink {
        sums: &mut sums,
        questions: &mut questions,
        next: &mut next,
        spawned: &mut spawned,
        media: &mut media,
        statistics: &mut statistics,
        observer: &mut tree,
        rules,
        next_id: &mut next_id,
        differentials: &mut differentials,
    };
    call(&mut sink, &ShadedRays { rows: &rows, at: 0, throughput: &rows.throughput });
    let tasks =
        next.iter().flat_map(|queue| queue.rows().flat_map(|(rows, lanes)| lanes.lanes().map(|l| rows.task(l))));
    (tasks.collect(), tree, statistics, sums.iter().next().expect("one sample"))
}

/// Spawns an upward ray with a weight.
fn spawn(sink: &mut Sink<'_, RayTree>, parents: &ShadedRays<'_>, weight: f32) {
    let weight = LaneColor::<f32>::splat(Rgb::gray(weight));
    let (followed, throughput) = sink.follow::<f64>(parents, RayKind::Reflected, Bits::lane(0), weight);
    if followed.any() {
        let (origin, direction) = (Point3::ORIGIN.into(), Vector3::Y.into());
        let kind = RayKind::Reflected;
        let (media, band, surfaces, eta) = (None, None, &SurfaceRows::default(), 1.0);
        let spawn = Spawn { kind, origin, direction, throughput, media, band, surfaces, eta };
        sink.spawn(parents, followed, &spawn);
    }
}

#[test]
fn rays_are_spawned_one_deeper_with_their_share() {
    let parent = task(2, 0.5);
    let (next, tree, statistics, _) = with(RULES, &parent, |sink, parents| spawn(sink, parents, 0.25));
    assert_eq!((next.len(), next[0].depth, next[0].throughput), (1, 3, Rgb::gray(0.125)));
    assert_eq!((next[0].id, next[0].parent, tree.rays.len()), (1, 0, 2));
    assert_eq!((statistics.reflected_rays, statistics.max_depth, statistics.cut_weight()), (1, 3, 0.0));
}

#[test]
fn rays_too_deep_or_too_light_are_cut_and_their_weight_is_known() {
    for (depth, weight, why) in [(3, 0.5, Cut::Depth), (1, 0.009, Cut::Weight), (3, 0.009, Cut::Depth)] {
        let parent = task(depth, 1.0);
        let (next, tree, statistics, _) = with(RULES, &parent, |sink, parents| spawn(sink, parents, weight));
        assert!(next.is_empty() && statistics.reflected_rays == 0);
        assert_eq!(tree.rays[0].cuts, [CutRay { kind: RayKind::Reflected, why, weight: Rgb::gray(weight) }]);
        assert!((statistics.cut_weight() - f64::from(weight)).abs() < 1e-9);
    }
    let all = Rules { min_weight: 0.0, ..RULES };
    let (next, ..) = with(all, &task(1, 1.0), |sink, parents| spawn(sink, parents, 1e-30));
    assert_eq!(next.len(), 1, "none is too light");
}

#[test]
fn rays_of_no_weight_are_spawned_by_rule_only() {
    let parent = task(1, 1.0);
    for (rule, count) in [(false, 0), (true, 1)] {
        let rules = Rules { weightless_rays: rule, min_weight: 0.0, ..RULES };
        let (next, tree, statistics, _) = with(rules, &parent, |sink, parents| spawn(sink, parents, 0.0));
        assert_eq!((next.len(), statistics.reflected_rays), (count, count as u64));
        assert!(tree.rays[0].cuts.is_empty());
    }
}

#[test]
fn a_ray_that_passes_stays_what_it_was_but_not_for_ever() {
    let mut ray = RayTask { kind: RayKind::Refracted, ..task(3, 0.001) };
    let beyond = Ray::new(Point3::new(1.0, 0.0, 0.0), Vector3::X);
    let mut passes = 0;
    loop {
        let (next, tree, statistics, _) = with(RULES, &ray, |sink, _| sink.pass(&ray, beyond, MediumStack::default()));
        assert_eq!((statistics.refracted_rays, statistics.reflected_rays), (0, 0), "it is no new ray");
        let Some(&again) = next.first() else {
            let cut = CutRay { kind: ray.kind, why: Cut::Depth, weight: ray.throughput };
            assert_eq!(tree.rays[0].cuts, [cut]);
            break;
        };
        assert_eq!((again.depth, again.throughput, again.kind), (ray.depth, ray.throughput, ray.kind));
        passes += 1;
        ray = RayTask { id: 0, parent: 0, ..again };
    }
    assert!((1000..100_000).contains(&passes), "{passes}");
}

#[test]
fn terms_carry_the_throughput_to_the_sample() {
    let parent = task(1, 0.5);
    let (_, tree, _, sum) = with(RULES, &parent, |sink, parents| {
        let (half, red) = (Rgb::gray(0.5), Rgb::new(1.0, 0.0, 0.0));
        sink.add::<f64>(parents, Bits::lane(0), Term::Emission, LaneColor::splat(half));
        sink.add::<f64>(parents, Bits::lane(0), Term::Ambient, LaneColor::splat(red));
    });
    assert_eq!(sum, Rgb::new(0.75, 0.25, 0.25));
    assert_eq!((tree.sum(), tree.shares.len()), (sum, 2));
    assert_eq!(tree.shares_of(0).count(), 2);
    assert_eq!(tree.shares_of(1).count(), 0);
}

#[test]
fn rays_of_one_sample_do_not_multiply_without_end() {
    let parent = task(1, 1.0);
    let (next, _, statistics, _) = with(RULES, &parent, |sink, parents| {
        for _ in 0..5000 {
            spawn(sink, parents, 1.0);
        }
    });
    assert_eq!((next.len(), statistics.reflected_rays), (2048, 2048));
    assert_eq!(statistics.cut_weight(), 2952.0, "and what is cut is counted");
}

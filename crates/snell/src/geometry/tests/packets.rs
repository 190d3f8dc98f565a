//! Rays side by side meet what each meets alone, to the last bit, by all instructions: neighbours that go through hierarchies
//! together, strangers that do not, and those that are no rays at all.

use snell_math::lanes::{Bits, InstructionSet, Lanes, WIDTH, Work, dispatch};
use snell_math::{Point3, Ray, Transform, Vector3};
use snell_scene::scene::{Object, ObjectKind, Prototype, Scene, Shape};
use snell_testkit::{TestRng, must_fail};

use super::{jumble, materials};
use crate::compile::CompiledScene;
use crate::geometry::lanes::{Blockers, HitRows};
use crate::geometry::space::Primitive;
use crate::geometry::{Geometry, Hit, QueryScratch};
use crate::task::{QuestionQueue, RayQueue, set_column};

/// What rays side by side are told.
struct Ask<'a> {
    geometry: &'a Geometry,
    rays: &'a [Ray; WIDTH],
    distance: &'a [f64; WIDTH],
    active: Bits,
    any_blocks: bool,
}

/// For each ray its hit, whether it is blocked, and what it meets if it is not.
type Answers = Vec<(Option<Hit>, bool, Vec<Hit>)>;

impl Work for Ask<'_> {
    type Output = Answers;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Answers {
        let Self { geometry, rays, distance, active, any_blocks } = self;
        let (mut queue, mut questions) = (RayQueue::default(), QuestionQueue::default());
        queue.fill(WIDTH);
        questions.fill(WIDTH);
        let (rows, asked) = (&mut queue.rows_mut()[0], &mut questions.rows_mut()[0]);
        for (lane, ray) in rays.iter().enumerate() {
            for (origin, direction) in
                [(&mut rows.origin, &mut rows.direction), (&mut asked.origin, &mut asked.direction)]
            {
                set_column(origin, lane, ray.origin.to_array());
                set_column(direction, lane, ray.direction.to_array());
            }
        }
        asked.distance = *distance;
        let (mut hits, mut scratch) = (HitRows::NOTHING, QueryScratch::default());
        let mut answers = Vec::new();
        for at in (0..WIDTH).step_by(L::COUNT) {
            let lanes = Bits(active.0 >> at) & L::all();
            geometry.intersect_lanes::<L>(rows, at, lanes, &mut hits, &mut scratch);
            let mut blockers = Blockers::default();
            geometry.block_lanes::<L>(asked, at, lanes, any_blocks, &mut blockers, &mut scratch);
            for lane in lanes.lanes() {
                let blocked = blockers.blocked.has(lane);
                let of_lane = blockers.hits.iter().filter(|(of, _)| usize::from(*of) == lane && !blocked);
                answers.push((hits.hit(at + lane), blocked, sorted(of_lane.map(|(_, hit)| *hit))));
            }
        }
        answers
    }
}

fn sorted(hits: impl Iterator<Item = Hit>) -> Vec<Hit> {
    let mut hits: Vec<Hit> = hits.collect();
    hits.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.order().cmp(&b.order())).then(a.place.part.cmp(&b.place.part)));
    hits
}

/// What each ray is told alone.
fn alone(ask: &Ask<'_>) -> Answers {
    let mut scratch = QueryScratch::default();
    let mut answer = |lane: usize| {
        let (ray, distance) = (&ask.rays[lane], ask.distance[lane]);
        let hit = ask.geometry.intersect(ray, f64::INFINITY, &mut scratch);
        let mut hits = Vec::new();
        let blocked = if ask.any_blocks {
            ask.geometry.is_blocked(ray, distance, &mut scratch)
        } else {
            ask.geometry.gather_blockers(ray, distance, &mut hits, &mut scratch)
        };
        (hit, blocked, if blocked { Vec::new() } else { sorted(hits.into_iter()) })
    };
    ask.active.lanes().map(&mut answer).collect()
}

/// What is to be compared of answers: where on a simple primitive a hit is says nothing.
fn known(geometry: &Geometry, answers: &Answers) -> Vec<String> {
    let describe = |hit: &Hit| {
        let is_simple =
            matches!(geometry.world.primitives[hit.primitive as usize], Primitive::Sphere(_) | Primitive::Plane(_));
        format!("{:x} {:?} {:?}", hit.t.to_bits(), hit.order(), (!is_simple).then_some(hit.place))
    };
    let describe = |(first, blocked, all): &(Option<Hit>, bool, Vec<Hit>)| {
        let all: Vec<String> = all.iter().map(describe).collect();
        format!("{:?} {blocked} {all:?}", first.as_ref().map(describe))
    };
    answers.iter().map(describe).collect()
}

/// Eight rays: neighbours, or strangers, or nearly so.
fn eight(rng: &mut TestRng, scale: f64) -> [Ray; WIDTH] {
    let far = *rng.pick(&[1.0, 1.0, 1.0, 1e9]);
    let (from, to) = (rng.vector(4.0 * scale * far), rng.vector(2.5 * scale));
    let spread = *rng.pick(&[0.0, 1e-3, 0.1, 1.0]) * scale;
    let is_axial = rng.below(4) == 0;
    let direction = *rng.pick(&[Vector3::X, -Vector3::Y, Vector3::Z]);
    std::array::from_fn(|lane| {
        let at = Point3::ORIGIN + to + rng.vector(spread);
        if is_axial {
            return Ray::new(at - direction * (5.0 * scale), direction);
        }
        // Shadow rays share their end, camera rays their beginning.
        let from = Point3::ORIGIN + from + if lane % 2 == 0 { Vector3::ZERO } else { rng.vector(spread) };
        let direction = at - from;
        let strange = rng.below(60) == 0;
        Ray::new(from, if strange { direction * f64::NAN } else { direction.normalize() })
    })
}

/// Asks in all ways; how many hits there were.
fn check(geometry: &Geometry, rng: &mut TestRng, scale: f64, rounds: usize) -> usize {
    let mut met = 0;
    for round in 0..rounds {
        let (rays, active) = (eight(rng, scale), Bits(if round % 3 == 0 { rng.below(256) as u8 } else { u8::MAX }));
        let distance = std::array::from_fn(|_| *rng.pick(&[3.0 * scale, 6.0 * scale, f64::INFINITY]));
        let ask = || Ask { geometry, rays: &rays, distance: &distance, active, any_blocks: round % 2 == 0 };
        let expected = alone(&ask());
        for set in InstructionSet::available() {
            assert_eq!(known(geometry, &dispatch(set, ask())), known(geometry, &expected), "{set:?} {rays:?}");
        }
        met += expected.iter().filter(|answer| answer.0.is_some()).count();
    }
    met
}

/// Very many balls, some of them of glass and some the same, in the world or in prototypes.
fn balls(rng: &mut TestRng, count: usize, scale: f64, nested: bool) -> Scene {
    let mut scene = Scene::default();
    let materials = materials(&mut scene);
    let mut objects = Vec::new();
    for _ in 0..count {
        let center = Point3::ORIGIN + rng.vector(2.0 * scale);
        let ball = Object::shape(Shape::Sphere { center, radius: rng.range(0.02, 0.4) * scale });
        let ball = Object { material: Some(*rng.pick(&materials)), ..ball };
        if rng.below(9) == 0 {
            objects.push(ball.clone());
        }
        objects.push(ball);
    }
    if nested {
        let prototype = scene.prototypes.push(Prototype { name: "balls".to_owned(), objects });
        for _ in 0..30 {
            scene.objects.push(Object {
                kind: ObjectKind::Instance(prototype),
                parent_from_object: Transform::translate(rng.vector(scale))
                    * Transform::scale(Vector3::new(0.5, 0.4, 0.3)),
                ..Object::shape(Shape::Sphere { center: Point3::ORIGIN, radius: 1.0 })
            });
        }
    } else {
        scene.objects = objects;
    }
    scene
}

fn build(scene: &Scene) -> Geometry {
    CompiledScene::build(scene).expect("it compiles").geometry
}

#[test]
fn rays_side_by_side_meet_what_each_meets_alone() {
    let mut rng = TestRng::new(23);
    for count in [1, 3, 5, 30, 120] {
        let met = check(&build(&jumble(&mut rng, count)), &mut rng, 1.0, 60);
        assert!(met >= count.min(20), "{met}");
    }
    // The smallest and the largest have no room in `f32`.
    for scale in [1e-13, 1e-3, 1.0, 1e6, 1e13] {
        for nested in [false, true] {
            let met = check(&build(&balls(&mut rng, 300, scale, nested)), &mut rng, scale, 60);
            assert!(met > 30, "{met} {scale} {nested}");
        }
    }
}

#[test]
fn one_wrong_lane_is_seen() {
    let mut rng = TestRng::new(5);
    let geometry = build(&balls(&mut rng, 300, 1.0, false));
    let (rays, distance, active) = (eight(&mut rng, 1.0), [f64::INFINITY; WIDTH], Bits(u8::MAX));
    let ask = |rays| Ask { geometry: &geometry, rays, distance: &distance, active, any_blocks: false };
    let mut nudged = rays;
    nudged[5].origin = nudged[5].origin + nudged[5].direction * 1e-13;
    must_fail("one ray begins a little later", || {
        assert_eq!(
            known(&geometry, &dispatch(InstructionSet::best(), ask(&nudged))),
            known(&geometry, &alone(&ask(&rays)))
        );
    });
}

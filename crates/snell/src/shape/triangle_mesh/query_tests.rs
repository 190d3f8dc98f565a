//! Queries of nasty meshes by nasty rays, by every instruction set, against a test of every triangle in `f64`; and twins whose
//! filter is not conservative.

use std::ops::ControlFlow;

use proptest::prelude::*;
use snell_math::lanes::{Eight, Floats, InstructionSet, Lanes, WIDTH, Work, dispatch};

use super::blocks::BlockRay;
use super::watertight::{Meeting, RaySpace};
use super::*;
use crate::accel::random::Random;
use crate::accel::wide::{Approach, Probe, number};

/// Kinds of meshes that filters have fallen over.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    /// Of all sizes, some twice, some without area.
    Soup,
    /// Long and thin in all directions.
    Needles,
    /// A fan of triangles that share edges and a vertex.
    Fan,
    /// A grid in a plane, on whole numbers.
    Grid,
    /// The same triangle many times.
    Copies,
    /// Huge ones around tiny ones.
    Scales,
}

pub(super) const KINDS: [Kind; 6] = [Kind::Soup, Kind::Needles, Kind::Fan, Kind::Grid, Kind::Copies, Kind::Scales];

pub(super) fn mesh_of(kind: Kind, count: usize, scale: f64, offset: Vector3, random: &mut Random) -> TriangleMesh {
    let mut positions: Vec<Vector3> = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..count {
        let first = positions.len() as u32;
        let corners = match kind {
            Kind::Soup => {
                let (center, size) = (random.vector(), random.number() * random.number());
                [0, 1, 2].map(|_| center + random.vector() * size)
            }
            Kind::Needles => {
                let (a, b) = (random.vector(), random.vector());
                [a, b, b + random.vector() * 1e-5]
            }
            Kind::Fan => {
                let rim = |i: usize| {
                    let angle = i as f64 * 0.3;
                    Vector3::new(
                        snell_math::portable::cos(angle),
                        snell_math::portable::sin(angle),
                        0.1 * (i % 3) as f64,
                    )
                };
                [Vector3::ZERO, rim(i), rim(i + 1)]
            }
            Kind::Grid => {
                let (x, y) = ((i / 2 % 8) as f64, (i / 16) as f64);
                let corner = |dx: f64, dy: f64| Vector3::new(x + dx, y + dy, 0.0);
                if i % 2 == 0 {
                    [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0)]
                } else {
                    [corner(0.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)]
                }
            }
            Kind::Copies => [Vector3::X, Vector3::Y, Vector3::Z],
            Kind::Scales => {
                let size = (0..i % 24).fold(1.0, |size, _| 0.5 * size);
                [0, 1, 2].map(|_| random.vector() * size)
            }
        };
        positions.extend(corners);
        triangles.push(if i % 11 == 10 { [first, first, first + 2] } else { [first, first + 1, first + 2] });
    }
    let positions = positions.iter().map(|p| (*p * scale + offset).to_array().map(|x| x as f32)).collect();
    TriangleMesh::new(&Mesh { positions, triangles, ..Mesh::default() }).expect("a good mesh")
}

/// A ray of a kind that depends on `i`: at vertices, edges and faces, along edges, parallel to axes, from afar and from within.
pub(super) fn ray_of(i: usize, mesh: &TriangleMesh, scale: f64, random: &mut Random) -> Ray {
    let [a, b, c] = mesh.triangle(random.index(mesh.triangles.len()) as u32);
    let target = match i % 4 {
        0 => a,
        1 => a.lerp(b, 0.5 + 0.5 * random.number()),
        _ => a.lerp(b, 0.3).lerp(c, 0.4),
    };
    let far = [1.5, 1.0, 100.0, 1e6, 1e12][i / 4 % 5] * scale;
    match i % 9 {
        // Along an edge.
        0 => Ray::new(a - (b - a) * 2.0, b - a),
        // From a corner.
        1 => Ray::new(a, random.vector()),
        // Parallel to an axis, through the target.
        2 => {
            let axis = [Vector3::X, Vector3::Y, -Vector3::Z][i / 9 % 3];
            Ray::new(target - axis * far, axis)
        }
        // In a plane parallel to two axes.
        3 => {
            let along = Vector3::new(random.number(), 0.0, -random.number());
            Ray::new(target - along * far, along)
        }
        // With components of very different sizes.
        4 => {
            let along = Vector3::new(random.number(), 1e-20 * random.number(), 1e-300 * random.number());
            Ray::new(target - along * far, along)
        }
        // With a direction that is very long or short.
        5 => {
            let size = [1e-250, 1e250, 1e-30, 1e30][i / 9 % 4];
            let along = random.vector();
            Ray::new(target - along * far, along * size)
        }
        6 => Ray::new(Point3::ORIGIN + random.vector() * scale, random.vector()),
        _ => {
            let along = random.vector();
            Ray::new(target - along * far, along)
        }
    }
}

/// Asks every query of every ray, by every instruction set.
fn check(mesh: &TriangleMesh, rays: usize, scale: f64, random: &mut Random) {
    let ways: Vec<TriangleMesh> =
        InstructionSet::available().into_iter().map(|set| mesh.clone().with_instructions(set)).collect();
    for i in 0..rays {
        let ray = ray_of(i, mesh, scale, random);
        let Some(space) = RaySpace::new(&ray) else { continue };
        let meetings: Vec<(u32, Meeting)> = (0..mesh.triangles.len() as u32)
            .filter_map(|id| Some((id, space.meet::<f64>(mesh.corners(id))?)))
            .collect();
        let some_t = meetings.get(i % meetings.len().max(1)).map_or(1.0, |(_, meeting)| meeting.t);
        // Ranges that end or begin exactly at a hit among them.
        let (t_min, t_max) = [
            (0.0, f64::INFINITY),
            (f64::NEG_INFINITY, f64::INFINITY),
            (0.0, some_t),
            (some_t, f64::INFINITY),
            (f64::NEG_INFINITY, some_t.next_down()),
            (0.5 * some_t, 1.5 * some_t),
        ][i % 6];
        let hits = || meetings.iter().filter(|(_, meeting)| t_min < meeting.t && meeting.t <= t_max);
        let closest = hits()
            .min_by(|a, b| a.1.t.total_cmp(&b.1.t).then(a.0.cmp(&b.0)))
            .map(|(id, meeting)| MeshHit::new(*id, *meeting));
        let all: Vec<u32> = hits().map(|(id, _)| *id).collect();
        for mesh in &ways {
            let what = || format!("ray {i} {ray:?} from {t_min} to {t_max} by {:?}", mesh.set);
            assert_eq!(mesh.intersect(&ray, t_min, t_max), closest, "{}", what());
            assert_eq!(mesh.any(&ray, t_min, t_max), closest.is_some(), "{}", what());
            let mut found = Vec::new();
            let _ = mesh.for_each_hit(&ray, t_min, t_max, |hit| {
                found.push(hit.triangle);
                ControlFlow::Continue(())
            });
            found.sort_unstable();
            assert_eq!(found, all, "{}", what());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 120, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn agrees_with_a_test_of_every_triangle(
        seed in any::<u64>(),
        kind in prop::sample::select(KINDS.to_vec()),
        count in 1..90_usize,
        scale in prop::sample::select(vec![1e-15, 1e-9, 1e-3, 1.0, 1e6, 1e11, 1e15]),
        offset in prop::sample::select(vec![0.0, 1.0, 1000.0]),
    ) {
        let mut random = Random(seed);
        let mesh = mesh_of(kind, count, scale, random.vector() * (offset * scale), &mut random);
        check(&mesh, 150, scale * offset.max(1.0), &mut random);
    }
}

/// What the filter says of all triangles of a block, for one ray.
struct Look<'a>(&'a TriangleMesh, &'a Probe, &'a RaySpace);

impl Work for Look<'_> {
    type Output = Vec<(u32, bool, f32, f32)>;
    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        let ray = BlockRay::<L::Eight>::new(self.1, self.2);
        let mut found = Vec::new();
        for block in &self.0.blocks {
            let Some(verdict) = ray.look(block, L::Eight::splat(f32::INFINITY)) else { continue };
            let (low, high) = (verdict.low.to_array(), verdict.high.to_array());
            for lane in (0..WIDTH).filter(|lane| (verdict.sure | verdict.unsure) >> lane & 1 == 1) {
                found.push((number(block.triangles[lane]), verdict.sure >> lane & 1 == 1, low[lane], high[lane]));
            }
        }
        found
    }
}

#[test]
fn the_filter_says_nothing_that_is_not_so_and_much() {
    let mut random = Random(11);
    let mut sure = 0;
    for kind in KINDS {
        for offset in [0.0, 30.0] {
            let mesh = mesh_of(kind, 80, 1.0, random.vector() * offset, &mut random);
            for i in 0..1000 {
                let ray = ray_of(i, &mesh, 1.0 + offset, &mut random);
                let Some(space) = RaySpace::new(&ray) else { continue };
                let Approach::Plain(probe) = mesh.tree.approach(&ray, 0.0, f64::INFINITY) else { continue };
                for set in InstructionSet::available() {
                    let said = dispatch(set, Look(&mesh, &probe, &space));
                    for id in 0..mesh.triangles.len() as u32 {
                        let truth = space.meet::<f64>(mesh.corners(id));
                        let said = said.iter().find(|said| said.0 == id);
                        match (truth, said) {
                            (Some(meeting), Some((_, true, low, high))) => {
                                let s = (meeting.t - probe.measure.start) * probe.measure.scale;
                                assert!(f64::from(*low) <= s && s <= f64::from(*high), "{low} {s} {high} {ray:?}");
                                sure += 1;
                            }
                            (Some(meeting), None) => {
                                assert!(meeting.t <= probe.measure.start, "{id} is missed by {ray:?}")
                            }
                            (None, Some((_, true, ..))) => panic!("{id} is not met by {ray:?}"),
                            _ => {}
                        }
                    }
                }
            }
        }
    }
    assert!(sure > 100_000, "{sure}");
}

/// The twin: with errors thought to be a thousand times smaller the filter says what is not so.
#[test]
fn a_filter_without_tolerance_is_caught() {
    let mut random = Random(12);
    let mut wrong = 0;
    for kind in KINDS {
        let mesh = mesh_of(kind, 80, 1.0, random.vector() * 30.0, &mut random);
        for i in 0..500 {
            let ray = ray_of(i, &mesh, 30.0, &mut random);
            let Some(space) = RaySpace::new(&ray) else { continue };
            let Approach::Plain(probe) = mesh.tree.approach(&ray, 0.0, f64::INFINITY) else { continue };
            let mut blind = probe;
            (blind.extent, blind.error) = (1e-3 * probe.extent, 1e-3 * probe.error);
            let said = dispatch(InstructionSet::Portable, Look(&mesh, &blind, &space));
            wrong += (0..mesh.triangles.len() as u32)
                .filter(|id| {
                    let said = said.iter().find(|said| said.0 == *id);
                    match space.meet::<f64>(mesh.corners(*id)) {
                        None => said.is_some_and(|said| said.1),
                        Some(meeting) => said.is_none() && meeting.t > probe.measure.start,
                    }
                })
                .count();
        }
    }
    assert!(wrong > 20, "{wrong}");
}

#[test]
fn triangles_of_several_leaves_are_met_once() {
    let mut random = Random(13);
    let mesh = mesh_of(Kind::Needles, 60, 1.0, Vector3::ZERO, &mut random);
    // Every triangle is there twice, by two boxes that it lies in both.
    let boxes: Vec<Bounds3> =
        (0..120).map(|i| mesh.triangle(i / 2).iter().fold(Bounds3::EMPTY, |b, corner| b.including(*corner))).collect();
    let bvh = Bvh::build(&boxes).expect("finite boxes").renumbered(|primitive| primitive / 2);
    let (tree, leaves) = WideTree::new(&bvh);
    let corners_of = |triangle| mesh.corners(triangle);
    let blocks = leaves.iter().map(|leaf| TriangleBlock::new(*leaf, corners_of)).collect();
    let twice = TriangleMesh { tree, blocks, ..mesh };
    check(&twice, 2000, 1.0, &mut random);
}

/// Rays in flight and side by side find what rays by themselves do, by every instruction set: more rays than are in flight, some of which miss
/// everything, are broken, or are odd.
#[test]
fn many_rays_find_the_same() {
    let mut random = Random(11);
    for kind in KINDS {
        for (count, scale) in [(3, 1.0), (200, 1.0), (200, 1e6), (40, 1e-20)] {
            let mesh = mesh_of(kind, count, scale, Vector3::ZERO, &mut random);
            let mut rays: Vec<Ray> =
                (0..100).map(|_| Ray::new(Point3::ORIGIN + random.vector() * (2.0 * scale), random.vector())).collect();
            rays[7].direction = Vector3::ZERO;
            rays[8].origin = Point3::new(f64::NAN, 0.0, 0.0);
            rays[9].direction = Vector3::new(0.0, -0.0, 1e-310);
            let t_max: Vec<f64> =
                (0..rays.len()).map(|i| if i % 3 == 0 { scale * random.number() } else { f64::INFINITY }).collect();
            for t_min in [0.0, -0.5 * scale, f64::NEG_INFINITY] {
                let expected: Vec<Option<MeshHit>> =
                    rays.iter().zip(&t_max).map(|(ray, t_max)| mesh.intersect(ray, t_min, *t_max)).collect();
                for set in InstructionSet::available() {
                    let mesh = mesh.clone().with_instructions(set);
                    let mut hits = vec![Some(MeshHit { t: 1.0, triangle: 0, barycentric: [0.0; 3], front: true }); 100];
                    many::in_flight(&mesh, &rays, t_min, &t_max, &mut hits);
                    assert_eq!(hits, expected, "{kind:?} {set:?}");
                    hits.fill(None);
                    mesh.intersect_many(&rays, t_min, &t_max, &mut hits);
                    assert_eq!(hits, expected, "{kind:?} {set:?}");
                    if t_min == 0.0 {
                        hits.fill(None);
                        many::side_by_side(&mesh, &rays, &t_max, &mut hits);
                        assert_eq!(hits, expected, "{kind:?} {set:?}");
                    }
                }
            }
        }
    }
}

/// The twin: rays that are given to the wrong places are told from those that are not.
#[test]
fn hits_in_other_places_are_told() {
    let mut random = Random(12);
    let mesh = mesh_of(Kind::Soup, 200, 1.0, Vector3::ZERO, &mut random);
    let rays: Vec<Ray> = (0..64).map(|_| Ray::new(random.point(), random.vector())).collect();
    let t_max = [f64::INFINITY; 64];
    let (mut hits, mut turned) = ([None; 64], [None; 64]);
    many::in_flight(&mesh, &rays, 0.0, &t_max, &mut hits);
    let rays_turned: Vec<Ray> = rays.iter().cycle().skip(1).take(64).copied().collect();
    many::in_flight(&mesh, &rays_turned, 0.0, &t_max, &mut turned);
    assert_ne!(hits, turned);
    turned.rotate_right(1);
    assert_eq!(hits, turned);
}

#[test]
fn hits_do_not_depend_on_the_hierarchys_quality() {
    // Long thin triangles that lie across each other, of which reinsertion moves many.
    let mut random = Random(41);
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for _ in 0..3000 {
        let (from, along) = (random.vector(), random.vector());
        let first = positions.len() as u32;
        positions.extend([from, from + along, from + along * 0.5 + random.vector() * 0.01]);
        triangles.push([first, first + 1, first + 2]);
    }
    let positions = positions.iter().map(|p: &Vector3| p.to_array().map(|x| x as f32)).collect();
    let mesh = Mesh { positions, triangles, ..Mesh::default() };
    let [medium, high] = [BuildQuality::Medium, BuildQuality::High]
        .map(|quality| TriangleMesh::with_quality(&mesh, quality).expect("a good mesh"));
    assert!(medium.tree != high.tree, "the twin: another tree");
    let mut met = 0;
    for _ in 0..3000 {
        let ray = Ray::new(random.point(), random.vector());
        let hit = medium.intersect(&ray, 0.0, f64::INFINITY);
        met += usize::from(hit.is_some());
        assert_eq!(high.intersect(&ray, 0.0, f64::INFINITY), hit);
        assert_eq!(high.any(&ray, 0.0, 1.0), medium.any(&ray, 0.0, 1.0));
    }
    assert!(met > 1000, "only {met} hits");
}

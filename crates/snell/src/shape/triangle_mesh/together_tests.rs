//! Rays side by side find what rays by themselves do, to the bit: nasty rays and nasty meshes, by every instruction set with lanes.

use std::ops::ControlFlow;

use snell_math::Transform;
use snell_math::lanes::{Bits, InstructionSet, Lanes, WIDTH, Work, dispatch};

use super::query_tests::{KINDS, Kind, mesh_of, ray_of};
use super::*;
use crate::accel::random::Random;
use crate::accel::wide::Group;
use crate::shape::{LaneSurfacePoint, RayRow};

type Rows = [[f64; WIDTH]; 3];

/// What there is to know of eight rays, each from its origin up to a parameter of its own.
#[derive(Clone, Debug, PartialEq)]
struct Answers {
    closest: [Option<MeshHit>; WIDTH],
    any: [bool; WIDTH],
    /// All hits, in the order of their triangles.
    all: [Vec<(u32, u64)>; WIDTH],
    /// Of the closest hit: the point, its error and both normals.
    surfaces: [Option<[u64; 10]>; WIDTH],
}

fn bits_of(surface: &SurfacePoint) -> [u64; 10] {
    let [a, b, c] = [surface.point.to_array(), surface.geometric_normal.to_array(), surface.shading_normal.to_array()];
    [a[0], a[1], a[2], surface.error, b[0], b[1], b[2], c[0], c[1], c[2]].map(f64::to_bits)
}

fn one_by_one(mesh: &TriangleMesh, rays: &[Ray; WIDTH], t_max: &[f64; WIDTH], place: &Transform) -> Answers {
    let closest = std::array::from_fn(|i| mesh.intersect(&rays[i], 0.0, t_max[i]));
    Answers {
        closest,
        any: std::array::from_fn(|i| mesh.any(&rays[i], 0.0, t_max[i])),
        all: std::array::from_fn(|i| {
            let mut all = Vec::new();
            let _ = mesh.for_each_hit(&rays[i], 0.0, t_max[i], |hit| {
                all.push((hit.triangle, hit.t.to_bits()));
                ControlFlow::Continue(())
            });
            all.sort_unstable();
            all
        }),
        surfaces: std::array::from_fn(|i| {
            let hit = closest[i]?;
            let hit = mesh.hit(&rays[i], hit.triangle, hit.t);
            Some(bits_of(&mesh.surface(&rays[i], &hit).carried(place)))
        }),
    }
}

struct Together<'a> {
    mesh: &'a TriangleMesh,
    /// A tree that the mesh's is inside of, for which the rays are made ready.
    around: Option<&'a WideTree>,
    rays: &'a [Ray; WIDTH],
    t_max: &'a [f64; WIDTH],
    place: &'a Transform,
}

impl Work for Together<'_> {
    /// And the lanes whose surfaces were had side by side.
    type Output = (Answers, Bits);
    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        let Self { mesh, around, rays, t_max, place } = self;
        let (mut origin, mut direction): (Rows, Rows) = Default::default();
        for (lane, ray) in rays.iter().enumerate() {
            for axis in 0..3 {
                (origin[axis][lane], direction[axis][lane]) = (ray.origin[axis], ray.direction[axis]);
            }
        }
        let row = RayRow { origin: &origin, direction: &direction };
        let (mut every, mut strange) = (Bits::first(WIDTH), Bits::NONE);
        let group;
        let sight = match around {
            None => None,
            Some(tree) => {
                let (ray, end) = (row.lanes::<L>(0), L::load(t_max, 0));
                let probes = tree.approach_together(ray.origin, ray.direction, every, end);
                (every, strange) = (probes.plain, probes.strange);
                group = Group::new(&probes, end);
                Some(Sight::new(row, &probes, &group))
            }
        };
        let sight = sight.as_ref();
        let mut closest = [None; WIDTH];
        mesh.intersect_together::<L>(row, sight, every, t_max, &mut closest);
        let mut in_flight = [None; WIDTH];
        mesh.closest_together::<L>(row, sight, every, t_max, &mut in_flight, true);
        assert_eq!(in_flight, closest);
        let mut any = mesh.any_together::<L>(row, sight, every, t_max);
        let mut all: [Vec<(u32, u64)>; WIDTH] = Default::default();
        let broken = mesh.each_together::<L>(row, sight, every, t_max, |lane, hit| {
            all[lane].push((hit.triangle, hit.t.to_bits()));
            ControlFlow::Continue(())
        });
        assert_eq!(broken, Bits::NONE);
        all.iter_mut().for_each(|all| all.sort_unstable());
        // Those that end at their second hit are those that have two.
        let mut count = [0; WIDTH];
        let broken = mesh.each_together::<L>(row, sight, every, t_max, |lane, _| {
            count[lane] += 1;
            if count[lane] == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert!(
            (0..WIDTH).all(|lane| broken.has(lane) == (all[lane].len() >= 2) && count[lane] == all[lane].len().min(2))
        );

        // Those that have to be asked for one by one are so by whoever made them ready.
        for lane in strange.lanes() {
            let alone = one_by_one(mesh, rays, t_max, place);
            (closest[lane], all[lane]) = (alone.closest[lane], alone.all[lane].clone());
            any |= Bits::lane(lane) & Bits::all_if(alone.any[lane]);
        }
        let met =
            (0..WIDTH).fold(Bits::NONE, |met, lane| met | Bits::lane(lane) & Bits::all_if(closest[lane].is_some()));
        let triangles = closest.map(|hit| hit.map_or(0, |hit| hit.triangle));
        let (surface, done) = mesh.surfaces(&row.lanes::<L>(0), &triangles, met);
        assert_eq!(done.without(met), Bits::NONE);
        let LaneSurfacePoint { point, error, geometric_normal, shading_normal } = surface.carried(place);
        let (mut rows, mut errors): ([Rows; 3], [f64; WIDTH]) = Default::default();
        point.store(&mut rows[0], 0);
        geometric_normal.store(&mut rows[1], 0);
        shading_normal.store(&mut rows[2], 0);
        error.store(&mut errors, 0);
        let surfaces = std::array::from_fn(|lane| {
            let [a, b, c] = rows.map(|rows| rows.map(|row| row[lane]));
            let numbers = [a[0], a[1], a[2], errors[lane], b[0], b[1], b[2], c[0], c[1], c[2]];
            done.has(lane).then(|| numbers.map(f64::to_bits))
        });
        let any = std::array::from_fn(|lane| any.has(lane));
        (Answers { closest, any, all, surfaces }, done)
    }
}

/// Instructions that work on rows of eight.
fn with_lanes() -> impl Iterator<Item = InstructionSet> {
    InstructionSet::available().into_iter().filter(|set| *set != InstructionSet::Scalar)
}

fn rays_at(mesh: &TriangleMesh, scale: f64, first: usize, random: &mut Random) -> ([Ray; WIDTH], [f64; WIDTH]) {
    // Now and then eight neighbours, as of a camera, and eight that go anywhere.
    let rays = if first.is_multiple_of(3) {
        let (from, to) = (Point3::ORIGIN + random.vector() * (3.0 * scale), mesh.triangle(0)[0]);
        std::array::from_fn(|_| Ray::new(from, to - from + random.vector() * (0.05 * scale)))
    } else {
        std::array::from_fn(|i| ray_of(first + i, mesh, scale, random))
    };
    let t_max = std::array::from_fn(|i| match i % 3 {
        0 => 3.0 * random.number().abs(),
        _ => f64::INFINITY,
    });
    (rays, t_max)
}

fn with_normals(mesh: TriangleMesh, random: &mut Random) -> TriangleMesh {
    // Some have no length, and some are none.
    let normals = (0..mesh.positions.len()).map(|i| match i % 23 {
        7 => [0.0; 3],
        9 => [f32::NAN, 0.0, 1.0],
        _ => random.vector().to_array().map(|x| x as f32),
    });
    TriangleMesh { normals: normals.collect(), ..mesh }
}

fn place() -> Transform {
    Transform::translate(Vector3::new(3.0, -20.0, 1e3))
        * Transform::rotate(Vector3::new(1.0, 2.0, -1.0), 0.7)
        * Transform::scale(Vector3::new(1.0, -3.0, 0.01))
}

#[test]
fn rays_side_by_side_find_the_same() {
    let mut random = Random(51);
    let (mut met, mut done) = (0, 0);
    for kind in KINDS {
        for (count, scale, offset) in
            [(1, 1.0, 0.0), (80, 1.0, 30.0), (200, 1e6, 0.0), (60, 1e-12, 0.0), (60, 1e-100, 0.0)]
        {
            let offset = random.vector() * (offset * scale);
            let bare = mesh_of(kind, count, scale, offset, &mut random);
            let smooth = with_normals(bare.clone(), &mut random);
            for (mesh, place) in [(bare, Transform::default()), (smooth, place())] {
                for first in 0..40 {
                    let (rays, t_max) = rays_at(&mesh, scale.max(offset.length()), 8 * first, &mut random);
                    let expected = one_by_one(&mesh, &rays, &t_max, &place);
                    for set in with_lanes() {
                        let mesh = mesh.clone().with_instructions(set);
                        let work = Together { mesh: &mesh, around: None, rays: &rays, t_max: &t_max, place: &place };
                        let (mut found, by_lanes) = dispatch(set, work);
                        met += found.closest.iter().flatten().count();
                        done += by_lanes.count() as usize;
                        // What could not be had side by side is had by itself.
                        for lane in (0..WIDTH).filter(|lane| !by_lanes.has(*lane)) {
                            found.surfaces[lane] = expected.surfaces[lane];
                        }
                        assert_eq!(found, expected, "{kind:?} {count} {scale} {set:?} {rays:?}");
                    }
                }
            }
        }
    }
    assert!(met > 10_000 && done * 10 > met * 7, "{met} {done}");
}

/// A tree over a mesh and a box that is so many times larger.
fn tree_around(mesh: &TriangleMesh, larger: f64) -> WideTree {
    let Bounds3 { min, max } = mesh.bounds();
    let extent = min.max_abs().max(max.max_abs()) * larger;
    let far = Bounds3::new(Point3::new(0.1 * extent, -extent, 0.0), Point3::new(0.2 * extent, 0.0, 0.3 * extent));
    let bvh = Bvh::build(&[mesh.bounds(), far]);
    WideTree::new(&bvh.expect("finite boxes")).0
}

#[test]
fn what_is_made_ready_for_a_space_serves_its_meshes() {
    let mut random = Random(53);
    let mut met = [0; 3];
    for kind in KINDS {
        for (count, scale, offset) in [(1, 1.0, 0.0), (80, 1.0, 30.0), (200, 1e6, 0.0), (60, 1e-9, 0.0)] {
            let offset = random.vector() * (offset * scale);
            let mesh = mesh_of(kind, count, scale, offset, &mut random);
            for (larger, met) in [1.0, 7.0, 1000.0].into_iter().zip(&mut met) {
                let (around, place) = (tree_around(&mesh, larger), Transform::default());
                for first in 0..20 {
                    let (rays, t_max) = rays_at(&mesh, scale.max(offset.length()), 8 * first, &mut random);
                    let expected = one_by_one(&mesh, &rays, &t_max, &place);
                    for set in with_lanes() {
                        let mesh = mesh.clone().with_instructions(set);
                        let around = Some(&around);
                        let work = Together { mesh: &mesh, around, rays: &rays, t_max: &t_max, place: &place };
                        let mut found = dispatch(set, work).0;
                        *met += found.closest.iter().flatten().count();
                        found.surfaces = expected.surfaces;
                        assert_eq!(found, expected, "{kind:?} {count} {scale} {larger} {set:?} {rays:?}");
                    }
                }
            }
        }
    }
    assert!(met.into_iter().all(|met| met > 2000), "{met:?}");
}

/// The twin: what other rays find is told from it, in each of the answers.
#[test]
fn what_other_rays_find_is_told() {
    let mut random = Random(52);
    let mesh = mesh_of(Kind::Soup, 200, 1.0, Vector3::ZERO, &mut random);
    let (place, mut told) = (Transform::default(), [0; 4]);
    for first in 0..30 {
        let (mut rays, t_max) = rays_at(&mesh, 1.0, 8 * first, &mut random);
        let expected = one_by_one(&mesh, &rays, &t_max, &place);
        rays.rotate_left(1);
        for set in with_lanes() {
            let work = Together { mesh: &mesh, around: None, rays: &rays, t_max: &t_max, place: &place };
            let found = dispatch(set, work).0;
            told[0] += usize::from(found.closest != expected.closest);
            told[1] += usize::from(found.any != expected.any);
            told[2] += usize::from(found.all != expected.all);
            told[3] += usize::from(found.surfaces != expected.surfaces);
        }
    }
    assert!(told.into_iter().all(|told| told > 15), "{told:?}");
}

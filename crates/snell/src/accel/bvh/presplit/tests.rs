//! Pieces against the triangles they are of: what they cover, what they gain, and rays that meet them.

use proptest::prelude::*;
use snell_math::{Point3, Ray, Vector3};

use super::super::*;
use super::*;
use crate::accel::WideBvh;
use crate::accel::random::Random;

type Triangle = [[f32; 3]; 3];

fn triangle(corners: [Point3; 3]) -> Triangle {
    corners.map(|corner| corner.to_array().map(|x| x as f32))
}

/// Long and thin triangles at all angles, and twice as many small ones.
fn sticks(count: usize, scale: f64, random: &mut Random) -> Vec<Triangle> {
    let stick = |i: usize| {
        let from = random.point();
        let (along, across) = if i.is_multiple_of(3) { (0.7, 0.003) } else { (0.01, 0.01) };
        let corners = [from, from + random.vector() * along, from + random.vector() * across];
        triangle(corners.map(|p| Point3::ORIGIN + (p - Point3::ORIGIN) * scale))
    };
    (0..count).map(stick).collect()
}

fn build(triangles: &[Triangle], presplit: bool) -> Bvh {
    let options = BuildOptions { block: 8, presplit, ..BuildOptions::default() };
    Bvh::over_triangles(triangles.len(), |i| triangles[i as usize], options).expect("not too many")
}

fn check(bvh: &Bvh, triangles: &[Triangle]) -> Result<(), Defect> {
    bvh.validate_triangles(triangles.len(), |i| triangles[i as usize])
}

#[test]
fn pieces_pay_where_triangles_are_long_and_only_there() {
    let long = sticks(3000, 10.0, &mut Random(1));
    let [whole, cut] = [false, true].map(|presplit| build(&long, presplit));
    assert_eq!((check(&whole, &long), check(&cut, &long)), (Ok(()), Ok(())));
    let [whole, cut] = [whole, cut].map(|bvh| bvh.statistics());
    assert!(cut.sah_cost < 0.85 * whole.sah_cost, "{whole:?} {cut:?}");
    assert!(whole.primitives < cut.primitives && cut.primitives as f64 <= 1.3 * whole.primitives as f64, "{cut:?}");
    // A hilly square of triangles that are small and alike, on a floor of two.
    let height = |i: usize, j: usize| 0.1 * ((i * i + 3 * j) % 7) as f64;
    let at = |i: usize, j: usize| Point3::new(i as f64, height(i, j), j as f64);
    let mut hills: Vec<Triangle> = (0..1600)
        .flat_map(|k| {
            let (i, j) = (k / 40, k % 40);
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)];
            [triangle([a, b, c]), triangle([b, d, c])]
        })
        .collect();
    assert!(build(&hills, true) == build(&hills, false));
    let [a, b, c] = [Point3::ORIGIN, Point3::new(40.0, 0.0, 0.0), Point3::new(0.0, 0.0, 40.0)];
    hills.extend([triangle([a, b, c]), triangle([b, c, Point3::new(40.0, 0.0, 40.0)])]);
    let pieces = build(&hills, true).statistics().primitives - hills.len();
    assert!(pieces <= 2, "{pieces}");
}

#[test]
fn the_same_pieces_from_any_number_of_threads() {
    let triangles = sticks(60_000, 1.0, &mut Random(2));
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| build(&triangles, true))
    };
    let one = with(1);
    assert!(one.statistics().primitives > triangles.len() && one == with(2) && one == with(7));
}

/// Triangles whose pieces have been wrong in one program or another, among small ones that make it worth while.
fn nasty_triangles() -> Vec<(&'static str, Vec<Triangle>)> {
    let mut random = Random(3);
    let mut among = |scale: f64, large: &[[[f64; 3]; 3]]| {
        let mut all = sticks(200, scale, &mut random);
        all.extend(
            large.iter().map(|corners| triangle(corners.map(|corner| Point3::ORIGIN + Vector3::from(corner) * scale))),
        );
        all
    };
    let needle = [[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 1.000_001]];
    let line = [[-1.0, -1.0, -1.0], [0.5, 0.5, 0.5], [1.0, 1.0, 1.0]];
    let flat = [[-1.0, 0.5, -1.0], [1.0, 0.5, 1.0], [1.0, 0.5, 0.99]];
    let upright = [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 1e-30]];
    vec![
        ("needle", among(1.0, &[needle; 3])),
        ("three points of a line", among(1.0, &[line])),
        ("flat", among(1.0, &[flat, upright])),
        ("huge", among(3e37, &[needle, flat])),
        ("tiny", among(1e-30, &[needle, flat, upright])),
        ("below the normal numbers", among(1e-40, &[needle, flat])),
        ("far away", {
            let mut far = among(1.0, &[needle, flat]);
            far.iter_mut().flatten().for_each(|corner| corner[0] += 1e4);
            far
        }),
        ("one", vec![triangle(needle.map(Point3::from))]),
        ("collapsed", vec![triangle([Point3::ORIGIN; 3]); 9]),
        ("identical", vec![triangle(needle.map(Point3::from)); 100]),
    ]
}

#[test]
fn nasty_triangles_are_covered() {
    for (name, triangles) in nasty_triangles() {
        let bvh = build(&triangles, true);
        assert_eq!(check(&bvh, &triangles), Ok(()), "{name}");
        assert!(bvh.primitives.len() as f64 <= 1.3 * triangles.len() as f64, "{name}");
        // The pieces of a triangle reach just as far as itself.
        assert_eq!(bvh.bounds(), build(&triangles, false).bounds(), "{name}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn pieces_cover_their_triangle(seed in any::<u64>(), splits in 1..200_u64, kind in 0..5_usize) {
        let mut random = Random(seed);
        let [a, b, c] = [random.point(), random.point(), random.point()];
        let corners = triangle(match kind {
            0 => [a, b, a.lerp(b, 1e-6)],
            1 => [a, b, Point3::new(a.x(), b.y(), c.z())],
            2 => [a, a + (b - a) * 1e-7, c],
            3 => [a, b, c].map(|p| Point3::new(p.x(), 0.25, p.z())),
            _ => [a, b, c],
        });
        let planes = Planes::new(&Box32 { corners: [[-1.0; 3], [1.0; 3]] });
        let boxes = planes.pieces(&corners, splits);
        prop_assert!(boxes.len() as u64 <= splits + 1);
        // Every point, such as are computed in f64 from weights, is in a box.
        for _ in 0..200 {
            let [u, v] = [random.number().abs(), random.number().abs()];
            let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
            let [a, b, c] = corners.map(|corner| Point3::from(corner.map(f64::from)));
            let p = a + (b - a) * u + (c - a) * v;
            let is_in = |b: &Box32| b.to_bounds().grown(4.0 * f64::EPSILON).contains(p);
            prop_assert!(boxes.iter().any(is_in), "{p:?} of {corners:?}");
        }
        // And they are no larger than the triangle's box.
        let whole = Box32::around(&corners);
        prop_assert!(boxes.iter().all(|b| whole.contains_box(b)));
    }
}

/// Where a ray meets a triangle, in the plainest way.
fn hit(ray: &Ray, corners: &Triangle) -> Option<f64> {
    let [a, b, c] = corners.map(|corner| Point3::from(corner.map(f64::from)));
    let (e1, e2, s) = (b - a, c - a, ray.origin - a);
    let p = ray.direction.cross(e2);
    let determinant = e1.dot(p);
    let (u, q) = (s.dot(p) / determinant, s.cross(e1));
    let (v, t) = (ray.direction.dot(q) / determinant, e2.dot(q) / determinant);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0).then_some(t)
}

/// How many of some rays at the triangles get another answer from the tree than from brute force.
fn wrong_answers(bvh: &Bvh, triangles: &[Triangle], rays: usize) -> usize {
    let bvh = WideBvh::from_binary(bvh);
    let mut random = Random(4);
    let is_wrong = |_: &usize| {
        let [a, b, c] = triangles[random.index(triangles.len())].map(|corner| Point3::from(corner.map(f64::from)));
        // At a point of a triangle, now and then one of its border.
        let target = a.lerp(b, random.number().abs()).lerp(c, random.number().max(0.0));
        let origin = random.point();
        let ray = Ray::new(origin, target - origin);
        let all: Vec<(u32, f64)> =
            triangles.iter().enumerate().filter_map(|(i, t)| Some((i as u32, hit(&ray, t)?))).collect();
        let closest = all.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        let mut visited = Vec::new();
        bvh.all(&ray, f64::INFINITY, |i| visited.extend(hit(&ray, &triangles[i as usize]).map(|t| (i, t))));
        visited.sort_by_key(|(i, _)| *i);
        let test = |i: u32, t_max: f64| hit(&ray, &triangles[i as usize]).filter(|t| *t <= t_max);
        bvh.closest(&ray, f64::INFINITY, test) != closest || visited != all
    };
    (0..rays).filter(is_wrong).count()
}

#[test]
fn rays_meet_triangles_in_pieces_once() {
    let triangles = sticks(300, 1.0, &mut Random(5));
    let mut bvh = build(&triangles, true);
    assert!(bvh.primitives.len() > 310, "{}", bvh.primitives.len());
    assert_eq!(wrong_answers(&bvh, &triangles, 5000), 0);
    // The twin: missed where a piece is too small.
    for node in bvh.nodes.iter_mut().filter(|node| node.is_leaf()) {
        let b = node.bounds.to_bounds();
        let small = |corner: Point3| b.center().lerp(corner, 0.99);
        node.bounds = Box32::enclosing(&Bounds3::new(small(b.min), small(b.max)));
    }
    assert!(wrong_answers(&bvh, &triangles, 500) > 0);
}

#[test]
fn planted_defects_of_pieces_are_caught() {
    let triangles = sticks(300, 1.0, &mut Random(6));
    let good = build(&triangles, true);
    assert_eq!(check(&good, &triangles), Ok(()));
    let in_pieces = (0..300).find(|i| good.repeated.contains(*i)).expect("pieces");
    let of = |bvh: &Bvh, triangle| {
        bvh.nodes.iter().position(|n| n.is_leaf() && bvh.primitives[n.range()].contains(&triangle)).expect("a leaf")
    };
    let sabotage = |plant: &dyn Fn(&mut Bvh)| {
        let mut bad = good.clone();
        plant(&mut bad);
        check(&bad, &triangles).expect_err("the defect is caught")
    };
    let secret = sabotage(&|bvh| bvh.repeated = Places::default());
    assert_eq!(secret, Defect::Unexpected(in_pieces));
    // One of its leaves no longer has it.
    let dropped = sabotage(&|bvh| {
        let range = bvh.nodes[of(bvh, in_pieces)].range();
        let other = bvh.primitives[range.clone()].iter().copied().find(|i| *i != in_pieces).expect("another");
        for place in bvh.primitives[range].iter_mut().filter(|place| **place == in_pieces) {
            *place = other;
        }
    });
    assert!(matches!(dropped, Defect::Unexpected(_)), "{dropped}");
    let lost = sabotage(&|bvh| {
        let leaf = of(bvh, in_pieces);
        let range = bvh.nodes[leaf].range();
        let place = bvh.primitives[range.clone()].iter().position(|i| *i == in_pieces).expect("it is there");
        bvh.primitives[range.clone()].swap(place, range.len() - 1);
        bvh.nodes[leaf].count -= 1;
    });
    assert!(
        matches!(lost, Defect::Uncovered(i) | Defect::OutsideLeaf { primitive: i, .. } if i == in_pieces),
        "{lost}"
    );
    let shrunk = sabotage(&|bvh| {
        let leaf = of(bvh, in_pieces);
        let bounds = &mut bvh.nodes[leaf].bounds;
        let middle = bounds.to_bounds().center();
        bounds.corners[1] = middle.to_array().map(|x| x as f32);
    });
    assert!(matches!(shrunk, Defect::Uncovered(_) | Defect::OutsideLeaf { .. }), "{shrunk}");
    let boxes: Vec<Bounds3> = triangles.iter().map(|t| Box32::around(t).to_bounds()).collect();
    assert_eq!(good.validate(&boxes), Err(Defect::Unexpected(in_pieces)));
}

//! Solids against point membership: along random lines through random trees, the intervals between crossings must be
//! inside exactly where the points of the line are.

use snell_math::{Point3, Ray, Transform, Vector3};
use snell_scene::scene::CsgOperation::{self, Difference, Intersection, Union};

use super::{CsgError, CsgHit, CsgNode, CsgScratch, CsgSolid};
use crate::shape::tests::{Random, fixture};
use crate::shape::{Cuboid, Frustum, Plane, Shape, Sphere};

fn leaf(shape: Shape) -> CsgNode {
    CsgNode::Leaf { shape, solid_from_leaf: None, tag: 0 }
}

fn operation(operation: CsgOperation, children: &[u32]) -> CsgNode {
    CsgNode::Operation { operation, children: children.to_vec() }
}

fn solid(nodes: Vec<CsgNode>) -> CsgSolid {
    CsgSolid::new(nodes).expect("a tree of solids")
}

fn cuboid(min: [f64; 3], max: [f64; 3]) -> Shape {
    Shape::Box(Cuboid::new(Point3::from(min), Point3::from(max)))
}

fn sphere(x: f64, radius: f64) -> Shape {
    Shape::Sphere(Sphere::new(Point3::new(x, 0.0, 0.0), radius))
}

/// A random tree of this depth at most; returns the place of its root.
fn grow(random: &mut Random, depth: u32, nodes: &mut Vec<CsgNode>) -> u32 {
    if depth == 0 || random.below(5) == 0 {
        let kind = random.below(6);
        let center = Point3::ORIGIN + random.vector_in_ball(1.0);
        let solid_from_leaf = (random.below(2) == 0).then(|| {
            let stretch = Vector3::new(random.range(0.5, 1.5), -random.range(0.5, 1.5), random.range(0.5, 1.5));
            let factors = [stretch, Vector3::new(0.7, 0.7, 0.7)][random.below(2) as usize];
            Transform::rotate(random.direction(), random.range(0.0, 6.0)) * Transform::scale(factors)
        });
        let shape = fixture(random, kind, center, 1.0).shape;
        nodes.push(CsgNode::Leaf { shape, solid_from_leaf, tag: nodes.len() as u32 });
    } else {
        let count = 1 + random.below(4);
        let children: Vec<u32> = (0..count).map(|_| grow(random, depth - 1, nodes)).collect();
        nodes.push(operation([Union, Intersection, Difference][random.below(3) as usize], &children));
    }
    nodes.len() as u32 - 1
}

/// Membership straight from the definition, by recursion over the nodes.
fn contains(nodes: &[CsgNode], node: u32, point: Point3) -> bool {
    match &nodes[node as usize] {
        CsgNode::Leaf { shape, solid_from_leaf, .. } => {
            shape.contains(solid_from_leaf.map_or(point, |map| map.inverse_point(point)))
        }
        CsgNode::Operation { operation, children } => {
            let inside: Vec<bool> = children.iter().map(|&child| contains(nodes, child, point)).collect();
            match operation {
                Union => inside.contains(&true),
                Intersection => !inside.contains(&false),
                Difference => inside[0] && !inside[1..].contains(&true),
            }
        }
    }
}

/// How many samples along the ray lie on the wrong side of these crossings.
fn mismatches(nodes: &[CsgNode], ray: &Ray, hits: &[CsgHit]) -> usize {
    let root = nodes.len() as u32 - 1;
    let wrong = |t: f64| {
        let before = hits.iter().filter(|hit| hit.t < t).count();
        let inside = match hits.get(before) {
            Some(next) => !next.entering,
            None => hits.last().is_some_and(|last| last.entering),
        };
        let near = hits.iter().any(|hit| (hit.t - t).abs() < 1e-7);
        // A line without crossings may also be inside all along, but then it is so everywhere.
        let inside = if hits.is_empty() { contains(nodes, root, ray.origin) } else { inside };
        !near && inside != contains(nodes, root, ray.at(t))
    };
    (-200..200).filter(|i| wrong(f64::from(*i) * 0.0201 + 0.003)).count()
}

fn random_ray(random: &mut Random) -> Ray {
    Ray::new(Point3::ORIGIN + random.vector_in_ball(1.5), random.direction())
}

/// The same tree with the first two parts of each difference swapped.
fn swapped(nodes: &[CsgNode]) -> Vec<CsgNode> {
    let mut nodes = nodes.to_vec();
    for node in &mut nodes {
        if let CsgNode::Operation { operation: Difference, children } = node
            && children.len() > 1
        {
            children.swap(0, 1);
        }
    }
    nodes
}

#[test]
fn crossings_agree_with_membership() {
    let mut random = Random(41);
    let mut scratch = CsgScratch::default();
    let (mut crossed, mut noticed) = (0, 0);
    for _ in 0..600 {
        let mut nodes = Vec::new();
        let root = grow(&mut random, 4, &mut nodes);
        let whole = solid(nodes.clone());
        let twin = solid(swapped(&nodes));
        let bounds = whole.bounds();
        for _ in 0..10 {
            let ray = random_ray(&mut random);
            let hits = whole.crossings(&ray, &mut scratch).to_vec();
            assert!(hits.windows(2).all(|pair| pair[0].t < pair[1].t && pair[0].entering != pair[1].entering));
            assert_eq!(mismatches(&nodes, &ray, &hits), 0, "{nodes:?} {ray:?} {hits:?}");
            for i in 0..20 {
                let point = ray.at(0.3 * f64::from(i) - 3.0);
                let inside = contains(&nodes, root, point);
                assert_eq!(whole.contains(point), inside);
                assert!(!inside || bounds.contains(point));
            }
            // The nearest hit is the first of them in range.
            for (t_min, t_max) in [(0.0, f64::INFINITY), (-0.5, 0.7), (0.3, 0.31)] {
                let first = hits.iter().copied().find(|hit| hit.t > t_min && hit.t < t_max);
                assert_eq!(whole.intersect(&ray, t_min, t_max, &mut scratch), first);
            }
            for hit in hits.iter().filter(|hit| hit.t.abs() < 10.0) {
                crossed += 1;
                let surface = whole.surface(&ray, *hit);
                assert!(surface.point.distance(ray.at(hit.t)) < 1e-6);
                let along = surface.geometric_normal.dot(ray.direction);
                assert!(along.abs() < 1e-6 || hit.entering == (along < 0.0), "{hit:?} {surface:?}");
            }
            let twins_hits = twin.crossings(&ray, &mut scratch);
            noticed += usize::from(mismatches(&nodes, &ray, twins_hits) > 0);
        }
    }
    assert!(crossed > 5000, "{crossed}");
    assert!(noticed > 500, "swapped differences were noticed along {noticed} lines only");
}

#[test]
fn half_spaces_hold_lines_that_never_cross_them() {
    let floor = Shape::Plane(Plane::new(Point3::ORIGIN, Vector3::Y));
    let carved = solid(vec![leaf(floor), leaf(sphere(0.0, 1.0)), operation(Difference, &[0, 1])]);
    let mut scratch = CsgScratch::default();
    let below = Ray::new(Point3::new(-5.0, -0.5, 0.0), Vector3::X);
    let hits = carved.crossings(&below, &mut scratch);
    assert_eq!(hits.iter().map(|hit| (hit.entering, hit.flipped)).collect::<Vec<_>>(), [(false, true), (true, true)]);
    let above = Ray::new(Point3::new(-5.0, 0.5, 0.0), Vector3::X);
    assert!(carved.crossings(&above, &mut scratch).is_empty());
    // Only one side of these bounds is finite.
    assert!(carved.bounds().max.y() < 1e-300 && carved.bounds().min.y() == f64::NEG_INFINITY);
}

/// Places and leaves of all crossings along +x at y = z = 0.25.
fn along_x(whole: &CsgSolid) -> Vec<(f64, u32)> {
    let ray = Ray::new(Point3::new(-1.0, 0.25, 0.25), Vector3::X);
    whole.crossings(&ray, &mut CsgScratch::default()).iter().map(|hit| (hit.t, hit.leaf)).collect()
}

#[test]
fn coincident_faces_leave_neither_walls_nor_gaps() {
    let (a, b) = (cuboid([0.0; 3], [1.0; 3]), cuboid([1.0, 0.0, 0.0], [2.0, 1.0, 1.0]));
    let with = |op, x: Shape, y: Shape| along_x(&solid(vec![leaf(x), leaf(y), operation(op, &[0, 1])]));
    // Side by side.
    assert_eq!(with(Union, a, b), [(1.0, 0), (3.0, 1)]);
    assert_eq!(with(Intersection, a, b), []);
    assert_eq!(with(Difference, a, b), [(1.0, 0), (2.0, 0)]);
    // The same.
    assert_eq!(with(Union, a, a), [(1.0, 0), (2.0, 0)]);
    assert_eq!(with(Intersection, a, a), [(1.0, 0), (2.0, 0)]);
    assert_eq!(with(Difference, a, a), []);
    // A hole flush with the face.
    let half = cuboid([0.0; 3], [0.5, 1.0, 1.0]);
    assert_eq!(with(Difference, a, half), [(1.5, 1), (2.0, 0)]);
    assert_eq!(with(Union, a, half), [(1.0, 0), (2.0, 0)]);
    // Coincident only up to rounding: the face in thirds, and the flat end of a cylinder on it.
    let third = 1.0 / 3.0;
    let (left, right) = (cuboid([0.0; 3], [third, 1.0, 1.0]), cuboid([0.1 + 0.7 / 3.0, 0.0, 0.0], [1.0; 3]));
    assert_eq!(with(Union, left, right).len(), 2);
    let axis = Vector3::new(1.0, 0.0, 0.0);
    let base = Point3::new(third, 0.3, 0.3);
    let rod = Shape::Cylinder(Frustum::new(base, 0.2, base + axis * 0.9, 0.2, true));
    assert_eq!(with(Union, left, rod).len(), 2);
}

#[test]
fn rays_spawned_where_parts_coincide_clear_both() {
    let mut random = Random(43);
    let spawned_hits = |random: &mut Random, factor: f64| {
        let mut hits = 0;
        for _ in 0..3000 {
            // A small rod through a large slab, flush with its top; anywhere, at any angle.
            let turn = Transform::rotate(random.direction(), random.range(0.0, 6.0));
            let (base, top) = (Point3::new(0.0, -1.0, 0.0), Point3::new(0.0, 1e-3, 0.0));
            let rod = Shape::Cylinder(Frustum::new(base, 0.5, top, 0.5, true));
            let slab = cuboid([-1e4, -1e3, -1e4], [1e4, 1e-3, 1e4]);
            let part = |shape| CsgNode::Leaf { shape, solid_from_leaf: Some(turn), tag: 0 };
            let whole = solid(vec![part(rod), part(slab), operation(Union, &[0, 1])]);
            let (target, from) =
                (Vector3::new(random.range(-0.4, 0.4), 1e-3, random.range(-0.2, 0.2)), Vector3::Y * 3.0);
            let ray = Ray::new(Point3::ORIGIN + turn.vector(from), turn.vector(target - from));
            let mut scratch = CsgScratch::default();
            let hit = whole.intersect(&ray, 0.0, f64::INFINITY, &mut scratch).expect("the ray aims at the rod");
            let surface = whole.surface(&ray, hit);
            let origin = surface.point + surface.geometric_normal.as_vector() * (surface.error * factor);
            let direction = random.direction();
            let away = surface.geometric_normal.dot(direction) < 1e-9;
            let spawned = Ray::new(origin, if away { -direction } else { direction });
            hits += usize::from(
                surface.geometric_normal.dot(spawned.direction) > 1e-9
                    && whole.intersect(&spawned, 0.0, f64::INFINITY, &mut scratch).is_some(),
            );
        }
        hits
    };
    assert_eq!(spawned_hits(&mut random, 1.0), 0);
    assert!(spawned_hits(&mut random, 0.0) > 0);
}

#[test]
fn depth_has_no_limit() {
    // Spheres in a row: (((a ∪ b) − c) ∪ d) …, and the same leaning to the other side.
    const DEPTH: u32 = 10_000;
    for leaning_left in [true, false] {
        let mut nodes = vec![leaf(sphere(0.0, 0.6))];
        for i in 1..DEPTH {
            let whole = nodes.len() as u32 - 1;
            nodes.push(leaf(sphere(f64::from(i), 0.6)));
            let part = whole + 1;
            let op = if i % 2 == 0 { Union } else { Difference };
            nodes.push(if leaning_left { operation(op, &[whole, part]) } else { operation(Union, &[part, whole]) });
        }
        let whole = solid(nodes);
        let mut scratch = CsgScratch::default();
        let ray = Ray::new(Point3::new(-10.0, 0.0, 0.0), Vector3::X);
        let hits = whole.crossings(&ray, &mut scratch);
        assert_eq!(hits.len(), if leaning_left { DEPTH as usize } else { 2 });
        assert!((hits[0].t - 9.4).abs() < 1e-12);
        let across = Ray::new(Point3::new(5000.0, 5.0, 0.0), -Vector3::Y);
        assert_eq!(whole.intersect(&across, 0.0, 100.0, &mut scratch).map(|hit| hit.leaf), Some(5000));
        assert!(whole.contains(Point3::new(5000.0, 0.0, 0.0)));
    }
}

#[test]
fn what_is_no_tree_is_refused() {
    let ball = || leaf(sphere(0.0, 1.0));
    let open = Frustum::new(Point3::ORIGIN, 1.0, Point3::new(0.0, 1.0, 0.0), 1.0, false);
    let refused = |nodes: Vec<CsgNode>| CsgSolid::new(nodes).expect_err("no tree");
    assert_eq!(refused(vec![]), CsgError::NodeCount);
    assert_eq!(refused(vec![leaf(Shape::Cylinder(open))]), CsgError::NotSolid(0));
    assert_eq!(refused(vec![operation(Union, &[])]), CsgError::NoParts(0));
    assert_eq!(refused(vec![operation(Union, &[0])]), CsgError::Child { node: 0, child: 0 });
    assert_eq!(refused(vec![ball(), operation(Union, &[0, 0])]), CsgError::Child { node: 1, child: 0 });
    assert_eq!(refused(vec![ball(), operation(Union, &[9])]), CsgError::Child { node: 1, child: 9 });
    assert_eq!(refused(vec![ball(), ball()]), CsgError::Unused(0));
    assert!(CsgSolid::new(vec![ball()]).is_ok());
}

#[test]
fn broken_rays_cross_nothing() {
    let whole = solid(vec![leaf(sphere(0.0, 1.0)), leaf(sphere(0.5, 1.0)), operation(Difference, &[0, 1])]);
    let mut scratch = CsgScratch::default();
    let nan = Vector3::new(f64::NAN, 0.0, 1.0);
    for ray in [
        Ray::new(Point3::ORIGIN, Vector3::ZERO),
        Ray::new(Point3::ORIGIN, nan),
        Ray::new(Point3(nan.0), Vector3::X),
        Ray::new(Point3::ORIGIN, Vector3::new(f64::INFINITY, 0.0, 0.0)),
    ] {
        assert!(whole.crossings(&ray, &mut scratch).is_empty());
        assert_eq!(whole.intersect(&ray, 0.0, f64::INFINITY, &mut scratch), None);
    }
}

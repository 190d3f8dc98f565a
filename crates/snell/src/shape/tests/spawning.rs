//! Rays spawned on a surface with the reported error as their only offset: they must not meet the same place again.

use snell_math::{Point3, Ray, Transform, Vector3};

use super::super::{Shape, SurfacePoint};
use super::{Fixture, Random, fixture, ray_at};

/// A direction on the outer side of the tangent plane, at any angle to it down to less than rounding, often towards
/// `aim`: from the side of a cone with that on its axis, along the side.
fn outward(random: &mut Random, surface: &SurfacePoint, aim: Point3) -> Vector3 {
    let normal = surface.geometric_normal;
    let n = normal.as_vector();
    let towards = (aim - surface.point) * if random.below(2) == 0 { 1.0 } else { -1.0 };
    let d = if random.below(4) == 0 { towards } else { random.direction() };
    let tangent = (d - n * n.dot(d)).try_normalize().unwrap_or_else(|| n.orthonormal_basis().0);
    let lift = [0.0, 1e-300, 1e-17, 1e-16, 1e-14, 1e-10, 1e-6, 1e-3, 1.0, 1e6][random.below(10) as usize];
    let d = (tangent + n * lift).normalize() * [1.0, 1e-3, 25.0][random.below(3) as usize];
    if normal.dot(d) < 0.0 { -d } else { d }
}

/// A fixture anywhere at any scale, with a hit on it.
fn hit_somewhere(random: &mut Random, kind: u64) -> Option<(Fixture, SurfacePoint)> {
    let scale = [1e-3, 1.0, 1e3, 1e6][random.below(4) as usize];
    let offset = [0.0, 1.0, 1e3, 1e6][random.below(4) as usize];
    let center = Point3::ORIGIN + random.direction() * offset;
    let fixture = fixture(random, kind, center, scale);
    let from = [2.0 * scale, 1e3 * scale, 1e6][random.below(3) as usize];
    let ray = ray_at(random, &fixture, from);
    let hit = fixture.shape.intersect(&ray, 0.0, f64::INFINITY)?;
    let surface = fixture.shape.surface(&ray, hit);
    Some((fixture, surface))
}

/// How many of the rays spawned outside convex shapes hit again, when offset by the error times `factor`.
fn hits_again(seed: u64, kind: u64, factor: f64) -> (usize, usize) {
    let mut random = Random(seed);
    let (mut spawned, mut hit) = (0, 0);
    for _ in 0..6000 {
        let Some((fixture, surface)) = hit_somewhere(&mut random, kind) else { continue };
        for _ in 0..3 {
            let origin = surface.point + surface.geometric_normal.as_vector() * (factor * surface.error);
            let ray = Ray::new(origin, outward(&mut random, &surface, fixture.center));
            spawned += 1;
            hit += usize::from(fixture.shape.intersect(&ray, 0.0, f64::INFINITY).is_some());
        }
    }
    (spawned, hit)
}

#[test]
fn rays_spawned_outside_convex_shapes_never_hit_them_again() {
    for kind in [0, 1, 2, 3, 4, 6, 7] {
        for factor in [1.0, 2.0] {
            let (spawned, hit) = hits_again(7, kind, factor);
            assert!(spawned > 3000, "{spawned} of kind {kind}");
            assert_eq!(hit, 0, "of {spawned} of kind {kind}, offset {factor} times the error");
        }
        // The twin: without the offset, many do. A box is put exactly onto its face and needs no luck.
        let (_, hit) = hits_again(7, kind, 0.0);
        assert!(hit > 10 || kind == 2, "{hit} of kind {kind} hit without an offset");
    }
}

#[test]
fn points_are_within_the_error_and_the_error_is_small() {
    let mut random = Random(8);
    for i in 0..40_000_u64 {
        let Some((fixture, surface)) = hit_somewhere(&mut random, i % 8) else { continue };
        let off = (fixture.distance)(surface.point).abs();
        assert!(off <= surface.error, "{:?}: {off} > {}", fixture.shape, surface.error);
        let reach = fixture.center.max_abs() + fixture.size + surface.point.max_abs();
        assert!(surface.error <= 2e-14 * reach && surface.error >= 0.0, "{:?} {surface:?} {reach}", fixture.shape);
        for normal in [surface.geometric_normal, surface.shading_normal] {
            assert!((normal.as_vector().length() - 1.0).abs() < 1e-14);
        }
    }
}

#[test]
fn rays_spawned_inside_solids_find_one_way_out() {
    let mut random = Random(9);
    let mut spawned = 0;
    for i in 0..20_000_u64 {
        let kind = [0, 2, 3, 4][(i % 4) as usize];
        let Some((fixture, surface)) = hit_somewhere(&mut random, kind) else { continue };
        let origin = surface.point - surface.geometric_normal.as_vector() * surface.error;
        // Near an edge or an apex the offset may lead out of the solid.
        if (fixture.distance)(origin) > -0.3 * surface.error || !fixture.shape.contains(origin) {
            continue;
        }
        let ray = Ray::new(origin, -outward(&mut random, &surface, fixture.center));
        let mut crossings = Vec::new();
        fixture.shape.crossings(&ray, &mut crossings);
        assert_eq!(crossings.iter().filter(|c| c.t > 0.0).count(), 1, "{:?} {ray:?} {crossings:?}", fixture.shape);
        spawned += 1;
    }
    assert!(spawned > 5000);
}

/// The torus is not convex: a spawned ray may rightly hit it further on, so only hits without space before them count.
fn torus_hits_again(factor: f64) -> usize {
    let mut random = Random(10);
    let mut hit_at_once = 0;
    for _ in 0..20_000 {
        let Some((fixture, surface)) = hit_somewhere(&mut random, 5) else { continue };
        let origin = surface.point + surface.geometric_normal.as_vector() * (factor * surface.error);
        let ray = Ray::new(origin, outward(&mut random, &surface, fixture.center));
        let Some(hit) = fixture.shape.intersect(&ray, 0.0, f64::INFINITY) else { continue };
        let farthest = (1..10).map(|i| (fixture.distance)(ray.at(hit.t * 0.1 * f64::from(i)))).fold(0.0, f64::max);
        hit_at_once += usize::from(farthest < 0.1 * surface.error);
    }
    hit_at_once
}

#[test]
fn rays_spawned_on_a_torus_do_not_hit_where_they_start() {
    assert_eq!(torus_hits_again(1.0), 0);
    assert!(torus_hits_again(0.0) > 100);
}

#[test]
fn carried_errors_suffice_under_any_affine_map() {
    let mut random = Random(11);
    let mut count = |factor: f64| {
        let (mut spawned, mut again) = (0, 0);
        for i in 0..20_000_u64 {
            let kind = [0, 2, 3, 4, 6, 7][(i % 6) as usize];
            let fixture = fixture(&mut random, kind, Point3::ORIGIN + random_offset(i), 1.0);
            let factors = Vector3::new(random.range(0.1, 3.0), random.range(-3.0, -0.1), random.range(1.0, 30.0));
            let angle = random.range(0.0, 6.0);
            let outer_from_inner =
                Transform::translate(random.direction() * [0.0, 10.0, 1e5][random.below(3) as usize])
                    * Transform::rotate(random.direction(), angle)
                    * Transform::scale(factors);
            let ray = ray_at(&mut random, &fixture, 5.0);
            let Some(hit) = fixture.shape.intersect(&ray, 0.0, f64::INFINITY) else { continue };
            let surface = fixture.shape.surface(&ray, hit).carried(&outer_from_inner);
            let origin = surface.point + surface.geometric_normal.as_vector() * (factor * surface.error);
            let ray = outer_from_inner
                .inverse_ray(&Ray::new(origin, outward(&mut random, &surface, outer_from_inner.point(fixture.center))));
            spawned += 1;
            let found = fixture.shape.intersect(&ray, 0.0, f64::INFINITY);
            // Carried directions are rounded: far away on an infinite plane, or a flat shape's, that is a real hit.
            again += usize::from(found.is_some_and(|hit| hit.t * ray.direction.length() < 10.0));
        }
        assert!(spawned > 5000);
        again
    };
    assert_eq!(count(1.0), 0);
    assert!(count(0.0) > 100);
}

fn random_offset(i: u64) -> Vector3 {
    [Vector3::ZERO, Vector3::new(1.0, -7.0, 3.0), Vector3::new(-1e3, 0.0, 2e3)][(i % 3) as usize]
}

#[test]
fn shapes_spawn_in_world_space_after_being_carried_there() {
    let mut random = Random(12);
    for i in 0..5000_u64 {
        let fixture = fixture(&mut random, [0, 1, 3, 4, 6, 7][(i % 6) as usize], Point3::ORIGIN, 1.0);
        let map = Transform::translate(random.vector_in_ball(1e4))
            * Transform::rotate(random.direction(), random.range(0.0, 6.0))
            * Transform::scale(Vector3::new(3.0, 3.0, -3.0));
        let shape: Shape = fixture.shape.transformed(&map).expect("the map is uniform");
        let ray = ray_at(&mut random, &fixture, 5.0);
        let ray = Ray::new(map.point(ray.origin), map.vector(ray.direction));
        let Some(hit) = shape.intersect(&ray, 0.0, f64::INFINITY) else { continue };
        let surface = shape.surface(&ray, hit);
        let origin = surface.point + surface.geometric_normal.as_vector() * surface.error;
        let spawned = Ray::new(origin, outward(&mut random, &surface, map.point(fixture.center)));
        assert!(shape.intersect(&spawned, 0.0, f64::INFINITY).is_none(), "{shape:?}");
    }
}

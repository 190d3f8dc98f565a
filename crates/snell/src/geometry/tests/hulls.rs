//! Cylinders and cones in a hierarchy that knows the tubes they lie in, against each of them asked by itself.

use snell_math::{Bounds3, Point3, Ray};
use snell_testkit::{TestRng, must_fail};

use crate::accel::{Hull, WideBvh};
use crate::geometry::space::{NONE, Primitive, hull_of};
use crate::shape::{Frustum, Shape};

/// Needles, disks, cones and what is between, some of them far away from where coordinates are zero.
fn frusta(rng: &mut TestRng, count: usize, scale: f64, far: f64) -> Vec<Shape> {
    let away = rng.vector(far);
    let mut one = || {
        let base = Point3::ORIGIN + (away + rng.vector(1.0)) * scale;
        let axis = rng.direction() * (scale * *rng.pick(&[1.5, 0.3, 1e-3]));
        let radius = scale * *rng.pick(&[0.3, 0.05, 1e-4]);
        if rng.coin() {
            Shape::Cylinder(Frustum::new(base, radius, base + axis, radius, rng.coin()))
        } else {
            Shape::Cone(Frustum::new(base, radius, base + axis, radius * rng.range(0.0, 1.0), rng.coin()))
        }
    };
    (0..count).map(|_| one()).collect()
}

fn hulls(shapes: &[Shape]) -> Vec<Hull> {
    (0..shapes.len() as u32).map(|shape| hull_of(&Primitive::Shape { shape, placement: NONE }, shapes)).collect()
}

/// Rays that graze tubes, or nearly follow them, from near and far.
fn ray(rng: &mut TestRng, hull: Hull, i: usize, scale: f64) -> Ray {
    let Hull::Tube { center, half_axis, radius } = hull else { panic!("a frustum lies in a tube") };
    let at = center + half_axis * rng.range(-1.0, 1.0);
    let along = if i.is_multiple_of(4) { half_axis.normalize() + rng.vector(1e-3) } else { rng.direction() };
    let aside = along.cross(half_axis).try_normalize().unwrap_or_else(|| rng.direction());
    let past = *rng.pick(&[0.0, 0.9, 0.999_999, 1.000_001]) * radius;
    let far = *rng.pick(&[0.0, 1.0, 100.0, 1e6]) * scale;
    Ray::new(at + aside * past - along.normalize() * far, along * [1.0, 1e-100, 1e100][i % 3])
}

/// How many rays meet something; what they meet is what meets them first by itself.
fn check(shapes: &[Shape], hulls: &[Hull], rng: &mut TestRng, scale: f64) -> usize {
    let bounds: Vec<Bounds3> = shapes.iter().map(Shape::bounds).collect();
    let plain = WideBvh::build(&bounds).expect("finite boxes");
    let bvh = plain.clone().with_hulls(hulls);
    let (mut met, mut visits) = (0, [0, 0]);
    for i in 0..400 {
        let hull = *rng.pick(hulls);
        let ray = ray(rng, hull, i, scale);
        let hit = |id: u32| shapes[id as usize].intersect(&ray, 0.0, f64::INFINITY).map(|hit| hit.t);
        let all = (0..shapes.len() as u32).filter_map(|id| Some((id, hit(id)?)));
        let closest = all.min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        assert_eq!(bvh.closest(&ray, f64::INFINITY, |id, _| hit(id)), closest, "{ray:?}");
        assert_eq!(bvh.any(&ray, f64::INFINITY, |id| hit(id).is_some()), closest.is_some(), "{ray:?}");
        for (visits, bvh) in visits.iter_mut().zip([&plain, &bvh]) {
            bvh.all(&ray, f64::INFINITY, |_| *visits += 1);
        }
        met += usize::from(closest.is_some());
    }
    assert!(shapes.len() < 10 || visits[1] * 10 < visits[0] * 9, "few are left out: {visits:?}");
    met
}

#[test]
fn frusta_are_met_where_they_are_alone() {
    let mut rng = TestRng::new(31);
    let mut met = 0;
    for (scale, far) in [(1.0, 0.0), (1.0, 20.0), (1e-9, 0.0), (1e9, 3.0)] {
        for count in [1, 12, 90] {
            let shapes = frusta(&mut rng, count, scale, far);
            met += check(&shapes, &hulls(&shapes), &mut rng, scale);
        }
    }
    assert!(met > 1500, "{met}");
}

#[test]
fn tubes_that_are_too_thin_lose_hits() {
    let mut rng = TestRng::new(32);
    let shapes = frusta(&mut rng, 60, 1.0, 0.0);
    let thinner = |hull: Hull| match hull {
        Hull::Tube { center, half_axis, radius } => Hull::Tube { center, half_axis, radius: 0.98 * radius },
        hull => hull,
    };
    let thin: Vec<Hull> = hulls(&shapes).into_iter().map(thinner).collect();
    must_fail("tubes that are too thin", || check(&shapes, &thin, &mut rng, 1.0));
}

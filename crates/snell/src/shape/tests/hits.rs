//! Hits and crossings against the signs of the distance functions along dense samples of each line.

use snell_math::{Point3, Ray};

use super::super::{Crossing, Frustum, Shape};
use super::{Fixture, Random, fixture, ray_at};

/// What is wrong with these crossings, as far as the signs of the distance function tell.
fn complaint(fixture: &Fixture, ray: &Ray, crossings: &[Crossing]) -> Option<String> {
    let length = ray.direction.length();
    let to_center = fixture.center - ray.origin;
    let tolerance = 2e-13 * (to_center.length() + fixture.size + fixture.center.max_abs());
    let starts_inside = crossings.first().is_some_and(|first| !first.entering);
    if starts_inside && !matches!(fixture.shape, Shape::Plane(_)) {
        return Some("it starts inside".to_owned());
    }
    for pair in crossings.windows(2) {
        if pair[0].t > pair[1].t || pair[0].entering == pair[1].entering {
            return Some(format!("{pair:?} are out of order"));
        }
    }
    for crossing in crossings {
        let distance = (fixture.distance)(ray.at(crossing.t));
        if distance.abs() > tolerance + 1e-15 * crossing.t.abs() * length {
            return Some(format!("{crossing:?} is {distance} off the surface, above {tolerance}"));
        }
    }
    let middle = to_center.dot(ray.direction) / (length * length);
    for i in -150..=150 {
        let t = middle + f64::from(i) * (1.2 / 150.0) * fixture.size / length;
        let distance = (fixture.distance)(ray.at(t));
        let inside = starts_inside ^ (crossings.iter().filter(|crossing| crossing.t < t).count() % 2 == 1);
        let parallel = matches!(fixture.shape, Shape::Plane(_)) && crossings.is_empty();
        if distance.abs() > tolerance && !parallel && inside != (distance < 0.0) {
            return Some(format!("at {t} it should be at distance {distance}, crossings {crossings:?}"));
        }
    }
    None
}

/// What is wrong with the nearest hits, given that the crossings are right.
fn nearest_complaint(shape: &Shape, ray: &Ray, crossings: &[Crossing]) -> Option<String> {
    let mut limits = vec![(0.0, f64::INFINITY), (f64::NEG_INFINITY, f64::INFINITY), (0.0, 0.3)];
    limits.extend(crossings.iter().flat_map(|c| [(c.t + 1e-9, f64::INFINITY), (f64::NEG_INFINITY, c.t), (c.t, 1e9)]));
    for (t_min, t_max) in limits {
        // A torus finds its roots anew for each range; so close to its ends nothing is said.
        let near_end = |t: f64| [t_min, t_max].iter().any(|end| (t - end).abs() < 1e-7 * (1.0 + t.abs()));
        let expected = crossings.iter().find(|c| c.t > t_min && c.t < t_max);
        let found = shape.intersect(ray, t_min, t_max);
        let same = match (expected, found) {
            (Some(expected), Some(found)) => {
                (expected.t - found.t).abs() <= 1e-7 * (1.0 + found.t.abs()) && expected.part == found.part
            }
            (None, None) => true,
            _ => false,
        };
        let excused = matches!(shape, Shape::Torus(_)) && crossings.iter().any(|c| near_end(c.t));
        if !same && !excused {
            return Some(format!("between {t_min} and {t_max}: {found:?} instead of {expected:?}"));
        }
    }
    None
}

#[test]
fn crossings_and_hits_agree_with_the_distance_function() {
    let mut random = Random(1);
    let (mut crossed, mut noticed) = (0, 0);
    for i in 0..12_000_u64 {
        let scale = [1.0, 1e-3, 1e6, 30.0][random.below(4) as usize];
        let center = Point3::ORIGIN + random.vector_in_ball(5.0 * scale);
        let fixture = fixture(&mut random, i % 6, center, scale);
        let from = [3.0, 100.0][random.below(2) as usize] * scale;
        let ray = ray_at(&mut random, &fixture, from);
        let mut crossings = Vec::new();
        fixture.shape.crossings(&ray, &mut crossings);
        let complaint_found = complaint(&fixture, &ray, &crossings);
        assert_eq!(complaint_found, None, "{i}: {:?} {ray:?}", fixture.shape);
        let nearest = nearest_complaint(&fixture.shape, &ray, &crossings);
        assert_eq!(nearest, None, "{i}: {:?} {ray:?} {crossings:?}", fixture.shape);
        // The twin: crossings without the first one, or with one moved, must be noticed.
        if crossings.len() >= 2 && (crossings[1].t - crossings[0].t) * ray.direction.length() > 0.1 * fixture.size {
            crossed += 1;
            let moved = Crossing { t: 0.9 * crossings[0].t + 0.1 * crossings[1].t, ..crossings[0] };
            let twins = [crossings[1..].to_vec(), [&[moved], &crossings[1..]].concat()];
            noticed += usize::from(twins.iter().all(|twin| complaint(&fixture, &ray, twin).is_some()));
        }
    }
    assert!(crossed > 4000);
    assert_eq!(noticed, crossed);
}

#[test]
fn open_frusta_are_hit_where_the_side_of_the_closed_ones_is() {
    let mut random = Random(2);
    for i in 0..4000 {
        let fixture = fixture(&mut random, 0, Point3::ORIGIN, 1.0);
        let radii = [random.unit(), if i % 2 == 0 { 0.0 } else { random.unit() }];
        let (base, top) = (Point3::ORIGIN, Point3::ORIGIN + random.direction() * 0.8);
        let [closed, open] =
            [true, false].map(|capped| Shape::Cone(Frustum::new(base, radii[0], top, radii[1], capped)));
        let ray = ray_at(&mut random, &fixture, 4.0);
        let (mut crossings, mut none) = (Vec::new(), Vec::new());
        closed.crossings(&ray, &mut crossings);
        open.crossings(&ray, &mut none);
        assert!(none.is_empty() && !open.is_solid() && !open.contains(base.lerp(top, 0.5)));
        let expected = crossings.iter().find(|c| c.part == 0 && c.t > 0.0).map(|c| c.t);
        assert_eq!(open.intersect(&ray, 0.0, f64::INFINITY).map(|hit| hit.t), expected);
    }
}

#[test]
fn flat_shapes_are_hit_within_their_borders() {
    let mut random = Random(3);
    let mut hits = 0;
    for i in 0..8000 {
        let fixture = fixture(&mut random, 6 + i % 2, Point3::new(3.0, -1.0, 0.5), 2.0);
        let ray = ray_at(&mut random, &fixture, 9.0);
        // The plane by bisection.
        let (mut low, mut high) = (1e-6, 1e5);
        let side = |t: f64| (fixture.distance)(ray.at(t)) > 0.0;
        let found = fixture.shape.intersect(&ray, 1e-6, 1e5);
        if side(low) == side(high) {
            assert!(found.is_none());
            continue;
        }
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if side(middle) == side(1e-6) {
                low = middle;
            } else {
                high = middle;
            }
        }
        let point = ray.at(low);
        let [_, v] = fixture.shape.uv(point, 0);
        let from_center = point.distance(fixture.center);
        match fixture.shape {
            Shape::Disk(_) => {
                let radius = fixture.size;
                let inside = (0.3 * radius..radius).contains(&from_center);
                let clear = (from_center - radius).abs() > 1e-6 && (from_center - 0.3 * radius).abs() > 1e-6;
                assert!(!clear || found.is_some() == inside);
                assert!(!clear || !inside || (v * 0.7 * radius + 0.3 * radius - from_center).abs() < 1e-6);
            }
            _ => assert!(found.is_none() || from_center < fixture.size),
        }
        if let Some(hit) = found {
            hits += 1;
            assert!((hit.t - low).abs() < 1e-9 * (1.0 + low));
        }
    }
    assert!(hits > 2000);
}

//! All curves of a body against what rays see of it: wherever neighbouring rays of a picture see different faces, or something
//! far behind, a curve must pass between them.

use snell_math::{Homogeneous3, Point3, Ray, Transform, Vector3};
use snell_scene::scene::CsgOperation::{self, Difference, Intersection, Union};

use super::super::{Body, Feature, FeatureKind, Form, OutlineOptions, features, intersections};
use super::{KINDS, distance_to_chords, random_placement, random_shape, samples};
use crate::csg::{CsgNode, CsgScratch, CsgSolid};
use crate::shape::Shape;
use crate::shape::tests::Random;

/// Pixels of a picture, each way.
const PIXELS: usize = 90;

/// A parallel view of a square of this half size around the origin.
pub(super) struct View {
    pub(super) towards: Vector3,
    x: Vector3,
    y: Vector3,
    half: f64,
}

/// What a ray saw: which body, leaf and part, how far, and the normal.
type Seen = Option<([u32; 3], f64, Vector3)>;

impl View {
    pub(super) fn new(towards: Vector3, half: f64) -> Self {
        let (x, y) = towards.orthonormal_basis();
        Self { towards, x, y, half }
    }

    fn pixel(&self) -> f64 {
        2.0 * self.half / PIXELS as f64
    }

    fn ray(&self, i: usize, j: usize) -> Ray {
        let at = |i: usize| (i as f64 + 0.5) * self.pixel() - self.half;
        Ray::new(Point3::ORIGIN + self.x * at(i) + self.y * at(j) + self.towards * 1e3, -self.towards)
    }

    /// Flattened along the view.
    fn flat(&self, p: Point3) -> Point3 {
        let v = p - Point3::ORIGIN;
        Point3::new(v.dot(self.x), v.dot(self.y), 0.0)
    }

    fn projected(&self, features: &[Feature]) -> Vec<Vec<Point3>> {
        let line =
            |feature: &Feature| samples(&feature.curve, 12).into_iter().map(|p| self.flat(p)).collect::<Vec<_>>();
        features.iter().filter(|feature| feature.kind != FeatureKind::Parameter).map(line).collect()
    }

    /// How many pairs of neighbours see different things with no curve between them, and how many differ.
    pub(super) fn unexplained(&self, bodies: &[Body], features: &[Feature]) -> (usize, usize) {
        let seen: Vec<Vec<Seen>> =
            (0..PIXELS).map(|i| (0..PIXELS).map(|j| see(bodies, &self.ray(i, j))).collect()).collect();
        let lines = self.projected(features);
        let (mut unexplained, mut differing) = (0, 0);
        for (i, j) in (0..PIXELS - 1).flat_map(|i| (0..PIXELS - 1).map(move |j| (i, j))) {
            for (k, l) in [(i + 1, j), (i, j + 1)] {
                if !self.differ(&seen[i][j], &seen[k][l]) {
                    continue;
                }
                differing += 1;
                let middle = self.flat(self.ray(i, j).origin).lerp(self.flat(self.ray(k, l).origin), 0.5);
                let near = lines.iter().map(|line| distance_to_chords(middle, line)).fold(f64::INFINITY, f64::min);
                unexplained += usize::from(near > 0.55 * self.pixel());
            }
        }
        (unexplained, differing)
    }

    /// Another body, a gap in depth that the slopes do not explain, or a sharp turn. Leaves and parts alone may meet smoothly.
    fn differ(&self, a: &Seen, b: &Seen) -> bool {
        let slope = |normal: &Vector3| 1.0 / normal.dot(self.towards).abs().max(1e-9);
        let (Some((a_part, a_depth, a_normal)), Some((b_part, b_depth, b_normal))) = (a, b) else {
            // A plane seen nearly edge on comes out of sight behind the rays' origins.
            return a.or(*b).is_some_and(|(_, _, normal)| slope(&normal) < 30.0);
        };
        let steepest = slope(a_normal).max(slope(b_normal));
        let is_gap = steepest < 10.0 && (a_depth - b_depth).abs() > 3.0 * steepest * self.pixel();
        a_part[0] != b_part[0] || is_gap || a_part != b_part && a_normal.dot(*b_normal) < 0.8
    }
}

/// Along no axis: planes are not seen edge on.
fn oblique(random: &mut Random) -> Vector3 {
    (random.direction() + Vector3::new(0.317, 0.241, 0.173)).normalize()
}

fn see(bodies: &[Body], ray: &Ray) -> Seen {
    let mut nearest: Seen = None;
    for (body, number) in bodies.iter().zip(0..) {
        let own = body.space_from_body.map_or(*ray, |map| map.inverse_ray(ray));
        let hit = match body.form {
            Form::Shape(shape) => shape.intersect(&own, 0.0, f64::INFINITY).map(|hit| {
                let normal = shape.surface(&own, hit).geometric_normal;
                ([number, 0, hit.part], hit.t, normal)
            }),
            Form::Solid(solid) => solid.intersect(&own, 0.0, f64::INFINITY, &mut CsgScratch::default()).map(|hit| {
                let normal = solid.surface(&own, hit).geometric_normal;
                ([number, hit.leaf, hit.part], hit.t, normal)
            }),
        };
        if let Some((part, t, normal)) = hit
            && nearest.as_ref().is_none_or(|seen| t < seen.1)
        {
            let normal = body.space_from_body.map_or(normal, |map| map.normal(normal)).normalize();
            nearest = Some((part, t, normal.as_vector()));
        }
    }
    nearest
}

pub(super) fn options() -> OutlineOptions<'static> {
    OutlineOptions { parameter_lines: 0, tolerance: &|_| 1e-3 }
}

/// A tree of two to four solids around the origin.
pub(super) fn random_solid(random: &mut Random) -> CsgSolid {
    let leaves = 2 + random.below(3) as u32;
    let mut nodes = Vec::new();
    for tag in 0..leaves {
        let kind = [0, 1, 2, 3, 4, 5][random.below(6) as usize];
        // The first one is bounded.
        let kind = if tag == 0 && kind == 1 { 2 } else { kind };
        let center = Point3::ORIGIN + random.vector_in_ball(0.5);
        let shape = random_shape(random, kind, center);
        let solid_from_leaf = (random.below(2) == 0).then(|| {
            let stretch = Vector3::new(random.range(0.6, 1.4), -random.range(0.6, 1.4), random.range(0.6, 1.4));
            Transform::rotate(random.direction(), random.range(0.0, 6.0)) * Transform::scale(stretch)
        });
        nodes.push(CsgNode::Leaf { shape, solid_from_leaf, tag });
    }
    let operation = |random: &mut Random| [Union, Intersection, Difference][random.below(3) as usize];
    if leaves == 4 {
        let halves = [[0, 1], [2, 3]].map(|children| (operation(random), children));
        for (operation, children) in halves {
            nodes.push(CsgNode::Operation { operation, children: children.to_vec() });
        }
        nodes.push(CsgNode::Operation { operation: operation(random), children: vec![4, 5] });
    } else {
        nodes.push(CsgNode::Operation { operation: operation(random), children: (0..leaves).collect() });
    }
    CsgSolid::new(nodes).expect("a tree of solids")
}

pub(super) fn solid_of(shapes: &[Shape], operation: CsgOperation) -> CsgSolid {
    let leaf = |(&shape, tag)| CsgNode::Leaf { shape, solid_from_leaf: None, tag };
    let mut nodes: Vec<CsgNode> = shapes.iter().zip(0..).map(leaf).collect();
    nodes.push(CsgNode::Operation { operation, children: (0..shapes.len() as u32).collect() });
    CsgSolid::new(nodes).expect("solids")
}

#[test]
fn every_visible_edge_of_a_solid_is_drawn() {
    let mut random = Random(61);
    let (mut differing, mut noticed) = (0, 0);
    for round in 0..150 {
        let solid = random_solid(&mut random);
        let map = random_placement(&mut random);
        let map = (random.below(2) == 0).then_some(&map);
        let body = Body { form: Form::Solid(&solid), space_from_body: map };
        let view = View::new(oblique(&mut random), 3.0);
        let mut found = features(&body, Homogeneous3::direction(view.towards), &options());
        let (unexplained, all) = view.unexplained(&[body], &found);
        assert!(
            unexplained <= all / 500,
            "{unexplained} of {all} in round {round}: {solid:?} {map:?} {:?}",
            view.towards
        );
        differing += all;
        // The twin: one curve less.
        if !found.is_empty() {
            found.remove(random.below(found.len() as u64) as usize);
            noticed += usize::from(view.unexplained(&[body], &found).0 > all / 500);
        }
    }
    assert!(differing > 12_000, "{differing}");
    assert!(noticed > 40, "{noticed}");
}

#[test]
fn every_visible_edge_between_bodies_is_drawn() {
    let mut random = Random(62);
    let (mut differing, mut noticed, mut crossed) = (0, 0, 0);
    for round in 0..240 {
        let shapes = [(); 2].map(|()| {
            let kind = random.below(KINDS);
            let center = Point3::ORIGIN + random.vector_in_ball(0.7);
            random_shape(&mut random, kind, center)
        });
        let solid = random_solid(&mut random);
        let maps = [(); 2].map(|()| {
            let stretch = Vector3::new(random.range(0.6, 1.4), 1.0, random.range(0.6, 1.4));
            Transform::rotate(random.direction(), 1.0) * Transform::scale(stretch)
        });
        let stands = |random: &mut Random, i: usize| (random.below(2) == 0).then_some(&maps[i]);
        let first = Body { form: Form::Shape(&shapes[0]), space_from_body: stands(&mut random, 0) };
        let form = if round % 3 == 0 { Form::Solid(&solid) } else { Form::Shape(&shapes[1]) };
        let second = Body { form, space_from_body: stands(&mut random, 1) };
        let view = View::new(oblique(&mut random), 3.0);
        let eye = Homogeneous3::direction(view.towards);
        let mut found = features(&first, eye, &options());
        found.extend(features(&second, eye, &options()));
        let own = found.len();
        found.extend(intersections(&first, &second, &options()));
        crossed += found.len() - own;
        let (unexplained, all) = view.unexplained(&[first, second], &found);
        assert!(
            unexplained <= all / 500,
            "{unexplained} of {all} in round {round}: {first:?} {second:?} {:?}",
            view.towards
        );
        differing += all;
        // The twin: without what they have in common.
        noticed += usize::from(view.unexplained(&[first, second], &found[..own]).0 > all / 500);
    }
    assert!(differing > 30_000 && crossed > 100, "{differing} {crossed}");
    assert!(noticed > 60, "{noticed}");
}

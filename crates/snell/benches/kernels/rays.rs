//! The rays: read from files, or made.
//!
//! A ray in a file is eight little-endian `f32`: origin, direction, largest distance, expected distance (infinite where nothing is
//! hit; for a shadow ray 0 where it is blocked). The files are PREFIX.primary, .bounce1, .bounce2 and .shadow.

use std::path::Path;

use snell::math::{Point3, Ray, Vector3, portable};
use snell::shape::triangle_mesh::TriangleMesh;

/// What is asked of a ray.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Question {
    Closest,
    Any,
}

/// Rays of one kind.
pub struct RaySet {
    pub name: &'static str,
    pub question: Question,
    pub rays: Vec<Ray>,
    pub t_max: Vec<f64>,
    expected: Vec<f32>,
}

impl RaySet {
    fn new(name: &'static str, question: Question) -> Self {
        Self { name, question, rays: Vec::new(), t_max: Vec::new(), expected: Vec::new() }
    }

    fn push(&mut self, ray: Ray, t_max: f64, expected: f32) {
        self.rays.push(ray);
        self.t_max.push(t_max);
        self.expected.push(expected);
    }

    /// How many answers are not those expected, roundings of `f32` aside.
    pub fn count_different(&self, answers: &[f32]) -> usize {
        let differs = |answer: f32, expected: f32| {
            let (hits, should_hit) = (answer < f32::INFINITY, expected < f32::INFINITY);
            hits != should_hit || hits && (answer - expected).abs() > 2e-4 * expected.max(0.05)
        };
        answers.iter().zip(&self.expected).filter(|(answer, expected)| differs(**answer, **expected)).count()
    }
}

fn sets() -> [RaySet; 4] {
    [
        RaySet::new("primary", Question::Closest),
        RaySet::new("bounce1", Question::Closest),
        RaySet::new("bounce2", Question::Closest),
        RaySet::new("shadow", Question::Any),
    ]
}

/// All sets, from files; at most so many rays of each.
pub fn read_all(prefix: &Path, limit: usize) -> Result<Vec<RaySet>, String> {
    sets()
        .into_iter()
        .map(|mut set| {
            let file = format!("{}.{}", prefix.display(), set.name);
            let bytes = std::fs::read(&file).map_err(|error| format!("{file}: {error}"))?;
            let (numbers, _) = bytes.as_chunks::<4>();
            let numbers: Vec<f32> = numbers.iter().map(|number| f32::from_le_bytes(*number)).collect();
            // Where not all are wanted, tiles from all over the picture.
            let tiles: Vec<&[[f32; 8]]> = numbers.as_chunks::<8>().0.chunks(TILE).collect();
            let stride = tiles.len().div_ceil(limit.div_ceil(TILE)).max(1);
            for ray in tiles.iter().step_by(stride).copied().flatten().take(limit) {
                let [x, y, z, dx, dy, dz, largest, expected] = *ray;
                let [x, y, z, dx, dy, dz] = [x, y, z, dx, dy, dz].map(f64::from);
                let ray = Ray::new(Point3::new(x, y, z), Vector3::new(dx, dy, dz));
                set.push(ray, f64::from(largest), expected);
            }
            Ok(set)
        })
        .collect()
}

/// How many rays are near each other in a file.
const TILE: usize = 64;

/// How far above a surface rays begin, relative to the size of everything.
const LIFT: f64 = 2e-5;

/// All sets for a mesh in a room, `count` rays each, or as many as come of sixteen pictures.
pub fn make_all(mesh: &TriangleMesh, count: usize) -> Vec<RaySet> {
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    let bounds = mesh.bounds();
    let (center, size) = (bounds.center(), bounds.diagonal());
    let lift = LIFT * size.max_abs();
    // From a corner of the room, a little above the middle, at the thing in it; a square light under the ceiling.
    let at = |x: f64, y: f64, z: f64| center + Vector3::new(x * size.x(), y * size.y(), z * size.z());
    let (eye, target, light) = (at(0.22, -0.1, 0.38), at(0.0, -0.25, 0.0), at(0.12, 0.45, 0.16));
    let ahead = (target - eye).normalize();
    let right = ahead.cross(Vector3::Y).normalize();
    let up = right.cross(ahead);
    let edge = ((count as f64).sqrt() as usize).next_multiple_of(8);
    let [mut primary, mut bounce1, mut bounce2, mut shadow] = sets();
    for pass in 0..16 {
        if pass > 0 && bounce1.rays.len().min(bounce2.rays.len()).min(shadow.rays.len()) >= count {
            break;
        }
        for index in 0..edge * edge {
            // Tiles of 8 x 8, so that rays that follow each other are near each other.
            let (tile, inside, tiles) = (index / 64, index % 64, edge / 8);
            let (mut x, mut y) = ((tile % tiles * 8 + inside % 8) as f64, (tile / tiles * 8 + inside / 8) as f64);
            if pass == 0 {
                (x, y) = (x + 0.5, y + 0.5);
            } else {
                (x, y) = (x + random.number(), y + random.number());
            }
            let (across, along) = (2.0 * x / edge as f64 - 1.0, 1.0 - 2.0 * y / edge as f64);
            let ray = Ray::new(eye, (ahead + right * (0.52 * across) + up * (0.52 * along)).normalize());
            let (distance, surface) = follow(mesh, &ray, lift);
            if pass == 0 && primary.rays.len() < count {
                primary.push(ray, f64::INFINITY, distance);
            }
            let Some((point, normal)) = surface else { continue };
            let spread = |x: f64| 0.1 * size.max_abs() * (2.0 * x - 1.0);
            let way = light + Vector3::new(spread(random.number()), 0.0, spread(random.number())) - point;
            if shadow.rays.len() < count && way.dot(normal) > 0.0 {
                let ray = Ray::new(point, way.normalize());
                let t_max = 0.999 * way.length();
                let expected = if mesh.any(&ray, 0.0, t_max) { 0.0 } else { f32::INFINITY };
                shadow.push(ray, t_max, expected);
            }
            let ray = Ray::new(point, scattered(&mut random, normal));
            let (distance, surface) = follow(mesh, &ray, lift);
            if bounce1.rays.len() < count {
                bounce1.push(ray, f64::INFINITY, distance);
            }
            let Some((point, normal)) = surface.filter(|_| bounce2.rays.len() < count) else { continue };
            let ray = Ray::new(point, scattered(&mut random, normal));
            bounce2.push(ray, f64::INFINITY, follow(mesh, &ray, lift).0);
        }
    }
    vec![primary, bounce1, bounce2, shadow]
}

/// How far a ray goes, and the point a little above the surface that it meets, with the normal on the ray's side.
fn follow(mesh: &TriangleMesh, ray: &Ray, lift: f64) -> (f32, Option<(Point3, Vector3)>) {
    let Some(hit) = mesh.intersect(ray, 0.0, f64::INFINITY) else { return (f32::INFINITY, None) };
    let surface = mesh.surface(ray, &hit);
    let normal = surface.geometric_normal.as_vector();
    let normal = if normal.dot(ray.direction) > 0.0 { -normal } else { normal };
    (hit.t as f32, Some((surface.point + normal * lift, normal)))
}

/// A direction about the normal, as likely as its cosine.
fn scattered(random: &mut Random, normal: Vector3) -> Vector3 {
    let (angle, z) = (std::f64::consts::TAU * random.number(), 2.0 * random.number() - 1.0);
    let radius = (1.0 - z * z).max(0.0).sqrt();
    let sphere = Vector3::new(radius * portable::cos(angle), radius * portable::sin(angle), z);
    (normal + sphere * 0.9999).normalize()
}

/// Marsaglia's xorshift.
struct Random(u64);

impl Random {
    /// From 0 up to 1.
    fn number(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

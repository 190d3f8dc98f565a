//! Rays through a real lens: from a place of the film through every surface to the world, at one wavelength.
//!
//! Follows: Kolb, Mitchell and Hanrahan, "A Realistic Camera Model for Computer Graphics", SIGGRAPH 1995, and Pharr, Jakob and
//! Humphreys, "Physically Based Rendering", 4th edition, section 5.4 of the third: rays are sent to that part of the last surface through which
//! the stop is seen from their place of the film, which is found beforehand.
//!
//! Here the lens is in its own coordinates, in millimetres: x and y as the camera's right and up, z along its gaze, the vertex of the
//! last surface at 0, the film behind it at −`film_distance`.
//!
//! What a place of the film receives is ∫ L cos⁴θ / d² dA over the plane through the last vertex, at distance d (Smith, "Modern Optical
//! Engineering", section 9.6). It is told relative to what the middle of the film receives of a white world at the helium d line, so that a
//! picture is as bright as with a thin lens, and darker towards its corners, as real ones are.

use std::f64::consts::PI;

use rayon::prelude::*;
use snell_math::dispersion::fraunhofer::{HELIUM_D, MERCURY_G};
use snell_math::{Dispersion, Point3, Ray, Vector3, portable};
use snell_scene::scene::{LensSurface, LensSystem};

/// In so many rings of the film the part of the last surface that sees the stop is kept.
const RINGS: usize = 64;
/// That part is found by rays through a grid of so many cells, again and again in what was found.
const CELLS: usize = 32;
const ROUNDS: usize = 3;
/// The wavelengths for which it is found: between them is what is seen of nearly all light.
const PUPIL_NM: [f64; 2] = [MERCURY_G, 700.0];

/// A real lens in front of a camera, ready to be traced.
///
/// ```
/// use snell::camera::Camera;
/// use snell::scene::{assets::MemoryAssets, document::read_scene, scene::PixelGrid};
/// let text = b"unit = 'cm'\n[camera]\nlook_at = [0, 0, -95]\nlens = 'double-gauss'\n";
/// let scene = read_scene("a.toml", text, &MemoryAssets::default(), &[]).0.unwrap();
/// let camera = Camera::new(&scene.camera, 36, 24, PixelGrid::Centers).unwrap();
/// let lens = camera.real_lens().unwrap();
/// let (ray, weight) = lens.ray([18.0, 12.0], [0.5, 0.5], 550.0).unwrap();
/// // Through the middle of the lens to the middle of what is sharp.
/// assert!(ray.at(100.0).x().abs() < 0.1 && weight > 0.9);
/// ```
#[derive(Clone, Debug)]
pub struct RealLens {
    /// From the film to the world.
    surfaces: Vec<Surface>,
    stop: Stop,
    /// How far the film is behind the last vertex.
    film_distance: f64,
    /// For each ring of the film, the part of the plane through the last vertex that sees the stop from the ring's places on the x axis.
    pupils: Vec<Option<Pupil>>,
    /// The radius of all rings together.
    film_radius: f64,
    /// What the middle of the film receives of a white world.
    irradiance: f64,
    disperses: bool,
    frame: LensFrame,
}

/// Where the lens is in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LensFrame {
    /// The vertex of the last surface.
    pub origin: Point3,
    /// Right, up and back, unit length.
    pub axes: [Vector3; 3],
    /// How long a millimetre is in the world.
    pub millimetre: f64,
    /// A place of the film, in millimetres, by raster coordinates: for x and for y, what they are multiplied by, and what is added.
    pub film_from_raster: [[f64; 2]; 2],
}

/// A surface as rays from the film meet it.
#[derive(Clone, Debug)]
struct Surface {
    /// Where its vertex is.
    z: f64,
    /// One over its radius: positive where the centre lies towards the film.
    curvature: f64,
    clear_radius_squared: f64,
    is_stop: bool,
    /// The index in front of it.
    front: Dispersion,
}

/// How far the stop is open.
#[derive(Clone, Debug)]
struct Stop {
    radius: f64,
    /// The normals of its blades' edges.
    edges: Vec<[f64; 2]>,
    /// How far the edges are from the axis.
    apothem: f64,
}

/// A rectangle of the plane through the last vertex, about the x axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pupil {
    left: f64,
    right: f64,
    half_height: f64,
}

/// Which rays the stop lets pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shape {
    /// Those within its blades.
    Blades,
    /// Those within the circle around the blades, which is the same all around.
    Round,
}

impl RealLens {
    /// For a lens in the world, and the film's size in millimetres.
    pub(super) fn new(lens: &LensSystem, frame: LensFrame, film: [f64; 2]) -> Self {
        let LensSystem { prescription, stop_radius, blades, film_distance, .. } = lens;
        let listed = &prescription.surfaces;
        let mut z = 0.0;
        let mut surfaces = Vec::with_capacity(listed.len());
        for (number, surface) in listed.iter().enumerate().rev() {
            let LensSurface { radius, clear_radius, .. } = surface;
            if number + 1 < listed.len() {
                z += surface.thickness;
            }
            let front = number.checked_sub(1).map_or(Dispersion::Constant(1.0), |before| listed[before].behind.clone());
            surfaces.push(Surface {
                z,
                curvature: 1.0 / radius,
                clear_radius_squared: clear_radius * clear_radius,
                is_stop: number == prescription.stop,
                front,
            });
        }
        let stop = Stop::new(*stop_radius, *blades);
        let disperses = listed.iter().any(|surface| surface.behind.is_dispersive());
        let film_radius = 0.5 * length(film);
        let mut lens = Self {
            surfaces,
            stop,
            film_distance: *film_distance,
            pupils: Vec::new(),
            film_radius,
            irradiance: 0.0,
            disperses,
            frame,
        };
        lens.irradiance = lens.axial_irradiance();
        lens.pupils = lens.find_pupils();
        lens
    }

    /// True where wavelengths go different ways through it.
    #[inline]
    pub fn disperses(&self) -> bool {
        self.disperses
    }

    /// What the middle of the film receives of a world of radiance 1 with the stop's circle open, in units of that radiance. For a
    /// lens that is well corrected and focused far away it is π / (4 N²) by Abbe's sine condition, N being the f-number.
    pub fn axial_irradiance(&self) -> f64 {
        let half = self.first_grid();
        let passes = |height: f64| self.trace([0.0, 0.0], [height, 0.0], HELIUM_D, Shape::Round).is_some();
        // The first height that does not pass, and the border before it.
        let Some(first) = (1..=8 * CELLS).map(|i| half * i as f64 / (8 * CELLS) as f64).find(|height| !passes(*height))
        else {
            return PI * sine_squared(half, self.film_distance);
        };
        let (mut inside, mut outside) = (first - half / (8 * CELLS) as f64, first);
        for _ in 0..60 {
            let middle = 0.5 * (inside + outside);
            if passes(middle) { inside = middle } else { outside = middle }
        }
        PI * sine_squared(inside, self.film_distance)
    }

    /// The ray through a raster position at a wavelength in nanometres, by two numbers in [0, 1) for the way through the lens, and the
    /// weight of the radiance that it finds; `None` for a way on which no light comes through.
    ///
    /// Over all numbers the mean weight is what the place receives of a white world, 1 in the middle of the picture.
    #[inline]
    pub fn ray(&self, [x, y]: [f64; 2], [u, v]: [f64; 2], wavelength_nm: f64) -> Option<(Ray, f64)> {
        let [[ax, bx], [ay, by]] = self.frame.film_from_raster;
        let film = [ax * x + bx, ay * y + by];
        let radius = length(film);
        let ring = ((radius / self.film_radius * RINGS as f64) as usize).min(RINGS - 1);
        let pupil = self.pupils[ring]?;
        let [cosine, sine] = if radius > 0.0 { film.map(|x| x / radius) } else { [1.0, 0.0] };
        let (along, across) = (pupil.left + u * (pupil.right - pupil.left), (2.0 * v - 1.0) * pupil.half_height);
        let place = [cosine * along - sine * across, sine * along + cosine * across];
        let (origin, direction) = self.trace(film, place, wavelength_nm, Shape::Blades)?;
        let (dx, dy, d) = (place[0] - film[0], place[1] - film[1], self.film_distance);
        let distance_squared = dx * dx + dy * dy + d * d;
        // cos⁴θ / d² with cos²θ = d² / distance².
        let falloff = d * d / (distance_squared * distance_squared);
        let weight = falloff * pupil.area() / (self.irradiance * self.stop.open_share());
        Some((self.in_world(origin, direction), weight))
    }

    /// From a place of the film through a place of the plane through the last vertex to the world; `None` where a rim or the stop is in
    /// the way, or light is reflected totally.
    #[inline]
    fn trace(&self, film: [f64; 2], place: [f64; 2], wavelength_nm: f64, shape: Shape) -> Option<(Vector3, Vector3)> {
        let mut origin = Vector3::new(film[0], film[1], -self.film_distance);
        let to_place = Vector3::new(place[0] - film[0], place[1] - film[1], self.film_distance);
        let length = to_place.length();
        let mut direction = Vector3::from(to_place.to_array().map(|x| x / length));
        let mut before = 1.0;
        for surface in &self.surfaces {
            let Surface { z, curvature, clear_radius_squared, is_stop, front } = surface;
            // From the vertex, and without a difference of like numbers: c t² + 2 b t + k = 0, whose root at the vertex is
            // finite for a flat surface too.
            let from_vertex = origin - Vector3::Z * *z;
            let b = curvature * from_vertex.dot(direction) + direction.z();
            let k = curvature * from_vertex.dot(from_vertex) + 2.0 * from_vertex.z();
            let discriminant = b * b - curvature * k;
            if discriminant < 0.0 {
                return None;
            }
            let t = -k / (b + discriminant.sqrt());
            let met = from_vertex + direction * t;
            let [x, y, _] = met.to_array();
            if x * x + y * y > *clear_radius_squared || *is_stop && !self.stop.passes([x, y], shape) {
                return None;
            }
            let normal = met * *curvature + Vector3::Z;
            let beyond = front.index(wavelength_nm);
            if beyond != before {
                let eta = before / beyond;
                let cosine = direction.dot(normal);
                let refracted_squared = 1.0 - eta * eta * (1.0 - cosine * cosine);
                if cosine <= 0.0 || refracted_squared < 0.0 {
                    return None;
                }
                let turn = refracted_squared.sqrt() - eta * cosine;
                direction = direction * eta + normal * turn;
            }
            origin = met + Vector3::Z * *z;
            before = beyond;
        }
        Some((origin, direction))
    }

    /// Half the side of the square of the plane through the last vertex in which the stop is looked for: what a surface's rim is seen
    /// under lies well within.
    fn first_grid(&self) -> f64 {
        2.0 * self.surfaces[0].clear_radius_squared.sqrt()
    }

    /// Where each ring of the film sees the stop.
    fn find_pupils(&self) -> Vec<Option<Pupil>> {
        let at = |number: usize| self.pupil_from(self.film_radius * number as f64 / (2 * RINGS) as f64);
        let pupils: Vec<Option<Pupil>> = (0..=2 * RINGS).into_par_iter().map(at).collect();
        let join = |ring: usize| pupils[2 * ring..=2 * ring + 2].iter().copied().flatten().reduce(Pupil::union);
        (0..RINGS).map(join).collect()
    }

    /// Where the stop is seen from a place of the film on the x axis, with a margin of a cell of the finest grid.
    fn pupil_from(&self, radius: f64) -> Option<Pupil> {
        let half = self.first_grid();
        let mut found = Pupil { left: -half, right: half, half_height: half };
        for round in 0..ROUNDS {
            let grid = |cells| self.pupil_within(&found, radius, cells);
            // A stop that is nearly closed falls between the places of a coarse grid.
            let narrower = grid(CELLS).or_else(|| if round == 0 { grid(16 * CELLS) } else { None });
            found = narrower?;
        }
        Some(found)
    }

    /// The part of a rectangle through which rays come, as far as a grid tells, with a cell around.
    fn pupil_within(&self, within: &Pupil, radius: f64, cells: usize) -> Option<Pupil> {
        let width = (within.right - within.left) / cells as f64;
        // The lens is the same above and below the x axis.
        let rows = cells / 2;
        let height = within.half_height / rows as f64;
        let mut found: Option<Pupil> = None;
        for row in 0..rows {
            for column in 0..cells {
                let x = within.left + width * (column as f64 + 0.5);
                let y = height * (row as f64 + 0.5);
                let passes = |nm: &f64| self.trace([radius, 0.0], [x, y], *nm, Shape::Round).is_some();
                if PUPIL_NM.iter().any(passes) {
                    let cell = Pupil {
                        left: (x - 1.5 * width).max(within.left),
                        right: (x + 1.5 * width).min(within.right),
                        half_height: (y + 1.5 * height).min(within.half_height),
                    };
                    found = Some(found.map_or(cell, |found| found.union(cell)));
                }
            }
        }
        found
    }

    /// A ray of the lens's coordinates in the world.
    fn in_world(&self, origin: Vector3, direction: Vector3) -> Ray {
        let LensFrame { origin: vertex, axes: [right, up, back], millimetre, .. } = self.frame;
        let vector = |v: Vector3| right * v.x() + up * v.y() - back * v.z();
        Ray::new(vertex + vector(origin) * millimetre, vector(direction).normalize())
    }
}

impl Pupil {
    fn area(&self) -> f64 {
        2.0 * self.half_height * (self.right - self.left)
    }

    fn union(self, other: Self) -> Self {
        Self {
            left: self.left.min(other.left),
            right: self.right.max(other.right),
            half_height: self.half_height.max(other.half_height),
        }
    }
}

impl Stop {
    fn new(radius: f64, blades: u32) -> Self {
        if blades < 3 {
            return Self { radius, edges: Vec::new(), apothem: radius };
        }
        let edge = |number: u32| {
            let angle = PI * f64::from(2 * number + 1) / f64::from(blades);
            [portable::cos(angle), portable::sin(angle)]
        };
        Self { radius, edges: (0..blades).map(edge).collect(), apothem: radius * portable::cos(PI / f64::from(blades)) }
    }

    /// True for a place that is open.
    #[inline]
    fn passes(&self, [x, y]: [f64; 2], shape: Shape) -> bool {
        x * x + y * y <= self.radius * self.radius
            && (shape == Shape::Round || self.edges.iter().all(|[a, b]| a * x + b * y <= self.apothem))
    }

    /// The area within its blades over that of the circle around them.
    fn open_share(&self) -> f64 {
        if self.edges.is_empty() {
            return 1.0;
        }
        let blades = self.edges.len() as f64;
        blades * portable::sin(2.0 * PI / blades) / (2.0 * PI)
    }
}

/// sin²θ of a ray from the axis to a height at a distance.
fn sine_squared(height: f64, distance: f64) -> f64 {
    height * height / (height * height + distance * distance)
}

fn length([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}

#[cfg(test)]
#[path = "lens_tests.rs"]
mod tests;

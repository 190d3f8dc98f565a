//! Photons where they fell, in cells, and what is made of those around a place: on surfaces from a disk, in media from a ball.

use rayon::prelude::*;
use snell_math::warp::henyey_greenstein_density;
use snell_math::{Point3, Vector3};

use super::lobes::{Lobes, Transport};
use super::sample::Gathers;
use super::spectra::{BLACK, Spectral, Wavelengths, plus, scaled, times};
use crate::interaction::SurfaceInteraction;

/// A photon where it fell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Photon {
    pub point: [f32; 3],
    /// Where it was going.
    pub direction: [f32; 3],
    /// The outward normal of the surface; zero in a medium.
    pub normal: [f32; 3],
    pub power: [f32; 4],
    /// See [`Emitted::density`].
    pub density: f32,
    /// It carries its hero alone, four times.
    pub hero_alone: bool,
}

/// The photons of one pass.
#[derive(Debug)]
pub struct PhotonMap {
    on_surfaces: Cells,
    in_media: Cells,
    /// N π r², of those that set out.
    disks: f64,
    /// N 4/3 π r³, of the radius in media.
    balls: f64,
    /// Theirs, and those of all paths of the pass.
    wavelengths: Wavelengths,
}

/// Photons in the order of their cells.
#[derive(Debug)]
struct Cells {
    photons: Vec<Photon>,
    /// Where each cell's begin; one more for the end.
    starts: Vec<u32>,
    radius: f64,
}

impl PhotonMap {
    /// Of photons on surfaces and in media with the radii to gather them from, of so many that set out.
    pub(super) fn new(photons: [Vec<Photon>; 2], radii: [f64; 2], count: u32, wavelengths: Wavelengths) -> Self {
        let [on_surfaces, in_media] = photons;
        let [disk, ball] = radii;
        let count = f64::from(count);
        Self {
            on_surfaces: Cells::new(on_surfaces, disk),
            in_media: Cells::new(in_media, ball),
            disks: count * std::f64::consts::PI * disk * disk,
            balls: count * (4.0 / 3.0) * std::f64::consts::PI * ball * ball * ball,
            wavelengths,
        }
    }

    /// The wavelengths of the pass.
    pub fn wavelengths(&self) -> &Wavelengths {
        &self.wavelengths
    }

    /// The weight of light that a path found by itself, which photons may have found too: `density` is that with which light sets out
    /// (as it is kept with photons), `sent` is that of the path where it was sent on.
    pub fn weight_of_path(&self, density: f64, gathers: Gathers, sent: f64) -> f64 {
        let met = match gathers {
            Gathers::Disk { cosine } => self.disks * cosine,
            Gathers::Ball { extinction } => self.balls * extinction,
        };
        1.0 / (1.0 + met * density / sent)
    }

    /// What the photons around a place make of the surface there, seen along a path.
    pub fn gather(&self, interaction: &SurfaceInteraction, lobes: &Lobes<'_>, hero_alone: bool) -> Spectral {
        let mut sum = BLACK;
        let normal = interaction.geometric_normal.as_vector();
        self.on_surfaces.around(interaction.point, |photon| {
            // Not around corners.
            if vector(photon.normal).dot(normal) < 0.5 {
                return;
            }
            let wi = -vector(photon.direction);
            let (value, sent) = lobes.evaluate(wi, Transport::Radiance);
            if sent <= 0.0 {
                return;
            }
            let cosine = lobes.flat_cosine(wi).abs();
            let weight = weight_of_photon(self.disks * f64::from(photon.density) * cosine / sent);
            let light = times(value, photon.power_for(hero_alone));
            sum = plus(sum, scaled(light, weight / (cosine * self.disks)));
        });
        sum
    }

    /// What the photons around a place in a medium send on to a path that goes `forward`, over what the medium scatters: its phase function's mean
    /// cosine, and the mean of what it takes away.
    pub fn gather_in_medium(
        &self,
        point: Point3,
        forward: Vector3,
        anisotropy: f64,
        extinction: f64,
        hero_alone: bool,
    ) -> Spectral {
        let mut sum = BLACK;
        self.in_media.around(point, |photon| {
            let sent = henyey_greenstein_density(-forward.dot(vector(photon.direction)), anisotropy);
            let weight = weight_of_photon(self.balls * f64::from(photon.density) * extinction / sent);
            sum = plus(sum, scaled(photon.power_for(hero_alone), sent * weight / self.balls));
        });
        sum
    }
}

/// By the ratio of densities; 1 where no path meets the light.
fn weight_of_photon(ratio: f64) -> f64 {
    if ratio.is_finite() { ratio / (1.0 + ratio) } else { 1.0 }
}

impl Photon {
    /// Its power for a path. Where both have given up the other wavelengths, the hero counts four times, not sixteen.
    fn power_for(&self, hero_alone: bool) -> Spectral {
        let power = self.power.map(f64::from);
        if hero_alone && self.hero_alone { scaled(power, 0.25) } else { power }
    }
}

impl Cells {
    fn new(photons: Vec<Photon>, radius: f64) -> Self {
        let cells = photons.len().next_power_of_two().max(2);
        let size = 2.0 * radius;
        let mut keyed: Vec<(u32, Photon)> =
            photons.par_iter().map(|photon| (cell(coordinates(place(photon.point), size), cells), *photon)).collect();
        // Photons of one cell stay in the order in which they set out.
        keyed.par_sort_by_key(|(cell, _)| *cell);
        let mut starts = vec![0; cells + 1];
        for (cell, _) in &keyed {
            starts[*cell as usize + 1] += 1;
        }
        for cell in 0..cells {
            starts[cell + 1] += starts[cell];
        }
        let photons = keyed.into_iter().map(|(_, photon)| photon).collect();
        Self { photons, starts, radius }
    }

    /// Shows all that are within the radius of a point.
    #[inline]
    fn around(&self, point: Point3, mut show: impl FnMut(&Photon)) {
        if self.photons.is_empty() {
            return;
        }
        let size = 2.0 * self.radius;
        let cells = self.starts.len() - 1;
        // The ball touches the cells around its corner: two in each direction.
        let low = coordinates(point - Vector3::new(self.radius, self.radius, self.radius), size);
        let mut seen = [u32::MAX; 8];
        for corner in 0..8 {
            let at = std::array::from_fn(|axis| low[axis].wrapping_add((corner >> axis) & 1));
            let cell = cell(at, cells);
            if seen[..corner as usize].contains(&cell) {
                continue;
            }
            seen[corner as usize] = cell;
            let range = self.starts[cell as usize] as usize..self.starts[cell as usize + 1] as usize;
            for photon in &self.photons[range] {
                if (place(photon.point) - point).length_squared() <= self.radius * self.radius {
                    show(photon);
                }
            }
        }
    }
}

/// The cell of a place.
fn coordinates(point: Point3, size: f64) -> [i64; 3] {
    point.to_array().map(|x| {
        let cell = (x / size).floor();
        // Saturates, which puts what is very far away into few cells.
        cell as i64
    })
}

/// The place of a cell in a table whose size is a power of two. (Teschner et al., "Optimized Spatial Hashing", VMV 2003.)
fn cell([x, y, z]: [i64; 3], cells: usize) -> u32 {
    let mixed = (x.wrapping_mul(73_856_093)) ^ (y.wrapping_mul(19_349_663)) ^ (z.wrapping_mul(83_492_791));
    let mixed = mixed as u64 ^ (mixed as u64 >> 17);
    (mixed & (cells as u64 - 1)) as u32
}

/// As a point.
pub(super) fn place(point: [f32; 3]) -> Point3 {
    Point3::from(point.map(f64::from))
}

fn vector(v: [f32; 3]) -> Vector3 {
    Vector3::from(v.map(f64::from))
}

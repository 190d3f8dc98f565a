//! The meshes: from a file, or a bumpy sphere; and the room around them.

use std::path::Path;

use snell::math::{Bounds3, Point3, portable};
use snell_scene::scene::Mesh;
use snell_scene::{Diagnostics, assets::MemoryAssets, reader};

/// Reads a mesh of any format that we read.
pub fn read(file: &Path) -> Result<Mesh, String> {
    let bytes = std::fs::read(file).map_err(|error| format!("{}: {error}", file.display()))?;
    let mut diagnostics = Diagnostics::default();
    let name = file.to_string_lossy();
    let mesh = reader::read_mesh(&name, &bytes, &MemoryAssets::default(), &mut diagnostics);
    let reason = || diagnostics.list.first().map_or("it has no triangle".to_owned(), |first| first.message.clone());
    mesh.map(|file| file.mesh).ok_or_else(|| format!("{name}: {}", reason()))
}

/// A sphere of radius 1 or so with waves on it, of about so many triangles of about the same size.
pub fn bumpy_sphere(triangles: usize) -> Mesh {
    let rings = ((triangles as f64 / 4.0).sqrt().ceil() as u32).max(2);
    let around = 2 * rings;
    let mut mesh = Mesh::default();
    for i in 0..=rings {
        let latitude = std::f64::consts::PI * f64::from(i) / f64::from(rings);
        for j in 0..around {
            let longitude = std::f64::consts::TAU * f64::from(j) / f64::from(around);
            let wave = portable::sin(17.0 * latitude) * portable::sin(23.0 * longitude);
            let radius = 1.0 + 0.05 * wave * portable::sin(latitude);
            let out = radius * portable::sin(latitude);
            let point =
                [out * portable::cos(longitude), radius * portable::cos(latitude), out * portable::sin(longitude)];
            mesh.positions.push(point.map(|x| x as f32));
        }
    }
    for i in 0..rings {
        for j in 0..around {
            let [a, b] = [i * around + j, i * around + (j + 1) % around];
            mesh.triangles.extend([[a, b, b + around], [a, b + around, a + around]]);
        }
    }
    mesh
}

/// Puts a mesh into a box of twelve triangles, some two and a half times as large, on whose floor it stands.
pub fn put_into_a_room(mesh: &mut Mesh) {
    let bounds = bounds(mesh);
    let (center, half) = (bounds.center(), bounds.diagonal().max_abs() * 1.25);
    let low = Point3::new(center.x() - half, bounds.min.y(), center.z() - half);
    let high = Point3::new(center.x() + half, bounds.min.y() + 1.2 * half, center.z() + half);
    let room = Bounds3::new(low, high);
    let first = mesh.positions.len() as u32;
    mesh.positions.extend((0..8).map(|corner| room.corner(corner).to_array().map(|x| x as f32)));
    // Of each pair of opposite sides, four corners in turn.
    for [a, b, c, d] in [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]] {
        mesh.triangles.extend([[a, b, c], [a, c, d]].map(|triangle| triangle.map(|corner: u32| first + corner)));
    }
    // What is listed for vertices or triangles is not needed here.
    let (positions, triangles) = (std::mem::take(&mut mesh.positions), std::mem::take(&mut mesh.triangles));
    *mesh = Mesh { positions, triangles, ..Mesh::default() };
}

fn bounds(mesh: &Mesh) -> Bounds3 {
    let point = |p: &[f32; 3]| Point3::from(p.map(f64::from));
    mesh.positions.iter().fold(Bounds3::EMPTY, |bounds, position| bounds.including(point(position)))
}

//! PLY, the Stanford polygon format: ascii, binary of either byte order.
//!
//! After Greg Turk's "The PLY Polygon File Format" (1994) and the habits of MeshLab, Blender and happly: positions x, y, z;
//! normals nx, ny, nz; texture coordinates as s t, u v or texture_u texture_v; colours red green blue (bytes and shorts are
//! sRGB-encoded, floating-point numbers scene-linear); faces as lists `vertex_indices` or `vertex_index` of any integer
//! type; triangle strips. Everything else is skipped. Coordinates are taken as they are, without units.
//!
//! Our own and not a library's: the crates at hand build a map of values a row, which takes seconds and gigabytes for a
//! million triangles, and trust the counts of the header.

mod body;
mod header;
mod source;

use snell_math::color::srgb_to_linear;

use super::mesh_file::MeshFile;
use super::normals::repair_normals;
use super::polygon::Triangulator;
use super::report::Report;
use crate::diagnostic::Diagnostic;
use crate::scene::Mesh;
use header::Format;
use source::{Ascii, Binary};

/// Reads a PLY file; problems go to the report.
pub(super) fn read(report: &mut Report<'_>) -> Option<MeshFile> {
    let header = header::read(report)?;
    let data = match header.format {
        Format::Ascii => body::read(&header, &mut Ascii::new(report.bytes, header.data), report)?,
        Format::LittleEndian => body::read(&header, &mut Binary::<false>::new(report.bytes, header.data), report)?,
        Format::BigEndian => body::read(&header, &mut Binary::<true>::new(report.bytes, header.data), report)?,
    };
    finish(data, report)
}

/// What the body gave, faces not yet cut into triangles.
#[derive(Clone, Debug, Default, PartialEq)]
struct Data {
    mesh: Mesh,
    /// The corners of all faces, one face after the other, and how many each has.
    corners: Vec<u32>,
    sizes: Vec<u32>,
    /// Triangles of strips.
    strips: Vec<[u32; 3]>,
}

/// Cuts faces into triangles.
fn finish(data: Data, report: &mut Report<'_>) -> Option<MeshFile> {
    let Data { mut mesh, corners, sizes, strips } = data;
    mesh.triangles.reserve(sizes.len() + strips.len());
    let mut triangulator = Triangulator::default();
    let mut cut = Vec::new();
    let mut start = 0;
    for &size in &sizes {
        let face = &corners[start..start + size as usize];
        start += size as usize;
        if let &[a, b, c] = face {
            mesh.triangles.push([a, b, c]);
            continue;
        }
        cut.clear();
        let points = face.iter().map(|&v| mesh.positions[v as usize].map(f64::from));
        if let Err(error) = triangulator.triangulate(points, &mut cut) {
            report.whole("faces", || Diagnostic::error(error.to_string()));
            return None;
        }
        mesh.triangles.extend(cut.iter().map(|t| t.map(|i| face[i as usize])));
    }
    mesh.triangles.extend(strips);
    if !mesh.normals.is_empty() {
        let broken = repair_normals(&mut mesh);
        if broken > 0 {
            let message = format!("{broken} normals are zero or not finite: computed from the faces around");
            report.whole("normals", || Diagnostic::warning(message));
        }
    }
    Some(MeshFile { mesh, ..MeshFile::default() })
}

/// A colour's component as read to scene-linear.
fn linear(value: f64, scalar: header::Scalar) -> f32 {
    use header::Scalar;
    let encoded_by = match scalar {
        Scalar::I8 | Scalar::U8 => 255.0,
        Scalar::I16 | Scalar::U16 => 65535.0,
        Scalar::I32 | Scalar::U32 => f64::from(u32::MAX),
        Scalar::F32 | Scalar::F64 => return value.max(0.0) as f32,
    };
    srgb_to_linear((value / encoded_by).clamp(0.0, 1.0) as f32)
}

#[cfg(test)]
mod plain_tests;
#[cfg(test)]
mod tests;

//! Readers for other people's formats, from bytes: meshes (PLY, OBJ with MTL, STL) and whole scenes (NFF).
//!
//! All of them tell everything that is wrong at once, with line and column in text and with the byte in binary data; none
//! panics, hangs, or allocates more than the bytes that are really there ask for. Coordinates keep the file's units and
//! axes; colours become scene-linear.
//!
//! ```
//! use snell_scene::{Diagnostics, assets::MemoryAssets, reader};
//! let bytes = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 9\n";
//! let mut diagnostics = Diagnostics::default();
//! assert!(reader::read_mesh("a.obj", bytes, &MemoryAssets::default(), &mut diagnostics).is_none());
//! let (place, _) = diagnostics.list[0].place.clone().unwrap();
//! assert_eq!(diagnostics.sources.location(&place), "a.obj:5:7");
//! ```

mod mesh_file;
mod mesh_scene;
pub mod nff;
mod normals;
mod obj;
mod ply;
pub mod polygon;
mod report;
mod stl;
pub(crate) mod text;

pub use mesh_file::{ColorFile, DielectricFile, MaterialFile, MeshFile};
pub use mesh_scene::mesh_scene;
pub use normals::{mesh_bounds, smooth_normals};

use crate::assets::Assets;
use crate::diagnostic::{Diagnostic, Diagnostics};
use report::Report;

/// A mesh format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// The Stanford polygon format.
    Ply,
    /// Wavefront's format.
    Obj,
    /// The stereolithography format.
    Stl,
}

impl MeshFormat {
    /// By the end of a file's name, in any case.
    ///
    /// ```
    /// use snell_scene::reader::MeshFormat;
    /// assert_eq!(MeshFormat::from_name("models/Spot.OBJ"), Some(MeshFormat::Obj));
    /// assert_eq!(MeshFormat::from_name("scene.toml"), None);
    /// ```
    pub fn from_name(name: &str) -> Option<Self> {
        let (_, extension) = name.rsplit_once('.')?;
        [("ply", Self::Ply), ("obj", Self::Obj), ("stl", Self::Stl)]
            .into_iter()
            .find(|(known, _)| extension.eq_ignore_ascii_case(known))
            .map(|(_, format)| format)
    }

    /// By how a file begins: with `ply`, with `solid`, with the length of a binary STL file, or with lines as in OBJ.
    pub fn from_content(bytes: &[u8]) -> Option<Self> {
        const LINES: usize = 1000;
        let start = bytes.iter().position(|b| !b.is_ascii_whitespace())?;
        if bytes[start..].starts_with(b"ply") && bytes.get(start + 3).is_none_or(u8::is_ascii_whitespace) {
            return Some(Self::Ply);
        }
        if stl::has_binary_length(bytes) || stl::begins_as_ascii(bytes) {
            return Some(Self::Stl);
        }
        let mut lines = text::Lines::new(bytes, start, false);
        for _ in 0..LINES {
            let line = lines.next_line()?;
            if bytes[line].first_chunk::<2>().is_some_and(|word| matches!(word, b"v " | b"v\t" | b"vt" | b"vn")) {
                return Some(Self::Obj);
            }
        }
        None
    }
}

/// Reads a mesh. `name` is its resolved path, for messages and as the base of the files that it names in turn; `assets` gives
/// those. The format is that of the name's extension, or else of the content.
///
/// What is wrong goes to `diagnostics`. `None` where there is an error, and for files without any triangle.
pub fn read_mesh(name: &str, bytes: &[u8], assets: &dyn Assets, diagnostics: &mut Diagnostics) -> Option<MeshFile> {
    let mut report = Report::new(name, bytes, diagnostics);
    let file = read_format(&mut report, assets);
    if !report.finish() {
        return None;
    }
    let mut file = file?;
    file.mesh.name = name.to_owned();
    Some(file)
}

fn read_format(report: &mut Report<'_>, assets: &dyn Assets) -> Option<MeshFile> {
    let (name, bytes) = (report.name, report.bytes);
    if bytes.is_empty() {
        report.whole("files", || Diagnostic::error("this file is empty"));
        return None;
    }
    let file = match MeshFormat::from_name(name).or_else(|| MeshFormat::from_content(bytes)) {
        Some(MeshFormat::Ply) => ply::read(report)?,
        Some(MeshFormat::Obj) => obj::read(report, assets)?,
        Some(MeshFormat::Stl) => stl::read(report)?,
        None => {
            let help = "meshes are read from PLY, OBJ and STL files";
            report.whole("files", || Diagnostic::error("this is no mesh in any known format").help(help));
            return None;
        }
    };
    if file.mesh.triangles.is_empty() {
        let points = file.mesh.positions.len();
        report.whole("files", || {
            let error = Diagnostic::error("there are no faces in this file: there is nothing to render");
            if points == 0 { error } else { error.help(format!("it has {points} points, but points are not rendered")) }
        });
        return None;
    }
    Some(file)
}

#[cfg(test)]
mod tests;

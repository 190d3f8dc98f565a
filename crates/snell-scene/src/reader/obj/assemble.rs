//! From the separate numbers of positions, texture coordinates and normals in an OBJ file to vertices that have all three.

use std::collections::HashMap;

use foldhash::fast::RandomState;

use super::{Corner, NONE, Parser};
use crate::diagnostic::Diagnostic;
use crate::reader::mesh_file::MeshFile;
use crate::reader::normals::repair_normals;
use crate::reader::report::Report;
use crate::scene::Mesh;

/// Makes the mesh; its materials are still to be added.
pub(super) fn assemble(mut parser: Parser<'_>, report: &mut Report<'_>) -> Option<MeshFile> {
    if !parser.colors.is_empty() {
        parser.colors.resize(parser.positions.len(), [1.0; 3]);
    }
    let mut mesh = Mesh { triangle_materials: triangle_materials(&parser, report)?, ..Mesh::default() };
    let corners = || parser.triangles.iter().flatten();
    let (any_uv, any_normal) = (corners().any(|c| c[1] != NONE), corners().any(|c| c[2] != NONE));
    if any_uv || any_normal {
        Builder::new(&parser, &mut mesh, any_uv, any_normal).build();
    } else {
        mesh.triangles = parser.triangles.iter().map(|t| t.map(|c| c[0])).collect();
        mesh.positions = parser.positions;
        mesh.colors = parser.colors;
    }
    if any_normal {
        let broken = repair_normals(&mut mesh);
        if broken > 0 {
            let message = format!("{broken} normals have no length: computed from the faces around");
            report.whole("normals", || Diagnostic::warning(message));
        }
    }
    if parser.loose > 0 && !mesh.triangles.is_empty() {
        let message = format!("{} points and lines are left out: only faces are rendered", parser.loose);
        report.whole("points and lines", || Diagnostic::warning(message));
    }
    Some(MeshFile { mesh, ..MeshFile::default() })
}

/// The material of every triangle; nothing where all have the first one. Triangles before the first `usemtl` have the one
/// after the named ones.
fn triangle_materials(parser: &Parser<'_>, report: &mut Report<'_>) -> Option<Vec<u16>> {
    let named = parser.material_names.len();
    if named >= usize::from(u16::MAX) {
        let message = format!("{named} materials are used, more than the limit of {}", u16::MAX - 1);
        report.whole("materials", || Diagnostic::error(message));
        return None;
    }
    let mut materials: Vec<u16> =
        parser.triangle_materials.iter().map(|&m| if m == NONE { named as u16 } else { m as u16 }).collect();
    if materials.iter().all(|&m| m == 0) {
        materials.clear();
    }
    Some(materials)
}

/// True where some triangles come before the first `usemtl`, and others after it.
pub(super) fn has_unnamed(parser: &Parser<'_>) -> bool {
    parser.triangle_materials.contains(&NONE)
}

struct Builder<'p, 'a, 'm> {
    parser: &'p Parser<'a>,
    mesh: &'m mut Mesh,
    any_uv: bool,
    any_normal: bool,
    /// For each position the first triple that used it, and the vertex it became: most positions have no other.
    first: Vec<(u32, u32, u32)>,
    /// All other triples.
    others: HashMap<Corner, u32, RandomState>,
}

impl<'p, 'a, 'm> Builder<'p, 'a, 'm> {
    fn new(parser: &'p Parser<'a>, mesh: &'m mut Mesh, any_uv: bool, any_normal: bool) -> Self {
        let first = vec![(NONE, NONE, NONE); parser.positions.len()];
        Self { parser, mesh, any_uv, any_normal, first, others: HashMap::default() }
    }

    fn build(mut self) {
        self.mesh.positions.reserve(self.parser.positions.len());
        self.mesh.triangles.reserve(self.parser.triangles.len());
        for triangle in &self.parser.triangles {
            // Where others have normals, a triangle without is meant to be flat.
            let vertices = if self.any_normal && triangle.iter().any(|c| c[2] == NONE) {
                let normal = flat_normal(self.parser, triangle);
                triangle.map(|corner| self.push(corner, normal))
            } else {
                triangle.map(|corner| self.vertex(corner))
            };
            self.mesh.triangles.push(vertices);
        }
    }

    #[inline]
    fn vertex(&mut self, corner: Corner) -> u32 {
        let [position, uv, normal] = corner;
        let first = self.first[position as usize];
        if first.2 != NONE && (first.0, first.1) == (uv, normal) {
            return first.2;
        }
        if first.2 != NONE
            && let Some(&vertex) = self.others.get(&corner)
        {
            return vertex;
        }
        let vertex = self.push(corner, self.parser.normals.get(normal as usize).copied().unwrap_or_default());
        if first.2 == NONE {
            self.first[position as usize] = (uv, normal, vertex);
        } else {
            self.others.insert(corner, vertex);
        }
        vertex
    }

    fn push(&mut self, [position, uv, _]: Corner, normal: [f32; 3]) -> u32 {
        let (parser, mesh) = (self.parser, &mut *self.mesh);
        mesh.positions.push(parser.positions[position as usize]);
        if self.any_uv {
            mesh.uvs.push(parser.uvs.get(uv as usize).copied().unwrap_or_default());
        }
        if self.any_normal {
            mesh.normals.push(normal);
        }
        if let Some(&color) = parser.colors.get(position as usize) {
            mesh.colors.push(color);
        }
        mesh.positions.len() as u32 - 1
    }
}

/// The normal of a triangle's plane, of any length; zero where it has no area.
fn flat_normal(parser: &Parser<'_>, triangle: &[Corner; 3]) -> [f32; 3] {
    let [a, b, c] =
        triangle.map(|corner| snell_math::Point3::from(parser.positions[corner[0] as usize].map(f64::from)));
    (b - a).cross(c - a).try_normalize().map_or([0.0; 3], |n| n.to_array().map(|x| x as f32))
}

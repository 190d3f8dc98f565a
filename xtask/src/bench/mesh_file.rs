//! Triangle meshes in memory, and the files that renderers read them from: binary PLY for us and for the Embree program, POV-Ray's
//! `mesh2`, which is text.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use super::vectors::{Vector, add};

/// Corners and triangles of three indices into them each.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    pub corners: Vec<[f32; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Adds another's triangles, each corner taken through `place`.
    pub fn append(&mut self, other: &Self, place: impl Fn(Vector) -> Vector) {
        let first = self.corners.len() as u32;
        let corners = other.corners.iter().map(|corner| place(corner.map(f64::from)).map(|x| x as f32));
        self.corners.extend(corners);
        self.triangles.extend(other.triangles.iter().map(|triangle| triangle.map(|index| index + first)));
    }

    /// Adds a corner and says its index.
    pub fn corner(&mut self, at: Vector) -> u32 {
        self.corners.push(at.map(|x| x as f32));
        self.corners.len() as u32 - 1
    }

    /// Adds a quadrangle as two triangles, corners in turn.
    pub fn quadrangle(&mut self, [a, b, c, d]: [u32; 4]) {
        self.triangles.extend([[a, b, c], [a, c, d]]);
    }

    /// Adds a box around the origin, turned and moved by `place`; seen from outside its triangles turn counter-clockwise.
    pub fn cuboid(&mut self, half: Vector, place: impl Fn(Vector) -> Vector) {
        let first = self.corners.len() as u32;
        for corner in 0..8 {
            let side = |axis: usize| if corner >> axis & 1 == 0 { -half[axis] } else { half[axis] };
            self.corner(place([side(0), side(1), side(2)]));
        }
        for face in [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]] {
            self.quadrangle(face.map(|index| index + first));
        }
    }

    /// The smallest and the largest coordinates.
    pub fn bounds(&self) -> [Vector; 2] {
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for corner in &self.corners {
            for axis in 0..3 {
                bounds[0][axis] = bounds[0][axis].min(f64::from(corner[axis]));
                bounds[1][axis] = bounds[1][axis].max(f64::from(corner[axis]));
            }
        }
        bounds
    }

    /// The same around the origin, its longest extent being 2.
    pub fn normalized(&self) -> Self {
        let [low, high] = self.bounds();
        let extent = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
        let middle = add(low, high).map(|x| x / 2.0);
        let mut mesh = Self::default();
        mesh.append(self, |at| [0, 1, 2].map(|axis| (at[axis] - middle[axis]) * 2.0 / extent));
        mesh
    }

    /// Writes binary PLY, little-endian: x, y, z as `float`, faces of three `int`.
    pub fn write_ply(&self, path: &Path) -> Result<(), String> {
        self.write(path, |out| {
            write!(
                out,
                "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
                 element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                self.corners.len(),
                self.triangles.len()
            )?;
            for corner in &self.corners {
                corner.iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
            }
            for triangle in &self.triangles {
                out.write_all(&[3])?;
                triangle.iter().try_for_each(|index| out.write_all(&index.to_le_bytes()))?;
            }
            Ok(())
        })
    }

    /// Writes OBJ, whose numbers read back are the same.
    pub fn write_obj(&self, path: &Path) -> Result<(), String> {
        self.write(path, |out| {
            for [x, y, z] in &self.corners {
                writeln!(out, "v {x} {y} {z}")?;
            }
            for [a, b, c] in self.triangles.iter().map(|triangle| triangle.map(|index| index + 1)) {
                writeln!(out, "f {a} {b} {c}")?;
            }
            Ok(())
        })
    }

    /// Writes a file that declares `name` as POV-Ray's `mesh2`.
    pub fn write_povray(&self, path: &Path, name: &str) -> Result<(), String> {
        self.write(path, |out| {
            write!(out, "#declare {name} = mesh2 {{\nvertex_vectors {{ {}", self.corners.len())?;
            for [x, y, z] in &self.corners {
                write!(out, ",\n<{x},{y},{z}>")?;
            }
            write!(out, "\n}}\nface_indices {{ {}", self.triangles.len())?;
            for [a, b, c] in &self.triangles {
                write!(out, ",\n<{a},{b},{c}>")?;
            }
            out.write_all(b"\n}\n}\n")
        })
    }

    fn write(
        &self,
        path: &Path,
        content: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>,
    ) -> Result<(), String> {
        let written = File::create(path).and_then(|file| {
            let mut out = BufWriter::with_capacity(1 << 20, file);
            content(&mut out)?;
            out.flush()
        });
        written.map_err(|error| format!("cannot write {}: {error}", path.display()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_faces_outwards_and_is_closed() {
        let mut mesh = Mesh::default();
        mesh.cuboid([1.0, 2.0, 3.0], |at| at);
        assert_eq!((mesh.corners.len(), mesh.triangles.len()), (8, 12));
        // The volume by the divergence theorem is positive only where all triangles turn outwards.
        let volume: f32 = mesh
            .triangles
            .iter()
            .map(|triangle| {
                let [a, b, c] = triangle.map(|index| mesh.corners[index as usize]);
                (a[0] * (b[1] * c[2] - b[2] * c[1])
                    + a[1] * (b[2] * c[0] - b[0] * c[2])
                    + a[2] * (b[0] * c[1] - b[1] * c[0]))
                    / 6.0
            })
            .sum();
        assert_eq!(volume, 48.0);
        assert_eq!(mesh.normalized().bounds()[1], [1.0 / 3.0_f32, 2.0 / 3.0, 1.0].map(f64::from));
    }

    #[test]
    fn files_hold_every_triangle() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut mesh = Mesh::default();
        mesh.cuboid([1.0; 3], |at| at);
        let (ply, pov) = (folder.path().join("a.ply"), folder.path().join("a.inc"));
        mesh.write_ply(&ply).expect("it is written");
        let obj = folder.path().join("a.obj");
        mesh.write_obj(&obj).expect("it is written");
        let text = std::fs::read_to_string(obj).expect("it is there");
        let count = |word: &str| text.lines().filter(|line| line.starts_with(word)).count();
        assert_eq!((count("v "), count("f ")), (mesh.corners.len(), mesh.triangles.len()));
        mesh.write_povray(&pov, "Box").expect("it is written");
        let bytes = std::fs::read(ply).expect("it is there");
        let head = bytes.windows(11).position(|window| window == b"end_header\n").expect("a head") + 11;
        assert_eq!(bytes.len() - head, 8 * 12 + 12 * 13);
        let text = std::fs::read_to_string(pov).expect("it is there");
        assert!(text.starts_with("#declare Box = mesh2 {\nvertex_vectors { 8,\n<-1,-1,-1>"), "{text}");
        assert_eq!(text.lines().filter(|line| line.starts_with('<')).count(), 8 + 12);
    }
}

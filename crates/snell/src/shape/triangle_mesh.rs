//! Triangle meshes: a watertight intersection over a hierarchy of their own, and the surface at a hit.
//!
//! The intersection follows Woop, Benthin and Wald, JCGT 2(1), 2013, with exact signs. Positions,
//! normals, texture coordinates and colours are `f32` as they came from the file; everything computed from them is `f64`.
//! All lengths are in the mesh's own space. A ray's direction need not have unit length; `t` is the ray parameter.

mod blocks;
mod many;
mod queries;
mod sight;
mod spaces;
mod surfaces;
mod together;
mod topology;
mod watertight;

#[cfg(test)]
mod query_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod together_tests;

use std::ops::ControlFlow;

use rayon::prelude::*;
use snell_math::lanes::InstructionSet;
use snell_math::{Bounds3, Normal3, Point3, Ray, Rgb, Vector3};
use snell_scene::scene::Mesh;

use super::SurfacePoint;
use crate::accel::wide::{WideTree, roomy};
use crate::accel::{BuildError, BuildOptions, BuildQuality, Bvh};
use blocks::TriangleBlock;
pub(crate) use sight::Sight;
pub use topology::{EdgeFaces, MeshEdge};
use watertight::{Meeting, RaySpace};

/// How many triangles are tested at once.
const BLOCK: usize = 8;

/// Triangles over shared vertices, ready to be met by rays. Front faces are counter-clockwise.
///
/// ```
/// use snell::shape::triangle_mesh::TriangleMesh;
/// use snell_math::{Point3, Ray, Vector3};
/// use snell_scene::scene::Mesh;
///
/// // A unit square of two triangles in the plane z = 0, its front towards +z.
/// let square = Mesh {
///     positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
///     triangles: vec![[0, 1, 2], [0, 2, 3]],
///     ..Mesh::default()
/// };
/// let mesh = TriangleMesh::new(&square)?;
/// // No ray slips through the diagonal.
/// let ray = Ray::new(Point3::new(0.5, 0.5, 2.0), -Vector3::Z);
/// let hit = mesh.intersect(&ray, 0.0, f64::INFINITY).expect("the square is in the way");
/// assert_eq!((hit.t, hit.front), (2.0, true));
/// assert_eq!(mesh.surface(&ray, &hit).point, Point3::new(0.5, 0.5, 0.0));
/// # Ok::<(), snell::shape::triangle_mesh::MeshError>(())
/// ```
#[derive(Clone, Debug)]
pub struct TriangleMesh {
    positions: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    colors: Vec<[f32; 3]>,
    triangle_materials: Vec<u16>,
    tree: WideTree,
    /// The leaves of the tree.
    blocks: Vec<TriangleBlock>,
    /// By what boxes and triangles are filtered.
    set: InstructionSet,
    bounds: Bounds3,
}

/// Where a ray meets a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshHit {
    /// The ray parameter.
    pub t: f64,
    /// The triangle, by its place in the scene's mesh.
    pub triangle: u32,
    /// The weights of the triangle's three vertices: none negative, with sum 1 up to rounding.
    pub barycentric: [f64; 3],
    /// The ray comes from the front, where the vertices run counter-clockwise: it enters what the mesh encloses.
    pub front: bool,
}

/// Why a mesh cannot be used: it breaks what [`Mesh`] promises.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MeshError {
    /// A triangle refers to a vertex that is not there.
    #[error("triangle {0} refers to a vertex that does not exist")]
    NoSuchVertex(usize),
    /// A position is NaN or infinite.
    #[error("the position of vertex {0} is not finite")]
    NotFinite(usize),
    /// A list that should be empty or have one entry a vertex, or a triangle, has another length.
    #[error("there are {found} {what}, not {expected}")]
    WrongLength {
        /// Which list.
        what: &'static str,
        /// How long it is.
        found: usize,
        /// How long it should be.
        expected: usize,
    },
    /// The hierarchy cannot be built.
    #[error(transparent)]
    Hierarchy(#[from] BuildError),
}

impl TriangleMesh {
    /// Takes over a mesh of the scene and builds its hierarchy. Triangles with two equal corners are never met; leaving
    /// them out opens no gap.
    ///
    /// # Errors
    /// Where the mesh breaks the promises of [`Mesh`], or has more than 2³¹ triangles.
    pub fn new(mesh: &Mesh) -> Result<Self, MeshError> {
        Self::with_quality(mesh, BuildQuality::Medium)
    }

    /// As [`TriangleMesh::new`], with more or less work for the hierarchy: nothing but speed and memory depends on it.
    ///
    /// # Errors
    /// As [`TriangleMesh::new`].
    pub fn with_quality(mesh: &Mesh, quality: BuildQuality) -> Result<Self, MeshError> {
        let vertices = mesh.positions.len();
        for (what, found, expected) in [
            ("normals", mesh.normals.len(), vertices),
            ("texture coordinates", mesh.uvs.len(), vertices),
            ("colours", mesh.colors.len(), vertices),
            ("materials of triangles", mesh.triangle_materials.len(), mesh.triangles.len()),
        ] {
            if found != 0 && found != expected {
                return Err(MeshError::WrongLength { what, found, expected });
            }
        }
        if let Some(vertex) = mesh.positions.par_iter().position_first(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(MeshError::NotFinite(vertex));
        }
        if let Some(triangle) = mesh.triangles.par_iter().position_first(|t| t.iter().any(|&v| v as usize >= vertices))
        {
            return Err(MeshError::NoSuchVertex(triangle));
        }
        let corners = |triangle| corners_of(&mesh.positions, &mesh.triangles, triangle);
        let options = BuildOptions { block: BLOCK, quality, ..BuildOptions::default() };
        let bvh = Bvh::over_triangles(mesh.triangles.len(), corners, options)?;
        let (tree, leaves) = WideTree::new(&bvh);
        let mut blocks = roomy(leaves.len());
        leaves.par_iter().map(|leaf| TriangleBlock::new(*leaf, corners)).collect_into_vec(&mut blocks);
        Ok(Self {
            positions: mesh.positions.clone(),
            triangles: mesh.triangles.clone(),
            normals: mesh.normals.clone(),
            uvs: mesh.uvs.clone(),
            colors: mesh.colors.clone(),
            triangle_materials: mesh.triangle_materials.clone(),
            tree,
            blocks,
            set: InstructionSet::best(),
            bounds: bvh.bounds(),
        })
    }

    /// The same mesh, filtered by other instructions; nothing else changes.
    #[must_use]
    pub fn with_instructions(self, set: InstructionSet) -> Self {
        Self { set, ..self }
    }

    /// The closest hit with t_min < t ≤ t_max; `t_min` may be negative. Where several triangles are met at the same t, the
    /// lowest wins. A triangle seen exactly edge on is not met. A ray that is not finite or has no direction meets nothing.
    ///
    /// Every point of an edge or a vertex belongs to just one of the triangles that a line through it passes from one side
    /// to the other, as if the line were moved by an infinitely small distance. So no ray slips through, and a line
    /// crosses a closed mesh as often from the front as from the back, without exception. A line that touches a silhouette
    /// crosses it twice or never; one on the border of an open mesh may meet it or not.
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<MeshHit> {
        queries::closest(self, ray, t_min, t_max)
    }

    /// [`TriangleMesh::intersect`] of many rays, each with its own largest t: the same hits, sooner where neighbours among them go
    /// much the same way, or the mesh is larger than the processor's caches. The rays may be in any order and of any kind.
    ///
    /// ```
    /// # use snell::shape::triangle_mesh::TriangleMesh;
    /// # use snell_math::{Point3, Ray, Vector3};
    /// # use snell_scene::scene::Mesh;
    /// # let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// # let mesh = TriangleMesh::new(&Mesh { positions, triangles: vec![[0, 1, 2]], ..Mesh::default() })?;
    /// let rays = [0.25, 2.0].map(|x| Ray::new(Point3::new(x, 0.25, 1.0), -Vector3::Z));
    /// let mut hits = [None; 2];
    /// mesh.intersect_many(&rays, 0.0, &[f64::INFINITY; 2], &mut hits);
    /// assert_eq!(hits.map(|hit| hit.map(|hit| hit.t)), [Some(1.0), None]);
    /// # Ok::<(), snell::shape::triangle_mesh::MeshError>(())
    /// ```
    ///
    /// # Panics
    /// Where there are not as many rays, largest t and places for hits.
    pub fn intersect_many(&self, rays: &[Ray], t_min: f64, t_max: &[f64], hits: &mut [Option<MeshHit>]) {
        assert!(rays.len() == t_max.len() && rays.len() == hits.len(), "as many rays as limits and places for hits");
        many::closest(self, rays, t_min, t_max, hits);
    }

    /// The hit of a ray with one triangle, worked out again from what is worth keeping of it: the triangle and t. Of a ray
    /// that does not meet the triangle it is the middle.
    ///
    /// # Panics
    /// Where there is no such triangle.
    pub fn hit(&self, ray: &Ray, triangle: u32, t: f64) -> MeshHit {
        let meeting = RaySpace::new(ray).and_then(|space| space.meet::<f64>(self.corners(triangle)));
        meeting.map_or(MeshHit { t, triangle, barycentric: [1.0 / 3.0; 3], front: true }, |meeting| {
            MeshHit::new(triangle, meeting)
        })
    }

    /// Where a point of a triangle's plane is on the triangle, or beside it: its barycentric coordinates, of which some are
    /// negative there. t is 0. Of a triangle without area it is the middle.
    ///
    /// # Panics
    /// Where there is no such triangle.
    pub(crate) fn beside(&self, triangle: u32, place: Point3) -> MeshHit {
        let [a, b, c] = self.triangle(triangle);
        let (ab, ac, at) = (b - a, c - a, place - a);
        let normal = ab.cross(ac);
        let scale = 1.0 / normal.length_squared();
        let (of_b, of_c) = (at.cross(ac).dot(normal) * scale, ab.cross(at).dot(normal) * scale);
        let barycentric =
            if of_b.is_finite() && of_c.is_finite() { [1.0 - of_b - of_c, of_b, of_c] } else { [1.0 / 3.0; 3] };
        MeshHit { t: 0.0, triangle, barycentric, front: true }
    }

    /// Visits all hits with t_min < t ≤ t_max, in a fixed order that is not that of t, until `visit` breaks; returns
    /// whether it did. What is a hit is the same as for [`TriangleMesh::intersect`].
    #[inline]
    pub fn for_each_hit(
        &self,
        ray: &Ray,
        t_min: f64,
        t_max: f64,
        visit: impl FnMut(MeshHit) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        queries::each(self, ray, t_min, t_max, visit)
    }

    /// True where something is met with t_min < t ≤ t_max: the question of a shadow ray to an opaque mesh.
    #[inline]
    pub fn any(&self, ray: &Ray, t_min: f64, t_max: f64) -> bool {
        queries::any(self, ray, t_min, t_max)
    }

    /// The surface at a hit of `ray` with this mesh.
    ///
    /// A ray that starts at `point + geometric_normal * error`, or on the other side at `point − geometric_normal *
    /// error`, and leads away from the surface does not meet the triangle, or another one of the same plane, again. The
    /// error is 64 u times the largest coordinate of the mesh, u = 2⁻⁵³: the corners of any triangle are displaced by
    /// rounding by less than 12 u of it when a ray from somewhere on the mesh is tested, and the point by less than 8 u.
    ///
    /// # Panics
    /// Where the hit is of another mesh and this one has no such triangle.
    pub fn surface(&self, ray: &Ray, hit: &MeshHit) -> SurfacePoint {
        let vertices = self.triangles[hit.triangle as usize].map(|vertex| vertex as usize);
        let [a, b, c] = vertices.map(|vertex| point(self.positions[vertex]));
        let (ab, ac) = (b - a, c - a);
        // A triangle whose corners are three points of a line has no normal; it is met by the rays that rounding would
        // let pass between its neighbours, and turns to them.
        let geometric_normal =
            (ab.cross(ac).try_normalize()).or_else(|| (-ray.direction).try_normalize()).unwrap_or(Vector3::Y);
        let [u, v] = self.mix(&self.uvs, hit).filter(|uv| uv.iter().all(|x| x.is_finite())).unwrap_or([0.0, 0.0]);
        let shading_normal = self
            .mix(&self.normals, hit)
            .and_then(|normal| Vector3::from(normal).try_normalize())
            .map_or(geometric_normal.into(), |normal| Normal3::from(normal).face_forward(geometric_normal));
        SurfacePoint {
            point: a + ab * hit.barycentric[1] + ac * hit.barycentric[2],
            error: self.surface_error(),
            geometric_normal: geometric_normal.into(),
            shading_normal,
            uv: [u, v],
        }
    }

    /// How far points of surfaces are from the true ones, at most.
    #[inline]
    fn surface_error(&self) -> f64 {
        64.0 * 0.5 * f64::EPSILON * self.bounds.min.max_abs().max(self.bounds.max.max_abs())
    }

    /// Whether there are colours of vertices.
    #[inline]
    pub(crate) fn has_colors(&self) -> bool {
        !self.colors.is_empty()
    }

    /// The colour of the vertices, mixed at a hit; `None` where the mesh has no colours or they are not finite.
    ///
    /// # Panics
    /// As [`TriangleMesh::surface`].
    pub fn color(&self, hit: &MeshHit) -> Option<Rgb> {
        let color = self.mix(&self.colors, hit)?;
        Some(Rgb::from(color.map(|x| x as f32))).filter(|color| color.is_finite())
    }

    /// A triangle's place in the mesh's list of materials: 0 where one material serves all.
    pub fn material_index(&self, triangle: u32) -> u16 {
        self.triangle_materials.get(triangle as usize).copied().unwrap_or(0)
    }

    /// The number of triangles, those that are never met included.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The box around all triangles that can be met, exactly.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// How many directed edges have no opposite one to match, corners of equal position being one: 0 where the mesh is
    /// closed. An edge of a hole counts 1. Takes n log n time, and memory for the while.
    pub fn boundary_edges(&self) -> usize {
        topology::boundary_edges(&self.positions, &self.triangles)
    }

    /// All edges with the faces along them, corners of equal position being one. Takes n log n time.
    pub fn edges(&self) -> Vec<MeshEdge> {
        topology::edges(&self.positions, &self.triangles)
    }

    /// The corners of a triangle.
    ///
    /// # Panics
    /// Where there is no such triangle.
    #[inline]
    pub fn triangle(&self, triangle: u32) -> [Point3; 3] {
        self.corners(triangle).map(point)
    }

    /// The place of a vertex.
    ///
    /// # Panics
    /// Where there is no such vertex.
    #[inline]
    pub fn vertex(&self, vertex: u32) -> Point3 {
        point(self.positions[vertex as usize])
    }

    /// True where the mesh encloses something: every edge is matched, see [`TriangleMesh::boundary_edges`].
    pub fn is_closed(&self) -> bool {
        !self.tree.is_empty() && self.boundary_edges() == 0
    }

    /// The volume of a closed mesh: negative for one that is inside out, whose faces are clockwise as seen from outside. For an open
    /// mesh the number means nothing.
    pub fn signed_volume(&self) -> f64 {
        // From the middle, so that no digits are lost far from the origin.
        let middle = self.bounds.center();
        let of_triangle = |triangle: u32| {
            let [a, b, c] = self.triangle(triangle).map(|corner| corner - middle);
            a.dot(b.cross(c)) / 6.0
        };
        (0..self.triangles.len() as u32).map(of_triangle).sum()
    }

    /// True where a point is inside a closed mesh: a ray from it crosses the mesh an odd number of times. Any direction
    /// will do, since crossings are counted right on edges and vertices too. For an open mesh the answer means nothing.
    pub fn contains(&self, p: Point3) -> bool {
        let mut inside = false;
        if self.bounds.contains(p) {
            // Parallel to no axis or diagonal: few triangles of things that people make are seen edge on by it.
            let ray = Ray::new(p, Vector3::new(0.296, 0.854, 0.428));
            // It never breaks, so there is nothing to know from its end.
            let _ = self.for_each_hit(&ray, 0.0, f64::INFINITY, |_| {
                inside = !inside;
                ControlFlow::Continue(())
            });
        }
        inside
    }

    /// The memory it takes, in bytes.
    pub fn bytes(&self) -> usize {
        size_of::<Self>()
            + size_of_val(self.positions.as_slice())
            + size_of_val(self.triangles.as_slice())
            + size_of_val(self.normals.as_slice())
            + size_of_val(self.uvs.as_slice())
            + size_of_val(self.colors.as_slice())
            + size_of_val(self.triangle_materials.as_slice())
            + self.tree.bytes()
            + size_of_val(self.blocks.as_slice())
    }

    #[inline]
    fn corners(&self, triangle: u32) -> [[f32; 3]; 3] {
        corners_of(&self.positions, &self.triangles, triangle)
    }

    /// An attribute of the vertices, mixed at a hit; `None` where the mesh does not have it.
    fn mix<const N: usize>(&self, attribute: &[[f32; N]], hit: &MeshHit) -> Option<[f64; N]> {
        if attribute.is_empty() {
            return None;
        }
        let mut mixed = [0.0; N];
        for (vertex, weight) in self.triangles[hit.triangle as usize].into_iter().zip(hit.barycentric) {
            for (mixed, x) in mixed.iter_mut().zip(attribute[vertex as usize]) {
                *mixed += weight * f64::from(x);
            }
        }
        Some(mixed)
    }
}

impl MeshHit {
    fn new(triangle: u32, meeting: Meeting) -> Self {
        Self { t: meeting.t, triangle, barycentric: meeting.weights, front: meeting.front }
    }
}

#[inline]
fn corners_of(positions: &[[f32; 3]], triangles: &[[u32; 3]], triangle: u32) -> [[f32; 3]; 3] {
    triangles[triangle as usize].map(|vertex| positions[vertex as usize])
}

fn point(position: [f32; 3]) -> Point3 {
    Point3::from(position.map(f64::from))
}

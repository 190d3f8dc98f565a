//! Hits of rays side by side, worked out: shapes and meshes of the world in lanes, everything else one by one. What comes
//! of it is what [`Geometry::interaction`] gives for each hit alone.

use snell_math::lanes::{Bits, LaneVector, Lanes, WIDTH, Work};
use snell_math::{Point3, Ray, Vector3};

use super::lanes::HitRows;
use super::space::{Attributes, NONE, Primitive};
use super::{Geometry, Hit, LocalPlace};
use crate::interaction::{SolidId, SurfaceInteraction, SurfaceRows};
use crate::shape::{LanePlanes, LaneRay, LaneSpheres, LaneSurfacePoint, RayRow, SurfacePoint};
use crate::task::{column, set_column};
use crate::texture::Spaces;

impl Geometry {
    /// Works out hits of rays side by side, from place `at` of the rows on.
    #[inline(always)]
    pub(crate) fn surfaces<L: Lanes>(
        &self,
        rays: RayRow,
        at: usize,
        hits: &HitRows,
        met: Bits,
        surfaces: &mut SurfaceRows,
    ) {
        let ray = rays.lanes::<L>(at);
        let t = L::load(&hits.t, at);
        // Neighbouring rays most often meet the same thing.
        let first = hits.primitive[at + met.lowest()];
        let is_same = met.lanes().all(|lane| hits.primitive[at + lane] == first);
        let primitive = &self.world.primitives[first as usize];
        if is_same && let Primitive::Sphere(_) | Primitive::Plane(_) = primitive {
            let (material, object_space) = self.plain_attributes(first);
            for lane in at..at + L::COUNT {
                surfaces.whole[lane] = None;
                surfaces.solid[lane] = SolidId(u64::from(first) << 32 | u64::from(NONE));
                surfaces.material[lane] = material;
            }
            surfaces.unplaced = if object_space == NONE { met } else { Bits::NONE };
            match primitive {
                Primitive::Sphere(sphere) => surfaces.put_spheres(at, met, &LaneSpheres::from(sphere), &ray, t),
                Primitive::Plane(plane) => surfaces.put_planes(at, met, &LanePlanes::from(plane), &ray, t),
                _ => {}
            }
            return;
        }
        let (mut spheres, mut planes, mut shapes, mut meshes) = (Bits::NONE, Bits::NONE, Bits::NONE, Bits::NONE);
        let (mut place, mut normal, mut radius) = ([[0.0; WIDTH]; 3], [[0.0; WIDTH]; 3], [1.0; WIDTH]);
        let mut unplaced = 0;
        if !self.meshes.is_empty() {
            for lane in met.lanes() {
                self.prefetch_surface::<L>(hits, at + lane);
            }
        }
        for lane in met.lanes() {
            let index = hits.primitive[at + lane];
            surfaces.whole[at + lane] = None;
            surfaces.solid[at + lane] = SolidId(u64::from(index) << 32 | u64::from(NONE));
            let (material, object_space) = self.plain_attributes(index);
            surfaces.material[at + lane] = material;
            unplaced |= u8::from(object_space == NONE) << lane;
            match &self.world.primitives[index as usize] {
                Primitive::Sphere(sphere) => {
                    spheres |= Bits::lane(lane);
                    set_column(&mut place, at + lane, sphere.center.to_array());
                    radius[at + lane] = sphere.radius;
                }
                Primitive::Plane(plane) => {
                    planes |= Bits::lane(lane);
                    let (point, unit) = plane.point_and_normal();
                    set_column(&mut place, at + lane, point.to_array());
                    set_column(&mut normal, at + lane, unit.to_array());
                }
                Primitive::Shape { shape, placement: NONE }
                    if L::COUNT == WIDTH && self.world.shapes[*shape as usize].has_lanes() =>
                {
                    shapes |= Bits::lane(lane);
                }
                primitive => {
                    if L::COUNT == WIDTH
                        && let Some(material) = self.material_of_plain_mesh(primitive, index, hits.place[lane])
                    {
                        meshes |= Bits::lane(lane);
                        surfaces.material[lane] = material;
                        continue;
                    }
                    self.surface_one_by_one(&rays.ray(at + lane), hits, at + lane, surfaces);
                }
            }
        }
        surfaces.unplaced = Bits(unplaced) & (spheres | planes | shapes);
        if shapes.any() {
            L::stage(OfShapes { geometry: self, rays, hits, shapes, surfaces });
        }
        if meshes.any() {
            let unusual = L::stage(OfMeshes { geometry: self, rays, hits, meshes, surfaces });
            // What asks for no place on an object may have any.
            surfaces.unplaced |= meshes.without(unusual);
            for lane in unusual.lanes() {
                self.surface_one_by_one(&rays.ray(lane), hits, lane, surfaces);
            }
        }
        if spheres.any() {
            let lanes = LaneSpheres { center: LaneVector::load(&place, at), radius: L::load(&radius, at) };
            surfaces.put_spheres(at, spheres, &lanes, &ray, t);
        }
        if planes.any() {
            let lanes = LanePlanes { point: LaneVector::load(&place, at), normal: LaneVector::load(&normal, at) };
            surfaces.put_planes(at, planes, &lanes, &ray, t);
        }
    }

    /// The material of a hit with a mesh of the world, where all that is asked of the hit is where it is and its normals.
    #[inline(always)]
    fn material_of_plain_mesh(&self, primitive: &Primitive, index: u32, place: LocalPlace) -> Option<u32> {
        let Primitive::Mesh { mesh, .. } = primitive else { return None };
        let material = self.material_of(primitive, &self.world.attributes[index as usize], NONE, place);
        let Spaces { object, uv, .. } = self.spaces[material as usize];
        (!object && !uv && !self.meshes[*mesh as usize].has_colors()).then_some(material)
    }

    /// The material of a shape of the world, and the space of its object.
    #[inline(always)]
    fn plain_attributes(&self, index: u32) -> (u32, u32) {
        let Attributes { material, object_space, .. } = self.world.attributes[index as usize];
        (if material == NONE { self.default_material } else { material }, object_space)
    }

    #[inline(never)]
    fn surface_one_by_one(&self, ray: &Ray, hits: &HitRows, lane: usize, surfaces: &mut SurfaceRows) {
        let Some(hit) = hits.hit(lane) else { return };
        let whole = self.interaction(ray, &hit);
        set_column(&mut surfaces.point, lane, whole.point.to_array());
        set_column(&mut surfaces.geometric_normal, lane, whole.geometric_normal.to_array());
        set_column(&mut surfaces.shading_normal, lane, whole.shading_normal.to_array());
        surfaces.error[lane] = whole.error;
        surfaces.material[lane] = whole.material;
        surfaces.solid[lane] = whole.solid;
        surfaces.whole[lane] = Some(whole);
    }

    /// Everything about one of eight hits.
    #[inline(never)]
    pub(crate) fn interaction_of(&self, hits: &HitRows, surfaces: &SurfaceRows, lane: usize) -> SurfaceInteraction {
        if let Some(whole) = &surfaces.whole[lane] {
            return *whole;
        }
        let surface = SurfacePoint {
            point: Point3::from(column(&surfaces.point, lane)),
            error: surfaces.error[lane],
            geometric_normal: Vector3::from(column(&surfaces.geometric_normal, lane)).into(),
            shading_normal: Vector3::from(column(&surfaces.shading_normal, lane)).into(),
            uv: [0.0, 0.0],
        };
        let index = hits.primitive[lane];
        // Of balls and planes, which have one part, what stands in the row may be that of a hit farther away.
        let part = if let Primitive::Shape { .. } = &self.world.primitives[index as usize] {
            hits.place[lane].part
        } else {
            0
        };
        let hit = Hit { t: hits.t[lane], primitive: index, inner: NONE, place: LocalPlace::of_part(part) };
        self.complete(&self.world, &hit, index, None, surface, None, surfaces.material[lane])
    }
}

/// The question for hits with meshes of the world, worked out; the lanes that have to be worked out one by one. By itself, since
/// scenes without meshes should not carry it around.
struct OfMeshes<'a> {
    geometry: &'a Geometry,
    rays: RayRow<'a>,
    hits: &'a HitRows,
    meshes: Bits,
    surfaces: &'a mut SurfaceRows,
}

impl Work for OfMeshes<'_> {
    type Output = Bits;
    #[inline(always)]
    fn run<L: Lanes>(self) -> Bits {
        let Self { geometry, rays, hits, meshes, surfaces } = self;
        let ray = rays.lanes::<L>(0);
        let triangles = hits.place.map(|place| place.part);
        let (mut rest, mut unusual) = (meshes, Bits::NONE);
        while rest.any() {
            let (index, same) = hits.alike(rest);
            rest = rest.without(same);
            let primitive = &geometry.world.primitives[index as usize];
            let Primitive::Mesh { mesh, .. } = primitive else { continue };
            let mesh = &geometry.meshes[*mesh as usize];
            let (surface, done) = match geometry.world.placement(primitive) {
                None => mesh.surfaces(&ray, &triangles, same),
                Some(placement) => {
                    let (surface, done) = mesh.surfaces(&placement.lanes_to_local(ray), &triangles, same);
                    (placement.carry_lanes_out(&surface), done)
                }
            };
            unusual |= same.without(done);
            let LaneSurfacePoint { point, error, geometric_normal, shading_normal } = surface;
            surfaces.put(0, done, point, geometric_normal, shading_normal, error);
        }
        unusual
    }
}

/// The question for hits with shapes that stand in the world as they are, worked out; by itself for the same reason.
struct OfShapes<'a> {
    geometry: &'a Geometry,
    rays: RayRow<'a>,
    hits: &'a HitRows,
    shapes: Bits,
    surfaces: &'a mut SurfaceRows,
}

impl Work for OfShapes<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { geometry, rays, hits, shapes, surfaces } = self;
        let (ray, t) = (rays.lanes::<L>(0), L::load(&hits.t, 0));
        let mut parts = [0.0; WIDTH];
        for lane in shapes.lanes() {
            parts[lane] = f64::from(hits.place[lane].part);
        }
        let part = L::load(&parts, 0);
        let mut rest = shapes;
        while rest.any() {
            let (index, same) = hits.alike(rest);
            rest = rest.without(same);
            let Primitive::Shape { shape, .. } = &geometry.world.primitives[index as usize] else { continue };
            let (point, normal, error) = geometry.world.shapes[*shape as usize].surfaces(&ray, t, part);
            surfaces.put(0, same, point, normal, normal, error);
        }
    }
}

impl SurfaceRows {
    /// Puts in where rays meet spheres.
    #[inline(always)]
    fn put_spheres<L: Lanes>(&mut self, at: usize, lanes: Bits, spheres: &LaneSpheres<L>, ray: &LaneRay<L>, t: L) {
        let (point, normal, error) = spheres.surface(ray, t);
        self.put(at, lanes, point, normal, normal, error);
    }

    /// Puts in where rays meet planes.
    #[inline(always)]
    fn put_planes<L: Lanes>(&mut self, at: usize, lanes: Bits, planes: &LanePlanes<L>, ray: &LaneRay<L>, t: L) {
        let (point, error) = planes.surface(ray, t);
        let normal = planes.normal;
        self.put(at, lanes, point, normal, normal, error);
    }

    /// Puts in surfaces of some lanes.
    #[inline(always)]
    fn put<L: Lanes>(
        &mut self,
        at: usize,
        lanes: Bits,
        point: LaneVector<L>,
        geometric_normal: LaneVector<L>,
        shading_normal: LaneVector<L>,
        error: L,
    ) {
        put_rows(&mut self.point, at, lanes, point);
        error.or_where_not(lanes, L::load(&self.error, at)).store(&mut self.error, at);
        put_rows(&mut self.geometric_normal, at, lanes, geometric_normal);
        put_rows(&mut self.shading_normal, at, lanes, shading_normal);
    }
}

/// Puts some lanes into rows.
#[inline(always)]
fn put_rows<L: Lanes>(rows: &mut [[f64; WIDTH]; 3], at: usize, lanes: Bits, v: LaneVector<L>) {
    v.or_where_not(lanes, LaneVector::load(rows, at)).store(rows, at);
}

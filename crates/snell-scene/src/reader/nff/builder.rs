//! From the numbers of an NFF file to a scene.

use std::collections::HashMap;

use snell_math::{Dispersion, Point3, Rgb};

use crate::reader::normals::{position_key, repair_normals};
use crate::reader::polygon::{TooComplex, Triangulator};
use crate::scene::{
    Background, Camera, Dielectric, Falloff, Light, LightKind, Material, Medium, Mesh, Object, Shape, Texture,
};
use crate::{Id, Scene};

/// The numbers of an `f` entity. The colour and the shares are scene-linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fill {
    pub color: Rgb,
    pub diffuse: f32,
    pub specular: f32,
    pub shininess: f32,
    pub transmittance: f32,
    pub index: f64,
}

impl Default for Fill {
    /// For things before the first fill: white and diffuse.
    fn default() -> Self {
        Self { color: Rgb::WHITE, diffuse: 1.0, specular: 0.0, shininess: 0.0, transmittance: 0.0, index: 1.0 }
    }
}

/// Collects a scene.
#[derive(Default)]
pub(super) struct Builder {
    pub camera: Camera,
    /// Width and height in pixels.
    pub resolution: Option<[u32; 2]>,
    pub background: Rgb,
    /// Places, and colours where the file gives them.
    pub lights: Vec<(Point3, Option<Rgb>)>,
    /// The corners of the polygon that is being read, and their normals if it is a patch.
    pub corners: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    /// The polygons so far would take too long.
    pub too_complex: bool,
    scene: Scene,
    fill: Fill,
    /// The materials of all fills so far, by the fill's numbers and by whether things have one side.
    materials: HashMap<([u64; 8], bool), Id<Material>>,
    polygons: Collected,
    patches: Collected,
    triangulator: Triangulator,
    cut: Vec<[u32; 3]>,
}

/// The polygons of one fill.
#[derive(Default)]
struct Collected {
    mesh: Mesh,
    /// Vertices by their position and normal.
    vertices: HashMap<[[u32; 3]; 2], u32>,
}

impl Builder {
    /// What follows has this fill.
    pub fn fill(&mut self, fill: Fill) {
        if fill == self.fill {
            return;
        }
        self.flush();
        self.fill = fill;
    }

    /// A sphere; a negative radius shows its inside.
    pub fn sphere(&mut self, center: Point3, radius: f64) {
        self.shape(Shape::Sphere { center, radius: radius.abs() }, radius > 0.0);
    }

    /// An open cylinder or cone between two different points; negative radii show its inside.
    pub fn cone(&mut self, base: Point3, base_radius: f64, top: Point3, top_radius: f64) {
        let outside = base_radius + top_radius > 0.0;
        let (base_radius, top_radius) = (base_radius.abs(), top_radius.abs());
        let shape = if base_radius == top_radius {
            Shape::Cylinder { base, top, radius: base_radius, capped: false }
        } else {
            Shape::Cone { base, base_radius, top, top_radius, capped: false }
        };
        self.shape(shape, outside);
    }

    /// The polygon of `corners`, or a patch with `normals`. Says how many triangles it became.
    pub fn polygon(&mut self, patch: bool) -> Result<usize, TooComplex> {
        self.cut.clear();
        let points = self.corners.iter().map(|p| p.map(f64::from));
        if let Err(error) = self.triangulator.triangulate(points, &mut self.cut) {
            self.too_complex = true;
            return Err(error);
        }
        let Collected { mesh, vertices } = if patch { &mut self.patches } else { &mut self.polygons };
        for triangle in &self.cut {
            mesh.triangles.push(triangle.map(|corner| {
                let position = self.corners[corner as usize];
                let normal = self.normals.get(corner as usize).copied().unwrap_or_default();
                *vertices.entry([position, normal].map(position_key)).or_insert_with(|| {
                    mesh.positions.push(position);
                    if patch {
                        mesh.normals.push(normal);
                    }
                    mesh.positions.len() as u32 - 1
                })
            }));
        }
        Ok(self.cut.len())
    }

    /// The scene, with all lights and settings.
    pub fn finish(mut self) -> Scene {
        self.flush();
        let count = self.lights.len() as f64;
        // The Readme's suggestion; without any light, ambient light alone shows what is there.
        let intensity = if self.lights.is_empty() { 1.0 } else { count.sqrt() / (2.0 * count) };
        let intensity = Rgb::gray(intensity as f32);
        let mut scene = self.scene;
        scene.camera = self.camera;
        scene.background = Background::Color(self.background);
        scene.ambient = intensity;
        if let Some([width, height]) = self.resolution {
            (scene.settings.width, scene.settings.height) = (width, height);
        }
        scene.lights.extend(self.lights.into_iter().map(|(position, color)| Light {
            name: None,
            kind: LightKind::Point { position },
            intensity: color.unwrap_or(intensity),
            spectrum: None,
            falloff: Falloff::None,
        }));
        scene
    }

    /// Turns the polygons of the current fill into objects.
    fn flush(&mut self) {
        for mut mesh in [std::mem::take(&mut self.polygons).mesh, std::mem::take(&mut self.patches).mesh] {
            if !mesh.triangles.is_empty() {
                repair_normals(&mut mesh);
                let mesh = self.scene.meshes.push(mesh);
                self.shape(Shape::Mesh(mesh), true);
            }
        }
    }

    fn shape(&mut self, shape: Shape, outside: bool) {
        let material = self.material(outside);
        self.scene.objects.push(Object { material: Some(material), ..Object::shape(shape) });
    }

    /// The current fill's material.
    fn material(&mut self, outside: bool) -> Id<Material> {
        let Fill { color, diffuse, specular, shininess, transmittance, index } = self.fill;
        let one_sided = outside && transmittance == 0.0;
        let [r, g, b] = color.to_array();
        let key = [r, g, b, diffuse, specular, shininess, transmittance].map(f64::from);
        let key = ([key[0], key[1], key[2], key[3], key[4], key[5], key[6], index].map(f64::to_bits), one_sided);
        if let Some(&material) = self.materials.get(&key) {
            return material;
        }
        let mut texture = |color: Rgb| self.scene.textures.push(Texture::constant(color));
        let transparent = transmittance > 0.0;
        let reflects = specular > 0.0;
        let material = Material {
            diffuse: Some(texture(color * diffuse)),
            specular: reflects.then(|| texture(Rgb::gray(specular))),
            shininess,
            mirror: (reflects && !transparent).then(|| texture(Rgb::gray(specular))),
            dielectric: transparent.then(|| Dielectric {
                ior: Dispersion::Constant(index),
                fresnel: false,
                reflect: texture(Rgb::gray(specular)),
                transmit: texture(color * transmittance),
                roughness: 0.0,
                film: None,
                medium: Medium::default(),
                measured_ior: None,
                extinction: None,
                priority: 0,
            }),
            one_sided,
            ..Material::default()
        };
        let material = self.scene.materials.push(material);
        self.materials.insert(key, material);
        material
    }
}

//! What a mesh file gives: a mesh with the materials and pictures that it names, not yet part of any scene.

use snell_math::{Dispersion, Point3, Rgb, Transform, Vector3};

use crate::Scene;
use crate::scene::{Dielectric, ImageAsset, Mapping, Material, Medium, Mesh, Pattern, Space, Texture};
use crate::table::{Id, Table};

/// A mesh and everything that came with it. [`MeshFile::add_to`] makes it part of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshFile {
    /// The mesh. Its `triangle_materials` are places in the `materials` below; its own `materials` are still empty.
    pub mesh: Mesh,
    /// The materials that its triangles use, in the order of their first use.
    pub materials: Vec<MaterialFile>,
    /// The pictures that these materials use, each file once.
    pub images: Vec<ImageAsset>,
}

/// A [`Material`] whose colours are not yet textures of a scene. The fields mean the same.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MaterialFile {
    /// Its name in the file.
    pub name: Option<String>,
    /// Light it gives off.
    pub emission: Option<ColorFile>,
    /// The factor on ambient light; where absent, the diffuse colour.
    pub ambient: Option<ColorFile>,
    /// Diffuse reflectance.
    pub diffuse: Option<ColorFile>,
    /// Strength and colour of the highlight.
    pub specular: Option<ColorFile>,
    /// The highlight's exponent.
    pub shininess: f32,
    /// The coefficient of the mirrored ray.
    pub mirror: Option<ColorFile>,
    /// Where it is transparent.
    pub dielectric: Option<DielectricFile>,
}

/// A [`Dielectric`] with a clear inside.
#[derive(Clone, Debug, PartialEq)]
pub struct DielectricFile {
    /// The index of refraction.
    pub ior: f64,
    /// Shares by Fresnel's equations, scaled by the coefficients; or else by the coefficients alone.
    pub fresnel: bool,
    /// The coefficient of the reflected ray.
    pub reflect: ColorFile,
    /// The coefficient of the refracted ray.
    pub transmit: ColorFile,
}

/// A colour, or a picture in its place.
#[derive(Clone, Debug, PartialEq)]
pub enum ColorFile {
    /// The same scene-linear colour everywhere.
    Constant(Rgb),
    /// A picture at the surface's (u, v), after `scale · (u, v) + offset`.
    Image {
        /// The place in [`MeshFile::images`].
        image: usize,
        /// Repeated outside [0, 1]², or else the border's colour.
        repeat: bool,
        /// Factors on u and v.
        scale: [f64; 2],
        /// Added to u and v.
        offset: [f64; 2],
    },
}

impl MeshFile {
    /// Adds pictures, textures, materials and the mesh to a scene's tables, and says where the mesh is. No object is added.
    pub fn add_to(self, scene: &mut Scene) -> Id<Mesh> {
        let images: Vec<_> = self.images.into_iter().map(|image| scene.images.push(image)).collect();
        let mut mesh = self.mesh;
        for material in self.materials {
            let material = material.resolve(&mut scene.textures, &images);
            mesh.materials.push(scene.materials.push(material));
        }
        scene.meshes.push(mesh)
    }
}

impl MaterialFile {
    /// The material, with its colours added to the table of textures.
    fn resolve(self, textures: &mut Table<Texture>, images: &[Id<ImageAsset>]) -> Material {
        let mut texture = |color: ColorFile| textures.push(color.resolve(images));
        Material {
            emission: self.emission.map(&mut texture),
            emission_spectrum: None,
            ambient: self.ambient.map(&mut texture),
            diffuse: self.diffuse.map(&mut texture),
            specular: self.specular.map(&mut texture),
            mirror: self.mirror.map(&mut texture),
            dielectric: self.dielectric.map(|d| Dielectric {
                ior: Dispersion::Constant(d.ior),
                fresnel: d.fresnel,
                reflect: texture(d.reflect),
                transmit: texture(d.transmit),
                roughness: 0.0,
                film: None,
                medium: Medium::default(),
                measured_ior: None,
                extinction: None,
                priority: 0,
            }),
            name: self.name,
            shininess: self.shininess,
            metal: None,
            one_sided: false,
        }
    }
}

impl ColorFile {
    fn resolve(self, images: &[Id<ImageAsset>]) -> Texture {
        match self {
            Self::Constant(color) => Texture::constant(color),
            Self::Image { image, repeat, scale, offset } => {
                let [x, y] = scale.map(|factor| if factor == 0.0 { 1.0 } else { factor });
                let columns = (Vector3::new(x, 0.0, 0.0), Vector3::new(0.0, y, 0.0), Vector3::Z);
                let origin = Point3::new(offset[0], offset[1], 0.0);
                // Scales whose inverse is not finite stand for nothing: the picture as it is.
                let texture_from_space =
                    Transform::from_columns(columns.0, columns.1, columns.2, origin).unwrap_or(Transform::IDENTITY);
                Texture {
                    pattern: Pattern::Image { image: images[image], repeat, smooth: true },
                    mapping: Mapping { space: Space::Uv, texture_from_space },
                }
            }
        }
    }
}

//! From the scene as its author described it to the flat, immutable form that is traced.

mod count;
mod images;
mod names;
mod objects;
mod overlap;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use snell_math::dispersion::fraunhofer::SODIUM_D;
use snell_math::{Point3, Ray, Rgb};
use snell_scene::scene::{self, Scene};
use snell_scene::{Diagnostic, Severity, Span};

pub use names::ObjectNames;
pub use overlap::overlapping_bodies;

use crate::accel::BuildQuality;
use crate::differential::RayDifferential;
use crate::geometry::{Geometry, Hit, QueryScratch};
use crate::interaction::{SurfaceInteraction, Surroundings};
use crate::light::{Light, LightOrigin};
use crate::material::Material;
use crate::task::{Inside, MediumStack, MediumStacks};
use crate::texture::{Background, Textures};

/// A scene ready to be traced: never changed, shared by all threads.
#[derive(Debug)]
pub struct CompiledScene {
    /// What rays can meet.
    pub geometry: Geometry,
    /// The materials.
    pub materials: Vec<Material>,
    /// The textures.
    pub textures: Textures,
    /// The lights.
    pub lights: Vec<Light>,
    /// Ambient light.
    pub ambient: Rgb,
    /// The camera, still without a picture's size.
    pub camera: scene::Camera,
    /// The names of the objects, by their number; those without one are named after what they are.
    pub object_names: ObjectNames,
    /// The names of the materials, by their number: "material 3" for the third where it has none.
    pub material_names: Vec<String>,
    /// The names of the lights, by their number.
    pub light_names: Vec<String>,
    /// What is odd about the scene but renders all the same.
    pub warnings: Vec<Diagnostic>,
    /// What a ray sees that hits nothing.
    pub background: Background,
    /// For each material, its body's index of refraction at the D line; 1 where it is opaque.
    indices_d: Vec<f64>,
    /// By the number of a transparent object, where the scene says so.
    body_spans: BTreeMap<u32, Span>,
    /// Any light goes through any material.
    has_bodies: bool,
    /// Some picture is seen, on a surface or in the background.
    sees_pictures: bool,
}

/// A light that is seen under a smaller angle, in radians, is as good as a point.
const POINT_LIKE: f64 = 1e-4;

/// What keeps a scene from being compiled: errors, and the warnings that came with them.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{}", self.first_message())]
pub struct CompileError {
    /// What was found, in the order of finding.
    pub diagnostics: Vec<Diagnostic>,
}

impl CompileError {
    fn first_message(&self) -> &str {
        let is_error = |d: &&Diagnostic| d.severity == Severity::Error;
        self.diagnostics.iter().find(is_error).map_or("the scene cannot be compiled", |d| &d.message)
    }
}

/// Sizes of a compiled scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneSize {
    /// Triangles in meshes, each mesh counted once.
    pub triangles: u64,
    /// Primitives that hierarchies hold, triangles not counted.
    pub primitives: u64,
}

/// Names as they are given, or else after the kind of thing and its number from 1.
fn names<'a>(given: impl Iterator<Item = Option<&'a str>>, kind: &str) -> Vec<String> {
    given.zip(1..).map(|(name, number)| name.map_or_else(|| format!("{kind} {number}"), str::to_owned)).collect()
}

/// Those of a scene's materials, and the one of things that have none.
fn material_names(scene: &Scene) -> Vec<String> {
    let mut names = names(scene.materials.iter().map(|material| material.name.as_deref()), "material");
    names.push("default material".to_owned());
    names
}

impl CompiledScene {
    /// Compiles a scene: decodes its pictures, flattens its objects, builds its hierarchies.
    ///
    /// # Errors
    /// [`CompileError`] with everything that is wrong: pictures that cannot be decoded, textures that refer to themselves,
    /// more primitives than can be counted.
    pub fn build(scene: &Scene) -> Result<Self, CompileError> {
        Self::with_quality(scene, BuildQuality::Medium)
    }

    /// As [`CompiledScene::build`], with more or less work for the hierarchies: no picture depends on it, only how long building
    /// and rendering take.
    ///
    /// # Errors
    /// As [`CompiledScene::build`].
    pub fn with_quality(scene: &Scene, quality: BuildQuality) -> Result<Self, CompileError> {
        let mut diagnostics = Vec::new();
        let images = images::decode_all(&scene.images, &mut diagnostics);
        if !diagnostics.is_empty() {
            return Err(CompileError { diagnostics });
        }
        let textures = Textures::compile(&scene.textures, &images)
            .map_err(|error| diagnostics.push(Diagnostic::error(error.to_string())));
        let background = Background::compile(&scene.background, &images)
            .map_err(|error| diagnostics.push(Diagnostic::error(error.to_string())));
        let (Ok(textures), Ok(background)) = (textures, background) else {
            return Err(CompileError { diagnostics });
        };
        let mut materials: Vec<Material> =
            scene.materials.iter().map(|material| Material::new(material, &textures)).collect();
        materials.push(Material::unspecified());
        let Some(objects::Compiled { geometry, names: object_names, body_spans }) =
            objects::compile(scene, &materials, &textures, quality, &mut diagnostics)
        else {
            return Err(CompileError { diagnostics });
        };
        Ok(Self {
            geometry,
            lights: scene.lights.iter().map(Light::new).collect(),
            ambient: scene.ambient,
            camera: scene.camera.clone(),
            object_names,
            material_names: material_names(scene),
            light_names: names(scene.lights.iter().map(|light| light.name.as_deref()), "light"),
            warnings: diagnostics,
            body_spans,
            indices_d: materials.iter().map(|m| m.body.as_ref().map_or(1.0, |b| b.ior.index(SODIUM_D))).collect(),
            has_bodies: materials.iter().any(|m| m.body.is_some()),
            sees_pictures: background.is_picture() || materials.iter().any(|m| m.spaces(&textures).footprint),
            materials,
            textures,
            background,
        })
    }

    /// How much there is of it.
    pub fn size(&self) -> SceneSize {
        let Geometry { world, prototypes, meshes, .. } = &self.geometry;
        let primitives = std::iter::once(world).chain(prototypes).map(|space| space.primitives.len() as u64).sum();
        SceneSize { triangles: meshes.iter().map(|mesh| mesh.triangle_count() as u64).sum(), primitives }
    }

    /// The names of lights that have no extent, or next to none: those that no ray meets by chance.
    pub fn lights_without_extent(&self) -> Vec<&str> {
        let has_extent =
            |light: &Light| matches!(light.origin(), LightOrigin::Direction(_, angle) if angle > POINT_LIKE);
        let all = self.lights.iter().zip(&self.light_names);
        let without = all.filter(|(light, _)| !light.intensity().is_black() && !has_extent(light));
        without.map(|(_, name)| name.as_str()).collect()
    }

    /// Everything about a hit that shading needs.
    #[inline]
    pub fn interaction(&self, ray: &Ray, hit: &Hit) -> SurfaceInteraction {
        self.geometry.interaction(ray, hit)
    }

    /// The index of refraction at the D line of what is there: of a body, or 1 outside of all.
    #[inline]
    pub fn index_d(&self, inside: Option<Inside>) -> f64 {
        inside.map_or(1.0, |inside| self.indices_d[inside.material as usize])
    }

    /// True where some picture is seen, on a surface or in the background: rays know then how their neighbours differ, so that it is
    /// not seen point by point.
    #[inline]
    pub fn sees_pictures(&self) -> bool {
        self.sees_pictures
    }

    /// What the neighbours of a ray meet, where the material makes something of it.
    pub fn surroundings(
        &self,
        ray: &Ray,
        hit: &Hit,
        interaction: &SurfaceInteraction,
        differential: &RayDifferential,
    ) -> Surroundings {
        let material = &self.materials[interaction.material as usize];
        if !(material.sends_rays() || self.geometry.spaces[interaction.material as usize].footprint) {
            return Surroundings::NONE;
        }
        self.geometry.surroundings(ray, hit, interaction, differential)
    }

    /// The bodies that a point is in, as a stack with the innermost on top.
    pub fn media_around(&self, point: Point3, media: &mut MediumStacks, query: &mut QueryScratch) -> MediumStack {
        if !self.has_bodies {
            return MediumStack::default();
        }
        let bodies = self.geometry.bodies_around(point, query);
        bodies.into_iter().fold(MediumStack::default(), |stack, (solid, material)| {
            let priority = self.materials[material as usize].body.as_ref().map_or(0, |body| body.priority);
            media.enter(stack, Inside { solid, material, priority })
        })
    }
}

//! From the model to the [`Scene`]: names become ids, degrees radians, files bytes; and every mistake of meaning is told.
//!
//! Each part goes on after a mistake with some harmless value, so that all mistakes are found; where there was any, the
//! scene is not given out.

mod camera_lens;
mod drawing;
mod files;
mod ior;
mod lens;
mod light;
mod material;
mod mesh;
mod object;
mod order;
mod placement;
mod plot;
mod shape;
mod size;
mod spectrum;
mod texture;
mod view;

use std::collections::BTreeMap;

use snell_math::Vector3;

use super::model::{self, Either, Located, Triple};
use crate::assets::Assets;
use crate::diagnostic::{Diagnostic, Diagnostics, Span};
use crate::scene::{self, ImageAsset, Material, Mesh, Prototype, Scene, Texture};
use crate::table::Id;

/// The largest picture.
const MAX_PIXELS: u64 = 1 << 28;

/// Resolves a document; `base` is the path of the scene file. Objects are used up one by one, since they may be very many.
pub(in crate::document) fn resolve(
    document: model::Document,
    base: &str,
    assets: &dyn Assets,
    diagnostics: &mut Diagnostics,
) -> Scene {
    let mut resolver = Resolver {
        scene: Scene::default(),
        base: base.to_owned(),
        assets,
        diagnostics,
        unit_mm: document.unit.as_ref().map(|unit| millimetres(&unit.value)),
        images: BTreeMap::new(),
        textures: BTreeMap::new(),
        materials: BTreeMap::new(),
        prototypes: BTreeMap::new(),
        meshes: BTreeMap::new(),
        default_material: None,
    };
    resolver.settings(&document);
    resolver.scene.ambient = document.ambient.0;
    resolver.scene.camera = resolver.camera(&document.camera);
    if let Some(background) = &document.background {
        resolver.scene.background = resolver.background(background);
    }
    resolver.scene.lights = document.light.iter().map(|light| resolver.light(light)).collect();
    resolver.named_textures(&document.texture);
    for (name, material) in &document.material.0 {
        let material = resolver.material(&material.value, Some(&name.value));
        let id = resolver.scene.materials.push(material);
        resolver.materials.insert(name.value.clone(), id);
    }
    resolver.named_prototypes(document.prototype);
    resolver.world(document.object);
    let aspect = f64::from(document.image.width) / f64::from(document.image.height);
    resolver.scene.drawing = resolver.drawing(&document.drawing, aspect);
    resolver.scene.plots = resolver.plots(&document.plot);
    resolver.scene
}

/// Of something measured, the scene's unit of length must be known.
fn needs_unit(what: &str, span: &Option<Span>) -> Diagnostic {
    let message = format!("{what}, but how long a world unit is has not been said");
    let diagnostic = Diagnostic::error(message).at_optional(span.clone(), "needs the scene's `unit`");
    diagnostic
        .help("write `unit = \"cm\"` at the top of the scene, or \"mm\", \"m\", \"in\" or a number of millimetres")
}

fn millimetres(unit: &model::Unit) -> f64 {
    match unit {
        Either::A(model::UnitName::Mm) => 1.0,
        Either::A(model::UnitName::Cm) => 10.0,
        Either::A(model::UnitName::M) => 1000.0,
        Either::A(model::UnitName::In) => 25.4,
        Either::B(millimetres) => *millimetres,
    }
}

struct Resolver<'a> {
    scene: Scene,
    /// The file against which names of files are resolved.
    base: String,
    assets: &'a dyn Assets,
    diagnostics: &'a mut Diagnostics,
    /// How many millimetres a world unit is long, where the author said so.
    unit_mm: Option<f64>,
    /// By resolved path.
    images: BTreeMap<String, Id<ImageAsset>>,
    textures: BTreeMap<String, Id<Texture>>,
    materials: BTreeMap<String, Id<Material>>,
    prototypes: BTreeMap<String, Id<Prototype>>,
    /// By resolved path and the bits of the smoothing angle.
    meshes: BTreeMap<(String, Option<u64>), Id<Mesh>>,
    /// The material of objects without one, made when first needed.
    default_material: Option<Id<Material>>,
}

impl Resolver<'_> {
    fn error(&mut self, span: &Option<Span>, message: impl Into<String>, label: impl Into<String>) {
        self.diagnostics.push(Diagnostic::error(message).at_optional(span.clone(), label));
    }

    /// A direction scaled to unit length; where it has no length, that is told and `instead` is given.
    fn direction(&mut self, vector: &Located<Triple>, what: &str, instead: Vector3) -> Vector3 {
        Vector3::from(vector.value).try_normalize().unwrap_or_else(|| {
            self.error(&vector.span, format!("{what} has no length, and so no direction"), "all three are 0");
            instead
        })
    }

    fn settings(&mut self, document: &model::Document) {
        let (image, render) = (&document.image, &document.render);
        if u64::from(image.width) * u64::from(image.height) > MAX_PIXELS {
            self.diagnostics.push(Diagnostic::error(format!(
                "the picture of {} × {} pixels is too large: at most {MAX_PIXELS} pixels are possible",
                image.width, image.height
            )));
        }
        self.scene.settings = scene::Settings {
            width: image.width,
            height: image.height,
            depth: render.depth,
            min_weight: render.min_weight,
            weightless_rays: false,
            antialiasing: match render.antialiasing {
                Either::A(model::AntialiasingMethod::None) => scene::Antialiasing::None,
                Either::A(model::AntialiasingMethod::Adaptive) => scene::Antialiasing::Adaptive,
                Either::B(samples) => scene::Antialiasing::Samples(samples),
            },
            shadows: match render.shadows {
                model::Shadows::Filtered => scene::Shadows::Filtered,
                model::Shadows::Opaque => scene::Shadows::Opaque,
                model::Shadows::None => scene::Shadows::None,
            },
            bands: render.bands,
            integrator: match render.integrator {
                model::Integrator::Whitted => scene::IntegratorKind::Whitted,
                model::Integrator::Path => scene::IntegratorKind::Path,
            },
            samples: render.samples,
            tone: match image.tone {
                model::Tone::None => scene::Tone::None,
                model::Tone::Reinhard => scene::Tone::Reinhard,
                model::Tone::Filmic => scene::Tone::Filmic,
            },
            exposure: image.exposure,
            pixel_grid: match image.pixel_grid {
                model::PixelGrid::Centers => scene::PixelGrid::Centers,
                model::PixelGrid::Corners => scene::PixelGrid::Corners,
            },
        };
    }
}

//! What an integrator cannot show of a scene, told before the picture is dark.

use snell_scene::Diagnostic;

use super::PathSettings;
use crate::compile::CompiledScene;

/// Light that a picture will lack, by `whitted` or by paths.
///
/// ```
/// use snell::compile::CompiledScene;
/// use snell::math::Rgb;
/// use snell::render::{PathSettings, warnings};
/// use snell::scene::scene::{Material, Object, Scene, Shape, Texture};
///
/// let mut scene = Scene { ambient: Rgb::BLACK, ..Scene::default() };
/// let shape = Shape::Sphere { center: snell::math::Point3::ORIGIN, radius: 1.0 };
/// let emission = Some(scene.textures.push(Texture::constant(Rgb::WHITE)));
/// let material = Some(scene.materials.push(Material { emission, ..Material::default() }));
/// scene.objects.push(Object { material, ..Object::shape(shape) });
/// let compiled = CompiledScene::build(&scene).unwrap();
/// assert!(warnings(&compiled, None)[0].message.contains("light nothing"));
/// assert!(warnings(&compiled, Some(&PathSettings::default())).is_empty());
/// ```
pub fn warnings(scene: &CompiledScene, paths: Option<&PathSettings>) -> Vec<Diagnostic> {
    let mut list = Vec::new();
    let Some(paths) = paths else {
        let has_lamps = scene.materials.iter().any(|material| material.emits());
        let is_lit = !scene.ambient.is_black() || scene.lights.iter().any(|light| !light.intensity().is_black());
        if has_lamps && !is_lit {
            let message = "surfaces with `emission` light nothing by `whitted`, and there is no other light";
            list.push(Diagnostic::warning(message).help("use --integrator path, or add a [[light]]"));
        }
        return list;
    };
    let point_like = scene.lights_without_extent();
    if point_like.is_empty() {
        return list;
    }
    let names = point_like.join(", ");
    if !paths.photons && scene.materials.iter().any(|material| material.is_specular()) {
        let message = format!("light of {names} does not come through glass or off mirrors without photons");
        let help = "leave --no-photons out: a light without extent is met by no path";
        list.push(Diagnostic::warning(message).help(help));
    }
    list
}

//! How paths are traced, by what the command line and the scene say.

use snell::compile::CompiledScene;
use snell::render::{PathSettings, RenderSettings, Watch};
use snell::scene::scene::IntegratorKind;
use snell::scene::{Diagnostic, Scene};

use crate::arguments::{IntegratorName, PathArguments, PictureArguments};
use crate::failure::Failure;

/// How paths are traced; `None` where `whitted` makes the picture. A flag that is for the other of both is refused; `flags` are those of
/// paths that only the command has, with whether they are given.
pub fn settings(
    arguments: &PathArguments,
    picture: &PictureArguments,
    scene: &Scene,
    flags: &[(&str, bool)],
) -> Result<Option<PathSettings>, Failure> {
    let PathArguments { integrator, samples, seed, no_photons } = arguments;
    let of_scene = scene.settings.integrator == IntegratorKind::Path;
    if !integrator.map_or(of_scene, |name| name == IntegratorName::Path) {
        let own = [("--samples", samples.is_some()), ("--seed", seed.is_some()), ("--no-photons", *no_photons)];
        return match own.iter().chain(flags).find(|(_, is_given)| *is_given) {
            None => Ok(None),
            Some((flag, _)) => {
                let message = format!("{flag} is for path tracing, and this picture is rendered by `whitted`");
                Err(Failure::usage(Diagnostic::error(message).help("add --integrator path, or leave it out")))
            }
        };
    }
    let PictureArguments { aa, min_weight, shadows, bands, wavelength, .. } = picture;
    let others = [
        ("--aa", aa.is_some()),
        ("--min-weight", min_weight.is_some()),
        ("--shadows", shadows.is_some()),
        ("--bands", bands.is_some()),
        ("--wavelength", wavelength.is_some()),
    ];
    if let Some((flag, _)) = others.into_iter().find(|(_, is_given)| *is_given) {
        let message = format!("{flag} is for `whitted`, and the paths of this picture are traced");
        let help = if flag == "--aa" {
            "use --samples, or --integrator whitted"
        } else {
            "leave it out, or use --integrator whitted"
        };
        return Err(Failure::usage(Diagnostic::error(message).help(help)));
    }
    let defaults = PathSettings::default();
    Ok(Some(PathSettings {
        samples: samples.unwrap_or(scene.settings.samples),
        photons: !no_photons,
        depth: picture.depth.and_then(|depth| u16::try_from(depth).ok()).unwrap_or(defaults.depth),
        seed: seed.unwrap_or(defaults.seed),
        ..defaults
    }))
}

/// A picture whose rays are watched, by the integrator that makes it.
pub fn watch<'a>(
    scene: &'a CompiledScene,
    settings: &'a RenderSettings,
    paths: Option<&PathSettings>,
) -> Result<Watch<'a>, Failure> {
    let watch = match paths {
        Some(paths) => Watch::paths(scene, settings, paths),
        None => Watch::new(scene, settings),
    };
    watch.map_err(|error| Failure::input(Diagnostic::error(error.to_string())))
}

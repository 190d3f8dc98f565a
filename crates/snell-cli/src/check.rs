//! `snell check`: reads and compiles scenes, and tells all that is wrong with them.

use snell::compile::{CompiledScene, overlapping_bodies};
use snell::drawing::{self, DrawingSettings};
use snell::render::RenderSettings;
use snell::scene::{Diagnostic, Diagnostics};

use crate::arguments::CheckArguments;
use crate::assets::FileAssets;
use crate::console::write_stdout;
use crate::diagnostics;
use crate::failure::{FINE, Failure, WRONG_INPUT};
use crate::load::Place;

/// Checks all scenes, also after a wrong one. The exit code says whether any has errors.
pub fn run(arguments: &CheckArguments) -> Result<u8, Failure> {
    let mut code = FINE;
    for name in &arguments.scenes {
        let found = check(name).unwrap_or_else(|failure| failure.diagnostics);
        diagnostics::print(&found);
        let verdict = match found.counts() {
            (0, 1..) => format!("no errors, {}", diagnostics::summary(&found)),
            _ => diagnostics::summary(&found),
        };
        if found.has_errors() {
            code = WRONG_INPUT;
        }
        write_stdout(format!("{}: {verdict}\n", name.escape_debug()).as_bytes())?;
    }
    Ok(code)
}

fn check(name: &str) -> Result<Diagnostics, Failure> {
    let (scene, mut diagnostics) = Place::find(name)?.read(&[], &FileAssets::default())?;
    let Some(scene) = scene else { return Ok(diagnostics) };
    match CompiledScene::build(&scene) {
        Ok(compiled) => {
            if let Err(error) = RenderSettings::from(&scene.settings).camera(&compiled) {
                diagnostics.push(Diagnostic::error(error.to_string()));
            }
            // What only a drawing asks of its cameras and windows.
            if let Err(error) = drawing::check(&compiled, &DrawingSettings::new(&scene)) {
                diagnostics.push(Diagnostic::error(error.to_string()));
            }
            let overlaps = overlapping_bodies(&compiled);
            diagnostics.list.extend(compiled.warnings);
            diagnostics.list.extend(overlaps);
        }
        Err(error) => diagnostics.list.extend(error.diagnostics),
    }
    Ok(diagnostics)
}

//! Our own scene format, TOML or JSON: one model ([`model`]) drives the reader, the published schema, the reference
//! `docs/scene-format.md` and the completions of `--set`.
//!
//! Reading goes: text → `tree` of values with places (`plain`, `parse`, `json`) → `--set` (`overrides`) → mistakes of form, all
//! of them, against the schema (`check`) → the model through serde (`deserialize`) → mistakes of meaning, all of them, and
//! the [`Scene`] (`resolve`). What has mistakes of form is left out, so that the rest is still examined for meaning.

mod check;
mod color;
mod deserialize;
mod json;
mod keys;
pub mod model;
mod overrides;
mod parse;
mod plain;
mod reference;
mod resolve;
mod schema;
mod tree;

#[cfg(test)]
mod tests;

use serde::Deserialize;

pub use keys::{KeyInfo, keys};
pub use reference::reference;
pub use schema::schema;

use crate::assets::Assets;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::scene::Scene;

/// Reads a scene file. `name` is its path as the user knows it, and the base of the files that it names; one that ends with
/// `.json` is read as JSON, any other as TOML. `overrides` are the texts `KEY=VALUE` of `--set`.
///
/// The scene is there exactly where the diagnostics have no errors.
///
/// ```
/// use snell_scene::{assets::MemoryAssets, document::read_scene};
/// let text = b"[[object]]\nsphere = { radius = -1 }\n";
/// let (scene, diagnostics) = read_scene("a.toml", text, &MemoryAssets::default(), &[]);
/// assert!(scene.is_none());
/// assert_eq!(diagnostics.list[0].message, "`object.0.sphere.radius` is -1, but must be above 0");
///
/// let set = ["object.0.sphere.radius=1".to_owned()];
/// let (scene, _) = read_scene("a.toml", text, &MemoryAssets::default(), &set);
/// assert_eq!(scene.unwrap().objects.len(), 1);
/// ```
pub fn read_scene(name: &str, bytes: &[u8], assets: &dyn Assets, overrides: &[String]) -> (Option<Scene>, Diagnostics) {
    let mut diagnostics = Diagnostics::default();
    let scene = read(name, bytes, assets, overrides, &mut diagnostics);
    // In the order of the texts, whichever check has found them.
    let place = |diagnostic: &Diagnostic| diagnostic.place.as_ref().map(|(span, _)| (span.source, span.range.start));
    diagnostics.list.sort_by_key(|diagnostic| (diagnostic.place.is_none(), place(diagnostic)));
    let scene = scene.filter(|_| !diagnostics.has_errors());
    shorten(&mut diagnostics);
    (scene, diagnostics)
}

/// Reads a TOML file that a scene names and that holds one table of the schema, such as a lens; `called` is what messages call it.
/// `None` where it has mistakes, which are told.
fn read_table<T: for<'de> Deserialize<'de>>(
    name: &str,
    bytes: &[u8],
    [definition, called]: [&'static str; 2],
    diagnostics: &mut Diagnostics,
) -> Option<T> {
    let text = String::from_utf8_lossy(bytes);
    let source = diagnostics.sources.add(name, &*text);
    if text.len() > tree::Place::LONGEST {
        diagnostics.push(Diagnostic::error(format!("the file {name:?} is too long for {called}")));
        return None;
    }
    let root = parse::document(&text, source, diagnostics)?;
    if !check::check_table(&root, &schema::RuleBook::new(), definition, called, diagnostics) {
        return None;
    }
    match T::deserialize(root) {
        Ok(table) => Some(table),
        Err(mismatch) => {
            diagnostics.push(Diagnostic::error(format!("the file {name:?} cannot be read: {mismatch}")));
            None
        }
    }
}

/// How much is told of one scene.
const MAX_TOLD: usize = 200;

/// Leaves out what nobody would read, but not how much that is and how bad.
fn shorten(diagnostics: &mut Diagnostics) {
    let left_out = diagnostics.list.split_off(MAX_TOLD.min(diagnostics.list.len()));
    if let Some(severity) = left_out.iter().map(|diagnostic| diagnostic.severity).max() {
        let message = format!("{} more mistakes are left out here", left_out.len());
        diagnostics.push(Diagnostic { severity, ..Diagnostic::error(message) });
    }
}

fn read(
    name: &str,
    bytes: &[u8],
    assets: &dyn Assets,
    overrides: &[String],
    diagnostics: &mut Diagnostics,
) -> Option<Scene> {
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => {
            let source = diagnostics.sources.add(name, String::from_utf8_lossy(bytes));
            let at = error.valid_up_to();
            let span = crate::diagnostic::Span { source, range: at..at + '\u{fffd}'.len_utf8() };
            diagnostics.push(Diagnostic::error("the file is not UTF-8 text").at(span, "from here on"));
            return None;
        }
    };
    let source = diagnostics.sources.add(name, text);
    if text.len().max(overrides.iter().map(String::len).max().unwrap_or(0)) > tree::Place::LONGEST {
        let message = format!("the text is longer than {} bytes", tree::Place::LONGEST);
        diagnostics.push(Diagnostic::error(message).help("write meshes as files of their own"));
        return None;
    }
    let is_json = name.get(name.len().saturating_sub(5)..).is_some_and(|end| end.eq_ignore_ascii_case(".json"));
    let parsed =
        if is_json { json::document(text, source, diagnostics) } else { parse::document(text, source, diagnostics) };
    let mut root = parsed?;
    overrides::apply(&mut root, overrides, diagnostics);
    if !overrides.is_empty() && root.depth() > parse::MAX_NESTING {
        diagnostics.push(Diagnostic::error("the scene is nested too deeply with what `--set` puts into it"));
        return None;
    }
    check::check(&mut root, &schema::RuleBook::new(), diagnostics);
    match model::Document::deserialize(root) {
        Ok(document) => Some(resolve::resolve(document, name, assets, diagnostics)),
        Err(mismatch) => {
            diagnostics.push(Diagnostic::error(format!("the scene cannot be read: {mismatch}")));
            None
        }
    }
}

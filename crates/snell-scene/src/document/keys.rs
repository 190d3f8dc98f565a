//! All keys of a scene file, for the completion of `--set` and for whoever wants a list.

use super::schema::{Part, schema};

/// A key of the scene file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeyInfo {
    /// The way to it, as `--set` takes it; `NAME` stands for a name or an index.
    pub path: String,
    /// What it takes, with range and unit: "a number above 0, in world units".
    pub expected: String,
    /// What it is: the first sentence of its description.
    pub summary: String,
}

/// All keys, in the order of the reference. Where objects stand within objects, only the outer ones are listed.
///
/// ```
/// let keys = snell_scene::document::keys();
/// let fov = keys.iter().find(|key| key.path == "camera.fov").unwrap();
/// assert_eq!(fov.expected, "a number from 0.0001 to 179.9, in degrees");
/// assert!(keys.iter().any(|key| key.path == "object.NAME.sphere.radius"));
/// ```
pub fn keys() -> Vec<KeyInfo> {
    let schema = schema();
    let mut keys = Vec::new();
    if let Some(root) = Part::root(&schema) {
        walk(root, "", &mut Vec::new(), &mut keys);
    }
    keys
}

fn walk<'a>(table: Part<'a>, path: &str, within: &mut Vec<&'a str>, keys: &mut Vec<KeyInfo>) {
    for (name, part) in table.properties().filter(|(name, _)| !name.starts_with('$')) {
        let path = if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
        let description = part.text("description").unwrap_or_default();
        keys.push(KeyInfo {
            path: path.clone(),
            expected: super::check::expected(part),
            summary: first_sentence(description).to_owned(),
        });
        inside(part, &path, within, keys);
    }
}

/// The keys of the tables that a value may be, or its items.
fn inside<'a>(part: Part<'a>, path: &str, within: &mut Vec<&'a str>, keys: &mut Vec<KeyInfo>) {
    for form in part.forms() {
        let below = match form.kind() {
            Some("object") => match form.entries() {
                Some(entry) => {
                    inside(entry, &format!("{path}.NAME"), within, keys);
                    continue;
                }
                None => form,
            },
            Some("array") => match form.items() {
                Some(item) if item.forms().iter().any(|form| form.kind() == Some("object")) => {
                    inside(item, &format!("{path}.NAME"), within, keys);
                    continue;
                }
                _ => continue,
            },
            _ => continue,
        };
        let reference = below.reference().unwrap_or_default();
        if within.contains(&reference) {
            continue;
        }
        within.push(reference);
        walk(below, path, within, keys);
        within.pop();
    }
}

pub(super) fn first_sentence(text: &str) -> &str {
    text.find(". ").map_or(text, |end| &text[..=end])
}

//! From the statements of an MTL file to a material.
//!
//! Wavefront's illumination models, as far as one light-surface interaction goes: 0 gives off its diffuse colour, 1 is diffuse,
//! 2 adds the highlight, from 3 on the specular colour mirrors as well, 4, 6, 7 and 9 are glass, 5 and 7 follow Fresnel, 8
//! and 9 mirror nothing. Colours are scene-linear, as they stand.
//!
//! Transparent is what has d < 1 (or Tr > 0), or is glass by its model and says so by d, Tf or Ni. Its transmission is
//! Tf · (1 − d), where Tf is white if absent and 1 − d is 1 for glass with d = 1; its diffuse colour is scaled by d. A
//! picture takes the place of its colour; a picture for the diffuse colour colours ambient light too.

use std::collections::{BTreeMap, HashMap};

use snell_math::Rgb;

use super::Parser;
use super::mtl::{self, Map, Statements};
use crate::assets::{AssetError, Assets};
use crate::diagnostic::{Diagnostic, did_you_mean};
use crate::reader::mesh_file::{ColorFile, DielectricFile, MaterialFile};
use crate::reader::report::{Report, quoted};
use crate::reader::text::{Word, Words};
use crate::scene::ImageAsset;

/// How many libraries one file may name.
const MAX_LIBRARIES: usize = 256;
/// How many names are tried as what a misspelt one may mean.
const MAX_SUGGESTIONS: usize = 1000;
/// The diffuse reflectance of what has no material.
const PLAIN: Rgb = Rgb::gray(0.8);

/// Reads the libraries that an OBJ file names and gives the materials that its faces use, in the order of first use, with
/// their pictures. Where some faces come before the first `usemtl`, a plain material for them is the last.
pub(super) fn read(
    parser: &Parser<'_>,
    report: &mut Report<'_>,
    assets: &dyn Assets,
) -> (Vec<MaterialFile>, Vec<ImageAsset>) {
    let mut found = Found {
        wanted: &parser.material_numbers,
        materials: vec![None; parser.material_names.len()],
        defined: Vec::new(),
        images: Images::default(),
    };
    let mut seen = Vec::new();
    for library in &parser.libraries {
        found.library(report, assets, *library, &mut seen);
        if seen.len() > MAX_LIBRARIES {
            let message = format!("more than {MAX_LIBRARIES} material libraries: the others are not read");
            report.at(library.range(), "material libraries", || Diagnostic::warning(message));
            break;
        }
    }
    let mut materials = Vec::with_capacity(found.materials.len() + 1);
    for (material, name) in found.materials.into_iter().zip(&parser.material_names) {
        materials.push(material.unwrap_or_else(|| {
            // Without any library, names are but names.
            if !parser.libraries.is_empty() {
                report.at(name.range(), "materials that are not defined", || {
                    let text = String::from_utf8_lossy(name.text);
                    let near = did_you_mean(&text, found.defined.iter().map(String::as_str));
                    let warning = Diagnostic::warning(format!(
                        "the material {} is in no library: a plain grey one is taken",
                        quoted(name.text)
                    ));
                    match near {
                        Some(near) => warning.help(format!("did you mean `{near}`?")),
                        None => warning,
                    }
                });
            }
            plain(Some(String::from_utf8_lossy(name.text).into_owned()))
        }));
    }
    if super::assemble::has_unnamed(parser) {
        materials.push(plain(None));
    }
    (materials, found.images.list)
}

fn plain(name: Option<String>) -> MaterialFile {
    MaterialFile { name, diffuse: Some(ColorFile::Constant(PLAIN)), ..MaterialFile::default() }
}

/// What the libraries so far gave.
struct Found<'p, 'a> {
    wanted: &'p HashMap<&'a [u8], u32>,
    materials: Vec<Option<MaterialFile>>,
    /// Names of the first materials, for suggestions.
    defined: Vec<String>,
    images: Images,
}

impl Found<'_, '_> {
    /// Reads what one `mtllib` line names: one file whose name may hold spaces, or else several.
    fn library(&mut self, report: &mut Report<'_>, assets: &dyn Assets, line: Word<'_>, seen: &mut Vec<String>) {
        let bytes = report.bytes;
        let mut words: Vec<Word<'_>> = Words::new(bytes, line.range()).take(MAX_LIBRARIES + 1).collect();
        let whole = resolve(report.name, assets, line);
        if words.len() > 1 && (seen.contains(&whole) || !matches!(assets.read(&whole), Err(AssetError::NotFound))) {
            words = vec![line];
        }
        for word in words {
            let path = resolve(report.name, assets, word);
            if seen.contains(&path) {
                continue;
            }
            seen.push(path.clone());
            match assets.read(&path) {
                Ok(content) => {
                    let mut library = report.on(&path, &content);
                    mtl::read(&mut library, |library, statements| self.material(library, assets, statements));
                    if !library.finish() {
                        report.fail();
                    }
                }
                Err(error) => report.at(word.range(), "material libraries", || missing(&path, &error, assets)),
            }
        }
    }

    /// Keeps a material if a face uses it; the first of a name counts.
    fn material(&mut self, library: &mut Report<'_>, assets: &dyn Assets, statements: &Statements) {
        if self.defined.len() < MAX_SUGGESTIONS {
            self.defined.push(String::from_utf8_lossy(&statements.name).into_owned());
        }
        let Some(&number) = self.wanted.get(statements.name.as_slice()) else { return };
        if self.materials[number as usize].is_some() {
            let name = quoted(&statements.name);
            return library.at(statements.range.clone(), "materials defined twice", || {
                Diagnostic::warning(format!("the material {name} is defined before: this definition is left out"))
            });
        }
        let material = convert(statements, |map| self.images.load(library, assets, map));
        self.materials[number as usize] = Some(material);
    }
}

fn resolve(base: &str, assets: &dyn Assets, word: Word<'_>) -> String {
    assets.resolve(base, &String::from_utf8_lossy(word.text))
}

/// Says that a file is not there, and what may be meant.
fn missing(path: &str, error: &AssetError, assets: &dyn Assets) -> Diagnostic {
    let warning = Diagnostic::warning(format!("`{path}` is left out: {error}"));
    let similar = if matches!(error, AssetError::NotFound) { assets.similar(path) } else { Vec::new() };
    match did_you_mean(path, similar.iter().map(String::as_str)) {
        Some(near) => warning.help(format!("did you mean `{near}`?")),
        None => warning,
    }
}

/// The pictures so far, each file once.
#[derive(Default)]
struct Images {
    list: Vec<ImageAsset>,
    /// Where each path's picture is; nothing for one that could not be read.
    places: BTreeMap<String, Option<usize>>,
}

impl Images {
    fn load(&mut self, library: &mut Report<'_>, assets: &dyn Assets, map: &Map) -> Option<ColorFile> {
        let path = assets.resolve(library.name, &map.path);
        if !self.places.contains_key(&path) {
            let place = match assets.read(&path) {
                Ok(bytes) => {
                    let span = Some(library.span(map.range.clone()));
                    self.list.push(ImageAsset { name: path.clone(), bytes, span });
                    Some(self.list.len() - 1)
                }
                Err(error) => {
                    library.at(map.range.clone(), "pictures", || missing(&path, &error, assets));
                    None
                }
            };
            self.places.insert(path.clone(), place);
        }
        let image = (*self.places.get(&path)?)?;
        Some(ColorFile::Image { image, repeat: !map.clamp, scale: map.scale, offset: map.offset })
    }
}

/// The material that the statements describe. Black terms are left away.
fn convert(s: &Statements, mut picture: impl FnMut(&Map) -> Option<ColorFile>) -> MaterialFile {
    let visible = |color: Option<Rgb>| color.filter(|c| !c.is_black()).map(ColorFile::Constant);
    let mut term = |map: &Option<Map>, color: Option<Rgb>| map.as_ref().and_then(&mut picture).or(visible(color));
    let highlight = s.specular.is_some_and(|c| !c.is_black()) || s.specular_map.is_some();
    let illum = s.illum.unwrap_or(if highlight { 2 } else { 1 });
    let opacity = s.opacity.unwrap_or(1.0);

    let diffuse = s.diffuse.unwrap_or(if s.diffuse_map.is_some() { Rgb::WHITE } else { PLAIN }) * opacity as f32;
    let diffuse = term(&s.diffuse_map, Some(diffuse)).filter(|_| opacity > 0.0);
    let ambient = match (&s.ambient_map, &s.diffuse_map) {
        (None, Some(_)) => None,
        // Black is said, not left away: an absent ambient colour means the diffuse one.
        _ => term(&s.ambient_map, None).or(s.ambient.map(|c| ColorFile::Constant(c * opacity as f32))),
    };
    let emission = term(&s.emission_map, s.emission);
    let specular = term(&s.specular_map, s.specular).filter(|_| illum >= 2);
    let name = Some(String::from_utf8_lossy(&s.name).into_owned());
    if illum == 0 {
        // A colour that no light changes.
        return MaterialFile { name, emission: emission.or(diffuse), ..MaterialFile::default() };
    }

    let dielectric = dielectric(s, illum, opacity, specular.clone());
    let mirrors = matches!(illum, 3..=7) && dielectric.is_none();
    MaterialFile {
        name,
        emission,
        ambient,
        diffuse,
        mirror: specular.clone().filter(|_| mirrors),
        specular,
        shininess: s.shininess.unwrap_or(0.0) as f32,
        dielectric,
    }
}

/// Where the material is transparent.
fn dielectric(s: &Statements, illum: u32, opacity: f64, specular: Option<ColorFile>) -> Option<DielectricFile> {
    let glass = matches!(illum, 4 | 6 | 7 | 9);
    let ior = s.ior.filter(|&n| n >= 0.1).unwrap_or(1.0);
    if opacity >= 1.0 && !(glass && (s.transmission.is_some() || ior != 1.0)) {
        return None;
    }
    let share = if opacity < 1.0 { 1.0 - opacity as f32 } else { 1.0 };
    let fresnel = illum == 7;
    let reflect = match illum {
        // Fresnel's equations say how much; the specular colour is that of the highlight.
        7 => Some(ColorFile::Constant(Rgb::WHITE)),
        3..=6 => specular,
        _ => None,
    };
    Some(DielectricFile {
        ior,
        fresnel,
        reflect: reflect.unwrap_or(ColorFile::Constant(Rgb::BLACK)),
        transmit: ColorFile::Constant(s.transmission.unwrap_or(Rgb::WHITE) * share),
    })
}

//! Materials.

use std::f64::consts::LN_2;

use snell_math::spectrum::{MeasuredSpectrum, d65, spectrum_to_rgb, spectrum_to_xyz};
use snell_math::{Rgb, portable};

use super::ior::Optics;
use super::{Resolver, needs_unit};
use crate::catalogue;
use crate::diagnostic::{Diagnostic, Span, did_you_mean};
use crate::document::model::{self, Either, Located, MaterialChoice, Paint};
use crate::scene::{Dielectric, Extinction, Film, FilmVariation, Material, Medium, Metal, MetalIndex};
use crate::table::Id;

/// The diffuse colour of objects without a material.
const DEFAULT_DIFFUSE: f32 = 0.8;

impl Resolver<'_> {
    pub(super) fn material(&mut self, material: &model::Material, name: Option<&str>) -> Material {
        let (emission, emission_spectrum) = match &material.emission {
            Some(paint) => {
                let (texture, spectrum) = self.emission(paint);
                (Some(texture), spectrum)
            }
            None => (None, None),
        };
        Material {
            name: name.map(str::to_owned),
            emission,
            emission_spectrum,
            ambient: material.ambient.as_ref().map(|paint| self.term(paint)),
            diffuse: material.diffuse.as_ref().map(|paint| self.term(paint)),
            specular: material.specular.as_ref().map(|paint| self.term(paint)),
            shininess: material.shininess,
            mirror: material.mirror.as_ref().map(|paint| self.term(paint)),
            dielectric: material.dielectric.as_ref().map(|dielectric| self.dielectric(dielectric)),
            metal: material.metal.as_ref().map(|metal| self.metal(metal)),
            one_sided: material.one_sided,
        }
    }

    /// The material that an object names or brings.
    pub(super) fn chosen_material(&mut self, choice: &MaterialChoice) -> Id<Material> {
        match choice {
            // A name that is missing here was left out for its own mistakes.
            Either::A(name) => self.materials.get(&name.0).copied().unwrap_or(Id::from_index(0)),
            Either::B(material) => {
                let material = self.material(material, None);
                self.scene.materials.push(material)
            }
        }
    }

    /// The material of objects without one: diffuse, so that they are seen.
    pub(super) fn default_material(&mut self) -> Id<Material> {
        if let Some(id) = self.default_material {
            return id;
        }
        let diffuse = Some(self.constant(Rgb::gray(DEFAULT_DIFFUSE)));
        let id = self.scene.materials.push(Material { diffuse, ..Material::default() });
        self.default_material = Some(id);
        id
    }

    fn dielectric(&mut self, located: &Located<model::Dielectric>) -> Dielectric {
        let dielectric = &located.value;
        if !dielectric.fresnel {
            for (key, paint) in [("reflect", &dielectric.reflect), ("transmit", &dielectric.transmit)] {
                if paint.is_none() {
                    let message = format!("a dielectric with `fresnel = false` needs the fixed coefficient `{key}`");
                    let diagnostic = Diagnostic::error(message).at_optional(located.span.clone(), "missing here");
                    self.diagnostics.push(diagnostic.help("for example `reflect = 0.1, transmit = 0.9`"));
                }
            }
        }
        let Optics { ior, measured: measured_ior, extinction } = self.optics(&dielectric.ior);
        let extinction = match &dielectric.absorption {
            Some(Located { value: Either::A(model::AbsorptionWord::Catalogue), span }) => {
                self.extinction(&extinction, &dielectric.ior.span, span)
            }
            _ => None,
        };
        let medium = self.medium(dielectric, extinction.as_ref());
        let film = dielectric.film.as_ref().map(|film| self.film(film));
        let mut coefficient = |paint: &Option<Located<Paint>>| match paint {
            Some(paint) => self.term(paint),
            None => self.constant(Rgb::WHITE),
        };
        Dielectric {
            ior,
            fresnel: dielectric.fresnel,
            reflect: coefficient(&dielectric.reflect),
            transmit: coefficient(&dielectric.transmit),
            roughness: dielectric.roughness,
            film,
            medium,
            measured_ior,
            extinction,
            priority: dielectric.priority,
        }
    }

    fn metal(&mut self, located: &Located<model::Metal>) -> Metal {
        let model::Metal { of, index, color, roughness, film } = &located.value;
        let index = match (of, index, color) {
            (Some(name), None, None) => self.named_metal(name),
            (None, Some(index), None) => {
                let model::ComplexIndex([n, k]) = index.value;
                if n + k == 0.0 {
                    let diagnostic =
                        Diagnostic::error("a metal of index 0 is none").at_optional(index.span.clone(), "here");
                    self.diagnostics.push(diagnostic.help("gold has [0.18, 3.4] for yellow light"));
                }
                MetalIndex::Constant([n, k])
            }
            (None, None, Some(color)) => MetalIndex::Color(color.value.0),
            _ => {
                let message = "a metal needs one of the keys `of`, `index` and `color`";
                let diagnostic = Diagnostic::error(message).at_optional(located.span.clone(), "here");
                self.diagnostics.push(diagnostic.help("for example `of = \"gold\"`"));
                MetalIndex::Color(Rgb::WHITE)
            }
        };
        let film = film.as_ref().map(|film| self.film(film));
        Metal { index, roughness: *roughness, film }
    }

    /// A metal of the catalogue.
    fn named_metal(&mut self, name: &Located<String>) -> MetalIndex {
        if let Some(metal) = catalogue::metal(&name.value) {
            return MetalIndex::Measured(metal);
        }
        let names: Vec<&str> = catalogue::metals().map(|metal| metal.key).collect();
        let diagnostic = Diagnostic::error(format!("there is no metal {:?} of known indices", name.value))
            .at_optional(name.span.clone(), "not in the catalogue");
        self.diagnostics.push(match did_you_mean(&name.value, names.iter().copied()) {
            Some(near) => diagnostic.help(format!("did you mean {near:?}?")),
            None => diagnostic.help(format!("there are {}; or give `index` or `color`", names.join(", "))),
        });
        MetalIndex::Color(Rgb::WHITE)
    }

    fn film(&mut self, film: &model::Film) -> Film {
        let (thickness_nm, variation) = match &film.thickness {
            Either::A(thickness) => (*thickness, None),
            Either::B(model::FilmThickness { from, to, by }) => {
                (*from, Some(FilmVariation { to_nm: *to, by: self.term(by) }))
            }
        };
        Film { thickness_nm, variation, ior: self.ior(&film.ior) }
    }

    /// What was measured of the absorption of a glass, in the scene's units.
    fn extinction(&mut self, known: &[[f64; 2]], ior: &Option<Span>, span: &Option<Span>) -> Option<Extinction> {
        let mut diagnostic = None;
        let measured =
            MeasuredSpectrum::new(known.iter().map(|[nm, _]| *nm).collect(), known.iter().map(|[_, k]| *k).collect());
        if measured.is_err() {
            let what = Diagnostic::error("what this material absorbs is not in the catalogue");
            let what = what.at_optional(span.clone(), "nothing is known of it");
            let what = match ior {
                Some(ior) => what.related(ior.clone(), "of this material"),
                None => what,
            };
            diagnostic = Some(what.help(
                "Schott's glasses, such as \"N-BK7\", have it; else write `absorption = { color = …, distance = … }`",
            ));
        } else if self.unit_mm.is_none() {
            diagnostic = Some(needs_unit("absorption of the catalogue is measured by the millimetre", span));
        }
        self.diagnostics.list.extend(diagnostic);
        Some(Extinction { k: measured.ok()?, unit_mm: self.unit_mm? })
    }

    fn medium(&mut self, dielectric: &model::Dielectric, extinction: Option<&Extinction>) -> Medium {
        let mut medium = Medium { absorption: extinction.map_or(Rgb::BLACK, absorption_color), ..Medium::default() };
        if let Some(Located { value: Either::B(absorption), .. }) = &dielectric.absorption {
            let color = absorption.color.value.0;
            if color.to_array().iter().all(|&c| c > 0.0 && c <= 1.0) {
                medium.absorption = color.map(|c| finite((-portable::ln(f64::from(c)) / absorption.distance).max(0.0)));
            } else {
                let message = "the colour of an absorption must be above 0 and at most 1 in every component";
                let [r, g, b] = color.to_array();
                let diagnostic = Diagnostic::error(message)
                    .at_optional(absorption.color.span.clone(), format!("this is [{r}, {g}, {b}]"));
                self.diagnostics.push(diagnostic.help(
                    "it is the colour that white light has after `distance`; for a component that is absorbed almost at once, write a small number such as 0.001",
                ));
            }
        }
        if let Some(scattering) = &dielectric.scattering {
            medium.scattering = scattering.color.0.map(|c| finite(f64::from(c) / scattering.distance));
            medium.anisotropy = scattering.anisotropy;
        }
        medium
    }
}

/// The coefficients of absorption in red, green and blue that daylight sees of measured ones, over a way on which half of it is left.
fn absorption_color(extinction: &Extinction) -> Rgb {
    let [_, mean, _] = spectrum_to_xyz(|nm| d65(nm) * extinction.coefficient(nm));
    if !(mean > 0.0 && mean.is_finite()) {
        return Rgb::BLACK;
    }
    let distance = LN_2 / mean;
    let left = spectrum_to_rgb(|nm| d65(nm) * portable::exp(-extinction.coefficient(nm) * distance));
    left.map(|share| finite((-portable::ln(f64::from(share.clamp(1e-6, 1.0))) / distance).max(0.0)))
}

/// As `f32`, the largest where it is larger: after such a distance nothing is left either way.
fn finite(coefficient: f64) -> f32 {
    coefficient.min(f64::from(f32::MAX)) as f32
}

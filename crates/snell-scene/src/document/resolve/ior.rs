//! Indices of refraction: numbers, names, formulas, glasses of files.

use snell_math::Dispersion;

use super::Resolver;
use crate::catalogue::{self, Glass};
use crate::diagnostic::{Diagnostic, Span, did_you_mean};
use crate::document::model::{Either, Ior, IorFormula, Located};

/// The wavelengths between which a formula must give an index, in micrometres: what eyes see.
const VISIBLE: [f64; 2] = [0.38, 0.78];

/// Between these wavelengths, in nanometres, is more than 99.9 % of the light that eyes see of daylight.
const MOSTLY_SEEN_NM: [f64; 2] = [410.0, 700.0];

/// What is known of a material by its `ior`.
#[derive(Debug)]
pub(super) struct Optics {
    /// Its index.
    pub ior: Dispersion,
    /// What was measured of it, where `ior` is the lecture's number.
    pub measured: Option<Dispersion>,
    /// Pairs of a wavelength in nanometres and the coefficient of extinction; empty where it is not known.
    pub extinction: Vec<[f64; 2]>,
}

impl From<Dispersion> for Optics {
    fn from(ior: Dispersion) -> Self {
        Self { ior, measured: None, extinction: Vec::new() }
    }
}

impl Resolver<'_> {
    /// The index of what only paths ask for: films, lenses of cameras.
    pub(super) fn ior(&mut self, ior: &Located<Ior>) -> Dispersion {
        let Optics { ior, measured, .. } = self.optics(ior);
        measured.unwrap_or(ior)
    }

    /// All that is known of a material by its index.
    pub(super) fn optics(&mut self, ior: &Located<Ior>) -> Optics {
        match &ior.value {
            Either::A(number) => Dispersion::Constant(*number).into(),
            Either::B(Either::A(name)) if catalogue::is_glass_file(name) => self.glass_of_file(name, &ior.span),
            Either::B(Either::A(name)) => self.named_glass(name, &ior.span),
            Either::B(Either::B(formula)) => self.formula(formula, ior).into(),
        }
    }

    /// A material of the catalogue.
    fn named_glass(&mut self, name: &str, span: &Option<Span>) -> Optics {
        let Some(entry) = catalogue::lookup(name) else {
            let diagnostic = Diagnostic::error(format!("there is no material {name:?} of known index"))
                .at_optional(span.clone(), "not in the catalogue");
            self.diagnostics.push(match catalogue::suggest(name) {
                Some(near) => diagnostic.help(format!("did you mean {near:?}?")),
                None => diagnostic.help("write the index as a number, such as 1.5"),
            });
            return Dispersion::Constant(1.0).into();
        };
        let glass = Glass::from(entry);
        self.warn_outside(&glass, span);
        let measured = entry.measured().map(catalogue::Entry::dispersion);
        Optics { ior: glass.dispersion, measured, extinction: glass.extinction }
    }

    /// A glass of a file: `file.agf#NAME`, or the only one of a file.
    fn glass_of_file(&mut self, name: &str, span: &Option<Span>) -> Optics {
        let nothing = Optics::from(Dispersion::Constant(1.0));
        let of_glass = |glass: &Glass| Optics {
            ior: glass.dispersion.clone(),
            measured: None,
            extinction: glass.extinction.clone(),
        };
        let (path, wanted) = catalogue::split(name);
        let located = Located { value: path.to_owned(), span: span.clone() };
        let Some((path, bytes)) = self.file(&located) else { return nothing };
        let file = catalogue::read_glass_file(&path, &bytes);
        let is_wanted = |name: &str| wanted.is_none_or(|wanted| wanted.eq_ignore_ascii_case(name));
        let mut found = file.glasses.iter().filter(|glass| is_wanted(&glass.name));
        match (found.next(), found.next()) {
            (Some(glass), None) => {
                self.warn_outside(glass, span);
                return of_glass(glass);
            }
            (Some(first), Some(_)) if wanted.is_none() => {
                let message = format!("the file {path:?} has several glasses, and none is named");
                let help = format!("write one after a #, such as {:?}", format!("{name}#{}", first.name));
                self.diagnostics.push(Diagnostic::error(message).at_optional(span.clone(), "which?").help(help));
                return nothing;
            }
            (Some(glass), Some(_)) => return of_glass(glass),
            (None, _) => {}
        }
        if let Some(problem) =
            file.problems.iter().find(|problem| is_wanted(&problem.glass) || problem.glass.is_empty())
        {
            let message = format!("{path}:{}: {}", problem.line, problem.message);
            self.error(span, message, "cannot be read");
            return nothing;
        }
        let wanted = wanted.unwrap_or_default();
        let diagnostic = Diagnostic::error(format!("the file {path:?} has no glass {wanted:?}"))
            .at_optional(span.clone(), "not in that file");
        let names = file.glasses.iter().map(|glass| glass.name.as_str());
        self.diagnostics.push(match did_you_mean(wanted, names) {
            Some(near) => diagnostic.help(format!("did you mean {near:?}?")),
            None => diagnostic,
        });
        nothing
    }

    /// A formula is never extrapolated in silence where there is much to be seen.
    fn warn_outside(&mut self, glass: &Glass, span: &Option<Span>) {
        if MOSTLY_SEEN_NM.iter().all(|nm| glass.covers(*nm)) {
            return;
        }
        if let Some(message) = glass.outside() {
            self.diagnostics.push(Diagnostic::warning(message).at_optional(span.clone(), "in visible light"));
        }
    }

    fn formula(&mut self, formula: &IorFormula, ior: &Located<Ior>) -> Dispersion {
        let dispersion = match (&formula.cauchy, &formula.sellmeier) {
            (Some(cauchy), _) => Dispersion::Cauchy(cauchy.0.clone()),
            (None, Some(sellmeier)) => {
                if sellmeier.b.len() != sellmeier.c.value.len() {
                    let (b, c) = (sellmeier.b.len(), sellmeier.c.value.len());
                    let message = format!("Sellmeier's formula has {b} numerators `b` but {c} wavelengths `c`");
                    self.error(&sellmeier.c.span, message, format!("must be {b} numbers"));
                }
                let terms = sellmeier.b.iter().copied().zip(sellmeier.c.value.iter().copied()).collect();
                Dispersion::Sellmeier { constant: sellmeier.constant, terms }
            }
            (None, None) => Dispersion::Constant(1.0),
        };
        let steps = 40;
        let wavelength = |i: usize| VISIBLE[0] + (VISIBLE[1] - VISIBLE[0]) * i as f64 / steps as f64;
        let bad = (0..=steps).map(wavelength).find(|l| !(0.1..=100.0).contains(&index(&dispersion, *l)));
        if let Some(bad) = bad {
            let message = format!("the formula gives no index between 0.1 and 100 at {:.0} nm", bad * 1000.0);
            self.error(&ior.span, message, "wavelengths are in micrometres");
        }
        dispersion
    }
}

/// The index that a formula gives at a wavelength in micrometres; NaN where it gives none.
fn index(dispersion: &Dispersion, wavelength: f64) -> f64 {
    let square = wavelength * wavelength;
    match dispersion {
        Dispersion::Constant(index) => *index,
        Dispersion::Cauchy(coefficients) => coefficients.iter().rev().fold(0.0, |sum, c| sum / square + c),
        Dispersion::Sellmeier { constant, terms } => {
            let sum: f64 = terms.iter().map(|(b, c)| b * square / (square - c)).sum();
            (1.0 + constant + sum).sqrt()
        }
        // Those are not written in scenes.
        Dispersion::Rational { .. } | Dispersion::Table(_) => dispersion.index(wavelength * 1000.0),
    }
}

#[cfg(test)]
mod tests {
    use snell_math::dispersion::fraunhofer::HELIUM_D;

    use crate::assets::MemoryAssets;
    use crate::document::read_scene;

    const AGF: &[u8] = b"CC mine\nNM ONE 2\nCD 1 0.01\nLD 0.3 0.9\nNM TWO 1\nCD 2.25\nLD 0.45 0.9\nNM BAD 77\nCD 1\n";
    const PAGE: &[u8] = b"DATA:\n  - type: formula 5\n    wavelength_range: 0.3 2\n    coefficients: 1.5 0.004 -2\n";

    /// The index at the d line, or what is told.
    fn index(ior: &str) -> (Option<f64>, Vec<String>) {
        let text = format!(
            "[material.glass]\ndielectric = {{ ior = {ior:?} }}\n[[object]]\nsphere = {{}}\nmaterial = \"glass\"\n"
        );
        let assets = MemoryAssets::default().with("glass/a.agf", AGF).with("glass/page.yml", PAGE);
        let (scene, diagnostics) = read_scene("scene.toml", text.as_bytes(), &assets, &[]);
        let told = |d: &crate::Diagnostic| match &d.help {
            Some(help) => format!("{}; {help}", d.message),
            None => d.message.clone(),
        };
        let found = scene.and_then(|scene| {
            scene.materials.iter().next().and_then(|m| m.dielectric.as_ref().map(|d| d.ior.index(HELIUM_D)))
        });
        (found, diagnostics.list.iter().map(told).collect())
    }

    #[test]
    fn glasses_come_from_files() {
        let s = HELIUM_D * HELIUM_D * 1e-6;
        assert_eq!(index("glass/a.agf#ONE"), (Some((1.0 + s / (s - 0.01)).sqrt()), vec![]));
        let (page, told) = index("glass/page.yml");
        assert!((page.unwrap() - (1.5 + 0.004 / s)).abs() < 1e-14 && told.is_empty());
        // The twin: the other glass of the file, which is not known in all of visible light.
        let (two, told) = index("glass/a.agf#two");
        assert_eq!(two, Some(1.5));
        assert_eq!(told, ["the index of TWO was measured from 450 to 900 nm; beyond, its formula is extrapolated"]);
    }

    #[test]
    fn mistakes_are_told() {
        for (ior, message) in [
            ("glass/a.agf#TWOO", "the file \"glass/a.agf\" has no glass \"TWOO\"; did you mean \"TWO\"?"),
            ("glass/a.agf#BAD", "glass/a.agf:8: formula 77 is none of the 13 that are known"),
            (
                "glass/a.agf",
                "the file \"glass/a.agf\" has several glasses, and none is named; write one after a #, such as \"glass/a.agf#ONE\"",
            ),
            (
                "glass/b.agf",
                "the file \"glass/b.agf\" cannot be had: there is no such file; did you mean \"glass/a.agf\"?",
            ),
            ("N-BKK7", "there is no material \"N-BKK7\" of known index; did you mean \"N-BK7\"?"),
        ] {
            let (found, told) = index(ior);
            assert_eq!((found, told), (None, vec![message.to_owned()]), "{ior}");
        }
    }

    #[test]
    fn formulas_are_not_extrapolated_in_silence() {
        let (found, told) = index("PMMA");
        assert!(found.is_some());
        assert_eq!(told, ["the index of PMMA was measured from 436.8 to 1052 nm; beyond, its formula is extrapolated"]);
        // The twins: known in all visible light, and a value of a table.
        assert!(
            index("N-BK7").1.is_empty() && index("diamond").1.is_empty() && index("diamond-dispersive").1.is_empty()
        );
    }
}

//! Indices of refraction: numbers, names, formulas.

use snell_math::Dispersion;

use super::Resolver;
use crate::diagnostic::{Diagnostic, did_you_mean};
use crate::document::model::{Either, Ior, IorFormula, Located};

/// The wavelengths between which a formula must give an index, in micrometres: what eyes see.
const VISIBLE: [f64; 2] = [0.38, 0.78];

impl Resolver<'_> {
    pub(super) fn ior(&mut self, ior: &Located<Ior>) -> Dispersion {
        match &ior.value {
            Either::A(number) => Dispersion::Constant(*number),
            Either::B(Either::A(name)) => resolve_ior_name(name).unwrap_or_else(|suggestion| {
                let diagnostic = Diagnostic::error(format!("there is no material {name:?} of known index"))
                    .at_optional(ior.span.clone(), "not in the catalogue");
                self.diagnostics.push(match suggestion {
                    Some(near) => diagnostic.help(format!("did you mean {near:?}?")),
                    None => diagnostic.help("write the index as a number, such as 1.5"),
                });
                Dispersion::Constant(1.0)
            }),
            Either::B(Either::B(formula)) => self.formula(formula, ior),
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
    }
}

/// The index of a material by its name, or the nearest name. The one place that knows the catalogue.
fn resolve_ior_name(name: &str) -> Result<Dispersion, Option<String>> {
    let plain = |name: &str| name.to_lowercase().replace(['-', '_'], " ");
    let wanted = plain(name);
    match LECTURE.iter().find(|(known, _)| plain(known) == wanted) {
        Some((_, index)) => Ok(Dispersion::Constant(*index)),
        None if wanted == "n bk7" || wanted == "bk7" => Ok(Dispersion::Sellmeier {
            constant: 0.0,
            terms: vec![(1.03961212, 0.00600069867), (0.231792344, 0.0200179144), (1.01046945, 103.560653)],
        }),
        None => {
            let names = LECTURE.iter().map(|(known, _)| *known).chain(["N-BK7"]);
            Err(did_you_mean(name, names).map(str::to_owned))
        }
    }
}

/// The table of the lecture, at 589.3 nm.
const LECTURE: [(&str, f64); 11] = [
    ("vacuum", 1.0),
    ("helium", 1.000036),
    ("air", 1.0002926),
    ("ice", 1.31),
    ("water", 1.333),
    ("ethanol", 1.36),
    ("glycerine", 1.4729),
    ("rock salt", 1.516),
    ("glass", 1.5),
    ("cubic zirconia", 2.16),
    ("diamond", 2.419),
];

//! Indices of refraction: numbers, names, formulas.

use snell_math::Dispersion;

use super::Resolver;
use crate::catalogue::{self, Entry};
use crate::diagnostic::Diagnostic;
use crate::document::model::{Either, Ior, IorFormula, Located};

/// The wavelengths between which a formula must give an index, in micrometres: what eyes see.
const VISIBLE: [f64; 2] = [0.38, 0.78];

impl Resolver<'_> {
    pub(super) fn ior(&mut self, ior: &Located<Ior>) -> Dispersion {
        match &ior.value {
            Either::A(number) => Dispersion::Constant(*number),
            Either::B(Either::A(name)) => catalogue::lookup(name).map(Entry::dispersion).unwrap_or_else(|| {
                let diagnostic = Diagnostic::error(format!("there is no material {name:?} of known index"))
                    .at_optional(ior.span.clone(), "not in the catalogue");
                self.diagnostics.push(match catalogue::suggest(name) {
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

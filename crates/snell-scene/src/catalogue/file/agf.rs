//! Zemax's glass catalogues: lines that begin with two letters.
//!
//! Follows: the OpticStudio user manual, "Using Material Catalogs" and "The Formulas": NM name, formula and code; GC a comment; CD the
//! coefficients; LD the range in micrometres; IT wavelength, transmittance and thickness in millimetres. The rest (temperature,
//! density, prices) is not for a picture. Wavelengths are micrometres in air, indices relative to air.

use snell_math::Dispersion;
use snell_math::dispersion::RationalTerm;

use super::{GlassFile, GlassProblem, nanometres, numbers, range_nm};
use crate::catalogue::{Glass, Medium};

/// A glass whose lines are being read.
struct Open {
    name: String,
    line: usize,
    comment: String,
    formula: u32,
    coefficients: Vec<f64>,
    valid_nm: Option<[f64; 2]>,
    extinction: Vec<[f64; 2]>,
    /// The first thing that is wrong.
    wrong: Option<(usize, String)>,
}

pub(super) fn read(text: &str) -> GlassFile {
    let mut file = GlassFile::default();
    let mut catalogue = String::new();
    let mut open: Option<Open> = None;
    for (line, content) in (1..).zip(text.lines()) {
        let content = content.trim();
        let (code, rest) = content.split_at_checked(2).unwrap_or((content, ""));
        let rest = rest.trim();
        match (code, &mut open) {
            ("CC", _) if catalogue.is_empty() => catalogue = rest.to_owned(),
            ("NM", _) => {
                if let Some(done) = open.take() {
                    close(done, &catalogue, &mut file);
                }
                open = Some(begin(rest, line));
            }
            ("GC", Some(glass)) => glass.comment = rest.to_owned(),
            ("CD", Some(glass)) => match numbers(rest.split_whitespace()) {
                Ok(coefficients) => glass.coefficients = coefficients,
                Err(message) => glass.fail(line, message),
            },
            ("LD", Some(glass)) => match numbers(rest.split_whitespace()).and_then(|ends| range_nm(&ends)) {
                Ok(range) => glass.valid_nm = Some(range),
                Err(message) => glass.fail(line, message),
            },
            ("IT", Some(glass)) => glass.transmittance(rest),
            _ => {}
        }
    }
    if let Some(done) = open {
        close(done, &catalogue, &mut file);
    }
    file
}

fn begin(rest: &str, line: usize) -> Open {
    let mut words = rest.split_whitespace();
    let name = words.next().unwrap_or_default().to_owned();
    // Written as a whole number, or as one with a point.
    let formula = words.next().and_then(|word| word.parse::<f64>().ok()).unwrap_or(0.0) as u32;
    let wrong = name.is_empty().then(|| (line, "a glass without a name".to_owned()));
    Open {
        name,
        line,
        comment: String::new(),
        formula,
        coefficients: Vec::new(),
        valid_nm: None,
        extinction: Vec::new(),
        wrong,
    }
}

impl Open {
    fn fail(&mut self, line: usize, message: String) {
        self.wrong.get_or_insert((line, message));
    }

    /// A line of transmittance. Some catalogues have them without numbers, which says nothing.
    fn transmittance(&mut self, rest: &str) {
        if let Ok(values) = numbers(rest.split_whitespace())
            && let [micrometres, share, thickness_mm] = values[..]
            && let Some(k) = Glass::extinction_of(nanometres(micrometres), share, thickness_mm)
        {
            self.extinction.push([nanometres(micrometres), k]);
        }
    }
}

fn close(mut glass: Open, catalogue: &str, file: &mut GlassFile) {
    let dispersion = match glass.wrong.take() {
        Some(wrong) => Err(wrong),
        None => formula(glass.formula, &glass.coefficients).map_err(|message| (glass.line, message)),
    };
    match dispersion {
        Err((line, message)) => file.problems.push(GlassProblem { glass: glass.name, line, message }),
        Ok((formula, dispersion)) => {
            glass.extinction.sort_by(|a, b| a[0].total_cmp(&b[0]));
            glass.extinction.dedup_by_key(|row| row[0]);
            file.glasses.push(Glass {
                name: glass.name,
                description: glass.comment,
                source: catalogue.to_owned(),
                formula: formula.to_owned(),
                dispersion,
                valid_nm: glass.valid_nm,
                reference: Medium::Air,
                extinction: glass.extinction,
            });
        }
    }
}

/// A formula by its number, and what it is called.
fn formula(number: u32, coefficients: &[f64]) -> Result<(&'static str, Dispersion), String> {
    use RationalTerm as Term;
    // What is left out at the end is 0.
    let c = |index: usize| coefficients.get(index).copied().unwrap_or(0.0);
    if coefficients.iter().all(|c| *c == 0.0) {
        return Err("the glass has no coefficients (CD)".to_owned());
    }
    let sellmeier = |pairs: usize| Dispersion::Sellmeier {
        constant: 0.0,
        terms: (0..pairs).map(|i| (c(2 * i), c(2 * i + 1))).collect(),
    };
    let powers = |powers: &[f64]| powers.iter().enumerate().map(|(i, power)| Term::power(c(i), *power)).collect();
    let squared = |terms: Vec<Term>| Dispersion::Rational { is_squared: true, terms };
    let plain = |terms: Vec<Term>| Dispersion::Rational { is_squared: false, terms };
    Ok(match number {
        1 => ("Schott", squared(powers(&[0.0, 2.0, -2.0, -4.0, -6.0, -8.0]))),
        2 => ("Sellmeier", sellmeier(3)),
        3 => ("Herzberger", plain(herzberger(&std::array::from_fn(c)))),
        4 => {
            let first = Term::resonance(c(1), 2.0, c(2) * c(2));
            let second = Term::resonance(c(3), 0.0, c(4) * c(4));
            ("Sellmeier 2", squared(vec![Term::power(1.0 + c(0), 0.0), first, second]))
        }
        5 => ("Conrady", plain(powers(&[0.0, -1.0, -3.5]))),
        6 => ("Sellmeier 3", sellmeier(4)),
        7 | 8 => {
            let power = if number == 7 { 0.0 } else { 2.0 };
            let terms = vec![Term::power(c(0), 0.0), Term::resonance(c(1), power, c(2)), Term::power(-c(3), 2.0)];
            (if number == 7 { "Handbook of Optics 1" } else { "Handbook of Optics 2" }, squared(terms))
        }
        9 => {
            let resonances = [Term::resonance(c(1), 2.0, c(2)), Term::resonance(c(3), 2.0, c(4))];
            ("Sellmeier 4", squared([vec![Term::power(c(0), 0.0)], resonances.to_vec()].concat()))
        }
        10 => ("extended", squared(powers(&[0.0, 2.0, -2.0, -4.0, -6.0, -8.0, -10.0, -12.0]))),
        11 => ("Sellmeier 5", sellmeier(5)),
        12 => ("extended 2", squared(powers(&[0.0, 2.0, -2.0, -4.0, -6.0, -8.0, 4.0, 6.0]))),
        13 => ("extended 3", squared(powers(&[0.0, 2.0, 4.0, -2.0, -4.0, -6.0, -8.0, -10.0, -12.0]))),
        other => return Err(format!("formula {other} is none of the 13 that are known")),
    })
}

/// Herzberger's formula: n = A + B L + C L² + D λ² + E λ⁴ + F λ⁶, L = 1 / (λ² − 0.028).
pub(super) fn herzberger(c: &[f64; 6]) -> Vec<RationalTerm> {
    const POLE: f64 = 0.028;
    let twice = RationalTerm { coefficient: c[2], power: 0.0, pole: POLE, order: 2 };
    let rest = [(c[3], 2.0), (c[4], 4.0), (c[5], 6.0)].map(|(c, power)| RationalTerm::power(c, power));
    [&[RationalTerm::power(c[0], 0.0), RationalTerm::resonance(c[1], 0.0, POLE), twice][..], &rest].concat()
}

//! Pages of the refractiveindex.info database: YAML of one plain form, of which only what is needed is read.
//!
//! Follows: the database's "Dispersion formulas" (<https://refractiveindex.info/database/doc/Dispersion%20formulas.pdf>); Polyanskiy,
//! Scientific Data 11, 94, 2024. Wavelengths are micrometres in vacuum, but for Schott's glasses, whose pages do not say that theirs
//! are in air; indices then are relative to it.

use snell_math::Dispersion;
use snell_math::dispersion::RationalTerm as Term;

use super::agf::herzberger;
use super::{GlassFile, GlassProblem, nanometres, numbers, range_nm};
use crate::catalogue::{Glass, Medium};

/// One block of `DATA`.
#[derive(Default)]
struct Block {
    line: usize,
    kind: String,
    range: Option<[f64; 2]>,
    coefficients: Vec<f64>,
    rows: Vec<Vec<f64>>,
}

pub(super) fn read(name: &str, text: &str) -> GlassFile {
    match glass(name, text) {
        Ok(glass) => GlassFile { glasses: vec![glass], problems: Vec::new() },
        Err((line, message)) => {
            GlassFile { glasses: Vec::new(), problems: vec![GlassProblem { glass: name.to_owned(), line, message }] }
        }
    }
}

fn glass(name: &str, text: &str) -> Result<Glass, (usize, String)> {
    let blocks = blocks(text)?;
    let mut index: Option<(String, Dispersion, Option<[f64; 2]>)> = None;
    let mut extinction = Vec::new();
    for block in &blocks {
        let at = |message: String| (block.line, message);
        match block.kind.as_str() {
            "tabulated k" => extinction = columns(block, 2, 1).map_err(at)?,
            "tabulated n" | "tabulated nk" => {
                let count = if block.kind.ends_with("nk") { 3 } else { 2 };
                let rows = columns(block, count, 1).map_err(at)?;
                if count == 3 {
                    extinction = columns(block, 3, 2).map_err(at)?;
                }
                let ends = [rows[0][0], rows[rows.len() - 1][0]];
                let table = Dispersion::Table(rows.iter().map(|[nm, n]| (*nm, *n)).collect());
                index.get_or_insert(("table".to_owned(), table, Some(ends)));
            }
            kind => {
                let (formula, dispersion) = formula(kind, &block.coefficients).map_err(at)?;
                index.get_or_insert((formula.to_owned(), dispersion, block.range));
            }
        }
    }
    let (formula, dispersion, valid_nm) = index.ok_or((1, "the page gives no index of refraction".to_owned()))?;
    let is_schott = text.contains("SCHOTT Zemax catalog");
    Ok(Glass {
        name: name.to_owned(),
        description: String::new(),
        source: reference(text),
        formula,
        dispersion,
        valid_nm,
        reference: if is_schott { Medium::Air } else { Medium::Vacuum },
        extinction,
    })
}

/// The lines of `REFERENCES` as one, without the marks of HTML.
fn reference(text: &str) -> String {
    let lines = text.lines().skip_while(|line| !line.starts_with("REFERENCES")).skip(1);
    let joined: Vec<&str> = lines.take_while(|line| line.starts_with(' ')).map(str::trim).collect();
    let mut plain = String::new();
    let mut is_mark = false;
    for letter in joined.join(" ").chars().take(1000) {
        match letter {
            '<' => is_mark = true,
            '>' => is_mark = false,
            _ if !is_mark => plain.push(letter),
            _ => {}
        }
    }
    plain
}

fn blocks(text: &str) -> Result<Vec<Block>, (usize, String)> {
    let mut blocks: Vec<Block> = Vec::new();
    let lines = (1..).zip(text.lines()).skip_while(|(_, line)| line.trim_end() != "DATA:").skip(1);
    // `DATA` ends at the next line that is not indented.
    for (line, content) in lines.take_while(|(_, line)| line.is_empty() || line.starts_with([' ', '-'])) {
        let content = content.trim();
        if let Some(kind) = content.strip_prefix("- type:") {
            blocks.push(Block { line, kind: kind.trim().to_owned(), ..Block::default() });
            continue;
        }
        let Some(block) = blocks.last_mut() else { continue };
        let values = |text: &str| numbers(text.split_whitespace()).map_err(|message| (line, message));
        if let Some(range) = content.strip_prefix("wavelength_range:") {
            block.range = Some(range_nm(&values(range)?).map_err(|message| (line, message))?);
        } else if let Some(coefficients) = content.strip_prefix("coefficients:") {
            block.coefficients = values(coefficients)?;
        } else if !content.is_empty() && !content.contains(':') && !content.starts_with('#') {
            block.rows.push(values(content)?);
        }
    }
    if blocks.is_empty() { Err((1, "the page has no DATA".to_owned())) } else { Ok(blocks) }
}

/// Wavelengths in nanometres with one of the other columns.
fn columns(block: &Block, count: usize, column: usize) -> Result<Vec<[f64; 2]>, String> {
    let rows: Vec<[f64; 2]> = block
        .rows
        .iter()
        .map(|row| if row.len() == count { Ok([nanometres(row[0]), row[column]]) } else { Err(()) })
        .collect::<Result<_, _>>()
        .map_err(|()| format!("each row of {} needs {count} numbers", block.kind))?;
    if rows.is_empty() {
        return Err(format!("{} has no rows", block.kind));
    }
    if rows.windows(2).any(|pair| pair[0][0] >= pair[1][0]) {
        return Err(format!("the wavelengths of {} do not ascend", block.kind));
    }
    Ok(rows)
}

/// A formula by its name, and what it is called.
fn formula(kind: &str, coefficients: &[f64]) -> Result<(&'static str, Dispersion), String> {
    let c = |index: usize| coefficients.get(index).copied().unwrap_or(0.0);
    let Some((first, rest)) = coefficients.split_first() else {
        return Err(format!("{kind} has no coefficients"));
    };
    let pairs = |rest: &[f64]| -> Vec<(f64, f64)> {
        rest.chunks(2).map(|pair| (pair[0], pair.get(1).copied().unwrap_or(0.0))).collect()
    };
    let powers = |first: f64, rest: &[f64]| {
        std::iter::once(Term::power(first, 0.0))
            .chain(pairs(rest).into_iter().map(|(c, p)| Term::power(c, p)))
            .collect()
    };
    Ok(match kind {
        "formula 1" => {
            let terms = pairs(rest).into_iter().map(|(b, pole)| (b, pole * pole)).collect();
            ("Sellmeier", Dispersion::Sellmeier { constant: *first, terms })
        }
        "formula 2" => ("Sellmeier", Dispersion::Sellmeier { constant: *first, terms: pairs(rest) }),
        "formula 3" => ("polynomial", Dispersion::Rational { is_squared: true, terms: powers(*first, rest) }),
        "formula 4" => {
            let resonance =
                |at: usize| Term::resonance(c(at), c(at + 1), snell_math::portable::pow(c(at + 2), c(at + 3)));
            let mut terms = vec![Term::power(*first, 0.0), resonance(1), resonance(5)];
            terms.extend(pairs(coefficients.get(9..).unwrap_or_default()).into_iter().map(|(c, p)| Term::power(c, p)));
            ("rational", Dispersion::Rational { is_squared: true, terms })
        }
        "formula 5" => ("Cauchy", Dispersion::Rational { is_squared: false, terms: powers(*first, rest) }),
        "formula 6" => {
            // b / (c − λ⁻²) = (b / c) λ² / (λ² − 1 / c).
            let resonances = pairs(rest).into_iter().filter(|(b, _)| *b != 0.0);
            let resonances = resonances.map(|(b, c)| Term::resonance(b / c, 2.0, 1.0 / c));
            let terms = std::iter::once(Term::power(1.0 + first, 0.0)).chain(resonances).collect();
            ("gases", Dispersion::Rational { is_squared: false, terms })
        }
        "formula 7" => {
            ("Herzberger", Dispersion::Rational { is_squared: false, terms: herzberger(&std::array::from_fn(c)) })
        }
        other => return Err(format!("{:?} is no formula that is known", other.chars().take(32).collect::<String>())),
    })
}

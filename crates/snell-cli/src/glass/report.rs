//! A material as text and as JSON.

use std::fmt::Write;

use serde_json::{Map, Value, json};
use snell::math::Dispersion;
use snell::math::dispersion::fraunhofer;
use snell::scene::catalogue::{Glass, Medium};

use super::{Answer, medium_name};

/// A line for each material: its name, n_d, V_d, and what it is.
pub fn list(glasses: &[Glass]) -> String {
    let width = glasses.iter().map(|glass| glass.name.chars().count()).max().unwrap_or(0).max(4);
    let mut text = format!("{:width$}  {:>8}  {:>6}  what it is\n", "name", "n_d", "V_d");
    for glass in glasses {
        let abbe = glass.dispersion.abbe_number().map_or_else(|| "-".to_owned(), |abbe| format!("{abbe:.2}"));
        let index = glass.dispersion.index(fraunhofer::HELIUM_D);
        let line = format!("{:width$}  {index:>8.5}  {abbe:>6}  {}", glass.name, glass.description);
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

/// All that is known of a material, for people.
pub fn text(glass: &Glass, answers: &[Answer], thickness_mm: f64) -> String {
    let mut text = String::new();
    let mut line = |line: String| {
        text.push_str(line.trim_end());
        text.push('\n');
    };
    let medium = medium_name(glass.reference);
    if !answers.is_empty() {
        for answer in answers {
            let (air, vacuum) = (answer.air_nm, answer.vacuum_nm);
            let other = match answer.medium {
                Medium::Air => format!("{vacuum:.4} nm in vacuum"),
                Medium::Vacuum => format!("{air:.4} nm in air"),
            };
            let relative = medium_name(answer.medium);
            let share = glass
                .internal_transmittance(answer.own_nm(glass), thickness_mm)
                .map_or_else(String::new, |share| format!("; {thickness_mm} mm let {share:.6} through"));
            line(format!(
                "{} at {} nm in {relative} ({other}): {:.9} relative to {relative}{share}",
                glass.name,
                answer.given_nm(),
                answer.index
            ));
        }
        return text;
    }
    line(if glass.description.is_empty() {
        glass.name.clone()
    } else {
        format!("{}: {}", glass.name, glass.description)
    });
    if !glass.source.is_empty() {
        line(format!("  source   {}", glass.source));
    }
    line(format!("  formula  {}", formula(glass)));
    if let Some([low, high]) = glass.valid_nm {
        line(format!("  range    {low} to {high} nm; wavelengths in {medium}, indices relative to {medium}"));
    }
    line(format!("  n_d      {:.6}", glass.dispersion.index(fraunhofer::HELIUM_D)));
    if let Some(abbe) = glass.dispersion.abbe_number() {
        line(format!("  V_d      {abbe:.4}"));
    }
    if glass.dispersion.is_dispersive() {
        line(format!("\n  {:<4} {:>10}  {:>9}", "line", "nm", "index"));
        for (name, nm, what) in fraunhofer::LINES {
            let outside = if glass.covers(nm) { "" } else { " (outside of the range: extrapolated)" };
            line(format!("  {name:<4} {nm:>10.4}  {:>9.6}  {what}{outside}", glass.dispersion.index(nm)));
        }
    }
    if !glass.extinction.is_empty() {
        line(format!("\n  internal transmittance of {thickness_mm} mm\n  {:>10}  share", "nm"));
        for [nm, _] in &glass.extinction {
            let share = glass.internal_transmittance(*nm, thickness_mm).unwrap_or(0.0);
            line(format!("  {nm:>10}  {share:.6}"));
        }
    }
    text
}

/// The formula with its coefficients.
fn formula(glass: &Glass) -> String {
    let mut text = glass.formula.clone();
    match &glass.dispersion {
        Dispersion::Constant(index) => {
            let _ = write!(text, ": n = {index}");
        }
        Dispersion::Sellmeier { constant, terms } => {
            let _ = write!(text, ": n\u{b2} = {}", 1.0 + constant);
            for (strength, pole) in terms {
                let _ = write!(text, " + {strength} \u{3bb}\u{b2}/(\u{3bb}\u{b2} - {pole})");
            }
            text.push_str(", \u{3bb} in \u{b5}m");
        }
        Dispersion::Table(rows) => {
            let _ = write!(text, " of {} rows", rows.len());
        }
        Dispersion::Cauchy(_) | Dispersion::Rational { .. } => {}
    }
    text
}

/// All that is known of a material, for programs, in full precision. `index` is that at the first wavelength asked for, or n_d.
pub fn json(glass: &Glass, answers: &[Answer], thickness_mm: f64) -> Value {
    let nd = glass.dispersion.index(fraunhofer::HELIUM_D);
    let lines: Map<String, Value> = fraunhofer::LINES
        .into_iter()
        .map(|(name, nm, _)| {
            let line = json!({ "nm": nm, "index": glass.dispersion.index(nm), "in_range": glass.covers(nm) });
            (name.to_owned(), line)
        })
        .collect();
    let at: Vec<Value> = answers
        .iter()
        .map(|answer| {
            json!({
                "wavelength_nm": answer.given_nm(),
                "air_nm": answer.air_nm,
                "vacuum_nm": answer.vacuum_nm,
                "relative_to": medium_name(answer.medium),
                "index": answer.index,
                "in_range": glass.covers(answer.own_nm(glass)),
                "internal_transmittance": glass.internal_transmittance(answer.own_nm(glass), thickness_mm),
            })
        })
        .collect();
    let transmittance: Vec<Value> = glass
        .extinction
        .iter()
        .map(|[nm, k]| {
            json!({ "nm": nm, "k": k, "internal_transmittance": glass.internal_transmittance(*nm, thickness_mm) })
        })
        .collect();
    json!({
        "name": glass.name,
        "description": glass.description,
        "source": glass.source,
        "formula": glass.formula,
        "coefficients": coefficients(&glass.dispersion),
        "relative_to": medium_name(glass.reference),
        "range_nm": glass.valid_nm,
        "nd": nd,
        "vd": glass.dispersion.abbe_number(),
        "index": answers.first().map_or(nd, |answer| answer.index),
        "at": at,
        "lines": lines,
        "thickness_mm": thickness_mm,
        "transmittance": transmittance,
    })
}

/// The numbers of a formula; wavelengths in micrometres, but in a table nanometres.
fn coefficients(dispersion: &Dispersion) -> Value {
    match dispersion {
        Dispersion::Constant(index) => json!({ "n": index }),
        Dispersion::Cauchy(coefficients) => json!({ "cauchy": coefficients }),
        Dispersion::Sellmeier { constant, terms } => {
            let (b, c): (Vec<f64>, Vec<f64>) = terms.iter().copied().unzip();
            json!({ "constant": constant, "b": b, "c": c })
        }
        Dispersion::Rational { is_squared, terms } => {
            let terms: Vec<Value> = terms
                .iter()
                .map(|term| {
                    json!({ "coefficient": term.coefficient, "power": term.power, "pole": term.pole, "order": term.order })
                })
                .collect();
            json!({ "sum_is": if *is_squared { "n^2" } else { "n" }, "terms": terms })
        }
        Dispersion::Table(rows) => json!({ "table": rows }),
    }
}

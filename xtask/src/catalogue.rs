//! `cargo xtask catalogue DATABASE`: writes the tables of measured materials in `snell-scene` anew.
//!
//! DATABASE is a checkout of the refractiveindex.info database
//! (<https://github.com/polyanskiy/refractiveindex.info-database>, CC0 1.0), the folder that holds `database/data`, or a folder
//! with the pages that are needed and the glasses in its folder `schott`. Its
//! formula 1 is Sellmeier's with poles as wavelengths, its formula 2 with their squares; the table has squares.
//! Wavelengths there are in micrometres, the ranges of the table in nanometres.

use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

mod absorption;

use crate::Outcome;
use crate::arguments::Arguments;

/// The file that is written, from the root of the repository.
const TABLE: &str = "crates/snell-scene/src/catalogue/measured.rs";
/// The longest line of the project's code.
const LINE: usize = 120;
const DATA: &str = "database/data";
const SCHOTT: &str = "specs/schott/optical";

/// A material with a page of its own.
struct Material {
    file: &'static str,
    /// Its name in a folder of pages alone.
    page: &'static str,
    key: &'static str,
    aliases: &'static [&'static str],
    description: &'static str,
    source: &'static str,
}

const MATERIALS: [Material; 7] = [
    Material {
        file: "main/H2O/nk/Daimon-20.0C.yml",
        page: "H2O-Daimon-20C.yml",
        key: "water-20C",
        aliases: &["water-dispersive"],
        description: "distilled water at 20 °C",
        source: "Daimon and Masumura, Applied Optics 46, 3811 (2007)",
    },
    Material {
        file: "main/SiO2/nk/Malitson.yml",
        page: "SiO2-Malitson.yml",
        key: "fused-silica",
        aliases: &["silica", "quartz-glass"],
        description: "fused silica (quartz glass) at 20 °C",
        source: "Malitson, J. Opt. Soc. Am. 55, 1205 (1965)",
    },
    Material {
        file: "organic/(C5H8O2)n - poly(methyl methacrylate)/nk/Sultanova.yml",
        page: "PMMA-Sultanova.yml",
        key: "PMMA",
        aliases: &["acrylic", "plexiglas", "plexiglass"],
        description: "acrylic glass, poly(methyl methacrylate), at 20 °C",
        source: "Sultanova, Kasarova and Nikolov, Acta Physica Polonica A 116, 585 (2009)",
    },
    Material {
        file: "main/NaCl/nk/Li.yml",
        page: "NaCl-Li.yml",
        key: "NaCl",
        aliases: &["rock-salt-dispersive", "salt-dispersive", "halite-dispersive", "sodium-chloride"],
        description: "rock salt, sodium chloride, at 24 °C",
        source: "Li, J. Phys. Chem. Ref. Data 5, 329 (1976)",
    },
    Material {
        file: "main/Al2O3/nk/Malitson-o.yml",
        page: "Al2O3-Malitson-o.yml",
        key: "sapphire-o",
        aliases: &["sapphire"],
        description: "synthetic sapphire, ordinary ray, at 20 °C",
        source: "Malitson and Dodge, J. Opt. Soc. Am. 62, 1405 (1972)",
    },
    Material {
        file: "other/mixed crystals/ZrO2-Y2O3/nk/Wood.yml",
        page: "CubicZirconia-Wood.yml",
        key: "cubic-zirconia-dispersive",
        aliases: &["zirconia-dispersive"],
        description: "cubic zirconia with 12 mol % yttria at 25 °C",
        source: "Wood and Nassau, Applied Optics 21, 2978 (1982)",
    },
    Material {
        file: "main/C/nk/Peter.yml",
        page: "C-Peter-diamond.yml",
        key: "diamond-dispersive",
        aliases: &[],
        description: "diamond at room temperature",
        source: "Peter, Zeitschrift für Physik 15, 358 (1923)",
    },
];

const HEAD: &str = "\
//! Measured materials with dispersion: written by `cargo xtask catalogue`, not by hand.
//!
//! From the refractiveindex.info database (Polyanskiy), which is in the public domain by CC0 1.0: see DATA-LICENSE.md
//! beside this file. Sellmeier's formula as [`snell_math::Dispersion`] has it, poles in square micrometres; ranges in
//! nanometres.

use super::{Entry, material, schott};

";

/// Reads the database named on the command line and writes the table.
pub fn run(arguments: Arguments) -> Outcome {
    let database = arguments.at_most_one_name()?;
    let database = database.ok_or("say where the checkout of refractiveindex.info-database is")?;
    write_table(Path::new(&database)).map_err(|error| error.to_string())
}

fn write_table(database: &Path) -> Result<(), Box<dyn Error>> {
    let mut table = String::from(HEAD);
    table.push_str("/// Materials of one paper each.\n#[rustfmt::skip]\n");
    writeln!(table, "pub(super) static MATERIALS: [Entry; {}] = [", MATERIALS.len())?;
    for Material { file, page, key, aliases, description, source } in &MATERIALS {
        let formula = Formula::read(&page_of(database, file, page))?;
        writeln!(table, "    material({key:?}, &{aliases:?},")?;
        writeln!(table, "        {description:?},")?;
        writeln!(table, "        {source:?},")?;
        writeln!(table, "        {:?}, {:?}, &[", formula.range_nm, formula.constant)?;
        for term in &formula.terms {
            writeln!(table, "            {term:?},")?;
        }
        table.push_str("        ]),\n");
    }
    table.push_str("];\n\n");

    let files = glasses(database)?;
    table.push_str("/// Optical glasses of Schott.\n#[rustfmt::skip]\n");
    writeln!(table, "pub(super) static SCHOTT: [Entry; {}] = [", files.len())?;
    for file in &files {
        let formula = Formula::read(file)?;
        let key = file.file_stem().and_then(|stem| stem.to_str()).ok_or("a file name that is not text")?;
        if formula.constant != 0.0 {
            return Err(format!("{key}: a constant term, which the table of glasses has no place for").into());
        }
        let start = format!("    schott({key:?}, {:?},", formula.range_nm);
        let terms = format!("&{:?}),", formula.terms);
        let separator = if start.len() + 1 + terms.len() > LINE { "\n        " } else { " " };
        writeln!(table, "{start}{separator}{terms}")?;
    }
    table.push_str("];\n");

    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().ok_or("xtask has no parent folder")?;
    fs::write(root.join(TABLE), table)?;
    println!("{TABLE}: {} materials, {} glasses", MATERIALS.len(), files.len());
    absorption::write_tables(root, database)
}

/// A page in a checkout of the database, or in a folder of pages.
fn page_of(database: &Path, file: &str, page: &str) -> PathBuf {
    let inside = database.join(DATA).join(file);
    if inside.exists() { inside } else { database.join(page) }
}

/// The pages of Schott's glasses, by name.
fn glasses(database: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let folder = page_of(database, SCHOTT, "schott");
    let mut files =
        fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path())).collect::<Result<Vec<_>, _>>()?;
    files.retain(|path| path.extension().is_some_and(|extension| extension == "yml"));
    files.sort();
    Ok(files)
}

/// Sellmeier's formula as it goes into the table.
struct Formula {
    range_nm: [f64; 2],
    constant: f64,
    terms: Vec<(f64, f64)>,
}

impl Formula {
    /// Reads a page of the database: the first block of `DATA` must be a formula. Of YAML this needs the one-line
    /// values only.
    fn read(path: &Path) -> Result<Self, Box<dyn Error>> {
        let page = fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
        Self::parse(&page).map_err(|error| format!("{}: {error}", path.display()).into())
    }

    fn parse(page: &str) -> Result<Self, Box<dyn Error>> {
        let (_, data) = page.split_once("\nDATA:").ok_or("no DATA")?;
        let value = |key: &str| {
            data.lines()
                .find_map(|line| line.trim_start_matches([' ', '-']).strip_prefix(key))
                .map(str::trim)
                .ok_or_else(|| format!("no {key}"))
        };
        let numbers = |text: &str| text.split_whitespace().map(str::parse::<f64>).collect::<Result<Vec<_>, _>>();
        let square = match value("type:")? {
            "formula 1" => |pole: f64| pole * pole,
            "formula 2" => |pole: f64| pole,
            other => return Err(format!("{other} is neither formula 1 nor formula 2").into()),
        };
        // The millionth of a nanometre is rounding.
        let nanometres = |micrometres: f64| (micrometres * 1e9).round() / 1e6;
        let [low, high] = numbers(value("wavelength_range:")?)?[..] else {
            return Err("a range of two numbers".into());
        };
        let coefficients = numbers(value("coefficients:")?)?;
        let Some((constant, terms)) = coefficients.split_first().filter(|(_, terms)| terms.len() % 2 == 0) else {
            return Err("an odd number of coefficients is needed".into());
        };
        Ok(Self {
            range_nm: [nanometres(low), nanometres(high)],
            constant: *constant,
            terms: terms.chunks_exact(2).map(|pair| (pair[0], square(pair[1]))).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_both_formulas() {
        let page = |formula: &str| {
            let values = "    wavelength_range: 0.3 2.5\n    coefficients: 0.1 2 3\n";
            format!("COMMENTS: |\n    none\nDATA:\n  - type: {formula}\n{values}")
        };
        let first = Formula::parse(&page("formula 1")).unwrap();
        assert_eq!((first.range_nm, first.constant, first.terms), ([300.0, 2500.0], 0.1, vec![(2.0, 9.0)]));
        assert_eq!(Formula::parse(&page("formula 2")).unwrap().terms, [(2.0, 3.0)]);
        assert!(Formula::parse(&page("formula 3")).is_err());
        assert!(Formula::parse("DATA").is_err());
    }
}

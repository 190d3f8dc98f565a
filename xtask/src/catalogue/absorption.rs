//! The tables of what materials absorb: Schott's glasses, and metals with their complex indices.

use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use super::{glasses, page_of};

const EXTINCTION: &str = "crates/snell-scene/src/catalogue/extinction.rs";
const METALS: &str = "crates/snell-scene/src/catalogue/metals.rs";

/// What light eyes see, with some room, in nanometres: metals are kept for these.
const SEEN_NM: [f64; 2] = [300.0, 1000.0];

const EXTINCTION_HEAD: &str = "\
//! What Schott's glasses absorb: written by `cargo xtask catalogue`, not by hand.
//!
//! From the refractiveindex.info database (Polyanskiy), in the public domain by CC0 1.0: see DATA-LICENSE.md beside this
//! file. Pairs of a wavelength in nanometres and the coefficient of extinction k, the imaginary part of the index.

/// By the name of the glass, in order.
#[rustfmt::skip]
";

const METALS_HEAD: &str = "\
//! Metals with their complex indices: written by `cargo xtask catalogue`, not by hand.
//!
//! From the refractiveindex.info database (Polyanskiy), in the public domain by CC0 1.0: see DATA-LICENSE.md beside this
//! file. Rows of a wavelength in nanometres and n + i k, from 300 to 1000 nm.

use super::Metal;

#[rustfmt::skip]
";

struct Page {
    file: &'static str,
    page: &'static str,
    key: &'static str,
    aliases: &'static [&'static str],
    source: &'static str,
}

const JOHNSON: &str = "Johnson and Christy, Phys. Rev. B 6, 4370 (1972)";

const PAGES: [Page; 4] = [
    Page { file: "main/Ag/nk/Johnson.yml", page: "Ag-Johnson.yml", key: "silver", aliases: &["Ag"], source: JOHNSON },
    Page { file: "main/Au/nk/Johnson.yml", page: "Au-Johnson.yml", key: "gold", aliases: &["Au"], source: JOHNSON },
    Page { file: "main/Cu/nk/Johnson.yml", page: "Cu-Johnson.yml", key: "copper", aliases: &["Cu"], source: JOHNSON },
    Page {
        file: "main/Al/nk/Rakic.yml",
        page: "Al-Rakic.yml",
        key: "aluminium",
        aliases: &["Al", "aluminum"],
        source: "Rakić, Applied Optics 34, 4755 (1995)",
    },
];

/// Writes both.
pub fn write_tables(root: &Path, database: &Path) -> Result<(), Box<dyn Error>> {
    let files = glasses(database)?;
    let mut table = String::from(EXTINCTION_HEAD);
    writeln!(table, "pub(super) static EXTINCTION: [(&str, &[(u16, f32)]); {}] = [", files.len())?;
    for file in &files {
        let key = file.file_stem().and_then(|stem| stem.to_str()).ok_or("a file name that is not text")?;
        let rows = block(&fs::read_to_string(file)?, "tabulated k", 2)?;
        let rows: Vec<(u16, f32)> = rows.iter().map(|row| (row[0].round() as u16, row[1] as f32)).collect();
        writeln!(table, "    ({key:?}, &{rows:?}),")?;
    }
    table.push_str("];\n");
    fs::write(root.join(EXTINCTION), table)?;

    let mut table = String::from(METALS_HEAD);
    writeln!(table, "pub(super) static METALS: [Metal; {}] = [", PAGES.len())?;
    for Page { file, page, key, aliases, source } in &PAGES {
        let text = fs::read_to_string(page_of(database, file, page))?;
        let mut rows = block(&text, "tabulated nk", 3)?;
        rows.retain(|row| (SEEN_NM[0]..=SEEN_NM[1]).contains(&row[0]));
        writeln!(table, "    Metal {{ key: {key:?}, aliases: &{aliases:?}, source: {source:?}, rows: &[")?;
        for row in rows {
            writeln!(table, "        ({:?}, {:?}, {:?}),", row[0], row[1], row[2])?;
        }
        table.push_str("    ] },\n");
    }
    table.push_str("];\n");
    fs::write(root.join(METALS), table)?;
    println!("{EXTINCTION}, {METALS}");
    Ok(())
}

/// The rows of a page's block of data of a type, of so many numbers each; wavelengths in nanometres.
fn block(page: &str, kind: &str, columns: usize) -> Result<Vec<Vec<f64>>, Box<dyn Error>> {
    let (_, rest) = page.split_once(&format!("type: {kind}\n")).ok_or_else(|| format!("no {kind}"))?;
    let mut rows = Vec::new();
    for line in rest.lines().skip(1) {
        let Ok(mut row) = line.split_whitespace().map(str::parse::<f64>).collect::<Result<Vec<_>, _>>() else { break };
        if row.len() != columns {
            break;
        }
        // The thousandth of a nanometre is rounding.
        row[0] = (row[0] * 1e6).round() / 1e3;
        rows.push(row);
    }
    if rows.is_empty() { Err(format!("no rows of {kind}").into()) } else { Ok(rows) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_end_where_their_numbers_do() {
        let page =
            "DATA:\n  - type: tabulated k\n    data: |\n        0.3 1e-6\n        0.4 2e-6\nCONDITIONS:\n    1 2\n";
        assert_eq!(block(page, "tabulated k", 2).unwrap(), [vec![300.0, 1e-6], vec![400.0, 2e-6]]);
        assert!(block(page, "tabulated nk", 3).is_err());
        assert!(block(page, "tabulated k", 3).is_err());
    }
}

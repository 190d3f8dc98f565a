//! The catalogue against an independent table of indices, and as a table of names.

use snell_math::dispersion::fraunhofer::{HELIUM_D, HYDROGEN_C, HYDROGEN_F, MERCURY_E, MERCURY_G, SODIUM_D};

use super::*;

/// The key under which the catalogue has a material of the reference table, where it has it.
fn key_of(reference: &str) -> Option<&str> {
    match reference {
        "fused silica (Malitson)" => Some("fused-silica"),
        "water 20C (Daimon)" => Some("water-20C"),
        "diamond (Peter)" => Some("diamond-dispersive"),
        "sapphire o-ray (Malitson-Dodge)" => Some("sapphire-o"),
        "acrylic PMMA (Sultanova)" => Some("PMMA"),
        "cubic zirconia ZrO2-12%Y2O3 (Wood)" => Some("cubic-zirconia-dispersive"),
        "rock salt NaCl (Li)" => Some("NaCl"),
        "ice (Warren 2008)" | "helium (Mansfield)" | "MgF2 o-ray (Li)" => None,
        glass => Some(glass),
    }
}

/// True where the entry has a row's indices at the lines g, F, e, d and C, its Abbe number and its range.
fn matches_row(entry: &Entry, row: &[&str]) -> bool {
    let dispersion = entry.dispersion();
    let number = |column: usize| row[column].parse::<f64>().unwrap();
    let lines = [MERCURY_G, HYDROGEN_F, MERCURY_E, HELIUM_D, HYDROGEN_C];
    let indices = lines.iter().enumerate().all(|(i, line)| (dispersion.index(*line) - number(4 + i)).abs() < 1e-9);
    // The table's Abbe numbers have twelve digits, of a quotient of differences.
    let abbe = dispersion.abbe_number().is_some_and(|abbe| (abbe - number(9)).abs() < 1e-8);
    let range: Vec<f64> = row[3].split(' ').map(|end| end.parse::<f64>().unwrap() * 1000.0).collect();
    let valid = entry.valid_nm.is_some_and(|valid| (0..2).all(|i| (valid[i] - range[i]).abs() < 1e-6));
    indices && abbe && valid
}

#[test]
fn measured_materials_agree_with_the_reference_table() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/reference/materials_dispersion.csv");
    let Ok(table) = std::fs::read_to_string(path) else {
        println!("skipped: {path} is absent");
        return;
    };
    let mut checked = 0;
    for row in table.lines().skip(2).map(|line| line.split(',').collect::<Vec<_>>()) {
        let Some(key) = key_of(row[0]) else { continue };
        let entry = lookup(key).unwrap_or_else(|| panic!("{key} is not in the catalogue"));
        assert!(matches_row(entry, &row), "{key}");
        // The twin: no other entry passes for it. (High-transmission melts share the coefficients of their glass.)
        let others = entries().filter(|other| other.formula != entry.formula && matches_row(other, &row));
        assert_eq!(others.count(), 0, "{key}");
        checked += 1;
    }
    assert_eq!(checked, 19);
}

#[test]
fn the_lecture_has_its_printed_values() {
    for (name, index) in [
        ("vacuum", 1.0),
        ("helium", 1.000036),
        ("air at STP", 1.0002926),
        ("water ice", 1.31),
        ("liquid water", 1.333),
        ("ethanol", 1.36),
        ("glycerine", 1.4729),
        ("rock salt", 1.516),
        ("salt", 1.516),
        ("glass", 1.5),
        ("cubic zirconia", 2.15),
        ("diamond", 2.419),
    ] {
        assert_eq!(lookup(name).unwrap().dispersion(), Dispersion::Constant(index), "{name}");
    }
    // And the real things beside them.
    assert!((lookup("NaCl").unwrap().dispersion().index(SODIUM_D) - 1.544).abs() < 5e-4);
    assert!((lookup("diamond-dispersive").unwrap().dispersion().index(SODIUM_D) - 2.417).abs() < 5e-4);
    assert!((lookup("water-20C").unwrap().dispersion().index(SODIUM_D) - 1.333).abs() < 5e-4);
}

#[test]
fn names_are_found_however_they_are_spelt() {
    for (spelling, key) in [
        ("N-BK7", "N-BK7"),
        ("nbk7", "N-BK7"),
        ("n bk 7", "N-BK7"),
        ("BK7", "N-BK7"),
        ("bak 4", "N-BAK4"),
        ("F2", "F2"),
        ("n_sf11", "N-SF11"),
        ("ROCK SALT", "rock salt"),
        ("rock-salt", "rock salt"),
        ("CubicZirconia", "cubic zirconia"),
        ("Plexiglas", "PMMA"),
        ("water 20c", "water-20C"),
        (" Diamond ", "diamond"),
    ] {
        assert_eq!(lookup(spelling).map(|entry| entry.key), Some(key), "{spelling}");
    }
    for unknown in ["", "-", " ", "diamonds", "N-BK", "wåter"] {
        assert_eq!(lookup(unknown), None, "{unknown}");
    }
}

#[test]
fn every_name_means_one_entry() {
    let mut seen: Vec<String> = Vec::new();
    for entry in entries() {
        for name in std::iter::once(&entry.key).chain(entry.aliases) {
            assert_eq!(lookup(name), Some(entry), "{name}");
            seen.push(letters(name).collect());
        }
        assert!(!entry.description.is_empty() && !entry.source.is_empty());
    }
    let count = seen.len();
    seen.sort();
    seen.dedup();
    assert_eq!(seen.len(), count, "two names are the same but for case, spaces and dashes");
    assert_eq!(names().count(), 11 + 7 + 156);
}

#[test]
fn every_glass_behaves_like_glass_in_visible_light() {
    for entry in entries().filter(|entry| entry.valid_nm.is_some()) {
        let dispersion = entry.dispersion();
        assert!(dispersion.is_dispersive());
        let mut before = f64::INFINITY;
        for nanometre in (360..=830).step_by(5) {
            let index = dispersion.index(f64::from(nanometre));
            assert!((1.3..2.6).contains(&index) && index < before, "{} at {nanometre} nm: {index}", entry.key);
            before = index;
        }
        let abbe = dispersion.abbe_number().unwrap();
        assert!((15.0..100.0).contains(&abbe), "{}: {abbe}", entry.key);
    }
}

#[test]
fn glasses_have_the_data_of_their_glass_code() {
    // The first three digits of a code are n_d − 1, the last three ten times the Abbe number.
    for (key, code) in
        [("N-BK7", 517_642), ("SF10", 728_284), ("F2", 620_364), ("N-FK51A", 487_845), ("LASF35", 22_291)]
    {
        let dispersion = lookup(key).unwrap().dispersion();
        let index = ((dispersion.index(HELIUM_D) - 1.0) * 1000.0).round() as u32 % 1000;
        let abbe = (dispersion.abbe_number().unwrap() * 10.0).round() as u32;
        assert_eq!(index * 1000 + abbe, code, "{key}");
    }
}

#[test]
fn suggestions_are_near_and_long_names_cost_nothing() {
    assert_eq!(suggest("watre"), Some("water"));
    assert_eq!(suggest("N-BKK7"), Some("N-BK7"));
    assert_eq!(suggest("glycerole"), Some("glycerol"));
    assert_eq!(suggest("xyzzy plugh"), None);
    assert_eq!(suggest(&"diamond".repeat(1_000_000)), None);
}

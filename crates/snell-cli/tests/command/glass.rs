//! `snell glass`: what it tells of the catalogue, against independent values, and what it says to mistakes.

use serde_json::Value;

use crate::support::Folder;

fn text(folder: &Folder, line: &str) -> String {
    String::from_utf8(folder.good(line).stdout).unwrap()
}

fn json(folder: &Folder, line: &str) -> Value {
    folder.good(&format!("{line} --format json")).json()
}

/// What is said where the command fails with this code.
fn bad(folder: &Folder, line: &str, code: i32) -> String {
    let run = folder.run(line);
    assert_eq!(run.code, Some(code), "{run:?}");
    run.stderr
}

#[test]
fn all_materials_are_listed_and_searched() {
    let folder = Folder::new();
    let all = text(&folder, "glass");
    for part in ["N-BK7", "SF57HTultra", "diamond-dispersive", "rock salt", "PMMA", "1.51680   64.17"] {
        assert!(all.contains(part), "{part}\n{all}");
    }
    assert_eq!(all.lines().count(), 1 + 11 + 7 + 156);
    let found = text(&folder, "glass --search sapphire");
    assert!(found.lines().count() == 2 && found.contains("sapphire-o"), "{found}");
    let told = bad(&folder, "glass --search unobtainium", 1);
    assert!(told.contains("no material has \"unobtainium\""), "{told}");
}

#[test]
fn a_glass_is_told_with_its_lines_formula_source_and_transmittance() {
    let folder = Folder::new();
    let told = text(&folder, "glass n-bk7");
    for part in [
        "N-BK7: optical glass of Schott",
        "Zemax catalogue of 2017",
        "Sellmeier: n\u{b2} = 1 + 1.03961212 \u{3bb}\u{b2}/(\u{3bb}\u{b2} - 0.00600069867)",
        "300 to 2500 nm; wavelengths in air",
        "n_d      1.516800",
        "V_d      64.1673",
        "  d      587.5618   1.516800  yellow helium",
        "internal transmittance of 10 mm",
    ] {
        assert!(told.contains(part), "{part}\n{told}");
    }
}

#[test]
fn numbers_agree_with_the_reference_table() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/reference/materials_dispersion.csv");
    let Ok(table) = std::fs::read_to_string(path) else {
        println!("skipped: {path} is absent");
        return;
    };
    let folder = Folder::new();
    let all = json(&folder, "glass");
    let mut checked = 0;
    for row in table.lines().skip(2).map(|line| line.split(',').collect::<Vec<_>>()) {
        let Some(glass) = all.as_array().unwrap().iter().find(|glass| glass["name"] == row[0]) else { continue };
        let near =
            |value: &Value, column: usize| (value.as_f64().unwrap() - row[column].parse::<f64>().unwrap()).abs() < 1e-8;
        for (line, column) in [("g", 4), ("F", 5), ("e", 6), ("d", 7), ("C", 8)] {
            assert!(near(&glass["lines"][line]["index"], column), "{} {line}", row[0]);
        }
        assert!(near(&glass["nd"], 7) && near(&glass["index"], 7) && near(&glass["vd"], 9), "{}", row[0]);
        assert!(!near(&glass["lines"]["h"]["index"], 4), "the twin");
        checked += 1;
    }
    assert_eq!(checked, 12);
}

#[test]
fn wavelengths_are_in_air_or_in_vacuum_as_stated() {
    let folder = Folder::new();
    let told = json(&folder, "glass N-BK7 --at 587.5618");
    assert!((told["index"].as_f64().unwrap() - 1.5168000345).abs() < 1e-10);
    assert_eq!(told["at"][0]["relative_to"], "air");
    assert!((told["at"][0]["vacuum_nm"].as_f64().unwrap() - 587.7247).abs() < 1e-3);
    // In vacuum: the same light, and an index larger by that of air.
    let vacuum = json(&folder, "glass N-BK7 --at 587.72467 --in vacuum");
    let (absolute, relative) = (vacuum["index"].as_f64().unwrap(), told["index"].as_f64().unwrap());
    assert!((absolute / relative - 1.000_277).abs() < 1e-6, "{absolute}");
    // A table's number is not converted.
    assert_eq!(json(&folder, "glass diamond --at 500 --in air")["index"], 2.419);
    let said = text(&folder, "glass fused-silica --at 632.8 --at 1064");
    assert_eq!(said.lines().count(), 2);
    assert!(said.starts_with("fused-silica at 632.8 nm in vacuum (632.6251 nm in air): 1.45701"), "{said}");
}

#[test]
fn beyond_its_range_a_formula_is_not_extrapolated_in_silence() {
    let folder = Folder::new();
    let run = folder.good("glass N-SF11 --at 300");
    let warning = run.stderr;
    assert!(warning.contains("the index of N-SF11 was measured from 370 to 2500 nm"), "{warning}");
    assert!(folder.good("glass N-SF11 --at 400").stderr.is_empty(), "the twin");
    assert!(text(&folder, "glass N-SF11").contains("(outside of the range: extrapolated)"));
}

#[test]
fn indices_are_drawn() {
    let folder = Folder::new();
    folder.good("glass N-BK7 -o n.svg");
    let svg = std::fs::read_to_string(folder.path("n.svg")).unwrap();
    assert!(svg.starts_with("<svg ") && svg.contains("index curves") && svg.contains("index axes"), "{svg}");
    folder.good("glass N-BK7 -o n.json");
    let told = bad(&folder, "glass N-BK7 -o n.doc", 2);
    assert!(told.contains("says no format"), "{told}");
    assert!(bad(&folder, "glass -o all.svg", 2).contains("for one material"));
}

#[test]
fn files_of_glasses_are_read() {
    let folder = Folder::new();
    folder.write("a.agf", "CC mine\nNM ONE 2 0 0 0\nCD 1 0.01\nLD 0.4 0.7\nNM TWO 1\nCD 2.25\nNM BAD 77\nCD 1\n");
    let run = folder.good("glass a.agf");
    let (list, warning) = (run.text().to_owned(), run.stderr);
    assert!(list.contains("ONE") && list.contains("TWO    1.50000"), "{list}");
    assert!(warning.contains("a.agf:7: BAD: formula 77 is none of the 13"), "{warning}");
    let one = json(&folder, "glass a.agf#one --at 500");
    assert!((one["index"].as_f64().unwrap() - (1.0_f64 + 0.25 / (0.25 - 0.01)).sqrt()).abs() < 1e-15);
    assert!(bad(&folder, "glass a.agf#TWOO", 1).contains("did you mean \"TWO\"?"));
    assert!(bad(&folder, "glass none.agf", 1).contains("there is no such file"));
}

#[test]
fn unknown_names_are_suggested() {
    let folder = Folder::new();
    assert!(bad(&folder, "glass N-BKK7", 1).contains("did you mean \"N-BK7\"?"));
    assert!(bad(&folder, "glass granite", 1).contains("`snell glass` lists all"));
    bad(&folder, "glass N-BK7 --at 3", 2);
}

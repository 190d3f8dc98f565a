//! Files of glasses: formulas against their textbook form, mistakes with their lines, hostile bytes, and the pages that the
//! catalogue was made from.

use proptest::prelude::*;
use snell_math::dispersion::fraunhofer::{HELIUM_D, HYDROGEN_C, MERCURY_G};
use snell_math::portable;

use super::*;
use crate::catalogue::{self, Medium};

fn agf(formula: u32, coefficients: &str) -> GlassFile {
    let text =
        format!("CC test\r\nNM X {formula} 0 0 0\r\nGC a comment\r\nED 1 2 3\r\nCD {coefficients}\r\nLD 0.3 2.5\r\n");
    read_glass_file("a.AGF", text.as_bytes())
}

/// The index that the only glass of a file has.
fn index(file: &GlassFile, nm: f64) -> f64 {
    assert_eq!(file.problems, []);
    file.glasses[0].dispersion.index(nm)
}

#[test]
fn formulas_of_zemax_are_those_of_its_manual() {
    let l = HELIUM_D * 1e-3;
    let s = l * l;
    let i = 1.0 / s;
    let h = 1.0 / (s - 0.028);
    let pow = portable::pow;
    let cases = [
        (
            1,
            "2.27 -0.01 0.0106 0.0002 -7e-6 5e-7",
            (2.27 - 0.01 * s + (0.0106 + (0.0002 + (-7e-6 + 5e-7 * i) * i) * i) * i).sqrt(),
        ),
        (2, "1 0.006 0.2 0.02 1 100", (1.0 + s / (s - 0.006) + 0.2 * s / (s - 0.02) + s / (s - 100.0)).sqrt()),
        (
            3,
            "1.5 0.01 0.001 -0.002 1e-4 1e-5",
            1.5 + 0.01 * h + 0.001 * h * h - 0.002 * s + 1e-4 * s * s + 1e-5 * s * s * s,
        ),
        (4, "0.2 1 0.1 0.01 5", (1.2 + s / (s - 0.01) + 0.01 / (s - 25.0)).sqrt()),
        (5, "1.5 0.01 0.001", 1.5 + 0.01 / l + 0.001 / pow(l, 3.5)),
        (
            6,
            "1 0.006 0.2 0.02 1 100 0.1 0.001",
            (1.0 + s / (s - 0.006) + 0.2 * s / (s - 0.02) + s / (s - 100.0) + 0.1 * s / (s - 0.001)).sqrt(),
        ),
        (7, "2.2 0.01 0.02 0.003", (2.2 + 0.01 / (s - 0.02) - 0.003 * s).sqrt()),
        (8, "1.2 1.1 0.01 0.003", (1.2 + 1.1 * s / (s - 0.01) - 0.003 * s).sqrt()),
        (9, "1.2 1.1 0.01 0.5 90", (1.2 + 1.1 * s / (s - 0.01) + 0.5 * s / (s - 90.0)).sqrt()),
        (10, "2.2 0 0.01 0 0 0 1e-6 1e-7", (2.2 + 0.01 * i + 1e-6 * pow(i, 5.0) + 1e-7 * pow(i, 6.0)).sqrt()),
        (
            11,
            "1 0.006 0.2 0.02 1 100 0.1 0.001 0.3 0.002",
            (1.0 + s / (s - 0.006)
                + 0.2 * s / (s - 0.02)
                + s / (s - 100.0)
                + 0.1 * s / (s - 0.001)
                + 0.3 * s / (s - 0.002))
                .sqrt(),
        ),
        (12, "2.2 0 0.01 0 0 0 1e-3 1e-4", (2.2 + 0.01 * i + 1e-3 * s * s + 1e-4 * s * s * s).sqrt()),
        (13, "2.2 0 1e-3 0.01 0 0 0 0 1e-6", (2.2 + 1e-3 * s * s + 0.01 * i + 1e-6 * pow(i, 6.0)).sqrt()),
    ];
    for (number, coefficients, expected) in cases {
        let ours = index(&agf(number, coefficients), HELIUM_D);
        assert!((ours - expected).abs() < 1e-12, "formula {number}: {ours} {expected}");
        // The twin: the next formula is another one.
        let other = agf(number % 13 + 1, coefficients);
        assert!((index(&other, HELIUM_D) - expected).abs() > 1e-7, "formula {number}");
    }
}

#[test]
fn a_zemax_catalogue_has_names_comments_ranges_and_transmittance() {
    let text = "CC Test glasses\nNM A 2 517642 1.5168 64.17 0 1\nGC a crown\nCD 1.03961212 0.00600069867 0.231792344 0.0200179144 1.01046945 103.560653\n\
                LD 0.31 2.5\nIT 0.5 0.99 10\nIT 0.4 0.98 25.0\nIT 0.6\nNM B 2.0 0 0 0\nCD 1 oh\nNM C 99\nCD 1\nNM\nCD 1 1\nNM D 1\n";
    let file = read_glass_file("dir/test.agf", text.as_bytes());
    assert_eq!(file.glasses.len(), 1);
    let glass = &file.glasses[0];
    assert_eq!(
        (glass.name.as_str(), glass.description.as_str(), glass.source.as_str()),
        ("A", "a crown", "Test glasses")
    );
    assert_eq!((glass.valid_nm, glass.reference), (Some([310.0, 2500.0]), Medium::Air));
    assert!((glass.internal_transmittance(500.0, 10.0).unwrap() - 0.99).abs() < 1e-12);
    assert!((glass.internal_transmittance(400.0, 25.0).unwrap() - 0.98).abs() < 1e-12);
    assert!((glass.internal_transmittance(500.0, 20.0).unwrap() - 0.99 * 0.99).abs() < 1e-12);
    assert_eq!((glass.internal_transmittance(399.0, 10.0), glass.internal_transmittance(501.0, 10.0)), (None, None));
    let told: Vec<_> = file.problems.iter().map(|p| (p.glass.as_str(), p.line, p.message.as_str())).collect();
    assert_eq!(
        told,
        [
            ("B", 10, "\"oh\" is no finite number"),
            ("C", 11, "formula 99 is none of the 13 that are known"),
            ("", 13, "a glass without a name"),
            ("D", 15, "the glass has no coefficients (CD)"),
        ]
    );
}

#[test]
fn texts_may_be_utf_16_and_files_may_be_nothing() {
    let text = "NM A 2\nCD 1 0.01\n";
    let wide: Vec<u8> = [0xff, 0xfe].into_iter().chain(text.encode_utf16().flat_map(u16::to_le_bytes)).collect();
    assert_eq!(read_glass_file("a.agf", &wide), read_glass_file("a.agf", text.as_bytes()));
    for name in ["a.agf", "a.yml", "a.txt", "", "agf"] {
        let file = read_glass_file(name, b"");
        assert!(file.glasses.is_empty() && file.problems.len() == 1, "{name}");
    }
}

fn page(data: &str) -> GlassFile {
    let text = format!(
        "REFERENCES: |\n    <a href=\"x\">Someone</a>,\n    1999\nDATA:\n{data}CONDITIONS:\n    temperature: 293\n"
    );
    read_glass_file("db/page.yml", text.as_bytes())
}

#[test]
fn formulas_of_the_database_are_those_of_its_documentation() {
    let l = HELIUM_D * 1e-3;
    let s = l * l;
    let h = 1.0 / (s - 0.028);
    let pow = portable::pow;
    let cases = [
        (1, "0.1 1 0.1", (1.1 + s / (s - 0.01)).sqrt()),
        (2, "0.1 1 0.01", (1.1 + s / (s - 0.01)).sqrt()),
        (3, "2.2 0.01 -2 0.001 1.5", (2.2 + 0.01 / s + 0.001 * pow(l, 1.5)).sqrt()),
        (4, "1.5 0.9 2 0.1 2 0.01 0 3 2 0.002 2", (1.5 + 0.9 * s / (s - 0.01) + 0.01 / (s - 9.0) + 0.002 * s).sqrt()),
        (5, "1.5 0.004 -2 1e-5 -4", 1.5 + 0.004 / s + 1e-5 / (s * s)),
        (6, "0 0.0147 423.98", 1.0 + 0.0147 / (423.98 - 1.0 / s)),
        (
            7,
            "1.5 0.01 0.001 -0.002 1e-4 1e-5",
            1.5 + 0.01 * h + 0.001 * h * h - 0.002 * s + 1e-4 * s * s + 1e-5 * s * s * s,
        ),
    ];
    for (number, coefficients, expected) in cases {
        let file = page(&format!(
            "  - type: formula {number}\n    wavelength_range: 0.3 2\n    coefficients: {coefficients}\n"
        ));
        assert!((index(&file, HELIUM_D) - expected).abs() < 1e-13, "formula {number}");
        assert!((index(&file, HELIUM_D + 5.0) - expected).abs() > 1e-10, "the twin");
        assert_eq!(file.glasses[0].valid_nm, Some([300.0, 2000.0]));
        assert_eq!((file.glasses[0].name.as_str(), file.glasses[0].source.as_str()), ("page", "Someone, 1999"));
    }
    let table = page("  - type: tabulated nk\n    data: |\n        0.4 1.6 1e-6\n        0.5 1.5 2e-6\n");
    assert!((index(&table, 450.0) - 1.55).abs() < 1e-14);
    assert_eq!(table.glasses[0].extinction, [[400.0, 1e-6], [500.0, 2e-6]]);
}

#[test]
fn pages_with_mistakes_are_told_with_their_line() {
    for (data, line, message) in [
        ("  - type: formula 9\n    coefficients: 1 2\n", 5, "\"formula 9\" is no formula that is known"),
        ("  - type: formula 2\n", 5, "formula 2 has no coefficients"),
        ("  - type: formula 2\n    coefficients: 1 x\n", 6, "\"x\" is no finite number"),
        (
            "  - type: formula 2\n    wavelength_range: 2 1\n",
            6,
            "a range of wavelengths needs two ascending numbers in micrometres",
        ),
        (
            "  - type: tabulated n\n    data: |\n        0.4 1.5\n        0.3 1.6\n",
            5,
            "the wavelengths of tabulated n do not ascend",
        ),
        ("  - type: tabulated n\n    data: |\n        0.4 1.5 7\n", 5, "each row of tabulated n needs 2 numbers"),
        ("  - type: tabulated n\n    data: |\n", 5, "tabulated n has no rows"),
        ("  - type: tabulated k\n    data: |\n        0.4 1.5\n", 1, "the page gives no index of refraction"),
        ("", 1, "the page has no DATA"),
    ] {
        let file = page(data);
        assert_eq!(file.glasses, []);
        assert_eq!(file.problems, [GlassProblem { glass: "page".to_owned(), line, message: message.to_owned() }]);
    }
}

/// The materials that the catalogue was made from, where they are at hand.
fn shared_page(name: &str) -> Option<GlassFile> {
    let path = format!("{}/../../../shared/assets/materials/{name}.yml", env!("CARGO_MANIFEST_DIR"));
    std::fs::read(&path).ok().map(|bytes| read_glass_file(&path, &bytes))
}

#[test]
fn the_catalogue_is_the_pages_it_was_made_from() {
    if shared_page("SiO2-Malitson").is_none() {
        println!("skipped: the pages are absent");
        return;
    }
    let others = [
        ("H2O-Daimon-20C", "water-20C"),
        ("SiO2-Malitson", "fused-silica"),
        ("PMMA-Sultanova", "PMMA"),
        ("NaCl-Li", "NaCl"),
        ("Al2O3-Malitson-o", "sapphire-o"),
        ("CubicZirconia-Wood", "cubic-zirconia-dispersive"),
        ("C-Peter-diamond", "diamond-dispersive"),
    ];
    let schott = catalogue::entries().filter(|entry| entry.reference == Medium::Air);
    let pages: Vec<(String, &str)> = schott
        .map(|entry| (format!("schott/{}", entry.key), entry.key))
        .chain(others.map(|(page, key)| (page.to_owned(), key)))
        .collect();
    assert_eq!(pages.len(), 156 + 7);
    for (page, key) in pages {
        let file = shared_page(&page).unwrap_or_else(|| panic!("no page {page}"));
        assert_eq!(file.problems, [], "{page}");
        let (ours, theirs) = (Glass::from(catalogue::lookup(key).unwrap()), &file.glasses[0]);
        assert_eq!((ours.valid_nm, ours.reference), (theirs.valid_nm, theirs.reference), "{page}");
        for nm in [MERCURY_G, HELIUM_D, HYDROGEN_C] {
            assert_eq!(ours.dispersion.index(nm), theirs.dispersion.index(nm), "{page}");
            assert_ne!(ours.dispersion.index(nm + 1.0), theirs.dispersion.index(nm), "the twin");
        }
        if ours.reference == Medium::Air {
            assert_eq!(ours.extinction.len(), theirs.extinction.len(), "{page}");
            for (ours, theirs) in ours.extinction.iter().zip(&theirs.extinction) {
                assert!(
                    ours[0] == theirs[0] && (ours[1] / theirs[1] - 1.0).abs() < 1e-6,
                    "{page}: {ours:?} {theirs:?}"
                );
            }
        }
    }
    for (page, key) in
        [("Ag-Johnson", "silver"), ("Au-Johnson", "gold"), ("Cu-Johnson", "copper"), ("Al-Rakic", "aluminium")]
    {
        let file = shared_page(page).unwrap();
        let metal = catalogue::metal(key).unwrap();
        for (row, [nm, k]) in
            metal.rows.iter().zip(file.glasses[0].extinction.iter().filter(|row| (300.0..=1000.0).contains(&row[0])))
        {
            assert_eq!((row.0, row.1, row.2), (*nm, file.glasses[0].dispersion.index(*nm), *k), "{page}");
        }
        assert!(metal.rows.len() > 20);
        assert_eq!(metal.index(0.0), [metal.rows[0].1, metal.rows[0].2]);
        let last = metal.rows[metal.rows.len() - 1];
        assert_eq!(metal.index(1e9), [last.1, last.2]);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn nothing_panics(bytes in prop::collection::vec(any::<u8>(), 0..400), which in 0..2usize) {
        let _ = read_glass_file(["a.agf", "a.yml"][which], &bytes);
    }

    #[test]
    fn words_of_the_formats_in_any_order_give_usable_indices(
        words in prop::collection::vec(prop::sample::select(vec![
            "NM", "CD", "LD", "IT", "CC", "A", "2", "3", "4", "7", "0.1", "-1e300", "0", "nan", "\n", "DATA:\n", "  - type: ", "formula 4\n",
            "formula 6\n", "tabulated nk\n", "    coefficients: ", "    wavelength_range: ", "    data: |\n", "        ", "1e-300",
        ]), 0..60),
    ) {
        let text = words.join(" ").replace("\n ", "\n");
        for name in ["a.agf", "a.yml"] {
            for glass in read_glass_file(name, text.as_bytes()).glasses {
                for nm in [0.0, 100.0, 550.0, 1e9] {
                    prop_assert!(glass.dispersion.index(nm) > 0.0);
                    let _ = glass.internal_transmittance(nm, 10.0);
                }
            }
        }
    }
}

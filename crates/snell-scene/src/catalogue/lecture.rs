//! The lecture's table of indices of refraction, with the values it prints.
//!
//! Follows: CS5310, lecture 3, "Refraction": n_D, at the sodium line of 589.3 nm. Where the table prints a range, the
//! entry has its lower end. Rock salt is printed as 1.516; it measures 1.544, which is what the entry `NaCl` gives.

use super::{Entry, Formula, Medium};

pub(super) static LECTURE: [Entry; 11] = [
    printed("vacuum", &[], "vacuum, by definition", 1.0),
    printed("helium", &[], "helium gas", 1.000_036),
    printed("air", &["air at STP"], "air at standard temperature and pressure", 1.000_292_6),
    printed("ice", &["water ice"], "water ice", 1.31),
    printed("water", &["liquid water"], "liquid water at 20 °C", 1.333),
    printed("ethanol", &["alcohol"], "ethanol", 1.36),
    printed("glycerine", &["glycerin", "glycerol"], "glycerine", 1.4729),
    printed(
        "rock salt",
        &["salt", "halite"],
        "rock salt as the lecture prints it (it measures 1.544: see NaCl)",
        1.516,
    ),
    printed("glass", &["typical glass"], "typical glass, the lower end of 1.5 to 1.9", 1.5),
    printed("cubic zirconia", &["zirconia"], "cubic zirconia, the lower end of 2.15 to 2.18", 2.15),
    printed("diamond", &[], "diamond", 2.419),
];

/// By the lecture's name, the entry of what was measured of the same material.
pub(super) const MEASURED: [(&str, &str); 4] = [
    ("water", "water-20C"),
    ("rock salt", "NaCl"),
    ("cubic zirconia", "cubic-zirconia-dispersive"),
    ("diamond", "diamond-dispersive"),
];

const fn printed(key: &'static str, aliases: &'static [&'static str], description: &'static str, index: f64) -> Entry {
    Entry {
        key,
        aliases,
        description,
        source: "CS5310, lecture 3, table of indices of refraction at 589.3 nm",
        formula: Formula::Constant(index),
        valid_nm: None,
        reference: Medium::Vacuum,
    }
}

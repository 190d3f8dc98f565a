//! The catalogue of transparent materials by name: what `ior = "N-BK7"` in a scene means.
//!
//! Two kinds of entry:
//! - the lecture's table, under the names it uses (`water`, `rock salt`, `glass`, `diamond`, …), with the one value it
//!   prints: the same index for every wavelength. Rock salt is 1.516 there, as printed, though the crystal measures
//!   1.544;
//! - measured materials with dispersion, so that white light splits: every Schott glass under its own name (`N-BK7`,
//!   `SF10`), and crystals, water and plastics under names that differ from the lecture's: `water-20C`, `fused-silica`,
//!   `PMMA`, `NaCl`, `sapphire-o`, `cubic-zirconia-dispersive`, `diamond-dispersive`. Path tracing takes them for the lecture's too
//!   ([`Entry::measured`]). An old name of a glass that is no
//!   more in Schott's catalogue, such as `BK7`, means the glass that took its place, which has N- before it.
//!
//! Schott's indices are relative to air, as its data sheets give them, and by wavelengths in air; the difference to vacuum, a
//! share of 0.0003, is below what a picture shows. What Schott's glasses absorb is here too, and metals ([`metal()`]) are. Names are
//! compared without regard to case, spaces, dashes and underscores. The tables are constants: nothing is parsed or built at
//! start-up. Glasses that are not here come from files ([`read_glass_file`]).

mod extinction;
mod file;
mod glass;
mod lecture;
mod measured;
mod metal;
mod metals;

pub(crate) use file::split;
pub use file::{GlassFile, GlassProblem, is_glass_file, read_glass_file};
pub use glass::Glass;
pub use metal::{Metal, metal, metals};

use snell_math::Dispersion;

use crate::diagnostic::did_you_mean;

/// The longest name that is looked at for a suggestion, in bytes.
const LONGEST_NAME: usize = 64;

/// One material of the catalogue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// Its name, as documentation and diagnostics write it.
    pub key: &'static str,
    /// Other names that mean the same.
    pub aliases: &'static [&'static str],
    /// What it is, in a few words.
    pub description: &'static str,
    /// Who measured or printed it.
    pub source: &'static str,
    /// Its index of refraction.
    pub formula: Formula,
    /// The wavelengths, in nanometres, between which the formula was fitted; `None` for a fixed value. Beyond, the
    /// formula is extrapolated.
    pub valid_nm: Option<[f64; 2]>,
    /// What wavelengths are measured in, and what the index is relative to.
    pub reference: Medium,
}

/// What wavelengths are measured in, and what indices are relative to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Medium {
    /// Nothing.
    Vacuum,
    /// Standard air, whose index is about 1.00028.
    Air,
}

/// A [`Dispersion`] that can be a constant of the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Formula {
    /// As [`Dispersion::Constant`].
    Constant(f64),
    /// As [`Dispersion::Sellmeier`]: the constant c₀ and the pairs (bᵢ, cᵢ), cᵢ in square micrometres.
    Sellmeier(f64, &'static [(f64, f64)]),
}

impl Entry {
    /// The index of refraction as a scene holds it.
    pub fn dispersion(&self) -> Dispersion {
        match self.formula {
            Formula::Constant(index) => Dispersion::Constant(index),
            Formula::Sellmeier(constant, terms) => Dispersion::Sellmeier { constant, terms: terms.to_vec() },
        }
    }

    /// What was measured of the material of which the lecture prints one index: what path tracing takes for it. `None` where nothing was,
    /// and for what is measured itself.
    ///
    /// ```
    /// use snell_scene::catalogue;
    /// let water = catalogue::lookup("water").unwrap();
    /// assert_eq!(water.measured().unwrap().key, "water-20C");
    /// assert!(catalogue::lookup("ice").unwrap().measured().is_none());
    /// ```
    pub fn measured(&self) -> Option<&'static Self> {
        let (_, key) = lecture::MEASURED.iter().find(|(printed, _)| *printed == self.key)?;
        measured::MATERIALS.iter().find(|entry| entry.key == *key)
    }

    /// What the material absorbs: pairs of ascending wavelengths in nanometres and the coefficient of extinction k, the imaginary
    /// part of the index. Empty where the catalogue does not know.
    ///
    /// ```
    /// use snell_scene::catalogue;
    /// assert!(catalogue::lookup("SF6").unwrap().extinction().len() > 10);
    /// assert!(catalogue::lookup("water").unwrap().extinction().is_empty());
    /// ```
    pub fn extinction(&self) -> &'static [(u16, f32)] {
        extinction::EXTINCTION
            .binary_search_by(|(key, _)| key.cmp(&self.key))
            .map_or(&[], |at| extinction::EXTINCTION[at].1)
    }

    /// True where one of its names is this one.
    fn is_called(&self, name: &str) -> bool {
        std::iter::once(&self.key).chain(self.aliases).any(|own| letters(own).eq(letters(name)))
    }
}

/// The material of this name, without regard to case, spaces, dashes and underscores.
///
/// ```
/// use snell_scene::catalogue;
/// let glass = catalogue::lookup("n-bk7").unwrap();
/// assert_eq!(glass.key, "N-BK7");
/// assert!((glass.dispersion().index(587.5618) - 1.5168).abs() < 1e-6);
/// assert_eq!(catalogue::lookup("Rock-Salt").unwrap().dispersion().index(589.3), 1.516);
/// assert!(catalogue::lookup("unobtainium").is_none());
/// ```
pub fn lookup(name: &str) -> Option<&'static Entry> {
    let successor = |entry: &&Entry| entry.key.strip_prefix("N-").is_some_and(|old| letters(old).eq(letters(name)));
    entries().find(|entry| entry.is_called(name)).or_else(|| measured::SCHOTT.iter().find(successor))
}

/// All entries: the lecture's table in its order, then the measured materials, then the glasses in the order of their
/// names.
pub fn entries() -> impl Iterator<Item = &'static Entry> {
    lecture::LECTURE.iter().chain(&measured::MATERIALS).chain(&measured::SCHOTT)
}

/// The keys of all entries, in their order.
pub fn names() -> impl Iterator<Item = &'static str> {
    entries().map(|entry| entry.key)
}

/// The name nearest to one that is not in the catalogue, where one is near.
///
/// ```
/// use snell_scene::catalogue;
/// assert_eq!(catalogue::suggest("dimond"), Some("diamond"));
/// assert_eq!(catalogue::suggest("N-SF111"), Some("N-SF11"));
/// assert_eq!(catalogue::suggest("granite"), None);
/// ```
pub fn suggest(name: &str) -> Option<&'static str> {
    // Comparing takes time with the product of the lengths, and no name is as long as this.
    if name.len() > LONGEST_NAME {
        return None;
    }
    did_you_mean(name, entries().flat_map(|entry| std::iter::once(entry.key).chain(entry.aliases.iter().copied())))
}

/// What is compared of a name.
fn letters(name: &str) -> impl Iterator<Item = char> {
    name.chars().filter(|c| !c.is_whitespace() && !matches!(c, '-' | '_')).flat_map(char::to_lowercase)
}

/// An entry of the generated table of materials.
const fn material(
    key: &'static str,
    aliases: &'static [&'static str],
    description: &'static str,
    source: &'static str,
    valid_nm: [f64; 2],
    constant: f64,
    terms: &'static [(f64, f64)],
) -> Entry {
    Entry {
        key,
        aliases,
        description,
        source,
        formula: Formula::Sellmeier(constant, terms),
        valid_nm: Some(valid_nm),
        reference: Medium::Vacuum,
    }
}

/// An entry of the generated table of glasses.
const fn schott(key: &'static str, valid_nm: [f64; 2], terms: &'static [(f64, f64)]) -> Entry {
    Entry {
        key,
        aliases: &[],
        description: "optical glass of Schott, index relative to air",
        source: "Schott, Zemax catalogue of 2017-01-20",
        formula: Formula::Sellmeier(0.0, terms),
        valid_nm: Some(valid_nm),
        reference: Medium::Air,
    }
}

#[cfg(test)]
mod tests;

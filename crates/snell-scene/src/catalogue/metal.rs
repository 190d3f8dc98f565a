//! Metals by name, with their complex indices.

use super::letters;
use super::metals::METALS;

/// A metal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metal {
    /// Its name.
    pub key: &'static str,
    /// Other names that mean the same.
    pub aliases: &'static [&'static str],
    /// Who measured it.
    pub source: &'static str,
    /// Rows (λ, n, k): ascending wavelengths in nanometres, and the complex index n + i k.
    pub rows: &'static [(f64, f64, f64)],
}

impl Metal {
    /// n and k at a wavelength in nanometres, linear between the rows; beyond the ends, those of the nearer one.
    ///
    /// ```
    /// use snell_scene::catalogue;
    /// let [n, k] = catalogue::metal("gold").unwrap().index(582.1);
    /// assert!((n - 0.29).abs() < 1e-9 && (k - 2.863).abs() < 1e-9);
    /// ```
    pub fn index(&self, wavelength_nm: f64) -> [f64; 2] {
        let after = self.rows.partition_point(|(nm, ..)| *nm <= wavelength_nm).clamp(1, self.rows.len() - 1);
        let ((low, n0, k0), (high, n1, k1)) = (self.rows[after - 1], self.rows[after]);
        let fraction = ((wavelength_nm - low) / (high - low)).clamp(0.0, 1.0);
        [n0 * (1.0 - fraction) + n1 * fraction, k0 * (1.0 - fraction) + k1 * fraction]
    }
}

/// The metal of this name, without regard to case, spaces, dashes and underscores.
///
/// ```
/// use snell_scene::catalogue;
/// assert_eq!(catalogue::metal("Aluminum").unwrap().key, "aluminium");
/// assert!(catalogue::metal("adamantium").is_none());
/// ```
pub fn metal(name: &str) -> Option<&'static Metal> {
    let is_called = |own: &str| letters(own).eq(letters(name));
    METALS.iter().find(|metal| is_called(metal.key) || metal.aliases.iter().any(|alias| is_called(alias)))
}

/// All metals.
pub fn metals() -> impl Iterator<Item = &'static Metal> {
    METALS.iter()
}

//! The index of refraction as a function of wavelength.
//!
//! The formulas are those of glass makers' data sheets and of the refractiveindex.info database (Polyanskiy,
//! "Refractiveindex.info database of optical constants", Scientific Data 11, 94, 2024): its formula 1 is Sellmeier's
//! with the poles given as wavelengths (square them), its formula 2 is Sellmeier's with the poles already squared.
//! Wavelengths: nanometres at the door, micrometres inside the formulas. Indices have no unit.

mod air;
mod rational;

pub use air::{air_index, air_wavelength, vacuum_wavelength};
pub use rational::RationalTerm;

/// Wavelengths of the spectral lines at which glass is measured, in air, in nanometres (ISO 7944 and the Schott data sheets).
pub mod fraunhofer {
    /// D: the middle of the two yellow lines of sodium; the line of the classical index n_D.
    pub const SODIUM_D: f64 = 589.3;
    /// d: yellow helium, the line of the catalogue index n_d.
    pub const HELIUM_D: f64 = 587.5618;
    /// F: blue hydrogen.
    pub const HYDROGEN_F: f64 = 486.1327;
    /// C: red hydrogen.
    pub const HYDROGEN_C: f64 = 656.2725;
    /// g: blue mercury.
    pub const MERCURY_G: f64 = 435.8343;
    /// e: green mercury.
    pub const MERCURY_E: f64 = 546.0740;
    /// All lines of the data sheets from violet to infrared: name, wavelength in air in nanometres, and where the light is
    /// from.
    pub const LINES: [(&str, f64, &str); 14] = [
        ("i", 365.0146, "ultraviolet mercury"),
        ("h", 404.6561, "violet mercury"),
        ("g", MERCURY_G, "blue mercury"),
        ("F'", 479.9914, "blue cadmium"),
        ("F", HYDROGEN_F, "blue hydrogen"),
        ("e", MERCURY_E, "green mercury"),
        ("d", HELIUM_D, "yellow helium"),
        ("D", SODIUM_D, "yellow sodium, the middle of two"),
        ("C'", 643.8469, "red cadmium"),
        ("C", HYDROGEN_C, "red hydrogen"),
        ("r", 706.5188, "red helium"),
        ("A'", 768.2, "red potassium"),
        ("s", 852.11, "infrared caesium"),
        ("t", 1013.98, "infrared mercury"),
    ];
}

/// The smallest index that [`Dispersion::index`] gives.
pub const MIN_INDEX: f64 = 1e-3;
/// The largest index that [`Dispersion::index`] gives.
pub const MAX_INDEX: f64 = 1e3;

/// The wavelengths, in nanometres, that formulas are evaluated at: from the far ultraviolet to one millimetre. Beyond,
/// an index is the one of the nearer end.
const WAVELENGTHS_NM: [f64; 2] = [100.0, 1e6];
/// How near, relative to λ², a Sellmeier formula may come to a pole.
const POLE_MARGIN: f64 = 1e-3;

/// An index of refraction, constant or by a dispersion formula. Wavelengths are vacuum wavelengths in micrometres
/// inside the formulas and nanometres at the door.
///
/// ```
/// use snell_math::Dispersion;
/// use snell_math::dispersion::fraunhofer;
/// let bk7 = Dispersion::Sellmeier {
///     constant: 0.0,
///     terms: vec![(1.03961212, 0.00600069867), (0.231792344, 0.0200179144), (1.01046945, 103.560653)],
/// };
/// assert!((bk7.index(fraunhofer::HELIUM_D) - 1.5168).abs() < 1e-6);
/// assert!((bk7.abbe_number().unwrap() - 64.17).abs() < 0.01);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Dispersion {
    /// The same index for every wavelength.
    Constant(f64),
    /// Cauchy: n = Σ cᵢ / λ²ⁱ, λ in micrometres.
    Cauchy(Vec<f64>),
    /// Sellmeier: n² = 1 + c₀ + Σ bᵢ λ² / (λ² − cᵢ), λ and √cᵢ in micrometres.
    Sellmeier {
        /// The constant c₀, most often 0.
        constant: f64,
        /// Pairs (bᵢ, cᵢ), cᵢ in square micrometres.
        terms: Vec<(f64, f64)>,
    },
    /// A sum of terms which is n², or n itself.
    Rational {
        /// The sum is the square of the index.
        is_squared: bool,
        /// The terms, λ in micrometres.
        terms: Vec<RationalTerm>,
    },
    /// Measured: pairs (λ, n) of ascending wavelengths in nanometres, joined by straight lines. Beyond the ends, the ends' indices.
    Table(Vec<(f64, f64)>),
}

impl Dispersion {
    /// Cauchy's formula with two terms that has the given index at the d line and the given Abbe number V_d: what a
    /// glass code such as 517642 says. An Abbe number that is not positive and finite gives a constant index.
    ///
    /// ```
    /// let crown = snell_math::Dispersion::from_abbe_number(1.5168, 64.17);
    /// assert!((crown.abbe_number().unwrap() - 64.17).abs() < 1e-9);
    /// ```
    pub fn from_abbe_number(index_d: f64, abbe_number: f64) -> Self {
        if !(abbe_number > 0.0 && abbe_number.is_finite()) {
            return Self::Constant(index_d);
        }
        let inverse_square = |nanometres: f64| 1e6 / (nanometres * nanometres);
        let principal_dispersion = (index_d - 1.0) / abbe_number;
        let slope =
            principal_dispersion / (inverse_square(fraunhofer::HYDROGEN_F) - inverse_square(fraunhofer::HYDROGEN_C));
        Self::Cauchy(vec![index_d - slope * inverse_square(fraunhofer::HELIUM_D), slope])
    }

    /// The index of refraction at a vacuum wavelength in nanometres.
    ///
    /// Always a number in [[`MIN_INDEX`], [`MAX_INDEX`]], whatever the formula and the wavelength: a wavelength at or
    /// beyond the resonance (pole) of a Sellmeier formula that is nearest to the d line counts as one just before it,
    /// and a formula that gives no real index gives the smallest.
    #[inline]
    pub fn index(&self, wavelength_nm: f64) -> f64 {
        let micrometres = wavelength_nm.clamp(WAVELENGTHS_NM[0], WAVELENGTHS_NM[1]) * 1e-3;
        let squared = micrometres * micrometres;
        let index = match self {
            Self::Constant(index) => *index,
            Self::Cauchy(coefficients) => coefficients.iter().rev().fold(0.0, |sum, c| sum / squared + c),
            Self::Sellmeier { constant, terms } => sellmeier_squared(*constant, terms, squared).max(0.0).sqrt(),
            Self::Rational { is_squared: true, terms } => rational::sum(terms, squared).max(0.0).sqrt(),
            Self::Rational { is_squared: false, terms } => rational::sum(terms, squared),
            Self::Table(rows) => table_index(rows, wavelength_nm),
        };
        if index.is_nan() { MIN_INDEX } else { index.clamp(MIN_INDEX, MAX_INDEX) }
    }

    /// True where the index depends on the wavelength, so that white light splits.
    pub fn is_dispersive(&self) -> bool {
        match self {
            Self::Constant(_) => false,
            Self::Cauchy(coefficients) => coefficients.iter().skip(1).any(|c| *c != 0.0),
            Self::Sellmeier { terms, .. } => terms.iter().any(|(b, c)| *b != 0.0 && *c != 0.0),
            Self::Rational { terms, .. } => terms.iter().any(RationalTerm::is_dispersive),
            Self::Table(rows) => rows.iter().any(|(_, index)| *index != rows[0].1),
        }
    }

    /// The Abbe number V_d = (n_d − 1) / (n_F − n_C): small where colours spread much. `None` where the index is the
    /// same at the F and the C line.
    pub fn abbe_number(&self) -> Option<f64> {
        let principal_dispersion = self.index(fraunhofer::HYDROGEN_F) - self.index(fraunhofer::HYDROGEN_C);
        (self.is_dispersive() && principal_dispersion != 0.0)
            .then(|| (self.index(fraunhofer::HELIUM_D) - 1.0) / principal_dispersion)
    }
}

/// Sellmeier's n² at a squared wavelength in square micrometres, which is first brought between the two poles that
/// enclose the d line.
#[inline]
fn sellmeier_squared(constant: f64, terms: &[(f64, f64)], squared: f64) -> f64 {
    let poles = terms.iter().filter(|(strength, _)| *strength != 0.0).map(|(_, pole)| *pole);
    let squared = rational::between_poles(squared, poles);
    let sum: f64 = terms.iter().filter(|(b, _)| *b != 0.0).map(|(b, c)| b * squared / (squared - c)).sum();
    1.0 + constant + sum
}

/// The index between the rows of a table; NaN where there are none.
fn table_index(rows: &[(f64, f64)], wavelength_nm: f64) -> f64 {
    let after = rows.partition_point(|(nm, _)| *nm <= wavelength_nm);
    match (after.checked_sub(1).and_then(|before| rows.get(before)), rows.get(after)) {
        (Some((low, first)), Some((high, second))) => {
            let fraction = (wavelength_nm - low) / (high - low);
            first * (1.0 - fraction) + second * fraction
        }
        (Some((_, index)), None) | (None, Some((_, index))) => *index,
        (None, None) => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// One glass of the reference table: coefficients as refractiveindex.info lists them, by formula 1 or 2.
    fn from_row(formula: &str, coefficients: &str) -> Option<Dispersion> {
        let numbers: Vec<f64> = coefficients.split_whitespace().map(|n| n.parse().unwrap()).collect();
        let square = match formula {
            "ri.info formula 1" => |c: f64| c * c,
            "ri.info formula 2" => |c: f64| c,
            _ => return None,
        };
        let terms = numbers[1..].chunks_exact(2).map(|pair| (pair[0], square(pair[1]))).collect();
        Some(Dispersion::Sellmeier { constant: numbers[0], terms })
    }

    /// How far the formula is from a row's indices at the lines g, F, e, d, C, and from its Abbe number.
    fn deviation(dispersion: &Dispersion, row: &[&str]) -> (f64, f64) {
        use fraunhofer::{HELIUM_D, HYDROGEN_C, HYDROGEN_F, MERCURY_E, MERCURY_G};
        let index = [MERCURY_G, HYDROGEN_F, MERCURY_E, HELIUM_D, HYDROGEN_C]
            .iter()
            .zip(&row[4..9])
            .map(|(line, expected)| (dispersion.index(*line) - expected.parse::<f64>().unwrap()).abs())
            .fold(0.0, f64::max);
        let abbe = (dispersion.abbe_number().unwrap() - row[9].parse::<f64>().unwrap()).abs();
        (index, abbe)
    }

    #[test]
    fn indices_and_abbe_numbers_agree_with_the_reference_table() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/reference/materials_dispersion.csv");
        let Ok(table) = std::fs::read_to_string(path) else {
            println!("skipped: {path} is absent");
            return;
        };
        let mut checked = 0;
        for row in table.lines().skip(2).map(|line| line.split(',').collect::<Vec<_>>()) {
            let Some(dispersion) = from_row(row[1], row[2]) else { continue };
            let (index, abbe) = deviation(&dispersion, &row);
            assert!(index < 1e-9 && abbe < 1e-7, "{}: off by {index:e}, Abbe number by {abbe:e}", row[0]);
            // The twin: poles not squared, or squared twice, must be seen.
            let other = if row[1].ends_with('1') { "ri.info formula 2" } else { "ri.info formula 1" };
            assert!(deviation(&from_row(other, row[2]).unwrap(), &row).0 > 1e-3, "{}", row[0]);
            checked += 1;
        }
        assert!(checked >= 20, "only {checked} rows");
    }

    #[test]
    fn cauchy_is_its_polynomial_in_the_inverse_square() {
        let cauchy = Dispersion::Cauchy(vec![1.5, 0.004, 0.0001]);
        assert_eq!(cauchy.index(500.0), (0.0001 / 0.25 + 0.004) / 0.25 + 1.5);
        assert_eq!(cauchy.index(1000.0), 0.0001 + 0.004 + 1.5);
        assert!(cauchy.is_dispersive() && !Dispersion::Cauchy(vec![1.5, 0.0]).is_dispersive());
        assert_eq!(Dispersion::Cauchy(vec![1.5]).abbe_number(), None);
    }

    #[test]
    fn a_constant_is_constant() {
        let water = Dispersion::Constant(1.333);
        assert!([0.0, 400.0, 700.0, f64::INFINITY].iter().all(|nm| water.index(*nm) == 1.333));
        assert!(!water.is_dispersive());
        assert_eq!(water.abbe_number(), None);
        assert_eq!(Dispersion::from_abbe_number(1.5, 0.0), Dispersion::Constant(1.5));
    }

    #[test]
    fn beyond_a_resonance_the_index_stays_that_beside_it() {
        // One pole in the ultraviolet at 300 nm and one in the infrared at 2000 nm.
        let glass = Dispersion::Sellmeier { constant: 0.0, terms: vec![(1.2, 0.09), (0.5, 4.0)] };
        assert_eq!(glass.index(300.0), glass.index(200.0));
        assert_eq!(glass.index(2000.0), glass.index(9000.0));
        assert!(glass.index(301.0) > glass.index(350.0), "normal dispersion up to the pole");
        assert_eq!(glass.index(2000.0), MIN_INDEX, "n² is negative beside the infrared pole");
    }

    #[test]
    fn rational_terms_are_the_other_formulas_written_out() {
        let (b, c) = (1.1, 0.012);
        let sellmeier = Dispersion::Sellmeier { constant: 0.2, terms: vec![(b, c)] };
        let terms = vec![RationalTerm::power(1.2, 0.0), RationalTerm::resonance(b, 2.0, c)];
        let rational = Dispersion::Rational { is_squared: true, terms };
        let cauchy = Dispersion::Cauchy(vec![1.5, 0.004]);
        let terms = vec![RationalTerm::power(1.5, 0.0), RationalTerm::power(0.004, -2.0)];
        let powers = Dispersion::Rational { is_squared: false, terms };
        for nm in [110.0, 300.0, 550.0, 900.0, 5000.0] {
            assert!((sellmeier.index(nm) - rational.index(nm)).abs() < 1e-14, "{nm}");
            assert!((cauchy.index(nm) - powers.index(nm)).abs() < 1e-14, "{nm}");
        }
        assert!(rational.is_dispersive() && powers.is_dispersive());
        let terms = vec![RationalTerm::power(2.25, 0.0)];
        assert!(!Dispersion::Rational { is_squared: true, terms }.is_dispersive());
        // Schott's old formula with the old data sheet's coefficients of BK7 (Schott, 1992).
        let powers = [0.0, 2.0, -2.0, -4.0, -6.0, -8.0];
        let a = [2.271_892_9, -1.010_807_7e-2, 1.059_250_9e-2, 2.081_696_5e-4, -7.647_253_8e-6, 4.924_099_1e-7];
        let terms = a.into_iter().zip(powers).map(|(a, p)| RationalTerm::power(a, p)).collect();
        let bk7 = Dispersion::Rational { is_squared: true, terms };
        assert!((bk7.index(fraunhofer::HELIUM_D) - 1.5168).abs() < 2e-5);
    }

    #[test]
    fn tables_are_joined_by_lines() {
        let table = Dispersion::Table(vec![(400.0, 1.6), (500.0, 1.5), (700.0, 1.4)]);
        let near = |nm, index: f64| (table.index(nm) - index).abs() < 1e-15;
        assert!(near(300.0, 1.6) && near(400.0, 1.6) && near(450.0, 1.55) && near(600.0, 1.45) && near(900.0, 1.4));
        assert!(table.is_dispersive() && table.abbe_number().is_some());
        assert!(!Dispersion::Table(vec![(1.0, 1.5), (2.0, 1.5)]).is_dispersive());
        assert_eq!(Dispersion::Table(Vec::new()).index(500.0), MIN_INDEX);
        assert!(!Dispersion::Table(Vec::new()).is_dispersive());
    }

    fn any_number() -> impl Strategy<Value = f64> {
        prop_oneof![proptest::num::f64::ANY, -2.0..2.0f64, 0.0..1.0f64, Just(0.345_228_868_816_912_4)]
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn any_formula_at_any_wavelength_gives_a_usable_index(
            constant in any_number(),
            terms in prop::collection::vec((any_number(), any_number()), 0..5),
            coefficients in prop::collection::vec(any_number(), 0..5),
            wavelength_nm in prop_oneof![any_number(), 1.0..2000.0f64],
        ) {
            let rational =
                terms.iter().zip(0..).map(|((b, c), order)| RationalTerm { coefficient: *b, power: *c, pole: *c, order });
            let rational = rational.collect();
            let formulas = [
                Dispersion::Constant(constant),
                Dispersion::Cauchy(coefficients),
                Dispersion::Rational { is_squared: constant > 0.0, terms: rational },
                Dispersion::Table(terms.iter().map(|(b, c)| (*c, *b)).collect()),
                Dispersion::Sellmeier { constant, terms },
            ];
            for dispersion in formulas {
                for wavelength_nm in [wavelength_nm, fraunhofer::HELIUM_D] {
                    let index = dispersion.index(wavelength_nm);
                    prop_assert!((MIN_INDEX..=MAX_INDEX).contains(&index), "{dispersion:?} gives {index}");
                }
            }
        }

        #[test]
        fn index_and_abbe_number_come_back(index_d in 1.3..2.5f64, abbe in 15.0..100.0f64) {
            let dispersion = Dispersion::from_abbe_number(index_d, abbe);
            prop_assert!((dispersion.index(fraunhofer::HELIUM_D) - index_d).abs() < 1e-14);
            prop_assert!((dispersion.abbe_number().unwrap() / abbe - 1.0).abs() < 1e-11);
        }
    }
}

//! Formulas of one variable, such as `2*cos(x) - pi/2`: compiled once, evaluated often, with the same bits everywhere.
//!
//! The grammar is that of printed mathematics: `^` binds tightest and to the right, so that `-x^2` is −(x²) and `2^3^2` is 2⁹; then
//! signs, then `*` and `/`, then `+` and `-`. Angles are in radians.

mod parse;

use std::ops::Range;

use snell_math::portable;

/// A formula, compiled: numbers and operations in the order in which a pocket calculator with a stack would do them.
///
/// ```
/// use snell_scene::scene::Expression;
/// let wave = Expression::parse("1 + cos(2*x)", Some("x"))?;
/// assert_eq!(wave.evaluate(0.0), 2.0);
/// let mistake = Expression::parse("coss(x)", Some("x")).unwrap_err();
/// assert_eq!(mistake.message, "there is no function `coss`");
/// assert_eq!(mistake.help.as_deref(), Some("did you mean `cos`?"));
/// # Ok::<(), snell_scene::scene::ExpressionError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Expression {
    text: String,
    variable: Option<String>,
    /// Never needs more than [`STACK`] places and always leaves one number: the parser sees to it.
    program: Vec<Step>,
}

/// What is wrong with a formula.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ExpressionError {
    /// What, in one line without a full stop.
    pub message: String,
    /// Where in the formula, bytes; may be empty at its end.
    pub range: Range<usize>,
    /// A few words to stand under that place.
    pub label: String,
    /// What to do.
    pub help: Option<String>,
}

/// How many intermediate results a formula may have at a time.
const STACK: usize = 64;

/// The same text of the same variable is the same formula.
impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        (&self.text, &self.variable) == (&other.text, &other.variable)
    }
}

#[derive(Clone, Copy, Debug)]
enum Step {
    Number(f64),
    Variable,
    Negate,
    /// Of the last number.
    Function(OfOne),
    /// Of the last two numbers.
    Operation(OfTwo),
}

type OfOne = fn(f64) -> f64;
type OfTwo = fn(f64, f64) -> f64;

/// The functions of one number, by name.
const FUNCTIONS: [(&str, OfOne); 20] = [
    ("sin", portable::sin),
    ("cos", portable::cos),
    ("tan", portable::tan),
    ("asin", portable::asin),
    ("acos", portable::acos),
    ("atan", portable::atan),
    ("sinh", |x| 0.5 * (portable::exp(x) - portable::exp(-x))),
    ("cosh", |x| 0.5 * (portable::exp(x) + portable::exp(-x))),
    ("tanh", |x| if x.abs() > 20.0 { x.signum() } else { 1.0 - 2.0 / (portable::exp(2.0 * x) + 1.0) }),
    ("exp", portable::exp),
    ("ln", portable::ln),
    ("log2", portable::log2),
    ("log10", |x| portable::ln(x) / std::f64::consts::LN_10),
    ("sqrt", f64::sqrt),
    ("cbrt", portable::cbrt),
    ("abs", f64::abs),
    ("sign", |x| if x == 0.0 { 0.0 } else { x.signum() }),
    ("floor", f64::floor),
    ("ceil", f64::ceil),
    ("round", f64::round),
];

/// The functions of two numbers, by name.
const FUNCTIONS_OF_TWO: [(&str, OfTwo); 4] = [
    ("min", f64::min),
    ("max", f64::max),
    ("atan2", portable::atan2),
    // What is left of x after whole multiples of y, with the sign of y.
    ("mod", |x, y| x - y * (x / y).floor()),
];

/// The numbers that have names.
const CONSTANTS: [(&str, f64); 4] = [
    ("pi", std::f64::consts::PI),
    ("π", std::f64::consts::PI),
    ("tau", std::f64::consts::TAU),
    ("e", std::f64::consts::E),
];

impl Expression {
    /// Reads a formula of one variable, or of none. It may have 1000 bytes, and parentheses 50 deep.
    ///
    /// # Errors
    /// [`ExpressionError`] where it is none: what is wrong, where, and what was probably meant.
    pub fn parse(text: &str, variable: Option<&str>) -> Result<Self, ExpressionError> {
        let program = parse::program(text, variable)?;
        Ok(Self { text: text.to_owned(), variable: variable.map(str::to_owned), program })
    }

    /// The names of all functions that formulas know.
    pub fn function_names() -> impl Iterator<Item = &'static str> {
        FUNCTIONS.iter().map(|(name, _)| *name).chain(FUNCTIONS_OF_TWO.iter().map(|(name, _)| *name))
    }

    /// The formula as it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Its value where the variable has this one; NaN or infinite where it has none, as 1/x at 0.
    pub fn evaluate(&self, variable: f64) -> f64 {
        let mut stack = [0.0_f64; STACK];
        let mut height = 0;
        for step in &self.program {
            match step {
                Step::Number(_) | Step::Variable => {
                    stack[height] = if let Step::Number(number) = step { *number } else { variable };
                    height += 1;
                }
                Step::Negate => stack[height - 1] = -stack[height - 1],
                Step::Function(function) => stack[height - 1] = function(stack[height - 1]),
                Step::Operation(operation) => {
                    height -= 1;
                    stack[height - 1] = operation(stack[height - 1], stack[height]);
                }
            }
        }
        stack[0]
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn at(text: &str, x: f64) -> f64 {
        Expression::parse(text, Some("x")).unwrap().evaluate(x)
    }

    #[test]
    fn formulas_mean_what_mathematics_means() {
        let cases = [
            ("-x^2", -9.0),
            ("2^3^2", 512.0),
            ("2^-x", 0.125),
            ("1 - 2 - 3", -4.0),
            ("12/2/3*2", 4.0),
            ("2*-x", -6.0),
            ("--x", 3.0),
            ("1e-3*x", 0.003),
            (".5*x", 1.5),
            ("min(x, 2) + max(x, 4)", 6.0),
            ("mod(-1, x)", 2.0),
            ("sqrt(x*x + 16)", 5.0),
            ("abs(-x) + sign(-x) + floor(2.5) + ceil(2.5) + round(2.4)", 9.0),
            ("2·x − 4×1", 2.0),
            ("cos(π) + cos(pi)", -2.0),
            ("log2(8) + ln(e) - atan2(0, 1)", 4.0),
            ("((((x))))", 3.0),
        ];
        for (text, value) in cases {
            assert_eq!(at(text, 3.0), value, "{text}");
        }
        assert!((at("tanh(0.3) - sinh(0.3)/cosh(0.3)", 0.0)).abs() < 1e-15);
        assert!(at("1/x", 0.0).is_infinite() && at("ln(x)", -1.0).is_nan());
        assert_eq!(at("sin(x)", 1.25).to_bits(), portable::sin(1.25).to_bits());
    }

    #[test]
    fn long_and_deep_formulas_are_refused() {
        let nested = |n: usize| format!("{}x{}", "(".repeat(n), ")".repeat(n));
        assert_eq!(at(&nested(40), 2.0), 2.0);
        let right = |n: usize| format!("{}x{}", "1+(".repeat(n), ")".repeat(n));
        assert_eq!(at(&right(40), 2.0), 42.0);
        for text in
            [nested(60), nested(490), right(100), "-".repeat(900) + "x", "2^".repeat(400) + "x", "(".repeat(900)]
        {
            let error = Expression::parse(&text, Some("x")).unwrap_err();
            assert!(error.message.contains("deep"), "{}", error.message);
        }
        let error = Expression::parse(&"x+".repeat(1_000_000), Some("x")).unwrap_err();
        assert!(error.message.contains("2000000 bytes"), "{}", error.message);
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, cases: 2000, ..ProptestConfig::default() })]
        #[test]
        fn any_text_is_read_or_refused_at_a_place_of_it(
            words in prop::collection::vec(prop::sample::select(vec![
                "x", "1", "2.5", "1e", "e", "pi", "+", "-", "*", "/", "^", "(", ")", ",", "sin", "sin(", "min(", "é", "π", " ", ".", "y",
            ]), 0..12),
            value in -10.0..10.0f64,
        ) {
            let text = words.concat();
            match Expression::parse(&text, Some("x")) {
                Ok(expression) => {
                    expression.evaluate(value);
                }
                Err(error) => prop_assert!(text.get(error.range.clone()).is_some(), "{error:?} of {text:?}"),
            }
        }
    }
}

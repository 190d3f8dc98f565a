//! Tests that take minutes: they run only where they are asked for, by `cargo xtask test --long`.

/// The environment variable that `cargo xtask test --long` sets.
const LONG_TESTS: &str = "SNELL_LONG_TESTS";

/// True where tests of minutes are wanted. Where they are not, says on standard error what is left out.
///
/// ```
/// use snell_testkit::long_tests;
/// if long_tests("every picture in full size") {
///     // ...
/// }
/// ```
#[must_use]
pub fn long_tests(what: &str) -> bool {
    let wanted = std::env::var_os(LONG_TESTS).is_some_and(|value| value == "1");
    if !wanted {
        eprintln!("skipped: {what}; `cargo xtask test --long` runs it");
    }
    wanted
}

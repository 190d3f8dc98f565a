//! `cargo xtask test`: all tests and documentation examples of the workspace, with plain `cargo test`.
//!
//! Its last line is `N passed, N failed`, added up from the runs' own output. A test program that dies before it has
//! reported (a crash, an `abort`) counts every test it still owed as failed, and a run without any test is a failure.

use std::io::{BufRead, BufReader};
use std::process::Stdio;
use std::time::UNIX_EPOCH;

use crate::Outcome;
use crate::arguments::Arguments;
use crate::process;

/// The environment variable through which `snell_testkit` learns that tests of minutes are wanted.
const LONG_TESTS: &str = "SNELL_LONG_TESTS";

/// The environment variable by which property tests draw their cases. `.cargo/config.toml` sets it, so that runs are the same.
const SEED: &str = "PROPTEST_RNG_SEED";

/// Runs the command line `cargo xtask test ...`.
pub fn run(mut arguments: Arguments) -> Outcome {
    let options = Options {
        long: arguments.flag("--long"),
        all_output: arguments.flag("--all-output"),
        filter: arguments.at_most_one_name()?,
    };
    // The closing line comes last whatever happens, so that people and programs find it there.
    let (tally, outcome) = all(&options)?;
    if let Err(reason) = &outcome {
        println!("\n{reason}");
    }
    println!("\n{tally}");
    outcome.map_err(|_| String::new())
}

/// Which tests run and how much of their output is shown.
#[derive(Debug, Default)]
pub struct Options {
    /// Also the tests that take minutes.
    pub long: bool,
    /// Every line of the test programs, not only what is worth a look.
    pub all_output: bool,
    /// Only tests whose name contains this.
    pub filter: Option<String>,
}

/// Runs the tests; the tally, and why the run as a whole counts as failed where it does. An outer error means that
/// cargo could not be started at all.
pub fn all(options: &Options) -> Result<(Tally, Outcome), String> {
    let mut command = process::cargo();
    // One failing test program must not hide the others' results.
    command.args(["test", "--workspace", "--no-fail-fast"]);
    command.args(&options.filter).stdin(Stdio::null()).stdout(Stdio::piped());
    if options.long {
        command.env(LONG_TESTS, "1");
        let seed = UNIX_EPOCH.elapsed().map_or(0, |time| time.as_secs());
        println!("Property tests draw new cases; the same again by `{SEED}={seed} cargo test NAME`.");
        command.env(SEED, seed.to_string());
    }
    let mut child = command.spawn().map_err(|error| format!("cannot start cargo: {error}"))?;
    let mut tally = Tally::default();
    if let Some(stdout) = child.stdout.take() {
        for line in BufReader::new(stdout).split(b'\n') {
            let line = line.map_err(|error| format!("cannot read the output of cargo test: {error}"))?;
            let line = String::from_utf8_lossy(&line);
            let worth_a_look = tally.read(line.trim_end());
            if worth_a_look || options.all_output {
                println!("{}", line.trim_end());
            }
        }
    }
    let status = child.wait().map_err(|error| format!("cannot wait for cargo: {error}"))?;
    tally.close();
    let outcome = verdict(&tally, status.success(), options.filter.as_deref());
    Ok((tally, outcome))
}

/// Whether a run with this tally and this word from cargo is a success.
fn verdict(tally: &Tally, cargo_succeeded: bool, filter: Option<&str>) -> Outcome {
    if tally.failed > 0 {
        return Err("some tests failed; they are listed above".to_owned());
    }
    if !cargo_succeeded {
        return Err("cargo test failed although no test did: see above for what did not build or start".to_owned());
    }
    match filter {
        _ if tally.passed > 0 => Ok(()),
        Some(filter) => Err(format!("no test has a name that contains `{filter}`")),
        None => Err("no test was run".to_owned()),
    }
}

/// What the test programs reported so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Tests that passed.
    pub passed: usize,
    /// Tests that failed, or whose program ended before it said.
    pub failed: usize,
    /// Tests that are marked as ignored.
    pub skipped: usize,
    /// Tests that the program now running has announced and not yet accounted for.
    owed: usize,
    /// Inside the part of a program's output that tells of its failures, where every line is shown.
    in_failures: bool,
}

impl Tally {
    /// Takes in one line of a test program's output; whether a person wants to see it when all goes well.
    fn read(&mut self, line: &str) -> bool {
        if let Some(announced) = counted(line, "running ", " test") {
            self.close();
            self.owed = announced;
            return false;
        }
        if let Some(counts) = line.strip_prefix("test result: ") {
            let count = |name| counts.split(['.', ';']).find_map(|part| counted(part.trim(), "", name)).unwrap_or(0);
            let (passed, failed, skipped) = (count(" passed"), count(" failed"), count(" ignored"));
            self.passed += passed;
            self.failed += failed;
            self.skipped += skipped;
            self.owed = 0;
            self.in_failures = false;
            return passed + failed + skipped > 0;
        }
        self.in_failures |= line == "failures:";
        let is_routine = line.is_empty()
            || line.starts_with("all doctests ran in")
            || line.starts_with("test ") && [" ... ok", " ... ignored"].iter().any(|end| line.contains(end));
        self.in_failures || !is_routine
    }

    /// The program now running has ended: what it owes will not come.
    fn close(&mut self) {
        self.failed += std::mem::take(&mut self.owed);
        self.in_failures = false;
    }
}

/// The number in `BEFORE n AFTER...`.
fn counted(line: &str, before: &str, after: &str) -> Option<usize> {
    let rest = line.strip_prefix(before)?;
    let end = rest.find(|c: char| !c.is_ascii_digit())?;
    rest[end..].starts_with(after).then(|| rest[..end].parse().ok())?
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} passed, {} failed", self.passed, self.failed)?;
        if self.skipped > 0 { write!(f, ", {} skipped", self.skipped) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tally(output: &str) -> (Tally, String) {
        let mut tally = Tally::default();
        let shown: Vec<&str> = output.lines().filter(|line| tally.read(line)).collect();
        tally.close();
        (tally, shown.join("\n"))
    }

    const GOOD: &str = "
running 3 tests
test a ... ok
test b - should panic ... ok
test c ... ignored, takes an hour

test result: ok. 2 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.01s
";
    const BAD: &str = "
running 2 tests
test d ... ok
test e ... FAILED

failures:

---- e stdout ----
what e said
running 7 of 8

failures:
    e

test result: FAILED. 1 passed; 1 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.00s
";
    const EMPTY: &str = "
running 0 tests

test result: ok. 0 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.00s
";

    #[test]
    fn programs_add_up_and_only_the_interesting_lines_are_shown() {
        let (total, shown) = tally(&[GOOD, BAD, EMPTY].concat());
        assert_eq!(total.to_string(), "3 passed, 1 failed, 1 skipped");
        assert!(shown.contains("what e said") && shown.contains("test e ... FAILED"), "{shown}");
        assert!(!shown.contains("test a") && !shown.contains("0 passed; 0 failed"), "{shown}");
        assert!(verdict(&total, false, None).is_err());
    }

    #[test]
    fn a_program_that_dies_fails_the_tests_it_owed() {
        let (total, _) = tally(&["running 5 tests\ntest a ... ok\n", GOOD].concat());
        assert_eq!(total.to_string(), "2 passed, 5 failed, 1 skipped");
        let (total, _) = tally("running 1 test\n");
        assert_eq!(total.to_string(), "0 passed, 1 failed");
    }

    #[test]
    fn a_run_that_proves_nothing_is_a_failure() {
        let (good, _) = tally(GOOD);
        let (empty, _) = tally(EMPTY);
        assert_eq!(verdict(&good, true, None), Ok(()));
        assert!(verdict(&good, false, None).is_err());
        assert!(verdict(&empty, true, None).is_err());
        assert!(verdict(&empty, true, Some("typo")).expect_err("no test").contains("typo"));
    }
}

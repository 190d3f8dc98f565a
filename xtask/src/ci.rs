//! `cargo xtask ci`: everything that must pass before a change lands, the same here and on the server.
//!
//! The steps run in order, are named and timed, and the first that fails ends the run.

use std::time::{Duration, Instant};

use crate::arguments::Arguments;
use crate::process::{cargo, root, run as finish};
use crate::{Outcome, test, tidy};

/// A step's name, and the step; what it returns is a note for the table at the end.
type Step = (&'static str, fn() -> Result<String, String>);

const STEPS: &[Step] = &[
    ("tidy", || tidy::check_and_print(&root())),
    ("fmt", || quietly(finish(cargo().args(["fmt", "--all", "--check"])))),
    ("clippy", || {
        quietly(finish(cargo().args(["clippy", "--workspace", "--all-targets", "--", "--deny", "warnings"])))
    }),
    ("test", tests),
    ("doc", || {
        quietly(finish(cargo().args(["doc", "--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "--deny warnings")))
    }),
];

/// Runs the command line `cargo xtask ci`.
pub fn run(arguments: Arguments) -> Outcome {
    arguments.nothing()?;
    let mut table = String::new();
    for (name, step) in STEPS {
        println!("\n== {name}");
        let start = Instant::now();
        match step() {
            Ok(note) => table += &row(name, start.elapsed(), &note),
            Err(reason) => {
                println!("\n{table}{}", row(name, start.elapsed(), "FAILED"));
                return Err(format!("{name}: {reason}"));
            }
        }
    }
    println!("\n{table}all {} steps passed", STEPS.len());
    Ok(())
}

fn row(name: &str, time: Duration, note: &str) -> String {
    format!("{name:<8} {:>7.1} s  {note}\n", time.as_secs_f64())
}

fn quietly(outcome: Outcome) -> Result<String, String> {
    outcome.map(|()| "ok".to_owned())
}

fn tests() -> Result<String, String> {
    let (tally, outcome) = test::all(&test::Options::default())?;
    println!("\n{tally}");
    outcome.map(|()| tally.to_string())
}

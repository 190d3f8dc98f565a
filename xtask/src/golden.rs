//! `cargo xtask golden`: renders the scenes that have reference pictures and compares them; with `--bless`, the new
//! pictures become the references. The comparing itself is a test of the `snell` crate, see `snell_testkit`.

use crate::Outcome;
use crate::arguments::Arguments;
use crate::process;

/// The environment variable that tells the golden test to write references instead of comparing with them.
const BLESS: &str = "SNELL_BLESS";

/// Runs the command line `cargo xtask golden ...`.
pub fn run(mut arguments: Arguments) -> Outcome {
    let bless = arguments.flag("--bless");
    let filter = arguments.at_most_one_name()?;
    let mut command = process::cargo();
    command
        .args(["test", "--package", "snell", "--test", "golden", "--test", "golden_drawing", "--no-fail-fast"])
        .args(&filter);
    if bless {
        command.env(BLESS, "1");
    }
    let outcome = process::run(&mut command);
    let report = process::target().join("golden-report").join("index.html");
    if report.is_file() {
        println!("expected, actual and difference side by side: {}", report.display());
    }
    match outcome {
        Ok(()) if bless => {
            println!("blessed; look at every picture in `git diff --stat goldens` before you commit it");
            Ok(())
        }
        Ok(()) => Ok(()),
        Err(_) if bless => Err("the references could not all be written, see above".to_owned()),
        Err(_) => Err("a picture differs from its reference, or could not be rendered; look at the report, and \
                       accept a wanted change with `cargo xtask golden --bless`"
            .to_owned()),
    }
}

//! `cargo xtask`: the project's own chores, one file each. Plain Rust, so that a newcomer needs nothing else.
//!
//! A chore is a function from its arguments to `Ok` or the reason why it failed; [`COMMANDS`] lists them all.

mod arguments;
mod bench;
mod catalogue;
mod ci;
mod fuzz;
mod gallery;
mod golden;
mod process;
mod test;
mod tidy;

use std::process::ExitCode;

use arguments::Arguments;

/// What a chore returns; the error is the sentence that is printed after `error:`, empty where all is said already.
type Outcome = Result<(), String>;

/// One chore: how it is called, what it does, and the function that does it.
struct Command {
    name: &'static str,
    /// What may follow the name.
    usage: &'static str,
    /// One line for the list of commands.
    summary: &'static str,
    run: fn(Arguments) -> Outcome,
}

const COMMANDS: &[Command] = &[
    Command {
        name: "test",
        usage: "[--long] [--all-output] [FILTER]",
        summary: "run all tests and documentation examples; --long adds those that take minutes, and new cases",
        run: test::run,
    },
    Command {
        name: "ci",
        usage: "",
        summary: "everything that must pass before a change lands: tidy, fmt, clippy, test, doc",
        run: ci::run,
    },
    Command { name: "tidy", usage: "", summary: "check the invariants that a program can check", run: tidy::run },
    Command {
        name: "golden",
        usage: "[--bless] [FILTER]",
        summary: "compare rendered scenes with their reference pictures; --bless accepts the new ones",
        run: golden::run,
    },
    Command {
        name: "gallery",
        usage: "[NAME...]",
        summary: "render the built-in scenes into docs/gallery and write its page",
        run: gallery::run,
    },
    Command {
        name: "bench",
        usage: "[--runs N] [--only TEXT] [--write-docs] [--bless] [BENCHMARK...]",
        summary: "measure pictures, rays and builds against other renderers; an unknown name tells what there is",
        run: bench::run,
    },
    Command {
        name: "fuzz",
        usage: "[--seconds N] [TARGET]",
        summary: "feed the readers broken bytes with cargo-fuzz, 60 seconds per target unless told",
        run: fuzz::run,
    },
    Command {
        name: "catalogue",
        usage: "DATABASE",
        summary: "write the table of measured glasses anew from a checkout of refractiveindex.info-database",
        run: catalogue::run,
    },
];

fn main() -> ExitCode {
    let mut words = std::env::args().skip(1);
    let name = words.next().unwrap_or_else(|| "--help".to_owned());
    if matches!(name.as_str(), "--help" | "-h" | "help") {
        print!("{}", help());
        return ExitCode::SUCCESS;
    }
    let Some(command) = COMMANDS.iter().find(|command| command.name == name) else {
        eprintln!("error: there is no chore named `{name}`\n\n{}", help());
        return ExitCode::from(2);
    };
    let arguments = Arguments::new(words.collect());
    if arguments.asks_for_help() {
        println!("cargo xtask {} {}\n    {}", command.name, command.usage, command.summary);
        return ExitCode::SUCCESS;
    }
    match (command.run)(arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            if !reason.is_empty() {
                eprintln!("error: {reason}");
            }
            ExitCode::FAILURE
        }
    }
}

/// The list of commands, as `cargo xtask --help` prints it.
fn help() -> String {
    let mut text = "The project's own chores.\n\nUsage: cargo xtask COMMAND [ARGUMENTS]\n\n".to_owned();
    for command in COMMANDS {
        text += &format!("  {:<8} {:<33} {}\n", command.name, command.usage, command.summary);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn help_lists_every_command() {
        for command in COMMANDS {
            assert!(help().lines().any(|line| line.trim_start().starts_with(command.name)), "{}", command.name);
        }
    }
}

//! The `snell` command: the only crate that opens files, prints, reads the clock and exits.

mod arguments;
mod assets;
mod bug;
mod builtin;
mod check;
mod console;
mod diagnostics;
mod draw;
mod explain;
mod failure;
mod glass;
mod interrupt;
mod load;
mod map;
mod memory;
mod output;
mod paths;
mod preview;
mod progress;
mod render;
mod scenes;
mod settings;
mod statistics;
mod view;

use std::process::ExitCode;

use clap::{CommandFactory, Parser};
use clap_mangen::Man;
use snell::scene::{Diagnostic, document};

use crate::arguments::{Arguments, Command};
use crate::console::{quoted, say, write_stdout};
use crate::failure::{FINE, Failure};
use crate::statistics::Stopwatch;

#[global_allocator]
static MEMORY: memory::LargePages = memory::LargePages;

fn main() -> ExitCode {
    let watch = Stopwatch::start();
    bug::install_hook();
    let code = run(Arguments::parse().command, watch).unwrap_or_else(|failure| {
        diagnostics::print(&failure.diagnostics);
        if failure.diagnostics.list.len() > 1 {
            say(diagnostics::summary(&failure.diagnostics));
        }
        failure.code
    });
    ExitCode::from(code)
}

fn run(command: Command, watch: Stopwatch) -> Result<u8, Failure> {
    match command {
        Command::Render(arguments) => return render::run(&arguments, watch),
        Command::Draw(arguments) => return draw::run(&arguments, watch),
        Command::Explain(arguments) => return explain::run(&arguments),
        Command::View(arguments) => return view::run(&arguments),
        Command::Glass(arguments) => return glass::run(&arguments),
        Command::Check(arguments) => return check::run(&arguments),
        Command::Scenes(arguments) => return scenes::run(&arguments),
        Command::Schema => write_stdout(format!("{:#}\n", document::schema()).as_bytes())?,
        Command::Completions { shell } => {
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut Arguments::command(), "snell", &mut text);
            write_stdout(&text)?;
        }
        Command::Man { command } => write_stdout(&manual(command.as_deref())?)?,
    }
    Ok(FINE)
}

/// The manual page of the program or of one of its commands.
fn manual(command: Option<&str>) -> Result<Vec<u8>, Failure> {
    let mut program = Arguments::command();
    program.build();
    let page = match command {
        None => program,
        Some(name) => program.find_subcommand(name).cloned().ok_or_else(|| {
            Failure::usage(
                Diagnostic::error(format!("there is no command {}", quoted(name))).help("see `snell --help`"),
            )
        })?,
    };
    let mut text = Vec::new();
    Man::new(page)
        .render(&mut text)
        .map_err(|error| Failure::input(Diagnostic::error(format!("the manual cannot be written: {error}"))))?;
    Ok(text)
}

//! What ends the command early, with the exit code that says whose turn it is.

use snell::scene::{Diagnostic, Diagnostics};

/// All is well.
pub const FINE: u8 = 0;
/// The scene or a file is wrong.
pub const WRONG_INPUT: u8 = 1;
/// The command line is wrong; what clap refuses ends with the same.
pub const WRONG_USAGE: u8 = 2;

/// Why there is no result.
#[derive(Debug)]
pub struct Failure {
    /// The process's exit code.
    pub code: u8,
    /// What to print; nothing where it was printed already.
    pub diagnostics: Diagnostics,
}

impl Failure {
    /// A file or a name is wrong.
    pub fn input(diagnostic: Diagnostic) -> Self {
        Self { code: WRONG_INPUT, diagnostics: single(diagnostic) }
    }

    /// The options do not go together, or not with this scene.
    pub fn usage(diagnostic: Diagnostic) -> Self {
        Self { code: WRONG_USAGE, diagnostics: single(diagnostic) }
    }

    /// The scene is wrong.
    pub fn scene(diagnostics: Diagnostics) -> Self {
        Self { code: WRONG_INPUT, diagnostics }
    }
}

fn single(diagnostic: Diagnostic) -> Diagnostics {
    let mut diagnostics = Diagnostics::default();
    diagnostics.push(diagnostic);
    diagnostics
}

//! What a user sees where the program itself is wrong: that it is, and what to send to those who can mend it.

use std::panic::{self, PanicHookInfo};
use std::sync::atomic::{AtomicBool, Ordering};

use crate::console::say;

/// Where to send it.
const ISSUES: &str = concat!(env!("CARGO_PKG_REPOSITORY"), "/issues");

/// Replaces the message that a panic prints.
pub fn install_hook() {
    static TOLD: AtomicBool = AtomicBool::new(false);
    panic::set_hook(Box::new(|info| {
        // Several threads may meet the same bug.
        if !TOLD.swap(true, Ordering::Relaxed) {
            say(message(&what(info), std::env::args().collect()));
        }
    }));
}

fn what(info: &PanicHookInfo<'_>) -> String {
    let payload = info.payload();
    let text = payload.downcast_ref::<&str>().copied().or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    let place = info.location().map(|location| format!(" ({}:{})", location.file(), location.line()));
    format!("{}{}", text.unwrap_or("unknown"), place.unwrap_or_default())
}

fn message(what: &str, arguments: Vec<String>) -> String {
    let line: Vec<String> = arguments.iter().map(|argument| argument.escape_debug().to_string()).collect();
    format!(
        "\nThis is a bug in Snell, not a mistake of yours. Please report it, with the scene if you can, at\n{ISSUES}\n\n  \
         what:     {what}\n  version:  snell {} on {} {}\n  command:  {}\n",
        env!("CARGO_PKG_VERSION"),
        std::env::consts::ARCH,
        std::env::consts::OS,
        line.join(" "),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bug_comes_with_all_that_a_report_needs() {
        let text = message("index out of bounds (a.rs:7)", vec!["snell".to_owned(), "render".to_owned()]);
        for part in ["bug in Snell", ISSUES, "out of bounds (a.rs:7)", env!("CARGO_PKG_VERSION"), "snell render"] {
            assert!(text.contains(part), "{text}");
        }
    }
}

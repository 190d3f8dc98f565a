//! Libraries touch nothing outside: only shells open files, print, read the clock or the environment, or exit.

use super::paths::paths;
use super::source::{is_name, line_at};
use super::tree::is_below;
use super::{Report, Tree};

/// The sources of the crates that are libraries.
const LIBRARIES: &[&str] =
    &["crates/snell-math/src", "crates/snell-image/src", "crates/snell-scene/src", "crates/snell/src"];

/// Modules of the standard library that are doors to the outside.
const DOORS: &[&str] = &["fs", "env", "process", "net"];

/// Calls that leave the library by another way, as they stand in code.
const CALLS: &[&str] = &[
    "print!",
    "println!",
    "eprint!",
    "eprintln!",
    "Instant::now",
    "SystemTime::now",
    "process::exit",
    "process::abort",
    "io::stdin",
    "io::stdout",
    "io::stderr",
    "static mut",
];

/// No library opens files, prints, reads the clock or the environment, exits, or keeps a changeable global.
pub fn libraries_touch_nothing_outside(tree: &Tree, report: &mut Report) {
    for (path, source) in tree.rust().filter(|(path, _)| LIBRARIES.iter().any(|library| is_below(path, library))) {
        let code = &source.shipped;
        let mut tell = |offset, what: &str| {
            let message = format!("`{what}` is for shells; a library gets its data and returns its results");
            report.problem("library", path, line_at(code, offset), message);
        };
        for found in paths(code, &["std"]) {
            if let [_, module, ..] = found.segments[..]
                && DOORS.contains(&module)
            {
                tell(found.offset, &found.segments.join("::"));
            }
        }
        for call in CALLS {
            let ends_in_name = call.bytes().last().is_some_and(is_name);
            for (offset, _) in code.match_indices(call) {
                let starts_inside = offset > 0 && is_name(code.as_bytes()[offset - 1]);
                let goes_on = ends_in_name && code.as_bytes().get(offset + call.len()).copied().is_some_and(is_name);
                // `std::process::exit` has been told of already, by its door.
                let by_door = call.split_once("::").is_some_and(|(module, _)| DOORS.contains(&module))
                    && code[..offset].ends_with("std::");
                if !starts_inside && !goes_on && !by_door {
                    tell(offset, call);
                }
            }
        }
    }
}

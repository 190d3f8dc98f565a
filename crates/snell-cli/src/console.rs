//! Standard output and standard error, without panics where nobody reads them.

use std::fmt::Display;
use std::io::{self, ErrorKind, Write};

use snell::scene::Diagnostic;

use crate::failure::Failure;

/// Writes to standard output. A reader that went away wants no more, which is no failure.
pub fn write_stdout(bytes: &[u8]) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::input(Diagnostic::error(format!("standard output cannot be written: {}", reason(&error)))))
        }
        _ => Ok(()),
    }
}

/// Writes text with colours to standard output, which shows them where it can and where they are wanted.
pub fn write_styled(text: &str) -> Result<(), Failure> {
    let mut bytes = anstream::AutoStream::new(Vec::new(), anstream::AutoStream::choice(&io::stdout()));
    // Writing into memory does not fail.
    let _ = bytes.write_all(text.as_bytes());
    write_stdout(&bytes.into_inner())
}

/// Writes a line to standard error. There is nobody left to tell where that fails.
pub fn say(line: impl Display) {
    let _ = writeln!(io::stderr().lock(), "{line}");
}

/// An error of the operating system in words, without its number.
pub fn reason(error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => "there is no such file".to_owned(),
        ErrorKind::PermissionDenied => "permission denied".to_owned(),
        ErrorKind::IsADirectory => "it is a folder".to_owned(),
        ErrorKind::NotADirectory => "a part of its path is not a folder".to_owned(),
        ErrorKind::ReadOnlyFilesystem => "the file system is read-only".to_owned(),
        ErrorKind::StorageFull => "the disk is full".to_owned(),
        _ => {
            let text = error.to_string();
            text.split(" (os error").next().unwrap_or(&text).to_lowercase()
        }
    }
}

/// `1 error`, `2 errors`.
pub fn count(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

/// A path or a name for a message: in quotes, with nothing in it that a terminal would obey.
pub fn quoted(name: &str) -> String {
    let mut text = String::with_capacity(name.len() + 2);
    text.push('"');
    for letter in name.chars() {
        if letter.is_control() {
            text.extend(letter.escape_default());
        } else {
            text.push(letter);
        }
    }
    text.push('"');
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_the_system_are_words() {
        assert_eq!(reason(&io::Error::from(ErrorKind::PermissionDenied)), "permission denied");
        assert_eq!(reason(&io::Error::other("Strange thing (os error 77)")), "strange thing");
    }

    #[test]
    fn names_cannot_command_the_terminal() {
        assert_eq!(quoted("a\x1b[2Jb\u{9b}ü \"c\""), "\"a\\u{1b}[2Jb\\u{9b}ü \"c\"\"");
    }
}

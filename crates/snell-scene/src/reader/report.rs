//! What is wrong with one file, said with its place and bounded in number.
//!
//! A broken mesh may be wrong in a million places. The first [`CAP`] problems of a kind are told in full, each with line and
//! column (or the byte, in binary data), and the rest counted. The file's text enters the [`SourceMap`](crate::SourceMap)
//! only when the first problem needs it, so a good file is never copied.

use std::ops::Range;

use crate::diagnostic::{Diagnostic, Diagnostics, Severity, SourceId, Span};

/// How many problems of one kind are told in full.
pub(crate) const CAP: usize = 20;

/// Collects the problems of one file.
pub(crate) struct Report<'a> {
    /// The file's name as the user knows it.
    pub name: &'a str,
    /// The file's content.
    pub bytes: &'a [u8],
    /// Where its text ends and binary data begins.
    text_end: usize,
    diagnostics: &'a mut Diagnostics,
    source: Option<SourceId>,
    kinds: Vec<Kind>,
    failed: bool,
}

/// Problems that are counted together.
struct Kind {
    /// In the plural, to stand after "and 7 more".
    name: &'static str,
    severity: Severity,
    count: usize,
}

impl<'a> Report<'a> {
    /// For a file that is text from end to end.
    pub fn new(name: &'a str, bytes: &'a [u8], diagnostics: &'a mut Diagnostics) -> Self {
        Self { name, bytes, text_end: bytes.len(), diagnostics, source: None, kinds: Vec::new(), failed: false }
    }

    /// From this byte on, the file is binary data: places there are told as numbers of bytes.
    pub fn binary_from(&mut self, offset: usize) {
        if offset > self.text_end {
            // The text known so far is too short for what follows.
            self.source = None;
        }
        self.text_end = offset;
    }

    /// True where an error was told: the file gives nothing.
    pub fn failed(&self) -> bool {
        self.failed
    }

    /// True where anything was told.
    #[cfg(test)]
    pub fn has_told(&self) -> bool {
        !self.kinds.is_empty()
    }

    /// Notes that a file that this one names has an error: this one gives nothing either.
    pub fn fail(&mut self) {
        self.failed = true;
    }

    /// A report on another file into the same list, as for a material library.
    pub fn on<'b>(&'b mut self, name: &'b str, bytes: &'b [u8]) -> Report<'b> {
        Report::new(name, bytes, self.diagnostics)
    }

    /// A place in this file.
    pub fn span(&mut self, range: Range<usize>) -> Span {
        let source = *self.source.get_or_insert_with(|| {
            self.diagnostics.sources.add(self.name, text_of(&self.bytes[..self.text_end.min(self.bytes.len())]))
        });
        Span { source, range }
    }

    /// Tells a problem at a place. `kind` is what such problems are called, in the plural.
    pub fn at(&mut self, range: Range<usize>, kind: &'static str, say: impl FnOnce() -> Diagnostic) {
        let Some(mut diagnostic) = self.counted(kind, say) else { return };
        if range.start >= self.text_end && self.text_end < self.bytes.len() {
            diagnostic.message = format!("{}, byte {}: {}", self.name, range.start, diagnostic.message);
        } else {
            diagnostic.place = Some((self.span(range), String::new()));
        }
        self.diagnostics.push(diagnostic);
    }

    /// Tells a problem of the file as a whole.
    pub fn whole(&mut self, kind: &'static str, say: impl FnOnce() -> Diagnostic) {
        let Some(mut diagnostic) = self.counted(kind, say) else { return };
        diagnostic.message = format!("{}: {}", self.name, diagnostic.message);
        self.diagnostics.push(diagnostic);
    }

    /// Counts a problem; gives it back where it is to be told in full.
    fn counted(&mut self, kind: &'static str, say: impl FnOnce() -> Diagnostic) -> Option<Diagnostic> {
        if let Some(known) = self.kinds.iter_mut().find(|k| k.name == kind) {
            known.count += 1;
            if known.count > CAP {
                return None;
            }
        }
        let diagnostic = say();
        self.failed |= diagnostic.severity == Severity::Error;
        if !self.kinds.iter().any(|k| k.name == kind) {
            self.kinds.push(Kind { name: kind, severity: diagnostic.severity, count: 1 });
        }
        Some(diagnostic)
    }

    /// Tells how many problems were not told. True where the file is good enough to be used.
    pub fn finish(self) -> bool {
        for kind in self.kinds.iter().filter(|k| k.count > CAP) {
            let more = kind.count - CAP;
            let message = format!("{}: and {more} more {}", self.name, kind.name);
            self.diagnostics.push(Diagnostic { severity: kind.severity, ..Diagnostic::error(message) });
        }
        !self.failed
    }
}

/// The bytes as text of the same length, so that places keep their numbers: each byte that is not UTF-8 becomes `?`.
fn text_of(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len());
    for chunk in bytes.utf8_chunks() {
        text.push_str(chunk.valid());
        text.extend(chunk.invalid().iter().map(|_| '?'));
    }
    text
}

/// Bytes from a file as they may stand in a message: text, shortened where it is long.
pub(crate) fn quoted(bytes: &[u8]) -> String {
    const LONGEST: usize = 40;
    let text: String = String::from_utf8_lossy(&bytes[..bytes.len().min(4 * LONGEST)])
        .chars()
        .map(|c| if c.is_control() { '?' } else { c })
        .collect();
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("`{}…`", &text[..end]),
        None => format!("`{text}`"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn problems_are_told_up_to_the_cap_and_then_counted() {
        let mut diagnostics = Diagnostics::default();
        let mut report = Report::new("a.obj", b"one\ntwo \xff three", &mut diagnostics);
        for _ in 0..CAP + 5 {
            report.at(10..15, "numbers", || Diagnostic::warning("bad"));
        }
        assert!(report.finish());
        assert_eq!(diagnostics.list.len(), CAP + 1);
        assert_eq!(diagnostics.list[CAP].message, "a.obj: and 5 more numbers");
        let (span, _) = diagnostics.list[0].place.clone().unwrap();
        assert_eq!(diagnostics.sources.location(&span), "a.obj:2:7");
    }

    #[test]
    fn quotes_are_short_and_printable() {
        assert_eq!(quoted(b"abc\x07\xff"), "`abc?\u{fffd}`");
        assert!(quoted(&[b'x'; 1000]).chars().count() < 50);
    }
}

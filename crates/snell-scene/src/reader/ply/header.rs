//! The header of a PLY file: lines of text that say which elements follow, how many, and with which properties.

use std::ops::Range;

use crate::diagnostic::{Diagnostic, did_you_mean};
use crate::reader::report::{Report, quoted};
use crate::reader::text::{Lines, Word, Words, parse_integer};

/// How the numbers after the header are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes in binary data.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    pub fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

/// One number, or a list of them after their count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

#[derive(Clone, Debug)]
pub(super) struct Property {
    pub name: String,
    pub kind: Kind,
    /// Where the header says so.
    pub range: Range<usize>,
}

#[derive(Clone, Debug)]
pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
    /// Where the header says so.
    pub range: Range<usize>,
}

#[derive(Clone, Debug)]
pub(super) struct Header {
    pub format: Format,
    pub elements: Vec<Element>,
    /// Where the data begin.
    pub data: usize,
}

const KEYWORDS: [&str; 6] = ["format", "comment", "obj_info", "element", "property", "end_header"];

/// Reads the header and tells all that is wrong with it.
pub(super) fn read(report: &mut Report<'_>) -> Option<Header> {
    let bytes = report.bytes;
    let start = bytes.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(0);
    let end = start + 3;
    if bytes.get(start..end) != Some(b"ply") || !bytes.get(end).is_none_or(u8::is_ascii_whitespace) {
        report.binary_from(0);
        report.whole("headers", || Diagnostic::error("this is no PLY file: it does not begin with the line `ply`"));
        return None;
    }
    // Until the data are found, the text that messages may point into ends with the header's longest sensible size.
    let (lines_end, data) = end_of_header(bytes, start);
    report.binary_from(lines_end);

    let mut parser = Parser { format: None, elements: Vec::new() };
    let mut lines = Lines::new(&bytes[..lines_end], end, false);
    while let Some(line) = lines.next_line() {
        parser.line(report, Words::new(bytes, line));
    }
    let Some(data) = data else {
        let at = lines_end.saturating_sub(1);
        report
            .at(at..lines_end, "headers", || Diagnostic::error("the header has no end: there is no line `end_header`"));
        return None;
    };
    if parser.format.is_none() && !report.failed() {
        let help = "the second line should be `format ascii 1.0`, `format binary_little_endian 1.0` or `format binary_big_endian 1.0`";
        report.at(start..end, "headers", || Diagnostic::error("the header names no format").help(help));
    }
    if parser.format == Some(Format::Ascii) {
        report.binary_from(bytes.len());
    }
    match parser.format {
        Some(format) if !report.failed() => Some(Header { format, elements: parser.elements, data }),
        _ => None,
    }
}

/// Where the header's lines end, and where the data begin if it has an end: after the line `end_header` with the line end
/// that the first line has too, since binary data may begin with a byte that looks like one.
fn end_of_header(bytes: &[u8], start: usize) -> (usize, Option<usize>) {
    const LONGEST: usize = 1 << 20;
    let limit = bytes.len().min(start + LONGEST);
    let after_magic = &bytes[start + 3..limit];
    let blanks = after_magic.iter().take_while(|&&b| b == b' ' || b == b'\t').count();
    let line_end: &[u8] = match &after_magic[blanks..] {
        [b'\r', b'\n', ..] => b"\r\n",
        [b'\r', ..] => b"\r",
        _ => b"\n",
    };
    let mut lines = Lines::new(&bytes[..limit], start + 3, false);
    while let Some(line) = lines.next_line() {
        let mut words = Words::new(bytes, line.clone());
        if words.next().is_some_and(|w| w.text == b"end_header") {
            let data =
                if bytes[line.end..].starts_with(line_end) { line.end + line_end.len() } else { lines.position() };
            return (line.end, Some(data));
        }
    }
    (limit, None)
}

struct Parser {
    format: Option<Format>,
    elements: Vec<Element>,
}

impl Parser {
    fn line(&mut self, report: &mut Report<'_>, mut words: Words<'_>) {
        let Some(keyword) = words.next() else { return };
        match keyword.text {
            b"comment" | b"obj_info" | b"end_header" => {}
            b"format" => self.format(report, keyword, &mut words),
            b"element" => self.element(report, keyword, &mut words),
            b"property" => self.property(report, keyword, &mut words),
            other => report.at(keyword.range(), "unknown header lines", || {
                let message = format!("unknown word {} in the header", quoted(other));
                match std::str::from_utf8(other).ok().and_then(|word| did_you_mean(word, KEYWORDS)) {
                    // A property that is passed over would shift everything after it.
                    Some(near) => Diagnostic::error(message).help(format!("did you mean `{near}`?")),
                    None => Diagnostic::warning(format!("{message}: this line is left out")),
                }
            }),
        }
    }

    fn format(&mut self, report: &mut Report<'_>, keyword: Word<'_>, words: &mut Words<'_>) {
        let (name, version) = (words.next(), words.next());
        let format = match name.map(|w| w.text) {
            Some(b"ascii") => Format::Ascii,
            Some(b"binary_little_endian") => Format::LittleEndian,
            Some(b"binary_big_endian") => Format::BigEndian,
            _ => {
                let help = "known formats are ascii, binary_little_endian and binary_big_endian";
                let range = name.map_or(keyword.range(), |w| w.range());
                return report.at(range, "headers", || Diagnostic::error("unknown format").help(help));
            }
        };
        match version {
            Some(version) if version.text != b"1.0" => report.at(version.range(), "headers", || {
                Diagnostic::warning(format!("version {} is read as 1.0, the only one known", quoted(version.text)))
            }),
            _ => {}
        }
        self.format = Some(format);
    }

    fn element(&mut self, report: &mut Report<'_>, keyword: Word<'_>, words: &mut Words<'_>) {
        let (Some(name), Some(count)) = (words.next(), words.next()) else {
            let help = "as in `element vertex 8`";
            return report.at(keyword.range(), "headers", || {
                Diagnostic::error("an element needs a name and a count").help(help)
            });
        };
        let Some(count_value) = parse_integer(count.text).and_then(|c| u64::try_from(c).ok()) else {
            return report.at(count.range(), "headers", || {
                Diagnostic::error(format!("{} is no count of elements", quoted(count.text)))
            });
        };
        let text = String::from_utf8_lossy(name.text).into_owned();
        if let Some(first) = self.elements.iter().find(|e| e.name == text) {
            let first = first.range.clone();
            let span = report.span(first);
            return report.at(name.range(), "headers", || {
                Diagnostic::error(format!("the element {} is declared twice", quoted(name.text)))
                    .related(span, "first declared here")
            });
        }
        let range = name.start..count.range().end;
        self.elements.push(Element { name: text, count: count_value, properties: Vec::new(), range });
    }

    fn property(&mut self, report: &mut Report<'_>, keyword: Word<'_>, words: &mut Words<'_>) {
        let Some(element) = self.elements.last_mut() else {
            return report.at(keyword.range(), "headers", || Diagnostic::error("a property before the first element"));
        };
        let scalar = |report: &mut Report<'_>, words: &mut Words<'_>| -> Option<Scalar> {
            let word = words.next();
            let known = word.and_then(|w| Scalar::named(w.text));
            if known.is_none() {
                let range = word.map_or(keyword.range(), |w| w.range());
                let help = "types are char, uchar, short, ushort, int, uint, float and double";
                report.at(range, "headers", || Diagnostic::error("unknown type of a property").help(help));
            }
            known
        };
        let mut ahead = words.clone();
        let kind = if ahead.next().is_some_and(|w| w.text == b"list") {
            *words = ahead;
            let (Some(count), Some(item)) = (scalar(report, words), scalar(report, words)) else { return };
            if !count.is_integer() {
                let message = "the count of a list must be of an integer type";
                return report.at(keyword.range(), "headers", || Diagnostic::error(message));
            }
            Kind::List { count, item }
        } else {
            let Some(scalar) = scalar(report, words) else { return };
            Kind::Scalar(scalar)
        };
        let Some(name) = words.next() else {
            return report.at(keyword.range(), "headers", || Diagnostic::error("a property without a name"));
        };
        let range = keyword.start..name.range().end;
        let name = String::from_utf8_lossy(name.text).into_owned();
        element.properties.push(Property { name, kind, range });
    }
}

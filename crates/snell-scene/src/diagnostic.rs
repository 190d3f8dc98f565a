//! What is wrong with an input, said to the person who wrote it: message, place and suggestion, as values. Shells print them.

use std::ops::Range;
use std::sync::Arc;

/// One text that diagnostics can point into: a file, or a command line's `--set`.
#[derive(Clone, Debug)]
pub struct Source {
    /// Its name as the user knows it: a path, or `--set`.
    pub name: String,
    /// Its whole text; bytes that are not UTF-8 replaced.
    pub text: Arc<str>,
}

/// The place of a [`Source`] in its [`SourceMap`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SourceId(pub(crate) u32);

/// All texts that were read.
#[derive(Clone, Debug, Default)]
pub struct SourceMap {
    sources: Vec<Source>,
}

impl SourceMap {
    /// Adds a text.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<Arc<str>>) -> SourceId {
        self.sources.push(Source { name: name.into(), text: text.into() });
        SourceId(self.sources.len() as u32 - 1)
    }

    /// The text under an id that this map gave.
    pub fn get(&self, id: SourceId) -> &Source {
        &self.sources[id.0 as usize]
    }

    /// Line and column, both from 1, of a span's start; columns count characters.
    pub fn line_column(&self, span: &Span) -> (usize, usize) {
        let text = &self.get(span.source).text;
        let start = text.floor_char_boundary(span.range.start.min(text.len()));
        let before = &text[..start];
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
    }

    /// `file:line:column` of a span's start.
    pub fn location(&self, span: &Span) -> String {
        let (line, column) = self.line_column(span);
        format!("{}:{line}:{column}", self.get(span.source).name)
    }
}

/// A stretch of one source, in bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Span {
    /// Which text.
    pub source: SourceId,
    /// Which bytes of it.
    pub range: Range<usize>,
}

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The scene renders, but perhaps not as meant.
    Warning,
    /// Nothing is rendered.
    Error,
}

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// How bad.
    pub severity: Severity,
    /// What is wrong, naming the thing: one line, lower case, no full stop.
    pub message: String,
    /// Where: the main place, with a few words to stand under it (may be empty).
    pub place: Option<(Span, String)>,
    /// Further places that explain, such as "first defined here".
    pub related: Vec<(Span, String)>,
    /// What to do: "did you mean …", the allowed range.
    pub help: Option<String>,
}

impl Diagnostic {
    /// An error with no place yet.
    pub fn error(message: impl Into<String>) -> Self {
        Self { severity: Severity::Error, message: message.into(), place: None, related: Vec::new(), help: None }
    }

    /// A warning with no place yet.
    pub fn warning(message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(message) }
    }

    /// With its main place and the words that stand under it.
    #[must_use]
    pub fn at(mut self, span: Span, label: impl Into<String>) -> Self {
        self.place = Some((span, label.into()));
        self
    }

    /// With its main place where there is one.
    #[must_use]
    pub fn at_optional(self, span: Option<Span>, label: impl Into<String>) -> Self {
        match span {
            Some(span) => self.at(span, label),
            None => self,
        }
    }

    /// With one more place that explains.
    #[must_use]
    pub fn related(mut self, span: Span, label: impl Into<String>) -> Self {
        self.related.push((span, label.into()));
        self
    }

    /// With advice.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// Everything that was found wrong, in the order of finding, and the texts it points into.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    /// The texts.
    pub sources: SourceMap,
    /// What was found.
    pub list: Vec<Diagnostic>,
}

impl Diagnostics {
    /// Adds one.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.list.push(diagnostic);
    }

    /// True where anything forbids rendering.
    pub fn has_errors(&self) -> bool {
        self.list.iter().any(|d| d.severity == Severity::Error)
    }

    /// How many errors and how many warnings.
    pub fn counts(&self) -> (usize, usize) {
        let errors = self.list.iter().filter(|d| d.severity == Severity::Error).count();
        (errors, self.list.len() - errors)
    }
}

/// The candidate nearest to a misspelt word, where one is near enough to be worth suggesting.
///
/// Nearness is the Damerau–Levenshtein distance without regard to case, at most a third of the longer word's length. Words
/// of more than 256 bytes are near to nothing: the distance takes time and memory in proportion to both lengths.
///
/// ```
/// use snell_scene::diagnostic::did_you_mean;
/// assert_eq!(did_you_mean("shpere", ["sphere", "plane"]), Some("sphere"));
/// assert_eq!(did_you_mean("zebra", ["sphere", "plane"]), None);
/// ```
pub fn did_you_mean<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    const LONGEST: usize = 256;
    if word.len() > LONGEST {
        return None;
    }
    let lower = word.to_lowercase();
    candidates
        .into_iter()
        .filter(|candidate| candidate.len() <= LONGEST)
        .map(|candidate| {
            let distance = strsim::damerau_levenshtein(&lower, &candidate.to_lowercase());
            (distance, candidate)
        })
        .filter(|(distance, candidate)| distance * 3 <= candidate.chars().count().max(lower.chars().count()))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

//! Diagnostics on standard error: message, `file:line:column`, the underlined source, and what to do.

use std::io::Write;
use std::ops::Range;

use annotate_snippets::{Annotation, AnnotationKind, Group, Level, Renderer, Snippet, normalize_untrusted_str};
use snell::scene::{Diagnostic, Diagnostics, Severity, SourceId, SourceMap, Span};

use crate::console::count;

/// Lines are cut to this width where standard error is no terminal; columns.
const WIDTH_WITHOUT_TERMINAL: usize = 120;

/// Prints all, in colour where the terminal and `NO_COLOR` allow it.
pub fn print(diagnostics: &Diagnostics) {
    if diagnostics.list.is_empty() {
        return;
    }
    let width = terminal_size::terminal_size_of(std::io::stderr()).map(|(width, _)| usize::from(width.0));
    let text = render_all(diagnostics, &Renderer::styled().term_width(width.unwrap_or(WIDTH_WITHOUT_TERMINAL)));
    // There is nobody left to tell where this fails.
    let _ = anstream::stderr().lock().write_all(text.as_bytes());
}

/// How many errors and warnings there are: `3 errors, 1 warning`, or `no mistakes`.
pub fn summary(diagnostics: &Diagnostics) -> String {
    match diagnostics.counts() {
        (0, 0) => "no mistakes".to_owned(),
        (errors, 0) => count(errors, "error"),
        (0, warnings) => count(warnings, "warning"),
        (errors, warnings) => format!("{}, {}", count(errors, "error"), count(warnings, "warning")),
    }
}

/// One in a line of its own: `a.toml:3:5: unknown material "glas"`.
pub fn one_line(diagnostic: &Diagnostic, sources: &SourceMap) -> String {
    let place = diagnostic.place.as_ref().map(|(span, _)| format!("{}: ", sources.location(span)));
    normalize_untrusted_str(&format!("{}{}", place.unwrap_or_default(), diagnostic.message))
}

fn render_all(diagnostics: &Diagnostics, renderer: &Renderer) -> String {
    diagnostics.list.iter().fold(String::new(), |mut text, diagnostic| {
        text += &render(diagnostic, &diagnostics.sources, renderer);
        // A blank line sets those with a source apart.
        text += if diagnostic.place.is_some() { "\n\n" } else { "\n" };
        text
    })
}

fn render(diagnostic: &Diagnostic, sources: &SourceMap, renderer: &Renderer) -> String {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let mut group = Group::with_title(level.primary_title(diagnostic.message.as_str()));
    let excerpts = excerpts(diagnostic);
    for excerpt in &excerpts {
        let source = sources.get(excerpt.source);
        let window = lines_around(&source.text, &excerpt.range);
        let (line, _) = sources.line_column(&Span { source: excerpt.source, range: window.clone() });
        let annotations = excerpt.annotations.iter().map(|(kind, range, label)| {
            let text = &source.text;
            let start = text.floor_char_boundary(range.start.clamp(window.start, window.end));
            let end = text.ceil_char_boundary(range.end.clamp(start, window.end));
            let annotation: Annotation<'_> = kind.span(start - window.start..end - window.start);
            annotation.label((!label.is_empty()).then_some(*label))
        });
        group = group.element(
            Snippet::source(&source.text[window.clone()])
                .path(source.name.as_str())
                .line_start(line)
                .annotations(annotations),
        );
    }
    let Some(help) = &diagnostic.help else { return renderer.render(&[group]) };
    let help = normalize_untrusted_str(help);
    if excerpts.is_empty() {
        // Without a source there is no margin to hang it on.
        let help = renderer.render(&[Group::with_title(Level::HELP.secondary_title(help))]);
        return format!("{}\n{help}", renderer.render(&[group]));
    }
    renderer.render(&[group.element(Level::HELP.message(help))])
}

/// What is shown of one source.
struct Excerpt<'a> {
    source: SourceId,
    /// From the first marked byte to the last.
    range: Range<usize>,
    annotations: Vec<(AnnotationKind, Range<usize>, &'a str)>,
}

/// The places of a diagnostic, the main one first, those in the same source together.
fn excerpts(diagnostic: &Diagnostic) -> Vec<Excerpt<'_>> {
    let main = diagnostic.place.iter().map(|place| (AnnotationKind::Primary, place));
    let related = diagnostic.related.iter().map(|place| (AnnotationKind::Context, place));
    let mut excerpts: Vec<Excerpt<'_>> = Vec::new();
    for (kind, (Span { source, range }, label)) in main.chain(related) {
        let annotation = (kind, range.clone(), label.as_str());
        match excerpts.iter_mut().find(|excerpt| excerpt.source == *source) {
            Some(excerpt) => {
                excerpt.range = excerpt.range.start.min(range.start)..excerpt.range.end.max(range.end);
                excerpt.annotations.push(annotation);
            }
            None => {
                excerpts.push(Excerpt { source: *source, range: range.clone(), annotations: vec![annotation] });
            }
        }
    }
    excerpts
}

/// The whole lines that a range touches: all that is needed of a source, which may have many megabytes.
fn lines_around(text: &str, range: &Range<usize>) -> Range<usize> {
    let start = text.floor_char_boundary(range.start.min(text.len()));
    let end = text.ceil_char_boundary(range.end.clamp(start, text.len()));
    let first = text[..start].rfind('\n').map_or(0, |at| at + 1);
    let last = text[end..].find('\n').map_or(text.len(), |at| end + at);
    first..last
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(diagnostic: Diagnostic, sources: SourceMap) -> String {
        render_all(&Diagnostics { sources, list: vec![diagnostic] }, &Renderer::plain())
    }

    #[test]
    fn a_place_is_shown_with_its_line_and_words() {
        let mut sources = SourceMap::default();
        let source = sources.add("a.toml", "# first\n\nmaterial = \"glas\"\n");
        let diagnostic = Diagnostic::error("unknown material \"glas\"")
            .at(Span { source, range: 20..26 }, "not defined")
            .help("did you mean \"glass\"?");
        let expected = concat!(
            "error: unknown material \"glas\"\n",
            " --> a.toml:3:12\n",
            "  |\n",
            "3 | material = \"glas\"\n",
            "  |            ^^^^^^ not defined\n",
            "  |\n",
            "  = help: did you mean \"glass\"?\n\n",
        );
        assert_eq!(plain(diagnostic, sources), expected);
    }

    #[test]
    fn without_a_place_there_is_no_margin() {
        let diagnostic = Diagnostic::error("\"lenz\" is no scene").help("did you mean \"lens\"?");
        let expected = "error: \"lenz\" is no scene\nhelp: did you mean \"lens\"?\n";
        assert_eq!(plain(diagnostic, SourceMap::default()), expected);
    }

    #[test]
    fn places_in_two_sources_are_both_shown() {
        let mut sources = SourceMap::default();
        let set = sources.add("--set", "camera.fov=900");
        let file = sources.add("a.toml", "[camera]\nfov = 40\n");
        let diagnostic = Diagnostic::warning("strange")
            .at(Span { source: set, range: 11..14 }, "")
            .related(Span { source: file, range: 9..17 }, "in place of this");
        let text = plain(diagnostic, sources);
        for part in ["warning: strange", "--> --set:1:12", "1 | camera.fov=900", "::: a.toml:2:1", "in place of this"] {
            assert!(text.contains(part), "{part} is not in\n{text}");
        }
    }

    #[test]
    fn spans_out_of_the_text_or_in_a_letter_do_no_harm() {
        for (text, range) in [("", 0..0), ("", 5..9), ("ä", 1..1), ("äö\n", 1..3), ("a\nb", 2..99), ("x\n", 2..2)] {
            let mut sources = SourceMap::default();
            let source = sources.add("a.toml", text);
            let diagnostic = Diagnostic::error("wrong").at(Span { source, range: range.clone() }, "here");
            assert!(plain(diagnostic, sources).starts_with("error: wrong"), "{range:?} of {text:?}");
        }
    }

    #[test]
    fn nothing_in_a_scene_commands_the_terminal() {
        let mut sources = SourceMap::default();
        let source = sources.add("a.toml", "x = \"\x1b[2J\"\n");
        let diagnostic = Diagnostic::error("no \x1b[2J").at(Span { source, range: 4..8 }, "").help("\x1b]0;title\x07");
        assert!(!plain(diagnostic, sources).contains(['\x1b', '\x07']));
    }

    #[test]
    fn only_the_lines_in_question_are_handed_on() {
        assert_eq!(lines_around("one\ntwo\nthree\n", &(5..6)), 4..7);
        assert_eq!(lines_around("one\ntwo\nthree", &(1..9)), 0..13);
        assert_eq!(lines_around("one\n", &(4..4)), 4..4);
    }

    #[test]
    fn counts_are_words() {
        let mut diagnostics = Diagnostics::default();
        assert_eq!(summary(&diagnostics), "no mistakes");
        diagnostics.push(Diagnostic::warning("w"));
        assert_eq!(summary(&diagnostics), "1 warning");
        diagnostics.push(Diagnostic::error("e"));
        diagnostics.push(Diagnostic::error("e"));
        assert_eq!(summary(&diagnostics), "2 errors, 1 warning");
    }
}

//! Every mistake that the scene format knows, as the author sees it: `mistakes.txt` holds scenes and the messages they give,
//! with place, underlined text and suggestion. `SNELL_BLESS=1` writes the messages anew.

#![expect(clippy::unwrap_used, reason = "helpers of tests, where a panic is a failure")]

use std::fmt::Write;

use snell_scene::assets::MemoryAssets;
use snell_scene::document::read_scene;
use snell_scene::{Diagnostics, Severity, Span};

const CASES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/mistakes.txt");

/// One case: a title, the options of `--set` that go with it, the scene, and the messages.
struct Case {
    title: String,
    sets: Vec<String>,
    json: bool,
    scene: String,
    messages: String,
}

fn cases() -> Vec<Case> {
    let text = std::fs::read_to_string(CASES).unwrap();
    let parts = text.split("\n=== ").skip(1);
    parts
        .map(|part| {
            let (title, rest) = part.split_once('\n').unwrap();
            let rest = format!("\n{rest}");
            let (scene, messages) = rest.split_once("\n---\n").unwrap_or((&rest, ""));
            let (sets, lines): (Vec<&str>, Vec<&str>) = scene.lines().partition(|line| line.starts_with("--set "));
            Case {
                title: title.to_owned(),
                sets: sets.iter().map(|line| line["--set ".len()..].to_owned()).collect(),
                json: title.contains("(JSON)"),
                scene: lines.join("\n").trim_start().to_owned() + "\n",
                messages: messages.trim_end().to_owned(),
            }
        })
        .collect()
}

fn assets() -> MemoryAssets {
    MemoryAssets::default()
        .with("textures/wood.png", b"png")
        .with("valley.hdr", b"hdr")
        .with("lenses/wrong.toml", b"surfaces = [{ radus = 3, diameter = -1 }]\nnam = 'x'\n")
        .with("lenses/two-stops.toml", b"surfaces = [{ diameter = 1, stop = true }, { diameter = 1, stop = true }]\n")
}

/// Diagnostics as plain text, as a compiler shows them.
fn rendered(diagnostics: &Diagnostics) -> String {
    let mut text = String::new();
    for diagnostic in &diagnostics.list {
        let severity = if diagnostic.severity == Severity::Error { "error" } else { "warning" };
        writeln!(text, "{severity}: {}", diagnostic.message).unwrap();
        for (span, label) in diagnostic.place.iter().chain(&diagnostic.related) {
            underlined(&mut text, diagnostics, span, label);
        }
        if let Some(help) = &diagnostic.help {
            writeln!(text, "  help: {help}").unwrap();
        }
    }
    text.trim_end().to_owned()
}

fn underlined(text: &mut String, diagnostics: &Diagnostics, span: &Span, label: &str) {
    let source = &diagnostics.sources.get(span.source).text;
    let (line, column) = diagnostics.sources.line_column(span);
    let content = source.lines().nth(line - 1).unwrap_or_default();
    let length = source[span.range.clone()].lines().next().unwrap_or_default().chars().count().max(1);
    writeln!(text, "  --> {}", diagnostics.sources.location(span)).unwrap();
    writeln!(text, "   | {content}").unwrap();
    writeln!(text, "   | {}{} {label}", " ".repeat(column - 1), "^".repeat(length)).unwrap();
    text.truncate(text.trim_end().len());
    text.push('\n');
}

fn messages(case: &Case) -> (bool, String) {
    let name = if case.json { "scene.json" } else { "scene.toml" };
    let (scene, diagnostics) = read_scene(name, case.scene.as_bytes(), &assets(), &case.sets);
    assert_eq!(scene.is_none(), diagnostics.has_errors(), "{}: a scene exactly where there are no errors", case.title);
    (scene.is_some(), rendered(&diagnostics))
}

#[test]
fn mistakes_are_told_as_written_down() {
    let cases = cases();
    assert!(cases.len() >= 60, "only {} cases were found", cases.len());
    if std::env::var_os("SNELL_BLESS").is_some() {
        let text = std::fs::read_to_string(CASES).unwrap();
        let mut blessed = text.split("\n=== ").next().unwrap().to_owned();
        for case in &cases {
            let sets: String = case.sets.iter().map(|set| format!("--set {set}\n")).collect();
            let (scene, found) = (case.scene.trim_end(), messages(case).1);
            let scene = if scene.is_empty() { String::new() } else { format!("{scene}\n") };
            write!(blessed, "\n=== {}\n{sets}{scene}---\n{found}\n", case.title).unwrap();
        }
        std::fs::write(CASES, blessed).unwrap();
        return;
    }
    let mut wrong = String::new();
    for case in &cases {
        let (_, found) = messages(case);
        if found != case.messages {
            write!(wrong, "\n=== {}\nexpected:\n{}\nfound:\n{found}\n", case.title, case.messages).unwrap();
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// The comparison itself: a message with another column must not pass for the right one.
#[test]
fn a_misplaced_message_is_noticed() {
    let cases = cases();
    let case = cases.iter().find(|case| case.messages.contains("scene.toml:2:")).unwrap();
    let shifted = Case {
        title: case.title.clone(),
        sets: case.sets.clone(),
        json: case.json,
        scene: format!("\n{}", case.scene),
        messages: String::new(),
    };
    assert_ne!(messages(&shifted).1, case.messages);
}

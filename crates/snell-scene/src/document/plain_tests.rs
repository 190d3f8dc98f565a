//! The plain parser against the crate `toml`: the same tree, or nothing.

use std::cell::Cell;

use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

use super::super::parse;
use super::*;
use crate::diagnostic::{Diagnostics, SourceId};

/// The tree by the crate `toml`; `None` where the text is wrong.
fn by_toml(text: &str) -> Option<Node<'_>> {
    parse::by_toml(text, SourceId(0), &mut Diagnostics::default())
}

/// What is wrong with the plain parser's answer.
fn fault(text: &str, plain: Option<&Node<'_>>) -> Option<String> {
    let plain = plain?;
    match by_toml(text) {
        None => Some(format!("read what is no TOML:\n{text}")),
        Some(other) if &other != plain => Some(format!("read another tree from\n{text}\n{plain:?}\n{other:?}")),
        Some(_) => None,
    }
}

fn runner(cases: u32) -> TestRunner {
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
}

/// Pieces of which texts are made that are mostly wrong, but often nearly right.
const PIECES: &[&str] = &[
    "a",
    "b",
    "a-b_1",
    "a.b",
    "b . a",
    "\"a\"",
    "'a'",
    " = ",
    "=",
    "a = 1\n",
    "b = {}\n",
    "[a]\n",
    "[b]\n",
    "[a.b]\n",
    "[ a . b ]\n",
    "[[a]]\n",
    "[[b]]\n",
    "[[a.b]]\n",
    "[a.b.c]\n",
    "[[a.b.c]]\n",
    "[",
    "]",
    "[[",
    "]]",
    "{",
    "}",
    ", ",
    ",",
    "\n",
    "\r\n",
    "\r",
    "# é\n",
    "#",
    "\u{7f}",
    "\u{1}",
    "\t",
    "\"",
    "'",
    "\"\"",
    "\"\"\"",
    "''",
    "'''",
    "\\n",
    "true",
    "false",
    "0",
    "00",
    "-0",
    "+1",
    "1.5",
    "1.",
    ".5",
    "1e5",
    "1e",
    "-1.25e-3",
    "1_000",
    "0x1F",
    "inf",
    "nan",
    "1979-05-27",
    "07:32:00",
    "123456789012345678",
    "1234567890123456789",
    "99999999999999999999",
    "1e400",
    "é",
    "{a = 1, b = [1, 2.5]}",
    "[1, 2, 3,]",
    "a = [{a = 1}]\n",
    "b = \"x\" # y\n",
    "a.b = 1\n",
    "{a.b = 1}",
    "{a = 1, a = 2}",
];

#[test]
fn whatever_it_reads_is_what_the_crate_reads() {
    let pieces = prop::collection::vec(0..PIECES.len(), 0..14);
    let read = Cell::new(0);
    runner(6000)
        .run(&pieces, |pieces| {
            let text: String = pieces.iter().map(|piece| PIECES[*piece]).collect();
            let plain = document(&text, SourceId(0));
            read.set(read.get() + u32::from(plain.is_some()));
            prop_assert_eq!(fault(&text, plain.as_ref()), None);
            Ok(())
        })
        .unwrap();
    assert!(read.get() > 300, "only {}", read.get());
}

/// Values, well written.
fn value() -> impl Strategy<Value = String> {
    let space = "( |\t|\n|\r\n|# x\n){0,2}";
    let leaf = prop_oneof![
        "[+-]?(0|[1-9][0-9]{0,18})(\\.[0-9]{1,20})?([eE][+-]?[0-9]{1,3})?",
        "\"[a-zé #]{0,5}\"",
        "'[a-z\\\\]{0,5}'",
        Just("true".to_owned()),
        Just("false".to_owned()),
    ];
    leaf.prop_recursive(4, 24, 5, move |inner| {
        let item = (space, inner.clone(), space).prop_map(|(a, value, b)| a + &value + &b);
        let entry = (space, "[a-e]{1,2}", "[ \t]?=[ \t]?", inner, space)
            .prop_map(|(a, key, equals, value, b)| a + &key + &equals + &value + &b);
        prop_oneof![
            (prop::collection::vec(item, 0..5), "(, ?\n?)?").prop_map(|(items, end)| format!(
                "[{}{}]",
                items.join(","),
                if items.is_empty() { "" } else { &end }
            )),
            prop::collection::vec(entry, 0..4).prop_map(|entries| format!("{{{}}}", entries.join(","))),
        ]
    })
}

#[test]
fn what_is_plain_is_read_and_as_the_crate_reads_it() {
    let lines = prop_oneof![
        3 => ("[a-e]{1,2}", " ?= ?", value(), "( # c)?").prop_map(|(k, e, v, c)| k + &e + &v + &c),
        2 => ("[a-c](\\.[a-c]){0,2}", any::<bool>()).prop_map(|(path, list)| {
            if list { format!("[[{path}]]") } else { format!("[{path}]") }
        }),
        1 => Just("# a comment".to_owned()),
    ];
    let texts = (prop::collection::vec(lines, 0..8), prop_oneof![Just("\n"), Just("\r\n")]);
    let (read, right) = (Cell::new(0), Cell::new(0));
    runner(3000)
        .run(&texts, |(lines, end)| {
            let text = lines.join(end);
            let plain = document(&text, SourceId(0));
            read.set(read.get() + u32::from(plain.is_some()));
            right.set(right.get() + u32::from(by_toml(&text).is_some()));
            prop_assert_eq!(fault(&text, plain.as_ref()), None);
            Ok(())
        })
        .unwrap();
    let (read, right) = (read.get(), right.get());
    assert!(read * 10 > right * 8 && right > 500, "{read} of {right}");
}

/// Scenes as people write them.
const SCENES: [&str; 5] = [
    include_str!("../../../../scenes/bubble.toml"),
    include_str!("../../../../scenes/cosine-plot.toml"),
    include_str!("../../../../scenes/kitchen-window.toml"),
    include_str!("../../../../scenes/lens.toml"),
    include_str!("../../../../scenes/nine-red-balls.toml"),
];

#[test]
fn the_scenes_of_the_repository_are_read_as_the_crate_reads_them() {
    let mut read = 0;
    for text in SCENES {
        let plain = document(text, SourceId(0));
        assert_eq!(fault(text, plain.as_ref()), None);
        read += usize::from(plain.is_some());
    }
    assert!(read * 2 > SCENES.len(), "only {read} are plain");
}

#[test]
fn tables_by_headers_may_be_very_many() {
    let many = |header: &str, count: usize| {
        (0..count).map(|i| format!("{}\n", header.replace('#', &i.to_string()))).collect::<String>()
    };
    let start = "[material.m7.dielectric]\nior = 1.5\n".to_owned();
    for (text, plain) in [
        (many("[[object]]\nsphere = {}", 5000), true),
        (many("[material.m#]\ndiffuse = 1", 5000), true),
        (many("[material.m#]\ndiffuse = 1", 5000) + "[material.m4999]\n", false),
        (many("[material.m#]\n[material.m#.dielectric]\n", 5000), true),
        (start.clone() + &many("[texture.m#]", 500), true),
        (start + &many("[material.m#]", 500), false),
        (many("[material.m#.dielectric]\n", 5000), false),
    ] {
        let read = document(&text, SourceId(0));
        assert_eq!(read.is_some(), plain, "{}", &text[..60]);
        assert_eq!(fault(&text, read.as_ref()), None);
    }
}

/// The twin: the comparison sees every kind of change.
#[test]
fn a_planted_difference_is_found() {
    let text = "a = 1\n[[b]]\nc = [1.5, \"x\"]\n";
    let tree = document(text, SourceId(0)).unwrap();
    assert_eq!(fault(text, Some(&tree)), None);
    let change = |change: &dyn Fn(&mut Entries<'_>)| {
        let mut tree = tree.clone();
        let Value::Table(entries) = &mut tree.value else { panic!() };
        change(entries);
        fault(text, Some(&tree)).is_some()
    };
    assert!(change(&|entries| entries[0].1.value = Value::Float(1.0)));
    assert!(change(&|entries| entries[0].0.place.end += 1));
    assert!(change(&|entries| entries[1].1.place.start += 1));
    assert!(change(&|entries| entries.swap(0, 1)));
    assert!(change(&|entries| entries.truncate(1)));
    assert!(fault("a = 1 1", Some(&tree)).is_some());
}

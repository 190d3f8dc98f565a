//! No input makes the reader panic or give a scene with numbers that are not finite: arbitrary bytes, broken copies of a
//! scene that has everything, and arbitrary `--set`.

use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use snell_scene::assets::MemoryAssets;
use snell_scene::document::read_scene;

/// A scene with every kind of thing: all examples of the reference together.
fn everything() -> Vec<String> {
    let reference = snell_scene::document::reference();
    reference.split("```toml\n").skip(1).map(|block| block.split("```").next().unwrap().to_owned()).collect()
}

/// Words that are most likely to lead somewhere.
const WORDS: [&str; 24] = [
    "nan",
    "inf",
    "-1",
    "0",
    "1e308",
    "1e-308",
    "{}",
    "[]",
    "[[object]]\n",
    "\"",
    "#",
    "=",
    "[",
    "}",
    "union = [",
    "sphere",
    "true",
    "4294967296",
    "-0.0",
    "é",
    "\u{0}",
    "grid",
    "instance = \"a\"",
    "\n",
];

fn check(text: &[u8], sets: &[String]) {
    for name in ["scene.toml", "scene.json"] {
        let (scene, diagnostics) = read_scene(name, text, &MemoryAssets::default(), sets);
        assert_eq!(scene.is_none(), diagnostics.has_errors());
        for diagnostic in &diagnostics.list {
            for (span, _) in diagnostic.place.iter().chain(&diagnostic.related) {
                let source = &diagnostics.sources.get(span.source).text;
                assert!(span.range.start <= span.range.end && span.range.end <= source.len(), "{diagnostic:?}");
                assert!(source.get(span.range.clone()).is_some(), "{diagnostic:?}");
                diagnostics.sources.location(span);
            }
        }
        if let Some(scene) = scene {
            assert!(scene.objects.iter().all(|object| object.parent_from_object.affine().is_finite()));
            assert!(scene.lights.iter().all(|light| light.intensity.is_finite()));
        }
    }
}

fn runner(cases: u32) -> TestRunner {
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
}

#[test]
fn arbitrary_bytes_do_no_harm() {
    let bytes = prop::collection::vec(any::<u8>(), 0..200);
    runner(200)
        .run(&bytes, |bytes| {
            check(&bytes, &[]);
            Ok(())
        })
        .unwrap();
}

#[test]
fn broken_scenes_do_no_harm() {
    let scenes = everything();
    let edits = prop::collection::vec((any::<prop::sample::Index>(), 0..12_usize, 0..WORDS.len()), 1..4);
    let strategy = (0..scenes.len(), edits);
    runner(300)
        .run(&strategy, |(scene, edits)| {
            let mut bytes = scenes[scene].clone().into_bytes();
            for (at, removed, word) in edits {
                let at = at.index(bytes.len() + 1);
                let end = bytes.len().min(at + removed);
                bytes.splice(at..end, WORDS[word].bytes());
            }
            check(&bytes, &[]);
            Ok(())
        })
        .unwrap();
}

#[test]
fn truncated_scenes_do_no_harm() {
    for scene in everything() {
        for end in (0..scene.len()).step_by(23) {
            check(&scene.as_bytes()[..end], &[]);
        }
    }
}

#[test]
fn values_of_any_type_under_any_key_do_no_harm() {
    let scene = everything().concat();
    let scene = scene.split("[[object]]").nth(1).map_or(String::new(), |object| format!("[[object]]{object}"));
    let keys = snell_scene::document::keys();
    for (i, key) in keys.iter().enumerate() {
        let value = WORDS[i % WORDS.len()];
        check(scene.as_bytes(), &[format!("{}={value}", key.path.replace("NAME", "0"))]);
    }
    let words = prop::collection::vec(0..WORDS.len(), 0..6);
    runner(300)
        .run(&words, |words| {
            let set: String = words.iter().map(|word| WORDS[*word]).collect();
            check(scene.as_bytes(), &[set]);
            Ok(())
        })
        .unwrap();
}

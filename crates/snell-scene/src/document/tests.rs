//! The published files and the limits of the scene format; `tests/` of this crate has what is seen from outside.

use super::*;
use crate::assets::MemoryAssets;

const DOCS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs");

/// The files that are written from the model, and the texts that belong there.
fn published() -> [(String, String); 3] {
    let schema = schema();
    let rules = concat!(env!("CARGO_MANIFEST_DIR"), "/src/document/schema-rules.txt");
    [
        (rules.to_owned(), schema::extract(&schema)),
        (format!("{DOCS}/scene.schema.json"), serde_json::to_string_pretty(&schema).unwrap() + "\n"),
        (format!("{DOCS}/scene-format.md"), reference()),
    ]
}

#[test]
fn published_files_are_current() {
    for (path, text) in published() {
        if std::env::var_os("SNELL_BLESS").is_some() {
            std::fs::create_dir_all(DOCS).unwrap();
            std::fs::write(&path, text).unwrap();
        } else {
            let committed = std::fs::read_to_string(&path).unwrap_or_default();
            assert!(committed == text, "{path} is not current: SNELL_BLESS=1 cargo test -p snell-scene");
        }
    }
}

#[test]
fn every_example_of_the_reference_is_a_scene() {
    let reference = reference();
    let mut count = 0;
    for block in reference.split("```toml\n").skip(1) {
        let example = block.split("```").next().unwrap();
        let (scene, diagnostics) = read_scene("example.toml", example.as_bytes(), &MemoryAssets::default(), &[]);
        assert!(scene.is_some(), "{example}\n{:#?}", diagnostics.list);
        count += 1;
    }
    assert!(count >= 15, "only {count} examples were found");
}

/// Every number has a range or is free of one for a reason, a default or is required, and every length says its unit; every
/// key and every type says what it is.
#[test]
fn the_schema_says_everything() {
    let schema = schema();
    assert!(schema["$schema"].is_string());
    let mut keys = 0;
    let definitions = schema["$defs"].as_object().unwrap();
    for (name, definition) in definitions.iter().chain([(&"the root".to_owned(), &schema)]) {
        assert!(definition["description"].is_string(), "{name}");
        let Some(properties) = definition["properties"].as_object() else { continue };
        assert_eq!(definition["additionalProperties"], false, "{name}");
        for (key, property) in properties {
            keys += 1;
            let description = property["description"].as_str().unwrap_or_default();
            assert!(description.ends_with(['.', '…']) && !description.contains('\\'), "{name}.{key}: {description:?}");
            assert!(!property["default"].is_null() || property.get("default").is_none(), "{name}.{key}");
        }
    }
    assert!(keys > 150, "only {keys} keys");
}

#[test]
fn keys_are_unique_and_settable() {
    let keys = keys();
    assert!(keys.iter().all(|key| !key.summary.is_empty() && !key.expected.is_empty()));
    let mut paths: Vec<&str> = keys.iter().map(|key| &*key.path).collect();
    paths.sort_unstable();
    assert!(paths.windows(2).all(|pair| pair[0] != pair[1]));
    for path in ["ambient", "light.NAME.point.falloff.constant", "material.NAME.dielectric.absorption.color"] {
        assert!(paths.contains(&path), "{path}");
    }
}

#[test]
fn the_reference_names_every_function_of_formulas() {
    let reference = reference();
    let list = reference.split("the functions ").nth(1).unwrap().split(", with angles").next().unwrap();
    let named: Vec<&str> = list.split([',', ' ']).filter(|word| !word.is_empty() && *word != "and").collect();
    assert_eq!(named, crate::scene::Expression::function_names().collect::<Vec<_>>());
}

#[test]
fn very_many_mistakes_are_told_in_part_and_in_time() {
    let many = |n: usize, line: &dyn Fn(usize) -> String| (0..n).map(line).collect::<String>();
    let long = "x".repeat(1 << 20);
    let texts = [
        many(20_000, &|i| format!("[[drawing.camera]]\nname = \"c{i}\"\nview = {{}}\n"))
            + &many(20_000, &|_| "[[drawing.line]]\npoints = [[0, 0, 0], [1, 0, 0]]\nproject_to = \"d\"\n".to_owned()),
        many(20_000, &|_| "[[plot]]\nwindow = [0, \"cosh\", 0, \"1/0\"]\n".to_owned()),
        "[camera]\n".to_owned() + &many(50_000, &|i| format!("fovv{i} = 1\n")),
        many(20_000, &|i| format!("[[object]]\nsphere = {{}}\nmaterial = \"m{i}\"\n[material.n{i}]\n")),
        many(20_000, &|_| "[[object]]\nsphere = {}\nscale = 0\n".to_owned()),
        format!(
            "{long} = 1\nambient = \"{long}\"\n[[object]]\nsphere = {{}}\nmaterial = \"{long}\"\n[material.{long}a]\n"
        ),
    ];
    for text in texts {
        let (scene, diagnostics) = read_scene("a.toml", text.as_bytes(), &MemoryAssets::default(), &[]);
        assert!(scene.is_none() && diagnostics.has_errors());
        assert!(diagnostics.list.len() <= MAX_TOLD + 1);
    }
}

fn nested(levels: usize) -> String {
    let open = "{ difference = [".repeat(levels - 1);
    let close = "] }".repeat(levels - 1);
    format!("[[object]]\nunion = [{open}{{ sphere = {{}} }}{close}]\n")
}

/// Runs with half of the stack that threads have by default.
fn on_a_small_stack(test: impl FnOnce() + Send + 'static) {
    std::thread::Builder::new().stack_size(1 << 20).spawn(test).unwrap().join().unwrap();
}

#[test]
fn solids_nest_a_hundred_deep() {
    on_a_small_stack(|| {
        let text = nested(100);
        let (scene, diagnostics) = read_scene("a.toml", text.as_bytes(), &MemoryAssets::default(), &[]);
        assert!(scene.is_some(), "{:?}", diagnostics.list);
    });
}

#[test]
fn what_is_nested_too_deeply_is_refused() {
    on_a_small_stack(|| {
        let dotted = |n: usize| vec!["a"; n].join(".");
        let texts = [
            nested(200),
            nested(100_000),
            format!("a = {}", "[".repeat(1_000_000)),
            format!("a = {}{}", "{a=".repeat(300_000), "}".repeat(300_000)),
            format!("{} = 1", dotted(200_000)),
            format!("[{}]\nb = 1", dotted(200_000)),
            format!("[[{}]]\n", dotted(200)),
            format!("[{}]\n{} = {{ {} = 1 }}\n", dotted(200), dotted(100), dotted(100)),
            "[[a]]\n[[a.a]]\n".to_owned() + &(3..150).map(|n| format!("[[{}]]\n", dotted(n))).collect::<String>(),
        ];
        for text in texts {
            let (scene, diagnostics) = read_scene("a.toml", text.as_bytes(), &MemoryAssets::default(), &[]);
            assert!(scene.is_none());
            assert!(diagnostics.list.len() <= 3, "{:?}", diagnostics.list);
        }
        let json = format!("{{\"a\": {}", "[".repeat(1_000_000));
        assert!(read_scene("a.json", json.as_bytes(), &MemoryAssets::default(), &[]).1.has_errors());
        let sets = [format!("{}=1", dotted(200)), format!("a.{}=[[[[[[]]]]]]", dotted(208)), dotted(100_000) + "=1"];
        let (scene, diagnostics) = read_scene("a.toml", b"", &MemoryAssets::default(), &sets);
        assert!(scene.is_none() && diagnostics.has_errors());
    });
}

#[test]
fn chains_of_names_are_followed_without_recursion() {
    on_a_small_stack(|| {
        let mut text = String::from("[prototype.p0]\nsphere = {}\n");
        for i in 1..3000 {
            text += &format!("[prototype.p{i}]\ninstance = \"p{}\"\n", i - 1);
        }
        text += "[[object]]\ninstance = \"p2999\"\n";
        let (scene, diagnostics) = read_scene("a.toml", text.as_bytes(), &MemoryAssets::default(), &[]);
        assert!(scene.is_none());
        assert!(diagnostics.list[0].message.contains("257 deep"), "{}", diagnostics.list[0].message);
    });
}

//! Planted defects: a small tidy project, one thing broken in it at a time, and what `tidy` must say about that.

use std::fs;

use super::{Problem, Report, Tree, check};

/// A project in a temporary folder in which nothing is wrong.
struct Project {
    folder: tempfile::TempDir,
}

impl Project {
    fn tidy() -> Self {
        let project = Self { folder: tempfile::tempdir().expect("a temporary folder") };
        project.write("Cargo.toml", "[workspace]\nmembers = [\"crates/*\"]\n");
        project.write("CHANGELOG.md", "# Changes\n\n## [Unreleased]\n");
        project.write(
            "README.md",
            "See [the changes](CHANGELOG.md#unreleased), [code](crates) and [web](https://a.org).\n",
        );
        project
            .write("crates/snell-math/Cargo.toml", "[package]\nname = \"snell-math\"\n[dependencies]\nglam = \"1\"\n");
        project.write(
            "crates/snell-math/src/lib.rs",
            "//! Mathematics.\n\n#[allow(dead_code, reason = \"a test\")]\nfn f() {}\n",
        );
        project.write(
            "crates/snell/Cargo.toml",
            "[package]\nname = \"snell\"\n[dependencies]\nsnell-math.workspace = true\n\
             [dev-dependencies]\nsnell-testkit.workspace = true\n",
        );
        project.write("crates/snell/src/lib.rs", "//! The engine.\n\npub mod shape;\n");
        project.write("crates/snell/src/shape/mod.rs", "//! Shapes.\n\nuse crate::math::Point3;\n");
        project.write(
            "crates/snell/src/csg/mod.rs",
            "//! Solids.\n\nuse crate::shape::Hit; // not println!()\n\n\
             #[cfg(test)]\nmod tests {\n    use crate::film::Film;\n    fn t() { println!(\"{}\", std::env::args().count()); }\n}\n",
        );
        project.write("crates/snell/src/shape/triangle_mesh.rs", "//! Meshes.\n\nuse crate::accel::Bvh;\n");
        project.write("crates/snell/tests/whole.rs", "//! From outside.\n\nuse std::fs;\n");
        project.write("scenes/ball.toml", "# Ball\n");
        project.write("goldens/ball.png", "small");
        project.write("target/anything.rs", "not looked at");
        project
    }

    fn write(&self, path: &str, text: impl AsRef<[u8]>) {
        let file = self.folder.path().join(path);
        fs::create_dir_all(file.parent().expect("inside the folder")).expect("folder made");
        fs::write(file, text).expect("file written");
    }

    fn report(&self) -> Report {
        check(&Tree::read(self.folder.path()).expect("readable"))
    }

    /// Breaks one file; `tidy` must name this place and this rule, and nothing else.
    #[track_caller]
    fn plant(&self, path: &str, text: impl AsRef<[u8]>, line: usize, rule: &str) -> String {
        self.write(path, text);
        let problems = self.report().problems;
        match &problems[..] {
            [only] if (only.path.as_str(), only.line, only.rule) == (path, line, rule) => only.message.clone(),
            _ => panic!("planted {path}:{line} [{rule}], but tidy says {problems:#?}"),
        }
    }
}

/// Plants one defect in a project of its own.
#[track_caller]
fn plant(path: &str, text: impl AsRef<[u8]>, line: usize, rule: &str) -> String {
    Project::tidy().plant(path, text, line, rule)
}

#[test]
fn nothing_is_said_of_a_tidy_project() {
    let report = Project::tidy().report();
    assert_eq!(report.problems, Vec::<Problem>::new());
    assert_eq!(report.notes, Vec::<String>::new());
}

#[test]
fn a_file_that_does_not_say_what_it_is() {
    plant("crates/snell-math/src/a.rs", "fn f() {}\n", 1, "first-line");
    plant("crates/snell-math/src/a.rs", "\n//! Late.\n", 1, "first-line");
    plant("crates/snell-math/src/a.rs", "//!\n", 1, "first-line");
    plant("crates/snell-math/src/a.rs", "", 1, "first-line");
}

#[test]
fn a_file_that_is_too_long() {
    let lines = |count: usize| format!("//! Long.\n{}", "\n".repeat(count - 1));
    plant("crates/snell-math/src/a.rs", lines(801), 801, "length");
    let project = Project::tidy();
    project.write("crates/snell-math/src/a.rs", lines(800));
    let report = project.report();
    assert!(report.problems.is_empty() && report.notes.len() == 1, "{report:?}");
    project.write("crates/snell-math/src/a.rs", lines(500));
    assert!(project.report().notes.is_empty());
}

#[test]
fn a_file_that_is_too_big() {
    plant("docs/big.bin", vec![0; (1 << 20) + 1], 1, "size");
    plant("goldens/ball.png", vec![b'x'; (64 << 10) + 1], 1, "size");
    let project = Project::tidy();
    project.write("docs/fits.bin", vec![0; 1 << 20]);
    project.write("docs/words.txt", vec![b'x'; 2 << 20]);
    assert!(project.report().problems.is_empty());
}

#[test]
fn a_scene_without_its_golden() {
    plant("scenes/glass/prism.toml", "# Prism\n", 1, "golden");
    let project = Project::tidy();
    fs::remove_file(project.folder.path().join("goldens/ball.png")).expect("removed");
    assert!(project.report().problems.is_empty(), "without any golden there is nothing to compare with yet");
}

#[test]
fn a_changelog_without_a_place_for_news() {
    plant("CHANGELOG.md", "# Changes\n\n## 0.1.0\n", 1, "changelog");
}

#[test]
fn a_crate_that_knows_too_much() {
    let manifest = |rest: &str| format!("[package]\nname = \"snell-math\"\n\n{rest}");
    let path = "crates/snell-math/Cargo.toml";
    plant(path, manifest("[dependencies]\nglam = \"1\"\nsnell-image.workspace = true\n"), 6, "crates");
    plant(path, manifest("[dependencies]\nimage = { package = \"snell-image\", path = \"..\" }\n"), 5, "crates");
    plant(path, manifest("[target.'cfg(unix)'.dependencies]\nsnell = \"1\"\n"), 5, "crates");
    plant(path, manifest("[build-dependencies.snell-scene]\nworkspace = true\n"), 4, "crates");
    plant(path, manifest("[dependencies]\nsnell-testkit.workspace = true\n"), 5, "crates");
    plant(path, manifest("[dev-dependencies]\nsnell.workspace = true\n"), 5, "crates");
    plant(path, manifest("[dependencies\n"), 4, "crates");
    plant("crates/new/Cargo.toml", "[package]\nname = \"snell-new\"\n", 1, "crates");
}

#[test]
fn a_room_that_knows_too_much() {
    let shape = |rest: &str| format!("//! Shapes.\n\n{rest}\n");
    let path = "crates/snell/src/shape/mod.rs";
    let message = plant(path, shape("use crate::accel::Bvh;"), 3, "rooms");
    assert!(message.contains("`shape` must not know `accel`"), "{message}");
    plant(path, shape("use crate::{\n    math::Point3,\n    film::Film,\n};"), 5, "rooms");
    plant(path, shape("fn f() -> super::light::Light {}"), 3, "rooms");
    plant(path, shape("use crate::Film;"), 3, "rooms");
    plant("crates/snell/src/shape/disc.rs", shape("use super::super::csg::Solid;"), 3, "rooms");
    plant("crates/snell/src/cellar/mod.rs", "//! A new room.\n", 1, "rooms");
}

#[test]
fn a_library_that_touches_the_outside() {
    let planted = [
        "use std::fs::File;",
        "use std::{\n    env,\n};",
        "fn f() { println!(\"a\"); }",
        "fn f() { eprint!(\"a\"); }",
        "fn f() { std::process::exit(1) }",
        "use std::time::Instant;\nfn f() { Instant::now(); }",
        "fn f() { SystemTime::now(); }",
        "fn f() { io::stdout(); }",
        "static mut COUNT: u32 = 0;",
        "fn f() { std::net::TcpStream::connect(\"a\"); }",
    ];
    for code in planted {
        // The place is the last line but for the one whose group goes on.
        let line = if code.contains('\n') { 4 } else { 3 };
        plant("crates/snell-image/src/a.rs", format!("//! A.\n\n{code}\n"), line, "library");
    }
    let project = Project::tidy();
    let innocent =
        "//! A.\n\n// println!()\nfn f() { myprintln!(); writeln!(w, \"println!\"); static_mut(); stdfs::fs::x(); }\n";
    project.write("crates/snell-image/src/a.rs", innocent);
    project.write("crates/snell-cli/src/main.rs", "//! A shell.\n\nfn main() { println!(); }\n");
    assert_eq!(project.report().problems, Vec::new());
}

#[test]
fn a_silenced_lint_without_a_reason() {
    let path = "crates/snell/src/shape/disc.rs";
    plant(path, "//! Disc.\n\n#[allow(dead_code)]\nfn f() {}\n", 3, "reason");
    plant(path, "//! Disc.\n#![expect(clippy::all, unused)]\n", 2, "reason");
    plant(path, "//! Disc.\n\n#[cfg_attr(\n    unix,\n    allow(dead_code)\n)]\nfn f() {}\n", 3, "reason");
    plant(
        path,
        "//! Disc.\n#[cfg(test)]\nmod tests {\n    #[allow(unused)] // reason = \"no\"\n    fn f() {}\n}\n",
        4,
        "reason",
    );
    let project = Project::tidy();
    project.write(path, "//! Disc.\n#[should_panic(expected = \"a\")]\nfn f() {}\n// #[allow(unused)]\n");
    assert_eq!(project.report().problems, Vec::new());
}

#[test]
fn work_that_is_not_finished() {
    for mark in [concat!("TO", "DO"), concat!("FIX", "ME"), concat!("XX", "X")] {
        plant("crates/snell-math/src/a.rs", format!("//! A.\n\n// {mark}: later\n"), 3, "unfinished");
        plant("docs/a.md", format!("# A\n\n({mark})\n"), 3, "unfinished");
        let project = Project::tidy();
        project.write("docs/a.md", format!("# A\n\nA{mark} and {}\n", mark.to_lowercase()));
        project.write("assets/a.obj", mark);
        assert_eq!(project.report().problems, Vec::new());
    }
}

#[test]
fn a_forbidden_word() {
    let project = Project::tidy();
    project.write("docs/a.md", "# Rhubarbs\n\nSome Rhubarb.\n");
    project.write("xtask/forbidden-words.txt", "# none but these\n");
    assert_eq!(project.report().problems, Vec::new());
    project.write("xtask/forbidden-words.txt", "# none but these\nRHUBARB # a plant\n");
    let problems = project.report().problems;
    assert!(matches!(&problems[..], [only] if only.path == "docs/a.md" && only.line == 3), "{problems:?}");
    project.plant("docs/a.md", "# Plants\n\n\nrhubarb\n", 4, "word");
    fs::remove_file(project.folder.path().join("docs/a.md")).expect("removed");
    project.plant("docs/rhubarb.md", "# Plants\n", 1, "word");
}

#[test]
fn a_link_that_leads_nowhere() {
    plant("docs/a.md", "# A\n\n[gone](gone.md)\n", 3, "link");
    plant("docs/a.md", "# A\n![gone](../docs/gone.png \"title\")\n", 2, "link");
    plant("docs/a.md", "[a]\n\n[a]: ../gone.md#part\n", 3, "link");
    plant("docs/a.md", "<img src=\"gone.png\">\n", 1, "link");
    plant("docs/a.md", "[outside](../../outside.md)\n", 1, "link");
    plant("docs/a.md", "[not looked at](../target/anything.rs)\n", 1, "link");
    let project = Project::tidy();
    project.write("docs/a.md", "[up](../README.md) [here](#a) [root](/scenes) [code](../crates/snell/)\n");
    assert_eq!(project.report().problems, Vec::new());
}

//! Built-in scenes: listed, printed, extracted, and the same picture from a copy.

use std::fs;
use std::path::Path;

use crate::support::Folder;

/// The file names in the repository's folder of scenes that end so.
fn repository_scenes() -> Vec<String> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes"));
    let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.filter_map(|name| name.strip_suffix(".toml").map(str::to_owned)).collect();
    names.sort();
    names
}

#[test]
fn all_scenes_of_the_repository_are_listed_with_a_title() {
    let run = Folder::new().good("scenes");
    let names: Vec<&str> = run.text().lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(names, repository_scenes());
    assert!(run.text().lines().all(|line| line.split_whitespace().count() > 1), "{}", run.text());
    assert!(run.stderr.is_empty());
}

#[test]
fn a_scene_is_printed_as_it_is() {
    let text = fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/lens.toml")).unwrap();
    assert_eq!(Folder::new().good("scenes lens").stdout, text);
}

#[test]
fn a_copy_renders_to_the_same_bytes() {
    let folder = Folder::new();
    for (name, files) in
        [("nine-red-balls", vec![]), ("familiar-scene", vec!["images"]), ("kitchen-window", vec!["images"])]
    {
        let copy = folder.path(name);
        let run = folder.good(&format!("scenes {name} --extract {name}"));
        assert!(run.stderr.starts_with("wrote "), "{run:?}");
        for file in files {
            assert!(copy.join(file).is_dir(), "{file}");
        }
        folder.good(&format!("render {name} --width 24 --aa none -o built-in.png"));
        folder.good(&format!("render {name}/{name}.toml --width 24 --aa none -o copy.png"));
        assert!(folder.read("built-in.png") == folder.read("copy.png"), "{name}");
    }
}

#[test]
fn a_changed_copy_is_never_overwritten() {
    let folder = Folder::new();
    folder.good("scenes lens --extract .");
    folder.good("scenes lens --extract .");
    folder.write("lens.toml", "# mine\n");
    let run = folder.run("scenes lens --extract .");
    assert_eq!(run.code, Some(1));
    assert!(run.stderr.contains("there is another file of that name already"), "{run:?}");
    assert_eq!(folder.read("lens.toml"), b"# mine\n");
}

#[test]
fn a_file_comes_before_a_built_in_scene_of_its_name() {
    let folder = Folder::new();
    fs::create_dir(folder.path("lens")).unwrap();
    folder.good("render lens --width 4 --aa none");
    assert_eq!(folder.picture("lens.png").size(), (4, 3));
}

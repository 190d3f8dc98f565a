//! Where pictures go: files of both formats, standard output, and all that is refused before rendering.

use std::fs;

use snell::image::{Limits, decode};

use crate::support::{self, Folder};

#[test]
fn exr_keeps_the_light_and_its_layers() {
    let folder = Folder::new();
    folder.good("render nine-red-balls --width 16 -o plain.exr");
    folder.good("render nine-red-balls --width 16 -o layers.EXR --layers");
    let (plain, layers) = (folder.read("plain.exr"), folder.read("layers.EXR"));
    assert_eq!(decode(&plain, &Limits::default()).unwrap().image, decode(&layers, &Limits::default()).unwrap().image);
    let has = |bytes: &[u8], name: &[u8]| bytes.windows(name.len()).any(|window| window == name);
    for channel in [&b"N.X\0"[..], b"Z\0", b"id\0"] {
        assert!(has(&layers, channel) && !has(&plain[..400.min(plain.len())], channel), "{channel:?}");
    }
}

#[test]
fn a_picture_goes_to_another_program() {
    let folder = Folder::new();
    folder.good("render lens --width 16 --aa none");
    let run = folder.good("render lens --width 16 --aa none -o -");
    assert_eq!(run.stdout, folder.read("lens.png"));
    assert!(run.stderr.starts_with("wrote a PNG to standard output (16x12, "), "{run:?}");
    assert_eq!(folder.names(), ["lens.png"]);
}

#[test]
fn a_picture_that_is_there_is_replaced() {
    let folder = Folder::new();
    folder.write("a.png", "old");
    folder.good("render lens --width 4 --aa none -o a.png");
    assert_eq!(folder.picture("a.png").size(), (4, 3));
    assert_eq!(folder.names(), ["a.png"]);
}

#[test]
fn what_cannot_be_written_is_refused_before_rendering() {
    let folder = Folder::new();
    fs::create_dir(folder.path("folder.png")).unwrap();
    folder.write("file", "");
    // At this size, rendering would take minutes.
    for (output, code, message) in [
        ("a.gif", 2, "error: the ending of \"a.gif\" says no format that can be written\nhelp: end it with .png"),
        ("a", 2, "error: the ending of \"a\" says no format"),
        ("no/a.png", 1, "error: the picture \"no/a.png\" cannot be written: there is no folder \"no\"\n"),
        ("folder.png", 1, "error: the picture \"folder.png\" cannot be written: it is a folder\n"),
        ("file/a.png", 1, "error: the picture \"file/a.png\" cannot be written: "),
        ("a.png --layers", 2, "error: --layers needs an .exr file"),
        ("a.exr --bits 16", 2, "error: --bits is for PNG"),
        ("- --json", 2, "error: standard output cannot have both"),
        ("- --preview", 2, "error: standard output cannot have both"),
        ("a.png --preview", 2, "error: --preview needs a terminal, and standard output is none\n"),
        ("a.png --height 65536", 2, "error: a picture of 65536x65536 pixels is too large"),
    ] {
        let run = folder.run(&format!("render nine-red-balls --width 65536 --aa 64 -o {output}"));
        assert_eq!(run.code, Some(code), "{run:?}");
        assert!(run.stderr.starts_with(message), "{run:?}");
        assert!(run.stdout.is_empty());
    }
    assert_eq!(folder.names(), ["file", "folder.png"]);
}

#[cfg(unix)]
#[test]
fn protected_folders_and_files_are_respected() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    let protect = |name: &str, mode: u32| {
        fs::set_permissions(folder.path(name), fs::Permissions::from_mode(mode)).unwrap();
    };
    folder.write("kept.png", "kept");
    protect("kept.png", 0o444);
    let run = folder.run("render lens --width 4 -o kept.png");
    assert_eq!(run.code, Some(1));
    assert!(run.stderr.contains("the file is there already and write-protected"), "{run:?}");
    assert_eq!(folder.read("kept.png"), b"kept");

    fs::create_dir(folder.path("locked")).unwrap();
    protect("locked", 0o555);
    if support::is_almighty(&folder.path("locked")) {
        eprintln!("skipped: this user may write everywhere");
    } else {
        let run = folder.run("render lens --width 4 -o locked/a.png");
        assert_eq!(run.code, Some(1));
        assert!(run.stderr.contains("no file can be made in the folder \"locked\": permission denied"), "{run:?}");
    }
    protect("locked", 0o755);
}

#[test]
fn a_scene_does_not_overwrite_its_own_pictures() {
    let folder = Folder::new();
    folder.good("render nine-red-balls --width 4 --aa none -o sky.png");
    let before = folder.read("sky.png");
    folder.write("sky.toml", "[background]\nphotograph = { file = \"sky.png\" }\n[[object]]\nsphere = {}\n");
    let run = folder.run("render sky.toml");
    assert_eq!(run.code, Some(1), "{run:?}");
    assert!(run.stderr.contains("the scene itself uses that file\nhelp: choose another name with -o"), "{run:?}");
    assert_eq!(folder.read("sky.png"), before);
    folder.good("render sky.toml --width 8 --aa none -o other.png");
}

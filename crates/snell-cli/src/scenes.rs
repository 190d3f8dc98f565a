//! `snell scenes`: the built-in scenes, listed, printed, or copied to a folder with all that they need.

use std::fs::{self, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::Path;

use snell::scene::{Diagnostic, document};

use crate::arguments::ScenesArguments;
use crate::builtin::{self, BuiltinAssets, BuiltinScene};
use crate::console::{quoted, reason, say, write_stdout};
use crate::failure::{FINE, Failure};
use crate::load::Place;

/// Lists, prints or extracts.
pub fn run(arguments: &ScenesArguments) -> Result<u8, Failure> {
    match (&arguments.name, &arguments.extract) {
        (None, _) => write_stdout(list().as_bytes())?,
        (Some(name), None) => write_stdout(find(name)?.text.as_bytes())?,
        (Some(name), Some(folder)) => extract(find(name)?, folder)?,
    }
    Ok(FINE)
}

fn find(name: &str) -> Result<BuiltinScene, Failure> {
    // A file of that name is not meant here, but what resembles the name is.
    builtin::find(name).map_or_else(
        || match Place::find(name) {
            Err(failure) => Err(failure),
            Ok(_) => Err(Failure::input(
                Diagnostic::error(format!("{} is a file, not a built-in scene", quoted(name)))
                    .help("`snell scenes` lists the built-in scenes"),
            )),
        },
        Ok,
    )
}

/// Name and title, a scene in each line.
fn list() -> String {
    let width = builtin::all().map(|scene| scene.name.len()).max().unwrap_or(0);
    builtin::all().map(|scene| format!("{:width$}  {}\n", scene.name, scene.title())).collect()
}

/// Writes the scene and the files that it names, and never over a file that is there.
fn extract(scene: BuiltinScene, folder: &Path) -> Result<(), Failure> {
    // Reading the scene tells which files it names.
    let assets = BuiltinAssets::default();
    let _ = document::read_scene(&scene.source_name(), scene.text.as_bytes(), &assets, &[]);
    let name = format!("{}.toml", scene.name);
    write_new(&folder.join(&name), scene.text.as_bytes())?;
    for (path, bytes) in assets.files_read() {
        write_new(&folder.join(path), bytes)?;
    }
    let path = folder.join(name);
    let shown = path.display();
    say(format_args!("wrote {shown}; edit it, then: snell render {shown}"));
    Ok(())
}

/// Makes a file, and its folders where they are missing. One with the same content may be there already.
fn write_new(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let wrong = |problem: String| {
        Failure::input(Diagnostic::error(format!("{} cannot be written: {problem}", quoted(&path.to_string_lossy()))))
    };
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|error| wrong(reason(&error)))?;
    }
    match OpenOptions::new().write(true).create_new(true).open(path) {
        Ok(mut file) => file.write_all(bytes).map_err(|error| wrong(reason(&error))),
        Err(error) if error.kind() == ErrorKind::AlreadyExists => match fs::read(path) {
            Ok(there) if there == bytes => Ok(()),
            _ => Err(wrong("there is another file of that name already".to_owned())),
        },
        Err(error) => Err(wrong(reason(&error))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_line_begins_with_a_name() {
        let list = list();
        let names: Vec<&str> = list.lines().filter_map(|line| line.split_whitespace().next()).collect();
        assert_eq!(names, builtin::all().map(|scene| scene.name).collect::<Vec<_>>());
        assert!(list.contains("  Nine red balls\n"));
    }

    #[test]
    fn what_is_there_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a/b.toml");
        write_new(&path, b"one").unwrap();
        write_new(&path, b"one").unwrap();
        assert!(write_new(&path, b"two").is_err());
        assert_eq!(fs::read(&path).unwrap(), b"one");
    }
}

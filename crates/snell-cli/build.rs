//! Lists the built-in scenes for `builtin.rs`: every scene of the folder `scenes`, and every file in its subfolders.
//!
//! `scenes` in this crate's folder is a symbolic link to the workspace's; packaging the crate puts the files themselves in its
//! place. Where links are not checked out as such, the workspace's folder is found directly.

use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn Error>> {
    let package = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").ok_or("cargo names the package's folder")?);
    let candidates = [package.join("scenes"), package.join("../../scenes")];
    let folder = candidates.iter().find(|folder| folder.is_dir()).ok_or("there is no folder `scenes`")?;
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={}", folder.display());

    let (mut scenes, mut assets) = (Vec::new(), Vec::new());
    for path in entries(folder)? {
        if path.is_dir() {
            files_below(&path, &mut assets)?;
        } else if path.extension().is_some_and(|extension| extension == "toml") {
            scenes.push(path);
        }
    }

    let mut code = String::from("pub const SCENES: &[(&str, &str)] = &[\n");
    for path in &scenes {
        let name = path.file_stem().and_then(|stem| stem.to_str()).ok_or("a scene's name is not UTF-8")?;
        writeln!(code, "    ({name:?}, include_str!({:?})),", absolute(path)?)?;
    }
    code += "];\npub const ASSETS: &[(&str, &[u8])] = &[\n";
    for path in &assets {
        // Under the name by which a scene beside the folder calls it.
        let parts: Option<Vec<&str>> = path.strip_prefix(folder)?.iter().map(|part| part.to_str()).collect();
        let name = parts.ok_or("a file's name is not UTF-8")?.join("/");
        writeln!(code, "    ({name:?}, include_bytes!({:?})),", absolute(path)?)?;
    }
    code += "];\n";
    let out = PathBuf::from(std::env::var_os("OUT_DIR").ok_or("cargo names a folder for the result")?);
    fs::write(out.join("builtin.rs"), code)?;
    Ok(())
}

/// What is in a folder, by name, so that the same files give the same program.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut paths = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>, std::io::Error>>()?;
    paths.sort();
    Ok(paths)
}

/// The files in a folder and below it, but for the pages that describe them.
fn files_below(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), Box<dyn Error>> {
    for path in entries(folder)? {
        if path.is_dir() {
            files_below(&path, files)?;
        } else if path.extension().is_none_or(|extension| extension != "md") {
            files.push(path);
        }
    }
    Ok(())
}

fn absolute(path: &Path) -> Result<String, Box<dyn Error>> {
    Ok(std::path::absolute(path)?.to_str().ok_or("a path is not UTF-8")?.to_owned())
}

//! The bytes of a scene's files from the disk: never from a network, and never more than a limit.

use std::fs::{self, File};
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use snell::scene::{AssetError, Assets};

use crate::console::reason;

/// The largest file that is read; bytes.
const LIMIT: u64 = 4 << 30;
/// How many files of a folder are looked at for "did you mean".
const NAMES: usize = 4096;

/// Files on disk; it remembers which were read.
#[derive(Debug, Default)]
pub struct FileAssets {
    read: Mutex<Vec<PathBuf>>,
}

impl FileAssets {
    /// The whole content of the file that the command line names, which may also be a pipe.
    pub fn read_named(&self, path: &str) -> Result<Arc<[u8]>, AssetError> {
        self.read_any(path, LIMIT)
    }

    /// Whether a path leads to a file that was read.
    pub fn has_read(&self, path: &Path) -> bool {
        let Ok(path) = fs::canonicalize(path) else { return false };
        let read = self.read.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        read.iter().any(|read| fs::canonicalize(read).is_ok_and(|read| read == path))
    }

    fn read_any(&self, path: &str, limit: u64) -> Result<Arc<[u8]>, AssetError> {
        let unreadable = |error: std::io::Error| match error.kind() {
            ErrorKind::NotFound => AssetError::NotFound,
            _ => AssetError::Unreadable(reason(&error)),
        };
        let file = File::open(path).map_err(unreadable)?;
        let metadata = file.metadata().map_err(unreadable)?;
        if metadata.is_dir() {
            return Err(AssetError::Unreadable("it is a folder".to_owned()));
        }
        if metadata.len() > limit {
            return Err(AssetError::TooLarge { size: metadata.len(), limit });
        }
        // What is no regular file, or grows meanwhile, may have more than was said.
        let bytes = content(file.take(limit + 1), metadata.len() as usize).map_err(unreadable)?;
        if bytes.len() as u64 > limit {
            return Err(AssetError::TooLarge { size: bytes.len() as u64, limit });
        }
        self.read.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push(PathBuf::from(path));
        Ok(bytes)
    }
}

/// All that a source gives, which is said to be so many bytes: read right to where it stays, unless that is wrong.
fn content(mut source: impl Read, expected: usize) -> std::io::Result<Arc<[u8]>> {
    let mut bytes: Arc<[u8]> = std::iter::repeat_n(0, expected).collect();
    let mut read = 0;
    if let Some(place) = Arc::get_mut(&mut bytes) {
        while read < expected {
            match source.read(&mut place[read..]) {
                Ok(0) => break,
                Ok(count) => read += count,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
    }
    let mut more = Vec::new();
    source.read_to_end(&mut more)?;
    if read == expected && more.is_empty() { Ok(bytes) } else { Ok([&bytes[..read], &more].concat().into()) }
}

impl Assets for FileAssets {
    fn read(&self, resolved: &str) -> Result<Arc<[u8]>, AssetError> {
        // A pipe or a device named by a scene could keep us waiting for ever.
        if fs::metadata(resolved).is_ok_and(|metadata| !metadata.is_file() && !metadata.is_dir()) {
            return Err(AssetError::Unreadable("it is no regular file".to_owned()));
        }
        self.read_any(resolved, LIMIT)
    }

    fn similar(&self, resolved: &str) -> Vec<String> {
        let folder = resolved.rsplit_once('/').map_or("", |(folder, _)| folder);
        let prefix = if resolved.contains('/') { format!("{folder}/") } else { String::new() };
        let names = files_in(Path::new(if prefix.is_empty() { "." } else { &prefix }));
        names.into_iter().map(|name| prefix.clone() + &name).collect()
    }
}

/// The names of the files in a folder, in order; none where it cannot be read.
pub fn files_in(folder: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let is_file = |entry: &fs::DirEntry| fs::metadata(entry.path()).is_ok_and(|metadata| metadata.is_file());
    let entries = entries.filter_map(Result::ok).take(NAMES).filter(is_file);
    let mut names: Vec<String> = entries.filter_map(|entry| entry.file_name().into_string().ok()).collect();
    names.sort();
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_read_and_remembered() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bin");
        fs::write(&path, b"hello").unwrap();
        let assets = FileAssets::default();
        assert!(!assets.has_read(&path));
        assert_eq!(&*assets.read(path.to_str().unwrap()).unwrap(), b"hello");
        assert!(assets.has_read(&folder.path().join(".").join("a.bin")));
        assert!(!assets.has_read(&folder.path().join("b.bin")));
    }

    #[test]
    fn all_is_read_whatever_length_was_promised() {
        let bytes: Vec<u8> = (0..100).collect();
        for expected in [0, 1, 99, 100, 101, 5000] {
            assert_eq!(&*content(bytes.as_slice(), expected).unwrap(), bytes, "{expected}");
        }
        assert!(content([].as_slice(), 10).unwrap().is_empty());
    }

    #[test]
    fn what_cannot_be_read_is_said_in_words() {
        let folder = tempfile::tempdir().unwrap();
        let name = |file: &str| folder.path().join(file).to_str().unwrap().replace('\\', "/");
        fs::write(name("long.bin"), [0; 9]).unwrap();
        fs::write(name("long.txt"), b"").unwrap();
        let assets = FileAssets::default();
        assert_eq!(assets.read(&name("lonk.bin")), Err(AssetError::NotFound));
        assert_eq!(assets.read(&name("")), Err(AssetError::Unreadable("it is a folder".to_owned())));
        assert_eq!(assets.read_any(&name("long.bin"), 8), Err(AssetError::TooLarge { size: 9, limit: 8 }));
        assert_eq!(assets.similar(&name("lonk.bin")), [name("long.bin"), name("long.txt")]);
        assert!(assets.similar(&name("no/such/folder.png")).is_empty());
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_no_pictures() {
        let assets = FileAssets::default();
        assert_eq!(assets.read("/dev/zero"), Err(AssetError::Unreadable("it is no regular file".to_owned())));
    }
}

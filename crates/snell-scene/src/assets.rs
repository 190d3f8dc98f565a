//! The one door through which readers get bytes: they never open a file themselves.

use std::sync::Arc;

/// Where the bytes of a scene's files come from: a folder on disk in the command, memory in tests, a browser's uploads.
///
/// Paths are as written in the scene, with `/` between parts, relative to the file that names them. `base` is the path of
/// that naming file (empty for a scene that came from no file), so an implementation can resolve one against the other.
pub trait Assets: Sync {
    /// The path under which a file named `path` inside the file `base` is known: joined and normalised. The result is what
    /// [`Assets::read`] takes, what diagnostics show, and the `base` for files named in turn by that file.
    fn resolve(&self, base: &str, path: &str) -> String {
        let absolute = path.starts_with('/') || path.get(1..3).is_some_and(|p| p == ":/" || p == ":\\");
        let folder = if absolute { "" } else { base.rsplit_once('/').map_or("", |(folder, _)| folder) };
        let joined = if folder.is_empty() && !base.starts_with('/') || absolute {
            path.replace('\\', "/")
        } else {
            format!("{folder}/{}", path.replace('\\', "/"))
        };
        let mut parts: Vec<&str> = Vec::new();
        for part in joined.split('/') {
            match part {
                "." => {}
                ".." if parts.last().is_some_and(|p| !p.is_empty() && *p != "..") => {
                    parts.pop();
                }
                part => parts.push(part),
            }
        }
        parts.join("/")
    }

    /// The whole content of a resolved path.
    ///
    /// # Errors
    /// [`AssetError`], whose text says why in words for the author of the scene.
    fn read(&self, resolved: &str) -> Result<Arc<[u8]>, AssetError>;

    /// Names of files near a resolved path that does not exist, to say "did you mean" with; none by default.
    fn similar(&self, resolved: &str) -> Vec<String> {
        let _ = resolved;
        Vec::new()
    }
}

/// Why a file could not be had.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AssetError {
    /// There is nothing under that path.
    #[error("there is no such file")]
    NotFound,
    /// It is there, but it cannot be read: permissions, a folder, a failing disk.
    #[error("it cannot be read: {0}")]
    Unreadable(String),
    /// It is larger than the limit on one file.
    #[error("it is {size} bytes, more than the limit of {limit}")]
    TooLarge {
        /// Its size in bytes.
        size: u64,
        /// The limit in bytes.
        limit: u64,
    },
}

/// Assets held in memory, by resolved path: for tests, examples and scenes that need no file.
///
/// ```
/// use snell_scene::assets::{Assets, MemoryAssets};
/// let assets = MemoryAssets::default().with("scenes/a.txt", b"hello");
/// let path = assets.resolve("scenes/b.toml", "./a.txt");
/// assert_eq!(&*assets.read(&path).unwrap(), b"hello");
/// ```
#[derive(Clone, Debug, Default)]
pub struct MemoryAssets {
    files: std::collections::BTreeMap<String, Arc<[u8]>>,
}

impl MemoryAssets {
    /// Adds a file.
    #[must_use]
    pub fn with(mut self, path: &str, bytes: &[u8]) -> Self {
        self.files.insert(path.to_owned(), bytes.into());
        self
    }
}

impl Assets for MemoryAssets {
    fn read(&self, resolved: &str) -> Result<Arc<[u8]>, AssetError> {
        self.files.get(resolved).cloned().ok_or(AssetError::NotFound)
    }

    fn similar(&self, _resolved: &str) -> Vec<String> {
        self.files.keys().cloned().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_resolve_against_the_file_that_names_them() {
        let a = MemoryAssets::default();
        for (base, path, resolved) in [
            ("", "x.png", "x.png"),
            ("s.toml", "x.png", "x.png"),
            ("dir/s.toml", "x.png", "dir/x.png"),
            ("dir/s.toml", "../x.png", "x.png"),
            ("dir/s.toml", "./m/../x.png", "dir/x.png"),
            ("../dir/s.toml", "../../x.png", "../../x.png"),
            ("/a/b/s.toml", "c/x.png", "/a/b/c/x.png"),
            ("/a/b/s.toml", "/x.png", "/x.png"),
            ("/s.toml", "x.png", "/x.png"),
            ("dir/s.toml", "m\\x.png", "dir/m/x.png"),
        ] {
            assert_eq!(a.resolve(base, path), resolved, "{path} in {base}");
        }
    }
}

//! Lenses by name: what `lens = "double-gauss"` in a camera means. Each is a lens file as an author may write one, with its source in it.

/// A lens that is built in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuiltinLens {
    /// What it is called.
    pub name: &'static str,
    /// Its file, TOML.
    pub text: &'static str,
}

macro_rules! lenses {
    ($($name:literal),+ $(,)?) => {
        [$(BuiltinLens { name: $name, text: include_str!(concat!($name, ".toml")) }),+]
    };
}

static LENSES: [BuiltinLens; 4] = lenses!["achromat", "cooke-triplet", "double-gauss", "singlet"];

/// All of them, by name.
///
/// ```
/// use snell_scene::lenses;
/// let names: Vec<&str> = lenses::all().map(|lens| lens.name).collect();
/// assert_eq!(names, ["achromat", "cooke-triplet", "double-gauss", "singlet"]);
/// ```
pub fn all() -> impl Iterator<Item = BuiltinLens> {
    LENSES.iter().copied()
}

/// The one of that name.
pub fn find(name: &str) -> Option<BuiltinLens> {
    all().find(|lens| lens.name == name)
}

/// True where a name is that of a file: it ends with `.toml`.
pub fn is_lens_file(name: &str) -> bool {
    name.get(name.len().saturating_sub(5)..).is_some_and(|end| end.eq_ignore_ascii_case(".toml"))
}

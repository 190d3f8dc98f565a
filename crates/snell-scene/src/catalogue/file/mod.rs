//! Files of glasses: Zemax's catalogues (`.agf`) and pages of the refractiveindex.info database (`.yml`).
//!
//! Neither reader panics, hangs, or makes more of a file than is in it. A glass that is wrong is left out and told, with its
//! line; the others are given.

mod agf;
mod page;

#[cfg(test)]
mod tests;

use super::Glass;

/// What a file of glasses has.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GlassFile {
    /// The glasses, in the order of the file.
    pub glasses: Vec<Glass>,
    /// What is wrong with others.
    pub problems: Vec<GlassProblem>,
}

/// Why a glass of a file is left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GlassProblem {
    /// The glass; empty where it is the file as a whole.
    pub glass: String,
    /// The line, from 1.
    pub line: usize,
    /// What is wrong: one line, lower case, no full stop.
    pub message: String,
}

/// True where a name is that of a file of glasses, and not of a glass: by its ending, `#` and what follows it left out.
///
/// ```
/// use snell_scene::catalogue::is_glass_file;
/// assert!(is_glass_file("hoya.agf#FCD1") && is_glass_file("Malitson.yml"));
/// assert!(!is_glass_file("N-BK7"));
/// ```
pub fn is_glass_file(name: &str) -> bool {
    kind(split(name).0).is_some()
}

/// A name's file, and the glass of it that is meant after a `#`.
pub(crate) fn split(name: &str) -> (&str, Option<&str>) {
    match name.rsplit_once('#') {
        Some((file, glass)) if kind(file).is_some() => (file, Some(glass)),
        _ => (name, None),
    }
}

#[derive(Clone, Copy)]
enum Kind {
    Agf,
    Page,
}

fn kind(file: &str) -> Option<Kind> {
    let (_, ending) = file.rsplit_once('.')?;
    match ending.to_ascii_lowercase().as_str() {
        "agf" => Some(Kind::Agf),
        "yml" | "yaml" => Some(Kind::Page),
        _ => None,
    }
}

/// Reads a file of glasses; its name's ending says of which kind. A page's glass is called like its file.
///
/// ```
/// use snell_scene::catalogue::read_glass_file;
/// let text = b"CC a catalogue\nNM CROWN 2 517642 1.5168 64.17 0 1\nCD 1.03961212 0.00600069867 0.231792344 \
///              0.0200179144 1.01046945 103.560653\nLD 0.31 2.325\n";
/// let file = read_glass_file("small.agf", text);
/// assert!((file.glasses[0].dispersion.index(587.5618) - 1.5168).abs() < 1e-6);
/// ```
pub fn read_glass_file(name: &str, bytes: &[u8]) -> GlassFile {
    let text = decoded(bytes);
    let file = match kind(name) {
        Some(Kind::Agf) => agf::read(&text),
        Some(Kind::Page) => {
            let last = name.rsplit('/').next().unwrap_or(name);
            page::read(last.rsplit_once('.').map_or(last, |(stem, _)| stem), &text)
        }
        None => {
            let message = "the file's ending says no format of glasses: .agf, .yml".to_owned();
            return GlassFile {
                problems: vec![GlassProblem { glass: String::new(), line: 1, message }],
                ..GlassFile::default()
            };
        }
    };
    let mut file = file;
    if file.glasses.is_empty() && file.problems.is_empty() {
        let message = "there is no glass in this file".to_owned();
        file.problems.push(GlassProblem { glass: String::new(), line: 1, message });
    }
    file
}

/// The text of a file: UTF-8, or UTF-16 with its mark, as some of Zemax's are.
fn decoded(bytes: &[u8]) -> String {
    let wide = |bytes: &[u8], unit: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]])).collect();
        String::from_utf16_lossy(&units)
    };
    match bytes {
        [0xff, 0xfe, rest @ ..] => wide(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => wide(rest, u16::from_be_bytes),
        [0xef, 0xbb, 0xbf, rest @ ..] => String::from_utf8_lossy(rest).into_owned(),
        _ => String::from_utf8_lossy(bytes).into_owned(),
    }
}

/// The numbers of a line, or which word is none.
fn numbers<'w>(words: impl Iterator<Item = &'w str>) -> Result<Vec<f64>, String> {
    words
        .map(|word| match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(format!("{:?} is no finite number", word.chars().take(32).collect::<String>())),
        })
        .collect()
}

/// Micrometres as nanometres, without the rounding of a millionth.
fn nanometres(micrometres: f64) -> f64 {
    (micrometres * 1e9).round() / 1e6
}

/// A range of wavelengths in nanometres, or what is wrong with it.
fn range_nm(micrometres: &[f64]) -> Result<[f64; 2], String> {
    match *micrometres {
        [low, high] if 0.0 < low && low <= high => Ok([nanometres(low), nanometres(high)]),
        _ => Err("a range of wavelengths needs two ascending numbers in micrometres".to_owned()),
    }
}

//! MTL, Wavefront's material libraries: the statements, as they stand.
//!
//! After Wavefront's "MTL material format" (1995), with `Ke`, `Kt` and the texture options that exporters write.

use std::ops::Range;

use snell_math::Rgb;

use crate::diagnostic::{Diagnostic, did_you_mean};
use crate::reader::report::{Report, quoted};
use crate::reader::text::{Lines, Word, Words, parse_float, text_start};

/// One material as its statements give it; what they leave out is absent.
#[derive(Clone, Debug, Default)]
pub(super) struct Statements {
    pub name: Vec<u8>,
    /// Where it begins.
    pub range: Range<usize>,
    pub ambient: Option<Rgb>,
    pub diffuse: Option<Rgb>,
    pub specular: Option<Rgb>,
    pub emission: Option<Rgb>,
    /// The transmission filter, Tf.
    pub transmission: Option<Rgb>,
    /// The exponent of the highlight, Ns.
    pub shininess: Option<f64>,
    /// The index of refraction, Ni.
    pub ior: Option<f64>,
    /// How opaque it is: d, or 1 − Tr.
    pub opacity: Option<f64>,
    /// The number of the illumination model.
    pub illum: Option<u32>,
    pub ambient_map: Option<Map>,
    pub diffuse_map: Option<Map>,
    pub specular_map: Option<Map>,
    pub emission_map: Option<Map>,
}

/// A picture in place of a colour.
#[derive(Clone, Debug)]
pub(super) struct Map {
    pub path: String,
    /// Where the library names it.
    pub range: Range<usize>,
    pub clamp: bool,
    pub scale: [f64; 2],
    pub offset: [f64; 2],
}

/// Statements known to others that change nothing here.
const IGNORED: [&[u8]; 18] = [
    b"sharpness",
    b"Pr",
    b"Pm",
    b"Ps",
    b"Pc",
    b"Pcr",
    b"Kp",
    b"Km",
    b"aniso",
    b"anisor",
    b"map_aat",
    b"map_Pr",
    b"map_Pm",
    b"map_Ps",
    b"map_Ns",
    b"map_NS",
    b"Pns",
    b"Nt",
];
/// Maps that would change the picture, told and left out.
const UNUSED_MAPS: [&[u8]; 14] = [
    b"map_d",
    b"map_bump",
    b"map_Bump",
    b"bump",
    b"Bump",
    b"norm",
    b"disp",
    b"decal",
    b"refl",
    b"map_refl",
    b"map_Tr",
    b"map_Disp",
    b"map_Kn",
    b"map_norm",
];
const KNOWN: [&str; 16] = [
    "newmtl", "Ka", "Kd", "Ks", "Ke", "Kt", "Tf", "Ns", "Ni", "d", "Tr", "illum", "map_Ka", "map_Kd", "map_Ks",
    "map_Ke",
];

/// Reads a library and hands over each material once its last statement is read.
pub(super) fn read<'a>(report: &mut Report<'a>, mut take: impl FnMut(&mut Report<'a>, &Statements)) {
    let bytes = report.bytes;
    let start = match text_start(bytes) {
        Ok(start) => start,
        Err(encoding) => {
            let help = "save it as UTF-8 or plain ASCII";
            report.whole("encodings", || Diagnostic::error(format!("this file is text in {encoding}")).help(help));
            return;
        }
    };
    let mut material: Option<Statements> = None;
    let mut lines = Lines::new(bytes, start, true);
    while let Some(line) = lines.next_line() {
        let mut words = Words::new(bytes, line);
        let Some(keyword) = words.next() else { continue };
        if keyword.text[0] == b'#' {
            continue;
        }
        if keyword.text == b"newmtl" {
            let name = words.rest().text.to_vec();
            let next = Statements { name, range: keyword.range(), ..Statements::default() };
            if let Some(complete) = material.replace(next) {
                take(report, &complete);
            }
        } else if let Some(material) = &mut material {
            statement(report, material, keyword, words);
        } else {
            report.at(keyword.range(), "statements before the first material", || {
                Diagnostic::warning("a statement before the first `newmtl` is left out")
            });
        }
    }
    if let Some(complete) = material {
        take(report, &complete);
    }
}

fn statement(report: &mut Report<'_>, material: &mut Statements, keyword: Word<'_>, words: Words<'_>) {
    match keyword.text {
        b"Ka" => set(&mut material.ambient, color(report, keyword, words)),
        b"Kd" => set(&mut material.diffuse, color(report, keyword, words)),
        b"Ks" => set(&mut material.specular, color(report, keyword, words)),
        b"Ke" => set(&mut material.emission, color(report, keyword, words)),
        b"Tf" | b"Kt" => set(&mut material.transmission, color(report, keyword, words)),
        b"Ns" => set(&mut material.shininess, number(report, keyword, words, 0.0..=1e6)),
        b"Ni" => set(&mut material.ior, number(report, keyword, words, 0.0..=100.0)),
        b"d" => set(&mut material.opacity, number(report, keyword, words, 0.0..=1.0)),
        b"Tr" => {
            if material.opacity.is_none() {
                set(&mut material.opacity, number(report, keyword, words, 0.0..=1.0).map(|t| 1.0 - t));
            }
        }
        b"illum" => set(&mut material.illum, number(report, keyword, words, 0.0..=10.0).map(|n| n as u32)),
        b"map_Ka" => set(&mut material.ambient_map, map(report, keyword, words)),
        b"map_Kd" => set(&mut material.diffuse_map, map(report, keyword, words)),
        b"map_Ks" => set(&mut material.specular_map, map(report, keyword, words)),
        b"map_Ke" => set(&mut material.emission_map, map(report, keyword, words)),
        known if IGNORED.contains(&known) => {}
        known if UNUSED_MAPS.contains(&known) => report.at(keyword.range(), "maps that are not used", || {
            Diagnostic::warning(format!("{} is not used: the picture is left out", quoted(known)))
        }),
        unknown => report.at(keyword.range(), "unknown statements", || {
            let warning = Diagnostic::warning(format!("unknown word {}: this line is left out", quoted(unknown)));
            match std::str::from_utf8(unknown).ok().and_then(|word| did_you_mean(word, KNOWN)) {
                Some(near) => warning.help(format!("did you mean `{near}`?")),
                None => warning,
            }
        }),
    }
}

/// Keeps what was there where nothing better came.
fn set<T>(field: &mut Option<T>, value: Option<T>) {
    if value.is_some() {
        *field = value;
    }
}

/// One or three numbers, scene-linear, not negative.
fn color(report: &mut Report<'_>, keyword: Word<'_>, mut words: Words<'_>) -> Option<Rgb> {
    let ahead = words.clone().next();
    if let Some(word) = ahead.filter(|w| matches!(w.text, b"spectral" | b"xyz")) {
        report.at(word.range(), "colours that are not RGB", || {
            Diagnostic::warning(format!("colours given by {} are not read: this line is left out", quoted(word.text)))
        });
        return None;
    }
    let mut values = [0.0; 3];
    let mut read = 0;
    for value in &mut values {
        let Some(word) = words.next().filter(|w| w.text[0] != b'#') else { break };
        *value = checked(report, word, 0.0..=f64::from(f32::MAX))? as f32;
        read += 1;
    }
    match read {
        0 => {
            nothing(report, keyword);
            None
        }
        3 => Some(Rgb::from(values)),
        _ => Some(Rgb::gray(values[0])),
    }
}

/// The last number of the line: `d -halo 0.5` has an option before it.
fn number(
    report: &mut Report<'_>,
    keyword: Word<'_>,
    words: Words<'_>,
    range: std::ops::RangeInclusive<f64>,
) -> Option<f64> {
    let Some(word) = words.filter(|w| w.text != b"-halo").take_while(|w| w.text[0] != b'#').last() else {
        nothing(report, keyword);
        return None;
    };
    checked(report, word, range)
}

fn nothing(report: &mut Report<'_>, keyword: Word<'_>) {
    report.at(keyword.range(), "statements without a number", || {
        Diagnostic::error(format!("{} needs a number", quoted(keyword.text)))
    });
}

/// A finite number; one outside the range is clamped, with a warning.
fn checked(report: &mut Report<'_>, word: Word<'_>, range: std::ops::RangeInclusive<f64>) -> Option<f64> {
    let Some(value) = parse_float(word.text).filter(|v| v.is_finite()) else {
        report.at(word.range(), "words that are no numbers", || {
            Diagnostic::error(format!("{} is no finite number", quoted(word.text)))
        });
        return None;
    };
    let clamped = value.clamp(*range.start(), *range.end());
    if clamped != value {
        report.at(word.range(), "numbers out of range", || {
            Diagnostic::warning(format!("{value} is out of range: {clamped} is taken"))
        });
    }
    Some(clamped)
}

/// Options, then the name of a picture, which may hold spaces. Options after the name are understood as well.
fn map(report: &mut Report<'_>, keyword: Word<'_>, mut words: Words<'_>) -> Option<Map> {
    let mut map = Map { path: String::new(), range: keyword.range(), clamp: false, scale: [1.0; 2], offset: [0.0; 2] };
    let bytes = report.bytes;
    let mut name: Option<Range<usize>> = None;
    while let Some(word) = words.next() {
        let parameters = match word.text {
            b"-s" => {
                triple(&mut words, &mut map.scale, 1.0);
                0
            }
            b"-o" => {
                triple(&mut words, &mut map.offset, 0.0);
                0
            }
            b"-t" => {
                triple(&mut words, &mut [0.0; 2], 0.0);
                0
            }
            b"-clamp" => {
                map.clamp = words.next().is_some_and(|w| w.text == b"on");
                0
            }
            b"-blendu" | b"-blendv" | b"-boost" | b"-texres" | b"-cc" | b"-bm" | b"-imfchan" | b"-type"
            | b"-colorspace" => 1,
            b"-mm" => 2,
            _ => {
                // What stands between two words of the name belongs to it.
                name = Some(name.map_or(word.range(), |n| n.start..word.range().end));
                0
            }
        };
        for _ in 0..parameters {
            words.next();
        }
    }
    let Some(range) = name else {
        report.at(keyword.range(), "maps without a name", || {
            Diagnostic::warning(format!("{} names no picture", quoted(keyword.text)))
        });
        return None;
    };
    map.path = String::from_utf8_lossy(&bytes[range.clone()]).into_owned();
    map.range = range;
    Some(map)
}

/// One to three numbers: for u, v and w, of which w is of no use here.
fn triple(words: &mut Words<'_>, values: &mut [f64; 2], default: f64) {
    *values = [default; 2];
    for i in 0..3 {
        let mut ahead = words.clone();
        let Some(value) = ahead.next().and_then(|w| parse_float(w.text)).filter(|v| v.is_finite()) else { return };
        if let Some(place) = values.get_mut(i) {
            *place = value;
        }
        *words = ahead;
    }
}

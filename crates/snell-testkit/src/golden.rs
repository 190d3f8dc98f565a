//! Golden pictures: what was rendered must equal a committed PNG in every code of every pixel. The renderer gives the same
//! bits everywhere, so there is no tolerance.
//!
//! A missing reference is a failure. A mismatch leaves a report for the eye in `target/golden-report/`: the expected
//! picture, the actual one and their difference, as PNGs and as one page. `SNELL_BLESS=1` writes the references anew; then
//! look at them before committing.

mod report;

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use snell_image::metrics::{Difference, Incomparable, compare_display};
use snell_image::{
    BitDepth, DisplayImage, Image, Limits, PngEffort, PngOptions, ToneCurve, decode_display, encode_png,
};
use snell_math::Rgb;

/// A picture that can be golden.
pub trait Golden {
    /// The codes that are compared.
    fn display(&self) -> Cow<'_, DisplayImage>;
}

impl Golden for DisplayImage {
    fn display(&self) -> Cow<'_, DisplayImage> {
        Cow::Borrowed(self)
    }
}

/// Scene-linear light is developed into 8 bits without tone curve or exposure.
impl Golden for Image<Rgb> {
    fn display(&self) -> Cow<'_, DisplayImage> {
        Cow::Owned(DisplayImage::develop(self, ToneCurve::None, 0.0, BitDepth::Eight))
    }
}

/// Compares a picture with the reference `folder/name.png`.
///
/// # Panics
/// Where the reference is missing or unreadable, or the picture differs from it in anything. The message gives the number of
/// different pixels, the largest difference and the first place, and says where the report is.
///
/// ```no_run
/// # let picture = snell_image::Image::filled(1, 1, snell_math::Rgb::BLACK);
/// use snell_testkit::assert_golden;
/// assert_golden("five-glass-balls", &picture, concat!(env!("CARGO_MANIFEST_DIR"), "/../../goldens"));
/// ```
#[track_caller]
pub fn assert_golden(name: &str, picture: &impl Golden, folder: impl AsRef<Path>) {
    if let Err(failure) = check(name, picture, folder.as_ref(), &report_folder(), is_blessing()) {
        panic!("golden picture `{name}`: {failure}");
    }
}

/// Compares a text with the stored one at `path`, line by line; stores it where that is asked for.
///
/// # Panics
/// Where there is no stored text, or a line of it is another. The message says which.
#[track_caller]
pub fn assert_golden_text(path: &Path, actual: &str) {
    if is_blessing() {
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(path, actual).expect("written");
        return;
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let expected = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    for (number, (expected, actual)) in (1..).zip(expected.lines().zip(actual.lines())) {
        assert_eq!(actual, expected, "{name}, line {number}; `SNELL_BLESS=1` stores it anew");
    }
    assert_eq!(actual.lines().count(), expected.lines().count(), "{name}");
}

/// True where references are written anew.
pub fn is_blessing() -> bool {
    std::env::var_os("SNELL_BLESS").is_some_and(|value| value == "1")
}

/// `target/golden-report/` of this workspace.
fn report_folder() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target"), PathBuf::from);
    target.join("golden-report")
}

/// Why a picture is not golden.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// There is no reference.
    #[error(
        "there is no reference {}; run the test with SNELL_BLESS=1 to write it, look at it, and commit it",
        .0.display()
    )]
    Missing(PathBuf),
    /// The reference is no PNG.
    #[error("the reference {} cannot be read: {}", .0.display(), .1)]
    Unreadable(PathBuf, String),
    /// Another size, or other bits.
    #[error("{}; the report is {}", .0, .1.display())]
    Shape(Incomparable, PathBuf),
    /// Other codes.
    #[error(
        "{} pixels differ, by up to {} codes; the first is {first:?}, expected {expected:?}, got {actual:?}; the report is {}",
        .difference.pixels, .difference.largest, .report.display()
    )]
    Different {
        /// How far.
        difference: Difference,
        /// Column and row of the first different pixel.
        first: (u32, u32),
        /// Its codes in the reference.
        expected: [u16; 3],
        /// Its codes in the picture.
        actual: [u16; 3],
        /// The page to look at.
        report: PathBuf,
    },
    /// A name with other characters than letters, digits, `-` and `_`.
    #[error("a golden picture's name consists of ASCII letters, digits, `-` and `_`")]
    Name,
    /// A file could not be written.
    #[error("{} cannot be written: {}", .0.display(), .1)]
    Unwritable(PathBuf, String),
}

/// The comparison behind [`assert_golden`], with nothing taken from the environment.
///
/// # Errors
/// See [`Failure`]. With `bless`, only where the reference cannot be written.
pub fn check(
    name: &str,
    picture: &impl Golden,
    folder: &Path,
    report_folder: &Path,
    bless: bool,
) -> Result<(), Failure> {
    if name.is_empty() || !name.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '_')) {
        return Err(Failure::Name);
    }
    let actual = picture.display();
    let path = folder.join(format!("{name}.png"));
    if bless {
        return write_png(&path, &actual);
    }
    let Ok(bytes) = std::fs::read(&path) else {
        return Err(Failure::Missing(path));
    };
    let expected =
        decode_display(&bytes, &Limits::default()).map_err(|error| Failure::Unreadable(path, error.to_string()))?;
    match compare_display(&expected, &actual) {
        Ok(Difference { first_at: None, .. }) => Ok(()),
        Ok(difference @ Difference { first_at: Some(first), .. }) => {
            let [expected_codes, actual_codes] = [&expected, &actual].map(|image| image.code(first.0, first.1));
            Err(Failure::Different {
                difference,
                first,
                expected: expected_codes,
                actual: actual_codes,
                report: report::write(report_folder, name, &expected, &actual, Some(&difference))?,
            })
        }
        Err(problem) => Err(Failure::Shape(problem, report::write(report_folder, name, &expected, &actual, None)?)),
    }
}

/// Writes a picture, making the folder where it is missing.
fn write_png(path: &Path, image: &DisplayImage) -> Result<(), Failure> {
    let options = PngOptions { effort: PngEffort::Small, ..PngOptions::default() };
    let bytes = encode_png(image, &options).map_err(|error| Failure::Unwritable(path.to_owned(), error.to_string()))?;
    write(path, &bytes)
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    path.parent()
        .map_or(Ok(()), std::fs::create_dir_all)
        .and_then(|()| std::fs::write(path, bytes))
        .map_err(|error| Failure::Unwritable(path.to_owned(), error.to_string()))
}

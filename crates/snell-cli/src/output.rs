//! Where a picture goes: examined before anything is rendered, written aside and then put in place.

use std::fs::{self, OpenOptions};
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

use snell::image::{BitDepth, DisplayImage, ExrOptions, PngOptions, encode_exr, encode_png, encode_png_of_light};
use snell::render::{RenderSettings, Rendering};
use snell::scene::Diagnostic;
use tempfile::NamedTempFile;

use crate::arguments::{Bits, RenderArguments};
use crate::assets::FileAssets;
use crate::console::{quoted, reason, write_stdout};
use crate::failure::Failure;

/// What the picture's file calls its maker.
pub const SOFTWARE: &str = concat!("Snell ", env!("CARGO_PKG_VERSION"));

/// The format of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Display colours.
    Png(BitDepth),
    /// Scene-linear colours, with or without layers.
    Exr,
}

/// A picture's place and format.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// Only the terminal's preview was asked for.
    Nowhere,
    /// A PNG for another program.
    Stdout(Format),
    /// A file.
    File(PathBuf, Format),
}

impl Target {
    /// What the command line asks for. Only its words are examined, not the disk.
    pub fn new(arguments: &RenderArguments, stem: &str) -> Result<Self, Failure> {
        let path = match &arguments.output {
            None if arguments.preview => return Self::Nowhere.fits(arguments),
            None => PathBuf::from(format!("{stem}.png")),
            Some(path) => path.clone(),
        };
        let bits = match arguments.bits {
            Some(Bits::Sixteen) => BitDepth::Sixteen,
            _ => BitDepth::Eight,
        };
        if path.as_os_str() == "-" {
            return Self::Stdout(Format::Png(bits)).fits(arguments);
        }
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let format = match ending.as_deref() {
            Some("png") => Format::Png(bits),
            Some("exr") => Format::Exr,
            // A device such as /dev/null has no ending.
            _ if is_special(&path) => Format::Png(bits),
            _ => {
                let shown = quoted(&path.to_string_lossy());
                let message = format!("the ending of {shown} says no format that can be written");
                let help =
                    "end it with .png (8 or 16 bits) or .exr (scene-linear); `-o -` writes a PNG to standard output";
                return Err(Failure::usage(Diagnostic::error(message).help(help)));
            }
        };
        Self::File(path, format).fits(arguments)
    }

    /// Whether the other options go with it.
    fn fits(self, arguments: &RenderArguments) -> Result<Self, Failure> {
        let is_exr = matches!(self, Self::File(_, Format::Exr));
        let refuse = |message: &str, help: &str| Err(Failure::usage(Diagnostic::error(message).help(help)));
        if arguments.layers && !is_exr {
            return refuse("--layers needs an .exr file: a PNG has no layers", "add -o NAME.exr");
        }
        if arguments.bits.is_some() && is_exr {
            return refuse("--bits is for PNG: an .exr file has floating point numbers", "leave --bits out");
        }
        if matches!(self, Self::Stdout(_)) {
            if arguments.json || arguments.preview {
                let message = "standard output cannot have both the picture and what --json or --preview prints";
                return refuse(message, "write the picture into a file with -o NAME.png");
            }
            if io::stdout().is_terminal() {
                let message = "standard output is a terminal, which does not show a PNG's bytes";
                return refuse(message, "use --preview, or send the output to a file or to another program");
            }
        }
        Ok(self)
    }

    /// As statistics and messages call it.
    pub fn name(&self) -> Option<String> {
        match self {
            Self::Nowhere => None,
            Self::Stdout(_) => Some("-".to_owned()),
            Self::File(path, _) => Some(path.display().to_string()),
        }
    }

    /// Whether the file could be written, as far as can be known before.
    pub fn check(&self) -> Result<(), Failure> {
        if let Self::File(path, _) = self { check_writable(path) } else { Ok(()) }
    }

    /// That the picture does not take the place of what the scene is made of.
    pub fn spares(&self, assets: &FileAssets) -> Result<(), Failure> {
        if let Self::File(path, _) = self { spare_sources(path, assets) } else { Ok(()) }
    }

    /// Encodes and writes.
    pub fn write(&self, rendering: &Rendering, settings: &RenderSettings) -> Result<(), Failure> {
        match self {
            Self::Nowhere => Ok(()),
            Self::Stdout(format) => write_stdout(&encode(*format, rendering, settings)?),
            Self::File(path, format) => write_file(path, &encode(*format, rendering, settings)?),
        }
    }
}

/// Whether a picture's file could be written, as far as can be known before.
pub fn check_writable(path: &Path) -> Result<(), Failure> {
    let wrong = |problem: &str| Failure::input(cannot_write(path, problem));
    if let Ok(metadata) = fs::metadata(path) {
        if metadata.is_dir() {
            return Err(wrong("it is a folder"));
        }
        if metadata.permissions().readonly() {
            return Err(wrong("the file is there already and write-protected"));
        }
        if is_special(path) {
            return Ok(());
        }
    }
    let folder = folder_of(path);
    let shown = quoted(&folder.to_string_lossy());
    match fs::metadata(folder) {
        Ok(metadata) if metadata.is_dir() => {}
        Ok(_) => return Err(wrong(&format!("{shown} is not a folder"))),
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            return Err(wrong(&format!("there is no folder {shown}")));
        }
        Err(error) => return Err(wrong(&reason(&error))),
    }
    // The only sure way to know whether a file can be made is to make one.
    temporary_file(folder)
        .map(drop)
        .map_err(|error| wrong(&format!("no file can be made in the folder {shown}: {}", reason(&error))))
}

/// That a picture does not take the place of what its scene is made of.
pub fn spare_sources(path: &Path, assets: &FileAssets) -> Result<(), Failure> {
    if assets.has_read(path) {
        let diagnostic = cannot_write(path, "the scene itself uses that file");
        return Err(Failure::input(diagnostic.help("choose another name with -o")));
    }
    Ok(())
}

/// Writes a picture's file as a whole or not at all.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    put_in_place(path, bytes).map_err(|error| Failure::input(cannot_write(path, &reason(&error))))
}

fn cannot_write(path: &Path, problem: &str) -> Diagnostic {
    Diagnostic::error(format!("the picture {} cannot be written: {problem}", quoted(&path.to_string_lossy())))
}

/// A pipe or a device: neither a file nor a folder.
fn is_special(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|metadata| !metadata.is_file() && !metadata.is_dir())
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn temporary_file(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".snell-").suffix(".part");
    // As any new file: what the user's mask leaves.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

/// Writes a file aside and renames it, so that nobody ever sees half a picture.
fn put_in_place(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if is_special(path) {
        return OpenOptions::new().write(true).open(path)?.write_all(bytes);
    }
    // Where a link leads there, the file is replaced and not the link.
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let mut file = temporary_file(folder_of(&path))?;
    file.write_all(bytes)?;
    if let Ok(metadata) = fs::metadata(&path) {
        file.as_file().set_permissions(metadata.permissions())?;
    }
    file.persist(&path).map(drop).map_err(|error| error.error)
}

fn encode(format: Format, rendering: &Rendering, settings: &RenderSettings) -> Result<Vec<u8>, Failure> {
    let encoded = match format {
        Format::Png(depth) => {
            let (light, tone, exposure) = (&rendering.image, settings.tone_curve(), settings.exposure);
            let text = vec![("Software".to_owned(), SOFTWARE.to_owned())];
            let options = PngOptions { text, ..PngOptions::default() };
            match depth {
                BitDepth::Eight => encode_png_of_light(light, tone, exposure, &options),
                BitDepth::Sixteen => encode_png(&DisplayImage::develop(light, tone, exposure, depth), &options),
            }
        }
        Format::Exr => {
            let options = ExrOptions { software: Some(SOFTWARE.to_owned()), ..ExrOptions::default() };
            let layers = rendering.layers.clone().unwrap_or_default();
            encode_exr(&rendering.image, &layers, &options)
        }
    };
    encoded.map_err(|error| Failure::input(Diagnostic::error(error.to_string())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_as_a_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        put_in_place(&path, b"one").unwrap();
        put_in_place(&path, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is left aside");
        assert!(put_in_place(&folder.path().join("no/a.png"), b"").is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_devices_and_permissions_are_kept() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (path, link) = (folder.path().join("a.png"), folder.path().join("link.png"));
        put_in_place(&path, b"one").unwrap();
        assert_ne!(fs::metadata(&path).unwrap().permissions().mode() & 0o044, 0, "others may read it as any new file");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        symlink(&path, &link).unwrap();
        put_in_place(&link, b"two").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
        put_in_place(Path::new("/dev/null"), b"gone").unwrap();
        assert!(is_special(Path::new("/dev/null")));
    }
}

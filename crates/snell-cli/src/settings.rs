//! The command line's word over the scene's settings.

use snell::scene::Diagnostic;
use snell::scene::scene::Settings;

use crate::arguments::PictureArguments;
use crate::failure::Failure;

/// The most pixels of a picture, 16384 × 16384: rendering so many takes about 25 gigabytes.
const MOST_PIXELS: u64 = 1 << 28;

/// Puts what the command line says into a scene's settings.
pub fn apply(arguments: &PictureArguments, settings: &mut Settings) -> Result<(), Failure> {
    replace(&mut settings.depth, arguments.depth);
    replace(&mut settings.min_weight, arguments.min_weight);
    replace(&mut settings.antialiasing, arguments.aa);
    replace(&mut settings.shadows, arguments.shadows.map(Into::into));
    replace(&mut settings.bands, arguments.bands);
    replace(&mut settings.tone, arguments.tone.map(Into::into));
    replace(&mut settings.exposure, arguments.exposure);
    apply_size((arguments.width, arguments.height), settings)
}

/// Puts the size that the command line asks for into a scene's settings.
pub fn apply_size(wanted: (Option<u32>, Option<u32>), settings: &mut Settings) -> Result<(), Failure> {
    (settings.width, settings.height) = size((settings.width, settings.height), wanted);
    let pixels = u64::from(settings.width) * u64::from(settings.height);
    if pixels > MOST_PIXELS {
        let message = format!(
            "a picture of {}x{} pixels is too large: it has {pixels} of them, and {MOST_PIXELS} are possible",
            settings.width, settings.height
        );
        return Err(Failure::usage(Diagnostic::error(message).help("use --width or --height to make it smaller")));
    }
    Ok(())
}

fn replace<T>(value: &mut T, by: Option<T>) {
    if let Some(by) = by {
        *value = by;
    }
}

/// The picture's size, where one side is wanted with the scene's aspect ratio, or both, or none.
fn size(scene: (u32, u32), wanted: (Option<u32>, Option<u32>)) -> (u32, u32) {
    match wanted {
        (None, None) => scene,
        (Some(width), Some(height)) => (width, height),
        (Some(width), None) => (width, other_side(width, scene.1, scene.0)),
        (None, Some(height)) => (other_side(height, scene.0, scene.1), height),
    }
}

/// `side · numerator / denominator`, rounded, at least 1.
fn other_side(side: u32, numerator: u32, denominator: u32) -> u32 {
    let (numerator, denominator) = (u64::from(numerator), u64::from(denominator.max(1)));
    let rounded = (u64::from(side) * numerator * 2 + denominator) / (denominator * 2);
    u32::try_from(rounded.max(1)).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_side_takes_the_other_along() {
        assert_eq!(size((1024, 768), (None, None)), (1024, 768));
        assert_eq!(size((1024, 768), (Some(512), None)), (512, 384));
        assert_eq!(size((1024, 768), (None, Some(3))), (4, 3));
        assert_eq!(size((1024, 768), (Some(5), Some(7))), (5, 7));
        assert_eq!(size((1440, 480), (Some(100), None)), (100, 33));
        assert_eq!(size((65536, 1), (Some(9), None)), (9, 1));
        assert_eq!(size((1, 65536), (Some(65536), None)), (65536, u32::MAX));
    }
}

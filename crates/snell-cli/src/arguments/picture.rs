//! What decides how a picture is rendered, on the command lines of all that renders or explains one.

use clap::{Args, ValueEnum};
use snell::scene::scene::Antialiasing;

use super::{Preset, ShadowsName, ToneName, number_in};

/// The scene's settings, where the command line has the last word.
#[derive(Args, Clone, Debug, Default)]
pub struct PictureArguments {
    /// Change a value of the scene, such as camera.fov=30; as often as needed
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,

    /// Settings of a standard: those of the Standard Procedural Databases
    #[arg(long, value_name = "spd", hide_possible_values = true)]
    pub preset: Option<Preset>,

    /// Pixels from left to right; alone, the height follows
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..=65536))]
    #[arg(help_heading = "Picture")]
    pub width: Option<u32>,

    /// Pixels from top to bottom; alone, the width follows
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..=65536))]
    #[arg(help_heading = "Picture")]
    pub height: Option<u32>,

    /// The curve from scene-linear to display colours
    #[arg(long, value_name = "none|reinhard|filmic", hide_possible_values = true, help_heading = "Picture")]
    pub tone: Option<ToneName>,

    /// Brightens by so many stops: 1 doubles the light, -1 halves it
    #[arg(long, value_name = "STOPS", value_parser = exposure, allow_negative_numbers = true)]
    #[arg(help_heading = "Picture")]
    pub exposure: Option<f32>,

    /// Depth of the deepest ray; a camera ray has 1
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    #[arg(help_heading = "Rendering")]
    pub depth: Option<u32>,

    /// Antialiasing; N is rays in every pixel
    #[arg(long, value_name = "none|adaptive|N", value_parser = antialiasing, help_heading = "Rendering")]
    pub aa: Option<Antialiasing>,

    /// What blocks light; `filtered`: glass lets some through
    #[arg(long, value_name = "filtered|opaque|none", hide_possible_values = true, help_heading = "Rendering")]
    pub shadows: Option<ShadowsName>,

    /// Least share of its pixel for a ray to be followed
    #[arg(long, value_name = "SHARE", value_parser = share, help_heading = "Rendering")]
    pub min_weight: Option<f32>,

    /// Bands of wavelengths that dispersive glass splits
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=64))]
    #[arg(help_heading = "Rendering")]
    pub bands: Option<u32>,

    /// Bend all light as it is bent at one wavelength
    #[arg(long, value_name = "NM", value_parser = wavelength, help_heading = "Rendering")]
    pub wavelength: Option<f64>,
}

impl PictureArguments {
    /// The words of a command line that say the same, each after a blank.
    pub fn words(&self) -> String {
        let mut words = String::new();
        let mut put = |name: &str, value: Option<String>| {
            if let Some(value) = value {
                words += &format!(" --{name} {}", word(&value));
            }
        };
        self.set.iter().for_each(|set| put("set", Some(set.clone())));
        put("preset", self.preset.and_then(name));
        put("width", self.width.map(|width| width.to_string()));
        put("height", self.height.map(|height| height.to_string()));
        put("tone", self.tone.and_then(name));
        put("exposure", self.exposure.map(|stops| stops.to_string()));
        put("depth", self.depth.map(|depth| depth.to_string()));
        put(
            "aa",
            self.aa.map(|aa| match aa {
                Antialiasing::None => "none".to_owned(),
                Antialiasing::Adaptive => "adaptive".to_owned(),
                Antialiasing::Samples(count) => count.to_string(),
            }),
        );
        put("shadows", self.shadows.and_then(name));
        put("min-weight", self.min_weight.map(|share| share.to_string()));
        put("bands", self.bands.map(|bands| bands.to_string()));
        put("wavelength", self.wavelength.map(|nm| nm.to_string()));
        words
    }
}

/// The name of a value as the command line has it.
fn name(value: impl ValueEnum) -> Option<String> {
    Some(value.to_possible_value()?.get_name().to_owned())
}

/// A word for a shell, in quotes where it needs them.
pub fn word(text: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+%@".contains(c);
    if !text.is_empty() && text.chars().all(is_plain) {
        text.to_owned()
    } else {
        format!("'{}'", text.replace('\'', r"'\''"))
    }
}

fn antialiasing(text: &str) -> Result<Antialiasing, String> {
    match text {
        "none" => Ok(Antialiasing::None),
        "adaptive" => Ok(Antialiasing::Adaptive),
        _ => match text.parse() {
            Ok(rays @ 1..=65536) => Ok(Antialiasing::Samples(rays)),
            _ => Err("write `none`, `adaptive`, or the number of rays for every pixel, 1 to 65536".to_owned()),
        },
    }
}

fn exposure(text: &str) -> Result<f32, String> {
    number_in(text, -32.0, 32.0)
}

fn share(text: &str) -> Result<f32, String> {
    number_in(text, 0.0, 1.0)
}

fn wavelength(text: &str) -> Result<f64, String> {
    match text.strip_suffix("nm").unwrap_or(text).trim().parse() {
        Ok(value) if (100.0..=10_000.0).contains(&value) => Ok(value),
        _ => Err("a wavelength from 100 to 10000 nanometres is needed".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::arguments::{Arguments, Command};

    #[test]
    fn words_say_what_was_said() {
        let all = "--set camera.fov=30 --set a.b=1 --preset spd --width 40 --height 30 --tone filmic --exposure -1.5 --depth 7 \
                   --aa 16 --shadows opaque --min-weight 0.25 --bands 3 --wavelength 486.1";
        let read = |line: &str| {
            let words = format!("snell render {line}");
            let arguments = Arguments::try_parse_from(words.split_whitespace()).unwrap();
            let Command::Render(arguments) = arguments.command else { panic!("no render command") };
            arguments.picture
        };
        let words = read(all).words();
        assert_eq!(words.split_whitespace().collect::<Vec<_>>(), all.split_whitespace().collect::<Vec<_>>());
        assert_eq!(read("").words(), "");
    }

    #[test]
    fn words_with_blanks_are_quoted() {
        assert_eq!(word("a.toml"), "a.toml");
        assert_eq!(word("my scene.toml"), "'my scene.toml'");
        assert_eq!(word("it's"), r"'it'\''s'");
        assert_eq!(word(""), "''");
    }
}

//! The command line, as clap reads it and `--help`, the manual and the completions describe it.

mod drawing;
mod explain;
mod glass;
mod paths;
mod picture;

use std::path::PathBuf;

use clap::builder::RangedU64ValueParser;
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use snell::accel::BuildQuality;
use snell::scene::scene::{Shadows, Tone};

pub use drawing::{DrawArguments, HiddenName, StrokeName, ViewArguments, ViewFormat};
pub use explain::{ExplainArguments, ExplainFormat};
pub use glass::{GlassArguments, GlassFormat, MediumName};
pub use paths::{IntegratorName, PathArguments, StopArguments};
pub use picture::{PictureArguments, word};

const EXAMPLES: &str = "\
Examples:
  snell render                             a first picture: nine-red-balls.png
  snell render lens --width 1920           a built-in scene; `snell scenes` lists them
  snell render my.toml -o my.png           a scene of yours
  snell render bunny.ply                   a mesh, framed and lit by itself
  snell draw lens                          the same scene as lines: lens.svg
  snell explain lens --pixel 300,200       the rays that made a pixel, and the share of each
  snell view lens --point 0,1,0            its matrices, and a point on its way to a pixel
  snell scenes lens --extract .            a built-in scene to begin with
  snell glass N-BK7                        a glass: its indices, formula, transmittance
  snell check my.toml                      all mistakes of a scene, with line and column";

const RENDER_EXAMPLES: &str = "\
Examples:
  snell render
  snell render lens --width 1920 -o lens.png
  snell render my.toml --set camera.fov=30 --set material.glass.dielectric.ior=diamond
  snell render my.toml --aa 64 --bits 16 -o my.png
  snell render my.toml --layers -o my.exr  scene-linear colours, depth, normals, objects
  snell render lens --map depth -o map.png how deep the tree of rays of each pixel is, in false colours
  snell render my.toml --preview           in the terminal only
  snell render my.toml -o - | display      to another program
  snell render balls.nff --preset spd      by the rules of the Standard Procedural Databases

Exit codes:
  0    the picture is there
  1    the scene or a file is wrong
  2    the command line is wrong
  130  interrupted by Ctrl-C (143: terminated); what was done is written.
       A second Ctrl-C ends at once, and nothing is written";

/// Renders glass, mirrors and what is seen in them, by recursive ray tracing
#[derive(Debug, Parser)]
#[command(name = "snell", version, after_help = EXAMPLES, max_term_width = 100, disable_help_subcommand = true)]
#[command(arg_required_else_help = true)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene to a picture
    Render(Box<RenderArguments>),
    /// Draw a scene as lines: SVG, PDF or PNG
    Draw(Box<DrawArguments>),
    /// Tell why a pixel looks as it does: the rays that made it, as text, JSON or a drawing
    Explain(Box<ExplainArguments>),
    /// Print a scene's viewing matrices, and follow points through them
    View(Box<ViewArguments>),
    /// List the built-in scenes, print one, or copy it to edit it
    Scenes(ScenesArguments),
    /// List the catalogue of glasses, or tell all about one: indices, formula, transmittance
    Glass(Box<GlassArguments>),
    /// Look for mistakes in scenes without rendering them
    Check(CheckArguments),
    /// Print the JSON Schema of scene files, for editors
    Schema,
    /// Print completions for a shell, to be sourced by it
    #[command(hide = true)]
    Completions {
        /// The shell.
        shell: Shell,
    },
    /// Print the manual page, in roff, of the program or of one of its commands
    #[command(hide = true)]
    Man {
        /// A command, such as `render`.
        command: Option<String>,
    },
}

/// `snell render`.
#[derive(Args, Debug)]
#[command(after_help = RENDER_EXAMPLES)]
pub struct RenderArguments {
    /// A scene (.toml, .json, .nff), a mesh (.ply, .obj, .stl) or the name of a built-in scene
    /// [default: nine-red-balls]
    pub scene: Option<String>,

    /// Where the picture goes: a .png or .exr file, or `-` for a PNG on standard output
    /// [default: the scene's name with .png, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,

    /// What decides how the picture is rendered.
    #[command(flatten)]
    pub picture: PictureArguments,

    /// Instead of colours, one property of every pixel in false colours: `--map list` tells which there are
    #[arg(long, value_name = "WHAT", conflicts_with_all = ["layers", "bits", "preview", "json"], help_heading = "Picture")]
    pub map: Option<String>,

    /// Bits of each colour in a PNG
    #[arg(long, value_name = "8|16", value_parser = bits, help_heading = "Picture")]
    pub bits: Option<Bits>,

    /// Depth, normals and object numbers as layers of an .exr file
    #[arg(long, help_heading = "Picture")]
    pub layers: bool,

    #[command(flatten)]
    pub paths: PathArguments,

    #[command(flatten)]
    pub stop: StopArguments,

    /// Threads [default: one for each core]
    #[arg(long, value_name = "N", value_parser = RangedU64ValueParser::<usize>::new().range(1..=1024))]
    #[arg(help_heading = "Rendering")]
    pub threads: Option<usize>,

    /// Work for hierarchies; `high` builds longer, for rays that are a little faster
    #[arg(long, value_name = "medium|high", default_value = "medium", hide_default_value = true)]
    #[arg(hide_possible_values = true, help_heading = "Rendering")]
    pub quality: QualityName,

    /// Edge of the squares that threads work on
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..=65536))]
    #[arg(help_heading = "Rendering")]
    pub tile: Option<u32>,

    /// Show the picture in the terminal; without -o no file is written
    #[arg(long, conflicts_with = "json", help_heading = "Reports")]
    pub preview: bool,

    /// Print times and counts as one JSON object on standard output
    #[arg(long, help_heading = "Reports")]
    pub json: bool,

    /// No progress and no closing line; warnings and errors only
    #[arg(short, long, help_heading = "Reports")]
    pub quiet: bool,
}

/// `snell scenes`.
#[derive(Args, Debug)]
pub struct ScenesArguments {
    /// The scene to print; without it all are listed, name and title
    pub name: Option<String>,

    /// Write the scene and its pictures into this folder, to edit and render them there
    #[arg(long, value_name = "FOLDER", requires = "name")]
    pub extract: Option<PathBuf>,
}

/// `snell check`.
#[derive(Args, Debug)]
pub struct CheckArguments {
    /// Scenes, meshes or names of built-in scenes
    #[arg(required = true, value_name = "SCENE")]
    pub scenes: Vec<String>,
}

// The values have no descriptions here, which `--help` would list at length.

/// Names of `--preset`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Preset {
    Spd,
}

/// Names of `--tone`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ToneName {
    None,
    Reinhard,
    Filmic,
}

impl From<ToneName> for Tone {
    fn from(name: ToneName) -> Self {
        match name {
            ToneName::None => Self::None,
            ToneName::Reinhard => Self::Reinhard,
            ToneName::Filmic => Self::Filmic,
        }
    }
}

/// Names of `--shadows`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ShadowsName {
    Filtered,
    Opaque,
    None,
}

impl From<ShadowsName> for Shadows {
    fn from(name: ShadowsName) -> Self {
        match name {
            ShadowsName::Filtered => Self::Filtered,
            ShadowsName::Opaque => Self::Opaque,
            ShadowsName::None => Self::None,
        }
    }
}

/// Names of `--quality`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum QualityName {
    Medium,
    High,
}

impl From<QualityName> for BuildQuality {
    fn from(name: QualityName) -> Self {
        match name {
            QualityName::Medium => Self::Medium,
            QualityName::High => Self::High,
        }
    }
}

/// Values of `--bits`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bits {
    /// 256 steps.
    Eight,
    /// 65536 steps.
    Sixteen,
}

fn bits(text: &str) -> Result<Bits, String> {
    match text {
        "8" => Ok(Bits::Eight),
        "16" => Ok(Bits::Sixteen),
        _ => Err("a PNG has 8 or 16".to_owned()),
    }
}

fn number_in(text: &str, least: f32, most: f32) -> Result<f32, String> {
    match text.parse() {
        Ok(value) if (least..=most).contains(&value) => Ok(value),
        _ => Err(format!("a number from {least} to {most} is needed")),
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;
    use snell::scene::scene::Antialiasing;

    use super::*;

    fn render(line: &str) -> Result<RenderArguments, clap::Error> {
        Arguments::try_parse_from(format!("snell render {line}").split_whitespace()).map(|arguments| {
            let Command::Render(arguments) = arguments.command else { panic!("no render command") };
            *arguments
        })
    }

    #[test]
    fn the_model_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn values_mean_what_they_say() {
        let arguments = render("a.toml --aa 16 --exposure -1.5 --bits 16 --min-weight 0 --shadows none").unwrap();
        assert_eq!(arguments.picture.aa, Some(Antialiasing::Samples(16)));
        assert_eq!(arguments.picture.exposure, Some(-1.5));
        assert_eq!(arguments.bits, Some(Bits::Sixteen));
        assert_eq!(arguments.picture.min_weight, Some(0.0));
        assert_eq!(arguments.picture.shadows.map(Shadows::from), Some(Shadows::None));
        assert_eq!(BuildQuality::from(render("--quality high").unwrap().quality), BuildQuality::High);
        assert_eq!(BuildQuality::from(render("").unwrap().quality), BuildQuality::Medium);
        assert_eq!(render("--aa none").unwrap().picture.aa, Some(Antialiasing::None));
    }

    #[test]
    fn values_out_of_range_are_refused() {
        for line in [
            "--width 0",
            "--width 65537",
            "--depth 0",
            "--aa 0",
            "--aa some",
            "--exposure nan",
            "--exposure 1e9",
            "--min-weight -1",
            "--min-weight 2",
            "--bits 12",
            "--threads 0",
            "--tile 0",
            "--json --preview",
            "--shadows soft",
            "--wavelength 5",
            "--quality low",
        ] {
            assert!(render(line).is_err(), "{line}");
        }
    }
}

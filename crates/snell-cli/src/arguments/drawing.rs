//! The command lines of `snell draw` and `snell view`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

const DRAW_EXAMPLES: &str = "\
Examples:
  snell draw lens
  snell draw my.toml -o my.pdf --hidden dashed --title \"Plan of my house\"
  snell draw bunny.ply --stroke depth -o bunny.svg
  snell render lens && snell draw lens --over lens.png -o both.png
  snell draw lens --set camera.eye=[9,4,12] --set camera.fov=60 --frustum lens --axes
                                           a camera and what it sees, from another one
  snell draw my.toml -o - | plotter        an SVG to another program

In titles and labels *x* is italic, _1 is lowered and ^2 raised.";

const VIEW_EXAMPLES: &str = "\
Examples:
  snell view lens
  snell view lens --point 0,1,0
  snell view lens --segment 0,0,0,0,0,20   clipped before the division
  snell view lens --format svg -o lens-view.svg
  snell view lens --point 1,2,3 --format json

The matrices are those of the lecture: M = M_o M_p M_v takes a point of the world to a pixel whose centre is
at whole numbers, y up, once it is divided by h.";

/// `snell draw`.
#[derive(Args, Debug)]
#[command(after_help = DRAW_EXAMPLES)]
pub struct DrawArguments {
    /// A scene (.toml, .json, .nff), a mesh (.ply, .obj, .stl) or the name of a built-in scene
    /// [default: nine-red-balls]
    pub scene: Option<String>,

    /// Where the drawing goes: a .svg, .pdf or .png file, or `-` for an SVG on standard output
    /// [default: the scene's name with .svg, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,

    /// Change a value of the scene, such as camera.fov=30; as often as needed
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,

    /// Lay it over a rendering of the scene, a PNG of the same proportions
    #[arg(long, value_name = "PNG")]
    pub over: Option<PathBuf>,

    /// What becomes of hidden lines
    #[arg(long, value_name = "removed|dashed|kept", hide_possible_values = true, help_heading = "Lines")]
    pub hidden: Option<HiddenName>,

    /// What the colour of lines tells
    #[arg(long, value_name = "uniform|object|material|depth", hide_possible_values = true, help_heading = "Lines")]
    pub stroke: Option<StrokeName>,

    /// Width of outlines; inner lines are thinner
    #[arg(long, value_name = "MM", value_parser = millimetres, help_heading = "Lines")]
    pub line_width: Option<f64>,

    /// Draw edges of meshes whose faces turn by more than this
    #[arg(long, value_name = "DEGREES", value_parser = degrees, help_heading = "Lines")]
    pub crease: Option<f64>,

    /// Lines around and along each curved shape, so many each way
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=1000), help_heading = "Lines")]
    pub parameter_lines: Option<u32>,

    /// The world's axes
    #[arg(long, help_heading = "Additions")]
    pub axes: bool,

    /// A grid on the ground, its lines so far apart
    #[arg(long, value_name = "UNITS", value_parser = positive, help_heading = "Additions")]
    pub grid: Option<f64>,

    /// The camera of another scene and what it sees
    #[arg(long, value_name = "SCENE", help_heading = "Additions")]
    pub frustum: Option<String>,

    /// A title above the picture
    #[arg(long, value_name = "TEXT", help_heading = "Additions")]
    pub title: Option<String>,

    /// A scale in world units
    #[arg(long, help_heading = "Additions")]
    pub scale: bool,

    /// A frame around the picture
    #[arg(long, help_heading = "Additions")]
    pub frame: bool,

    /// Width of the page
    #[arg(long, value_name = "MM", value_parser = millimetres, help_heading = "Page")]
    pub page_width: Option<f64>,

    /// Pixels from left to right of the rendering that it agrees with, and of a PNG
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..=65536), help_heading = "Page")]
    pub width: Option<u32>,

    /// Pixels from top to bottom
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..=65536), help_heading = "Page")]
    pub height: Option<u32>,

    /// No closing line; warnings and errors only
    #[arg(short, long)]
    pub quiet: bool,
}

/// `snell view`.
#[derive(Args, Debug)]
#[command(after_help = VIEW_EXAMPLES)]
pub struct ViewArguments {
    /// A scene (.toml, .json, .nff), a mesh (.ply, .obj, .stl) or the name of a built-in scene
    /// [default: nine-red-balls]
    pub scene: Option<String>,

    /// Follow a point of the world to its pixel; as often as needed
    #[arg(long, value_name = "X,Y,Z", value_parser = coordinates::<3>, allow_hyphen_values = true)]
    pub point: Vec<[f64; 3]>,

    /// Follow a segment, and tell where it is clipped; as often as needed
    #[arg(long, value_name = "X,Y,Z,X,Y,Z", value_parser = coordinates::<6>, allow_hyphen_values = true)]
    pub segment: Vec<[f64; 6]>,

    /// n, the z of the near plane in eye space: negative [default: the camera's, or before the scene]
    #[arg(long, value_name = "Z", allow_negative_numbers = true)]
    pub near: Option<f64>,

    /// f, the z of the far plane in eye space, below n [default: the camera's, or behind the scene]
    #[arg(long, value_name = "Z", allow_negative_numbers = true)]
    pub far: Option<f64>,

    /// Text, JSON, or a drawing of both volumes
    #[arg(long, value_name = "text|json|svg", hide_possible_values = true, default_value = "text")]
    pub format: ViewFormat,

    /// Where it goes [default: standard output]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,

    /// Change a value of the scene, such as camera.fov=30; as often as needed
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,

    /// Pixels from left to right; alone, the height follows
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub width: Option<u32>,

    /// Pixels from top to bottom; alone, the width follows
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub height: Option<u32>,
}

/// Names of `--hidden`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum HiddenName {
    Removed,
    Dashed,
    Kept,
}

/// Names of `--stroke`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum StrokeName {
    Uniform,
    Object,
    Material,
    Depth,
}

/// Names of `--format`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ViewFormat {
    Text,
    Json,
    Svg,
}

fn millimetres(text: &str) -> Result<f64, String> {
    match text.strip_suffix("mm").unwrap_or(text).trim().parse() {
        Ok(value) if (0.001..=10_000.0).contains(&value) => Ok(value),
        _ => Err("a length from 0.001 to 10000 millimetres is needed".to_owned()),
    }
}

fn degrees(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if (0.0..=180.0).contains(&value) => Ok(value),
        _ => Err("an angle from 0 to 180 degrees is needed".to_owned()),
    }
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if (1e-9..=1e9).contains(&value) => Ok(value),
        _ => Err("a number above 0 is needed".to_owned()),
    }
}

pub fn coordinates<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|word| word.trim().parse::<f64>()).collect();
    numbers
        .ok()
        .filter(|numbers| numbers.iter().all(|number| number.is_finite()))
        .and_then(|numbers| <[f64; N]>::try_from(numbers).ok())
        .ok_or_else(|| format!("{N} finite numbers with commas between them are needed"))
}

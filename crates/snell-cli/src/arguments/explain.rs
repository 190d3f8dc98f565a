//! The command line of `snell explain`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use snell::explain::View;
use snell::math::Point3;

use super::drawing::coordinates;
use super::{PathArguments, PictureArguments};

const EXAMPLES: &str = "\
Examples:
  snell explain lens --pixel 512,384       the tree of rays of a pixel
  snell explain lens --pixel 512,384 --sample 0
                                           of its first sample alone
  snell explain lens --ray 0,1,9,0,0,-1    of a ray from a point in a direction
  snell explain lens --pixel 512,384 --format json -o pixel.json
  snell explain lens --pixel 512,384 --view side -o pixel.svg
  snell explain lens --find tir            pixels that show total internal reflection
  snell explain lens --find depth=6 --count 1 -o deep.svg
                                           the clearest one, drawn
  snell explain seven-rays                 the lecture's seven rays, each in a drawing of its own
  snell explain caustic --pixel 290,240 --samples 16
                                           of path tracing: the ways that light took

A share is the part of the pixel's luminance that a ray and all that followed from it brought. In ways, R is reflected,
T transmitted and D scattered light.";

/// `snell explain`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ExplainArguments {
    /// A scene (.toml, .json, .nff), a mesh (.ply, .obj, .stl) or the name of a built-in scene. With nothing else said, each
    /// of the lecture's seven rays is looked for in it and drawn
    #[arg(required_unless_present = "find")]
    pub scene: Option<String>,

    /// The pixel, from the left and from the top; 0,0 is the first one
    #[arg(long, value_name = "X,Y", value_parser = pixel, conflicts_with = "ray")]
    pub pixel: Option<[u32; 2]>,

    /// A ray as if it came from the camera: where it begins and where it goes
    #[arg(long, value_name = "X,Y,Z,DX,DY,DZ", value_parser = coordinates::<6>, allow_hyphen_values = true)]
    pub ray: Option<[f64; 6]>,

    /// One of the pixel's samples alone, counted from 0; of a ray, whose random numbers it has
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..1 << 24))]
    pub sample: Option<u32>,

    /// Look for pixels that show something, the clearest first: `--find list` tells what there is
    #[arg(long, value_name = "WHAT", conflicts_with_all = ["pixel", "ray"])]
    pub find: Option<String>,

    /// How many pixels are to be found [default: 5]
    #[arg(long, value_name = "N", requires = "find", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub count: Option<u32>,

    /// Text for people, JSON for programs, or a drawing
    #[arg(long, value_name = "text|json|svg|pdf|png", hide_possible_values = true)]
    pub format: Option<ExplainFormat>,

    /// Where it goes; its ending says the format [default: standard output]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,

    /// From where the drawing sees the scene: a name, or a point of the world
    /// [default: across the plane of incidence, where angles are true]
    #[arg(long, value_name = "plane|side|above|front|camera|X,Y,Z", value_parser = view, allow_hyphen_values = true)]
    pub view: Option<View>,

    /// In text, where every ray begins and ends too
    #[arg(long)]
    pub details: bool,

    /// What decides how the picture is rendered.
    #[command(flatten)]
    pub picture: PictureArguments,

    #[command(flatten)]
    pub paths: PathArguments,
}

/// Names of `--format`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ExplainFormat {
    Text,
    Json,
    Svg,
    Pdf,
    Png,
}

fn pixel(text: &str) -> Result<[u32; 2], String> {
    let numbers: Result<Vec<u32>, _> = text.split(',').map(|word| word.trim().parse()).collect();
    numbers
        .ok()
        .and_then(|numbers| <[u32; 2]>::try_from(numbers).ok())
        .ok_or_else(|| "two whole numbers with a comma between them are needed, such as 300,200".to_owned())
}

fn view(text: &str) -> Result<View, String> {
    Ok(match text {
        "plane" => View::Plane,
        "side" => View::Side,
        "above" => View::Above,
        "front" => View::Front,
        "camera" => View::Camera,
        _ => match coordinates::<3>(text) {
            Ok([x, y, z]) => View::From(Point3::new(x, y, z)),
            Err(_) => {
                return Err("write `plane`, `side`, `above`, `front`, `camera`, or a point such as 4,3,9".to_owned());
            }
        },
    })
}

//! The command line of `snell glass`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

const GLASS_EXAMPLES: &str = "\
Examples:
  snell glass                              every material by name, n_d and V_d
  snell glass --search flint               those whose name or description has a word
  snell glass N-BK7                        all that is known of one
  snell glass N-BK7 --at 632.8             its index at a wavelength
  snell glass diamond-dispersive -o n.svg  its index over the wavelength, drawn
  snell glass hoya.agf                     the glasses of a file: Zemax's .agf, or a page
  snell glass hoya.agf#FCD1                of the refractiveindex.info database, .yml
  snell glass --format json                everything, for programs";

/// `snell glass`.
#[derive(Args, Debug)]
#[command(after_help = GLASS_EXAMPLES)]
pub struct GlassArguments {
    /// A material of the catalogue, or a file of glasses (.agf, .yml), with #NAME for one of them
    pub name: Option<String>,

    /// List only materials whose name, description or source has this
    #[arg(long, value_name = "TEXT")]
    pub search: Option<String>,

    /// The index at a wavelength in nanometres; as often as needed
    #[arg(long, value_name = "NM", value_parser = wavelength)]
    pub at: Vec<f64>,

    /// What the wavelengths of --at are measured in, and the index is relative to [default: what the
    /// material's formula has: air for glasses of makers, vacuum for others]
    #[arg(long = "in", value_name = "air|vacuum", hide_possible_values = true)]
    pub medium: Option<MediumName>,

    /// The thickness that internal transmittance is told for, in millimetres
    #[arg(long, value_name = "MM", default_value_t = 10.0, value_parser = thickness)]
    pub thickness: f64,

    /// Text, JSON, or the index drawn as SVG [default: by the ending of -o, or text]
    #[arg(long, value_name = "text|json|svg", hide_possible_values = true)]
    pub format: Option<GlassFormat>,

    /// Where it goes: .svg is drawn, .json is JSON [default: standard output]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// Names of `--format`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum GlassFormat {
    Text,
    Json,
    Svg,
}

/// Names of `--in`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MediumName {
    Air,
    Vacuum,
}

fn wavelength(text: &str) -> Result<f64, String> {
    match text.strip_suffix("nm").unwrap_or(text).trim().parse() {
        Ok(value) if (100.0..=1e6).contains(&value) => Ok(value),
        _ => Err("a wavelength from 100 to 1000000 nanometres is needed".to_owned()),
    }
}

fn thickness(text: &str) -> Result<f64, String> {
    match text.strip_suffix("mm").unwrap_or(text).trim().parse() {
        Ok(value) if (1e-6..=1e9).contains(&value) => Ok(value),
        _ => Err("a thickness above 0 millimetres is needed".to_owned()),
    }
}

//! What commands that render or explain are told about path tracing.

use std::time::Duration;

use clap::{Args, ValueEnum};

/// How light is followed.
#[derive(Args, Debug)]
pub struct PathArguments {
    /// How light is followed: `whitted` as the lecture has it; `path` as it is, with light that comes through glass
    #[arg(long, value_name = "whitted|path", hide_possible_values = true, help_heading = "Rendering")]
    pub integrator: Option<IntegratorName>,

    /// Most samples of a pixel by `path` [default: 64; as many as it takes with --noise or --time]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1 << 24))]
    #[arg(help_heading = "Paths")]
    pub samples: Option<u32>,

    /// Leave light that comes through glass to chance: lights send out nothing
    #[arg(long, help_heading = "Paths")]
    pub no_photons: bool,

    /// What random numbers depend on
    #[arg(long, value_name = "N", help_heading = "Paths")]
    pub seed: Option<u32>,
}

impl PathArguments {
    /// The words of a command line that say the same of one sample, each after a blank.
    pub fn words(&self) -> String {
        let Self { integrator, samples: _, no_photons, seed } = self;
        let mut words = String::new();
        match integrator {
            Some(IntegratorName::Path) => words += " --integrator path",
            Some(IntegratorName::Whitted) => words += " --integrator whitted",
            None => {}
        }
        if *no_photons {
            words += " --no-photons";
        }
        if let Some(seed) = seed {
            words += &format!(" --seed {seed}");
        }
        words
    }
}

/// When path tracing ends, besides by its number of samples.
#[derive(Args, Debug)]
pub struct StopArguments {
    /// Finish pixels whose error is below this share of their brightness
    #[arg(long, value_name = "SHARE", value_parser = noise, help_heading = "Paths")]
    pub noise: Option<f64>,

    /// Begin no further sample after this time, such as 30s or 5min
    #[arg(long, value_name = "TIME", value_parser = time, help_heading = "Paths")]
    pub time: Option<Duration>,
}

/// Names of `--integrator`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum IntegratorName {
    Whitted,
    Path,
}

fn noise(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if value > 0.0 && value <= 1.0 => Ok(value),
        _ => Err("a number above 0 and up to 1 is needed, such as 0.01".to_owned()),
    }
}

/// `30s`, `5min`, `1.5h`, `500ms`; a number alone is in seconds.
fn time(text: &str) -> Result<Duration, String> {
    let unit_at = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
    let (number, unit) = text.split_at(unit_at);
    let factor = match unit.trim() {
        "ms" => Some(1e-3),
        "" | "s" => Some(1.0),
        "m" | "min" => Some(60.0),
        "h" => Some(3600.0),
        _ => None,
    };
    let seconds = number.trim().parse::<f64>().ok().zip(factor).map(|(number, factor)| number * factor);
    seconds
        .filter(|seconds| (0.0..=1e8).contains(seconds))
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
        .ok_or_else(|| "a time is needed, such as 30s, 5min or 2h".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_read_with_their_units() {
        for (text, seconds) in
            [("30s", 30.0), ("5min", 300.0), ("2 m", 120.0), ("1.5h", 5400.0), ("500ms", 0.5), ("7", 7.0)]
        {
            assert_eq!(time(text), Ok(Duration::from_secs_f64(seconds)), "{text}");
        }
        for text in ["", "s", "-1s", "1y", "nan", "1e99h"] {
            assert!(time(text).is_err(), "{text}");
        }
    }

    #[test]
    fn noise_is_a_share() {
        assert_eq!(noise("0.01"), Ok(0.01));
        for text in ["0", "-1", "2", "nan", "x"] {
            assert!(noise(text).is_err(), "{text}");
        }
    }
}

//! How far apart two pictures look, as one number from 0 to 1: `cargo run -p snell-image --example flip -- REFERENCE TEST` prints
//! the mean of their ꟻLIP map for the paper's viewer. The exit code is 1 where a file is no picture, or the sizes differ.

use std::process::ExitCode;

use snell_image::flip::{PIXELS_PER_DEGREE, flip, mean};
use snell_image::{DisplayImage, Limits, decode_display};

fn main() -> ExitCode {
    let files: Vec<String> = std::env::args().skip(1).collect();
    let [reference, test] = files.as_slice() else {
        eprintln!("usage: flip REFERENCE TEST");
        return ExitCode::from(2);
    };
    match compare(reference, test) {
        Ok(difference) => {
            println!("{difference:.6}");
            ExitCode::SUCCESS
        }
        Err(reason) => {
            eprintln!("error: {reason}");
            ExitCode::FAILURE
        }
    }
}

fn compare(reference: &str, test: &str) -> Result<f64, String> {
    let (reference, test) = (picture(reference)?, picture(test)?);
    let map = flip(&reference, &test, PIXELS_PER_DEGREE).map_err(|error| error.to_string())?;
    Ok(mean(&map))
}

fn picture(file: &str) -> Result<DisplayImage, String> {
    let bytes = std::fs::read(file).map_err(|error| format!("cannot read {file}: {error}"))?;
    decode_display(&bytes, &Limits::default()).map_err(|error| format!("{file}: {error}"))
}

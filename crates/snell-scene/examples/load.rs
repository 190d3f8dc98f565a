//! Reads a mesh from a PLY, OBJ or STL file and says how many triangles it has, for measuring how long that takes:
//! `cargo run --release -p snell-scene --example load -- FILE`. What an OBJ file names in turn is not read.

use std::process::ExitCode;

use snell_scene::Diagnostics;
use snell_scene::assets::MemoryAssets;
use snell_scene::reader::read_mesh;

fn main() -> ExitCode {
    let files: Vec<String> = std::env::args().skip(1).collect();
    let [file] = files.as_slice() else {
        eprintln!("usage: load FILE");
        return ExitCode::from(2);
    };
    let bytes = match std::fs::read(file) {
        Ok(bytes) => bytes,
        Err(error) => {
            eprintln!("error: cannot read {file}: {error}");
            return ExitCode::FAILURE;
        }
    };
    match read_mesh(file, &bytes, &MemoryAssets::default(), &mut Diagnostics::default()) {
        Some(read) => {
            println!("{}", read.mesh.triangles.len());
            ExitCode::SUCCESS
        }
        None => {
            eprintln!("error: {file} is no mesh that can be read; `snell check` of a scene with it says why");
            ExitCode::FAILURE
        }
    }
}

//! Scene files in TOML, with a mesh and a picture that they may name.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    snell_fuzz::read_scene("scene.toml", bytes);
});

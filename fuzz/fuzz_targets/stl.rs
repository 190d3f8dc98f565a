//! STL files, with a scene around what they give.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| snell_fuzz::read_mesh("a.stl", bytes, b""));

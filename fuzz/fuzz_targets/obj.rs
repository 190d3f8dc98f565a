//! OBJ files with a material library: the bytes before the first 0xff are the mesh, those after it the library.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let split = bytes.iter().position(|&b| b == 0xff).unwrap_or(bytes.len());
    let library = bytes.get(split + 1..).unwrap_or_default();
    snell_fuzz::read_mesh("a.obj", &bytes[..split], library);
});

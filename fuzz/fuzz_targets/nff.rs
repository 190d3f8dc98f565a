//! NFF files, also under the rules of the Standard Procedural Databases.
#![no_main]

use snell_scene::reader::nff;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let (mut scene, diagnostics) = nff::read("a.nff", bytes);
    snell_fuzz::check(scene.as_ref(), &diagnostics);
    if let Some(scene) = &mut scene {
        nff::spd_rules(scene);
        snell_fuzz::check(Some(scene), &diagnostics);
    }
});

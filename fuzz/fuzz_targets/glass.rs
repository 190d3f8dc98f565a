//! Files of glasses: the first byte says of which kind. Every glass that is given has an index everywhere.
#![no_main]

use snell_scene::catalogue::read_glass_file;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Some((kind, rest)) = bytes.split_first() else { return };
    let file = read_glass_file(if kind & 1 == 0 { "a.agf" } else { "a.yml" }, rest);
    for glass in &file.glasses {
        for nm in [0.0, 300.0, 587.5618, 1e9] {
            assert!(glass.dispersion.index(nm) > 0.0);
            assert!(!glass.internal_transmittance(nm, 10.0).is_some_and(f64::is_nan));
        }
    }
    for problem in &file.problems {
        assert!(!problem.message.is_empty() && problem.line > 0);
    }
});

//! `snell render --integrator path`: where it ends, and what it refuses.

use crate::support::Folder;

#[test]
fn paths_need_no_other_scene_and_their_bits_do_not_depend_on_threads() {
    let folder = Folder::new();
    let options = "--integrator path --samples 2 --width 24 --quiet";
    folder.good(&format!("render one-glass-sphere {options} -o a.png --threads 1"));
    folder.good(&format!("render one-glass-sphere {options} -o b.png --threads 3 --tile 5"));
    folder.good(&format!("render one-glass-sphere {options} -o c.png --seed 1"));
    assert_eq!(folder.read("a.png"), folder.read("b.png"));
    assert_ne!(folder.read("a.png"), folder.read("c.png"));
}

#[test]
fn a_scene_may_ask_for_paths() {
    let folder = Folder::new();
    let samples = |options: &str| {
        let run = folder.good(&format!("render caustic --width 16 --json -o a.png {options}"));
        run.json()["rays"]["camera"].as_u64().unwrap() / (16 * 12)
    };
    assert_eq!(samples("--samples 3"), 3);
    // At the end of the first pass.
    assert_eq!(samples("--time 0s"), 1);
    assert!((16..1000).contains(&samples("--noise 0.5")));
    assert_eq!(samples("--integrator whitted --aa none"), 1);
}

#[test]
fn options_of_the_other_integrator_are_refused() {
    let folder = Folder::new();
    for (line, told) in [
        ("render lens --samples 4", "--samples is for path tracing"),
        ("render lens --noise 0.1", "--noise is for path tracing"),
        ("render lens --integrator path --aa 4", "--aa is for `whitted`"),
        ("render caustic --map depth --noise 0.1", "--noise ends pictures, not maps"),
        ("render caustic --wavelength 500", "--wavelength is for `whitted`"),
    ] {
        let run = folder.run(line);
        assert!(run.code == Some(2) && run.stderr.contains(told), "{run:?}");
    }
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}

#[test]
fn light_that_will_be_missing_is_told() {
    let folder = Folder::new();
    folder.write("lamp.toml", "ambient = 0\n[[object]]\nsphere = {}\nmaterial = { emission = 1 }\n");
    folder.write(
        "milk.toml",
        "[[light]]\nname = \"key\"\npoint = { position = [0, 5, 0] }\n\
         [[object]]\nsphere = {}\nmaterial = { dielectric = { ior = 1.3, scattering = { distance = 0.2 } } }\n",
    );
    let options = "--width 8 --quiet -o a.png";
    for (line, told) in [
        ("render lamp.toml", "light nothing by `whitted`"),
        ("render lens --integrator path --samples 1 --no-photons", "does not come through glass"),
        ("render milk.toml --integrator path --samples 1 --no-photons", "light of key does not come through glass"),
    ] {
        let run = folder.good(&format!("{line} {options}"));
        assert!(run.stderr.contains(told), "{run:?}");
    }
    for line in
        ["render lamp.toml --integrator path", "render lens --integrator path", "render milk.toml --integrator path"]
    {
        let samples = if line.contains("path") { " --samples 1" } else { "" };
        let run = folder.good(&format!("{line}{samples} {options}"));
        assert!(!run.stderr.contains("warning"), "{run:?}");
    }
}

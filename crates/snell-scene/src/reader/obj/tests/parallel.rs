//! Reading in stretches gives what reading line by line gives, however the file is cut.

use proptest::prelude::*;

use crate::Diagnostics;
use crate::reader::obj::{Parser, line_by_line, parallel};
use crate::reader::report::Report;
use crate::reader::tests::assets::shared;
use crate::reader::text::{Word, text_start};

/// Line by line, and whether anything was told.
fn plainly<'a>(bytes: &'a [u8], diagnostics: &'a mut Diagnostics) -> (Option<Parser<'a>>, bool) {
    let mut report = Report::new("a.obj", bytes, diagnostics);
    let parser = line_by_line(&mut report, text_start(bytes).unwrap_or(0));
    (parser, report.has_told())
}

/// Where two ways of reading differ.
fn compare(fast: &Parser<'_>, plain: &Parser<'_>) -> Result<(), String> {
    let bits = |values: &[[f32; 3]]| values.iter().map(|v| v.map(f32::to_bits)).collect::<Vec<_>>();
    let colors = |parser: &Parser<'_>| {
        let mut colors = parser.colors.clone();
        if !colors.is_empty() {
            colors.resize(parser.positions.len(), [1.0; 3]);
        }
        bits(&colors)
    };
    let words = |words: &[Word<'_>]| words.iter().map(|w| (w.text.to_vec(), w.start)).collect::<Vec<_>>();
    let same = [
        ("positions", bits(&fast.positions) == bits(&plain.positions)),
        ("colours", colors(fast) == colors(plain)),
        (
            "texture coordinates",
            fast.uvs.iter().flatten().map(|c| c.to_bits()).eq(plain.uvs.iter().flatten().map(|c| c.to_bits())),
        ),
        ("normals", bits(&fast.normals) == bits(&plain.normals)),
        ("triangles", fast.triangles == plain.triangles),
        ("materials", fast.triangle_materials == plain.triangle_materials),
        ("names", words(&fast.material_names) == words(&plain.material_names)),
        ("numbers of names", fast.material_numbers == plain.material_numbers),
        ("libraries", words(&fast.libraries) == words(&plain.libraries)),
        ("points and lines", fast.loose == plain.loose),
    ];
    same.iter().try_for_each(|(what, same)| if *same { Ok(()) } else { Err(format!("the {what} differ")) })
}

/// Compares both ways on stretches of several sizes. True where the fast one is not given up.
fn check(bytes: &[u8]) -> Result<bool, String> {
    let mut diagnostics = Diagnostics::default();
    let (plain, told) = plainly(bytes, &mut diagnostics);
    let mut is_plain = false;
    for size in [1, 7, 64, 1000, 1 << 20] {
        let Some(fast) = parallel::read(bytes, text_start(bytes).unwrap_or(0), size) else { continue };
        if told {
            return Err("something is to be told".to_owned());
        }
        compare(&fast, plain.as_ref().ok_or("it takes too long")?)?;
        is_plain = true;
    }
    Ok(is_plain)
}

const EVERYTHING: &str = "# a mesh\nmtllib a.mtl b c.mtl\no thing\nv 0 0 0\nv 1.5e0 0 -0.0 1\r\nv 1 1 0 0.5 0.25 1\n\nvt 0 1\nvt .5\nvt 1 1 0\n\
    vn 0 0 1 # up\nf 1 2 3\nusemtl red  one \ng a\nf 1/1/1 2/2/1 3/3/-1\n  v 0 1 0\nusemtl unused\nusemtl blue\nl 1 2\np 1\n\
    f -4//1 -3//1 -2//-1 -1//1\nusemtl red  one\nf 1/1 2/ 3/-1\ns off\nv 7 7 7\nv 9 7 7\nv 8 9 7 1 1 1 1 x\nv 8 7.5 7\nf 5 6 7 8\nf 1 1 1 1\nf +1 2 3 # end";

#[test]
fn all_that_is_plain_is_read_in_stretches() {
    assert_eq!(check(EVERYTHING.as_bytes()), Ok(true));
    assert_eq!(check(EVERYTHING.replace('\n', "\r\n").as_bytes()), Ok(true));
    assert_eq!(check(b""), Ok(true));
    for told in [
        "v 1 2",
        "v 1 2 x",
        "v 1 2 1e99",
        "v 1 2 3 2 0 0",
        "vn 1 2",
        "vt",
        "f 1 2",
        "f 1 2 9",
        "f 1 2 0",
        "f 1/9 2 3",
        "f -9 1 2",
        "f 1/1/1/1 2 3",
        "f 1 2 3\\\n",
        "f 1 2 3x",
        "f 1234567890 1 2",
        "curv 1",
        "vx",
        "# a \\\nf 1 2 3",
        "usemtl a\\\n",
        "v 1 2 3 \\",
    ] {
        assert_eq!(check(format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{told}\n").as_bytes()), Ok(false), "{told}");
    }
}

#[test]
fn a_planted_difference_is_seen() {
    let mut diagnostics = Diagnostics::default();
    let (plain, _) = plainly(EVERYTHING.as_bytes(), &mut diagnostics);
    let plain = plain.unwrap();
    for defect in 0..6 {
        let mut fast = parallel::read(EVERYTHING.as_bytes(), 0, 50).unwrap();
        assert_eq!(compare(&fast, &plain), Ok(()));
        match defect {
            0 => fast.positions[1][2] = 0.0,
            1 => fast.colors[2][0] += 1e-7,
            2 => fast.triangles[1].swap(0, 1),
            3 => fast.triangle_materials[0] = 0,
            4 => fast.material_names[0].start += 1,
            _ => fast.normals[0][2] = 0.5,
        }
        assert!(compare(&fast, &plain).is_err(), "{defect}");
    }
}

#[test]
fn every_file_at_hand_is_read_alike() {
    let Some(shared) = shared() else { return };
    let mut plain = 0;
    for folder in
        ["meshes", "meshes/bitterli-cornell-box", "obj-tests/assimp", "obj-tests/tinyobjloader", "obj-tests/tobj"]
    {
        let mut files: Vec<_> =
            std::fs::read_dir(shared.join(folder)).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.retain(|path| path.extension().is_some_and(|e| e == "obj"));
        for path in files {
            plain += usize::from(check(&std::fs::read(&path).unwrap()).unwrap_or_else(|e| panic!("{path:?}: {e}")));
        }
    }
    assert!(plain > 20, "{plain}");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]
    #[test]
    fn lines_in_any_order_are_read_alike(
        lines in prop::collection::vec(prop::sample::select(vec![
            "v 1 2 3", "v 4.25 -1e-3 9", "v 0 1 0 0.5", "v 1 1 4 0 1 0.5", "vt 0.1 0.9", "vn 0 1 0", "f 1 2 3", "f -1 -2 -3", "f 1 2 3 -1",
            "f 1/1 2/1 3/-1", "f 1//1 2//-1 3//1", "f 1/1/1 2/2/2 3/3/3", "usemtl a", "usemtl b", "usemtl a b", "mtllib m", "g", "l 1 2", "# c", "",
            "v 1 2 3\\", "f 2 2 2 2", "f 3 1 2 4 5",
        ]), 0..60),
    ) {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n{}", lines.join("\n"));
        prop_assert_eq!(check(text.as_bytes()).err(), None);
    }

    #[test]
    fn any_text_is_read_alike(text in "([vft]n? |[0-9/.e+-]{1,6}|[ \\\\\\r]|\\n|#){0,80}") {
        prop_assert_eq!(check(text.as_bytes()).err(), None);
    }
}

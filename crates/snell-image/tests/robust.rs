//! Every decoder meets files that are cut short, changed or made up: it answers with a picture or with an error in words,
//! never with a panic, and never takes long.

#![allow(clippy::unwrap_used, reason = "the helpers of a test fail it as the test itself does")]

mod common;

use common::{Noise, assets, cuts, files};
use proptest::prelude::*;
use snell_image::{
    BitDepth, DecodeError, DisplayImage, ExrOptions, ExrPrecision, Image, Layers, Limits, PngOptions, ToneCurve,
    decode, encode_exr, encode_png,
};
use snell_math::Rgb;

/// Small limits, so that files that lie about their size cost no time.
fn limits() -> Limits {
    Limits { max_width: 4096, max_height: 4096, max_bytes: 64 << 20 }
}

fn light() -> Image<Rgb> {
    Image::from_fn(40, 37, |x, y| Rgb::new(x as f32 / 40.0, (x * y % 17) as f32 / 17.0, (y as f32 / 30.0).min(1.0)))
}

fn png() -> Vec<u8> {
    let display = DisplayImage::develop(&light(), ToneCurve::None, 0.0, BitDepth::Eight);
    encode_png(&display, &PngOptions { text: vec![("Software".into(), "Snell".into())], ..Default::default() }).unwrap()
}

fn exr() -> Vec<u8> {
    let layers = Layers { object: Some(Image::from_fn(40, 37, |x, y| x * y)), ..Layers::default() };
    encode_exr(&light(), &layers, &ExrOptions { precision: ExrPrecision::Half, ..Default::default() }).unwrap()
}

/// A Radiance picture in the new run-length encoding, made by hand.
fn hdr() -> Vec<u8> {
    let mut file = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 12 +X 20\n".to_vec();
    for row in 0..12_u8 {
        file.extend([2, 2, 0, 20]);
        for component in 0..4_u8 {
            file.extend([128 + 15, if component == 3 { 129 } else { row * 20 }]);
            file.push(5);
            file.extend((0..5).map(|i| if component == 3 { 128 } else { i * 50 + component }));
        }
    }
    file
}

fn jpeg() -> Option<Vec<u8>> {
    Some(std::fs::read(assets("gltf/AttenuationTest")?.join("khronos_screenshot-x150.jpg")).unwrap())
}

fn samples() -> Vec<(&'static str, Vec<u8>)> {
    let mut samples = vec![("png", png()), ("exr", exr()), ("hdr", hdr())];
    samples.extend(jpeg().map(|bytes| ("jpeg", bytes)));
    samples
}

#[test]
fn whole_files_decode() {
    for (name, bytes) in samples() {
        let picture = decode(&bytes, &limits()).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(!picture.image.is_empty());
    }
}

#[test]
fn a_file_cut_anywhere_is_refused() {
    for (name, bytes) in samples() {
        for length in cuts(bytes.len(), 150) {
            match decode(&bytes[..length], &limits()) {
                Err(DecodeError::Corrupt(text)) => assert!(!text.contains('{'), "{text}"),
                other => panic!("{name} cut at {length} of {}: {other:?}", bytes.len()),
            }
        }
    }
}

#[test]
fn changed_bytes_do_not_panic() {
    let mut noise = Noise(0x5eed_0001);
    for (name, bytes) in samples() {
        let rounds = if name == "jpeg" { 60 } else { 600 };
        for _ in 0..rounds {
            let _ = decode(&change(&bytes, &mut noise), &limits());
        }
    }
}

/// Changes one to four bytes. The head is where the numbers are that decide sizes: half of the changes go there.
fn change(bytes: &[u8], noise: &mut Noise) -> Vec<u8> {
    let mut changed = bytes.to_vec();
    for _ in 0..=noise.below(4) {
        let end = if noise.below(2) == 0 { changed.len().min(400) } else { changed.len() };
        let at = noise.below(end);
        changed[at] = match noise.below(4) {
            0 => 0,
            1 => 255,
            2 => changed[at] ^ (1 << noise.below(8)),
            _ => noise.below(256) as u8,
        };
    }
    changed
}

/// An EXR of 70 × 30 pixels with half, float and whole-number channels.
fn exr_with(compression: exr::compression::Compression, blocks: exr::image::Blocks) -> Vec<u8> {
    use exr::prelude::*;
    let numbers = || 0..70 * 30;
    let halves = || FlatSamples::F16(numbers().map(|i| f16::from_f32(i as f32)).collect());
    let list = [
        AnyChannel::new("R", halves()),
        AnyChannel::new("G", halves()),
        AnyChannel::new("B", FlatSamples::F32(numbers().map(|i| i as f32 / 7.0).collect())),
        AnyChannel::new("A", FlatSamples::U32(numbers().map(|i| i as u32).collect())),
    ];
    let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
    let channels = AnyChannels::sort(list.into_iter().collect());
    let mut bytes = std::io::Cursor::new(Vec::new());
    Image::from_layer(Layer::new(Vec2(70, 30), LayerAttributes::default(), encoding, channels))
        .write()
        .to_buffered(&mut bytes)
        .unwrap();
    bytes.into_inner()
}

#[test]
fn changed_bytes_do_not_panic_in_any_compression_of_exr() {
    use exr::compression::Compression::*;
    let mut noise = Noise(0x5eed_0003);
    for compression in [Uncompressed, RLE, ZIP1, ZIP16, PIZ, PXR24, B44, B44A] {
        for blocks in [exr::image::Blocks::ScanLines, exr::image::Blocks::Tiles(exr::math::Vec2(16, 16))] {
            let bytes = exr_with(compression, blocks);
            assert_eq!(decode(&bytes, &limits()).unwrap().image.size(), (70, 30), "{compression} {blocks:?}");
            for _ in 0..200 {
                let _ = decode(&change(&bytes, &mut noise), &limits());
            }
        }
    }
}

#[test]
fn exr_of_a_compression_that_believes_its_data_is_refused() {
    let bytes = exr_with(exr::compression::Compression::DWAA(None), exr::image::Blocks::ScanLines);
    assert!(matches!(decode(&bytes, &limits()), Err(DecodeError::Unsupported(_))));
}

#[test]
fn limits_hold_for_every_format() {
    for (name, bytes) in samples() {
        for tight in [
            Limits { max_width: 11, ..limits() },
            Limits { max_height: 11, ..limits() },
            Limits { max_bytes: 1000, ..limits() },
        ] {
            let found = decode(&bytes, &tight);
            assert!(matches!(found, Err(DecodeError::TooLarge(_))), "{name} under {tight:?}: {:?}", found.map(|_| ()));
        }
    }
}

#[test]
fn other_kinds_of_files_are_named() {
    for (bytes, word) in [
        (&b"GIF89a"[..], "GIF"),
        (b"BM______", "BMP"),
        (b"RIFF____WEBP", "WebP"),
        (b"", "empty"),
        (b"\x89PN", "first bytes"),
        (b"[camera]\neye = [0, 0, 1]\n", "no picture"),
        (b"\x89PNG\n\x1a\n________________", "transferred as text"),
    ] {
        let text = decode(bytes, &limits()).unwrap_err().to_string();
        assert!(text.contains(word), "{text}");
    }
}

#[test]
fn panoramas_decode() {
    let Some(folder) = assets("hdr") else { return };
    for (name, bytes) in files(&folder, "hdr") {
        let picture = decode(&bytes, &Limits::default()).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(picture.image.count_non_finite(), 0);
        let brightest = picture.image.pixels().iter().map(|pixel| pixel.max_abs()).fold(0.0, f32::max);
        assert!(brightest > 1.0 && picture.image.width() == 2 * picture.image.height(), "{name}: {brightest}");
    }
}

#[test]
fn photographs_decode() {
    let Some(folder) = assets("gltf") else { return };
    for scene in ["AttenuationTest", "SpecularTest", "TransmissionTest"] {
        for (name, bytes) in files(&folder.join(scene), "jpg").into_iter().filter(|(name, _)| !name.contains("large")) {
            let picture = decode(&bytes, &Limits::default()).unwrap_or_else(|error| panic!("{scene}/{name}: {error}"));
            let mean = picture.image.pixels().iter().map(|pixel| f64::from(pixel.luminance())).sum::<f64>()
                / picture.image.pixels().len() as f64;
            assert!((0.005..0.95).contains(&mean), "{scene}/{name} has the mean {mean}");
        }
    }
    for (name, bytes) in assets("obj-tests/assimp").map(|folder| files(&folder, "jpg")).unwrap_or_default() {
        decode(&bytes, &Limits::default()).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn made_up_bytes_do_not_panic(kind in 0_usize..4, tail in proptest::collection::vec(any::<u8>(), 0..600)) {
        let head: &[u8] = [
            &b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"[..],
            b"\xff\xd8\xff\xe0",
            b"#?RADIANCE\n\n-Y 9 +X 9\n",
            b"\x76\x2f\x31\x01\x02\0\0\0",
        ][kind];
        let _ = decode(&[head, &tail].concat(), &limits());
    }
}

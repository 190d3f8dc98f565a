//! What is encoded decodes to the same numbers, and the same picture to the same bytes.

#![allow(clippy::unwrap_used, reason = "the helpers of a test fail it as the test itself does")]

mod common;

use snell_image::{
    BitDepth, DecodeError, DisplayImage, EncodeError, ExrOptions, ExrPrecision, Format, Image, Layers, Limits,
    PngEffort, PngOptions, ToneCurve, decode, decode_display, encode_exr, encode_png,
};
use snell_math::Rgb;

fn light(width: u32, height: u32) -> Image<Rgb> {
    let mut noise = common::Noise(0x5eed_0002);
    Image::from_fn(width, height, |_, _| {
        Rgb::from([(); 3].map(|()| (noise.number() >> 40) as f32 / (1 << 22) as f32 - 0.5))
    })
}

#[test]
fn png_of_8_and_16_bits_is_exact() {
    for depth in [BitDepth::Eight, BitDepth::Sixteen] {
        for effort in [PngEffort::Fast, PngEffort::Small] {
            for (width, height) in [(1, 1), (1, 9), (64, 41), (257, 3)] {
                let display = DisplayImage::develop(&light(width, height), ToneCurve::Filmic, -0.5, depth);
                let file = encode_png(&display, &PngOptions { effort, ..Default::default() }).unwrap();
                assert_eq!(decode_display(&file, &Limits::default()).unwrap(), display);
                let picture = decode(&file, &Limits::default()).unwrap();
                assert_eq!((picture.format, &picture.alpha, picture.notes.len()), (Format::Png, &None, 0));
                assert_eq!(picture.image, display.to_linear());
                assert_eq!(DisplayImage::develop(&picture.image, ToneCurve::None, 0.0, depth), display);
            }
        }
    }
}

#[test]
fn png_says_srgb_and_carries_texts() {
    let display = DisplayImage::develop(&light(3, 3), ToneCurve::None, 0.0, BitDepth::Eight);
    let text = vec![("Software".into(), "Snell".into()), ("Title".into(), "Glas, größer als π".into())];
    let file = encode_png(&display, &PngOptions { text, ..Default::default() }).unwrap();
    let reader = png::Decoder::new(std::io::Cursor::new(&file)).read_info().unwrap();
    assert_eq!(reader.info().srgb, Some(png::SrgbRenderingIntent::Perceptual));
    assert_eq!(reader.info().uncompressed_latin1_text[0].text, "Snell");
    assert_eq!(reader.info().utf8_text[0].get_text().unwrap(), "Glas, größer als π");
    for keyword in ["", " x", "größe", "a\nb", &"x".repeat(80)] {
        let options = PngOptions { text: vec![(keyword.into(), String::new())], ..Default::default() };
        assert_eq!(encode_png(&display, &options), Err(EncodeError::Keyword(keyword.into())));
    }
}

#[test]
fn exr_in_float_is_exact_to_the_last_bit() {
    let mut light = light(61, 50);
    let specials = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.0, 1e-45, f32::MAX, f32::MIN_POSITIVE];
    for (pixel, special) in light.pixels_mut().iter_mut().zip(specials) {
        pixel.g = special;
    }
    let file = encode_exr(&light, &Layers::default(), &ExrOptions::default()).unwrap();
    let picture = decode(&file, &Limits::default()).unwrap();
    let bits =
        |image: &Image<Rgb>| image.pixels().iter().flat_map(|p| p.to_array()).map(f32::to_bits).collect::<Vec<_>>();
    assert_eq!(bits(&picture.image), bits(&light));
    assert_eq!((picture.format, picture.alpha, picture.notes), (Format::Exr, None, vec![]));
}

#[test]
fn exr_in_half_keeps_eleven_bits() {
    let light = light(16, 33);
    let options = ExrOptions { precision: ExrPrecision::Half, ..Default::default() };
    let picture = decode(&encode_exr(&light, &Layers::default(), &options).unwrap(), &Limits::default()).unwrap();
    for (found, expected) in picture.image.pixels().iter().zip(light.pixels()) {
        assert!((found.r - expected.r).abs() <= expected.r.abs() / 2048.0 + 1e-7, "{found:?} for {expected:?}");
    }
}

#[test]
fn exr_layers_are_exact_and_named() {
    use exr::prelude::*;
    let light = light(20, 17);
    let layers = snell_image::Layers {
        depth: Some(snell_image::Image::from_fn(20, 17, |x, y| if x == 0 { f32::INFINITY } else { y as f32 / 3.0 })),
        normal: Some(snell_image::Image::from_fn(20, 17, |x, y| [x as f32, -1.0, y as f32 * 0.1])),
        object: Some(snell_image::Image::from_fn(20, 17, |x, y| u32::MAX - x * y)),
    };
    let options = ExrOptions { software: Some("Snell".into()), comments: Some("a test".into()), ..Default::default() };
    let file = encode_exr(&light, &layers, &options).unwrap();

    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(std::io::Cursor::new(&file))
        .unwrap();
    let names: Vec<String> = image.layer_data.channel_data.list.iter().map(|c| c.name.to_string()).collect();
    assert_eq!(names, ["B", "G", "N.X", "N.Y", "N.Z", "R", "Z", "id"]);
    assert_eq!(image.layer_data.attributes.software_name.as_ref().unwrap().to_string(), "Snell");
    assert_eq!(image.attributes.chromaticities.unwrap().red, Vec2(0.64, 0.33));
    let samples =
        |name: &str| &image.layer_data.channel_data.list[names.iter().position(|n| n == name).unwrap()].sample_data;
    assert_eq!(samples("Z"), &FlatSamples::F32(layers.depth.as_ref().unwrap().pixels().to_vec()));
    let normal = layers.normal.as_ref().unwrap().pixels();
    assert_eq!(samples("N.Z"), &FlatSamples::F32(normal.iter().map(|n| n[2]).collect()));
    assert_eq!(samples("id"), &FlatSamples::U32(layers.object.as_ref().unwrap().pixels().to_vec()));
    assert_eq!(decode(&file, &Limits::default()).unwrap().image, light);
}

#[test]
fn the_same_picture_gives_the_same_bytes() {
    let light = light(100, 130);
    let layers = Layers { depth: Some(light.map(|pixel| pixel.r)), ..Layers::default() };
    let encode = || {
        let display = DisplayImage::develop(&light, ToneCurve::None, 0.0, BitDepth::Eight);
        let exr =
            encode_exr(&light, &layers, &ExrOptions { software: Some("Snell".into()), ..Default::default() }).unwrap();
        (encode_png(&display, &PngOptions::default()).unwrap(), exr)
    };
    let first = encode();
    assert_eq!(first, encode());
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(encode);
    assert_eq!(first, alone);
}

#[test]
fn other_exr_files_are_read() {
    use exr::prelude::*;
    let write = |image: Image<Layer<AnyChannels<FlatSamples>>>| {
        let mut bytes = std::io::Cursor::new(Vec::new());
        image.write().to_buffered(&mut bytes).unwrap();
        bytes.into_inner()
    };
    let channel = |name: &str, offset: usize| {
        AnyChannel::new(name, FlatSamples::F32((0..70 * 30).map(|i| (i + offset) as f32).collect()))
    };
    let file = |names: &[&str], encoding: Encoding| {
        let list = names.iter().enumerate().map(|(i, name)| channel(name, i * 10_000)).collect();
        let layer = Layer::new(Vec2(70, 30), LayerAttributes::default(), encoding, AnyChannels::sort(list));
        write(Image::from_layer(layer))
    };
    let decode = |bytes: &[u8]| decode(bytes, &Limits::default());

    let tiles = Blocks::Tiles(Vec2(16, 16));
    for compression in [Compression::Uncompressed, Compression::RLE, Compression::ZIP1, Compression::PIZ] {
        for blocks in [Blocks::ScanLines, tiles] {
            for line_order in [LineOrder::Increasing, LineOrder::Decreasing] {
                let picture =
                    decode(&file(&["R", "G", "B", "A"], Encoding { compression, blocks, line_order })).unwrap();
                assert_eq!(
                    picture.image.get(69, 1),
                    Some(&Rgb::new(139.0, 10_139.0, 20_139.0)),
                    "{compression} {blocks:?}"
                );
                assert_eq!(picture.alpha.unwrap().get(3, 0), Some(&30_003.0));
            }
        }
    }
    let gray = decode(&file(&["Y"], Encoding::FAST_LOSSLESS)).unwrap();
    assert_eq!(gray.image.get(1, 0), Some(&Rgb::gray(1.0)));
    let layered = decode(&file(&["beauty.R", "beauty.G", "beauty.B", "Z"], Encoding::FAST_LOSSLESS)).unwrap();
    assert_eq!(layered.image.get(0, 0), Some(&Rgb::new(0.0, 10_000.0, 20_000.0)));
    let depth = decode(&file(&["Z"], Encoding::FAST_LOSSLESS));
    assert_eq!(depth, Err(DecodeError::Unsupported("the OpenEXR has no channels R, G and B, nor Y".into())));
}

#[test]
fn pictures_that_cannot_be_written_are_refused() {
    let empty = DisplayImage::develop(&light(0, 3), ToneCurve::None, 0.0, BitDepth::Eight);
    assert_eq!(encode_png(&empty, &PngOptions::default()), Err(EncodeError::Empty { width: 0, height: 3 }));
    let layers = Layers { depth: Some(Image::filled(2, 2, 0.0)), ..Layers::default() };
    assert_eq!(
        encode_exr(&light(2, 3), &layers, &ExrOptions::default()),
        Err(EncodeError::LayerSize { layer: "depth", size: (2, 2), expected: (2, 3) })
    );
}

/// Radiance pictures of 2 × 3 pixels in each orientation, flat; the pixel's red says where it must go.
#[test]
fn radiance_pictures_come_upright_from_every_orientation() {
    let file = |resolution: &str, order: [(u8, u8); 6]| {
        let mut file = format!("#?RGBE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n{resolution}\n").into_bytes();
        file.extend(order.into_iter().flat_map(|(x, y)| [10 * x + y + 8, 0, 0, 136]));
        file
    };
    let by_rows = |xs: [u8; 2], ys: [u8; 3]| [0, 1, 2, 3, 4, 5].map(|i| (xs[i % 2], ys[i / 2]));
    let by_columns = |xs: [u8; 2], ys: [u8; 3]| [0, 1, 2, 3, 4, 5].map(|i| (xs[i / 3], ys[i % 3]));
    let (right, left, down, up) = ([0, 1], [1, 0], [0, 1, 2], [2, 1, 0]);
    for (resolution, order) in [
        ("-Y 3 +X 2", by_rows(right, down)),
        ("-Y 3 -X 2", by_rows(left, down)),
        ("+Y 3 +X 2", by_rows(right, up)),
        ("+Y 3 -X 2", by_rows(left, up)),
        ("+X 2 -Y 3", by_columns(right, down)),
        ("-X 2 -Y 3", by_columns(left, down)),
        ("+X 2 +Y 3", by_columns(right, up)),
        ("-X 2 +Y 3", by_columns(left, up)),
    ] {
        let picture = decode(&file(resolution, order), &Limits::default()).unwrap();
        let expected = Image::from_fn(2, 3, |x, y| Rgb::new((10 * x + y + 8) as f32, 0.0, 0.0));
        assert_eq!(picture.image, expected, "{resolution}");
        assert_eq!(picture.notes.len(), 1, "its exposure is noted");
    }
}

#[test]
fn radiance_numbers_and_old_runs() {
    let mut file = b"#?RADIANCE\n# comment\n\n-Y 1 +X 300\n".to_vec();
    file.extend([255, 128, 0, 255]); // the brightest exponent
    file.extend([1, 1, 1, 0x2a]); // 42 more of it
    file.extend([1, 1, 1, 0x00]);
    file.extend([1, 128, 255, 1]); // the darkest
    file.extend([1, 1, 1, 0]); // none more, and then 256 of them
    file.extend([1, 1, 1, 1]);
    let picture = decode(&file, &Limits::default()).unwrap();
    let power = |exponent: i32| {
        if exponent > 0 { (0..exponent).fold(1.0_f64, |p, _| p * 2.0) } else { (exponent..0).fold(1.0, |p, _| p / 2.0) }
    };
    let bright = Rgb::new((255.0 * power(119)) as f32, (128.0 * power(119)) as f32, 0.0);
    let dark = Rgb::new(power(-135) as f32, (128.0 * power(-135)) as f32, (255.0 * power(-135)) as f32);
    assert!(picture.image.row(0)[..43].iter().all(|pixel| *pixel == bright));
    assert!(picture.image.row(0)[43..].iter().all(|pixel| *pixel == dark) && dark.r > 0.0);

    for (resolution, wrong) in [("-Y 2 +Y 2", "form"), ("-Y 2", "form"), ("-Y a +X 2", "form"), ("-Y 0 +X 2", "none")] {
        let error = decode(format!("#?RGBE\n\n{resolution}\n").as_bytes(), &Limits::default()).unwrap_err();
        assert!(error.to_string().contains(wrong), "{error}");
    }
}

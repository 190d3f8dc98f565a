//! PngSuite (Willem van Schaik) and the crashers of libpng and stb: every valid file decodes to the values that others
//! found in it, every broken one is refused in words.

#![allow(clippy::unwrap_used, reason = "the helpers of a test fail it as the test itself does")]

mod common;

use common::{assets, files};
use snell_image::{DecodeError, Format, Limits, Picture, decode};
use snell_math::{Rgb, portable};

/// The numbers of a JSON array, which may have a comma after the last.
fn numbers(json: &[u8]) -> Vec<u32> {
    String::from_utf8_lossy(json)
        .split(|c: char| !c.is_ascii_digit())
        .filter(|word| !word.is_empty())
        .map(|word| word.parse().unwrap())
        .collect()
}

/// The gAMA chunk's exponent, where there is one.
fn gamma(png: &[u8]) -> Option<f64> {
    let at = png.windows(4).position(|window| window == b"gAMA")? + 4;
    Some(f64::from(u32::from_be_bytes(png[at..at + 4].try_into().unwrap())) / 100_000.0)
}

/// Light back to codes, by the formulas, independent of the decoder's tables.
fn code(linear: f32, gamma: Option<f64>, max_code: f64) -> u32 {
    let linear = f64::from(linear);
    let encoded = match gamma {
        Some(gamma) => portable::pow(linear, gamma),
        None if linear <= 0.003_130_8 => linear * 12.92,
        None => 1.055 * portable::pow(linear, 1.0 / 2.4) - 0.055,
    };
    (encoded * max_code + 0.5) as u32
}

#[test]
fn valid_files_decode_to_the_expected_values() {
    let Some(folder) = assets("png/pngsuite") else { return };
    let mut compared = 0;
    for (name, bytes) in files(&folder.join("png"), "png").into_iter().filter(|(name, _)| !name.starts_with('x')) {
        let Picture { image, alpha, format, .. } =
            decode(&bytes, &Limits::default()).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(format, Format::Png);
        let json = std::fs::read(folder.join(format!("json/{name}.json"))).unwrap_or_default();
        let expected = numbers(&json);
        if expected.is_empty() {
            continue;
        }
        assert_eq!(expected.len(), image.pixels().len() * 4, "{name}");
        let max_code = if bytes[24] == 16 { 65535 } else { 255 };
        let gamma = gamma(&bytes);
        for (index, (pixel, expected)) in image.pixels().iter().zip(expected.chunks_exact(4)).enumerate() {
            let coverage = alpha.as_ref().map_or(1.0, |alpha| alpha.pixels()[index]);
            let found_alpha = (coverage * max_code as f32 + 0.5) as u32;
            let [red, green, blue] = pixel.to_array().map(|linear| code(linear, gamma, f64::from(max_code)));
            assert_eq!([red, green, blue, found_alpha], expected, "{name}, pixel {index}, gamma {gamma:?}");
        }
        compared += 1;
    }
    assert!(compared > 150, "only {compared} files had expected values");
}

#[test]
fn broken_files_are_refused_in_words() {
    let Some(folder) = assets("png/pngsuite/png") else { return };
    let mut broken: Vec<_> = files(&folder, "png").into_iter().filter(|(name, _)| name.starts_with('x')).collect();
    if let Some(corrupt) = assets("bad/png-stb-corrupt") {
        broken.extend(files(&corrupt, "png"));
    }
    assert!(broken.len() >= 28);
    for (name, bytes) in broken {
        match decode(&bytes, &Limits::default()) {
            Err(DecodeError::Corrupt(text)) => {
                println!("{name}: {text}");
                assert!(!text.contains('{') && !text.ends_with('.') && text.len() < 120, "{name}: {text}");
            }
            other => panic!("{name}: {other:?}"),
        }
    }
}

#[test]
fn a_wrong_checksum_is_told_by_its_chunk() {
    let Some(folder) = assets("png/pngsuite/png") else { return };
    let decode_file = |name: &str| decode(&std::fs::read(folder.join(name)).unwrap(), &Limits::default());
    let text = decode_file("xcsn0g01.png").unwrap_err().to_string();
    assert_eq!(text, "the PNG's CRC is wrong in chunk IDAT");
    let text = decode_file("xhdn0g08.png").unwrap_err().to_string();
    assert_eq!(text, "the PNG's CRC is wrong in chunk IHDR");
}

#[test]
fn crashers_do_not_crash() {
    let Some(folder) = assets("bad/png-libpng-crashers") else { return };
    let found = files(&folder, "png");
    assert!(found.len() >= 20);
    for (name, bytes) in found {
        match decode(&bytes, &Limits::default()) {
            Ok(picture) => println!("{name}: {:?} {:?}", picture.image.size(), picture.notes),
            Err(error) => println!("{name}: {error}"),
        }
    }
}

/// A gray PNG of 1 × 1 with the given chunks before its data, made by hand.
fn one_pixel(code: u8, chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut put = |kind: &[u8; 4], data: &[u8]| {
        let mut hasher = crc32fast::Hasher::new();
        hasher.update(kind);
        hasher.update(data);
        file.extend((data.len() as u32).to_be_bytes());
        file.extend(kind);
        file.extend(data);
        file.extend(hasher.finalize().to_be_bytes());
    };
    put(b"IHDR", &[0, 0, 0, 1, 0, 0, 0, 1, 8, 0, 0, 0, 0]);
    for (kind, data) in chunks {
        put(kind, data);
    }
    // zlib: header, one stored block of filter byte and code, Adler-32.
    let adler_low = 1 + u16::from(code);
    let adler_high = 1 + adler_low;
    let mut data = vec![0x78, 0x01, 0x01, 2, 0, 0xfd, 0xff, 0, code];
    data.extend(adler_high.to_be_bytes());
    data.extend(adler_low.to_be_bytes());
    put(b"IDAT", &data);
    put(b"IEND", &[]);
    file
}

fn light_of(chunks: &[(&[u8; 4], &[u8])]) -> (f32, Vec<String>) {
    let picture = decode(&one_pixel(128, chunks), &Limits::default()).unwrap();
    (picture.image.pixels()[0].g, picture.notes)
}

#[test]
fn chunks_decide_what_codes_mean() {
    let half = 128.0_f32 / 255.0;
    let srgb = Rgb::from_srgb([half; 3]).g;
    let gamma_one = 100_000_u32.to_be_bytes();
    assert_eq!(light_of(&[]).0, srgb, "nothing said: sRGB");
    assert_eq!(light_of(&[(b"gAMA", &gamma_one)]).0, half, "gAMA of one: linear");
    assert_eq!(light_of(&[(b"sRGB", &[0]), (b"gAMA", &gamma_one)]).0, srgb, "sRGB wins over gAMA");
    assert_eq!(light_of(&[(b"cICP", &[1, 8, 0, 1]), (b"sRGB", &[0])]).0, half, "cICP wins over all");
    let power = light_of(&[(b"gAMA", &45_455_u32.to_be_bytes())]).0;
    assert!((f64::from(power) - portable::pow(f64::from(half), 2.2)).abs() < 1e-5);
    assert!(light_of(&[(b"gAMA", &[0; 4])]).0.is_finite());

    let wide = [31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000_u32].map(u32::to_be_bytes).concat();
    assert_eq!(light_of(&[(b"cHRM", &wide)]).1, ["the PNG's primaries are not sRGB's; they were taken for such"]);
    let pq = decode(&one_pixel(1, &[(b"cICP", &[9, 16, 0, 1])]), &Limits::default());
    assert!(matches!(pq, Err(DecodeError::Unsupported(_))), "{pq:?}");
}

#[test]
fn a_small_file_cannot_ask_for_much_memory() {
    // 30000 × 30000 pixels said by 70 bytes: refused before anything of that size is allocated.
    let mut file = one_pixel(1, &[]);
    file[16..20].copy_from_slice(&30_000_u32.to_be_bytes());
    file[20..24].copy_from_slice(&30_000_u32.to_be_bytes());
    let crc = {
        let mut hasher = crc32fast::Hasher::new();
        hasher.update(&file[12..29]);
        hasher.finalize()
    };
    file[29..33].copy_from_slice(&crc.to_be_bytes());
    assert!(matches!(decode(&file, &Limits::default()), Err(DecodeError::TooLarge(_))));
    let generous = Limits { max_bytes: u64::MAX, ..Limits::default() };
    let error = decode(&file, &generous).unwrap_err();
    assert!(error.to_string().contains("too few"), "{error}");
    assert!(matches!(error, DecodeError::Corrupt(_)));
}

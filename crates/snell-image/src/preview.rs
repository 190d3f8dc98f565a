//! Pictures in a terminal, as text to print: half blocks in 24 bit colour, which most terminals show, and whole pictures
//! in the protocols of kitty (sw.kovidgoyal.net/kitty/graphics-protocol) and iTerm2 (iterm2.com/documentation-images).
//!
//! These are pure functions. Which of them a terminal understands is for its shell to find out.

use std::fmt::Write;

use snell_math::Rgb;

use crate::resize::{fit, resize};
use crate::{BitDepth, DisplayImage, Image, ToneCurve};

/// The picture as lines of `▀`, each showing two pixels: the upper in its own colour, the lower in the background's. At most
/// `columns` wide, smaller pictures in their own size; each line ends with a reset and a line feed.
///
/// ```
/// use snell_image::{Image, ToneCurve, preview::half_blocks};
/// use snell_math::Rgb;
/// let flag = Image::from_fn(1, 2, |_, y| if y == 0 { Rgb::WHITE } else { Rgb::new(1.0, 0.0, 0.0) });
/// let text = half_blocks(&flag, ToneCurve::None, 0.0, 80);
/// assert_eq!(text, "\x1b[38;2;255;255;255m\x1b[48;2;255;0;0m▀\x1b[0m\n");
/// ```
#[must_use]
pub fn half_blocks(light: &Image<Rgb>, tone: ToneCurve, exposure: f32, columns: u32) -> String {
    let (width, height) = fit(light.size(), columns, u32::MAX);
    let small = DisplayImage::develop(&resize(light, width, height), tone, exposure, BitDepth::Eight);
    let mut text = String::new();
    for y in (0..small.height()).step_by(2) {
        // Colours are said only where they change.
        let (mut foreground, mut background) = (None, None);
        for x in 0..small.width() {
            let upper = small.code(x, y);
            let lower = (y + 1 < small.height()).then(|| small.code(x, y + 1));
            if foreground != Some(upper) {
                color(&mut text, 38, upper);
                foreground = Some(upper);
            }
            if let Some(lower) = lower.filter(|lower| background != Some(*lower)) {
                color(&mut text, 48, lower);
                background = Some(lower);
            }
            text.push('▀');
        }
        text.push_str("\x1b[0m\n");
    }
    text
}

fn color(text: &mut String, layer: u8, [red, green, blue]: [u16; 3]) {
    // Writing to a string cannot fail.
    let _ = write!(text, "\x1b[{layer};2;{red};{green};{blue}m");
}

/// A PNG file as kitty's graphics protocol shows it, scaled to `columns` cells where that is given.
#[must_use]
pub fn kitty(png: &[u8], columns: Option<u32>) -> String {
    /// The protocol's longest piece of base64.
    const PIECE: usize = 4096;
    let encoded = base64(png);
    let size = columns.map(|columns| format!(",c={columns}")).unwrap_or_default();
    let mut text = String::with_capacity(encoded.len() + encoded.len() / PIECE * 16 + 64);
    let mut rest = encoded.as_str();
    let mut control = format!("a=T,f=100{size},");
    loop {
        let (piece, after) = rest.split_at(rest.len().min(PIECE));
        let more = u8::from(!after.is_empty());
        let _ = write!(text, "\x1b_G{control}m={more};{piece}\x1b\\");
        if after.is_empty() {
            text.push('\n');
            return text;
        }
        rest = after;
        control.clear();
    }
}

/// A PNG or JPEG file as iTerm2 shows it inline, scaled to `columns` cells where that is given.
#[must_use]
pub fn iterm2(file: &[u8], columns: Option<u32>) -> String {
    let width = columns.map(|columns| format!(";width={columns}")).unwrap_or_default();
    format!("\x1b]1337;File=inline=1;size={}{width};preserveAspectRatio=1:{}\x07\n", file.len(), base64(file))
}

/// Base64 with padding (RFC 4648, section 4).
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let at = |i: usize| u32::from(group.get(i).copied().unwrap_or(0));
        let bits = at(0) << 16 | at(1) << 8 | at(2);
        for digit in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * digit) & 63) as usize];
            text.push(if digit <= group.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_the_standard() {
        // RFC 4648, section 10.
        let pairs =
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg=="), ("fooba", "Zm9vYmE=")];
        for (plain, encoded) in pairs {
            assert_eq!(base64(plain.as_bytes()), encoded);
        }
        assert_eq!(base64(&[0xfb, 0xff]), "+/8=");
    }

    #[test]
    fn half_blocks_fit_the_terminal() {
        let light = Image::from_fn(100, 51, |x, y| Rgb::new(x as f32 / 99.0, y as f32 / 50.0, 0.0));
        let text = half_blocks(&light, ToneCurve::None, 0.0, 40);
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(lines.len(), 10, "51 · 40/100 rows, two in a line");
        assert!(lines.iter().all(|line| line.matches('▀').count() == 40 && line.ends_with("\x1b[0m")));
        assert_eq!(half_blocks(&Image::filled(3, 3, Rgb::WHITE), ToneCurve::None, 0.0, 80).lines().count(), 2);
        assert_eq!(half_blocks(&Image::filled(0, 0, Rgb::WHITE), ToneCurve::None, 0.0, 80), "");
        assert_eq!(half_blocks(&light, ToneCurve::None, 0.0, 0).matches('▀').count(), 1);
    }

    #[test]
    fn a_last_row_alone_has_no_background() {
        let text = half_blocks(&Image::filled(2, 3, Rgb::WHITE), ToneCurve::None, 0.0, 80);
        let last = text.lines().last().unwrap();
        assert!(!last.contains("48;2") && last.contains("38;2;255;255;255"));
    }

    #[test]
    fn kitty_gets_pieces_and_all_of_them() {
        let file: Vec<u8> = (0..10_000_u32).map(|i| (i * 7) as u8).collect();
        let text = kitty(&file, Some(60));
        let pieces: Vec<_> = text.trim_end().split_terminator("\x1b\\").collect();
        assert_eq!(pieces.len(), 4);
        assert!(pieces[0].starts_with("\x1b_Ga=T,f=100,c=60,m=1;"));
        assert!(pieces[1].starts_with("\x1b_Gm=1;") && pieces[3].starts_with("\x1b_Gm=0;"));
        let joined: String = pieces.iter().map(|piece| piece.split_once(';').unwrap().1).collect();
        assert_eq!(joined, base64(&file));
        assert_eq!(kitty(b"x", None), "\x1b_Ga=T,f=100,m=0;eA==\x1b\\\n");
    }

    #[test]
    fn iterm2_gets_one_file() {
        assert_eq!(iterm2(b"foo", Some(9)), "\x1b]1337;File=inline=1;size=3;width=9;preserveAspectRatio=1:Zm9v\x07\n");
    }
}

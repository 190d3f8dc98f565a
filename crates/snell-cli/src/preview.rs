//! `--preview`: which kind of picture the terminal shows, and the picture in that kind.
//!
//! Terminals say who they are in environment variables: `TERM`, `TERM_PROGRAM`, `COLORTERM` and some of their own.

use std::fmt::Write;
use std::io::IsTerminal;

use snell::image::preview::{half_blocks, iterm2, kitty};
use snell::image::resize::{fit, resize};
use snell::image::{BitDepth, DisplayImage, Image, PngOptions, encode_png_of_light};
use snell::math::Rgb;
use snell::render::RenderSettings;
use snell::scene::Diagnostic;

use crate::failure::Failure;

/// The width where the terminal does not tell; columns.
const USUAL_COLUMNS: u32 = 80;
/// The height where the terminal does not tell; rows.
const USUAL_ROWS: u32 = 24;

/// A kind of picture in a terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Whole pictures by kitty's protocol.
    Kitty,
    /// Whole pictures by iTerm2's protocol.
    Iterm2,
    /// Half blocks in 24 bit colour.
    TrueColor,
    /// Half blocks in the 256 colours of xterm.
    Colors256,
}

impl Kind {
    /// The best that standard output can show.
    pub fn of_stdout() -> Result<Self, Failure> {
        let refuse =
            |message: &str| Err(Failure::usage(Diagnostic::error(message).help("write a file instead: -o NAME.png")));
        if !std::io::stdout().is_terminal() {
            return refuse("--preview needs a terminal, and standard output is none");
        }
        let kind = Self::choose(&|name| std::env::var(name).ok().filter(|value| !value.is_empty()));
        kind.map_or_else(|| refuse("--preview needs a terminal with colours, and this one has none"), Ok)
    }

    fn choose(variable: &dyn Fn(&str) -> Option<String>) -> Option<Self> {
        let value = |name: &str| variable(name).unwrap_or_default();
        let (term, program) = (value("TERM"), value("TERM_PROGRAM"));
        // A multiplexer keeps its terminal's variables but does not pass pictures on.
        let multiplexed = term.starts_with("screen")
            || term.starts_with("tmux")
            || ["TMUX", "STY"].iter().any(|name| variable(name).is_some());
        if term == "dumb" {
            return None;
        }
        if !multiplexed {
            if term == "xterm-kitty"
                || term == "xterm-ghostty"
                || program == "ghostty"
                || variable("KITTY_WINDOW_ID").is_some()
            {
                return Some(Self::Kitty);
            }
            let names = ["iTerm.app", "WezTerm", "mintty"];
            if names.contains(&program.as_str()) || value("LC_TERMINAL") == "iTerm2" {
                return Some(Self::Iterm2);
            }
        }
        let true_color = ["truecolor", "24bit"].contains(&value("COLORTERM").as_str())
            || term.ends_with("-direct")
            || variable("WT_SESSION").is_some();
        Some(if true_color { Self::TrueColor } else { Self::Colors256 })
    }
}

/// The picture as the text that shows it, no larger than the terminal.
pub fn text(kind: Kind, light: &Image<Rgb>, settings: &RenderSettings) -> Result<String, Failure> {
    let size = terminal_size::terminal_size_of(std::io::stdout());
    let (columns, rows) = size.map_or((USUAL_COLUMNS, USUAL_ROWS), |(width, height)| (width.0.into(), height.0.into()));
    let (tone, exposure) = (settings.tone_curve(), settings.exposure);
    let columns = columns_that_fit(light.size(), columns, rows);
    Ok(match kind {
        Kind::TrueColor => half_blocks(light, tone, exposure, columns),
        Kind::Colors256 => {
            let (width, height) = fit(light.size(), columns, u32::MAX);
            let small = resize(light, width, height);
            half_blocks_256(&DisplayImage::develop(&small, tone, exposure, BitDepth::Eight))
        }
        Kind::Kitty | Kind::Iterm2 => {
            let png = encode_png_of_light(light, tone, exposure, &PngOptions::default())
                .map_err(|error| Failure::input(Diagnostic::error(error.to_string())))?;
            if kind == Kind::Kitty { kitty(&png, Some(columns)) } else { iterm2(&png, Some(columns)) }
        }
    })
}

/// As many columns as leave the whole picture on the screen with two lines to spare. A cell is twice as high as wide.
fn columns_that_fit((width, height): (u32, u32), columns: u32, rows: u32) -> u32 {
    let rows = u64::from(rows.saturating_sub(2).max(1));
    let by_height = rows * 2 * u64::from(width) / u64::from(height.max(1));
    u64::from(columns).min(by_height).max(1) as u32
}

/// Lines of `▀` as of [`half_blocks`], in the colours 16 to 255 that terminals have in common.
fn half_blocks_256(picture: &DisplayImage) -> String {
    let mut text = String::new();
    for y in (0..picture.height()).step_by(2) {
        for x in 0..picture.width() {
            // Writing to a string cannot fail.
            let _ = write!(text, "\x1b[38;5;{}m", color_256(picture.code(x, y)));
            if y + 1 < picture.height() {
                let _ = write!(text, "\x1b[48;5;{}m", color_256(picture.code(x, y + 1)));
            }
            text.push('▀');
        }
        text.push_str("\x1b[0m\n");
    }
    text
}

/// The nearest of xterm's colours: the cube of 6 × 6 × 6 from 16 on, or the 24 greys from 232 on. Codes are 0 to 255.
fn color_256(codes: [u16; 3]) -> u16 {
    const LEVELS: [u16; 6] = [0, 95, 135, 175, 215, 255];
    let squared = |to: [u16; 3]| -> u32 { (0..3).map(|i| u32::from(codes[i].abs_diff(to[i])).pow(2)).sum() };
    let nearest = codes.map(|code| (0..6).min_by_key(|&i| LEVELS[i].abs_diff(code)).unwrap_or(0));
    let grey = (codes.iter().sum::<u16>() / 3).saturating_sub(3) / 10;
    let grey = grey.min(23);
    if squared([8 + 10 * grey; 3]) < squared(nearest.map(|i| LEVELS[i])) {
        return 232 + grey;
    }
    let [red, green, blue] = nearest.map(|i| i as u16);
    16 + 36 * red + 6 * green + blue
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(variables: &[(&str, &str)]) -> Option<Kind> {
        Kind::choose(&|name| variables.iter().find(|(other, _)| *other == name).map(|(_, value)| (*value).to_owned()))
    }

    #[test]
    fn terminals_get_the_best_that_they_show() {
        assert_eq!(chosen(&[("TERM", "xterm-kitty")]), Some(Kind::Kitty));
        assert_eq!(chosen(&[("TERM", "xterm-256color"), ("KITTY_WINDOW_ID", "1")]), Some(Kind::Kitty));
        assert_eq!(chosen(&[("TERM", "xterm-256color"), ("TERM_PROGRAM", "iTerm.app")]), Some(Kind::Iterm2));
        assert_eq!(chosen(&[("TERM", "xterm-256color"), ("COLORTERM", "truecolor")]), Some(Kind::TrueColor));
        assert_eq!(chosen(&[("TERM", "xterm-256color")]), Some(Kind::Colors256));
        assert_eq!(chosen(&[("TERM", "dumb"), ("COLORTERM", "truecolor")]), None);
    }

    #[test]
    fn multiplexers_do_not_pass_pictures_on() {
        let inside = [("TERM", "tmux-256color"), ("KITTY_WINDOW_ID", "1"), ("COLORTERM", "truecolor")];
        assert_eq!(chosen(&inside), Some(Kind::TrueColor));
        assert_eq!(chosen(&[("TERM", "xterm-kitty"), ("TMUX", "/tmp/tmux-0/default,1,0")]), Some(Kind::Colors256));
    }

    #[test]
    fn pictures_fit_the_screen() {
        assert_eq!(columns_that_fit((1024, 768), 80, 24), 58);
        assert_eq!(columns_that_fit((1024, 768), 40, 100), 40);
        assert_eq!(columns_that_fit((1, 65536), 80, 24), 1);
        assert_eq!(columns_that_fit((65536, 1), 80, 0), 80);
    }

    #[test]
    fn colors_are_the_nearest_of_256() {
        assert_eq!(color_256([0, 0, 0]), 16);
        assert_eq!(color_256([255, 255, 255]), 231);
        assert_eq!(color_256([255, 0, 0]), 196);
        assert_eq!(color_256([95, 135, 175]), 67);
        assert_eq!(color_256([118, 118, 118]), 243);
        // Brute force over all that there are.
        let level = |i: u16| if i == 0 { 0 } else { 55 + 40 * i };
        let color = |n: u16| match n {
            232.. => [8 + 10 * (n - 232); 3],
            _ => [level((n - 16) / 36), level((n - 16) / 6 % 6), level((n - 16) % 6)],
        };
        for step in 0..512_u16 {
            let codes = [step * 37 % 256, step * 91 % 256, step * 53 % 256];
            let distance = |n: u16| (0..3).map(|i| u32::from(color(n)[i].abs_diff(codes[i])).pow(2)).sum::<u32>();
            let best = (16..256).map(distance).min();
            assert_eq!(Some(distance(color_256(codes))), best, "{codes:?}");
        }
    }

    #[test]
    fn lines_end_with_a_reset() {
        let light = Image::filled(3, 3, Rgb::WHITE);
        let display = DisplayImage::develop(&light, snell::image::ToneCurve::None, 0.0, BitDepth::Eight);
        let text = half_blocks_256(&display);
        assert_eq!(text.lines().count(), 2);
        assert!(text.lines().all(|line| line.matches('▀').count() == 3 && line.ends_with("\x1b[0m")));
    }
}

//! Radiance's picture format (Ward, "Real Pixels", Graphics Gems II, 1991; and the format's reference at radsite.lbl.gov)
//! to scene-linear light: RGBE pixels, flat or run-length encoded in the old and the new way, in all eight orientations.
//!
//! A mantissa byte m with exponent byte e is `m · 2^(e − 136)`, as every writer means it. The numbers are taken as they
//! are: an EXPOSURE line other than 1 is noted and not divided out. XYZE pictures are refused.

use snell_math::Rgb;

use super::error::{COLOR_BYTES, image_of};
use super::{DecodeError, Format, Limits, Picture};

const FORMAT: Format = Format::Hdr;

/// Decodes a Radiance picture.
///
/// # Errors
/// See [`super::decode`].
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<Picture, DecodeError> {
    let mut lines = Lines { rest: bytes };
    let notes = read_header(&mut lines)?;
    let layout = Layout::parse(lines.next().ok_or_else(|| cut("before its resolution"))?)?;
    let (width, height) = (layout.width(), layout.height());
    limits.check(FORMAT, width, height, COLOR_BYTES)?;

    let mut input = Input { rest: lines.rest };
    let columns = layout.minor.count as usize;
    // Each scan line takes four bytes at least, however well it is packed.
    if u64::from(layout.major.count) * 4 > input.rest.len() as u64 {
        return Err(cut("within its pixels"));
    }
    let mut pixels = vec![Rgb::BLACK; width as usize * height as usize];
    let mut line = vec![[0_u8; 4]; columns];
    for i in 0..layout.major.count {
        input.scan_line(&mut line).map_err(|problem| match problem {
            Problem::Cut => cut("within its pixels"),
            Problem::Overrun => DecodeError::Corrupt(format!(
                "the Radiance HDR is damaged: a run passes the end of scan line {}",
                i + 1
            )),
            Problem::Length => DecodeError::Corrupt(format!(
                "the Radiance HDR is damaged: scan line {} says another length than the header",
                i + 1
            )),
        })?;
        for (j, rgbe) in (0..).zip(&line) {
            let (x, y) = layout.place(i, j);
            pixels[y as usize * width as usize + x as usize] = light(*rgbe);
        }
    }
    let image = image_of(FORMAT, width, height, pixels)?;
    Ok(Picture { image, alpha: None, format: FORMAT, notes })
}

fn cut(place: &str) -> DecodeError {
    DecodeError::Corrupt(format!("the Radiance HDR is cut short: it ends {place}"))
}

/// One RGBE pixel as light; every product is exact.
fn light([red, green, blue, exponent]: [u8; 4]) -> Rgb {
    if exponent == 0 {
        return Rgb::BLACK;
    }
    let scale = f64::from_bits((u64::from(exponent) + 1023 - 136) << 52);
    Rgb::from([red, green, blue].map(|mantissa| (f64::from(mantissa) * scale) as f32))
}

/// Reads the lines up to the empty one; gives notes.
fn read_header(lines: &mut Lines<'_>) -> Result<Vec<String>, DecodeError> {
    let mut exposure = 1.0_f64;
    loop {
        let line = lines.next().ok_or_else(|| cut("within its header"))?;
        let line = line.trim();
        if line.is_empty() {
            break;
        }
        if let Some(format) = line.strip_prefix("FORMAT=") {
            match format.trim() {
                "32-bit_rle_rgbe" => {}
                "32-bit_rle_xyze" => {
                    return Err(DecodeError::Unsupported(
                        "the Radiance HDR holds CIE XYZ colours; convert it with Radiance's ra_xyze -r".into(),
                    ));
                }
                other => {
                    let other: String = other.chars().take(40).collect();
                    return Err(DecodeError::Unsupported(format!("the Radiance HDR has the unknown format `{other}`")));
                }
            }
        } else if let Some(value) = line.strip_prefix("EXPOSURE=") {
            // Several multiply.
            exposure *= value.trim().parse::<f64>().unwrap_or(1.0);
        }
    }
    let mut notes = Vec::new();
    if (exposure - 1.0).abs() > 1e-6 {
        notes.push(format!("the Radiance HDR has exposure {exposure}; its numbers were taken as they are"));
    }
    Ok(notes)
}

struct Lines<'a> {
    rest: &'a [u8],
}

impl Lines<'_> {
    /// The next line without its end, where one ends.
    fn next(&mut self) -> Option<String> {
        let end = self.rest.iter().position(|&byte| byte == b'\n')?;
        let line = String::from_utf8_lossy(&self.rest[..end]).into_owned();
        self.rest = &self.rest[end + 1..];
        Some(line)
    }
}

/// One of the two numbers of the resolution line, such as `-Y 512`.
#[derive(Clone, Copy)]
struct Axis {
    is_y: bool,
    /// `+`: towards larger coordinates; Y counts upwards.
    increasing: bool,
    count: u32,
}

/// `-Y height +X width` and its seven relatives: scan lines lie along the minor axis.
#[derive(Clone, Copy)]
struct Layout {
    major: Axis,
    minor: Axis,
}

impl Layout {
    fn parse(line: String) -> Result<Self, DecodeError> {
        let wrong = || {
            let line: String = line.chars().take(40).collect();
            DecodeError::Corrupt(format!(
                "the Radiance HDR's resolution `{}` is not of the form `-Y 512 +X 1024`",
                line.trim()
            ))
        };
        let words: Vec<&str> = line.split_whitespace().collect();
        let [first, first_count, second, second_count] = words[..] else { return Err(wrong()) };
        let axis = |name: &str, count: &str| {
            let (is_y, increasing) = match name {
                "+X" => (false, true),
                "-X" => (false, false),
                "+Y" => (true, true),
                "-Y" => (true, false),
                _ => return Err(wrong()),
            };
            Ok(Axis { is_y, increasing, count: count.parse().map_err(|_| wrong())? })
        };
        let layout = Self { major: axis(first, first_count)?, minor: axis(second, second_count)? };
        if layout.major.is_y == layout.minor.is_y { Err(wrong()) } else { Ok(layout) }
    }

    fn width(&self) -> u32 {
        if self.major.is_y { self.minor.count } else { self.major.count }
    }

    fn height(&self) -> u32 {
        if self.major.is_y { self.major.count } else { self.minor.count }
    }

    /// Column and row of pixel `j` in scan line `i`.
    fn place(&self, i: u32, j: u32) -> (u32, u32) {
        let along = |axis: Axis, index: u32| {
            // Rows count downwards, Radiance's Y upwards.
            if axis.increasing == axis.is_y { axis.count - 1 - index } else { index }
        };
        let (major, minor) = (along(self.major, i), along(self.minor, j));
        if self.major.is_y { (minor, major) } else { (major, minor) }
    }
}

enum Problem {
    Cut,
    Overrun,
    Length,
}

struct Input<'a> {
    rest: &'a [u8],
}

impl Input<'_> {
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], Problem> {
        let (head, rest) = self.rest.split_first_chunk::<N>().ok_or(Problem::Cut)?;
        self.rest = rest;
        Ok(*head)
    }

    fn scan_line(&mut self, line: &mut [[u8; 4]]) -> Result<(), Problem> {
        let first = self.bytes::<4>()?;
        // In the new encoding a scan line begins with 2, 2 and its length, which is below 2^15.
        if first[0] == 2 && first[1] == 2 && first[2] < 128 && (8..1 << 15).contains(&line.len()) {
            if usize::from(u16::from_be_bytes([first[2], first[3]])) != line.len() {
                return Err(Problem::Length);
            }
            (0..4).try_for_each(|component| self.component(line, component))
        } else {
            self.old_scan_line(first, line)
        }
    }

    /// One component of all pixels: a count above 128 repeats a byte, else so many bytes follow.
    fn component(&mut self, line: &mut [[u8; 4]], component: usize) -> Result<(), Problem> {
        let mut at = 0;
        while at < line.len() {
            let [count] = self.bytes()?;
            let is_run = count > 128;
            let count = usize::from(if is_run { count - 128 } else { count });
            let pixels = line.get_mut(at..at + count).ok_or(Problem::Overrun)?;
            if is_run {
                let [value] = self.bytes()?;
                pixels.iter_mut().for_each(|pixel| pixel[component] = value);
            } else {
                let (values, rest) = self.rest.split_at_checked(count).ok_or(Problem::Cut)?;
                self.rest = rest;
                pixels.iter_mut().zip(values).for_each(|(pixel, &value)| pixel[component] = value);
            }
            at += count;
        }
        Ok(())
    }

    /// Whole pixels; one with mantissas 1, 1, 1 repeats the pixel before as often as its exponent says, and further
    /// such pixels at once say the higher digits to base 256.
    fn old_scan_line(&mut self, first: [u8; 4], line: &mut [[u8; 4]]) -> Result<(), Problem> {
        let mut pixel = first;
        let mut at = 0_usize;
        let mut shift = 0;
        loop {
            if let [1, 1, 1, count] = pixel {
                let before = *at.checked_sub(1).and_then(|last| line.get(last)).ok_or(Problem::Overrun)?;
                let count = usize::from(count).checked_shl(shift).ok_or(Problem::Overrun)?;
                let end = at.checked_add(count).ok_or(Problem::Overrun)?;
                line.get_mut(at..end).ok_or(Problem::Overrun)?.fill(before);
                at = end;
                shift += 8;
            } else {
                *line.get_mut(at).ok_or(Problem::Overrun)? = pixel;
                at += 1;
                shift = 0;
            }
            if at == line.len() {
                return Ok(());
            }
            pixel = self.bytes()?;
        }
    }
}

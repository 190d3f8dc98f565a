//! Pictures as textures: pixels addressed by continuous coordinates, blended or not, repeated or not.
//!
//! Pixels are scene-linear, row 0 on top. Coordinates (x, y) are in [0, 1]² over the whole picture, x to the right and y
//! *down*; pixel (i, j) covers [i, i + 1) / width × [j, j + 1) / height, and its own colour is met exactly at its centre.

use snell_math::Rgb;

use super::pyramid;

/// A picture, decoded to scene-linear colour. All pixels are finite.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureImage {
    /// The picture, then (once [`TextureImage::with_levels`] has made them) ever smaller versions of it.
    levels: Vec<Level>,
    /// The colour of all pixels, where it is only one.
    constant: Option<Rgb>,
}

/// One rectangle of pixels, row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Level {
    pub width: u32,
    pub height: u32,
    pub pixels: Vec<Rgb>,
}

/// Why pixels make no picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TextureImageError {
    /// Width or height is zero.
    #[error("a picture of {width} by {height} pixels has no colour")]
    Empty {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// The number of pixels does not fit width and height.
    #[error("{width} by {height} pixels were announced, but there are {pixels}")]
    Size {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// How many there are.
        pixels: usize,
    },
    /// A pixel has a component that is NaN or infinite.
    #[error("pixel ({x}, {y}) is not finite")]
    NotFinite {
        /// Column, from 0 at the left.
        x: u32,
        /// Row, from 0 at the top.
        y: u32,
    },
}

impl TextureImage {
    /// From pixels in rows, the top row first, each from left to right.
    ///
    /// # Errors
    /// Where there are no pixels, not as many as announced, or one that is not finite.
    ///
    /// ```
    /// use snell::math::Rgb;
    /// use snell::texture::TextureImage;
    /// let image = TextureImage::new(2, 1, vec![Rgb::BLACK, Rgb::WHITE]).unwrap();
    /// assert_eq!(image.pixel(1, 0), Rgb::WHITE);
    /// assert_eq!(image.color([0.5, 0.5], false, true, [[0.0; 2]; 2]), Rgb::gray(0.5));
    /// ```
    pub fn new(width: u32, height: u32, pixels: Vec<Rgb>) -> Result<Self, TextureImageError> {
        if width == 0 || height == 0 {
            return Err(TextureImageError::Empty { width, height });
        }
        if u64::from(width) * u64::from(height) != pixels.len() as u64 {
            return Err(TextureImageError::Size { width, height, pixels: pixels.len() });
        }
        if let Some(at) = pixels.iter().position(|color| !color.is_finite()) {
            let (x, y) = (at % width as usize, at / width as usize);
            return Err(TextureImageError::NotFinite { x: x as u32, y: y as u32 });
        }
        let constant = pixels.iter().all(|pixel| *pixel == pixels[0]).then_some(pixels[0]);
        Ok(Self { levels: vec![Level { width, height, pixels }], constant })
    }

    /// With smaller versions of itself, which lookups with a footprint use: a third more memory, more only for strips a few
    /// pixels wide. Without them a footprint changes nothing.
    #[must_use]
    pub fn with_levels(mut self) -> Self {
        self.levels.truncate(1);
        while let Some(next) = pyramid::halve(&self.levels[self.levels.len() - 1]) {
            self.levels.push(next);
        }
        self
    }

    /// Width in pixels, at least 1.
    pub fn width(&self) -> u32 {
        self.levels[0].width
    }

    /// Height in pixels, at least 1.
    pub fn height(&self) -> u32 {
        self.levels[0].height
    }

    /// The pixel in column `x` (from the left) of row `y` (from the top), or the nearest one where it lies outside.
    pub fn pixel(&self, x: u32, y: u32) -> Rgb {
        self.levels[0].pixel(x.min(self.width() - 1), y.min(self.height() - 1))
    }

    /// The colour, where it is the same everywhere.
    pub fn constant(&self) -> Option<Rgb> {
        self.constant
    }

    pub(super) fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// The colour at a position, x to the right and y down, the picture being [0, 1]². NaN and infinity are taken as 0.
    ///
    /// `repeat`: outside are more copies of the picture, else the border's colours. `smooth`: blended between the centres
    /// of pixels, else the nearest pixel. `footprint`: the sides of the parallelogram around the position that is to be
    /// averaged, in the position's unit: where it is longer than a pixel, smaller versions of the picture are blended.
    ///
    /// ```
    /// use snell::math::Rgb;
    /// use snell::texture::TextureImage;
    /// // Columns of black and white: grey where two of them are seen at once, and still sharp where two rows are.
    /// let pixels = (0..64).map(|i| Rgb::gray((i % 2) as f32)).collect();
    /// let image = TextureImage::new(8, 8, pixels).unwrap().with_levels();
    /// let seen = |width: f64, height: f64| {
    ///     image.color([0.5625, 0.5625], true, true, [[width / 8.0, 0.0], [0.0, height / 8.0]])
    /// };
    /// assert_eq!(seen(1.0, 1.0), Rgb::BLACK);
    /// assert_eq!(seen(2.0, 2.0), Rgb::gray(0.5));
    /// assert_eq!(seen(1.0, 2.0), Rgb::BLACK);
    /// ```
    pub fn color(&self, position: [f64; 2], repeat: bool, smooth: bool, footprint: [[f64; 2]; 2]) -> Rgb {
        if let Some(color) = self.constant {
            return color;
        }
        let look = |level: usize, position| {
            let pixels = &self.levels[level];
            if smooth || level > 0 { pixels.blended(position, repeat) } else { pixels.nearest(position, repeat) }
        };
        pyramid::average_over(&self.levels, position, footprint, look)
    }
}

/// The two pixels around a coordinate along one axis, and how far the coordinate is from the first to the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Neighbours {
    pub low: u32,
    pub high: u32,
    pub weight: f32,
}

impl Neighbours {
    /// Around `coordinate`, in [0, 1] over `size` pixels.
    #[inline]
    pub fn new(coordinate: f64, size: u32, repeat: bool) -> Self {
        // In units of 2⁻²⁴ pixels, a whole number: a pixel's centre is met exactly, however its coordinate was rounded.
        const UNITS: f64 = (1_u64 << 24) as f64;
        let in_pixels = inside(coordinate, repeat) * f64::from(size) - 0.5;
        let snapped = (in_pixels * UNITS).round() / UNITS;
        let cell = snapped.floor();
        let (low, last) = (cell as i64, i64::from(size) - 1);
        let wrap = |i: i64| match i {
            i if (0..=last).contains(&i) => i as u32,
            i if (i < 0) == repeat => last as u32,
            _ => 0,
        };
        Self { low: wrap(low), high: wrap(low + 1), weight: (snapped - cell) as f32 }
    }
}

/// A coordinate brought into [0, 1].
#[inline]
fn inside(coordinate: f64, repeat: bool) -> f64 {
    if !coordinate.is_finite() {
        0.0
    } else if repeat {
        coordinate - coordinate.floor()
    } else {
        coordinate.clamp(0.0, 1.0)
    }
}

impl Level {
    /// The pixel in a column and row that exist.
    #[inline]
    pub fn pixel(&self, x: u32, y: u32) -> Rgb {
        self.pixels[y as usize * self.width as usize + x as usize]
    }

    /// The colour of row `y` between two columns.
    #[inline]
    pub fn row_color(&self, columns: Neighbours, y: u32) -> Rgb {
        self.pixel(columns.low, y).lerp(self.pixel(columns.high, y), columns.weight)
    }

    /// Bilinear interpolation between the four nearest centres.
    #[inline]
    pub fn blended(&self, [x, y]: [f64; 2], repeat: bool) -> Rgb {
        let columns = Neighbours::new(x, self.width, repeat);
        let rows = Neighbours::new(y, self.height, repeat);
        self.row_color(columns, rows.low).lerp(self.row_color(columns, rows.high), rows.weight)
    }

    #[inline]
    fn nearest(&self, [x, y]: [f64; 2], repeat: bool) -> Rgb {
        let index = |coordinate: f64, size: u32| {
            // The last pixel also has the coordinate 1 itself.
            ((inside(coordinate, repeat) * f64::from(size)) as u32).min(size - 1)
        };
        self.pixel(index(x, self.width), index(y, self.height))
    }
}

//! A rectangle of pixels, and the layers that accompany a rendered picture. The type of a pixel says what it means;
//! row 0 is the top row, pixels lie row after row from left to right.

use snell_math::Rgb;

/// `width × height` pixels of meaning `P`; either side may be zero.
///
/// `Image<Rgb>` holds scene-linear light. See [`Layers`] for the others the renderer makes.
///
/// ```
/// use snell_image::Image;
/// let image = Image::from_fn(3, 2, |x, y| x + 10 * y);
/// assert_eq!(image.row(1), &[10, 11, 12]);
/// assert_eq!(image.get(2, 1), Some(&12));
/// assert_eq!(image.get(3, 1), None);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image<P> {
    width: u32,
    height: u32,
    pixels: Vec<P>,
}

/// A vector of pixels does not have the length that its picture's sides ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a picture of {width} × {height} pixels was given {count} of them")]
pub struct WrongPixelCount {
    /// The sides asked for.
    pub width: u32,
    /// The sides asked for.
    pub height: u32,
    /// The pixels given.
    pub count: usize,
}

impl<P> Image<P> {
    /// Takes pixels that lie row after row from the top left.
    ///
    /// # Errors
    /// Where their number is not `width × height`.
    pub fn from_pixels(width: u32, height: u32, pixels: Vec<P>) -> Result<Self, WrongPixelCount> {
        if pixels.len() as u64 == u64::from(width) * u64::from(height) {
            Ok(Self { width, height, pixels })
        } else {
            Err(WrongPixelCount { width, height, count: pixels.len() })
        }
    }

    /// Asks for every pixel, in order, by its column and row.
    pub fn from_fn(width: u32, height: u32, mut pixel: impl FnMut(u32, u32) -> P) -> Self {
        let mut pixels = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            pixels.extend((0..width).map(|x| pixel(x, y)));
        }
        Self { width, height, pixels }
    }

    /// Columns.
    #[inline]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    #[inline]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// (width, height).
    #[inline]
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// True where it has no pixels.
    pub fn is_empty(&self) -> bool {
        self.pixels.is_empty()
    }

    /// All pixels, row after row from the top left.
    #[inline]
    pub fn pixels(&self) -> &[P] {
        &self.pixels
    }

    /// All pixels, to be changed.
    #[inline]
    pub fn pixels_mut(&mut self) -> &mut [P] {
        &mut self.pixels
    }

    /// The pixels without the picture.
    pub fn into_pixels(self) -> Vec<P> {
        self.pixels
    }

    /// The pixel at column `x`, row `y`, where there is one.
    #[inline]
    pub fn get(&self, x: u32, y: u32) -> Option<&P> {
        (x < self.width && y < self.height).then(|| &self.pixels[self.index(x, y)])
    }

    /// The pixel at column `x`, row `y`, to be changed, where there is one.
    #[inline]
    pub fn get_mut(&mut self, x: u32, y: u32) -> Option<&mut P> {
        let index = self.index(x, y);
        if x < self.width { self.pixels.get_mut(index) } else { None }
    }

    /// Row `y` from left to right.
    ///
    /// # Panics
    /// Where there is no such row, as indexing a slice does.
    #[inline]
    pub fn row(&self, y: u32) -> &[P] {
        let width = self.width as usize;
        &self.pixels[y as usize * width..][..width]
    }

    /// The same picture of what `f` makes of each pixel.
    pub fn map<Q>(&self, f: impl FnMut(&P) -> Q) -> Image<Q> {
        Image { width: self.width, height: self.height, pixels: self.pixels.iter().map(f).collect() }
    }

    #[inline]
    fn index(&self, x: u32, y: u32) -> usize {
        y as usize * self.width as usize + x as usize
    }
}

impl<P: Clone> Image<P> {
    /// The same pixel everywhere.
    pub fn filled(width: u32, height: u32, pixel: P) -> Self {
        Self { width, height, pixels: vec![pixel; width as usize * height as usize] }
    }
}

impl Image<Rgb> {
    /// How many pixels have a component that is NaN or infinite: shown as black or clipped, and always worth a report.
    pub fn count_non_finite(&self) -> usize {
        self.pixels.iter().filter(|pixel| !pixel.is_finite()).count()
    }
}

/// What a rendered picture knows of each pixel besides its colour. Every layer has the size of the picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layers {
    /// Distance from the eye to the first surface along the gaze, in world units; infinite where nothing was hit.
    pub depth: Option<Image<f32>>,
    /// The unit shading normal of the first surface, world space, on the viewer's side; zero where nothing was hit.
    pub normal: Option<Image<[f32; 3]>>,
    /// The object first hit, counted from 1 in the order of the scene; 0 where nothing was hit.
    pub object: Option<Image<u32>>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_pixels_is_kept_right() {
        assert_eq!(Image::from_pixels(2, 2, vec![0; 3]), Err(WrongPixelCount { width: 2, height: 2, count: 3 }));
        assert!(Image::from_pixels(0, 7, Vec::<u8>::new()).is_ok_and(|image| image.is_empty()));
        assert!(Image::from_pixels(u32::MAX, u32::MAX, vec![0_u8]).is_err());
    }

    #[test]
    fn pixels_are_found_by_column_and_row() {
        let mut image = Image::from_fn(3, 2, |x, y| (x, y));
        assert_eq!(image.row(0), &[(0, 0), (1, 0), (2, 0)]);
        assert_eq!(image.get(3, 0), None, "not the first pixel of the next row");
        assert_eq!(image.get_mut(3, 0), None);
        *image.get_mut(1, 1).unwrap() = (9, 9);
        assert_eq!(image.pixels()[4], (9, 9));
        assert_eq!(image.map(|p| p.0).into_pixels(), [0, 1, 2, 0, 9, 2]);
    }

    #[test]
    fn non_finite_pixels_are_counted() {
        let mut image = Image::filled(2, 2, Rgb::gray(1.0));
        assert_eq!(image.count_non_finite(), 0);
        image.pixels_mut()[1].g = f32::NAN;
        image.pixels_mut()[3] = Rgb::gray(f32::INFINITY);
        assert_eq!(image.count_non_finite(), 2);
    }
}

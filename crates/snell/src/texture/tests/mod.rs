//! Textures and backgrounds as a whole: compiled from scenes and evaluated through their public interface.

mod background;
mod compile;
mod evaluate;
mod image;

use std::sync::Arc;

use snell_math::{Normal3, Point3, Rgb, Transform};
use snell_scene::scene::{Mapping, Pattern, Space, Texture};
use snell_scene::{Id, Table};

use super::{TextureCoordinates, TextureImage, Textures};

/// Numbers that break careless code.
pub(super) const NASTY: [f64; 14] = [
    0.0,
    -0.0,
    5e-324,
    -5e-324,
    1e-300,
    0.999_999_999_999_999_9,
    1.0,
    -1.0,
    9_007_199_254_740_993.0,
    -1e19,
    1.7e308,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

/// A texture table under construction.
#[derive(Default)]
pub(super) struct Builder {
    pub table: Table<Texture>,
    pub images: Vec<Arc<TextureImage>>,
}

impl Builder {
    pub fn constant(&mut self, color: Rgb) -> Id<Texture> {
        self.table.push(Texture::constant(color))
    }

    pub fn pattern(&mut self, space: Space, pattern: Pattern) -> Id<Texture> {
        self.table.push(Texture { pattern, mapping: Mapping { space, texture_from_space: Transform::IDENTITY } })
    }

    pub fn mapped(&mut self, space: Space, texture_from_space: Transform, pattern: Pattern) -> Id<Texture> {
        self.table.push(Texture { pattern, mapping: Mapping { space, texture_from_space } })
    }

    /// Black and white unit cubes (or squares).
    pub fn checker(&mut self, space: Space) -> Id<Texture> {
        let cells = [Rgb::BLACK, Rgb::WHITE].map(|color| self.constant(color));
        self.pattern(space, Pattern::Checker(cells))
    }

    pub fn image(&mut self, width: u32, height: u32) -> Arc<TextureImage> {
        let image = Arc::new(picture(width, height));
        self.images.push(Arc::clone(&image));
        image
    }

    pub fn compile(&self) -> Textures {
        Textures::compile(&self.table, &self.images).unwrap()
    }
}

/// A picture whose every pixel is different and says where it is.
pub(super) fn picture(width: u32, height: u32) -> TextureImage {
    let pixels =
        (0..height).flat_map(|y| (0..width).map(move |x| Rgb::new(x as f32, y as f32, (x * 7 + y * 3) as f32 % 5.0)));
    TextureImage::new(width, height, pixels.collect()).unwrap()
}

/// A point in both spaces, with no inside.
pub(super) fn at(x: f64, y: f64, z: f64) -> TextureCoordinates {
    TextureCoordinates::new(Point3::new(x, y, z), Normal3::new(0.0, 0.0, 0.0), 0.0, [x, y], &Transform::IDENTITY)
}

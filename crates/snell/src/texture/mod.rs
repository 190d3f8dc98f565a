//! Textures and backgrounds, compiled: flat tables that give a colour for a point of a surface, or for a direction.
//!
//! What the patterns mean is said once, in [`snell_scene::scene::texture`] and [`snell_scene::scene::background`]; here is
//! how they are computed. [`Textures::compile`] checks a scene's textures (ids, cycles, depth, cost, numbers), folds what is
//! constant, and lays out the rest; nothing is allocated or dispatched dynamically when they are evaluated.
//!
//! Points are `f64`, in the space named with them; colours are `f32`, scene-linear. Every evaluation gives a finite colour
//! for every input: a coordinate that is NaN or infinite is taken as the origin of texture space.
//!
//! ```
//! use snell::math::{Normal3, Point3, Rgb, Transform};
//! use snell::scene::scene::{Pattern, Texture};
//! use snell::scene::Table;
//! use snell::texture::{TextureCoordinates, Textures};
//!
//! let mut table = Table::default();
//! let black = table.push(Texture::constant(Rgb::BLACK));
//! let white = table.push(Texture::constant(Rgb::WHITE));
//! let board = table.push(Texture { pattern: Pattern::Checker([black, white]), ..Texture::constant(Rgb::BLACK) });
//!
//! let textures = Textures::compile(&table, &[]).unwrap();
//! assert_eq!(textures.constant(white), Some(Rgb::WHITE));
//! assert_eq!(textures.constant(board), None);
//!
//! // On the floor y = 0: evaluated just below it, in the cell with floor(y) = -1.
//! let at = |x| TextureCoordinates::new(Point3::new(x, 0.0, 0.5), Normal3::new(0.0, 1.0, 0.0), 0.0, [x, -0.5], &Transform::IDENTITY);
//! assert_eq!(textures.evaluate(board, &at(0.5)), Rgb::WHITE);
//! assert_eq!(textures.evaluate(board, &at(1.5)), Rgb::BLACK);
//! ```

mod background;
mod checker;
mod compile;
mod coordinates;
mod evaluate;
mod fractal;
mod image;
mod lanes;
mod noise;
mod placement;
mod pyramid;
mod ramp;
mod view;

#[cfg(test)]
mod tests;

pub use background::{Background, BackgroundError, SeenAtOnce};
pub use compile::{Spaces, TextureError, Textures};
pub use coordinates::{Footprint, RELATIVE_INSET, TextureCoordinates};
pub use image::{TextureImage, TextureImageError};
pub use lanes::{LaneCoordinates, PlainChecker};
pub use ramp::RampError;
pub use view::ViewProjection;

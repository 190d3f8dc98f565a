//! Decoding the pictures of a scene, all at once and in parallel.

use std::sync::Arc;

use rayon::prelude::*;
use snell_math::Rgb;
use snell_scene::scene::ImageAsset;
use snell_scene::{Diagnostic, Table};

use crate::texture::TextureImage;

/// The pictures in the order of the table. One that cannot be decoded becomes an error, and a black pixel in its place.
pub fn decode_all(assets: &Table<ImageAsset>, diagnostics: &mut Vec<Diagnostic>) -> Vec<Arc<TextureImage>> {
    let assets: Vec<&ImageAsset> = assets.iter().collect();
    let decoded: Vec<Result<TextureImage, String>> = assets.par_iter().map(|asset| decode(asset)).collect();
    decoded
        .into_iter()
        .zip(assets)
        .map(|(image, asset)| {
            Arc::new(image.unwrap_or_else(|reason| {
                let message = format!("the picture \"{}\" cannot be used: {reason}", asset.name);
                diagnostics.push(Diagnostic::error(message).at_optional(asset.span.clone(), "named here"));
                TextureImage::solid(Rgb::BLACK)
            }))
        })
        .collect()
}

fn decode(asset: &ImageAsset) -> Result<TextureImage, String> {
    let picture = snell_image::decode(&asset.bytes, &snell_image::Limits::default()).map_err(|error| error.to_string())?;
    let (width, height) = picture.image.size();
    TextureImage::new(width, height, picture.image.into_pixels()).map_err(|error| error.to_string())
}

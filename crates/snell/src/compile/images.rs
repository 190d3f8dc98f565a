//! Decoding the pictures of a scene, all at once and in parallel.

use std::sync::Arc;

use rayon::prelude::*;
use snell_scene::scene::ImageAsset;
use snell_scene::{Diagnostic, Table};

use crate::texture::TextureImage;

/// The pictures in the order of the table. One that cannot be decoded becomes an error and is left out.
pub fn decode_all(assets: &Table<ImageAsset>, diagnostics: &mut Vec<Diagnostic>) -> Vec<Arc<TextureImage>> {
    let assets: Vec<&ImageAsset> = assets.iter().collect();
    let decoded: Vec<Result<TextureImage, String>> = assets.par_iter().map(|asset| decode(asset)).collect();
    let mut images = Vec::with_capacity(assets.len());
    for (image, asset) in decoded.into_iter().zip(assets) {
        match image {
            Ok(image) => images.push(Arc::new(image)),
            Err(reason) => {
                let message = format!("the picture \"{}\" cannot be used: {reason}", asset.name);
                diagnostics.push(Diagnostic::error(message).at_optional(asset.span.clone(), "named here"));
            }
        }
    }
    images
}

fn decode(asset: &ImageAsset) -> Result<TextureImage, String> {
    let picture =
        snell_image::decode(&asset.bytes, &snell_image::Limits::default()).map_err(|error| error.to_string())?;
    let (width, height) = picture.image.size();
    let image = TextureImage::new(width, height, picture.image.into_pixels()).map_err(|error| error.to_string())?;
    Ok(image.with_levels())
}

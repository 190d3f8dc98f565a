//! The files that a scene names, through [`crate::Assets`].

use std::sync::Arc;

use super::Resolver;
use crate::diagnostic::{Diagnostic, did_you_mean};
use crate::document::model::Located;
use crate::scene::ImageAsset;
use crate::table::Id;

impl Resolver<'_> {
    /// A file's resolved path and bytes; a missing one is told.
    pub(super) fn file(&mut self, file: &Located<String>) -> Option<(String, Arc<[u8]>)> {
        let path = self.assets.resolve(&self.base, &file.value);
        match self.assets.read(&path) {
            Ok(bytes) => Some((path, bytes)),
            Err(reason) => {
                let message = format!("the file {path:?} cannot be had: {reason}");
                let mut diagnostic = Diagnostic::error(message).at_optional(file.span.clone(), "named here");
                let similar = self.assets.similar(&path);
                let last = |path: &str| path.rsplit('/').next().unwrap_or_default().to_owned();
                let names: Vec<String> = similar.iter().map(|path| last(path)).collect();
                if let Some(near) = did_you_mean(&last(&path), names.iter().map(String::as_str)) {
                    let index = names.iter().position(|name| name == near).unwrap_or(0);
                    diagnostic = diagnostic.help(format!("did you mean {:?}?", similar[index]));
                }
                self.diagnostics.push(diagnostic);
                None
            }
        }
    }

    /// A picture file, once however often it is named. Where it is missing, an id that leads nowhere: the scene is not
    /// given out then.
    pub(super) fn image(&mut self, file: &Located<String>) -> Id<ImageAsset> {
        let path = self.assets.resolve(&self.base, &file.value);
        if let Some(id) = self.images.get(&path) {
            return *id;
        }
        let Some((path, bytes)) = self.file(file) else { return Id::from_index(0) };
        let id = self.scene.images.push(ImageAsset { name: path.clone(), bytes, span: file.span.clone() });
        self.images.insert(path, id);
        id
    }
}

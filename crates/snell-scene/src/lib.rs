//! What the author of a scene said: the [`Scene`], with its tables and ids; the readers that make one from every format we
//! know; and the [`Diagnostics`] that they give, all at once, with places in the source.
//!
//! Nothing here knows of rays or hierarchies, and nothing opens a file: bytes come through [`Assets`].

pub mod assets;
pub mod catalogue;
pub mod diagnostic;
pub mod document;
pub mod lenses;
pub mod reader;
pub mod scene;
pub mod table;

pub use assets::{AssetError, Assets};
pub use diagnostic::{Diagnostic, Diagnostics, Severity, SourceId, SourceMap, Span};
pub use scene::Scene;
pub use table::{Id, Table};

//! All readers on all files at hand: good, odd and broken ones made by others, cut off at many places, with hostile headers.

pub(super) mod assets;
mod hostile;

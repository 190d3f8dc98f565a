//! Glass through the whole engine, from scene files to colours, against optics that was known before.

mod absorption;
mod dispersion;
mod energy;
mod inside;
mod instruments;
mod internal_reflection;
mod nested;

//! The built `snell` command, run in temporary folders as a user runs it.

mod mistakes;
mod output;
mod render;
mod scenes;
#[cfg(unix)]
mod signals;
mod streams;
mod support;

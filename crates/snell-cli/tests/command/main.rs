//! The built `snell` command, run in temporary folders as a user runs it.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod draw;
mod explain;
mod glass;
mod mistakes;
mod output;
mod paths;
mod render;
mod scenes;
mod schema;
#[cfg(unix)]
mod signals;
mod streams;
mod support;
mod view;

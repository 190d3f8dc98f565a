//! The `snell` command: the only crate that opens files, prints and exits.

fn main() {}

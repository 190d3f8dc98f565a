//! The paths that Rust code names: `std::fs::read`, and every leaf of `use crate::{accel, shape::{Hit, *}}`.

use super::source::is_name;

/// A path and where it begins.
#[derive(Debug, PartialEq)]
pub struct CodePath<'c> {
    /// Byte offset of its last segment.
    pub offset: usize,
    /// `["crate", "shape", "Hit"]`; a glob's last segment is `*`.
    pub segments: Vec<&'c str>,
}

/// A name or a single other character.
#[derive(Clone, Copy, Debug)]
struct Token<'c> {
    offset: usize,
    text: &'c str,
}

impl Token<'_> {
    fn is_name(&self) -> bool {
        self.text.bytes().next().is_some_and(is_name)
    }
}

/// All paths in `code` that begin with one of `roots`; comments and strings must be blank.
pub fn paths<'c>(code: &'c str, roots: &[&str]) -> Vec<CodePath<'c>> {
    let tokens = tokens(code);
    let mut found = Vec::new();
    for (at, token) in tokens.iter().enumerate() {
        if roots.contains(&token.text) && !continues_a_path(&tokens, at) {
            parse(&tokens, at, &mut Vec::new(), &mut found);
        }
    }
    found
}

fn tokens(code: &str) -> Vec<Token<'_>> {
    let bytes = code.as_bytes();
    let mut tokens = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let length = bytes[at..].iter().take_while(|&&byte| is_name(byte)).count().max(1);
        if !bytes[at].is_ascii_whitespace() {
            tokens.push(Token { offset: at, text: &code[at..at + length] });
        }
        at += length;
    }
    tokens
}

/// Whether the token is the later part of `name::token`. In `use ::std::fs` it is not.
fn continues_a_path(tokens: &[Token], at: usize) -> bool {
    at >= 3
        && tokens[at - 2..at].iter().all(|token| token.text == ":")
        && (tokens[at - 3].text == ">" || tokens[at - 3].is_name() && tokens[at - 3].text != "use")
}

fn is_path_separator(tokens: &[Token], at: usize) -> bool {
    tokens.get(at..at + 2).is_some_and(|pair| pair.iter().all(|token| token.text == ":"))
}

/// Reads the path or group at `at`, below `prefix`; returns where it ends.
fn parse<'c>(tokens: &[Token<'c>], at: usize, prefix: &mut Vec<&'c str>, found: &mut Vec<CodePath<'c>>) -> usize {
    let Some(&token) = tokens.get(at) else { return at };
    if token.text == "{" {
        let mut next = at + 1;
        while let Some(token) = tokens.get(next) {
            match token.text {
                "}" => return next + 1,
                "*" | "{" => next = parse(tokens, next, prefix, found),
                // `use crate::{shape as s, ...}`: the new name is no path.
                "as" => next += 2,
                _ if token.is_name() => next = parse(tokens, next, prefix, found),
                _ => next += 1,
            }
        }
        return next;
    }
    prefix.push(token.text);
    let follows = |at: usize| tokens.get(at).is_some_and(|token| token.is_name() || matches!(token.text, "{" | "*"));
    let end = if token.is_name() && is_path_separator(tokens, at + 1) && follows(at + 3) {
        parse(tokens, at + 3, prefix, found)
    } else {
        found.push(CodePath { offset: token.offset, segments: prefix.clone() });
        at + 1
    };
    prefix.pop();
    end
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(code: &str) -> Vec<String> {
        paths(code, &["std", "crate", "super"]).iter().map(|path| path.segments.join("::")).collect()
    }

    #[test]
    fn groups_are_taken_apart() {
        assert_eq!(
            found("use crate::{accel, shape::{Hit as H, *}, self};"),
            ["crate::accel", "crate::shape::Hit", "crate::shape::*", "crate::self"]
        );
        assert_eq!(found("use ::std::{fs, io::Read};"), ["std::fs", "std::io::Read"]);
    }

    #[test]
    fn expressions_and_parents_are_paths_too() {
        assert_eq!(found("let a = std::fs::read(super::super::b::<T>());"), ["std::fs::read", "super::super::b"]);
        assert_eq!(found("pub(in crate::shape) fn f() -> crate::Rgb {}"), ["crate::shape", "crate::Rgb"]);
    }

    #[test]
    fn the_middle_of_a_path_and_broken_code_begin_none() {
        assert_eq!(found("my::std::fs"), Vec::<String>::new());
        assert_eq!(found("use crate::{a, b"), ["crate::a", "crate::b"]);
        assert_eq!(found("crate:: "), ["crate"]);
        assert_eq!(found("crate::{{{"), Vec::<String>::new());
    }
}

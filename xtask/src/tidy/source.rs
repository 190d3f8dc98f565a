//! Views of Rust source text in which what a rule must not see is blank.
//!
//! Every view has the same length and the same lines as the text, so that an offset means the same place in all of them.
//! This is a lexer, not a parser: it knows comments, strings, characters and brackets, which is all that the rules need.

/// The text with every byte but line ends turned into a space.
pub fn blank(text: &str) -> String {
    text.bytes().map(|byte| if byte == b'\n' { '\n' } else { ' ' }).collect()
}

/// The line of a byte offset, from 1.
pub fn line_at(text: &str, offset: usize) -> usize {
    1 + text.as_bytes()[..offset.min(text.len())].iter().filter(|&&byte| byte == b'\n').count()
}

/// Blanks comments and the contents of string and character literals; their delimiters stay.
pub fn without_comments_and_strings(text: &str) -> String {
    let bytes = text.as_bytes();
    let mut code = String::with_capacity(text.len());
    let mut at = 0;
    while at < bytes.len() {
        let rest = &bytes[at..];
        let after_name = at > 0 && is_name(bytes[at - 1]);
        // (how many bytes are delimiters before, how many bytes the whole token has, delimiters after)
        let (open, length, close) = if rest.starts_with(b"//") {
            (0, rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len()), 0)
        } else if rest.starts_with(b"/*") {
            (0, block_comment(rest), 0)
        } else if let Some((open, length, close)) = raw_string(rest).filter(|_| !after_name) {
            (open, length, close)
        } else if rest[0] == b'"' {
            quoted(rest, b'"')
        } else if rest[0] == b'\'' && is_character(rest) {
            quoted(rest, b'\'')
        } else {
            code.push(if rest[0].is_ascii() { char::from(rest[0]) } else { ' ' });
            at += 1;
            continue;
        };
        let token = &bytes[at..at + length];
        for (index, &byte) in token.iter().enumerate() {
            let keep = byte == b'\n' || byte.is_ascii() && (index < open || index + close >= length);
            code.push(if keep { char::from(byte) } else { ' ' });
        }
        at += length;
    }
    code
}

/// Whether a byte can be part of a name.
pub fn is_name(byte: u8) -> bool {
    byte == b'_' || byte.is_ascii_alphanumeric() || !byte.is_ascii()
}

/// The length of the block comment at the start; they nest.
fn block_comment(bytes: &[u8]) -> usize {
    let mut depth = 0;
    let mut at = 0;
    while at < bytes.len() {
        let step = match &bytes[at..] {
            [b'/', b'*', ..] => {
                depth += 1;
                2
            }
            [b'*', b'/', ..] => {
                depth -= 1;
                2
            }
            _ => 1,
        };
        at += step;
        if depth == 0 {
            return at;
        }
    }
    bytes.len()
}

/// The raw string at the start, as lengths of its opening, of all of it and of its close: `r"..."`, `br#"..."#`.
fn raw_string(bytes: &[u8]) -> Option<(usize, usize, usize)> {
    let prefix = [&b"r"[..], b"br", b"cr"].into_iter().find(|prefix| bytes.starts_with(prefix))?.len();
    let hashes = bytes[prefix..].iter().take_while(|&&byte| byte == b'#').count();
    if bytes.get(prefix + hashes) != Some(&b'"') {
        return None;
    }
    let open = prefix + hashes + 1;
    let mut close = vec![b'"'];
    close.resize(1 + hashes, b'#');
    let end = bytes[open..].windows(close.len()).position(|window| window == close);
    Some(end.map_or((open, bytes.len(), 0), |end| (open, open + end + close.len(), close.len())))
}

/// The literal between `quote`s at the start, with backslash escapes, as lengths of its opening, of all of it and of its
/// close.
fn quoted(bytes: &[u8], quote: u8) -> (usize, usize, usize) {
    let mut at = 1;
    while at < bytes.len() {
        match bytes[at] {
            b'\\' => at += 2,
            byte if byte == quote => return (1, at + 1, 1),
            _ => at += 1,
        }
    }
    (1, bytes.len(), 0)
}

/// Whether the apostrophe at the start opens a character and not a lifetime: `'x'` or `'\...'`.
fn is_character(bytes: &[u8]) -> bool {
    match bytes.get(1) {
        None | Some(b'\n') => false,
        Some(b'\\') => true,
        Some(first) => {
            let width = match first {
                0xf0.. => 4,
                0xe0.. => 3,
                0xc0.. => 2,
                _ => 1,
            };
            bytes.get(1 + width) == Some(&b'\'')
        }
    }
}

/// Blanks every item that is compiled for tests only: what follows `#[cfg(test)]` or `#[cfg(all(test, ...))]`.
pub fn without_tests(code: &str) -> String {
    let mut shipped = code.to_owned();
    let mut from = 0;
    while let Some(start) = code[from..].find("#[cfg(").map(|found| from + found) {
        let condition = &code[start + "#[cfg(".len()..];
        let is_test = ["test)", "all(test,"].iter().any(|text| condition.starts_with(text));
        let end = if is_test { end_of_item(code, start) } else { start + "#[cfg(".len() };
        if is_test {
            shipped.replace_range(start..end, &blank(&code[start..end]));
        }
        from = end;
    }
    shipped
}

/// Where the item ends that begins, with its attributes, at `start`.
fn end_of_item(code: &str, start: usize) -> usize {
    let mut depth = 0_usize;
    for (offset, byte) in code.bytes().enumerate().skip(start) {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' => depth = depth.saturating_sub(1),
            b'}' => {
                depth = depth.saturating_sub(1);
                if depth == 0 {
                    return offset + 1;
                }
            }
            b';' if depth == 0 => return offset + 1,
            _ => {}
        }
    }
    code.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_literals_are_blank_and_everything_keeps_its_place() {
        let text = "a /* b /* c */ d */ e // f\n\"g\\\" // h\" i r#\"j \" k\"# l 'm' '\\'' 'n n<'o>(\"é\")";
        let code = without_comments_and_strings(text);
        assert_eq!(code.len(), text.len());
        let left: String = code.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(left, "a e \" \" i r#\" \"# l ' ' ' ' 'n n<'o>(\" \")");
        assert_eq!(line_at(text, text.find(" i ").expect("there")), 2);
    }

    #[test]
    fn unfinished_literals_reach_to_the_end() {
        for text in ["a /* b", "a \"b", "a r#\"b\"", "a '\\", "\"\\"] {
            let code = without_comments_and_strings(text);
            assert_eq!(code.len(), text.len());
            assert!(!code.contains('b'), "{code}");
        }
    }

    #[test]
    fn what_only_tests_compile_is_blank() {
        let code = "fn a() {}\n#[cfg(test)]\nmod tests {\n fn b() { [1; 2]; }\n}\nfn c() {}\n\
                    #[cfg(test)]\nmod more;\n#[cfg(all(test, unix))]\nconst D: [u8; 2] = [1; 2];\n#[cfg(unix)]\nfn e() {}";
        let shipped = without_tests(code);
        assert_eq!(shipped.len(), code.len());
        assert_eq!(
            shipped.split_whitespace().collect::<Vec<_>>().join(" "),
            "fn a() {} fn c() {} #[cfg(unix)] fn e() {}"
        );
    }
}

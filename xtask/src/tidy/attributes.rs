//! Whoever silences a lint says why.

use super::source::{is_name, line_at};
use super::{Report, Tree};

/// Every `#[allow(...)]` and `#[expect(...)]`, also inside `cfg_attr`, has a `reason = "..."`.
pub fn silenced_lints_have_reasons(tree: &Tree, report: &mut Report) {
    for (path, source) in tree.rust() {
        let code = &source.code;
        for (offset, opening) in ["#[", "#!["]
            .iter()
            .flat_map(|opening| code.match_indices(opening).map(|(offset, opening)| (offset, opening.len())))
        {
            let attribute = up_to_bracket(&code[offset + opening..]);
            let silences = ["allow", "expect"].iter().any(|name| calls(attribute, name));
            let squeezed: String = attribute.split_whitespace().collect();
            if silences && !squeezed.contains("reason=\"") {
                report.problem("reason", path, line_at(code, offset), "a silenced lint needs `reason = \"...\"`");
            }
        }
    }
}

/// The text before the bracket that closes the attribute.
fn up_to_bracket(code: &str) -> &str {
    let mut depth = 1;
    for (offset, byte) in code.bytes().enumerate() {
        match byte {
            b'[' => depth += 1,
            b']' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return &code[..offset];
        }
    }
    code
}

/// Whether `name(` stands in the attribute as a word of its own.
fn calls(attribute: &str, name: &str) -> bool {
    attribute.match_indices(name).any(|(offset, _)| {
        let starts_inside = offset > 0 && is_name(attribute.as_bytes()[offset - 1]);
        !starts_inside && attribute[offset + name.len()..].trim_start().starts_with('(')
    })
}

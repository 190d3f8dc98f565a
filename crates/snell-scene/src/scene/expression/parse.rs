//! From the text of a formula to its steps: recursive descent, with a bound on its depth.

use std::ops::Range;

use super::{CONSTANTS, Expression, ExpressionError, FUNCTIONS, FUNCTIONS_OF_TWO, STACK, Step};
use crate::diagnostic::did_you_mean;

/// The longest formula, in bytes.
const LONGEST: usize = 1000;
/// How deep parentheses, signs and powers may stand within each other.
const DEEPEST: usize = 50;

pub(super) fn program(text: &str, variable: Option<&str>) -> Result<Vec<Step>, ExpressionError> {
    if text.len() > LONGEST {
        let message = format!("the formula has {} bytes, more than the limit of {LONGEST}", text.len());
        return Err(error(message, 0..text.len(), "too long"));
    }
    let mut parser = Parser { text, at: 0, variable, depth: 0, height: 0, program: Vec::new() };
    parser.sum()?;
    parser.skip_space();
    if parser.at < text.len() {
        return Err(parser.unexpected_rest());
    }
    Ok(parser.program)
}

fn error(message: impl Into<String>, range: Range<usize>, label: &str) -> ExpressionError {
    ExpressionError { message: message.into(), range, label: label.to_owned(), help: None }
}

fn with_help(error: ExpressionError, help: impl Into<String>) -> ExpressionError {
    ExpressionError { help: Some(help.into()), ..error }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    variable: Option<&'a str>,
    depth: usize,
    /// How many numbers are on the stack after the program so far.
    height: usize,
    program: Vec<Step>,
}

impl<'a> Parser<'a> {
    fn skip_space(&mut self) {
        self.at = self.text.len() - self.text[self.at..].trim_start().len();
    }

    fn peek(&mut self) -> Option<char> {
        self.skip_space();
        self.text[self.at..].chars().next()
    }

    /// Goes past the next character where it is one of these.
    fn take(&mut self, wanted: &[char]) -> Option<char> {
        let next = self.peek().filter(|next| wanted.contains(next))?;
        self.at += next.len_utf8();
        Some(next)
    }

    /// Where the next character is; an empty range at the end.
    fn here(&mut self) -> Range<usize> {
        let length = self.peek().map_or(0, char::len_utf8);
        self.at..self.at + length
    }

    fn push(&mut self, step: Step) -> Result<(), ExpressionError> {
        match step {
            Step::Number(_) | Step::Variable => self.height += 1,
            Step::Operation(_) => self.height -= 1,
            Step::Negate | Step::Function(_) => {}
        }
        if self.height > STACK {
            return Err(self.too_deep());
        }
        self.program.push(step);
        Ok(())
    }

    fn too_deep(&mut self) -> ExpressionError {
        error("the formula is nested too deeply", self.here(), "too deep here")
    }

    fn sum(&mut self) -> Result<(), ExpressionError> {
        self.product()?;
        while let Some(sign) = self.take(&['+', '-', '−']) {
            self.product()?;
            self.push(Step::Operation(if sign == '+' { |a, b| a + b } else { |a, b| a - b }))?;
        }
        Ok(())
    }

    fn product(&mut self) -> Result<(), ExpressionError> {
        self.signed()?;
        while let Some(sign) = self.take(&['*', '·', '×', '/']) {
            if sign == '*' && self.text[self.at..].starts_with('*') {
                return Err(with_help(
                    error("`**` is no operation", self.at - 1..self.at + 1, "not known"),
                    "write `^`",
                ));
            }
            self.signed()?;
            self.push(Step::Operation(if sign == '/' { |a, b| a / b } else { |a, b| a * b }))?;
        }
        Ok(())
    }

    /// A power, or one with signs before it. All recursion comes through here.
    fn signed(&mut self) -> Result<(), ExpressionError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.too_deep());
        }
        match self.take(&['+', '-', '−']) {
            Some('+') => self.signed()?,
            Some(_) => {
                self.signed()?;
                self.push(Step::Negate)?;
            }
            None => {
                self.atom()?;
                if self.take(&['^']).is_some() {
                    self.signed()?;
                    self.push(Step::Operation(power))?;
                }
            }
        }
        self.depth -= 1;
        Ok(())
    }

    fn atom(&mut self) -> Result<(), ExpressionError> {
        let Some(next) = self.peek() else {
            let what = if self.text.trim().is_empty() { "the formula is empty" } else { "the formula breaks off" };
            return Err(error(what, self.at..self.at, "expected a number, a name or `(`"));
        };
        if next == '(' {
            let open = self.here();
            self.at = open.end;
            self.sum()?;
            return self.close(open);
        }
        if next.is_ascii_digit() || next == '.' {
            return self.number();
        }
        if next.is_alphabetic() {
            return self.name();
        }
        Err(error(format!("`{next}` has no place here"), self.here(), "expected a number, a name or `(`"))
    }

    fn close(&mut self, open: Range<usize>) -> Result<(), ExpressionError> {
        if self.take(&[')']).is_some() {
            return Ok(());
        }
        if self.peek().is_none() {
            return Err(error("a parenthesis is not closed", open, "opened here"));
        }
        Err(self.unexpected_rest())
    }

    /// What is wrong where a formula might have ended but goes on.
    fn unexpected_rest(&mut self) -> ExpressionError {
        let here = self.here();
        match self.peek() {
            Some(')') => error("there is a `)` too many", here, "closes nothing"),
            Some(',') => error("there is no place for a `,` here", here, "expected an operation"),
            Some(next) if next.is_alphanumeric() || "(.".contains(next) => {
                let found = error("an operation is missing", here, "expected an operation before this");
                with_help(found, "write products with `*`, as `2*x`")
            }
            Some(next) => error(format!("`{next}` is no operation"), here, "expected an operation"),
            None => error("the formula breaks off", here, "expected more"),
        }
    }

    fn number(&mut self) -> Result<(), ExpressionError> {
        let bytes = self.text.as_bytes();
        let digits = |mut at: usize| {
            while bytes.get(at).is_some_and(u8::is_ascii_digit) {
                at += 1;
            }
            at
        };
        let start = self.at;
        let mut end = digits(start);
        if bytes.get(end) == Some(&b'.') {
            end = digits(end + 1);
        }
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            let after = digits(end + 1 + sign);
            if after > end + 1 + sign {
                end = after;
            }
        }
        self.at = end;
        match self.text[start..end].parse::<f64>() {
            Ok(number) if number.is_finite() => self.push(Step::Number(number)),
            Ok(_) => Err(error("this number is too large", start..end, "not finite")),
            Err(_) => Err(error(format!("`{}` is no number", &self.text[start..end]), start..end, "expected a number")),
        }
    }

    fn name(&mut self) -> Result<(), ExpressionError> {
        let start = self.at;
        let rest = &self.text[start..];
        let length = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        let name = &rest[..length];
        self.at += length;
        let range = start..self.at;
        if self.peek() == Some('(') && self.variable != Some(name) {
            return self.call(name, range);
        }
        if self.variable == Some(name) {
            return self.push(Step::Variable);
        }
        if let Some((_, number)) = CONSTANTS.iter().find(|(constant, _)| *constant == name) {
            return self.push(Step::Number(*number));
        }
        if Expression::function_names().any(|function| function == name) {
            let found =
                error(format!("the function `{name}` has nothing to be taken of"), range, "expected `(` after this");
            return Err(with_help(found, format!("write `{name}({})`", self.variable.unwrap_or("1"))));
        }
        let known = self.variable.into_iter().chain(CONSTANTS.iter().map(|(constant, _)| *constant));
        let (help, label) = match (did_you_mean(name, known), self.variable) {
            (Some(near), _) => (format!("did you mean `{near}`?"), "unknown name"),
            (None, Some(variable)) => {
                (format!("the variable is `{variable}`; pi, tau and e are known numbers"), "unknown variable")
            }
            (None, None) => {
                ("this is a fixed number, without a variable; pi, tau and e are known".to_owned(), "unknown name")
            }
        };
        Err(with_help(error(format!("the formula knows no `{name}`"), range, label), help))
    }

    fn call(&mut self, name: &str, range: Range<usize>) -> Result<(), ExpressionError> {
        let one = FUNCTIONS.iter().find(|(function, _)| *function == name).map(|(_, f)| Step::Function(*f));
        let two = FUNCTIONS_OF_TWO.iter().find(|(function, _)| *function == name).map(|(_, f)| Step::Operation(*f));
        let Some(step) = one.or(two) else {
            if CONSTANTS.iter().any(|(constant, _)| *constant == name) {
                return Err(self.unexpected_rest());
            }
            let found = error(format!("there is no function `{name}`"), range, "unknown function");
            let names: Vec<&str> = Expression::function_names().collect();
            return Err(match did_you_mean(name, names.iter().copied()) {
                Some(near) => with_help(found, format!("did you mean `{near}`?")),
                None => with_help(found, format!("the functions are {}", names.join(", "))),
            });
        };
        let open = self.here();
        self.at = open.end;
        self.sum()?;
        if two.is_some() {
            if self.take(&[',']).is_none() {
                let found = error(format!("`{name}` is a function of two numbers"), range, "has one");
                return Err(with_help(found, format!("write `{name}(a, b)`")));
            }
            self.sum()?;
        }
        if self.peek() == Some(',') {
            let count = if two.is_some() { "two numbers" } else { "one number" };
            return Err(error(format!("`{name}` is a function of {count}"), self.here(), "one too many"));
        }
        self.close(open)?;
        self.push(step)
    }
}

/// Squares and cubes are multiplied out, so that they are exact where they can be.
fn power(base: f64, exponent: f64) -> f64 {
    if exponent == 2.0 {
        base * base
    } else if exponent == 3.0 {
        base * base * base
    } else {
        snell_math::portable::pow(base, exponent)
    }
}

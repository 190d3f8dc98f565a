//! From the text of a formula to its steps, by the library winnow: its Pratt parser knows how operators bind, and what stands between
//! them is told apart here, with a bound on how deep it may be nested.

use std::ops::Range;

use winnow::ascii::{digit0, digit1};
use winnow::combinator::{Infix, Prefix, dispatch, expression, fail, opt, peek};
use winnow::error::{ErrMode, ParserError};
use winnow::prelude::*;
use winnow::stream::{LocatingSlice, Location, Stateful, Stream};
use winnow::token::{any, one_of, take_while};

use super::{CONSTANTS, Expression, ExpressionError, FUNCTIONS, FUNCTIONS_OF_TWO, OfTwo, STACK, Step};
use crate::diagnostic::did_you_mean;

/// The longest formula, in bytes.
const LONGEST: usize = 1000;
/// How deep parentheses, signs and powers may stand within each other.
const DEEPEST: usize = 50;

/// How strongly operators bind: `-x^2` is −(x²), and a power of a power is taken from the right.
const SUM: i64 = 10;
const PRODUCT: i64 = 20;
const SIGN: i64 = 30;
const POWER: i64 = 40;

type Input<'a> = Stateful<LocatingSlice<&'a str>, State<'a>>;
type Program = Vec<Step>;
type Outcome<O> = Result<O, ErrMode<Told>>;

/// What is known while a formula is read.
#[derive(Clone, Copy, Debug)]
struct State<'a> {
    variable: Option<&'a str>,
    depth: usize,
}

/// What is wrong; nothing where another branch is to be tried.
#[derive(Clone, Debug)]
struct Told(Option<Box<ExpressionError>>);

impl<I: Stream> ParserError<I> for Told {
    type Inner = Self;

    fn from_input(_: &I) -> Self {
        Self(None)
    }

    fn into_inner(self) -> Result<Self, Self> {
        Ok(self)
    }
}

pub(super) fn program(text: &str, variable: Option<&str>) -> Result<Program, ExpressionError> {
    if text.len() > LONGEST {
        let message = format!("the formula has {} bytes, more than the limit of {LONGEST}", text.len());
        return Err(error(message, 0..text.len(), "too long"));
    }
    let mut input = Stateful { input: LocatingSlice::new(text), state: State { variable, depth: 0 } };
    let read = formula(&mut input).and_then(|program| end_of_text(&mut input).map(|()| program));
    let program = read.map_err(|mode| match mode {
        ErrMode::Cut(Told(Some(told))) | ErrMode::Backtrack(Told(Some(told))) => *told,
        _ => error("this is no formula", 0..text.len(), "not understood"),
    })?;
    // How many numbers wait at a time for an operation.
    let mut height = 0;
    for step in &program {
        match step {
            Step::Number(_) | Step::Variable => height += 1,
            Step::Operation(_) => height -= 1,
            Step::Negate | Step::Function(_) => {}
        }
        if height > STACK {
            return Err(error("the formula is nested too deeply", 0..text.len(), "too deep"));
        }
    }
    Ok(program)
}

fn error(message: impl Into<String>, range: Range<usize>, label: &str) -> ExpressionError {
    ExpressionError { message: message.into(), range, label: label.to_owned(), help: None }
}

fn with_help(error: ExpressionError, help: impl Into<String>) -> ExpressionError {
    ExpressionError { help: Some(help.into()), ..error }
}

/// Ends the reading with what is wrong.
fn stop<O>(told: ExpressionError) -> Outcome<O> {
    Err(ErrMode::Cut(Told(Some(Box::new(told)))))
}

fn space(i: &mut Input<'_>) -> Outcome<()> {
    take_while(0.., char::is_whitespace).void().parse_next(i)
}

/// The next character, which stays.
fn next(i: &mut Input<'_>) -> Outcome<Option<char>> {
    space(i)?;
    opt(peek(any)).parse_next(i)
}

/// Where the next character is; an empty range at the end.
fn here(i: &mut Input<'_>) -> Outcome<Range<usize>> {
    let length = next(i)?.map_or(0, char::len_utf8);
    let start = i.current_token_start();
    Ok(start..start + length)
}

/// One level deeper, if that is allowed.
fn deeper(i: &mut Input<'_>) -> Outcome<()> {
    i.state.depth += 1;
    if i.state.depth > DEEPEST {
        let here = here(i)?;
        return stop(error("the formula is nested too deeply", here, "too deep here"));
    }
    Ok(())
}

fn formula(i: &mut Input<'_>) -> Outcome<Program> {
    expression(operand).prefix(sign).infix(operation).parse_next(i)
}

/// A sign before an operand, of which there may be several.
fn sign<'a>(i: &mut Input<'a>) -> Outcome<Prefix<Input<'a>, Program, ErrMode<Told>>> {
    let sign = one_of(['+', '-', '−']).parse_next(i)?;
    deeper(i)?;
    Ok(Prefix(SIGN, if sign == '+' { |i, operand| shallower(i, operand, None) } else { negated }))
}

fn negated(i: &mut Input<'_>, operand: Program) -> Outcome<Program> {
    shallower(i, operand, Some(Step::Negate))
}

/// An operand whose level ends, with a last step.
fn shallower(i: &mut Input<'_>, mut operand: Program, step: Option<Step>) -> Outcome<Program> {
    i.state.depth -= 1;
    operand.extend(step);
    Ok(operand)
}

/// An operation between two operands.
fn operation<'a>(i: &mut Input<'a>) -> Outcome<Infix<Input<'a>, Program, ErrMode<Told>>> {
    space(i)?;
    let start = i.current_token_start();
    let infix = dispatch! {any;
        '+' => |_: &mut Input<'a>| Ok(Infix::Left(SUM, |_, a, b| Ok(both(a, b, |a, b| a + b)))),
        '-' | '−' => |_: &mut Input<'a>| Ok(Infix::Left(SUM, |_, a, b| Ok(both(a, b, |a, b| a - b)))),
        '*' | '·' | '×' => |_: &mut Input<'a>| Ok(Infix::Left(PRODUCT, |_, a, b| Ok(both(a, b, |a, b| a * b)))),
        '/' => |_: &mut Input<'a>| Ok(Infix::Left(PRODUCT, |_, a, b| Ok(both(a, b, |a, b| a / b)))),
        '^' => raising,
        _ => fail,
    }
    .parse_next(i)?;
    if i.input.starts_with('*') {
        let here = start..i.current_token_start() + 1;
        return stop(with_help(error("`**` is no operation", here, "not known"), "write `^`"));
    }
    Ok(infix)
}

fn raising<'a>(i: &mut Input<'a>) -> Outcome<Infix<Input<'a>, Program, ErrMode<Told>>> {
    deeper(i)?;
    Ok(Infix::Right(POWER, |i, a, b| shallower(i, both(a, b, power), None)))
}

fn both(mut a: Program, b: Program, operation: OfTwo) -> Program {
    a.extend(b);
    a.push(Step::Operation(operation));
    a
}

/// A number, a name, a function of something, or a formula in parentheses.
fn operand(i: &mut Input<'_>) -> Outcome<Program> {
    match next(i)? {
        Some('+' | '-' | '−') => fail.parse_next(i),
        Some('(') => {
            let open = here(i)?;
            any.void().parse_next(i)?;
            deeper(i)?;
            let inner = formula(i)?;
            close(i, open)?;
            shallower(i, inner, None)
        }
        Some(digit) if digit.is_ascii_digit() || digit == '.' => number(i),
        Some(letter) if letter.is_alphabetic() => name(i),
        Some(other) => {
            let here = here(i)?;
            stop(error(format!("`{other}` has no place here"), here, "expected a number, a name or `(`"))
        }
        None => {
            let end = i.current_token_start();
            let what = if is_blank(i) { "the formula is empty" } else { "the formula breaks off" };
            stop(error(what, end..end, "expected a number, a name or `(`"))
        }
    }
}

/// Nothing but space was read.
fn is_blank(i: &Input<'_>) -> bool {
    let mut whole = i.input;
    whole.reset_to_start();
    whole.chars().all(char::is_whitespace)
}

fn close(i: &mut Input<'_>, open: Range<usize>) -> Outcome<()> {
    match next(i)? {
        Some(')') => any.void().parse_next(i),
        None => stop(error("a parenthesis is not closed", open, "opened here")),
        Some(_) => unexpected_rest(i),
    }
}

fn end_of_text(i: &mut Input<'_>) -> Outcome<()> {
    if next(i)?.is_none() { Ok(()) } else { unexpected_rest(i) }
}

/// What is wrong where a formula might have ended but goes on.
fn unexpected_rest<O>(i: &mut Input<'_>) -> Outcome<O> {
    let here = here(i)?;
    stop(match next(i)? {
        Some(')') => error("there is a `)` too many", here, "closes nothing"),
        Some(',') => error("there is no place for a `,` here", here, "expected an operation"),
        Some(next) if next.is_alphanumeric() || "(.".contains(next) => {
            let found = error("an operation is missing", here, "expected an operation before this");
            with_help(found, "write products with `*`, as `2*x`")
        }
        Some(next) => error(format!("`{next}` is no operation"), here, "expected an operation"),
        None => error("the formula breaks off", here, "expected more"),
    })
}

fn number(i: &mut Input<'_>) -> Outcome<Program> {
    let exponent = (one_of(['e', 'E']), opt(one_of(['+', '-'])), digit1);
    let (text, range) = (digit0, opt(('.', digit0)), opt(exponent)).take().with_span().parse_next(i)?;
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(vec![Step::Number(number)]),
        Ok(_) => stop(error("this number is too large", range, "not finite")),
        Err(_) => stop(error(format!("`{text}` is no number"), range, "expected a number")),
    }
}

fn name(i: &mut Input<'_>) -> Outcome<Program> {
    let (name, range) = take_while(1.., |c: char| c.is_alphanumeric() || c == '_').with_span().parse_next(i)?;
    let variable = i.state.variable;
    if variable == Some(name) {
        return Ok(vec![Step::Variable]);
    }
    if next(i)? == Some('(') {
        return call(i, name, range);
    }
    if let Some((_, number)) = CONSTANTS.iter().find(|(constant, _)| *constant == name) {
        return Ok(vec![Step::Number(*number)]);
    }
    if Expression::function_names().any(|function| function == name) {
        let found =
            error(format!("the function `{name}` has nothing to be taken of"), range, "expected `(` after this");
        return stop(with_help(found, format!("write `{name}({})`", variable.unwrap_or("1"))));
    }
    let known = variable.into_iter().chain(CONSTANTS.iter().map(|(constant, _)| *constant));
    let (help, label) = match (did_you_mean(name, known), variable) {
        (Some(near), _) => (format!("did you mean `{near}`?"), "unknown name"),
        (None, Some(variable)) => {
            (format!("the variable is `{variable}`; pi, tau and e are known numbers"), "unknown variable")
        }
        (None, None) => {
            ("this is a fixed number, without a variable; pi, tau and e are known".to_owned(), "unknown name")
        }
    };
    stop(with_help(error(format!("the formula knows no `{name}`"), range, label), help))
}

fn call(i: &mut Input<'_>, name: &str, range: Range<usize>) -> Outcome<Program> {
    let one = FUNCTIONS.iter().find(|(function, _)| *function == name).map(|(_, f)| Step::Function(*f));
    let two = FUNCTIONS_OF_TWO.iter().find(|(function, _)| *function == name).map(|(_, f)| Step::Operation(*f));
    let Some(step) = one.or(two) else {
        if CONSTANTS.iter().any(|(constant, _)| *constant == name) {
            return unexpected_rest(i);
        }
        let found = error(format!("there is no function `{name}`"), range, "unknown function");
        let names: Vec<&str> = Expression::function_names().collect();
        return stop(match did_you_mean(name, names.iter().copied()) {
            Some(near) => with_help(found, format!("did you mean `{near}`?")),
            None => with_help(found, format!("the functions are {}", names.join(", "))),
        });
    };
    let open = here(i)?;
    any.void().parse_next(i)?;
    deeper(i)?;
    let mut program = formula(i)?;
    if two.is_some() {
        if next(i)? != Some(',') {
            let found = error(format!("`{name}` is a function of two numbers"), range, "has one");
            return stop(with_help(found, format!("write `{name}(a, b)`")));
        }
        any.void().parse_next(i)?;
        program.extend(formula(i)?);
    }
    if next(i)? == Some(',') {
        let count = if two.is_some() { "two numbers" } else { "one number" };
        let here = here(i)?;
        return stop(error(format!("`{name}` is a function of {count}"), here, "one too many"));
    }
    close(i, open)?;
    shallower(i, program, Some(step))
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

//! The words after a chore's name: flags, options with a value, and the rest. Whatever is left over is an error.

use std::str::FromStr;

/// Words not yet understood; each question takes its answer out.
#[derive(Debug)]
pub struct Arguments {
    words: Vec<String>,
}

impl Arguments {
    /// The words of one command line, without the program's and the chore's name.
    pub fn new(words: Vec<String>) -> Self {
        Self { words }
    }

    /// Whether `--help` or `-h` is among the words.
    pub fn asks_for_help(&self) -> bool {
        self.words.iter().any(|word| word == "--help" || word == "-h")
    }

    /// Takes `flag` out, wherever it stands; whether it was there.
    pub fn flag(&mut self, flag: &str) -> bool {
        let before = self.words.len();
        self.words.retain(|word| word != flag);
        self.words.len() < before
    }

    /// Takes `flag` out with all that follows it, which is returned; `None` where it is not there.
    pub fn rest_after(&mut self, flag: &str) -> Option<Vec<String>> {
        let at = self.words.iter().position(|word| word == flag)?;
        let rest = self.words.split_off(at + 1);
        self.words.pop();
        Some(rest)
    }

    /// Takes `option VALUE` or `option=VALUE` out; `None` where it is not there.
    pub fn option<T: FromStr>(&mut self, option: &str) -> Result<Option<T>, String> {
        let with_equals = format!("{option}=");
        let Some(at) = self.words.iter().position(|word| word == option || word.starts_with(&with_equals)) else {
            return Ok(None);
        };
        let word = self.words.remove(at);
        let value = match word.strip_prefix(&with_equals) {
            Some(value) => value.to_owned(),
            None if at < self.words.len() => self.words.remove(at),
            None => return Err(format!("`{option}` needs a value")),
        };
        value.parse().map(Some).map_err(|_| format!("`{value}` is no value for `{option}`"))
    }

    /// The words that are left, none of which may look like an option.
    pub fn names(self) -> Result<Vec<String>, String> {
        match self.words.iter().find(|word| word.starts_with('-')) {
            Some(word) => Err(format!("unknown option `{word}`; `--help` tells what there is")),
            None => Ok(self.words),
        }
    }

    /// The one word that may be left.
    pub fn at_most_one_name(self) -> Result<Option<String>, String> {
        let mut names = self.names()?;
        match names.len() {
            0 | 1 => Ok(names.pop()),
            _ => Err(format!("one name at most, not {}", names.len())),
        }
    }

    /// Nothing may be left.
    pub fn nothing(self) -> Result<(), String> {
        match self.names()?.first() {
            Some(name) => Err(format!("unexpected `{name}`")),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arguments(line: &str) -> Arguments {
        Arguments::new(line.split_whitespace().map(str::to_owned).collect())
    }

    #[test]
    fn flags_options_and_names_are_taken_apart() {
        let mut given = arguments("one --seconds 5 --long two");
        assert!(given.flag("--long"));
        assert!(!given.flag("--long"));
        assert_eq!(given.option::<u32>("--seconds"), Ok(Some(5)));
        assert_eq!(given.names(), Ok(vec!["one".to_owned(), "two".to_owned()]));
        assert_eq!(arguments("--seconds=7").option::<u32>("--seconds"), Ok(Some(7)));
    }

    #[test]
    fn the_rest_is_taken_as_it_is() {
        let mut given = arguments("one --run two --three");
        assert_eq!(given.rest_after("--run"), Some(vec!["two".to_owned(), "--three".to_owned()]));
        assert_eq!(given.rest_after("--run"), None);
        assert_eq!(given.names(), Ok(vec!["one".to_owned()]));
    }

    #[test]
    fn what_is_not_understood_is_an_error() {
        assert!(arguments("--seconds").option::<u32>("--seconds").is_err());
        assert!(arguments("--seconds five").option::<u32>("--seconds").is_err());
        assert!(arguments("--lnog").names().is_err());
        assert!(arguments("a b").at_most_one_name().is_err());
        assert!(arguments("a").nothing().is_err());
    }
}

//! Twins: a test that proves that another test can fail. Whoever writes a comparison, a validator or a statistical test
//! plants a defect and shows here that it is caught.

use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs an assertion on something that has a planted defect, and gives the message with which it failed.
///
/// # Panics
/// Where it did not fail: it would not catch the defect.
///
/// ```
/// use snell_testkit::must_fail;
/// let message = must_fail("a sum that is off by one", || assert_eq!(1 + 1, 3, "the sum"));
/// assert!(message.contains("the sum"));
/// ```
#[track_caller]
pub fn must_fail<T>(defect: &str, assertion: impl FnOnce() -> T) -> String {
    match catch_unwind(AssertUnwindSafe(assertion)) {
        Ok(_) => panic!("not caught: {defect}"),
        Err(payload) => payload
            .downcast_ref::<String>()
            .cloned()
            .or_else(|| payload.downcast_ref::<&str>().map(ToString::to_string))
            .unwrap_or_default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fail_is_told() {
        let message = must_fail("an assertion that accepts everything", || must_fail("a defect", || 1 + 1));
        assert_eq!(message, "not caught: a defect");
    }

    #[test]
    fn messages_are_given_on() {
        assert_eq!(must_fail("x", || panic!("plain")), "plain");
        assert_eq!(must_fail("x", || panic!("with {}", 7)), "with 7");
    }
}

//! Numbers for people.

use std::io::Write as _;

/// Prints a line that is seen also when the test passes: the test runner only captures what `println!` writes.
pub fn measured(what: impl std::fmt::Display) {
    let _ = writeln!(std::io::stderr().lock(), "measured: {what}");
}

//! The comment at the top of an export: what the text does not say.

use alloc::string::String;
use core::fmt::Write;

use super::change::Change;
use super::dialect::Dialect;

/// The text with a comment for each loss. Where there is no code, comments alone would look like some.
pub(super) fn with_losses(dialect: Dialect, text: String, changes: &[Change]) -> String {
    if text.is_empty() {
        return text;
    }
    let mut losses = String::new();
    for change in changes.iter().filter(|change| change.is_loss()) {
        let mut words = String::new();
        // Writing to a String cannot fail.
        let _ = write!(words, "NOT CARRIED: {change}");
        losses.push_str(&comment(dialect, &words));
    }
    if losses.is_empty() {
        return text;
    }
    // Nothing may stand before the declaration of an XML document.
    let at = if text.starts_with("<?xml") { text.find('\n').map_or(0, |end| end + 1) } else { 0 };
    let (head, rest) = text.split_at_checked(at).unwrap_or(("", &text));
    let mut whole = String::from(head);
    whole.push_str(&losses);
    whole.push_str(rest);
    whole
}

/// One line of comment. Whatever the words are, they do not end it. JSON has no comments.
pub(super) fn comment(dialect: Dialect, words: &str) -> String {
    let (open, close) = match dialect {
        Dialect::Json => return String::new(),
        Dialect::CcwSt
        | Dialect::SendReqEtc100
        | Dialect::SendReqEtc101
        | Dialect::DataExch
        | Dialect::SysmacSt => ("(* ", " *)"),
        Dialect::L5x => ("<!-- ", " -->"),
        Dialect::Rust => ("// ", ""),
        Dialect::Pycomm3 | Dialect::Cli | Dialect::Hex => ("# ", ""),
    };
    let mut line = String::from(open);
    line.push_str(&harmless(words));
    line.push_str(close);
    line.push('\n');
    line
}

/// Words that neither end a comment nor begin one inside of it, on one line. A backslash at the end of a line would
/// continue it.
pub(super) fn harmless(words: &str) -> String {
    let mut plain = String::with_capacity(words.len());
    for c in words.chars() {
        let last = plain.chars().next_back();
        let pair = matches!(
            (last, c),
            (Some('*'), ')' | '/') | (Some('('), '*') | (Some('-' | '<'), '-' | '!') | (Some('/'), '*' | '/')
        );
        if pair {
            plain.push(' ');
        }
        let line_end = c.is_control() || matches!(c, '\u{2028}' | '\u{2029}');
        plain.push(if line_end { ' ' } else { c });
    }
    // `--` must not stand before `-->`, nor a star before `)`.
    if plain.ends_with(['-', '*', '\\']) {
        plain.push(' ');
    }
    plain
}

/// Stands before what must not run before somebody has looked at it: it would send another request, or to another
/// device.
pub(super) const HELD: &str =
    "(* FALSE keeps this from running: see what is NOT CARRIED, then take it out. *)";

/// One more line of a program.
pub(super) fn line(out: &mut String, text: &str) {
    out.push_str(text);
    out.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_do_not_break_out_of_a_comment() {
        for (words, plain) in [
            ("a *) b := 1; (* c", "a * ) b := 1; ( * c"),
            ("--> <b/> <!-- --", "- -> <b/> < !- - - - "),
            ("one\r\ntwo\u{2028}three", "one  two three"),
            ("*/ system() // /*", "* / system() / / / * "),
            ("echo \\", "echo \\ "),
            ("Größe 16#0E = 14", "Größe 16#0E = 14"),
        ] {
            assert_eq!(harmless(words), plain);
        }
    }
}

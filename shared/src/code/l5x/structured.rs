//! Structured Text of a routine, statement by statement.

use alloc::string::String;
use alloc::vec::Vec;
use core::mem::take;

/// The lines of a routine so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Statements {
    /// The statement that has no end yet, and where it begins.
    open: (usize, String),
    /// What ends the comment or the text that is open.
    until: Option<&'static str>,
    found: Vec<(usize, String)>,
}

/// What begins a comment, and what ends it.
const COMMENTS: [(&str, &str); 3] = [("(*", "*)"), ("/*", "*/"), ("//", "\n")];

impl Statements {
    /// One more line, and where in the document it stands.
    pub(super) fn line(&mut self, at: usize, line: &str) {
        let mut rest = line;
        while !rest.is_empty() {
            if let Some(end) = self.until {
                let Some((_, after)) = rest.split_once(end) else { break };
                (self.until, rest) = (None, after);
                continue;
            }
            let comment = COMMENTS.iter().find(|(begin, _)| rest.starts_with(begin));
            if let Some((begin, end)) = comment {
                self.until = Some(end);
                rest = rest.get(begin.len()..).unwrap_or_default();
                continue;
            }
            let mut chars = rest.chars();
            match chars.next() {
                Some(';') => self.end(),
                // What a text says is no code.
                Some('\'') => self.until = Some("'"),
                Some(c) => {
                    if self.open.1.is_empty() {
                        self.open.0 = at;
                    }
                    if !(self.open.1.is_empty() && c.is_whitespace()) {
                        self.open.1.push(c);
                    }
                }
                None => {}
            }
            rest = chars.as_str();
        }
        // Neither of them goes on in the next line.
        self.until = self.until.filter(|end| !matches!(*end, "\n" | "'"));
        if !self.open.1.is_empty() {
            self.open.1.push(' ');
        }
    }

    /// All statements, each with the place of its first line.
    pub(super) fn finish(mut self) -> Vec<(usize, String)> {
        self.end();
        self.found
    }

    fn end(&mut self) {
        let (at, statement) = take(&mut self.open);
        if !statement.trim().is_empty() {
            self.found.push((at, statement));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_texts_are_no_code() {
        let mut statements = Statements::default();
        for (at, line) in [
            "(* a.b := 1;",
            "   a.b := 2; *) IF go THEN",
            "  a.b :=",
            "    3; // a.b := 4;",
            "  /* a.b := 5; */ t := 'x; a.b := 6;'; MSG(a);",
            "END_IF;",
        ]
        .into_iter()
        .enumerate()
        {
            statements.line(at, line);
        }
        let found = statements.finish();
        let found: Vec<(usize, &str)> = found.iter().map(|(at, text)| (*at, text.trim())).collect();
        assert_eq!(found, [(1, "IF go THEN   a.b :=     3"), (4, "t :="), (4, "MSG(a)"), (5, "END_IF")]);
    }
}

//! Which parts of a text are written in which dialect.
//!
//! A text is cut at its lines: each looks like XML, JSON, Python, Rust, a shell, bytes, a table or, if like nothing
//! else, Structured Text. What has brackets or quotes open goes on with the next line. Structured Text of several vendors is
//! then told apart by its calls and the variables that these share ([`vendor`]).

mod line;
mod span;
mod vendor;

use alloc::borrow::Cow;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use self::line::{Look, look};
use self::span::Open;
use super::control_expert;
use super::dialect::Dialect;

/// How a piece is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// A table of parameters.
    Parameters,
    /// Code.
    Code(Dialect),
}

/// Some lines of the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Piece<'a> {
    /// How it is read.
    pub(super) form: Form,
    /// From 1.
    pub(super) first_line: usize,
    /// Whole lines. What belongs to another piece is blank.
    pub(super) text: Cow<'a, str>,
}

/// The pieces of a text.
pub(super) fn pieces(text: &str, dialect: Option<Dialect>) -> Vec<Piece<'_>> {
    if let Some(dialect) = dialect {
        return vec![Piece { form: Form::Code(dialect), first_line: 1, text: Cow::Borrowed(text) }];
    }
    let mut pieces = Vec::new();
    for part in parts(text) {
        let Some(source) = text.get(part.bytes.clone()) else { continue };
        let piece = |form| Piece { form, first_line: part.first_line, text: Cow::Borrowed(source) };
        match part.look {
            Look::Nothing | Look::Remark => {}
            Look::Xml if control_expert::is_exchange(source) => {
                pieces.push(piece(Form::Code(Dialect::SendReqEtc100)));
            }
            Look::Xml => pieces.push(piece(Form::Code(Dialect::L5x))),
            Look::Json => pieces.push(piece(Form::Code(Dialect::Json))),
            Look::Python => pieces.push(piece(Form::Code(Dialect::Pycomm3))),
            Look::Rust => pieces.push(piece(Form::Code(Dialect::Rust))),
            Look::Shell => pieces.push(piece(Form::Code(Dialect::Cli))),
            Look::Hex => pieces.push(piece(Form::Code(Dialect::Hex))),
            // Which of the three it is, the words tell.
            Look::Words => pieces.push(piece(Form::Code(Dialect::SendReqEtc100))),
            Look::Table => pieces.push(piece(Form::Parameters)),
            Look::Iec => {
                let split = vendor::split(source).into_iter();
                pieces.extend(split.map(|(dialect, text)| Piece {
                    form: Form::Code(dialect),
                    first_line: part.first_line,
                    text,
                }));
            }
        }
    }
    pieces
}

/// Lines that look alike.
#[derive(Debug)]
struct Part {
    look: Look,
    first_line: usize,
    bytes: Range<usize>,
}

fn parts(text: &str) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    // Comments of a line, before it is known what they belong to.
    let mut waiting: Option<Part> = None;
    let mut open = Open::default();
    let mut at = 0;
    let mut after_blank = false;
    for (number, line) in (1..).zip(text.split_inclusive('\n')) {
        let bytes = at..at + line.len();
        at = bytes.end;
        let current = parts.last().map(|part| part.look);
        // A table that begins after an empty line is another one.
        let context = current.filter(|_| !(after_blank && line.trim_start().starts_with('|')));
        after_blank = line.trim().is_empty();
        let held = current.is_some_and(|look| open.holds(look, line));
        let found = if held { Look::Nothing } else { look(line, context) };
        match found {
            Look::Nothing => {
                if let Some(last) = waiting.as_mut().or(parts.last_mut()) {
                    last.bytes.end = bytes.end;
                }
            }
            Look::Remark => {
                let part = waiting.get_or_insert(Part {
                    look: Look::Remark,
                    first_line: number,
                    bytes: bytes.clone(),
                });
                part.bytes.end = bytes.end;
                continue;
            }
            look => {
                let whole = matches!(look, Look::Xml | Look::Json);
                let goes_on = parts.last().is_some_and(|last| last.look == look) && !whole;
                // Comments stand in front of what they are about, where that has comments of this form.
                let comment = waiting.take();
                let (first_line, start) = match comment {
                    Some(comment) if !whole && look != Look::Iec && look != Look::Table => {
                        (comment.first_line, comment.bytes.start)
                    }
                    _ => (number, bytes.start),
                };
                if let Some(last) = parts.last_mut().filter(|_| goes_on) {
                    last.bytes.end = bytes.end;
                } else {
                    parts.push(Part { look, first_line, bytes: start..bytes.end });
                    open = Open::default();
                }
            }
        }
        if let Some(last) = parts.last() {
            open.line(last.look, line);
        }
    }
    // What is no comment must not get lost.
    if let Some(last) = waiting.filter(|last| text.get(last.bytes.clone()).is_some_and(|it| it.contains('|')))
    {
        parts.push(Part { look: Look::Iec, ..last });
    }
    parts
}

/// A text of the same length and the same lines, with nothing but some ranges of it.
fn only(text: &str, keep: &[Range<usize>]) -> String {
    let mut kept = String::with_capacity(text.len());
    let mut ranges = keep.iter();
    let mut range = ranges.next();
    for (at, c) in text.char_indices() {
        while range.is_some_and(|range| range.end <= at) {
            range = ranges.next();
        }
        let inside = range.is_some_and(|range| range.contains(&at));
        kept.push(if inside || c == '\n' || c == '\r' { c } else { ' ' });
    }
    kept
}

#[cfg(test)]
mod tests;

//! A text as statements; what is none is remarked line by line.

use alloc::vec::Vec;
use core::ops::Range;

use winnow::stream::{Stateful, Stream, TokenSlice};

use super::declaration::declaration;
use super::grammar::assignment_or_call;
use super::input::{Failure, Input, is_next};
use super::syntax::Statement;
use super::token::{Lexeme, Place, Token, tokens};
use crate::code::remark::{Remark, RemarkKind};

/// A statement and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::code) struct Item<'a> {
    /// What it says.
    pub(in crate::code) statement: Statement<'a>,
    /// Its first token.
    pub(in crate::code) place: Place,
    /// Its bytes, with the semicolon.
    pub(in crate::code) span: Range<usize>,
    /// Its last line.
    pub(in crate::code) last_line: usize,
}

/// The statements of a text.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::code) struct Script<'a> {
    /// The text.
    pub(in crate::code) text: &'a str,
    /// In their order.
    pub(in crate::code) items: Vec<Item<'a>>,
    /// What was not understood, and the conditions that were left out.
    pub(in crate::code) remarks: Vec<Remark>,
}

/// Tokens of a condition. More is no condition, but a text that begins with IF.
const MAX_CONDITION: usize = 200;

/// Tokens before the colon of a declaration.
const MAX_NAMES: usize = 200;

/// What `END_…` closes, and nothing else.
const FRAMES: [&str; 8] = [
    "END_PROGRAM",
    "END_FUNCTION",
    "END_FUNCTION_BLOCK",
    "END_CASE",
    "END_FOR",
    "END_WHILE",
    "END_REPEAT",
    "END_IF",
];

/// Sections of declarations.
const SECTIONS: [&str; 9] = [
    "VAR",
    "VAR_GLOBAL",
    "VAR_INPUT",
    "VAR_OUTPUT",
    "VAR_IN_OUT",
    "VAR_EXTERNAL",
    "VAR_TEMP",
    "VAR_ACCESS",
    "VAR_CONFIG",
];

/// What may follow the word of a section.
const QUALIFIERS: [&str; 5] = ["CONSTANT", "RETAIN", "NON_RETAIN", "PERSISTENT", "PUBLIC"];

impl<'a> Script<'a> {
    /// Reads a whole text.
    pub(in crate::code) fn read(text: &'a str) -> Self {
        let (tokens, remarks) = tokens(text, false);
        let input = Stateful { input: TokenSlice::new(&tokens), state: 0 };
        let script = Self { text, items: Vec::new(), remarks };
        let mut reader = Reader { tokens: &tokens, input, script, section: None, flows: Vec::new() };
        while reader.input.peek_token().is_some() {
            reader.step();
        }
        let mut script = reader.script;
        script.remarks.sort_by_key(|remark| (remark.line, remark.column));
        script
    }

    /// The text of an item.
    pub(in crate::code) fn source(&self, item: &Item<'a>) -> &'a str {
        self.text.get(item.span.clone()).unwrap_or_default()
    }
}

struct Reader<'t, 'a> {
    tokens: &'t [Token<'a>],
    input: Input<'t, 'a>,
    script: Script<'a>,
    /// Inside of VAR … END_VAR: whether it is of constants.
    section: Option<bool>,
    /// The IFs, CASEs and loops around; whether it is a CASE.
    flows: Vec<bool>,
}

impl<'t, 'a: 't> Reader<'t, 'a> {
    /// One statement, or one frame around statements. Takes at least one token.
    fn step(&mut self) {
        let Some(first) = self.input.peek_token() else { return };
        let left = self.input.eof_offset();
        if first.is_sign(";") {
            self.input.next_token();
        } else if !self.frame(first) && !self.label(first) {
            self.statement(first);
        }
        if self.input.eof_offset() == left {
            self.input.next_token();
        }
    }

    fn frame(&mut self, first: &Token<'a>) -> bool {
        if first.lexeme != Lexeme::Name {
            return false;
        }
        let is = |words: &[&str]| words.iter().any(|word| first.is_word(word));
        if is(&SECTIONS) {
            self.input.next_token();
            let mut constant = false;
            while let Some(word) = self.input.peek_token().filter(|t| QUALIFIERS.iter().any(|q| t.is_word(q)))
            {
                constant |= word.is_word("CONSTANT");
                self.input.next_token();
            }
            self.section = Some(constant);
        } else if is(&["END_VAR"]) {
            self.input.next_token();
            self.section = None;
        } else if is(&FRAMES) {
            self.input.next_token();
            self.flows.pop();
        } else if is(&["IF", "ELSIF", "WHILE", "CASE", "FOR", "UNTIL"]) {
            self.condition(first);
        } else if is(&["ELSE", "REPEAT"]) {
            self.input.next_token();
            if first.is_word("REPEAT") {
                self.flows.push(false);
            }
            // The colon of a CASE's ELSE.
            if is_next(&self.input, &[":"]) {
                self.input.next_token();
            }
        } else if is(&["PROGRAM", "FUNCTION_BLOCK", "FUNCTION"]) {
            self.input.next_token();
            let line = first.place.line;
            while self.input.peek_token().is_some_and(|token| token.place.line == line) {
                self.input.next_token();
            }
        } else if is(&["RETURN", "EXIT"]) {
            self.input.next_token();
            self.note(first, RemarkKind::NoEffect(first.text.into()));
        } else {
            return false;
        }
        true
    }

    /// A condition belongs to the program: it is noted and left out.
    fn condition(&mut self, first: &Token<'a>) {
        let end = match () {
            () if first.is_word("CASE") => "OF",
            () if first.is_word("IF") || first.is_word("ELSIF") => "THEN",
            () if first.is_word("UNTIL") => "END_REPEAT",
            () => "DO",
        };
        let before = self.input.checkpoint();
        let mut last = first;
        let mut ended = false;
        for _ in 0..MAX_CONDITION {
            let Some(token) = self.input.peek_token() else { break };
            ended = token.is_word(end);
            if token.is_sign(";") || ended && first.is_word("UNTIL") {
                break;
            }
            self.input.next_token();
            last = token;
            if ended {
                break;
            }
        }
        if !ended {
            self.input.reset(&before);
            return self.fail(first, Failure::new(&self.input, RemarkKind::Expected(end.into())));
        }
        if !first.is_word("ELSIF") && !first.is_word("UNTIL") {
            self.flows.push(first.is_word("CASE"));
        }
        let excerpt = self.script.text.get(first.place.at..last.end()).unwrap_or_default();
        let what = RemarkKind::NoEffect("a condition".into());
        self.script.remarks.push(Remark::note(first.place.line, first.place.column, excerpt, what));
    }

    /// `0:`, `1, 2:`, `5..9:` of a CASE.
    fn label(&mut self, first: &Token<'a>) -> bool {
        if !self.flows.last().is_some_and(|case| *case) || first.lexeme == Lexeme::Address {
            return false;
        }
        let before = self.input.checkpoint();
        while let Some(token) = self.input.next_token() {
            let part = matches!(token.lexeme, Lexeme::Number | Lexeme::Name)
                || [",", "..", "-"].iter().any(|sign| token.is_sign(sign));
            if token.is_sign(":") {
                return true;
            }
            if !part || token.place.line != first.place.line {
                break;
            }
        }
        self.input.reset(&before);
        false
    }

    fn statement(&mut self, first: &Token<'a>) {
        self.input.state = 0;
        let section = self.section.or_else(|| self.is_declaration().then_some(false));
        let parsed = match section {
            Some(constant) => declaration(&mut self.input, constant).map(Statement::Declaration),
            None => assignment_or_call(&mut self.input),
        };
        match parsed {
            Ok(statement) => self.end(first, statement),
            Err(failure) => self.fail(first, failure),
        }
    }

    /// Declarations are pasted without their VAR, too: `a : INT`, `a, b AT %MW0 : INT`.
    fn is_declaration(&mut self) -> bool {
        let before = self.input.checkpoint();
        let mut is = false;
        for _ in 0..MAX_NAMES {
            let Some(token) = self.input.next_token() else { break };
            if token.lexeme != Lexeme::Name && token.lexeme != Lexeme::Address && !token.is_sign(",") {
                is = token.is_sign(":");
                break;
            }
        }
        self.input.reset(&before);
        is
    }

    /// A semicolon, or at least another line.
    fn end(&mut self, first: &Token<'a>, statement: Statement<'a>) {
        let next = self.input.peek_token();
        let Some(last) = self.last() else { return };
        let ended = next.is_some_and(|token| token.is_sign(";"));
        let elsewhere = next.is_none_or(|token| token.place.line > last.place.line);
        if !ended && !elsewhere {
            return self.fail(first, Failure::new(&self.input, RemarkKind::Expected(";".into())));
        }
        let mut end = last.end();
        if let Some(semicolon) = next.filter(|_| ended) {
            self.input.next_token();
            end = semicolon.end();
        } else {
            let what = RemarkKind::Expected(";".into());
            let place = last.place;
            self.script.remarks.push(Remark::warning(place.line, place.column, last.text, what));
        }
        self.script.items.push(Item {
            statement,
            place: first.place,
            span: first.place.at..end,
            last_line: last.place.line,
        });
    }

    /// The last token that was taken.
    fn last(&self) -> Option<&'t Token<'a>> {
        let taken = self.tokens.len() - self.input.eof_offset();
        self.tokens.get(taken.checked_sub(1)?)
    }

    /// Up to the semicolon or the end of the line where it failed, so that the next line is read by itself.
    fn fail(&mut self, first: &Token<'a>, failure: Failure) {
        let at = self.tokens.len() - failure.left;
        let at = self.tokens.get(at).or(self.tokens.last()).unwrap_or(first);
        let mut last = first;
        while let Some(token) = self.input.peek_token() {
            if token.place.line > at.place.line {
                break;
            }
            last = token;
            self.input.next_token();
            if token.is_sign(";") && token.place.at >= at.place.at {
                break;
            }
        }
        let start = if at.place.line == first.place.line { first } else { at };
        let excerpt = self.script.text.get(start.place.at..last.end().max(at.end())).unwrap_or_default();
        self.script.remarks.push(Remark::error(at.place.line, at.place.column, excerpt, failure.what));
    }

    fn note(&mut self, token: &Token<'a>, what: RemarkKind) {
        self.script.remarks.push(Remark::note(token.place.line, token.place.column, token.text, what));
    }
}

//! `MessageRequest` of rseip in a program.

use alloc::string::ToString;
use alloc::vec::Vec;

use super::super::dialect::Dialect;
use super::super::program::{Kind, Language, Names, Token, Value, groups, remember, tokens, value};
use super::super::remark::{Remark, RemarkKind};
use super::super::{Found, Imported, MAX_BLOCKS};
use super::request::{Bound, Request};
use super::way::{Said, Way, said};

/// Functions of `CommonServices`, and the service of each.
const SERVICES: [(&str, i64); 8] = [
    ("get_attribute_all", 0x01),
    ("set_attribute_all", 0x02),
    ("reset", 0x05),
    ("start", 0x06),
    ("stop", 0x07),
    ("get_attribute_single", 0x0E),
    ("set_attribute_single", 0x10),
    ("no_operation", 0x17),
];

/// Blocks from a program.
pub(in super::super) fn import(text: &str) -> Imported {
    let (tokens, remarks) = tokens(text, Language::Rust);
    let mut program = Program {
        names: Names::new(),
        bound: Bound::new(),
        way: Way::default(),
        fresh: true,
        blocks: Vec::new(),
        remarks,
    };
    let mut at = 0;
    while at < tokens.len() && program.blocks.len() <= MAX_BLOCKS {
        at += program.step(tokens.get(at..).unwrap_or_default()).max(1);
    }
    program.finish(text, &tokens)
}

struct Program<'t, 'a> {
    names: Names,
    bound: Bound<'t, 'a>,
    way: Way,
    /// Nothing of a way has been said since the last message.
    fresh: bool,
    blocks: Vec<Found>,
    remarks: Vec<Remark>,
}

impl<'t, 'a> Program<'t, 'a> {
    /// One place of the program; how many tokens it has.
    fn step(&mut self, rest: &'t [Token<'a>]) -> usize {
        match rest {
            // `use a::b;`
            [word, ..] if word.is("use") => rest.iter().position(|token| token.is(";")).unwrap_or(rest.len()),
            [word, ..] if word.is("let") || word.is("const") => self.bind(rest),
            [name, a, b, new, open, ..]
                if name.is("MessageRequest") && a.is(":") && b.is(":") && new.is("new") && open.is("(") =>
            {
                let (arguments, length) = groups(rest.get(4..).unwrap_or_default());
                self.message(rest.get(..4 + length).unwrap_or(rest), None, &arguments);
                4 + length
            }
            [dot, name, open, ..] if dot.is(".") && open.is("(") => {
                if let Some((_, service)) = SERVICES.iter().find(|(service, _)| name.is(service)) {
                    let (arguments, length) = groups(rest.get(2..).unwrap_or_default());
                    if !arguments.is_empty() {
                        self.message(rest.get(..2 + length).unwrap_or(rest), Some(*service), &arguments);
                        return 2 + length;
                    }
                }
                self.way(rest);
                1
            }
            _ => {
                self.way(rest);
                1
            }
        }
    }

    /// `let name: type = …;`, `const NAME: type = …;`: only the name is behind; what it is made of is read on. What is
    /// `mut` is changed later, so that its value is not known.
    fn bind(&mut self, rest: &'t [Token<'a>]) -> usize {
        let (sign, end) = statement(rest);
        let Some(sign) = sign else { return 1 };
        let before = rest.get(1..sign).unwrap_or_default();
        let made = rest.get(sign + 1..end).unwrap_or_default();
        let is_constant = !before.iter().any(|token| token.is("mut"));
        let mut names = before.iter().filter(|token| token.kind == Kind::Name && token.text != "mut");
        if let Some(name) = names.next() {
            let value = value(made, &self.names).filter(|_| is_constant);
            if let (Some(Value::Text(text)), true) = (&value, name.text.eq_ignore_ascii_case("name")) {
                self.say(Said::Name(text.clone()));
            }
            remember(&mut self.names, name.text, value);
            self.bound.remove(name.text);
            if is_constant {
                self.bound.insert(name.text, made);
            }
        }
        // Of a pattern, or of a type.
        for name in names {
            self.names.remove(name.text);
        }
        sign + 1
    }

    /// Something that says where messages go, and how long they have.
    fn way(&mut self, rest: &[Token<'_>]) {
        if let Some(said) = said(rest, &self.names) {
            self.say(said);
        }
    }

    /// The first thing that is said after a message begins another way.
    fn say(&mut self, said: Said) {
        if !self.fresh {
            (self.way, self.fresh) = (Way::default(), true);
        }
        self.way.add(said);
    }

    fn message(&mut self, tokens: &[Token<'a>], service: Option<i64>, arguments: &[&'t [Token<'a>]]) {
        let (Some(first), Some(last)) = (tokens.first(), tokens.last()) else { return };
        let (names, bound, way) = (&self.names, &self.bound, &self.way);
        let mut request = Request { names, bound, way, tokens, remarks: Vec::new() };
        let config = request.config(service, arguments);
        let (lines, remarks) = (first.line..last.line + 1, request.remarks);
        self.fresh = false;
        self.blocks.push(Found { config: config.into(), dialect: Dialect::Rust, lines, remarks });
    }

    fn finish(mut self, text: &str, tokens: &[Token<'_>]) -> Imported {
        if self.blocks.is_empty() {
            let what = RemarkKind::Expected("MessageRequest::new(…) of rseip".to_string());
            self.remarks.push(Remark::error(1, 1, text, what));
        } else if let Some(around) =
            tokens.iter().find(|token| ["for", "while", "loop"].iter().any(|word| token.is(word)))
        {
            let what = RemarkKind::NoEffect("how often the program does it".to_string());
            self.remarks.push(Remark::note(around.line, around.column, around.text, what));
        }
        Imported { blocks: self.blocks, remarks: self.remarks }
    }
}

/// Where the `=` of a statement is, and its end: a semicolon, or another statement where that is forgotten.
fn statement(rest: &[Token<'_>]) -> (Option<usize>, usize) {
    let (mut sign, mut at) = (None, 1);
    while let Some(token) = rest.get(at) {
        if [";", "let", "use", "fn"].iter().any(|end| token.is(end)) {
            break;
        }
        if sign.is_none() && token.is("=") {
            sign = Some(at);
        }
        at += token.close + 1;
    }
    (sign, at.min(rest.len()))
}

//! JSON with the place of every member: serde says what is wrong, this says where.

use alloc::borrow::ToOwned;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use serde_json::Value;

use super::error::ProjectErrorKind;

/// A place in a text, as editors count: both from 1, columns in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position {
    /// From 1.
    pub line: usize,
    /// In characters, from 1.
    pub column: usize,
}

/// The place of a member such as `AppCfg.MemberId[1]`; of what it is in, if it is not there itself. None: this is no JSON.
pub fn locate(text: &str, field: &str) -> Option<Position> {
    let document = Document::parse(text).ok()?;
    let mut node = &document.root;
    for step in field.split(['.', '[']) {
        let step = step.trim_end_matches(']');
        let inside = match &node.inside {
            Inside::Nothing => None,
            Inside::Members(members) => {
                members.iter().find(|member| member.name == step).map(|found| &found.node)
            }
            Inside::Items(items) => step.parse().ok().and_then(|place: usize| items.get(place)),
        };
        let Some(inside) = inside else { break };
        node = inside;
    }
    Some(position(text, node.at))
}

/// A text that is JSON and says everything once.
#[derive(Debug)]
pub(super) struct Document<'a> {
    text: &'a str,
    /// What it says.
    pub(super) value: Value,
    /// Where it says it.
    pub(super) root: Node,
}

/// A value and where it begins.
#[derive(Debug)]
pub(super) struct Node {
    /// In bytes.
    pub(super) at: usize,
    pub(super) inside: Inside,
}

/// What is in a value.
#[derive(Debug)]
pub(super) enum Inside {
    Nothing,
    Members(Vec<Member>),
    Items(Vec<Node>),
}

/// A member of an object.
#[derive(Debug)]
pub(super) struct Member {
    pub(super) name: String,
    /// Where the name begins, in bytes.
    pub(super) at: usize,
    pub(super) node: Node,
}

/// What is wrong with a text, and where.
pub(super) type Wrong = (Position, ProjectErrorKind);

impl<'a> Document<'a> {
    /// Everything that is wrong with it as JSON, or the document.
    pub(super) fn parse(text: &'a str) -> Result<Self, Vec<Wrong>> {
        let value = serde_json::from_str(text).map_err(|error| {
            let words = error.to_string();
            let words = words.rsplit_once(" at line ").map_or(&*words, |(words, _)| words);
            let place = place_of_byte(text, error.line(), error.column());
            alloc::vec![(place, ProjectErrorKind::Json(words.to_owned()))]
        })?;
        let mut scan = Scan { text, at: 0, wrong: Vec::new() };
        let root = scan.value();
        if scan.wrong.is_empty() { Ok(Self { text, value, root }) } else { Err(scan.wrong) }
    }

    /// Where a node is.
    pub(super) fn position(&self, at: usize) -> Position {
        position(self.text, at)
    }

    /// Reads a part of the document; what is wrong is told with its place.
    pub(super) fn read<T>(
        &self,
        value: &Value,
        node: &Node,
        read: impl Fn(Value) -> Result<T, serde_json::Error>,
    ) -> Result<T, Wrong> {
        read(value.clone()).map_err(|error| {
            let words = error.to_string();
            let fails = |value: &Value| read(value.clone()).map_err(|error| error.to_string()).err();
            let missing = words.strip_prefix("missing field `").and_then(|rest| rest.split('`').next());
            let at = match missing {
                Some(name) => lacking(value, node, name, &words, &fails),
                None => culprit(value, node, &words, &fails),
            };
            (self.position(at), ProjectErrorKind::Content(words))
        })
    }
}

/// The innermost part without which something else is wrong, or nothing.
fn culprit(whole: &Value, node: &Node, words: &str, fails: &impl Fn(&Value) -> Option<String>) -> usize {
    let (mut node, mut path) = (node, String::new());
    'deeper: loop {
        let parts: Vec<(String, &Node)> = match &node.inside {
            Inside::Nothing => break,
            Inside::Members(members) => {
                members.iter().map(|member| (member.name.clone(), &member.node)).collect()
            }
            Inside::Items(items) => {
                items.iter().enumerate().map(|(place, item)| (place.to_string(), item)).collect()
            }
        };
        for (name, part) in parts {
            let mut without = whole.clone();
            match without.pointer_mut(&path) {
                Some(Value::Object(members)) => drop(members.remove(&name)),
                Some(Value::Array(items)) => {
                    let place = name.parse().unwrap_or(usize::MAX);
                    if place < items.len() {
                        items.remove(place);
                    }
                }
                _ => {}
            }
            if fails(&without).as_deref() != Some(words) {
                path = format!("{path}/{}", escaped(&name));
                node = part;
                continue 'deeper;
            }
        }
        break;
    }
    node.at
}

/// The object that lacks a member: with it, something else is wrong.
fn lacking(
    whole: &Value,
    root: &Node,
    name: &str,
    words: &str,
    fails: &impl Fn(&Value) -> Option<String>,
) -> usize {
    let mut open = alloc::vec![(String::new(), root)];
    while let Some((path, node)) = open.pop() {
        let mut with = whole.clone();
        if let Some(Value::Object(members)) = with.pointer_mut(&path) {
            members.insert(name.to_owned(), Value::Null);
        }
        if fails(&with).as_deref() != Some(words) {
            return node.at;
        }
        match &node.inside {
            Inside::Nothing => {}
            Inside::Members(members) => {
                let inner =
                    members.iter().map(|member| (format!("{path}/{}", escaped(&member.name)), &member.node));
                open.extend(inner);
            }
            Inside::Items(items) => {
                open.extend(items.iter().enumerate().map(|(place, item)| (format!("{path}/{place}"), item)));
            }
        }
    }
    root.at
}

/// As a JSON pointer has it (RFC 6901).
fn escaped(name: &str) -> String {
    name.replace('~', "~0").replace('/', "~1")
}

/// Walks over a text that is known to be JSON.
struct Scan<'a> {
    text: &'a str,
    at: usize,
    wrong: Vec<Wrong>,
}

impl Scan<'_> {
    fn value(&mut self) -> Node {
        self.space();
        let at = self.at;
        let inside = match self.peek() {
            Some(b'{') => Inside::Members(self.members()),
            Some(b'[') => Inside::Items(self.items()),
            Some(b'"') => {
                self.string();
                Inside::Nothing
            }
            _ => {
                self.word();
                Inside::Nothing
            }
        };
        Node { at, inside }
    }

    fn members(&mut self) -> Vec<Member> {
        let mut members: Vec<Member> = Vec::new();
        let mut names = alloc::collections::BTreeSet::new();
        self.at += 1;
        while self.more(b'}') {
            let at = self.at;
            let name: String = serde_json::from_str(self.string()).unwrap_or_default();
            if !names.insert(name.clone()) {
                self.wrong.push((position(self.text, at), ProjectErrorKind::Twice(name.clone())));
            }
            self.space();
            self.at += 1; // the colon
            let node = self.value();
            members.push(Member { name, at, node });
        }
        members
    }

    fn items(&mut self) -> Vec<Node> {
        let mut items = Vec::new();
        self.at += 1;
        while self.more(b']') {
            items.push(self.value());
        }
        items
    }

    /// Whether another part begins here; steps over commas and over the end.
    fn more(&mut self, end: u8) -> bool {
        self.space();
        if self.peek() == Some(b',') {
            self.at += 1;
            self.space();
        }
        match self.peek() {
            Some(byte) if byte != end => true,
            _ => {
                self.at += 1;
                false
            }
        }
    }

    /// Steps over a text in quotes.
    fn string(&mut self) -> &str {
        let begin = self.at;
        self.at += 1;
        while let Some(byte) = self.peek() {
            self.at += if byte == b'\\' { 2 } else { 1 };
            if byte == b'"' {
                break;
            }
        }
        self.text.get(begin..self.at).unwrap_or_default()
    }

    /// Steps over a number, `true`, `false` or `null`.
    fn word(&mut self) {
        let begin = self.at;
        while self
            .peek()
            .is_some_and(|byte| !matches!(byte, b',' | b'}' | b']') && !byte.is_ascii_whitespace())
        {
            self.at += 1;
        }
        let word = self.text.get(begin..self.at).unwrap_or_default();
        let is_whole = word.bytes().all(|byte| byte.is_ascii_digit() || byte == b'-');
        if is_whole && word.parse::<i64>().is_err() && word.parse::<u64>().is_err() {
            self.wrong.push((position(self.text, begin), ProjectErrorKind::Inexact(word.to_owned())));
        }
        if self.at == begin {
            // Never in JSON; it ends all the same.
            self.at += 1;
        }
    }

    fn space(&mut self) {
        while self.peek().is_some_and(|byte| byte.is_ascii_whitespace()) {
            self.at += 1;
        }
    }

    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }
}

/// The place of a byte.
fn position(text: &str, at: usize) -> Position {
    let before = text.get(..text.floor_char_boundary(at)).unwrap_or_default();
    let line = before.bytes().filter(|byte| *byte == b'\n').count() + 1;
    let begin = before.rfind('\n').map_or(0, |at| at + 1);
    Position { line, column: before.get(begin..).unwrap_or_default().chars().count() + 1 }
}

/// serde counts the bytes of a line from 1, and 0 before its first.
fn place_of_byte(text: &str, line: usize, column: usize) -> Position {
    let line_text = text.split('\n').nth(line.saturating_sub(1)).unwrap_or_default();
    let before = line_text.get(..line_text.floor_char_boundary(column.saturating_sub(1))).unwrap_or_default();
    Position { line: line.max(1), column: before.chars().count() + 1 }
}

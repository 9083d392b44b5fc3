//! JSON once more, for the places of its members: serde_json says none.

use alloc::borrow::ToOwned;
use alloc::collections::BTreeSet;
use alloc::string::String;
use alloc::vec::Vec;

use super::document::{Inside, Member, Node, WrongAt};
use super::error::ProjectErrorKind;

/// Where everything is in a text that is known to be JSON, and what would be lost of it.
pub(super) fn scan(text: &str) -> (Node, Vec<WrongAt>) {
    let mut scan = Scan { text, at: 0, wrong: Vec::new() };
    let root = scan.value();
    (root, scan.wrong)
}

struct Scan<'a> {
    text: &'a str,
    at: usize,
    wrong: Vec<WrongAt>,
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
        let mut names = BTreeSet::new();
        self.at += 1;
        while self.more(b'}') {
            let at = self.at;
            let name: String = serde_json::from_str(self.string()).unwrap_or_default();
            if !names.insert(name.clone()) {
                self.wrong.push((at, ProjectErrorKind::Twice(name.clone())));
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
            self.wrong.push((begin, ProjectErrorKind::Inexact(word.to_owned())));
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

//! The tree, and how it grows while bytes are read.

use alloc::borrow::Cow;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;

use crate::wire::{DecodeError, DecodeErrorKind, Reader};

/// A range of bytes and what it is. The children cover the range without gaps; a node without children is a leaf.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Node {
    /// The first byte, counted from the start of what was dissected.
    pub from: usize,
    /// The byte after the last.
    pub to: usize,
    /// What it is: `service`, `class`, `product name` …
    pub name: Cow<'static, str>,
    /// What it says: number, name, explanation. May be empty where the children say it.
    pub text: String,
    /// The parts, in order.
    pub children: Vec<Self>,
    /// Whether these bytes are not what they should be. A child's error is not repeated here.
    pub error: bool,
}

impl Node {
    pub(super) const fn leaf(from: usize, to: usize, name: Cow<'static, str>, text: String) -> Self {
        Self { from, to, name, text, children: Vec::new(), error: false }
    }

    /// All leaves in the order of their bytes.
    pub fn leaves(&self) -> Vec<&Self> {
        if self.children.is_empty() {
            return alloc::vec![self];
        }
        self.children.iter().flat_map(Self::leaves).collect()
    }

    /// Whether there is an error here or below.
    pub fn is_broken(&self) -> bool {
        self.error || self.children.iter().any(Self::is_broken)
    }

    fn print(&self, depth: usize, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mark = if self.error { "! " } else { "" };
        write!(f, "{:width$}{mark}{}..{} {}", "", self.from, self.to, self.name, width = 2 * depth)?;
        if !self.text.is_empty() {
            write!(f, ": {}", self.text)?;
        }
        writeln!(f)?;
        self.children.iter().try_for_each(|child| child.print(depth + 1, f))
    }
}

/// One line a node, indented.
impl fmt::Display for Node {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.print(0, f)
    }
}

/// A node that is being read. Reading past the end turns what is left into an error and gives `None`.
#[derive(Debug)]
pub(super) struct Tree<'a> {
    reader: Reader<'a>,
    from: usize,
    children: Vec<Node>,
    problem: Option<DecodeError>,
}

impl<'a> Tree<'a> {
    /// Reads bytes that start at byte `at` of the whole.
    pub(super) const fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { reader: Reader::starting_at(bytes, at), from: at, children: Vec::new(), problem: None }
    }

    pub(super) const fn at(&self) -> usize {
        self.reader.at()
    }

    pub(super) const fn is_empty(&self) -> bool {
        self.reader.is_empty()
    }

    pub(super) const fn remaining(&self) -> usize {
        self.reader.remaining()
    }

    /// What comes next, without taking it.
    pub(super) fn peek(&self) -> Reader<'a> {
        self.reader.clone()
    }

    /// A leaf of `n` bytes.
    pub(super) fn leaf(
        &mut self,
        n: usize,
        name: impl Into<Cow<'static, str>>,
        text: impl FnOnce(&'a [u8]) -> String,
    ) -> Option<&'a [u8]> {
        let from = self.at();
        let name = name.into();
        match self.reader.take(n) {
            Ok(bytes) => {
                if n > 0 {
                    self.children.push(Node::leaf(from, self.at(), name, text(bytes)));
                }
                Some(bytes)
            }
            Err(error) => {
                self.fail(name, error);
                None
            }
        }
    }

    /// A leaf that is a USINT.
    pub(super) fn u8(&mut self, name: &'static str, text: impl FnOnce(u8) -> String) -> Option<u8> {
        let value = self.peek().u8().unwrap_or_default();
        self.leaf(1, name, |_| text(value))?;
        Some(value)
    }

    /// A leaf that is a UINT.
    pub(super) fn u16(&mut self, name: &'static str, text: impl FnOnce(u16) -> String) -> Option<u16> {
        let value = self.peek().u16().unwrap_or_default();
        self.leaf(2, name, |_| text(value))?;
        Some(value)
    }

    /// A leaf that is a UDINT.
    pub(super) fn u32(&mut self, name: &'static str, text: impl FnOnce(u32) -> String) -> Option<u32> {
        let value = self.peek().u32().unwrap_or_default();
        self.leaf(4, name, |_| text(value))?;
        Some(value)
    }

    /// Everything that is left, as it has been dissected elsewhere.
    pub(super) fn push_rest(&mut self, nodes: impl IntoIterator<Item = Node>) {
        self.reader.rest();
        self.children.extend(nodes);
    }

    /// A node of `n` bytes with parts of its own. If there are fewer, it is filled as far as they go.
    pub(super) fn branch(
        &mut self,
        n: usize,
        name: impl Into<Cow<'static, str>>,
        fill: impl FnOnce(&mut Self) -> Option<()>,
    ) -> Option<()> {
        let at = self.at();
        let taken = self.reader.take(n);
        let cut = taken.as_ref().err().copied();
        let bytes = taken.unwrap_or_else(|_| self.reader.rest());
        if bytes.is_empty() {
            self.problem = self.problem.or(cut);
        } else {
            let mut part = Self::new(bytes, at);
            // `None` has left its error in the part.
            let _ = fill(&mut part);
            part.problem = cut.or(part.problem);
            self.children.push(part.close(name, String::new()));
        }
        match cut {
            None => Some(()),
            Some(_) => None,
        }
    }

    /// What is left cannot be understood.
    pub(super) fn fail(&mut self, name: impl Into<Cow<'static, str>>, error: DecodeError) {
        let from = self.at();
        if self.reader.rest().is_empty() {
            self.problem = Some(error);
        } else {
            let leaf = Node::leaf(from, self.at(), name.into(), error.to_string());
            self.children.push(Node { error: true, ..leaf });
        }
    }

    /// The finished node. Bytes that nobody asked for are an error.
    pub(super) fn close(mut self, name: impl Into<Cow<'static, str>>, text: String) -> Node {
        if !self.is_empty() {
            let error = self.reader.error(DecodeErrorKind::Trailing { extra: self.remaining() });
            self.fail("unexpected bytes", error);
        }
        let error = self.problem.is_some();
        let text = self.problem.map_or(text, |problem| problem.to_string());
        let Self { reader, from, children, .. } = self;
        Node { from, to: reader.at(), name: name.into(), text, children, error }
    }
}

//! JSON with the place of every member: serde says what is wrong, this says where.

use alloc::borrow::ToOwned;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use serde_json::Value;

use super::culprit::{Search, culprit, lacking};
use super::error::ProjectErrorKind;
use super::place::{Lines, Position};
use super::scan::scan;

/// Where the members of a file are.
#[derive(Debug)]
pub struct Places<'a>(Document<'a>);

impl<'a> Places<'a> {
    /// None: this is no JSON.
    pub fn of(text: &'a str) -> Option<Self> {
        Document::parse(text).ok().map(Self)
    }

    /// The place of a member such as `AppCfg.MemberId[1]`; of what it is in, if it is not there itself.
    pub fn locate(&self, field: &str) -> Position {
        let mut node = &self.0.root;
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
        self.0.position(node.at)
    }
}

/// The first member that is there twice in a text that is JSON: by reading it, one of them would be lost.
pub fn twice(text: &str) -> Option<String> {
    scan(text).1.into_iter().find_map(|(_, what)| match what {
        ProjectErrorKind::Twice(name) => Some(name),
        _ => None,
    })
}

/// A text that is JSON and says everything once.
#[derive(Debug)]
pub(super) struct Document<'a> {
    lines: Lines<'a>,
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

/// The same, with the byte.
pub(super) type WrongAt = (usize, ProjectErrorKind);

/// Of one file so much is told one by one, and of the rest how much there is.
pub(super) const MAX_TOLD: usize = 100;

impl<'a> Document<'a> {
    /// Everything that is wrong with it as JSON, or the document.
    pub(super) fn parse(text: &'a str) -> Result<Self, Vec<Wrong>> {
        let lines = Lines::of(text);
        let value = serde_json::from_str(text).map_err(|error| {
            let words = error.to_string();
            let words = words.rsplit_once(" at line ").map_or(&*words, |(words, _)| words);
            let place = lines.position_of_serde(error.line(), error.column());
            alloc::vec![(place, ProjectErrorKind::Json(words.to_owned()))]
        })?;
        let (root, wrong) = scan(text);
        if wrong.is_empty() {
            return Ok(Self { lines, value, root });
        }
        let rest = wrong.len().saturating_sub(MAX_TOLD);
        let told = wrong.into_iter().take(MAX_TOLD);
        let mut told: Vec<Wrong> = told.map(|(at, what)| (lines.position(at), what)).collect();
        if let Some((last, _)) = told.last().filter(|_| rest > 0) {
            told.push((*last, ProjectErrorKind::More(rest)));
        }
        Err(told)
    }

    /// Where a node is.
    pub(super) fn position(&self, at: usize) -> Position {
        self.lines.position(at)
    }
}

/// Reads a part of a document; what is wrong is told with its byte.
pub(super) fn read_part<T>(
    value: &Value,
    node: &Node,
    search: &mut Search,
    read: impl Fn(Value) -> Result<T, serde_json::Error>,
) -> Result<T, WrongAt> {
    read(value.clone()).map_err(|error| {
        let words = error.to_string();
        let fails = |value: &Value| read(value.clone()).map_err(|error| error.to_string()).err();
        let missing = words.strip_prefix("missing field `").and_then(|rest| rest.split('`').next());
        let at = match missing {
            Some(name) => lacking(value, node, (name, &words), search, &fails),
            None => culprit(value, node, &words, search, &fails),
        };
        (at, ProjectErrorKind::Content(words))
    })
}

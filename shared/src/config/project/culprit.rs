//! Which part of a value is to blame for what serde says of the whole: the part that it does not complain about when it is
//! left out, or is there.

use alloc::borrow::ToOwned;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use serde_json::Value;

use super::document::{Inside, Node};

/// Bytes of JSON that are read again to find places, in all files of a project together. That is enough for all errors that
/// people make, and a project that is made to take long does not take minutes: then the place is that of something around the
/// culprit.
const MAX_SEARCHED: usize = 16 * 1024 * 1024;

/// What is left of [`MAX_SEARCHED`].
#[derive(Debug)]
pub(super) struct Search(usize);

impl Default for Search {
    fn default() -> Self {
        Self(MAX_SEARCHED)
    }
}

impl Search {
    /// Whether so many bytes may be read once more.
    fn may(&mut self, bytes: usize) -> bool {
        let may = self.0 > bytes;
        self.0 = self.0.saturating_sub(bytes + 1);
        may
    }
}

/// The innermost part without which something else is wrong, or nothing.
pub(super) fn culprit(
    whole: &Value,
    node: &Node,
    words: &str,
    search: &mut Search,
    fails: &impl Fn(&Value) -> Option<String>,
) -> usize {
    let (mut node, mut path, size) = (node, String::new(), whole.to_string().len());
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
            if !search.may(size) {
                break 'deeper;
            }
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
pub(super) fn lacking(
    whole: &Value,
    root: &Node,
    (name, words): (&str, &str),
    search: &mut Search,
    fails: &impl Fn(&Value) -> Option<String>,
) -> usize {
    let (mut open, size) = (alloc::vec![(String::new(), root)], whole.to_string().len());
    while let Some((path, node)) = open.pop() {
        if !search.may(size) {
            break;
        }
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

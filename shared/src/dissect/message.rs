//! Message router requests and replies.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use crate::table::{self, Field};
use crate::wire::{ClassCode, GeneralStatus, ServiceCode};

use super::connection_manager;
use super::path;
use super::tree::{Node, Tree};
use super::value::{About, Decoded, layout_of_reply, layout_of_request, values};
use super::words::coded;

/// A message router request: service, path, data.
pub fn request(bytes: &[u8]) -> Node {
    request_at(bytes, 0)
}

/// A message router reply: service, status, data. With its request, the data has types.
pub fn reply(bytes: &[u8], request: Option<&[u8]>) -> Node {
    reply_at(bytes, 0, &request.map(About::of).unwrap_or_default())
}

/// A request inside of something larger.
pub(super) fn request_at(bytes: &[u8], at: usize) -> Node {
    let mut tree = Tree::new(bytes, at);
    // `None` has left its error in the tree.
    let _ = fill_request(&mut tree, &About::of(bytes));
    tree.close("request", String::new())
}

/// A reply inside of something larger.
pub(super) fn reply_at(bytes: &[u8], at: usize, about: &About) -> Node {
    let mut tree = Tree::new(bytes, at);
    let _ = fill_reply(&mut tree, about);
    tree.close("reply", String::new())
}

fn fill_request(tree: &mut Tree<'_>, about: &About) -> Option<()> {
    let service = head(tree, about, "path")?;
    if connection_manager::is_asked(about) {
        return connection_manager::request(tree, service);
    }
    data(tree, layout_of_request(about))
}

/// A request inside of Unconnected_Send. One inside of that is left as bytes: only a puzzle has it.
pub(super) fn embedded(tree: &mut Tree<'_>) -> Option<()> {
    let about = About::of(tree.peek().rest());
    head(tree, &about, "embedded path")?;
    data(tree, layout_of_request(&about))
}

fn head(tree: &mut Tree<'_>, about: &About, path: &'static str) -> Option<ServiceCode> {
    let service = tree.u8("service", |code| service_text(about, ServiceCode(code)))?;
    let words = tree.u8("path size", |words| format!("{words} words, {} bytes", 2 * u16::from(words)))?;
    tree.branch(2 * usize::from(words), path, path::segments)?;
    Some(ServiceCode(service))
}

fn fill_reply(tree: &mut Tree<'_>, about: &About) -> Option<()> {
    let service = tree.u8("service", |code| {
        let service = ServiceCode(code & !ServiceCode::REPLY);
        if code == service.0 {
            return format!("{code:#04x}: not a reply, bit 7 is not set");
        }
        if let Some(who) = connection_manager::answers_instead(about, service) {
            let name = coded(service, table::service(ClassCode::ConnectionManager.0, service));
            return format!("{code:#04x}, reply to {name} {who}");
        }
        let answers = format!("{code:#04x}, reply to {}", service_text(about, service));
        match about.service {
            Some(asked) if asked != service => format!("{answers}. Another service was asked: {asked}"),
            _ => answers,
        }
    })?;
    let service = ServiceCode(service & !ServiceCode::REPLY);
    tree.u8("reserved", |byte| format!("{byte:#04x}"))?;
    let status = tree.u8("general status", |code| {
        coded(GeneralStatus(code), table::general_status(GeneralStatus(code)))
    })?;
    let status = GeneralStatus(status);
    let words = tree.u8("additional status size", |words| format!("{words} words"))?;
    for number in 0..words {
        tree.u16("additional status", |word| match number {
            0 => coded(format_args!("{word:#06x}"), table::extended_status(status, word)),
            _ => format!("{word} ({word:#06x})"),
        })?;
    }
    let refused = status != GeneralStatus::Success;
    if connection_manager::answers(about, service, refused, tree.remaining()) {
        return connection_manager::reply(tree, service, status);
    }
    data(tree, layout_of_reply(about, service, status))
}

fn service_text(about: &About, service: ServiceCode) -> String {
    let class = about.address.class.unwrap_or(0);
    coded(service, table::service(class, service))
}

/// Everything that is left: one leaf a field, and one for what is only guessed.
fn data(tree: &mut Tree<'_>, layout: Option<&'static [Field]>) -> Option<()> {
    tree.branch(tree.remaining(), "data", |tree| {
        let at = tree.at();
        let bytes = tree.peek().rest();
        let mut leaves: Vec<Node> = Vec::new();
        for value in values(layout, bytes) {
            let (from, to) = (at + value.from, at + value.to);
            let text = format!("{} {}{}", value.type_name, value.text, meaning(&value));
            match leaves.last_mut() {
                // Alternatives of the same guess.
                Some(last) if last.from == from => {
                    last.text.push_str(" or ");
                    last.text.push_str(&text);
                }
                _ if value.guess => {
                    leaves.push(Node::leaf(from, to, "type unknown".into(), "guess: ".to_string() + &text));
                }
                _ => leaves.push(Node::leaf(from, to, value.name, text)),
            }
        }
        tree.push_rest(leaves);
        Some(())
    })
}

/// The name behind a number that the specification's owner gives out, with a space before it.
fn meaning(value: &Decoded) -> String {
    let number = value.text.parse().ok();
    let entry = match value.name.as_ref() {
        "vendor id" => number.and_then(table::vendor),
        "device type" => number.and_then(table::device_type),
        _ => None,
    };
    entry.map_or_else(String::new, |entry| format!(" {}", entry.name))
}

//! `cipdeck write`: reads what is there, writes, and reads again.

use cipdeck_shared::engine::poll::{Quality, Reading, Reason};
use cipdeck_shared::tag::{self, Dialect, Elementary, TagHead, Type, Value, request};
use cipdeck_shared::wire::{GeneralStatus, MessageRouterReply, MessageRouterRequest};
use clap::Args;
use serde_json::json;

use super::controller::Controller;
use super::read::{exit, items};
use super::{Place, Tag, tag};
use crate::cli::{Exit, say};

/// A tag that is written.
#[derive(Debug, Args)]
#[command(
    after_help = "A value is written as 12.5, 0x1F, 16#1F, TRUE, \"text\", [1, 2, 3] or {speed: 1.5, run: TRUE}. \
                        Without a type it is written as the device says that it is."
)]
pub(in crate::cli) struct Write {
    #[command(flatten)]
    place: Place,
    /// What to write: a name, or a name with its type: Table=DINT[3]
    #[arg(value_name = "TAG", value_parser = tag)]
    tag: Tag,
    /// What will be there
    #[arg(value_name = "VALUE", allow_hyphen_values = true)]
    value: String,
}

impl Write {
    /// Writes and prints.
    pub(in crate::cli) async fn execute(self) -> Exit {
        let Self { place, tag, value } = self;
        let way = match place.way() {
            Ok(way) => way,
            Err(exit) => return exit,
        };
        Controller::with(way, async |controller| {
            let old = read(controller, &tag).await;
            let request = match tag.name.bit() {
                Some(bit) => {
                    let whole = Tag { name: tag.name.without_bit(), kind: tag.kind.clone() };
                    let whole = read(controller, &whole).await;
                    bit_of(controller.dialect(), &tag, &whole, bit, &value)
                }
                None => plan(controller, &tag, &old, &value),
            };
            let request = match request {
                Ok(request) => request,
                Err(exit) => return exit,
            };
            let reply = match controller.ask(request).await {
                Ok(reply) => reply,
                Err(lost) => {
                    let sent = "if it had been sent, the device may have carried it out";
                    return Exit::unanswered(&format!("{}: {}; {sent}", tag.name, lost.reason));
                }
            };
            let refused = refused(&reply);
            let now = read(controller, &tag).await;
            print(&place, &tag, [&old, &now], refused.as_deref());
            if refused.is_some() { Exit::REFUSED } else { exit(&[now]) }
        })
        .await
    }
}

async fn read(controller: &mut Controller, tag: &Tag) -> Reading {
    let reading = controller.read(items(std::slice::from_ref(tag))).await.pop().unwrap_or_default();
    if !matches!(reading.reason, Some(Reason::OtherType(_))) {
        return reading;
    }
    // It is not what somebody says that it is: what is there is shown as the device has it.
    let own = Tag { kind: None, ..tag.clone() };
    controller.read(items(&[own])).await.pop().unwrap_or_default()
}

/// The message, or why there is none.
fn plan(controller: &Controller, tag: &Tag, old: &Reading, text: &str) -> Result<MessageRouterRequest, Exit> {
    let (dialect, path) = (controller.dialect(), tag.name.path());
    // Somebody who says the type may be wrong about it: that is the device's to refuse.
    let Some(kind) = tag.kind.as_ref().or(old.kind.as_ref()) else {
        eprintln!("{}: {}", tag.name, old.reason.as_ref().map_or_else(unknown, Reason::text));
        return Err(if old.quality == Quality::Good {
            Exit::usage(&unknown())
        } else {
            exit(std::slice::from_ref(old))
        });
    };
    let wrong = |error: &dyn std::fmt::Display| Exit::usage(&format!("{}: {error}", tag.name));
    let value = kind.parse_value(text).map_err(|error| wrong(&error))?;
    let data = kind.encode(dialect, &value).map_err(|error| wrong(&error))?;
    let head = head(kind, dialect, old).ok_or_else(|| Exit::usage(&unknown()))?;
    let elements = u16::try_from(kind.elements(dialect)).unwrap_or(u16::MAX);
    let request = request::write(path, head, elements, &data).map_err(|error| wrong(&error))?;
    let (length, max) = (request.bytes().len(), controller.limits().request_max);
    if length > max {
        let less = "write its elements or members one by one, or use --connected";
        return Err(wrong(&format!("the message has {length} bytes, the device takes {max}: {less}")));
    }
    Ok(request)
}

/// A structure is written with the handle that it was read with.
fn head(kind: &Type, dialect: Dialect, old: &Reading) -> Option<TagHead> {
    kind.head(dialect).or_else(|| old.kind.as_ref()?.head(dialect))
}

/// Only a Logix writes a bit without touching the others.
fn bit_of(
    dialect: Dialect,
    tag: &Tag,
    whole: &Reading,
    bit: u8,
    text: &str,
) -> Result<MessageRouterRequest, Exit> {
    let wrong = |error: &dyn std::fmt::Display| Exit::usage(&format!("{}: {error}", tag.name));
    if dialect != Dialect::Logix {
        return Err(wrong(&"this controller cannot write a single bit: write the whole number"));
    }
    if whole.quality != Quality::Good {
        eprintln!("{}: {}", tag.name, whole.reason.as_ref().map_or_else(unknown, Reason::text));
        return Err(exit(std::slice::from_ref(whole)));
    }
    let on = Type::Elementary(Elementary::Bool).parse_value(text).map_err(|error| wrong(&error))?;
    let bits = match whole.kind {
        Some(Type::Elementary(kind)) => kind.bits().filter(|bits| bit < *bits),
        _ => None,
    };
    let size = bits.ok_or_else(|| wrong(&"there is no such bit: it is no whole number, or too small"))? / 8;
    let request = request::write_bit(tag.name.path(), size.into(), bit, on == Value::Bool(true));
    request.map_err(|error| wrong(&error))
}

fn unknown() -> String {
    "the device does not say what it is: give its type, as in TAG=DINT".to_owned()
}

/// Why the device has not carried it out, in words.
fn refused(reply: &[u8]) -> Option<String> {
    match MessageRouterReply::decode(reply) {
        Ok(reply) if reply.status == GeneralStatus::Success => None,
        Ok(reply) => Some(tag::refusal(reply.status, reply.additional.words().next())),
        Err(error) => Some(error.to_string()),
    }
}

fn print(place: &Place, tag: &Tag, [old, now]: [&Reading; 2], refused: Option<&str>) {
    let text = |reading: &Reading| {
        reading.value.as_ref().filter(|_| reading.quality == Quality::Good).map(ToString::to_string)
    };
    if place.json {
        let value = |reading: &Reading| {
            reading.value.as_ref().filter(|_| reading.quality == Quality::Good).map(Value::to_json)
        };
        say(&json!({
            "path": place.path,
            "tag": tag.name.to_string(),
            "old": value(old),
            "value": value(now),
            "error": refused,
        })
        .to_string());
        return;
    }
    let shown = |reading: &Reading| text(reading).unwrap_or_else(|| "?".to_owned());
    match refused {
        Some(why) => eprintln!("{}: not written: {why}; it is {}", tag.name, shown(now)),
        None => say(&format!("{}: {} -> {}", tag.name, shown(old), shown(now))),
    }
}

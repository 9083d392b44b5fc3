//! `cipdeck write`: reads what is there, writes, and reads again.

use cipdeck_shared::engine::poll::{Quality, Reading, Reason};
use cipdeck_shared::tag::{Elementary, Type, Value};
use clap::Args;
use serde_json::json;

use super::controller;
use super::read::exit;
use super::{Place, Tag, tag};
use crate::cli::{Exit, say};
use crate::desk::{self, Desk, Lost};

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
        controller::with(way, async |desk| match write(desk, &place, &tag, &value).await {
            Ok(exit) | Err(exit) => exit,
        })
        .await
    }
}

async fn write(desk: &mut Desk, place: &Place, tag: &Tag, text: &str) -> Result<Exit, Exit> {
    let wrong = |error: &dyn std::fmt::Display| Exit::usage(&format!("{}: {error}", tag.name));
    let lost = |lost: Lost| {
        let sent = "if it had been sent, the device may have carried it out";
        Exit::unanswered(&format!("{}: {}; {sent}", tag.name, lost.reason))
    };
    let old = read(desk, tag).await;
    let message = match tag.name.bit() {
        None => {
            // Somebody who says the type may be wrong about it: that is the device's to refuse.
            let kind = known(tag, tag.kind.as_ref().or(old.kind.as_ref()), &old)?;
            let value = kind.parse_value(text).map_err(|error| wrong(&error))?;
            desk::whole(desk.dialect(), &tag.name, kind, old.kind.as_ref(), &value)
        }
        Some(bit) => {
            let number = read(desk, &Tag { name: tag.name.without_bit(), kind: None }).await;
            let on = Type::Elementary(Elementary::Bool).parse_value(text).map_err(|error| wrong(&error))?;
            let kind = known(tag, number.kind.as_ref(), &number)?;
            desk::one_bit(desk.dialect(), &tag.name, kind, bit, on == Value::Bool(true))
        }
    };
    desk.put(message.map_err(|error| wrong(&error))?).map_err(|error| wrong(&error))?;
    let ended = desk.lane.run(None).await;
    let refused = desk::refused(desk::reply(&ended).map_err(lost)?);
    let now = read(desk, tag).await;
    print(place, tag, [&old, &now], refused.as_deref());
    Ok(if refused.is_some() { Exit::REFUSED } else { exit(&[now]) })
}

async fn read(desk: &mut Desk, tag: &Tag) -> Reading {
    let reading = desk.read(&tag.name, tag.kind.as_ref()).await.unwrap_or_default();
    if !matches!(reading.reason, Some(Reason::OtherType(_))) {
        return reading;
    }
    // It is not what somebody says that it is: what is there is shown as the device has it.
    desk.read(&tag.name, None).await.unwrap_or_default()
}

/// The type, or why nobody knows it.
fn known<'a>(tag: &Tag, kind: Option<&'a Type>, reading: &Reading) -> Result<&'a Type, Exit> {
    kind.ok_or_else(|| {
        if reading.quality == Quality::Good {
            return Exit::usage(&format!("{}: {}", tag.name, unknown()));
        }
        eprintln!("{}: {}", tag.name, reading.reason.as_ref().map_or_else(unknown, Reason::text));
        exit(std::slice::from_ref(reading))
    })
}

fn unknown() -> String {
    "the device does not say what it is: give its type, as in TAG=DINT".to_owned()
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

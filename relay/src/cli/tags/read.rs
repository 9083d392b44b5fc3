//! `cipdeck read`.

use cipdeck_shared::engine::poll::{Item, Quality, Reading, Reason};
use cipdeck_shared::tag::Value;
use clap::Args;
use serde::Serialize;

use super::controller;
use super::{Place, Tag, tag};
use crate::cli::{Exit, report, say};

/// Tags that are read.
#[derive(Debug, Args)]
#[command(
    after_help = "A tag is a name, such as Motor.Speed, Table[3] or Status.5, or a name with its type: \
                        Table=DINT[10], Motor=\"STRUCT{speed: REAL; run: BOOL}\". Without a type: as the device says."
)]
pub(in crate::cli) struct Read {
    #[command(flatten)]
    place: Place,
    /// What to read
    #[arg(value_name = "TAG", required = true, value_parser = tag)]
    tags: Vec<Tag>,
}

impl Read {
    /// Reads and prints.
    pub(in crate::cli) async fn execute(self) -> Exit {
        let Self { place, tags } = self;
        let way = match place.way() {
            Ok(way) => way,
            Err(exit) => return exit,
        };
        controller::with(way, async |desk| {
            let readings = match desk.read_all(items(&tags)).await {
                Ok(readings) => readings,
                Err(lost) => return Exit::unanswered(&lost.reason),
            };
            let results: Vec<_> = tags.iter().zip(&readings).map(|(tag, it)| Result::of(tag, it)).collect();
            if place.json {
                let report = Report { path: &place.path, profile: desk.profile().word(), tags: &results };
                say(&report::json(&report));
            } else {
                results.iter().for_each(Result::print);
            }
            exit(&readings)
        })
        .await
    }
}

/// What is asked for, in the order of the tags.
pub(super) fn items(tags: &[Tag]) -> Vec<Item> {
    let item = |(id, tag): (u32, &Tag)| Item { id, name: tag.name.clone(), kind: tag.kind.clone() };
    (0..).zip(tags).map(item).collect()
}

/// That of the first tag that could not be read.
pub(super) fn exit(readings: &[Reading]) -> Exit {
    let bad = readings.iter().find(|reading| reading.quality != Quality::Good);
    match bad.map(|reading| &reading.reason) {
        None => Exit::SUCCESS,
        Some(Some(Reason::Lost(_)) | None) => Exit::LOST,
        Some(Some(_)) => Exit::REFUSED,
    }
}

/// For machines.
#[derive(Debug, Serialize)]
struct Report<'a> {
    path: &'a str,
    profile: &'static str,
    tags: &'a [Result],
}

/// One tag.
#[derive(Debug, Serialize)]
struct Result {
    tag: String,
    #[serde(rename = "type", skip_serializing_if = "Option::is_none")]
    kind: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    value: Option<serde_json::Value>,
    /// As a person would write it.
    #[serde(skip_serializing_if = "Option::is_none")]
    text: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    /// General status of a refusal.
    #[serde(skip_serializing_if = "Option::is_none")]
    status: Option<u8>,
    /// Additional status words of a refusal.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    extended: Vec<u16>,
}

impl Result {
    fn of(tag: &Tag, reading: &Reading) -> Self {
        let value = reading.value.as_ref().filter(|_| reading.quality == Quality::Good);
        let (status, extended) = match &reading.reason {
            Some(Reason::Refused { status, words }) => (Some(status.0), words.clone()),
            _ => (None, Vec::new()),
        };
        let reason = || reading.reason.as_ref().map_or_else(|| "it was not read".to_owned(), Reason::text);
        Self {
            tag: tag.name.to_string(),
            kind: reading.kind.as_ref().or(tag.kind.as_ref()).map(ToString::to_string),
            value: value.map(Value::to_json),
            text: value.map(ToString::to_string),
            error: value.is_none().then(reason),
            status,
            extended,
        }
    }

    fn print(&self) {
        match (&self.text, &self.error) {
            (Some(text), _) => {
                let kind = self.kind.as_deref().map_or_else(|| "type unknown".to_owned(), str::to_owned);
                say(&format!("{} = {text}  ({kind})", self.tag));
            }
            (None, error) => eprintln!("{}: {}", self.tag, error.as_deref().unwrap_or_default()),
        }
    }
}

//! `cipdeck tags`.

use cipdeck_shared::engine::browse::{Access, Browse, BrowseWhat, Symbol};
use cipdeck_shared::tag::Type;
use clap::Args;
use serde::Serialize;

use super::Place;
use super::controller;
use crate::cli::{Exit, report, say};
use crate::desk::{Desk, Lost};

/// The tags of a controller.
#[derive(Debug, Args)]
pub(in crate::cli) struct List {
    #[command(flatten)]
    place: Place,
    /// Only those whose name contains this, in capitals or not
    #[arg(value_name = "TEXT", default_value = "")]
    filter: String,
    /// Also what the system has declared
    #[arg(long)]
    system: bool,
    /// Ask what structures are made of
    #[arg(long)]
    structures: bool,
}

impl List {
    /// Lists and prints, while the list is still being made.
    pub(in crate::cli) async fn execute(self) -> Exit {
        let way = match self.place.way() {
            Ok(way) => way,
            Err(exit) => return exit,
        };
        controller::with(way, async |desk| self.list(desk).await).await
    }

    async fn list(&self, desk: &mut Desk) -> Exit {
        let dialect = desk.dialect();
        let what = if self.system { BrowseWhat::WithSystem } else { BrowseWhat::Tags };
        let mut browse = Browse::new(dialect, what);
        let filter = self.filter.to_lowercase();
        let (mut told, mut entries) = (0, Vec::new());
        while !browse.is_done() {
            step(desk, &mut browse).await;
            let new: Vec<_> = browse.found().iter().skip(told).cloned().collect();
            told += new.len();
            for symbol in new.iter().filter(|symbol| symbol.name.to_lowercase().contains(&filter)) {
                let kind = if self.structures { self.structure(desk, symbol).await } else { None };
                let entry = Entry::of(symbol, kind);
                if self.place.json { entries.push(entry) } else { entry.print() }
            }
        }
        if self.place.json {
            say(&report::json(&entries));
        }
        if let Some(caveat) = Browse::caveat(dialect) {
            eprintln!("{caveat}");
        }
        match browse.error() {
            None => Exit::SUCCESS,
            Some(error) => Exit::unanswered(&format!("the list is not complete: {error}")),
        }
    }

    /// What the structure of a tag is made of; none for other tags, and where the device does not tell.
    async fn structure(&self, desk: &mut Desk, symbol: &Symbol) -> Option<Type> {
        let mut browse = Browse::template(desk.dialect(), symbol.template?);
        while !browse.is_done() {
            step(desk, &mut browse).await;
        }
        if let Some(error) = browse.error() {
            eprintln!("{}: {error}", symbol.name);
        }
        browse.kind().cloned()
    }
}

async fn step(desk: &mut Desk, browse: &mut Browse) {
    let Some(request) = browse.next_request() else { return };
    let reply = desk.ask(&request).await;
    browse.handle_reply(reply.as_deref().map_err(Lost::failure));
}

/// A tag as it is printed.
#[derive(Debug, Serialize)]
struct Entry {
    tag: String,
    #[serde(rename = "type")]
    kind: String,
    /// What a structure is made of.
    #[serde(skip_serializing_if = "Option::is_none")]
    members: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    access: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    note: Option<&'static str>,
}

impl Entry {
    fn of(symbol: &Symbol, kind: Option<Type>) -> Self {
        let whole = kind.as_ref().and_then(|kind| symbol.with_structure(kind));
        Self {
            tag: symbol.name.clone(),
            kind: whole.map_or_else(|| symbol.type_text.clone(), |whole| whole.to_string()),
            members: kind.and_then(|kind| match kind {
                Type::Structure(structure) => Some(structure.to_string()),
                _ => None,
            }),
            access: match symbol.access {
                Some(Access::Read) => Some("read"),
                Some(Access::None) => Some("none"),
                Some(Access::Write) | None => None,
            },
            note: symbol.note,
        }
    }

    fn print(&self) {
        let more = [self.members.as_deref(), self.access.map(|_| "not writable"), self.note];
        let more: Vec<_> = more.into_iter().flatten().collect();
        let gap = if more.is_empty() { "" } else { "  " };
        say(&format!("{}  {}{gap}{}", self.tag, self.kind, more.join("; ")));
    }
}

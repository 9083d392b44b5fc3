//! `/api/v1/history`: every run of every block.

use std::time::SystemTime;

use axum::Json as Answer;
use axum::body::Body;
use axum::extract::{Query, State};
use axum::http::{Uri, header};
use axum::response::IntoResponse;
use cipdeck_shared::api::{HistoryPage, HistoryState, HistoryTrend};
use cipdeck_shared::config::BlockId;
use futures_util::stream;
use serde::Deserialize;

use crate::app::App;
use crate::error::ApiError;
use crate::history::{self, Asked, Chart, History, Place};
use crate::wall_clock;

/// Runs of a page unless told otherwise, and at most.
const PAGE: (u16, u16) = (100, 1_000);

/// Points of a trend unless told otherwise, and at most.
const POINTS: (u16, u16) = (500, 2_000);

/// µs that a trend shows unless told otherwise: an hour.
const SHOWN: u64 = 3_600_000_000;

/// Everything that may be asked; text, so that what is wrong can be named.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Parameters {
    block: Option<String>,
    from: Option<String>,
    to: Option<String>,
    result: Option<String>,
    limit: Option<String>,
    before: Option<String>,
    points: Option<String>,
    value: Option<String>,
}

/// Runs that have ended, the newest first.
#[utoipa::path(
    get,
    path = "/history",
    tag = "history",
    params(
        ("block" = Option<String>, Query, pattern = "^(b(0|[1-9][0-9]{0,9}))?$", description = "One block; otherwise all"),
        ("from" = Option<String>, Query, description = "RFC 3339: ended at this time or later"),
        ("to" = Option<String>, Query, description = "RFC 3339: ended at this time or earlier"),
        ("result" = Option<String>, Query, pattern = "^(ok|failed|all)?$", description = "ok, failed or all"),
        ("limit" = Option<u16>, Query, minimum = 1, maximum = 1000, description = "Runs of a page; 100 without"),
        ("before" = Option<String>, Query, description = "What an earlier answer gave as `next`"),
    ),
    responses((status = 200, description = "A page", body = HistoryPage))
)]
pub(super) async fn list(State(app): State<App>, uri: Uri) -> Result<Answer<HistoryPage>, ApiError> {
    let parameters = Parameters::of(&uri, &["block", "from", "to", "result", "limit", "before"])?;
    let limit = number("limit", parameters.limit.as_deref(), PAGE)?;
    let page = app.history.page(parameters.asked()?, limit.into(), parameters.before()?).await?;
    Ok(Answer(page))
}

/// The runs of one block, summed up in buckets of equal length.
#[utoipa::path(
    get,
    path = "/history/trend",
    tag = "history",
    params(
        ("block" = BlockId, Query, description = "The block"),
        ("from" = Option<String>, Query, description = "RFC 3339: ended at this time or later"),
        ("to" = Option<String>, Query, description = "RFC 3339: ended at this time or earlier"),
        ("points" = Option<u16>, Query, minimum = 1, maximum = 2000, description = "Buckets; 500 without"),
        ("value" = Option<String>, Query, description = "The name of a decoded value; otherwise the first one"),
    ),
    responses((status = 200, description = "The trend", body = HistoryTrend))
)]
pub(super) async fn trend(State(app): State<App>, uri: Uri) -> Result<Answer<HistoryTrend>, ApiError> {
    let parameters = Parameters::of(&uri, &["block", "from", "to", "points", "value"])?;
    let block = parameters.block()?.ok_or_else(|| bad("say which block: ?block=b7"))?;
    let points = number("points", parameters.points.as_deref(), POINTS)?;
    let to = time("to", parameters.to.as_deref())?;
    let to = to.unwrap_or_else(|| wall_clock::micros(SystemTime::now()));
    let from = time("from", parameters.from.as_deref())?.unwrap_or(to.saturating_sub(SHOWN));
    let between = ordered(from, to)?;
    let value = parameters.value.filter(|value| !value.is_empty());
    Ok(Answer(app.history.trend(Chart { block, between, points: points.into(), value }).await?))
}

/// How much history is kept, and what is missing.
#[utoipa::path(
    get,
    path = "/history/state",
    tag = "history",
    responses((status = 200, description = "The state", body = HistoryState))
)]
pub(super) async fn state(State(app): State<App>, uri: Uri) -> Result<Answer<HistoryState>, ApiError> {
    Parameters::of(&uri, &[])?;
    Ok(Answer(app.history.state().await?))
}

/// Runs that have ended, as a file for a spreadsheet.
#[utoipa::path(
    get,
    path = "/history.csv",
    tag = "history",
    params(
        ("block" = Option<String>, Query, pattern = "^(b(0|[1-9][0-9]{0,9}))?$", description = "One block; otherwise all"),
        ("from" = Option<String>, Query, description = "RFC 3339: ended at this time or later"),
        ("to" = Option<String>, Query, description = "RFC 3339: ended at this time or earlier"),
        ("result" = Option<String>, Query, pattern = "^(ok|failed|all)?$", description = "ok, failed or all"),
        ("value" = Option<String>, Query, description = "The name of a decoded value; otherwise the first one"),
    ),
    responses((status = 200, description = "A run per line", body = String, content_type = "text/csv"))
)]
pub(super) async fn csv(State(app): State<App>, uri: Uri) -> Result<impl IntoResponse, ApiError> {
    let parameters = Parameters::of(&uri, &["block", "from", "to", "result", "value"])?;
    let asked = parameters.asked()?;
    let name = asked.block.map_or_else(|| "history.csv".to_owned(), |block| format!("history-{block}.csv"));
    let headers = [
        (header::CONTENT_TYPE, "text/csv; charset=utf-8; header=present".to_owned()),
        (header::CONTENT_DISPOSITION, format!("attachment; filename=\"{name}\"")),
    ];
    let value = parameters.value.filter(|value| !value.is_empty());
    let file = CsvFile { history: app.history, asked, value, next: Next::Header };
    Ok((headers, Body::from_stream(stream::try_unfold(file, CsvFile::part))))
}

/// A file that is being sent. Nothing is read ahead of who takes it.
struct CsvFile {
    history: History,
    asked: Asked,
    value: Option<String>,
    next: Next,
}

enum Next {
    Header,
    Runs(Option<Place>),
    Nothing,
}

impl CsvFile {
    async fn part(mut self) -> Result<Option<(String, Self)>, ApiError> {
        let before = match self.next {
            Next::Header => {
                self.next = Next::Runs(None);
                return Ok(Some((history::CSV_HEADER.to_owned(), self)));
            }
            Next::Runs(before) => before,
            Next::Nothing => return Ok(None),
        };
        let page = self.history.page(self.asked.clone(), PAGE.1.into(), before).await?;
        let next = page.next.as_deref().and_then(|next| next.parse().ok());
        self.next = next.map_or(Next::Nothing, |next| Next::Runs(Some(next)));
        let mut text = String::new();
        for run in &page.runs {
            history::csv_line(run, self.value.as_deref(), &mut text);
        }
        Ok(Some((text, self)))
    }
}

impl Parameters {
    /// Those of an address; only the named ones mean something here.
    fn of(uri: &Uri, allowed: &[&str]) -> Result<Self, ApiError> {
        let Query(pairs) = Query::<Vec<(String, String)>>::try_from_uri(uri)
            .map_err(|error| bad(format!("what follows the question mark cannot be read: {error}")))?;
        if let Some((name, _)) = pairs.iter().find(|(name, _)| !allowed.contains(&name.as_str())) {
            let known = if allowed.is_empty() { "none".to_owned() } else { allowed.join(", ") };
            return Err(bad(format!("there is no parameter {name:?} here; there are: {known}")));
        }
        let Query(parameters) = Query::try_from_uri(uri)
            .map_err(|error| bad(format!("what follows the question mark cannot be read: {error}")))?;
        Ok(parameters)
    }

    fn asked(&self) -> Result<Asked, ApiError> {
        let from = time("from", self.from.as_deref())?.unwrap_or(0);
        let to = time("to", self.to.as_deref())?.unwrap_or(u64::MAX);
        let q = match self.result.as_deref() {
            None | Some("" | "all") => None,
            Some("ok") => Some(true),
            Some("failed") => Some(false),
            Some(other) => return Err(bad(format!("result is ok, failed or all, not {other:?}"))),
        };
        Ok(Asked { block: self.block()?, between: ordered(from, to)?, q })
    }

    fn block(&self) -> Result<Option<BlockId>, ApiError> {
        let block = self.block.as_deref().filter(|block| !block.is_empty());
        let unreadable = |text: &str| bad(format!("a block is named like b7, not {text:?}"));
        block.map(|text| text.parse().map_err(|_| unreadable(text))).transpose()
    }

    fn before(&self) -> Result<Option<Place>, ApiError> {
        let before = self.before.as_deref().filter(|before| !before.is_empty());
        let unreadable = |()| bad("before is what an earlier answer gave as next");
        before.map(|text| text.parse().map_err(unreadable)).transpose()
    }
}

/// A number with a usual value and a biggest one.
fn number(name: &str, text: Option<&str>, (usual, most): (u16, u16)) -> Result<u16, ApiError> {
    let Some(text) = text.filter(|text| !text.is_empty()) else { return Ok(usual) };
    let number = text.parse().ok().filter(|number| (1..=most).contains(number));
    number.ok_or_else(|| bad(format!("{name} is a number from 1 to {most}, not {text:?}")))
}

/// µs since 1970.
fn time(name: &str, text: Option<&str>) -> Result<Option<u64>, ApiError> {
    let Some(text) = text.filter(|text| !text.is_empty()) else { return Ok(None) };
    let unreadable = || bad(format!("{name} is a time like 2026-11-22T10:00:00Z, not {text:?}"));
    wall_clock::parse(text).map(Some).ok_or_else(unreadable)
}

fn ordered(from: u64, to: u64) -> Result<(u64, u64), ApiError> {
    if from < to { Ok((from, to)) } else { Err(bad("from has to be earlier than to")) }
}

fn bad(words: impl Into<String>) -> ApiError {
    ApiError::Unreadable(words.into())
}

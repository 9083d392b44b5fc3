//! How much is kept, and for how long. The oldest go first, and it is written down that they went.

use cipdeck_shared::api::HistoryLoss;
use rusqlite::{Connection, Transaction};

use super::buffer::Span;
use super::dropped::Dropped;
use super::schema::{from_sql, to_sql};
use super::writer::forget_requests;
use crate::settings::HistorySettings;

/// Chunks that are looked at together.
const STEP: i64 = 256;

/// Steps after which others may write again: what is left goes the next time.
const MAX_STEPS: usize = 32;

/// Pages that are given back at a time.
const MAX_PAGES: u64 = 4_096;

/// What may be kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Limits {
    pub(super) max_bytes: u64,
    pub(super) max_age_us: u64,
}

/// A chunk that may go.
#[derive(Clone, Copy, Debug)]
struct Oldest {
    id: i64,
    batch: u64,
    span: Span,
}

impl Limits {
    pub(super) fn of(settings: &HistorySettings) -> Self {
        Self {
            max_bytes: u64::from(settings.max_mb) * 1024 * 1024,
            max_age_us: u64::from(settings.max_days) * 86_400_000_000,
        }
    }

    /// Deletes what is too old, then what is too much.
    pub(super) fn enforce(&self, connection: &mut Connection, now_us: u64) -> rusqlite::Result<()> {
        let since = now_us.saturating_sub(self.max_age_us);
        let old = |_: &Connection, chunk: &Oldest| Ok(chunk.span.last_us < since);
        delete(connection, now_us, HistoryLoss::Age, old)?;
        if file(connection)? <= self.max_bytes {
            return Ok(());
        }
        if used(connection)? > self.max_bytes {
            // A little more than needed, so that it is not needed again at once.
            let enough = self.max_bytes - self.max_bytes / 64;
            let too_much = |connection: &Connection, _: &Oldest| Ok(used(connection)? > enough);
            delete(connection, now_us, HistoryLoss::Size, too_much)?;
        }
        // The next runs need some of the space; what is over the limit is given back.
        let free = file(connection)?.saturating_sub(self.max_bytes) / pragma(connection, "page_size")?.max(1);
        if free > 0 {
            let mut pages =
                connection.prepare(&format!("PRAGMA incremental_vacuum({})", free.min(MAX_PAGES)))?;
            // A row for each page.
            let mut rows = pages.query(())?;
            while rows.next()?.is_some() {}
        }
        Ok(())
    }
}

/// Deletes the oldest chunks as long as they shall go.
fn delete(
    connection: &mut Connection,
    now_us: u64,
    why: HistoryLoss,
    goes: impl Fn(&Connection, &Oldest) -> rusqlite::Result<bool>,
) -> rusqlite::Result<()> {
    for _ in 0..MAX_STEPS {
        // Mostly nothing has to go, and one row says so.
        let Some(first) = oldest(connection, 1)?.pop() else { return Ok(()) };
        if !goes(connection, &first)? {
            return Ok(());
        }
        let oldest = oldest(connection, STEP)?;
        let transaction = connection.transaction()?;
        let mut gone: Option<Span> = None;
        for chunk in &oldest {
            if !goes(&transaction, chunk)? {
                break;
            }
            transaction.prepare_cached("DELETE FROM chunk WHERE id = ?1")?.execute([chunk.id])?;
            gone = Some(gone.map_or(chunk.span, |gone| gone.and(chunk.span)));
        }
        if let Some(span) = gone {
            write_down(&transaction, now_us, why, span)?;
        }
        forget_requests(&transaction, first.batch)?;
        transaction.commit()?;
    }
    Ok(())
}

fn write_down(
    transaction: &Transaction<'_>,
    now_us: u64,
    why: HistoryLoss,
    span: Span,
) -> rusqlite::Result<()> {
    transaction.prepare_cached("UPDATE total SET runs = max(0, runs - ?1)")?.execute([to_sql(span.runs)])?;
    Dropped::new(now_us, why, span).write(transaction)
}

fn oldest(connection: &Connection, most: i64) -> rusqlite::Result<Vec<Oldest>> {
    let mut statement = connection
        .prepare_cached("SELECT id, batch, runs, first_us, last_us FROM chunk ORDER BY id LIMIT ?1")?;
    let rows = statement.query_map([most], |row| {
        let number = |at| row.get(at).map(from_sql);
        let span = Span { runs: number(2)?, first_us: number(3)?, last_us: number(4)? };
        Ok(Oldest { id: row.get(0)?, batch: number(1)?, span })
    })?;
    rows.collect()
}

/// Bytes of the file.
pub(super) fn file(connection: &Connection) -> rusqlite::Result<u64> {
    Ok(pragma(connection, "page_count")? * pragma(connection, "page_size")?)
}

/// Bytes of the file that hold something.
pub(super) fn used(connection: &Connection) -> rusqlite::Result<u64> {
    let pages = pragma(connection, "page_count")?.saturating_sub(pragma(connection, "freelist_count")?);
    Ok(pages * pragma(connection, "page_size")?)
}

fn pragma(connection: &Connection, name: &str) -> rusqlite::Result<u64> {
    connection.prepare_cached(&format!("PRAGMA {name}"))?.query_row((), |row| row.get(0)).map(from_sql)
}

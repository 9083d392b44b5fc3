//! What is missing, and why. Nothing goes without being written down.

use cipdeck_shared::api::{HistoryDropped, HistoryLoss};
use rusqlite::{Connection, OptionalExtension, Transaction};

use super::buffer::Span;
use super::schema::{from_sql, to_sql};
use crate::wall_clock;

/// Losses for the same reason within this time are one row, µs.
const TOGETHER: u64 = 3_600_000_000;

/// Rows that are kept.
const MAX_ROWS: i64 = 1_000;

/// Rows that one answer has.
const MAX_SHOWN: usize = 20;

/// Runs that are missing for one reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Dropped {
    pub(super) at_us: u64,
    pub(super) why: HistoryLoss,
    /// `None`: nobody knows how many.
    pub(super) runs: Option<u64>,
    pub(super) first_us: u64,
    pub(super) last_us: u64,
    pub(super) detail: Option<String>,
}

impl Dropped {
    pub(super) const fn new(at_us: u64, why: HistoryLoss, span: Span) -> Self {
        Self {
            at_us,
            why,
            runs: Some(span.runs),
            first_us: span.first_us,
            last_us: span.last_us,
            detail: None,
        }
    }

    /// The same loss goes on.
    fn and(self, other: Self) -> Self {
        Self {
            at_us: other.at_us,
            why: self.why,
            runs: self.runs.zip(other.runs).map(|(one, more)| one + more),
            first_us: self.first_us.min(other.first_us),
            last_us: self.last_us.max(other.last_us),
            detail: other.detail.or(self.detail),
        }
    }

    /// Adds a loss to what has not been written yet: one for each reason.
    pub(super) fn add_to(self, pending: &mut Vec<Self>) {
        match pending.iter().position(|one| one.why == self.why) {
            Some(at) => {
                let one = pending.swap_remove(at);
                pending.push(one.and(self));
            }
            None => pending.push(self),
        }
    }

    /// Writes it down, together with what was lost for the same reason a short time ago.
    pub(super) fn write(&self, transaction: &Transaction<'_>) -> rusqlite::Result<()> {
        let since = to_sql(self.at_us.saturating_sub(TOGETHER));
        let last = transaction
            .prepare_cached("SELECT id, at_us, why, runs, first_us, last_us, detail FROM dropped WHERE why = ?1 AND at_us > ?2 ORDER BY id DESC LIMIT 1")?
            .query_row((self.why.word(), since), |row| Ok((row.get::<_, i64>(0)?, read(row)?)))
            .optional()?;
        // Another file that was set aside is another row: each has its own name.
        let last = last.filter(|_| self.why != HistoryLoss::Corrupt);
        let (id, all) = match last {
            Some((id, Some(last))) => (Some(id), last.and(self.clone())),
            _ => (None, self.clone()),
        };
        transaction
            .prepare_cached("INSERT OR REPLACE INTO dropped (id, at_us, why, runs, first_us, last_us, detail) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)")?
            .execute((
                id,
                to_sql(all.at_us),
                all.why.word(),
                all.runs.map(to_sql),
                to_sql(all.first_us),
                to_sql(all.last_us),
                &all.detail,
            ))?;
        transaction
            .prepare_cached("DELETE FROM dropped WHERE id <= (SELECT max(id) FROM dropped) - ?1")?
            .execute([MAX_ROWS])?;
        Ok(())
    }

    /// In JSON.
    pub(super) fn view(&self) -> HistoryDropped {
        HistoryDropped {
            at: wall_clock::of_micros(self.at_us),
            why: self.why,
            runs: self.runs,
            from: wall_clock::of_micros(self.first_us),
            to: wall_clock::of_micros(self.last_us),
            detail: self.detail.clone(),
        }
    }
}

/// What is missing between two times, also what is not written down yet; the newest first.
pub(super) fn between(
    connection: &Connection,
    pending: &[Dropped],
    (from_us, to_us): (u64, u64),
) -> rusqlite::Result<Vec<HistoryDropped>> {
    let mut statement = connection.prepare(
        "SELECT id, at_us, why, runs, first_us, last_us, detail FROM dropped \
         WHERE last_us >= ?1 AND first_us <= ?2 ORDER BY id DESC LIMIT ?3",
    )?;
    let rows = statement.query_map((to_sql(from_us), to_sql(to_us), to_sql(MAX_SHOWN as u64)), read)?;
    let written = rows.collect::<Result<Vec<_>, _>>()?;
    let meets = |one: &&Dropped| one.last_us >= from_us && one.first_us <= to_us;
    let all = pending.iter().filter(meets).cloned().chain(written.into_iter().flatten());
    Ok(all.take(MAX_SHOWN).map(|one| one.view()).collect())
}

/// `None` for a reason that only a newer version knows.
fn read(row: &rusqlite::Row<'_>) -> rusqlite::Result<Option<Dropped>> {
    let word: String = row.get(2)?;
    let why = HistoryLoss::ALL.into_iter().find(|why| why.word() == word);
    let (at_us, runs) = (from_sql(row.get(1)?), row.get::<_, Option<i64>>(3)?.map(from_sql));
    let (first_us, last_us, detail) = (from_sql(row.get(4)?), from_sql(row.get(5)?), row.get(6)?);
    Ok(why.map(|why| Dropped { at_us, why, runs, first_us, last_us, detail }))
}

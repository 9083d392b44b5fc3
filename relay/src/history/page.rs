//! Runs, the newest first, a page at a time.

use std::cmp::Reverse;
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use cipdeck_shared::api::{HistoryPage, HistoryRun};
use cipdeck_shared::config::{BlockId, write_hex};
use rusqlite::Connection;

use super::chunk::Runs;
use super::dropped::{self, Dropped};
use super::run::Run;
use super::schema::{from_sql, to_sql};
use super::values::Values;
use crate::wall_clock;

/// Which runs are asked for.
#[derive(Clone, Debug)]
pub(crate) struct Asked {
    /// All blocks if `None`.
    pub(crate) block: Option<BlockId>,
    /// µs since 1970, both inclusive.
    pub(crate) between: (u64, u64),
    /// Only those with this Q.
    pub(crate) q: Option<bool>,
}

/// A place in the history: runs are before it or behind it.
///
/// Batches go up with time; inside of one, the time orders the runs of different blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Place {
    batch: u64,
    at_us: u64,
    chunk: u64,
    index: u64,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { batch, at_us, chunk, index } = self;
        write!(f, "{batch}.{at_us}.{chunk}.{index}")
    }
}

impl FromStr for Place {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        let numbers: Vec<u64> = text.split('.').map(str::parse).collect::<Result<_, _>>().map_err(|_| ())?;
        let [batch, at_us, chunk, index] = *numbers.as_slice() else { return Err(()) };
        Ok(Self { batch, at_us, chunk, index })
    }
}

/// A chunk as it lies in the file.
pub(super) struct Stored {
    pub(super) id: u64,
    pub(super) batch: u64,
    pub(super) block: BlockId,
    pub(super) request: Arc<[u8]>,
    pub(super) data: Vec<u8>,
}

impl Stored {
    pub(super) fn runs(&self) -> Runs<'_> {
        Runs::of(self.block, Arc::clone(&self.request), &self.data)
    }
}

impl Asked {
    /// Calls `look` with each chunk that may hold such runs, the newest first, until it has seen enough.
    pub(super) fn chunks(
        &self,
        connection: &Connection,
        batches_up_to: u64,
        mut look: impl FnMut(Stored) -> bool,
    ) -> rusqlite::Result<()> {
        let block = self.block.map_or("", |_| "block = ?1 AND ");
        let result = match self.q {
            None => "",
            Some(true) => "AND failed < runs",
            Some(false) => "AND failed > 0",
        };
        let mut statement = connection.prepare(&format!(
            "SELECT chunk.id, batch, block, ifnull(bytes, x''), data FROM chunk LEFT JOIN request ON request.id = request \
             WHERE {block} batch <= ?2 AND last_us >= ?3 AND first_us <= ?4 {result} ORDER BY batch DESC, chunk.id DESC"
        ))?;
        let (from, to) = self.between;
        let id = self.block.map(|block| block.0);
        let mut rows = statement.query((id, to_sql(batches_up_to), to_sql(from), to_sql(to)))?;
        while let Some(row) = rows.next()? {
            let stored = Stored {
                id: from_sql(row.get(0)?),
                batch: from_sql(row.get(1)?),
                block: BlockId(row.get(2)?),
                request: row.get_ref(3)?.as_blob()?.into(),
                data: row.get(4)?,
            };
            if !look(stored) {
                break;
            }
        }
        Ok(())
    }

    /// Whether a run of a chunk is one of those.
    pub(super) fn wants(&self, run: &Run) -> bool {
        let (from, to) = self.between;
        (from..=to).contains(&run.at_us) && self.q.is_none_or(|q| q == run.q)
    }
}

/// At most `limit` runs before a place, and where to go on.
pub(super) fn page(
    connection: &Connection,
    pending: &[Dropped],
    asked: &Asked,
    (limit, before): (usize, Option<Place>),
) -> rusqlite::Result<HistoryPage> {
    let mut found: Vec<(Place, Run)> = Vec::new();
    let mut batch: Vec<(Place, Run)> = Vec::new();
    asked.chunks(connection, before.map_or(u64::MAX, |before| before.batch), |stored| {
        if batch.first().is_some_and(|(place, _)| place.batch != stored.batch) {
            finish(&mut batch, &mut found);
            if found.len() > limit {
                return false;
            }
        }
        let place = |(index, run): (u64, Run)| {
            let place = Place { batch: stored.batch, at_us: run.at_us, chunk: stored.id, index };
            (place, run)
        };
        let all = (0..).zip(stored.runs()).filter(|(_, run)| asked.wants(run)).map(place);
        batch.extend(all.filter(|(place, _)| before.is_none_or(|before| *place < before)));
        true
    })?;
    finish(&mut batch, &mut found);
    let more = found.len() > limit;
    found.truncate(limit);
    let next = found.last().filter(|_| more).map(|(place, _)| place.to_string());
    let mut values = Values::default();
    let runs = found.iter().map(|(place, run)| view(*place, run, &mut values)).collect();
    Ok(HistoryPage { runs, next, dropped: dropped::between(connection, pending, asked.between)? })
}

/// The runs of one batch are in the order of their blocks: by time, then.
fn finish(batch: &mut Vec<(Place, Run)>, found: &mut Vec<(Place, Run)>) {
    batch.sort_unstable_by_key(|(place, _)| Reverse(*place));
    found.append(batch);
}

fn view(place: Place, run: &Run, values: &mut Values) -> HistoryRun {
    HistoryRun {
        id: place.to_string(),
        block: run.block,
        at: wall_clock::of_micros(run.at_us),
        q: run.q,
        error_id: run.error_id,
        sub_error_id: run.sub_error_id,
        ext_error_id: run.ext_error_id,
        cause: run.cause.as_ref().map(|cause| cause.kind.word().to_owned()),
        may_have_acted: run.cause.as_ref().is_some_and(|cause| cause.may_have_acted),
        has_acted: run.cause.as_ref().is_some_and(|cause| cause.has_acted),
        reply_us: run.reply_us,
        elapsed_us: run.elapsed_us,
        request: write_hex(&run.request),
        response: run.response.as_deref().map(write_hex),
        values: values.of(run).to_vec(),
    }
}

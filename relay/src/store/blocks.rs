//! Blocks: JSON text and a revision.

use cipdeck_shared::config::{Block, BlockConfig, BlockId};
use rusqlite::{Connection, OptionalExtension};

use super::beside::Beside;
use super::{Store, StoreError};
use crate::project::Touched;

/// A block as it lies in the database.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stored {
    /// The block.
    pub(crate) block: Block,
    /// The last state of IN.
    pub(crate) input: bool,
}

/// How a change ended.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Change {
    /// Written: the block as it is now, or as it was before it was deleted.
    Done(Block),
    /// Somebody else was faster: the block as it is now.
    Stale(Block),
    /// There is no such block.
    Unknown,
}

impl Store {
    /// All blocks, by id.
    pub(crate) async fn load(&self) -> Result<Vec<Stored>, StoreError> {
        self.0.call(|connection| load(connection)).await
    }

    /// Stores a new block under a fresh id.
    pub(crate) async fn insert(&self, config: BlockConfig) -> Result<Block, StoreError> {
        let beside = self.1.clone();
        self.0.call(move |connection| insert(connection, &beside, config)).await
    }

    /// Replaces revision `revision` of a block.
    pub(crate) async fn replace(
        &self,
        id: BlockId,
        revision: u64,
        config: BlockConfig,
    ) -> Result<Change, StoreError> {
        let beside = self.1.clone();
        self.0.call(move |connection| replace(connection, &beside, id, revision, config)).await
    }

    /// Deletes revision `revision` of a block.
    pub(crate) async fn delete(&self, id: BlockId, revision: u64) -> Result<Change, StoreError> {
        let beside = self.1.clone();
        self.0.call(move |connection| delete(connection, &beside, id, revision)).await
    }

    /// Remembers IN for a block that resumes.
    pub(crate) async fn set_input(&self, id: BlockId, input: bool) -> Result<(), StoreError> {
        self.0
            .call(move |connection| {
                connection.execute("UPDATE block SET input = ?2 WHERE id = ?1", (id.0, input))?;
                Ok(())
            })
            .await
    }
}

/// SQLite counts with a sign. A revision counts up from 1 and never gets near the end.
struct Revision(i64);

impl From<u64> for Revision {
    fn from(revision: u64) -> Self {
        Self(i64::try_from(revision).unwrap_or(i64::MAX))
    }
}

impl From<Revision> for u64 {
    fn from(revision: Revision) -> Self {
        Self::try_from(revision.0).unwrap_or(0)
    }
}

fn load(connection: &Connection) -> Result<Vec<Stored>, StoreError> {
    let mut statement = connection.prepare("SELECT id, revision, config, input FROM block ORDER BY id")?;
    let rows = statement.query_map((), |row| {
        Ok((
            row.get::<_, u32>(0)?,
            row.get(1).map(Revision)?,
            row.get::<_, String>(2)?,
            row.get::<_, bool>(3)?,
        ))
    })?;
    let mut all = Vec::new();
    for row in rows {
        let (id, revision, config, input) = row?;
        let block =
            Block { id: BlockId(id), revision: revision.into(), config: serde_json::from_str(&config)? };
        all.push(Stored { block, input });
    }
    Ok(all)
}

fn insert(connection: &Connection, beside: &Beside, config: BlockConfig) -> Result<Block, StoreError> {
    let text = serde_json::to_string(&config)?;
    let transaction = connection.unchecked_transaction()?;
    transaction.execute("INSERT INTO block (revision, config) VALUES (1, ?1)", [text])?;
    let id = u32::try_from(transaction.last_insert_rowid()).map_err(|_| StoreError::NoIds)?;
    let id = BlockId(id);
    beside.commit(transaction, &[Touched::Block(id)])?;
    Ok(Block { id, revision: 1, config })
}

fn replace(
    connection: &mut Connection,
    beside: &Beside,
    id: BlockId,
    revision: u64,
    config: BlockConfig,
) -> Result<Change, StoreError> {
    let text = serde_json::to_string(&config)?;
    let transaction = connection.transaction()?;
    let change = change(&transaction, id, revision)?;
    let Change::Done(mut block) = change else { return Ok(change) };
    block.revision += 1;
    block.config = config;
    transaction.execute(
        "UPDATE block SET revision = ?2, config = ?3 WHERE id = ?1",
        (id.0, Revision::from(block.revision).0, text),
    )?;
    beside.commit(transaction, &[Touched::Block(id)])?;
    Ok(Change::Done(block))
}

fn delete(
    connection: &mut Connection,
    beside: &Beside,
    id: BlockId,
    revision: u64,
) -> Result<Change, StoreError> {
    let transaction = connection.transaction()?;
    let change = change(&transaction, id, revision)?;
    if matches!(change, Change::Done(_)) {
        transaction.execute("DELETE FROM block WHERE id = ?1", [id.0])?;
        beside.commit(transaction, &[Touched::Block(id)])?;
    }
    Ok(change)
}

/// The block, if it has the revision that somebody wants to change.
fn change(connection: &Connection, id: BlockId, revision: u64) -> Result<Change, StoreError> {
    let row = connection
        .query_row("SELECT revision, config FROM block WHERE id = ?1", [id.0], |row| {
            Ok((row.get(0).map(Revision)?, row.get::<_, String>(1)?))
        })
        .optional()?;
    let Some((found, config)) = row else { return Ok(Change::Unknown) };
    let found = u64::from(found);
    let block = Block { id, revision: found, config: serde_json::from_str(&config)? };
    Ok(if found == revision { Change::Done(block) } else { Change::Stale(block) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use cipdeck_shared::config::MsgCipGeneric;

    fn config(name: &str) -> BlockConfig {
        MsgCipGeneric { name: name.to_owned(), ..MsgCipGeneric::product_name("0,0") }.into()
    }

    #[tokio::test]
    async fn only_the_revision_that_was_seen_is_changed() {
        let store = Store::open(None).await.unwrap();
        let block = store.insert(config("a")).await.unwrap();
        assert_eq!((block.id, block.revision), (BlockId(1), 1));
        let Change::Done(second) = store.replace(block.id, 1, config("b")).await.unwrap() else { panic!() };
        assert_eq!((second.revision, second.config.name()), (2, "b"));
        assert_eq!(store.replace(block.id, 1, config("c")).await.unwrap(), Change::Stale(second.clone()));
        assert_eq!(store.delete(block.id, 1).await.unwrap(), Change::Stale(second.clone()));
        assert_eq!(store.delete(BlockId(9), 1).await.unwrap(), Change::Unknown);
        assert_eq!(store.load().await.unwrap(), [Stored { block: second.clone(), input: false }]);
        assert_eq!(store.delete(block.id, 2).await.unwrap(), Change::Done(second));
        assert_eq!(store.load().await.unwrap(), []);
    }

    #[tokio::test]
    async fn an_id_is_never_used_again_even_after_a_restart() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/cipdeck.sqlite");
        let store = Store::open(Some(&path)).await.unwrap();
        let block = store.insert(config("a")).await.unwrap();
        store.delete(block.id, 1).await.unwrap();
        store.close().await;
        let store = Store::open(Some(&path)).await.unwrap();
        let next = store.insert(config("b")).await.unwrap();
        assert_eq!(next.id, BlockId(2));
        store.set_input(next.id, true).await.unwrap();
        store.close().await;
        let store = Store::open(Some(&path)).await.unwrap();
        assert_eq!(store.load().await.unwrap(), [Stored { block: next, input: true }]);
    }

    #[tokio::test]
    async fn a_second_relay_on_the_same_data_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cipdeck.sqlite");
        let first = Store::open(Some(&path)).await.unwrap();
        first.insert(config("a")).await.unwrap();
        assert!(matches!(Store::open(Some(&path)).await, Err(StoreError::InUse)));
    }
}

//! The lists of what may be reached and written.

use cipdeck_shared::api::{NewAllowedTarget, NewAllowedWrite};
use rusqlite::Connection;

use super::{Store, StoreError};

/// Both lists, with their ids.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct StoredLists {
    /// Targets.
    pub(crate) targets: Vec<(u64, NewAllowedTarget)>,
    /// Writes.
    pub(crate) writes: Vec<(u64, NewAllowedWrite)>,
}

impl Store {
    /// Both lists.
    pub(crate) async fn load_lists(&self) -> Result<StoredLists, StoreError> {
        self.0.call(|connection| load(connection)).await
    }

    /// Another target; its id.
    pub(crate) async fn add_allowed_target(&self, new: NewAllowedTarget) -> Result<u64, StoreError> {
        self.0
            .call(move |connection| {
                let insert = "INSERT INTO allowed_target (target, note) VALUES (?1, ?2)";
                connection.execute(insert, (new.target, new.note))?;
                id(connection)
            })
            .await
    }

    /// Another write; its id.
    pub(crate) async fn add_allowed_write(&self, new: NewAllowedWrite) -> Result<u64, StoreError> {
        self.0
            .call(move |connection| {
                let rule = serde_json::to_string(&new)?;
                connection.execute("INSERT INTO allowed_write (rule) VALUES (?1)", [rule])?;
                id(connection)
            })
            .await
    }

    /// One target less.
    pub(crate) async fn remove_allowed_target(&self, id: u64) -> Result<(), StoreError> {
        self.remove("DELETE FROM allowed_target WHERE id = ?1", id).await
    }

    /// One write less.
    pub(crate) async fn remove_allowed_write(&self, id: u64) -> Result<(), StoreError> {
        self.remove("DELETE FROM allowed_write WHERE id = ?1", id).await
    }

    async fn remove(&self, statement: &'static str, id: u64) -> Result<(), StoreError> {
        let id = i64::try_from(id).unwrap_or(i64::MAX);
        self.0
            .call(move |connection| {
                connection.execute(statement, [id])?;
                Ok(())
            })
            .await
    }
}

fn id(connection: &Connection) -> Result<u64, StoreError> {
    u64::try_from(connection.last_insert_rowid()).map_err(|_| StoreError::NoIds)
}

fn load(connection: &Connection) -> Result<StoredLists, StoreError> {
    let mut lists = StoredLists::default();
    let mut targets = connection.prepare("SELECT id, target, note FROM allowed_target ORDER BY id")?;
    let rows = targets.query_map((), |row| {
        Ok((row.get::<_, i64>(0)?, NewAllowedTarget { target: row.get(1)?, note: row.get(2)? }))
    })?;
    for row in rows {
        let (id, target) = row?;
        lists.targets.push((id.unsigned_abs(), target));
    }
    let mut writes = connection.prepare("SELECT id, rule FROM allowed_write ORDER BY id")?;
    let rows = writes.query_map((), |row| Ok((row.get::<_, i64>(0)?, row.get::<_, String>(1)?)))?;
    for row in rows {
        let (id, rule) = row?;
        lists.writes.push((id.unsigned_abs(), serde_json::from_str(&rule)?));
    }
    Ok(lists)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn what_was_allowed_is_allowed_after_a_restart_and_what_was_removed_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cipdeck.sqlite");
        let target = |text: &str| NewAllowedTarget { target: text.to_owned(), note: "why".to_owned() };
        let write = NewAllowedWrite {
            target: "10.0.0.1".to_owned(),
            service: 16,
            class: 4,
            instance: None,
            attribute: Some(3),
            note: String::new(),
        };
        let store = Store::open(Some(&path)).await.unwrap();
        let first = store.add_allowed_target(target("10.0.0.1")).await.unwrap();
        let second = store.add_allowed_target(target("10.0.0.2")).await.unwrap();
        let listed = store.add_allowed_write(write.clone()).await.unwrap();
        store.remove_allowed_target(first).await.unwrap();
        store.close().await;
        let lists = Store::open(Some(&path)).await.unwrap().load_lists().await.unwrap();
        assert_eq!(lists.targets, [(second, target("10.0.0.2"))]);
        assert_eq!(lists.writes, [(listed, write)]);
    }
}

//! Migrations: SQL files that are appended to and never changed.

use std::time::Duration;

use rusqlite::Connection;

use super::StoreError;

/// One entry per version; `user_version` counts them.
const MIGRATIONS: &[&str] = &[
    include_str!("migrations/0001_blocks.sql"),
    include_str!("migrations/0002_allow.sql"),
    include_str!("migrations/0003_access.sql"),
];

/// How long a relay that is just ending may still hold the file.
const PATIENCE: Duration = Duration::from_secs(1);

/// Settings of the connection, then everything that the file lacks.
pub(super) fn prepare(connection: &mut Connection) -> Result<(), StoreError> {
    // One relay at a time: a second one is refused instead of running the same blocks again.
    connection.busy_timeout(PATIENCE)?;
    connection.pragma_update(None, "locking_mode", "EXCLUSIVE")?;
    connection.pragma_update(None, "journal_mode", "WAL")?;
    connection.pragma_update(None, "synchronous", "FULL")?;
    connection.pragma_update(None, "foreign_keys", true)?;
    migrate(connection, MIGRATIONS)
}

/// Brings a database up to date, a version at a time.
pub(crate) fn migrate(connection: &mut Connection, migrations: &[&str]) -> Result<(), StoreError> {
    let version = connection.pragma_query_value(None, "user_version", |row| row.get::<_, u32>(0))?;
    let found = usize::try_from(version).unwrap_or(usize::MAX);
    let missing = migrations.get(found..).ok_or(StoreError::TooNew { found, known: migrations.len() })?;
    for (version, migration) in (version + 1..).zip(missing) {
        let transaction = connection.transaction()?;
        transaction.execute_batch(migration)?;
        transaction.pragma_update(None, "user_version", version)?;
        transaction.commit()?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_newer_database_is_refused_and_a_current_one_left_alone() {
        let mut connection = Connection::open_in_memory().unwrap();
        prepare(&mut connection).unwrap();
        prepare(&mut connection).unwrap();
        connection.pragma_update(None, "user_version", 99).unwrap();
        let refused = migrate(&mut connection, MIGRATIONS);
        assert!(matches!(refused, Err(StoreError::TooNew { found: 99, .. })), "{refused:?}");
    }

    #[test]
    fn a_migration_that_fails_changes_nothing() {
        let mut connection = Connection::open_in_memory().unwrap();
        migrate(&mut connection, &["CREATE TABLE a (x); CREATE TABLE a (x)"]).unwrap_err();
        migrate(&mut connection, &["CREATE TABLE a (x)"]).unwrap();
    }
}

//! Migrations: SQL files that are appended to and never changed.

use std::time::Duration;

use rusqlite::Connection;

use super::StoreError;

/// One entry per version; `user_version` counts them.
const MIGRATIONS: &[&str] = &[
    include_str!("migrations/0001_blocks.sql"),
    include_str!("migrations/0002_allow.sql"),
    include_str!("migrations/0003_access.sql"),
    include_str!("migrations/0004_plant.sql"),
    include_str!("migrations/0005_project.sql"),
    include_str!("migrations/0006_project_change.sql"),
];

/// How long a backup may keep the database from what only one can do.
const PATIENCE: Duration = Duration::from_secs(1);

/// Settings of the connection, then everything that the file lacks.
pub(super) fn prepare(connection: &mut Connection) -> Result<(), StoreError> {
    connection.busy_timeout(PATIENCE)?;
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

    #[tokio::test]
    async fn what_any_earlier_version_has_stored_is_brought_up_to_date() {
        for version in 1..MIGRATIONS.len() {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("cipdeck.sqlite");
            let mut old = Connection::open(&path).unwrap();
            migrate(&mut old, &MIGRATIONS[..version]).unwrap();
            old.execute_batch(BLOCK_OF_VERSION_1).unwrap();
            old.close().unwrap();
            let store = crate::store::Store::open(Some(&path)).await.unwrap();
            let blocks = store.load().await.unwrap();
            assert_eq!(blocks.len(), 1, "from version {version}");
            assert_eq!((blocks[0].block.id.0, blocks[0].block.revision, blocks[0].input), (7, 3, true));
            assert_eq!(blocks[0].block.config.name(), "drive-current");
            assert!(store.users().await.unwrap().is_empty());
            store.close().await;
            let new = Connection::open(&path).unwrap();
            let known: u32 = new.pragma_query_value(None, "user_version", |row| row.get(0)).unwrap();
            assert_eq!(usize::try_from(known).unwrap(), MIGRATIONS.len());
        }
    }

    /// As the first version has written it.
    const BLOCK_OF_VERSION_1: &str = r#"INSERT INTO block (id, revision, config, input) VALUES (7, 3, '{"name":"drive-current","kind":"MSG_CIPGENERIC","Channel":"controller","Resume":true,"CtrlCfg":{"Cancel":false,"TriggerType":100,"StrMode":0},"AppCfg":{"Service":14,"Class":1,"Instance":1,"Attribute":7,"MemberCnt":0,"MemberId":[0,0,0]},"TargetCfg":{"Path":"4,192.168.1.100","CipConnMode":0,"UcmmTimeout":0,"ConnMsgTimeout":0,"ConnClose":false},"ReqData":"","ReqLength":0,"ResDataSize":490}', 1)"#;
}

//! Users, API tokens and view links. No secret is in the database: passwords are hashed with Argon2id, the secrets of
//! tokens and links, which are random, with SHA-256.

use cipdeck_shared::api::Role;
use rusqlite::types::Type;
use rusqlite::{Connection, Error, Row};

use super::{Store, StoreError};

/// A user as it lies in the database.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct StoredUser {
    /// Names the user.
    pub(crate) name: String,
    /// What the user may do.
    pub(crate) role: Role,
    /// Cannot sign in.
    pub(crate) disabled: bool,
    /// Argon2id, as a PHC string.
    pub(crate) password: String,
    /// RFC 3339.
    pub(crate) created_at: String,
    /// RFC 3339.
    pub(crate) last_sign_in: Option<String>,
}

/// An API token or a view link as it lies in the database.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct StoredPass {
    /// What it is.
    pub(crate) kind: PassKind,
    /// What people call it.
    pub(crate) name: String,
    /// What it may do.
    pub(crate) role: Role,
    /// One target a line.
    pub(crate) scope: String,
    /// SHA-256 of the secret.
    pub(crate) digest: [u8; 32],
    /// Who made it.
    pub(crate) created_by: String,
    /// s since 1970.
    pub(crate) ends_at: u64,
    /// s since 1970.
    pub(crate) last_used: Option<u64>,
}

/// Two kinds of secrets that open without a password.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PassKind {
    /// For programs.
    Token,
    /// For a tablet on the wall.
    ViewLink,
}

impl PassKind {
    const fn word(self) -> &'static str {
        match self {
            Self::Token => "token",
            Self::ViewLink => "view_link",
        }
    }
}

impl Store {
    /// All users.
    pub(crate) async fn users(&self) -> Result<Vec<StoredUser>, StoreError> {
        self.0.call(|connection| users(connection)).await
    }

    /// A user who is not there yet.
    pub(crate) async fn add_user(&self, user: StoredUser) -> Result<(), StoreError> {
        self.0
            .call(move |connection| {
                let StoredUser { name, role, disabled, password, created_at, last_sign_in } = user;
                connection.execute(
                    "INSERT INTO user (name, role, disabled, password, created_at, last_sign_in) \
                     VALUES (?1, ?2, ?3, ?4, ?5, ?6)",
                    (name, role.word(), disabled, password, created_at, last_sign_in),
                )?;
                Ok(())
            })
            .await
    }

    /// Another role, another password, locked or not.
    pub(crate) async fn change_user(&self, user: StoredUser) -> Result<(), StoreError> {
        self.0
            .call(move |connection| {
                let StoredUser { name, role, disabled, password, last_sign_in, .. } = user;
                connection.execute(
                    "UPDATE user SET role = ?2, disabled = ?3, password = ?4, last_sign_in = ?5 WHERE name = ?1",
                    (name, role.word(), disabled, password, last_sign_in),
                )?;
                Ok(())
            })
            .await
    }

    /// Forgets a user.
    pub(crate) async fn remove_user(&self, name: String) -> Result<(), StoreError> {
        self.0
            .call(move |connection| {
                connection.execute("DELETE FROM user WHERE name = ?1", [name])?;
                Ok(())
            })
            .await
    }

    /// All tokens and links with their ids.
    pub(crate) async fn passes(&self) -> Result<Vec<(u64, StoredPass)>, StoreError> {
        self.0.call(|connection| passes(connection)).await
    }

    /// A new token or link; its id.
    pub(crate) async fn add_pass(&self, pass: StoredPass) -> Result<u64, StoreError> {
        self.0
            .call(move |connection| {
                connection.execute(
                    "INSERT INTO pass (kind, name, role, scope, digest, created_by, ends_at) \
                     VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)",
                    (
                        pass.kind.word(),
                        pass.name,
                        pass.role.word(),
                        pass.scope,
                        pass.digest,
                        pass.created_by,
                        signed(pass.ends_at),
                    ),
                )?;
                u64::try_from(connection.last_insert_rowid()).map_err(|_| StoreError::NoIds)
            })
            .await
    }

    /// Forgets a token or link.
    pub(crate) async fn remove_pass(&self, id: u64) -> Result<(), StoreError> {
        self.0
            .call(move |connection| {
                connection.execute("DELETE FROM pass WHERE id = ?1", [signed(id)])?;
                Ok(())
            })
            .await
    }

    /// When tokens and links were used: pairs of an id and s since 1970.
    pub(crate) async fn passes_used(&self, used: Vec<(u64, u64)>) -> Result<(), StoreError> {
        self.0
            .call(move |connection| {
                let transaction = connection.transaction()?;
                for (id, at) in used {
                    transaction
                        .execute("UPDATE pass SET last_used = ?2 WHERE id = ?1", (signed(id), signed(at)))?;
                }
                Ok(transaction.commit()?)
            })
            .await
    }
}

fn users(connection: &Connection) -> Result<Vec<StoredUser>, StoreError> {
    let mut statement = connection
        .prepare("SELECT name, role, disabled, password, created_at, last_sign_in FROM user ORDER BY name")?;
    let rows = statement.query_map((), |row| {
        Ok(StoredUser {
            name: row.get(0)?,
            role: role(row, 1)?,
            disabled: row.get(2)?,
            password: row.get(3)?,
            created_at: row.get(4)?,
            last_sign_in: row.get(5)?,
        })
    })?;
    Ok(rows.collect::<Result<_, _>>()?)
}

fn passes(connection: &Connection) -> Result<Vec<(u64, StoredPass)>, StoreError> {
    let mut statement = connection.prepare(
        "SELECT id, kind, name, role, scope, digest, created_by, ends_at, last_used FROM pass ORDER BY id",
    )?;
    let rows = statement.query_map((), |row| {
        let kind = match row.get_ref(1)?.as_str()? {
            "token" => PassKind::Token,
            "view_link" => PassKind::ViewLink,
            other => return Err(unknown(1, other)),
        };
        let pass = StoredPass {
            kind,
            name: row.get(2)?,
            role: role(row, 3)?,
            scope: row.get(4)?,
            digest: row.get(5)?,
            created_by: row.get(6)?,
            ends_at: unsigned(row.get(7)?),
            last_used: row.get::<_, Option<i64>>(8)?.map(unsigned),
        };
        Ok((unsigned(row.get(0)?), pass))
    })?;
    Ok(rows.collect::<Result<_, _>>()?)
}

fn role(row: &Row<'_>, column: usize) -> Result<Role, Error> {
    let word = row.get_ref(column)?.as_str()?;
    Role::ALL.into_iter().find(|role| role.word() == word).ok_or_else(|| unknown(column, word))
}

fn unknown(column: usize, word: &str) -> Error {
    Error::FromSqlConversionFailure(column, Type::Text, format!("{word:?} is not known").into())
}

/// SQLite counts with a sign. Ids and times stay far from the end.
fn signed(number: u64) -> i64 {
    i64::try_from(number).unwrap_or(i64::MAX)
}

fn unsigned(number: i64) -> u64 {
    u64::try_from(number).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn user(role: Role) -> StoredUser {
        StoredUser {
            name: "anna".to_owned(),
            role,
            disabled: false,
            password: "$argon2id$".to_owned(),
            created_at: "2026-11-21T22:31:25.123456Z".to_owned(),
            last_sign_in: None,
        }
    }

    #[tokio::test]
    async fn users_come_back_as_they_were_changed_last() {
        let store = Store::open(None).await.unwrap();
        for role in Role::ALL {
            store.add_user(user(role)).await.unwrap();
            assert!(store.add_user(user(role)).await.is_err(), "a name is taken once");
            assert_eq!(store.users().await.unwrap(), [user(role)]);
            let changed = StoredUser { disabled: true, last_sign_in: Some("now".to_owned()), ..user(role) };
            store.change_user(changed.clone()).await.unwrap();
            assert_eq!(store.users().await.unwrap(), [changed]);
            store.remove_user("anna".to_owned()).await.unwrap();
            assert_eq!(store.users().await.unwrap(), []);
        }
    }

    #[tokio::test]
    async fn the_id_of_a_pass_is_never_used_again() {
        let store = Store::open(None).await.unwrap();
        let pass = StoredPass {
            kind: PassKind::ViewLink,
            name: "hall 3".to_owned(),
            role: Role::Viewer,
            scope: String::new(),
            digest: [7; 32],
            created_by: "anna".to_owned(),
            ends_at: 4_107_542_400,
            last_used: None,
        };
        let first = store.add_pass(pass.clone()).await.unwrap();
        assert!(store.add_pass(pass.clone()).await.is_err(), "no two secrets are the same");
        store.passes_used(vec![(first, 5)]).await.unwrap();
        let used = StoredPass { last_used: Some(5), ..pass.clone() };
        assert_eq!(store.passes().await.unwrap(), [(first, used)]);
        store.remove_pass(first).await.unwrap();
        assert_eq!(store.add_pass(pass).await.unwrap(), first + 1);
    }
}

//! Everything that belongs to a project, with the names of its files.

use cipdeck_shared::config::project::ProjectHead;
use cipdeck_shared::config::{Block, BlockId, Device, DeviceId, Extra, Group, GroupId, Variable, VariableId};
use rusqlite::{Connection, OptionalExtension, Row};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::StoreError;

/// All that is stored, or a part of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct StoredProject {
    pub(crate) head: Option<ProjectHead>,
    /// By id, like everything else here.
    pub(crate) blocks: Vec<StoredBlock>,
    pub(crate) targets: Vec<StoredTarget>,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StoredBlock {
    pub(crate) block: Block,
    /// The name of its file, without ending.
    pub(crate) file: Option<String>,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StoredTarget {
    pub(crate) device: Device,
    pub(crate) file: Option<String>,
    /// Members that nobody here knows.
    pub(crate) extra: Extra,
    pub(crate) groups: Vec<StoredGroup>,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StoredGroup {
    pub(crate) group: Group,
    pub(crate) file: Option<String>,
    pub(crate) extra: Extra,
    /// In their order.
    pub(crate) variables: Vec<(Variable, Extra)>,
}

/// Which part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scope {
    All,
    Block(BlockId),
    /// With its groups.
    Device(DeviceId),
    /// Its device, and of its groups this one.
    Group(GroupId),
}

/// Loads what is in a scope.
pub(crate) fn load_project(connection: &Connection, scope: Scope) -> Result<StoredProject, StoreError> {
    let mut stored = StoredProject::default();
    if scope == Scope::All {
        stored.head = head(connection)?;
    }
    let block = match scope {
        Scope::All => Some(None),
        Scope::Block(id) => Some(Some(id.0)),
        _ => None,
    };
    if let Some(id) = block {
        let query =
            "SELECT id, revision, config, file, '{}', 0 FROM block WHERE ?1 IS NULL OR id = ?1 ORDER BY id";
        for (id, revision, config, file, _, _) in rows(connection, query, id)? {
            stored.blocks.push(StoredBlock { block: Block { id: BlockId(id), revision, config }, file });
        }
    }
    let device = match scope {
        Scope::All => Some(None),
        Scope::Device(id) => Some(Some(id.0)),
        Scope::Group(id) => {
            let query = "SELECT device FROM variable_group WHERE id = ?1";
            let found = connection.query_row(query, [id.0], |row| row.get::<_, u32>(0)).optional()?;
            found.map(Some)
        }
        Scope::Block(_) => None,
    };
    if let Some(id) = device {
        let query =
            "SELECT id, revision, config, file, extra, 0 FROM device WHERE ?1 IS NULL OR id = ?1 ORDER BY id";
        for (id, revision, config, file, extra, _) in rows(connection, query, id)? {
            let device = Device { id: DeviceId(id), revision, config };
            let groups = groups(connection, device.id, scope)?;
            stored.targets.push(StoredTarget { device, file, extra, groups });
        }
    }
    Ok(stored)
}

fn groups(connection: &Connection, device: DeviceId, scope: Scope) -> Result<Vec<StoredGroup>, StoreError> {
    let query =
        "SELECT id, revision, config, file, extra, 0 FROM variable_group WHERE device = ?1 ORDER BY id";
    let mut groups = Vec::new();
    for (id, revision, config, file, extra, _) in rows(connection, query, Some(device.0))? {
        let id = GroupId(id);
        if matches!(scope, Scope::Group(only) if only != id) {
            continue;
        }
        let query =
            "SELECT id, revision, config, NULL, extra, owner FROM variable WHERE owner = ?1 ORDER BY id";
        let mut variables: Vec<(Variable, Extra)> = Vec::new();
        for (id, revision, config, _, extra, owner) in rows(connection, query, Some(id.0))? {
            variables.push((Variable { id: VariableId(id), revision, group: GroupId(owner), config }, extra));
        }
        variables.sort_by_key(|(variable, _)| (variable.config.order, variable.id));
        groups.push(StoredGroup { group: Group { id, revision, config }, file, extra, variables });
    }
    Ok(groups)
}

/// Id, revision, configuration, file, extra members, owner.
type Columns<T> = (u32, u64, T, Option<String>, Extra, u32);

fn rows<T: DeserializeOwned>(
    connection: &Connection,
    query: &str,
    id: Option<u32>,
) -> Result<Vec<Columns<T>>, StoreError> {
    let mut statement = connection.prepare_cached(query)?;
    let columns = |row: &Row<'_>| {
        let (config, extra) = (row.get::<_, String>(2)?, row.get::<_, String>(4)?);
        Ok((row.get::<_, u32>(0)?, row.get::<_, i64>(1)?, config, row.get(3)?, extra, row.get::<_, u32>(5)?))
    };
    let rows = statement.query_map([id], columns)?;
    rows.map(|row| {
        let (id, revision, config, file, extra, owner) = row?;
        let (config, extra) = (serde_json::from_str(&config)?, serde_json::from_str(&extra)?);
        Ok((id, revision.unsigned_abs(), config, file, extra, owner))
    })
    .collect()
}

fn head(connection: &Connection) -> Result<Option<ProjectHead>, StoreError> {
    let query = "SELECT head FROM project";
    let text = connection.query_row(query, (), |row| row.get::<_, String>(0)).optional()?;
    text.map(|text| Ok(serde_json::from_str(&text)?)).transpose()
}

/// What `cipdeck.json` says from now on.
pub(crate) fn put_head(connection: &Connection, head: &ProjectHead) -> Result<(), StoreError> {
    let text = json(head)?;
    connection.execute(
        "INSERT INTO project (id, head) VALUES (1, ?1) ON CONFLICT DO UPDATE SET head = ?1",
        [text],
    )?;
    Ok(())
}

/// What the last change of several files was called.
pub(crate) fn put_change(connection: &Connection, change: &str) -> Result<(), StoreError> {
    connection.execute("UPDATE project SET change = ?1", [change])?;
    Ok(())
}

/// See [`put_change`].
pub(super) fn change(connection: &Connection) -> Result<Option<String>, StoreError> {
    let change = connection.query_row("SELECT change FROM project", (), |row| row.get(0)).optional()?;
    Ok(change.flatten())
}

/// One of the four tables of a project.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Table {
    Block,
    Device,
    Group,
    Variable,
}

impl Table {
    const fn name(self) -> &'static str {
        match self {
            Self::Block => "block",
            Self::Device => "device",
            Self::Group => "variable_group",
            Self::Variable => "variable",
        }
    }

    /// Another configuration, with one more revision.
    pub(crate) fn update(
        self,
        connection: &Connection,
        id: u32,
        config: &impl Serialize,
    ) -> Result<(), StoreError> {
        let update = format!("UPDATE {} SET revision = revision + 1, config = ?2 WHERE id = ?1", self.name());
        connection.prepare_cached(&update)?.execute((id, json(config)?))?;
        Ok(())
    }

    /// Something new; its id. `owner` is the device of a group and the group of a variable.
    pub(crate) fn insert(
        self,
        connection: &Connection,
        owner: Option<u32>,
        config: &impl Serialize,
    ) -> Result<u32, StoreError> {
        let column = match self {
            Self::Block | Self::Device => None,
            Self::Group => Some("device"),
            Self::Variable => Some("owner"),
        };
        let config = json(config)?;
        match column {
            None => {
                let insert = format!("INSERT INTO {} (revision, config) VALUES (1, ?1)", self.name());
                connection.prepare_cached(&insert)?.execute([config])?;
            }
            Some(column) => {
                let insert =
                    format!("INSERT INTO {} (revision, {column}, config) VALUES (1, ?1, ?2)", self.name());
                connection.prepare_cached(&insert)?.execute((owner, config))?;
            }
        }
        u32::try_from(connection.last_insert_rowid()).map_err(|_| StoreError::NoIds)
    }

    /// Something less, with what belongs to it.
    pub(crate) fn delete(self, connection: &Connection, id: u32) -> Result<(), StoreError> {
        connection.prepare_cached(&format!("DELETE FROM {} WHERE id = ?1", self.name()))?.execute([id])?;
        Ok(())
    }

    /// The name of its file.
    pub(crate) fn set_file(
        self,
        connection: &Connection,
        id: u32,
        file: Option<&str>,
    ) -> Result<(), StoreError> {
        let update = format!("UPDATE {} SET file = ?2 WHERE id = ?1", self.name());
        connection.prepare_cached(&update)?.execute((id, file))?;
        Ok(())
    }

    /// The members that nobody here knows.
    pub(crate) fn set_extra(self, connection: &Connection, id: u32, extra: &Extra) -> Result<(), StoreError> {
        let update = format!("UPDATE {} SET extra = ?2 WHERE id = ?1", self.name());
        connection.prepare_cached(&update)?.execute((id, json(extra)?))?;
        Ok(())
    }
}

fn json(value: &impl Serialize) -> Result<String, StoreError> {
    Ok(serde_json::to_string(value)?)
}

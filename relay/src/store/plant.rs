//! Devices, groups and variables: JSON text and a revision. Who may change what, and which revision, has been decided
//! by the only caller, who changes one thing after the other.

use cipdeck_shared::api::WriteEntry;
use cipdeck_shared::config::{
    Device, DeviceConfig, DeviceId, Group, GroupConfig, GroupId, Variable, VariableConfig, VariableId,
};
use rusqlite::{Connection, Row, Transaction};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{Store, StoreError};
use crate::project::Touched;

/// Everything that is stored about devices.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct StoredPlant {
    /// By id.
    pub(crate) devices: Vec<Device>,
    /// By id.
    pub(crate) groups: Vec<Group>,
    /// By id.
    pub(crate) variables: Vec<Variable>,
}

/// A variable that is to be stored.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fresh {
    /// What was entered.
    pub(crate) config: VariableConfig,
    /// Its parent's place in the same list, where the parent has no id yet.
    pub(crate) parent: Option<usize>,
}

/// Writes that are kept of each device.
const KEPT_WRITES: u32 = 100;

impl Store {
    /// Everything.
    pub(crate) async fn load_plant(&self) -> Result<StoredPlant, StoreError> {
        self.0.call(|connection| load(connection)).await
    }

    /// A new device with its groups and their variables: all of it or nothing.
    pub(crate) async fn add_device(
        &self,
        config: DeviceConfig,
        groups: Vec<(GroupConfig, Vec<Fresh>)>,
    ) -> Result<StoredPlant, StoreError> {
        let beside = self.1.clone();
        self.0
            .call(move |connection| {
                let transaction = connection.transaction()?;
                transaction
                    .execute("INSERT INTO device (revision, config) VALUES (1, ?1)", [json(&config)?])?;
                let device = Device { id: DeviceId(last_id(&transaction)?), revision: 1, config };
                let mut made = StoredPlant { devices: vec![device.clone()], ..StoredPlant::default() };
                for (mut config, variables) in groups {
                    config.device = device.id;
                    let group = add_group(&transaction, config)?;
                    made.variables.extend(add_variables(&transaction, group.id, variables)?);
                    made.groups.push(group);
                }
                beside.commit(transaction, &[Touched::Device(device.id)])?;
                Ok(made)
            })
            .await
    }

    /// A device as it is now.
    pub(crate) async fn put_device(&self, device: Device) -> Result<(), StoreError> {
        let Device { id, revision, config } = device;
        let update = "UPDATE device SET revision = ?2, config = ?3 WHERE id = ?1";
        self.put(update, id.0, revision, config, Touched::Device(id)).await
    }

    /// A device less, with all that belongs to it.
    pub(crate) async fn remove_device(&self, id: DeviceId) -> Result<(), StoreError> {
        self.remove_all("DELETE FROM device WHERE id = ?1", vec![id.0], vec![Touched::Device(id)]).await
    }

    /// A new group.
    pub(crate) async fn add_group(&self, config: GroupConfig) -> Result<Group, StoreError> {
        let beside = self.1.clone();
        self.0
            .call(move |connection| {
                let transaction = connection.transaction()?;
                let group = add_group(&transaction, config)?;
                beside.commit(transaction, &[Touched::Group(group.id)])?;
                Ok(group)
            })
            .await
    }

    /// A group as it is now.
    pub(crate) async fn put_group(&self, group: Group) -> Result<(), StoreError> {
        let Group { id, revision, config } = group;
        let update = "UPDATE variable_group SET revision = ?2, config = ?3 WHERE id = ?1";
        self.put(update, id.0, revision, config, Touched::Group(id)).await
    }

    /// A group less, with its variables.
    pub(crate) async fn remove_group(&self, id: GroupId) -> Result<(), StoreError> {
        let delete = "DELETE FROM variable_group WHERE id = ?1";
        self.remove_all(delete, vec![id.0], vec![Touched::Group(id)]).await
    }

    /// New variables of a group: all of them or none.
    pub(crate) async fn add_variables(
        &self,
        group: GroupId,
        fresh: Vec<Fresh>,
    ) -> Result<Vec<Variable>, StoreError> {
        let beside = self.1.clone();
        self.0
            .call(move |connection| {
                let transaction = connection.transaction()?;
                let variables = add_variables(&transaction, group, fresh)?;
                beside.commit(transaction, &[Touched::Group(group)])?;
                Ok(variables)
            })
            .await
    }

    /// A variable as it is now.
    pub(crate) async fn put_variable(&self, variable: Variable) -> Result<(), StoreError> {
        let Variable { id, revision, group, config } = variable;
        let update = "UPDATE variable SET revision = ?2, config = ?3 WHERE id = ?1";
        self.put(update, id.0, revision, config, Touched::Group(group)).await
    }

    /// Variables of a group less.
    pub(crate) async fn remove_variables(
        &self,
        group: GroupId,
        ids: Vec<VariableId>,
    ) -> Result<(), StoreError> {
        let ids = ids.into_iter().map(|id| id.0).collect();
        self.remove_all("DELETE FROM variable WHERE id = ?1", ids, vec![Touched::Group(group)]).await
    }

    /// What was written to a device; the oldest are forgotten.
    pub(crate) async fn add_write(&self, device: DeviceId, entry: WriteEntry) -> Result<(), StoreError> {
        self.0
            .call(move |connection| {
                let transaction = connection.transaction()?;
                transaction.execute(
                    "INSERT INTO variable_write (device, entry) VALUES (?1, ?2)",
                    (device.0, json(&entry)?),
                )?;
                transaction.execute(
                    "DELETE FROM variable_write WHERE device = ?1 AND id NOT IN \
                     (SELECT id FROM variable_write WHERE device = ?1 ORDER BY id DESC LIMIT ?2)",
                    (device.0, KEPT_WRITES),
                )?;
                Ok(transaction.commit()?)
            })
            .await
    }

    /// What was written to a device, the newest first.
    pub(crate) async fn writes(&self, device: DeviceId) -> Result<Vec<WriteEntry>, StoreError> {
        self.0
            .call(move |connection| {
                let query = "SELECT entry FROM variable_write WHERE device = ?1 ORDER BY id DESC";
                let mut statement = connection.prepare(query)?;
                let rows = statement.query_map([device.0], |row| row.get::<_, String>(0))?;
                rows.map(|row| Ok(serde_json::from_str(&row?)?)).collect()
            })
            .await
    }

    async fn put(
        &self,
        update: &'static str,
        id: u32,
        revision: u64,
        config: impl Serialize + Send + 'static,
        touched: Touched,
    ) -> Result<(), StoreError> {
        let beside = self.1.clone();
        self.0
            .call(move |connection| {
                let transaction = connection.transaction()?;
                let revision = i64::try_from(revision).unwrap_or(i64::MAX);
                transaction.execute(update, (id, revision, json(&config)?))?;
                beside.commit(transaction, &[touched])
            })
            .await
    }

    async fn remove_all(
        &self,
        delete: &'static str,
        ids: Vec<u32>,
        touched: Vec<Touched>,
    ) -> Result<(), StoreError> {
        let beside = self.1.clone();
        self.0
            .call(move |connection| {
                let transaction = connection.transaction()?;
                for id in ids {
                    transaction.execute(delete, [id])?;
                }
                beside.commit(transaction, &touched)
            })
            .await
    }
}

fn add_group(transaction: &Transaction<'_>, config: GroupConfig) -> Result<Group, StoreError> {
    let insert = "INSERT INTO variable_group (device, revision, config) VALUES (?1, 1, ?2)";
    transaction.execute(insert, (config.device.0, json(&config)?))?;
    Ok(Group { id: GroupId(last_id(transaction)?), revision: 1, config })
}

fn add_variables(
    transaction: &Transaction<'_>,
    group: GroupId,
    fresh: Vec<Fresh>,
) -> Result<Vec<Variable>, StoreError> {
    let mut insert =
        transaction.prepare("INSERT INTO variable (owner, revision, config) VALUES (?1, 1, ?2)")?;
    let mut made: Vec<Variable> = Vec::with_capacity(fresh.len());
    for Fresh { mut config, parent } in fresh {
        if let Some(parent) = parent.and_then(|place| made.get(place)) {
            config.parent = Some(parent.id);
        }
        insert.execute((group.0, json(&config)?))?;
        made.push(Variable { id: VariableId(last_id(transaction)?), revision: 1, group, config });
    }
    Ok(made)
}

fn load(connection: &Connection) -> Result<StoredPlant, StoreError> {
    let mut plant = StoredPlant::default();
    let devices = "SELECT id, revision, config, 0 FROM device ORDER BY id";
    for (id, revision, config, _) in rows(connection, devices)? {
        plant.devices.push(Device { id: DeviceId(id), revision, config });
    }
    let groups = "SELECT id, revision, config, device FROM variable_group ORDER BY id";
    for (id, revision, config, _) in rows(connection, groups)? {
        plant.groups.push(Group { id: GroupId(id), revision, config });
    }
    let variables = "SELECT id, revision, config, owner FROM variable ORDER BY id";
    for (id, revision, config, owner) in rows(connection, variables)? {
        plant.variables.push(Variable { id: VariableId(id), revision, group: GroupId(owner), config });
    }
    Ok(plant)
}

/// Id, revision, configuration, and whose it is.
fn rows<T: DeserializeOwned>(
    connection: &Connection,
    query: &str,
) -> Result<Vec<(u32, u64, T, u32)>, StoreError> {
    let mut statement = connection.prepare(query)?;
    let columns = |row: &Row<'_>| {
        Ok((row.get::<_, u32>(0)?, row.get::<_, i64>(1)?, row.get::<_, String>(2)?, row.get::<_, u32>(3)?))
    };
    let rows = statement.query_map((), columns)?;
    rows.map(|row| {
        let (id, revision, config, owner) = row?;
        Ok((id, revision.unsigned_abs(), serde_json::from_str(&config)?, owner))
    })
    .collect()
}

fn json(value: &impl Serialize) -> Result<String, StoreError> {
    Ok(serde_json::to_string(value)?)
}

fn last_id(connection: &Connection) -> Result<u32, StoreError> {
    u32::try_from(connection.last_insert_rowid()).map_err(|_| StoreError::NoIds)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fresh(name: &str, parent: Option<usize>) -> Fresh {
        Fresh { config: VariableConfig::new(name, name), parent }
    }

    #[tokio::test]
    async fn a_plant_is_there_after_a_restart_and_what_belongs_to_something_goes_with_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cipdeck.sqlite");
        let store = Store::open(Some(&path)).await.unwrap();
        let group = GroupConfig::new(DeviceId(0), "line 4");
        let variables = vec![fresh("stMotor", None), fresh("speed", Some(0))];
        let device = DeviceConfig::new("NX 1", "0,0");
        let made = store.add_device(device, vec![(group, variables)]).await.unwrap();
        assert_eq!(made.groups[0].config.device, made.devices[0].id);
        assert_eq!(made.variables[1].config.parent, Some(made.variables[0].id));
        store.close().await;

        let store = Store::open(Some(&path)).await.unwrap();
        assert_eq!(store.load_plant().await.unwrap(), made);
        let changed = Device { revision: 2, ..made.devices[0].clone() };
        store.put_device(changed.clone()).await.unwrap();
        assert_eq!(store.load_plant().await.unwrap().devices, [changed]);
        store.remove_device(made.devices[0].id).await.unwrap();
        assert_eq!(store.load_plant().await.unwrap(), StoredPlant::default());
        let next = store.add_device(DeviceConfig::new("NX 2", "0,0"), Vec::new()).await.unwrap();
        assert_eq!(next.devices[0].id, DeviceId(2), "an id is never used again");
    }

    #[tokio::test]
    async fn the_last_hundred_writes_of_each_device_are_kept() {
        let store = Store::open(None).await.unwrap();
        for name in ["a", "b"] {
            store.add_device(DeviceConfig::new(name, "0,0"), Vec::new()).await.unwrap();
        }
        let entry = |number: u32| WriteEntry {
            at: String::new(),
            actor: "anna".to_owned(),
            variable: VariableId(number),
            name: String::new(),
            address: String::new(),
            old: None,
            new: None,
            read_back: None,
            is_done: true,
            reason: None,
            is_equal: None,
        };
        store.add_write(DeviceId(2), entry(0)).await.unwrap();
        for number in 1..=103 {
            store.add_write(DeviceId(1), entry(number)).await.unwrap();
        }
        let kept = store.writes(DeviceId(1)).await.unwrap();
        assert_eq!((kept.len(), kept[0].variable.0, kept[99].variable.0), (100, 103, 4));
        assert_eq!(store.writes(DeviceId(2)).await.unwrap(), [entry(0)]);
    }
}

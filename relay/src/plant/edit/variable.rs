//! Variables: added, also many at once, changed, forgotten.

use cipdeck_shared::api::NewVariables;
use cipdeck_shared::config::{GroupId, Variable, VariableId};
use cipdeck_shared::plan::plant;

use super::{changed, fresh_enough, refused, same, stays};
use crate::actor::Actor;
use crate::audit::Record;
use crate::error::ApiError;
use crate::plant::{Inner, Plant};
use crate::runner::lock;
use crate::store::Fresh;

impl Plant {
    /// New variables: all of them or none.
    pub(crate) async fn add_variables(
        &self,
        actor: &Actor,
        id: GroupId,
        new: NewVariables,
    ) -> Result<Vec<Variable>, ApiError> {
        let actor = actor.clone();
        self.edit(|inner| async move {
            let accepted = {
                let entries = lock(&inner.entries);
                let types = entries.types(id)?;
                let there = entries.variables_of(id);
                plant::added(there, &new.variables, &types, |place| format!("variables[{place}]"))
            };
            inner.add_variables(&actor, id, accepted.map_err(refused)?).await
        })
        .await
    }

    /// The variables of a file: all of them or none.
    pub(crate) async fn add_csv(
        &self,
        actor: &Actor,
        id: GroupId,
        text: String,
    ) -> Result<Vec<Variable>, ApiError> {
        let actor = actor.clone();
        self.edit(|inner| async move {
            let accepted = {
                let entries = lock(&inner.entries);
                let types = entries.types(id)?;
                let (lines, new): (Vec<_>, Vec<_>) =
                    plant::read_csv(&text).map_err(refused)?.into_iter().unzip();
                let line = |place: usize| format!("line {}", lines.get(place).copied().unwrap_or_default());
                plant::added(entries.variables_of(id), &new, &types, line)
            };
            inner.add_variables(&actor, id, accepted.map_err(refused)?).await
        })
        .await
    }

    /// A variable as it is from now on.
    pub(crate) async fn replace_variable(
        &self,
        actor: &Actor,
        id: VariableId,
        variable: Variable,
    ) -> Result<Variable, ApiError> {
        same(&id, &variable.id)?;
        let actor = actor.clone();
        self.edit(|inner| async move {
            let (config, device) = {
                let entries = lock(&inner.entries);
                let there = entries.variable(id)?;
                fresh_enough(there.revision, variable.revision, &id)?;
                stays(&there.group, &variable.group, "a variable stays in its group")?;
                let (all, types) = (entries.variables_of(there.group), entries.types(there.group)?);
                let config = plant::changed(id, &variable.config, all, &types).map_err(refused)?;
                (config, entries.group(there.group)?.config.device)
            };
            let variable = Variable { revision: variable.revision + 1, config, ..variable };
            inner.store.put_variable(variable.clone()).await?;
            lock(&inner.entries).put_variable(&variable);
            inner.note(&of_variable(&actor, "changed", &variable));
            inner.told(device, Some(variable.group));
            Ok(variable)
        })
        .await
    }

    /// Forgets a variable and its parts.
    pub(crate) async fn remove_variable(
        &self,
        actor: &Actor,
        id: VariableId,
        revision: u64,
    ) -> Result<(), ApiError> {
        let actor = actor.clone();
        self.edit(|inner| async move {
            let (variable, device, ids) = {
                let entries = lock(&inner.entries);
                let variable = entries.variable(id)?.clone();
                fresh_enough(variable.revision, revision, &id)?;
                let device = entries.group(variable.group)?.config.device;
                (variable, device, entries.with_parts(id))
            };
            inner.store.remove_variables(variable.group, ids.clone()).await?;
            lock(&inner.entries).remove_variables(&ids);
            inner.note(&of_variable(&actor, "deleted", &variable).with("parts", ids.len() - 1));
            inner.told(device, Some(variable.group));
            Ok(())
        })
        .await
    }
}

impl Inner {
    async fn add_variables(
        &self,
        actor: &Actor,
        group: GroupId,
        accepted: Vec<plant::Accepted>,
    ) -> Result<Vec<Variable>, ApiError> {
        let device = lock(&self.entries).group(group)?.config.device;
        let fresh = accepted
            .into_iter()
            .map(|accepted| Fresh { config: accepted.config, parent: accepted.parent })
            .collect();
        let variables = self.store.add_variables(group, fresh).await?;
        lock(&self.entries).add_variables(variables.clone());
        let record = changed(actor, "variables", "created").with("group", group.to_string());
        self.note(&record.with("count", variables.len()));
        self.told(device, Some(group));
        Ok(variables)
    }
}

fn of_variable(actor: &Actor, how: &str, variable: &Variable) -> Record {
    changed(actor, "variable", how)
        .with("id", variable.id.to_string())
        .with("name", variable.config.name.clone())
        .with("revision", variable.revision)
        .with("address", variable.config.address.clone())
        .with("writable", variable.config.writable)
}

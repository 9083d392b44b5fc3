//! What this document asks of the relay, beside what it reads with the office's `fetch`.

use cipdeck_shared::{
    api::{
        BrowseRequest, CopyDevice, DiscoverRequest, Discovered, NewValue, NewVariables, VariableWritten,
        VariablesCsv, WriteTicket, WriteVariable,
    },
    config::{
        Device, DeviceConfig, DeviceId, Group, GroupConfig, GroupId, NewVariable, Variable, VariableConfig,
        VariableId,
    },
};
use gloo_net::http::Method;
use serde::{Serialize, de::DeserializeOwned};

use crate::net::rest::{self, Answered};

/// Something with the revision that it replaces.
#[derive(Serialize)]
struct Revised<T> {
    revision: u64,
    #[serde(flatten)]
    config: T,
}

/// One more device.
pub async fn add_device(device: DeviceConfig) -> Answered<Device> {
    send(Method::POST, "devices", &device).await
}

/// A changed device.
pub async fn change_device(id: DeviceId, revision: u64, config: DeviceConfig) -> Answered<Device> {
    send(Method::PUT, &format!("devices/{id}"), &Revised { revision, config }).await
}

/// A device with the same groups and variables.
pub async fn copy_device(id: DeviceId, copy: CopyDevice) -> Answered<Device> {
    send(Method::POST, &format!("devices/{id}/copy"), &copy).await
}

/// Who is on the network.
pub async fn discover(request: DiscoverRequest) -> Answered<Discovered> {
    rest::discover(&request).await
}

/// One more group.
pub async fn add_group(group: GroupConfig) -> Answered<Group> {
    send(Method::POST, "groups", &group).await
}

/// A changed group.
pub async fn change_group(id: GroupId, revision: u64, config: GroupConfig) -> Answered<Group> {
    send(Method::PUT, &format!("groups/{id}"), &Revised { revision, config }).await
}

/// More variables: all of them, or none. What was made.
pub async fn add_variables(id: GroupId, variables: Vec<NewVariable>) -> Answered<Vec<Variable>> {
    send(Method::POST, &format!("groups/{id}/variables"), &NewVariables { variables }).await
}

/// A changed variable.
pub async fn change_variable(id: VariableId, revision: u64, config: VariableConfig) -> Answered<Variable> {
    send(Method::PUT, &format!("variables/{id}"), &Revised { revision, config }).await
}

/// The variables of a file: all of them, or none.
pub async fn import(id: GroupId, csv: String) -> Answered<()> {
    quiet(Method::POST, &format!("groups/{id}/variables.csv"), &VariablesCsv { csv }).await
}

/// The first half of a write.
pub async fn offer(id: VariableId, text: String) -> Answered<WriteTicket> {
    send(Method::POST, &format!("variables/{id}/offer"), &NewValue { text }).await
}

/// The second half.
pub async fn write(id: VariableId, ticket: String) -> Answered<VariableWritten> {
    send(Method::POST, &format!("variables/{id}/write"), &WriteVariable { ticket }).await
}

/// Asks a device what it has.
pub async fn browse(id: DeviceId, request: BrowseRequest) -> Answered<()> {
    quiet(Method::POST, &format!("devices/{id}/browse"), &request).await
}

/// Asks no more.
pub async fn end_browse(id: DeviceId) -> Answered<()> {
    rest::ask(Method::DELETE, &format!("devices/{id}/browse"), None).await.map(|_| ())
}

/// Reads something.
pub async fn get<T: DeserializeOwned>(resource: String) -> Answered<T> {
    rest::parse(&rest::ask(Method::GET, &resource, None).await?)
}

async fn send<T: DeserializeOwned>(method: Method, resource: &str, body: &impl Serialize) -> Answered<T> {
    rest::parse(&rest::ask(method, resource, Some(rest::json(body)?)).await?)
}

async fn quiet(method: Method, resource: &str, body: &impl Serialize) -> Answered<()> {
    rest::ask(method, resource, Some(rest::json(body)?)).await.map(|_| ())
}

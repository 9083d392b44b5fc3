//! What this document asks of the relay, beside what it reads with the office's `fetch`.

use cipdeck_shared::{
    api::{
        BrowseRequest, CopyDevice, DiscoverRequest, Discovered, NewValue, NewVariables, WriteTicket,
        WriteVariable, Written,
    },
    config::{
        Device, DeviceConfig, DeviceId, Group, GroupConfig, GroupId, NewVariable, Variable, VariableId,
    },
};
use gloo_net::http::Method;
use serde::{Deserialize, Serialize, de::DeserializeOwned};

use crate::net::rest::{self, Answered};

/// One more device.
pub async fn add_device(device: DeviceConfig) -> Answered<Device> {
    send(Method::POST, "devices", &device).await
}

/// A changed device; it names the revision that it replaces.
pub async fn change_device(device: Device) -> Answered<Device> {
    send(Method::PUT, &format!("devices/{}", device.id), &device).await
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

/// A changed group; it names the revision that it replaces.
pub async fn change_group(group: Group) -> Answered<Group> {
    send(Method::PUT, &format!("groups/{}", group.id), &group).await
}

/// More variables: all of them, or none. What was made.
pub async fn add_variables(id: GroupId, variables: Vec<NewVariable>) -> Answered<Vec<Variable>> {
    send(Method::POST, &format!("groups/{id}/variables"), &NewVariables { variables }).await
}

/// A changed variable; it names the revision that it replaces.
pub async fn change_variable(variable: Variable) -> Answered<Variable> {
    send(Method::PUT, &format!("variables/{}", variable.id), &variable).await
}

/// The first half of a write.
pub async fn offer(id: VariableId, text: String) -> Answered<WriteTicket> {
    send(Method::POST, &format!("variables/{id}/offer"), &NewValue { text }).await
}

/// What became of a write, without the value, which comes over the WebSocket.
#[derive(Debug, Deserialize)]
pub struct Done {
    /// Whether the device has taken it.
    pub is_done: bool,
    /// Why it has not.
    #[serde(default)]
    pub reason: Option<String>,
    /// It was sent, and no answer came.
    #[serde(default)]
    pub may_have_acted: bool,
    /// Before, written, read afterwards.
    pub written: Written,
}

/// The second half.
pub async fn write(id: VariableId, ticket: String) -> Answered<Done> {
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

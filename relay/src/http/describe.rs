//! `/api/v1/openapi.json`: what the routes say of themselves, completed with what is the same for many of them.

use std::iter;
use std::sync::LazyLock;

use axum::body::Bytes;
use axum::http::header;
use axum::response::IntoResponse;
use cipdeck_shared::api::{
    ClientMessage, LiveClientMessage, LiveServerMessage, Problem, ProblemCode, ServerMessage,
};
use serde_json::{Map, Value, json};
use utoipa::OpenApi;

use super::need::Need;
use crate::access::{CSRF_HEADER, SESSION_COOKIE, VIEW_COOKIE};

/// What the document says of the relay as a whole.
#[derive(OpenApi)]
#[openapi(
    info(
        title = "cipdeck",
        description = "The relay between the browser and EtherNet/IP devices. docs/REST.md describes the interface with examples; \
                       docs/WEBSOCKET.md describes the WebSocket at /api/v1/ws, whose messages are the schemas ClientMessage and \
                       ServerMessage; docs/LIVE.md describes the one at /api/v1/live, with LiveClientMessage and LiveServerMessage. Configured for local access, the relay asks nobody on its own machine to sign in. \
                       `x-cipdeck-need` says what a request asks of its caller, `x-cipdeck-problems` which problems it is answered with."
    ),
    components(schemas(ClientMessage, ServerMessage, LiveClientMessage, LiveServerMessage, Problem)),
    tags(
        (name = "access", description = "Who may call"),
        (name = "audit", description = "Who did what"),
        (name = "blocks", description = "The stored blocks and how they look"),
        (name = "commands", description = "What a block is told to do"),
        (name = "devices", description = "Devices, groups, variables and their values"),
        (name = "history", description = "Every run of every block"),
        (name = "lists", description = "What may be reached and written"),
        (name = "project", description = "Blocks, devices and groups as files"),
        (name = "relay", description = "The relay itself"),
        (name = "writing", description = "The write window and the tickets")
    )
)]
pub(super) struct Relay;

/// The document, made when somebody asks for it first.
static DOCUMENT: LazyLock<Bytes> = LazyLock::new(|| Bytes::from(document().to_string()));

/// This description.
#[utoipa::path(
    get,
    path = "/openapi.json",
    tag = "relay",
    responses((status = 200, description = "OpenAPI 3.1", body = Object))
)]
pub(super) async fn show() -> impl IntoResponse {
    ([(header::CONTENT_TYPE, "application/json")], DOCUMENT.clone())
}

/// The description of every route that is served.
pub(super) fn document() -> Value {
    // It has string keys only, which is all that could fail.
    let mut document = serde_json::to_value(super::routes().into_openapi()).unwrap_or_default();
    document["components"]["securitySchemes"] = json!({
        "session": {"type": "apiKey", "in": "cookie", "name": SESSION_COOKIE},
        "view_link": {"type": "apiKey", "in": "cookie", "name": VIEW_COOKIE},
        "csrf": {"type": "apiKey", "in": "header", "name": CSRF_HEADER},
        "token": {"type": "http", "scheme": "bearer"},
    });
    join_closed(&mut document["components"]["schemas"]);
    polish(&mut document);
    for (path, methods) in members(&mut document["paths"]) {
        for (method, operation) in members(methods) {
            complete(method, path, operation);
        }
    }
    document
}

fn members(value: &mut Value) -> impl Iterator<Item = (&String, &mut Value)> {
    value.as_object_mut().into_iter().flatten()
}

/// What follows from the address, from what a request carries, and from what it asks of its caller.
fn complete(method: &str, path: &str, operation: &mut Value) {
    let words = path.split(|c: char| !c.is_ascii_alphanumeric());
    let words = words.filter(|word| !matches!(*word, "" | "api" | "v1"));
    operation["operationId"] = iter::once(method).chain(words).collect::<Vec<_>>().join("_").into();
    let need = Need::of(&method.to_uppercase(), path);
    operation["x-cipdeck-need"] = need.map_or(Value::Null, |need| need.word().into());
    let need = need.unwrap_or(Need::Anyone);
    operation["security"] = security(method, need);
    // A body that may be left out is not null.
    let optional = operation.pointer_mut("/requestBody/content/application~1json/schema");
    if let Some(schema) = optional
        && schema["oneOf"][1] == json!({"type": "null"})
    {
        *schema = schema["oneOf"][0].take();
    }
    let codes = problems(method, operation);
    operation["x-cipdeck-problems"] = codes.iter().map(ProblemCode::word).collect();
    for status in codes.iter().map(ProblemCode::status) {
        let words: Vec<&str> =
            codes.iter().filter(|code| code.status() == status).map(ProblemCode::word).collect();
        let response = &mut operation["responses"][status.to_string()];
        if response.is_null() {
            *response = json!({"description": words.join(", ")});
        }
        response["content"]["application/problem+json"]["schema"] = json!({
            "allOf": [{"$ref": "#/components/schemas/Problem"}, {"properties": {"code": {"enum": words}}}]
        });
    }
}

/// How a caller says who they are; any one of these.
fn security(method: &str, need: Need) -> Value {
    if need == Need::Anyone {
        return json!([]);
    }
    let person = if method == "get" { json!({"session": []}) } else { json!({"session": [], "csrf": []}) };
    match need {
        Need::Person | Need::Window | Need::Stop | Need::Manage => json!([person]),
        Need::Look if method == "get" => json!([person, {"token": []}, {"view_link": []}]),
        _ => json!([person, {"token": []}]),
    }
}

/// The problems that the handler names, and those that any handler like it has.
fn problems(method: &str, operation: &Value) -> Vec<ProblemCode> {
    let own = operation["x-cipdeck-problems"].as_array().into_iter().flatten();
    let mut codes: Vec<ProblemCode> =
        own.filter_map(Value::as_str).map(|word| word.to_owned().into()).collect();
    let parameters = operation["parameters"].as_array().into_iter().flatten();
    let mut has = |condition: bool, code: ProblemCode| {
        if condition && !codes.contains(&code) {
            codes.push(code);
        }
    };
    for parameter in parameters {
        has(parameter["in"] == "path", ProblemCode::NotFound);
        has(parameter["in"] == "query", ProblemCode::Unreadable);
    }
    let has_body = !operation["requestBody"].is_null();
    // What carries a body has to carry JSON.
    has(method != "get", ProblemCode::Unreadable);
    has(has_body, ProblemCode::TooLarge);
    // A token that is not good is told so everywhere, and several make whoever tries them wait.
    has(true, ProblemCode::SignedOut);
    has(true, ProblemCode::TooMany);
    // A foreign Host or Origin, or not the role.
    has(true, ProblemCode::NotPermitted);
    has(true, ProblemCode::Internal);
    has(true, ProblemCode::Unavailable);
    ProblemCode::ALL.into_iter().filter(|code| codes.contains(code)).collect()
}

/// A closed object inside of another one would forbid the members of the other one: they become one object.
fn join_closed(schemas: &mut Value) {
    let mut opened = Map::new();
    for (name, schema) in members(schemas).filter(|(_, schema)| schema["additionalProperties"] == false) {
        let mut schema = schema.clone();
        if let Some(members) = schema.as_object_mut() {
            members.remove("additionalProperties");
        }
        opened.insert(format!("#/components/schemas/{name}"), schema);
    }
    for (_, schema) in members(schemas) {
        for part in schema.get_mut("allOf").and_then(Value::as_array_mut).into_iter().flatten() {
            if let Some(opened) = part["$ref"].as_str().and_then(|name| opened.get(name)) {
                *part = opened.clone();
            }
        }
    }
}

/// Integers say their range, and words are without the marks of the code's own documentation.
fn polish(value: &mut Value) {
    if let Some(words) = value.get_mut("description")
        && let Some(text) = words.as_str()
    {
        *words = text.replace("[`", "`").replace("`]", "`").replace("\\[", "[").replace("\\]", "]").into();
    }
    if let Some((format, least, most)) = integer(value)
        && let Some(members) = value.as_object_mut()
    {
        members.insert("format".to_owned(), format.into());
        members.entry("minimum").or_insert(least);
        members.entry("maximum").or_insert(most);
    }
    match value {
        Value::Array(values) => values.iter_mut().for_each(polish),
        Value::Object(members) => members.values_mut().for_each(polish),
        _ => {}
    }
}

/// How an integer is kept, its smallest and its biggest number.
fn integer(schema: &Value) -> Option<(&'static str, Value, Value)> {
    let kind = schema.get("type")?;
    if kind != "integer" && !kind.as_array()?.iter().any(|kind| kind == "integer") {
        return None;
    }
    let unsigned = |format, most: u64| Some((format, 0.into(), most.into()));
    match schema.get("format").and_then(Value::as_str) {
        Some("int64") => Some(("int64", i64::MIN.into(), i64::MAX.into())),
        Some("u-int8") => unsigned("uint8", u8::MAX.into()),
        Some("u-int16") => unsigned("uint16", u16::MAX.into()),
        Some("u-int32") => unsigned("uint32", u32::MAX.into()),
        _ => unsigned("uint64", u64::MAX),
    }
}

#[cfg(test)]
mod tests;

//! The interface does what its own description promises: schemathesis, which nobody here wrote, reads
//! `/api/v1/openapi.json` and asks every entry point with what is described and with what is not, once for each role.

use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

use cipdeck_tests::block;
use cipdeck_tests::managed::Managed;
use cipdeck_tests::rest::Rest;
use cipdeck_tests::tools;
use cipdeck_tests::wait::within;
use reqwest::Method;
use serde_json::{Value, json};
use tokio::process::Command;

/// One role takes about a quarter of this on a machine that does nothing else.
const LIMIT: Duration = Duration::from_mins(3);

/// Of each entry point beside those at the limits of what is described, which are tried in any case.
const EXAMPLES: &str = "4";

/// What must hold for every answer.
const CHECKS: &str = "not_a_server_error,status_code_conformance,content_type_conformance,\
                      response_headers_conformance,response_schema_conformance,negative_data_rejection";

/// Left out: it waits for seconds and sends into the network of whoever runs the tests; it becomes something else than
/// HTTP; it signs the caller out.
const LEFT_OUT: [&str; 4] = ["post_discover", "get_ws", "get_live", "delete_session"];

/// Teaches schemathesis to make archives of projects.
const ARCHIVES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/python/archives.py");

#[tokio::test]
async fn a_viewer_gets_what_is_described() {
    let seen = [
        "GET /api/v1/blocks/{id} 200",
        "POST /api/v1/blocks/{id}/run 403",
        "GET /api/v1/groups/{id}/values 200",
        "GET /api/v1/project 200",
        "POST /api/v1/variables/{id}/offer 403",
    ];
    promises_hold_for("viewer", &seen).await;
}

#[tokio::test]
async fn an_operator_gets_what_is_described() {
    promises_hold_for("operator", &["POST /api/v1/blocks/{id}/run 200", "POST /api/v1/blocks 403"]).await;
}

#[tokio::test]
async fn an_engineer_gets_what_is_described() {
    let seen = [
        "POST /api/v1/blocks 201",
        "POST /api/v1/blocks 422",
        "PUT /api/v1/blocks/{id} 400",
        "POST /api/v1/blocks/{id}/in 200",
        "POST /api/v1/blocks/{id}/run 200",
        "POST /api/v1/blocks/{id}/run 404",
        "GET /api/v1/blocks/{id}/exchange.pcapng 200",
        "POST /api/v1/devices 201",
        "POST /api/v1/devices 422",
        "PUT /api/v1/devices/{id} 400",
        "POST /api/v1/devices/{id}/copy 201",
        "GET /api/v1/devices/{id}/browse 200",
        "POST /api/v1/groups/{id}/variables 201",
        "GET /api/v1/groups/{id}/variables.csv 200",
        "POST /api/v1/variables/{id}/offer 404",
        "GET /api/v1/audit 200",
        "GET /api/v1/history/trend 200",
        "POST /api/v1/project 200",
        "POST /api/v1/project 400",
        "POST /api/v1/project/folder 409",
        "POST /api/v1/users 403",
    ];
    promises_hold_for("engineer", &seen).await;
}

#[tokio::test]
async fn an_administrator_gets_what_is_described() {
    let seen = [
        "POST /api/v1/users 201",
        "PATCH /api/v1/users/{name} 200",
        "POST /api/v1/tokens 400",
        "POST /api/v1/view-links 201",
        "POST /api/v1/allow/targets 201",
        "PUT /api/v1/read-only 200",
        "POST /api/v1/blocks 403",
    ];
    promises_hold_for("admin", &seen).await;
}

/// `seen` are answers that must have come: otherwise this tests little.
async fn promises_hold_for(role: &str, seen: &[&str]) {
    let relay = Managed::start().await;
    // Somebody to be changed, and blocks to be asked for.
    let made = json!({ "name": "somebody", "role": "viewer", "password": "four words are enough" });
    assert_eq!(relay.admin.post("users", &made).await.status, 201);
    let engineer = relay.user("engineer").await;
    for _ in 0..4 {
        engineer.create(&block::product_name("0,0")).await;
    }
    plants(&engineer).await;
    let (caller, headers) = caller(&relay, role).await;
    let document = asked_for_what_is_there(caller.get("openapi.json").await.body);
    let file = relay.folder().join("openapi.json");
    std::fs::write(&file, document.to_string()).expect("the folder can be written");
    run_schemathesis(&relay.address, &file, &headers).await;

    let counted = Rest::send(caller.request(Method::GET, "../../metrics")).await.body;
    let counted = counted.as_str().expect("text");
    for answer in seen {
        let words: Vec<&str> = answer.split(' ').collect();
        let [method, route, status] = words[..] else { panic!("{answer}") };
        let line = format!("{{method=\"{method}\",route=\"{route}\",status=\"{status}\"}}");
        assert!(counted.contains(&line), "{role}: {answer} never came; what came:\n{counted}");
    }
}

/// Two devices, of which one may be deleted, each with a group and a variable. They are the relay's own: nobody is asked.
async fn plants(engineer: &Rest) {
    for name in ["stays", "goes"] {
        let device =
            engineer.post("devices", &json!({ "name": name, "path": "0,0", "profile": "omron" })).await;
        let group = json!({ "device": device.body["id"], "name": name });
        let group = engineer.post("groups", &group).await;
        let path = format!("groups/{}/variables", group.body["id"].as_str().expect("an id"));
        let variables = json!({ "variables": [{ "name": name, "address": "TAG1", "writable": true }] });
        assert_eq!(engineer.post(&path, &variables).await.status, 201);
    }
}

/// Somebody with a role, and the headers that say so. An administrator is a person, everybody else a program.
async fn caller(relay: &Managed, role: &str) -> (Rest, Vec<String>) {
    let (rest, names) = match role {
        "admin" => (relay.admin.clone(), &["cookie", "x-csrf-token"][..]),
        role => (Rest::new(&relay.address).with_token(&relay.token(role).await), &["authorization"][..]),
    };
    let headers = names.iter().map(|name| format!("{name}: {}", rest.header(name))).collect();
    (rest, headers)
}

/// The document with addresses of things that exist, and of some that do not. Nobody deletes what others ask for, or
/// the ground under their own feet.
fn asked_for_what_is_there(mut document: Value) -> Value {
    let paths = document["paths"].as_object_mut().expect("paths");
    for (path, methods) in paths {
        for (method, operation) in methods.as_object_mut().expect("methods") {
            let known = match (path.as_str(), method.as_str()) {
                ("/api/v1/blocks/{id}", "delete") => json!(["b3", "b4", "b999"]),
                (path, _) if path.starts_with("/api/v1/blocks/") => json!(["b1", "b2", "b999"]),
                ("/api/v1/devices/{id}", "delete") => json!(["d2", "d999"]),
                ("/api/v1/groups/{id}", "delete") => json!(["g2", "g999"]),
                ("/api/v1/variables/{id}", "delete") => json!(["v2", "v999"]),
                (path, _) if path.starts_with("/api/v1/devices/") => json!(["d1", "d999"]),
                (path, _) if path.starts_with("/api/v1/groups/") => json!(["g1", "g999"]),
                (path, _) if path.starts_with("/api/v1/variables/") => json!(["v1", "v999"]),
                ("/api/v1/users/{name}", _) => json!(["somebody", "nobody"]),
                (path, "delete") if path.ends_with("/{id}") => json!([900, 901]),
                _ => continue,
            };
            let parameters = operation["parameters"].as_array_mut().expect("parameters");
            let own = parameters.iter_mut().find(|parameter| parameter["in"] == "path").expect("its address");
            own["schema"] = json!({ "enum": known });
        }
    }
    document
}

async fn run_schemathesis(address: &str, document: &Path, headers: &[String]) {
    let mut command = Command::new(tools::schemathesis());
    command.arg("run").arg(document).args(["--url", &format!("http://{address}")]);
    for header in headers {
        command.args(["--header", header]);
    }
    command.args(["--checks", CHECKS, "--phases", "coverage,fuzzing", "--max-examples", EXAMPLES]);
    command.args(["--generation-with-security-parameters", "false", "--generation-deterministic"]);
    command.args(["--continue-on-failure", "--no-color", "--warnings", "off"]);
    command.args(["--request-timeout", "20"]);
    for operation in LEFT_OUT {
        command.args(["--exclude-operation-id", operation]);
    }
    command.env("SCHEMATHESIS_HOOKS", ARCHIVES);
    // It leaves files where it runs.
    command.current_dir(document.parent().expect("a folder"));
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).kill_on_drop(true);
    let output = within("schemathesis ends", LIMIT, command.output()).await.expect("schemathesis runs");
    let said = [output.stdout, output.stderr].concat();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&said));
}

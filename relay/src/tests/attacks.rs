//! What somebody would try who wants more than they may.

use cipdeck_shared::api::{ClientMessage, Role};
use serde_json::{Value, json};
use tokio::net::TcpListener;

use super::site::Site;
use crate::http::{NEEDS, Need};
use crate::permit::permit;

/// Every entry point, from the tables that the relay itself uses: a new one is tried, too.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_viewer_with_a_token_tries_every_route_and_every_message() {
    let site = Site::start(permit).await;
    let block = json!({
        "name": "a", "TargetCfg": { "Path": "0,0" },
        "AppCfg": { "Service": 14, "Class": 1, "Instance": 1, "Attribute": 7 },
    });
    let id = site.person(Role::Engineer).create(&block).await;
    let viewer = site.program(Role::Viewer).await;
    let mut refused = 0;
    for (method, route, need) in NEEDS {
        let Some(path) = route.strip_prefix("/api/v1/") else { continue };
        let path = path.replace("{id}", &id).replace("{name}", "admin");
        let body = if *method == "GET" { Value::Null } else { json!({}) };
        let (status, answer) = viewer.ask(method, &path, &body).await;
        if matches!(need, Need::Anyone | Need::Look) {
            assert_ne!(status, 403, "{method} {path}: {answer}");
        } else {
            refused += 1;
            assert_eq!(
                (status, &answer["code"]),
                (403, &json!("not_permitted")),
                "{method} {path}: {answer}"
            );
        }
    }
    assert!(refused > 20, "{refused} routes are not for viewers");
    let mut socket = viewer.watch().await;
    for kind in message_types() {
        for input in [true, false] {
            let mut command = json!({ "type": kind, "block": id });
            if kind == "in" {
                command["IN"] = json!(input);
            }
            let answer = socket.command(command).await;
            assert_eq!(answer["problem"]["code"], "not_permitted", "{kind}: {answer}");
        }
    }
    site.stop().await;
}

/// As the type itself names them.
fn message_types() -> Vec<String> {
    let error = serde_json::from_value::<ClientMessage>(json!({ "type": "?" })).unwrap_err().to_string();
    let (_, expected) = error.split_once("expected one of").expect("the names of all messages");
    let names: Vec<_> = expected.split('`').skip(1).step_by(2).map(str::to_owned).collect();
    assert!(names.len() >= 3, "{error}");
    names
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_hidden_write_is_refused_by_the_relay() {
    let site = Site::start(permit).await;
    let engineer = site.person(Role::Engineer);
    // Multiple_Service_Packet with an Unconnected_Send with a Set_Attribute_Single.
    let block = json!({
        "name": "a harmless packet",
        "AppCfg": { "Service": 0x0A, "Class": 2, "Instance": 1 },
        "TargetCfg": { "Path": format!("4,{}", site.device) },
        "ReqData": "01 00 04 00 52 02 20 06 24 01 05 9d 09 00 10 03 20 04 24 96 30 03 01 00 01 00 01 00",
    });
    let id = engineer.create(&block).await;
    for role in [Role::Operator, Role::Engineer, Role::Admin] {
        let (status, body) = site.person(role).ask("POST", &format!("blocks/{id}/run"), &Value::Null).await;
        assert_eq!((status, &body["code"]), (403, &json!("not_permitted")), "{role:?}: {body}");
    }
    assert_eq!(engineer.ask("POST", "window", &json!({})).await.0, 200);
    assert_eq!(site.person(Role::Operator).ticket(&id).await, None, "it is not on the list");
    assert!(engineer.ticket(&id).await.is_some());
    site.stop().await;
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_replayed_command_is_refused() {
    let site = Site::start(permit).await;
    let engineer = site.person(Role::Engineer);
    let id = engineer.create(&write(&site)).await;
    assert_eq!(engineer.ask("POST", "window", &json!({})).await.0, 200);
    let path = format!("blocks/{id}/run");
    let command = json!({ "ticket": engineer.ticket(&id).await.unwrap() });
    let (status, body) = engineer.ask("POST", &path, &command).await;
    assert_eq!(
        (status, &body["Q"], &body["written"]["is_equal"]),
        (200, &json!(true), &json!(true)),
        "{body}"
    );
    for _ in 0..3 {
        let (status, body) = engineer.ask("POST", &path, &command).await;
        assert_eq!((status, &body["code"]), (403, &json!("not_permitted")), "{body}");
    }
    // Nor does somebody else's ticket help, as capable as they may be.
    let colleague = site.person(Role::Admin).hire("eve", Role::Engineer).await;
    let command = json!({ "ticket": engineer.ticket(&id).await.unwrap() });
    assert_eq!(colleague.ask("POST", &path, &command).await.0, 403);
    let (_, status) = engineer.ask("GET", &format!("blocks/{id}/status"), &Value::Null).await;
    assert_eq!(status["runs"], 1, "{status}");
    site.stop().await;
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn no_socket_is_opened_to_a_target_that_is_not_allowed() {
    let site = Site::start(permit).await;
    let engineer = site.person(Role::Engineer);
    let trap = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let port = trap.local_addr().unwrap().port();
    for path in [
        format!("4,127.0.0.1:{port}"),
        format!("4,localhost:{port}"),
        format!("4,localhost.:{port}"),
        format!("4,0.0.0.0:{port}"),
    ] {
        let mut block = write(&site);
        block["TargetCfg"]["Path"] = json!(path);
        block["AppCfg"]["Service"] = json!(14);
        block["ReqData"] = json!("");
        let (status, body) = engineer.ask("POST", "blocks", &block).await;
        if status != 201 {
            assert_eq!(body["code"], "findings", "{path}: {body}");
            continue;
        }
        let id = body["id"].as_str().unwrap();
        let (status, body) = engineer.ask("POST", &format!("blocks/{id}/run"), &Value::Null).await;
        assert_eq!((status, &body["code"]), (403, &json!("not_permitted")), "{path}: {body}");
    }
    let knocked = tokio::time::timeout(std::time::Duration::from_millis(200), trap.accept()).await;
    assert!(knocked.is_err(), "somebody has connected");
    site.stop().await;
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_name_of_this_machine_is_not_reached() {
    let site = Site::start(permit).await;
    let (admin, engineer) = (site.person(Role::Admin), site.person(Role::Engineer));
    let trap = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let port = trap.local_addr().unwrap().port();
    // Even an administrator who allows the name has not allowed what it stands for.
    let rule = json!({ "target": format!("localhost:{port}") });
    assert_eq!(admin.ask("POST", "allow/targets", &rule).await.0, 201);
    let mut block = write(&site);
    block["TargetCfg"]["Path"] = json!(format!("4,localhost:{port}"));
    block["AppCfg"]["Service"] = json!(14);
    block["ReqData"] = json!("");
    let id = engineer.create(&block).await;
    let (status, body) = engineer.ask("POST", &format!("blocks/{id}/run"), &Value::Null).await;
    assert_eq!((status, &body["cause"]["what"]), (200, &json!("not_permitted")), "{body}");
    let detail = body["cause"]["detail"].as_str().unwrap();
    assert!(detail.contains("the relay's own machine"), "{detail}");
    let knocked = tokio::time::timeout(std::time::Duration::from_millis(200), trap.accept()).await;
    assert!(knocked.is_err(), "somebody has connected");
    site.stop().await;
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn the_relay_does_not_call_itself() {
    let site = Site::start(permit).await;
    let (admin, engineer) = (site.person(Role::Admin), site.person(Role::Engineer));
    let rule = json!({ "target": "127.0.0.1:*" });
    assert_eq!(admin.ask("POST", "allow/targets", &rule).await.0, 201);
    let mut block = write(&site);
    block["TargetCfg"]["Path"] = json!(format!("4,{}", site.address));
    block["AppCfg"]["Service"] = json!(14);
    block["ReqData"] = json!("");
    let id = engineer.create(&block).await;
    let (status, body) = engineer.ask("POST", &format!("blocks/{id}/run"), &Value::Null).await;
    assert_eq!((status, &body["code"]), (403, &json!("not_permitted")), "{body}");
    assert!(body["detail"].as_str().unwrap().contains("the relay itself"), "{body}");
    site.stop().await;
}

/// A write that is on the operators' list.
fn write(site: &Site) -> Value {
    json!({
        "name": "write",
        "AppCfg": { "Service": 16, "Class": 4, "Instance": 150, "Attribute": 3 },
        "TargetCfg": { "Path": format!("4,{}", site.device) },
        "ReqData": "05".repeat(32),
    })
}

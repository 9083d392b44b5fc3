//! Roles by entry points by what is sent: as docs/SECURITY-MODEL.md has it, and another one without `permit`.

use cipdeck_shared::api::Role;
use serde_json::{Value, json};

use super::site::{Person, Site};
use crate::permit::permit;

/// What is sent.
const SENT: [&str; 5] = ["read", "listed write", "other write", "unknown service", "other target"];

/// How it is commanded.
const ENTRIES: [&str; 6] =
    ["REST run", "REST in", "cyclic in", "WebSocket run", "WebSocket in", COMMAND_LINE];

/// `cipdeck --relay URL run FILE`: stores a block, which engineers may; with a token, which people do not have.
const COMMAND_LINE: &str = "command line";

/// Who may send what, in the order of [`SENT`].
const fn designed(role: Role) -> [bool; 5] {
    match role {
        Role::Viewer => [false, false, false, false, false],
        Role::Operator => [true, true, false, false, false],
        Role::Engineer => [true, true, true, true, false],
        Role::Admin => [true, false, false, false, false],
    }
}

/// Caller, entry point, what was sent of [`SENT`].
type Row = (String, &'static str, [bool; 5]);

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn roles_by_entry_points() {
    let rows = matrix(Site::start(permit).await).await;
    print(&rows);
    for (caller, entry, sent) in &rows {
        let role = Role::ALL.into_iter().find(|role| caller.starts_with(role.word())).unwrap();
        let may_store = *entry != COMMAND_LINE || role.may_edit();
        let expected = if may_store { designed(role) } else { [false; 5] };
        assert_eq!(*sent, expected, "{caller}, {entry}: {SENT:?}");
    }
    assert_eq!(rows.len(), 4 * (ENTRIES.len() - 1) + 3 * ENTRIES.len());
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn without_permit_the_matrix_is_another_one() {
    let rows = matrix(Site::start(|_, _| Ok(())).await).await;
    print(&rows);
    let differs = |(caller, _, sent): &Row| {
        Role::ALL.into_iter().any(|role| caller.starts_with(role.word()) && *sent != designed(role))
    };
    // Where an engineer is let in by the store of blocks there is nothing left that permit would forbid.
    for entry in ENTRIES.into_iter().filter(|entry| *entry != COMMAND_LINE) {
        assert!(rows.iter().any(|row| row.1 == entry && differs(row)), "{entry} does not depend on permit");
    }
}

async fn matrix(site: Site) -> Vec<Row> {
    let engineer = site.person(Role::Engineer);
    let opened = engineer.ask("POST", "window", &json!({})).await;
    assert_eq!(opened.0, 200, "{}", opened.1);
    let mut rows = Vec::new();
    for role in Role::ALL {
        let person = site.person(role).clone();
        row(&site, &mut rows, role.word().to_owned(), &person).await;
        if role != Role::Admin {
            row(&site, &mut rows, format!("{} token", role.word()), &site.program(role).await).await;
        }
    }
    site.stop().await;
    rows
}

async fn row(site: &Site, rows: &mut Vec<Row>, caller: String, person: &Person) {
    for entry in ENTRIES {
        if entry == COMMAND_LINE && !caller.ends_with("token") {
            continue;
        }
        let mut sent = [false; 5];
        for (what, sent) in SENT.into_iter().zip(&mut sent) {
            *sent = is_sent(site, person, entry, what).await;
        }
        rows.push((caller.clone(), entry, sent));
    }
}

/// Tries as hard as the caller can: with a ticket where they get one.
async fn is_sent(site: &Site, person: &Person, entry: &str, what: &str) -> bool {
    if entry == COMMAND_LINE {
        let code = person.command_line(&block(site, what, false)).await.expect("a token");
        // 0: done. 3: the device does not know it. 2: it cannot be asked. 4: refused.
        assert!(matches!(code, 0 | 2 | 3 | 4), "{what}: exit code {code}");
        return matches!(code, 0 | 3);
    }
    let engineer = site.person(Role::Engineer);
    let id = engineer.create(&block(site, what, entry == "cyclic in")).await;
    let ticket =
        if what.contains("write") || what.contains("unknown") { person.ticket(&id).await } else { None };
    let mut command = json!({});
    if let Some(ticket) = ticket {
        command["ticket"] = json!(ticket);
    }
    if entry.ends_with("in") {
        command["IN"] = json!(true);
    }
    let problem = if entry.starts_with("WebSocket") {
        command["type"] = json!(entry.rsplit(' ').next().unwrap());
        command["block"] = json!(id);
        person.watch().await.command(command).await["problem"].clone()
    } else {
        let path = format!("blocks/{id}/{}", if entry == "REST run" { "run" } else { "in" });
        let (status, body) = person.ask("POST", &path, &command).await;
        if status == 200 { Value::Null } else { body }
    };
    let is_sent = if problem.is_null() {
        let ended = |status: &Value| matches!(status["phase"].as_str(), Some("done" | "failed"));
        let status = engineer.status_where(&id, ended).await;
        // The device has done it, or has answered that it does not know it.
        let has_answered = matches!(status["Status"]["ErrorID"].as_u64(), Some(0 | 224));
        assert!(has_answered || status["cause"]["what"] == "not_permitted", "{entry}, {what}: {status}");
        has_answered
    } else {
        assert_eq!(problem["code"], "not_permitted", "{entry}, {what}: {problem}");
        false
    };
    let (status, body) = engineer.ask("DELETE", &format!("blocks/{id}?revision=1"), &Value::Null).await;
    assert_eq!(status, 204, "{body}");
    is_sent
}

fn block(site: &Site, what: &str, is_cyclic: bool) -> Value {
    let (service, class, instance, attribute, data) = match what {
        "read" | "other target" => (14, 1, 1, 7, String::new()),
        "listed write" => (16, 4, 150, 3, "01".repeat(32)),
        "other write" => (16, 4, 151, 3, "01".to_owned()),
        _ => (0x4B, 0x93, 1, 0, String::new()),
    };
    let target = if what == "other target" { site.other } else { site.device };
    json!({
        "name": what,
        "AppCfg": { "Service": service, "Class": class, "Instance": instance, "Attribute": attribute },
        "TargetCfg": { "Path": format!("4,{target}") },
        "CtrlCfg": { "TriggerType": if is_cyclic { 20 } else { 0 } },
        "ReqData": data,
    })
}

fn print(rows: &[Row]) {
    println!("{:<16} {:<14} {}", "caller", "entry point", SENT.map(|what| format!("{what:<16}")).join(" "));
    for (caller, entry, sent) in rows {
        let cells = sent.map(|sent| format!("{:<16}", if sent { "sent" } else { "no" })).join(" ");
        println!("{caller:<16} {entry:<14} {cells}");
    }
}

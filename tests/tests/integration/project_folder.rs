//! The folder of a project that somebody else changes while a relay keeps it, and a relay that ends in the middle of a
//! change.

use std::fs;
use std::path::Path;

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::command::{Service, cipdeck};
use cipdeck_tests::relay::Relay;
use cipdeck_tests::rest::{Reply, Rest};
use cipdeck_tests::viewer::Viewer;
use cipdeck_tests::wait::eventually_every;
use reqwest::Method;
use serde_json::{Value, json};
use std::time::Duration;
use tempfile::TempDir;

use super::project::{commit, git, plant, save, serve, stop, utf8};

#[tokio::test]
async fn a_folder_that_was_changed_is_read_again_after_a_look() {
    let folder = TempDir::new().expect("a temporary folder");
    git(&folder, &["init", "-q"]).await;
    let relay = Service::serve_project(folder.path(), None).await;
    let rest = Rest::new(&relay.address);
    for name in ["changes", "goes", "runs", "stays"] {
        rest.create(&with(block::product_name("0,0"), "/name", name)).await;
    }
    let group = plant(&rest).await;
    save(&rest, "blocks/b3", |block| block["CtrlCfg"]["TriggerType"] = json!(100)).await;
    save(&rest, "blocks/b4", |block| block["CtrlCfg"]["TriggerType"] = json!(100)).await;
    for id in ["b3", "b4"] {
        assert_eq!(rest.post(&format!("blocks/{id}/in"), &json!({ "IN": true })).await.status, 200);
    }
    commit(&folder).await;
    let mut viewer = Viewer::connect(&relay.address).await;

    // As `git checkout` of another branch.
    edit(&folder, "blocks/changes.json", "\"Attribute\": 7", "\"Attribute\": 6");
    edit(&folder, "blocks/runs.json", "\"Attribute\": 7", "\"Attribute\": 1");
    fs::remove_file(folder.path().join("blocks/goes.json")).expect("removed");
    let text = fs::read_to_string(folder.path().join("blocks/stays.json")).expect("a file");
    fs::write(folder.path().join("blocks/new.json"), text.replace("stays", "new")).expect("a new one");
    edit(&folder, "groups/nx-1/line-4.json", "\"1/min\"", "\"rpm\"");
    let mine = with(rest.get("blocks/b1").await.body, "/AppCfg/Attribute", 5);
    let refused = rest.put("blocks/b1", &mine).await;
    refused.is_problem(409, "conflict");
    let way = refused.body["detail"].as_str().unwrap_or_default();
    assert!(way.contains("POST /api/v1/project/folder"), "{way}");

    let before = rest.get("blocks").await.body;
    let preview = read_again(&rest, "?preview=true").await;
    assert_eq!((preview.status, &preview.body["stored"]), (200, &json!(false)), "{preview:?}");
    let expected = [
        "block changed changes AppCfg.Attribute: 7 → 6",
        "block created new ",
        "block changed runs it runs, and is stopped; AppCfg.Attribute: 7 → 1",
        "block unchanged stays ",
        "block removed goes ",
        "target unchanged NX 1 ",
        "group changed line 4 variables: 0 created, 1 changed, 0 removed",
    ];
    assert_eq!(parts(&preview), expected);
    assert_eq!(rest.get("blocks").await.body, before, "only looked at");
    assert_eq!(rest.get("blocks/b3/status").await.body["IN"], true);

    // What is taken is what was seen.
    let seen = preview.body["seen"].as_str().expect("a digest").to_owned();
    edit(&folder, "cipdeck.json", "\"name\": \"", "\"name\": \"x");
    read_again(&rest, &format!("?seen={seen}")).await.is_problem(409, "conflict");
    assert_eq!(rest.get("blocks").await.body, before);
    let seen = read_again(&rest, "?preview=true").await.body["seen"].as_str().expect("a digest").to_owned();
    let done = read_again(&rest, &format!("?seen={seen}")).await;
    assert_eq!((done.status, &done.body["stored"]), (200, &json!(true)), "{done:?}");
    assert_eq!(parts(&done), expected);

    assert_eq!(rest.get("blocks/b1").await.body["AppCfg"]["Attribute"], 6);
    rest.get("blocks/b2").await.is_problem(404, "not_found");
    let on = async |id: &str| rest.get(&format!("blocks/{id}/status")).await.body["IN"].clone();
    assert_eq!((on("b3").await, on("b4").await), (json!(false), json!(true)), "what is the same goes on");
    assert_eq!(rest.run("b5").await["Q"], true, "what is new runs");
    assert_eq!(rest.get(&format!("groups/{group}/variables")).await.body[1]["unit"], "rpm");
    viewer
        .wait_until("a viewer sees the same blocks", PATIENCE, |viewer| {
            let seen: Vec<_> = viewer.blocks.keys().map(String::as_str).collect();
            (seen == ["b1", "b3", "b4", "b5"]).then_some(())
        })
        .await;
    let audit = rest.get("audit").await.body.to_string();
    assert!(audit.contains("block_deleted") && audit.contains("plant_changed"), "{audit}");

    // Saving works again, and nothing else is written.
    commit(&folder).await;
    save(&rest, "blocks/b1", |block| block["AppCfg"]["Attribute"] = json!(5)).await;
    assert_eq!(git(&folder, &["diff", "--numstat"]).await, "1\t1\tblocks/changes.json\n");
    let again = read_again(&rest, "").await;
    assert!(again.status == 200 && parts(&again).iter().all(|part| part.contains("unchanged")), "{again:?}");
}

#[tokio::test]
async fn what_is_gone_from_the_folder_is_gone_with_all_that_belongs_to_it() {
    let folder = TempDir::new().expect("a temporary folder");
    let relay = Service::serve_project(folder.path(), None).await;
    let rest = Rest::new(&relay.address);
    let group = plant(&rest).await;
    fs::remove_file(folder.path().join("targets/nx-1.json")).expect("removed");
    let torn = read_again(&rest, "").await;
    torn.is_problem(422, "findings");
    assert!(torn.body["findings"].to_string().contains("there is no targets/nx-1.json"), "{torn:?}");
    fs::remove_dir_all(folder.path().join("groups")).expect("removed");
    let done = read_again(&rest, "").await;
    assert_eq!(parts(&done), ["target removed NX 1 with its groups: line 4"]);
    assert_eq!(rest.get("devices").await.body, json!({ "devices": [], "groups": [] }));
    rest.get(&format!("groups/{group}/values")).await.is_problem(404, "not_found");
    rest.get("devices/d1/status").await.is_problem(404, "not_found");
    plant(&rest).await;
    fs::remove_file(folder.path().join("groups/nx-1/line-4.json")).expect("removed");
    let done = read_again(&rest, "").await;
    assert_eq!(parts(&done), ["target unchanged NX 1 ", "group removed line 4 variables: 2 removed"]);
    assert_eq!(rest.get("devices").await.body["groups"], json!([]));
}

#[tokio::test]
async fn a_folder_that_cannot_be_read_changes_nothing_and_says_where() {
    let folder = TempDir::new().expect("a temporary folder");
    let relay = Service::serve_project(folder.path(), None).await;
    let rest = Rest::new(&relay.address);
    rest.create(&with(block::product_name("0,0"), "/name", "a")).await;
    rest.create(&with(block::product_name("0,0"), "/name", "b")).await;
    let before = rest.get("blocks").await.body;
    edit(&folder, "blocks/a.json", "\"Attribute\": 7", "\"Attribute\": \"7\"");
    fs::write(folder.path().join("blocks/b.json"), [0xFF]).expect("a file");
    let refused = read_again(&rest, "").await;
    refused.is_problem(422, "findings");
    assert!(refused.body["findings"].to_string().contains("blocks/b.json:1:1"), "{refused:?}");
    fs::write(folder.path().join("blocks/b.json"), "{").expect("a file");
    let preview = read_again(&rest, "?preview=true").await;
    let fields: Vec<_> = preview.body["findings"].as_array().into_iter().flatten().collect();
    assert_eq!((preview.status, fields.len()), (200, 2), "{preview:?}");
    assert_eq!(rest.get("blocks").await.body, before);

    // Wrong numbers are taken as they are, as at the start, and said.
    fs::remove_file(folder.path().join("blocks/b.json")).expect("removed");
    edit(&folder, "blocks/a.json", "\"Attribute\": \"7\"", "\"Attribute\": 70000");
    let done = read_again(&rest, "").await;
    assert_eq!(parts(&done), ["block changed a AppCfg.Attribute: 7 → 70000", "block removed b "]);
    assert!(done.body["findings"].to_string().contains("AppCfg.Attribute"), "{done:?}");
    assert_eq!(rest.run("b1").await["Status"]["ErrorID"], 33);

    fs::remove_file(folder.path().join("cipdeck.json")).expect("removed");
    let refused = read_again(&rest, "").await;
    refused.is_problem(409, "conflict");
    assert!(refused.body.to_string().contains("is it the right folder?"), "{refused:?}");
    for wrong in ["?preview=yes", "?preview=true&preview=true", "?sen=1"] {
        read_again(&rest, wrong).await.is_problem(400, "unreadable");
    }
    read_again(&Relay::start().await.rest, "").await.is_problem(409, "conflict");
}

/// Groups of the device that is renamed: enough, that a relay can be stopped in between.
const GROUPS: usize = 60;

#[tokio::test]
async fn a_relay_that_is_killed_while_it_renames_a_device_leaves_it_there_once() {
    let (folder, data) = (TempDir::new().expect("a folder"), TempDir::new().expect("a folder"));
    let mut relay = Service::serve_project(folder.path(), Some(data.path())).await;
    let rest = Rest::new(&relay.address);
    plant(&rest).await;
    for number in 1..GROUPS {
        let group = json!({ "device": "d1", "name": format!("more {number}") });
        assert_eq!(rest.post("groups", &group).await.status, 201);
    }
    let before = rest.get("devices").await.body;
    let device = with(rest.get("devices/d1").await.body, "/name", "other");
    let rename = tokio::spawn({
        let request = rest.request(Method::PUT, "devices/d1").json(&device);
        async move { request.send().await.map(|answer| answer.status().as_u16()) }
    });
    let new = folder.path().join("groups/other");
    eventually_every(Duration::from_micros(100), "the first files are there", PATIENCE, async || {
        new.exists().then_some(())
    })
    .await;
    relay.process.kill();
    relay.process.ended(PATIENCE).await;
    let answered = rename.await.expect("it ends").is_ok();

    // The journal tells whoever looks, too.
    if folder.path().join(".cipdeck-change.json").exists() {
        let checked = cipdeck(&["project", "check", utf8(folder.path())]).await;
        assert!(checked.code == 2 && checked.stderr.contains("was interrupted"), "{checked:?}");
    }
    let mut relay = Service::serve_project(folder.path(), Some(data.path())).await;
    let rest = Rest::new(&relay.address);
    let after = rest.get("devices").await.body;
    let name = after["devices"][0]["name"].as_str().unwrap_or_default();
    assert!(!answered || name == "other", "what was acknowledged is there");
    assert_eq!(after["groups"], before["groups"], "the same ones, once, under the same ids");
    assert_eq!(after["devices"].as_array().map(Vec::len), Some(1), "{after}");
    let path = if name == "other" { "groups/other" } else { "groups/nx-1" };
    assert_eq!(fs::read_dir(folder.path().join("groups")).expect("a folder").count(), 1);
    assert_eq!(fs::read_dir(folder.path().join(path)).expect("a folder").count(), GROUPS);
    assert_eq!(hidden(folder.path()), Vec::<String>::new());
    stop(&mut relay).await;
}

#[tokio::test]
async fn what_is_left_of_an_interrupted_change_is_not_guessed() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("cipdeck.json"), "{\"project\": 1}").expect("a file");
    let journal = folder.path().join(".cipdeck-change.json");
    let sides = |before: &str| json!({ "change": "x", "files": { "cipdeck.json": { "before": before, "after": "{}" } } });
    for (text, told) in [
        ("{".to_owned(), "Put the files in order yourself"),
        (sides("{\"project\": 1, \"name\": \"y\"}").to_string(), "somebody has changed cipdeck.json since"),
    ] {
        fs::write(&journal, text).expect("a file");
        let refused = serve(folder.path(), None).await;
        assert!(refused.code == 2 && refused.stderr.contains(told), "{refused:?}");
        assert!(refused.stderr.contains(".cipdeck-change.json"), "{refused:?}");
        assert!(journal.exists(), "nothing was touched");
    }
}

async fn read_again(rest: &Rest, query: &str) -> Reply {
    Rest::send(rest.request(Method::POST, &format!("project/folder{query}"))).await
}

/// `block changed drive AppCfg.Attribute: 7 → 6`
fn parts(reply: &Reply) -> Vec<String> {
    let word = |part: &Value, name: &str| part[name].as_str().unwrap_or_default().to_owned();
    let words = |part: &Value| ["what", "how", "name", "detail"].map(|name| word(part, name)).join(" ");
    reply.body["parts"].as_array().unwrap_or_else(|| panic!("{reply:?}")).iter().map(words).collect()
}

/// As with an editor.
fn edit(folder: &TempDir, path: &str, from: &str, to: &str) {
    let file = folder.path().join(path);
    let text = fs::read_to_string(&file).expect("the file");
    assert!(text.contains(from), "{path} has no {from}: {text}");
    fs::write(&file, text.replace(from, to)).expect("the file is changed");
}

/// What the relay has left behind, anywhere.
fn hidden(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.')) {
            found.push(path.display().to_string());
        } else if path.is_dir() {
            found.extend(hidden(&path));
        }
    }
    found
}

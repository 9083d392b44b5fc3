//! A project: a folder under version control that a relay keeps, and archives that go from relay to relay.

use std::fs;
use std::io::{Cursor, Write};
use std::path::Path;

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::command::{Ended, Service, cipdeck, program};
use cipdeck_tests::relay::Relay;
use cipdeck_tests::rest::{Reply, Rest};
use reqwest::Method;
use serde_json::{Value, json};
use tempfile::TempDir;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

#[tokio::test]
async fn a_save_without_a_change_is_no_difference_and_a_change_is_one_line() {
    let folder = TempDir::new().expect("a temporary folder");
    git(&folder, &["init", "-q"]).await;
    let relay = Service::serve_project(folder.path(), None).await;
    let rest = Rest::new(&relay.address);
    let block = with(block::product_name("0,0"), "/Colour", json!({ "known to": ["somebody else", 0.1] }));
    let block = with(block, "/AppCfg/Extended", true);
    let id = rest.create(&with(block, "/name", "Förderband 3")).await;
    let group = plant(&rest).await;
    commit(&folder).await;
    let listed = git(&folder, &["ls-files"]).await;
    assert_eq!(
        listed.lines().collect::<Vec<_>>(),
        ["blocks/f-rderband-3.json", "cipdeck.json", "groups/nx-1/line-4.json", "targets/nx-1.json"]
    );

    // Everything is saved as it is.
    save(&rest, &format!("blocks/{id}"), |_| ()).await;
    save(&rest, "devices/d1", |_| ()).await;
    let tree = rest.get("devices").await.body;
    assert_eq!(rest.put(&format!("groups/{group}"), &tree["groups"][0]).await.status, 200);
    for variable in rest.get(&format!("groups/{group}/variables")).await.body.as_array().expect("variables") {
        let path = format!("variables/{}", variable["id"].as_str().expect("an id"));
        assert_eq!(rest.put(&path, variable).await.status, 200);
    }
    assert_eq!(git(&folder, &["status", "--porcelain"]).await, "");

    save(&rest, &format!("blocks/{id}"), |block| block["AppCfg"]["Attribute"] = json!(6)).await;
    assert_eq!(git(&folder, &["diff", "--numstat"]).await, "1\t1\tblocks/f-rderband-3.json\n");
    let text = fs::read_to_string(folder.path().join("blocks/f-rderband-3.json")).expect("the file");
    let written: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(written["Colour"], json!({ "known to": ["somebody else", 0.1] }));
    assert_eq!((&written["AppCfg"]["Extended"], written.get("id")), (&json!(true), None));
    // One more variable is its lines alone.
    commit(&folder).await;
    let more = json!({ "variables": [{ "name": "run", "address": "run" }] });
    assert_eq!(rest.post(&format!("groups/{group}/variables"), &more).await.status, 201);
    let difference = git(&folder, &["diff", "--numstat"]).await;
    assert_eq!(difference, "6\t0\tgroups/nx-1/line-4.json\n", "{}", git(&folder, &["diff"]).await);
}

#[tokio::test]
async fn an_edit_by_hand_is_not_overwritten() {
    let folder = TempDir::new().expect("a temporary folder");
    git(&folder, &["init", "-q"]).await;
    let relay = Service::serve_project(folder.path(), None).await;
    let rest = Rest::new(&relay.address);
    rest.create(&with(block::product_name("0,0"), "/name", "a")).await;
    rest.create(&with(block::product_name("0,0"), "/name", "b")).await;
    commit(&folder).await;
    let file = folder.path().join("blocks/a.json");
    let by_hand =
        fs::read_to_string(&file).expect("the file").replace("\"Attribute\": 7", "\"Attribute\": 6");
    fs::write(&file, &by_hand).expect("the file is changed");

    let before = rest.get("blocks").await.body;
    let changed = with(rest.get("blocks/b1").await.body, "/AppCfg/Attribute", 1);
    let refused = rest.put("blocks/b1", &changed).await;
    refused.is_problem(409, "conflict");
    let detail = refused.body["detail"].as_str().unwrap_or_default();
    assert!(detail.contains("blocks/a.json") && detail.contains("git checkout"), "{detail}");
    rest.delete("blocks/b1?revision=1").await.is_problem(409, "conflict");
    assert_eq!(rest.get("blocks").await.body, before, "nothing was stored");
    assert_eq!(fs::read_to_string(&file).expect("the file"), by_hand);
    save(&rest, "blocks/b2", |block| block["AppCfg"]["Attribute"] = json!(1)).await;

    git(&folder, &["checkout", "-q", "--", "blocks/a.json"]).await;
    assert_eq!(rest.put("blocks/b1", &changed).await.status, 200, "as the conflict has said");
}

#[tokio::test]
async fn at_a_restart_the_files_are_the_truth_and_ids_stay() {
    let (folder, data) = (TempDir::new().expect("a folder"), TempDir::new().expect("a folder"));
    let mut relay = Service::serve_project(folder.path(), Some(data.path())).await;
    let rest = Rest::new(&relay.address);
    for name in ["a", "b", "c"] {
        rest.create(&with(block::product_name("0,0"), "/name", name)).await;
    }
    plant(&rest).await;
    let devices = rest.get("devices").await.body;
    let variables = rest.get("groups/g1/variables").await.body;
    stop(&mut relay).await;

    let at = |name: &str| folder.path().join(format!("blocks/{name}.json"));
    let text = fs::read_to_string(at("a")).expect("a file");
    fs::write(at("a"), text.replace("\"Attribute\": 7", "\"Attribute\": 6")).expect("changed");
    fs::rename(at("b"), at("moved")).expect("renamed");
    fs::remove_file(at("c")).expect("removed");
    // As somebody writes it, and as wrong as somebody writes it.
    fs::write(
        at("Hand made"),
        json!({ "name": "d", "AppCfg": { "Service": 300, "Class": 1, "Instance": 1 },
        "TargetCfg": { "Path": "0,0" } })
        .to_string(),
    )
    .expect("a new one");
    let mut relay = Service::serve_project(folder.path(), Some(data.path())).await;
    let rest = Rest::new(&relay.address);
    let blocks = rest.get("blocks").await.body;
    let seen: Vec<_> = blocks
        .as_array()
        .expect("blocks")
        .iter()
        .map(|block| {
            (
                block["id"].as_str().unwrap_or_default(),
                block["revision"].as_u64(),
                block["name"].as_str().unwrap_or_default(),
            )
        })
        .collect();
    assert_eq!(seen, [("b1", Some(2), "a"), ("b2", Some(1), "b"), ("b4", Some(1), "d")]);
    assert_eq!(blocks[0]["AppCfg"]["Attribute"], 6);
    let status = rest.run("b4").await;
    assert_eq!(
        (&status["Status"]["ErrorID"], &status["cause"]["what"]),
        (&json!(33), &json!("invalid")),
        "{status}"
    );
    assert_eq!(rest.get("devices").await.body, devices);
    assert_eq!(rest.get("groups/g1/variables").await.body, variables);
    let output = relay.process.output().join("\n");
    for told in
        ["blocks/Hand made.json:1:", "file=\"blocks/a.json\"", "how=Changed", "how=Removed", "how=Created"]
    {
        assert!(output.contains(told), "{told}\n{output}");
    }
    stop(&mut relay).await;

    // The folder is away: nothing is lost.
    let empty = TempDir::new().expect("a folder");
    let refused = serve(empty.path(), Some(data.path())).await;
    assert_eq!(refused.code, 2, "{refused:?}");
    assert!(refused.stderr.contains("is it the right folder?"), "{refused:?}");
}

#[tokio::test]
async fn a_file_that_cannot_be_read_stops_the_start_with_its_place() {
    let folder = TempDir::new().expect("a folder");
    let write = |path: &str, text: &str| {
        let file = folder.path().join(path);
        fs::create_dir_all(file.parent().expect("a folder")).expect("a folder");
        fs::write(file, text).expect("a file");
    };
    write("cipdeck.json", "{\"project\": 1}");
    write(
        "blocks/a.json",
        "{\n  \"name\": \"a\",\n  \"AppCfg\": {\"Service\": \"14\", \"Class\": 1, \"Instance\": 1},\n  \"TargetCfg\": {\"Path\": \"0,0\"}\n}\n",
    );
    write("blocks/b.json", "{\n  \"name\": \"b\"\n");
    write("groups/nx/line.json", "{\"name\": \"line\"}");
    let refused = serve(folder.path(), None).await;
    assert_eq!(refused.code, 2, "{refused:?}");
    let expected = [
        "blocks/a.json:3:25: invalid type: string \"14\", expected i64",
        "blocks/b.json:3:1: this is not JSON",
        "groups/nx/line.json: this is a group of the target `nx`, and there is no targets/nx.json",
    ];
    for told in expected {
        assert!(refused.stderr.contains(told), "{told}\n{}", refused.stderr);
    }
    let checked = cipdeck(&["project", "check", utf8(folder.path())]).await;
    assert_eq!(checked.code, 2, "{checked:?}");
    for told in expected {
        assert!(checked.stdout.contains(told), "{told}\n{}", checked.stdout);
    }
    write("cipdeck.json", "{\"project\": 2}");
    let refused = serve(folder.path(), None).await;
    assert!(refused.code == 2 && refused.stderr.contains("use a newer cipdeck"), "{refused:?}");
}

#[tokio::test]
async fn a_file_of_a_project_runs_from_the_command_line() {
    let folder = TempDir::new().expect("a folder");
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    let relay = Service::serve_project(folder.path(), None).await;
    let rest = Rest::new(&relay.address);
    rest.create(&with(block::product_name(&format!("4,{}", device.address)), "/name", "Product name")).await;
    let words = json!({ "name": "words", "kind": "SEND_REQ", "Address": "ADDR('0.2.0.0.0.0.0')",
        "Data_to_Send": "0000 030E 0120 0124 0730", "Management_Param": [0, 0, 30, 10] });
    rest.create(&words).await;
    let file = folder.path().join("blocks/product-name.json");
    let checked = cipdeck(&["check", utf8(&file), "--json"]).await;
    assert_eq!((checked.code, &checked.json()["request"]), (0, &json!("0e03200124013007")), "{checked:?}");
    let ran = cipdeck(&["run", utf8(&file), "--json"]).await;
    assert_eq!((ran.code, &ran.json()["Q"]), (0, &json!(true)), "{ran:?}");
    let ran = cipdeck(&["run", utf8(&folder.path().join("blocks/words.json")), "--json"]).await;
    assert_eq!(ran.code, 0, "{ran:?}");
    let checked = cipdeck(&["project", "check", utf8(folder.path())]).await;
    assert_eq!(
        (checked.code, checked.stdout.lines().last()),
        (0, Some("2 blocks, 0 targets, 0 groups: 0 errors"))
    );
}

#[tokio::test]
async fn an_archive_takes_everything_to_another_relay() {
    let (one, other) = (Relay::start().await, Relay::start().await);
    let block = with(block::product_name("0,0"), "/Colour", "red");
    one.rest.create(&block).await;
    one.rest.create(&with(block.clone(), "/AppCfg/Attribute", 6)).await;
    plant(&one.rest).await;
    let packed = export(&one.rest).await;

    // Something of the same name, and something else.
    other.rest.create(&with(block, "/AppCfg/Attribute", 1)).await;
    other.rest.create(&with(block::product_name("0,0"), "/name", "stays")).await;
    let preview = import(&other.rest, "project?preview=true", packed.clone()).await;
    assert_eq!((preview.status, &preview.body["stored"]), (200, &json!(false)), "{preview:?}");
    assert_eq!(other.rest.get("blocks").await.body.as_array().map(Vec::len), Some(2));
    let done = import(&other.rest, "project", packed.clone()).await;
    assert_eq!((done.status, &done.body["stored"]), (200, &json!(true)), "{done:?}");
    let how: Vec<_> = done.body["parts"]
        .as_array()
        .expect("parts")
        .iter()
        .map(|part| {
            (
                part["what"].as_str().unwrap_or_default(),
                part["how"].as_str().unwrap_or_default(),
                part["id"].as_str().unwrap_or_default(),
            )
        })
        .collect();
    assert_eq!(
        how,
        [
            ("block", "changed", "b1"),
            ("block", "created", "b3"),
            ("block", "left", "b2"),
            ("target", "created", "d1"),
            ("group", "created", "g1")
        ]
    );
    let content = |mut blocks: Value| {
        for block in blocks.as_array_mut().into_iter().flatten() {
            block["id"].take();
            block["revision"].take();
        }
        blocks
    };
    let (there, here) =
        (content(one.rest.get("blocks").await.body), content(other.rest.get("blocks").await.body));
    assert_eq!((&here[0], &here[2]), (&there[0], &there[1]));
    assert_eq!(other.rest.get("devices").await.body, one.rest.get("devices").await.body);
    assert_eq!(
        other.rest.get("groups/g1/variables").await.body,
        one.rest.get("groups/g1/variables").await.body
    );
    assert_eq!(other.rest.run("b3").await["Q"], true, "what was taken in runs");
    let again = import(&other.rest, "project", packed.clone()).await.body;
    let changed = again["parts"]
        .as_array()
        .expect("parts")
        .iter()
        .filter(|part| !matches!(part["how"].as_str(), Some("unchanged" | "left")))
        .count();
    assert_eq!(changed, 0, "{again}");
    let audit = other.rest.get("audit").await.body.to_string();
    assert!(audit.contains("block_created") && audit.contains("plant_changed"), "{audit}");

    // A relay with a folder has them as files, and gives the same archive.
    let folder = TempDir::new().expect("a folder");
    let relay = Service::serve_project(folder.path(), None).await;
    let rest = Rest::new(&relay.address);
    assert_eq!(import(&rest, "project", packed.clone()).await.status, 200);
    let unpacked = TempDir::new().expect("a folder");
    let (archive, into) = (unpacked.path().join("x.zip"), unpacked.path().join("x"));
    fs::write(&archive, &packed).expect("the archive");
    let ended = cipdeck(&["project", "unpack", utf8(&archive), utf8(&into)]).await;
    assert_eq!(ended.code, 0, "{ended:?}");
    for path in ["blocks", "targets", "groups"] {
        let different =
            program(Path::new("diff"), &["-r", utf8(&into.join(path)), utf8(&folder.path().join(path))])
                .await;
        assert_eq!((different.code, different.stdout.as_str()), (0, ""), "{different:?}");
    }
}

#[tokio::test]
async fn an_import_says_before_what_it_replaces_removes_and_stops() {
    let (one, other) = (Relay::start().await, Relay::start().await);
    let cyclic = with(block::product_name("0,0"), "/CtrlCfg", json!({ "TriggerType": 200 }));
    let mut ids = Vec::new();
    for relay in [&one, &other] {
        let id = relay.rest.create(&cyclic).await;
        assert_eq!(relay.rest.post(&format!("blocks/{id}/in"), &json!({ "IN": true })).await.status, 200);
        ids.push(id);
        plant(&relay.rest).await;
    }
    save(&one.rest, &format!("blocks/{}", ids[0]), |block| block["AppCfg"]["Attribute"] = json!(6)).await;
    let variable = with(one.rest.get("groups/g1/variables").await.body[1].clone(), "/unit", "rpm");
    assert_eq!(one.rest.put("variables/v2", &variable).await.status, 200);
    let more = json!({ "variables": [{ "name": "here", "address": "here" }] });
    assert_eq!(one.rest.post("groups/g1/variables", &more).await.status, 201);
    let more = json!({ "variables": [{ "name": "x", "address": "x" }, { "name": "y", "address": "y" }] });
    assert_eq!(other.rest.post("groups/g1/variables", &more).await.status, 201);

    let packed = export(&one.rest).await;
    for (path, input) in [("project?preview=true", true), ("project", false)] {
        let answer = import(&other.rest, path, packed.clone()).await;
        let details: Vec<_> = answer.body["parts"]
            .as_array()
            .expect("parts")
            .iter()
            .filter_map(|part| part["detail"].as_str())
            .collect();
        assert_eq!(
            details,
            [
                "it runs, and is stopped; AppCfg.Attribute: 7 → 6",
                "variables: 1 created, 1 changed, 2 removed"
            ]
        );
        assert_eq!(other.rest.get(&format!("blocks/{}/status", ids[1])).await.body["IN"], input);
    }
    let left = other.rest.get("groups/g1/variables").await.body;
    assert_eq!(left.as_array().map(Vec::len), Some(3), "{left}");
}

#[tokio::test]
async fn an_archive_with_an_error_stores_nothing_and_says_where() {
    let relay = Relay::start().await;
    let rest = &relay.rest;
    let good = json!({ "name": "good", "AppCfg": { "Service": 14, "Class": 1, "Instance": 1 }, "TargetCfg": { "Path": "0,0" } });
    let wrong = with(good.clone(), "/AppCfg/Service", 300).to_string();
    let broken = "{\"name\": \"x\",\n \"AppCfg\": 5}";
    let head = "{\"project\": 1}";
    let packed = zip(&[
        ("cipdeck.json", head),
        ("blocks/a.json", &good.to_string()),
        ("blocks/b.json", &wrong),
        ("blocks/c.json", broken),
    ]);
    let refused = import(rest, "project", packed.clone()).await;
    refused.is_problem(422, "findings");
    let preview = import(rest, "project?preview=true", packed).await;
    assert_eq!(preview.status, 200, "{preview:?}");
    for findings in [&refused.body["findings"], &preview.body["findings"]] {
        let errors: Vec<_> = findings
            .as_array()
            .expect("findings")
            .iter()
            .filter(|finding| finding["severity"] == "error")
            .map(|finding| finding["field"].as_str().unwrap_or_default())
            .collect();
        assert_eq!(errors.len(), 2, "{findings}");
        assert!(
            errors[0].starts_with("blocks/c.json:2:12") && errors[1].starts_with("blocks/b.json:1:"),
            "{errors:?}"
        );
    }

    for (name, archive, status, code) in [
        ("no archive", b"no archive".to_vec(), 400, "unreadable"),
        ("nothing", Vec::new(), 400, "unreadable"),
        ("a path outwards", zip(&[("../x.json", head)]), 400, "unreadable"),
        ("a newer version", zip(&[("cipdeck.json", "{\"project\": 7}")]), 422, "findings"),
        ("a bomb", zip(&[("blocks/x.json", &" ".repeat(9 << 20))]), 400, "unreadable"),
        ("too much", vec![0; 17 << 20], 413, "too_large"),
    ] {
        let refused = import(rest, "project", archive).await;
        assert_eq!(
            (refused.status, refused.body["code"].as_str()),
            (status, Some(code)),
            "{name}: {refused:?}"
        );
    }
    // A form of a foreign page can send neither type.
    rest.post("project", &json!({})).await.is_problem(400, "unreadable");
    import(rest, "project?preview=yes", zip(&[("cipdeck.json", head)])).await.is_problem(400, "unreadable");
    import(rest, "project?prewiev=true", zip(&[("cipdeck.json", head)])).await.is_problem(400, "unreadable");
    assert_eq!(rest.get("blocks").await.body, json!([]));
}

#[tokio::test]
async fn a_full_disk_refuses_the_change_and_leaves_the_files_whole() {
    let folder = TempDir::new().expect("a folder");
    let relay = Service::serve_project(folder.path(), None).await;
    let rest = Rest::new(&relay.address);
    rest.create(&with(block::product_name("0,0"), "/name", "a")).await;
    let file = folder.path().join("blocks/a.json");
    let before = fs::read_to_string(&file).expect("the file");
    relay.process.limit_files(Some(100));
    let changed = with(rest.get("blocks/b1").await.body, "/AppCfg/Attribute", 6);
    rest.put("blocks/b1", &changed).await.is_problem(503, "unavailable");
    rest.post("blocks", &block::product_name("0,0")).await.is_problem(503, "unavailable");
    assert_eq!(rest.get("blocks/b1").await.body["revision"], 1);
    assert_eq!(fs::read_to_string(&file).expect("the file"), before);
    let files: Vec<_> = fs::read_dir(folder.path().join("blocks")).expect("the folder").collect();
    assert_eq!(files.len(), 1, "{files:?}");
    relay.process.limit_files(None);
    assert_eq!(rest.put("blocks/b1", &changed).await.status, 200);
    assert!(fs::read_to_string(&file).expect("the file").contains("\"Attribute\": 6"));
}

/// A device `NX 1` with a group `line 4` of two variables; the group.
pub(super) async fn plant(rest: &Rest) -> String {
    let device = rest.post("devices", &json!({ "name": "NX 1", "path": "0,0" })).await;
    assert_eq!(device.status, 201, "{device:?}");
    let group = rest.post("groups", &json!({ "device": device.body["id"], "name": "line 4" })).await;
    assert_eq!(group.status, 201, "{group:?}");
    let group = group.body["id"].as_str().expect("an id").to_owned();
    let variables = json!({ "variables": [
        { "name": "motor", "address": "stMotor", "type": "STRUCT{speed: REAL; run: BOOL}" },
        { "parent_address": "stMotor", "name": "speed", "address": "speed", "unit": "1/min", "min": 0.1 },
    ] });
    let made = rest.post(&format!("groups/{group}/variables"), &variables).await;
    assert_eq!(made.status, 201, "{made:?}");
    group
}

/// Reads something, changes it, and stores it.
pub(super) async fn save(rest: &Rest, path: &str, change: impl FnOnce(&mut Value)) {
    let mut body = rest.get(path).await.body;
    change(&mut body);
    let saved = rest.put(path, &body).await;
    assert_eq!(saved.status, 200, "{path}: {saved:?}");
}

async fn export(rest: &Rest) -> Vec<u8> {
    let answer = rest.request(Method::GET, "project").send().await.expect("the relay answers");
    assert_eq!(answer.headers()["content-type"], "application/zip");
    answer.bytes().await.expect("an archive").to_vec()
}

pub(super) async fn import(rest: &Rest, path: &str, archive: Vec<u8>) -> Reply {
    Rest::send(rest.request(Method::POST, path).header("content-type", "application/zip").body(archive)).await
}

pub(super) fn zip(files: &[(&str, &str)]) -> Vec<u8> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (path, text) in files {
        archive.start_file(*path, SimpleFileOptions::default()).expect("a file");
        archive.write_all(text.as_bytes()).expect("a text");
    }
    archive.finish().expect("an archive").into_inner()
}

pub(super) async fn serve(project: &Path, data: Option<&Path>) -> Ended {
    let mut arguments = vec!["serve", "--listen", "127.0.0.1:0", "--project", utf8(project)];
    arguments.extend(data.into_iter().flat_map(|data| ["--data", utf8(data)]));
    cipdeck(&arguments).await
}

pub(super) async fn stop(relay: &mut Service) {
    relay.process.interrupt();
    let status = relay.process.ended(PATIENCE).await;
    assert!(status.success(), "{status}\n{}", relay.process.output().join("\n"));
}

pub(super) async fn git(folder: &TempDir, arguments: &[&str]) -> String {
    let own = [
        "-C",
        utf8(folder.path()),
        "-c",
        "user.name=x",
        "-c",
        "user.email=x@example.org",
        "-c",
        "core.autocrlf=false",
    ];
    let ended = program(Path::new("git"), &[&own, arguments].concat()).await;
    assert_eq!(ended.code, 0, "git {arguments:?}: {ended:?}");
    ended.stdout
}

pub(super) async fn commit(folder: &TempDir) {
    git(folder, &["add", "-A"]).await;
    git(folder, &["commit", "-q", "-m", "as it is"]).await;
}

pub(super) fn utf8(path: &Path) -> &str {
    path.to_str().expect("a path in UTF-8")
}

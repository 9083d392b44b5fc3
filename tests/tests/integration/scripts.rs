//! What a script may that lets a relay send: `cipdeck --relay URL run FILE`, with a token of each role.

use cipdeck_tests::block::{self, with};
use cipdeck_tests::command::{Ended, cipdeck};
use cipdeck_tests::fake_plc::{self, FakePlc};
use cipdeck_tests::managed::Managed;
use serde_json::{Value, json};
use tempfile::TempDir;

/// Done, or refused by the relay with these words.
const DONE: Result<(), &str> = Ok(());
const NO_EDIT: Result<(), &str> = Err("blocks and devices are changed by engineers");
const NO_WINDOW: Result<(), &str> = Err("write window");
const NOT_LISTED: Result<(), &str> = Err("list");

#[tokio::test]
async fn a_script_may_what_its_token_may_and_writes_in_a_window_that_a_person_has_opened() {
    let relay = Managed::start().await;
    let plc = FakePlc::start(fake_plc::answering(&[1, 2, 3, 4])).await;
    let folder = TempDir::new().unwrap();
    let store = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let file = |name: &str, block: &Value| store(name, &block.to_string());
    let write = block::set(&plc.path(), 4, 150, 3, "0a0b0c0d");
    let files = [
        file("read", &block::product_name(&plc.path())),
        file("write", &write),
        file("unknown", &with(block::get(&plc.path(), 0x300, 1, 1), "/AppCfg/Service", 0x5A)),
        file("elsewhere", &block::product_name("4,192.0.2.1")),
    ];
    let mut tokens = Vec::new();
    for role in ["viewer", "operator", "engineer"] {
        tokens.push((role, store(role, &relay.token(role).await)));
    }
    let token = std::fs::read_to_string(&tokens[2].1).unwrap();
    let an_administrator = json!({ "name": "all", "role": "admin", "days": 1 });
    assert_eq!(relay.admin.post("tokens", &an_administrator).await.status / 100, 4);
    let url = format!("http://{}", relay.address);
    let run = async |token: &str, file: &str| -> Ended {
        cipdeck(&["--relay", &url, "--token-file", token, "run", file]).await
    };
    let matrix = async |window: &str, engineer: [Result<(), &str>; 4]| {
        for (role, token) in &tokens {
            let expected = if *role == "engineer" { engineer } else { [NO_EDIT; 4] };
            for (file, expected) in files.iter().zip(expected) {
                let ended = run(token, file).await;
                println!("{window:6} {role:8} {:9} exit {}", file.rsplit('/').next().unwrap(), ended.code);
                match expected {
                    Ok(()) => assert_eq!(ended.code, 0, "{role} {file}: {ended:?}"),
                    Err(words) => {
                        assert_eq!(ended.code, 4, "{role} {file}: {ended:?}");
                        assert!(ended.stderr.contains(words), "{role} {file}: {}", ended.stderr);
                    }
                }
            }
        }
    };
    let sent = || plc.messages().iter().filter(|message| message[0] != 14).map(|m| m[0]).collect::<Vec<_>>();

    matrix("closed", [DONE, NO_WINDOW, NO_WINDOW, NOT_LISTED]).await;
    assert_eq!(sent(), [0; 0], "nothing but reads has arrived");
    let script = relay.admin.with_header("cookie", "").with_token(&token);
    script.post("window", &json!({})).await.is_problem(403, "not_permitted");

    let engineer = relay.user("engineer").await;
    assert_eq!(engineer.post("window", &json!({})).await.status, 200);
    matrix("open", [DONE, DONE, DONE, NOT_LISTED]).await;
    assert_eq!(sent(), [0x10, 0x5A], "what the engineer's token sent, once each");

    assert_eq!(engineer.delete("window").await.status, 204);
    matrix("closed", [DONE, NO_WINDOW, NO_WINDOW, NOT_LISTED]).await;
    assert_eq!(sent().len(), 2);
    assert_eq!(relay.admin.get("blocks").await.body, json!([]), "no script has left anything behind");
    let stranger = run(&store("stranger", "cdt_9_00000000"), &files[0]).await;
    assert!(stranger.code == 4 && stranger.stdout.is_empty(), "{stranger:?}");
}

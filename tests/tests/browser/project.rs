//! The relay's folder: somebody else has changed it, and the page shows what that means before it is taken.

use std::fs;

use cipdeck_relay::Settings;
use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::browser::{Browser, Journey, part};
use cipdeck_tests::relay::Relay;
use serde_json::json;
use tempfile::TempDir;

use super::code::{looks, page};

#[tokio::test]
async fn a_folder_that_was_changed_is_looked_at_and_taken() {
    let folder = TempDir::new().expect("a folder");
    let project = folder.path().join("plant");
    let kept = project.clone();
    let data = TempDir::new().expect("a folder");
    let relay = Relay::start_with(data, |settings| Settings { project: Some(kept), ..settings }).await;
    let cyclic = with(block::product_name("0,0"), "/CtrlCfg", json!({ "TriggerType": 200 }));
    let id = relay.rest.create(&with(cyclic, "/name", "drive name")).await;
    relay.rest.create(&with(block::product_name("0,0"), "/name", "goes")).await;
    assert_eq!(relay.rest.post(&format!("blocks/{id}/in"), &json!({ "IN": true })).await.status, 200);
    let file = project.join("blocks/drive-name.json");
    let edit = |from: &str, to: &str| {
        let text = fs::read_to_string(&file).expect("the file");
        assert!(text.contains(from), "{text}");
        fs::write(&file, text.replace(from, to)).expect("changed by hand");
    };
    edit("\"Attribute\": 7", "\"Attribute\": 6");
    fs::remove_file(project.join("blocks/goes.json")).expect("removed by hand");

    let journey = Journey::start("project_folder").await;
    let mut user = journey.open("user", &page(&relay, "/project")).await;
    user.click_part("folder-look").await;
    user.see("it runs, and is stopped; AppCfg.Attribute: 7 → 6", PATIENCE).await;
    user.see("0 to create, 1 to change, 1 to remove, 0 left as they are, 0 wrong", PATIENCE).await;
    assert_eq!(relay.rest.get("blocks").await.body[0]["AppCfg"]["Attribute"], 7, "only looked at");
    looks(&mut user, "look").await;
    let inside = "return [...document.querySelectorAll('.panel')].every(panel => panel.scrollWidth <= panel.clientWidth)";
    assert_eq!(user.script(inside).await, true, "nothing sticks out of a panel");

    // In between somebody goes on: what was seen is not what would be taken.
    edit("\"Attribute\": 6", "\"Attribute\": \"six\"");
    user.click_part("project-do").await;
    user.see("look again, and decide again", PATIENCE).await;
    user.click_part("folder-look").await;
    user.see("invalid type: string \"six\"", PATIENCE).await;
    assert!(!user.can_use("project-do").await, "what cannot be read is not taken");
    looks(&mut user, "wrong").await;

    edit("\"Attribute\": \"six\"", "\"Attribute\": 6");
    take(&mut user).await;
    user.shot("done").await;
    let blocks = relay.rest.get("blocks").await.body;
    assert_eq!((blocks.as_array().map(Vec::len), &blocks[0]["AppCfg"]["Attribute"]), (Some(1), &json!(6)));
    assert_eq!(relay.rest.get(&format!("blocks/{id}/status")).await.body["IN"], false);

    // Written anew without saying anything new: it has to be taken all the same, or every save would be refused.
    edit("\n}", "\n\n}");
    let block = with(relay.rest.get(&format!("blocks/{id}")).await.body, "/AppCfg/Attribute", 5);
    relay.rest.put(&format!("blocks/{id}"), &block).await.is_problem(409, "conflict");
    take(&mut user).await;
    assert_eq!(relay.rest.put(&format!("blocks/{id}"), &block).await.status, 200);
    user.close_with_expected_errors().await;
}

/// Looks, and takes what was seen.
async fn take(user: &mut Browser) {
    user.click_part("folder-look").await;
    user.find("what would happen", &part("project-preview"), PATIENCE).await;
    user.click_part("project-do").await;
    user.find("that it is done", &part("project-done"), PATIENCE).await;
}

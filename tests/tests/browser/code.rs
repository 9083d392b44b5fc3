//! The pages of code: old code in, with every line that is not understood; a block out in each dialect, and as a block of
//! another kind; projects down and up; and what is no code at all.

use std::path::{Path, PathBuf};

use cipdeck_relay::Settings;
use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::browser::{Browser, Journey, part};
use cipdeck_tests::relay::Relay;
use serde_json::{Value, json};
use tempfile::TempDir;
use thirtyfour::prelude::By;

/// The complete requests that are worked out for Schneider's modules, and what makes each a section of a program.
///
/// Sources: Control Expert help for TSX ETC 100 (`SEND_REQ`), TSX ETC 101 (D-SE-0006433, D-SE-0020131) and BMX NOC 0401
/// (`DATA_EXCH`, D-SE-0006557); the Modbus object in EIO0000001601, p. 67.
const REQUESTS: [Request; 4] = [
    Request {
        words: "0000 030E 0120 0124 0730",
        length: 10,
        kind: "SEND_REQ (TSX ETC 100)",
        dialect: "send-req-etc100",
        call: "SEND_REQ(ADDR('0.2.0.192.168.1.102'), 16#000E, Data, Management, Reply);",
    },
    Request {
        words: "0000 C0A8 0166 024E 4420 0124 0000 000A",
        length: 16,
        kind: "SEND_REQ (TSX ETC 101)",
        dialect: "send-req-etc101",
        call: "SEND_REQ(ADDR('0.2.0'), 16#000E, Data, Management, Reply);",
    },
    Request {
        words: "0000 024E 4420 0124 0000 000A",
        length: 12,
        kind: "SEND_REQ (TSX ETC 100)",
        dialect: "send-req-etc100",
        call: "SEND_REQ(ADDR('0.2.0.192.168.1.102'), 16#000E, Data, Management, Reply);",
    },
    Request {
        words: "024E 4420 0124 0000 000A",
        length: 10,
        kind: "DATA_EXCH",
        dialect: "data-exch",
        call: "DATA_EXCH(ADDMX('0.2.0{192.168.1.102}UNC.CIP'), 1, Data, Management, Reply);",
    },
];

struct Request {
    /// `Data_to_Send`.
    words: &'static str,
    /// `Management_Param[3]`.
    length: usize,
    /// What it becomes.
    kind: &'static str,
    /// What it is written in.
    dialect: &'static str,
    /// The call around it.
    call: &'static str,
}

impl Request {
    /// A section of a program: the words one by one, then the call.
    fn section(&self) -> String {
        let words = self.words.split(' ').enumerate();
        let words: Vec<_> = words.map(|(index, word)| format!("Data[{index}] := 16#{word};\n")).collect();
        let (words, length, call) = (words.concat(), self.length, self.call);
        let text = format!("{words}Management[2] := 30; (* 3 s *)\nManagement[3] := {length};\n{call}\n");
        text
    }
}

#[tokio::test]
async fn the_requests_of_schneiders_modules_become_blocks_and_give_the_same_words_again() {
    let relay = Relay::start().await;
    let journey = Journey::start("code_words").await;
    let mut user = journey.open("user", &page(&relay, "")).await;
    user.see("What can be read", PATIENCE).await;
    user.shot("empty").await;
    for (number, request) in REQUESTS.iter().enumerate() {
        // The words alone, then the whole section.
        paste(&user, request.words).await;
        user.see("1 block", PATIENCE).await;
        assert_eq!(user.find("the kind", &part("kind"), PATIENCE).await, request.kind, "{}", request.words);
        paste(&user, &request.section()).await;
        let lines = request.section().lines().count();
        user.see(&format!("lines 1–{lines}"), PATIENCE).await;
        assert_eq!(user.find("the kind", &part("kind"), PATIENCE).await, request.kind);
        user.shot(&format!("section-{number}")).await;
        fill_name(&user, &format!("request-{number}")).await;
        user.click_part("save").await;
        let saved = user.find("it is saved", &part("saved"), PATIENCE).await;
        let id = id_in(&saved);
        let stored = relay.rest.get(&format!("blocks/{id}")).await.body;
        assert_eq!(stored["Data_to_Send"], request.words, "{stored}");
        assert_eq!(stored["name"], format!("request-{number}"));
        for language in ["st", "il"] {
            user.go(&page(&relay, &format!("/{id}?as={}", request.dialect))).await;
            user.click_part(&format!("language-{language}")).await;
            let code = code(&user).await;
            for word in request.words.split(' ') {
                assert!(code.to_uppercase().contains(&format!("16#{word}")), "{word}: {code}");
            }
            user.shot(&format!("code-{number}-{language}")).await;
        }
        user.go(&page(&relay, "")).await;
        // The text lies there as it was left.
        user.click_part("clear").await;
        user.see("What can be read", PATIENCE).await;
    }
    user.close().await;
}

#[tokio::test]
async fn a_mixed_text_becomes_blocks_and_each_line_of_rubbish_is_shown_at_its_place() {
    let relay = Relay::start().await;
    let name = "drive_name";
    let drive = relay.rest.create(&with(block::product_name("4,192.168.1.100"), "/name", name)).await;
    let journey = Journey::start("code_mixed").await;
    let mut user = journey.open("user", &page(&relay, &format!("/{drive}?as=ccw-st"))).await;
    let mut text = code(&user).await;
    text += "\nthis is no code at all;\n\n";
    let rubbish = text.matches('\n').count() - 1;
    text += &REQUESTS[0].section();
    text += "\n0E 03 20 01 24 01 30 07\n";
    user.go(&page(&relay, "")).await;
    paste(&user, &text).await;
    user.see("3 blocks, 1 place not understood", PATIENCE).await;
    let line = "//*[@data-test='rest']//*[@data-test='not-understood']";
    let said = user.find("the line of rubbish", line, PATIENCE).await;
    assert!(said.contains(&format!("line {rubbish},")) && said.contains("this is no code"), "{said}");
    user.click_at(&format!("{line}//button"), "the line").await;
    let selected = "const a = document.getElementById('code-text'); return a.value.slice(a.selectionStart, a.selectionEnd)";
    assert_eq!(user.script(selected).await, "this is no code at all;");
    user.find(
        "the marked line",
        "//*[contains(@class,'code-number') and contains(@class,'error')]",
        PATIENCE,
    )
    .await;
    user.shot("mixed").await;
    // The hex names no device.
    user.fill("Device of the blocks whose text names none", "192.168.1.7").await;
    user.see("4,192.168.1.7", PATIENCE).await;
    user.find("that the name is there already", &part("double"), PATIENCE).await;
    fits(&mut user, "aimed").await;
    looks(&mut user, "import").await;
    user.click_part("save").await;
    user.see("3 saved.", PATIENCE).await;
    fits(&mut user, "saved").await;
    let blocks = relay.rest.get("blocks").await.body;
    assert_eq!(blocks.as_array().map(Vec::len), Some(4), "{blocks}");
    let aimed = blocks.as_array().into_iter().flatten().any(|it| it["TargetCfg"]["Path"] == "4,192.168.1.7");
    assert!(aimed, "{blocks}");
    assert!(!user.can_use("save").await, "nothing is saved twice");
    user.close().await;
}

#[tokio::test]
async fn a_block_is_taken_home_in_every_dialect() {
    let relay = Relay::start().await;
    let write = with(block::product_name("4,192.168.1.100"), "/name", "speed *) --> reference");
    let write = with(write, "/AppCfg", json!({ "Service": 16, "Class": 4, "Instance": 150, "Attribute": 3 }));
    let write = with(write, "/ReqData", "dc050000");
    let id = relay.rest.create(&write).await;
    let journey = Journey::start("code_out").await;
    let mut user = journey.open("user", &page(&relay, &format!("/{id}"))).await;
    for dialect in DIALECTS {
        user.click_part(dialect).await;
        user.find("its code", &format!("//*[@data-dialect='{dialect}']"), PATIENCE).await;
        let code = code(&user).await;
        assert!(!code.trim().is_empty(), "{dialect}");
        fits(&mut user, dialect).await;
        let file = user.find("a file name", &part("file-name"), PATIENCE).await;
        assert!(file.starts_with("speed") && !file.contains(['*', ' ', '>']), "{file}");
        let link = "return decodeURIComponent(document.querySelector('[data-test=download]').href.split(',').slice(1).join(','))";
        let downloaded = user.script(link).await;
        assert_eq!(downloaded.as_str().map(str::trim_end), Some(code.trim_end()), "{dialect}");
    }
    looks(&mut user, "export").await;
    user.close().await;
}

const DIALECTS: [&str; 11] = [
    "ccw-st",
    "l5x",
    "send-req-etc100",
    "send-req-etc101",
    "data-exch",
    "sysmac-st",
    "pycomm3",
    "rust",
    "cli",
    "hex",
    "json",
];

#[tokio::test]
async fn what_l5x_cannot_say_is_said_loudly() {
    let relay = Relay::start().await;
    let members = with(block::product_name("4,192.168.1.100"), "/AppCfg/MemberCnt", 2);
    let members = with(members, "/AppCfg/MemberId", json!([1, 300, 0]));
    let id = relay.rest.create(&members).await;
    let journey = Journey::start("code_loud").await;
    let mut user = journey.open("user", &page(&relay, &format!("/{id}?as=l5x"))).await;
    user.find("that the request is another one", &part("request-changes"), PATIENCE).await;
    user.find("the member", "//tr[@data-grade='request']", PATIENCE).await;
    fits(&mut user, "members").await;
    looks(&mut user, "loud").await;
    user.close().await;
}

#[tokio::test]
async fn an_l5x_file_becomes_blocks() {
    let relay = Relay::start().await;
    let id = relay.rest.create(&block::product_name("4,192.168.1.100")).await;
    let journey = Journey::start("code_l5x").await;
    let mut user = journey.open("user", &page(&relay, &format!("/{id}?as=l5x"))).await;
    let text = code(&user).await;
    let folder = TempDir::new().expect("a folder");
    let file = written(folder.path(), "drives.L5X", text.as_bytes());
    user.go(&page(&relay, "")).await;
    choose(&user, "code-files", &[file]).await;
    user.see("1 block", PATIENCE).await;
    user.see("drives.L5X", PATIENCE).await;
    user.shot("file").await;
    fill_name(&user, "from the file").await;
    user.click_part("save").await;
    user.see("1 saved.", PATIENCE).await;
    let blocks = relay.rest.get("blocks").await.body;
    let all = blocks.as_array().expect("blocks");
    let read = all.iter().find(|it| it["name"] == "from the file").expect("the block");
    assert_eq!(
        (&read["AppCfg"], &read["TargetCfg"]["Path"]),
        (&all[0]["AppCfg"], &all[0]["TargetCfg"]["Path"])
    );
    user.close().await;
}

#[tokio::test]
async fn a_block_becomes_a_send_req_and_comes_back() {
    let relay = Relay::start().await;
    let id = relay.rest.create(&block::product_name("4,192.168.1.100")).await;
    let journey = Journey::start("code_convert").await;
    let mut user = journey.open("user", &page(&relay, &format!("/{id}"))).await;
    becomes(&mut user, "SEND_REQ (TSX ETC 100)").await;
    let sides = "return ['before', 'after'].map(side => document.querySelector(`[data-test=${side}] [data-test=bytes]`).textContent)";
    assert_eq!(user.script(sides).await, json!(["0E03200124013007", "0E03200124013007"]));
    fits(&mut user, "to-send-req").await;
    looks(&mut user, "convert").await;
    let there = save_another(&mut user).await;
    let stored = relay.rest.get(&format!("blocks/{there}")).await.body;
    assert_eq!(
        (&stored["kind"], &stored["Data_to_Send"]),
        (&json!("SEND_REQ"), &json!("0000 030E 0120 0124 0730"))
    );
    user.go(&page(&relay, &format!("/{there}"))).await;
    becomes(&mut user, "MSG_CIPGENERIC").await;
    let back = save_another(&mut user).await;
    let back = relay.rest.get(&format!("blocks/{back}")).await.body;
    let first = relay.rest.get(&format!("blocks/{id}")).await.body;
    assert_eq!(
        (&back["AppCfg"], &back["TargetCfg"]["Path"]),
        (&first["AppCfg"], &first["TargetCfg"]["Path"])
    );
    user.close().await;
}

#[tokio::test]
async fn a_conversion_that_changes_the_device_has_to_be_confirmed() {
    let relay = Relay::start().await;
    let id = relay.rest.create(&block::product_name("4,192.168.1.100,1,0")).await;
    let journey = Journey::start("code_confirm").await;
    let mut user = journey.open("user", &page(&relay, &format!("/{id}"))).await;
    user.click_at("//button[@data-kind='SEND_REQ (TSX ETC 100)']", "SEND_REQ").await;
    user.find("what changes", &part("request-changes"), PATIENCE).await;
    user.see("Confirm what is marked red first", PATIENCE).await;
    assert!(!user.can_use("save-another").await);
    fits(&mut user, "to-confirm").await;
    save_another(&mut user).await;
    user.shot("confirmed").await;
    user.close().await;
}

#[tokio::test]
async fn a_project_goes_from_one_relay_to_another() {
    let folder = TempDir::new().expect("a folder");
    let project = folder.path().join("plant");
    std::fs::create_dir(&project).expect("a folder for the project");
    let kept = project.clone();
    let data = TempDir::new().expect("a folder");
    let here = Relay::start_with(data, |settings| Settings { project: Some(kept), ..settings }).await;
    here.rest.create(&with(block::product_name("4,192.168.1.100"), "/name", "drive name")).await;
    here.rest.create(&block::get("0,0", 1, 1, 6)).await;
    assert!(project.join("blocks").join("drive-name.json").is_file(), "it is written at once");
    let journey = Journey::start("code_project").await;
    let mut user = journey.open("user", &page(&here, "/project")).await;
    let said = user.find("which folder", &part("served"), PATIENCE).await;
    assert!(said.contains(&project.display().to_string()), "{said}");
    user.shot("served").await;
    let link = user.script("return document.querySelector('[data-test=project-down]').href").await;
    let zip = reqwest::get(link.as_str().expect("an address")).await.expect("an answer");
    let zip = zip.error_for_status().expect("a project").bytes().await.expect("a body");
    let zip = written(folder.path(), "plant.zip", &zip);

    let there = Relay::start().await;
    let old = with(block::get("0,0", 1, 1, 5), "/name", "get-1-1-6");
    there.rest.create(&old).await;
    user.go(&page(&there, "/project")).await;
    user.see("The relay serves no folder", PATIENCE).await;
    let text = written(folder.path(), "plant.txt", b"no zip");
    choose(&user, "project-file", &[text]).await;
    user.find("that it is no zip", &part("no-zip"), PATIENCE).await;
    choose(&user, "project-file", std::slice::from_ref(&zip)).await;
    user.see("1 to create, 1 to change, 0 to remove, 0 left as they are, 0 wrong", PATIENCE).await;
    assert_eq!(names(&there).await, ["get-1-1-6"], "only looked at");
    fits(&mut user, "preview").await;
    looks(&mut user, "preview").await;
    user.click_part("project-do").await;
    user.find("that it is done", &part("project-done"), PATIENCE).await;
    user.shot("done").await;
    assert_eq!(names(&there).await, ["drive name", "get-1-1-6"]);
    choose(&user, "project-file", &[zip]).await;
    user.see("Nothing would change.", PATIENCE).await;
    assert!(!user.can_use("project-do").await);
    user.shot("again").await;
    user.close().await;
}

/// Of all blocks, sorted.
async fn names(relay: &Relay) -> Vec<String> {
    let blocks = relay.rest.get("blocks").await.body;
    let names = blocks.as_array().into_iter().flatten().filter_map(|block| block["name"].as_str());
    let mut names: Vec<_> = names.map(str::to_owned).collect();
    names.sort();
    names
}

#[tokio::test]
async fn what_is_no_code_is_told() {
    let relay = Relay::start().await;
    let journey = Journey::start("code_wrong").await;
    let mut user = journey.open("user", &page(&relay, "")).await;
    let folder = TempDir::new().expect("a folder");
    let picture = written(folder.path(), "picture.png", b"\x89PNG\r\n\x1A\n\0\0\0\rIHDR");
    let big = written(folder.path(), "big.st", &b"x := 1;\n".repeat(2 * 1024 * 1024 / 8));
    let nothing = written(folder.path(), "nothing.st", b"");
    let accents = written(folder.path(), "accents.txt", b"(* d\xE9bit *)\n0E 03 20 01 24 01 30 07\n");
    choose(&user, "code-files", &[picture, big, nothing, accents]).await;
    user.see("picture.png is not read: it is not a text", PATIENCE).await;
    user.see("big.st is not read: it has 2097152 bytes", PATIENCE).await;
    user.see("nothing.st is not read: there is nothing in it", PATIENCE).await;
    user.find("how it was read", &part("latin1"), PATIENCE).await;
    user.see("1 block", PATIENCE).await;
    user.shot("files").await;
    user.click_part("clear").await;
    user.see("What can be read", PATIENCE).await;

    paste(&user, "(* this comment has no end\n16#0000\n").await;
    user.find("the comment", &part("not-understood"), PATIENCE).await;
    user.find("that there is no block", &part("no-block"), PATIENCE).await;
    user.shot("unclosed").await;
    paste(&user, &"x := 1;\n".repeat(2 * 1024 * 1024 / 8)).await;
    user.see("nothing of it was read", PATIENCE).await;
    user.shot("too-long").await;
    paste(&user, "{\"name\": \"wrong\", \"AppCfg\": { \"Service\": 300, \"Class\": 1, \"Instance\": 1, \"Attribute\": 7 }, \"TargetCfg\": { \"Path\": \"0,0\" } }").await;
    user.find("what is wrong", &part("wrong"), PATIENCE).await;
    assert!(!user.can_use("save").await, "errors are not saved");
    fits(&mut user, "error").await;
    paste(&user, " ").await;
    user.see("What can be read", PATIENCE).await;
    user.go(&page(&relay, "/b4711")).await;
    user.find("that it is gone", &part("problem"), PATIENCE).await;
    user.shot("gone").await;
    user.go(&page(&relay, "/nowhere")).await;
    user.see("There is no such page", PATIENCE).await;
    // A block that is not there is an answer with another status, which the browser logs.
    user.close_with_expected_errors().await;
}

/// Chooses a kind and confirms what has to be confirmed.
async fn becomes(user: &mut Browser, kind: &str) {
    user.click_at(&format!("//button[@data-kind='{kind}']"), kind).await;
    user.find("both beside each other", &part("pair"), PATIENCE).await;
    user.find("that the bytes are equal", &part("bytes-equal"), PATIENCE).await;
}

/// The new block's id.
async fn save_another(user: &mut Browser) -> String {
    let count = "return document.querySelectorAll('[data-test=tick]').length";
    for number in 1..=user.script(count).await.as_u64().unwrap_or(0) {
        user.click_at(&format!("({})[{number}]", part("tick")), "I have seen it").await;
    }
    user.click_part("save-another").await;
    let said = user.find("it is saved", &part("made"), PATIENCE).await;
    id_in(&said)
}

/// `b7` of `Saved as b7. Open it`.
fn id_in(text: &str) -> String {
    let words = text.split([' ', '.', '\n']);
    let is_id = |word: &&str| word.strip_prefix('b').is_some_and(|number| number.parse::<u64>().is_ok());
    words.clone().find(is_id).unwrap_or_else(|| panic!("no id in {text}")).to_owned()
}

pub(super) fn page(relay: &Relay, rest: &str) -> String {
    format!("{}code{rest}", relay.page())
}

/// The code that is shown, without its line numbers.
async fn code(user: &Browser) -> String {
    user.find("code", &part("code"), PATIENCE).await;
    let script = "return [...document.querySelectorAll('.code-line')].map(line => line.textContent).join('')";
    user.script(script).await.as_str().expect("a text").to_owned()
}

/// As a paste: keys would be one event for each letter.
async fn paste(user: &Browser, text: &str) {
    user.find("the field", &part("code-text"), PATIENCE).await;
    let script = format!(
        "const area = document.getElementById('code-text'); area.value = {}; \
         area.dispatchEvent(new InputEvent('input', {{ bubbles: true }})); return 0",
        Value::from(text)
    );
    user.script(&script).await;
}

async fn fill_name(user: &Browser, name: &str) {
    user.fill_at(&part("name"), "the block's name", name).await;
}

fn written(folder: &Path, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, bytes).expect("the file is written");
    path
}

async fn choose(user: &Browser, mark: &str, files: &[PathBuf]) {
    let paths: Vec<_> = files.iter().map(|file| file.display().to_string()).collect();
    let input = user.driver().find(By::XPath(part(mark))).await.expect("the field for files");
    input.send_keys(paths.join("\n")).await.expect("files are chosen");
}

/// In the other theme and in a narrow window.
pub(super) async fn looks(user: &mut Browser, stage: &str) {
    user.click_part("theme").await;
    fits(user, &format!("{stage}-other-theme")).await;
    user.resize(900, 1000).await;
    fits(user, &format!("{stage}-narrow")).await;
    user.click_part("theme").await;
    fits(user, &format!("{stage}-narrow-theme")).await;
    user.resize(1280, 860).await;
}

async fn fits(user: &mut Browser, stage: &str) {
    user.shot(stage).await;
    let excess = "return document.scrollingElement.scrollWidth - window.innerWidth";
    let excess = user.script(excess).await.as_i64().expect("a number");
    assert!(excess <= 0, "{stage}: {excess} px stick out");
}

//! `cipdeck project`: the folder of a project on the command line, without a relay.

use std::fs;
use std::path::{Path, PathBuf};

use cipdeck_tests::command::{Ended, cipdeck, program};
use cipdeck_tests::tools;
use serde_json::json;
use tempfile::TempDir;

use super::project::{utf8, zip};

const HEAD: &str = "{\"project\": 1, \"name\": \"plant\"}";

#[tokio::test]
async fn a_folder_goes_into_an_archive_and_comes_back_the_same() {
    let folder = plant();
    fs::create_dir(folder.path().join(".git")).expect("a folder");
    write(&folder, ".git/config", "{}");
    write(&folder, "README.md", "ours");
    let (first, second) = (folder.path().join("a.zip"), folder.path().join("b.zip"));
    for archive in [&first, &second] {
        let packed = pack(folder.path(), archive).await;
        assert_eq!(packed.code, 0, "{packed:?}");
    }
    assert_eq!(
        fs::read(&first).expect("a file"),
        fs::read(&second).expect("a file"),
        "equal files, equal bytes"
    );

    let back = folder.path().join("new/back");
    let unpacked = unpack(&first, &back).await;
    assert_eq!((unpacked.code, unpacked.stderr.as_str()), (0, ""), "{unpacked:?}");
    assert_eq!(
        files(&back),
        ["blocks/drive.json", "cipdeck.json", "groups/nx-1/line-4.json", "targets/nx-1.json"]
    );
    for root in [folder.path(), &back] {
        let checked = cipdeck(&["check", "--json", utf8(&root.join("blocks/drive.json"))]).await;
        assert_eq!(
            (checked.code, &checked.json()["request"]),
            (0, &json!("0e03200124013007")),
            "{checked:?}"
        );
    }
    let again = folder.path().join("c.zip");
    assert_eq!(pack(&back, &again).await.code, 0);
    assert_eq!(fs::read(&again).expect("a file"), fs::read(&first).expect("a file"), "and once more");
    let checked = check(&back).await;
    assert_eq!(
        (checked.code, checked.stdout.lines().last()),
        (0, Some("1 block, 1 target, 1 group: 0 errors")),
        "{checked:?}"
    );
}

#[tokio::test]
async fn what_cannot_be_read_is_not_packed() {
    let folder = plant();
    let archive = folder.path().join("x.zip");
    write(&folder, "blocks/drive.json", "{\n  \"name\": \"x\",\n  \"AppCfg\": 5\n}");
    let packed = pack(folder.path(), &archive).await;
    assert_eq!(packed.code, 2, "{packed:?}");
    assert!(packed.stderr.contains("error: blocks/drive.json:3:13: "), "{packed:?}");
    assert_eq!(fs::read(&archive).expect("what went to standard output"), b"", "{packed:?}");
    // Wrong numbers are: they are somebody's work, and said.
    write(&folder, "blocks/drive.json", &block(300));
    let packed = pack(folder.path(), &archive).await;
    assert_eq!(packed.code, 0, "{packed:?}");
    assert!(
        packed.stderr.contains("error: blocks/drive.json:1:") && packed.stderr.contains("AppCfg.Service"),
        "{packed:?}"
    );
    let packed = pack(&folder.path().join("nowhere"), &archive).await;
    assert!(
        packed.code == 2 && packed.stderr.contains("cannot read") && packed.stderr.contains("nowhere"),
        "{packed:?}"
    );
    assert!(!folder.path().join("nowhere").exists(), "nothing is made");
}

#[tokio::test]
async fn what_is_there_is_not_unpacked_over_and_what_is_wrong_not_at_all() {
    let folder = TempDir::new().expect("a folder");
    let archive = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).expect("an archive");
        path
    };
    let good = archive(
        "good.zip",
        &zip(&[("cipdeck.json", HEAD), ("blocks/a.json", &block(14)), ("notes.txt", "x")]),
    );
    let into = folder.path().join("into");
    let unpacked = unpack(&good, &into).await;
    assert_eq!(unpacked.code, 0, "{unpacked:?}");
    assert!(unpacked.stderr.contains("notes.txt is no file of a project, and is left out"), "{unpacked:?}");
    let before = fs::read_to_string(into.join("blocks/a.json")).expect("a file");
    let other = archive("other.zip", &zip(&[("cipdeck.json", HEAD), ("blocks/a.json", &block(1))]));
    let refused = unpack(&other, &into).await;
    assert!(refused.code == 2 && refused.stderr.contains("has a project already"), "{refused:?}");
    assert_eq!(fs::read_to_string(into.join("blocks/a.json")).expect("a file"), before);

    for (name, bytes, told) in [
        ("text.zip", b"no archive".to_vec(), "not a zip archive"),
        ("out.zip", zip(&[("../x.json", "{}")]), "leaves the project"),
        (
            "broken.zip",
            zip(&[("cipdeck.json", HEAD), ("blocks/a.json", "{")]),
            "error: blocks/a.json:1:1: this is not JSON",
        ),
        ("new.zip", zip(&[("cipdeck.json", "{\"project\": 7}")]), "use a newer cipdeck"),
    ] {
        let nowhere = folder.path().join("nowhere");
        let refused = unpack(&archive(name, &bytes), &nowhere).await;
        assert!(refused.code == 2 && refused.stderr.contains(told), "{name}: {refused:?}");
        assert!(!nowhere.exists(), "{name}: nothing is made");
    }
    let refused = unpack(&folder.path().join("none.zip"), &folder.path().join("x")).await;
    assert!(refused.code == 2 && refused.stderr.contains("none.zip"), "{refused:?}");
}

#[tokio::test]
async fn a_check_tells_everything_with_its_place_also_to_machines() {
    let folder = plant();
    write(&folder, "blocks/other.json", &block(300));
    write(&folder, "blocks/Other.json", &block(14));
    write(&folder, "targets/nx-1.json", "{\"name\": \"NX 1\", \"path\": \"0,0\", \"pth\": 1}");
    let checked = check(folder.path()).await;
    assert_eq!(checked.code, 2, "{checked:?}");
    for told in [
        "error: blocks/other.json: many file systems cannot tell this name from blocks/Other.json",
        "error: blocks/other.json:1:",
        "warning: targets/nx-1.json:1:33: this version does not know the member `pth`",
        "3 blocks, 1 target, 1 group: 2 errors",
    ] {
        assert!(checked.stdout.contains(told), "{told}\n{}", checked.stdout);
    }
    let checked = cipdeck(&["project", "check", "--json", utf8(folder.path())]).await;
    assert_eq!(checked.code, 2, "{checked:?}");
    let all = checked.json();
    let errors =
        all["findings"].as_array().expect("findings").iter().filter(|one| one["severity"] == "error");
    assert_eq!(errors.count(), 2, "{all}");

    // Warnings alone are no failure: a hook may go on.
    fs::remove_file(folder.path().join("blocks/other.json")).expect("removed");
    assert_eq!(check(folder.path()).await.code, 0);
    let none = check(&folder.path().join("nowhere")).await;
    assert!(none.code == 2 && none.stderr.contains("nowhere"), "{none:?}");
    assert!(!folder.path().join("nowhere").exists(), "nothing is made");
    let file = check(&folder.path().join("cipdeck.json")).await;
    assert!(file.code == 2 && file.stderr.contains("cannot read"), "{file:?}");
}

/// A block, a device, a group: written by hand.
fn plant() -> TempDir {
    let folder = TempDir::new().expect("a folder");
    for path in ["blocks", "targets", "groups/nx-1"] {
        fs::create_dir_all(folder.path().join(path)).expect("a folder");
    }
    write(&folder, "cipdeck.json", HEAD);
    write(&folder, "blocks/drive.json", &block(14));
    write(&folder, "targets/nx-1.json", "{\"name\": \"NX 1\", \"path\": \"0,0\"}");
    write(&folder, "groups/nx-1/line-4.json", "{\"name\": \"line 4\", \"period_ms\": 500}");
    folder
}

fn block(service: u32) -> String {
    json!({ "name": "drive", "AppCfg": { "Service": service, "Class": 1, "Instance": 1, "Attribute": 7,
        "MemberCnt": 0, "MemberId": [0, 0, 0] }, "TargetCfg": { "Path": "0,0" }, "ReqData": "" })
    .to_string()
}

fn write(folder: &TempDir, path: &str, text: &str) {
    fs::write(folder.path().join(path), text).expect("a file");
}

async fn check(folder: &Path) -> Ended {
    cipdeck(&["project", "check", utf8(folder)]).await
}

/// As people do it: what goes to standard output goes into a file.
async fn pack(folder: &Path, archive: &Path) -> Ended {
    let cipdeck = tools::cipdeck();
    let script = "exec \"$0\" project pack \"$1\" > \"$2\"";
    program(Path::new("sh"), &["-c", script, utf8(&cipdeck), utf8(folder), utf8(archive)]).await
}

async fn unpack(archive: &Path, folder: &Path) -> Ended {
    cipdeck(&["project", "unpack", utf8(archive), utf8(folder)]).await
}

/// Of a folder, with `/`, sorted.
fn files(root: &Path) -> Vec<String> {
    let (mut found, mut open): (Vec<String>, Vec<PathBuf>) = (Vec::new(), vec![root.to_owned()]);
    while let Some(at) = open.pop() {
        for entry in fs::read_dir(at).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else {
                found.push(utf8(path.strip_prefix(root).expect("inside")).to_owned());
            }
        }
    }
    found.sort();
    found
}

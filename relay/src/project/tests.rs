use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use cipdeck_shared::config::project::{read, write_block};
use cipdeck_shared::config::{
    BlockConfig, Device, DeviceConfig, DeviceId, GroupConfig, MsgCipGeneric, VariableConfig,
};

use super::folder::steps;
use super::journal::{JOURNAL, Journal};
use super::*;
use crate::store::{Change, Fresh, Store, StoreError};

fn block(name: &str) -> BlockConfig {
    MsgCipGeneric { name: name.to_owned(), ..MsgCipGeneric::product_name("0,0") }.into()
}

async fn joined(data: Option<&Path>, root: &Path) -> (Store, Outcome) {
    let store = Store::open(data).await.unwrap();
    let folder = Folder::open(root).unwrap();
    let read = read(folder.files());
    assert!(read.errors.is_empty(), "{:?}", read.errors);
    let outcome = store.join(folder, read, false).await.unwrap();
    (store, outcome)
}

fn files(root: &Path) -> Vec<String> {
    let mut files: Vec<_> = Folder::open(root).unwrap().files().keys().cloned().collect();
    files.sort();
    files
}

#[tokio::test]
async fn every_change_is_in_its_file_before_it_is_stored() {
    let root = tempfile::tempdir().unwrap();
    let (store, _) = joined(None, root.path()).await;
    let made = store.insert(block("Drive 1")).await.unwrap();
    store.insert(block("drive 1")).await.unwrap();
    assert_eq!(files(root.path()), ["blocks/drive-1-2.json", "blocks/drive-1.json", "cipdeck.json"]);
    let Change::Done(made) = store.replace(made.id, 1, block("Pump")).await.unwrap() else { panic!() };
    assert_eq!(files(root.path()), ["blocks/drive-1-2.json", "blocks/pump.json", "cipdeck.json"]);
    store.delete(made.id, 2).await.unwrap();
    assert_eq!(files(root.path()), ["blocks/drive-1-2.json", "cipdeck.json"]);

    let group = GroupConfig::new(DeviceId(0), "line 4");
    let variable = |name: &str, parent| Fresh { config: VariableConfig::new(name, name), parent };
    let variables = vec![variable("motor", None), variable("speed", Some(0))];
    let made = store.add_device(DeviceConfig::new("NX 1", "0,0"), vec![(group, variables)]).await.unwrap();
    let in_group = |name: &str| fs::read_to_string(root.path().join(format!("groups/{name}.json"))).unwrap();
    assert!(in_group("nx-1/line-4").contains("\"parent_address\": \"motor\""));
    let config = DeviceConfig::new("NX 2", "0,0");
    store.put_device(Device { id: made.devices[0].id, revision: 2, config }).await.unwrap();
    assert!(in_group("nx-2/line-4").contains("speed"));
    store.remove_variables(made.groups[0].id, vec![made.variables[1].id]).await.unwrap();
    assert!(!in_group("nx-2/line-4").contains("speed"));
    assert!(!root.path().join("groups/nx-1").exists());
    store.remove_device(made.devices[0].id).await.unwrap();
    assert_eq!(files(root.path()), ["blocks/drive-1-2.json", "cipdeck.json"]);
}

#[tokio::test]
async fn what_cannot_be_written_is_not_stored() {
    let root = tempfile::tempdir().unwrap();
    let (store, _) = joined(None, root.path()).await;
    let made = store.insert(block("a")).await.unwrap();
    let path = root.path().join("blocks/a.json");
    let text = fs::read_to_string(&path).unwrap();
    // Somebody else has changed the file, removed it, made another one.
    fs::write(&path, text.replace("490", "100")).unwrap();
    let refused = store.replace(made.id, 1, block("b")).await.unwrap_err().to_string();
    assert!(refused.starts_with("blocks/a.json was changed by somebody else"), "{refused}");
    fs::remove_file(&path).unwrap();
    let refused = store.delete(made.id, 1).await.unwrap_err().to_string();
    assert!(refused.starts_with("blocks/a.json was removed by somebody else"), "{refused}");
    fs::write(&path, &text).unwrap();
    fs::write(root.path().join("blocks/c.json"), "").unwrap();
    let refused = store.insert(block("c")).await.unwrap_err().to_string();
    assert!(refused.starts_with("blocks/c.json was made by somebody else"), "{refused}");
    assert_eq!(store.load().await.unwrap().len(), 1);
    // What does not concern those files goes on.
    store.insert(block("d")).await.unwrap();
    store.replace(made.id, 1, block("A")).await.unwrap();
}

#[cfg(unix)]
#[tokio::test]
async fn a_change_of_several_files_is_written_whole_or_not_at_all() {
    use std::os::unix::fs::PermissionsExt;
    let root = tempfile::tempdir().unwrap();
    let (store, _) = joined(None, root.path()).await;
    let group = |name: &str| (GroupConfig::new(DeviceId(0), name), Vec::new());
    let made = store.add_device(DeviceConfig::new("x", "0,0"), vec![group("a"), group("b")]).await.unwrap();
    let before = files(root.path());
    let targets = root.path().join("targets");
    fs::set_permissions(&targets, fs::Permissions::from_mode(0o555)).unwrap();
    let device = Device { id: made.devices[0].id, revision: 2, config: DeviceConfig::new("y", "0,0") };
    let refused = store.put_device(device.clone()).await.unwrap_err();
    assert!(matches!(refused, StoreError::Files(FilesError::Write { .. })), "{refused}");
    assert!(
        refused.to_string().contains("targets/y.json in the project's folder cannot be written"),
        "{refused}"
    );
    assert_eq!(store.load_plant().await.unwrap().devices[0].config.name, "x");
    fs::set_permissions(&targets, fs::Permissions::from_mode(0o755)).unwrap();
    assert_eq!(files(root.path()), before);
    store.put_device(device).await.unwrap();
    assert_eq!(files(root.path()), ["cipdeck.json", "groups/y/a.json", "groups/y/b.json", "targets/y.json"]);
}

/// Everything in a folder, also what is hidden.
fn everything(root: &Path) -> BTreeMap<String, String> {
    let mut all = BTreeMap::new();
    let mut open = vec![root.to_owned()];
    while let Some(at) = open.pop() {
        for entry in fs::read_dir(at).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(root).unwrap().to_str().unwrap().to_owned();
                all.insert(name, fs::read_to_string(&path).unwrap());
            }
        }
    }
    all
}

fn put(root: &Path, path: &str, text: Option<&str>) {
    let file = root.join(path);
    match text {
        Some(text) => {
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, text).unwrap();
        }
        None => fs::remove_file(file).unwrap(),
    }
}

#[tokio::test]
async fn wherever_a_rename_is_interrupted_it_is_taken_back_or_was_done() {
    let root = tempfile::tempdir().unwrap();
    let (store, _) = joined(None, root.path()).await;
    let group = |name: &str| (GroupConfig::new(DeviceId(0), name), Vec::new());
    let made = store.add_device(DeviceConfig::new("x", "0,0"), vec![group("a"), group("b")]).await.unwrap();
    let before = everything(root.path());
    let device = Device { id: made.devices[0].id, revision: 2, config: DeviceConfig::new("y", "0,0") };
    store.put_device(device).await.unwrap();
    let after = everything(root.path());
    assert!(!after.keys().any(|path| path.starts_with('.')), "{after:?}");
    let change = store.last_change().await.unwrap().expect("several files were changed");

    let files = before.keys().chain(after.keys()).filter(|path| before.get(*path) != after.get(*path));
    let changes: BTreeMap<_, _> = files.map(|path| (path.clone(), after.get(path).cloned())).collect();
    assert_eq!(changes.len(), 6);
    let journal = Journal::of(&change, &before, &changes);
    for done in 0..=changes.len() {
        let root = tempfile::tempdir().unwrap();
        for (path, text) in &before {
            put(root.path(), path, Some(text));
        }
        put(root.path(), JOURNAL, Some(&journal.text().unwrap()));
        put(root.path(), "targets/.y.json.new", Some("{"));
        for (path, text) in steps(&changes).take(done) {
            put(root.path(), path, text.as_deref());
        }
        let refused = Folder::open(root.path()).unwrap_err().to_string();
        assert!(refused.contains(JOURNAL), "{refused}");
        let repaired = Folder::repair(root.path(), Some("another change")).unwrap();
        assert_eq!(repaired.len(), 6, "after {done} steps");
        Folder::open(root.path()).unwrap();
        assert_eq!(everything(root.path()), before, "after {done} steps");
        assert_eq!(Folder::repair(root.path(), None).unwrap(), Vec::<String>::new());
    }

    // The database has it: only the journal is too much.
    put(root.path(), JOURNAL, Some(&journal.text().unwrap()));
    assert_eq!(Folder::repair(root.path(), Some(&change)).unwrap().len(), 6);
    assert_eq!(everything(root.path()), after);

    // Somebody has gone on meanwhile: nothing is touched.
    put(root.path(), JOURNAL, Some(&journal.text().unwrap()));
    put(root.path(), "targets/y.json", Some("{}"));
    let there = everything(root.path());
    let refused = Folder::repair(root.path(), None).unwrap_err().to_string();
    assert!(refused.contains("somebody has changed targets/y.json since"), "{refused}");
    assert_eq!(everything(root.path()), there);
}

#[cfg(unix)]
#[tokio::test]
async fn links_are_neither_read_nor_written_through() {
    use std::os::unix::fs::symlink;
    let (root, elsewhere) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let (store, _) = joined(None, root.path()).await;
    let made = store.insert(block("a")).await.unwrap();
    fs::rename(root.path().join("blocks"), elsewhere.path().join("blocks")).unwrap();
    symlink(elsewhere.path().join("blocks"), root.path().join("blocks")).unwrap();
    let refused = store.replace(made.id, 1, block("b")).await.unwrap_err().to_string();
    assert!(refused.contains("is behind a link"), "{refused}");
    let refused = Folder::open(root.path()).unwrap_err().to_string();
    assert!(refused.contains("blocks: this is a link"), "{refused}");
}

#[tokio::test]
async fn members_that_nobody_knows_survive_a_change_of_devices_groups_and_variables() {
    let root = tempfile::tempdir().unwrap();
    let at = |path: &str| root.path().join(path);
    for folder in ["targets", "groups/nx"] {
        fs::create_dir_all(at(folder)).unwrap();
    }
    fs::write(at("cipdeck.json"), r#"{"project": 1, "name": "x", "owner": "y"}"#).unwrap();
    fs::write(at("targets/nx.json"), r#"{"rack": "7b", "name": "NX", "path": "0,0"}"#).unwrap();
    let group = r#"{"shift": 2, "name": "line", "variables": [{"note": [1], "name": "a", "address": "a"}]}"#;
    fs::write(at("groups/nx/line.json"), group).unwrap();
    let (store, _) = joined(None, root.path()).await;
    let stored = store.load_plant().await.unwrap();
    let config = DeviceConfig::new("NX 2", "0,0");
    store.put_device(Device { revision: 2, config, ..stored.devices[0].clone() }).await.unwrap();
    let mut variable = stored.variables[0].clone();
    variable.config.unit = "m".to_owned();
    store.put_variable(variable).await.unwrap();
    let written = read(Folder::open(root.path()).unwrap().files()).project;
    let target = &written.targets["nx-2"];
    let group = &target.groups["line"];
    assert_eq!((&target.extra["rack"], &group.extra["shift"]), (&"7b".into(), &2.into()));
    assert_eq!(group.variables[0].extra["note"], serde_json::json!([1]));
    assert_eq!(
        (written.head.extra["owner"].as_str(), group.variables[0].config.unit.as_str()),
        (Some("y"), "m")
    );
}

#[tokio::test]
async fn ids_stay_with_their_files_and_names() {
    let (data, root) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let path = data.path().join("cipdeck.sqlite");
    let (store, _) = joined(Some(&path), root.path()).await;
    for name in ["a", "b", "c", "d"] {
        store.insert(block(name)).await.unwrap();
    }
    store.close().await;
    // By hand: a renamed in the file, b as a file, c removed, e new, d as it was.
    let at = |name: &str| root.path().join(format!("blocks/{name}.json"));
    fs::write(at("a"), write_block(&block("A"))).unwrap();
    fs::rename(at("b"), at("moved")).unwrap();
    fs::remove_file(at("c")).unwrap();
    fs::write(at("e"), write_block(&block("e"))).unwrap();
    let (store, outcome) = joined(Some(&path), root.path()).await;
    let told: Vec<_> = outcome
        .parts
        .iter()
        .map(|part| {
            let how = format!("{:?}", part.how);
            (part.id.clone().unwrap_or_default(), how, part.file.clone().unwrap_or_default())
        })
        .collect();
    let told: Vec<_> =
        told.iter().map(|(id, how, file)| (id.as_str(), how.as_str(), file.as_str())).collect();
    assert_eq!(
        told,
        [
            ("b1", "Changed", "blocks/a.json"),
            ("b4", "Unchanged", "blocks/d.json"),
            ("b5", "Created", "blocks/e.json"),
            ("b2", "Unchanged", "blocks/moved.json"),
            ("b3", "Removed", "blocks/c.json"),
        ]
    );
    let stored = store.load().await.unwrap();
    let stored: Vec<_> =
        stored.iter().map(|one| (one.block.id.0, one.block.revision, one.block.config.name())).collect();
    assert_eq!(stored, [(1, 2, "A"), (2, 1, "b"), (4, 1, "d"), (5, 1, "e")]);
    assert!(at("moved").exists() && at("a").exists(), "files stay as people have called them");
    store.close().await;
    // A folder that is not this project: nothing is lost.
    let store = Store::open(Some(&path)).await.unwrap();
    let empty = Folder::open(&root.path().join("empty")).unwrap();
    let read = read(empty.files());
    let refused = store.join(empty, read, false).await.unwrap_err().to_string();
    assert!(refused.contains("is it the right folder?"), "{refused}");
    assert_eq!(store.load().await.unwrap().len(), 4);
}

#[tokio::test]
async fn what_only_the_database_has_is_written_into_a_new_project() {
    let (data, root) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let path = data.path().join("cipdeck.sqlite");
    let store = Store::open(Some(&path)).await.unwrap();
    store.insert(block("a")).await.unwrap();
    store.insert(block("a")).await.unwrap();
    store.close().await;
    fs::create_dir(root.path().join("blocks")).unwrap();
    fs::write(root.path().join("blocks/x.json"), write_block(&block("x"))).unwrap();
    let (store, _) = joined(Some(&path), root.path()).await;
    assert_eq!(store.load().await.unwrap().len(), 3);
    assert_eq!(files(root.path()), ["blocks/a-2.json", "blocks/a.json", "blocks/x.json", "cipdeck.json"]);
}

#[tokio::test]
async fn loose_blocks_become_a_project_and_stay_where_they_are() {
    let root = tempfile::tempdir().unwrap();
    let text = write_block(&block("x")).replacen("{\n", "{\n  \"id\": \"b9\",\n  \"revision\": 4,\n", 1);
    fs::write(root.path().join("Drive.json"), &text).unwrap();
    let (_, outcome) = joined(None, root.path()).await;
    assert_eq!(outcome.parts.len(), 1);
    assert_eq!(files(root.path()), ["blocks/Drive.json", "cipdeck.json"]);
    assert_eq!(fs::read_to_string(root.path().join("Drive.json")).unwrap(), text);
    assert_eq!(fs::read_to_string(root.path().join("blocks/Drive.json")).unwrap(), write_block(&block("x")));
}

#[tokio::test]
async fn a_save_without_a_change_leaves_what_people_have_written() {
    let root = tempfile::tempdir().unwrap();
    let by_hand = "{\"Note\": 1.50, \"name\":\"x\",\n\t\"AppCfg\":{\"Service\":14,\"Class\":1,\"Instance\":1,\"Attribute\":7},\"ReqData\":\"0A 0B\",\"TargetCfg\":{\"Path\":\"0,0\"}}";
    fs::create_dir(root.path().join("blocks")).unwrap();
    let file = root.path().join("blocks/x.json");
    fs::write(&file, by_hand).unwrap();
    let (store, _) = joined(None, root.path()).await;
    let there = store.load().await.unwrap().remove(0).block;
    let Change::Done(again) = store.replace(there.id, 1, there.config.clone()).await.unwrap() else {
        panic!()
    };
    assert_eq!((again.revision, fs::read_to_string(&file).unwrap().as_str()), (2, by_hand));
    let mut changed = there.config;
    if let BlockConfig::MsgCipGeneric(config) = &mut changed {
        config.app_cfg.attribute = 6;
    }
    store.replace(there.id, 2, changed.clone()).await.unwrap();
    assert_eq!(fs::read_to_string(&file).unwrap(), write_block(&changed));
    assert!(write_block(&changed).contains("\"Note\": 1.5"));
}

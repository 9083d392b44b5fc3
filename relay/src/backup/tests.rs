//! There and back, while somebody writes, and with what somebody has made up.

use std::fs;

use cipdeck_shared::config::MsgCipGeneric;
use tempfile::TempDir;

use super::*;
use crate::audit::{Audit, Event, Record, verify_folder};
use crate::store::Store;

fn config(name: &str) -> MsgCipGeneric {
    let mut config = MsgCipGeneric::product_name("0,0");
    config.name = name.to_owned();
    config
}

/// A data folder with one block and two records.
async fn filled(folder: &Path) -> (Store, Audit) {
    let store = Store::open(Some(&folder.join("cipdeck.sqlite"))).await.unwrap();
    store.insert(config("drive-current").into()).await.unwrap();
    let audit = Audit::open(Some(folder)).unwrap();
    for _ in 0..2 {
        audit.append(&Record::new(Event::SignIn, "anna", "")).unwrap();
    }
    crate::tls::Tls::self_signed(Some(folder), vec!["localhost".to_owned()]).unwrap();
    fs::write(folder.join("read-only"), "").unwrap();
    (store, audit)
}

async fn block_names(folder: &Path) -> Vec<String> {
    let store = Store::open(Some(&folder.join("cipdeck.sqlite"))).await.unwrap();
    let names =
        store.load().await.unwrap().into_iter().map(|stored| stored.block.config.name().to_owned()).collect();
    store.close().await;
    names
}

#[tokio::test]
async fn a_relay_that_is_writing_is_copied_and_comes_back_as_it_was() {
    let (data, place) = (TempDir::new().unwrap(), TempDir::new().unwrap());
    let (store, audit) = filled(data.path()).await;
    let file = place.path().join("monday.tar");
    make(data.path(), &file, true).unwrap();
    // What comes later is not in it.
    store.insert(config("later").into()).await.unwrap();
    audit.append(&Record::new(Event::SignOut, "anna", "")).unwrap();

    let back = place.path().join("back");
    restore(&file, &back).unwrap();
    assert_eq!(block_names(&back).await, ["drive-current"]);
    assert_eq!(verify_folder(&back).unwrap().unwrap().records, 2);
    for name in ["tls/cert.pem", "tls/key.pem", "read-only"] {
        assert_eq!(fs::read(back.join(name)).unwrap(), fs::read(data.path().join(name)).unwrap(), "{name}");
    }
    // It goes on from there.
    Audit::open(Some(&back)).unwrap().append(&Record::new(Event::WritePermitted, "anna", "")).unwrap();
    let left: Vec<_> = fs::read_dir(place.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left.len(), 2, "nothing else is left behind: {left:?}");
}

#[tokio::test]
async fn nothing_is_overwritten() {
    let (data, place) = (TempDir::new().unwrap(), TempDir::new().unwrap());
    let kept = filled(data.path()).await;
    let file = place.path().join("monday.tar");
    make(data.path(), &file, true).unwrap();
    assert!(matches!(make(data.path(), &file, true), Err(BackupError::Exists(_))));
    assert!(matches!(restore(&file, data.path()), Err(BackupError::Exists(_))));
    assert!(matches!(make(place.path(), &place.path().join("x"), true), Err(BackupError::NoDatabase(_))));
    drop(kept);
}

#[cfg(unix)]
#[tokio::test]
async fn nobody_else_can_read_a_backup_or_what_it_was_restored_to() {
    use std::os::unix::fs::PermissionsExt;
    let (data, place) = (TempDir::new().unwrap(), TempDir::new().unwrap());
    let kept = filled(data.path()).await;
    let (file, back) = (place.path().join("monday.tar"), place.path().join("back"));
    make(data.path(), &file, true).unwrap();
    restore(&file, &back).unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o077;
    for path in [file, back.clone(), back.join("cipdeck.sqlite"), back.join("tls"), back.join("tls/key.pem")]
    {
        assert_eq!(mode(&path), 0, "{}", path.display());
    }
    drop(kept);
}

#[tokio::test]
async fn a_damaged_backup_restores_nothing() {
    let (data, place) = (TempDir::new().unwrap(), TempDir::new().unwrap());
    let kept = filled(data.path()).await;
    let (file, back) = (place.path().join("monday.tar"), place.path().join("back"));
    make(data.path(), &file, true).unwrap();
    let whole = fs::read(&file).unwrap();
    let refused = |bytes: &[u8]| {
        let path = place.path().join("damaged.tar");
        fs::write(&path, bytes).unwrap();
        let words = restore(&path, &back).unwrap_err().to_string();
        assert!(!back.exists() && !place.path().join("back.restoring").exists(), "{words}");
        words
    };
    let at = whole.windows(12).position(|window| window == b"SQLite forma").unwrap();
    let mut changed = whole.clone();
    changed[at + 200] ^= 1;
    assert!(refused(&changed).contains("cipdeck.sqlite is not as it was"));
    refused(&whole[..at + 4096]);
    assert!(refused(b"").contains("does not begin with backup.json"));
    refused(&vec![b'x'; 4096]);
    drop(kept);
}

#[test]
fn names_that_lead_elsewhere_are_refused() {
    for name in ["../x", "/etc/passwd", "tls/../../x", "audit-broken-../x.jsonl", "relay.lock", ""] {
        assert!(!is_known(name), "{name}");
    }
    assert!(is_known("audit-broken-20261122T101010.jsonl"));
    let place = TempDir::new().unwrap();
    let path = place.path().join("made-up.tar");
    let mut archive = tar::Builder::new(File::create(&path).unwrap());
    let manifest = r#"{"cipdeck":"0","at":"","files":[{"name":"../x","bytes":1,"sha256":""}]}"#;
    for (name, text) in [(MANIFEST, manifest), ("x", "x")] {
        let mut header = tar::Header::new_gnu();
        header.set_size(text.len() as u64);
        if name == "x" {
            header.as_old_mut().name[..4].copy_from_slice(b"../x");
            header.set_cksum();
            archive.append(&header, text.as_bytes()).unwrap();
        } else {
            archive.append_data(&mut header, name, text.as_bytes()).unwrap();
        }
    }
    drop(archive.into_inner().unwrap());
    let words = restore(&path, &place.path().join("back")).unwrap_err().to_string();
    assert!(words.contains("does not belong there"), "{words}");
    assert!(!place.path().join("x").exists());
}

//! What is done to the file, and what is found.

use std::fs;
use std::io;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use proptest::prelude::*;
use tempfile::TempDir;

use super::head::{HEAD, Head};
use super::keeper::take_care;
use super::medium::{AppendError, Medium};
use super::verify::Verified;
use super::*;

fn record(event: Event) -> Record {
    Record::new(event, "anna", "10.0.0.7").with("block", "b7").with("new", "0a00")
}

/// A folder with the audit of a relay that has stopped.
fn folder(records: usize) -> TempDir {
    let folder = TempDir::new().unwrap();
    let audit = Audit::open(Some(folder.path())).unwrap();
    for _ in 0..records {
        audit.append(&record(Event::WritePermitted)).unwrap();
    }
    folder
}

fn verified(folder: &Path) -> Result<Verified, String> {
    verify_folder(folder).unwrap()
}

fn lines(folder: &Path) -> Vec<String> {
    fs::read_to_string(folder.join(FILE)).unwrap().lines().map(|line| format!("{line}\n")).collect()
}

fn write_lines(folder: &Path, lines: &[String]) {
    fs::write(folder.join(FILE), lines.concat()).unwrap();
}

#[test]
fn records_survive_a_restart_and_the_chain_goes_on() {
    let folder = folder(3);
    let audit = Audit::open(Some(folder.path())).unwrap();
    audit.append(&record(Event::SignIn)).unwrap();
    let state = audit.state();
    assert_eq!((state.records, state.writable, state.verified), (4, true, true));
    let found = verified(folder.path()).unwrap();
    assert_eq!(found.records, 4);
    assert!(found.notes.is_empty(), "{found:?}");
}

#[test]
fn nothing_is_lost_when_the_process_ends_without_a_word() {
    let folder = folder(0);
    let audit = Audit::open(Some(folder.path())).unwrap();
    for _ in 0..100 {
        audit.append(&record(Event::WritePermitted)).unwrap();
    }
    // Neither dropped nor asked to wait: what counts is what others can read by now.
    assert_eq!(verified(folder.path()).unwrap().records, 100);
}

#[test]
fn a_removed_doubled_or_moved_line_is_found() {
    type Change = fn(&mut Vec<String>);
    let changes: [(&str, Change); 6] = [
        ("line 1", |lines| drop(lines.remove(0))),
        ("line 3", |lines| drop(lines.remove(2))),
        ("line 4", |lines| lines.insert(2, lines[2].clone())),
        ("line 3", |lines| lines.swap(2, 3)),
        ("record 5 is missing at the end", |lines| drop(lines.pop())),
        ("records 1 to 5 are missing at the end", Vec::clear),
    ];
    for (expected, change) in changes {
        let folder = folder(5);
        let mut lines = lines(folder.path());
        change(&mut lines);
        write_lines(folder.path(), &lines);
        let found = verified(folder.path()).unwrap_err();
        assert!(found.contains(expected), "{expected}: {found}");
        assert!(!Audit::open(Some(folder.path())).unwrap().is_writable(), "{expected}");
    }
}

#[test]
fn a_missing_file_or_head_is_found() {
    for (name, expected) in [(FILE, "audit.jsonl is missing"), (HEAD, "audit.head is missing")] {
        let folder = folder(2);
        fs::remove_file(folder.path().join(name)).unwrap();
        assert!(verified(folder.path()).unwrap_err().contains(expected));
        assert!(!Audit::open(Some(folder.path())).unwrap().is_writable(), "{name}");
    }
}

#[test]
fn a_record_that_was_never_finished_is_no_break() {
    let folder = folder(3);
    let path = folder.path().join(FILE);
    let mut bytes = fs::read(&path).unwrap();
    bytes.extend_from_slice(b"{\"seq\":4,\"at\":\"2026-");
    fs::write(&path, bytes).unwrap();
    assert_eq!(
        verified(folder.path()).unwrap().notes,
        ["20 bytes of a record that was never finished follow"]
    );
    let audit = Audit::open(Some(folder.path())).unwrap();
    audit.append(&record(Event::WritePermitted)).unwrap();
    assert_eq!(verified(folder.path()).unwrap().records, 4);
}

#[test]
fn a_break_stops_writes_until_it_is_accepted_and_everything_else_is_recorded() {
    let folder = folder(5);
    let mut changed = lines(folder.path());
    changed[2] = changed[2].replace("anna", "emma");
    write_lines(folder.path(), &changed);

    let audit = Audit::open(Some(folder.path())).unwrap();
    assert!(!audit.is_writable());
    assert!(matches!(audit.append(&record(Event::WritePermitted)), Err(AuditError::Broken(_))));
    audit.append(&record(Event::WriteDenied)).unwrap();
    drop(audit);
    let found = verified(folder.path()).unwrap_err();
    assert!(found.contains("nobody has accepted: line 3: its content does not match its hash"), "{found}");
    let kept = fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .find(|name| name.starts_with("audit-broken-"))
        .expect("the broken file is kept");
    assert_eq!(fs::read_to_string(folder.path().join(&kept)).unwrap(), changed.concat());

    // A restart heals nothing.
    let audit = Audit::open(Some(folder.path())).unwrap();
    assert!(!audit.is_writable());
    assert_eq!(audit.state().records, 7, "numbers go on");
    assert!(accept(folder.path(), "root").unwrap().is_some());
    take_care(&audit.0.shared, folder.path());
    assert!(audit.is_writable());
    audit.append(&record(Event::WritePermitted)).unwrap();
    drop(audit);
    let found = verified(folder.path()).unwrap();
    assert_eq!(found.records, 4);
    assert_eq!(found.notes, ["begins with record 6, after a break that was accepted"]);
    assert_eq!(accept(folder.path(), "root"), Ok(None), "nothing is left to accept");
}

#[test]
fn an_acceptance_is_good_for_the_break_that_was_looked_at_only() {
    let folder = folder(2);
    fs::remove_file(folder.path().join(FILE)).unwrap();
    drop(Audit::open(Some(folder.path())).unwrap());
    accept(folder.path(), "root").unwrap();
    // Before the relay takes it up, something else is broken.
    fs::remove_file(folder.path().join(FILE)).unwrap();
    assert!(!Audit::open(Some(folder.path())).unwrap().is_writable());
}

#[test]
fn a_file_that_is_touched_while_the_relay_runs_stops_writes() {
    let touch: [fn(&Path); 4] = [
        |path| fs::remove_file(path).unwrap(),
        |path| fs::rename(path, path.with_extension("old")).unwrap(),
        |path| fs::write(path, "").unwrap(),
        |path| {
            let copy = fs::read(path).unwrap();
            fs::remove_file(path).unwrap();
            fs::write(path, copy).unwrap();
        },
    ];
    for touch in touch {
        let folder = folder(0);
        let audit = Audit::open(Some(folder.path())).unwrap();
        audit.append(&record(Event::WritePermitted)).unwrap();
        touch(&folder.path().join(FILE));
        audit.append(&record(Event::WritePermitted)).unwrap_err();
        assert!(!audit.is_writable());
        audit.append(&record(Event::SignIn)).unwrap();
        let state = audit.state();
        assert!(state.trouble.unwrap().contains("audit accept"));
        assert_eq!(lines(folder.path()).len(), 2);
    }
}

/// A disk that can be full.
struct Full {
    lines: Vec<u8>,
    full: Arc<AtomicBool>,
}

impl Medium for Full {
    fn append(&mut self, bytes: &[u8]) -> Result<(), AppendError> {
        if self.full.load(Ordering::Relaxed) {
            return Err(AppendError::Failed(io::Error::from(io::ErrorKind::StorageFull)));
        }
        self.lines.extend_from_slice(bytes);
        Ok(())
    }

    fn set_aside(&mut self) -> io::Result<String> {
        self.lines.clear();
        Ok("kept".to_owned())
    }

    fn file(&self) -> Option<Arc<fs::File>> {
        None
    }

    fn length(&self) -> u64 {
        self.lines.len() as u64
    }

    fn memory(&self) -> Option<Vec<u8>> {
        Some(self.lines.clone())
    }
}

#[test]
fn a_full_disk_stops_writes_until_there_is_room_and_what_was_lost_is_counted() {
    let full = Arc::new(AtomicBool::new(false));
    let medium = Full { lines: Vec::new(), full: Arc::clone(&full) };
    let mut log = Log::new(Box::new(medium), Head::NONE, true);
    log.append(&record(Event::WritePermitted)).unwrap();
    full.store(true, Ordering::Relaxed);
    for _ in 0..3 {
        assert!(matches!(log.append(&record(Event::WritePermitted)), Err(AuditError::Failed(_))));
    }
    assert!(log.trouble().unwrap().to_string().contains("writes to devices are stopped until it can"));
    log.resume().unwrap_err();
    full.store(false, Ordering::Relaxed);
    log.resume().unwrap();
    assert!(log.trouble().is_none());
    log.append(&record(Event::WritePermitted)).unwrap();
    let text = String::from_utf8(log.medium().memory().unwrap()).unwrap();
    assert_eq!(text.lines().count(), 3);
    assert!(text.lines().nth(1).unwrap().contains("\"not_recorded\":3"), "{text}");
}

#[test]
fn a_break_that_is_found_while_the_disk_is_full_is_told_first_when_there_is_room() {
    let full = Arc::new(AtomicBool::new(true));
    let medium = Full { lines: Vec::new(), full: Arc::clone(&full) };
    let mut log = Log::new(Box::new(medium), Head::NONE, true);
    log.break_off("somebody was here").unwrap_err();
    log.append(&record(Event::SignIn)).unwrap_err();
    full.store(false, Ordering::Relaxed);
    log.append(&record(Event::SignIn)).unwrap();
    let text = String::from_utf8(log.medium().memory().unwrap()).unwrap();
    let events: Vec<_> = text.lines().map(|line| line::read(line.as_bytes()).unwrap().event).collect();
    assert_eq!(events, ["chain_broken", "audit_resumed", "sign_in"]);
    assert!(matches!(log.append(&record(Event::WritePermitted)), Err(AuditError::Broken(_))));
    log.accept(1, "root").unwrap();
    log.append(&record(Event::WritePermitted)).unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn a_write_that_is_cut_short_leaves_no_half_line() {
    let folder = folder(1);
    let Some(small) = SmallDisk::mount(folder.path()) else { return };
    let audit = Audit::open(Some(&small.0)).unwrap();
    let long = record(Event::WritePermitted).with("request", "00".repeat(700));
    while audit.append(&long).is_ok() {}
    let found = verified(&small.0).unwrap();
    assert!(found.records > 5 && found.notes.is_empty(), "{found:?}");
    fs::remove_file(small.0.join("ballast")).unwrap();
    audit.append(&long).unwrap();
    assert!(audit.is_writable());
    drop(audit);
    verified(&small.0).unwrap();
}

/// A file system of 64 KiB; only root can make one.
#[cfg(target_os = "linux")]
struct SmallDisk(PathBuf);

#[cfg(target_os = "linux")]
impl SmallDisk {
    fn mount(folder: &Path) -> Option<Self> {
        let path = folder.join("small");
        fs::create_dir(&path).unwrap();
        let mounted = std::process::Command::new("mount")
            .args(["-t", "tmpfs", "-o", "size=64k", "tmpfs"])
            .arg(&path)
            .stderr(std::process::Stdio::null())
            .status();
        if !mounted.is_ok_and(|status| status.success()) {
            return None;
        }
        fs::write(path.join("ballast"), vec![0; 16 * 1024]).unwrap();
        Some(Self(path))
    }
}

#[cfg(target_os = "linux")]
impl Drop for SmallDisk {
    fn drop(&mut self) {
        let _ = std::process::Command::new("umount").arg("-l").arg(&self.0).status();
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn one_changed_byte_anywhere_is_found(at in any::<prop::sample::Index>(), change in 1..=255_u8) {
        thread_local! {
            static WHOLE: (TempDir, Vec<u8>) = {
                let folder = folder(12);
                let bytes = fs::read(folder.path().join(FILE)).unwrap();
                (folder, bytes)
            };
        }
        let found = WHOLE.with(|(folder, whole)| {
            let mut bytes = whole.clone();
            bytes[at.index(whole.len())] ^= change;
            fs::write(folder.path().join(FILE), bytes).unwrap();
            verified(folder.path())
        });
        prop_assert!(found.is_err(), "{:?}", found);
    }

    #[test]
    fn a_file_that_is_cut_off_anywhere_is_found(cut in any::<prop::sample::Index>()) {
        let folder = folder(4);
        let path = folder.path().join(FILE);
        let mut bytes = fs::read(&path).unwrap();
        bytes.truncate(cut.index(bytes.len()));
        fs::write(&path, bytes).unwrap();
        prop_assert!(verified(folder.path()).is_err());
    }
}

#[test]
fn a_long_file_is_trusted_at_its_end_first_and_read_whole_while_the_relay_works() {
    let folder = folder(0);
    let audit = Audit::open(Some(folder.path())).unwrap();
    let long = record(Event::SignIn).with("text", "x".repeat(16_000));
    for _ in 0..300 {
        audit.append(&long).unwrap();
    }
    drop(audit);
    let mut changed = lines(folder.path());
    changed[2] = changed[2].replace("anna", "emma");
    write_lines(folder.path(), &changed);
    let audit = Audit::open(Some(folder.path())).unwrap();
    let deadline = std::time::Instant::now() + std::time::Duration::from_mins(1);
    while audit.is_writable() {
        assert!(std::time::Instant::now() < deadline, "the changed line is not found");
        thread::yield_now();
    }
    assert!(audit.state().trouble.unwrap().contains("line 3"));
}

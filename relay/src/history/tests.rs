use std::time::Duration;

use cipdeck_shared::api::HistoryLoss;
use cipdeck_shared::config::BlockId;
use tempfile::TempDir;

use super::run::{Run, a_refused_run, a_run};
use super::*;

/// µs since 1970 from which the runs of these tests count: the age limit is far away.
fn base() -> u64 {
    wall_clock::micros(std::time::SystemTime::now()) - 3_600_000_000
}

const EVERYTHING: Asked = Asked { block: None, between: (0, u64::MAX), q: None };

fn of(block: u32) -> Asked {
    Asked { block: Some(BlockId(block)), ..EVERYTHING }
}

/// A writer without its thread, and readers of the same file.
struct Desk {
    folder: TempDir,
    writer: Writer,
    shared: Arc<Shared>,
}

impl Desk {
    fn new() -> Self {
        Self::in_folder(tempfile::tempdir().unwrap(), Limits::of(&HistorySettings::default()))
    }

    fn in_folder(folder: TempDir, limits: Limits) -> Self {
        let shared = Arc::new(Shared::default());
        let writer = Writer::new(folder.path().join(DATABASE), limits, Arc::clone(&shared));
        Self { folder, writer, shared }
    }

    fn read<T>(&self, call: impl FnOnce(&Connection, &[Dropped]) -> rusqlite::Result<T>) -> T {
        let connection = schema::open_to_read(&self.folder.path().join(DATABASE)).unwrap();
        call(&connection, &lock(&self.shared.pending)).unwrap()
    }

    fn page(&self, asked: &Asked, limit: usize, before: Option<Place>) -> HistoryPage {
        self.read(|connection, pending| page::page(connection, pending, asked, (limit, before)))
    }

    fn state(&self) -> HistoryState {
        self.read(state_of)
    }

    fn trend(&self, chart: Chart) -> HistoryTrend {
        self.read(|connection, pending| trend::trend(connection, pending, chart))
    }

    fn losses(&self) -> Vec<(HistoryLoss, Option<u64>)> {
        self.state().dropped.iter().map(|dropped| (dropped.why, dropped.runs)).collect()
    }
}

fn times(page: &HistoryPage) -> Vec<u64> {
    page.runs.iter().map(|run| wall_clock::parse(&run.at).unwrap()).collect()
}

#[test]
fn runs_are_listed_newest_first_over_blocks_batches_and_pages() {
    let (mut desk, base) = (Desk::new(), base());
    for batch in 0..5 {
        let at = |offset: u64| base + batch * 1_000 + offset;
        // Two blocks by turns, one of them with two requests.
        let other = Run { request: Arc::from([0x0E, 3, 0x20, 1, 0x24, 1, 0x30, 2]), ..a_run(1, at(4)) };
        desk.writer.write(&[
            a_run(1, at(0)),
            a_refused_run(2, at(1)),
            a_run(1, at(2)),
            a_run(2, at(3)),
            other,
        ]);
    }
    let expected: Vec<u64> = (0..5)
        .rev()
        .flat_map(|batch| (0..5).rev().map(move |offset| base + batch * 1_000 + offset))
        .collect();
    assert_eq!(times(&desk.page(&EVERYTHING, 100, None)), expected);
    for limit in [1, 3, 24, 25] {
        let (mut all, mut before) = (Vec::new(), None);
        loop {
            let page = desk.page(&EVERYTHING, limit, before);
            assert!(page.runs.len() <= limit);
            all.extend(times(&page));
            let Some(next) = page.next else { break };
            before = Some(next.parse().unwrap());
        }
        assert_eq!(all, expected, "in pages of {limit}");
    }
    assert_eq!(desk.page(&of(2), 100, None).runs.len(), 10);
    let failed = desk.page(&Asked { q: Some(false), ..of(2) }, 100, None);
    assert_eq!((failed.runs.len(), failed.runs[0].cause.as_deref()), (5, Some("refused_by_device")));
    assert_eq!(desk.page(&Asked { q: Some(false), ..of(1) }, 100, None).runs, []);
    let second = Asked { between: (base + 1_000, base + 1_002), ..EVERYTHING };
    assert_eq!(times(&desk.page(&second, 100, None)), [base + 1_002, base + 1_001, base + 1_000]);
    assert_eq!(desk.state().runs, 25);
}

#[test]
fn a_run_is_kept_as_it_was() {
    let (mut desk, base) = (Desk::new(), base());
    desk.writer.write(&[a_run(7, base), a_refused_run(7, base + 1)]);
    let page = desk.page(&of(7), 10, None);
    let [failed, ok] = page.runs.as_slice() else { panic!("{page:?}") };
    assert_eq!((ok.q, ok.reply_us, ok.elapsed_us), (true, Some(300), Some(400)));
    assert_eq!((ok.request.as_str(), ok.response.as_deref()), ("0e03200124013001", Some("8e0000000100")));
    assert_eq!((ok.values[0].name.as_str(), ok.values[0].number), ("vendor id", Some(1.0)));
    assert_eq!((failed.q, failed.error_id, failed.sub_error_id), (false, 224, 5));
    assert_eq!((failed.response.as_deref(), failed.values.len()), (Some("8e000500"), 0));
    assert!(page.next.is_none() && page.dropped.is_empty());
}

#[test]
fn equal_requests_are_stored_once() {
    let (mut desk, base) = (Desk::new(), base());
    (0..20).for_each(|number| desk.writer.write(&[a_run(number, base), a_run(number + 100, base)]));
    let requests =
        desk.read(|connection, _| connection.query_row("SELECT count(*) FROM request", (), |row| row.get(0)));
    assert_eq!((requests, desk.state().runs), (1_i64, 40));
}

#[test]
fn what_is_too_much_goes_from_the_oldest_and_it_is_said() {
    let limits = Limits { max_bytes: 1024 * 1024, ..Limits::of(&HistorySettings::default()) };
    let (mut desk, base) = (Desk::in_folder(tempfile::tempdir().unwrap(), limits), base());
    let long = |at: u64| Run { response: Some(at.to_le_bytes().repeat(60).into()), ..a_run(1, at) };
    let mut at = base;
    for _ in 0..400 {
        desk.writer.write(&(at..at + 20).map(long).collect::<Vec<_>>());
        at += 20;
    }
    let state = desk.state();
    assert!(state.bytes <= limits.max_bytes && state.bytes > limits.max_bytes / 2, "{state:?}");
    let [dropped] = state.dropped.as_slice() else { panic!("one row for all of it: {state:?}") };
    assert_eq!((dropped.why, dropped.runs), (HistoryLoss::Size, Some(8_000 - state.runs)));
    assert_eq!(dropped.from, wall_clock::of_micros(base));
    assert!(Some(&dropped.to) < state.oldest.as_ref());
    assert_eq!(state.newest, Some(wall_clock::of_micros(at - 1)));
    let kept = desk.page(&EVERYTHING, 10_000, None);
    assert_eq!(kept.runs.len() as u64, state.runs);
    assert_eq!(desk.shared.lost.load(Ordering::Relaxed), 0, "a limit is no loss");
    // A limit that is made smaller takes effect, and the file gives the space back.
    let limits = Limits { max_bytes: 256 * 1024, ..limits };
    let mut desk = Desk::in_folder(desk.folder, limits);
    desk.writer.write(&[a_run(1, at)]);
    desk.writer.write(&[a_run(1, at + 1)]);
    assert!(desk.state().bytes <= limits.max_bytes);
    let file = limits::file(desk.writer.connection()).unwrap();
    assert!(file <= limits.max_bytes, "{file}");
}

#[test]
fn what_is_too_old_goes_and_its_request_goes_with_it() {
    let limits = Limits { max_age_us: 2 * 3_600_000_000, ..Limits::of(&HistorySettings::default()) };
    let (mut desk, base) = (Desk::in_folder(tempfile::tempdir().unwrap(), limits), base());
    let old = Run { request: Arc::from([1, 2, 0x20, 1, 0x24, 1]), ..a_run(1, base - 2 * 3_600_000_000) };
    desk.writer.write(&[a_run(1, base)]);
    desk.writer.write(std::slice::from_ref(&old));
    desk.writer.write(&[a_run(1, base + 1)]);
    assert_eq!(desk.losses(), [], "one that is younger was written before");
    desk.writer.write(&[]);
    assert_eq!(desk.state().runs, 3);
    let mut desk = Desk::in_folder(tempfile::tempdir().unwrap(), limits);
    desk.writer.write(&[old]);
    desk.writer.write(&[a_run(1, base)]);
    assert_eq!((desk.losses(), desk.state().runs), (vec![(HistoryLoss::Age, Some(1))], 1));
}

#[test]
fn a_full_disk_costs_what_it_cannot_hold_says_so_and_nothing_more() {
    let (mut desk, base) = (Desk::new(), base());
    desk.writer.write(&[a_run(1, base)]);
    let pages =
        desk.writer.connection().pragma_query_value(None, "page_count", |row| row.get::<_, i64>(0)).unwrap();
    desk.writer.connection().pragma_update(None, "max_page_count", pages).unwrap();
    let long = |at| Run { response: Some(vec![1; 5_000].into()), ..a_run(1, at) };
    for at in 1..4 {
        desk.writer.write(&[long(base + at)]);
    }
    let problem = lock(&desk.shared.problem).clone();
    assert!(problem.as_ref().is_some_and(|problem| problem.contains("full")), "{problem:?}");
    assert_eq!(desk.losses(), [(HistoryLoss::Disk, Some(3))], "told before it can be written down");
    assert_eq!(
        (desk.page(&EVERYTHING, 9, None).runs.len(), desk.shared.lost.load(Ordering::Relaxed)),
        (1, 3)
    );

    desk.writer.connection().pragma_update(None, "max_page_count", 1_000_000).unwrap();
    desk.writer.write(&[long(base + 9)]);
    assert_eq!(*lock(&desk.shared.problem), None);
    assert_eq!(desk.losses(), [(HistoryLoss::Disk, Some(3))]);
    assert_eq!(times(&desk.page(&EVERYTHING, 9, None)), [base + 9, base]);
    assert!(lock(&desk.shared.pending).is_empty(), "written down");
    let page = desk.page(&Asked { between: (base + 1, base + 2), ..EVERYTHING }, 9, None);
    assert_eq!(page.dropped[0].from, wall_clock::of_micros(base + 1));
    assert!(desk.page(&Asked { between: (base + 5, base + 9), ..EVERYTHING }, 9, None).dropped.is_empty());
}

#[test]
fn a_folder_that_cannot_be_made_is_tried_again() {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().join("data");
    std::fs::write(&data, "a file where the folder should be").unwrap();
    let shared = Arc::new(Shared::default());
    let limits = Limits::of(&HistorySettings::default());
    let mut writer = Writer::new(data.join(DATABASE), limits, Arc::clone(&shared));
    assert!(lock(&shared.problem).is_some());
    writer.write(&[a_run(1, base())]);
    assert_eq!(shared.lost.load(Ordering::Relaxed), 1);
    std::fs::remove_file(&data).unwrap();
    writer.write(&[a_run(1, base())]);
    assert!(lock(&shared.problem).is_none());
    let connection = schema::open_to_read(&data.join(DATABASE)).unwrap();
    let state = state_of(&connection, &[]).unwrap();
    assert_eq!((state.runs, state.dropped[0].why, state.dropped[0].runs), (1, HistoryLoss::Disk, Some(1)));
}

#[test]
fn a_file_that_is_no_history_is_set_aside_and_it_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let garbage = "not a database at all, but long enough to be taken for one".repeat(99);
    std::fs::write(folder.path().join(DATABASE), garbage).unwrap();
    check_aside("garbage", folder);
    let spoilt = |spoil: &str| {
        let Desk { folder, mut writer, .. } = Desk::new();
        writer.connection().execute_batch(spoil).unwrap();
        folder
    };
    check_aside("newer", spoilt("PRAGMA user_version = 99"));
    check_aside("another database", spoilt("DROP TABLE total"));
}

fn check_aside(name: &str, folder: TempDir) {
    let mut desk = Desk::in_folder(folder, Limits::of(&HistorySettings::default()));
    assert_eq!(desk.losses(), [(HistoryLoss::Corrupt, None)], "{name}: told before it is written down");
    desk.writer.write(&[a_run(1, base())]);
    let state = desk.state();
    assert_eq!((state.runs, desk.losses()), (1, vec![(HistoryLoss::Corrupt, None)]), "{name}");
    let detail = state.dropped[0].detail.clone().unwrap_or_default();
    let files = std::fs::read_dir(desk.folder.path()).unwrap();
    let names: Vec<String> = files.map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
    let aside = names
        .iter()
        .find(|file| file.contains(".aside-") && !file.ends_with("-wal") && !file.ends_with("-shm"));
    assert!(aside.is_some_and(|aside| detail.contains(aside.as_str())), "{name}: {detail} {names:?}");
}

#[test]
fn a_trend_sums_up_what_lies_in_each_bucket() {
    let mut desk = Desk::new();
    let base = base();
    let read = |at: u64, value: i16| {
        let [low, high] = value.to_le_bytes();
        Run {
            request: Arc::from([0x0E, 3, 0x20, 0x0F, 0x24, 1, 0x30, 1]),
            response: Some(Arc::from([0x8E, 0, 0, 0, low, high])),
            reply_us: Some(at - base),
            ..a_run(1, at)
        }
    };
    desk.writer.write(&[read(base + 1, -5), read(base + 2, 7), a_refused_run(1, base + 3)]);
    desk.writer.write(&[read(base + 25, 100), a_run(2, base + 26)]);
    let chart = |value: Option<&str>| Chart {
        block: BlockId(1),
        between: (base, base + 40),
        points: 4,
        value: value.map(str::to_owned),
    };
    let trend = desk.trend(chart(Some("data as INT")));
    assert_eq!((trend.bucket_us, trend.complete), (10, true));
    let buckets: Vec<_> =
        trend.buckets.iter().map(|bucket| (bucket.index, bucket.runs, bucket.failed)).collect();
    assert_eq!(buckets, [(0, 3, 1), (2, 1, 0)]);
    let value = trend.buckets[0].value.unwrap();
    assert_eq!((value.min, value.mean, value.max), (-5.0, 1.0, 7.0));
    let reply = trend.buckets[0].reply_us.unwrap();
    assert_eq!((reply.min, reply.max), (1.0, 300.0), "a refusal is a reply, too");
    assert_eq!(trend.values, ["data as UINT", "data as INT"]);
    let first = desk.trend(chart(None));
    assert_eq!((first.value.as_deref(), first.buckets[1].value.unwrap().max), (Some("data as UINT"), 100.0));
    let none = desk.trend(chart(Some("speed")));
    assert!(
        none.buckets.iter().all(|bucket| bucket.value.is_none()) && none.value.as_deref() == Some("speed")
    );
}

#[tokio::test]
async fn what_was_handed_over_is_there_after_the_end_and_readers_do_not_stop_the_thread() {
    let folder = tempfile::tempdir().unwrap();
    let history = History::open(Some(folder.path()), HistorySettings::default()).await;
    let buffer = history.recorder().0.unwrap();
    let (base, count) = (base(), 3_000);
    // A reader in the middle of its work.
    let reader = schema::open_to_read(&folder.path().join(DATABASE)).unwrap();
    reader.execute_batch("BEGIN; SELECT * FROM chunk").unwrap();
    (0..count).for_each(|number| buffer.push(a_run(1, base + number)));
    let written = async {
        while history.state().await.unwrap().runs < count {
            tokio::time::sleep(Duration::from_millis(5)).await;
        }
    };
    tokio::time::timeout(Duration::from_secs(10), written).await.unwrap();
    buffer.push(a_run(1, base + count));
    history.close().await;
    assert_eq!(history.health(), HistoryHealth { recording: true, lost: 0 });
    let again = History::open(Some(folder.path()), HistorySettings::default()).await;
    assert_eq!(again.state().await.unwrap().runs, count + 1);
    again.close().await;
}

#[tokio::test]
async fn without_a_folder_nothing_is_kept_and_it_is_said() {
    for (folder, enabled) in [(None, true), (Some(Path::new("/nowhere")), false)] {
        let settings = HistorySettings { enabled, ..HistorySettings::default() };
        let history = History::open(folder, settings).await;
        assert!(!history.state().await.unwrap().enabled);
        assert_eq!(history.page(EVERYTHING, 10, None).await.unwrap(), HistoryPage::default());
        history.close().await;
    }
}

//! How fast messages are written as code, read back and converted. docs/PERFORMANCE.md says how the numbers are made.
//!
//! Run by `cargo xtask bench`, or alone: `cargo bench -p cipdeck-shared --bench code -- [--quick] [--out FOLDER]`.

#![expect(clippy::print_stdout, reason = "the tables are what it is for")]

use core::fmt::Write as _;
use core::hint::black_box;
use core::time::Duration;
use std::path::PathBuf;
use std::time::Instant;

use cipdeck_shared::code::{Dialect, Kind, MAX_BLOCKS, MAX_TEXT, Options, convert, export, import};
use cipdeck_shared::config::{BlockConfig, MsgCipGeneric};

/// Of how many messages the short text is an eighth of the long one.
const PART: usize = 8;

fn main() -> std::io::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let out = arguments.iter().position(|it| it == "--out").and_then(|at| arguments.get(at + 1));
    let rounds = if arguments.iter().any(|it| it == "--quick") { 3 } else { 9 };
    let mut tables = dialects(rounds);
    tables.push('\n');
    tables.push_str(&kinds(rounds));
    println!("{tables}");
    if let Some(folder) = out.map(PathBuf::from) {
        std::fs::create_dir_all(&folder)?;
        std::fs::write(folder.join("code.md"), tables)?;
    }
    Ok(())
}

/// A write of a parameter of a drive, so that there is data.
fn message(number: usize) -> BlockConfig {
    let mut config = MsgCipGeneric::product_name("4,192.168.1.100,1,0");
    config.name = format!("ramp-{number}");
    let app = &mut config.app_cfg;
    (app.service, app.class, app.attribute) = (16, 147, 9);
    app.instance = i64::try_from(number).unwrap_or(1) + 1;
    config.req_data = "f401".into();
    config.into()
}

/// As many messages as an import takes, and the first eighth of them.
struct Texts {
    dialect: Dialect,
    long: String,
    messages: usize,
    short: String,
}

impl Texts {
    fn new(dialect: Dialect) -> Self {
        let (mut texts, mut size) = (Vec::new(), 0);
        while texts.len() < MAX_BLOCKS {
            let text = export(&message(texts.len()), dialect, &Options::default()).text;
            size += text.len() + 1;
            if size > MAX_TEXT {
                break;
            }
            texts.push(text);
        }
        texts.truncate(texts.len() / PART * PART);
        let short = texts.get(..texts.len() / PART).unwrap_or_default().join("\n");
        Self { dialect, long: texts.join("\n"), messages: texts.len(), short }
    }
}

/// One row for each dialect: writing, reading, and whether eight times as much takes eight times as long.
fn dialects(rounds: usize) -> String {
    let all: Vec<Texts> = Dialect::ALL.into_iter().map(Texts::new).collect();
    let mut times: Vec<[Vec<Duration>; 3]> = all.iter().map(|_| Default::default()).collect();
    for _ in 0..rounds {
        for (texts, [write, long, short]) in all.iter().zip(&mut times) {
            let block = message(1);
            write.push(timed(|| {
                for _ in 0..100 {
                    black_box(export(black_box(&block), texts.dialect, &Options::default()));
                }
            }));
            long.push(timed(|| {
                let found = import(black_box(&texts.long), None).blocks.len();
                assert_eq!(found, texts.messages, "{}", texts.dialect);
            }));
            short.push(timed(|| {
                for _ in 0..PART {
                    black_box(import(black_box(&texts.short), None));
                }
            }));
        }
    }
    let mut table = String::from(
        "| dialect | bytes | write, µs | read, µs | read, MiB/s | whole text, ms | long : short |\n\
         | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    for (texts, [write, long, short]) in all.iter().zip(&times) {
        let [write, long, short] = [write, long, short].map(|times| median(times));
        let [bytes, messages] = [texts.long.len(), texts.messages].map(number);
        let _ = writeln!(
            table,
            "| {} | {:.0} | {:.1} | {:.1} | {:.1} | {:.0} | **{:.2}** |",
            texts.dialect,
            bytes / messages,
            write * 1e6 / 100.0,
            long * 1e6 / messages,
            bytes / long / 1_048_576.0,
            long * 1e3,
            long / short,
        );
    }
    table
}

/// One row for each pair of kinds.
fn kinds(rounds: usize) -> String {
    let pairs: Vec<(Kind, Kind)> = Kind::ALL
        .into_iter()
        .flat_map(|from| Kind::ALL.map(|to| (from, to)))
        .filter(|(from, to)| from != to)
        .collect();
    let mut times: Vec<Vec<Duration>> = pairs.iter().map(|_| Vec::new()).collect();
    for _ in 0..rounds {
        for ((from, to), times) in pairs.iter().zip(&mut times) {
            let block = convert(&message(1), *from).config;
            times.push(timed(|| {
                for _ in 0..100 {
                    black_box(convert(black_box(&block), *to));
                }
            }));
        }
    }
    let mut table = String::from("| from | to | µs |\n| --- | --- | ---: |\n");
    for ((from, to), times) in pairs.iter().zip(&times) {
        let _ = writeln!(table, "| {from} | {to} | {:.1} |", median(times) * 1e6 / 100.0);
    }
    table
}

fn timed(work: impl FnOnce()) -> Duration {
    let start = Instant::now();
    work();
    start.elapsed()
}

/// In s.
fn median(times: &[Duration]) -> f64 {
    let mut times = times.to_vec();
    times.sort_unstable();
    times.get(times.len() / 2).map_or(0.0, Duration::as_secs_f64)
}

#[expect(clippy::cast_precision_loss, reason = "lengths of texts")]
fn number(count: usize) -> f64 {
    count as f64
}

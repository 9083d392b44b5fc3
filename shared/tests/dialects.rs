//! Every dialect, as somebody uses it: a block goes out as code, loses all of its comments, and comes back.
#![cfg(not(target_arch = "wasm32"))]

#[path = "dialects/blocks.rs"]
mod blocks;
#[path = "dialects/comments.rs"]
mod comments;

use cipdeck_shared::code::{Code, Dialect, Found, Grade, Kind, Language, Options, convert, export, import};
use cipdeck_shared::config::{BlockConfig, MsgCipGeneric};
use cipdeck_shared::plan::{MessagePlan, Severity};
use proptest::prelude::*;

use self::blocks::block;
use self::comments::without_comments;

/// What a block sends, where to, and how long it waits.
#[derive(Clone, Debug, PartialEq)]
struct Sends {
    request: Vec<u8>,
    target: String,
    route: Vec<u8>,
    ucmm_timeout_ms: u32,
    connected_timeout_ms: Option<u32>,
}

fn sends(block: &BlockConfig) -> Option<Sends> {
    let plan = MessagePlan::of(block).0?;
    let path = block.as_msg().and_then(|config| config.target_cfg.path.parse().ok());
    Some(Sends {
        request: plan.bytes().to_vec(),
        target: plan.target().to_string(),
        route: path.map_or_else(Vec::new, |path: cipdeck_shared::config::TargetPath| path.route.bytes()),
        ucmm_timeout_ms: plan.ucmm_timeout_ms(),
        connected_timeout_ms: plan.connection().map(|connection| connection.timeout_ms),
    })
}

/// The one block that a text without its comments gives, recognised or as this dialect; with its comments it gives the
/// same.
fn back(code: &Code, dialect: Dialect, asked: Option<Dialect>) -> Result<Found, String> {
    let bare = read(&without_comments(dialect, &code.text), asked)?;
    let whole = read(&code.text, asked)?;
    if sends(&bare.config) == sends(&whole.config) {
        Ok(bare)
    } else {
        Err(format!("comments change what is read of\n{}", code.text))
    }
}

fn read(text: &str, asked: Option<Dialect>) -> Result<Found, String> {
    let mut imported = import(text, asked);
    let errors = imported.remarks.iter().filter(|remark| remark.severity == Severity::Error);
    let errors: Vec<String> = errors.map(ToString::to_string).collect();
    match (imported.blocks.len(), errors.is_empty()) {
        (1, true) => Ok(imported.blocks.remove(0)),
        (blocks, _) => Err(format!("{blocks} blocks, {errors:?} in\n{text}")),
    }
}

fn options(il: bool) -> Options {
    Options { language: if il { Language::Il } else { Language::St } }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 192, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_a_dialect_says_comes_back(block in block(), il in any::<bool>(), told in any::<bool>()) {
        let sent = sends(&block);
        for dialect in Dialect::ALL {
            let code = export(&block, dialect, &options(il));
            let losses: Vec<String> = code.losses().map(ToString::to_string).collect();
            let Some(sent) = &sent else {
                let silent = losses.is_empty() || !code.text.is_empty();
                prop_assert!(dialect == Dialect::Json || !silent, "{dialect}: code of an invalid block: {}", code.text);
                continue;
            };
            let asked = told.then_some(dialect);
            let found = match back(&code, dialect, asked) {
                Ok(found) => found,
                Err(why) => {
                    // Nothing is written of what cannot be said, and that is told.
                    let request = code.losses().any(|change| change.grade == Grade::Request);
                    prop_assert!(request && code.text.trim().is_empty(), "{}: {} {:?}", dialect, why, losses);
                    continue;
                }
            };
            let again = sends(&found.config);
            if losses.is_empty() {
                prop_assert_eq!(again.as_ref(), Some(sent), "{}: {:?}\n{}", dialect, found.remarks, code.text);
            }
            let other = again.is_none_or(|again| {
                again.request != sent.request || again.target != sent.target || again.route != sent.route
            });
            if other && dialect != Dialect::Hex {
                let told = code.changes.iter().any(|change| change.grade == Grade::Request);
                prop_assert!(told, "{}: other bytes or another device, and only {:?}\n{}", dialect, losses, code.text);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None, ..ProptestConfig::default() })]

    /// Nothing that somebody pastes ends the program, and nothing is without a word.
    #[test]
    fn any_text_is_read_or_told(
        dialect in proptest::sample::select(Dialect::ALL.to_vec()),
        asked in proptest::option::of(proptest::sample::select(Dialect::ALL.to_vec())),
        cut in any::<proptest::sample::Index>(),
        at in any::<proptest::sample::Index>(),
        noise in "[ -~\\n(){}\\[\\]'\"<>*#%é🦀0-9]{0,12}",
    ) {
        let text = export(&ramp(), dialect, &options(cut.index(2) == 1)).text;
        let mut characters: Vec<char> = text.chars().collect();
        characters.truncate(cut.index(characters.len() + 1));
        let at = at.index(characters.len() + 1);
        characters.splice(at..at, noise.chars());
        let text: String = characters.into_iter().collect();
        let imported = import(&text, asked);
        let words = without_comments(asked.unwrap_or(dialect), &text);
        if asked.is_some() && !words.trim().is_empty() {
            prop_assert!(!imported.blocks.is_empty() || !imported.remarks.is_empty(), "{:?}: {}", asked, text);
        }
        for found in &imported.blocks {
            prop_assert!(found.lines.start >= 1 && found.lines.start < found.lines.end, "{:?}", found);
        }
    }
}

/// Wherever a text has a number, any other may stand.
#[test]
fn no_number_ends_an_import_or_what_follows_it() {
    let extremes = [
        "-9223372036854775808",
        "18446744073709551615",
        "170141183460469231731687303715884105727",
        "99999999999999999999999999999999999999999999",
    ];
    for dialect in Dialect::ALL {
        let text = export(&ramp(), dialect, &options(false)).text;
        let mut rest = 0;
        while let Some(start) = text[rest..].find(|c: char| c.is_ascii_digit()).map(|at| rest + at) {
            let end = text[start..].find(|c: char| !c.is_ascii_digit()).map_or(text.len(), |at| start + at);
            for extreme in extremes {
                let other = [&text[..start], extreme, &text[end..]].concat();
                for found in import(&other, Some(dialect)).blocks {
                    for kind in Kind::ALL {
                        let _ = convert(&found.config, kind);
                    }
                }
            }
            rest = end;
        }
    }
}

/// As it is typed by an engineer: a drive's ramp.
fn ramp() -> BlockConfig {
    let mut config = MsgCipGeneric::product_name("4,192.168.1.100");
    config.name = "drive-ramp".into();
    let app = &mut config.app_cfg;
    (app.service, app.class, app.instance, app.attribute) = (16, 0x93, 41, 9);
    (config.req_data, config.target_cfg.ucmm_timeout) = ("f401".into(), 2_500);
    config.into()
}

/// `cargo test -p cipdeck-shared --test dialects table -- --nocapture`
#[test]
#[expect(clippy::print_stdout, reason = "the table is for a person")]
fn one_message_in_every_dialect_as_a_table() {
    let block = ramp();
    let sent = sends(&block).expect("a message");
    println!("\n| dialect | bytes | target | timeouts | losses |\n| --- | --- | --- | --- | --- |");
    for dialect in Dialect::ALL {
        let languages: &[bool] =
            if dialect.kind() == Kind::MsgCipGeneric { &[false] } else { &[false, true] };
        for il in languages {
            let code = export(&block, dialect, &options(*il));
            let found = back(&code, dialect, None).unwrap_or_else(|why| panic!("{dialect}: {why}"));
            let again = sends(&found.config).unwrap_or_else(|| panic!("{dialect}: {}", code.text));
            let mark = |equal: bool| if equal { "equal" } else { "OTHER" };
            let timeouts = again.ucmm_timeout_ms == sent.ucmm_timeout_ms
                && again.connected_timeout_ms == sent.connected_timeout_ms;
            let losses: Vec<String> =
                code.losses().map(|loss| format!("{} ({})", loss.member, loss.grade.name())).collect();
            println!(
                "| {dialect}{} | {} | {} | {} | {} |",
                if *il { " IL" } else { "" },
                mark(again.request == sent.request),
                mark(again.target == sent.target),
                mark(timeouts),
                if losses.is_empty() { "none".to_string() } else { losses.join(", ") }
            );
            assert_eq!(again.request, sent.request, "{dialect}");
            if dialect != Dialect::Hex {
                assert_eq!((again.target, timeouts), (sent.target.clone(), true), "{dialect}\n{}", code.text);
            }
        }
    }
}

#[test]
fn twenty_messages_of_all_dialects_in_one_text() {
    let mut text = String::new();
    let mut expected = Vec::new();
    for number in 0..20 {
        let dialect = Dialect::ALL[number % Dialect::ALL.len()];
        let BlockConfig::MsgCipGeneric(mut config) = ramp() else { unreachable!() };
        config.name = format!("message{number}");
        config.app_cfg.instance = 100 + i64::try_from(number).expect("small");
        let block = BlockConfig::from(config);
        text.push_str(&export(&block, dialect, &options(number % 2 == 1)).text);
        text.push('\n');
        expected.push(sends(&block).expect("a message").request);
    }
    let imported = import(&text, None);
    let errors: Vec<String> = imported
        .remarks
        .iter()
        .chain(imported.blocks.iter().flat_map(|found| &found.remarks))
        .filter(|remark| remark.severity == Severity::Error)
        .map(|remark| format!("{remark}\n{}", text.lines().nth(remark.line - 1).unwrap_or_default()))
        .collect();
    assert_eq!(errors, [""; 0]);
    let found: Vec<Vec<u8>> =
        imported.blocks.iter().map(|found| sends(&found.config).expect("a message").request).collect();
    let dialects: Vec<Dialect> = imported.blocks.iter().map(|found| found.dialect).collect();
    assert_eq!(found, expected, "{dialects:?}\n{text}");
    let lines: Vec<usize> = imported.blocks.iter().map(|found| found.lines.start).collect();
    assert!(lines.is_sorted(), "{lines:?}");
}

#[test]
fn no_name_breaks_out_of_any_dialect() {
    let names = [
        "'; DROP TABLE blocks",
        "*) x := 1; (*",
        "]]></Comment>",
        "</Tag><Tag Name=\"x\">",
        "\"\"\"\nimport os\n\"\"\"",
        "*/ fn main() {} /*",
        "a\nb\r\nc",
        "$(reboot)`reboot`",
        "🦀 é ß",
        "\\",
        "--><!--",
        "{}%s",
        "IF",
        "end_var",
        "MOD",
        "CIPSTATUS",
    ];
    for name in names {
        let mut block = ramp();
        block.set_name(name.into());
        let sent = sends(&block).expect("a message");
        for dialect in Dialect::ALL {
            for il in [false, true] {
                let code = export(&block, dialect, &options(il));
                for text in [code.text.clone(), without_comments(dialect, &code.text)] {
                    let imported = import(&text, Some(dialect));
                    let requests: Vec<Vec<u8>> = imported
                        .blocks
                        .iter()
                        .map(|found| sends(&found.config).expect("a message").request)
                        .collect();
                    assert_eq!(
                        requests,
                        core::slice::from_ref(&sent.request),
                        "{dialect} {name:?}\n{text}\n{:?}",
                        imported.remarks
                    );
                }
            }
        }
    }
}

#[test]
fn comments_carry_nothing() {
    for dialect in Dialect::ALL {
        let code = export(&ramp(), dialect, &options(false));
        let with = import(&code.text, Some(dialect));
        let without = import(&without_comments(dialect, &code.text), Some(dialect));
        let blocks = |imported: &cipdeck_shared::code::Imported| -> Vec<BlockConfig> {
            imported.blocks.iter().map(|found| found.config.clone()).collect()
        };
        assert_eq!(blocks(&with), blocks(&without), "{dialect}");
    }
}

/// The requests that a person pastes from a document: nobody says which module they are for.
#[test]
fn pasted_words_are_recognised_without_a_word() {
    for (words, dialect, length) in [
        ("0000 030E 0120 0124 0730", Dialect::SendReqEtc100, 10),
        ("0000 C0A8 0166 024E 4420 0124 0000 000A", Dialect::SendReqEtc101, 16),
        ("0000 024E 4420 0124 0000 000A", Dialect::SendReqEtc100, 12),
        ("024E 4420 0124 0000 000A", Dialect::DataExch, 10),
    ] {
        for text in
            [words.to_owned(), format!("{words} {length}"), format!("| some request | {words} | {length} |")]
        {
            let imported = import(&text, None);
            assert_eq!(imported.blocks.len(), 1, "{text}: {imported:?}");
            let found = &imported.blocks[0];
            let config = found.config.as_send_req().expect("words");
            assert_eq!((found.dialect, config.data_to_send.as_str()), (dialect, words), "{text}");
            assert_eq!(config.management_param, [0, 0, 30, length], "{text}");
            let code = export(&found.config, dialect, &options(false));
            let again = back(&code, dialect, None).unwrap_or_else(|why| panic!("{why}"));
            assert_eq!(again.config.as_send_req().expect("words").data_to_send, words, "{}", code.text);
        }
    }
}

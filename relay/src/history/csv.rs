//! Runs as CSV (RFC 4180): one line each, the newest first.
//!
//! Spreadsheets run what looks like a formula, and a device may call itself `=cmd|…`: such a text gets an apostrophe.
//! Bytes have spaces between them, because `0e03` would become a number.

use std::fmt::Write;

use cipdeck_shared::api::HistoryRun;

/// The first line.
pub(crate) const HEADER: &str = "at,block,result,ErrorID,SubErrorID,ExtErrorID,cause,may_have_acted,reply_us,elapsed_us,request,response,value,number,text\r\n";

/// A line; `value` names the decoded value that is shown, the first one if `None`.
pub(crate) fn line(run: &HistoryRun, value: Option<&str>, out: &mut String) {
    let shown = run.values.iter().find(|found| value.is_none_or(|name| name == found.name));
    let number = |number: Option<u64>| number.map(|number| number.to_string()).unwrap_or_default();
    let result = if run.q { "ok" } else { "failed" };
    let acted = if run.has_acted {
        "has"
    } else if run.may_have_acted {
        "may"
    } else {
        ""
    };
    let cells = [
        run.at.clone(),
        run.block.to_string(),
        result.to_owned(),
        run.error_id.to_string(),
        run.sub_error_id.to_string(),
        run.ext_error_id.to_string(),
        text(run.cause.as_deref().unwrap_or_default()),
        acted.to_owned(),
        number(run.reply_us),
        number(run.elapsed_us),
        bytes(&run.request),
        bytes(run.response.as_deref().unwrap_or_default()),
        shown.map(|shown| text(&shown.name)).unwrap_or_default(),
        shown.and_then(|shown| shown.number).map(|number| number.to_string()).unwrap_or_default(),
        shown.map(|shown| text(&shown.text)).unwrap_or_default(),
    ];
    for (at, cell) in cells.iter().enumerate() {
        let comma = if at == 0 { "" } else { "," };
        let _ = write!(out, "{comma}{cell}");
    }
    out.push_str("\r\n");
}

/// A cell of text, which is never a formula.
fn text(text: &str) -> String {
    let formula = text.starts_with(['=', '+', '-', '@', '\t', '\r', '\n']) && text.parse::<f64>().is_err();
    let safe = if formula { format!("'{text}") } else { text.to_owned() };
    if safe.contains(['"', ',', '\r', '\n']) { format!("\"{}\"", safe.replace('"', "\"\"")) } else { safe }
}

/// `0e 03 20`
fn bytes(hex: &str) -> String {
    let mut out = String::with_capacity(hex.len() + hex.len() / 2);
    for (at, digit) in hex.chars().enumerate() {
        if at > 0 && at % 2 == 0 {
            out.push(' ');
        }
        out.push(digit);
    }
    out
}

#[cfg(test)]
mod tests {
    use cipdeck_shared::api::HistoryValue;
    use cipdeck_shared::config::BlockId;

    use super::*;

    fn run() -> HistoryRun {
        HistoryRun {
            id: String::new(),
            block: BlockId(7),
            at: "2026-11-22T10:00:00.000000Z".into(),
            q: true,
            error_id: 0,
            sub_error_id: 0,
            ext_error_id: 0,
            cause: None,
            may_have_acted: false,
            has_acted: false,
            reply_us: Some(390),
            elapsed_us: Some(412),
            request: "0e03".into(),
            response: Some("8e000000".into()),
            values: Vec::new(),
        }
    }

    fn line_of(run: &HistoryRun, value: Option<&str>) -> String {
        let mut out = String::new();
        line(run, value, &mut out);
        out
    }

    #[test]
    fn a_line_has_a_cell_for_each_column() {
        let columns = HEADER.split(',').count();
        let ok = line_of(&run(), None);
        assert_eq!(ok, "2026-11-22T10:00:00.000000Z,b7,ok,0,0,0,,,390,412,0e 03,8e 00 00 00,,,\r\n");
        assert_eq!(ok.split(',').count(), columns);
        let failed = HistoryRun {
            q: false,
            error_id: 55,
            sub_error_id: 115,
            cause: Some("timeout".into()),
            may_have_acted: true,
            reply_us: None,
            response: None,
            ..run()
        };
        let expected = "2026-11-22T10:00:00.000000Z,b7,failed,55,115,0,timeout,may,,412,0e 03,,,,\r\n";
        assert_eq!(line_of(&failed, None), expected);
    }

    #[test]
    fn the_value_that_is_asked_for_is_shown() {
        let value = |name: &str, text: &str, number| HistoryValue {
            name: name.into(),
            type_name: "INT".into(),
            text: text.into(),
            number,
            guess: true,
        };
        let values =
            vec![value("data as UINT", "65534", Some(65_534.0)), value("data as INT", "-2", Some(-2.0))];
        let run = HistoryRun { values, ..run() };
        assert!(line_of(&run, None).ends_with(",data as UINT,65534,65534\r\n"));
        assert!(line_of(&run, Some("data as INT")).ends_with(",data as INT,-2,-2\r\n"));
        assert!(line_of(&run, Some("speed")).ends_with(",,,\r\n"));
    }

    #[test]
    fn a_text_from_a_device_is_never_a_formula_and_never_breaks_the_line() {
        for (given, expected) in [
            ("=cmd|' /C calc'!A0", "'=cmd|' /C calc'!A0"),
            ("+1+1", "'+1+1"),
            ("-1+1", "'-1+1"),
            ("@SUM(A1)", "'@SUM(A1)"),
            ("\t=1", "'\t=1"),
            ("-5", "-5"),
            ("a,b", "\"a,b\""),
            ("say \"x\"\r\n=1", "\"say \"\"x\"\"\r\n=1\""),
            ("=HYPERLINK(\"x\",\"y\")", "\"'=HYPERLINK(\"\"x\"\",\"\"y\"\")\""),
            ("1756-L83E/B", "1756-L83E/B"),
        ] {
            assert_eq!(text(given), expected);
        }
    }
}

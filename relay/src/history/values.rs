//! What replies say. Not stored: it follows from request and reply, and a better table makes old runs readable, too.

use std::collections::HashMap;
use std::sync::Arc;

use cipdeck_shared::api::HistoryValue;
use cipdeck_shared::dissect::{self, Decoded};

use super::run::Run;

/// Replies that are remembered: most blocks read the same few values.
const MAX_REMEMBERED: usize = 1_024;

/// Decodes replies, each different one once.
#[derive(Debug, Default)]
pub(super) struct Values {
    known: HashMap<Exchanged, Arc<[HistoryValue]>>,
    last: Option<(Exchanged, Arc<[HistoryValue]>)>,
}

/// Request and reply.
type Exchanged = (Arc<[u8]>, Arc<[u8]>);

impl Values {
    /// The values of a success; nothing for a failure.
    pub(super) fn of(&mut self, run: &Run) -> Arc<[HistoryValue]> {
        let Some(response) = run.response.as_ref().filter(|_| run.q) else { return Arc::default() };
        if let Some(((request, known), values)) = &self.last
            && Arc::ptr_eq(request, &run.request)
            && Arc::ptr_eq(known, response)
        {
            return Arc::clone(values);
        }
        if self.known.len() >= MAX_REMEMBERED {
            self.known.clear();
        }
        let key = (Arc::clone(&run.request), Arc::clone(response));
        let values = self.known.entry(key.clone()).or_insert_with(|| decode(&run.request, response));
        self.last = Some((key, Arc::clone(values)));
        Arc::clone(values)
    }
}

fn decode(request: &[u8], response: &[u8]) -> Arc<[HistoryValue]> {
    dissect::decode(request, response).into_iter().map(value).collect()
}

fn value(decoded: Decoded) -> HistoryValue {
    let Decoded { type_name, name, text, guess, .. } = decoded;
    let name = if guess { format!("{name} as {type_name}") } else { name.into_owned() };
    let number = number(&type_name, &text);
    HistoryValue { name, type_name: type_name.into_owned(), text, number, guess }
}

/// The number of a text, where its type is one of numbers. A text like `192.168.1.10` or `inf` is none.
fn number(type_name: &str, text: &str) -> Option<f64> {
    if matches!(type_name, "STRING" | "SHORT_STRING" | "ASCII" | "bytes") {
        return None;
    }
    let hexadecimal = || u64::from_str_radix(text.strip_prefix("0x")?, 16).ok();
    #[expect(clippy::cast_precision_loss, reason = "a number for charts; the text is exact")]
    let hexadecimal = || hexadecimal().map(|number| number as f64);
    text.parse().ok().or_else(hexadecimal).filter(|number: &f64| number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::super::run::{a_refused_run, a_run};
    use super::*;

    fn shown(run: &Run) -> Vec<(String, String, Option<f64>)> {
        let values = Values::default().of(run);
        values.iter().map(|value| (value.name.clone(), value.text.clone(), value.number)).collect()
    }

    #[test]
    fn what_is_known_has_its_name_and_what_is_guessed_says_so() {
        assert_eq!(shown(&a_run(1, 1)), [("vendor id".to_owned(), "1".to_owned(), Some(1.0))]);
        let parameter = Run {
            request: Arc::from([0x0E, 3, 0x20, 0x0F, 0x24, 1, 0x30, 1]),
            response: Some(Arc::from([0x8E, 0, 0, 0, 0xFE, 0xFF])),
            ..a_run(1, 1)
        };
        let expected = [("data as UINT", "65534", Some(65_534.0)), ("data as INT", "-2", Some(-2.0))];
        assert_eq!(
            shown(&parameter),
            expected.map(|(name, text, number)| (name.into(), text.into(), number))
        );
        assert_eq!(shown(&a_refused_run(1, 1)), []);
        assert_eq!(shown(&Run { response: Some(Arc::from([])), ..a_run(1, 1) }), []);
    }

    #[test]
    fn only_numbers_are_numbers() {
        for (type_name, text, expected) in [
            ("REAL", "1.5", Some(1.5)),
            ("REAL", "1e-7", Some(1e-7)),
            ("REAL", "NaN", None),
            ("REAL", "inf", None),
            ("WORD", "0x0034", Some(52.0)),
            ("UDINT", "192.168.1.10", None),
            ("SHORT_STRING", "1756", None),
            ("bytes", "01 02", None),
        ] {
            assert_eq!(number(type_name, text), expected, "{type_name} {text}");
        }
    }
}

//! Which runs: of which block, of which time, and how they ended.

use cipdeck_shared::config::Block;
use yew::prelude::*;

use crate::{
    browser,
    office::{i18n::tr, kit::choice},
};

/// What is asked for. The times are fixed when somebody asks, so that pages follow each other without a gap.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Wanted {
    pub(super) span: Span,
    /// RFC 3339, or nothing.
    pub(super) from: String,
    /// RFC 3339.
    pub(super) to: String,
    /// `ok`, `failed`, or nothing for both.
    pub(super) result: String,
    pub(super) before: String,
}

/// How far back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Span {
    QuarterHour,
    Hour,
    Shift,
    Day,
    Week,
    Month,
}

impl Span {
    pub(super) const ALL: [Self; 6] =
        [Self::QuarterHour, Self::Hour, Self::Shift, Self::Day, Self::Week, Self::Month];

    const fn minutes(self) -> u32 {
        match self {
            Self::QuarterHour => 15,
            Self::Hour => 60,
            Self::Shift => 8 * 60,
            Self::Day => 24 * 60,
            Self::Week => 7 * 24 * 60,
            Self::Month => 30 * 24 * 60,
        }
    }

    fn words(self) -> AttrValue {
        match self {
            Self::QuarterHour => tr!("span.quarter_hour"),
            Self::Hour => tr!("span.hour"),
            Self::Shift => tr!("span.shift"),
            Self::Day => tr!("span.day"),
            Self::Week => tr!("span.week"),
            Self::Month => tr!("span.month"),
        }
    }
}

impl Wanted {
    pub(super) fn new() -> Self {
        let nothing = String::new();
        let empty = Self {
            span: Span::Hour,
            from: nothing.clone(),
            to: nothing.clone(),
            result: nothing.clone(),
            before: nothing,
        };
        empty.over(Span::Hour)
    }

    /// The same of another time, which ends now.
    pub(super) fn over(&self, span: Span) -> Self {
        let back = f64::from(span.minutes()) * 60_000.0;
        Self { span, from: browser::utc(-back), to: browser::utc(0.0), before: String::new(), ..self.clone() }
    }
}

/// Three choices, a button that asks again, and the file.
pub(super) fn filter(
    blocks: &[Block],
    block: &str,
    wanted: &Wanted,
    on_block: Callback<String>,
    on_span: &Callback<Span>,
    on_result: Callback<String>,
    csv: String,
) -> Html {
    let all = std::iter::once(("".into(), tr!("history.all_blocks")));
    let names = blocks
        .iter()
        .map(|it| (AttrValue::from(String::from(it.id)), AttrValue::from(it.config.name().to_owned())));
    let spans: Vec<_> =
        Span::ALL.iter().map(|span| (span.minutes().to_string().into(), span.words())).collect();
    let results = [
        ("".into(), tr!("history.both")),
        ("ok".into(), tr!("history.good")),
        ("failed".into(), tr!("history.failed")),
    ];
    let again = {
        let (on_span, span) = (on_span.clone(), wanted.span);
        move |_: MouseEvent| on_span.emit(span)
    };
    let on_minutes = on_span.reform(|minutes: String| {
        let is_it = |span: &Span| span.minutes().to_string() == minutes;
        Span::ALL.into_iter().find(is_it).unwrap_or(Span::Hour)
    });
    html! {
        <div class="inline-form filters">
            { choice("history-block", tr!("history.block"), block, &all.chain(names).collect::<Vec<_>>(), on_block) }
            { choice("history-span", tr!("history.span"), &wanted.span.minutes().to_string(), &spans, on_minutes) }
            { choice("history-result", tr!("history.result"), &wanted.result, &results, on_result) }
            <button type="button" class="button" onclick={again} data-test="history-again">{ tr!("history.again") }</button>
            <a class="export" href={csv} download="" data-test="csv">{ tr!("history.csv") }</a>
        </div>
    }
}

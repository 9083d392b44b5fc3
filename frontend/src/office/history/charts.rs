//! The charts of one block, and the same in numbers.

use cipdeck_shared::api::{HistoryBucket, HistoryRange, HistoryTrend};
use yew::prelude::*;

use super::{
    chart::{Line, chart},
    strip::strip,
};
use crate::{
    browser,
    kit::short,
    office::{
        i18n::tr,
        kit::{choice, note},
    },
};

/// Good and bad, reply time, and a value if the block's replies hold numbers.
pub(super) fn charts(trend: &HistoryTrend, on_value: Callback<String>) -> Html {
    if trend.buckets.is_empty() {
        return note(tr!("chart.none"));
    }
    let reply = Line {
        title: tr!("chart.reply"),
        test: "reply-chart",
        points: points(trend, |it| it.reply_us.as_ref()),
        divisor: 1_000.0,
    };
    let name = trend.value.clone().unwrap_or_default();
    let value = Line {
        title: tr!("chart.value", name = name),
        test: "value-chart",
        points: points(trend, |it| it.value.as_ref()),
        divisor: 1.0,
    };
    let names: Vec<_> = trend
        .values
        .iter()
        .map(|name| (AttrValue::from(name.clone()), AttrValue::from(name.clone())))
        .collect();
    html! {
        <section class="charts">
            if !trend.complete {
                <p class="warning-text">{ tr!("chart.incomplete") }</p>
            }
            { strip(trend) }
            { chart(trend, &reply) }
            if names.len() > 1 {
                { choice("history-value", tr!("history.value"), &name, &names, on_value) }
            }
            { chart(trend, &value) }
            { table(trend) }
        </section>
    }
}

fn points(
    trend: &HistoryTrend,
    of: impl Fn(&HistoryBucket) -> Option<&HistoryRange>,
) -> Vec<(u32, &HistoryRange)> {
    trend.buckets.iter().filter_map(|it| Some((it.index, of(it)?))).collect()
}

/// What is drawn, in numbers.
fn table(trend: &HistoryTrend) -> Html {
    let range = |range: Option<&HistoryRange>, divisor: f64| {
        range.map_or_else(String::new, |it| {
            let [min, mean, max] = [it.min, it.mean, it.max].map(|number| short(number / divisor));
            tr!("chart.range", min = min, mean = mean, max = max).to_string()
        })
    };
    let start = browser::ms_of(&trend.from);
    #[expect(clippy::cast_precision_loss, reason = "a length of time")]
    let bucket_ms = trend.bucket_us as f64 / 1_000.0;
    let line = |it: &HistoryBucket| {
        html! {
            <tr key={it.index}>
                <th scope="row">{ browser::local(start + f64::from(it.index) * bucket_ms) }</th>
                <td class="num">{ it.runs }</td><td class="num">{ it.failed }</td>
                <td>{ range(it.reply_us.as_ref(), 1_000.0) }</td><td>{ range(it.value.as_ref(), 1.0) }</td>
            </tr>
        }
    };
    html! {
        <details class="numbers">
            <summary>{ tr!("chart.numbers") }</summary>
            <div class="scroll"><table class="listing">
                <thead><tr>
                    <th scope="col">{ tr!("chart.from") }</th><th scope="col" class="num">{ tr!("chart.runs") }</th>
                    <th scope="col" class="num">{ tr!("chart.failed") }</th><th scope="col">{ tr!("chart.reply") }</th>
                    <th scope="col">{ tr!("history.value") }</th>
                </tr></thead>
                <tbody>{ for trend.buckets.iter().map(line) }</tbody>
            </table></div>
        </details>
    }
}

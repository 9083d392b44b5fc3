//! Runs that have ended: of all blocks, or of one with its charts.

mod chart;
mod charts;
mod dropped;
mod filter;
mod run;
mod state;
mod strip;

use cipdeck_shared::{
    api::{HistoryPage as Runs, HistoryTrend},
    config::{Block, BlockId},
};
use yew::prelude::*;

use self::{
    charts::charts,
    dropped::dropped,
    filter::{Span, Wanted, filter},
    run::run,
    state::HistoryKept,
};
use super::{
    fetch::use_fetched,
    i18n::tr,
    kit::{note, waiting},
    query::query,
    route::{self, Page},
};
use crate::{hooks::use_title, net::rest};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct HistoryProps {
    pub(super) block: Option<BlockId>,
}

/// Filter, charts of one block, list, what is missing, and the way to take it along.
#[component]
pub(super) fn HistoryPage(props: &HistoryProps) -> Html {
    use_title(&tr!("history.title"));
    let blocks = use_fetched::<Vec<Block>>("blocks".to_owned());
    let wanted = use_state(Wanted::new);
    let block = props.block.map(String::from).unwrap_or_default();
    let (from, to) = (wanted.from.as_str(), wanted.to.as_str());
    let pairs = [("block", block.as_str()), ("from", from), ("to", to), ("result", wanted.result.as_str())];
    let runs = use_fetched::<Runs>(format!(
        "history{}",
        query(&[&pairs[..], &[("before", &wanted.before)]].concat())
    ));
    let on_span = {
        let wanted = wanted.clone();
        Callback::from(move |span: Span| wanted.set(wanted.over(span)))
    };
    let on_result = {
        let wanted = wanted.clone();
        Callback::from(move |result: String| {
            wanted.set(Wanted { result, before: String::new(), ..(*wanted).clone() });
        })
    };
    let on_block = Callback::from(|id: String| route::go(Page::History(id.parse().ok())));
    let older = runs.data.as_ref().and_then(|page| page.next.clone()).map(|before| {
        let wanted = wanted.clone();
        let onclick = move |_: MouseEvent| wanted.set(Wanted { before: before.clone(), ..(*wanted).clone() });
        html! { <button type="button" class="button" {onclick} data-test="older">{ tr!("audit.older") }</button> }
    });
    let names = blocks.data.as_deref().map(Vec::as_slice).unwrap_or_default();
    let csv = rest::address(&format!("history.csv{}", query(&pairs)));
    html! { <>
        <h1>{ tr!("history.title") }</h1>
        <HistoryKept />
        { filter(names, &block, &wanted, on_block, &on_span, on_result, csv) }
        if let Some(id) = props.block {
            <Trend key={id.to_string()} {id} from={from.to_owned()} to={to.to_owned()} />
        } else {
            { note(tr!("history.choose")) }
        }
        { waiting(&runs) }
        if let Some(page) = &runs.data {
            { dropped(&page.dropped) }
            if page.runs.is_empty() {
                { note(tr!("history.none")) }
            } else {
                <div class="scroll"><table class="listing" aria-label={tr!("history.runs")}>
                    <thead><tr>
                        <th scope="col">{ tr!("audit.at") }</th><th scope="col">{ tr!("history.block") }</th>
                        <th scope="col">{ tr!("history.result") }</th><th scope="col" class="num">{ tr!("history.reply") }</th>
                        <th scope="col">{ tr!("history.value") }</th>
                    </tr></thead>
                    <tbody>{ for page.runs.iter().map(|it| run(it, names)) }</tbody>
                </table></div>
            }
        }
        <div class="choices">{ older }</div>
    </> }
}

#[derive(Clone, PartialEq, Properties)]
struct TrendProps {
    id: BlockId,
    from: String,
    to: String,
}

/// The charts of a block; of its values the one that somebody chooses.
#[component]
fn Trend(props: &TrendProps) -> Html {
    let value = use_state(String::new);
    let block = String::from(props.id);
    let pairs = [
        ("block", block.as_str()),
        ("from", &props.from),
        ("to", &props.to),
        ("points", POINTS),
        ("value", &value),
    ];
    let trend = use_fetched::<HistoryTrend>(format!("history/trend{}", query(&pairs)));
    let on_value = {
        let value = value.clone();
        Callback::from(move |name: String| value.set(name))
    };
    match &trend.data {
        None => waiting(&trend),
        Some(found) => html! { <>{ dropped(&found.dropped) }{ charts(found, on_value) }</> },
    }
}

/// As many as a chart has room for.
const POINTS: &str = "160";

//! The bytes: the request as it would be sent now, and the newest reply.

use std::rc::Rc;

use cipdeck_shared::{
    api::ExchangeView,
    config::{BlockId, read_hex},
    dissect,
};
use gloo_timers::callback::Timeout;
use yew::{platform::spawn_local, prelude::*};

use super::subject::Subject;
use crate::{browser, hooks::use_workbench, i18n::tr, kit::HexView, net::rest, store::DeckId};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct ExchangeProps {
    pub(super) subject: Rc<Subject>,
    pub(super) exchange: Option<Rc<ExchangeView>>,
}

/// Request and reply, byte by byte.
#[component]
pub(super) fn Exchange(props: &ExchangeProps) -> Html {
    let request = props.subject.plan.as_ref().map(|plan| plan.request().bytes());
    let request_view = use_memo(request, |request| {
        request.as_deref().map(|bytes| (Rc::<[u8]>::from(bytes), Rc::new(dissect::request(bytes))))
    });
    let reply_view = use_memo(props.exchange.clone(), |exchange| {
        let exchange = exchange.as_ref()?;
        let reply = read_hex(exchange.response.as_deref()?).ok()?;
        let request = read_hex(&exchange.request).ok();
        let tree = dissect::reply(&reply, request.as_deref());
        Some((Rc::<[u8]>::from(reply), Rc::new(tree)))
    });
    html! {
        <>
            <h2>{ tr!("bytes.request") }<span class="count">{ count(request_view.as_ref().as_ref().map(|(bytes, _)| bytes.len())) }</span></h2>
            if let Some((bytes, tree)) = &*request_view {
                <HexView label={tr!("bytes.request")} bytes={bytes.clone()} tree={tree.clone()} hint=true test="request-bytes" />
            } else {
                <p class="quiet">{ tr!("bytes.no_request") }</p>
            }
            <h2>{ tr!("bytes.reply") }<span class="count">{ count(reply_view.as_ref().as_ref().map(|(bytes, _)| bytes.len())) }</span></h2>
            if let Some((bytes, tree)) = &*reply_view {
                <HexView label={tr!("bytes.reply")} bytes={bytes.clone()} tree={tree.clone()} test="reply-bytes" />
            } else {
                <p class="quiet">{ if props.exchange.is_some() { tr!("bytes.unanswered") } else { tr!("bytes.no_reply") } }</p>
            }
        </>
    }
}

fn count(bytes: Option<usize>) -> AttrValue {
    bytes.map_or_else(AttrValue::default, |count| tr!("field.byte_count", count = count))
}

/// Fetches the newest exchange of a stored block after its runs, but not more often than people can look.
#[hook]
pub(super) fn use_exchange(id: DeckId, runs: u64) {
    let bench = use_workbench();
    let last = use_mut_ref(|| f64::NEG_INFINITY);
    use_effect_with((id, runs), move |(id, runs)| {
        let fetch = id.stored().filter(|_| *runs > 0 && bench.relay().is_online()).map(|block| {
            let wait = (*last.borrow() + MOST_OFTEN_MS - browser::now_ms()).max(0.0);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to MOST_OFTEN_MS")]
            Timeout::new(wait as u32, move || {
                *last.borrow_mut() = browser::now_ms();
                spawn_local(async move { fetch(&bench, block).await });
            })
        });
        move || drop(fetch)
    });
}

/// ms between two fetches of a cyclic block.
const MOST_OFTEN_MS: f64 = 500.0;

async fn fetch(bench: &crate::workbench::Workbench, block: BlockId) {
    // Without an answer the bytes stay as they are; the connection says why.
    if let Ok(Some(exchange)) = rest::newest_exchange(block).await {
        bench.rows().put_exchange(DeckId::Stored(block), exchange);
    }
}

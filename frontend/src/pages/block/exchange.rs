//! The bytes: the request as it would be sent now, and the newest reply.

use std::rc::Rc;

use cipdeck_shared::{
    api::{BlockStatus, ExchangeView},
    config::{BlockId, Profile, read_hex, write_hex},
    dissect,
    engine::Phase,
    plan::MessagePlan,
    wire::MessageRouterReply,
};
use gloo_timers::callback::Timeout;
use yew::{platform::spawn_local, prelude::*};

use super::subject::Subject;
use crate::{browser, hooks::use_workbench, i18n::tr, kit::HexView, net::rest, store::DeckId};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct ExchangeProps {
    pub(super) subject: Rc<Subject>,
    pub(super) exchange: Option<Rc<ExchangeView>>,
    /// The exchange is not that of the newest run: it has not been fetched yet.
    pub(super) earlier: bool,
    pub(super) has_run: bool,
}

/// Request and reply, byte by byte.
#[component]
pub(super) fn Exchange(props: &ExchangeProps) -> Html {
    let subject = &props.subject;
    let request = subject.plan.as_ref().map(|plan| sent(plan, subject.profile).to_vec());
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
            <h2>
                { tr!("bytes.request") }
                <span class="count">{ count(request_view.as_ref().as_ref().map(|(bytes, _)| bytes.len())) }</span>
                if let Some(plan) = &subject.plan {
                    <span class="count" data-test="sent-as">{ sent_as(plan, subject.profile) }</span>
                }
                { download(props) }
            </h2>
            if let Some((bytes, tree)) = &*request_view {
                <HexView label={tr!("bytes.request")} bytes={bytes.clone()} tree={tree.clone()} hint=true test="request-bytes" />
            } else {
                <p class="quiet">{ tr!("bytes.no_request") }</p>
            }
            <h2>
                { tr!("bytes.reply") }
                <span class="count">{ count(reply_view.as_ref().as_ref().map(|(bytes, _)| bytes.len())) }</span>
                if props.earlier {
                    <span class="count" data-test="reply-earlier">{ tr!("bytes.earlier") }</span>
                }
            </h2>
            if let Some((bytes, tree)) = &*reply_view {
                <HexView label={tr!("bytes.reply")} bytes={bytes.clone()} tree={tree.clone()} test="reply-bytes" />
            } else {
                <p class="quiet">{ if props.exchange.is_some() { tr!("bytes.unanswered") } else { tr!("bytes.no_reply") } }</p>
            }
        </>
    }
}

/// The bytes that go out: over a connection the message alone, otherwise with its route around it.
fn sent(plan: &MessagePlan, profile: Profile) -> &[u8] {
    match plan.connection() {
        Some(_) => plan.bytes(),
        None => plan.routed(profile).message(),
    }
}

/// What is around these bytes, or in them.
fn sent_as(plan: &MessagePlan, profile: Profile) -> AttrValue {
    match (plan.connection(), plan.routed(profile).route().is_empty()) {
        (Some(_), _) => tr!("bytes.connected"),
        (None, false) => tr!("bytes.routed"),
        (None, true) => AttrValue::default(),
    }
}

/// The frames of the block's last messages for Wireshark; only a relay keeps them.
fn download(props: &ExchangeProps) -> Html {
    match props.subject.id {
        DeckId::Stored(id) if props.subject.online && props.has_run => html! { <>
            { other_ways(id) }
            <a class="download" href={format!("/office/history/{id}")} data-test="history">{ tr!("bytes.history") }</a>
            <a class="download" href={rest::capture(id)} download="" title={tr!("bytes.download_title")} data-test="pcapng">
                { tr!("bytes.download") }
            </a>
        </> },
        DeckId::Stored(id) if props.subject.online => other_ways(id),
        _ => html! {},
    }
}

/// As code of a controller, and field by field: in the documents that have room for it.
fn other_ways(id: BlockId) -> Html {
    html! { <>
        <a class="download" href={format!("/code/{id}")} data-test="code">{ tr!("bytes.code") }</a>
        <a class="download" href={format!("/office/data/{id}")} data-test="data">{ tr!("bytes.data") }</a>
    </> }
}

/// Whether an exchange cannot be that of the newest run, which it is fetched after.
pub(super) fn is_earlier(exchange: &ExchangeView, status: &BlockStatus) -> bool {
    let reply = exchange.response.as_deref().and_then(|response| read_hex(response).ok());
    let reply = reply.as_deref().and_then(|reply| MessageRouterReply::decode(reply).ok());
    let same = match (status.phase, reply) {
        (Phase::Done, Some(reply)) => write_hex(reply.data) == status.res_data,
        (Phase::Done, None) => false,
        (Phase::Failed, Some(reply)) => match status.status.error_id {
            REFUSED => u16::from(reply.status.0) == status.status.sub_error_id,
            // A reply that could not be used: too long, or of another service.
            error_id => MAY_HAVE_A_REPLY.contains(&error_id),
        },
        (Phase::Failed, None) => status.status.error_id != REFUSED,
        // A new run is under way: it will have its own.
        _ => return false,
    };
    !same || exchange.request != status.request
}

/// `ErrorID` of a CIP error reply.
const REFUSED: u16 = 224;

/// `ErrorID`s that a reply with bytes can end in: the data does not fit, the reply makes no sense.
const MAY_HAVE_A_REPLY: [u16; 2] = [33, 69];

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

#[cfg(test)]
mod tests {
    use super::*;
    use cipdeck_shared::engine::BlockView;

    const REQUEST: &str = "0e03200124013007";

    fn exchange(response: Option<&str>) -> ExchangeView {
        ExchangeView {
            at: String::new(),
            request: REQUEST.to_owned(),
            response: response.map(str::to_owned),
            request_frame: None,
            response_frame: None,
        }
    }

    fn status(phase: Phase, error_id: u16, sub_error_id: u16, res_data: &str) -> BlockStatus {
        let mut status =
            BlockStatus::new(BlockId(1), &BlockView { phase, ..BlockView::default() }, None, None);
        (status.status.error_id, status.status.sub_error_id) = (error_id, sub_error_id);
        (status.request, status.res_data) = (REQUEST.to_owned(), res_data.to_owned());
        status
    }

    #[test]
    fn bytes_of_an_earlier_run_are_told_from_those_of_the_newest() {
        let (good, refusal) = (exchange(Some("8e0000000a0b")), exchange(Some("8e000500")));
        for (name, exchange, status, earlier) in [
            ("its own value", &good, status(Phase::Done, 0, 0, "0a0b"), false),
            ("another value", &good, status(Phase::Done, 0, 0, "0a0c"), true),
            ("its own refusal", &refusal, status(Phase::Failed, 224, 5, ""), false),
            ("a value before a refusal", &good, status(Phase::Failed, 224, 5, ""), true),
            ("a value before a timeout", &good, status(Phase::Failed, 55, 115, ""), true),
            ("a timeout", &exchange(None), status(Phase::Failed, 55, 115, ""), false),
            ("nothing before a value", &exchange(None), status(Phase::Done, 0, 0, "0a0b"), true),
            ("a value that was too long", &good, status(Phase::Failed, 33, 48, ""), false),
            ("while the next run is under way", &good, status(Phase::Sent, 0, 0, ""), false),
        ] {
            assert_eq!(is_earlier(exchange, &status), earlier, "{name}");
        }
        let other =
            BlockStatus { request: "0e03200124013001".to_owned(), ..status(Phase::Done, 0, 0, "0a0b") };
        assert!(is_earlier(&good, &other), "the answer to another request");
    }
}

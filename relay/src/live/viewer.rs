//! One viewer: it says which groups it watches, and gets what is new of them at most every 100 ms.

use std::sync::Arc;
use std::time::Duration;

use axum::extract::ws::Message;
use cipdeck_shared::api::{LIVE_PROTOCOL, LiveClientMessage, LiveServerMessage};
use cipdeck_shared::config::GroupId;
use futures_util::{Sink, Stream, StreamExt};
use tokio::time::{Instant, sleep_until};
use tokio_util::sync::CancellationToken;

use crate::actor::Actor;
use crate::line::{End, Line};
use crate::permit::Policy;
use crate::plant::{Plant, Seen};

/// Least time between two messages with values.
const PAUSE: Duration = Duration::from_millis(100);

/// Least time between two messages with statuses.
const STATUS_PAUSE: Duration = Duration::from_millis(500);

/// Groups that one viewer may watch at once.
const MAX_WATCHED: usize = 64;

/// Who watches what.
#[derive(Debug)]
pub(super) struct Seat {
    /// Who.
    pub(super) actor: Actor,
    /// What.
    pub(super) plant: Plant,
    /// Whether anything can be written.
    pub(super) policy: Arc<Policy>,
    /// Until the relay stops.
    pub(super) stop: CancellationToken,
}

/// Serves a viewer until it leaves, stops reading, or the relay stops.
pub(super) async fn serve<S, R, E>(sink: S, mut stream: R, seat: Seat)
where
    S: Sink<Message> + Unpin + Send,
    R: Stream<Item = Result<Message, E>> + Unpin + Send,
{
    let Seat { actor, plant, policy, stop } = seat;
    let (mut version, mut rules) = (plant.hub().watch(), policy.watch());
    let mut viewer = Viewer { line: Line::new(sink), seen: Seen::default() };
    let (mut next, mut next_status, mut is_behind) = (Instant::now(), Instant::now(), true);
    let mut end = viewer.hello(&policy).await;
    while let Ok(()) = end {
        end = tokio::select! {
            // Somebody who is locked out hears and sees nothing more, however much there is to say.
            biased;
            () = stop.cancelled() => Err(End::STOPPING),
            () = actor.gone() => Err(End::SIGNED_OUT),
            changed = rules.changed() => match changed {
                Ok(()) => viewer.line.say(&LiveServerMessage::Access(policy.write_state())).await,
                Err(_) => Err(End::Gone),
            },
            frame = stream.next() => match frame {
                Some(Ok(frame)) => match read(frame) {
                    Ok(None) => Ok(()),
                    Ok(Some(groups)) => {
                        plant.hub().watch_groups(&mut viewer.seen, &groups);
                        is_behind = true;
                        Ok(())
                    }
                    Err(Wrong::Message(detail)) => viewer.line.say(&LiveServerMessage::Problem { detail }).await,
                    Err(Wrong::End(end)) => Err(end),
                },
                Some(Err(_)) | None => Err(End::Gone),
            },
            changed = version.changed(), if !is_behind => {
                is_behind = true;
                changed.map_err(|_| End::Gone)
            }
            () = sleep_until(next), if is_behind => {
                is_behind = false;
                let now = Instant::now();
                next = now + PAUSE;
                version.mark_unchanged();
                let told = viewer.news(&plant).await;
                if told.is_ok() && now >= next_status {
                    next_status = now + STATUS_PAUSE;
                    viewer.statuses(&plant).await
                } else {
                    // Those that wait are looked for again.
                    is_behind = viewer.waits(&plant);
                    told
                }
            }
        };
    }
    if let Err(end) = end {
        viewer.line.close(end, stream).await;
    }
}

enum Wrong {
    Message(String),
    End(End),
}

fn read(frame: Message) -> Result<Option<Vec<GroupId>>, Wrong> {
    let text = match frame {
        Message::Text(text) => text,
        Message::Binary(_) => return Err(Wrong::Message("messages are text".to_owned())),
        Message::Close(_) => return Err(Wrong::End(End::Gone)),
        // Answered by the socket itself.
        Message::Ping(_) | Message::Pong(_) => return Ok(None),
    };
    if !text.trim_ascii_start().starts_with('{') {
        // An array of a message's members would be read as well.
        let detail = "the message cannot be read: it has to be a JSON object";
        return Err(Wrong::Message(detail.to_owned()));
    }
    match serde_json::from_str(&text) {
        Ok(LiveClientMessage::Watch { groups }) if groups.len() > MAX_WATCHED => {
            Err(Wrong::Message(format!("at most {MAX_WATCHED} groups can be watched")))
        }
        Ok(LiveClientMessage::Watch { groups }) => Ok(Some(groups)),
        Err(error) => Err(Wrong::Message(format!("the message cannot be read: {error}"))),
    }
}

struct Viewer<S> {
    line: Line<S>,
    seen: Seen,
}

impl<S: Sink<Message> + Unpin> Viewer<S> {
    async fn hello(&mut self, policy: &Policy) -> Result<(), End> {
        let relay = env!("CARGO_PKG_VERSION").to_owned();
        self.line.say(&LiveServerMessage::Hello { protocol: LIVE_PROTOCOL, relay }).await?;
        self.line.say(&LiveServerMessage::Access(policy.write_state())).await
    }

    /// What this viewer has not seen yet.
    async fn news(&mut self, plant: &Plant) -> Result<(), End> {
        let news = plant.hub().news(&mut self.seen);
        if news.tree {
            self.line.say(&LiveServerMessage::Tree(plant.tree())).await?;
        }
        for group in news.variables {
            self.line.say(&LiveServerMessage::Variables { group }).await?;
        }
        for values in news.values {
            self.line.say(&LiveServerMessage::Values { group: values.group, values: values.values }).await?;
        }
        Ok(())
    }

    async fn statuses(&mut self, plant: &Plant) -> Result<(), End> {
        let devices = plant.hub().statuses(&mut self.seen);
        if devices.is_empty() { Ok(()) } else { self.line.say(&LiveServerMessage::Status { devices }).await }
    }

    /// Whether there are statuses that it has not seen.
    fn waits(&self, plant: &Plant) -> bool {
        plant.hub().has_statuses(&self.seen)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Who writes a client copies from the document.
    #[test]
    fn every_example_of_live_values_is_a_message() {
        let text = include_str!("../../../docs/LIVE.md");
        let mut kinds = Vec::new();
        for example in text.split("```json").skip(1).filter_map(|rest| rest.split("```").next()) {
            let value: serde_json::Value = serde_json::from_str(example).unwrap();
            let kind = value["type"].as_str().unwrap().to_owned();
            let again = if kind == "watch" {
                serde_json::to_value(serde_json::from_str::<LiveClientMessage>(example).unwrap()).unwrap()
            } else {
                serde_json::to_value(serde_json::from_str::<LiveServerMessage>(example).unwrap()).unwrap()
            };
            assert_eq!(again, value, "{example}");
            kinds.push(kind);
        }
        for kind in ["hello", "access", "tree", "status", "variables", "values", "problem", "watch"] {
            assert!(kinds.iter().any(|there| there == kind), "no example of {kind}");
        }
    }

    #[test]
    fn what_is_no_message_says_why() {
        let groups: Vec<_> = (0..65).map(|number| format!("\"g{number}\"")).collect();
        let many = format!(r#"{{"type":"watch","groups":[{}]}}"#, groups.join(","));
        for text in ["", "[]", r#"["watch",["g1"]]"#, r#"{"type":"run"}"#, many.as_str()] {
            assert!(matches!(read(Message::text(text)), Err(Wrong::Message(_))), "{text}");
        }
        let watch = read(Message::text(r#" {"type":"watch","groups":["g1"]}"#));
        assert!(matches!(watch, Ok(Some(groups)) if groups == [GroupId(1)]));
    }
}

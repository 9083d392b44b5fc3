//! One viewer: it gets what is new at most every 50 ms, and sends commands.

use std::sync::Arc;
use std::time::Duration;

use axum::extract::ws::{Message, close_code};
use cipdeck_shared::api::{PROTOCOL_VERSION, ServerMessage};
use futures_util::{Sink, Stream, StreamExt};
use tokio::task::JoinSet;
use tokio::time::{Instant, sleep_until};
use tokio_util::sync::CancellationToken;

use super::{MAX_MESSAGE, command};
use crate::actor::Actor;
use crate::blocks::Blocks;
use crate::error::ApiError;
use crate::hub::{Cursor, Update};
use crate::line::{End, Line};
use crate::metrics::Metrics;
use crate::permit::Policy;

/// Least time between two messages with changes.
const PAUSE: Duration = Duration::from_millis(50);

/// Commands of one viewer that may be under way at once.
const MAX_COMMANDS: usize = 256;

/// Who watches what.
#[derive(Debug)]
pub(super) struct Seat {
    /// Who.
    pub(super) actor: Actor,
    /// What.
    pub(super) blocks: Blocks,
    /// Whether anything can be written.
    pub(super) policy: Arc<Policy>,
    /// Until the relay stops.
    pub(super) stop: CancellationToken,
}

/// Serves a viewer until it leaves, stops reading, or the relay stops. Generic over the socket, so that tests need
/// none.
pub(super) async fn serve<S, R, E>(sink: S, mut stream: R, seat: Seat, is_too_long: fn(&E) -> bool)
where
    S: Sink<Message> + Unpin + Send,
    R: Stream<Item = Result<Message, E>> + Unpin + Send,
{
    let Seat { actor, blocks, policy, stop } = seat;
    let (mut version, mut rules) = (blocks.hub().watch(), policy.watch());
    let mut viewer = Viewer::new(sink);
    let (mut commands, mut next, mut is_behind) = (JoinSet::new(), Instant::now(), true);
    let hello =
        ServerMessage::Hello { protocol: PROTOCOL_VERSION, relay: env!("CARGO_PKG_VERSION").to_owned() };
    let mut end = viewer.line.say(&hello).await;
    if end.is_ok() {
        end = viewer.line.say(&ServerMessage::Access(policy.write_state())).await;
    }
    while let Ok(()) = end {
        end = tokio::select! {
            // Somebody who is locked out hears and sees nothing more, however much there is to say.
            biased;
            () = stop.cancelled() => Err(End::STOPPING),
            () = actor.gone() => Err(End::SIGNED_OUT),
            changed = rules.changed() => match changed {
                Ok(()) => viewer.line.say(&ServerMessage::Access(policy.write_state())).await,
                Err(_) => Err(End::Gone),
            },
            frame = stream.next() => match frame {
                Some(Ok(frame)) => match read(frame) {
                    Ok(None) => Ok(()),
                    Ok(Some(message)) if commands.len() < MAX_COMMANDS => {
                        actor.touch();
                        commands.spawn(command::carry_out(message, actor.clone(), blocks.clone()));
                        Ok(())
                    }
                    Ok(Some(message)) => viewer.line.say(&too_many(&message)).await,
                    Err(Wrong::Answer(answer)) => viewer.line.say(&answer).await,
                    Err(Wrong::End(end)) => Err(end),
                },
                Some(Err(error)) if is_too_long(&error) => Err(TOO_LONG),
                Some(Err(_)) | None => Err(End::Gone),
            },
            Some(answer) = commands.join_next() => match answer {
                Ok(answer) => viewer.line.say(&answer).await,
                // It panicked: the log has it, and the viewer's command stays without an answer.
                Err(_) => Ok(()),
            },
            changed = version.changed(), if !is_behind => {
                is_behind = true;
                changed.map_err(|_| End::Gone)
            }
            () = sleep_until(next), if is_behind => {
                is_behind = false;
                next = Instant::now() + PAUSE;
                version.mark_unchanged();
                viewer.update(&blocks, &policy.metrics).await
            }
        };
    }
    if let Err(end) = end {
        viewer.line.close(end, stream).await;
    }
}

const TOO_LONG: End = End::Close(close_code::SIZE, "a message has at most 64 KiB");

enum Wrong {
    Answer(Box<ServerMessage>),
    End(End),
}

fn read(frame: Message) -> Result<Option<cipdeck_shared::api::ClientMessage>, Wrong> {
    match frame {
        Message::Text(text) if text.len() > MAX_MESSAGE => Err(Wrong::End(TOO_LONG)),
        Message::Binary(bytes) if bytes.len() > MAX_MESSAGE => Err(Wrong::End(TOO_LONG)),
        Message::Text(text) => command::read(&text).map(Some).map_err(Wrong::Answer),
        Message::Binary(_) => Err(Wrong::Answer(Box::new(command::unreadable("", "messages are text")))),
        Message::Close(_) => Err(Wrong::End(End::Gone)),
        // Answered by the socket itself.
        Message::Ping(_) | Message::Pong(_) => Ok(None),
    }
}

fn too_many(message: &cipdeck_shared::api::ClientMessage) -> ServerMessage {
    let error = ApiError::Busy(format!("{MAX_COMMANDS} commands of this viewer are under way"));
    command::refuse(command::id(message).to_owned(), error)
}

struct Viewer<S> {
    line: Line<S>,
    cursor: Cursor,
    seq: u64,
}

impl<S: Sink<Message> + Unpin> Viewer<S> {
    fn new(sink: S) -> Self {
        Self { line: Line::new(sink), cursor: Cursor::default(), seq: 0 }
    }

    /// What this viewer has not seen yet.
    async fn update(&mut self, blocks: &Blocks, metrics: &Metrics) -> Result<(), End> {
        let Some(update) = blocks.hub().update(&mut self.cursor) else { return Ok(()) };
        self.seq += 1;
        let seq = self.seq;
        let Update { is_snapshot, blocks, statuses, removed, targets, targets_removed } = update;
        if is_snapshot && seq > 1 {
            metrics.snapshot();
        }
        let message = if is_snapshot {
            ServerMessage::Snapshot { seq, blocks, statuses, targets }
        } else {
            ServerMessage::Changes { seq, statuses, blocks, removed, targets, targets_removed }
        };
        self.line.say(&message).await
    }
}

#[cfg(test)]
mod tests;

//! One viewer: it gets what is new at most every 50 ms, and sends commands.

use std::sync::Arc;
use std::time::Duration;

use axum::extract::ws::{CloseFrame, Message, Utf8Bytes, close_code};
use cipdeck_shared::api::{PROTOCOL_VERSION, ServerMessage};
use futures_util::{Sink, SinkExt, Stream, StreamExt};
use tokio::task::JoinSet;
use tokio::time::{Instant, sleep_until, timeout};
use tokio_util::sync::CancellationToken;

use super::{MAX_MESSAGE, command};
use crate::actor::Actor;
use crate::blocks::Blocks;
use crate::error::ApiError;
use crate::hub::{Cursor, Update};
use crate::metrics::Metrics;
use crate::permit::Policy;

/// Least time between two messages with changes.
const PAUSE: Duration = Duration::from_millis(50);

/// A viewer that takes nothing for so long is gone.
const PATIENCE: Duration = Duration::from_secs(10);

/// The close code for somebody whose session has ended, from the range that is free for applications.
const SIGNED_OUT: u16 = 4401;

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
    let mut end = viewer.say(&hello).await;
    if end.is_ok() {
        end = viewer.say(&ServerMessage::Access(policy.write_state())).await;
    }
    while let Ok(()) = end {
        end = tokio::select! {
            // Somebody who is locked out hears and sees nothing more, however much there is to say.
            biased;
            () = stop.cancelled() => Err(End::Close(close_code::AWAY, "the relay stops")),
            () = actor.gone() => Err(End::Close(SIGNED_OUT, "the session has ended: sign in again")),
            changed = rules.changed() => match changed {
                Ok(()) => viewer.say(&ServerMessage::Access(policy.write_state())).await,
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
                    Ok(Some(message)) => viewer.say(&too_many(&message)).await,
                    Err(Wrong::Answer(answer)) => viewer.say(&answer).await,
                    Err(Wrong::End(end)) => Err(end),
                },
                Some(Err(error)) if is_too_long(&error) => Err(TOO_LONG),
                Some(Err(_)) | None => Err(End::Gone),
            },
            Some(answer) = commands.join_next() => match answer {
                Ok(answer) => viewer.say(&answer).await,
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
    if let Err(End::Close(code, reason)) = end {
        viewer.close(code, reason, stream).await;
    }
}

/// Why a viewer is not served any longer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    /// We close.
    Close(u16, &'static str),
    /// It left, or the connection is broken.
    Gone,
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
    sink: S,
    cursor: Cursor,
    seq: u64,
}

impl<S: Sink<Message> + Unpin> Viewer<S> {
    fn new(sink: S) -> Self {
        Self { sink, cursor: Cursor::default(), seq: 0 }
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
        self.say(&message).await
    }

    async fn say(&mut self, message: &ServerMessage) -> Result<(), End> {
        // Our messages have string keys only, which is all that could fail.
        let text = serde_json::to_string(message).map_err(|_| End::Gone)?;
        self.send(Message::Text(text.into())).await
    }

    async fn send(&mut self, frame: Message) -> Result<(), End> {
        match timeout(PATIENCE, self.sink.send(frame)).await {
            Ok(Ok(())) => Ok(()),
            Ok(Err(_)) => Err(End::Gone),
            Err(_) => {
                tracing::info!("a viewer takes no messages any more");
                Err(End::Gone)
            }
        }
    }

    /// Says why, and gives the viewer a moment to answer, so that it hears it.
    async fn close<E>(
        &mut self,
        code: u16,
        reason: &'static str,
        mut stream: impl Stream<Item = Result<Message, E>> + Unpin,
    ) {
        let frame = CloseFrame { code, reason: Utf8Bytes::from_static(reason) };
        if self.send(Message::Close(Some(frame))).await.is_ok() {
            let answered = async { while let Some(Ok(_)) = stream.next().await {} };
            let _ = timeout(Duration::from_secs(1), answered).await;
        }
    }
}

#[cfg(test)]
mod tests;

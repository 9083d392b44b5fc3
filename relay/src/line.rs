//! The socket of a viewer, as both WebSockets use it: a viewer that takes nothing is left, one that is sent away hears
//! why.

use std::time::Duration;

use axum::extract::ws::{CloseFrame, Message, Utf8Bytes, close_code};
use futures_util::{Sink, SinkExt, Stream, StreamExt};
use serde::Serialize;
use tokio::time::timeout;

/// A viewer that takes nothing for so long is gone.
const PATIENCE: Duration = Duration::from_secs(10);

/// The close code for somebody whose session has ended, from the range that is free for applications.
const SIGNED_OUT: u16 = 4401;

/// Why a viewer is not served any longer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// We close.
    Close(u16, &'static str),
    /// It left, or the connection is broken.
    Gone,
}

impl End {
    /// The relay stops.
    pub(crate) const STOPPING: Self = Self::Close(close_code::AWAY, "the relay stops");

    /// The session, or what it was made with, has ended.
    pub(crate) const SIGNED_OUT: Self = Self::Close(SIGNED_OUT, "the session has ended: sign in again");
}

/// What is said goes through here.
pub(crate) struct Line<S>(S);

impl<S: Sink<Message> + Unpin> Line<S> {
    pub(crate) const fn new(sink: S) -> Self {
        Self(sink)
    }

    /// One message.
    pub(crate) async fn say(&mut self, message: &impl Serialize) -> Result<(), End> {
        // Our messages have string keys only, which is all that could fail.
        let text = serde_json::to_string(message).map_err(|_| End::Gone)?;
        self.send(Message::Text(text.into())).await
    }

    /// Says why, and gives the viewer a moment to answer, so that it hears it. One that is gone hears nothing.
    pub(crate) async fn close<E>(
        &mut self,
        end: End,
        mut stream: impl Stream<Item = Result<Message, E>> + Unpin,
    ) {
        let End::Close(code, reason) = end else { return };
        let frame = CloseFrame { code, reason: Utf8Bytes::from_static(reason) };
        if self.send(Message::Close(Some(frame))).await.is_ok() {
            let answered = async { while let Some(Ok(_)) = stream.next().await {} };
            let _ = timeout(Duration::from_secs(1), answered).await;
        }
    }

    async fn send(&mut self, frame: Message) -> Result<(), End> {
        match timeout(PATIENCE, self.0.send(frame)).await {
            Ok(Ok(())) => Ok(()),
            Ok(Err(_)) => Err(End::Gone),
            Err(_) => {
                tracing::info!("a viewer takes no messages any more");
                Err(End::Gone)
            }
        }
    }
}

//! What a viewer says, and what is answered.

use cipdeck_shared::api::{Answer, ClientMessage, Role, ServerMessage};

use crate::actor::Actor;
use crate::blocks::Blocks;
use crate::error::ApiError;
use crate::permit::Denied;

/// Reads a message. What cannot be read is answered under its id, if it has one.
pub(super) fn read(text: &str) -> Result<ClientMessage, Box<ServerMessage>> {
    if !text.trim_ascii_start().starts_with('{') {
        // An array of a message's members would be read as well.
        return Err(Box::new(unreadable("", "the message cannot be read: it has to be a JSON object")));
    }
    serde_json::from_str(text).map_err(|error| {
        let id = serde_json::from_str::<serde_json::Value>(text).ok();
        let id = id.as_ref().and_then(|value| value.get("id")?.as_str()).unwrap_or_default();
        Box::new(unreadable(id, &format!("the message cannot be read: {error}")))
    })
}

/// The answer to something that is no message of ours.
pub(super) fn unreadable(id: &str, why: &str) -> ServerMessage {
    refuse(id.to_owned(), ApiError::Unreadable(why.to_owned()))
}

/// A command that is not carried out.
pub(super) fn refuse(id: String, error: ApiError) -> ServerMessage {
    ServerMessage::Answer { id, answer: Box::new(Answer::Problem(error.into())) }
}

/// The id under which a message is answered.
pub(super) fn id(message: &ClientMessage) -> &str {
    match message {
        ClientMessage::Run { id, .. } | ClientMessage::Cancel { id, .. } | ClientMessage::In { id, .. } => id,
    }
}

/// Whether the caller's role may say this at all; what a command sends is asked about when it is carried out.
fn is_open_to(message: &ClientMessage, actor: &Actor) -> bool {
    match message {
        ClientMessage::Run { .. } | ClientMessage::Cancel { .. } | ClientMessage::In { .. } => {
            actor.role().is_some_and(Role::may_send)
        }
    }
}

/// Carries a command out. A run is answered at DN or ER, everything else at once.
pub(super) async fn carry_out(message: ClientMessage, actor: Actor, blocks: Blocks) -> ServerMessage {
    let id = id(&message).to_owned();
    if !is_open_to(&message, &actor) {
        return refuse(id, ApiError::NotPermitted(Denied::OnlyLooks.to_string()));
    }
    let status = match message {
        ClientMessage::Run { block, ticket, .. } => blocks.run(&actor, block, ticket.as_deref()).await,
        ClientMessage::Cancel { block, .. } => blocks.cancel(block),
        ClientMessage::In { block, input, ticket, .. } => {
            blocks.set_in(&actor, block, input, ticket.as_deref()).await
        }
    };
    match status {
        Ok(status) => ServerMessage::Answer { id, answer: Box::new(Answer::Status(status)) },
        Err(error) => refuse(id, error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_without_their_names_are_no_message() {
        assert!(read(r#" {"type":"cancel","id":"c1","block":"b7"}"#).is_ok());
        for text in [r#"["cancel","c1","b7"]"#, "null", "", "7"] {
            assert!(read(text).is_err(), "{text}");
        }
    }

    /// Who writes a client copies from the document.
    #[test]
    fn every_example_in_the_document_is_a_message() {
        let text = include_str!("../../../docs/WEBSOCKET.md");
        let mut kinds = Vec::new();
        for example in text.split("```json").skip(1).filter_map(|rest| rest.split("```").next()) {
            let value: serde_json::Value = serde_json::from_str(example).unwrap();
            let kind = value["type"].as_str().unwrap().to_owned();
            if matches!(kind.as_str(), "run" | "cancel" | "in") {
                let message = read(example).unwrap_or_else(|answer| panic!("{example}: {answer:?}"));
                assert_eq!(serde_json::to_value(message).unwrap(), value);
            } else {
                let message: ServerMessage = serde_json::from_str(example).unwrap();
                assert_eq!(serde_json::to_value(message).unwrap(), value, "{example}");
            }
            kinds.push(kind);
        }
        for kind in ["hello", "access", "snapshot", "changes", "answer", "run", "cancel", "in"] {
            assert!(kinds.iter().any(|there| there == kind), "no example of {kind}");
        }
    }
}

//! What the relay says over the WebSocket, as this page reads it.

use cipdeck_shared::{
    api::{BlockStatus, Problem, TargetStatus, WindowView},
    config::{Block, BlockId},
};
use serde::Deserialize;

/// Every member of every `ServerMessage`. Reading that type itself, which is told by its `type`, would read each message
/// twice, and cost 10 kB of the page.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Heard {
    /// `hello`, `access`, `snapshot`, `changes`, `answer`, or a word of a newer relay.
    #[serde(rename = "type")]
    pub(super) kind: String,
    pub(super) protocol: u32,
    pub(super) seq: u64,
    pub(super) blocks: Vec<Block>,
    pub(super) statuses: Vec<BlockStatus>,
    pub(super) removed: Vec<BlockId>,
    pub(super) targets: Vec<TargetStatus>,
    pub(super) targets_removed: Vec<String>,
    pub(super) window: Option<WindowView>,
    pub(super) read_only: bool,
    pub(super) stopped: Option<String>,
    pub(super) id: String,
    pub(super) status: Option<BlockStatus>,
    pub(super) problem: Option<Problem>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use cipdeck_shared::{
        api::{Answer, ProblemCode, ServerMessage, WriteState},
        config::MsgCipGeneric,
    };

    fn heard(message: &ServerMessage) -> Heard {
        serde_json::from_str(&serde_json::to_string(message).unwrap()).unwrap()
    }

    #[test]
    fn what_the_relay_says_is_read() {
        let block = Block { id: BlockId(7), revision: 3, config: MsgCipGeneric::product_name("0,0").into() };
        let changes = ServerMessage::Changes {
            seq: 8,
            statuses: Vec::new(),
            blocks: vec![block.clone()],
            removed: vec![BlockId(3)],
            targets: Vec::new(),
            targets_removed: vec!["10.0.0.1:44818".to_owned()],
        };
        let read = heard(&changes);
        assert_eq!((read.kind.as_str(), read.seq, read.removed), ("changes", 8, vec![BlockId(3)]));
        assert_eq!((read.blocks, read.targets_removed.len()), (vec![block], 1));
        let window = WindowView {
            owner: "anna".to_owned(),
            opened_at: String::new(),
            ends_at: String::new(),
            left_ms: 900_000,
        };
        let access = WriteState { window: Some(window.clone()), read_only: true, stopped: None };
        let read = heard(&ServerMessage::Access(access));
        assert_eq!((read.kind.as_str(), read.window, read.read_only), ("access", Some(window), true));
        let problem = Problem { code: ProblemCode::Busy, ..crate::net::rest::unreachable(String::new()) };
        let answer = Box::new(Answer::Problem(problem.clone()));
        let read = heard(&ServerMessage::Answer { id: "c1".to_owned(), answer });
        assert_eq!((read.kind.as_str(), read.id.as_str(), read.problem), ("answer", "c1", Some(problem)));
    }
}

//! Messages about tags: requests that nobody has configured as a block.

use crate::config::{Channel, Profile, TargetPath};
use crate::wire::{MessageRouterRequest, TooLong};

use super::effect::effects;
use super::routed::Routes;
use super::{ConnectionPlan, MessagePlan, TriggerType};

/// How requests about tags get to their controller.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TagWay {
    /// Where it is.
    pub path: TargetPath,
    /// What it is.
    pub profile: Profile,
    /// Over a class 3 connection, which stays open while it is used.
    pub connected: bool,
    /// From asking to the reply, ms.
    pub timeout_ms: u32,
}

impl MessagePlan {
    /// One message on its way; its reply may be as long as the wire carries. Refuses what does not fit into the
    /// message that carries it along the route.
    pub fn tag(way: &TagWay, request: MessageRouterRequest) -> Result<Self, TooLong> {
        let bytes = request.bytes();
        let connection = ConnectionPlan { timeout_ms: way.timeout_ms, close: false };
        Ok(Self {
            routes: Routes::new(&request, &way.path.route, way.timeout_ms)?,
            effects: effects(&bytes).into(),
            bytes: bytes.into(),
            request,
            target: way.path.target.clone(),
            channel: Channel::Monitor,
            profile: way.profile,
            trigger: TriggerType::Once,
            ucmm_timeout_ms: way.timeout_ms,
            connection: way.connected.then_some(connection),
            keep_alive_ms: 0,
            res_data_size: u16::MAX,
            resume: false,
            words: None,
        })
    }
}

//! A block as somebody sends it or keeps it in a file: the relay gives the id and counts the revisions.

use cipdeck_shared::config::{BlockConfig, read_hex, read_words, write_hex, write_words};
use serde::Deserialize;
use serde_json::Value;
use utoipa::ToSchema;

/// A configuration with or without the id and the revision that it once had.
#[derive(Clone, Debug, Deserialize, ToSchema)]
pub(crate) struct Draft {
    /// What it claims to be.
    #[serde(default)]
    pub(crate) id: Option<Value>,
    /// Which revision it replaces.
    #[serde(default)]
    pub(crate) revision: Option<u64>,
    /// The pins.
    #[serde(flatten)]
    pub(crate) config: BlockConfig,
}

/// As it is stored: bytes in lower case without spaces, words in their one spelling, and `Cancel`, which is an input,
/// FALSE.
pub(crate) fn normalised(mut config: BlockConfig) -> BlockConfig {
    match &mut config {
        BlockConfig::MsgCipGeneric(config) => {
            config.ctrl_cfg.cancel = false;
            if let Ok(bytes) = read_hex(&config.req_data) {
                config.req_data = write_hex(&bytes);
            }
        }
        BlockConfig::SendReq(config) => {
            if let Ok(words) = read_words(&config.data_to_send) {
                config.data_to_send = write_words(&words);
            }
        }
    }
    config
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_draft_keeps_what_it_does_not_know_and_is_stored_in_one_spelling() {
        let text = r#"{"id":"b3","revision":2,"name":"x","ReqData":"0A 0b,0xFF","CtrlCfg":{"Cancel":true},"Colour":"red",
            "AppCfg":{"Service":14,"Class":1,"Instance":1},"TargetCfg":{"Path":"0,0"}}"#;
        let draft: Draft = serde_json::from_str(text).unwrap();
        assert_eq!((draft.id, draft.revision), (Some("b3".into()), Some(2)));
        let config = normalised(draft.config);
        let config = config.as_msg().unwrap();
        assert_eq!((config.req_data.as_str(), config.ctrl_cfg.cancel), ("0a0bff", false));
        assert_eq!(config.extra.keys().collect::<Vec<_>>(), ["Colour"]);
    }
}

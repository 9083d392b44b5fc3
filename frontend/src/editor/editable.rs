//! What a document has to know of the kind of blocks that it edits.

use cipdeck_shared::{
    api,
    config::{BlockConfig, Extra, MsgCipGeneric, SendReq},
};
use serde::Serialize;

use super::drafts::Keepable;

/// The configuration of one kind of blocks.
pub trait Kind: Clone + Serialize + Into<BlockConfig> + 'static {
    /// That of a block of this kind.
    fn of_block(block: &BlockConfig) -> Option<&Self>;

    /// What the block is called.
    fn name(&self) -> &str;

    /// Names the block.
    fn set_name(&mut self, name: String);

    /// Members beside those of the kind.
    fn extra(&mut self) -> &mut Extra;

    /// As a relay wants it in the place of the revision that was seen. One way to write configurations instead of two: the
    /// relay takes the id from the address.
    #[must_use]
    fn with_revision(mut self, revision: u64) -> Self {
        self.extra().insert("revision".to_owned(), revision.into());
        self
    }
}

/// A draft of a configuration.
pub trait Editable: Keepable + Clone + PartialEq + 'static {
    /// What it becomes.
    type Config: Kind;
    /// One change.
    type Edit: 'static;

    /// A draft of a configuration; `revision` if it is stored.
    fn new(config: Self::Config, revision: Option<u64>) -> Self;

    /// Everything readable.
    fn config(&self) -> &Self::Config;

    /// The stored revision that it started from; none for a block that is not stored yet.
    fn revision(&mut self) -> &mut Option<u64>;

    /// Takes in one change.
    fn edit(&mut self, edit: Self::Edit);

    /// What the relay found, shown at the fields until the next change.
    fn refuse(&mut self, findings: Vec<api::Finding>);

    /// Whether storing it would change something, or cannot be tried yet.
    fn differs_from(&self, stored: &Self::Config) -> bool;
}

macro_rules! kind {
    ($config:ty, $of_block:ident) => {
        impl Kind for $config {
            fn of_block(block: &BlockConfig) -> Option<&Self> {
                block.$of_block()
            }

            fn name(&self) -> &str {
                &self.name
            }

            fn set_name(&mut self, name: String) {
                self.name = name;
            }

            fn extra(&mut self) -> &mut Extra {
                &mut self.extra
            }
        }
    };
}

kind!(MsgCipGeneric, as_msg);
kind!(SendReq, as_send_req);

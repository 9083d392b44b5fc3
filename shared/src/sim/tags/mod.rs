//! Tags of a simulated controller: Logix, Micro800 or Omron.
//!
//! A tag is a piece of memory, laid out as the family does; requests read and write pieces of it. Refusals are those of
//! the family, as far as they are known; see [`Wrong`](refusal::Wrong).

mod address;
mod file;
mod memory;
mod motion;
mod object;
mod read;
mod refusal;
mod service;
mod structures;
mod symbols;
mod templates;
mod variables;
mod write;

pub use self::file::TagFileError;
pub use self::memory::{DefinitionError, TagAccess, TagDefinition, TagMemory};
pub use self::motion::{Motion, UnknownMotion};
pub(super) use self::service::Call;
pub use self::service::Tags;

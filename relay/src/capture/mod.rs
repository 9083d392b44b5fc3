//! Captures for Wireshark: our own frames as TCP packets in a pcapng file.
//!
//! The payloads and the times are the real ones. What is around them is made up, because a program does not see its own
//! TCP headers: each connection becomes a conversation with a handshake, sequence numbers without gaps and a farewell,
//! so that Wireshark puts frames together as on a real wire. The file says so itself.

mod conversation;
mod exchanges;
mod file;
mod packet;
mod recorder;

pub use self::conversation::Conversation;
pub(crate) use self::exchanges::{Carried, file_name, of_exchanges};
pub use self::file::{CaptureFile, Packet};
pub(crate) use self::recorder::Recorder;
pub use crate::runner::{Direction, Ends};

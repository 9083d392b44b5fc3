//! The bytes of a file that somebody has chosen → text, or why they are none: as the command line reads them.

pub use cipdeck_shared::code::{Decoded, Encoding, MAX_TEXT as MAX_FILE, NoText, decode, with_line_feeds};

//! The last exchanges of a block as a capture.

use std::collections::BTreeMap;
use std::io;
use std::time::SystemTime;

use cipdeck_shared::config::BlockId;

use super::conversation::Conversation;
use super::file::CaptureFile;
use crate::runner::{Direction, Ends, Trace};

/// The frames of one message, and where they went.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Carried {
    /// Which connection, and when.
    pub(crate) trace: Trace,
    /// When the message had ended.
    pub(crate) ended: SystemTime,
    /// The frame that was written, if it was.
    pub(crate) request: Option<Vec<u8>>,
    /// The frame that was read, if one was.
    pub(crate) response: Option<Vec<u8>>,
}

/// A whole pcapng file. Each connection begins with a handshake at the time of its first frame, and has no end: it may
/// still be open.
pub(crate) fn of_exchanges(messages: &[Carried]) -> io::Result<Vec<u8>> {
    let mut file = CaptureFile::new(Vec::new())?;
    let mut conversations: BTreeMap<Ends, Conversation> = BTreeMap::new();
    for Carried { trace, ended, request, response } in messages {
        let frames = [
            (Direction::Out, request, trace.wrote.unwrap_or(*ended)),
            (Direction::In, response, trace.read.unwrap_or(*ended)),
        ];
        for (direction, frame, at) in frames {
            let Some(frame) = frame else { continue };
            let mut begin = Vec::new();
            let conversation = conversations.entry(trace.ends).or_insert_with(|| {
                let (conversation, packets) = Conversation::open(trace.ends, at);
                begin = packets;
                conversation
            });
            let packets = conversation.data(direction, frame, at);
            file.write(&begin)?;
            file.write(&packets)?;
        }
    }
    Ok(file.into_inner())
}

/// Characters of a block's name in the name of a file.
const MAX_NAME: usize = 64;

/// A file name that every system takes and that means nothing to a header: letters, digits, `-` and `_`.
pub(crate) fn file_name(block: &str, id: BlockId) -> String {
    let safe = |letter: char| if letter.is_ascii_alphanumeric() || letter == '_' { letter } else { '-' };
    let name: String = block.chars().take(MAX_NAME).map(safe).collect();
    let name = name.trim_matches('-');
    format!("{}.pcapng", if name.is_empty() { String::from(id) } else { name.to_owned() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_cannot_leave_its_folder_or_its_header() {
        for (name, expected) in [
            ("drive-current", "drive-current.pcapng"),
            ("../../etc/pass wd", "etc-pass-wd.pcapng"),
            ("a\"; x=\"\r\nb", "a---x----b.pcapng"),
            ("Füllstand 1", "F-llstand-1.pcapng"),
            ("…", "b7.pcapng"),
            ("", "b7.pcapng"),
        ] {
            assert_eq!(file_name(name, BlockId(7)), expected);
        }
    }
}

//! Records everything that goes over the runner's sockets into a file.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::SystemTime;

use cipdeck_shared::engine::LinkId;

use super::conversation::Conversation;
use super::file::{CaptureFile, Packet};
use crate::runner::{Direction, Ends, Tap, lock};

/// The recorder of one file.
#[derive(Debug)]
pub(crate) struct Recorder {
    path: PathBuf,
    recording: Mutex<Recording>,
}

#[derive(Debug)]
struct Recording {
    file: CaptureFile<BufWriter<File>>,
    conversations: BTreeMap<LinkId, Conversation>,
    /// The first thing that went wrong; nothing is written after it.
    error: Option<io::Error>,
}

/// The file cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("the capture {} cannot be written: {error}", path.display())]
pub(crate) struct RecordError {
    path: PathBuf,
    error: io::Error,
}

impl Recorder {
    /// Creates the file, or empties it.
    pub(crate) fn create(path: &Path) -> Result<Self, RecordError> {
        let file = File::create(path).and_then(|file| CaptureFile::new(BufWriter::new(file)));
        let file = file.map_err(|error| RecordError { path: path.to_owned(), error })?;
        let recording = Recording { file, conversations: BTreeMap::new(), error: None };
        Ok(Self { path: path.to_owned(), recording: Mutex::new(recording) })
    }

    /// Whether everything is in the file.
    pub(crate) fn complete(&self) -> Result<(), RecordError> {
        match lock(&self.recording).error.take() {
            None => Ok(()),
            Some(error) => Err(RecordError { path: self.path.clone(), error }),
        }
    }
}

impl Recording {
    fn write(&mut self, packets: &[Packet]) {
        if self.error.is_none() {
            self.error = self.file.write(packets).err();
        }
    }
}

impl Tap for Recorder {
    fn opened(&self, link: LinkId, ends: Ends) {
        let (conversation, packets) = Conversation::open(ends, SystemTime::now());
        let mut recording = lock(&self.recording);
        recording.conversations.insert(link, conversation);
        recording.write(&packets);
    }

    fn moved(&self, link: LinkId, direction: Direction, bytes: &[u8], at: SystemTime) {
        let mut recording = lock(&self.recording);
        if let Some(conversation) = recording.conversations.get_mut(&link) {
            let packets = conversation.data(direction, bytes, at);
            recording.write(&packets);
        }
    }

    fn closed(&self, link: LinkId, direction: Direction) {
        let mut recording = lock(&self.recording);
        if let Some(mut conversation) = recording.conversations.remove(&link) {
            recording.write(&conversation.close(direction, SystemTime::now()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_cannot_be_created_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("missing").join("a.pcapng");
        let error = Recorder::create(&path).unwrap_err().to_string();
        assert!(error.contains("a.pcapng") && error.contains("cannot be written"), "{error}");
    }
}

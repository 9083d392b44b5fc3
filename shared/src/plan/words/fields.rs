//! A table of words as fields that a person fills in, and back. Nothing is lost in either direction.

use alloc::vec::Vec;
use core::fmt;

use crate::config::{SendReqForm, bytes_of, words_of};
use crate::wire::{Epath, LogicalKind, LogicalSegment, Segment};

use super::OBJECT;
use super::split::{Split, SplitError, head};

/// A table of words in fields.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WordsFields {
    /// 0 unconnected, 1 over a class 3 connection; 0 for a DATA_EXCH, whose address says it.
    pub message_type: u16,
    /// The device on a TSX ETC 101; zeros for the other forms.
    pub ip: [u8; 4],
    /// The CIP service, with whatever bit 7 is.
    pub service: u8,
    /// The CIP path.
    pub path: WordsPath,
    /// The CIP request's data.
    pub data: Vec<u8>,
    /// Bytes behind the request that are there, but not sent. A last half word of 0 is none.
    pub behind: Vec<u8>,
}

/// A path in fields.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WordsPath {
    /// Class, instance, attribute and members, each as narrow as it can be.
    Object(WordsObject),
    /// Anything else: the bytes of its segments.
    Other(Vec<u8>),
}

/// The numbers of an object's path.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct WordsObject {
    /// The class.
    pub class: u32,
    /// The instance.
    pub instance: Option<u32>,
    /// The attribute; only with an instance.
    pub attribute: Option<u32>,
    /// Members, in their order.
    pub members: Vec<u32>,
}

/// Why words are not fields, or fields are not words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldsError {
    /// There is no CIP request in the words.
    Split(SplitError),
    /// The path is longer than what is sent.
    PathCut {
        /// What its size says, in words.
        words: u8,
        /// Bytes that are there.
        left: usize,
    },
    /// A path of an odd number of bytes.
    OddPath,
    /// A path of more than 255 words.
    LongPath,
    /// More bytes than a word can count.
    TooLong,
}

impl WordsFields {
    /// The first `length` bytes of a table of words. Any words with a request in them are understood: what is no object's
    /// path, or one with wider numbers than it needs, is [`WordsPath::Other`].
    pub fn read(form: SendReqForm, words: &[u16], length: usize) -> Result<Self, FieldsError> {
        let split = Split::new(form, words, length).map_err(FieldsError::Split)?;
        let [service, size, rest @ ..] = split.message.as_slice() else {
            return Err(FieldsError::Split(SplitError::TooShort { length, at: split.at }));
        };
        let (path, data) = rest
            .split_at_checked(2 * usize::from(*size))
            .ok_or(FieldsError::PathCut { words: *size, left: rest.len() })?;
        // What fills the last word is nobody's.
        let is_filling = split.behind == [0] && length % 2 == 1;
        Ok(Self {
            message_type: split.message_type.unwrap_or_default(),
            ip: split.ip.unwrap_or_default(),
            service: *service,
            path: WordsPath::of(path),
            data: data.to_vec(),
            behind: if is_filling { Vec::new() } else { split.behind },
        })
    }

    /// [`Self::read`] of all bytes.
    pub fn of_words(form: SendReqForm, words: &[u16]) -> Result<Self, FieldsError> {
        Self::read(form, words, 2 * words.len())
    }

    /// The words, and how many bytes of them are sent.
    pub fn write(&self, form: SendReqForm) -> Result<(Vec<u16>, u16), FieldsError> {
        let path = self.path.bytes();
        if path.len() % 2 == 1 {
            return Err(FieldsError::OddPath);
        }
        let size = u8::try_from(path.len() / 2).map_err(|_| FieldsError::LongPath)?;
        let mut bytes = bytes_of(&head(form, self.message_type, self.ip));
        bytes.extend_from_slice(&[self.service, size]);
        bytes.extend_from_slice(&path);
        bytes.extend_from_slice(&self.data);
        let length = u16::try_from(bytes.len()).map_err(|_| FieldsError::TooLong)?;
        bytes.extend_from_slice(&self.behind);
        Ok((words_of(&bytes), length))
    }
}

impl WordsPath {
    /// From the bytes of a path.
    pub fn of(bytes: &[u8]) -> Self {
        let path = Epath::decode(bytes).ok();
        let object = path.and_then(|path| WordsObject::of(&path)).map(Self::Object);
        // A path that is put together in another way has to stay as it is.
        object.filter(|object| object.bytes() == bytes).unwrap_or_else(|| Self::Other(bytes.to_vec()))
    }

    /// The path's bytes.
    pub fn bytes(&self) -> Vec<u8> {
        match self {
            Self::Object(object) => object.path().bytes(),
            Self::Other(bytes) => bytes.clone(),
        }
    }
}

impl WordsObject {
    fn of(path: &Epath) -> Option<Self> {
        let mut segments = path.segments().iter();
        let mut rest = segments.clone();
        let mut next = |wanted| {
            let Segment::Logical(LogicalSegment { kind, value }) = *rest.next()? else { return None };
            (kind == wanted).then(|| {
                segments.next();
                value
            })
        };
        let mut numbers = [None; 3];
        for (number, kind) in numbers.iter_mut().zip(OBJECT) {
            *number = next(kind);
            if number.is_none() {
                break;
            }
        }
        let [class, instance, attribute] = numbers;
        let member = |segment: &Segment| match segment {
            Segment::Logical(LogicalSegment { kind: LogicalKind::Member, value }) => Some(*value),
            _ => None,
        };
        let members = segments.map(member).collect::<Option<_>>()?;
        Some(Self { class: class?, instance, attribute, members })
    }

    fn path(&self) -> Epath {
        let numbers = [Some(self.class), self.instance, self.attribute];
        let path =
            numbers.into_iter().zip(OBJECT).fold(Epath::default(), |path, (number, kind)| match number {
                Some(number) => path.then(kind, number),
                None => path,
            });
        self.members.iter().fold(path, |path, member| path.then(LogicalKind::Member, *member))
    }
}

impl fmt::Display for FieldsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Split(error) => write!(f, "{error}"),
            Self::PathCut { words, left } => {
                let bytes = 2 * u16::from(*words);
                write!(
                    f,
                    "the path size of {words} words needs {bytes} bytes behind it; {left} are sent (it counts words, not bytes)"
                )
            }
            Self::OddPath => f.write_str("the path has an odd number of bytes; its size counts words"),
            Self::LongPath => f.write_str("the path has more than 255 words"),
            Self::TooLong => f.write_str("more than 65535 bytes"),
        }
    }
}

impl core::error::Error for FieldsError {}

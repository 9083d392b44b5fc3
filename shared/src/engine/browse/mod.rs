//! Asks a controller which tags it has, and what its structures are made of.
//!
//! Sans-IO: send [`Browse::next_request`], give what came of it to [`Browse::handle_reply`], until [`Browse::is_done`].
//! [`Browse::found`] only grows, so it can be shown page by page while the list goes on; whoever has seen enough stops
//! asking. Structures are not looked into: [`Browse::template`] does that for one, when somebody wants it.
//!
//! | family | tags | structures |
//! | --- | --- | --- |
//! | Logix | class 6B, service 55: the controller's, then each program's | class 6C: members with their places |
//! | Micro800 | the same service: globals alone | not told |
//! | Omron | class 6A, service 5F: names; class 6B: the type of each | class 6C: members, one by one |

mod logix_types;
mod omron_types;
mod symbol;
mod symbols;
mod variables;

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use self::logix_types::LogixTypes;
use self::omron_types::OmronTypes;
use self::symbols::Symbols;
use self::variables::Variables;
use super::poll::Failure;
use crate::tag::{Dialect, Type, refusal};
use crate::wire::{GeneralStatus, MessageRouterReply, MessageRouterRequest, ServiceCode};

pub use self::symbol::{Access, Symbol};

/// Which tags.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BrowseWhat {
    /// What people have declared, and the tags of modules.
    #[default]
    Tags,
    /// What the system has declared, too.
    WithSystem,
}

/// A list that is being made.
#[derive(Debug)]
pub struct Browse {
    work: Work,
    found: Vec<Symbol>,
    kind: Option<Type>,
    /// The service that is asked for, until its reply is there.
    asked: Option<ServiceCode>,
    requests: u32,
    is_done: bool,
    error: Option<String>,
}

#[derive(Debug)]
enum Work {
    Symbols(Symbols),
    Variables(Variables),
    LogixTypes(LogixTypes),
    OmronTypes(OmronTypes),
    /// The family does not tell.
    Nothing,
}

/// What one reply was worth.
enum Step {
    More,
    Done,
}

/// A reply: its status and its data.
struct Answer<'a> {
    status: GeneralStatus,
    word: Option<u16>,
    data: &'a [u8],
}

impl Browse {
    /// The tags of a device.
    pub fn new(dialect: Dialect, what: BrowseWhat) -> Self {
        Self::of(match dialect {
            Dialect::Logix | Dialect::Micro800 => Work::Symbols(Symbols::new(dialect, what)),
            Dialect::Omron => Work::Variables(Variables::new(what)),
        })
    }

    /// The structure with the number that [`Symbol::template`] gave. Its type is in [`Self::kind`] in the end.
    pub fn template(dialect: Dialect, id: u32) -> Self {
        let work = match dialect {
            Dialect::Logix => Work::LogixTypes(LogixTypes::new(id)),
            Dialect::Omron => Work::OmronTypes(OmronTypes::new(id)),
            Dialect::Micro800 => Work::Nothing,
        };
        let mut browse = Self::of(work);
        if matches!(browse.work, Work::Nothing) {
            browse.fail("a Micro800 does not tell what its structures are made of".to_string());
        }
        browse
    }

    /// What a list of the family leaves out, in words. Sources: pycomm3 issue 74 and libplctag issue 557 (arrays of a
    /// Micro800), pylogix issue 66 (its programs), aphyt (Omron's
    /// unpublished variables).
    pub const fn caveat(dialect: Dialect) -> Option<&'static str> {
        match dialect {
            Dialect::Logix => None,
            Dialect::Micro800 => Some(
                "A Micro800 lists its global variables only. Arrays of BOOL, and arrays that do not begin at 0, may be \
                 missing; they can be typed.",
            ),
            Dialect::Omron => Some("An Omron lists the variables that are published to the network."),
        }
    }

    const fn of(work: Work) -> Self {
        Self { work, found: Vec::new(), kind: None, asked: None, requests: 0, is_done: false, error: None }
    }

    /// The message router request to send now; nothing while one is outstanding, and in the end.
    pub fn next_request(&mut self) -> Option<Vec<u8>> {
        if self.is_done || self.asked.is_some() {
            return None;
        }
        let request: Option<MessageRouterRequest> = match &mut self.work {
            Work::Symbols(work) => work.request(),
            Work::Variables(work) => work.request(),
            Work::LogixTypes(work) => work.request(),
            Work::OmronTypes(work) => work.request(),
            Work::Nothing => None,
        };
        let Some(request) = request else {
            self.fail("there is nothing left to ask".to_string());
            return None;
        };
        self.asked = Some(request.service());
        self.requests = self.requests.saturating_add(1);
        Some(request.bytes())
    }

    /// What came of the request.
    pub fn handle_reply(&mut self, reply: Result<&[u8], Failure>) {
        let Some(asked) = self.asked.take() else { return };
        let step = match reply.map(MessageRouterReply::decode) {
            Ok(Ok(reply)) if reply.service == asked => self.take(&Answer {
                status: reply.status,
                word: reply.additional.words().next(),
                data: reply.data,
            }),
            Ok(Ok(reply)) => Err(refusal(reply.status, reply.additional.words().next())),
            Ok(Err(error)) => Err(error.to_string()),
            Err(Failure::Refused { status, words }) => {
                self.take(&Answer { status, word: words.first().copied(), data: &[] })
            }
            Err(Failure::Lost { reason } | Failure::NotTaken { reason }) => Err(reason),
        };
        match step {
            Ok(Step::More) => {}
            Ok(Step::Done) => self.is_done = true,
            Err(error) => self.fail(error),
        }
    }

    fn take(&mut self, answer: &Answer<'_>) -> Result<Step, String> {
        match &mut self.work {
            Work::Symbols(work) => work.take(answer, &mut self.found),
            Work::Variables(work) => work.take(answer, &mut self.found),
            Work::LogixTypes(work) => work.take(answer, &mut self.kind),
            Work::OmronTypes(work) => work.take(answer, &mut self.kind),
            Work::Nothing => Ok(Step::Done),
        }
    }

    /// The tags so far; what is there stays as it is.
    pub fn found(&self) -> &[Symbol] {
        &self.found
    }

    /// The type of the structure, when it is known.
    pub const fn kind(&self) -> Option<&Type> {
        self.kind.as_ref()
    }

    /// Requests so far. How many there will be, no family tells.
    pub const fn requests(&self) -> u32 {
        self.requests
    }

    /// What is being read: a program, or the controller's own tags.
    pub fn progress(&self) -> &str {
        match &self.work {
            Work::Symbols(work) => work.scope().unwrap_or_default(),
            _ => "",
        }
    }

    /// Whether nothing is left to ask, or it has failed.
    pub const fn is_done(&self) -> bool {
        self.is_done
    }

    /// Why the list is not complete.
    pub fn error(&self) -> Option<&str> {
        self.error.as_deref()
    }

    fn fail(&mut self, error: String) {
        self.is_done = true;
        self.error = Some(error);
    }
}

impl Answer<'_> {
    fn is_refused(&self) -> bool {
        !matches!(self.status, GeneralStatus::Success | GeneralStatus::PartialTransfer)
    }

    fn in_words(&self) -> String {
        refusal(self.status, self.word)
    }
}

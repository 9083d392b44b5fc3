//! What a conversion changes, and why.

use alloc::string::{String, ToString};
use core::fmt;

/// One member that is not carried as it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// As in the stored configuration: `TargetCfg.UcmmTimeout`.
    pub member: String,
    /// What it is in the block.
    pub from: String,
    /// What it becomes; empty: nothing.
    pub to: String,
    /// How bad that is.
    pub grade: Grade,
    /// Why, and what to do.
    pub why: Why,
}

/// How bad a change is. Everything but [`Grade::Carried`] is a loss.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Grade {
    /// Told in other words: nothing is lost.
    Carried,
    /// The nearest value that the other side knows.
    Adjusted,
    /// Not told at all.
    Lost,
    /// The bytes of the request, or the device they go to, are others.
    Request,
}

/// Why a member is not carried as it is. The text says what to do about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Why {
    /// The other side has no such thing.
    NoSuchMember,
    /// Its timeout counts in steps of so many ms.
    TimeoutStep(u32),
    /// Its timeout has other bounds, in ms.
    TimeoutBounds(u32, u32),
    /// It has one timeout for all.
    OneTimeout,
    /// It cannot go along this route.
    NoRoute,
    /// It knows addresses in digits only.
    NoHostName,
    /// It always uses TCP port 44818.
    NoTcpPort,
    /// It has no simulated device.
    NoBuiltIn,
    /// It has no member segments.
    NoMemberSegments,
    /// It writes path segments in other widths.
    SegmentWidths,
    /// It cannot leave a connection open, or cannot close it by itself.
    ConnectionStays,
    /// It cannot do it over a connection.
    UnconnectedOnly,
    /// It can do it over a connection only.
    ConnectedOnly,
    /// Its data is limited to so many bytes.
    DataLimit(usize),
    /// Whole words hold half a word, too.
    WholeWords,
    /// Where the communication module is belongs to the controller's project.
    ModulePlace,
    /// It cannot go through another station.
    NoBridge,
    /// Its path is made of other segments.
    OtherSegments,
    /// It goes to another device.
    OtherDevice,
    /// It is not in use for this message.
    Unused,
    /// A number there is at most so big.
    NumberLimit(i64),
    /// Its name is made of other characters.
    NameCharacters,
    /// The program around the block does it.
    ProgramDoes,
    /// It is a setting of cipdeck.
    OursAlone,
    /// The block has errors, so that what it would send is not known.
    NotSendable,
}

impl Change {
    /// A change of a member.
    pub fn new(
        member: &impl ToString,
        from: &impl ToString,
        to: &impl ToString,
        grade: Grade,
        why: Why,
    ) -> Self {
        let (member, from, to) = (member.to_string(), from.to_string(), to.to_string());
        Self { member, from, to, grade, why }
    }

    /// Whether another request would be sent, or to another device.
    fn is_other_request(&self) -> bool {
        self.grade == Grade::Request
    }

    /// Whether something is adjusted, lost, or sent otherwise.
    pub const fn is_loss(&self) -> bool {
        !matches!(self.grade, Grade::Carried)
    }
}

/// Whether a text must not run before somebody has looked at it: what was converted before, or what is written of it,
/// is another request, or goes to another device.
pub(super) fn is_held(before: &[Change], written: &[Change]) -> bool {
    before.iter().chain(written).any(Change::is_other_request)
}

/// `TargetCfg.UcmmTimeout 3050 -> 3100 (adjusted): its timeout …`
impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { member, from, to, grade, why } = self;
        write!(f, "{member} {from}")?;
        if !to.is_empty() {
            write!(f, " -> {to}")?;
        }
        write!(f, " ({}): {why}", grade.name())
    }
}

impl Grade {
    /// The word in lists and JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Carried => "carried",
            Self::Adjusted => "adjusted",
            Self::Lost => "lost",
            Self::Request => "request",
        }
    }
}

impl Why {
    /// Stable, for machines.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::NoSuchMember => "no_such_member",
            Self::TimeoutStep(_) => "timeout_step",
            Self::TimeoutBounds(..) => "timeout_bounds",
            Self::OneTimeout => "one_timeout",
            Self::NoRoute => "no_route",
            Self::NoHostName => "no_host_name",
            Self::NoTcpPort => "no_tcp_port",
            Self::NoBuiltIn => "no_built_in",
            Self::NoMemberSegments => "no_member_segments",
            Self::SegmentWidths => "segment_widths",
            Self::ConnectionStays => "connection_stays",
            Self::UnconnectedOnly => "unconnected_only",
            Self::ConnectedOnly => "connected_only",
            Self::DataLimit(_) => "data_limit",
            Self::WholeWords => "whole_words",
            Self::ModulePlace => "module_place",
            Self::NoBridge => "no_bridge",
            Self::OtherSegments => "other_segments",
            Self::OtherDevice => "other_device",
            Self::Unused => "unused",
            Self::NumberLimit(_) => "number_limit",
            Self::NameCharacters => "name_characters",
            Self::ProgramDoes => "program_does",
            Self::OursAlone => "ours_alone",
            Self::NotSendable => "not_sendable",
        }
    }
}

impl fmt::Display for Why {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NoSuchMember => "there is no such setting there; set it by other means if it matters",
            Self::TimeoutStep(step) => return write!(f, "timeouts are counted in steps of {step} ms there; it is rounded up"),
            Self::TimeoutBounds(low, high) => {
                return write!(f, "timeouts are {low} to {high} ms there; it is moved into that range");
            }
            Self::OneTimeout => "there is one timeout for everything there; the one in use is taken",
            Self::NoRoute => "this route cannot be told there; set up the target in the project, or send from another device",
            Self::NoHostName => "only an IP address can be told there; write the address of the device",
            Self::NoTcpPort => "it always goes to TCP port 44818 there",
            Self::NoBuiltIn => "0,0 is the simulated device of cipdeck, or the controller itself; write the address of the device",
            Self::NoMemberSegments => "a path there has class, instance and attribute only; the members are not sent",
            Self::SegmentWidths => "path segments are written in other widths there; most devices do not mind",
            Self::ConnectionStays => "when a connection is closed cannot be chosen there",
            Self::UnconnectedOnly => "there are no class 3 connections there; it is sent unconnected",
            Self::ConnectedOnly => "it is sent over a connection there",
            Self::DataLimit(limit) => return write!(f, "data has at most {limit} bytes there"),
            Self::WholeWords => "sizes are whole words there; the larger one is taken",
            Self::ModulePlace => {
                "rack, module and channel say where the communication module is; check them against the configuration of \
                 the controller"
            }
            Self::NoBridge => "there is no way through another station there; the message goes straight to the device",
            Self::OtherSegments => "a path there is class, instance, attribute and members in this order",
            Self::OtherDevice => "it goes to another device: correct the address",
            Self::Unused => "it is not in use for this message",
            Self::NumberLimit(limit) => {
                return write!(f, "numbers are at most {limit} there; it may be refused, or cut off");
            }
            Self::NameCharacters => "names are made of other characters there",
            Self::ProgramDoes => "the program around the block has to do it",
            Self::OursAlone => "it is a setting of cipdeck; a controller has nothing like it",
            Self::NotSendable => "the block has errors: correct them first",
        })
    }
}

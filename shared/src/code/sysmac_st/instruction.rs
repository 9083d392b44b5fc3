//! The instructions: which one a call is of, and where their arguments stand.

use alloc::string::String;

use crate::code::text::{Call, Expression, Literal, Reading};

/// What is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Instruction {
    /// `CIPUCMMSend`
    Unconnected,
    /// `CIPOpen`, `CIPOpenWithDataSize`
    Open,
    /// `CIPSend`
    Send,
    /// `CIPClose`
    Close,
}

const NAMES: [(&str, Instruction); 5] = [
    ("cipucmmsend", Instruction::Unconnected),
    ("cipsend", Instruction::Send),
    ("cipopenwithdatasize", Instruction::Open),
    ("cipopen", Instruction::Open),
    ("cipclose", Instruction::Close),
];

/// What every one of them gives back.
const OUTPUTS: [&str; 7] = ["Done", "Busy", "Error", "ErrorID", "ErrorIDEx", "RespSize", "ENO"];

impl Instruction {
    /// By the type of an instance.
    pub(super) fn of_type(name: &str) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        NAMES.iter().find(|(it, _)| *it == name).map(|(_, instruction)| *instruction)
    }

    /// By the name of an instance that nobody declares: `CIPUCMMSend_instance`, `CIPSend1`.
    pub(super) fn of_name(name: &str) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        let numbered =
            |rest: &str| rest.is_empty() || rest.starts_with(|c: char| c == '_' || c.is_ascii_digit());
        let is_it = |(it, _): &&(&str, Self)| name.strip_prefix(it).is_some_and(numbered);
        NAMES.iter().find(is_it).map(|(_, instruction)| *instruction)
    }

    /// By the inputs of a call whose instance says nothing.
    pub(super) fn of_inputs(call: &Call<'_>) -> Option<Self> {
        let has = |name: &str| {
            call.arguments.iter().any(|it| it.name.is_some_and(|it| it.eq_ignore_ascii_case(name)))
        };
        match (has("RqPath"), has("RoutePath"), has("Handle")) {
            (true, _, true) => Some(Self::Send),
            (true, _, false) => Some(Self::Unconnected),
            (false, true, _) => Some(Self::Open),
            (false, false, _) => None,
        }
    }

    /// In their order. That of CIPSend is W502 p. 750; of the others from memory.
    pub(super) const fn inputs(self) -> &'static [&'static str] {
        match self {
            Self::Unconnected => &[
                "Execute",
                "RoutePath",
                "TimeOut",
                "ServiceCode",
                "RqPath",
                "ServiceDat",
                "Size",
                "RespServiceDat",
            ],
            Self::Open => &["Execute", "RoutePath", "TimeOut", "DataSize"],
            Self::Send => {
                &["Execute", "Handle", "ServiceCode", "RqPath", "ServiceDat", "Size", "RespServiceDat"]
            }
            Self::Close => &["Execute", "Handle"],
        }
    }

    /// Whether it has such an input or output.
    pub(super) fn has(self, name: &str) -> bool {
        let others: &[&str] = if self == Self::Open { &["EN", "Handle"] } else { &["EN"] };
        let mut names = self.inputs().iter().chain(&OUTPUTS).chain(others);
        names.any(|it| it.eq_ignore_ascii_case(name))
    }
}

/// A call of one of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Site<'s, 'a> {
    /// Which item of the script.
    pub(super) item: usize,
    pub(super) call: &'s Call<'a>,
    pub(super) instruction: Instruction,
}

impl<'s, 'a> Site<'s, 'a> {
    /// Where an input stands in a call without names.
    pub(super) fn position(&self, name: &str) -> usize {
        let at = self.instruction.inputs().iter().position(|it| it.eq_ignore_ascii_case(name));
        at.unwrap_or(usize::MAX)
    }

    /// Whether the call gives it.
    pub(super) fn gives(&self, name: &str) -> bool {
        self.call.argument(self.position(name), name).is_some()
    }

    pub(super) fn value(&self, name: &str) -> Option<&'s Expression<'a>> {
        self.call.argument(self.position(name), name)?.value.as_ref()
    }

    /// The variable of an input, or the member of the instance.
    pub(super) fn key(&self, name: &str) -> Option<String> {
        Reading::key(self.call, self.position(name), name)
    }

    /// `Execute := FALSE`: how programs make the next start a rising edge.
    pub(super) fn only_resets(&self) -> bool {
        matches!(self.value("Execute"), Some(Expression::Literal(Literal::Bool(false), _)))
    }
}

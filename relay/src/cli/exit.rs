//! Exit codes: 0 success; 1 internal, cannot listen, or cannot write a capture; 2 usage or error findings; 3 `ErrorID`
//! 224; 4 everything else (timeout, refused, malformed, nobody answered).

use std::process::ExitCode;

use cipdeck_shared::engine::CipStatus;

/// How the process ends.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Exit {
    code: u8,
    message: Option<String>,
}

impl Exit {
    /// Everything worked.
    pub(crate) const SUCCESS: Self = Self { code: 0, message: None };

    /// Internal, or cannot listen.
    pub(crate) fn internal(message: &impl ToString) -> Self {
        Self { code: 1, message: Some(message.to_string()) }
    }

    /// What was typed, or a file that was named, cannot be used.
    pub(crate) fn usage(message: &impl ToString) -> Self {
        Self { code: 2, message: Some(message.to_string()) }
    }

    /// A message that did not end well, and did not even end by itself.
    pub(crate) fn interrupted(message: &impl ToString) -> Self {
        Self { code: 4, message: Some(message.to_string()) }
    }

    /// Nobody has said anything.
    pub(crate) fn unanswered(message: &impl ToString) -> Self {
        Self { code: 4, message: Some(message.to_string()) }
    }

    /// How a message ended. What is to be said has been said.
    pub(crate) const fn message(status: &CipStatus) -> Self {
        let code = match status {
            CipStatus { error: false, .. } => 0,
            CipStatus { error_id: 224, .. } => 3,
            _ => 4,
        };
        Self { code, message: None }
    }

    /// What was asked for beside the message failed. What is to be said has been said.
    pub(crate) const INCOMPLETE: Self = Self { code: 1, message: None };

    /// The device refused a tag. What is to be said has been said.
    pub(crate) const REFUSED: Self = Self { code: 3, message: None };

    /// A tag got no answer. What is to be said has been said.
    pub(crate) const LOST: Self = Self { code: 4, message: None };

    /// Error findings. What is to be said has been said.
    pub(crate) const FINDINGS: Self = Self { code: 2, message: None };

    /// The number.
    #[cfg(test)]
    pub(crate) const fn code(&self) -> u8 {
        self.code
    }

    /// Says on stderr what is left to say.
    pub(crate) fn report(self) -> ExitCode {
        if let Some(message) = self.message {
            eprintln!("cipdeck: {message}");
        }
        ExitCode::from(self.code)
    }
}

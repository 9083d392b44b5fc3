//! Exit codes: 0 success; 1 internal, or cannot listen; 2 usage or error findings; 3 `ErrorID` 224; 4 everything else
//! (timeout, refused, malformed).

use std::process::ExitCode;

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

    /// Says on stderr what is left to say.
    pub(crate) fn report(self) -> ExitCode {
        if let Some(message) = self.message {
            eprintln!("cipdeck: {message}");
        }
        ExitCode::from(self.code)
    }
}

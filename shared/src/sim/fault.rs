//! What a device can do wrong on purpose.

use core::fmt;
use core::str::FromStr;

use crate::wire::{EncapsulationStatus, GeneralStatus};

/// What happens to the reply of one `SendRRData` or `SendUnitData` request. The device has carried the request out, except for
/// [`Fault::ErrorStatus`] and [`Fault::EncapsulationStatus`], which refuse it.
///
/// As text: the names below, as in `--fault drop --fault status=0x64`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// `ok`: nothing is wrong with this reply. For alternating with something else.
    Ok,
    /// `drop`: no reply.
    Drop,
    /// `half-frame`: half of the reply, then silence on this connection.
    HalfFrame,
    /// `wrong-context`: somebody else's sender context.
    WrongContext,
    /// `wrong-session`: somebody else's session handle.
    WrongSession,
    /// `wrong-service`: the reply of another service.
    WrongService,
    /// `garbage`: bytes that are no frame.
    Garbage,
    /// `status=N`: an encapsulation status, such as `status=0x64`.
    EncapsulationStatus(EncapsulationStatus),
    /// `close`: the connection is closed instead of a reply.
    Close,
    /// `error=N`: a general status, such as `error=0x10`.
    ErrorStatus(GeneralStatus),
    /// `wrong-connection-id`: somebody else's connection id; only in connected replies.
    WrongConnectionId,
    /// `wrong-sequence`: another sequence count; only in connected replies.
    WrongSequence,
}

impl Fault {
    /// The status with which the request is refused.
    pub(super) const fn refusal(self) -> Option<GeneralStatus> {
        match self {
            Self::ErrorStatus(status) => Some(status),
            _ => None,
        }
    }
}

/// The text is none of the fault names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "a fault is one of ok, drop, half-frame, wrong-context, wrong-session, wrong-service, wrong-connection-id, \
     wrong-sequence, garbage, close, status=N (encapsulation status, 32 bit) or error=N (general status, 8 bit); N as 100 or 0x64"
)]
pub struct UnknownFault;

impl FromStr for Fault {
    type Err = UnknownFault;

    fn from_str(text: &str) -> Result<Self, UnknownFault> {
        Ok(match text {
            "ok" => Self::Ok,
            "drop" => Self::Drop,
            "half-frame" => Self::HalfFrame,
            "wrong-context" => Self::WrongContext,
            "wrong-session" => Self::WrongSession,
            "wrong-service" => Self::WrongService,
            "wrong-connection-id" => Self::WrongConnectionId,
            "wrong-sequence" => Self::WrongSequence,
            "garbage" => Self::Garbage,
            "close" => Self::Close,
            _ => {
                let (name, number) = text.split_once('=').ok_or(UnknownFault)?;
                let number = parse_number(number).ok_or(UnknownFault)?;
                match name {
                    "status" => Self::EncapsulationStatus(EncapsulationStatus(number)),
                    "error" => {
                        Self::ErrorStatus(GeneralStatus(u8::try_from(number).map_err(|_| UnknownFault)?))
                    }
                    _ => return Err(UnknownFault),
                }
            }
        })
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ok => "ok",
            Self::Drop => "drop",
            Self::HalfFrame => "half-frame",
            Self::WrongContext => "wrong-context",
            Self::WrongSession => "wrong-session",
            Self::WrongService => "wrong-service",
            Self::WrongConnectionId => "wrong-connection-id",
            Self::WrongSequence => "wrong-sequence",
            Self::Garbage => "garbage",
            Self::Close => "close",
            Self::EncapsulationStatus(status) => return write!(f, "status={status}"),
            Self::ErrorStatus(status) => return write!(f, "error={status}"),
        })
    }
}

fn parse_number(text: &str) -> Option<u32> {
    match text.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::string::ToString;

    #[test]
    fn every_fault_reads_back_from_its_name() {
        let faults = [
            Fault::Ok,
            Fault::Drop,
            Fault::HalfFrame,
            Fault::WrongContext,
            Fault::WrongSession,
            Fault::WrongService,
            Fault::WrongConnectionId,
            Fault::WrongSequence,
            Fault::Garbage,
            Fault::Close,
            Fault::EncapsulationStatus(EncapsulationStatus(0x65)),
            Fault::ErrorStatus(GeneralStatus(0x10)),
        ];
        for fault in faults {
            assert_eq!(fault.to_string().parse(), Ok(fault));
        }
        assert_eq!("status=100".parse(), Ok(Fault::EncapsulationStatus(EncapsulationStatus(100))));
    }

    #[test]
    fn a_wrong_name_is_told_the_right_ones() {
        for text in ["", "dorp", "status", "status=", "status=x", "error=256", "other=1"] {
            let error = text.parse::<Fault>().unwrap_err();
            assert!(error.to_string().contains("half-frame"), "{text}");
        }
    }
}

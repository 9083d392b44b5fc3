//! The 24-byte encapsulation header and the frames that need nothing else.
//!
//! `UINT command | UINT length of what follows | UDINT session | UDINT status | 8 bytes sender context | UDINT
//! options`. Source: OpENer `encap.h`; the session frames of the Omron NX article re-encode byte for byte.

use alloc::vec::Vec;

use super::cursor::{DecodeError, DecodeErrorKind, Reader, TooLong};

/// Bytes of the header.
pub const HEADER_SIZE: usize = 24;

/// Longest data part: 65,535 less the header. Recalled from CIP volume 2.
pub const MAX_DATA: usize = 65_511;

/// The only protocol version of `RegisterSession`.
pub const PROTOCOL_VERSION: u16 = 1;

open_enum! {
    /// Encapsulation command. Source: Wireshark packet-enip.c, OpENer encap.h.
    pub struct Command(u16, width 6) {
        /// Does nothing; no reply.
        Nop = 0x0000,
        /// Which services the target has.
        ListServices = 0x0004,
        /// Who the target is; TCP or UDP.
        ListIdentity = 0x0063,
        /// Which communication interfaces the target has.
        ListInterfaces = 0x0064,
        /// Opens a session; one per TCP connection.
        RegisterSession = 0x0065,
        /// Closes the session; no reply, the target closes the TCP connection.
        UnRegisterSession = 0x0066,
        /// An unconnected request or its reply.
        SendRRData = 0x006F,
        /// A connected request or reply.
        SendUnitData = 0x0070,
        /// Legacy, optional.
        IndicateStatus = 0x0072,
        /// Legacy, optional.
        Cancel = 0x0073,
        /// CIP Security.
        StartDTLS = 0x00C8,
    }
}

open_enum! {
    /// Status of an encapsulation reply: 0 is success. Explanations are in `table`.
    pub struct EncapsulationStatus(u32, width 6) {
        /// The command was accepted.
        Success = 0x0000,
        /// Unknown command, or a second RegisterSession.
        InvalidCommand = 0x0001,
        /// No free session or memory at the target.
        InsufficientMemory = 0x0002,
        /// The data part is badly formed.
        IncorrectData = 0x0003,
        /// The session is unknown to the target.
        InvalidSessionHandle = 0x0064,
        /// The length field and the message do not match.
        InvalidLength = 0x0065,
        /// RegisterSession with a version other than 1.
        UnsupportedProtocolVersion = 0x0069,
    }
}

/// What the target gave in reply to `RegisterSession`; 0 before that.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SessionHandle(pub u32);

/// Eight bytes that the target echoes: they tie a reply to its request.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SenderContext(pub [u8; 8]);

impl From<u64> for SenderContext {
    fn from(counter: u64) -> Self {
        Self(counter.to_le_bytes())
    }
}

/// The header without the length, which follows from the data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header {
    /// What is asked or answered.
    pub command: Command,
    /// The session; 0 before RegisterSession and for the List commands.
    pub session: SessionHandle,
    /// 0 in requests.
    pub status: EncapsulationStatus,
    /// Echoed by the target.
    pub context: SenderContext,
    /// 0.
    pub options: u32,
}

impl Header {
    /// A request's header.
    pub const fn request(command: Command, session: SessionHandle, context: SenderContext) -> Self {
        Self { command, session, status: EncapsulationStatus::Success, context, options: 0 }
    }

    /// The header of the reply to this request: everything is echoed, the status is new.
    #[must_use]
    pub const fn reply(self, status: EncapsulationStatus) -> Self {
        Self { status, options: 0, ..self }
    }

    /// Reads a header and the length of the data that follows it.
    pub fn decode(reader: &mut Reader<'_>) -> Result<(Self, usize), DecodeError> {
        let command = Command(reader.u16()?);
        let length_field = reader.error(DecodeErrorKind::TooLong { length: 0, max: MAX_DATA });
        let length = usize::from(reader.u16()?);
        if length > MAX_DATA {
            let kind = DecodeErrorKind::TooLong { length, max: MAX_DATA };
            return Err(DecodeError { kind, ..length_field });
        }
        let header = Self {
            command,
            session: SessionHandle(reader.u32()?),
            status: EncapsulationStatus(reader.u32()?),
            context: SenderContext(reader.array()?),
            options: reader.u32()?,
        };
        Ok((header, length))
    }

    fn encode(&self, length: u16, out: &mut Vec<u8>) {
        out.extend_from_slice(&self.command.0.to_le_bytes());
        out.extend_from_slice(&length.to_le_bytes());
        out.extend_from_slice(&self.session.0.to_le_bytes());
        out.extend_from_slice(&self.status.0.to_le_bytes());
        out.extend_from_slice(&self.context.0);
        out.extend_from_slice(&self.options.to_le_bytes());
    }
}

/// One whole frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Encapsulation<'a> {
    /// The header.
    pub header: Header,
    length: u16,
    data: &'a [u8],
}

impl<'a> Encapsulation<'a> {
    /// A frame; refuses data over [`MAX_DATA`].
    pub fn new(header: Header, data: &'a [u8]) -> Result<Self, TooLong> {
        match u16::try_from(data.len()) {
            Ok(length) if data.len() <= MAX_DATA => Ok(Self { header, length, data }),
            _ => Err(TooLong { what: "encapsulation data", length: data.len(), max: MAX_DATA }),
        }
    }

    /// A frame without data.
    pub const fn empty(header: Header) -> Self {
        Self { header, length: 0, data: &[] }
    }

    /// What follows the header.
    pub const fn data(&self) -> &'a [u8] {
        self.data
    }

    /// Decodes exactly one frame.
    pub fn decode(bytes: &'a [u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::new(bytes);
        let frame = Self::read(&mut reader)?;
        reader.finish()?;
        Ok(frame)
    }

    /// Reads one frame and leaves what follows.
    pub fn read(reader: &mut Reader<'a>) -> Result<Self, DecodeError> {
        let (header, length) = Header::decode(reader)?;
        let data = reader.take(length)?;
        // `Header::decode` has already refused what would not fit.
        let length = u16::try_from(length).unwrap_or(u16::MAX);
        Ok(Self { header, length, data })
    }

    /// Appends the frame.
    pub fn encode(&self, out: &mut Vec<u8>) {
        out.reserve(HEADER_SIZE + self.data.len());
        self.header.encode(self.length, out);
        out.extend_from_slice(self.data);
    }
}

/// Data of `RegisterSession`, request and reply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RegisterSession {
    /// [`PROTOCOL_VERSION`].
    pub version: u16,
    /// 0: no options exist.
    pub options: u16,
}

impl RegisterSession {
    /// What every client sends.
    pub const CURRENT: Self = Self { version: PROTOCOL_VERSION, options: 0 };

    /// Decodes the data part.
    pub fn decode(data: &[u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::starting_at(data, HEADER_SIZE);
        let decoded = Self { version: reader.u16()?, options: reader.u16()? };
        reader.finish()?;
        Ok(decoded)
    }

    /// The data part.
    pub const fn bytes(self) -> [u8; 4] {
        let [v0, v1] = self.version.to_le_bytes();
        let [o0, o1] = self.options.to_le_bytes();
        [v0, v1, o0, o1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hex_literal::hex;

    #[test]
    fn register_session_is_the_articles_frame() {
        // Omron NX over EtherNet/IP, cnblogs xiketang 13664904: RegisterSession request
        let golden =
            hex!("65 00 04 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 01 00 00 00");
        let data = RegisterSession::CURRENT.bytes();
        let header =
            Header::request(Command::RegisterSession, SessionHandle::default(), SenderContext::default());
        let mut out = Vec::new();
        Encapsulation::new(header, &data).unwrap().encode(&mut out);
        assert_eq!(out, golden);
        assert_eq!(Encapsulation::decode(&golden).unwrap().header, header);
    }

    #[test]
    fn a_length_over_the_maximum_is_refused_at_the_length_field() {
        let mut bytes = [0_u8; 24];
        bytes[0] = 0x6F;
        bytes[2..4].copy_from_slice(&[0xFF, 0xFF]);
        let error = Encapsulation::decode(&bytes).unwrap_err();
        assert_eq!((error.at, error.kind), (2, DecodeErrorKind::TooLong { length: 65_535, max: MAX_DATA }));
    }

    #[test]
    fn every_prefix_is_an_error_and_never_a_panic() {
        let whole = hex!("6F 00 02 00 01 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 AA BB");
        for end in 0..whole.len() {
            assert!(Encapsulation::decode(&whole[..end]).is_err(), "prefix of {end} bytes");
        }
    }
}

//! Encapsulation frames written by hand, so that the product's own codec is not tested against itself. The layout
//! is that of OpENer's encap.h and cpf.h.

use tokio::io::{AsyncRead, AsyncReadExt as _};

/// RegisterSession.
pub const REGISTER_SESSION: u16 = 0x65;
/// UnRegisterSession.
pub const UNREGISTER_SESSION: u16 = 0x66;
/// SendRRData.
pub const SEND_RR_DATA: u16 = 0x6F;
/// SendUnitData.
pub const SEND_UNIT_DATA: u16 = 0x70;
/// Bytes of the encapsulation header.
pub const HEADER: usize = 24;

/// A whole frame.
pub fn encapsulate(command: u16, session: u32, status: u32, context: [u8; 8], data: &[u8]) -> Vec<u8> {
    let length = u16::try_from(data.len()).expect("a frame of at most 65535 bytes");
    let mut frame = Vec::with_capacity(HEADER + data.len());
    frame.extend(command.to_le_bytes());
    frame.extend(length.to_le_bytes());
    frame.extend(session.to_le_bytes());
    frame.extend(status.to_le_bytes());
    frame.extend(context);
    frame.extend([0; 4]); // options
    frame.extend(data);
    frame
}

/// The data of a SendRRData frame: interface handle, timeout, a null address item and an unconnected data item.
pub fn unconnected(message: &[u8]) -> Vec<u8> {
    let length = u16::try_from(message.len()).expect("a message of at most 65535 bytes");
    let mut data = vec![0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0xB2, 0];
    data.extend(length.to_le_bytes());
    data.extend(message);
    data
}

/// A frame as it came in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame(pub Vec<u8>);

impl Frame {
    /// Reads one frame.
    pub async fn read(stream: &mut (impl AsyncRead + Unpin)) -> std::io::Result<Self> {
        let mut frame = vec![0; HEADER];
        stream.read_exact(&mut frame).await?;
        let length = usize::from(u16::from_le_bytes([frame[2], frame[3]]));
        frame.resize(HEADER + length, 0);
        stream.read_exact(&mut frame[HEADER..]).await?;
        Ok(Self(frame))
    }

    /// The encapsulation command.
    pub fn command(&self) -> u16 {
        u16::from_le_bytes(self.array(0))
    }

    /// The session handle.
    pub fn session(&self) -> u32 {
        u32::from_le_bytes(self.array(4))
    }

    /// The encapsulation status.
    pub fn status(&self) -> u32 {
        u32::from_le_bytes(self.array(8))
    }

    /// The sender context.
    pub fn context(&self) -> [u8; 8] {
        self.array(12)
    }

    /// The message router bytes of a SendRRData frame.
    pub fn message(&self) -> &[u8] {
        &self.0[HEADER + unconnected(&[]).len()..]
    }

    fn array<const N: usize>(&self, at: usize) -> [u8; N] {
        self.0[at..at + N].try_into().expect("a frame has a header")
    }
}

//! The pcapng file.

use std::borrow::Cow;
use std::fmt;
use std::io::{self, Write};
use std::time::{SystemTime, UNIX_EPOCH};

use pcap_file::pcapng::PcapNgWriter;
use pcap_file::pcapng::blocks::enhanced_packet::EnhancedPacketBlock;
use pcap_file::pcapng::blocks::interface_description::{
    InterfaceDescriptionBlock, InterfaceDescriptionOption,
};
use pcap_file::{DataLink, PcapError};

/// What the file says about itself.
const COMMENT: &str = "Written by cipdeck. The payloads and the times are those of the sockets; the Ethernet, IP and \
                       TCP headers are synthesised by cipdeck. 192.0.2.1 and 192.0.2.2 stand for cipdeck and the \
                       simulated device inside of it, between which there is no network.";

/// Times are in units of 10 to the power of minus this: nanoseconds, which is what `pcap_file` writes.
const TIME_RESOLUTION: u8 = 9;

/// One packet of a capture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Packet {
    /// When its payload was written or read.
    pub at: SystemTime,
    /// From the Ethernet header on.
    pub bytes: Vec<u8>,
}

/// A capture that is complete after every packet.
pub struct CaptureFile<W: Write>(PcapNgWriter<W>);

impl<W: Write> CaptureFile<W> {
    /// Writes what comes before the first packet.
    pub fn new(writer: W) -> io::Result<Self> {
        let mut file = Self(PcapNgWriter::new(writer).map_err(into_io)?);
        let interface = InterfaceDescriptionBlock {
            linktype: DataLink::ETHERNET,
            snaplen: 0,
            options: vec![
                InterfaceDescriptionOption::Comment(Cow::Borrowed(COMMENT)),
                InterfaceDescriptionOption::IfName(Cow::Borrowed("cipdeck")),
                InterfaceDescriptionOption::IfTsResol(TIME_RESOLUTION),
            ],
        };
        file.0.write_pcapng_block(interface).map_err(into_io)?;
        file.0.get_mut().flush()?;
        Ok(file)
    }

    /// Adds packets, and sees to it that they are in the file.
    pub fn write(&mut self, packets: &[Packet]) -> io::Result<()> {
        for Packet { at, bytes } in packets {
            let block = EnhancedPacketBlock {
                interface_id: 0,
                timestamp: at.duration_since(UNIX_EPOCH).unwrap_or_default(),
                original_len: u32::try_from(bytes.len()).unwrap_or(u32::MAX),
                data: Cow::Borrowed(bytes),
                options: Vec::new(),
            };
            self.0.write_pcapng_block(block).map_err(into_io)?;
        }
        self.0.get_mut().flush()
    }

    /// What was written to.
    pub fn into_inner(self) -> W {
        self.0.into_inner()
    }
}

impl<W: Write> fmt::Debug for CaptureFile<W> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("CaptureFile").finish_non_exhaustive()
    }
}

fn into_io(error: PcapError) -> io::Error {
    match error {
        PcapError::IoError(error) => error,
        error => io::Error::other(error),
    }
}

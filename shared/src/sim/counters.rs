//! What the device has done so far.

use core::fmt;

/// Counted since the device was switched on, over all TCP connections and all modules.
///
/// Printed as one line that scripts may read: `unconnected 3, connections opened 1, connected requests 1000, closed 1,
/// timed out 0, unregistered 0, repeated 0, dropped 0`; and, if there were any, `, tag reads 12, tag writes 1,
/// packets 3`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Unconnected requests other than those that open or close a connection.
    pub unconnected: u64,
    /// Connections that were opened.
    pub opened: u64,
    /// Connected requests that were carried out.
    pub connected: u64,
    /// Connections that a Forward_Close ended.
    pub closed: u64,
    /// Connections that were silent for too long.
    pub timed_out: u64,
    /// Connections that ended with their session, by UnRegisterSession.
    pub unregistered: u64,
    /// Connected requests with the sequence count of the one before: answered from memory.
    pub repeated: u64,
    /// Connected requests to a connection that is not there: no answer.
    pub dropped: u64,
    /// Requests that read tags, carried out or refused; those in a packet count each.
    pub tag_reads: u64,
    /// Requests that write tags.
    pub tag_writes: u64,
    /// Messages with several requests in them.
    pub packets: u64,
}

impl fmt::Display for Counters {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            unconnected, opened, connected, closed, timed_out, unregistered, repeated, dropped, ..
        } = *self;
        let Self { tag_reads, tag_writes, packets, .. } = *self;
        write!(
            f,
            "unconnected {unconnected}, connections opened {opened}, connected requests {connected}, "
        )?;
        write!(f, "closed {closed}, timed out {timed_out}, unregistered {unregistered}, ")?;
        write!(f, "repeated {repeated}, dropped {dropped}")?;
        if tag_reads + tag_writes + packets > 0 {
            write!(f, ", tag reads {tag_reads}, tag writes {tag_writes}, packets {packets}")?;
        }
        Ok(())
    }
}

/// The attributes of a module's Connection Manager: instance attributes 1 to 8, a UINT each that wraps.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ManagerCounts([u16; 8]);

/// Which attribute counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Count {
    OpenRequest = 1,
    OpenFormatReject = 2,
    OpenResourceReject = 3,
    OpenOtherReject = 4,
    CloseRequest = 5,
    CloseFormatReject = 6,
    CloseOtherReject = 7,
    Timeout = 8,
}

impl ManagerCounts {
    /// The attributes of Get_Attributes_All, in its order.
    pub(super) const ATTRIBUTES: core::ops::RangeInclusive<u16> = 1..=8;

    pub(super) fn add(&mut self, count: Count) {
        if let Some(value) = self.0.get_mut(count as usize - 1) {
            *value = value.wrapping_add(1);
        }
    }

    pub(super) fn read(&self, attribute: u16) -> Option<[u8; 2]> {
        let index = usize::from(attribute).checked_sub(1)?;
        self.0.get(index).map(|value| value.to_le_bytes())
    }
}

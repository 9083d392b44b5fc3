//! Service codes that this crate itself needs. From 0x32 up a number means different things per class:
//! look names up in `table` by (class, service).

open_enum! {
    /// A CIP service code without the reply bit: 1..=127.
    pub struct ServiceCode(u8, width 4) {
        /// All attributes of one instance, in the class's own order.
        GetAttributesAll = 0x01,
        /// Writes all settable attributes.
        SetAttributesAll = 0x02,
        /// Several attributes by number.
        GetAttributeList = 0x03,
        /// Several attributes by number, written.
        SetAttributeList = 0x04,
        /// Restarts the object or the device.
        Reset = 0x05,
        /// One attribute.
        GetAttributeSingle = 0x0E,
        /// Several requests in one, to the Message Router.
        MultipleServicePacket = 0x0A,
        /// One attribute, written.
        SetAttributeSingle = 0x10,
        /// Tags: reads elements.
        ReadTag = 0x4C,
        /// Tags: writes elements.
        WriteTag = 0x4D,
        /// Connection Manager: ends a connection.
        ForwardClose = 0x4E,
        /// Connection Manager: hands a message on along a route.
        UnconnectedSend = 0x52,
        /// Tags: writes a part of what does not fit into a packet.
        WriteTagFragmented = 0x53,
        /// Connection Manager: opens a connection of at most 511 bytes.
        ForwardOpen = 0x54,
        /// Tags: the next symbols of a Logix controller.
        GetInstanceAttributeList = 0x55,
        /// Connection Manager: opens a connection of at most 65,535 bytes.
        LargeForwardOpen = 0x5B,
    }
}

impl ServiceCode {
    /// Tags: writes single bits. The number that [`Self::ForwardClose`] has in the Connection Manager.
    pub const READ_MODIFY_WRITE_TAG: Self = Self::ForwardClose;

    /// Tags: reads a part of what does not fit into a packet. The number that [`Self::UnconnectedSend`] has in the
    /// Connection Manager.
    pub const READ_TAG_FRAGMENTED: Self = Self::UnconnectedSend;

    /// Bit 7 of the first byte of a reply.
    pub const REPLY: u8 = 0x80;
}

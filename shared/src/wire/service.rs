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
        /// One attribute, written.
        SetAttributeSingle = 0x10,
    }
}

impl ServiceCode {
    /// Bit 7 of the first byte of a reply.
    pub const REPLY: u8 = 0x80;
}

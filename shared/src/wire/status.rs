//! General status of a message router reply. Explanations are in `table`.

open_enum! {
    /// General status of a CIP reply: 0 is success, everything else a refusal by the device.
    /// Source: the general status table in `data/general_status.tsv`.
    pub struct GeneralStatus(u8, width 4) {
        /// The request was carried out.
        Success = 0x00,
        /// A connection-type service failed; the additional status says how.
        ConnectionFailure = 0x01,
        /// A path segment could not be parsed.
        PathSegmentError = 0x04,
        /// Class or instance is not in the device.
        PathDestinationUnknown = 0x05,
        /// Only a part of the data: ask for the next one.
        PartialTransfer = 0x06,
        /// The class or instance does not have the service.
        ServiceNotSupported = 0x08,
        /// Of several attributes at least one failed; each has its own status in the data.
        AttributeListError = 0x0A,
        /// The attribute is read only.
        AttributeNotSettable = 0x0E,
        /// The state of the device does not allow it.
        ObjectStateConflict = 0x0C,
        /// Who asks may not.
        PrivilegeViolation = 0x0F,
        /// The answer would be longer than the connection or the frame allows.
        ReplyDataTooLarge = 0x11,
        /// The request carried too few bytes.
        NotEnoughData = 0x13,
        /// The attribute number is unknown.
        AttributeNotSupported = 0x14,
        /// The request carried too many bytes.
        TooMuchData = 0x15,
        /// Of the requests in a packet at least one failed; each has its own status.
        EmbeddedServiceError = 0x1E,
        /// The vendor's own: the additional status says what.
        VendorSpecific = 0x1F,
        /// A parameter of the request has a value that it cannot have.
        InvalidParameter = 0x20,
        /// The path size is not that of the path.
        PathSizeInvalid = 0x26,
        /// Object specific: the additional status says what.
        ObjectSpecific = 0xFF,
    }
}

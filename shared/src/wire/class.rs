//! Class codes that this crate itself needs; `table` knows the others by name.

open_enum! {
    /// A CIP class (object type). 16 bit in the block's `AppCfg.Class`.
    pub struct ClassCode(u16, width 6) {
        /// Who the device is.
        Identity = 0x01,
        /// Dispatches requests to objects.
        MessageRouter = 0x02,
        /// I/O data as attribute 3.
        Assembly = 0x04,
        /// Opens connections, forwards Unconnected_Send.
        ConnectionManager = 0x06,
        /// Parameter object of the specification.
        Parameter = 0x0F,
        /// Registers and coils of Modbus devices.
        Modbus = 0x44,
        /// Tag names of Logix controllers.
        Symbol = 0x6B,
        /// Structures of Logix controllers, types of variables of Omron's.
        Template = 0x6C,
        /// Rockwell's drive parameters.
        DpiParameter = 0x93,
        /// IP configuration.
        TcpIpInterface = 0xF5,
        /// Speed, flags and MAC address.
        EthernetLink = 0xF6,
    }
}

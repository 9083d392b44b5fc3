//! A small EtherNet/IP device without a socket: for trying a message without hardware, and for tests.
//!
//! Three levels, each usable alone:
//! * [`Device`] answers message router requests: objects, attributes, refusals.
//! * [`SimConnection`] is one TCP connection to it: sessions, framing, delay and [faults](Fault).
//! * [`handle_datagram`] answers UDP.
//!
//! Bytes and time come in, bytes go out; nothing waits. One `Device` serves any number of connections. Values move
//! as functions of the time that is passed in, so a test sees what it asks for.
//!
//! | object | attributes |
//! | --- | --- |
//! | Identity 1/1 | 1 to 7, Get_Attributes_All |
//! | Message Router 2/1, Connection Manager 6/1 | none: every service is refused with 0x08 |
//! | Assembly 4/100 | 3: 32 bytes of input, move by themselves |
//! | Assembly 4/150 | 3: 32 bytes of output, writable, remembered |
//! | DPI Parameter 147/n | 9: the value; n = 1, 7, 41, 42, 43, see below |
//! | TCP/IP Interface 245/1 | 5 |
//! | Ethernet Link 246/1 | 1 to 3 |
//!
//! The parameters:
//!
//! | n | value | type | |
//! | --- | --- | --- | --- |
//! | 1 | output frequency | INT, 0.01 Hz | moves: 30 Hz ± 5 Hz in 8 s |
//! | 7 | output current | REAL, A | moves: 4.2 A ± 1 A in 5 s |
//! | 41 | acceleration time | INT, 0.01 s | writable, 1000 at first |
//! | 42 | deceleration time | INT, 0.01 s | writable, 1000 at first |
//! | 43 | speed reference | REAL, Hz | writable, 30.0 at first |

mod assembly;
mod attribute;
mod config;
mod connection;
mod connections;
mod counters;
mod datagram;
mod device;
mod fault;
mod forward;
mod identity;
mod module;
mod network;
mod objects;
mod opening;
mod outbox;
mod parameter;
mod request;
mod route;
mod session;
mod wave;

pub use self::assembly::{ASSEMBLY_SIZE, INPUT_ASSEMBLY, OUTPUT_ASSEMBLY};
pub use self::config::{Quirk, SimConfig, UnknownQuirk};
pub use self::connection::SimConnection;
pub use self::counters::Counters;
pub use self::datagram::handle_datagram;
pub use self::device::Device;
pub use self::fault::{Fault, UnknownFault};
pub use self::identity::SimIdentity;
pub use self::module::{BACKPLANE, ETHERNET, SimModule};

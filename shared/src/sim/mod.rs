//! A small EtherNet/IP device without a socket, in a chassis with a few others: for trying a message without hardware,
//! and for tests.
//!
//! Three levels, each usable alone:
//! * [`Device`] answers message router requests: objects, attributes, routes, connections, refusals.
//! * [`SimConnection`] is one TCP connection to it: sessions, framing, delay and [faults](Fault).
//! * [`handle_datagram`] answers UDP.
//!
//! Bytes and time come in, bytes go out; nothing waits. One `Device` serves any number of TCP connections. Values move
//! as functions of the time that is passed in, so a test sees what it asks for.
//!
//! # What is there
//!
//! [Modules](SimModule) in a chassis and on an Ethernet, each with values of its own. [`SimModule::usual`]:
//!
//! | slot (port 1) | address (port 2) | who |
//! | --- | --- | --- |
//! | 0 | that of the TCP connection | the device itself |
//! | 1 | | cipdeck demo I/O |
//! | 3 | 192.168.1.10 | cipdeck demo bridge |
//! | | 192.168.1.20 | cipdeck demo remote |
//!
//! The objects of each:
//!
//! | object | attributes |
//! | --- | --- |
//! | Identity 1/1 | 1 to 7, Get_Attributes_All |
//! | Message Router 2/1 | none |
//! | Assembly 4/100 | 3: 32 bytes of input, move by themselves |
//! | Assembly 4/150 | 3: 32 bytes of output, writable, remembered |
//! | Connection Manager 6/1 | 1 to 8: what it has counted, Get_Attributes_All |
//! | DPI Parameter 147/n | 9: the value; n = 1, 7, 41, 42, 43, see below |
//! | Modbus 68/1 | none; 0x4E reads and 0x50 writes [holding registers](Registers); only of the device itself, and if it has some |
//! | TCP/IP Interface 245/1 | 5; only of a module with an address |
//! | Ethernet Link 246/1 | 1 to 3; only of a module with an address |
//!
//! Get_Attribute_List works everywhere, and instance 0 of each class has 1 revision, 2 highest instance and 3 number of
//! instances. The parameters:
//!
//! | n | value | type | |
//! | --- | --- | --- | --- |
//! | 1 | output frequency | INT, 0.01 Hz | moves: 30 Hz ± 5 Hz in 8 s |
//! | 7 | output current | REAL, A | moves: 4.2 A ± 1 A in 5 s |
//! | 41 | acceleration time | INT, 0.01 s | writable, 1000 at first |
//! | 42 | deceleration time | INT, 0.01 s | writable, 1000 at first |
//! | 43 | speed reference | REAL, Hz | writable, 30.0 at first |
//!
//! # Controllers
//!
//! A [profile](SimProfile) makes it a Logix, a Micro800 or an Omron NX: [`SimProfile::config`] has identity, sizes and the
//! usual [tags](TagMemory). Tags are pieces of memory, laid out as the family does; they are read and written by name and
//! told by the objects that the family has for it. `docs/SIMULATOR.md` has the tables: services, refusals, what is guessed.
//! A program that makes no controller carries no code of one: [`Tags`] are behind a pointer.
//!
//! # Routes
//!
//! Unconnected_Send and Forward_Open follow their path one hop after the other, as bridges do. Where it does not lead on,
//! the router answers 01 with 0x0311 (no such port), 0x0312 (no such slot, or no address), 0x0315 (no port segment), 0x0318
//! (its own address), or, after the time that it was given, 0x0204 (nobody there), and how many words of the path it had
//! left. What waits for that time holds up nothing else.
//!
//! # Connections
//!
//! Class 3 connections to the Message Router of any module. They belong to the session that opened them, but whoever
//! knows the three numbers of a connection may close it. A request with the sequence count of the one before is answered
//! from memory; a request to an id that is not open is dropped. When a TCP connection is lost its connections stay, as on
//! many devices, until they have been silent for RPI x multiplier (at least 10 s before the first request) or somebody
//! closes them; UnRegisterSession closes them at once.

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
mod modbus;
mod module;
mod network;
mod objects;
mod opening;
mod outbox;
mod packet;
mod parameter;
mod profile;
mod request;
mod route;
mod session;
mod tags;
mod wave;

pub use self::assembly::{ASSEMBLY_SIZE, INPUT_ASSEMBLY, OUTPUT_ASSEMBLY};
pub use self::config::{Quirk, SimConfig, UnknownQuirk};
pub use self::connection::SimConnection;
pub use self::counters::Counters;
pub use self::datagram::handle_datagram;
pub use self::device::Device;
pub use self::fault::{Fault, UnknownFault};
pub use self::identity::SimIdentity;
pub use self::modbus::Registers;
pub use self::module::{BACKPLANE, ETHERNET, SimModule};
pub use self::profile::{SimProfile, UnknownProfile};
pub use self::tags::{
    DefinitionError, Motion, TagAccess, TagDefinition, TagFileError, TagMemory, Tags, UnknownMotion,
};

//! Bytes ↔ types of EtherNet/IP and CIP. Imports nothing but `core` and `alloc`.
//!
//! *Decoding is total*: any byte string gives a value or a [`DecodeError`] that names the byte. Decoded values
//! borrow from the input where they carry data. *Encoding cannot fail*: what would not fit on the wire is refused
//! when the value is made ([`TooLong`]), so that `encode` has nothing left to refuse.
//!
//! All integers are little endian, except the socket address in a `ListIdentity` reply, which is big endian.
//! Codes that a device may extend ([`Command`], [`GeneralStatus`] …) are open: an unknown value survives and prints
//! as hexadecimal.

#[macro_use]
mod open;

mod class;
mod common_packet;
mod connection_manager;
mod cursor;
mod deframer;
mod encapsulation;
mod epath;
mod forward_close;
mod forward_open;
mod identity;
mod list_identity;
mod list_services;
mod message_router;
mod multiple_service;
mod request_timeout;
mod send_rr_data;
mod send_unit_data;
mod service;
mod simple_data;
mod status;
mod symbol;
mod unconnected_send;
mod value;

pub use self::class::ClassCode;
pub use self::common_packet::{CommonPacketFormat, Item, ItemType, Items};
pub use self::connection_manager::{ConnectionTriad, RouterRefusal};
pub use self::cursor::{DecodeError, DecodeErrorKind, Reader, TooLong};
pub use self::deframer::Deframer;
pub use self::encapsulation::{
    Command, Encapsulation, EncapsulationStatus, HEADER_SIZE, Header, MAX_DATA, PROTOCOL_VERSION,
    RegisterSession, SenderContext, SessionHandle,
};
pub use self::epath::{Epath, LogicalKind, LogicalSegment, PortSegment, Segment};
pub use self::forward_close::{ForwardClose, ForwardCloseReply};
pub use self::forward_open::{
    ConnectionParameters, ForwardOpen, ForwardOpenReply, MAX_CLASSIC_SIZE, TimeoutMultiplier,
};
pub use self::identity::IdentityAttributes;
pub use self::list_identity::{ListIdentityItem, SocketAddress};
pub use self::list_services::ListServicesItem;
pub use self::message_router::{AdditionalStatus, MessageRouterReply, MessageRouterRequest};
pub use self::multiple_service::{MultipleServicePacket, MultipleServiceReply};
pub use self::request_timeout::RequestTimeout;
pub use self::send_rr_data::{MAX_MESSAGE, SendRrData, UnconnectedMessage};
pub use self::send_unit_data::{ConnectedItem, ConnectedMessage, ConnectionId, MAX_CONNECTED_MESSAGE};
pub use self::service::ServiceCode;
pub use self::simple_data::SimpleDataSegment;
pub use self::status::GeneralStatus;
pub use self::symbol::SymbolSegment;
pub use self::unconnected_send::UnconnectedSend;
pub use self::value::{CipType, CipValue, ShortString};

//! Tags of an export.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt::Write;

use super::super::message::{Message, spaced};
use super::MAX_TARGET_OBJECT;
use super::path::connection_path;
use super::xml::{cdata, escaped};

/// The `MESSAGE`.
pub(super) fn message(message: &Message<'_>, name: &str) -> String {
    let (app, data) = (&message.config.app_cfg, message.data());
    // Of an instance that is too large nobody knows what is sent.
    let request = if app.instance > MAX_TARGET_OBJECT {
        "is not the block's".to_string()
    } else {
        spaced(&message.bytes_without_members())
    };
    let about = format!(
        "{}: service {}, class {}, instance {} = 16#{:x}, attribute {}; request {request}",
        message.config.name,
        message.service_words(),
        message.class_words(),
        app.instance,
        app.instance,
        if app.attribute == 0 { "none".to_string() } else { app.attribute.to_string() },
    );
    let source = if data.is_empty() { String::new() } else { format!(" LocalElement=\"{name}_Req[0]\"") };
    // As in exports: a connection that is not kept is not cached; without one there is nothing to say.
    let (flag, cache) = match message.plan.connection() {
        None => ("2", ""),
        Some(connection) if connection.close => ("1", " CacheConnections=\"FALSE\""),
        Some(_) => ("1", " CacheConnections=\"TRUE\""),
    };
    format!(
        "<Tag Name=\"{name}\" TagType=\"Base\" DataType=\"MESSAGE\" ExternalAccess=\"Read/Write\">\n\
         <Description>\n{}\n</Description>\n<Data Format=\"Message\">\n\
         <MessageParameters MessageType=\"CIP Generic\" RequestedLength=\"{}\" ConnectedFlag=\"{flag}\" \
         ConnectionPath=\"{}\" CommTypeCode=\"0\" ServiceCode=\"16#{:04x}\" ObjectType=\"16#{:04x}\" \
         TargetObject=\"{}\" AttributeNumber=\"16#{:04x}\" LocalIndex=\"0\"{source} \
         DestinationTag=\"{name}_Res[0]\"{cache} LargePacketUsage=\"false\"/>\n</Data>\n</Tag>\n",
        cdata(&about),
        data.len(),
        escaped(&connection_path(message)),
        app.service,
        app.class,
        app.instance,
        app.attribute,
    )
}

/// An array of SINT, as hexadecimal.
pub(super) fn bytes(name: &str, bytes: &[u8]) -> String {
    let signed: Vec<String> = bytes.iter().map(|byte| byte.cast_signed().to_string()).collect();
    let size = bytes.len();
    let mut tag = format!(
        "<Tag Name=\"{name}\" TagType=\"Base\" DataType=\"SINT\" Dimensions=\"{size}\" Radix=\"Hex\" Constant=\"false\" \
         ExternalAccess=\"Read/Write\">\n<Data Format=\"L5K\">\n{}\n</Data>\n<Data Format=\"Decorated\">\n\
         <Array DataType=\"SINT\" Dimensions=\"{size}\" Radix=\"Hex\">\n",
        cdata(&format!("[{}]", signed.join(",")))
    );
    for (index, byte) in bytes.iter().enumerate() {
        // Writing to a String cannot fail.
        let _ = writeln!(tag, "<Element Index=\"[{index}]\" Value=\"16#{byte:02x}\"/>");
    }
    tag.push_str("</Array>\n</Data>\n</Tag>\n");
    tag
}

/// A BOOL, FALSE.
pub(super) fn flag(name: &str) -> String {
    format!(
        "<Tag Name=\"{name}\" TagType=\"Base\" DataType=\"BOOL\" Radix=\"Decimal\" Constant=\"false\" \
         ExternalAccess=\"Read/Write\">\n<Data Format=\"L5K\">\n<![CDATA[0]]>\n</Data>\n<Data Format=\"Decorated\">\n\
         <DataValue DataType=\"BOOL\" Radix=\"Decimal\" Value=\"0\"/>\n</Data>\n</Tag>\n"
    )
}

/// A TIMER of so many ms.
pub(super) fn timer(name: &str, preset: i64) -> String {
    let mut members = String::new();
    for (member, value) in [("PRE", preset), ("ACC", 0)] {
        let _ = writeln!(
            members,
            "<DataValueMember Name=\"{member}\" DataType=\"DINT\" Radix=\"Decimal\" Value=\"{value}\"/>"
        );
    }
    for member in ["EN", "TT", "DN"] {
        let _ = writeln!(members, "<DataValueMember Name=\"{member}\" DataType=\"BOOL\" Value=\"0\"/>");
    }
    format!(
        "<Tag Name=\"{name}\" TagType=\"Base\" DataType=\"TIMER\" Constant=\"false\" ExternalAccess=\"Read/Write\">\n\
         <Data Format=\"L5K\">\n<![CDATA[[0,{preset},0]]]>\n</Data>\n<Data Format=\"Decorated\">\n\
         <Structure DataType=\"TIMER\">\n{members}</Structure>\n</Data>\n</Tag>\n"
    )
}

//! A block as a script.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt::Write;

use super::super::Code;
use super::super::change::{Change, Grade, Why, is_held};
use super::super::cli::closes_at_end;
use super::super::dialect::Dialect;
use super::super::header::comment;
use super::super::l5x::link;
use super::super::message::{Message, Tells, spaced};
use super::super::program::quoted;
use crate::config::{BlockConfig, Endpoint};
use crate::wire::Segment;

/// What pycomm3 gives a router, always.
const ROUTER_MS: u32 = 5_120;

/// The last port number that it writes right.
const MAX_PORT: u16 = 14;

/// A block as a script that runs.
pub(in super::super) fn export(block: &BlockConfig, before: &[Change]) -> Code {
    let message = match Message::of(block) {
        Ok(message) => message,
        Err(code) => return code,
    };
    let mut changes = message.untold(Tells::default());
    let timeout = timeout(&message, &mut changes);
    closes_at_end(&message, &mut changes);
    requests(&message, &mut changes);
    let held = is_held(before, &changes);
    Code { text: script(&message, timeout, held), changes }
}

/// One timeout serves for everything.
fn timeout(message: &Message<'_>, changes: &mut Vec<Change>) -> u32 {
    let ucmm = message.plan.ucmm_timeout_ms();
    let mut adjusted = |to: u32, why: Why| {
        changes.push(Change::new(&"TargetCfg.UcmmTimeout", &ucmm, &to, Grade::Adjusted, why));
    };
    let Some(connection) = message.plan.connection() else {
        if !message.path.route.is_empty() && ucmm > ROUTER_MS {
            adjusted(ROUTER_MS, Why::TimeoutBounds(0, ROUTER_MS));
        }
        return ucmm;
    };
    if connection.timeout_ms != ucmm {
        adjusted(connection.timeout_ms, Why::OneTimeout);
    }
    connection.timeout_ms
}

/// What would go out otherwise than the block says.
fn requests(message: &Message<'_>, changes: &mut Vec<Change>) {
    let app = &message.config.app_cfg;
    let mut other = |member: &str, from: &str, to: &str, why: Why| {
        changes.push(Change::new(&member, &from, &to, Grade::Request, why));
    };
    if !message.members().is_empty() {
        other("AppCfg.MemberId", &format!("{:?}", message.members()), "", Why::NoMemberSegments);
    }
    if app.instance > 0xFFFF {
        let instance = app.instance.to_string();
        other("AppCfg.Instance", &instance, &instance, Why::SegmentWidths);
    }
    if message.endpoint().is_none() {
        other("TargetCfg.Path", "0,0", "127.0.0.1", Why::NoBuiltIn);
    }
    if message.endpoint().is_some_and(|endpoint| endpoint.port == u16::MAX) {
        other("TargetCfg.Path", &message.config.target_cfg.path, "", Why::NoTcpPort);
    }
    if has_long_port(message) && message.plan.connection().is_some() {
        other("TargetCfg.Path", &message.config.target_cfg.path, "", Why::NoRoute);
    }
}

fn has_long_port(message: &Message<'_>) -> bool {
    let mut segments = message.path.route.segments().iter();
    segments.any(|segment| matches!(segment, Segment::Port(port) if port.port() > MAX_PORT))
}

/// `192.168.1.100:44820`, the port only where it is an unusual one.
pub(in super::super) fn host(endpoint: Option<&Endpoint>) -> String {
    match endpoint {
        None => "127.0.0.1".to_string(),
        Some(endpoint) if endpoint.has_unusual_port() => endpoint.to_string(),
        Some(endpoint) => endpoint.host.to_string(),
    }
}

fn script(message: &Message<'_>, timeout_ms: u32, held: bool) -> String {
    let app = &message.config.app_cfg;
    let route = &message.path.route;
    let connected = message.plan.connection().is_some();
    // Where pycomm3 writes a segment wrongly, the finished bytes are given: size in words, a pad, the route.
    let bytes = (has_long_port(message) && !connected).then(|| {
        let bytes = route.bytes();
        let words = u8::try_from(bytes.len() / 2).unwrap_or(u8::MAX);
        format!("bytes.fromhex(\"{}\")", spaced(&[&[words, 0], bytes.as_slice()].concat()))
    });
    let mut path = host(message.endpoint());
    for segment in route.segments() {
        if let (Segment::Port(port), None) = (segment, &bytes) {
            // Writing to a String cannot fail.
            let _ = write!(path, "/{}/{}", port.port(), link(port));
        }
    }
    let mut text = comment(Dialect::Pycomm3, &about(message));
    text.push_str("from pycomm3 import CIPDriver\n\n");
    if held {
        text.push_str(
            "# Remove this line when what is NOT CARRIED is settled.\n\
             raise SystemExit(\"this script does not send what the block says\")\n\n",
        );
    }
    let seconds = format!("{}.{:03}", timeout_ms / 1_000, timeout_ms % 1_000);
    let seconds = seconds.strip_suffix("00").unwrap_or(&seconds);
    let _ = write!(
        text,
        "driver = CIPDriver(\"{path}\")\n\
         driver.socket_timeout = {seconds}  # s; {timeout_ms} ms = 0x{timeout_ms:X}\n\
         with driver:\n    reply = driver.generic_message(\n\
         \x20       service=0x{:02X},  # {}\n\
         \x20       class_code=0x{:02X},  # {}\n\
         \x20       instance=0x{:02X},  # {}\n",
        app.service,
        message.service_words(),
        app.class,
        message.class_words(),
        app.instance,
        app.instance,
    );
    if app.attribute != 0 {
        let _ = writeln!(text, "        attribute=0x{:02X},  # {}", app.attribute, app.attribute);
    }
    if !message.data().is_empty() {
        let _ = writeln!(text, "        request_data=bytes.fromhex(\"{}\"),", spaced(message.data()));
    }
    let python = |is: bool| if is { "True" } else { "False" };
    let route_path = bytes.unwrap_or_else(|| python(!route.is_empty()).to_string());
    let _ = writeln!(text, "        connected={},", python(connected));
    if !connected {
        let wrapped = python(!route.is_empty());
        let _ = write!(text, "        unconnected_send={wrapped},\n        route_path={route_path},\n");
    }
    let _ = write!(
        text,
        "        name={},\n    )\nif reply.error:\n    raise SystemExit(f\"{{reply.tag}}: {{reply.error}}\")\n\
         print(reply.tag, reply.value.hex(\" \"))\n",
        quoted(&message.config.name, escaped)
    );
    text
}

fn about(message: &Message<'_>) -> String {
    let bytes = spaced(message.plan.bytes());
    format!("{}: request {bytes}. Needs: pip install pycomm3", message.config.name)
}

fn escaped(c: char) -> String {
    format!("\\U{:08x}", u32::from(c))
}

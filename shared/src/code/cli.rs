//! `cipdeck send`: one line that sends the message from here.

mod read;
mod shell;

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::Code;
use super::change::{Change, Grade, Why, is_held};
use super::dialect::Dialect;
use super::header::comment;
use super::message::{Message, Tells, spaced};
use crate::config::{BlockConfig, write_hex};

pub(super) use self::read::import;

/// A block as a command line for a POSIX shell.
pub(super) fn export(block: &BlockConfig, before: &[Change]) -> Code {
    let message = match Message::of(block) {
        Ok(message) => message,
        Err(code) => return code,
    };
    let mut changes = message.untold(Tells::default());
    let timeout = timeout(&message, &mut changes);
    closes_at_end(&message, &mut changes);
    // What is sent does not depend on it.
    changes.push(Change::new(&"name", &block.name(), &"", Grade::Carried, Why::NoSuchMember));
    let app = &message.config.app_cfg;
    let mut words: Vec<String> = ["cipdeck", "send"].map(String::from).to_vec();
    let mut option = |name: &str, value: &str| words.extend([name.to_string(), shell::quoted(value)]);
    // A path may begin with anything but a minus: it is a port, a comma and an address.
    option("", message.config.target_cfg.path.trim());
    option("--service", &format!("0x{:02X}", app.service));
    option("--class", &format!("0x{:02X}", app.class));
    option("--instance", &app.instance.to_string());
    if app.attribute != 0 {
        option("--attribute", &app.attribute.to_string());
    }
    for member in message.members() {
        option("--member", &member.to_string());
    }
    if !message.data().is_empty() {
        option("--data", &write_hex(message.data()));
    }
    if let Some(timeout) = timeout {
        option("--timeout", &timeout.to_string());
    }
    if message.plan.connection().is_some() {
        words.push("--connected".into());
    }
    words.retain(|word| !word.is_empty());
    let about = format!(
        "{}: service {}, class {}, instance 0x{:X}, attribute 0x{:X}; request {}",
        block.name(),
        message.service_words(),
        message.class_words(),
        app.instance,
        app.attribute,
        spaced(message.plan.bytes()),
    );
    // What would reach something else does not run before somebody has looked at it.
    let never = if is_held(before, &changes) { "false && " } else { "" };
    Code { text: format!("{}{never}{}\n", comment(Dialect::Cli, &about), words.join(" ")), changes }
}

/// One timeout serves for both: of the connection, where there is one.
fn timeout(message: &Message<'_>, changes: &mut Vec<Change>) -> Option<u32> {
    let ucmm = message.plan.ucmm_timeout_ms();
    let target = &message.config.target_cfg;
    let Some(connection) = message.plan.connection() else {
        return (target.ucmm_timeout != 0).then_some(ucmm);
    };
    if (target.ucmm_timeout, target.conn_msg_timeout) == (0, 0) {
        return None;
    }
    let one = connection.timeout_ms;
    if ucmm != one {
        changes.push(Change::new(&"TargetCfg.UcmmTimeout", &ucmm, &one, Grade::Adjusted, Why::OneTimeout));
    }
    Some(one)
}

/// A program that ends leaves no connection open.
pub(super) fn closes_at_end(message: &Message<'_>, changes: &mut Vec<Change>) {
    if message.plan.connection().is_some_and(|connection| !connection.close) {
        let (member, why) = ("TargetCfg.ConnClose", Why::ConnectionStays);
        changes.push(Change::new(&member, &"FALSE", &"TRUE", Grade::Adjusted, why));
    }
}

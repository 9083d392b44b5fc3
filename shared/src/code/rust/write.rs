//! A block as a program.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt::Write;

use super::super::Code;
use super::super::change::{Change, Grade, Why, is_held};
use super::super::dialect::Dialect;
use super::super::header::comment;
use super::super::message::{Message, Tells, spaced};
use super::super::program::quoted;
use crate::config::BlockConfig;
use crate::wire::{PortSegment, Segment};

/// The last port number that rseip writes right.
const MAX_PORT: u16 = 14;

/// The last instance that it has room for; a longer one is given as finished bytes.
const MAX_INSTANCE: i64 = 0xFFFF;

/// A block as a program.
pub(in super::super) fn export(block: &BlockConfig, before: &[Change]) -> Code {
    let message = match Message::of(block) {
        Ok(message) => message,
        Err(code) => return code,
    };
    let mut changes = message.untold(Tells::default());
    super::super::cli::closes_at_end(&message, &mut changes);
    let mut other = |to: &str, why: Why| {
        let path = &message.config.target_cfg.path;
        changes.push(Change::new(&"TargetCfg.Path", path, &to, Grade::Request, why));
    };
    if message.endpoint().is_none() {
        other("127.0.0.1", Why::NoBuiltIn);
    }
    if ports(&message).any(|port| port.port() > MAX_PORT) {
        other("", Why::NoRoute);
    }
    let held = is_held(before, &changes);
    Code { text: Program { message: &message }.text(held), changes }
}

fn ports<'a>(message: &'a Message<'_>) -> impl Iterator<Item = &'a PortSegment> {
    message.path.route.segments().iter().filter_map(|segment| match segment {
        Segment::Port(port) => Some(port),
        _ => None,
    })
}

/// One message as a program.
struct Program<'a> {
    message: &'a Message<'a>,
}

impl Program<'_> {
    fn text(&self, held: bool) -> String {
        let message = self.message;
        let ucmm = message.plan.ucmm_timeout_ms();
        let about = format!("{}: request {}", message.config.name, spaced(message.plan.bytes()));
        let mut text = comment(Dialect::Rust, &about);
        text.push_str(
            "// Cargo.toml: rseip = \"0.3\"\n\
             //             tokio = { version = \"1\", features = [\"macros\", \"net\", \"rt-multi-thread\", \"time\"] }\n",
        );
        text.push_str(&self.imports());
        // Writing to a String cannot fail.
        let _ =
            writeln!(text, "\nconst UCMM_TIMEOUT: Duration = Duration::from_millis({ucmm}); // 0x{ucmm:X}");
        if let Some(connection) = message.plan.connection() {
            let ms = connection.timeout_ms;
            let _ =
                writeln!(text, "const CONN_MSG_TIMEOUT: Duration = Duration::from_millis({ms}); // 0x{ms:X}");
        }
        let refusal = if held {
            "    // Remove this line when what is NOT CARRIED is settled.\n    \
             return Err(\"this program does not send what the block says\".into());\n    #[allow(unreachable_code)]\n"
        } else {
            ""
        };
        let within = match message.plan.connection() {
            None => "timeout(UCMM_TIMEOUT, send()).await??",
            Some(_) => "send().await?",
        };
        let name = quoted(&message.config.name, |c| format!("\\u{{{:x}}}", u32::from(c)));
        let (before, after) = self.exchange();
        let _ = write!(
            text,
            "\n#[tokio::main]\nasync fn main() -> Result<(), Box<dyn Error>> {{\n    let name = {name};\n{refusal}    \
             let data = {within};\n    println!(\"{{name}}: {{data:02x?}}\");\n    Ok(())\n}}\n\n\
             async fn send() -> Result<Vec<u8>, Box<dyn Error>> {{\n{before}{}{after}    Ok(reply.data)\n}}\n",
            self.request(),
        );
        text
    }

    fn imports(&self) -> String {
        let (routed, connected) =
            (!self.message.path.route.is_empty(), self.message.plan.connection().is_some());
        let built = self.message.config.app_cfg.instance <= MAX_INSTANCE;
        let mut text = String::from("use std::error::Error;\nuse std::time::Duration;\n\n");
        if !connected && !routed {
            text.push_str("use rseip::ClientError;\nuse rseip::cip::codec::decode::message_reply::decode_unconnected_send;\n");
        }
        text.push_str(match (connected, routed, built) {
            (_, true, _) => "use rseip::cip::epath::{EPath, PortSegment, Segment};\n",
            (true, false, _) => "use rseip::cip::epath::{EPath, Segment};\n",
            (false, false, true) => "use rseip::cip::epath::EPath;\n",
            (false, false, false) => "",
        });
        text.push_str("use rseip::cip::{MessageReply, MessageRequest};\n");
        text.push_str(match (connected, routed) {
            (true, _) => {
                "use rseip::client::{EipConnection, OpenOptions};\nuse rseip::precludes::MessageService;\n"
            }
            (false, true) => "use rseip::client::EipClient;\nuse rseip::precludes::MessageService;\n",
            (false, false) => "use rseip::client::EipContext;\nuse tokio::net::TcpStream;\n",
        });
        text.push_str("use tokio::time::timeout;\n");
        text
    }

    /// Service, path and data.
    fn request(&self) -> String {
        let (message, app) = (self.message, &self.message.config.app_cfg);
        let mut path = format!(
            "EPath::new()\n        .with_class(0x{:02X}) // {}\n        .with_instance(0x{:02X})",
            app.class,
            message.class_words(),
            app.instance,
        );
        if app.attribute != 0 {
            let _ = write!(path, "\n        .with_attribute(0x{:02X})", app.attribute);
        }
        for member in message.members() {
            let _ = write!(path, "\n        .with_element(0x{member:02X})");
        }
        if app.instance > MAX_INSTANCE {
            path = slice(&message.plan.request().path().bytes());
        }
        let data = if message.data().is_empty() { "()".to_string() } else { slice(message.data()) };
        format!(
            "    // Instance {}, attribute {}.\n    let path = {path};\n    let service = 0x{:02X}; // {}\n    \
             let request = MessageRequest::new(service, path, {data});\n",
            app.instance,
            app.attribute,
            app.service,
            message.service_words(),
        )
    }

    /// What stands before the request, and after it.
    fn exchange(&self) -> (String, &'static str) {
        let host = match self.message.endpoint() {
            None => "127.0.0.1:44818".to_string(),
            Some(endpoint) => endpoint.to_string(),
        };
        match self.message.plan.connection() {
            Some(connection) => {
                let rate = u64::from(connection.timeout_ms) * 1_000 / 4;
                let before = format!(
                    "    let options = OpenOptions::default()\n        .connection_path(EPath::from(vec![{}Segment::Class(2), \
                     Segment::Instance(1)]))\n        .o_t_rpi({rate}) // us; x 4 = the timeout of the connection\n        \
                     .t_o_rpi({rate})\n        .timeout_multiplier(0);\n    \
                     let mut connection = EipConnection::new_host_lookup(\"{host}\", options).await?;\n    \
                     timeout(UCMM_TIMEOUT, connection.reconnect()).await??;\n",
                    self.hops()
                );
                let after = "    let reply: MessageReply<Vec<u8>> = timeout(CONN_MSG_TIMEOUT, connection.send(request)).await??;\n    \
                             connection.close().await?;\n";
                (before, after)
            }
            None if self.message.path.route.is_empty() => {
                let before = format!(
                    "    let stream = TcpStream::connect(\"{host}\").await?;\n    \
                     let mut context: EipContext<_, ClientError> = EipContext::new(stream);\n    \
                     context.register_session().await?;\n"
                );
                let after = "    let packet = context.send_rrdata(request).await?;\n    \
                             let reply: MessageReply<Vec<u8>> = decode_unconnected_send(packet)?;\n    \
                             context.unregister_session().await?;\n";
                (before, after)
            }
            None => {
                let before = format!(
                    "    let route = EPath::from(vec![{}]);\n    \
                     let mut client = EipClient::new_host_lookup(\"{host}\").await?.with_connection_path(route);\n",
                    self.hops().trim_end_matches(", ")
                );
                let after = "    let reply: MessageReply<Vec<u8>> = client.send(request).await?;\n    client.close().await?;\n";
                (before, after)
            }
        }
    }

    /// `Segment::Port(PortSegment { port: 1, link: vec![0].into() }), `
    fn hops(&self) -> String {
        let hops: Vec<String> = ports(self.message)
            .map(|port| {
                let link = port.address().map(|address| format!("b\"{address}\".to_vec()"));
                let link = link.unwrap_or_else(|| format!("vec![{}]", port.slot().unwrap_or(0)));
                format!("Segment::Port(PortSegment {{ port: {}, link: {link}.into() }}), ", port.port())
            })
            .collect();
        hops.concat()
    }
}

/// `&[0x0A, 0x0B][..]`
fn slice(bytes: &[u8]) -> String {
    let bytes: Vec<String> = bytes.iter().map(|byte| format!("0x{byte:02X}")).collect();
    format!("&[{}][..]", bytes.join(", "))
}

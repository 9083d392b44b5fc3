// what's it called?: request 0E 03 20 01 24 01 30 07
// Cargo.toml: rseip = "0.3"
//             tokio = { version = "1", features = ["macros", "net", "rt-multi-thread", "time"] }
use std::error::Error;
use std::time::Duration;

use rseip::cip::epath::{EPath, PortSegment, Segment};
use rseip::cip::{MessageReply, MessageRequest};
use rseip::client::{EipConnection, OpenOptions};
use rseip::precludes::MessageService;
use tokio::time::timeout;

const UCMM_TIMEOUT: Duration = Duration::from_millis(5000); // 0x1388
const CONN_MSG_TIMEOUT: Duration = Duration::from_millis(5000); // 0x1388

#[tokio::main]
async fn main() -> Result<(), Box<dyn Error>> {
    let name = "what's it called?";
    let data = send().await?;
    println!("{name}: {data:02x?}");
    Ok(())
}

async fn send() -> Result<Vec<u8>, Box<dyn Error>> {
    let options = OpenOptions::default()
        .connection_path(EPath::from(vec![Segment::Port(PortSegment { port: 1, link: vec![0].into() }), Segment::Class(2), Segment::Instance(1)]))
        .o_t_rpi(1250000) // us; x 4 = the timeout of the connection
        .t_o_rpi(1250000)
        .timeout_multiplier(0);
    let mut connection = EipConnection::new_host_lookup("192.168.1.100:44818", options).await?;
    timeout(UCMM_TIMEOUT, connection.reconnect()).await??;
    // Instance 1, attribute 7.
    let path = EPath::new()
        .with_class(0x01) // 1 Identity
        .with_instance(0x01)
        .with_attribute(0x07);
    let service = 0x0E; // 14 Get_Attribute_Single
    let request = MessageRequest::new(service, path, ());
    let reply: MessageReply<Vec<u8>> = timeout(CONN_MSG_TIMEOUT, connection.send(request)).await??;
    connection.close().await?;
    Ok(reply.data)
}

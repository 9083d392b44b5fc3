// what's it called?: request 0E 03 20 01 24 01 30 07
// Cargo.toml: rseip = "0.3"
//             tokio = { version = "1", features = ["macros", "net", "rt-multi-thread", "time"] }
use std::error::Error;
use std::time::Duration;

use rseip::cip::epath::{EPath, PortSegment, Segment};
use rseip::cip::{MessageReply, MessageRequest};
use rseip::client::EipClient;
use rseip::precludes::MessageService;
use tokio::time::timeout;

const UCMM_TIMEOUT: Duration = Duration::from_millis(5000); // 0x1388

#[tokio::main]
async fn main() -> Result<(), Box<dyn Error>> {
    let name = "what's it called?";
    let data = timeout(UCMM_TIMEOUT, send()).await??;
    println!("{name}: {data:02x?}");
    Ok(())
}

async fn send() -> Result<Vec<u8>, Box<dyn Error>> {
    let route = EPath::from(vec![Segment::Port(PortSegment { port: 1, link: vec![3].into() }), Segment::Port(PortSegment { port: 2, link: b"192.168.1.55".to_vec().into() })]);
    let mut client = EipClient::new_host_lookup("plc-3.line:44820").await?.with_connection_path(route);
    // Instance 1, attribute 7.
    let path = EPath::new()
        .with_class(0x01) // 1 Identity
        .with_instance(0x01)
        .with_attribute(0x07);
    let service = 0x0E; // 14 Get_Attribute_Single
    let request = MessageRequest::new(service, path, ());
    let reply: MessageReply<Vec<u8>> = client.send(request).await?;
    client.close().await?;
    Ok(reply.data)
}

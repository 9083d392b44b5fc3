// what's it called?: request 0E 06 20 01 24 01 30 07 28 01 29 00 2C 01 0A 0B
// Cargo.toml: rseip = "0.3"
//             tokio = { version = "1", features = ["macros", "net", "rt-multi-thread", "time"] }
use std::error::Error;
use std::time::Duration;

use rseip::ClientError;
use rseip::cip::codec::decode::message_reply::decode_unconnected_send;
use rseip::cip::epath::EPath;
use rseip::cip::{MessageReply, MessageRequest};
use rseip::client::EipContext;
use tokio::net::TcpStream;
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
    let stream = TcpStream::connect("192.168.1.100:44818").await?;
    let mut context: EipContext<_, ClientError> = EipContext::new(stream);
    context.register_session().await?;
    // Instance 1, attribute 7.
    let path = EPath::new()
        .with_class(0x01) // 1 Identity
        .with_instance(0x01)
        .with_attribute(0x07)
        .with_element(0x01)
        .with_element(0x12C);
    let service = 0x0E; // 14 Get_Attribute_Single
    let request = MessageRequest::new(service, path, &[0x0A, 0x0B][..]);
    let packet = context.send_rrdata(request).await?;
    let reply: MessageReply<Vec<u8>> = decode_unconnected_send(packet)?;
    context.unregister_session().await?;
    Ok(reply.data)
}

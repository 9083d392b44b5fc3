//! Our simulated controllers, asked for their tags by clients that nobody here wrote.
//!
//! The scripts are in `tests/python`, and beside each what it has to print.

use std::net::SocketAddrV4;
use std::path::Path;
use std::process::Stdio;

use cipdeck_tests::command::{Service, cipdeck};
use cipdeck_tests::peers::cpppo_client;
use cipdeck_tests::wait::within;
use cipdeck_tests::{PATIENCE, tools};
use futures_util::TryStreamExt;
use rseip::cip::connection::OpenOptions;
use rseip::cip::epath::{EPath, PortSegment};
use rseip::cip::{MessageReply, MessageRequest};
use rseip::client::ab_eip::{
    AbEipClient, AbEipConnection, AbService as _, PathParser as _, SERVICE_READ_TAG, TagType, TagValue,
};
use rseip::precludes::{CommonServices as _, MessageService as _};
use tokio::process::Command;

#[tokio::test]
async fn pycomm3_reads_and_writes_a_logix() {
    let expected = include_str!("../../python/pycomm3_logix.txt");
    let counted = prints("logix", "pycomm3_logix.py", expected).await;
    assert_eq!(counted, "tag reads 39, tag writes 18, packets 4");
}

#[tokio::test]
async fn pylogix_reads_and_writes_a_logix() {
    let counted = prints("logix", "pylogix_logix.py", include_str!("../../python/pylogix_logix.txt")).await;
    assert_eq!(counted, "tag reads 55, tag writes 10, packets 4");
}

#[tokio::test]
async fn pycomm3_and_pylogix_read_and_write_a_micro800() {
    let counted = prints("micro800", "micro800.py", include_str!("../../python/micro800.txt")).await;
    assert!(counted.ends_with("packets 0"), "{counted}");
}

#[tokio::test]
async fn aphyt_reads_and_writes_an_omron() {
    let expected = include_str!("../../python/aphyt_omron.txt");
    // It asks at 44818 and nowhere else: an address of this process, so that nobody else is there.
    let [.., high, low] = std::process::id().to_be_bytes();
    let device =
        Service::simulate(&format!("127.{}.{low}.2:44818", 1 + high % 250), &["--profile", "omron"]).await;
    let host = device.address.strip_suffix(":44818").expect("the port").to_owned();
    assert_prints("aphyt_omron.py", &host, expected).await;
}

#[tokio::test]
async fn rseip_reads_and_writes_tags_of_a_logix() {
    let device = Service::simulate("127.0.0.1:0", &["--profile", "logix"]).await;
    let address: SocketAddrV4 = device.address.parse().expect("an IPv4 address");
    let mut client = AbEipClient::new(address).with_connection_path(PortSegment::default());
    let value: TagValue<i32> = client.read_tag(tag("Scalar")).await.expect("a DINT");
    assert_eq!((value.tag_type, value.value), (TagType::Dint, 42));
    client.write_tag(tag("Scalar"), TagValue { tag_type: TagType::Dint, value: -7 }).await.expect("a write");
    let value: TagValue<i32> = client.read_tag(tag("Scalar")).await.expect("a DINT");
    assert_eq!(value.value, -7);
    let value: TagValue<f32> = client.read_tag(tag("Motor1.Speed")).await.expect("a REAL");
    assert!((value.value - 1450.0).abs() < f32::EPSILON);
    let value: TagValue<bool> = client.read_tag(tag("Motor1.Run")).await.expect("a BOOL");
    assert!(value.value);
    let values: TagValue<Vec<i32>> = client.read_tag((tag("Arr[5]"), 4)).await.expect("four DINTs");
    assert_eq!(values.value, [5, 6, 7, 8]);
    let value: TagValue<i32> = client.read_tag(tag("Program:Main.x")).await.expect("a tag of a program");
    assert_eq!(value.value, 7);
    let wrong = TagValue { tag_type: TagType::Real, value: 1.5_f32 };
    let refused = client.write_tag(tag("Scalar"), wrong).await.expect_err("a wrong type").to_string();
    assert!(refused.contains("0xff") || refused.contains("255"), "{refused}");
    let missing: Result<TagValue<i32>, _> = client.read_tag(tag("Nobody")).await;
    assert!(missing.is_err());
    let names: Vec<_> = client
        .list_tag()
        .call()
        .map_ok(|symbol| symbol.name.into_owned())
        .try_collect()
        .await
        .expect("a list");
    assert!(
        names.len() > 1_000
            && ["Scalar", "Program:Main", "D0999"].iter().all(|name| names.iter().any(|it| it == name))
    );
    client.close().await.expect("the end");
}

#[tokio::test]
async fn rseip_reads_several_tags_in_a_packet_over_a_connection() {
    let device = Service::simulate("127.0.0.1:0", &["--profile", "logix"]).await;
    let address: SocketAddrV4 = device.address.parse().expect("an IPv4 address");
    // Its own interval is 17 ms: a pause of the machine would end the connection.
    let options = OpenOptions::default().o_t_rpi(2_000_000).t_o_rpi(2_000_000);
    let mut connection = AbEipConnection::new(address, options);
    let request = |name: &str| MessageRequest::new(SERVICE_READ_TAG, tag(name), 1_u16);
    let packet = connection.multiple_service().push(request("Scalar")).push(request("Status"));
    let mut replies = within("rseip gets a reply", PATIENCE, packet.call()).await.expect("a packet");
    let mut found = Vec::new();
    while let Some(reply) = replies.next() {
        let reply: MessageReply<TagValue<i32>> = reply.expect("a reply");
        found.push(reply.data.value);
    }
    assert_eq!(found, [42, 5]);
    connection.close().await.expect("Forward_Close is answered");
}

#[tokio::test]
async fn cpppo_reads_and_writes_tags_of_a_logix_one_by_one_and_in_a_packet() {
    for more in [&[][..], &["--multiple"]] {
        let device = Service::simulate("127.0.0.1:0", &["--profile", "logix"]).await;
        let tags = ["Scalar", "Arr[0-9]", "Setpoint=(REAL)1.5", "Setpoint", "Motor1.Count"];
        let said = cpppo_client("client", &[&["-p", "-a", &device.address], more, &tags].concat()).await;
        for line in [
            "Scalar              == [42]",
            "== [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]",
            "<= [1.5]",
            "== [1.5]",
            "== [7]",
        ] {
            assert!(said.contains(line), "{line}: {said}");
        }
        let counted = counters(device).await;
        assert_eq!(counted, format!("tag reads 4, tag writes 1, packets {}", more.len()), "{said}");
    }
}

#[tokio::test]
async fn a_file_of_tags_is_used_or_refused_with_line_and_tag() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let file = folder.path().join("plant.json");
    let file = file.to_str().expect("a path in UTF-8");
    let text = r#"[{ "name": "Füllstand", "type": "REAL", "value": 71.5 }]"#;
    std::fs::write(file, text).expect("a file");
    let device = Service::simulate("127.0.0.1:0", &["--profile", "logix", "--tags", file]).await;
    let address: SocketAddrV4 = device.address.parse().expect("an IPv4 address");
    let mut client = AbEipClient::new(address).with_connection_path(PortSegment::default());
    let level: TagValue<f32> = client.read_tag(EPath::from_symbol("Füllstand")).await.expect("a REAL");
    assert!((level.value - 71.5).abs() < f32::EPSILON);
    std::fs::write(file, "[\n  { \"name\": \"Level\", \"type\": \"INT\", \"value\": 70000 }\n]")
        .expect("a file");
    let refused =
        cipdeck(&["simulate", "--listen", "127.0.0.1:0", "--profile", "logix", "--tags", file]).await;
    assert_eq!(refused.code, 2, "{refused:?}");
    let expected = format!("{file}: line 2, Level: value: 70000 is outside of INT: -32768 to 32767");
    assert!(refused.stderr.contains(&expected), "{refused:?}");
    let refused = cipdeck(&["simulate", "--listen", "127.0.0.1:0", "--tags", file]).await;
    assert_eq!(refused.code, 2, "{refused:?}");
    assert!(refused.stderr.contains("--tags needs --profile"), "{refused:?}");
}

fn tag(name: &str) -> EPath {
    EPath::parse_tag(name).expect("a name")
}

/// Runs a script against a controller; what the controller has counted of its tags.
async fn prints(profile: &str, script: &str, expected: &str) -> String {
    let device = Service::simulate("127.0.0.1:0", &["--profile", profile]).await;
    assert_prints(script, &device.address, expected).await;
    counters(device).await
}

/// What it says of its tags when it is stopped.
async fn counters(mut device: Service) -> String {
    device.process.interrupt();
    device.process.ended(PATIENCE).await;
    let last = |line: &str| line.starts_with("unconnected ").then(|| line.to_owned());
    let line = device.process.line("what it has done", PATIENCE, last).await;
    line.find("tag reads").map(|at| line[at..].to_owned()).expect("tags were asked for")
}

/// What is printed has to be what is kept beside the script.
async fn assert_prints(script: &str, address: &str, expected: &str) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("python").join(script);
    let mut command = Command::new(tools::tags_python());
    command.arg(file).arg(address).env("PYTHONIOENCODING", "utf-8").env("PYTHONDONTWRITEBYTECODE", "1");
    command.stdin(Stdio::null()).kill_on_drop(true);
    let output = within(&format!("{script} ends"), PATIENCE, command.output()).await.expect("Python starts");
    let [printed, complained] =
        [output.stdout, output.stderr].map(|said| String::from_utf8_lossy(&said).into_owned());
    for (number, (found, expected)) in printed.lines().zip(expected.lines()).enumerate() {
        assert_eq!(found, expected, "{script}, line {}\n{complained}", number + 1);
    }
    assert_eq!(printed.lines().count(), expected.lines().count(), "{script}: {printed}\n{complained}");
    assert!(output.status.success(), "{script}: {complained}");
}

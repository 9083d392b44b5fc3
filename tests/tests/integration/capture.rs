//! What cipdeck records is what went over the wire, and Wireshark understands it.

use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use cipdeck_tests::command::{Ended, Service, cipdeck};
use cipdeck_tests::fake_plc::{self, FakePlc};
use cipdeck_tests::peers::{CiplinkAdapter, Cpppo};
use cipdeck_tests::process::Process;
use cipdeck_tests::relay::Relay;
use cipdeck_tests::tshark::Capture;
use cipdeck_tests::{PATIENCE, block, tools};
use reqwest::Method;
use tempfile::TempDir;

/// Get_Attribute_Single of the product name.
const PRODUCT_NAME: [&str; 8] = ["--service", "14", "--class", "1", "--instance", "1", "--attribute", "7"];

#[tokio::test]
async fn everything_that_is_sent_to_the_simulated_device_is_recorded() {
    let simulator = Service::simulate("127.0.0.1:0", &[]).await;
    let address: SocketAddr = simulator.address.parse().unwrap();
    let before = SystemTime::now();
    let recording = Recording::of(&fake_plc::path(address), &["--repeat", "3"]).await;
    let capture = recording.capture(address.port());
    capture.is_clean().await;
    // RegisterSession and its reply, three times two, UnRegisterSession.
    assert_eq!(
        capture.field("enip", "enip.command").await,
        ["0x0065", "0x0065", "0x006f", "0x006f", "0x006f", "0x006f", "0x006f", "0x006f", "0x0066"]
    );
    assert_eq!(capture.packets("cip.service == 0x8e && cip.genstat == 0").await.len(), 3);
    assert_eq!(capture.packets("tcp.flags.syn == 1 || tcp.flags.fin == 1").await.len(), 4);
    for time in capture.field("enip", "frame.time_epoch").await {
        let at = UNIX_EPOCH + Duration::from_secs_f64(time.parse().unwrap());
        let second = Duration::from_secs(1);
        assert!(at + second > before && at < SystemTime::now() + second, "{time} is not the time of day");
    }
    let comment = std::fs::read(recording.file()).unwrap();
    assert!(String::from_utf8_lossy(&comment).contains("TCP headers are synthesised by cipdeck"));
}

#[tokio::test]
async fn everything_that_is_sent_to_ciplinks_adapter_is_recorded() {
    let adapter = CiplinkAdapter::start();
    let recording = Recording::of(&adapter.path(), &["--repeat", "2"]).await;
    recording.has_messages(adapter.address().port(), 2).await;
}

#[tokio::test]
async fn everything_that_is_sent_to_cpppo_is_recorded() {
    let cpppo = Cpppo::start().await;
    let recording = Recording::of(&cpppo.path(), &["--repeat", "2"]).await;
    recording.has_messages(port(&cpppo.path()), 2).await;
}

#[tokio::test]
async fn routed_messages_are_recorded() {
    let simulator = Service::simulate("127.0.0.1:0", &[]).await;
    let address: SocketAddr = simulator.address.parse().unwrap();
    for (route, answer) in
        [(",1,0", "cip.service == 0x8e && cip.genstat == 0"), (",1,9", "cip.cm.ext_status == 0x0312")]
    {
        let recording = Recording::of(&(fake_plc::path(address) + route), &[]).await;
        let capture = recording.capture(address.port());
        capture.is_clean().await;
        let (capture, _folder) = capture.at_usual_port().await;
        assert_eq!(capture.packets("cip.service == 0x52").await.len(), 1, "{route}");
        assert_eq!(capture.packets(answer).await.len(), 1, "{route}");
    }
}

#[tokio::test]
async fn connected_messages_are_recorded_with_their_connection() {
    let simulator = Service::simulate("127.0.0.1:0", &[]).await;
    let adapter = CiplinkAdapter::start();
    let cpppo = Cpppo::start().await;
    let simulator: SocketAddr = simulator.address.parse().unwrap();
    for path in [fake_plc::path(simulator), adapter.path(), cpppo.path()] {
        let recording = Recording::of(&path, &["--connected", "--repeat", "3"]).await;
        assert_eq!(recording.ended.code, 0, "{:?}", recording.ended);
        let capture = recording.capture(port(&path));
        capture.is_clean().await;
        let commands = capture.counts("enip.command", ["0x0065", "0x0070", "0x0066"]).await;
        assert_eq!(commands, [2, 6, 1], "one session, three requests and replies on a connection: {path}");
        let [large, classic, request, close] =
            capture.counts("cip.service", ["0x5b", "0x54", "0x0e", "0x4e"]).await;
        assert_eq!((large + classic, request, close), (1, 3, 1), "{path}");
        let frames = capture.packets("enip").await.len();
        assert_eq!(frames, capture.packets("tcp.len > 0").await.len(), "everything is dissected");
    }
}

#[tokio::test]
async fn the_built_in_device_is_recorded_with_made_up_addresses() {
    let recording = Recording::of("0,0", &[]).await;
    recording.has_messages(44_818, 1).await;
    let addresses = recording.capture(44_818).field("cip.service == 0x0e", "ip.dst").await;
    assert_eq!(addresses, ["192.0.2.2"]);
}

#[tokio::test]
async fn a_block_from_a_file_is_recorded_as_well() {
    let folder = TempDir::new().unwrap();
    let (block, file) = (folder.path().join("block.json"), file_in(folder.path()));
    std::fs::write(&block, block::product_name("0,0").to_string()).unwrap();
    let ended = cipdeck(&["run", block.to_str().unwrap(), "--pcap", file.to_str().unwrap()]).await;
    assert_eq!(ended.code, 0, "{ended:?}");
    Recording { ended, folder }.has_messages(44_818, 1).await;
}

#[tokio::test]
async fn requests_of_all_shapes_are_understood() {
    let simulator = Service::simulate("127.0.0.1:0", &[]).await;
    let address: SocketAddr = simulator.address.parse().unwrap();
    for arguments in [
        &["--service", "1", "--class", "1", "--instance", "1"][..],
        &["--service", "14", "--class", "0x93", "--instance", "3", "--attribute", "9"],
        &["--service", "14", "--class", "0x1234", "--instance", "0x56789", "--attribute", "0x300"],
        &[
            "--service",
            "14",
            "--class",
            "4",
            "--instance",
            "100",
            "--attribute",
            "3",
            "--member",
            "1",
            "--member",
            "300",
        ],
        &[
            "--service",
            "16",
            "--class",
            "4",
            "--instance",
            "150",
            "--attribute",
            "3",
            "--data",
            &"0a".repeat(32),
        ],
        &["--service", "0x4b", "--class", "0x64", "--instance", "0", "--data", "01"],
    ] {
        let recording = Recording::start(&fake_plc::path(address), arguments).await;
        let capture = recording.capture(address.port());
        capture.is_clean().await;
        assert_eq!(capture.packets("enip").await.len(), 5, "{arguments:?}");
    }
}

#[tokio::test]
async fn a_message_without_an_answer_is_recorded_too() {
    let plc = FakePlc::start(fake_plc::messages(|_| vec![])).await;
    let recording = Recording::of(&plc.path(), &["--timeout", "300"]).await;
    assert_eq!(recording.ended.code, 4, "{:?}", recording.ended);
    let capture = recording.capture(port(&plc.path()));
    capture.is_clean().await;
    assert_eq!(capture.field("enip", "enip.command").await, ["0x0065", "0x0065", "0x006f"]);
    assert_eq!(capture.packets("tcp.flags.fin == 1").await.len(), 2, "the socket is closed");
}

#[tokio::test]
async fn an_interrupted_command_leaves_a_whole_file() {
    let simulator = Service::simulate("127.0.0.1:0", &[]).await;
    let address: SocketAddr = simulator.address.parse().unwrap();
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("interrupted.pcapng");
    let path = fake_plc::path(address);
    let more = ["--repeat", "1000000", "--pcap", file.to_str().unwrap()];
    let arguments = [&["send", &path][..], &PRODUCT_NAME, &more].concat();
    let mut process = Process::start(&tools::cipdeck(), arguments);
    process.line("ten messages", PATIENCE, |line| line.trim().starts_with("10 ").then_some(())).await;
    process.interrupt();
    process.ended(PATIENCE).await;
    let capture = Capture { file, port: address.port() };
    capture.is_clean().await;
    assert!(capture.packets("enip").await.len() > 20);
    assert_eq!(
        capture.packets("tcp.flags.fin == 1").await.len(),
        2,
        "the end of the connection is in the file"
    );
}

#[tokio::test]
async fn a_file_that_cannot_be_written_stops_everything_before_it_begins() {
    let plc = FakePlc::start(fake_plc::answering(&[1])).await;
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("no such folder").join("a.pcapng");
    let path = plc.path();
    let arguments = [&["send", &path][..], &PRODUCT_NAME, &["--pcap", file.to_str().unwrap()]].concat();
    let ended = cipdeck(&arguments).await;
    assert_eq!((ended.code, ended.stdout.as_str()), (1, ""), "{ended:?}");
    assert!(ended.stderr.contains("a.pcapng cannot be written"), "{ended:?}");
    assert_eq!(plc.requests().len(), 0);
}

#[tokio::test]
async fn the_last_exchanges_of_a_block_can_be_downloaded() {
    let simulator = Service::simulate("127.0.0.1:0", &[]).await;
    let address: SocketAddr = simulator.address.parse().unwrap();
    let relay = Relay::start().await;
    let named = block::with(block::product_name(&fake_plc::path(address)), "/name", "line 4/reset");
    let id = relay.rest.create(&named).await;
    let folder = TempDir::new().unwrap();

    let empty = Download::of(&relay, &id, folder.path()).await;
    assert_eq!(empty.capture(44_818).packets("frame").await, Vec::<String>::new(), "nothing has been sent");
    for _ in 0..18 {
        relay.rest.run(&id).await;
    }
    let full = Download::of(&relay, &id, folder.path()).await;
    assert_eq!(full.content_type, "application/x-pcapng");
    assert_eq!(full.disposition, "attachment; filename=\"line-4-reset.pcapng\"");
    let capture = full.capture(address.port());
    capture.is_clean().await;
    assert_eq!(capture.packets("enip").await.len(), 32, "the last 16 of 18");
    assert_eq!(capture.packets("cip.service == 0x8e").await.len(), 16);
    assert_eq!(capture.packets("tcp.flags.syn == 1").await.len(), 2, "one connection");
    let times = capture.field("enip", "frame.time_epoch").await;
    assert!(times.is_sorted_by(|a, b| a <= b), "in the order in which they went: {times:?}");

    relay.rest.get("blocks/b99/exchange.pcapng").await.is_problem(404, "not_found");
}

#[tokio::test]
async fn the_download_of_the_built_in_device_and_of_one_that_says_nothing() {
    let relay = Relay::start().await;
    let folder = TempDir::new().unwrap();
    let id = relay.rest.create(&block::product_name("0,0")).await;
    relay.rest.run(&id).await;
    let download = Download::of(&relay, &id, folder.path()).await;
    let capture = download.capture(44_818);
    capture.is_clean().await;
    assert_eq!(capture.field("enip", "ip.src").await, ["192.0.2.1", "192.0.2.2"]);

    let plc = FakePlc::start(fake_plc::messages(|_| vec![])).await;
    let silent = block::with(block::product_name(&plc.path()), "/TargetCfg/UcmmTimeout", 250);
    let id = relay.rest.create(&silent).await;
    relay.rest.run(&id).await;
    let download = Download::of(&relay, &id, folder.path()).await;
    assert_eq!(download.capture(port(&plc.path())).packets("enip").await.len(), 1, "the request alone");
}

/// A `cipdeck send --pcap` that has ended.
struct Recording {
    ended: Ended,
    folder: TempDir,
}

impl Recording {
    /// Of reading the product name.
    async fn of(path: &str, more: &[&str]) -> Self {
        Self::start(path, &[&PRODUCT_NAME, more].concat()).await
    }

    async fn start(path: &str, arguments: &[&str]) -> Self {
        let folder = TempDir::new().expect("a temporary folder");
        let file = file_in(folder.path());
        let pcap = ["--pcap", file.to_str().expect("a path in UTF-8")];
        let ended = cipdeck(&[&["send", path], arguments, &pcap].concat()).await;
        Self { ended, folder }
    }

    fn file(&self) -> PathBuf {
        file_in(self.folder.path())
    }

    fn capture(&self, port: u16) -> Capture {
        Capture { file: self.file(), port }
    }

    /// A session, so many messages with their answers, and the farewell.
    async fn has_messages(&self, port: u16, messages: usize) {
        assert_eq!(self.ended.code, 0, "{:?}", self.ended);
        let capture = self.capture(port);
        capture.is_clean().await;
        assert_eq!(capture.packets("enip").await.len(), 2 + 2 * messages + 1);
        assert_eq!(capture.packets("cip.service == 0x8e && cip.genstat == 0").await.len(), messages);
    }
}

/// The download of a block's last exchanges.
struct Download {
    content_type: String,
    disposition: String,
    file: PathBuf,
}

impl Download {
    async fn of(relay: &Relay, id: &str, folder: &Path) -> Self {
        let request = relay.rest.request(Method::GET, &format!("blocks/{id}/exchange.pcapng"));
        let response = request.send().await.expect("the relay answers");
        assert_eq!(response.status(), 200);
        let header = |name: &str| {
            let value = response.headers().get(name).and_then(|value| value.to_str().ok());
            value.unwrap_or_default().to_owned()
        };
        let (content_type, disposition) = (header("content-type"), header("content-disposition"));
        let file = file_in(folder);
        std::fs::write(&file, response.bytes().await.expect("a body")).expect("a file");
        Self { content_type, disposition, file }
    }

    fn capture(&self, port: u16) -> Capture {
        Capture { file: self.file.clone(), port }
    }
}

fn file_in(folder: &Path) -> PathBuf {
    folder.join("capture.pcapng")
}

/// The port in a path like `4,127.0.0.1:44820`.
fn port(path: &str) -> u16 {
    path.rsplit(':').next().and_then(|port| port.parse().ok()).expect("a path with a port")
}

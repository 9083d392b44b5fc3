//! Wireshark's command line, the reader of captures that nobody here wrote.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::Stdio;
use std::time::SystemTime;

use cipdeck_relay::capture::{CaptureFile, Conversation, Direction, Ends};
use tempfile::TempDir;
use tokio::process::Command;

use crate::wait::within;
use crate::{PATIENCE, tools};

/// Where EtherNet/IP is at home.
pub const USUAL_PORT: u16 = 44_818;

/// What must not be found in a capture.
const FAULTS: &str =
    "_ws.malformed || tcp.analysis.flags || tcp.checksum.status == 0 || ip.checksum.status == 0";

/// A capture of frames to and from one TCP port.
#[derive(Clone, Debug)]
pub struct Capture {
    /// The file.
    pub file: PathBuf,
    /// The target's TCP port.
    pub port: u16,
}

impl Capture {
    /// The packets that a display filter finds, a line each.
    pub async fn packets(&self, filter: &str) -> Vec<String> {
        self.tshark(&["-Y", filter]).await
    }

    /// A field of the packets that a display filter finds.
    pub async fn field(&self, filter: &str, field: &str) -> Vec<String> {
        self.tshark(&["-Y", filter, "-T", "fields", "-e", field]).await
    }

    /// Asserts that tshark understands all of it: no packet is malformed, no sequence number or checksum is wrong.
    pub async fn is_clean(&self) {
        self.has_no_faults().await;
        if self.port != USUAL_PORT {
            self.at_usual_port().await.0.has_no_faults().await;
        }
    }

    /// The same payloads to and from port 44818: only there does tshark tell replies from requests, and look into the
    /// replies of each service. The folder keeps the file.
    pub async fn at_usual_port(&self) -> (Self, TempDir) {
        let fields = [
            "-Y",
            "tcp.len > 0",
            "-T",
            "fields",
            "-e",
            "tcp.stream",
            "-e",
            "tcp.dstport",
            "-e",
            "tcp.payload",
        ];
        let mut copy = CaptureFile::new(Vec::new()).expect("memory takes everything");
        let mut conversations = BTreeMap::new();
        for line in self.tshark(&fields).await {
            let [stream, to, payload] =
                line.split('\t').collect::<Vec<_>>().try_into().expect("three fields");
            let stream: u16 = stream.parse().expect("the number of a connection");
            let at = SystemTime::now();
            let conversation = conversations.entry(stream).or_insert_with(|| {
                let (local, peer) = ([10, 0, 0, 1], [10, 0, 0, 2]);
                let ends = Ends { local: (local, 50_000 + stream).into(), peer: (peer, USUAL_PORT).into() };
                let (conversation, packets) = Conversation::open(ends, at);
                copy.write(&packets).expect("memory takes everything");
                conversation
            });
            let direction = if to == self.port.to_string() { Direction::Out } else { Direction::In };
            let packets = conversation.data(direction, &bytes(payload), at);
            copy.write(&packets).expect("memory takes everything");
        }
        Self::stored(copy, USUAL_PORT)
    }

    /// A capture that was written into memory, on the disk as long as its folder is kept.
    pub fn stored(capture: CaptureFile<Vec<u8>>, port: u16) -> (Self, TempDir) {
        let folder = TempDir::new().expect("a temporary folder");
        let file = folder.path().join("stored.pcapng");
        std::fs::write(&file, capture.into_inner()).expect("a file");
        (Self { file, port }, folder)
    }

    /// How many packets have each of these values in a field.
    pub async fn counts<const N: usize>(&self, field: &str, values: [&str; N]) -> [usize; N] {
        let found = self.field(field, field).await;
        values.map(|value| found.iter().filter(|line| line.split(',').any(|one| one == value)).count())
    }

    async fn has_no_faults(&self) {
        let found = self.packets(FAULTS).await;
        assert!(found.is_empty(), "{found:#?}");
    }

    async fn tshark(&self, arguments: &[&str]) -> Vec<String> {
        let mut command = Command::new(tools::tshark());
        // Twice over the file, so that a reply is known by the request before it; nobody is asked for names.
        command.args(["-2", "-n", "-o", "tcp.check_checksum:TRUE", "-o", "ip.check_checksum:TRUE"]);
        command
            .arg("-r")
            .arg(&self.file)
            .args(["-d", &format!("tcp.port=={},enip", self.port)])
            .args(arguments);
        command.stdin(Stdio::null()).kill_on_drop(true);
        let output = within("tshark ends", PATIENCE, command.output()).await.expect("tshark starts");
        assert!(output.status.success(), "tshark cannot read {}: {output:?}", self.file.display());
        String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect()
    }
}

fn bytes(hex: &str) -> Vec<u8> {
    let digits: Vec<_> = hex.chars().filter_map(|digit| digit.to_digit(16)).collect();
    digits
        .chunks(2)
        .map(|pair| pair.iter().fold(0, |byte, digit| byte << 4 | u8::try_from(*digit).expect("a digit")))
        .collect()
}

//! Wireshark's command line, the reader of captures that nobody here wrote.

use std::path::PathBuf;
use std::process::Stdio;

use tokio::process::Command;

use crate::wait::within;
use crate::{PATIENCE, tools};

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
        for filter in
            ["_ws.malformed", "tcp.analysis.flags", "tcp.checksum.status == 0 || ip.checksum.status == 0"]
        {
            let found = self.packets(filter).await;
            assert!(found.is_empty(), "{filter}: {found:#?}");
        }
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

//! A relay as it is shipped: nobody may anything until somebody has set it up, and then it answers elsewhere, over TLS.

use tempfile::TempDir;

use crate::PATIENCE;
use crate::process::Process;
use crate::tools;

/// A running `cipdeck serve` that will be reachable from other machines.
#[derive(Debug)]
pub struct Shipped {
    /// Where it waits for the set-up, as `127.0.0.1:40123`.
    pub address: String,
    process: Process,
    _folder: TempDir,
}

impl Shipped {
    /// On a free port, with an empty folder.
    pub async fn start() -> Self {
        let folder = TempDir::new().expect("a temporary folder");
        let data = folder.path().to_str().expect("a path in UTF-8");
        let process = Process::start(&tools::cipdeck(), ["serve", "--listen", "0.0.0.0:0", "--data", data]);
        let address = |line: &str| Some(line.strip_prefix("cipdeck listens on http://")?.to_string());
        let address = process.line("where it listens", PATIENCE, address).await;
        Self { address, process, _folder: folder }
    }

    /// The code on its terminal.
    pub async fn code(&self) -> String {
        let code = |line: &str| Some(line.strip_prefix("set-up code: ")?.to_string());
        self.process.line("the set-up code", PATIENCE, code).await
    }

    /// Where it answers once it is set up, as seen from this machine.
    pub async fn secure(&self) -> String {
        let port = |line: &str| {
            let address = line.strip_prefix("cipdeck listens on https://")?;
            Some(address.rsplit_once(':')?.1.trim().to_string())
        };
        let port = self.process.line("where it listens over TLS", PATIENCE, port).await;
        format!("https://localhost:{port}")
    }

    /// The fingerprint of the certificate that it has made, as it prints it.
    pub async fn fingerprint(&self) -> String {
        let printed = |line: &str| Some(line.strip_prefix("certificate SHA-256 ")?.trim().to_string());
        self.process.line("the fingerprint", PATIENCE, printed).await
    }
}

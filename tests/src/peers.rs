//! Targets that nobody here wrote: the adapter of the crate `ciplink` and the server of the Python package `cpppo`.

use std::net::{Ipv4Addr, SocketAddr};

use ciplink::adapter::{Adapter, AdapterConfig, AdapterIdentity, Assembly};

use tokio::process::Command;

use crate::process::Process;
use crate::wait::within;
use crate::{PATIENCE, fake_plc, tools};

/// `ciplink`'s adapter in this process; it stops when it is dropped.
#[derive(Debug)]
pub struct CiplinkAdapter(Adapter);

impl CiplinkAdapter {
    /// What Identity 1/1/7 answers.
    pub const PRODUCT_NAME: &str = "Weighing station";
    /// What Identity 1/1/1 answers: Rockwell Automation.
    pub const VENDOR_ID: u16 = 1;

    /// On a free port.
    pub fn start() -> Self {
        Self::listen(0)
    }

    /// On a given port: the same target, started again.
    pub fn listen(port: u16) -> Self {
        let identity = AdapterIdentity {
            vendor_id: Self::VENDOR_ID,
            product_name: Self::PRODUCT_NAME.into(),
            ..AdapterIdentity::default()
        };
        let config = AdapterConfig {
            identity,
            assemblies: vec![Assembly::input(100, 32), Assembly::output(150, 32)],
            bind: Ipv4Addr::LOCALHOST,
            port,
            io_port: 0,
            ..AdapterConfig::default()
        };
        Self(Adapter::start(config).expect("ciplink's adapter listens"))
    }

    /// Where it listens.
    pub fn address(&self) -> SocketAddr {
        self.0.addr()
    }

    /// `TargetCfg.Path` of this target.
    pub fn path(&self) -> String {
        fake_plc::path(self.address())
    }

    /// Sets the data of the input assembly 4/100/3.
    pub fn set_input(&self, data: &[u8]) {
        self.0.set_input(100, data).expect("assembly 100 exists");
    }
}

/// `python -m cpppo.server.enip` with some tags, ended when it is dropped.
#[derive(Debug)]
pub struct Cpppo {
    address: SocketAddr,
    udp: SocketAddr,
    _process: Process,
}

impl Cpppo {
    /// What Identity 1/1/7 answers.
    pub const PRODUCT_NAME: &str = "1756-L61/B LOGIX5561";

    /// With the tag `T=DINT[10]`.
    pub async fn start() -> Self {
        Self::with_tags(&["T=DINT[10]"]).await
    }

    /// On a free port, which it prints once it listens.
    pub async fn with_tags(tags: &[&str]) -> Self {
        let arguments = [&["-m", "cpppo.server.enip", "-A", "-a", "127.0.0.1:0"], tags].concat();
        let process = Process::start(&tools::cpppo_python(), arguments);
        let port = process.line("cpppo prints its address", PATIENCE, tcp_port).await;
        let udp = process.line("cpppo prints its UDP address", PATIENCE, udp_port).await;
        let [address, udp] = [port, udp].map(|port| SocketAddr::from((Ipv4Addr::LOCALHOST, port)));
        Self { address, udp, _process: process }
    }

    /// `TargetCfg.Path` of this target.
    pub fn path(&self) -> String {
        fake_plc::path(self.address)
    }

    /// Where it answers to `ListIdentity` over UDP.
    pub fn udp(&self) -> SocketAddr {
        self.udp
    }
}

/// From `Network TCP Server address = ('127.0.0.1', 36149)`.
fn tcp_port(line: &str) -> Option<u16> {
    line.strip_prefix("Network TCP Server address = ('127.0.0.1', ")?.strip_suffix(')')?.parse().ok()
}

/// From `Network UDP Server address = ('127.0.0.1', 36150)`: a port of its own when any free one may be taken.
fn udp_port(line: &str) -> Option<u16> {
    line.strip_prefix("Network UDP Server address = ('127.0.0.1', ")?.strip_suffix(')')?.parse().ok()
}

/// What a client of the package `cpppo` prints: `python -m cpppo.server.enip.MODULE`.
pub async fn cpppo_client(module: &str, arguments: &[&str]) -> String {
    let mut command = Command::new(tools::cpppo_python());
    command.args(["-m", &format!("cpppo.server.enip.{module}")]).args(arguments).kill_on_drop(true);
    let output = within("cpppo's client ends", PATIENCE, command.output()).await.expect("Python starts");
    let said = [output.stdout, output.stderr].concat();
    String::from_utf8_lossy(&said).into_owned()
}

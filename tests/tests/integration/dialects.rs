//! What is exported runs: the pycomm3 script by a Python that nobody here wrote, the command line by a shell, the Rust
//! program by the compiler; and `cipdeck convert` gives the same request back.

use std::path::Path;
use std::process::Stdio;

use cipdeck_shared::code::{Dialect, Options, export};
use cipdeck_shared::config::MsgCipGeneric;
use cipdeck_tests::command::{Ended, Service, cipdeck, program};
use cipdeck_tests::peers::CiplinkAdapter;
use cipdeck_tests::wait::within;
use cipdeck_tests::{PATIENCE, tools};
use serde_json::Value;
use tokio::process::Command;

fn product_name(path: &str) -> MsgCipGeneric {
    let mut config = MsgCipGeneric::product_name(path);
    config.name = "what's it called?".into();
    config.target_cfg.ucmm_timeout = 5_000;
    config
}

fn connected(path: &str) -> MsgCipGeneric {
    let mut config = product_name(path);
    let target = &mut config.target_cfg;
    (target.cip_conn_mode, target.conn_msg_timeout, target.conn_close) = (1, 5_000, true);
    config
}

fn code(config: MsgCipGeneric, dialect: Dialect) -> String {
    let code = export(&config.into(), dialect, &Options::default());
    let losses: Vec<String> = code.losses().map(ToString::to_string).collect();
    assert_eq!(losses, [""; 0], "{dialect}");
    code.text
}

/// `4,127.0.0.1:12345`
fn path(address: &str) -> String {
    format!("4,{address}")
}

#[tokio::test]
async fn the_script_of_pycomm3_runs_against_the_simulator_and_ciplinks_adapter() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    let adapter = CiplinkAdapter::start();
    let name = simulated_name(&device).await;
    for (what, config, expected) in [
        ("direct", product_name(&path(&device.address)), name.as_slice()),
        ("connected", connected(&path(&device.address)), name.as_slice()),
        ("adapter, direct", product_name(&adapter.path()), CiplinkAdapter::PRODUCT_NAME.as_bytes()),
        ("adapter, connected", connected(&adapter.path()), CiplinkAdapter::PRODUCT_NAME.as_bytes()),
    ] {
        let ended = python(&code(config, Dialect::Pycomm3)).await;
        assert_eq!(ended.code, 0, "{what}: {ended:?}");
        let hex: Vec<_> = expected.iter().map(|byte| format!(" {byte:02x}")).collect();
        let hex = hex.concat();
        let line = format!("what's it called? {:02x}{hex}", expected.len());
        assert_eq!(ended.stdout.trim_end(), line, "{what}: {ended:?}");
    }
}

#[tokio::test]
async fn a_routed_script_of_pycomm3_goes_through_the_router() {
    let device = Service::simulate("127.0.0.1:0", &["--profile", "logix"]).await;
    let direct = send(&path(&device.address)).await;
    let routed = format!("{},1,0", path(&device.address));
    let ended = python(&code(product_name(&routed), Dialect::Pycomm3)).await;
    assert_eq!(ended.code, 0, "{ended:?}");
    let spaced: Vec<String> = direct.iter().map(|byte| format!("{byte:02x}")).collect();
    assert!(ended.stdout.trim_end().ends_with(&spaced.join(" ")), "{ended:?}");
}

#[tokio::test]
async fn a_script_that_would_send_something_else_ends_before_it_sends() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    let mut config = product_name(&path(&device.address));
    (config.app_cfg.member_cnt, config.app_cfg.member_id[0]) = (1, 1);
    let text = export(&config.into(), Dialect::Pycomm3, &Options::default()).text;
    let ended = python(&text).await;
    assert_eq!(ended.code, 1, "{ended:?}");
    assert!(
        ended.stderr.contains("does not send what the block says") && ended.stdout.is_empty(),
        "{ended:?}"
    );
}

#[tokio::test]
async fn the_command_line_runs_in_a_shell() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    let name = simulated_name(&device).await;
    for config in [product_name(&path(&device.address)), connected(&path(&device.address))] {
        let text = code(config, Dialect::Cli);
        // The program that was built here is the one that is found.
        let folder = tools::cipdeck().parent().expect("a folder").to_owned();
        let search = std::env::var_os("PATH").unwrap_or_default();
        let search = std::env::join_paths(std::iter::once(folder).chain(std::env::split_paths(&search)));
        let mut shell = Command::new("sh");
        shell
            .arg("-c")
            .arg(format!("{} --json", text.trim_end()))
            .env("PATH", search.expect("a search path"));
        let ended = run(shell, "the line").await;
        assert_eq!(ended.code, 0, "{text}{ended:?}");
        let data = ended.json()["ResData"].as_str().expect("data").to_owned();
        let hex: Vec<_> = name.iter().map(|byte| format!("{byte:02x}")).collect();
        let hex = hex.concat();
        assert_eq!(data, format!("{:02x}{hex}", name.len()), "{ended:?}");
    }
}

#[tokio::test]
async fn converting_there_and_back_keeps_the_request() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let file = |name: &str, text: &str| {
        let file = folder.path().join(name);
        std::fs::write(&file, text).expect("a file");
        file.to_str().expect("a path in UTF-8").to_owned()
    };
    let mut config = product_name("4,192.168.1.100");
    config.name = "speed".into();
    (config.app_cfg.service, config.app_cfg.class, config.app_cfg.instance, config.app_cfg.attribute) =
        (16, 0x93, 41, 9);
    config.req_data = "f401".into();
    let block = file("block.json", &code(config, Dialect::Json));
    let request = cipdeck(&["check", &block, "--json"]).await.json()["request"].clone();
    assert!(request.as_str().is_some_and(|request| request.starts_with("1003")), "{request}");
    for dialect in Dialect::ALL {
        let there = cipdeck(&["convert", &block, "--to", dialect.name()]).await;
        assert_eq!(there.code, 0, "{dialect}: {there:?}");
        let back = piped(&["convert", "-", "--to", "json"], &there.stdout).await;
        assert_eq!(back.code, 0, "{dialect}: {back:?}\n{}", there.stdout);
        let again = file(&format!("{dialect}.json"), &back.stdout);
        let checked: Value = cipdeck(&["check", &again, "--json"]).await.json();
        assert_eq!(checked["request"], request, "{dialect}: {}", there.stdout);
    }
}

/// Compiled with the tests: what is exported is what is in the file.
mod exported {
    #![allow(
        dead_code,
        unused_qualifications,
        clippy::all,
        clippy::pedantic,
        clippy::use_self,
        reason = "as an engineer gets it; compiling it is the test"
    )]

    mod direct {
        include!("../rust/direct.rs");
    }
    mod routed {
        include!("../rust/routed.rs");
    }
    mod over_a_connection {
        include!("../rust/connected.rs");
    }
}

#[test]
fn the_programs_of_rseip_are_those_that_compile() {
    let mut members = product_name("4,192.168.1.100");
    (members.app_cfg.member_cnt, members.app_cfg.member_id) = (2, vec![1, 300, 0]);
    members.req_data = "0a0b".into();
    let routed = product_name("4,plc-3.line:44820,1,3,2,192.168.1.55");
    for (name, config) in
        [("direct", members), ("routed", routed), ("connected", connected("4,192.168.1.100,1,0"))]
    {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/rust").join(format!("{name}.rs"));
        let text = code(config, Dialect::Rust);
        if std::env::var_os("CIPDECK_BLESS").is_some() {
            std::fs::write(&file, &text).expect("a file");
        }
        let kept = std::fs::read_to_string(&file).expect("a program");
        assert_eq!(text, kept, "{name}: CIPDECK_BLESS=1 writes the files again");
    }
}

/// What the simulator calls itself, without the length in front.
async fn simulated_name(device: &Service) -> Vec<u8> {
    send(&path(&device.address)).await.split_off(1)
}

/// The reply's data to a read of the product name.
async fn send(path: &str) -> Vec<u8> {
    let number = ["--service", "14", "--class", "1", "--instance", "1", "--attribute", "7"];
    let ended = cipdeck(&[&["send", path, "--json"], &number[..]].concat()).await;
    let data = ended.json()["ResData"].as_str().unwrap_or_else(|| panic!("{ended:?}")).to_owned();
    cipdeck_shared::config::read_hex(&data).expect("bytes")
}

async fn python(script: &str) -> Ended {
    let folder = tempfile::TempDir::new().expect("a folder");
    let file = folder.path().join("exported.py");
    std::fs::write(&file, script).expect("a file");
    program(&tools::tags_python(), &[file.to_str().expect("a path in UTF-8")]).await
}

async fn piped(arguments: &[&str], input: &str) -> Ended {
    let folder = tempfile::TempDir::new().expect("a folder");
    let file = folder.path().join("input");
    std::fs::write(&file, input).expect("a file");
    let mut command = Command::new(tools::cipdeck());
    command.args(arguments).stdin(std::fs::File::open(&file).expect("the file"));
    run(command, "convert").await
}

async fn run(mut command: Command, what: &str) -> Ended {
    command.kill_on_drop(true).stdout(Stdio::piped()).stderr(Stdio::piped());
    let output = within(&format!("{what} ends"), PATIENCE, command.output()).await.expect("it starts");
    let [stdout, stderr] =
        [output.stdout, output.stderr].map(|said| String::from_utf8_lossy(&said).into_owned());
    Ended { code: output.status.code().expect("an exit code"), stdout, stderr }
}

//! The relay as a web server: who may call, what is answered, how it starts and stops.

#![expect(clippy::unwrap_used, reason = "a test ends where it fails")]

mod common;

use std::io::{BufRead, BufReader, Read};
use std::process::{Child, ChildStdout, Command, Stdio};

use cipdeck_relay::{RunError, Settings};
use tokio::net::TcpListener;

use self::common::{Relay, local, request};

fn problem(status: u16, code: &str) -> (u16, String) {
    (status, code.to_owned())
}

#[tokio::test]
async fn the_page_and_the_interface_are_served_under_a_strict_policy() {
    let relay = Relay::start(local(Settings::in_memory())).await;
    for path in ["/", "/monitor", "/api/v1/health"] {
        let reply = relay.ask("GET", path, "").await;
        assert_eq!(reply.status, 200, "{path}: {reply:?}");
        for header in [
            "content-security-policy: default-src 'none'; script-src 'self' 'wasm-unsafe-eval';",
            "x-content-type-options: nosniff",
            "referrer-policy: no-referrer",
        ] {
            assert!(reply.headers.contains(header), "{path}: {header} is missing in {}", reply.headers);
        }
    }
    let page = relay.ask("GET", "/", "").await;
    assert!(page.headers.contains("content-type: text/html"), "{page:?}");
    assert!(page.headers.contains("cache-control: no-cache"), "{page:?}");
    assert_eq!(relay.ask("GET", "/api/v1/health", "").await.json()["status"], "ok");
    relay.stop().await;
}

#[tokio::test]
async fn an_unknown_address_is_a_problem_not_a_page() {
    let relay = Relay::start(local(Settings::in_memory())).await;
    for (method, path) in [
        ("GET", "/api/v1/nothing"),
        ("GET", "/api/v2/health"),
        ("GET", "/api"),
        ("POST", "/api/v1/health"),
        ("GET", "/missing.js"),
        ("GET", "/../Cargo.toml"),
        ("POST", "/"),
    ] {
        assert_eq!(relay.ask(method, path, "").await.problem(), problem(404, "not_found"), "{method} {path}");
    }
    relay.stop().await;
}

#[tokio::test]
async fn a_foreign_host_or_origin_is_refused_everywhere() {
    let relay = Relay::start(local(Settings::in_memory())).await;
    let host = relay.address.to_string();
    for path in ["/", "/api/v1/health", "/api/v1/ws"] {
        for headers in [
            &[("Host", "rebound.example")][..],
            &[("Host", host.as_str()), ("Origin", "http://foreign.example")],
            &[("Host", host.as_str()), ("Origin", "null")],
        ] {
            let reply = request(relay.address, "GET", path, headers, "").await;
            assert_eq!(reply.problem(), problem(403, "not_permitted"), "{path} {headers:?}");
        }
    }
    let own = format!("http://{host}");
    let reply =
        request(relay.address, "GET", "/api/v1/health", &[("Host", &host), ("Origin", &own)], "").await;
    assert_eq!(reply.status, 200);
    relay.stop().await;
}

#[tokio::test]
async fn a_listener_for_everybody_is_refused() {
    let listener = TcpListener::bind("0.0.0.0:0").await.unwrap();
    let refused = cipdeck_relay::run(local(Settings::in_memory()), listener, std::future::pending()).await;
    assert!(matches!(refused, Err(RunError::NotLoopback(_))), "{refused:?}");
}

#[cfg(unix)]
#[test]
fn without_an_administrator_the_command_stays_where_others_cannot_reach_it() {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().to_str().unwrap();
    let (mut child, line, _) = start(&["serve", "--listen", "0.0.0.0:0", "--data", data]);
    assert!(line.starts_with("cipdeck listens on http://127.0.0.1:"), "{line}");
    assert!(folder.path().join("tls/cert.pem").exists(), "the certificate is made before it is needed");
    stop(&mut child);
}

/// Hashes of passwords and tokens are in the database, and the key of the certificate beside it.
#[cfg(unix)]
#[test]
fn nobody_else_on_the_machine_reads_the_data() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().join("new/data");
    let (mut child, _, _) = start(&["serve", "--listen", "0.0.0.0:0", "--data", data.to_str().unwrap()]);
    let mode = |path: &std::path::Path| std::fs::metadata(path).unwrap().permissions().mode() & 0o077;
    for file in ["cipdeck.sqlite", "cipdeck.sqlite-wal", "history.sqlite", "audit.jsonl", "tls/key.pem", "."]
    {
        assert_eq!(mode(&data.join(file)), 0, "{file}");
    }
    stop(&mut child);
}

/// Whoever comes through a tunnel comes from this machine.
#[test]
fn local_access_is_refused_where_others_could_come_through() {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().to_str().unwrap();
    for more in [["--listen", "0.0.0.0:0"], ["--allow-host", "gateway.example"]] {
        let arguments = [&["serve", "--local", "viewer", "--data", data], &more[..]].concat();
        let output = cipdeck(&arguments).output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(1) && stderr.contains("[local]"), "{more:?}: {stderr}");
    }
}

#[test]
fn an_unknown_key_in_the_configuration_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("cipdeck.toml");
    std::fs::write(&file, "listne = \"127.0.0.1:0\"").unwrap();
    let output = cipdeck(&["serve", "--config", file.to_str().unwrap()]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(stderr.contains("listne"), "{stderr}");
}

#[cfg(unix)]
#[test]
fn the_command_says_where_it_listens_and_how_to_set_it_up_and_stops_when_asked() {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().to_str().unwrap();
    let (mut child, line, mut stdout) = start(&["serve", "--listen", "127.0.0.1:0", "--data", data]);
    let address = line.trim().rsplit("http://").next().unwrap();
    assert!(std::net::TcpStream::connect(address).is_ok(), "{line}");
    stop(&mut child);
    let mut rest = String::new();
    stdout.read_to_string(&mut rest).unwrap();
    let code = rest.trim_end().strip_prefix("set-up code: ").expect("one more line");
    assert!(code.len() == 14 && !code.contains('\n'), "{rest}");
}

/// A running relay, and the first line that it prints.
#[cfg(unix)]
fn start(arguments: &[&str]) -> (Child, String, BufReader<ChildStdout>) {
    let mut child = cipdeck(arguments).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    let mut stdout = BufReader::new(child.stdout.take().unwrap());
    let mut line = String::new();
    stdout.read_line(&mut line).unwrap();
    (child, line, stdout)
}

#[cfg(unix)]
fn stop(child: &mut Child) {
    assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(0));
}

fn cipdeck(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cipdeck"));
    command.args(arguments);
    command
}

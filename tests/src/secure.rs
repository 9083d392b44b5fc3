//! The relay over TLS as `openssl s_client` sees it: a client that nobody here wrote.

use std::path::Path;
use std::process::Stdio;

use tokio::io::AsyncWriteExt as _;
use tokio::process::Command;

use crate::PATIENCE;
use crate::wait::within;

/// What came of a connection.
#[derive(Debug)]
pub struct Handshake {
    /// The handshake was completed.
    pub succeeded: bool,
    /// Everything that `openssl` has said: protocol, cipher, certificate, and the answer.
    pub said: String,
}

impl Handshake {
    /// SHA-256 of the relay's certificate.
    pub fn certificate(&self) -> &str {
        let begin = self.said.find("-----BEGIN CERTIFICATE-----").expect("a certificate");
        let end = self.said.find("-----END CERTIFICATE-----").expect("its end");
        &self.said[begin..end]
    }
}

/// Connects with more arguments, sends one request (nothing if it is empty), and reads until the end. `prefix` is a
/// command to run it with, such as `ip netns exec elsewhere`.
pub async fn connect(prefix: &[&str], address: &str, arguments: &[&str], request: &str) -> Handshake {
    let openssl = ["openssl", "s_client", "-connect", address, "-ign_eof"];
    let words = [prefix, &openssl, arguments].concat();
    let (program, rest) = words.split_first().expect("a program");
    let mut child = Command::new(program)
        .args(rest)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .kill_on_drop(true)
        .spawn()
        .unwrap_or_else(|error| {
            panic!("{program}: {error}; install it with `apt-get install openssl iproute2`")
        });
    let mut stdin = child.stdin.take().expect("a pipe");
    // A refused handshake closes the pipe.
    let _ = stdin.write_all(request.as_bytes()).await;
    if request.is_empty() {
        drop(stdin);
    }
    let output = within("openssl ends", PATIENCE, child.wait_with_output()).await.expect("openssl runs");
    let said = [output.stdout, output.stderr].concat();
    let said = String::from_utf8_lossy(&said).into_owned();
    Handshake { succeeded: said.contains("Verify return code") && !said.contains("Cipher is (NONE)"), said }
}

/// A request that asks for the end of the connection.
pub fn request(method: &str, path: &str, host: &str, body: &str) -> String {
    format!(
        "{method} /api/v1/{path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\nContent-Type: application/json\r\n\
         Content-Length: {}\r\n\r\n{body}",
        body.len()
    )
}

/// Makes a certificate for `localhost` and its key, as `cert.pem` and `key.pem`.
pub async fn make_certificate(folder: &Path, name: &str) {
    let (key, chain) = (folder.join("key.pem"), folder.join("cert.pem"));
    let status = Command::new("openssl")
        .args([
            "req",
            "-x509",
            "-newkey",
            "ec",
            "-pkeyopt",
            "ec_paramgen_curve:prime256v1",
            "-nodes",
            "-days",
            "7",
        ])
        .args(["-subj", &format!("/CN={name}"), "-addext", "subjectAltName=DNS:localhost"])
        .arg("-keyout")
        .arg(key)
        .arg("-out")
        .arg(chain)
        .stderr(Stdio::null())
        .status();
    let status = within("openssl makes a certificate", PATIENCE, status).await;
    assert!(status.expect("openssl is installed").success());
}

//! TLS as `openssl` sees it: which versions and ciphers are spoken, and how another certificate is taken up.

use std::fs;
use std::path::Path;
use std::time::Duration;

use cipdeck_tests::PATIENCE;
use cipdeck_tests::process::Process;
use cipdeck_tests::secure::{connect, make_certificate, request};
use cipdeck_tests::tools;
use cipdeck_tests::wait::eventually;
use tempfile::TempDir;

/// `cipdeck serve` with a configuration file; the address behind `https://`.
async fn serve(folder: &Path, configuration: &str) -> (Process, String) {
    let file = folder.join("cipdeck.toml");
    fs::write(&file, configuration).expect("a folder to write to");
    let (file, data) = (file.to_str().expect("UTF-8"), folder.join("data"));
    let arguments =
        ["serve", "--listen", "127.0.0.1:0", "--data", data.to_str().expect("UTF-8"), "--config", file];
    let process = Process::start(&tools::cipdeck(), arguments);
    let address = |line: &str| line.strip_prefix("cipdeck listens on https://").map(str::to_owned);
    let address = process.line("cipdeck says where it listens", PATIENCE, address).await;
    (process, address)
}

#[tokio::test]
async fn only_tls_1_3_is_spoken() {
    let folder = TempDir::new().unwrap();
    let (process, address) = serve(folder.path(), "[tls]").await;
    for version in ["-tls1", "-tls1_1", "-tls1_2"] {
        let refused = connect(&[], &address, &[version], "").await;
        assert!(!refused.succeeded, "{version}: {}", refused.said);
    }
    let ciphers = [
        ("TLS_AES_256_GCM_SHA384", true),
        ("TLS_AES_128_GCM_SHA256", true),
        ("TLS_CHACHA20_POLY1305_SHA256", true),
        ("TLS_AES_128_CCM_SHA256", false),
        ("TLS_AES_128_CCM_8_SHA256", false),
    ];
    let ask = request("GET", "health", &address, "");
    for (cipher, is_spoken) in ciphers {
        let handshake = connect(&[], &address, &["-tls1_3", "-ciphersuites", cipher], &ask).await;
        assert_eq!(handshake.succeeded, is_spoken, "{cipher}: {}", handshake.said);
        if is_spoken {
            let says = |text: &str| assert!(handshake.said.contains(text), "{text}: {}", handshake.said);
            says(cipher);
            says("TLSv1.3");
            says("HTTP/1.1 200 OK");
            says("Compression: NONE");
            says("Early data was not sent");
            // The key of the certificate, and that of the exchange.
            says("Server public key is 256 bit");
            says("X25519");
        }
    }
    // No version of HTTP that WebSockets would need another way for.
    let alpn = connect(&[], &address, &["-alpn", "h2,http/1.1"], &ask).await;
    assert!(alpn.said.contains("ALPN protocol: http/1.1"), "{}", alpn.said);
    let printed = process.line("the fingerprint", PATIENCE, |line| {
        line.strip_prefix("certificate SHA-256 ").map(str::to_owned)
    });
    let (printed, said) = (printed.await, alpn.said);
    let pem = folder.path().join("shown.pem");
    let end = said.find("-----END CERTIFICATE-----").unwrap();
    let begin = said.find("-----BEGIN CERTIFICATE-----").unwrap();
    fs::write(&pem, format!("{}-----END CERTIFICATE-----\n", &said[begin..end])).unwrap();
    let arguments = ["x509", "-noout", "-fingerprint", "-sha256", "-checkhost", "localhost", "-in"];
    let output = std::process::Command::new("openssl").args(arguments).arg(&pem).output().unwrap();
    let known = String::from_utf8(output.stdout).unwrap();
    assert!(known.contains(&printed), "{printed} is printed, {known} is served");
    assert!(known.contains("does match certificate"), "{known}");
}

#[tokio::test]
async fn another_certificate_is_taken_up_without_a_restart_and_a_broken_one_is_not() {
    let folder = TempDir::new().unwrap();
    make_certificate(folder.path(), "first").await;
    let path = |name: &str| folder.path().join(name).display().to_string();
    let configuration =
        format!("[tls]\ncert = {:?}\nkey = {:?}\nhsts = true", path("cert.pem"), path("key.pem"));
    let (process, address) = serve(folder.path(), &configuration).await;
    let ask = request("GET", "health", &address, "");
    let served = async || connect(&[], &address, &[], &ask).await;
    let first = served().await;
    assert!(first.said.contains("CN = first") || first.said.contains("CN=first"), "{}", first.said);
    assert!(
        first.said.to_lowercase().contains("strict-transport-security: max-age=31536000"),
        "{}",
        first.said
    );

    fs::write(folder.path().join("cert.pem"), "no certificate").unwrap();
    let complaint = |line: &str| line.contains("the old one stays").then_some(());
    process.line("the broken file is named in the log", PATIENCE, complaint).await;
    assert_eq!(served().await.certificate(), first.certificate());

    make_certificate(folder.path(), "second").await;
    let second = eventually("the new certificate is served", Duration::from_secs(10), async || {
        let handshake = served().await;
        (handshake.certificate() != first.certificate()).then_some(handshake)
    });
    let second = second.await;
    assert!(second.said.contains("CN = second") || second.said.contains("CN=second"), "{}", second.said);
    assert!(second.said.contains("HTTP/1.1 200 OK"));

    process.hang_up();
    let same = |line: &str| line.contains("the certificate is the same").then_some(());
    process.line("SIGHUP is heard", PATIENCE, same).await;
    let audit = fs::read_to_string(folder.path().join("data/audit.jsonl")).unwrap();
    assert_eq!(audit.matches("\"event\":\"certificate_reloaded\"").count(), 1, "{audit}");
}

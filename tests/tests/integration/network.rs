//! From another machine: what is heard of the relay before set-up and after it.

use std::path::Path;

use cipdeck_tests::PATIENCE;
use cipdeck_tests::command::{Ended, program};
use cipdeck_tests::managed::{PASSWORD, address, setup_code};
use cipdeck_tests::namespace::Network;
use cipdeck_tests::process::Process;
use cipdeck_tests::secure::{connect, request};
use cipdeck_tests::{block, tools};
use serde_json::{Value, json};
use tempfile::TempDir;

/// What `curl` cannot do: connect, and understand TLS as an answer in plain HTTP.
const REFUSED: i32 = 7;

async fn run(prefix: [&str; 4], arguments: &[&str]) -> Ended {
    program(Path::new(prefix[0]), &[&prefix[1..], arguments].concat()).await
}

async fn curl(prefix: [&str; 4], arguments: &[&str]) -> Ended {
    run(prefix, &[&["curl", "--silent", "--show-error", "--max-time", "10"], arguments].concat()).await
}

#[tokio::test]
async fn from_another_network_there_is_no_answer_before_set_up_and_tls_only_after_it() {
    let network = Network::make();
    let (here, elsewhere) = (network.at_relay(), network.elsewhere());
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let listen = format!("{}:8818", network.address());
    let cipdeck = tools::cipdeck();
    let (cipdeck, data) = (cipdeck.to_str().unwrap(), path("data"));
    let serve = [cipdeck, "serve", "--listen", &listen, "--data", &data];
    let process = Process::start(Path::new(here[0]), [&here[1..], &serve].concat());
    let plain = process.line("it listens on loopback", PATIENCE, address).await;
    let code = process.line("it prints the set-up code", PATIENCE, setup_code).await;
    assert_eq!(plain, "127.0.0.1:8818");

    // Before set-up: nobody answers who is asked from there; whoever is here is told where the relay will be.
    for scheme in ["http", "https"] {
        let nobody = curl(elsewhere, &[&format!("{scheme}://{listen}/api/v1/health")]).await;
        assert_eq!(nobody.code, REFUSED, "{nobody:?}");
    }
    let url = |path: &str| format!("http://{plain}/api/v1/{path}");
    let session = curl(here, &[&url("session")]).await.json();
    assert_eq!(
        (&session["state"], &session["moves_to"]),
        (&json!("set_up"), &json!(format!("https://{listen}/")))
    );
    let blocks = curl(here, &[&url("blocks")]).await.json();
    assert_eq!(blocks["code"], "signed_out", "{blocks}");
    let form = json!({ "code": code, "name": "root", "password": PASSWORD }).to_string();
    let json_body = ["--header", "Content-Type: application/json", "--data"];
    let set_up = curl(here, &[&json_body[..], &[&form, &url("setup")]].concat()).await.json();
    assert_eq!(set_up["caller"]["role"], "admin", "{set_up}");

    // After it, without a restart: TLS from there, and nothing on loopback any more.
    let secure = |line: &str| line.starts_with("cipdeck listens on https://").then(|| address(line))?;
    assert_eq!(process.line("it goes where others can reach it", PATIENCE, secure).await, listen);
    assert_eq!(curl(here, &[&url("health")]).await.code, REFUSED);
    let in_clear = curl(elsewhere, &[&format!("http://{listen}/api/v1/health")]).await;
    assert!(in_clear.code != 0 && in_clear.stdout.is_empty(), "plain HTTP gets no HTTP: {in_clear:?}");
    let health = request("GET", "health", &listen, "");
    for version in ["-tls1", "-tls1_1", "-tls1_2"] {
        let refused = connect(&elsewhere, &listen, &[version], &health).await;
        assert!(!refused.succeeded && !refused.said.contains("HTTP/1.1"), "{version}: {}", refused.said);
    }
    let handshake = connect(&elsewhere, &listen, &["-tls1_3"], &health).await;
    assert!(handshake.succeeded && handshake.said.contains("HTTP/1.1 200 OK"), "{}", handshake.said);
    let foreign = connect(&elsewhere, &listen, &[], &request("GET", "health", "rebound.example", "")).await;
    assert!(foreign.said.contains("HTTP/1.1 403"), "{}", foreign.said);

    // A person signs in from there, and is known by a cookie; a change takes the token that only our page has.
    let (certificate, jar) = (path("data/tls/cert.pem"), path("cookies"));
    let trusting = ["--cacert", &certificate, "--cookie", &jar, "--cookie-jar", &jar];
    let url = |path: &str| format!("https://{listen}/api/v1/{path}");
    let ask = async |more: &[&str], path: &str| {
        let ended = curl(elsewhere, &[&trusting[..], more, &[&url(path)]].concat()).await;
        assert_eq!(ended.code, 0, "{ended:?}");
        serde_json::from_str::<Value>(&ended.stdout).unwrap_or_default()
    };
    assert_eq!(ask(&[], "blocks").await["code"], "signed_out");
    let form = json!({ "name": "root", "password": PASSWORD }).to_string();
    let signed_in = ask(&[&json_body[..], &[&form]].concat(), "session").await;
    let csrf = format!("X-CSRF-Token: {}", signed_in["caller"]["csrf"].as_str().expect("a token"));
    let kept = std::fs::read_to_string(&jar).unwrap();
    assert!(kept.contains("#HttpOnly_") && kept.contains("__Host-cipdeck"), "{kept}");
    assert_eq!(ask(&[], "blocks").await, json!([]));
    let new = json!({ "name": "nightly", "role": "engineer", "days": 1 }).to_string();
    let refused = ask(&[&json_body[..], &[&new]].concat(), "tokens").await;
    assert_eq!((&refused["status"], &refused["code"]), (&json!(403), &json!("not_permitted")), "{refused}");
    let made = ask(&[&["--header", &csrf], &json_body[..], &[&new]].concat(), "tokens").await;
    let secret = made["secret"].as_str().expect("a token");

    // A script from there, which compares the fingerprint.
    let fingerprint = |line: &str| line.strip_prefix("certificate SHA-256 ").map(str::to_owned);
    let fingerprint = process.line("it prints its fingerprint", PATIENCE, fingerprint).await;
    std::fs::write(path("token"), secret).unwrap();
    std::fs::write(path("block.json"), block::product_name("0,0").to_string()).unwrap();
    let (relay, token, file) = (format!("https://{listen}"), path("token"), path("block.json"));
    let known = [cipdeck, "--relay", &relay, "--token-file", &token, "--fingerprint", &fingerprint];
    let ran = run(elsewhere, &[&known[..], &["run", &file]].concat()).await;
    assert_eq!(ran.code, 0, "{ran:?}");
    let unknown = [cipdeck, "--relay", &relay, "--token-file", &token, "run", &file];
    let refused = run(elsewhere, &unknown).await;
    assert!(refused.code == 4 && refused.stderr.contains("certificate"), "{refused:?}");
}

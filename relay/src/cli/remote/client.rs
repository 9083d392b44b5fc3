//! The relay's REST interface, as far as `run` needs it.

use std::io;
use std::path::Path;
use std::time::Duration;

use cipdeck_shared::api::{BlockStatus, ExchangeView, Problem, RunRequest, WriteRequest, WriteTicket};
use cipdeck_shared::config::{Block, BlockConfig};
use reqwest::{Method, RequestBuilder, Url, redirect};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{Remote, trust};
use crate::cli::Exit;

/// A message takes at most 10 s and its turn; a relay that says nothing for so long is not there.
const PATIENCE: Duration = Duration::from_mins(2);

/// To reach it.
const TO_CONNECT: Duration = Duration::from_secs(10);

/// Where a token may be.
const TOKEN: &str = "CIPDECK_TOKEN";

/// A relay that can be asked.
pub(super) struct Client {
    http: reqwest::Client,
    base: Url,
    token: Option<String>,
}

/// Why something was not done.
#[derive(Debug, thiserror::Error)]
pub(super) enum Failed {
    /// The relay has not answered, or not as one.
    #[error("{0}")]
    Relay(String),
    /// The relay has refused.
    #[error("the relay refuses ({}): {}", .0.title, .0.detail)]
    Refused(Box<Problem>),
}

impl Failed {
    /// The exit code of a command that ends with this.
    pub(super) fn exit(&self) -> Exit {
        if let Self::Refused(problem) = self
            && problem.findings.is_some()
        {
            return Exit::usage(self);
        }
        Exit::unanswered(self)
    }
}

impl Client {
    /// With what was given; nothing is asked yet.
    pub(super) fn new(remote: &Remote) -> Result<Self, String> {
        let url = remote.relay.as_deref().ok_or("--token-file and --fingerprint go with --relay URL")?;
        let base = address(url)?;
        let token = match &remote.token_file {
            Some(path) => Some(token(path)?),
            None => {
                std::env::var(TOKEN).ok().map(|text| text.trim().to_owned()).filter(|text| !text.is_empty())
            }
        };
        let fingerprint = remote.fingerprint.as_deref().map(trust::Fingerprint::read).transpose()?;
        let builder = reqwest::Client::builder()
            .user_agent(concat!("cipdeck/", env!("CARGO_PKG_VERSION")))
            .redirect(redirect::Policy::none())
            .no_proxy()
            .connect_timeout(TO_CONNECT)
            .timeout(PATIENCE);
        let http = trust::trusting(builder, fingerprint)?
            .build()
            .map_err(|error| format!("cannot make a client: {}", chain(&error)))?;
        Ok(Self { http, base, token })
    }

    /// Stores a block.
    pub(super) async fn create(&self, config: &BlockConfig) -> Result<Block, Failed> {
        self.json(self.with(Method::POST, "blocks", config)).await
    }

    /// Asks for a ticket for a write.
    pub(super) async fn offer(&self, block: &Block) -> Result<WriteTicket, Failed> {
        let request = WriteRequest { revision: block.revision };
        self.json(self.with(Method::POST, &format!("blocks/{}/write", block.id), &request)).await
    }

    /// Runs it once, to its end.
    pub(super) async fn run(&self, block: &Block, ticket: Option<String>) -> Result<BlockStatus, Failed> {
        self.json(self.with(Method::POST, &format!("blocks/{}/run", block.id), &RunRequest { ticket })).await
    }

    /// The reply of the last message, if one came.
    pub(super) async fn last_response(&self, block: &Block) -> Result<Option<String>, Failed> {
        let request = self.request(Method::GET, &format!("blocks/{}/exchange", block.id));
        let mut exchanges: Vec<ExchangeView> = self.json(request).await?;
        Ok(exchanges.pop().and_then(|exchange| exchange.response))
    }

    /// Forgets a block.
    pub(super) async fn delete(&self, block: &Block) -> Result<(), Failed> {
        let path = format!("blocks/{}?revision={}", block.id, block.revision);
        self.send(self.request(Method::DELETE, &path)).await.map(|_| ())
    }

    fn request(&self, method: Method, path: &str) -> RequestBuilder {
        let request = self.http.request(method, format!("{}api/v1/{path}", self.base));
        match &self.token {
            Some(token) => request.bearer_auth(token),
            None => request,
        }
    }

    fn with(&self, method: Method, path: &str, body: &(impl Serialize + Sync)) -> RequestBuilder {
        self.request(method, path).json(body)
    }

    async fn json<T: DeserializeOwned>(&self, request: RequestBuilder) -> Result<T, Failed> {
        let body = self.send(request).await?;
        serde_json::from_slice(&body).map_err(|error| {
            Failed::Relay(format!("{} does not answer as a relay of this version: {error}", self.base))
        })
    }

    async fn send(&self, request: RequestBuilder) -> Result<Vec<u8>, Failed> {
        let lost = |error: reqwest::Error| Failed::Relay(format!("{}: {}", self.base, chain(&error)));
        let response = request.send().await.map_err(lost)?;
        let status = response.status();
        let body = response.bytes().await.map_err(lost)?;
        if status.is_success() {
            return Ok(body.into());
        }
        Err(match serde_json::from_slice::<Problem>(&body) {
            Ok(problem) => Failed::Refused(Box::new(problem)),
            Err(_) => Failed::Relay(format!("{} answers {status}, and not as a relay", self.base)),
        })
    }
}

/// A token is sent there: it has to be the right place.
fn address(text: &str) -> Result<Url, String> {
    let mut url = Url::parse(text).map_err(|error| format!("--relay {text}: {error}"))?;
    let is_here = match url.host_str() {
        Some("localhost") => true,
        Some(host) => {
            let host = host.trim_matches(['[', ']']);
            host.parse::<std::net::IpAddr>().is_ok_and(|ip| ip.is_loopback())
        }
        None => false,
    };
    match url.scheme() {
        "https" if url.has_host() => {}
        "http" if is_here => {}
        "http" => return Err("plain http goes to this machine only: say https://".to_owned()),
        _ => return Err(format!("--relay {text}: say https://HOST:PORT")),
    }
    if !url.username().is_empty() || url.password().is_some() {
        return Err("--relay: no name and no password in the address; make an API token".to_owned());
    }
    url.set_path("/");
    url.set_query(None);
    url.set_fragment(None);
    Ok(url)
}

fn token(path: &Path) -> Result<String, String> {
    let unreadable = |error: io::Error| format!("cannot read {}: {error}", path.display());
    let text = std::fs::read_to_string(path).map_err(unreadable)?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = std::fs::metadata(path).map_err(unreadable)?.permissions().mode();
        if mode & 0o077 != 0 {
            eprintln!("warning: {} can be read by others: chmod 600", path.display());
        }
    }
    let token = text.trim();
    if token.is_empty() || !token.bytes().all(|byte| byte.is_ascii_graphic()) {
        return Err(format!("{} holds no token: it begins with cdt_", path.display()));
    }
    Ok(token.to_owned())
}

/// All that an error says, down to its cause. The address is said by the caller.
fn chain(error: &dyn std::error::Error) -> String {
    let mut texts = Vec::new();
    let mut next = Some(error);
    while let Some(error) = next {
        texts.push(error.to_string());
        next = error.source();
    }
    texts.dedup();
    texts.join(": ")
}

#[cfg(test)]
mod tests {
    use rustls::ServerConfig;
    use rustls::pki_types::PrivateKeyDer;
    use sha2::{Digest, Sha256};
    use tokio::io::{AsyncReadExt, AsyncWriteExt};
    use tokio::net::TcpListener;
    use tokio_rustls::TlsAcceptor;

    use super::*;

    /// Answers everything with a refusal, over TLS with a certificate of its own; its address and fingerprint.
    async fn refusing() -> (String, String) {
        let made = rcgen::generate_simple_self_signed(["other.example".to_owned()]).unwrap();
        let certificate = made.cert.der().clone();
        let digest = Sha256::digest(&certificate);
        let fingerprint = digest.iter().map(|byte| format!("{byte:02X}")).collect::<Vec<_>>().join(":");
        let key = PrivateKeyDer::try_from(made.signing_key.serialize_der()).unwrap();
        let provider = rustls::crypto::ring::default_provider();
        let config = ServerConfig::builder_with_provider(provider.into())
            .with_protocol_versions(&[&rustls::version::TLS13])
            .unwrap()
            .with_no_client_auth()
            .with_single_cert(vec![certificate], key)
            .unwrap();
        let acceptor = TlsAcceptor::from(std::sync::Arc::new(config));
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let address = listener.local_addr().unwrap();
        tokio::spawn(async move {
            while let Ok((socket, _)) = listener.accept().await {
                let Ok(mut stream) = acceptor.accept(socket).await else { continue };
                let _ = stream.read(&mut [0; 4096]).await;
                let body =
                    r#"{"title":"Signed out","status":401,"code":"signed_out","detail":"sign in first"}"#;
                let head =
                    format!("HTTP/1.1 401 x\r\nContent-Length: {}\r\nConnection: close\r\n\r\n", body.len());
                let _ = stream.write_all(format!("{head}{body}").as_bytes()).await;
                let _ = stream.shutdown().await;
            }
        });
        (format!("https://{address}"), fingerprint)
    }

    #[tokio::test]
    async fn only_the_certificate_with_the_fingerprint_gets_the_token() {
        let (url, fingerprint) = refusing().await;
        let (_, other) = refusing().await;
        let ask = async |fingerprint: Option<&String>| {
            let remote =
                Remote { relay: Some(url.clone()), token_file: None, fingerprint: fingerprint.cloned() };
            let client = Client::new(&remote).unwrap();
            client.send(client.request(Method::GET, "blocks")).await.unwrap_err()
        };
        let Failed::Refused(problem) = ask(Some(&fingerprint)).await else { panic!("it has answered") };
        assert_eq!(problem.status, 401);
        let Failed::Relay(why) = ask(Some(&other)).await else { panic!("not the same") };
        assert!(why.contains("another fingerprint") && why.contains(&fingerprint), "{why}");
        let Failed::Relay(why) = ask(None).await else { panic!("nobody vouches for it") };
        assert!(why.contains("certificate"), "{why}");
    }

    #[test]
    fn a_token_goes_over_tls_or_stays_on_this_machine() {
        for (text, expected) in [
            ("https://relay.plant.example:8818", "https://relay.plant.example:8818/"),
            ("https://192.0.2.17:8818/monitor?x#y", "https://192.0.2.17:8818/"),
            ("http://127.0.0.1:8818", "http://127.0.0.1:8818/"),
            ("http://localhost:8818/", "http://localhost:8818/"),
            ("http://[::1]:8818", "http://[::1]:8818/"),
        ] {
            assert_eq!(address(text).unwrap().as_str(), expected);
        }
        for text in [
            "http://relay.plant.example:8818",
            "http://127.0.0.1.example:8818",
            "http://192.168.1.1",
            "ftp://127.0.0.1",
            "127.0.0.1:8818",
            "relay",
            "https://anna:secret@relay.plant.example",
        ] {
            address(text).unwrap_err();
        }
    }
}

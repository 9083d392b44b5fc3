//! A client of the REST interface, written from its document.

use std::net::IpAddr;

use reqwest::header::{HeaderMap, HeaderName, HeaderValue};
use reqwest::{Client, ClientBuilder, Method, RequestBuilder};
use serde_json::Value;

/// A client of one relay.
#[derive(Clone, Debug)]
pub struct Rest {
    client: Client,
    base: String,
    headers: HeaderMap,
}

/// The HTTP client wants to know who computes, also where nothing is encrypted. The second call changes nothing.
pub fn install_tls() {
    let _ = rustls::crypto::ring::default_provider().install_default();
}

/// An answer.
#[derive(Clone, Debug)]
pub struct Reply {
    /// HTTP status.
    pub status: u16,
    /// Content type, or empty.
    pub content_type: String,
    /// JSON, or the text as a string.
    pub body: Value,
    /// All headers.
    pub headers: HeaderMap,
}

impl Rest {
    /// A client of the relay at an address like `127.0.0.1:8818`.
    pub fn new(address: impl std::fmt::Display) -> Self {
        Self::with(Client::builder(), format!("http://{address}"))
    }

    /// Over TLS, believing this certificate (PEM) and no other.
    pub fn over_tls(address: impl std::fmt::Display, certificate: &[u8]) -> Self {
        let certificate = reqwest::Certificate::from_pem(certificate).expect("a certificate");
        Self::with(Client::builder().tls_certs_only([certificate]), format!("https://{address}"))
    }

    /// From another address of this machine, such as `127.0.0.2`: to the relay that is another client.
    #[must_use]
    pub fn calling_from(&self, address: IpAddr) -> Self {
        let called = Self::with(Client::builder().local_address(address), self.base.clone());
        Self { headers: self.headers.clone(), ..called }
    }

    fn with(builder: ClientBuilder, base: String) -> Self {
        install_tls();
        let client = builder.no_proxy().build().expect("a client");
        Self { client, base, headers: HeaderMap::new() }
    }

    /// With one more header in every request.
    #[must_use]
    pub fn with_header(&self, name: &'static str, value: &str) -> Self {
        let mut called = self.clone();
        let value = HeaderValue::from_str(value).expect("a value of a header");
        called.headers.insert(HeaderName::from_static(name), value);
        called
    }

    /// With an API token.
    #[must_use]
    pub fn with_token(&self, token: &str) -> Self {
        self.with_header("authorization", &format!("Bearer {token}"))
    }

    /// Signs in, or sets up, and is that person from then on.
    pub async fn sign_in(&self, path: &str, form: &Value) -> Self {
        let reply = self.post(path, form).await;
        assert_eq!(reply.status, 200, "{path}: {reply:?}");
        let cookie = reply.cookie().expect("a cookie");
        let csrf = reply.body["caller"]["csrf"].as_str().expect("a CSRF token");
        self.with_header("cookie", &cookie).with_header("x-csrf-token", csrf)
    }

    /// The value of a header of every request; empty if there is none.
    pub fn header(&self, name: &str) -> &str {
        self.headers.get(name).and_then(|value| value.to_str().ok()).unwrap_or_default()
    }

    /// GET of a path below `/api/v1/`.
    pub async fn get(&self, path: &str) -> Reply {
        Self::send(self.request(Method::GET, path)).await
    }

    /// POST of JSON.
    pub async fn post(&self, path: &str, body: &Value) -> Reply {
        Self::send(json(self.request(Method::POST, path), body)).await
    }

    /// PUT of JSON.
    pub async fn put(&self, path: &str, body: &Value) -> Reply {
        Self::send(json(self.request(Method::PUT, path), body)).await
    }

    /// DELETE.
    pub async fn delete(&self, path: &str) -> Reply {
        Self::send(self.request(Method::DELETE, path)).await
    }

    /// A request of one's own making.
    pub fn request(&self, method: Method, path: &str) -> RequestBuilder {
        self.at(method, &format!("/api/v1/{path}"))
    }

    /// A request of one's own making, anywhere.
    pub fn at(&self, method: Method, path: &str) -> RequestBuilder {
        self.client.request(method, format!("{}{path}", self.base)).headers(self.headers.clone())
    }

    /// Sends a request and reads its answer.
    pub async fn send(request: RequestBuilder) -> Reply {
        let response = request.send().await.expect("the relay answers");
        let header = response.headers().get("content-type").and_then(|value| value.to_str().ok());
        let content_type = header.unwrap_or_default().to_string();
        let (status, headers) = (response.status().as_u16(), response.headers().clone());
        let text = response.text().await.expect("a body");
        let body = serde_json::from_str(&text).unwrap_or(Value::String(text));
        Reply { status, content_type, body, headers }
    }

    /// Stores a block; its id.
    pub async fn create(&self, block: &Value) -> String {
        let reply = self.post("blocks", block).await;
        assert!(matches!(reply.status, 200 | 201), "the block is stored: {reply:?}");
        reply.body["id"].as_str().expect("an id").to_string()
    }

    /// Opens a write window if there is none, and asks for the ticket of a write.
    pub async fn ticket(&self, id: &str, revision: u64) -> String {
        let opened = self.post("window", &serde_json::json!({})).await;
        assert!(matches!(opened.status, 200 | 409), "a write window: {opened:?}");
        let reply =
            self.post(&format!("blocks/{id}/write"), &serde_json::json!({ "revision": revision })).await;
        assert_eq!(reply.status, 200, "a ticket: {reply:?}");
        reply.body["ticket"].as_str().expect("a ticket").to_string()
    }

    /// Runs a block once; its status at DN or ER.
    pub async fn run(&self, id: &str) -> Value {
        let reply = self.post(&format!("blocks/{id}/run"), &serde_json::json!({})).await;
        assert_eq!(reply.status, 200, "the block ran: {reply:?}");
        reply.body
    }
}

impl Reply {
    /// The cookie that it sets, as `name=value`.
    pub fn cookie(&self) -> Option<String> {
        let text = self.headers.get("set-cookie")?.to_str().ok()?;
        Some(text.split(';').next()?.to_owned())
    }

    /// Asserts that this is a problem with a status and a code.
    pub fn is_problem(&self, status: u16, code: &str) {
        assert_eq!((self.status, self.body["code"].as_str()), (status, Some(code)), "{self:?}");
        assert_eq!(self.content_type, "application/problem+json", "{self:?}");
        assert_eq!(self.body["status"], status, "{self:?}");
    }
}

fn json(request: RequestBuilder, body: &Value) -> RequestBuilder {
    request.header("content-type", "application/json").body(body.to_string())
}

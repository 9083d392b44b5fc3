//! A relay that has been set up, with a person for each role, and two devices of which it may reach one.

use std::collections::HashMap;
use std::net::SocketAddr;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use cipdeck_shared::api::{NewAllowedWrite, Role};
use cipdeck_shared::sim::{Device, SimConfig};
use futures_util::{SinkExt, StreamExt};
use reqwest::{Client, Method};
use serde_json::{Value, json};
use tempfile::TempDir;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{mpsc, oneshot};
use tokio::task::JoinHandle;
use tokio_tungstenite::tungstenite::Message;
use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use tokio_tungstenite::{MaybeTlsStream, WebSocketStream, connect_async};

use crate::permit::Gate;
use crate::runner::Clock;
use crate::settings::Settings;
use crate::{RunError, cli, simulate};

const PASSWORD: &str = "correct horse battery";

/// How long anything may take that does not wait for a timeout of the product.
pub(super) const PATIENCE: Duration = Duration::from_secs(20);

pub(super) struct Site {
    pub(super) address: SocketAddr,
    /// The device that may be reached.
    pub(super) device: SocketAddr,
    /// The one that may not.
    pub(super) other: SocketAddr,
    people: HashMap<Role, Person>,
    stop: oneshot::Sender<()>,
    running: JoinHandle<Result<(), RunError>>,
    _folder: TempDir,
}

/// Somebody who has signed in, or a program with a token.
#[derive(Clone)]
pub(super) struct Person {
    client: Client,
    address: SocketAddr,
    headers: Vec<(&'static str, String)>,
    /// What a program has in a file.
    token: Option<String>,
}

/// HTTP status and body.
pub(super) type Reply = (u16, Value);

impl Site {
    /// Starts everything; `gate` decides.
    pub(super) async fn start(gate: Gate) -> Self {
        // Somebody else may have chosen already.
        let _ = rustls::crypto::ring::default_provider().install_default();
        let (device, other) = (device().await, device().await);
        let folder = TempDir::new().unwrap();
        let mut settings = Settings::stored_in(folder.path()).allowing(format!("{device} via *"));
        settings.allow.write.push(NewAllowedWrite {
            target: device.to_string(),
            service: 16,
            class: 4,
            instance: Some(150),
            attribute: Some(3),
            note: String::new(),
        });
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let address = listener.local_addr().unwrap();
        let (stop, stopped) = oneshot::channel::<()>();
        let (told, mut code) = mpsc::channel(1);
        let running = tokio::spawn(crate::serve_with(
            settings,
            listener,
            async {
                let _ = stopped.await;
            },
            move |_, code| told.try_send(code.unwrap().to_owned()).unwrap(),
            gate,
        ));
        let code = code.recv().await.unwrap();
        let stranger = Person::new(address);
        let set_up = json!({ "code": code, "name": "admin", "password": PASSWORD });
        let admin = stranger.sign_in_at("setup", &set_up).await;
        let mut people = HashMap::from([(Role::Admin, admin.clone())]);
        for role in [Role::Viewer, Role::Operator, Role::Engineer] {
            people.insert(role, admin.hire(role.word(), role).await);
        }
        Self { address, device, other, people, stop, running, _folder: folder }
    }

    pub(super) fn person(&self, role: Role) -> &Person {
        &self.people[&role]
    }

    /// A program with a token of this role.
    pub(super) async fn program(&self, role: Role) -> Person {
        let new = json!({ "name": role.word(), "role": role, "days": 1 });
        let (status, body) = self.person(Role::Admin).ask("POST", "tokens", &new).await;
        assert_eq!(status, 201, "{body}");
        let token = body["secret"].as_str().unwrap().to_owned();
        let bearer = format!("Bearer {token}");
        Person { headers: vec![("authorization", bearer)], token: Some(token), ..Person::new(self.address) }
    }

    pub(super) async fn stop(self) {
        self.stop.send(()).unwrap();
        self.running.await.unwrap().unwrap();
    }
}

impl Person {
    pub(super) fn new(address: SocketAddr) -> Self {
        Self { client: Client::new(), address, headers: Vec::new(), token: None }
    }

    pub(super) async fn ask(&self, method: &str, path: &str, body: &Value) -> Reply {
        let response = self.send(method, path, body).await;
        let status = response.status().as_u16();
        let text = response.text().await.unwrap();
        (status, serde_json::from_str(&text).unwrap_or(Value::String(text)))
    }

    /// Somebody new, who has signed in.
    pub(super) async fn hire(&self, name: &str, role: Role) -> Self {
        let user = json!({ "name": name, "role": role, "password": PASSWORD });
        let (status, body) = self.ask("POST", "users", &user).await;
        assert_eq!(status, 201, "{body}");
        Self::new(self.address).sign_in(name).await
    }

    pub(super) async fn sign_in(&self, name: &str) -> Self {
        self.sign_in_at("session", &json!({ "name": name, "password": PASSWORD })).await
    }

    async fn sign_in_at(&self, path: &str, body: &Value) -> Self {
        let response = self.send("POST", path, body).await;
        let cookie = response.headers().get("set-cookie").map(|value| value.to_str().unwrap().to_owned());
        let text = response.text().await.unwrap();
        let session: Value = serde_json::from_str(&text).unwrap();
        let cookie = cookie.unwrap_or_else(|| panic!("{text}"));
        let cookie = cookie.split(';').next().unwrap().to_owned();
        let csrf = session["caller"]["csrf"].as_str().unwrap().to_owned();
        Self { headers: vec![("cookie", cookie), ("x-csrf-token", csrf)], ..self.clone() }
    }

    async fn send(&self, method: &str, path: &str, body: &Value) -> reqwest::Response {
        let url = format!("http://{}/api/v1/{path}", self.address);
        let mut request = self.client.request(Method::from_bytes(method.as_bytes()).unwrap(), url);
        for (name, value) in &self.headers {
            request = request.header(*name, value);
        }
        if !body.is_null() {
            request = request.header("content-type", "application/json").body(body.to_string());
        }
        request.send().await.unwrap()
    }

    /// Stores a block; its id.
    pub(super) async fn create(&self, block: &Value) -> String {
        let (status, body) = self.ask("POST", "blocks", block).await;
        assert_eq!(status, 201, "{body}");
        body["id"].as_str().unwrap().to_owned()
    }

    /// The ticket for a write, if there is one for this person.
    pub(super) async fn ticket(&self, block: &str) -> Option<String> {
        let (_, body) = self.ask("POST", &format!("blocks/{block}/write"), &json!({ "revision": 1 })).await;
        body["ticket"].as_str().map(str::to_owned)
    }

    /// Waits until the status of a block is as wanted.
    pub(super) async fn status_where(&self, block: &str, wanted: impl Fn(&Value) -> bool) -> Value {
        let look = async {
            loop {
                let (_, status) = self.ask("GET", &format!("blocks/{block}/status"), &Value::Null).await;
                if wanted(&status) {
                    break status;
                }
                tokio::task::yield_now().await;
            }
        };
        tokio::time::timeout(PATIENCE, look).await.expect("the status in time")
    }

    /// What the command line makes of a block with this person's token: its exit code. People have none.
    pub(super) async fn command_line(&self, block: &Value) -> Option<u8> {
        let folder = TempDir::new().unwrap();
        let file = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, text).unwrap();
            path.to_str().unwrap().to_owned()
        };
        let (token, block) = (file("token", self.token.as_ref()?), file("block.json", &block.to_string()));
        let relay = format!("http://{}", self.address);
        Some(cli::act(&["--relay", &relay, "--token-file", &token, "run", &block, "--json"]).await)
    }

    pub(super) async fn watch(&self) -> Viewer {
        let mut request = format!("ws://{}/api/v1/ws", self.address).into_client_request().unwrap();
        for (name, value) in &self.headers {
            request.headers_mut().insert(*name, value.parse().unwrap());
        }
        Viewer(connect_async(request).await.unwrap().0)
    }
}

/// A WebSocket.
pub(super) struct Viewer(WebSocketStream<MaybeTlsStream<TcpStream>>);

impl Viewer {
    /// Sends a command; its answer.
    pub(super) async fn command(&mut self, mut command: Value) -> Value {
        command["id"] = json!("c");
        self.0.send(Message::text(command.to_string())).await.unwrap();
        let answer = async {
            loop {
                let Some(Ok(Message::Text(text))) = self.0.next().await else { panic!("the end") };
                let message: Value = serde_json::from_str(&text).unwrap();
                if message["type"] == "answer" {
                    break message;
                }
            }
        };
        tokio::time::timeout(PATIENCE, answer).await.expect("an answer in time")
    }
}

async fn device() -> SocketAddr {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = listener.local_addr().unwrap();
    let device = Arc::new(Mutex::new(Device::new(SimConfig::default())));
    tokio::spawn(simulate::answer_tcp(listener, device, Clock::start()));
    address
}

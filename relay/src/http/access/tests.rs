//! What a browser, a program and a foreign page get when they call.

use std::net::SocketAddr;
use std::time::Duration;

use cipdeck_shared::api::{NewUser, Role};
use futures_util::StreamExt;
use reqwest::{Client, Method, RequestBuilder, redirect};
use serde_json::{Value, json};
use tempfile::TempDir;
use tokio::net::TcpListener;
use tokio::sync::oneshot;
use tokio_tungstenite::connect_async;
use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use tokio_tungstenite::tungstenite::{Error, Message};

use super::super::need::{NEEDS, Need};
use crate::access::Access;
use crate::actor::Actor;
use crate::audit::Audit;
use crate::settings::Settings;
use crate::store::Store;

const PASSWORD: &str = "correct horse battery";

/// A relay with the users `admin`, `engineer`, `operator` and `viewer`.
struct Relay {
    address: SocketAddr,
    client: Client,
    _stop: oneshot::Sender<()>,
    _folder: TempDir,
}

/// Somebody's browser.
#[derive(Clone)]
struct Browser<'a> {
    relay: &'a Relay,
    cookie: String,
    csrf: String,
}

struct Reply {
    status: u16,
    cookies: Vec<String>,
    location: String,
    retry_after: Option<u64>,
    body: Value,
}

impl Relay {
    async fn start() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let settings = Settings::stored_in(folder.path());
        let store = Store::open(settings.database().as_deref()).await.unwrap();
        let access = Access::open_cheaply(store.clone(), Audit::open(None).unwrap(), None).await;
        let actor = Actor::local(Role::Admin, "");
        for role in Role::ALL {
            let new = NewUser { name: role.word().to_owned(), role, password: PASSWORD.to_owned() };
            access.add_user(new, &actor).await.unwrap();
        }
        store.close().await;
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let address = listener.local_addr().unwrap();
        let (stop, stopped) = oneshot::channel();
        tokio::spawn(crate::run(settings, listener, async {
            let _ = stopped.await;
        }));
        // A second one changes nothing.
        let _ = rustls::crypto::ring::default_provider().install_default();
        let client = Client::builder().redirect(redirect::Policy::none()).build().unwrap();
        Self { address, client, _stop: stop, _folder: folder }
    }

    fn request(&self, method: &str, path: &str) -> RequestBuilder {
        let method = Method::from_bytes(method.as_bytes()).unwrap();
        self.client.request(method, format!("http://{}{path}", self.address))
    }

    fn api(&self, method: &str, path: &str) -> RequestBuilder {
        self.request(method, &format!("/api/v1/{path}"))
    }

    async fn sign_in(&self, name: &str) -> Browser<'_> {
        let form = json!({ "name": name, "password": PASSWORD });
        let reply = send(self.api("POST", "session").json(&form)).await;
        assert_eq!(reply.status, 200, "{}", reply.body);
        let cookie = reply.cookies[0].split(';').next().unwrap().to_owned();
        Browser { relay: self, cookie, csrf: text(&reply.body["caller"]["csrf"]) }
    }

    async fn watch(
        &self,
        header: &str,
        value: &str,
    ) -> Result<impl StreamExt<Item = Result<Message, Error>> + Unpin + use<>, Error> {
        let mut request = format!("ws://{}/api/v1/ws", self.address).into_client_request()?;
        let name = tokio_tungstenite::tungstenite::http::HeaderName::from_bytes(header.as_bytes()).unwrap();
        request.headers_mut().insert(name, value.parse().unwrap());
        Ok(connect_async(request).await?.0)
    }
}

impl Browser<'_> {
    fn request(&self, method: &str, path: &str) -> RequestBuilder {
        self.relay.api(method, path).header("cookie", &self.cookie).header("x-csrf-token", &self.csrf)
    }

    async fn send(&self, method: &str, path: &str, body: Value) -> Reply {
        send(self.request(method, path).json(&body)).await
    }

    async fn get(&self, path: &str) -> Reply {
        send(self.request("GET", path)).await
    }
}

async fn send(request: RequestBuilder) -> Reply {
    let response = request.send().await.unwrap();
    let all = |name: &str| {
        let values = response.headers().get_all(name).iter();
        values.map(|value| value.to_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    let (cookies, location) = (all("set-cookie"), all("location").concat());
    let retry_after = all("retry-after").first().map(|text| text.parse().unwrap());
    let status = response.status().as_u16();
    let body = response.text().await.unwrap();
    let body = serde_json::from_str(&body).unwrap_or(Value::String(body));
    Reply { status, cookies, location, retry_after, body }
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_else(|| panic!("a text: {value}")).to_owned()
}

async fn closed(socket: &mut (impl StreamExt<Item = Result<Message, Error>> + Unpin)) {
    let closed = async {
        while let Some(Ok(frame)) = socket.next().await {
            if frame.is_close() {
                break;
            }
        }
    };
    tokio::time::timeout(Duration::from_secs(1), closed).await.expect("closed within a second");
}

#[tokio::test]
async fn nobody_gets_anything_but_the_way_in() {
    let relay = Relay::start().await;
    for (method, route, need) in NEEDS {
        let path = route.replace("{id}", "1").replace("{name}", "viewer").replace("{secret}", "x");
        if *need != Need::Anyone {
            let reply = send(relay.request(method, &path)).await;
            assert_eq!((reply.status, &reply.body["code"]), (401, &json!("signed_out")), "{method} {path}");
        }
    }
    assert!(
        matches!(relay.watch("x-nothing", "x").await, Err(Error::Http(response)) if response.status() == 401)
    );
    let reply = send(relay.api("GET", "session")).await;
    assert_eq!(reply.body, json!({ "state": "signed_out" }));
    assert_eq!(send(relay.api("GET", "health")).await.status, 200);
    assert_eq!(send(relay.api("DELETE", "session")).await.status, 204);
    assert_eq!(send(relay.request("GET", "/")).await.status, 200, "the page");
    let set_up = json!({ "code": "0000-0000-0000", "name": "x", "password": PASSWORD });
    let reply = send(relay.api("POST", "setup").json(&set_up)).await;
    assert_eq!((reply.status, &reply.body["code"]), (409, &json!("conflict")));
}

#[tokio::test]
async fn a_session_is_a_sealed_cookie_and_a_token_that_only_our_page_knows() {
    let relay = Relay::start().await;
    let form = json!({ "name": "engineer", "password": PASSWORD });
    let reply = send(relay.api("POST", "session").json(&form)).await;
    let cookie = &reply.cookies[0];
    assert!(cookie.starts_with("__Host-cipdeck="), "{cookie}");
    for part in ["; HttpOnly", "; Secure", "; SameSite=Strict", "; Path=/"] {
        assert!(cookie.contains(part), "{cookie} lacks {part}");
    }
    assert!(!cookie.contains("Domain"), "{cookie}");
    let caller = &reply.body["caller"];
    assert_eq!((&reply.body["state"], &caller["role"]), (&json!("signed_in"), &json!("engineer")));
    assert_eq!((&caller["kind"], &caller["idle_minutes"]), (&json!("person"), &json!(15)));
    let engineer = relay.sign_in("engineer").await;
    let seen = engineer.get("session").await.body;
    assert_eq!(seen["caller"]["csrf"], json!(engineer.csrf));
    assert_eq!(engineer.send("POST", "session/active", json!({})).await.status, 204);
    // A foreign page sends the cookie at most.
    for csrf in [None, Some(""), Some("x"), Some(&engineer.csrf[1..])] {
        for (method, path) in
            [("POST", "session/active"), ("POST", "check"), ("DELETE", "session"), ("POST", "session")]
        {
            let mut request = relay.api(method, path).header("cookie", &engineer.cookie).json(&form);
            if let Some(csrf) = csrf {
                request = request.header("x-csrf-token", csrf);
            }
            let reply = send(request).await;
            assert_eq!(
                (reply.status, &reply.body["code"]),
                (403, &json!("not_permitted")),
                "{method} {path}"
            );
        }
    }
    let reply = engineer.send("DELETE", "session", json!({})).await;
    assert_eq!((reply.status, reply.cookies.len()), (204, 1));
    assert!(reply.cookies[0].starts_with("__Host-cipdeck=; ") && reply.cookies[0].contains("Max-Age=0"));
    assert_eq!(engineer.get("blocks").await.status, 401);
}

#[tokio::test]
async fn no_form_of_a_foreign_page_is_read() {
    let relay = Relay::start().await;
    let engineer = relay.sign_in("engineer").await;
    let body = json!({ "name": "engineer", "password": PASSWORD }).to_string();
    for content_type in
        ["text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x", ""]
    {
        for request in [relay.api("POST", "session"), engineer.request("POST", "check")] {
            let reply = send(request.header("content-type", content_type).body(body.clone())).await;
            assert_eq!((reply.status, &reply.body["code"]), (400, &json!("unreadable")), "{content_type}");
        }
    }
    for request in [relay.api("POST", "session"), relay.api("POST", "setup")] {
        assert_eq!(send(request.body(body.clone())).await.status, 400, "without a type");
    }
    let typed = relay.api("POST", "session").header("content-type", "application/json; charset=utf-8");
    assert_eq!(send(typed.body(body)).await.status, 200);
}

#[tokio::test]
async fn revoked_is_out_within_a_second() {
    let relay = Relay::start().await;
    let (admin, viewer) = (relay.sign_in("admin").await, relay.sign_in("viewer").await);
    let mut socket = relay.watch("cookie", &viewer.cookie).await.unwrap();
    assert!(socket.next().await.unwrap().unwrap().is_text());
    let sessions = admin.get("sessions").await.body;
    let of_viewer = sessions.as_array().unwrap().iter().find(|entry| entry["name"] == "viewer").unwrap();
    assert_eq!((&of_viewer["from"], &of_viewer["kind"]), (&json!("127.0.0.1"), &json!("person")));
    let path = format!("sessions/{}", of_viewer["id"]);
    assert_eq!(admin.send("DELETE", &path, json!({})).await.status, 204);
    closed(&mut socket).await;
    assert_eq!(viewer.get("blocks").await.status, 401);
    assert_eq!(admin.send("DELETE", &path, json!({})).await.status, 404);
}

#[tokio::test]
async fn an_administrator_keeps_users_and_nobody_else_does() {
    let relay = Relay::start().await;
    let admin = relay.sign_in("admin").await;
    let new = json!({ "name": "anna", "role": "viewer", "password": "a long password" });
    for role in ["viewer", "operator", "engineer"] {
        let reply = relay.sign_in(role).await.send("POST", "users", new.clone()).await;
        assert_eq!((reply.status, &reply.body["code"]), (403, &json!("not_permitted")), "{role}");
    }
    let reply = admin.send("POST", "users", new.clone()).await;
    assert_eq!((reply.status, &reply.body["role"]), (201, &json!("viewer")), "{}", reply.body);
    assert!(reply.body.get("password").is_none());
    assert_eq!(admin.send("POST", "users", new).await.status, 409);
    let change = json!({ "role": "operator", "password": PASSWORD });
    assert_eq!(admin.send("PATCH", "users/anna", change).await.body["role"], "operator");
    let anna = relay.sign_in("anna").await;
    let change = json!({ "old": PASSWORD, "new": "yet another password" });
    assert_eq!(anna.send("POST", "session/password", change).await.status, 204);
    assert_eq!(admin.send("DELETE", "users/anna", json!({})).await.status, 204);
    assert_eq!(anna.get("blocks").await.status, 401);
    let names: Vec<_> =
        admin.get("users").await.body.as_array().unwrap().iter().map(|user| text(&user["name"])).collect();
    assert_eq!(names, ["admin", "engineer", "operator", "viewer"]);
    for (method, body) in [("DELETE", json!({})), ("PATCH", json!({ "disabled": true }))] {
        let reply = admin.send(method, "users/admin", body).await;
        assert_eq!((reply.status, &reply.body["code"]), (409, &json!("conflict")));
        assert!(text(&reply.body["detail"]).contains("last administrator"), "{}", reply.body);
    }
    assert_eq!(admin.send("PATCH", "users/nobody", json!({})).await.status, 404);
}

#[tokio::test]
async fn a_token_needs_no_cookie_and_wins_over_one() {
    let relay = Relay::start().await;
    let admin = relay.sign_in("admin").await;
    let new = json!({ "name": "nightly", "role": "engineer", "scope": ["192.168.1.10"], "days": 30 });
    let made = admin.send("POST", "tokens", new).await;
    assert_eq!((made.status, &made.body["token"]["scope"]), (201, &json!(["192.168.1.10"])), "{}", made.body);
    let secret = text(&made.body["secret"]);
    let with = |method: &str, path: &str| relay.api(method, path).bearer_auth(&secret);
    assert_eq!(send(with("GET", "blocks")).await.status, 200);
    let caller = send(with("GET", "session").header("cookie", &admin.cookie)).await.body["caller"].clone();
    assert_eq!((&caller["name"], &caller["kind"]), (&json!("nightly"), &json!("token")));
    assert!(caller.get("csrf").is_none());
    // Neither more rights than its role, nor those that are a person's.
    for (method, path) in [
        ("GET", "users"),
        ("GET", "tokens"),
        ("POST", "window"),
        ("DELETE", "window"),
        ("POST", "session/password"),
    ] {
        let reply = send(with(method, path).header("cookie", &admin.cookie)).await;
        assert_eq!(reply.status, 403, "{method} {path}");
    }
    let mut socket = relay.watch("authorization", &format!("Bearer {secret}")).await.unwrap();
    assert!(socket.next().await.unwrap().unwrap().is_text());
    let listed = admin.get("tokens").await.body;
    assert!(!listed.to_string().contains(secret.rsplit_once('_').unwrap().1), "told once");
    let path = format!("tokens/{}", made.body["token"]["id"]);
    assert_eq!(admin.send("DELETE", &path.replace("tokens", "view-links"), json!({})).await.status, 404);
    assert_eq!(admin.send("DELETE", &path, json!({})).await.status, 204);
    closed(&mut socket).await;
    let reply = send(with("GET", "blocks").header("cookie", &admin.cookie)).await;
    assert_eq!((reply.status, &reply.body["code"]), (401, &json!("signed_out")));
    assert_eq!(send(relay.api("GET", "blocks").header("authorization", "Basic eDp5")).await.status, 401);
}

#[tokio::test]
async fn a_view_link_opens_the_monitor_and_nothing_else() {
    let relay = Relay::start().await;
    let admin = relay.sign_in("admin").await;
    let made = admin.send("POST", "view-links", json!({ "name": "hall 3", "hours": 24 })).await;
    assert_eq!(made.status, 201, "{}", made.body);
    let url = text(&made.body["url"]);
    let secret = url.strip_prefix(&format!("http://{}/view/", relay.address)).unwrap();
    assert!(text(&made.body["qr_svg"]).contains("<svg"));
    let opened = send(relay.request("GET", &format!("/view/{secret}"))).await;
    assert_eq!((opened.status, opened.location.as_str()), (303, "/monitor"));
    let cookie = &opened.cookies[0];
    assert!(cookie.starts_with("__Host-cipdeck-view=") && cookie.contains("Max-Age=86"), "{cookie}");
    let cookie = cookie.split(';').next().unwrap().to_owned();
    let seen = send(relay.api("GET", "session").header("cookie", &cookie)).await.body;
    assert_eq!((&seen["caller"]["kind"], &seen["caller"]["role"]), (&json!("view_link"), &json!("viewer")));
    let tablet = Browser { relay: &relay, cookie: cookie.clone(), csrf: text(&seen["caller"]["csrf"]) };
    assert_eq!(tablet.get("blocks").await.status, 200);
    for (method, path) in
        [("POST", "blocks"), ("POST", "discover"), ("GET", "audit"), ("DELETE", "window"), ("GET", "users")]
    {
        assert_eq!(send(tablet.request(method, path)).await.status, 403, "{method} {path}");
    }
    // A person signs in and out on the tablet, which goes on afterwards.
    let mut person = relay.sign_in("operator").await;
    person.cookie = format!("{cookie}; {}", person.cookie);
    assert_eq!(person.get("session").await.body["caller"]["name"], "operator");
    let out = person.send("DELETE", "session", json!({})).await;
    assert!(out.cookies.len() == 1 && out.cookies[0].starts_with("__Host-cipdeck=;"), "{:?}", out.cookies);
    assert_eq!(person.get("session").await.body["caller"]["kind"], "view_link");
    let mut socket = relay.watch("cookie", &cookie).await.unwrap();
    assert!(socket.next().await.unwrap().unwrap().is_text());
    let path = format!("view-links/{}", made.body["link"]["id"]);
    assert_eq!(admin.send("DELETE", &path, json!({})).await.status, 204);
    closed(&mut socket).await;
    assert_eq!(tablet.get("blocks").await.status, 401);
    let again = send(relay.request("GET", &format!("/view/{secret}"))).await;
    assert_eq!((again.status, again.cookies.len()), (401, 0));
    assert!(text(&again.body).contains("ask for a new one"), "{}", again.body);
}

#[tokio::test]
async fn guessing_is_slow() {
    let relay = Relay::start().await;
    let wrong = json!({ "name": "admin", "password": "wrong" });
    let reply = send(relay.api("POST", "session").json(&wrong)).await;
    assert_eq!((reply.status, &reply.body["code"]), (401, &json!("signed_out")));
    let reply = send(relay.api("POST", "session").json(&wrong)).await;
    assert_eq!((reply.status, &reply.body["code"]), (429, &json!("too_many")));
    assert_eq!(reply.retry_after, Some(1));
}

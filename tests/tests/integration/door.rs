//! Who may call the relay, and how much they may send.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::relay::Relay;
use cipdeck_tests::rest::Rest;
use reqwest::Method;
use tokio_tungstenite::connect_async;
use tokio_tungstenite::tungstenite::Error;
use tokio_tungstenite::tungstenite::client::IntoClientRequest as _;

#[tokio::test]
async fn a_page_from_elsewhere_is_refused() {
    let relay = Relay::start().await;
    for (header, value) in [
        ("origin", "https://example.com"),
        ("origin", "null"),
        ("host", "example.com"),
        ("host", "127.0.0.1:1"),
    ] {
        let reply = Rest::send(relay.rest.request(Method::GET, "health").header(header, value)).await;
        reply.is_problem(403, "not_permitted");
    }
}

#[tokio::test]
async fn the_own_page_and_programs_are_let_in() {
    let relay = Relay::start().await;
    assert_eq!(relay.rest.get("health").await.status, 200, "a program sends no Origin");
    for host in ["127.0.0.1", "localhost"] {
        let origin = format!("http://{host}:{}", relay.address.port());
        let reply = Rest::send(relay.rest.request(Method::GET, "health").header("origin", origin)).await;
        assert_eq!(reply.status, 200, "{reply:?}");
    }
}

#[tokio::test]
async fn a_websocket_from_elsewhere_is_refused() {
    let relay = Relay::start().await;
    let mut request = format!("ws://{}/api/v1/ws", relay.address).into_client_request().unwrap();
    request.headers_mut().insert("origin", "https://example.com".parse().unwrap());
    match connect_async(request).await {
        Err(Error::Http(response)) => assert_eq!(response.status(), 403),
        other => panic!("a foreign page got a WebSocket: {other:?}"),
    }
}

#[tokio::test]
async fn a_frame_over_64_kib_closes_with_1009_and_harms_nobody_else() {
    let relay = Relay::start().await;
    let mut other = relay.viewer().await;
    let mut viewer = relay.viewer().await;
    viewer.send_text("x".repeat(64 * 1024 + 1)).await;
    let frame = viewer.closed(PATIENCE).await.expect("a close frame");
    assert_eq!(u16::from(frame.code), 1009, "{frame:?}");
    let id = relay.rest.create(&cipdeck_tests::block::product_name("0,0")).await;
    let status = other.run(&id).await;
    assert_eq!(status["Q"], true, "{status}");
}

#[tokio::test]
async fn a_body_of_2_mb_is_too_large() {
    let relay = Relay::start().await;
    let body = format!("{{\"name\":\"{}\"}}", "x".repeat(2 * 1024 * 1024));
    let request =
        relay.rest.request(Method::POST, "blocks").header("content-type", "application/json").body(body);
    Rest::send(request).await.is_problem(413, "too_large");
    assert_eq!(relay.rest.get("health").await.status, 200, "the relay stays up");
}

#[tokio::test]
async fn text_that_is_no_command_is_answered_and_the_websocket_stays_open() {
    let relay = Relay::start().await;
    let mut viewer = relay.viewer().await;
    let answer = viewer.command(serde_json::json!({ "type": "fly", "block": "b1" })).await;
    assert_eq!(answer["problem"]["code"], "unreadable", "{answer}");
    let answer = viewer.command(serde_json::json!({ "type": "run", "block": "b99" })).await;
    assert_eq!(answer["problem"]["code"], "not_found", "{answer}");
}

#[tokio::test]
async fn the_page_loads_nothing_from_elsewhere() {
    let relay = Relay::start().await;
    let response = reqwest::get(relay.page()).await.unwrap();
    assert_eq!(response.status(), 200);
    let policy = response.headers()["content-security-policy"].to_str().unwrap().to_string();
    assert!(policy.contains("default-src 'none'") || policy.contains("default-src 'self'"), "{policy}");
    for forbidden in ["'unsafe-inline'", "'unsafe-eval'", "*", "http:", "https:"] {
        assert!(!policy.contains(forbidden), "{forbidden} in {policy}");
    }
    let page = response.text().await.unwrap();
    assert!(!page.contains("http://") && !page.contains("https://"), "{page}");
}

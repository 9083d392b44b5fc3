//! The relay does not answer any more, but its connections stay open, as if its cable were pulled.

use std::time::Duration;

use cipdeck_tests::PATIENCE;
use cipdeck_tests::browser::{Browser, Journey, part};
use cipdeck_tests::command::Service;
use tempfile::TempDir;

/// Three questions, 5 s apart, and some time to say so.
const LONG: Duration = Duration::from_secs(40);

#[tokio::test]
async fn every_live_page_notices_and_goes_on_by_itself() {
    let folder = TempDir::new().expect("a temporary folder");
    let relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let journey = Journey::start("silence").await;
    let mut users = Vec::new();
    for (who, path) in [("deck", ""), ("words", "words"), ("devices", "devices")] {
        let user = journey.open(who, &format!("http://{}/{path}", relay.address)).await;
        link(&user, "online", PATIENCE).await;
        users.push(user);
    }
    relay.process.freeze();
    for user in &mut users {
        link(user, "lost", LONG).await;
        user.shot("silent").await;
    }
    relay.process.thaw();
    for user in users {
        link(&user, "online", LONG).await;
        user.close_with_expected_errors().await;
    }
}

/// Waits until the page says so of its connection.
async fn link(user: &Browser, state: &str, limit: Duration) {
    let mark = format!("{}[@data-state='{state}']", part("connection"));
    user.find(&format!("a connection that is {state}"), &mark, limit).await;
}

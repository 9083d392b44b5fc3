//! The relay dies and comes back while the page is open.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block;
use cipdeck_tests::browser::Journey;
use cipdeck_tests::command::Service;
use cipdeck_tests::rest::Rest;
use tempfile::TempDir;

#[tokio::test]
async fn the_page_says_so_and_goes_on_by_itself() {
    let folder = TempDir::new().expect("a temporary folder");
    let relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let address = relay.address.clone();
    Rest::new(&address).create(&block::product_name("0,0")).await;
    let journey = Journey::start("reconnect").await;
    let mut user = journey.open("user", &format!("http://{address}/")).await;
    user.click("get-1-1-7").await;
    user.click("Run").await;
    user.see("cipdeck demo drive", PATIENCE).await;

    relay.process.kill();
    user.see("relay: reconnecting", PATIENCE).await;
    user.shot("reconnecting").await;
    drop(relay);
    let _relay = Service::serve(&address, folder.path()).await;
    user.see("relay: connected", PATIENCE).await;
    user.shot("connected").await;
    user.click("Run").await;
    user.see("cipdeck demo drive", PATIENCE).await;
    user.close_with_expected_errors().await;
}

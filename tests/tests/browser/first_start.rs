//! From nothing to a decoded reply.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::browser::{Journey, part};
use cipdeck_tests::measure::measured;
use cipdeck_tests::peers::CiplinkAdapter;
use cipdeck_tests::relay::Relay;

#[tokio::test]
async fn the_demo_device_names_itself_in_at_most_two_clicks() {
    let relay = Relay::start().await;
    let journey = Journey::start("first_start_demo").await;
    let mut user = journey.open("user", &relay.page()).await;
    user.find("the first start", &part("first-demo"), PATIENCE).await;
    user.shot("first-start").await;
    user.click_part("first-demo").await;
    user.see("cipdeck demo drive", PATIENCE).await;
    user.shot("product-name").await;
    measured(format!("first start -> demo device -> product name: {} clicks", user.clicks));
    assert!(user.clicks <= 2, "{} clicks", user.clicks);
    user.close().await;
}

#[tokio::test]
async fn an_address_is_all_that_a_device_needs() {
    let relay = Relay::start().await;
    let adapter = CiplinkAdapter::start();
    let journey = Journey::start("first_start_address").await;
    let mut user = journey.open("user", &relay.page()).await;
    user.see("connected", PATIENCE).await;
    user.fill_at(&part("first-address"), "address", &adapter.address().to_string()).await;
    user.shot("address").await;
    user.click_part("first-send").await;
    user.see(CiplinkAdapter::PRODUCT_NAME, PATIENCE).await;
    user.shot("product-name").await;
    measured(format!("first start -> address -> product name: {} click", user.clicks));
    assert!(user.clicks <= 2, "{} clicks", user.clicks);
    user.close().await;
}

#[tokio::test]
async fn the_demo_device_works_without_a_relay() {
    let relay = Relay::start().await;
    let journey = Journey::start("first_start_without_relay").await;
    let mut user = journey.open("user", &relay.page()).await;
    user.see("connected", PATIENCE).await;
    relay.stop().await;
    user.see("relay: reconnecting", PATIENCE).await;
    user.shot("no-relay").await;
    user.click_part("first-demo").await;
    user.see("cipdeck demo drive", PATIENCE).await;
    user.shot("product-name").await;
    user.close_with_expected_errors().await;
}

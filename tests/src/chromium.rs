//! How Chromium and chromedriver are started.

use tempfile::TempDir;
use thirtyfour::ChromeCapabilities;
use thirtyfour::common::capabilities::firefox::LoggingPrefsLogLevel;
use thirtyfour::prelude::*;

/// A browser with a profile of its own, which keeps a log. `trusting`: it takes any certificate, such as one that a relay
/// has made for itself.
pub(crate) fn capabilities(profile: &TempDir, trusting: bool) -> ChromeCapabilities {
    let mut capabilities = DesiredCapabilities::chrome();
    let profile = format!("--user-data-dir={}", profile.path().display());
    let trust = trusting.then_some("--ignore-certificate-errors");
    for argument in ARGUMENTS.into_iter().chain([profile.as_str()]).chain(trust) {
        capabilities.add_arg(argument).expect("an argument is text");
    }
    capabilities.set_browser_log_level(LoggingPrefsLogLevel::All).expect("a level is text");
    capabilities
}

/// Without a display, and without talking to anybody but the relay.
const ARGUMENTS: [&str; 11] = [
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--window-size=1440,1043",
];

/// From `ChromeDriver was started successfully on port 39731.`
pub(crate) fn port(line: &str) -> Option<u16> {
    line.strip_prefix("ChromeDriver was started successfully on port ")?.strip_suffix('.')?.parse().ok()
}

//! Journeys through the page in headless Chromium, over WebDriver. A journey finds things as a person does: by the
//! words on them.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::time::Duration;

use serde_json::Value;
use tempfile::TempDir;
use thirtyfour::prelude::*;
use thirtyfour::{Key, TypingData};
use tokio::sync::{Semaphore, SemaphorePermit};

use crate::chromium::{capabilities, port};
use crate::process::Process;
use crate::rest::install_tls;
use crate::wait::eventually;
use crate::{PATIENCE, tools};

/// One browser journey at a time: two would only slow each other down.
static TURN: Semaphore = Semaphore::const_new(1);

/// A journey: one chromedriver, any number of browsers, numbered screenshots.
#[derive(Debug)]
pub struct Journey {
    name: &'static str,
    folder: PathBuf,
    server: String,
    chromedriver: Process,
    _turn: SemaphorePermit<'static>,
}

impl Journey {
    /// Waits for its turn and starts a chromedriver. Screenshots go to a folder of the journey's name.
    pub async fn start(name: &'static str) -> Self {
        let turn = TURN.acquire().await.expect("never closed");
        let folder = tools::screenshots().join(name);
        let _ = std::fs::remove_dir_all(&folder); // those of an earlier run would mislead
        std::fs::create_dir_all(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        let chromedriver = Process::start(&tools::chromedriver(), ["--port=0"]);
        let port = chromedriver.line("chromedriver prints its port", PATIENCE, port).await;
        Self { name, folder, server: format!("http://127.0.0.1:{port}"), chromedriver, _turn: turn }
    }

    /// Opens a browser with a profile of its own at an address.
    pub async fn open(&self, who: &'static str, url: &str) -> Browser {
        self.open_browser(who, url, false).await
    }

    /// The same for a relay whose certificate nobody has signed.
    pub async fn open_trusting(&self, who: &'static str, url: &str) -> Browser {
        self.open_browser(who, url, true).await
    }

    async fn open_browser(&self, who: &'static str, url: &str, trusting: bool) -> Browser {
        let profile = TempDir::new().expect("a folder for the browser's profile");
        install_tls();
        let driver = WebDriver::new(self.server.as_str(), capabilities(&profile, trusting)).await;
        let driver = driver.unwrap_or_else(|error| {
            panic!("Chromium does not start: {error}\n{}", self.chromedriver.output().join("\n"))
        });
        let browser = Browser {
            journey: self.name,
            who,
            folder: self.folder.clone(),
            server: self.server.clone(),
            driver: Some(driver),
            shots: 0,
            clicks: 0,
            _profile: profile,
        };
        browser.go(url).await;
        browser
    }
}

/// One browser window.
#[derive(Debug)]
pub struct Browser {
    journey: &'static str,
    who: &'static str,
    folder: PathBuf,
    server: String,
    driver: Option<WebDriver>,
    shots: usize,
    /// How often the user has clicked.
    pub clicks: usize,
    _profile: TempDir,
}

impl Browser {
    /// Goes to an address, as if it was typed.
    pub async fn go(&self, url: &str) {
        self.driver().goto(url).await.unwrap_or_else(|error| panic!("{url}: {error}"));
    }

    /// Clicks the button, link, tab or switch with this name, once it can be clicked.
    pub async fn click(&mut self, name: &str) {
        self.click_at(&control(name), name).await;
    }

    /// Clicks what an XPath finds, once it can be clicked.
    pub async fn click_at(&mut self, xpath: &str, name: &str) {
        self.until(&format!("`{name}` can be clicked"), PATIENCE, async |driver| {
            let element = shown(driver, xpath).await?;
            if !element.is_enabled().await.ok()? {
                return None;
            }
            element.click().await.ok()
        })
        .await;
        self.clicks += 1;
    }

    /// Clicks the part that is marked for tests with `data-test`.
    pub async fn click_part(&mut self, mark: &str) {
        self.click_at(&part(mark), mark).await;
    }

    /// Replaces the text of the field with this label.
    pub async fn fill(&self, label: &str, text: &str) {
        self.fill_at(&field(label), label, text).await;
    }

    /// Replaces the text of the field that an XPath finds.
    pub async fn fill_at(&self, xpath: &str, name: &str, text: &str) {
        self.until(&format!("the field `{name}`"), PATIENCE, async |driver| {
            let element = shown(driver, xpath).await?;
            element.send_keys(Key::Control + "a").await.ok()?;
            let replacement = if text.is_empty() { Key::Delete.into() } else { TypingData::from(text) };
            element.send_keys(replacement).await.ok()
        })
        .await;
    }

    /// Gives the page another size, in px.
    pub async fn resize(&self, width: u32, height: u32) {
        let size =
            serde_json::json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        self.chromium("Emulation.setDeviceMetricsOverride", size).await;
    }

    /// Moves the pointer over what an XPath finds.
    pub async fn point_at(&self, xpath: &str) {
        self.until(&format!("{xpath} can be pointed at"), PATIENCE, async |driver| {
            let element = shown(driver, xpath).await?;
            driver.action_chain().move_to_element_center(&element).perform().await.ok()
        })
        .await;
    }

    /// Presses a key while what an XPath finds has the focus.
    pub async fn press(&self, xpath: &str, key: Key) {
        self.until(&format!("{xpath} takes a key"), PATIENCE, async |driver| {
            let element = shown(driver, xpath).await?;
            element.focus().await.ok()?;
            element.send_keys(key.clone()).await.ok()
        })
        .await;
    }

    /// Waits until an XPath finds nothing that is displayed.
    pub async fn gone(&self, what: &str, xpath: &str) {
        let what = format!("gone: {what}");
        self.until(&what, PATIENCE, async |driver| shown(driver, xpath).await.is_none().then_some(())).await;
    }

    /// Waits until the page shows this text.
    pub async fn see(&self, text: &str, limit: Duration) {
        self.until(&format!("the page shows `{text}`"), limit, async |driver| {
            text_of(driver).await.filter(|page| page.contains(text))
        })
        .await;
    }

    /// Waits until an XPath finds something that is displayed; its text.
    pub async fn find(&self, what: &str, xpath: &str, limit: Duration) -> String {
        self.until(what, limit, async |driver| shown(driver, xpath).await?.text().await.ok()).await
    }

    /// Whether the part that is marked for tests with `data-test` can be used.
    pub async fn can_use(&self, mark: &str) -> bool {
        let element = shown(self.driver(), &part(mark)).await;
        let Some(element) = element else { return false };
        element.is_enabled().await.unwrap_or(false)
    }

    /// Everything that the page shows.
    pub async fn text(&self) -> String {
        text_of(self.driver()).await.unwrap_or_default()
    }

    /// What a script returns.
    pub async fn script(&self, script: &str) -> Value {
        let result = self.driver().execute(script, Vec::new()).await;
        result.unwrap_or_else(|error| panic!("{script}: {error}")).json().clone()
    }

    /// A command of Chromium's own protocol.
    pub async fn chromium(&self, command: &str, parameters: Value) -> Value {
        let session = self.driver().session_id();
        let url = format!("{}/session/{session}/goog/cdp/execute", self.server);
        let body = serde_json::json!({ "cmd": command, "params": parameters }).to_string();
        let request = reqwest::Client::new().post(url).header("content-type", "application/json").body(body);
        let response = request.send().await.expect("chromedriver answers");
        let text = response.text().await.expect("a body");
        let mut answer: Value = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
        answer["value"].take()
    }

    /// Asks again and again until `probe` gives a value; keeps a screenshot and fails when `limit` has passed.
    pub async fn until<T>(
        &self,
        what: &str,
        limit: Duration,
        mut probe: impl AsyncFnMut(&WebDriver) -> Option<T>,
    ) -> T {
        let deadline = tokio::time::Instant::now() + limit;
        let probed = eventually(what, limit * 2, async || match probe(self.driver()).await {
            Some(value) => Some(Some(value)),
            None => (tokio::time::Instant::now() >= deadline).then_some(None),
        });
        match probed.await {
            Some(value) => value,
            None => self.fail(&format!("not within {limit:?}: {what}")).await,
        }
    }

    /// Keeps a screenshot of this stage of the journey.
    pub async fn shot(&mut self, stage: &str) {
        self.shots += 1;
        let name = format!("{:02}-{}-{stage}.png", self.shots, self.who);
        self.driver().screenshot(&self.folder.join(name)).await.expect("a screenshot");
    }

    /// Ends the browser; fails when the page has logged an error.
    pub async fn close(self) {
        let log = self.driver().browser_log().await.unwrap_or_default();
        let errors: Vec<_> = log.iter().filter(|entry| entry.level == "SEVERE").collect();
        assert!(errors.is_empty(), "the page has logged errors: {errors:#?}");
        self.close_with_expected_errors().await;
    }

    /// Ends the browser after a journey in which requests fail: the browser itself logs those.
    pub async fn close_with_expected_errors(mut self) {
        let driver = self.driver.take().expect("open until here");
        driver.quit().await.expect("Chromium ends");
    }

    /// The WebDriver session.
    pub fn driver(&self) -> &WebDriver {
        self.driver.as_ref().expect("open until it is closed")
    }

    async fn fail(&self, what: &str) -> ! {
        let mut report = format!("{} ({}): {what}", self.journey, self.who);
        let shot = self.folder.join(format!("failed-{}.png", self.who));
        if self.driver().screenshot(&shot).await.is_ok() {
            let _ = write!(report, "\nscreenshot: {}", shot.display());
        }
        let _ = write!(report, "\nthe page shows:\n{}", self.text().await);
        for entry in self.driver().browser_log().await.unwrap_or_default() {
            let _ = write!(report, "\n{}: {}", entry.level, entry.message);
        }
        panic!("{report}");
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // After a failure: chromedriver's process group is ended, so there is nothing to ask of it.
        if let Some(driver) = self.driver.take() {
            let _ = driver.leak();
        }
    }
}

/// XPath of a control by its name: its text or a part of it, or its label for those who listen.
pub fn control(name: &str) -> String {
    format!(
        "//*[self::button or self::a or self::summary or @role='button' or @role='tab' or @role='switch']\
         [normalize-space(.)='{name}' or @aria-label='{name}' or .//*[normalize-space(.)='{name}']]"
    )
}

/// XPath of the part of the page that is marked for tests with `data-test`.
pub fn part(mark: &str) -> String {
    format!("//*[@data-test='{mark}']")
}

/// XPath of a form field by its label.
pub fn field(label: &str) -> String {
    format!(
        "//*[self::input or self::textarea or self::select]\
         [@aria-label='{label}' or @id=//label[normalize-space(.)='{label}']/@for]"
    )
}

async fn shown(driver: &WebDriver, xpath: &str) -> Option<WebElement> {
    for element in driver.find_all(By::XPath(xpath)).await.ok()? {
        if element.is_displayed().await.unwrap_or(false) {
            return Some(element);
        }
    }
    None
}

async fn text_of(driver: &WebDriver) -> Option<String> {
    driver.find(By::Tag("body")).await.ok()?.text().await.ok()
}

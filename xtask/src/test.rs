//! `cargo xtask test`: everything that can be tested without a device, from the codec to the page in a browser.

use std::process::Command;

use anyhow::Result;

use crate::{
    frontend::{self, Profile},
    fuzz,
    process::{cargo, program, run},
    report::Report,
    toolchain::{self, Preference, WASM, WasmToolchain},
    tools::{self, TestTools},
    workspace,
};

/// Installs what is missing, builds, and runs all tests up to the first that fails.
pub(crate) fn all(report: &mut Report, preference: Preference, long: bool) -> Result<()> {
    let wasm = toolchain::find(report, preference)?;
    let tools = tools::for_tests(report, preference.consent)?;
    // The page comes first: the relay embeds it, and would otherwise be built twice.
    frontend::build(report, &wasm, Profile::Quick)?;
    report.step("tests: shared, relay, page (native)", || {
        run(cargo().args(["test", "-p", "cipdeck-shared", "-p", "cipdeck-relay", "-p", "cipdeck-frontend"]))
    })?;
    report.step("tests: xtask (native)", || run(cargo().args(["test", "-p", "xtask"])))?;
    report.step("tests: shared (wasm32, in the browser)", || shared_as_wasm(&wasm, &tools))?;
    report.step("tests: page (wasm-pack, in the browser)", || components(&wasm, &tools))?;
    report.step("relay: build cipdeck", || {
        // Together with the tests that start it: both then share one build of their dependencies.
        run(cargo().args(["build", "-p", "cipdeck-relay", "-p", "cipdeck-tests", "--bin", "cipdeck"]))
    })?;
    report.step("tests: integration, other implementations, browser journeys", || journeys(&tools, long))?;
    if long {
        fuzz::all(report, FUZZ_SECONDS)?;
    }
    Ok(())
}

/// The core's tests, in the engine that will run the page.
fn shared_as_wasm(wasm: &WasmToolchain, tools: &TestTools) -> Result<()> {
    let mut command = wasm.cargo();
    in_browser(&mut command, tools)?;
    let runner = "wasm-bindgen-test-runner";
    run(command
        .args(["test", "-p", "cipdeck-shared", "--tests", "--target", WASM, "--profile", PROFILE])
        .env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUNNER", runner)
        .env("WASM_BINDGEN_USE_BROWSER", "1"))
}

/// The tests of the page's components.
fn components(wasm: &WasmToolchain, tools: &TestTools) -> Result<()> {
    let mut command = program("wasm-pack");
    wasm.prepare(&mut command);
    in_browser(&mut command, tools)?;
    command.current_dir(workspace::root().join("frontend"));
    command.args(["test", "--headless", "--chrome", "--chromedriver"]).arg(&tools.chromedriver);
    run(command.args(["--mode", "no-install", "--", "--profile", PROFILE]))
}

/// Everything together: the relay as it is, targets that others wrote, and a browser.
fn journeys(tools: &TestTools, long: bool) -> Result<()> {
    let binary = format!("cipdeck{}", std::env::consts::EXE_SUFFIX);
    let mut command = cargo();
    if long {
        command.env("CIPDECK_RANDOM_INPUTS", RANDOM_INPUTS);
    }
    run(command
        .args(["test", "-p", "cipdeck-tests"])
        .env("CIPDECK_BIN", workspace::target().join("debug").join(binary))
        .env("CIPDECK_CHROMEDRIVER", &tools.chromedriver)
        .env("CIPDECK_CPPPO_PYTHON", &tools.cpppo_python)
        .env("CIPDECK_SCHEMATHESIS", &tools.schemathesis)
        .env("CIPDECK_TAGS_PYTHON", &tools.tags_python)
        .env("CIPDECK_TSHARK", &tools.tshark)
        .env("CIPDECK_SCREENSHOTS", workspace::target().join("screenshots")))
}

fn in_browser(command: &mut Command, tools: &TestTools) -> Result<()> {
    command
        .env("PATH", tools::path()?)
        .env("CHROMEDRIVER", &tools.chromedriver)
        .env("WASM_BINDGEN_TEST_WEBDRIVER_JSON", workspace::root().join("frontend").join("webdriver.json"))
        .env("WASM_BINDGEN_TEST_TIMEOUT", SECONDS_PER_TEST);
    Ok(())
}

/// The page's own profile, so that its dependencies are compiled once.
const PROFILE: &str = "page";

/// Sign-ins, tokens and WebSocket frames that nobody would send.
const RANDOM_INPUTS: &str = "1000000";

/// Of each target.
const FUZZ_SECONDS: u64 = 60;

const SECONDS_PER_TEST: &str = "120";

//! Programs of tests and checks: installed once into `target/tools`, never into the user's own folders.

use std::{
    env,
    ffi::OsString,
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result, bail};
use toml::Table;

use crate::{
    process::{cargo, find, program, read, run},
    report::Report,
    system::{self, Consent},
    workspace,
};

/// The browser and its driver, programs in Python, and the reader of captures.
#[derive(Debug)]
pub(crate) struct TestTools {
    /// The WebDriver of Chromium or Chrome.
    pub(crate) chromedriver: PathBuf,
    /// A Python that can import cpppo.
    pub(crate) cpppo_python: PathBuf,
    /// The program that asks an HTTP interface what its description promises.
    pub(crate) schemathesis: PathBuf,
    /// A Python that can import the clients of tags.
    pub(crate) tags_python: PathBuf,
    /// Wireshark's command line.
    pub(crate) tshark: PathBuf,
}

/// Finds what the tests need, and installs what is missing.
pub(crate) fn for_tests(report: &mut Report, consent: Consent) -> Result<TestTools> {
    report.step("tool: wasm-bindgen's test runner", || {
        // Without its lock file, which names a version that may be gone from the registry.
        install("wasm-bindgen-cli", &locked_version("wasm-bindgen")?, &[])
    })?;
    report.step("tool: wasm-pack", || install("wasm-pack", WASM_PACK, &["--locked"]))?;
    let chromedriver = report.step("tool: Chromium and its driver", || browser(consent))?;
    let cpppo_python =
        report.step("tool: cpppo, a target that is not ours", || python_with(consent, "cpppo", &[CPPPO]))?;
    let schemathesis = report.step("tool: schemathesis, a reader of OpenAPI that is not ours", || {
        let python = python_with(consent, "schemathesis", &[SCHEMATHESIS])?;
        Ok(python.with_file_name(format!("schemathesis{}", env::consts::EXE_SUFFIX)))
    })?;
    let tags_python = tag_clients(report, consent)?;
    let tshark = report.step("tool: tshark, a reader of captures that is not ours", || tshark(consent))?;
    report.step("tool: ip, openssl and curl, callers that are not ours", || callers(consent))?;
    Ok(TestTools { chromedriver, cpppo_python, schemathesis, tags_python, tshark })
}

/// A Python that can import the clients of tags.
pub(crate) fn tag_clients(report: &mut Report, consent: Consent) -> Result<PathBuf> {
    report.step("tool: pycomm3, pylogix and aphyt, clients that are not ours", || {
        python_with(consent, "tags", TAG_CLIENTS)
    })
}

/// Installs cargo-deny if it is missing.
pub(crate) fn cargo_deny() -> Result<()> {
    install("cargo-deny", CARGO_DENY, &["--locked"])
}

/// Installs cargo-fuzz if it is missing.
pub(crate) fn cargo_fuzz() -> Result<()> {
    install("cargo-fuzz", CARGO_FUZZ, &["--locked"])
}

/// The search path with `target/tools/bin` in front.
pub(crate) fn path() -> Result<OsString> {
    let present = env::var_os("PATH").unwrap_or_default();
    let all = std::iter::once(folder().join("bin")).chain(env::split_paths(&present));
    env::join_paths(all).context("a folder in PATH has a name that PATH cannot hold")
}

/// Installs a crate's programs in this version. Compiled without optimisation: they run for seconds, compile for minutes.
fn install(name: &str, version: &str, flags: &[&str]) -> Result<()> {
    let installed = read(cargo().args(["install", "--list", "--root"]).arg(folder()))?;
    if installed.lines().any(|line| line == format!("{name} v{version}:")) {
        println!("    {name} {version} is installed");
        return Ok(());
    }
    run(cargo()
        .args(["install", name, "--version", version, "--debug", "--root"])
        .arg(folder())
        .arg("--target-dir")
        .arg(folder().join("build"))
        .args(flags))
}

/// The driver on the PATH; on Debian it can be installed.
fn browser(consent: Consent) -> Result<PathBuf> {
    if let Some(named) = env::var_os("CIPDECK_CHROMEDRIVER") {
        return Ok(named.into());
    }
    if find("chromedriver").is_none() && system::is_debian() {
        system::install(consent, &["chromium", "chromium-driver"], "A browser for the tests")?;
    }
    let driver = find("chromedriver").context(
        "chromedriver is not on the PATH: install Chrome or Chromium and the chromedriver of the same version \
         (or name it in CIPDECK_CHROMEDRIVER)",
    )?;
    println!("    {}", read(program(&driver).arg("--version"))?);
    Ok(driver)
}

/// Wireshark's command line on the PATH; on Debian it can be installed.
fn tshark(consent: Consent) -> Result<PathBuf> {
    if let Some(named) = env::var_os("CIPDECK_TSHARK") {
        return Ok(named.into());
    }
    if find("tshark").is_none() && system::is_debian() {
        system::install(consent, &["tshark"], "A reader of captures for the tests")?;
    }
    let tshark = find("tshark").context(
        "tshark is not on the PATH: install Wireshark with its command line (or name it in CIPDECK_TSHARK)",
    )?;
    let version = read(program(&tshark).arg("--version"))?;
    println!("    {}", version.lines().next().unwrap_or_default());
    Ok(tshark)
}

/// What calls the relay from another network namespace, and over TLS.
fn callers(consent: Consent) -> Result<()> {
    for (tool, package) in [("ip", "iproute2"), ("openssl", "openssl"), ("curl", "curl")] {
        if find(tool).is_none() && system::is_debian() {
            system::install(consent, &[package], "A caller for the tests")?;
        }
        let found = find(tool).with_context(|| format!("{tool} is not on the PATH: install {package}"))?;
        println!("    {}", found.display());
    }
    Ok(())
}

/// A Python environment of our own that holds packages in these versions.
fn python_with(consent: Consent, name: &str, wanted: &[(&str, &str)]) -> Result<PathBuf> {
    let venv = folder().join(format!("{name}-venv"));
    let python =
        if cfg!(windows) { venv.join("Scripts").join("python.exe") } else { venv.join("bin").join("python") };
    let version = |package: &str| {
        let script = format!("from importlib.metadata import version; print(version({package:?}))");
        read(program(&python).args(["-c", &script]))
    };
    let is_there =
        |(package, wanted): &(&str, &str)| version(package).is_ok_and(|version| version == *wanted);
    if !wanted.iter().all(is_there) {
        if system::is_debian() {
            system::install(consent, &["python3", "python3-venv"], name)?;
        }
        run(program(system_python()?).args(["-m", "venv", "--clear"]).arg(&venv))?;
        run(program(&python)
            .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"])
            .args(wanted.iter().map(|(package, wanted)| format!("{package}=={wanted}"))))?;
    }
    for (package, wanted) in wanted {
        match version(package)? {
            version if version == *wanted => println!("    {package} {version}"),
            other => bail!("{package} {other} was installed instead of {wanted}"),
        }
    }
    Ok(python)
}

/// The system's Python where there is one: an environment made by it outlives the user's version managers.
fn system_python() -> Result<PathBuf> {
    let debian = Path::new("/usr/bin/python3");
    if debian.is_file() {
        return Ok(debian.to_owned());
    }
    find("python3")
        .or_else(|| find("python"))
        .context("Python 3 is not on the PATH; tools of the tests need it")
}

/// The version of a crate in Cargo.lock.
fn locked_version(name: &str) -> Result<String> {
    let lock: Table = fs::read_to_string(workspace::root().join("Cargo.lock"))?.parse()?;
    let packages = lock.get("package").and_then(toml::Value::as_array).into_iter().flatten();
    let found =
        packages.into_iter().find(|package| package.get("name").and_then(toml::Value::as_str) == Some(name));
    let version = found.and_then(|package| package.get("version")?.as_str());
    Ok(version.with_context(|| format!("Cargo.lock does not name {name}"))?.to_owned())
}

fn folder() -> PathBuf {
    workspace::target().join("tools")
}

const WASM_PACK: &str = "0.15.1";
const CARGO_DENY: &str = "0.20.2";
const CARGO_FUZZ: &str = "0.13.1";
const CPPPO: (&str, &str) = ("cpppo", "5.2.5");
const SCHEMATHESIS: (&str, &str) = ("schemathesis", "4.32.5");
const TAG_CLIENTS: &[(&str, &str)] = &[("pycomm3", "1.2.16"), ("pylogix", "1.1.6"), ("aphyt", "0.1.30")];

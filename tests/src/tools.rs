//! Where the tools of the tests are. `cargo xtask test` finds or installs them and names them in the environment.

use std::env;
use std::path::{Path, PathBuf};

/// The built `cipdeck`: `CIPDECK_BIN`, otherwise beside the tests in the target folder.
pub fn cipdeck() -> PathBuf {
    let beside = || {
        let exe = env::current_exe().ok()?;
        Some(exe.parent()?.parent()?.join("cipdeck"))
    };
    existing(named("CIPDECK_BIN").or_else(beside)).unwrap_or_else(|| {
        panic!("cipdeck is not built: run `cargo build -p cipdeck-relay`, or set CIPDECK_BIN; {HINT}")
    })
}

/// A Python that has the package cpppo: `CIPDECK_CPPPO_PYTHON`.
pub fn cpppo_python() -> PathBuf {
    existing(named("CIPDECK_CPPPO_PYTHON")).unwrap_or_else(|| {
        panic!(
            "cpppo is missing: run `python3 -m venv VENV && VENV/bin/pip install cpppo`, and set \
             CIPDECK_CPPPO_PYTHON=VENV/bin/python; {HINT}"
        )
    })
}

/// A Python that has the packages pycomm3, pylogix and aphyt: `CIPDECK_TAGS_PYTHON`.
pub fn tags_python() -> PathBuf {
    existing(named("CIPDECK_TAGS_PYTHON")).unwrap_or_else(|| {
        panic!(
            "pycomm3, pylogix and aphyt are missing: run `python3 -m venv VENV && VENV/bin/pip install pycomm3 pylogix \
             aphyt`, and set CIPDECK_TAGS_PYTHON=VENV/bin/python; {HINT}"
        )
    })
}

/// The program schemathesis: `CIPDECK_SCHEMATHESIS`, otherwise `schemathesis` in the search path.
pub fn schemathesis() -> PathBuf {
    existing(named("CIPDECK_SCHEMATHESIS").or_else(|| search("schemathesis"))).unwrap_or_else(|| {
        panic!(
            "schemathesis is missing: run `python3 -m venv VENV && VENV/bin/pip install schemathesis`, and set \
             CIPDECK_SCHEMATHESIS=VENV/bin/schemathesis; {HINT}"
        )
    })
}

/// The WebDriver of Chromium: `CIPDECK_CHROMEDRIVER`, otherwise `chromedriver` in the search path.
pub fn chromedriver() -> PathBuf {
    existing(named("CIPDECK_CHROMEDRIVER").or_else(|| search("chromedriver"))).unwrap_or_else(|| {
        panic!("chromedriver is missing: run `apt-get install chromium chromium-driver`, or set CIPDECK_CHROMEDRIVER; {HINT}")
    })
}

/// Wireshark's command line: `CIPDECK_TSHARK`, otherwise `tshark` in the search path.
pub fn tshark() -> PathBuf {
    existing(named("CIPDECK_TSHARK").or_else(|| search("tshark"))).unwrap_or_else(|| {
        panic!("tshark is missing: run `apt-get install tshark`, or set CIPDECK_TSHARK; {HINT}")
    })
}

/// Where screenshots are kept: `CIPDECK_SCREENSHOTS`, otherwise `target/screenshots`.
pub fn screenshots() -> PathBuf {
    named("CIPDECK_SCREENSHOTS")
        .unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/screenshots"))
}

const HINT: &str = "or run `cargo xtask test`, which does all of this";

fn named(variable: &str) -> Option<PathBuf> {
    env::var_os(variable).filter(|value| !value.is_empty()).map(PathBuf::from)
}

fn existing(path: Option<PathBuf>) -> Option<PathBuf> {
    path.filter(|path| path.exists())
}

fn search(name: &str) -> Option<PathBuf> {
    env::split_paths(&env::var_os("PATH")?).map(|folder| folder.join(name)).find(|path| path.is_file())
}

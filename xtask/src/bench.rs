//! `cargo xtask bench`: how fast our client is beside others. docs/PERFORMANCE.md says how it is measured.

use anyhow::Result;

use crate::{
    process::{cargo, run},
    report::Report,
    system::Consent,
    tools, workspace,
};

/// Builds the benchmarks as they are shipped and runs them; tables go to the terminal and to target/bench.
pub(crate) fn all(report: &mut Report, quick: bool, only: Option<String>, consent: Consent) -> Result<()> {
    let with_tags = only.as_deref().is_none_or(|only| "tags".contains(only));
    let python = if with_tags { Some(tools::tag_clients(report, consent)?) } else { None };
    let folder = workspace::target().join("bench");
    if only.as_deref().is_none_or(|only| "code".contains(only)) {
        report.step("bench: code", || {
            let mut command = cargo();
            command.args(["bench", "-p", "cipdeck-shared", "--bench", "code", "--", "--out"]).arg(&folder);
            if quick {
                command.arg("--quick");
            }
            run(&mut command)
        })?;
    }
    if only.as_deref() == Some("code") {
        return Ok(());
    }
    let bench = |name: &str| {
        let mut command = cargo();
        command.args(["bench", "-p", "cipdeck-tests", "--bench", name, "--"]);
        command
    };
    report.step("bench: build", || run(bench("speed").arg("--help").stdout(std::process::Stdio::null())))?;
    if only.is_none() {
        report.step("bench: allocations", || run(bench("allocations").arg("--out").arg(&folder)))?;
    }
    report.step("bench: speed", || {
        let mut command = bench("speed");
        command.arg("all").arg("--out").arg(&folder);
        if quick {
            command.arg("--quick");
        }
        if let Some(python) = python {
            command.env("CIPDECK_TAGS_PYTHON", python);
        }
        if let Some(only) = only {
            command.args(["--only", &only]);
        }
        run(&mut command)
    })
}

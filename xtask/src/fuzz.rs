//! Fuzzing: whatever bytes come, nothing panics and the rules hold. The targets are in fuzz/.

use std::{
    fs,
    io::Read as _,
    path::Path,
    process::{Command, Stdio},
};

use anyhow::{Context, Result, bail};

use crate::{
    process::{program, run},
    report::Report,
    tools, workspace,
};

/// In the order in which they run; each reads what the others do not.
const TARGETS: [&str; 7] = ["deframer", "reply", "epath", "effects", "target_path", "code_import", "client"];

/// Builds all targets and runs each for this long; says how often.
pub(crate) fn all(report: &mut Report, seconds: u64) -> Result<()> {
    report.step("tool: cargo-fuzz", tools::cargo_fuzz)?;
    report.step("fuzz: build", || run(cargo_fuzz("build")?.args(OPTIONS).arg(folder())))?;
    for target in TARGETS {
        let runs = report.step(&format!("fuzz: {target}, {seconds} s"), || one(target, seconds))?;
        report.say(&format!("fuzz: {target}: {runs} executions"));
    }
    Ok(())
}

fn one(target: &str, seconds: u64) -> Result<u64> {
    let corpus = folder().join("corpus").join(target);
    fs::create_dir_all(&corpus)?;
    if matches!(target, "deframer" | "reply") {
        sow(&corpus)?;
    }
    let artifacts = folder().join("artifacts").join(target);
    fs::create_dir_all(&artifacts)?;
    let mut command = cargo_fuzz("run")?;
    command.args(OPTIONS).arg(folder()).arg(target).arg(&corpus).arg("--");
    command.arg(format!("-max_total_time={seconds}"));
    command.arg(format!("-artifact_prefix={}/", artifacts.display())).arg("-print_final_stats=1");
    let mut child = command.stderr(Stdio::piped()).spawn().context("cannot start cargo fuzz")?;
    let mut said = String::new();
    child.stderr.take().context("its output")?.read_to_string(&mut said)?;
    if !child.wait()?.success() {
        // The end says what happened, and where the input is.
        let lines: Vec<_> = said.lines().collect();
        bail!("{}", lines.get(lines.len().saturating_sub(40)..).unwrap_or_default().join("\n"));
    }
    let runs = said.lines().find_map(|line| line.strip_prefix("stat::number_of_executed_units:"));
    runs.and_then(|text| text.trim().parse().ok()).context("the fuzzer does not say how often it ran")
}

/// No sanitizer: the product has no unsafe code, and without one the fuzzer is ten times as fast.
const OPTIONS: [&str; 3] = ["--sanitizer", "none", "--target-dir"];

fn cargo_fuzz(task: &str) -> Result<Command> {
    let mut command = program("cargo");
    // Its compiler flags are unstable; a stable compiler takes them so.
    command.env("PATH", tools::path()?).env("RUSTC_BOOTSTRAP", "1");
    command.args(["fuzz", task]);
    Ok(command)
}

/// The frames of the tests, as first inputs.
fn sow(corpus: &Path) -> Result<()> {
    let golden = workspace::root().join("shared").join("tests").join("golden");
    for entry in fs::read_dir(golden)? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "hex") {
            let file = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            for (name, bytes) in frames(&fs::read_to_string(&path)?) {
                fs::write(corpus.join(format!("{file}-{name}")), bytes)?;
            }
        }
    }
    Ok(())
}

/// `name =`, then lines of hexadecimal bytes, up to an empty line.
fn frames(text: &str) -> Vec<(String, Vec<u8>)> {
    let mut frames: Vec<(String, Vec<u8>)> = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        if let Some((name, _)) = line.split_once('=') {
            frames.push((name.trim().to_owned(), Vec::new()));
        } else if let Some((_, bytes)) = frames.last_mut() {
            bytes.extend(line.split_whitespace().filter_map(|byte| u8::from_str_radix(byte, 16).ok()));
        }
    }
    frames
}

fn folder() -> std::path::PathBuf {
    workspace::target().join("fuzz")
}

#[cfg(test)]
mod tests {
    use super::frames;

    #[test]
    fn frames_have_a_name_and_lines_of_bytes() {
        let text = "# A remark.\n\nfirst =\n    65 00\n    04\n\nsecond =\n    6f\n";
        assert_eq!(frames(text), [("first".to_owned(), vec![0x65, 0, 4]), ("second".to_owned(), vec![0x6F])]);
    }
}

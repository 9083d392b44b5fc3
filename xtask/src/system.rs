//! Packages of a Debian system. Never installed without a word: `--yes`, the variable `CI`, or a yes on the terminal.

use std::{
    env,
    io::{IsTerminal, Write},
};

use anyhow::{Result, bail};
use clap::Args;

use crate::process::{find, program, read, run};

/// Whether system packages may be installed.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(crate) struct Consent {
    /// Install system packages without asking (also when the variable CI is set).
    #[arg(long)]
    pub(crate) yes: bool,
}

/// Whether this is a Debian, or one of its children.
pub(crate) fn is_debian() -> bool {
    find("apt-get").is_some() && find("dpkg-query").is_some()
}

/// Those of the packages that are not installed.
pub(crate) fn missing<'a>(packages: &[&'a str]) -> Vec<&'a str> {
    let installed = |package: &str| {
        read(program("dpkg-query").args(["--show", "--showformat=${db:Status-Status}", package]))
            .is_ok_and(|status| status == "installed")
    };
    packages.iter().copied().filter(|package| !installed(package)).collect()
}

/// Installs the packages that are missing, for the reason given.
pub(crate) fn install(consent: Consent, packages: &[&str], reason: &str) -> Result<()> {
    let missing = missing(packages);
    if missing.is_empty() {
        return Ok(());
    }
    let command = format!("apt-get install -y --no-install-recommends {}", missing.join(" "));
    if !read(program("id").arg("-u")).is_ok_and(|user| user == "0") {
        bail!("{reason} needs packages that only root can install. As root: {command}");
    }
    if !consent.given(&missing.join(" "), reason)? {
        bail!("{reason} needs packages; nothing was installed. Say --yes, set CI=true, or run: {command}");
    }
    run(apt().arg("update"))?;
    run(apt().args(["install", "-y", "--no-install-recommends"]).args(missing))
}

impl Consent {
    fn given(self, packages: &str, reason: &str) -> Result<bool> {
        if self.yes || env::var("CI").is_ok_and(|value| !value.is_empty() && value != "false") {
            println!("    {reason} needs {packages}: installing with apt-get");
            return Ok(true);
        }
        if !std::io::stdin().is_terminal() {
            return Ok(false);
        }
        print!("    {reason} needs {packages}. Install with apt-get? [y/N] ");
        std::io::stdout().flush()?;
        let mut answer = String::new();
        std::io::stdin().read_line(&mut answer)?;
        Ok(matches!(answer.trim(), "y" | "Y" | "yes"))
    }
}

fn apt() -> std::process::Command {
    let mut command = program("apt-get");
    command.arg("--quiet").env("DEBIAN_FRONTEND", "noninteractive");
    command
}

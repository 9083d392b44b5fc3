//! The command line tool.

use std::path::Path;
use std::process::Stdio;

use serde_json::Value;
use tokio::process::Command;

use crate::process::Process;
use crate::wait::within;
use crate::{PATIENCE, tools};

/// How a command ended.
#[derive(Debug)]
pub struct Ended {
    /// Exit code.
    pub code: i32,
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
}

impl Ended {
    /// The one JSON document on standard output.
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{error}: {self:?}"))
    }
}

/// Runs `cipdeck` with arguments to its end.
pub async fn cipdeck(arguments: &[&str]) -> Ended {
    program(&tools::cipdeck(), arguments).await
}

/// Runs a program with arguments to its end.
pub async fn program(program: &Path, arguments: &[&str]) -> Ended {
    let name = program.display();
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null()).kill_on_drop(true);
    let output = within(&format!("{name} {} ends", arguments.join(" ")), PATIENCE, command.output()).await;
    let output = output.unwrap_or_else(|error| panic!("{name} does not start: {error}"));
    Ended {
        code: output.status.code().unwrap_or_else(|| panic!("an exit code: {output:?}")),
        stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
        stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

/// A running `cipdeck serve` or `cipdeck simulate`, and where it listens.
#[derive(Debug)]
pub struct Service {
    /// Address and port, from the line it prints.
    pub address: String,
    /// The process.
    pub process: Process,
}

impl Service {
    /// `cipdeck serve` for whoever is at this machine, with its data in `folder`; `listen` is `127.0.0.1:0` for a free port.
    pub async fn serve(listen: &str, folder: &Path) -> Self {
        Self::start(&serve(listen, folder)).await
    }

    /// [`Service::serve`], of a process that survives [`Process::limit_files`]: a file that is too big is an error to
    /// it, as a full disk is, and not its end.
    pub async fn serve_with_limits(listen: &str, folder: &Path) -> Self {
        let program = tools::cipdeck();
        let shell = ["-c", "trap '' XFSZ; exec \"$0\" \"$@\"", program.to_str().expect("a path in UTF-8")];
        Self::started(Process::start(Path::new("sh"), [&shell[..], &serve(listen, folder)].concat())).await
    }

    /// `cipdeck serve` of a project, with its other data in `data` or nowhere. As [`Service::serve_with_limits`].
    pub async fn serve_project(project: &Path, data: Option<&Path>) -> Self {
        let program = tools::cipdeck();
        let utf8 = |path: &Path| path.to_str().expect("a path in UTF-8").to_owned();
        let mut arguments =
            vec!["-c".to_owned(), "trap '' XFSZ; exec \"$0\" \"$@\"".to_owned(), utf8(&program)];
        arguments.extend(["serve", "--listen", "127.0.0.1:0", "--local", "engineer"].map(str::to_owned));
        arguments.extend(["--allow".to_owned(), LOOPBACK.to_owned(), "--project".to_owned(), utf8(project)]);
        arguments.extend(data.into_iter().flat_map(|data| ["--data".to_owned(), utf8(data)]));
        Self::started(Process::start(Path::new("sh"), arguments)).await
    }

    /// `cipdeck simulate` with more arguments.
    pub async fn simulate(listen: &str, more: &[&str]) -> Self {
        Self::start(&[&["simulate", "--listen", listen], more].concat()).await
    }

    async fn start(arguments: &[&str]) -> Self {
        Self::started(Process::start(&tools::cipdeck(), arguments)).await
    }

    async fn started(process: Process) -> Self {
        let address = process.line("cipdeck prints its address", PATIENCE, listening_at).await;
        Self { address, process }
    }
}

fn serve<'a>(listen: &'a str, folder: &'a Path) -> Vec<&'a str> {
    let folder = folder.to_str().expect("a path in UTF-8");
    vec!["serve", "--listen", listen, "--data", folder, "--local", "engineer", "--allow", LOOPBACK]
}

/// The address in a line like `cipdeck listens on http://127.0.0.1:8818`.
fn listening_at(line: &str) -> Option<String> {
    if !line.starts_with("cipdeck ") {
        return None; // the log has the address, too, before the relay answers
    }
    let rest = &line[line.find("127.")?..];
    let end = rest.find(|c: char| !(c.is_ascii_digit() || c == '.' || c == ':')).unwrap_or(rest.len());
    Some(rest[..end].to_string())
}

/// The devices of the tests.
pub const LOOPBACK: &str = "127.0.0.1:* via *";

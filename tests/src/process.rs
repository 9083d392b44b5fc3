//! Child processes: their output is always drained, and nothing of them outlives the test.

use std::ffi::OsStr;
use std::path::Path;
use std::process::{ExitStatus, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use rustix::process::{Pid, Resource, Rlimit, Signal, getrlimit, kill_process, kill_process_group, prlimit};
use tokio::io::{AsyncBufReadExt as _, AsyncRead, BufReader};
use tokio::process::{Child, Command};

use crate::wait::{eventually, within};

/// A running program in its own process group, which is killed on drop.
#[derive(Debug)]
pub struct Process {
    name: String,
    child: Child,
    group: Option<Pid>,
    lines: Lines,
}

/// What a process has said, standard output and standard error in the order of arrival.
type Lines = Arc<Mutex<Vec<String>>>;

impl Process {
    /// Starts `program` with `arguments`.
    pub fn start(program: &Path, arguments: impl IntoIterator<Item = impl AsRef<OsStr>>) -> Self {
        let name = program.display().to_string();
        let mut child = Command::new(program)
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .process_group(0)
            .kill_on_drop(true)
            .spawn()
            .unwrap_or_else(|error| panic!("{name} does not start: {error}"));
        let lines = Lines::default();
        drain(child.stdout.take(), &lines);
        drain(child.stderr.take(), &lines);
        let group = child.id().and_then(|id| i32::try_from(id).ok()).and_then(Pid::from_raw);
        Self { name, child, group, lines }
    }

    /// Waits for a line from which `parse` makes a value.
    pub async fn line<T>(&self, what: &str, limit: Duration, parse: impl Fn(&str) -> Option<T>) -> T {
        eventually(what, limit, async || self.output().iter().find_map(|line| parse(line))).await
    }

    /// Everything it has said so far.
    pub fn output(&self) -> Vec<String> {
        self.lines.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Asks it to stop, as Ctrl-C does.
    pub fn interrupt(&self) {
        self.signal(Signal::INT);
    }

    /// Asks it to read its files again, as `systemctl reload` does.
    pub fn hang_up(&self) {
        self.signal(Signal::HUP);
    }

    /// Ends it without asking, as `kill -9` and a power failure do.
    pub fn kill(&self) {
        self.signal(Signal::KILL);
    }

    /// Stops it where it is, with its connections open: to the others it looks as if its cable were pulled.
    pub fn freeze(&self) {
        self.signal(Signal::STOP);
    }

    /// Lets it go on after [`Self::freeze`].
    pub fn thaw(&self) {
        self.signal(Signal::CONT);
    }

    /// How much memory it has, in bytes.
    pub fn memory(&self) -> u64 {
        let pid = self.group.expect("it runs").as_raw_nonzero();
        let text = std::fs::read_to_string(format!("/proc/{pid}/status")).expect("it runs");
        let line = text.lines().find_map(|line| line.strip_prefix("VmRSS:")).expect("its memory");
        let kilobytes: u64 = line.trim_end_matches("kB").trim().parse().expect("a number");
        kilobytes * 1024
    }

    /// How big its files may become, in bytes; `None`: as big as it likes. Takes effect at once.
    pub fn limit_files(&self, bytes: Option<u64>) {
        let maximum = getrlimit(Resource::Fsize).maximum;
        if let (Some(_), Some(pid)) = (self.child.id(), self.group) {
            let limit = Rlimit { current: bytes.or(maximum), maximum };
            prlimit(Some(pid), Resource::Fsize, limit)
                .unwrap_or_else(|error| panic!("{}: {error}", self.name));
        }
    }

    /// Waits until it has ended.
    pub async fn ended(&mut self, limit: Duration) -> ExitStatus {
        let status = within(&format!("{} ends", self.name), limit, self.child.wait()).await;
        self.group = None; // the id may now belong to somebody else
        status.unwrap_or_else(|error| panic!("{}: {error}", self.name))
    }

    fn signal(&self, signal: Signal) {
        // The child is waited for by nobody else, so that its id still means this process.
        if let (Some(_), Some(pid)) = (self.child.id(), self.group) {
            kill_process(pid, signal).unwrap_or_else(|error| panic!("{}: {error}", self.name));
        }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        if std::thread::panicking() {
            eprintln!("--- {} said:\n{}", self.name, self.output().join("\n"));
        }
        // Its own children too: a browser has many.
        if let Some(group) = self.group {
            let _ = kill_process_group(group, Signal::KILL);
        }
    }
}

fn drain(stream: Option<impl AsyncRead + Unpin + Send + 'static>, lines: &Lines) {
    let Some(stream) = stream else { return };
    let lines = Arc::clone(lines);
    tokio::spawn(async move {
        let mut reader = BufReader::new(stream).lines();
        while let Ok(Some(line)) = reader.next_line().await {
            lines.lock().unwrap_or_else(PoisonError::into_inner).push(line);
        }
    });
}

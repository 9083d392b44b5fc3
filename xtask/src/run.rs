//! `cargo xtask run`: from a fresh clone to a page in the browser, with a simulated device beside it.

use std::{
    env, fs,
    io::ErrorKind,
    net::{SocketAddr, TcpListener, TcpStream},
    path::{Path, PathBuf},
    process::{Child, Command},
    sync::mpsc::{Receiver, RecvTimeoutError, channel},
    time::{Duration, Instant},
};

use anyhow::{Context, Result, bail};
use clap::Args;

use crate::{
    frontend::{self, Profile},
    process::{cargo, program, run},
    report::Report,
    toolchain::{self, Preference},
    workspace,
};

/// Where things listen.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct Addresses {
    /// Where the page is served.
    #[arg(long, default_value = "127.0.0.1:8818")]
    listen: SocketAddr,
    /// Where the simulated device listens.
    #[arg(long, default_value = "127.0.0.1:44818")]
    simulate: SocketAddr,
    /// Where the simulated controller with tags listens, an Omron NX.
    #[arg(long, default_value = "127.0.0.1:44819")]
    controller: SocketAddr,
}

/// Builds what is missing, starts the simulated devices and the relay, and waits for Ctrl-C.
pub(crate) fn all(report: &mut Report, preference: Preference, addresses: Addresses) -> Result<()> {
    let Addresses { listen, simulate, controller } = addresses;
    report.step("are the addresses free?", || {
        free(listen, "the page", "--listen")?;
        free(simulate, "the simulated device", "--simulate")?;
        free(controller, "the simulated controller", "--controller")
    })?;
    let wasm = toolchain::find(report, preference)?;
    frontend::build(report, &wasm, Profile::Quick)?;
    report.step("relay: build cipdeck", || {
        run(cargo().args(["build", "-p", "cipdeck-relay", "--bin", "cipdeck"]))
    })?;

    let stop = stop_signal()?;
    let data = workspace::target().join("run");
    let mut device = report.step("start the simulated device", || {
        Running::start(
            "cipdeck simulate",
            cipdeck().arg("simulate").args(["--listen", &simulate.to_string()]),
            simulate,
        )
    })?;
    let mut tags = report.step("start the simulated controller", || {
        let mut command = cipdeck();
        command.arg("simulate").args(["--profile", "omron", "--listen", &controller.to_string()]);
        Running::start("cipdeck simulate --profile omron", &mut command, controller)
    })?;
    let demo = report
        .step("lay down the demo configuration", || demo_configuration(&data, &[simulate, controller]))?;
    let mut relay = report.step("start the relay", || {
        let mut command = cipdeck();
        command.arg("serve").args(["--listen", &listen.to_string()]).arg("--data").arg(&data);
        command.arg("--config").arg(&demo);
        Running::start("cipdeck serve", &mut command, listen)
    })?;
    report.say(&format!("cipdeck is at     http://{listen}"));
    report.say(&format!("simulated device  {}   (as a block's Path)", block_path(simulate)));
    report.say(&format!("simulated Omron   {}   (under Devices; it lists its tags)", block_path(controller)));
    report.say(&format!("blocks are kept   in {}", data.display()));
    report.say(
        "demo              whoever is at this machine is an engineer, without signing in, and may reach the two",
    );
    report.say(&format!("                  simulated devices alone: {}", demo.display()));
    report.say("Ctrl-C stops all");
    wait(&stop, &mut [&mut relay, &mut device, &mut tags])?;
    report.step("stop the relay", || relay.stop())?;
    report.step("stop the simulated devices", || {
        device.stop()?;
        tags.stop()
    })
}

/// What a real relay denies until an administrator allows it: acting without signing in, and targets.
fn demo_configuration(data: &Path, devices: &[SocketAddr]) -> Result<PathBuf> {
    fs::create_dir_all(data).with_context(|| format!("cannot make {}", data.display()))?;
    let path = data.join("demo.toml");
    let allow = |device: &SocketAddr| {
        format!("\n[[allow.target]]\ntarget = \"{device} via *\"\nnote = \"demo: a simulated device\"\n")
    };
    let allowed: String = devices.iter().map(allow).collect();
    let text = format!(
        "# Written by cargo xtask run: for a trial on this machine, not for a plant.\n\n\
         [local]\nrole = \"engineer\"\n{allowed}"
    );
    fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))?;
    Ok(path)
}

/// A block's Path leaves the usual port out.
fn block_path(device: SocketAddr) -> String {
    match device.port() {
        44818 => format!("4,{}", device.ip()),
        port => format!("4,{}:{port}", device.ip()),
    }
}

/// Fails with a way out where the address is taken.
fn free(address: SocketAddr, what: &str, option: &str) -> Result<()> {
    match TcpListener::bind(address) {
        Ok(_) => Ok(()),
        Err(error) if error.kind() == ErrorKind::AddrInUse => bail!(
            "{address} is taken: another program listens where {what} should be (another cipdeck?). \
             Stop it, or choose another address: cargo xtask run {option} {}",
            SocketAddr::new(address.ip(), address.port().checked_add(1).unwrap_or(1024))
        ),
        Err(error) => Err(error).with_context(|| format!("{what} cannot listen on {address}; see {option}")),
    }
}

/// One of the processes that `run` started; ended when dropped.
struct Running {
    name: &'static str,
    child: Child,
    ended: bool,
}

impl Running {
    /// Starts a process and waits until its address answers.
    fn start(name: &'static str, command: &mut Command, address: SocketAddr) -> Result<Self> {
        apart(command);
        let child = command.spawn().with_context(|| format!("cannot start {name}"))?;
        let mut running = Self { name, child, ended: false };
        let deadline = Instant::now() + START;
        while TcpStream::connect_timeout(&address, POLL).is_err() {
            running.must_run()?;
            if Instant::now() > deadline {
                bail!("{name} does not answer on {address} after {} s", START.as_secs());
            }
            std::thread::sleep(POLL);
        }
        running.must_run()?;
        Ok(running)
    }

    /// Fails where the process has ended by itself.
    fn must_run(&mut self) -> Result<()> {
        if let Some(status) = self.child.try_wait()? {
            self.ended = true;
            bail!("{} ended by itself: {status}", self.name);
        }
        Ok(())
    }

    /// Asks the process to stop; ends it where it does not.
    fn stop(&mut self) -> Result<()> {
        ask_to_stop(&self.child);
        let deadline = Instant::now() + STOP;
        while Instant::now() < deadline {
            if self.child.try_wait()?.is_some() {
                self.ended = true;
                return Ok(());
            }
            std::thread::sleep(POLL);
        }
        println!("    {} did not stop within {} s: killed", self.name, STOP.as_secs());
        self.child.kill()?;
        self.child.wait()?;
        self.ended = true;
        Ok(())
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if !self.ended {
            // Only after a failure elsewhere, which is reported; this one has nothing to add.
            _ = self.stop();
        }
    }
}

/// Waits for the signal to stop; fails where a process ends before.
fn wait(stop: &Receiver<()>, processes: &mut [&mut Running]) -> Result<()> {
    loop {
        match stop.recv_timeout(POLL) {
            Ok(()) | Err(RecvTimeoutError::Disconnected) => return Ok(()),
            Err(RecvTimeoutError::Timeout) => {}
        }
        for process in &mut *processes {
            process.must_run()?;
        }
    }
}

/// Ctrl-C, or a request to end.
fn stop_signal() -> Result<Receiver<()>> {
    let (sender, receiver) = channel();
    ctrlc::set_handler(move || {
        // Nobody listens any more while the processes are being stopped already.
        _ = sender.send(());
    })
    .context("cannot watch for Ctrl-C")?;
    Ok(receiver)
}

fn cipdeck() -> Command {
    let name = format!("cipdeck{}", env::consts::EXE_SUFFIX);
    let path: PathBuf = workspace::target().join("debug").join(name);
    program(path)
}

/// A group of its own: the terminal's Ctrl-C reaches only this process, which then asks the others in order.
#[cfg(unix)]
fn apart(command: &mut Command) {
    std::os::unix::process::CommandExt::process_group(command, 0);
}

#[cfg(unix)]
fn ask_to_stop(child: &Child) {
    let id = i32::try_from(child.id()).ok().and_then(rustix::process::Pid::from_raw);
    if let Some(id) = id {
        // It may have ended in this moment.
        _ = rustix::process::kill_process(id, rustix::process::Signal::INT);
    }
}

#[cfg(not(unix))]
fn apart(_: &mut Command) {}

/// The console has sent Ctrl-C to all of its processes.
#[cfg(not(unix))]
fn ask_to_stop(_: &Child) {}

const POLL: Duration = Duration::from_millis(100);
const START: Duration = Duration::from_secs(20);
const STOP: Duration = Duration::from_secs(10);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_taken_address_is_named_with_what_to_type() {
        let other = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let address = other.local_addr().expect("an address");
        let error = free(address, "the page", "--listen").expect_err("taken").to_string();
        assert!(
            error.contains(&address.to_string()) && error.contains("cargo xtask run --listen 127.0.0.1:"),
            "{error}"
        );
    }

    #[test]
    fn the_path_for_a_block_names_only_an_unusual_port() {
        assert_eq!(block_path("127.0.0.1:44818".parse().expect("an address")), "4,127.0.0.1");
        assert_eq!(block_path("127.0.0.1:44820".parse().expect("an address")), "4,127.0.0.1:44820");
    }
}

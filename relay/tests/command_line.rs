//! `send`, `run` and `check` against `simulate`, each a process of its own, as a person uses them.

#![expect(clippy::unwrap_used, reason = "a test ends where it fails")]

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Output, Stdio};

use serde_json::Value;

/// A simulated device that ends with the test.
struct Device {
    child: Child,
    path: String,
}

impl Device {
    fn start(arguments: &[&str]) -> Self {
        let mut child = cipdeck(&["simulate", "--listen", "127.0.0.1:0"])
            .args(arguments)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let address = line.split(' ').find(|word| word.starts_with("127.0.0.1:")).unwrap();
        let path = format!("4,{address}");
        Self { child, path }
    }

    /// `send` to this device.
    fn send(&self, arguments: &[&str]) -> (i32, String, String) {
        read(cipdeck(&["send", &self.path]).args(arguments).output().unwrap())
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn cipdeck(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cipdeck"));
    command.args(arguments);
    command
}

/// Exit code, stdout, stderr.
fn read(output: Output) -> (i32, String, String) {
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

fn words(text: &str) -> Vec<&str> {
    text.split(' ').collect()
}

const NAME: &str = "--service 14 --class 1 --instance 1 --attribute 7";

#[test]
fn a_message_is_answered_decoded_and_exits_with_0() {
    let device = Device::start(&[]);
    let (code, stdout, stderr) = device.send(&words(&format!("{NAME} --json")));
    let json: Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!(code, 0, "{stderr}");
    assert_eq!(
        (json["Q"].as_bool(), json["Status"]["StatusBits"].as_u64()),
        (Some(true), Some(17)),
        "{json}"
    );
    assert_eq!(json["request"], "0e03200124013007");
    assert_eq!(json["decoded"][0]["text"], "cipdeck demo drive");
    assert_eq!(json["response"], format!("8e000000{}", json["ResData"].as_str().unwrap()));
    assert_eq!(json["last"]["ResData"], json["ResData"]);
    assert!(stderr.starts_with("warning: TargetCfg.Path: TCP port"), "{stderr}");

    let (code, stdout, _) =
        device.send(&words("--service 0Eh --class 16#93 --instance 0x29 --attribute 9 --repeat 3"));
    assert_eq!((code, stdout.lines().count()), (0, 3), "{stdout}");
}

#[test]
fn a_refusal_exits_with_3_and_is_told_in_words() {
    let device = Device::start(&[]);
    let (code, stdout, _) = device.send(&words("--service 14 --class 238 --instance 1 --attribute 7"));
    assert_eq!(code, 3);
    for part in
        ["ErrorID 224 SubErrorID 5", "Path destination unknown", "(confirmed)", "0e 03 20 ee 24 01 30 07"]
    {
        assert!(stdout.contains(part), "{part} is missing in {stdout}");
    }
    let (code, stdout, _) = device.send(&words("--service 14 --class 238 --instance 1 --json"));
    let json: Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!(
        (code, &json["Status"]["ErrorID"], &json["Status"]["SubErrorID"]),
        (3, &224.into(), &5.into())
    );
}

#[test]
fn errors_in_the_configuration_exit_with_2_and_nothing_is_sent() {
    // Nothing listens there: sending would exit with 4.
    let (code, stdout, stderr) = read(
        cipdeck(&["send", "4,127.0.0.1:1", "--service", "300", "--class", "1", "--instance", "-1"])
            .output()
            .unwrap(),
    );
    assert_eq!((code, stdout.as_str()), (2, ""));
    assert!(stderr.contains("error: AppCfg.Service: 300 is outside 1 to 127"), "{stderr}");
    assert!(stderr.contains("error: AppCfg.Instance: -1 is outside 0 to 4294967295"), "{stderr}");
    for (argument, value) in [("--service", "1x"), ("--class", "3F"), ("--instance", "")] {
        let (code, _, stderr) = read(cipdeck(&["send", "0,0", argument, value]).output().unwrap());
        assert_eq!(code, 2, "{stderr}");
        assert!(stderr.contains(argument), "{stderr}");
    }
    for data in ["1", "zz", &"00".repeat(491)] {
        let arguments =
            ["send", "0,0", "--service", "16", "--class", "4", "--instance", "150", "--data", data];
        let (code, _, stderr) = read(cipdeck(&arguments).output().unwrap());
        assert_eq!(code, 2, "{stderr}");
        assert!(stderr.contains("error: ReqData"), "{stderr}");
    }
}

#[test]
fn everything_between_here_and_the_device_exits_with_4() {
    let (code, stdout, _) = read(cipdeck(&["send", "4,127.0.0.1:1"]).args(words(NAME)).output().unwrap());
    assert_eq!(code, 4);
    assert!(stdout.contains("ErrorID 210") && stdout.contains("Nobody listens"), "{stdout}");
    for (fault, expected) in [
        ("drop", "ErrorID 55 SubErrorID 115"),
        ("half-frame", "ErrorID 55 SubErrorID 115"),
        ("wrong-context", "ErrorID 55 SubErrorID 115"),
        ("close", "ErrorID 55 SubErrorID 115"),
        ("garbage", "ErrorID 69 SubErrorID 65"),
        ("wrong-service", "ErrorID 69 SubErrorID 65"),
        ("status=8", "encapsulation status 0x08"),
    ] {
        let device = Device::start(&["--fault", fault]);
        let (code, stdout, stderr) = device.send(&words(&format!("{NAME} --timeout 250")));
        assert_eq!(code, 4, "{fault}: {stdout}{stderr}");
        assert!(stdout.contains(expected), "{fault}: {stdout}");
    }
}

#[test]
fn repeating_goes_on_after_a_failure_and_exits_as_the_first_one_did() {
    let device =
        Device::start(&["--fault", "ok", "--fault", "error=0x0f", "--fault", "drop", "--fault", "ok"]);
    let (code, stdout, _) = device.send(&words(&format!("{NAME} --timeout 250 --repeat 4 --json")));
    assert_eq!(code, 3);
    let ids: Vec<_> = stdout
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).unwrap()["Status"]["ErrorID"].as_u64().unwrap())
        .collect();
    assert_eq!(ids, [0, 224, 55, 0]);
}

#[test]
fn a_block_from_a_file_is_checked_and_run() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("block.json");
    let block = |service: u16| {
        format!(
            r#"{{"id":"b7","revision":3,"name":"name","AppCfg":{{"Service":{service},"Class":1,"Instance":1,"Attribute":7}},"TargetCfg":{{"Path":"0,0"}}}}"#
        )
    };
    let command = |arguments: &[&str]| read(cipdeck(arguments).arg(&file).output().unwrap());

    std::fs::write(&file, block(14)).unwrap();
    let (code, stdout, _) = command(&["check", "--json"]);
    assert_eq!((code, stdout.trim()), (0, r#"{"findings":[],"request":"0e03200124013007"}"#));
    let (code, stdout, _) = command(&["run"]);
    assert_eq!(code, 0);
    assert!(stdout.contains("cipdeck demo drive"), "{stdout}");

    std::fs::write(&file, block(300)).unwrap();
    let (code, stdout, _) = command(&["check", "--json"]);
    let json: Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!((code, &json["request"]), (2, &Value::Null));
    let finding = &json["findings"][0];
    assert_eq!(
        (&finding["field"], &finding["min"], &finding["max"]),
        (&"AppCfg.Service".into(), &1.into(), &127.into())
    );
    assert_eq!(command(&["run"]).0, 2);

    std::fs::write(&file, "{}").unwrap();
    let (code, _, stderr) = command(&["check"]);
    assert_eq!(code, 2);
    assert!(stderr.contains("is not a block"), "{stderr}");
    assert_eq!(read(cipdeck(&["run", "/nowhere/block.json"]).output().unwrap()).0, 2);
}

//! From another machine, as far as one machine can play that: another network namespace.

use std::process::{Command, Stdio};

use cipdeck_tests::PATIENCE;
use cipdeck_tests::process::Process;
use cipdeck_tests::rest::Rest;
use cipdeck_tests::secure::{connect, request};
use cipdeck_tests::tools;
use serde_json::json;
use tempfile::TempDir;

/// A network of two: this machine and the namespace. It ends with the value.
struct Elsewhere {
    name: String,
    /// This machine's address there.
    address: String,
}

impl Elsewhere {
    /// Only root can make one.
    fn make() -> Option<Self> {
        let id = std::process::id();
        let (name, here) = (format!("cipdeck-{id}"), format!("cd{id}"));
        let [high, low] = [id >> 6 & 0xff, id << 2 & 0xfc];
        let address = format!("10.213.{high}.{low}").parse::<std::net::Ipv4Addr>().ok()?;
        let of = |offset: u32| std::net::Ipv4Addr::from_bits(address.to_bits() + offset).to_string();
        let elsewhere = Self { name: name.clone(), address: of(1) };
        let there = format!("{here}e");
        let made = [
            format!("netns add {name}"),
            format!("link add {here} type veth peer name {there} netns {name}"),
            format!("addr add {}/30 dev {here}", of(1)),
            format!("link set {here} up"),
            format!("-n {name} addr add {}/30 dev {there}", of(2)),
            format!("-n {name} link set {there} up"),
        ];
        made.iter().all(|words| ip(words)).then_some(elsewhere)
    }

    fn prefix(&self) -> [&str; 4] {
        ["ip", "netns", "exec", &self.name]
    }

    /// Can a TCP connection be made from there?
    fn reaches(&self, address: &str) -> bool {
        let (host, port) = address.rsplit_once(':').expect("a port");
        let script = format!("exec 3<>/dev/tcp/{host}/{port}");
        let words = self.prefix();
        let mut command = Command::new(words[0]);
        command.args(&words[1..]).args(["timeout", "2", "bash", "-c", &script]);
        command.stderr(Stdio::null()).status().expect("ip is installed").success()
    }
}

impl Drop for Elsewhere {
    fn drop(&mut self) {
        // The pair of interfaces goes with it.
        ip(&format!("netns del {}", self.name));
    }
}

fn ip(words: &str) -> bool {
    let status = Command::new("ip").args(words.split(' ')).stderr(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}

#[tokio::test]
async fn others_hear_nothing_before_set_up_and_tls_alone_after_it() {
    let Some(elsewhere) = Elsewhere::make() else {
        let why = "a network namespace needs root and `apt-get install iproute2`";
        // Where everything has to be seen nothing is passed over.
        assert!(std::env::var_os("CI").is_none(), "{why}");
        return eprintln!("NOT RUN: {why}");
    };
    let folder = TempDir::new().unwrap();
    let (listen, data) = (format!("{}:0", elsewhere.address), folder.path().to_str().unwrap());
    let process = Process::start(&tools::cipdeck(), ["serve", "--listen", &listen, "--data", data]);
    let plain = process.line("it listens on loopback", PATIENCE, |line| {
        line.strip_prefix("cipdeck listens on http://").map(str::to_owned)
    });
    let plain = plain.await;
    let code = process.line("it prints the set-up code", PATIENCE, |line| {
        line.strip_prefix("set-up code: ").map(str::to_owned)
    });
    let code = code.await;
    assert!(plain.starts_with("127.0.0.1:"), "{plain}");
    let port = plain.rsplit(':').next().unwrap();
    assert!(!elsewhere.reaches(&format!("{}:{port}", elsewhere.address)), "nobody answers before set-up");
    let rest = Rest::new(&plain);
    let session = rest.get("session").await.body;
    assert!(session["moves_to"].as_str().unwrap().starts_with("https://10.213."), "{session}");
    rest.get("blocks").await.is_problem(401, "signed_out");

    let password = "correct horse battery staple";
    let reply = rest.post("setup", &json!({ "code": code, "name": "anna", "password": password })).await;
    assert_eq!(reply.status, 200, "{reply:?}");
    let secure = process.line("it goes where others can reach it", PATIENCE, |line| {
        line.strip_prefix("cipdeck listens on https://").map(str::to_owned)
    });
    let secure = secure.await;
    assert!(elsewhere.reaches(&secure));
    assert!(std::net::TcpStream::connect(&plain).is_err(), "loopback is left");

    let ask =
        async |arguments: &[&str], text: &str| connect(&elsewhere.prefix(), &secure, arguments, text).await;
    let health = request("GET", "health", &secure, "");
    let handshake = ask(&["-tls1_3"], &health).await;
    assert!(handshake.said.contains("HTTP/1.1 200 OK"), "{}", handshake.said);
    assert!(!ask(&["-tls1_2"], &health).await.succeeded);
    let foreign = ask(&[], &request("GET", "health", "rebound.example", "")).await;
    assert!(foreign.said.contains("HTTP/1.1 403"), "{}", foreign.said);
    let blocks = ask(&[], &request("GET", "blocks", &secure, "")).await;
    assert!(blocks.said.contains("HTTP/1.1 401"), "{}", blocks.said);
    let form = json!({ "name": "anna", "password": password }).to_string();
    let signed_in = ask(&[], &request("POST", "session", &secure, &form)).await;
    let said = signed_in.said.to_lowercase();
    assert!(said.contains("http/1.1 200") && said.contains("set-cookie: __host-cipdeck="), "{said}");
    // Plain HTTP gets no HTTP back.
    let words = elsewhere.prefix();
    let curl = Command::new(words[0])
        .args(&words[1..])
        .args(["curl", "-s", "-m", "5", &format!("http://{secure}/api/v1/health")])
        .output()
        .unwrap();
    assert!(!curl.status.success() && curl.stdout.is_empty(), "{curl:?}");
}

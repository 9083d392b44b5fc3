//! A relay as it is without any configuration: nobody may anything until an administrator has set it up.

use std::path::Path;

use serde_json::json;
use tempfile::TempDir;

use crate::command::LOOPBACK;
use crate::process::Process;
use crate::rest::Rest;
use crate::{PATIENCE, tools};

/// Everybody's.
pub const PASSWORD: &str = "four words are enough";

/// `cipdeck serve` on a free port of loopback, set up.
#[derive(Debug)]
pub struct Managed {
    /// Where it listens.
    pub address: String,
    /// The process.
    pub process: Process,
    /// The code that it has printed.
    pub code: String,
    /// The administrator `root`.
    pub admin: Rest,
    folder: TempDir,
}

impl Managed {
    /// Starts it, makes the administrator, and allows the targets on loopback.
    pub async fn start() -> Self {
        Self::start_with(&[], |address, _| Rest::new(address)).await
    }

    /// With more arguments, and a client that is made from its address and its data folder.
    pub async fn start_with(arguments: &[&str], client: impl Fn(&str, &Path) -> Rest) -> Self {
        let folder = TempDir::new().expect("a temporary folder");
        let data = folder.path().to_str().expect("a path in UTF-8");
        let serve = ["serve", "--listen", "127.0.0.1:0", "--data", data];
        let process = Process::start(&tools::cipdeck(), [&serve[..], arguments].concat());
        let address = process.line("it says where it listens", PATIENCE, address).await;
        let code = process.line("it prints the set-up code", PATIENCE, setup_code).await;
        let form = json!({ "code": code, "name": "root", "password": PASSWORD });
        let admin = client(&address, folder.path()).sign_in("setup", &form).await;
        let allowed = admin.post("allow/targets", &json!({ "target": LOOPBACK, "note": "" })).await;
        assert_eq!(allowed.status, 201, "{allowed:?}");
        Self { address, process, code, admin, folder }
    }

    /// Its data folder.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Makes a user with the name of the role, who signs in.
    pub async fn user(&self, role: &str) -> Rest {
        let new = json!({ "name": role, "role": role, "password": PASSWORD });
        let made = self.admin.post("users", &new).await;
        assert_eq!(made.status, 201, "{made:?}");
        let stranger = self.admin.with_header("cookie", "").with_header("x-csrf-token", "");
        stranger.sign_in("session", &json!({ "name": role, "password": PASSWORD })).await
    }

    /// Makes an API token with a role for a day; its secret.
    pub async fn token(&self, role: &str) -> String {
        let new = json!({ "name": role, "role": role, "days": 1 });
        let made = self.admin.post("tokens", &new).await;
        assert_eq!(made.status, 201, "{made:?}");
        made.body["secret"].as_str().expect("a secret").to_owned()
    }
}

/// The address in `cipdeck listens on http://127.0.0.1:8818` or `https://…`.
pub fn address(line: &str) -> Option<String> {
    let url = line.strip_prefix("cipdeck listens on ")?;
    Some(url.split_once("://")?.1.to_owned())
}

/// The code in `set-up code: 7K3M-90QX-V2TB`.
pub fn setup_code(line: &str) -> Option<String> {
    line.strip_prefix("set-up code: ").map(str::to_owned)
}

//! Where things are: the workspace's root and what is built in it.

use std::{
    env,
    path::{Path, PathBuf},
};

/// The folder that holds the workspace's `Cargo.toml`.
pub(crate) fn root() -> PathBuf {
    // cargo gives this to `cargo xtask`; the folder of compile time serves a binary that is started by hand.
    let xtask =
        env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| env!("CARGO_MANIFEST_DIR").into(), PathBuf::from);
    xtask.parent().map_or_else(|| xtask.clone(), Path::to_path_buf)
}

/// The target folder of the host's builds; `CARGO_TARGET_DIR` is obeyed.
pub(crate) fn target() -> PathBuf {
    env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), |named| root().join(named))
}

/// The page that the relay embeds.
pub(crate) fn page() -> PathBuf {
    root().join("frontend").join("dist")
}

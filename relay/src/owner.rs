//! Who owns the files of a data folder.
//!
//! Commands that work on a data folder are often run as root, while the relay runs as a user of its own: what they leave
//! behind must not be out of its reach.

use std::fs::{self, Metadata};
use std::io;
use std::path::Path;

/// Gives everything in the folder to the folder's owner, as far as this user may. Elsewhere than on Unix there is
/// nothing to do.
pub(crate) fn hand_over(folder: &Path) {
    if let Ok(owner) = fs::metadata(folder)
        && let Err(error) = give(folder, &owner)
    {
        tracing::warn!(%error, "some files in {} may be out of the relay's reach", folder.display());
    }
}

/// Gives a path and what is in it to the owner of something else.
#[cfg(unix)]
pub(crate) fn give(path: &Path, owner: &Metadata) -> io::Result<()> {
    use std::os::unix::fs::{MetadataExt, lchown};
    let own = fs::symlink_metadata(path)?;
    if (own.uid(), own.gid()) != (owner.uid(), owner.gid()) {
        lchown(path, Some(owner.uid()), Some(owner.gid()))?;
    }
    if own.is_dir() {
        for entry in fs::read_dir(path)? {
            give(&entry?.path(), owner)?;
        }
    }
    Ok(())
}

#[cfg(not(unix))]
pub(crate) fn give(_: &Path, _: &Metadata) -> io::Result<()> {
    Ok(())
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::{MetadataExt, chown};

    use super::*;

    #[test]
    fn what_root_leaves_in_the_relays_folder_is_the_relays() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("tls/key.pem");
        fs::create_dir(folder.path().join("tls")).unwrap();
        fs::write(&file, "").unwrap();
        // Only root can make this difference.
        let owner = if chown(folder.path(), Some(8818), Some(8818)).is_ok() {
            8818
        } else {
            fs::metadata(folder.path()).unwrap().uid()
        };
        hand_over(folder.path());
        assert_eq!(fs::metadata(&file).unwrap().uid(), owner);
    }
}

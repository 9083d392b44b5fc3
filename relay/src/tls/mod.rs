//! TLS 1.3 and nothing older: a certificate from files, or one that the relay has made for itself.

mod certificate;
mod made;
mod watch;

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

use rustls::ServerConfig;

use self::certificate::Certificate;
pub(crate) use self::watch::watch;

/// Where the relay keeps the certificate that it has made, in the data folder.
const FOLDER: &str = "tls";

/// Why there is no certificate to serve with.
#[derive(Debug, thiserror::Error)]
pub(crate) enum TlsError {
    /// A file is not there, or must not be read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A file cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Unwritable {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A file holds something else.
    #[error("{}: {what}", path.display())]
    Unusable {
        /// Which file.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
    /// The certificate could not be made.
    #[error("cannot make a certificate: {0}")]
    NotMade(String),
}

/// What the relay serves with. Clones share it, and all of them see another certificate at once.
#[derive(Clone, Debug)]
pub(crate) struct Tls(Arc<Shared>);

#[derive(Debug)]
struct Shared {
    source: Source,
    current: Mutex<Current>,
}

/// Where the certificate comes from.
#[derive(Debug)]
enum Source {
    /// Somebody else renews it.
    Files { chain: PathBuf, key: PathBuf },
    /// Made here and kept in this folder, for these names.
    Made { folder: PathBuf, names: Vec<String> },
    /// Made here and gone with the relay.
    InMemory,
}

/// The certificate in use.
#[derive(Debug)]
struct Current {
    certificate: Certificate,
    /// The files as they were when they were read.
    stamp: Stamp,
}

/// When the two files were changed, and how long they are.
type Stamp = [Option<(SystemTime, u64)>; 2];

impl Tls {
    /// With a chain and a key in PEM that somebody else renews.
    pub(crate) fn from_files(chain: &Path, key: &Path) -> Result<Self, TlsError> {
        Self::open(Source::Files { chain: chain.to_owned(), key: key.to_owned() })
    }

    /// With a certificate for these names, made now or by an earlier relay with this data folder; without a folder it
    /// lives in memory.
    pub(crate) fn self_signed(data: Option<&Path>, names: Vec<String>) -> Result<Self, TlsError> {
        let Some(data) = data else {
            let certificate = Certificate::made(&made::make(&names, SystemTime::now())?)?;
            return Ok(Self::with(Source::InMemory, certificate, Stamp::default()));
        };
        Self::open(Source::Made { folder: data.join(FOLDER), names })
    }

    fn open(source: Source) -> Result<Self, TlsError> {
        source.renew()?;
        let stamp = source.stamp();
        let certificate = source.read()?;
        Ok(Self::with(source, certificate, stamp))
    }

    fn with(source: Source, certificate: Certificate, stamp: Stamp) -> Self {
        Self(Arc::new(Shared { source, current: Mutex::new(Current { certificate, stamp }) }))
    }

    /// SHA-256 of the certificate, as browsers show it: `A1:B2:…`.
    pub(crate) fn fingerprint(&self) -> String {
        self.current().certificate.fingerprint.clone()
    }

    /// What the next connection is accepted with.
    pub(crate) fn config(&self) -> Arc<ServerConfig> {
        Arc::clone(&self.current().certificate.config)
    }

    /// Takes up what is in the files by now, if it is something else; true if it is. What cannot be used changes
    /// nothing.
    fn reload(&self) -> Result<bool, TlsError> {
        if matches!(self.0.source, Source::InMemory) {
            return Ok(false);
        }
        self.0.source.renew()?;
        // Before reading: what is written meanwhile is seen the next time.
        self.current().stamp = self.0.source.stamp();
        let certificate = self.0.source.read()?;
        if certificate.fingerprint == self.fingerprint() {
            return Ok(false);
        }
        self.current().certificate = certificate;
        Ok(true)
    }

    /// The files have been touched, or the certificate is near its end.
    fn is_stale(&self) -> bool {
        self.0.source.stamp() != self.current().stamp || self.0.source.is_ending()
    }

    fn current(&self) -> MutexGuard<'_, Current> {
        self.0.current.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Source {
    fn files(&self) -> Option<(PathBuf, PathBuf)> {
        match self {
            Self::Files { chain, key } => Some((chain.clone(), key.clone())),
            Self::Made { folder, .. } => Some((folder.join(made::CHAIN), folder.join(made::KEY))),
            Self::InMemory => None,
        }
    }

    fn stamp(&self) -> Stamp {
        let stamp =
            |path: &Path| std::fs::metadata(path).and_then(|file| Ok((file.modified()?, file.len()))).ok();
        self.files().map_or_else(Stamp::default, |(chain, key)| [stamp(&chain), stamp(&key)])
    }

    fn read(&self) -> Result<Certificate, TlsError> {
        let (chain, key) = self.files().unwrap_or_default();
        Certificate::read(&chain, &key)
    }

    fn is_ending(&self) -> bool {
        match self {
            Self::Made { folder, names } => !made::is_good(folder, names, SystemTime::now()),
            Self::Files { .. } | Self::InMemory => false,
        }
    }

    /// Makes what is ours to make, if it is not there or near its end.
    fn renew(&self) -> Result<(), TlsError> {
        let Self::Made { folder, names } = self else { return Ok(()) };
        if made::is_good(folder, names, SystemTime::now()) && self.read().is_ok() {
            return Ok(());
        }
        made::keep(folder, names, SystemTime::now())
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use tempfile::TempDir;

    use super::*;

    fn names(names: &[&str]) -> Vec<String> {
        names.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_made_certificate_is_kept_until_a_name_is_missing() {
        let folder = TempDir::new().unwrap();
        let open = |list: &[&str]| Tls::self_signed(Some(folder.path()), names(list)).unwrap().fingerprint();
        let first = open(&["localhost", "127.0.0.1"]);
        assert_eq!(first.len(), 32 * 3 - 1, "{first}");
        assert_eq!(open(&["localhost", "127.0.0.1"]), first);
        assert_eq!(open(&["localhost"]), first, "a name too many does not matter");
        assert_ne!(open(&["localhost", "plc-gateway.plant.local"]), first);
    }

    #[test]
    fn a_made_certificate_is_renewed_near_its_end_and_when_it_is_damaged() {
        let folder = TempDir::new().unwrap();
        let list = names(&["localhost"]);
        let tls = folder.path().join(FOLDER);
        let long_ago = SystemTime::now() - std::time::Duration::from_hours(370 * 24);
        made::keep(&tls, &list, long_ago).unwrap();
        let old = fs::read(tls.join(made::CHAIN)).unwrap();
        let first = Tls::self_signed(Some(folder.path()), list.clone()).unwrap().fingerprint();
        assert_ne!(fs::read(tls.join(made::CHAIN)).unwrap(), old);
        fs::write(tls.join(made::KEY), "nothing").unwrap();
        let second = Tls::self_signed(Some(folder.path()), list).unwrap().fingerprint();
        assert_ne!(second, first);
    }

    #[cfg(unix)]
    #[test]
    fn only_the_owner_can_read_the_key() {
        use std::os::unix::fs::PermissionsExt;
        let folder = TempDir::new().unwrap();
        Tls::self_signed(Some(folder.path()), names(&["localhost"])).unwrap();
        let key = fs::metadata(folder.path().join(FOLDER).join(made::KEY)).unwrap();
        assert_eq!(key.permissions().mode() & 0o777, 0o600);
    }

    #[test]
    fn files_that_cannot_be_used_are_named() {
        let folder = TempDir::new().unwrap();
        made::keep(folder.path(), &names(&["localhost"]), SystemTime::now()).unwrap();
        let (chain, key) = (folder.path().join(made::CHAIN), folder.path().join(made::KEY));
        Tls::from_files(&chain, &key).unwrap();
        let words = |chain: &Path, key: &Path| Tls::from_files(chain, key).unwrap_err().to_string();
        assert!(words(&key, &key).contains("no certificate"), "{}", words(&key, &key));
        assert!(words(&chain, &chain).contains("no private key"), "{}", words(&chain, &chain));
        assert!(words(&chain, &folder.path().join("gone.pem")).contains("cannot read"));
        let other = TempDir::new().unwrap();
        made::keep(other.path(), &names(&["localhost"]), SystemTime::now()).unwrap();
        let strange = words(&chain, &other.path().join(made::KEY));
        assert!(strange.contains("does not belong to"), "{strange}");
    }

    #[test]
    fn a_broken_new_file_keeps_the_old_certificate_and_a_good_one_is_taken_up() {
        let folder = TempDir::new().unwrap();
        let list = names(&["localhost"]);
        made::keep(folder.path(), &list, SystemTime::now()).unwrap();
        let (chain, key) = (folder.path().join(made::CHAIN), folder.path().join(made::KEY));
        let tls = Tls::from_files(&chain, &key).unwrap();
        let first = tls.fingerprint();
        assert!(!tls.is_stale());
        fs::write(&chain, "not a certificate").unwrap();
        assert!(tls.is_stale());
        tls.reload().unwrap_err();
        assert!(!tls.is_stale(), "the same broken file is complained about once");
        assert_eq!(tls.fingerprint(), first);
        made::keep(folder.path(), &list, SystemTime::now()).unwrap();
        assert!(tls.is_stale() && tls.reload().unwrap());
        assert_ne!(tls.fingerprint(), first);
        assert!(!tls.reload().unwrap(), "nothing new");
    }
}

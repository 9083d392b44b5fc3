//! The certificate that the relay makes for itself, and keeps in its data folder.

use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::Path;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use rcgen::{CertificateParams, DnType, ExtendedKeyUsagePurpose, KeyPair, KeyUsagePurpose};
use serde::{Deserialize, Serialize};

use super::TlsError;
use crate::private;

pub(super) const CHAIN: &str = "cert.pem";
pub(super) const KEY: &str = "key.pem";

/// What the certificate is for, and until when: nothing here reads certificates.
const ABOUT: &str = "about.json";

const DAY: Duration = Duration::from_hours(24);

/// The longest time that browsers accept.
const DAYS: u32 = 397;

/// It is renewed this long before its end.
const RENEWED: Duration = Duration::from_hours(30 * 24);

#[derive(Serialize, Deserialize)]
struct About {
    names: Vec<String>,
    /// Seconds since 1970.
    until: u64,
}

/// A certificate and its key in PEM.
pub(super) struct Pem {
    pub(super) chain: String,
    pub(super) key: String,
}

/// The folder has a certificate for all of these names, and not near its end.
pub(super) fn is_good(folder: &Path, names: &[String], now: SystemTime) -> bool {
    let about: Option<About> =
        fs::read(folder.join(ABOUT)).ok().and_then(|text| serde_json::from_slice(&text).ok());
    about.is_some_and(|about| {
        let until = UNIX_EPOCH + Duration::from_secs(about.until);
        names.iter().all(|name| about.names.contains(name)) && now + RENEWED < until
    })
}

/// Makes a certificate and keeps it in the folder.
pub(super) fn keep(folder: &Path, names: &[String], now: SystemTime) -> Result<(), TlsError> {
    let pem = make(names, now)?;
    let until = now + DAY * DAYS;
    let about = About {
        names: names.to_vec(),
        until: until.duration_since(UNIX_EPOCH).unwrap_or_default().as_secs(),
    };
    let about = serde_json::to_vec(&about).unwrap_or_default();
    private::folder(folder).map_err(|source| TlsError::Unwritable { path: folder.to_owned(), source })?;
    for (name, content) in [(KEY, pem.key.as_bytes()), (CHAIN, pem.chain.as_bytes()), (ABOUT, &about)] {
        let path = folder.join(name);
        write(&path, content).map_err(|source| TlsError::Unwritable { path, source })?;
    }
    tracing::info!(tls.names = ?names, "made a certificate");
    Ok(())
}

/// Makes a certificate for these names, from `now` on.
pub(super) fn make(names: &[String], now: SystemTime) -> Result<Pem, TlsError> {
    let not_made = |error: rcgen::Error| TlsError::NotMade(error.to_string());
    let mut params = CertificateParams::new(names.to_vec()).map_err(not_made)?;
    params.distinguished_name.push(DnType::CommonName, "cipdeck");
    // A client whose clock is late is no reason to refuse.
    params.not_before = (now - DAY).into();
    params.not_after = (now + DAY * DAYS - DAY).into();
    params.key_usages = vec![KeyUsagePurpose::DigitalSignature];
    params.extended_key_usages = vec![ExtendedKeyUsagePurpose::ServerAuth];
    let key = KeyPair::generate().map_err(not_made)?;
    let certificate = params.self_signed(&key).map_err(not_made)?;
    Ok(Pem { chain: certificate.pem(), key: key.serialize_pem() })
}

/// Replaces a file: the old one or the new one is there at any time, and nobody else can read it.
fn write(path: &Path, content: &[u8]) -> io::Result<()> {
    let new = path.with_extension("new");
    let mut options = OpenOptions::new();
    options.write(true).create(true).truncate(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    let mut file = options.open(&new)?;
    file.write_all(content)?;
    file.sync_all()?;
    fs::rename(new, path)
}

//! A chain and its key, ready to serve with.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use rustls::ServerConfig;
use rustls::pki_types::pem::PemObject;
use rustls::pki_types::{CertificateDer, PrivateKeyDer};
use rustls::version::TLS13;
use sha2::{Digest, Sha256};

use super::TlsError;
use super::made::Pem;

/// A certificate that can be served with.
#[derive(Debug)]
pub(super) struct Certificate {
    pub(super) config: Arc<ServerConfig>,
    /// SHA-256 of the first certificate of the chain, `A1:B2:…`.
    pub(super) fingerprint: String,
}

impl Certificate {
    /// Reads two files in PEM.
    pub(super) fn read(chain: &Path, key: &Path) -> Result<Self, TlsError> {
        let read = |path: &Path| {
            fs::read(path).map_err(|source| TlsError::Unreadable { path: path.to_owned(), source })
        };
        let unusable = |path: &Path, what: String| TlsError::Unusable { path: path.to_owned(), what };
        let certificates = CertificateDer::pem_slice_iter(&read(chain)?)
            .collect::<Result<Vec<_>, _>>()
            .map_err(|error| unusable(chain, format!("not PEM: {error}")))?;
        if certificates.is_empty() {
            return Err(unusable(chain, "no certificate is in it (PEM, CERTIFICATE)".to_owned()));
        }
        let private = PrivateKeyDer::from_pem_slice(&read(key)?)
            .map_err(|_| unusable(key, "no private key is in it (PEM, PRIVATE KEY)".to_owned()))?;
        Self::new(certificates, private).map_err(|error| match error {
            rustls::Error::InconsistentKeys(_) => {
                unusable(key, format!("this key does not belong to the certificate in {}", chain.display()))
            }
            error => unusable(chain, error.to_string()),
        })
    }

    /// One that was just made.
    pub(super) fn made(pem: &Pem) -> Result<Self, TlsError> {
        let not_made = |error: &dyn ToString| TlsError::NotMade(error.to_string());
        let chain = CertificateDer::from_pem_slice(pem.chain.as_bytes()).map_err(|error| not_made(&error))?;
        let key = PrivateKeyDer::from_pem_slice(pem.key.as_bytes()).map_err(|error| not_made(&error))?;
        Self::new(vec![chain], key).map_err(|error| not_made(&error))
    }

    fn new(chain: Vec<CertificateDer<'static>>, key: PrivateKeyDer<'static>) -> Result<Self, rustls::Error> {
        let fingerprint = chain.first().map(|first| fingerprint(first)).unwrap_or_default();
        // Said here and not left to what is compiled in: another crate may want more.
        let provider = Arc::new(rustls::crypto::ring::default_provider());
        let mut config = ServerConfig::builder_with_provider(provider)
            .with_protocol_versions(&[&TLS13])?
            .with_no_client_auth()
            .with_single_cert(chain, key)?;
        // No HTTP/2: a WebSocket needs a connection of its own there as well.
        config.alpn_protocols = vec![b"http/1.1".to_vec()];
        Ok(Self { config: Arc::new(config), fingerprint })
    }
}

fn fingerprint(certificate: &[u8]) -> String {
    let bytes: Vec<String> = Sha256::digest(certificate).iter().map(|byte| format!("{byte:02X}")).collect();
    bytes.join(":")
}

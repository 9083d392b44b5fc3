//! `[tls]`: the certificate.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::SettingsError;

/// `[tls]`
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tls {
    /// The chain, PEM; with `key`.
    pub cert: Option<PathBuf>,
    /// The private key, PEM; with `cert`.
    pub key: Option<PathBuf>,
    /// Browsers are told to keep to HTTPS for everything on this host.
    #[serde(default)]
    pub hsts: bool,
}

impl Tls {
    /// The chain and the key; `None` = made by the relay.
    pub(crate) fn files(&self) -> Option<(&Path, &Path)> {
        self.cert.as_deref().zip(self.key.as_deref())
    }

    pub(super) fn checked(self) -> Result<Self, SettingsError> {
        match (&self.cert, &self.key) {
            (Some(_), None) => Err(SettingsError::HalfCertificate("tls.key")),
            (None, Some(_)) => Err(SettingsError::HalfCertificate("tls.cert")),
            _ => Ok(self),
        }
    }
}

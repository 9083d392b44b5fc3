//! Which certificate is believed: one that the machine's own list vouches for, or the one with a fingerprint.

use std::fmt;
use std::sync::Arc;

use rustls::client::danger::{HandshakeSignatureValid, ServerCertVerified, ServerCertVerifier};
use rustls::crypto::{CryptoProvider, ring, verify_tls13_signature};
use rustls::pki_types::{CertificateDer, ServerName, UnixTime};
use rustls::version::TLS13;
use rustls::{ClientConfig, DigitallySignedStruct, Error, PeerIncompatible, SignatureScheme};
use sha2::{Digest, Sha256};
use subtle::ConstantTimeEq;

/// SHA-256 of a certificate.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Fingerprint([u8; 32]);

impl Fingerprint {
    /// `A1:B2:…` or `a1b2…`
    pub(super) fn read(text: &str) -> Result<Self, String> {
        let digits: String = text.chars().filter(|c| !matches!(c, ':' | ' ')).collect();
        let bytes = cipdeck_shared::config::read_hex(&digits).ok().and_then(|bytes| bytes.try_into().ok());
        bytes.map(Self).ok_or_else(|| "--fingerprint: a SHA-256 has 64 hexadecimal digits".to_owned())
    }

    fn of(certificate: &[u8]) -> Self {
        Self(Sha256::digest(certificate).into())
    }
}

impl fmt::Debug for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

impl fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (at, byte) in self.0.iter().enumerate() {
            write!(f, "{}{byte:02X}", if at == 0 { "" } else { ":" })?;
        }
        Ok(())
    }
}

/// TLS 1.3 with `ring`, whatever else is compiled in.
pub(super) fn trusting(
    builder: reqwest::ClientBuilder,
    fingerprint: Option<Fingerprint>,
) -> Result<reqwest::ClientBuilder, String> {
    let provider = ring::default_provider();
    let Some(expected) = fingerprint else {
        // There may be one already: every use in this process takes the same.
        let _ = provider.install_default();
        return Ok(builder.tls_backend_rustls().tls_version_min(reqwest::tls::Version::TLS_1_3));
    };
    let provider = Arc::new(provider);
    let config = ClientConfig::builder_with_provider(Arc::clone(&provider))
        .with_protocol_versions(&[&TLS13])
        .map_err(|error| format!("TLS: {error}"))?
        .dangerous()
        .with_custom_certificate_verifier(Arc::new(Pinned { expected, provider }))
        .with_no_client_auth();
    Ok(builder.tls_backend_preconfigured(config))
}

/// Believes one certificate and no other, whatever name and dates it has: somebody has compared the fingerprint.
#[derive(Debug)]
struct Pinned {
    expected: Fingerprint,
    provider: Arc<CryptoProvider>,
}

impl ServerCertVerifier for Pinned {
    fn verify_server_cert(
        &self,
        certificate: &CertificateDer<'_>,
        _: &[CertificateDer<'_>],
        _: &ServerName<'_>,
        _: &[u8],
        _: UnixTime,
    ) -> Result<ServerCertVerified, Error> {
        let found = Fingerprint::of(certificate);
        if found.0.ct_eq(&self.expected.0).into() {
            return Ok(ServerCertVerified::assertion());
        }
        Err(Error::General(format!(
            "the certificate has another fingerprint, {found}: this is another relay, or somebody is in between"
        )))
    }

    fn verify_tls12_signature(
        &self,
        _: &[u8],
        _: &CertificateDer<'_>,
        _: &DigitallySignedStruct,
    ) -> Result<HandshakeSignatureValid, Error> {
        Err(Error::PeerIncompatible(PeerIncompatible::ServerDoesNotSupportTls12Or13))
    }

    /// That the other end has the key of the certificate, and does not merely show it.
    fn verify_tls13_signature(
        &self,
        message: &[u8],
        certificate: &CertificateDer<'_>,
        signature: &DigitallySignedStruct,
    ) -> Result<HandshakeSignatureValid, Error> {
        let algorithms = &self.provider.signature_verification_algorithms;
        verify_tls13_signature(message, certificate, signature, algorithms)
    }

    fn supported_verify_schemes(&self) -> Vec<SignatureScheme> {
        self.provider.signature_verification_algorithms.supported_schemes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fingerprint_is_read_as_people_copy_it() {
        let own = Fingerprint::of(b"certificate");
        let plain = own.to_string().replace(':', "").to_lowercase();
        for text in [own.to_string(), plain.clone(), own.to_string().replace(':', " ")] {
            assert_eq!(Fingerprint::read(&text).unwrap(), own);
        }
        for text in ["", "A1", &plain[2..], &format!("{plain}00"), &plain.replace(&plain[..1], "x")] {
            Fingerprint::read(text).unwrap_err();
        }
    }
}

//! Secrets that the relay makes: random, told once, and kept as their SHA-256.

use cipdeck_shared::config::write_hex;
use sha2::{Digest as _, Sha256};

use crate::error::ApiError;

/// What is kept of a secret. A secret is random, so that nobody finds it from its digest.
pub(super) type Digest = [u8; 32];

/// Bytes from the system's source of randomness.
pub(super) fn random<const N: usize>() -> Result<[u8; N], ApiError> {
    let mut bytes = [0; N];
    match getrandom::fill(&mut bytes) {
        Ok(()) => Ok(bytes),
        Err(error) => Err(ApiError::Internal(format!("the system gives no random numbers: {error}"))),
    }
}

/// A secret of 256 bits as hexadecimal text.
pub(super) fn new() -> Result<String, ApiError> {
    random::<32>().map(|bytes| write_hex(&bytes))
}

/// What is kept of a secret.
pub(super) fn digest(secret: &str) -> Digest {
    Sha256::digest(secret.as_bytes()).into()
}

/// What a page has to say beside the cookie that holds the secret: a foreign page can send the cookie, but it cannot
/// read this. It follows from the secret, and the secret does not follow from it.
pub(super) fn csrf(secret: &str) -> String {
    write_hex(&digest(&format!("X-CSRF-Token {secret}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_secret_is_like_another_and_none_is_its_own_token() {
        let (one, two) = (new().unwrap(), new().unwrap());
        assert_eq!((one.len(), two.len()), (64, 64));
        assert_ne!(one, two);
        assert_ne!(csrf(&one), csrf(&two));
        assert_ne!(
            csrf(&one),
            write_hex(&digest(&one)),
            "what lies in the memory of the relay opens nothing"
        );
    }
}

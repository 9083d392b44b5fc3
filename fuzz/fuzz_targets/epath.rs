//! A path that can be read is written so that it reads the same again.
#![no_main]

use cipdeck_shared::wire::{Epath, MessageRouterRequest};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    match Epath::decode(bytes) {
        Ok(path) => assert_eq!(Epath::decode(&path.bytes()), Ok(path)),
        Err(error) => assert!(error.at <= bytes.len(), "{error} lies in the bytes"),
    }
    match MessageRouterRequest::decode(bytes) {
        Ok(request) => assert_eq!(MessageRouterRequest::decode(&request.bytes()), Ok(request)),
        Err(error) => assert!(error.at <= bytes.len(), "{error} lies in the bytes"),
    }
});

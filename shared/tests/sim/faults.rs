//! What goes wrong on purpose.

use cipdeck_shared::sim::{Device, Fault, SimConfig};
use cipdeck_shared::wire::{
    Encapsulation, EncapsulationStatus, GeneralStatus, MessageRouterReply, SenderContext, ServiceCode,
    SessionHandle,
};
use hex_literal::hex;

use super::frames::{PRODUCT_NAME, at, message_of, registered, rr, sent, status_of};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

#[test]
fn each_fault_looks_as_its_name_says() {
    let reply_to = |fault: Fault| {
        let mut device = Device::new(SimConfig { faults: vec![fault], ..SimConfig::default() });
        let (mut connection, session) = registered(&mut device);
        connection.handle_input(&mut device, &rr(session, 7, &PRODUCT_NAME), at(0));
        (sent(&mut connection, at(0)), connection, session)
    };
    let (good, _, _) = reply_to(Fault::Ok);
    assert_eq!(message_of(&good)[..4], hex!("8E 00 00 00"));

    let (bytes, connection, _) = reply_to(Fault::Drop);
    assert!(bytes.is_empty() && !connection.is_closed());

    let (bytes, mut connection, session) = reply_to(Fault::HalfFrame);
    assert_eq!(bytes, good[..good.len() / 2]);
    let mut device = Device::default();
    connection.handle_input(&mut device, &rr(session, 8, &PRODUCT_NAME), at(0));
    assert!(sent(&mut connection, at(9)).is_empty(), "silence after half a frame");

    let header = |bytes: &[u8]| Encapsulation::decode(bytes).unwrap().header;
    assert_ne!(header(&reply_to(Fault::WrongContext).0).context, SenderContext::from(7));
    let (bytes, _, session) = reply_to(Fault::WrongSession);
    assert_ne!(header(&bytes).session, SessionHandle(session));

    let message = message_of(&reply_to(Fault::WrongService).0);
    assert_ne!(MessageRouterReply::decode(&message).unwrap().service, ServiceCode::GetAttributeSingle);
    assert!(Encapsulation::decode(&reply_to(Fault::Garbage).0).is_err());

    let status = EncapsulationStatus::InvalidLength;
    assert_eq!(status_of(&reply_to(Fault::EncapsulationStatus(status)).0).1, status);
    let (bytes, connection, _) = reply_to(Fault::Close);
    assert!(bytes.is_empty() && connection.is_closed());

    let message = message_of(&reply_to(Fault::ErrorStatus(GeneralStatus(0x10))).0);
    let refusal = MessageRouterReply::decode(&message).unwrap();
    assert_eq!((refusal.service, refusal.status.0), (ServiceCode::GetAttributeSingle, 0x10));
}

#[test]
fn faults_take_turns_even_over_a_new_connection() {
    let config = SimConfig { faults: vec![Fault::Close, Fault::Ok], ..SimConfig::default() };
    let mut device = Device::new(config);
    for round in 0..3 {
        let (mut connection, session) = registered(&mut device);
        connection.handle_input(&mut device, &rr(session, 1, &PRODUCT_NAME), at(0));
        assert!(connection.is_closed(), "round {round}");
        let (mut connection, session) = registered(&mut device);
        connection.handle_input(&mut device, &rr(session, 1, &PRODUCT_NAME), at(0));
        assert!(!sent(&mut connection, at(0)).is_empty(), "round {round}");
    }
}

//! Forward_Open, Large_Forward_Open and Forward_Close.
//!
//! The additional status words are those of `data/extended_status_connection_manager.tsv`.

use alloc::vec::Vec;

use crate::engine::time::Instant;
use crate::wire::{
    ClassCode, ConnectionTriad, Epath, ForwardCloseReply, ForwardOpen, ForwardOpenReply, GeneralStatus,
    MAX_CLASSIC_SIZE, Reader, RequestTimeout, SessionHandle,
};

use super::connections::Connection;
use super::counters::Count;
use super::device::{Device, count};
use super::request::Refusal;
use super::route::{INVALID_SEGMENT, Stuck, follow, words};

/// Connection in use or duplicate Forward_Open.
const DUPLICATE: u16 = 0x0100;
const TRANSPORT_NOT_SUPPORTED: u16 = 0x0103;
const NOT_FOUND: u16 = 0x0107;
const INVALID_SIZE: u16 = 0x0109;
const RPI_NOT_SUPPORTED: u16 = 0x0111;
const OUT_OF_CONNECTIONS: u16 = 0x0113;
const INVALID_APPLICATION_PATH: u16 = 0x0117;
const INVALID_O_T_TYPE: u16 = 0x0123;
const INVALID_T_O_TYPE: u16 = 0x0124;
const REDUNDANT_OWNER: u16 = 0x0125;
const NULL_OPEN: u16 = 0x0132;
const INVALID_MULTIPLIER: u16 = 0x0133;
const CLOSE_PATH_MISMATCH: u16 = 0x0316;

/// Sequence count and the shortest reply.
const MIN_SIZE: u16 = 6;

/// Before its first request a connection lives at least this long, us. OpENer cipconnectionobject.c.
const FIRST_WATCHDOG_US: u64 = 10_000_000;

/// Who refuses, what is counted, and what is said.
struct Rejection {
    module: usize,
    count: Count,
    refusal: Refusal,
}

impl Device {
    /// The connection begins here and ends at the module that the path leads to.
    pub(super) fn open(
        &mut self,
        module: usize,
        large: bool,
        data: &[u8],
        session: SessionHandle,
        now: Instant,
    ) -> Result<Vec<u8>, Refusal> {
        let opened = self.check_open(module, large, data);
        let target = opened.as_ref().map_or_else(|rejection| rejection.module, |opened| opened.0);
        count(&mut self.modules, module, target, Count::OpenRequest);
        let open = match opened {
            Ok((_, open)) => open,
            Err(rejection) => {
                count(&mut self.modules, module, target, rejection.count);
                return Err(rejection.refusal);
            }
        };
        let (o_t_id, t_o_id, triad) = (self.connections.free_id(), open.t_o_id, open.triad);
        let watchdog_us = open.multiplier.watchdog_us(open.o_t_rpi_us);
        self.connections.insert(Connection {
            triad,
            o_t_id,
            t_o_id,
            o_t_size: open.o_t.size,
            t_o_size: open.t_o.size,
            session,
            module: target,
            watchdog_us,
            expires: Instant(now.0.saturating_add(watchdog_us.max(FIRST_WATCHDOG_US))),
            last: None,
        });
        self.counters.opened += 1;
        let (o_t_api_us, t_o_api_us) = (open.o_t_rpi_us, open.t_o_rpi_us);
        let mut out = Vec::new();
        ForwardOpenReply { o_t_id, t_o_id, triad, o_t_api_us, t_o_api_us }.encode(&mut out);
        Ok(out)
    }

    fn check_open(&self, module: usize, large: bool, data: &[u8]) -> Result<(usize, ForwardOpen), Rejection> {
        let format = |refusal| Rejection { module, count: Count::OpenFormatReject, refusal };
        let mut reader = Reader::new(data);
        let head = ForwardOpen::read_head(large, &mut reader);
        let (open, size) = head.map_err(|_| format(GeneralStatus::NotEnoughData.into()))?;
        let mut path = read_path(&mut reader, size).map_err(|status| format(status.into()))?;
        let says = |status, remaining| Stuck { status, remaining }.refusal(Some(open.triad), open.timeout);
        let target = follow(&self.modules, module, &mut path)
            .map_err(|stuck| format(stuck.refusal(Some(open.triad), open.timeout)))?;
        let remaining = words(&path);
        let format = |status| Rejection {
            module: target,
            count: Count::OpenFormatReject,
            refusal: says(status, remaining),
        };
        let application = Epath::decode(path.rest()).map_err(|_| format(INVALID_SEGMENT))?;
        if application != Epath::object(ClassCode::MessageRouter.0, 1) {
            return Err(format(INVALID_APPLICATION_PATH));
        }
        let other = |refusal| Rejection { module: target, count: Count::OpenOtherReject, refusal };
        if self.connections.by_triad(open.triad).is_some() {
            return Err(other(says(DUPLICATE, 0)));
        }
        if let Some(status) = unsupported(&open) {
            return Err(other(says(status, 0)));
        }
        let accepted = if large { self.config.max_size } else { self.config.max_size.min(MAX_CLASSIC_SIZE) };
        if [open.o_t.size, open.t_o.size].iter().any(|size| !(MIN_SIZE..=accepted).contains(size)) {
            let mut refusal = says(INVALID_SIZE, 0);
            refusal.additional.extend_from_slice(&accepted.to_le_bytes());
            return Err(other(refusal));
        }
        if self.connections.len() >= self.config.max_connections {
            let refusal = says(OUT_OF_CONNECTIONS, 0);
            return Err(Rejection { module: target, count: Count::OpenResourceReject, refusal });
        }
        Ok((target, open))
    }

    /// Anybody who knows its three numbers may close a connection.
    pub(super) fn close(&mut self, module: usize, data: &[u8]) -> Result<Vec<u8>, Refusal> {
        let checked = self.check_close(module, data);
        let target = checked.as_ref().map_or_else(|rejection| rejection.module, |checked| checked.0);
        count(&mut self.modules, module, target, Count::CloseRequest);
        let triad = match checked {
            Ok((_, triad)) => triad,
            Err(rejection) => {
                count(&mut self.modules, module, target, rejection.count);
                return Err(rejection.refusal);
            }
        };
        self.connections.close(triad);
        self.counters.closed += 1;
        let mut out = Vec::new();
        ForwardCloseReply { triad }.encode(&mut out);
        Ok(out)
    }

    fn check_close(&self, module: usize, data: &[u8]) -> Result<(usize, ConnectionTriad), Rejection> {
        let format = |refusal| Rejection { module, count: Count::CloseFormatReject, refusal };
        let short = |_| format(GeneralStatus::NotEnoughData.into());
        let mut reader = Reader::new(data);
        let timeout = RequestTimeout::read(&mut reader).map_err(short)?;
        let triad = ConnectionTriad::read(&mut reader).map_err(short)?;
        let [size, _reserved] = reader.array().map_err(short)?;
        let mut path = read_path(&mut reader, size).map_err(|status| format(status.into()))?;
        let says = |status| Stuck { status, remaining: 0 }.refusal(Some(triad), timeout);
        let target = follow(&self.modules, module, &mut path)
            .map_err(|stuck| format(stuck.refusal(Some(triad), timeout)))?;
        let other =
            |status| Rejection { module: target, count: Count::CloseOtherReject, refusal: says(status) };
        let connection = self.connections.by_triad(triad).ok_or_else(|| other(NOT_FOUND))?;
        if connection.module != target {
            return Err(other(CLOSE_PATH_MISMATCH));
        }
        Ok((target, triad))
    }
}

/// The path, which is all that is left.
fn read_path<'a>(reader: &mut Reader<'a>, words: u8) -> Result<Reader<'a>, GeneralStatus> {
    let path = reader.sub(2 * usize::from(words)).map_err(|_| GeneralStatus::NotEnoughData)?;
    if reader.is_empty() { Ok(path) } else { Err(GeneralStatus::TooMuchData) }
}

/// What explicit messages cannot have.
fn unsupported(open: &ForwardOpen) -> Option<u16> {
    const NULL: u8 = 0;
    const POINT_TO_POINT: u8 = 2;
    /// Server, and class 3; any trigger of the specification.
    const SERVER_CLASS_3: u8 = 0x83;
    const LAST_TRIGGER: u8 = 2;
    let (o_t, t_o) = (open.o_t, open.t_o);
    let (class, trigger) = (open.transport & 0x8F, open.transport >> 4 & 0x07);
    let checks = [
        (class != SERVER_CLASS_3 || trigger > LAST_TRIGGER, TRANSPORT_NOT_SUPPORTED),
        (o_t.kind() == NULL && t_o.kind() == NULL, NULL_OPEN),
        (o_t.kind() != POINT_TO_POINT, INVALID_O_T_TYPE),
        (t_o.kind() != POINT_TO_POINT, INVALID_T_O_TYPE),
        (o_t.is_redundant_owner() || t_o.is_redundant_owner(), REDUNDANT_OWNER),
        (open.multiplier.0 > 7, INVALID_MULTIPLIER),
        (open.o_t_rpi_us == 0 || open.t_o_rpi_us == 0, RPI_NOT_SUPPORTED),
    ];
    checks.into_iter().find_map(|(wrong, status)| wrong.then_some(status))
}

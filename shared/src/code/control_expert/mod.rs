//! Control Expert: `SEND_REQ` for TSX ETC 100 and TSX ETC 101, `DATA_EXCH` for BMX NOC 0401 and M580.
//!
//! The calls are positional, as the documents print them; in IL the accumulator is the first argument. `ADR` and `TYP`
//! are the pins of DATA_EXCH in Control Expert help D-SA-0009555; `EMIS`, `GEST` and `RECP` are from memory. That an INT
//! takes `16#C0A8` as its bit pattern is from memory, too. Both ADDM (D-SA-0023454) and ADDMX (D-SE-0019648) make addresses
//! for DATA_EXCH.

mod address;
mod call;
mod exchange;
mod form;
mod il;
mod located;
mod read;
mod table;
mod variables;
mod words;
mod write;

pub(super) use self::exchange::is_exchange;
pub(super) use self::read::import;
pub(super) use self::write::export;

#[cfg(test)]
mod tests;

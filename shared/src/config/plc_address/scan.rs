//! From the first character to the last.

use alloc::string::String;
use alloc::vec::Vec;
use core::ops::Range;

use super::error::{AddressError, AddressErrorKind, Needed};
use super::{AddressDevice, AddressFunction, AddressMode, AddressPart, PlcAddress, Xway};
use crate::config::target_path::{DEFAULT_TCP_PORT, Endpoint, Host};

/// Our own limit: the longest address that can be written has less than 60 characters.
const MAX_ADDRESS: usize = 100;

/// Straight ones, and what word processors make of them.
const QUOTES: &str = "'\"\u{2018}\u{2019}\u{201A}\u{201B}\u{201C}\u{201D}\u{201E}\u{2032}\u{00B4}`";

pub(super) struct Scan<'a> {
    text: &'a str,
    /// The next byte: always the first of a character.
    at: usize,
    parts: Vec<AddressPart>,
}

type Scanned<T> = Result<T, AddressError>;

impl<'a> Scan<'a> {
    pub(super) const fn new(text: &'a str) -> Self {
        Self { text, at: 0, parts: Vec::new() }
    }

    pub(super) fn address(mut self) -> Scanned<(PlcAddress, Vec<AddressPart>)> {
        if self.text.trim().is_empty() {
            return Err(self.error(AddressErrorKind::Empty));
        }
        if self.text.chars().count() > MAX_ADDRESS {
            return Err(self.error(AddressErrorKind::TooLong));
        }
        let function = self.function()?;
        if function.is_some() && !self.take('(') {
            return Err(self.needed(Needed::Open));
        }
        let quoted = self.take_quote();
        let address = self.body(function)?;
        if quoted && !self.take_quote() {
            return Err(self.needed(Needed::Quote));
        }
        if function.is_some() && !self.take(')') {
            return Err(self.needed(Needed::Close));
        }
        self.blanks();
        if self.at < self.text.len() {
            return Err(self.error(AddressErrorKind::Surplus));
        }
        Ok((address, self.parts))
    }

    fn function(&mut self) -> Scanned<Option<AddressFunction>> {
        let (range, word) = self.word();
        let known = [
            (AddressFunction::Addr, "makes an address of the text: Premium, Atrium"),
            (AddressFunction::Addm, "makes an address of the text: M340"),
            (AddressFunction::Addmx, "makes an address of the text: M580"),
        ];
        if word.is_empty() {
            return Ok(None);
        }
        let found = known.into_iter().find(|(function, _)| word.eq_ignore_ascii_case(function.word()));
        let Some((function, text)) = found else {
            self.at = range.start;
            return Err(self.error(AddressErrorKind::UnknownFunction));
        };
        self.part(range, "function", text.into());
        Ok(Some(function))
    }

    fn body(&mut self, function: Option<AddressFunction>) -> Scanned<PlcAddress> {
        let xway = self.xway()?;
        let rack = self
            .number("the rack", "rack", |rack| alloc::format!("rack {rack} of the communication module"))?;
        let module = self.next_number("the module", "module", |module| {
            alloc::format!("position {module} of the communication module in its rack")
        })?;
        let channel = self.next_number("the channel", "channel", |channel| match channel {
            3 => "channel 3: known from modules with HART".into(),
            _ => alloc::format!("channel {channel} of the communication module"),
        })?;
        let device = self.device()?;
        Ok(PlcAddress { function, xway, rack, module, channel, device })
    }

    fn xway(&mut self) -> Scanned<Option<Xway>> {
        if !self.take('{') {
            return Ok(None);
        }
        let network = self.number("the network", "network", |network| {
            alloc::format!(
                "network {network}: bridges of the PLCs lead there; cipdeck goes straight to the IP address"
            )
        })?;
        let station =
            self.next_number("the station", "station", |station| alloc::format!("station {station}"))?;
        if self.take('}') { Ok(Some(Xway { network, station })) } else { Err(self.needed(Needed::Brace)) }
    }

    fn device(&mut self) -> Scanned<Option<AddressDevice>> {
        if self.take('.') {
            let device = AddressDevice::Dotted(self.endpoint()?);
            let (range, word) = self.word();
            if !word.is_empty() {
                self.at = range.start;
                return Err(self.error(AddressErrorKind::ModeWithoutDevice));
            }
            return Ok(Some(device));
        }
        if !self.take('{') {
            let before = self.at;
            let mode = self.mode()?;
            self.at = before;
            return if mode.is_none() {
                Ok(None)
            } else {
                Err(self.error(AddressErrorKind::ModeWithoutDevice))
            };
        }
        let endpoint = self.endpoint()?;
        if !self.take('}') {
            return Err(self.needed(Needed::Brace));
        }
        let mode = self.mode()?.ok_or_else(|| self.error(AddressErrorKind::MissingMode))?;
        Ok(Some(AddressDevice::Braced(endpoint, mode)))
    }

    fn endpoint(&mut self) -> Scanned<Endpoint> {
        self.blanks();
        let from = self.at;
        let mut ip = [0; 4];
        for (index, byte) in ip.iter_mut().enumerate() {
            if index > 0 && !self.take('.') {
                return Err(self.needed(Needed::Dot("the IP address's next number")));
            }
            (_, *byte) = self.digits("a part of the IP address")?;
        }
        let text = match ip {
            [0, 0, 0, 0] => "the built-in simulated device".into(),
            _ => alloc::format!("{}: the device", core::net::Ipv4Addr::from(ip)),
        };
        self.part(from..self.at, "ip", text);
        let port = if self.take(':') { self.port()? } else { DEFAULT_TCP_PORT };
        Ok(Endpoint { host: Host::Ip(ip), port })
    }

    fn port(&mut self) -> Scanned<u16> {
        self.blanks();
        let range = self.run(|c| c.is_ascii_digit());
        let port =
            self.text.get(range.clone()).and_then(|digits| digits.parse().ok()).filter(|port| *port != 0);
        let Some(port) = port else {
            self.at = range.start;
            return Err(self.error(AddressErrorKind::BadPort));
        };
        self.part(
            range,
            "port",
            alloc::format!("TCP port {port}: a controller always uses {DEFAULT_TCP_PORT}"),
        );
        Ok(port)
    }

    /// `UNC.CIP`, `CON.CIP`, or nothing.
    fn mode(&mut self) -> Scanned<Option<AddressMode>> {
        self.blanks();
        let range = self.run(|c| c.is_ascii_alphanumeric() || c == '.');
        let word = self.text.get(range.clone()).unwrap_or_default();
        if word.is_empty() {
            return Ok(None);
        }
        let known = [
            (AddressMode::Unconnected, "an unconnected EtherNet/IP message"),
            (AddressMode::Connected, "an EtherNet/IP message over a class 3 connection"),
        ];
        let found = known.into_iter().find(|(mode, _)| word.eq_ignore_ascii_case(mode.word()));
        let Some((mode, text)) = found else {
            self.at = range.start;
            return Err(self.error(AddressErrorKind::UnknownMode));
        };
        self.part(range, "mode", text.into());
        Ok(Some(mode))
    }

    fn next_number(
        &mut self,
        what: &'static str,
        name: &'static str,
        text: impl FnOnce(u8) -> String,
    ) -> Scanned<u8> {
        if self.take('.') { self.number(what, name, text) } else { Err(self.needed(Needed::Dot(what))) }
    }

    fn number(
        &mut self,
        what: &'static str,
        name: &'static str,
        text: impl FnOnce(u8) -> String,
    ) -> Scanned<u8> {
        let (range, number) = self.digits(what)?;
        self.part(range, name, text(number));
        Ok(number)
    }

    fn digits(&mut self, what: &'static str) -> Scanned<(Range<usize>, u8)> {
        self.blanks();
        let range = self.run(|c| c.is_ascii_digit());
        let digits = self.text.get(range.clone()).unwrap_or_default();
        if digits.is_empty() {
            return Err(self.needed(Needed::Number(what)));
        }
        let Ok(number) = digits.parse() else {
            self.at = range.start;
            return Err(self.error(AddressErrorKind::TooBig));
        };
        Ok((range, number))
    }

    fn word(&mut self) -> (Range<usize>, &'a str) {
        self.blanks();
        let range = self.run(char::is_alphabetic);
        (range.clone(), self.text.get(range).unwrap_or_default())
    }

    fn take(&mut self, wanted: char) -> bool {
        self.blanks();
        let found = self.rest().starts_with(wanted);
        self.at += if found { wanted.len_utf8() } else { 0 };
        found
    }

    fn take_quote(&mut self) -> bool {
        self.blanks();
        let quote = self.rest().chars().next().filter(|c| QUOTES.contains(*c));
        self.at += quote.map_or(0, char::len_utf8);
        quote.is_some()
    }

    fn blanks(&mut self) {
        self.run(char::is_whitespace);
    }

    fn run(&mut self, goes_on: impl Fn(char) -> bool) -> Range<usize> {
        let rest = self.rest();
        let length = rest.find(|c| !goes_on(c)).unwrap_or(rest.len());
        let from = self.at;
        self.at += length;
        from..self.at
    }

    fn rest(&self) -> &'a str {
        self.text.get(self.at..).unwrap_or_default()
    }

    fn part(&mut self, range: Range<usize>, name: &'static str, text: String) {
        self.parts.push(AddressPart { range, name, text });
    }

    fn needed(&self, needed: Needed) -> AddressError {
        self.error(AddressErrorKind::Expected(needed))
    }

    fn error(&self, kind: AddressErrorKind) -> AddressError {
        let before = self.text.get(..self.at).unwrap_or_default();
        AddressError { position: before.chars().count(), kind }
    }
}

//! Owns a poller, a device and the time.

use cipdeck_shared::engine::poll::{DeviceLimits, Failure, Group, Item, Poller, Quality, Reading};
use cipdeck_shared::engine::time::{Instant, Millis};

use crate::device::Device;

/// How long a device needs for an answer, µs.
pub(crate) const ANSWER: u64 = 500;

pub(crate) struct Owner {
    pub(crate) poller: Poller,
    pub(crate) device: Device,
    pub(crate) now: Instant,
    pub(crate) answer_us: u64,
    /// The cable is pulled.
    pub(crate) is_lost: bool,
    /// When each request was sent.
    pub(crate) sent: Vec<Instant>,
}

impl Owner {
    pub(crate) fn new(device: Device) -> Self {
        let limits =
            DeviceLimits::of(device.dialect, device.dialect == cipdeck_shared::tag::Dialect::Micro800);
        Self::with_limits(device, limits)
    }

    pub(crate) fn with_limits(device: Device, limits: DeviceLimits) -> Self {
        Self {
            poller: Poller::new(limits),
            device,
            now: Instant(1_000_000),
            answer_us: ANSWER,
            is_lost: false,
            sent: Vec::new(),
        }
    }

    /// Items are numbered from 10 times the group's number on. `name` or `name:type`.
    pub(crate) fn group(&mut self, id: u32, period: u64, names: &[&str]) {
        let items = names.iter().zip(10 * id..).map(|(text, id)| item(id, text)).collect();
        self.poller.put_group(Group { id, period: Millis(period), on: true, items }, self.now);
    }

    /// Time passes, and everything happens in its time.
    pub(crate) fn run(&mut self, ms: u64) {
        let end = self.now + Millis(ms);
        loop {
            while self.now < end
                && let Some(request) = self.poller.poll_request(self.now)
            {
                let limits = *self.poller.limits();
                assert!(request.bytes.len() <= limits.request_max, "{} bytes", request.bytes.len());
                assert_eq!(self.poller.poll_request(self.now), None, "one request at a time");
                self.sent.push(self.now);
                self.now = Instant(self.now.0 + self.answer_us);
                if self.is_lost {
                    let reason = "no answer".to_owned();
                    self.poller.handle_reply(self.now, Err(Failure::Lost { reason }));
                } else {
                    let reply = self.device.answer(&request.bytes);
                    self.poller.handle_reply(self.now, Ok(&reply));
                }
            }
            match self.poller.poll_timeout() {
                Some(next) if next < end && self.now < end => self.now = next.max(self.now),
                _ => break,
            }
        }
        self.now = self.now.max(end);
    }

    pub(crate) fn reading(&self, item: u32) -> &Reading {
        self.poller.reading(item).expect("an item")
    }

    /// Quality and value as a person sees them.
    pub(crate) fn shown(&self, item: u32) -> (Quality, String) {
        let reading = self.reading(item);
        (reading.quality, reading.value.as_ref().map_or(String::new(), ToString::to_string))
    }

    #[track_caller]
    pub(crate) fn all_good(&self, values: &[(u32, &str)]) {
        for (item, value) in values {
            assert_eq!(
                self.shown(*item),
                (Quality::Good, (*value).to_owned()),
                "{item} {:?}",
                self.reading(*item)
            );
        }
    }

    /// Requests since the last call.
    pub(crate) fn requests(&mut self) -> Vec<Vec<String>> {
        self.sent.clear();
        core::mem::take(&mut self.device.log)
    }
}

pub(crate) fn item(id: u32, text: &str) -> Item {
    let (name, kind) = match text.split_once(" : ") {
        Some((name, kind)) => (name, Some(kind.parse().expect("a type"))),
        None => (text, None),
    };
    Item { id, name: name.parse().expect("a name"), kind }
}

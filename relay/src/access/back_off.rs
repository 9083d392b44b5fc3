//! Whoever gives something wrong waits before the next attempt: 1 s, 2 s, 4 s … 5 min.
//!
//! An attempt counts as wrong until it has turned out to be right, so that many at once gain nothing. Strangers share
//! one count for each name; somebody who has signed in from an address before, and whoever is at the relay's machine,
//! has a count of their own there: nobody can lock out a user for ever.

use std::collections::{HashMap, HashSet};
use std::net::{IpAddr, Ipv6Addr};
use std::sync::Mutex;
use std::time::Duration;

use tokio::time::Instant;

use crate::error::ApiError;
use crate::runner::lock;

/// After the first wrong attempt.
const FIRST: Duration = Duration::from_secs(1);

/// At most.
const LONGEST: Duration = Duration::from_mins(5);

/// So long after its wait a count is forgotten.
const MEMORY: Duration = Duration::from_mins(15);

/// Wrong attempts of an address that cost nothing: several people may share it.
const FREE: u32 = 4;

/// Counts that are kept, and known places.
const MOST: usize = 4096;

/// What is counted.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Key {
    /// A user's name, tried from anywhere.
    Name(String),
    /// A user's name, tried from where the user has been before.
    NameAt(String, IpAddr),
    /// Passwords from an address.
    Address(IpAddr),
    /// Tokens and view links from an address.
    Secret(IpAddr),
    /// The set-up code.
    Code,
}

impl Key {
    const fn free(&self) -> u32 {
        match self {
            Self::Name(_) | Self::NameAt(..) | Self::Code => 0,
            Self::Address(_) | Self::Secret(_) => FREE,
        }
    }
}

/// Counts wrong attempts.
#[derive(Debug, Default)]
pub(super) struct BackOff(Mutex<Counts>);

#[derive(Debug, Default)]
struct Counts {
    by_key: HashMap<Key, Count>,
    /// Where users have signed in.
    places: HashSet<(String, IpAddr)>,
}

#[derive(Clone, Copy, Debug)]
struct Count {
    wrong: u32,
    until: Instant,
}

impl BackOff {
    /// What an attempt to sign in is counted under.
    pub(super) fn of_user(&self, name: &str, from: IpAddr) -> Vec<Key> {
        let place = place(from);
        let is_known = from.is_loopback() || lock(&self.0).places.contains(&(name.to_owned(), place));
        let name = name.to_owned();
        let of_name = if is_known { Key::NameAt(name, place) } else { Key::Name(name) };
        vec![of_name, Key::Address(place)]
    }

    /// What a token or a link is counted under.
    pub(super) fn of_secret(from: IpAddr) -> Vec<Key> {
        vec![Key::Secret(place(from))]
    }

    /// Before an attempt: refused while somebody has to wait; counted otherwise.
    pub(super) fn attempt(&self, keys: &[Key]) -> Result<(), ApiError> {
        let (mut counts, now) = (lock(&self.0), Instant::now());
        let waits = keys.iter().filter_map(|key| counts.by_key.get(key)).map(|count| count.until);
        if let Some(until) = waits.max().filter(|until| *until > now) {
            let retry_after = until - now;
            let seconds = retry_after.as_secs() + 1;
            let why = format!("after wrong attempts the relay waits: try again in {seconds} s");
            return Err(ApiError::TooMany { retry_after, why });
        }
        for key in keys {
            counts.make_room(now);
            let count = counts.by_key.entry(key.clone()).or_insert(Count { wrong: 0, until: now });
            if now > count.until + MEMORY {
                count.wrong = 0;
            }
            count.wrong = count.wrong.saturating_add(1);
            count.until = now + wait(count.wrong.saturating_sub(key.free()));
        }
        Ok(())
    }

    /// It was right.
    pub(super) fn was_right(&self, keys: &[Key]) {
        let mut counts = lock(&self.0);
        for key in keys {
            counts.by_key.remove(key);
        }
        let mut user = None;
        let mut from = None;
        for key in keys {
            match key {
                Key::Name(name) | Key::NameAt(name, _) => user = Some(name.clone()),
                Key::Address(place) => from = Some(*place),
                Key::Secret(_) | Key::Code => {}
            }
        }
        if let (Some(user), Some(from)) = (user, from)
            && counts.places.len() < MOST
        {
            counts.places.insert((user, from));
        }
    }

    /// It was neither: nobody has looked.
    pub(super) fn was_not_tried(&self, keys: &[Key]) {
        let (mut counts, now) = (lock(&self.0), Instant::now());
        for key in keys {
            if let Some(count) = counts.by_key.get_mut(key) {
                count.wrong = count.wrong.saturating_sub(1);
                count.until = now;
            }
        }
    }
}

impl Counts {
    /// Forgets what is old, and otherwise who waits least: an attacker's many names push out each other.
    fn make_room(&mut self, now: Instant) {
        if self.by_key.len() < MOST {
            return;
        }
        self.by_key.retain(|_, count| now <= count.until + MEMORY);
        while self.by_key.len() >= MOST {
            let first = self.by_key.iter().min_by_key(|(_, count)| count.until).map(|(key, _)| key.clone());
            let Some(first) = first else { return };
            self.by_key.remove(&first);
        }
    }
}

fn wait(wrong: u32) -> Duration {
    match wrong {
        0 => Duration::ZERO,
        wrong => FIRST.saturating_mul(1_u32.checked_shl(wrong - 1).unwrap_or(u32::MAX)).min(LONGEST),
    }
}

/// One machine has one IPv4 address, but a whole network of IPv6 addresses.
fn place(from: IpAddr) -> IpAddr {
    match from.to_canonical() {
        IpAddr::V4(ip) => IpAddr::V4(ip),
        IpAddr::V6(ip) => IpAddr::V6(Ipv6Addr::from_bits(ip.to_bits() >> 64 << 64)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERE: IpAddr = IpAddr::V4(std::net::Ipv4Addr::new(192, 0, 2, 1));
    const THERE: IpAddr = IpAddr::V4(std::net::Ipv4Addr::new(192, 0, 2, 2));

    fn waits(back_off: &BackOff, keys: &[Key]) -> Option<Duration> {
        match back_off.attempt(keys) {
            Ok(()) => None,
            Err(ApiError::TooMany { retry_after, .. }) => Some(retry_after),
            Err(other) => panic!("{other:?}"),
        }
    }

    #[tokio::test(start_paused = true)]
    async fn the_wait_doubles_up_to_five_minutes_and_is_forgotten_later() {
        let back_off = BackOff::default();
        let keys = back_off.of_user("anna", HERE);
        for seconds in [1, 2, 4, 8, 16, 32, 64, 128, 256, 300, 300] {
            assert_eq!(waits(&back_off, &keys), None);
            assert_eq!(waits(&back_off, &keys), Some(Duration::from_secs(seconds)));
            tokio::time::advance(Duration::from_secs(seconds)).await;
        }
        tokio::time::advance(MEMORY + Duration::from_secs(1)).await;
        assert_eq!(waits(&back_off, &keys), None);
        assert_eq!(waits(&back_off, &keys), Some(FIRST));
    }

    #[tokio::test(start_paused = true)]
    async fn of_many_attempts_at_once_one_is_tried() {
        let back_off = BackOff::default();
        let keys = back_off.of_user("anna", HERE);
        assert_eq!((0..100).filter(|_| waits(&back_off, &keys).is_none()).count(), 1);
    }

    #[tokio::test(start_paused = true)]
    async fn right_is_right_and_an_overloaded_relay_is_nobodys_fault() {
        let back_off = BackOff::default();
        let keys = back_off.of_user("anna", HERE);
        for _ in 0..20 {
            assert_eq!(waits(&back_off, &keys), None);
            back_off.was_right(&keys);
            let keys = back_off.of_user("anna", HERE);
            assert_eq!(waits(&back_off, &keys), None);
            back_off.was_not_tried(&keys);
        }
    }

    #[tokio::test(start_paused = true)]
    async fn strangers_lock_out_neither_who_was_here_before_nor_who_is_at_the_machine() {
        let back_off = BackOff::default();
        let mine = back_off.of_user("anna", HERE);
        assert_eq!(waits(&back_off, &mine), None);
        back_off.was_right(&mine);
        let stranger = back_off.of_user("anna", THERE);
        assert_eq!(waits(&back_off, &stranger), None);
        let other = back_off.of_user("anna", "2001:db8::1".parse().unwrap());
        assert!(waits(&back_off, &other).is_some(), "strangers share a count");
        assert_eq!(waits(&back_off, &back_off.of_user("anna", HERE)), None);
        assert_eq!(waits(&back_off, &back_off.of_user("anna", "127.0.0.1".parse().unwrap())), None);
    }

    #[tokio::test(start_paused = true)]
    async fn an_address_tries_many_names_no_faster_than_one() {
        let back_off = BackOff::default();
        let mut tried = 0;
        for number in 0..1_000 {
            let from = format!("2001:db8::{number:x}").parse().unwrap();
            tried += usize::from(waits(&back_off, &back_off.of_user(&format!("u{number}"), from)).is_none());
        }
        assert_eq!(tried, 5, "one network of IPv6 addresses is one machine");
    }

    #[tokio::test(start_paused = true)]
    async fn memory_is_bounded_and_the_longest_wait_is_kept() {
        let back_off = BackOff::default();
        let victim = [Key::Name("anna".to_owned())];
        for seconds in [1, 2, 4, 8] {
            assert_eq!(waits(&back_off, &victim), None);
            tokio::time::advance(Duration::from_secs(seconds)).await;
        }
        assert_eq!(waits(&back_off, &victim), None);
        for number in 0..2 * MOST {
            assert_eq!(waits(&back_off, &[Key::Name(format!("u{number}"))]), None);
        }
        assert!(lock(&back_off.0).by_key.len() <= MOST);
        assert_eq!(waits(&back_off, &victim), Some(Duration::from_secs(16)));
    }
}

//! What may be reached, and what operators may write. Everything else is denied.

use std::collections::HashMap;
use std::net::{IpAddr, SocketAddr};
use std::sync::{PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};

use cipdeck_shared::api::{AllowedTarget, AllowedWrite, NewAllowedTarget, NewAllowedWrite};
use cipdeck_shared::config::{Endpoint, Host, Target};
use cipdeck_shared::plan::Effect;
use cipdeck_shared::table::{self, Access};
use cipdeck_shared::wire::ClassCode;

use super::question::{Denied, Sending, place};
use super::target_rule::{RuleError, TargetRule};

/// Both lists, and the addresses that names stand for.
#[derive(Debug, Default)]
pub(crate) struct Lists(RwLock<Inner>);

#[derive(Debug, Default)]
struct Inner {
    targets: Vec<Entry<TargetRule>>,
    writes: Vec<Entry<WriteRule>>,
    /// Names are resolved once; they stand for the same addresses until a list changes.
    pinned: HashMap<String, Vec<IpAddr>>,
    /// Where the relay itself listens.
    own: Vec<SocketAddr>,
}

#[derive(Debug)]
struct Entry<T> {
    /// `None` for one of the configuration file.
    id: Option<u64>,
    rule: T,
    note: String,
}

/// A write that operators may send.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct WriteRule {
    target: TargetRule,
    service: u8,
    class: u16,
    instance: Option<u32>,
    attribute: Option<u16>,
}

impl TryFrom<&NewAllowedWrite> for WriteRule {
    type Error = RuleError;

    fn try_from(write: &NewAllowedWrite) -> Result<Self, RuleError> {
        let NewAllowedWrite { target, service, class, instance, attribute, .. } = write;
        let target = target.parse()?;
        Ok(Self { target, service: *service, class: *class, instance: *instance, attribute: *attribute })
    }
}

impl WriteRule {
    fn covers(&self, sending: &Sending, effect: &Effect) -> bool {
        sending.is_covered(effect, &self.target)
            && !effect.carries()
            && effect.service.0 == self.service
            && effect.class == Some(self.class)
            && (self.instance.is_none() || effect.instance == self.instance)
            && (self.attribute.is_none() || effect.attribute == self.attribute)
    }
}

impl Lists {
    /// What the relay listens on is no plant's device.
    pub(crate) fn listens_on(&self, address: SocketAddr) {
        self.write().own.push(address);
    }

    /// Another target. Names are resolved anew from now on.
    pub(crate) fn add_target(&self, id: Option<u64>, new: &NewAllowedTarget) -> Result<(), RuleError> {
        let entry = Entry { id, rule: new.target.parse()?, note: new.note.clone() };
        self.change(|lists| lists.targets.push(entry));
        Ok(())
    }

    /// Another write.
    pub(crate) fn add_write(&self, id: Option<u64>, new: &NewAllowedWrite) -> Result<(), RuleError> {
        let entry = Entry { id, rule: new.try_into()?, note: new.note.clone() };
        self.change(|lists| lists.writes.push(entry));
        Ok(())
    }

    /// One target less; whether it was there.
    pub(crate) fn remove_target(&self, id: u64) -> bool {
        self.change(|lists| remove(&mut lists.targets, id))
    }

    /// One write less; whether it was there.
    pub(crate) fn remove_write(&self, id: u64) -> bool {
        self.change(|lists| remove(&mut lists.writes, id))
    }

    /// All targets.
    pub(crate) fn targets(&self) -> Vec<AllowedTarget> {
        let lists = self.read();
        let view = |entry: &Entry<TargetRule>| AllowedTarget {
            id: entry.id,
            target: entry.rule.to_string(),
            note: entry.note.clone(),
            pinned: lists.pinned_by(&entry.rule),
        };
        lists.targets.iter().map(view).collect()
    }

    /// All writes.
    pub(crate) fn writes(&self) -> Vec<AllowedWrite> {
        let view = |entry: &Entry<WriteRule>| AllowedWrite {
            id: entry.id,
            write: NewAllowedWrite {
                target: entry.rule.target.to_string(),
                service: entry.rule.service,
                class: entry.rule.class,
                instance: entry.rule.instance,
                attribute: entry.rule.attribute,
                note: entry.note.clone(),
            },
        };
        self.read().writes.iter().map(view).collect()
    }

    /// Whether a message may go where it goes, the hops inside of it included.
    pub(super) fn allow(&self, sending: &Sending) -> Result<(), Denied> {
        let Target::Network(endpoint) = &sending.target else { return Ok(()) };
        let lists = self.read();
        if let Some(route) = sending.uncovered(&lists.targets.iter().map(|entry| &entry.rule)) {
            return Err(Denied::Target(place(&sending.target, route)));
        }
        match &endpoint.host {
            Host::Ip(ip) => lists.admit(SocketAddr::from((*ip, endpoint.port))),
            // Its addresses are checked when it is resolved, which is when the connection is made.
            Host::Name(_) => Ok(()),
        }
    }

    /// Whether an operator may send everything in it that is no read.
    pub(super) fn allow_write(&self, sending: &Sending) -> Result<(), Denied> {
        let lists = self.read();
        let is_listed = |effect: &Effect| lists.writes.iter().any(|entry| entry.rule.covers(sending, effect));
        match sending.effects.iter().find(|effect| effect.access != Access::Read && !is_listed(effect)) {
            Some(effect) => Err(Denied::NotOnList(words(effect))),
            None => Ok(()),
        }
    }

    /// Whether a connection may be made to an endpoint at all, before its name is resolved.
    pub(crate) fn allow_endpoint(&self, endpoint: &Endpoint) -> Result<(), Denied> {
        let lists = self.read();
        if !lists.targets.iter().any(|entry| entry.rule.covers_endpoint(endpoint)) {
            return Err(Denied::Target(endpoint.to_string()));
        }
        match &endpoint.host {
            Host::Ip(ip) => lists.admit(SocketAddr::from((*ip, endpoint.port))),
            Host::Name(_) => Ok(()),
        }
    }

    /// The addresses that a name stands for, if it has been resolved.
    pub(crate) fn pinned(&self, name: &str) -> Option<Vec<IpAddr>> {
        self.read().pinned.get(&name.to_ascii_lowercase()).cloned()
    }

    /// A name has been resolved: those of its addresses that may be reached. They stay the same from now on.
    pub(crate) fn pin(&self, name: &str, port: u16, addresses: Vec<IpAddr>) -> Result<Vec<IpAddr>, Denied> {
        let mut lists = self.write();
        let mut refused = Denied::Target(name.to_owned());
        let mut kept = Vec::new();
        for address in addresses {
            match lists.admit((address, port).into()) {
                Ok(()) => kept.push(address),
                Err(denied) => refused = denied,
            }
        }
        if kept.is_empty() {
            return Err(refused);
        }
        // Who was first is right: two attempts may resolve at the same time. What was pinned for one port may not be
        // reached at another.
        let mut pinned = lists.pinned.entry(name.to_ascii_lowercase()).or_insert(kept).clone();
        pinned.retain(|address| lists.admit((*address, port).into()).is_ok());
        if pinned.is_empty() { Err(refused) } else { Ok(pinned) }
    }

    fn change<T>(&self, change: impl FnOnce(&mut Inner) -> T) -> T {
        let mut lists = self.write();
        lists.pinned.clear();
        change(&mut lists)
    }

    fn read(&self) -> RwLockReadGuard<'_, Inner> {
        self.0.read().unwrap_or_else(PoisonError::into_inner)
    }

    fn write(&self) -> RwLockWriteGuard<'_, Inner> {
        self.0.write().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Inner {
    /// Addresses that no plant's device has are reached only where the list names them.
    fn admit(&self, address: SocketAddr) -> Result<(), Denied> {
        let ip = address.ip().to_canonical();
        if self.is_own(ip, address.port()) {
            let named = self.targets.iter().any(|entry| entry.rule.names_port(ip, address.port()));
            return if named {
                Ok(())
            } else {
                Err(Denied::Special(address.to_string(), "the relay itself"))
            };
        }
        match special(ip) {
            Some(kind) if !self.targets.iter().any(|entry| entry.rule.names(ip, address.port())) => {
                Err(Denied::Special(address.to_string(), kind))
            }
            _ => Ok(()),
        }
    }

    fn is_own(&self, ip: IpAddr, port: u16) -> bool {
        self.own.iter().any(|own| {
            own.port() == port
                && (own.ip() == ip || ip.is_loopback() || own.ip().is_unspecified() && is_of_this_machine(ip))
        })
    }

    fn pinned_by(&self, rule: &TargetRule) -> Vec<String> {
        let addresses = rule.name().and_then(|name| self.pinned.get(name));
        addresses.into_iter().flatten().map(IpAddr::to_string).collect()
    }
}

fn remove<T>(entries: &mut Vec<Entry<T>>, id: u64) -> bool {
    let before = entries.len();
    entries.retain(|entry| entry.id != Some(id));
    entries.len() < before
}

/// What an address is, if no device of a plant has it.
fn special(ip: IpAddr) -> Option<&'static str> {
    let is_link_local = match ip {
        IpAddr::V4(ip) => ip.is_link_local(),
        IpAddr::V6(ip) => ip.is_unicast_link_local(),
    };
    let is_broadcast = matches!(ip, IpAddr::V4(ip) if ip.is_broadcast());
    let is_nowhere = matches!(ip, IpAddr::V4(ip) if ip.octets()[0] == 0) || ip.is_unspecified();
    [
        (ip.is_loopback(), "the relay's own machine"),
        (is_link_local, "a link-local address"),
        (ip.is_multicast(), "a multicast address"),
        (is_broadcast, "a broadcast address"),
        (is_nowhere, "no address of a device"),
    ]
    .into_iter()
    .find_map(|(is, kind)| is.then_some(kind))
}

/// An interface that cannot be listed counts as ours.
fn is_of_this_machine(ip: IpAddr) -> bool {
    if_addrs::get_if_addrs().map_or(true, |all| all.iter().any(|interface| interface.ip() == ip))
}

fn words(effect: &Effect) -> String {
    // Names are those of tags.
    let class = effect.class.unwrap_or(ClassCode::Symbol.0);
    let service = table::service(class, effect.service).map_or("an unknown service", |row| row.name);
    if effect.class.is_none() {
        return format!("service {} {service}, of a tag: the list names objects only", effect.service.0);
    }
    let number = |value: Option<u32>| value.map_or_else(|| "?".to_owned(), |value| value.to_string());
    format!(
        "service {} {service}, class {}, instance {}, attribute {}",
        effect.service.0,
        number(effect.class.map(u32::from)),
        number(effect.instance),
        number(effect.attribute.map(u32::from))
    )
}

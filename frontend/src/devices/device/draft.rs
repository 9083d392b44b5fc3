//! A device as it is typed: texts, so that what is no number stays where it was typed.

use std::collections::BTreeMap;

use cipdeck_shared::{
    api::DiscoveredDevice,
    config::{Connecting, DEVICE_REQUESTS_PER_S, DEVICE_TIMEOUT_MS, DeviceConfig, Profile},
};
use yew::AttrValue;

use crate::{devices::i18n::tr, office::check};

/// What the form holds.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DeviceDraft {
    pub(super) name: String,
    pub(super) site: String,
    pub(super) path: String,
    pub(super) profile: String,
    pub(super) connection: String,
    pub(super) timeout: String,
    pub(super) limit: String,
    /// One per line: `Motor = STRUCT{speed: REAL}`.
    pub(super) types: String,
}

impl Default for DeviceDraft {
    fn default() -> Self {
        Self::of(&DeviceConfig::new("", ""))
    }
}

/// What is wrong with a draft, by field; the relay finds the rest.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct DeviceProblems {
    pub(super) name: Option<AttrValue>,
    pub(super) path: Option<AttrValue>,
    pub(super) timeout: Option<AttrValue>,
    pub(super) limit: Option<AttrValue>,
    pub(super) types: Option<AttrValue>,
}

impl DeviceDraft {
    /// As it is stored.
    pub(super) fn of(config: &DeviceConfig) -> Self {
        let types = config.types.iter().map(|(name, kind)| format!("{name} = {kind}\n"));
        Self {
            name: config.name.clone(),
            site: config.site.clone(),
            path: config.path.clone(),
            profile: config.profile.word().to_owned(),
            connection: config.connection.word().to_owned(),
            timeout: config.timeout_ms.to_string(),
            limit: config.max_requests_per_s.to_string(),
            types: types.collect(),
        }
    }

    /// What has answered on the network.
    pub(super) fn found(device: &DiscoveredDevice) -> Self {
        let path = match device.port {
            44_818 => format!("4,{}", device.address),
            port => format!("4,{}:{port}", device.address),
        };
        let name: String = device.name.trim().chars().take(64).collect();
        Self { name, path, ..Self::default() }
    }

    /// The configuration, or what is wrong.
    pub(super) fn read(&self) -> Result<DeviceConfig, DeviceProblems> {
        let (timeout, limit) =
            (check::number(&self.timeout, 250, 10_000), check::number(&self.limit, 1, 1_000));
        let types = read_types(&self.types);
        let problems = DeviceProblems {
            name: check::needed(&self.name),
            path: check::needed(&self.path),
            timeout: timeout.as_ref().err().cloned(),
            limit: limit.as_ref().err().cloned(),
            types: types.as_ref().err().cloned(),
        };
        if problems != DeviceProblems::default() {
            return Err(problems);
        }
        Ok(DeviceConfig {
            name: self.name.trim().to_owned(),
            site: self.site.trim().to_owned(),
            path: self.path.trim().to_owned(),
            profile: Profile::of_word(&self.profile).unwrap_or_default(),
            connection: Connecting::ALL
                .into_iter()
                .find(|it| it.word() == self.connection)
                .unwrap_or_default(),
            timeout_ms: timeout.map_or(DEVICE_TIMEOUT_MS, i64::from),
            max_requests_per_s: limit.map_or(DEVICE_REQUESTS_PER_S, i64::from),
            types: types.unwrap_or_default(),
        })
    }
}

fn read_types(text: &str) -> Result<BTreeMap<String, String>, AttrValue> {
    let mut types = BTreeMap::new();
    for (number, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let parts = line.split_once('=').map(|(name, kind)| (name.trim(), kind.trim()));
        let Some((name, kind)) = parts.filter(|(name, kind)| !name.is_empty() && !kind.is_empty()) else {
            return Err(tr!("device.types_line", line = number + 1));
        };
        if types.insert(name.to_owned(), kind.to_owned()).is_some() {
            return Err(tr!("device.types_twice", name = name));
        }
    }
    Ok(types)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_stored_comes_back() {
        let mut config = DeviceConfig::new("NX 1", "4,10.0.0.1");
        config.types.insert("Motor".to_owned(), "STRUCT{speed: REAL; run: BOOL}".to_owned());
        config.profile = Profile::Omron;
        assert_eq!(DeviceDraft::of(&config).read(), Ok(config));
    }

    #[test]
    fn wrong_texts_are_told_at_their_fields() {
        let wrong = DeviceDraft {
            timeout: "3 s".to_owned(),
            limit: "0".to_owned(),
            types: "Motor STRUCT{}".to_owned(),
            ..DeviceDraft::default()
        };
        let problems = wrong.read().unwrap_err();
        assert!(problems.name.is_some() && problems.path.is_some() && problems.timeout.is_some());
        assert!(problems.limit.is_some() && problems.types.unwrap().contains('1'));
        let twice = DeviceDraft { types: "A = INT\nA = DINT".to_owned(), ..DeviceDraft::default() };
        assert!(twice.read().unwrap_err().types.unwrap().contains('A'));
    }
}

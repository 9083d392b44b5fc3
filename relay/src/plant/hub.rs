//! The newest values of all variables and the newest status of all devices. State is kept, changes may be dropped: a
//! viewer asks for what is newer than the last thing that it has seen.

use std::collections::{BTreeMap, HashMap};
use std::sync::{Arc, Mutex};

use cipdeck_shared::api::{DeviceStatus, GroupValues};
use cipdeck_shared::config::{DeviceId, GroupId};
use tokio::sync::watch;

use super::point::{Point, Shown};
use crate::runner::lock;

/// What viewers look at.
#[derive(Debug)]
pub(crate) struct Hub {
    latest: Mutex<Latest>,
    version: watch::Sender<u64>,
}

#[derive(Debug, Default)]
struct Latest {
    version: u64,
    /// When devices or groups were changed.
    tree: u64,
    groups: BTreeMap<GroupId, Rows>,
    statuses: BTreeMap<DeviceId, (u64, DeviceStatus)>,
}

#[derive(Debug, Default)]
struct Rows {
    /// When variables were added, changed or removed.
    changed: u64,
    all: Vec<Row>,
    places: HashMap<u32, usize>,
}

/// Shared, so that it is put into words without anybody waiting.
#[derive(Clone, Debug)]
struct Row {
    shown: Arc<Shown>,
    point: Arc<Point>,
    version: u64,
}

/// How much one viewer has seen.
#[derive(Debug, Default)]
pub(crate) struct Seen {
    tree: Option<u64>,
    statuses: Option<u64>,
    groups: BTreeMap<GroupId, Option<u64>>,
}

/// News for one viewer.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct News {
    /// Devices or groups have changed.
    pub(crate) tree: bool,
    /// Watched groups whose variables have changed.
    pub(crate) variables: Vec<GroupId>,
    /// The newest values of watched groups.
    pub(crate) values: Vec<GroupValues>,
}

impl Default for Hub {
    fn default() -> Self {
        Self { latest: Mutex::default(), version: watch::Sender::new(0) }
    }
}

impl Hub {
    /// Changes whenever something has changed.
    pub(crate) fn watch(&self) -> watch::Receiver<u64> {
        self.version.subscribe()
    }

    /// Devices or groups have changed.
    pub(super) fn tree_changed(&self) {
        self.change(|latest, version| latest.tree = version);
    }

    /// What a group has now. Values of variables that are the same as before stay. When nothing looks different, viewers
    /// hear of it only if something else has `changed`.
    pub(super) fn put_group(&self, group: GroupId, shown: Vec<Shown>, changed: bool) {
        self.change(|latest, version| {
            let is_new = !latest.groups.contains_key(&group);
            let rows = latest.groups.entry(group).or_default();
            if !changed && !is_new && rows.all.iter().map(|row| &*row.shown).eq(&shown) {
                return;
            }
            let mut before: HashMap<_, _> = rows.all.drain(..).map(|row| (row.shown.variable, row)).collect();
            rows.places = shown.iter().enumerate().map(|(place, shown)| (shown.variable.0, place)).collect();
            let row = |shown: Shown| {
                let row = before.remove(&shown.variable).filter(|row| row.shown.address == shown.address);
                let point = row.map(|row| row.point).unwrap_or_default();
                Row { shown: Arc::new(shown), point, version }
            };
            rows.all = shown.into_iter().map(row).collect();
            rows.changed = version;
        });
    }

    /// A group is gone.
    pub(super) fn remove_group(&self, group: GroupId) {
        self.change(|latest, _| latest.groups.remove(&group));
    }

    /// New values of a group.
    pub(super) fn put_points(&self, points: impl IntoIterator<Item = (GroupId, u32, Point)>) {
        self.change(|latest, version| {
            for (group, variable, point) in points {
                let Some(rows) = latest.groups.get_mut(&group) else { continue };
                let row = rows.places.get(&variable).and_then(|place| rows.all.get_mut(*place));
                if let Some(row) = row {
                    (row.point, row.version) = (Arc::new(point), version);
                }
            }
        });
    }

    /// All values of a group become the same, as when it is turned off.
    pub(super) fn put_all_points(&self, group: GroupId, point: impl Fn(&Point) -> Point) {
        self.change(|latest, version| {
            for row in latest.groups.get_mut(&group).into_iter().flat_map(|rows| &mut rows.all) {
                (row.point, row.version) = (Arc::new(point(&row.point)), version);
            }
        });
    }

    /// How a device is now.
    pub(super) fn put_status(&self, status: DeviceStatus) {
        self.change(|latest, version| {
            let before = latest.statuses.get(&status.device);
            if before.is_none_or(|(_, before)| *before != status) {
                latest.statuses.insert(status.device, (version, status));
            }
        });
    }

    /// A device is gone.
    pub(super) fn remove_status(&self, device: DeviceId) {
        self.change(|latest, _| latest.statuses.remove(&device));
    }

    /// How a device is.
    pub(crate) fn status(&self, device: DeviceId) -> Option<DeviceStatus> {
        lock(&self.latest).statuses.get(&device).map(|(_, status)| status.clone())
    }

    /// All values of a group.
    pub(crate) fn values(&self, group: GroupId) -> Option<GroupValues> {
        let rows = lock(&self.latest).groups.get(&group).map(|rows| rows.newer(None))?;
        Some(in_words(group, &rows))
    }

    /// A viewer looks at these groups from now on. Those that it looked at before go on where they were.
    pub(crate) fn watch_groups(&self, seen: &mut Seen, groups: &[GroupId]) {
        let latest = lock(&self.latest);
        let there = groups.iter().filter(|group| latest.groups.contains_key(group));
        seen.groups = there.map(|group| (*group, seen.groups.get(group).copied().flatten())).collect();
    }

    /// What a viewer has not seen yet of what it looks at.
    pub(crate) fn news(&self, seen: &mut Seen) -> News {
        let latest = lock(&self.latest);
        let now = latest.version;
        let mut news =
            News { tree: seen.tree.is_none_or(|version| version < latest.tree), ..News::default() };
        let mut newer = Vec::new();
        seen.tree = Some(now);
        seen.groups.retain(|group, _| latest.groups.contains_key(group));
        for (group, version) in &mut seen.groups {
            let Some(rows) = latest.groups.get(group) else { continue };
            if version.is_some_and(|version| version < rows.changed) {
                news.variables.push(*group);
            }
            let rows = rows.newer(*version);
            if version.is_none() || !rows.is_empty() {
                newer.push((*group, rows));
            }
            *version = Some(now);
        }
        drop(latest);
        news.values = newer.iter().map(|(group, rows)| in_words(*group, rows)).collect();
        news
    }

    /// The statuses that a viewer has not seen yet.
    pub(crate) fn statuses(&self, seen: &mut Seen) -> Vec<DeviceStatus> {
        let latest = lock(&self.latest);
        let before = seen.statuses.replace(latest.version);
        let newer =
            latest.statuses.values().filter(|(version, _)| before.is_none_or(|before| *version > before));
        newer.map(|(_, status)| status.clone()).collect()
    }

    /// Whether there are such.
    pub(crate) fn has_statuses(&self, seen: &Seen) -> bool {
        let latest = lock(&self.latest);
        latest.statuses.values().any(|(version, _)| seen.statuses.is_none_or(|before| *version > before))
    }

    fn change<T>(&self, call: impl FnOnce(&mut Latest, u64) -> T) {
        let mut latest = lock(&self.latest);
        latest.version += 1;
        let version = latest.version;
        call(&mut latest, version);
        drop(latest);
        self.version.send_replace(version);
    }
}

impl Rows {
    fn newer(&self, seen: Option<u64>) -> Vec<Row> {
        self.all.iter().filter(|row| seen.is_none_or(|seen| row.version > seen)).cloned().collect()
    }
}

fn in_words(group: GroupId, rows: &[Row]) -> GroupValues {
    GroupValues { group, values: rows.iter().map(|row| row.shown.value(&row.point)).collect() }
}

#[cfg(test)]
mod tests {
    use cipdeck_shared::api::Quality;
    use cipdeck_shared::config::VariableId;
    use cipdeck_shared::tag::{Value, View};

    use super::*;

    const G: GroupId = GroupId(1);

    fn shown(id: u32, address: &str) -> Shown {
        Shown {
            variable: VariableId(id),
            address: address.to_owned(),
            view: View::default(),
            unit: String::new(),
            wrong: None,
        }
    }

    fn point(value: i64) -> Point {
        Point { quality: Quality::Good, value: Some(Value::Signed(value)), ..Point::default() }
    }

    fn told(news: &News) -> Vec<(u32, String)> {
        let values = news.values.iter().flat_map(|group| &group.values);
        values.map(|value| (value.variable.0, value.text.clone())).collect()
    }

    #[test]
    fn a_viewer_gets_everything_first_and_then_the_newest_of_what_has_changed() {
        let hub = Hub::default();
        hub.put_group(G, vec![shown(1, "a"), shown(2, "b")], false);
        let mut seen = Seen::default();
        hub.watch_groups(&mut seen, &[G, GroupId(9)]);
        let first = hub.news(&mut seen);
        assert_eq!((first.tree, told(&first).len()), (true, 2));
        assert_eq!(hub.news(&mut seen), News::default(), "nothing new");
        hub.put_points([(G, 1, point(7))]);
        hub.put_points([(G, 1, point(8)), (GroupId(9), 1, point(9)), (G, 9, point(9))]);
        assert_eq!(told(&hub.news(&mut seen)), [(1, "8".to_owned())]);
    }

    #[test]
    fn a_changed_group_is_told_and_values_of_the_same_variables_stay() {
        let hub = Hub::default();
        hub.put_group(G, vec![shown(1, "a"), shown(2, "b")], false);
        hub.put_points([(G, 1, point(7)), (G, 2, point(8))]);
        let mut seen = Seen::default();
        hub.watch_groups(&mut seen, &[G]);
        hub.news(&mut seen);
        hub.put_group(G, vec![shown(2, "b"), shown(1, "other"), shown(3, "c")], false);
        let news = hub.news(&mut seen);
        assert_eq!(news.variables, [G]);
        let empty = String::new();
        assert_eq!(told(&news), [(2, "8".to_owned()), (1, empty.clone()), (3, empty)]);
        hub.remove_group(G);
        assert_eq!(hub.news(&mut seen), News::default());
    }
}

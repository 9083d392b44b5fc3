//! How components learn of what the relay says.

use std::{cell::Cell, rc::Rc};

use cipdeck_shared::{
    api::DeviceStatus,
    config::{DeviceId, GroupId, VariableId},
};
use gloo_timers::callback::Interval;
use yew::prelude::*;

use super::{Plant, Shown, Tree};

/// The connection, from the context; renders when anything but a value changes.
#[hook]
pub fn use_plant() -> Plant {
    let plant = use_context::<Plant>().expect("the document provides a Plant");
    let update = use_force_update();
    use_effect_with(plant.clone(), move |plant| {
        let watch = plant.watch(Callback::from(move |()| update.force_update()));
        move || drop(watch)
    });
    plant
}

/// The tree; renders when anything but a value changes.
#[hook]
pub fn use_tree() -> Option<Rc<Tree>> {
    use_plant().tree()
}

/// What a device says of itself.
#[hook]
pub fn use_device_status(id: DeviceId) -> Option<Rc<DeviceStatus>> {
    use_plant().status(id)
}

/// One value; renders once in a frame in which it has changed.
#[hook]
pub fn use_value(id: VariableId) -> Option<Rc<Shown>> {
    let store = use_context::<Plant>().expect("the document provides a Plant").values().clone();
    let update = use_force_update();
    use_effect_with((store.clone(), id), move |(store, id)| {
        let watch = store.watch(*id, Callback::from(move |()| update.force_update()));
        move || drop(watch)
    });
    store.value(id)
}

/// Asks for the values of a group as long as the component is there.
#[hook]
pub fn use_watched(group: GroupId) {
    let plant = use_context::<Plant>().expect("the document provides a Plant");
    use_effect_with((plant, group), |(plant, group)| {
        plant.want(*group);
        let (plant, group) = (plant.clone(), *group);
        move || plant.leave(group)
    });
}

/// Renders at most every so many ms while values change, unless it is `paused`: for what looks at many of them.
#[hook]
pub fn use_frames(every_ms: u32, paused: bool) {
    let plant = use_context::<Plant>().expect("the document provides a Plant");
    let update = use_force_update();
    use_effect_with((plant, every_ms, paused), move |(plant, every_ms, paused)| {
        let changed = Rc::new(Cell::new(true));
        let wake = Callback::from({
            let changed = changed.clone();
            move |()| changed.set(true)
        });
        let running = (!*paused).then(|| {
            let ticks = Interval::new(*every_ms, move || {
                if changed.replace(false) {
                    update.force_update();
                }
            });
            (plant.values().watch_frames(wake), ticks)
        });
        move || drop(running)
    });
}

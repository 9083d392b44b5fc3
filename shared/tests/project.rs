//! A project comes back from its files as it was, whatever people call things and whatever else stands in the files.
#![cfg(not(target_arch = "wasm32"))]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::indexing_slicing, reason = "a test may fail")]

extern crate alloc;

use alloc::collections::BTreeMap;

use cipdeck_shared::config::project::{
    PROJECT_HEAD, Project, ProjectGroup, ProjectTarget, ProjectVariable, files, free_file_name, is_portable,
    read,
};
use cipdeck_shared::config::{
    BlockConfig, DeviceConfig, Extra, MsgCipGeneric, SendReq, SendReqForm, VariableConfig,
};
use proptest::collection::{btree_map, vec};
use proptest::prelude::*;
use serde_json::Value;

/// Members that somebody else's tool has added. Their names begin like none of ours.
fn extra() -> impl Strategy<Value = Extra> {
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<i64>().prop_map(Value::from),
        any::<u64>().prop_map(Value::from),
        any::<f64>().prop_filter("JSON has no others", |number| number.is_finite()).prop_map(Value::from),
        ".{0,12}".prop_map(Value::from),
    ];
    let value = leaf.prop_recursive(3, 12, 4, |inner| {
        prop_oneof![
            vec(inner.clone(), 0..4).prop_map(Value::from),
            btree_map(".{0,6}", inner, 0..4).prop_map(|members| Value::Object(members.into_iter().collect())),
        ]
    });
    btree_map("x .{0,8}", value, 0..3)
}

fn block() -> impl Strategy<Value = BlockConfig> {
    (".{0,20}", any::<i64>(), any::<[i64; 3]>(), ".{0,30}", extra(), extra()).prop_map(
        |(name, service, members, path, outer, inner)| {
            let mut config = MsgCipGeneric::product_name(&path);
            config.name = name;
            config.app_cfg.service = service;
            config.app_cfg.member_id = members.to_vec();
            config.extra = outer;
            config.app_cfg.extra = inner.clone();
            config.target_cfg.extra = inner;
            config.into()
        },
    )
}

fn words_block() -> impl Strategy<Value = BlockConfig> {
    let form = proptest::sample::select(SendReqForm::ALL.as_slice());
    (form, ".{0,20}", ".{0,30}", ".{0,40}", any::<[i64; 4]>(), any::<i64>(), extra()).prop_map(
        |(form, name, address, data, management, period, extra)| {
            let mut config = SendReq::new(form, &name);
            config.address = address;
            config.data_to_send = data;
            config.management_param = management.to_vec();
            config.period = period;
            config.extra = extra;
            config.into()
        },
    )
}

fn group() -> impl Strategy<Value = ProjectGroup> {
    let variable =
        (".{0,10}", any::<f64>().prop_filter("JSON", |min| min.is_finite()), any::<i64>(), extra());
    (".{0,20}", any::<i64>(), any::<bool>(), vec(variable, 0..4), extra()).prop_map(
        |(name, period_ms, on, variables, extra)| {
            let variable = |(place, (name, min, order, extra)): (usize, (String, f64, i64, Extra))| {
                let config = VariableConfig {
                    min: Some(min),
                    order,
                    ..VariableConfig::new(&name, &format!("v{place}"))
                };
                ProjectVariable { parent_address: None, config, extra }
            };
            let variables = variables.into_iter().enumerate().map(variable).collect();
            ProjectGroup { name, period_ms, on, order: 0, variables, extra }
        },
    )
}

fn project() -> impl Strategy<Value = Project> {
    let target = (".{0,20}", vec(group(), 0..3), extra());
    (vec(prop_oneof![block(), words_block()], 0..4), vec(target, 0..3), extra()).prop_map(
        |(blocks, targets, extra)| {
            let mut project = Project::default();
            project.head.extra = extra;
            for block in blocks {
                let file = free_file_name(block.name(), |file| project.blocks.contains_key(file));
                project.blocks.insert(file, block);
            }
            for (name, groups, extra) in targets {
                let config = DeviceConfig::new(&name, "0,0");
                let mut target = ProjectTarget { config, extra, groups: BTreeMap::new() };
                for group in groups {
                    let file = free_file_name(&group.name, |file| target.groups.contains_key(file));
                    target.groups.insert(file, group);
                }
                let file = free_file_name(&name, |file| project.targets.contains_key(file));
                project.targets.insert(file, target);
            }
            project
        },
    )
}

proptest! {
    #[test]
    fn written_read_and_written_again_is_the_same_text(project in project()) {
        let written = files(&project);
        let found = read(&written);
        prop_assert!(found.errors.is_empty(), "{:?}", found.errors);
        prop_assert_eq!(&found.project, &project);
        prop_assert_eq!(files(&found.project), written);
    }

    #[test]
    fn every_path_that_is_written_is_one_that_every_file_system_has(project in project()) {
        for path in files(&project).keys() {
            for step in path.split('/') {
                prop_assert!(is_portable(step), "{path}");
            }
        }
    }

    #[test]
    fn whatever_stands_in_a_file_is_read_or_refused(text in "[{}\\[\\]\":,0-9a-z\\\\ .eE+-]{0,60}|.{0,40}", place in 0..4_usize) {
        let path = ["blocks/a.json", "targets/a.json", "groups/a/a.json", PROJECT_HEAD][place];
        let found = read(&[(path.to_owned(), text)].into());
        prop_assert_eq!(found.errors.is_empty() || !found.errors[0].to_string().is_empty(), true);
    }

    #[test]
    fn half_a_file_says_where_it_ends(project in project(), cut in 0..4_000_usize) {
        for (path, text) in files(&project) {
            let half = &text[..text.floor_char_boundary(cut.min(text.len().saturating_sub(3)))];
            let found = read(&[(path.clone(), half.to_owned())].into());
            prop_assert!(found.errors.iter().any(|error| error.file == path && error.position.is_some()), "{path}");
        }
    }
}

use alloc::string::String;
use alloc::vec;

use super::*;
use crate::config::SendReqForm;
use crate::engine::status::{Cause, RefusedBy};
use crate::table::{self, MESSAGE_REFUSED, ReportList};

fn started(form: SendReqForm) -> BlockView {
    let plan = WordsPlan {
        form,
        words: vec![],
        length: 10,
        timeout_ms: Some(3_000),
        connected: false,
        received_words: 4,
    };
    let words = Some(Arc::new(Words::started(Arc::new(plan), 6)));
    BlockView { input: true, phase: Phase::Sent, words, ..BlockView::default() }
}

fn ended(form: SendReqForm, cause: Option<Cause>, reply: &[u8]) -> Management {
    let mut view = started(form);
    view.words = view.words.map(|words| Arc::new(words.answered(reply.to_vec())));
    view.phase = if cause.is_some() { Phase::Failed } else { Phase::Done };
    view.cause = cause;
    Management::of(&view).unwrap()
}

#[test]
fn the_activity_bit_is_up_while_it_runs_and_the_length_changes_with_it() {
    let running = Management::of(&started(SendReqForm::Etc100)).unwrap();
    assert_eq!((running.activity, running.reports), (0x0701, 0));
    assert_eq!((running.timeout_and_length, running.received.len(), running.eno), (Some([30, 10]), 0, true));
    let done = ended(SendReqForm::Etc100, None, &[0x8E, 0, 0, 0, 0x34, 0x12]);
    assert_eq!((done.activity, done.reports, done.timeout_and_length), (0x0700, 0, Some([30, 6])));
    assert_eq!(done.received, [0x8E, 0, 0, 0, 0x34, 0x12]);
    assert_eq!(Management::of(&BlockView::default()), None, "a block without words has none");
}

#[test]
fn exchange_numbers_go_round_without_0() {
    let plan = match &started(SendReqForm::DataExch).words.unwrap().start {
        Ok(plan) => Arc::clone(plan),
        Err(report) => panic!("{report}"),
    };
    for (before, number) in [(0, 1), (1, 2), (254, 255), (255, 1)] {
        assert_eq!(Words::started(Arc::clone(&plan), before).exchange, number);
    }
}

#[test]
fn a_refusal_of_the_device_is_a_correct_exchange_with_its_status_in_the_data() {
    let refused =
        ended(SendReqForm::Etc100, Some(Cause::new(CauseKind::RefusedByDevice)), &[0x8E, 0, 5, 1, 0, 0]);
    assert_eq!((refused.reports, refused.received), (0, vec![0x8E, 0, 5, 1, 0, 0]));
    let long = [0x8E, 0, 5, 4, 0, 0, 0, 0, 0, 0, 0, 0];
    let cut = ended(SendReqForm::Etc100, Some(Cause::new(CauseKind::RefusedByDevice)), &long);
    assert_eq!((cut.reports, cut.received, cut.timeout_and_length), (0x0009, vec![], Some([30, 0])));
}

#[test]
fn a_start_that_is_refused_never_raises_the_activity_bit() {
    let words = Some(Arc::new(Words::refused(0x03, 6)));
    let cause = Some(Cause::new(CauseKind::Invalid));
    let view = BlockView { input: true, phase: Phase::Waiting, words, cause, ..BlockView::default() };
    let refused = Management::of(&view).unwrap();
    assert_eq!((refused.activity, refused.reports, refused.eno), (0x0600, 0x0003, false));
    let view = BlockView { phase: Phase::Failed, words: None, ..view };
    assert_eq!(Management::invalid(&view).map(|refused| refused.reports), Some(0x0006));
}

#[test]
fn every_cause_has_a_report_that_the_tables_explain_and_none_looks_like_success() {
    for form in SendReqForm::ALL {
        for what in CauseKind::ALL {
            let is_refusal = what == CauseKind::RefusedByDevice;
            let (communication, operation) = reports::of(form, Some(&Cause::new(what.clone())));
            assert_eq!(communication == 0, is_refusal, "{what:?}");
            assert!(table::communication_report(communication).is_some());
            let list = if form == SendReqForm::Etc100 { ReportList::Etc100 } else { ReportList::DataExch };
            if communication == MESSAGE_REFUSED {
                let entry = table::operation_report(list, communication, operation);
                assert!(entry.is_some(), "{form:?} {what:?} {operation:02x}");
            } else {
                assert_eq!(operation, 0);
            }
        }
        let open = Cause { by: Some(RefusedBy::ForwardOpen), ..Cause::new(CauseKind::RefusedByDevice) };
        assert_eq!(reports::of(form, Some(&open)).0, MESSAGE_REFUSED, "its message has never been sent");
    }
}

#[test]
fn the_document_has_the_table_of_reports() {
    let document = include_str!("../../../../docs/SEND_REQ.md");
    for row in REPORTS {
        let what = String::from(row.cause.clone());
        let by = if row.by.is_some() { " by `forward_open`" } else { "" };
        let line = document.lines().find(|line| {
            line.strip_prefix("| `").and_then(|line| line.strip_prefix(&what)).is_some_and(|rest| {
                let rest = rest.strip_prefix('`').and_then(|rest| rest.strip_prefix(by));
                rest.is_some_and(|rest| rest.starts_with([':', ' ']) && !rest.starts_with(" by"))
            })
        });
        let line = line.unwrap_or_else(|| panic!("{what}{by} is not in docs/SEND_REQ.md"));
        let shown =
            |(communication, operation): (u8, u8)| alloc::format!("{communication:02X} / {operation:02X}");
        let known = if row.is_confirmed { "confirmed" } else { "inferred" };
        let columns = alloc::format!(" | {} | {} | {known} |", shown(row.etc100), shown(row.exchange));
        assert!(line.ends_with(&columns), "{line} has to end with{columns}");
    }
}

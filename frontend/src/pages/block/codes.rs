//! The numbers of an error in words, from the tables.

use cipdeck_shared::{
    engine::CipStatus,
    table::{self, Entry},
    wire::{EncapsulationStatus, GeneralStatus},
};

/// The rows that explain a status, the most telling first.
pub(super) fn entries(status: &CipStatus, encapsulation: Option<u32>) -> Vec<Entry> {
    let block = table::block_error(status.error_id, status.sub_error_id);
    let cip = is_cip(status).then(|| {
        let general = GeneralStatus(u8::try_from(status.sub_error_id).ok()?);
        let extended =
            table::extended_status(general, status.ext_error_id).filter(|_| status.ext_error_id != 0);
        Some((table::general_status(general), extended))
    });
    let (general, extended) = cip.flatten().unwrap_or_default();
    let encapsulation =
        encapsulation.and_then(|status| table::encapsulation_status(EncapsulationStatus(status)));
    [extended, general, encapsulation, block].into_iter().flatten().collect()
}

/// Whether the `SubErrorID` is a CIP general status.
fn is_cip(status: &CipStatus) -> bool {
    status.error_id == CIP_ERROR
}

/// `ErrorID` of a CIP error reply. Source: `data/block_errors.tsv`.
const CIP_ERROR: u16 = 224;

/// One line: `224/5 Path destination unknown`.
pub(crate) fn error_words(status: &CipStatus) -> String {
    let codes = match status.sub_error_id {
        0 => status.error_id.to_string(),
        sub => format!("{}/{sub}", status.error_id),
    };
    let name = entries(status, None).first().map_or("", |entry| entry.name);
    format!("{codes} {name}").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use cipdeck_shared::engine::CauseKind;

    fn status(error_id: u16, sub_error_id: u16) -> CipStatus {
        CipStatus { error: true, error_id, sub_error_id, ..CipStatus::default() }
    }

    #[test]
    fn a_refusal_is_named_by_its_general_status() {
        assert_eq!(
            error_words(&status(224, 5)),
            format!("224/5 {}", table::general_status(GeneralStatus(5)).unwrap().name)
        );
    }

    #[test]
    fn a_timeout_is_named_by_its_phase_and_an_unknown_code_by_its_number() {
        let timeout = table::block_error(55, 115).unwrap();
        assert_eq!(error_words(&status(55, 115)), format!("55/115 {}", timeout.name));
        assert_eq!(error_words(&status(4711, 0)), "4711");
    }

    #[test]
    fn every_cause_that_we_know_has_a_text_and_something_to_try() {
        let on_the_way = ["refused_by_router", "connection_refused"];
        for key in CauseKind::ALL.iter().map(CauseKind::word).chain(on_the_way) {
            assert!(crate::i18n::find(crate::i18n::CAUSE, key).is_some(), "cause.{key}");
            assert!(crate::i18n::find(crate::i18n::TRY, key).is_some(), "try.{key}");
        }
    }
}

//! How a draft is kept over a reload.

use cipdeck_shared::config::BlockConfig;
use serde::{Deserialize, Serialize};

use super::{data_as::DataAs, draft::Draft, number::NUMBERS, part::Part};
use crate::editor::{Editable, Keepable};

/// One draft: a line of JSON.
#[derive(Serialize, Deserialize)]
struct Kept {
    id: String,
    revision: Option<u64>,
    config: BlockConfig,
    numbers: Vec<(String, String)>,
    parts: Vec<(String, String)>,
    auto_length: bool,
    raw_path: bool,
    data_as: String,
}

impl Keepable for Draft {
    fn write(&self, id: &str) -> Option<String> {
        let kept = Kept {
            id: id.to_owned(),
            revision: self.revision,
            config: self.config.clone().into(),
            numbers: self.numbers.iter().map(|(field, text)| (field.to_string(), text.clone())).collect(),
            parts: self.parts.iter().map(|(part, text)| (part.word().to_owned(), text.clone())).collect(),
            auto_length: self.auto_length,
            raw_path: self.raw_path,
            data_as: self.data_as.word().to_owned(),
        };
        serde_json::to_string(&kept).ok()
    }

    fn read(line: &str) -> Option<(String, Self)> {
        let kept: Kept = serde_json::from_str(line).ok()?;
        let BlockConfig::SendReq(config) = kept.config else { return None };
        let mut draft = Self::new(config, kept.revision);
        for field in NUMBERS {
            let name = field.to_string();
            if let Some((_, text)) = kept.numbers.iter().find(|(kept, _)| *kept == name) {
                draft.numbers.insert(field, text.clone());
            }
        }
        for part in Part::ALL {
            if let Some((_, text)) = kept.parts.iter().find(|(kept, _)| kept == part.word()) {
                draft.parts.insert(part, text.clone());
            }
        }
        draft.auto_length = kept.auto_length;
        draft.raw_path = kept.raw_path;
        draft.data_as = DataAs::of_word(&kept.data_as).unwrap_or_default();
        Some((kept.id, draft))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::words::edit::Edit;
    use cipdeck_shared::{
        config::{SendReq, SendReqForm},
        plan::Field,
    };

    #[test]
    fn a_draft_survives_a_reload_with_every_text_that_was_typed() {
        let mut draft = Draft::new(SendReq::new(SendReqForm::Etc101, "read"), Some(3));
        draft.edit(Edit::Words("0000 C0A8 0166 024E 4420 0124 0000 000A".to_owned()));
        draft.edit(Edit::DataAs(DataAs::Uint));
        draft.edit(Edit::Part(Part::Instance, "1x".to_owned()));
        draft.edit(Edit::Number(Field::ManagementParam(2), "3s".to_owned()));
        draft.edit(Edit::AutoLength(false));
        let line = draft.write("b7").unwrap();
        assert!(!line.contains('\n'));
        assert_eq!(Draft::read(&line), Some(("b7".to_owned(), draft)));
        assert_eq!(Draft::read("not json"), None);
    }
}

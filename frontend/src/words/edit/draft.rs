//! What somebody is typing: keeps every text, and the configuration as far as it is readable.
//!
//! The words are the truth. The fields of `Data_to_Send` are read from them; a field that is typed is kept as text, and
//! changes the words as soon as all fields can be read. Typing words gives up the texts of the fields.

use cipdeck_shared::{
    api,
    config::{Channel, Profile, SendReq, read_number, read_words, write_words},
    plan::{
        Field,
        words::{FieldsError, WordsFields, WordsPath},
    },
};

use super::{
    data_as::DataAs,
    number::{number, set_number},
    part::{self, Part},
};
use crate::{editor::Editable, store::Shelf};

mod check;

/// A block that is being edited.
#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    /// The stored revision that it started from; none for a block that is not stored yet.
    pub revision: Option<u64>,
    /// Everything readable.
    pub config: SendReq,
    /// Numbers as typed.
    pub(super) numbers: Shelf<Field, String>,
    /// Fields of `Data_to_Send` as typed.
    pub(super) parts: Shelf<Part, String>,
    /// Whether `Management_Param[3]` follows the words.
    pub auto_length: bool,
    /// Whether the path is typed as bytes.
    pub raw_path: bool,
    /// How data is shown.
    pub data_as: DataAs,
    /// What the relay did not accept, until something is changed.
    refused: Vec<api::Finding>,
}

/// One change.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// The text of a number field.
    Number(Field, String),
    /// `name`, `Address`, `ReqLayout` or `ResLayout`.
    Text(Field, String),
    /// `Data_to_Send`, as words.
    Words(String),
    /// A field of `Data_to_Send`.
    Part(Part, String),
    /// How the path is typed.
    RawPath(bool),
    /// How data is shown.
    DataAs(DataAs),
    /// Whether `Management_Param[3]` follows the words.
    AutoLength(bool),
    /// Gives up what was typed into fields and cannot be read.
    ForgetParts,
    /// `Resume`
    Resume(bool),
    /// `Channel`
    Channel(Channel),
    /// `Profile`
    Profile(Profile),
}

/// What the words say, for the fields.
#[derive(Clone, Debug, PartialEq)]
pub enum Fields {
    /// They can be shown and changed.
    Of(WordsFields),
    /// There are no words yet: the fields are empty.
    Empty,
    /// The words themselves cannot be read.
    Unreadable,
    /// There is no request in them.
    NoRequest(FieldsError),
}

impl Draft {
    /// The words, if they can be read.
    pub fn words(&self) -> Option<Vec<u16>> {
        read_words(&self.config.data_to_send).ok()
    }

    /// `Management_Param[3]`, whatever it holds.
    pub fn length(&self) -> i64 {
        number(&self.config, &Field::ManagementParam(3)).unwrap_or_default()
    }

    /// The text of a number field.
    pub fn number(&self, field: &Field) -> String {
        let plain = || number(&self.config, field).map(|value| value.to_string());
        self.numbers.get(field).cloned().or_else(plain).unwrap_or_default()
    }

    /// What the words say, for the fields.
    pub fn fields(&self) -> Fields {
        let Some(words) = self.words() else { return Fields::Unreadable };
        if words.is_empty() {
            return Fields::Empty;
        }
        // The high byte of a half word is no data. Everything else is, also what another length leaves out.
        let is_half = self.auto_length && self.length() == odd_length(&words);
        let length = 2 * words.len() - usize::from(is_half);
        match WordsFields::read(self.config.form(), &words, length) {
            Ok(fields) => Fields::Of(fields),
            Err(error) => Fields::NoRequest(error),
        }
    }

    /// The text of a field of `Data_to_Send`.
    pub fn part(&self, part: Part) -> String {
        self.parts.get(&part).cloned().unwrap_or_else(|| self.plain_part(part))
    }

    /// The texts of fields that are not in the words, because one of the fields cannot be read.
    pub fn waiting_parts(&self) -> Vec<(Part, String)> {
        if self.wrong_parts().is_empty() {
            return Vec::new();
        }
        let differs = |(part, text): &(Part, String)| *text != self.plain_part(*part);
        self.parts.iter().map(|(part, text)| (*part, text.clone())).filter(differs).collect()
    }

    /// Whether the path cannot be written as numbers.
    pub fn needs_raw_path(&self) -> bool {
        matches!(self.fields(), Fields::Of(WordsFields { path: WordsPath::Other(_), .. }))
    }

    fn plain_part(&self, part: Part) -> String {
        match self.fields() {
            Fields::Of(parts) => part.write(&parts, self.data_as),
            _ if part == Part::MessageType => "0".to_owned(),
            _ => String::new(),
        }
    }

    /// Fields that cannot be read. As long as nothing was typed into them, the words alone are judged.
    fn wrong_parts(&self) -> Vec<(Part, String)> {
        if self.parts.iter().next().is_none() {
            return Vec::new();
        }
        self.read_parts().err().unwrap_or_default()
    }

    fn read_parts(&self) -> Result<WordsFields, Vec<(Part, String)>> {
        part::read(self.config.form(), self.raw_path, self.shown_data_as(), |part| self.part(part))
    }

    /// How data is shown where it is not of the chosen type.
    pub fn shown_data_as(&self) -> DataAs {
        match (self.parts.get(&Part::Data), self.fields()) {
            (None, Fields::Of(parts)) if self.data_as.write(&parts.data).is_none() => DataAs::Bytes,
            _ => self.data_as,
        }
    }

    /// Fields → words.
    fn put_together(&mut self) {
        let Ok(parts) = self.read_parts() else { return };
        let Ok((words, length)) = parts.write(self.config.form()) else { return };
        self.config.data_to_send = write_words(&words);
        if self.auto_length {
            self.type_length(length.into());
        }
    }

    fn type_words(&mut self, text: String) {
        self.config.data_to_send = text;
        self.parts = Shelf::default();
        if let (true, Some(words)) = (self.auto_length, self.words()) {
            self.set_length(&words);
        }
        self.raw_path |= self.needs_raw_path();
    }

    /// All bytes of the words. Half a word stays half a word.
    fn set_length(&mut self, words: &[u16]) {
        if !lengths(words).contains(&self.length()) {
            self.type_length(odd_length(words) + 1);
        }
    }

    fn type_length(&mut self, bytes: i64) {
        let field = Field::ManagementParam(3);
        set_number(&mut self.config, &field, bytes);
        self.numbers.remove(&field);
    }
}

impl Editable for Draft {
    type Config = SendReq;
    type Edit = Edit;

    fn new(config: SendReq, revision: Option<u64>) -> Self {
        let mut draft = Self {
            revision,
            data_as: DataAs::of_layout(&config.req_layout),
            config,
            numbers: Shelf::default(),
            parts: Shelf::default(),
            auto_length: true,
            raw_path: false,
            refused: Vec::new(),
        };
        draft.auto_length = draft.words().is_none_or(|words| lengths(&words).contains(&draft.length()));
        draft.raw_path = draft.needs_raw_path();
        draft
    }

    fn config(&self) -> &SendReq {
        &self.config
    }

    fn revision(&mut self) -> &mut Option<u64> {
        &mut self.revision
    }

    fn edit(&mut self, edit: Edit) {
        self.refused.clear();
        match edit {
            Edit::Number(field, text) => {
                if let Ok(value) = read_number(&text) {
                    set_number(&mut self.config, &field, value);
                }
                self.numbers.insert(field, text);
            }
            Edit::Text(field, text) => {
                if let Some(member) = text_member(&mut self.config, &field) {
                    *member = text;
                }
            }
            Edit::Words(text) => self.type_words(text),
            Edit::Part(part, text) => {
                // What the other way to write the path had is older now.
                let other = |it: &Part| it.is_of_path() && (*it == Part::Path) != (part == Part::Path);
                self.parts.retain(|it, _| !(part.is_of_path() && other(it)));
                self.parts.insert(part, text);
                self.put_together();
            }
            Edit::RawPath(raw_path) => self.raw_path = raw_path || self.needs_raw_path(),
            Edit::DataAs(data_as) => {
                self.data_as = data_as;
                self.parts.remove(&Part::Data);
            }
            Edit::AutoLength(auto_length) => {
                self.auto_length = auto_length;
                if let (true, Some(words)) = (auto_length, self.words()) {
                    self.set_length(&words);
                }
            }
            Edit::ForgetParts => self.parts = Shelf::default(),
            Edit::Resume(on) => self.config.resume = on,
            Edit::Channel(channel) => self.config.channel = channel,
            Edit::Profile(profile) => self.config.profile = profile,
        }
    }

    fn refuse(&mut self, findings: Vec<api::Finding>) {
        self.refused = findings;
    }

    fn differs_from(&self, stored: &SendReq) -> bool {
        let unreadable = self.numbers.iter().any(|(_, text)| read_number(text).is_err());
        self.config != *stored || unreadable || !self.wrong_parts().is_empty()
    }
}

/// The lengths that mean all of the words: also without the high byte of the last one, if it is 0.
fn lengths(words: &[u16]) -> Vec<i64> {
    let even = odd_length(words) + 1;
    match words.last() {
        Some(last) if *last < 0x100 => vec![even, even - 1],
        _ => vec![even],
    }
}

fn odd_length(words: &[u16]) -> i64 {
    i64::try_from(2 * words.len()).unwrap_or(i64::MAX) - 1
}

fn text_member<'a>(config: &'a mut SendReq, field: &Field) -> Option<&'a mut String> {
    match field {
        Field::Name => Some(&mut config.name),
        Field::Address => Some(&mut config.address),
        Field::ReqLayout => Some(&mut config.req_layout),
        Field::ResLayout => Some(&mut config.res_layout),
        _ => None,
    }
}

#[cfg(test)]
mod tests;

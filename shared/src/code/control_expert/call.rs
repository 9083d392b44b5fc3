//! One call of `SEND_REQ` or `DATA_EXCH` as a block.

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::super::Found;
use super::super::remark::{Remark, RemarkKind};
use super::super::text::{Call, Expression, Item, Place};
use super::read::{key_of, variable};
use super::variables::{MAX_WORDS, Variables, Word, memory_words};
use super::{address, form, table};
use crate::config::{PlcAddress, SendReq, SendReqForm, write_words};
use crate::plan::Severity;

/// Names of the pins: those of the documents, and those of the function itself.
const ADDRESS: [&str; 3] = ["Address", "ADR", "ADDR"];
const CODE: [&str; 5] = ["Request_Code", "CODE", "TYP", "Type", "Action"];
const SEND: [&str; 2] = ["Data_to_Send", "EMIS"];
const MANAGEMENT: [&str; 2] = ["Management_Param", "GEST"];
const RECEIVED: [&str; 2] = ["Received_Data", "RECP"];

/// Endings of a variable's name that are not the message's.
const ENDINGS: [&str; 8] = [
    "_Data_to_Send",
    "_Send",
    "_Emis",
    "_Management_Param",
    "_Mgmt",
    "_Gest",
    "Data_to_Send",
    "Management_Param",
];

/// Reads a call; the names of its variables join the used ones.
pub(super) fn read_call(
    variables: &Variables<'_, '_, '_>,
    call: &Call<'_>,
    item: &Item<'_>,
    used: &mut BTreeSet<String>,
) -> Found {
    let mut reading = Reading { variables, call, item, used, remarks: Vec::new(), first: item.place.line };
    let config = reading.config();
    let form = config.form();
    let lines = reading.first..item.last_line + 1;
    Found { config: config.into(), dialect: table::dialect(form), lines, remarks: reading.remarks }
}

struct Reading<'r, 'v, 's, 'a> {
    variables: &'r Variables<'v, 's, 'a>,
    call: &'r Call<'a>,
    item: &'r Item<'a>,
    used: &'r mut BTreeSet<String>,
    remarks: Vec<Remark>,
    /// The first line that says something about it.
    first: usize,
}

impl<'r, 'a> Reading<'r, '_, '_, 'a> {
    fn config(&mut self) -> SendReq {
        let is_data_exch = self.call.is("DATA_EXCH");
        let address = self.address();
        let words = self.words();
        let form = self.form(is_data_exch, address.as_deref(), &words);
        let mut config = SendReq::new(form, &self.name());
        config.address = address.unwrap_or_else(|| {
            self.say(Severity::Error, RemarkKind::Missing("a constant Address".to_string()));
            self.say(Severity::Warning, RemarkKind::told(&form::no_address(form)));
            form::address(form).to_string()
        });
        config.data_to_send = write_words(&words);
        let code = self.code(if is_data_exch { 1 } else { 14 });
        if is_data_exch {
            config.exchange_type = code;
        } else {
            config.request_code = code;
        }
        let timeout = self.management(2);
        if timeout.is_none() {
            let words = "Management_Param[2] is not set: 0, it waits for ever".to_string();
            self.say(Severity::Warning, RemarkKind::Told(words));
        }
        let length = self.management(3).unwrap_or_else(|| {
            let bytes = 2 * words.len();
            let words = format!("Management_Param[3] is not set: all {bytes} bytes are sent");
            self.say(Severity::Warning, RemarkKind::Told(words));
            i64::try_from(bytes).unwrap_or(i64::MAX)
        });
        config.management_param = alloc::vec![0, 0, timeout.unwrap_or(0), length];
        self.received(&mut config);
        config
    }

    fn value(&self, position: usize, names: &[&str]) -> Option<&'r Expression<'a>> {
        let is_it = |name: &str| names.iter().any(|it| it.eq_ignore_ascii_case(name));
        let formal = self.call.arguments.iter().find(|argument| argument.name.is_some_and(is_it));
        let positional = || self.call.arguments.get(position).filter(|argument| argument.name.is_none());
        formal.or_else(positional)?.value.as_ref()
    }

    fn address(&mut self) -> Option<String> {
        let value = self.value(0, &ADDRESS)?;
        if let Some(reference) = variable(Some(value)) {
            self.uses(reference.root);
        }
        let (address, words) = address::readable(self.variables.address(value)?);
        if let Some(words) = words {
            self.say(Severity::Warning, RemarkKind::Told(words));
        }
        Some(address)
    }

    /// The words that are sent, as far as the length counts and they are known.
    fn words(&mut self) -> Vec<u16> {
        let Some(reference) = variable(self.value(2, &SEND)) else {
            self.say(Severity::Error, RemarkKind::Missing("Data_to_Send".to_string()));
            return Vec::new();
        };
        self.uses(reference.root);
        let known = self.variables.table(reference).words;
        let length = self.management(3).and_then(|length| usize::try_from(length).ok());
        let needed = length.map_or(known.len(), |length| length.div_ceil(2));
        let mut words = Vec::new();
        for (index, word) in known.iter().enumerate() {
            words.push(match word {
                Some(Word::Known(word)) => *word,
                Some(Word::Made) => {
                    let what = RemarkKind::NotConstant(format!("{}[{index}]", reference.root));
                    self.say(Severity::Error, what);
                    0
                }
                None => {
                    if index < needed {
                        let words = format!("{}[{index}] is not set: it is 0", reference.root);
                        self.say(Severity::Warning, RemarkKind::Told(words));
                    }
                    0
                }
            });
        }
        if known.is_empty() {
            let words = format!("nothing is known of the words of {}: write Data_to_Send", reference.root);
            self.say(Severity::Error, RemarkKind::Told(words));
        }
        // What nobody sets and nobody sends is only room.
        let set = known.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
        words.truncate(set.max(needed));
        words
    }

    /// The layout, by the function, the address and the words.
    fn form(&mut self, is_data_exch: bool, address: Option<&str>, words: &[u16]) -> SendReqForm {
        if is_data_exch {
            let words = "recognised as DATA_EXCH: the function says so".to_string();
            self.say(Severity::Note, RemarkKind::Told(words));
            return SendReqForm::DataExch;
        }
        let possible = form::possible(words);
        let has_device = address
            .and_then(|address| address.parse::<PlcAddress>().ok())
            .map(|address| address.device.is_some());
        let by_address = match has_device {
            Some(true) => Some(SendReqForm::Etc100),
            Some(false) => Some(SendReqForm::Etc101),
            None => None,
        };
        let by_words = possible.iter().copied().find(|form| *form != SendReqForm::DataExch);
        let form = match (by_address, by_words) {
            (Some(form), _) if possible.contains(&form) => form,
            (_, Some(form)) => form,
            (form, None) => form.unwrap_or(SendReqForm::Etc100),
        };
        if by_address.is_some_and(|by_address| by_address != form) {
            let words = "the Address and the words are of different modules: the words count".to_string();
            self.say(Severity::Warning, RemarkKind::Told(words));
        }
        let why = match by_address {
            Some(SendReqForm::Etc100) if form == SendReqForm::Etc100 => {
                format!("recognised as {form}: the Address names the device")
            }
            _ => form::why(form, words),
        };
        self.say(Severity::Note, RemarkKind::Told(why));
        form
    }

    fn code(&mut self, usual: i64) -> i64 {
        let Some(value) = self.value(1, &CODE) else {
            self.say(Severity::Warning, RemarkKind::Missing("Request_Code".to_string()));
            return usual;
        };
        let number = value.integer_in(self.variables.memory);
        number.and_then(|number| i64::try_from(number).ok()).unwrap_or_else(|| {
            self.say_at(
                value.place(),
                Severity::Warning,
                RemarkKind::NotConstant("Request_Code".to_string()),
            );
            usual
        })
    }

    fn management(&mut self, index: usize) -> Option<i64> {
        let reference = variable(self.value(3, &MANAGEMENT))?;
        self.uses(reference.root);
        match self.variables.element(reference, index)? {
            Word::Known(word) => Some(word.into()),
            Word::Made => {
                let what = RemarkKind::NotConstant(format!("{}[{index}]", reference.root));
                self.say(Severity::Warning, what);
                None
            }
        }
    }

    fn received(&mut self, config: &mut SendReq) {
        let Some(reference) = variable(self.value(4, &RECEIVED)) else { return };
        self.uses(reference.root);
        if let Some(size) = self.variables.table(reference).size {
            config.received_data_size = i64::try_from(size).unwrap_or(i64::MAX);
        } else {
            let (name, size) = (reference.root, config.received_data_size);
            let words = format!("the size of {name} is not known: Received_Data_Size is {size}");
            self.say(Severity::Note, RemarkKind::Told(words));
        }
    }

    /// What the variables are called, without what tells them apart.
    fn name(&self) -> String {
        let root = [(2, &SEND), (3, &MANAGEMENT)]
            .into_iter()
            .find_map(|(position, names)| variable(self.value(position, names)))
            .map_or("", |reference| reference.root);
        let lower = root.to_ascii_lowercase();
        let is_whole = SEND.iter().chain(&MANAGEMENT).any(|pin| pin.eq_ignore_ascii_case(root));
        if is_whole {
            return root.to_string();
        }
        let ending = ENDINGS.iter().find(|ending| lower.ends_with(&ending.to_ascii_lowercase()));
        let name = root.get(..root.len() - ending.map_or(0, |ending| ending.len())).unwrap_or(root);
        let name = if name.is_empty() { root } else { name };
        name.trim_start_matches('%').replace(':', "_")
    }

    fn uses(&mut self, root: &str) {
        self.used.insert(key_of(root));
        if let Some(alias) = self.variables.located.alias(root) {
            let words = self.variables.declaration(&alias).or_else(|| self.variables.declaration(root));
            let count = words.map_or(1, |it| usize::try_from(it.kind.elements()).unwrap_or(0).min(MAX_WORDS));
            for name in [&alias, root] {
                if let Some((first, _)) = memory_words(name) {
                    self.used.extend((0..count).map(|index| format!("%mw{}", first.saturating_add(index))));
                }
            }
            self.used.insert(alias);
        }
        if let Some((first, count)) = memory_words(root) {
            let count = count.unwrap_or(4).min(MAX_WORDS);
            self.used.extend((0..count).map(|index| format!("%mw{}", first.saturating_add(index))));
        }
        if let Some(line) = self.variables.names.assigned(root) {
            self.first = self.first.min(line);
        }
    }

    fn say(&mut self, severity: Severity, what: RemarkKind) {
        self.say_at(self.item.place, severity, what);
    }

    fn say_at(&mut self, place: Place, severity: Severity, what: RemarkKind) {
        let excerpt = self.variables.script.text.get(self.item.span.clone()).unwrap_or_default();
        let remark = Remark::error(place.line, place.column, excerpt, what);
        // Management words are asked for more than once.
        let remark = Remark { severity, ..remark };
        if !self.remarks.contains(&remark) {
            self.remarks.push(remark);
        }
    }
}

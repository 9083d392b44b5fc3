//! `cipdeck send …` in a text, as a person or we have written it.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::super::dialect::Dialect;
use super::super::remark::{Remark, RemarkKind};
use super::super::{Found, Imported};
use super::shell::{Word, words};
use crate::config::{MsgCipGeneric, read_number};
use crate::plan::Severity;

/// Options that say how a message is sent and shown, not what it is; whether a value follows.
const WITHOUT_EFFECT: [(&str, bool); 5] =
    [("--repeat", true), ("--json", false), ("--pcap", true), ("--log", true), ("--log-format", true)];

/// Options that have no value.
const FLAGS: [&str; 1] = ["--connected"];

/// Blocks from command lines.
pub(in super::super) fn import(text: &str) -> Imported {
    let mut imported = Imported::default();
    let (words, unclosed) = words(text);
    if let Some((line, column)) = unclosed {
        let excerpt = text.lines().nth(line - 1).unwrap_or_default();
        imported.remarks.push(Remark::error(line, column, excerpt, RemarkKind::Unclosed("a quote")));
    }
    for command in words.split(|word| word.ends) {
        if imported.is_full() {
            break;
        }
        // A prompt, and what stands before a command in a script.
        let start =
            command.iter().take_while(|word| matches!(word.text.as_str(), "$" | "%" | "sudo")).count();
        let command = command.get(start..).unwrap_or_default();
        match command {
            [] => {}
            // It keeps a command from running, as we write it.
            [only] if only.text == "false" => {}
            [program, send, rest @ ..] if is_cipdeck(&program.text) && send.text == "send" => {
                imported.blocks.push(Command::default().read(program, rest));
            }
            [first, ..] => {
                let line: Vec<&str> = command.iter().map(|word| word.text.as_str()).collect();
                let (line, excerpt) = (first.line, line.join(" "));
                imported.remarks.push(Remark::error(line, first.column, &excerpt, RemarkKind::NotUnderstood));
            }
        }
    }
    for operator in words.iter().filter(|word| word.ends && !matches!(word.text.as_str(), "" | ";")) {
        let words = "what happens between commands";
        let what = RemarkKind::NoEffect(words.to_string());
        imported.remarks.push(Remark::note(operator.line, operator.column, &operator.text, what));
    }
    if imported.blocks.is_empty() && imported.remarks.is_empty() {
        let words = "cipdeck send PATH --service …".to_string();
        imported.remarks.push(Remark::error(1, 1, text, RemarkKind::Expected(words)));
    }
    imported
}

fn is_cipdeck(program: &str) -> bool {
    let name = program.rsplit(['/', '\\']).next().unwrap_or_default();
    name.eq_ignore_ascii_case("cipdeck") || name.eq_ignore_ascii_case("cipdeck.exe")
}

/// One line being read.
#[derive(Default)]
struct Command {
    path: Option<String>,
    service: Option<i64>,
    class: Option<i64>,
    instance: Option<i64>,
    attribute: i64,
    members: Vec<i64>,
    data: String,
    connected: bool,
    timeout: i64,
    remarks: Vec<Remark>,
}

impl Command {
    fn read(mut self, program: &Word, words: &[Word]) -> Found {
        let mut rest = words.iter();
        let mut last = program.line;
        while let Some(word) = rest.next() {
            last = last.max(word.line);
            let (name, mut value) = match word.text.split_once('=') {
                Some((name, value)) if name.starts_with("--") => (name, Some(value.to_string())),
                _ => (word.text.as_str(), None),
            };
            let known = WITHOUT_EFFECT.iter().find(|(option, _)| *option == name);
            let has_value = known.map_or(!FLAGS.contains(&name), |(_, has_value)| *has_value);
            if name.starts_with("--") && has_value && value.is_none() {
                value = rest.next().map(|word| word.text.clone());
            }
            if known.is_some() {
                self.say(word, Severity::Note, RemarkKind::NoEffect(name.to_string()));
            } else {
                self.option(word, name, value.as_deref());
            }
        }
        let lines = program.line..last + 1;
        let config = self.config(program);
        Found { config: config.into(), dialect: Dialect::Cli, lines, remarks: self.remarks }
    }

    fn option(&mut self, word: &Word, name: &str, value: Option<&str>) {
        let Some(value) = value else {
            match name {
                "--connected" => self.connected = true,
                name if name.starts_with('-') => {
                    self.say(word, Severity::Error, RemarkKind::UnknownMember(name.to_string()));
                }
                path if self.path.is_none() => self.path = Some(path.to_string()),
                _ => self.say(word, Severity::Error, RemarkKind::NotUnderstood),
            }
            return;
        };
        if name == "--data" {
            self.data = value.to_string();
            return;
        }
        if !matches!(name, "--service" | "--class" | "--instance" | "--attribute" | "--member" | "--timeout")
        {
            self.say(word, Severity::Error, RemarkKind::UnknownMember(name.to_string()));
            return;
        }
        let number = match read_number(value) {
            Ok(number) => number,
            Err(error) => {
                let words = format!("{name} {value}: {error}");
                self.say(word, Severity::Error, RemarkKind::Told(words));
                return;
            }
        };
        let before = match name {
            "--service" => self.service.replace(number),
            "--class" => self.class.replace(number),
            "--instance" => self.instance.replace(number),
            "--attribute" => {
                self.attribute = number;
                None
            }
            "--member" => {
                self.members.push(number);
                None
            }
            _ => {
                self.timeout = number;
                None
            }
        };
        if before.is_some() {
            self.say(word, Severity::Warning, RemarkKind::Twice(name.to_string()));
        }
    }

    fn config(&mut self, program: &Word) -> MsgCipGeneric {
        for (name, is_told) in [
            ("PATH", self.path.is_some()),
            ("--service", self.service.is_some()),
            ("--class", self.class.is_some()),
            ("--instance", self.instance.is_some()),
        ] {
            if !is_told {
                self.say(program, Severity::Error, RemarkKind::Missing(name.to_string()));
            }
        }
        let mut config = MsgCipGeneric::product_name(self.path.as_deref().unwrap_or_default());
        config.name = "send".to_string();
        let app = &mut config.app_cfg;
        app.service = self.service.unwrap_or(0);
        app.class = self.class.unwrap_or(0);
        app.instance = self.instance.unwrap_or(0);
        app.attribute = self.attribute;
        app.member_cnt = i64::try_from(self.members.len()).unwrap_or(i64::MAX);
        // Too many are told by MemberCnt.
        app.member_id.clone_from(&self.members);
        app.member_id.resize(3, 0);
        let target = &mut config.target_cfg;
        target.cip_conn_mode = self.connected.into();
        target.ucmm_timeout = self.timeout;
        if self.connected {
            // The connection ends with the program.
            (target.conn_msg_timeout, target.conn_close) = (self.timeout, true);
        }
        config.req_data.clone_from(&self.data);
        config
    }

    fn say(&mut self, word: &Word, severity: Severity, what: RemarkKind) {
        let remark = Remark::error(word.line, word.column, &word.text, what);
        self.remarks.push(Remark { severity, ..remark });
    }
}

#[cfg(test)]
mod tests {
    use super::super::export;
    use super::*;
    use crate::config::BlockConfig;

    #[test]
    fn a_line_is_read_as_the_program_reads_it() {
        let text = "# a drive\n$ ./target/debug/cipdeck send '4,10.0.0.7, 1,0' --service=0x10 --class 93h \\\n  --instance 41 \
                    --attribute 9 --data \"0A 0b\" --timeout 2500 --json | jq .\n";
        let read = import(text);
        let config = read.blocks[0].config.as_msg().unwrap();
        let app = &config.app_cfg;
        assert_eq!((app.service, app.class, app.instance, app.attribute), (16, 147, 41, 9));
        assert_eq!(
            (config.target_cfg.path.as_str(), config.target_cfg.ucmm_timeout),
            ("4,10.0.0.7, 1,0", 2_500)
        );
        assert_eq!((config.req_data.as_str(), read.blocks[0].lines.clone()), ("0A 0b", 2..4));
        let said: Vec<String> = read.remarks.iter().map(ToString::to_string).collect();
        assert_eq!(said.len(), 2, "{said:?}");
        assert!(said[0].starts_with("3:") && said[0].ends_with("left out: jq ."), "{said:?}");
    }

    #[test]
    fn what_is_missing_or_unknown_is_told() {
        let read = import("cipdeck send --service 1F --klass 1 --instance\n");
        let said: Vec<String> = read.blocks[0].remarks.iter().map(ToString::to_string).collect();
        for part in ["--service 1F", "--klass is not known", "PATH is missing", "--class is missing"] {
            assert!(said.iter().any(|remark| remark.contains(part)), "{part}: {said:?}");
        }
        assert_eq!(import("cipdeck send '4,1").remarks[0].what, RemarkKind::Unclosed("a quote"));
        assert_eq!(import("").remarks.len(), 1);
    }

    #[test]
    fn everything_of_a_message_is_on_the_line() {
        let mut config = MsgCipGeneric::product_name("4,plc-3.line:44820,1,0");
        config.name = "speed\n'; rm -rf /".into();
        (config.app_cfg.member_cnt, config.app_cfg.member_id) = (2, alloc::vec![1, 300, 0]);
        (config.req_data, config.target_cfg.ucmm_timeout) = ("0a0b".into(), 2_500);
        let block = BlockConfig::from(config.clone());
        let code = export(&block, &[]);
        assert_eq!(code.losses().count(), 0);
        let read = import(&code.text);
        assert_eq!((read.blocks.len(), read.remarks.len()), (1, 0), "{read:?}");
        config.name = "send".into();
        assert_eq!(read.blocks[0].config, config.into());
    }
}

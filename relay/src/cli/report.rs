//! What is printed about findings and about a message that has ended.

use cipdeck_shared::api::{self, BlockStatus, Checked};
use cipdeck_shared::config::{BlockConfig, SendReq, SendReqForm, space_hex, write_hex};
use cipdeck_shared::dissect::{self, Decoded};
use cipdeck_shared::plan::{Finding, MessagePlan, Severity};
use cipdeck_shared::table;
use cipdeck_shared::tag::DataFields;
use cipdeck_shared::wire::ServiceCode;
use serde::Serialize;

use super::{explain, words};

/// All findings on stderr, one a line.
pub(super) fn findings(findings: &[Finding]) {
    for finding in findings {
        let severity = match finding.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        eprintln!("{severity}: {}: {}", finding.field, finding.rule);
    }
}

/// Findings and request as JSON.
pub(super) fn checked(plan: Option<&MessagePlan>, findings: &[Finding]) -> String {
    let request = plan.map(|plan| write_hex(plan.bytes()));
    json(&Checked { findings: api::findings(findings), request })
}

/// A message that has ended.
#[derive(Debug, Serialize)]
pub(super) struct Report<'a> {
    #[serde(flatten)]
    status: &'a BlockStatus,
    /// Message router bytes, if an answer came.
    response: Option<String>,
    /// What the reply's data means.
    decoded: Vec<Decoded>,
    /// How the words are laid out, of a block that has some.
    #[serde(skip)]
    form: Option<SendReqForm>,
}

impl<'a> Report<'a> {
    /// With the message router bytes of the request and of the reply, if one came.
    pub(super) fn new(
        status: &'a BlockStatus,
        request: &[u8],
        response: Option<&[u8]>,
        config: &BlockConfig,
    ) -> Self {
        let decode = |response| match DataFields::read(config.res_layout()) {
            Ok(layout) => dissect::decode_as(&layout, response),
            // Empty: nobody has said.
            Err(_) => dissect::decode(request, response),
        };
        Self {
            status,
            response: response.map(write_hex),
            decoded: response.map(decode).unwrap_or_default(),
            form: config.as_send_req().map(SendReq::form),
        }
    }

    /// Whether the message failed.
    pub(super) const fn is_error(&self) -> bool {
        self.status.status.error
    }

    /// For machines.
    pub(super) fn json(&self) -> String {
        json(self)
    }

    /// In one line.
    pub(super) fn line(&self) -> String {
        let elapsed = duration(self.status.elapsed_us);
        if self.status.status.error {
            return format!("failed after {elapsed}: {}", self.sentences().join(" "));
        }
        let values: Vec<_> = self.decoded.iter().map(value).collect();
        let values = if values.is_empty() { "no data".to_owned() } else { values.join("; ") };
        format!("done in {elapsed}: {values}")
    }

    /// Why it failed; of a block with words its reports first.
    fn sentences(&self) -> Vec<String> {
        let reports =
            self.status.words.as_ref().zip(self.form).map(|(status, form)| words::reports(status, form));
        reports.into_iter().flatten().chain(explain::sentences(self.status)).collect()
    }

    /// For people.
    pub(super) fn text(&self, config: &BlockConfig) -> String {
        let mut lines = vec![title(config)];
        let elapsed = duration(self.status.elapsed_us);
        if self.status.status.error {
            lines.push(format!("  failed after {elapsed}"));
            lines.extend(explain::sentences(self.status).into_iter().map(|sentence| format!("  {sentence}")));
        } else {
            lines.push(format!("  done in {elapsed}, reply after {}", duration(self.status.reply_us)));
            lines.extend(self.decoded.iter().map(|decoded| format!("  {}", value(decoded))));
            if self.decoded.is_empty() {
                lines.push("  the reply has no data".to_owned());
            }
        }
        if let Some((status, form)) = self.status.words.as_ref().zip(self.form) {
            lines.extend(words::lines(status, form).into_iter().map(|line| format!("  {line}")));
        }
        lines.push(format!("  request  {}", space_hex(&self.status.request)));
        if let Some(response) = &self.response {
            lines.push(format!("  reply    {}", space_hex(response)));
        }
        lines.join("\n")
    }
}

/// `Get_Attribute_Single of Identity 1/1/7 at 4,192.168.1.100`
fn title(config: &BlockConfig) -> String {
    let config = match config {
        BlockConfig::MsgCipGeneric(config) => config,
        BlockConfig::SendReq(config) => return format!("{} to {}", config.form(), config.address),
    };
    let app = &config.app_cfg;
    let class = u16::try_from(app.class).unwrap_or_default();
    let service = ServiceCode(u8::try_from(app.service).unwrap_or_default());
    let service = table::service(class, service)
        .map_or_else(|| format!("service {service}"), |row| row.name.to_owned());
    let class_name = table::class(class).map_or_else(String::new, |row| format!("{}, ", row.name));
    let attribute = if app.attribute == 0 { String::new() } else { format!(" attribute {}", app.attribute) };
    let (class, instance, path) = (app.class, app.instance, &config.target_cfg.path);
    format!("{service}: {class_name}class {class} instance {instance}{attribute} at {path}")
}

fn value(decoded: &Decoded) -> String {
    let guess = if decoded.guess { " (a guess)" } else { "" };
    format!("{} {} {}{guess}", decoded.name, decoded.type_name, decoded.text)
}

fn duration(micros: Option<u64>) -> String {
    match micros {
        None => "an unknown time".to_owned(),
        Some(micros) => format!("{}.{:03} ms", micros / 1_000, micros % 1_000),
    }
}

/// Our own types have string keys only, which is all that could fail.
pub(super) fn json(value: &impl Serialize) -> String {
    serde_json::to_string(value).unwrap_or_else(|error| format!("{{\"error\":\"{error}\"}}"))
}

//! Logs: records with a message and fields, to stderr. Payload bytes appear at `trace` only.

use std::io::IsTerminal;

use tracing_subscriber::EnvFilter;
use tracing_subscriber::filter::ParseError;

use crate::settings::LogFormat;

/// Starts logging. A second call in one process (tests) changes nothing.
pub(crate) fn start(log: &str, format: LogFormat) -> Result<(), ParseError> {
    let filter = EnvFilter::try_new(log)?;
    let is_terminal = std::io::stderr().is_terminal();
    let builder =
        tracing_subscriber::fmt().with_env_filter(filter).with_writer(std::io::stderr).with_ansi(is_terminal);
    // Fails only when logging has been started before.
    let _ = match format {
        LogFormat::Text => builder.try_init(),
        LogFormat::Json => builder.json().flatten_event(true).try_init(),
    };
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_filter_that_makes_no_sense_is_refused() {
        assert!(start("cipdeck_relay=loud", LogFormat::Text).is_err());
    }
}

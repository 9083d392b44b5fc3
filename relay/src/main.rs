//! The binary `cipdeck`.

use std::process::ExitCode;

fn main() -> ExitCode {
    cipdeck_relay::cli::main()
}

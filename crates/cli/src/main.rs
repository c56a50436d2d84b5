// SPDX-License-Identifier: MIT OR Apache-2.0
//! The program `foveate`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(foveate_cli::run(std::env::args_os()))
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! The fingerprint of a design: a short hash of its configuration.

use crate::DesignConfig;
use sha2::{Digest, Sha256};
use std::fmt::Write;

/// Version of the meaning of a configuration. It changes when an unchanged configuration means
/// something else.
const CONTRACT: &str = "foveate design 1\n";

/// Returns the first 64 bits of the SHA-256 of a validated configuration, as 16 hexadecimal digits.
pub(crate) fn config_fingerprint(config: &DesignConfig) -> String {
    let mut hash = Sha256::new();
    hash.update(CONTRACT);
    hash.update(config.to_toml());
    hash.finalize().iter().take(8).fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

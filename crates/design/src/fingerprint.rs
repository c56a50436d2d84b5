// SPDX-License-Identifier: MIT OR Apache-2.0
//! A short name for a design: equal configurations have it in common, others do not.

use crate::Config;
use sha2::{Digest, Sha256};
use std::fmt::Write;

/// Changes when the same configuration starts to mean something else.
const CONTRACT: &str = "foveate design 1\n";

/// The first 64 bits of the SHA-256 of the resolved configuration, as 16 hexadecimal digits.
pub(crate) fn of(config: &Config) -> String {
    let mut hash = Sha256::new();
    hash.update(CONTRACT);
    hash.update(config.to_toml());
    hash.finalize().iter().take(8).fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

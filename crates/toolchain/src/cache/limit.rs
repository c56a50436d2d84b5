// SPDX-License-Identifier: MIT OR Apache-2.0
//! The size limit of a cache, and when it is enforced.

use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

use super::eviction;
use crate::error::ToolError;

/// The environment variable with the limit.
pub(super) const VARIABLE: &str = "FOVEATE_CACHE_SIZE";
const MIB: u64 = 1 << 20;
const MINIMUM_LIMIT: u64 = MIB;
const DEFAULT_LIMIT: u64 = 5 << 30;
/// The divisor of the limit that gives the slack. The folder is checked again once this process has
/// built as many bytes as the slack, and an eviction frees as many bytes below the limit, so that a
/// full cache is not searched after every build.
const CHECK_DIVISOR: u64 = 16;

/// The largest number of bytes of a cache, or no limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CacheLimit(Option<u64>);

impl Default for CacheLimit {
    fn default() -> Self {
        Self(Some(DEFAULT_LIMIT))
    }
}

impl CacheLimit {
    pub(super) const NONE: Self = Self(None);

    #[cfg(test)]
    pub(super) fn bytes(bytes: u64) -> Self {
        Self(Some(bytes))
    }

    /// Parses a limit such as `500M`, `5G` or `1T`, in powers of 1,024, or `none`.
    pub(super) fn parse(text: &str) -> Result<Self, ToolError> {
        if text.trim() == "none" {
            return Ok(Self::NONE);
        }
        let text = text.trim();
        let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
        let unit = match text[digits.len()..].to_ascii_uppercase().as_str() {
            "M" | "MB" | "MIB" => Some(MIB),
            "G" | "GB" | "GIB" => Some(MIB << 10),
            "T" | "TB" | "TIB" => Some(MIB << 20),
            _ => None,
        };
        let bytes = digits.parse::<u64>().ok().zip(unit);
        bytes
            .and_then(|(number, unit)| number.checked_mul(unit))
            .filter(|&bytes| bytes >= MINIMUM_LIMIT)
            .map(|bytes| Self(Some(bytes)))
            .ok_or_else(|| ToolError::InvalidCacheSize { value: text.to_owned() })
    }

    /// Makes room if necessary after something of `bytes` was built. `built` is the number of bytes
    /// that this process has built since its last check. No result depends on this, so failures are
    /// ignored.
    pub(super) fn enforce(self, root: &Path, built: &OnceLock<AtomicU64>, bytes: u64) {
        let Some(limit) = self.0 else { return };
        let slack = limit / CHECK_DIVISOR;
        let is_first = built.get().is_none();
        let built = built.get_or_init(AtomicU64::default);
        let is_due = built.fetch_add(bytes, Ordering::Relaxed) + bytes >= slack;
        if is_first || is_due {
            built.store(0, Ordering::Relaxed);
            eviction::evict(root, limit, limit - slack);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_units() {
        for (text, bytes) in
            [("1M", MIB), (" 500mb ", 500 * MIB), ("2GiB", 2 << 30), ("1T", 1 << 40)]
        {
            assert_eq!(CacheLimit::parse(text).unwrap(), CacheLimit(Some(bytes)), "{text}");
        }
        assert_eq!(CacheLimit::parse("none").unwrap(), CacheLimit::NONE);
        for text in ["", "0M", "500", "5K", "-1G", "1.5G", "G", "all", "99999999999T", "1µ"] {
            let error = CacheLimit::parse(text).unwrap_err();
            assert!(error.is_environment());
            assert!(
                error.to_string().contains(&format!("FOVEATE_CACHE_SIZE is `{text}`")),
                "{error}"
            );
        }
    }
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cache keys: the hash of everything that a build depends on.

use std::fmt::{self, Write as _};

use sha2::{Digest as _, Sha256};

use crate::source_files::Source;

/// The number of hexadecimal digits of a SHA-256.
const HASH_DIGITS: usize = 64;

/// The name of a cache entry: the kind of build, and the hash of all its inputs.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct CacheKey(String);

impl CacheKey {
    /// Starts a key for one kind of build, such as `verilator`.
    #[must_use]
    pub fn builder(kind: &str) -> CacheKeyBuilder {
        CacheKeyBuilder { kind: kind.to_owned(), hash: Sha256::new() }
    }

    /// Returns whether this text has the form of a key: a kind and a hash.
    pub(crate) fn is_key_name(name: &str) -> bool {
        let digit = |c: u8| c.is_ascii_digit() || (b'a'..=b'f').contains(&c);
        name.rsplit_once('-').is_some_and(|(kind, hash)| {
            !kind.is_empty() && hash.len() == HASH_DIGITS && hash.bytes().all(digit)
        })
    }

    /// Returns the key as the name of a folder.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for CacheKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Collects the inputs of a build. Every field is hashed with its name and length, so that
/// different sequences of fields have different hashes.
#[derive(Debug, Clone)]
pub struct CacheKeyBuilder {
    kind: String,
    hash: Sha256,
}

impl CacheKeyBuilder {
    /// Adds a named value, such as a version, or the contents of a file under its name.
    #[must_use]
    pub fn field(mut self, name: &str, value: impl AsRef<[u8]>) -> Self {
        for part in [name.as_bytes(), value.as_ref()] {
            self.hash.update(part.len().to_string());
            self.hash.update(b":");
            self.hash.update(part);
        }
        self
    }

    /// Adds a list of values under one name.
    #[must_use]
    pub fn list<S: AsRef<str>>(self, name: &str, values: &[S]) -> Self {
        let counted = self.field(name, values.len().to_string());
        values.iter().fold(counted, |key, value| key.field(name, value.as_ref()))
    }

    /// Adds the names and contents of source files.
    #[must_use]
    pub fn sources(self, sources: &[Source]) -> Self {
        let counted = self.field("sources", sources.len().to_string());
        sources.iter().fold(counted, |key, (name, contents)| key.field(name, contents))
    }

    /// Finishes the key.
    #[must_use]
    pub fn finish(self) -> CacheKey {
        CacheKey(format!("{}-{}", self.kind, hex(&self.hash.finalize())))
    }
}

/// Returns the SHA-256 of some bytes, as hexadecimal digits.
#[must_use]
pub fn sha256_hex(bytes: impl AsRef<[u8]>) -> String {
    hex(&Sha256::digest(bytes.as_ref()))
}

/// Returns one hash for a set of Verilog files: the hash of what `sha256sum` prints for them in the
/// order of their names. Reports on RTL contain it, so that a reader can see whether two reports
/// are about the same RTL.
#[must_use]
pub fn sources_sha256(sources: &[Source]) -> String {
    let line = |(name, text): &Source| (name.clone(), format!("{}  {name}\n", sha256_hex(text)));
    let mut lines: Vec<_> = sources.iter().map(line).collect();
    lines.sort();
    sha256_hex(lines.into_iter().map(|(_, line)| line).collect::<String>())
}

pub(crate) fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        // Writing to a string cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_are_sha256() {
        let empty = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
        assert_eq!(sha256_hex(""), empty);
    }

    #[test]
    fn the_order_of_sources_does_not_matter() {
        let source = |name: &str, text: &str| (name.to_owned(), text.to_owned());
        let (a, b) = (source("a.v", "1"), source("b.v", "2"));
        let lines = format!("{}  a.v\n{}  b.v\n", sha256_hex("1"), sha256_hex("2"));
        assert_eq!(sources_sha256(&[a.clone(), b.clone()]), sha256_hex(lines));
        assert_eq!(sources_sha256(&[b.clone(), a]), sources_sha256(&[source("a.v", "1"), b]));
    }

    #[test]
    fn fields_do_not_run_together() {
        let key = |fields: &[(&str, &str)]| {
            let start = CacheKey::builder("t");
            fields.iter().fold(start, |key, (name, value)| key.field(name, value)).finish()
        };
        assert_ne!(key(&[("a", "bc")]), key(&[("ab", "c")]));
        assert_ne!(key(&[("a", "b"), ("c", "d")]), key(&[("a", "b1:c1:d")]));
        assert_eq!(key(&[("a", "b")]), key(&[("a", "b")]));
        assert!(key(&[]).as_str().starts_with("t-"));
        assert!(CacheKey::is_key_name(key(&[]).as_str()));
        assert!(!CacheKey::is_key_name("thesis-2026") && !CacheKey::is_key_name(&sha256_hex("")));
    }
}

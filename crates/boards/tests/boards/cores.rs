// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that the prefix of a core is plain in every language. It is the only text that a user
//! chooses in a core; of a configuration only known texts are taken (tests of `foveate-design`).

use foveate_emit::Prefix;

use crate::hostile_texts::texts;

#[test]
fn a_prefix_is_a_plain_name() {
    let is_name = |text: &str| {
        text.starts_with(|c: char| c.is_ascii_alphabetic())
            && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
    };
    for text in texts() {
        match Prefix::new(&text) {
            Ok(prefix) => assert!(is_name(prefix.text()), "{text:?}"),
            Err(error) => {
                let said = error.to_string();
                assert!(
                    said.contains("prefix") && said.len() < 1000,
                    "{text:.40}: {} bytes",
                    said.len()
                );
                assert!(!said.contains(|c: char| c.is_control()), "{said:?}");
            }
        }
    }
}

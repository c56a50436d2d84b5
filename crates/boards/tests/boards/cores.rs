// SPDX-License-Identifier: MIT OR Apache-2.0
//! A prefix is all that a user names of a core, and plain in every language. Of a configuration no text is taken that the program
//! does not know (tests of `foveate-design`).

use foveate_emit::Prefix;

use crate::hostile::texts;

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

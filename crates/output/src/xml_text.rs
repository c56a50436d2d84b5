// SPDX-License-Identifier: MIT OR Apache-2.0
//! Makes text valid in XML where no template escapes it: in comments, and for characters that
//! cannot be escaped.

/// Returns text for a comment, which two hyphens would end.
pub(crate) fn comment_text(text: &str) -> String {
    let mut text = text.to_owned();
    // One pass turns three hyphens into a text that still has two in a row.
    while text.contains("--") {
        text = text.replace("--", "- -");
    }
    text
}

/// Returns a whole document in which U+FFFD replaces the characters that XML cannot represent.
/// Names of files may contain them.
pub(crate) fn valid_document(text: String) -> String {
    let is_invalid = |letter: char| matches!(letter, '\0'..='\x08' | '\x0B' | '\x0C' | '\x0E'..='\x1F' | '\u{fffe}' | '\u{ffff}');
    if text.contains(is_invalid) { text.replace(is_invalid, "\u{fffd}") } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hyphens_do_not_end_a_comment() {
        assert_eq!(comment_text("a-b --no-area"), "a-b - -no-area");
        for text in ["--->", "x----->", "---", "--", "<!-- -->"] {
            assert!(!comment_text(text).contains("--"), "{text}");
        }
    }

    #[test]
    fn a_document_has_only_characters_of_xml() {
        assert_eq!(valid_document("a\tb\r\n\u{e4}".to_owned()), "a\tb\r\n\u{e4}");
        assert_eq!(valid_document("a\0b\u{1b}[2J".to_owned()), "a\u{fffd}b\u{fffd}[2J");
    }
}

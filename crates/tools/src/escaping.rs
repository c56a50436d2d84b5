// SPDX-License-Identifier: MIT OR Apache-2.0
//! Escapes user text inside a generated script or page, with one function for each language. Each
//! function accepts any text, and the language reads back exactly that text. Plain words stay
//! unchanged.

use std::borrow::Cow;
use std::fmt::Write as _;

/// Returns whether every shell, Tcl, and tools with simple parsers accept a character as part of a
/// word.
fn is_plain(letter: char) -> bool {
    letter.is_ascii_alphanumeric() || "-_./:=,%+@".contains(letter)
}

/// Returns whether a character is a control character, or a format character that changes the
/// direction or the position of its neighbours. Editors and terminals do not show such a character
/// in its place.
#[must_use]
pub fn is_hidden(letter: char) -> bool {
    letter.is_control()
        || matches!(letter, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}')
}

/// Escapes a word for a POSIX shell. NUL is left out, because no word of a shell can contain it.
#[must_use]
pub fn shell_word(text: &str) -> Cow<'_, str> {
    if !text.is_empty() && text.chars().all(is_plain) {
        return text.into();
    }
    format!("'{}'", text.replace('\0', "").replace('\'', r"'\''")).into()
}

/// Escapes a word for Tcl, which is also valid inside a list in braces.
#[must_use]
pub fn tcl_word(text: &str) -> Cow<'_, str> {
    if text.is_empty() {
        return "{}".into();
    }
    if text.chars().all(is_plain) {
        return text.into();
    }
    let mut word = String::new();
    for letter in text.chars() {
        match letter {
            _ if is_plain(letter) => word.push(letter),
            // Writing to a string cannot fail.
            _ if u32::from(letter) <= 0xFFFF => drop(write!(word, "\\u{:04x}", u32::from(letter))),
            other => word.push(other),
        }
    }
    word.into()
}

/// Escapes text in a comment of one line, in a shell, Tcl, Verilog, TOML or a file of constraints.
/// The comment must not begin with the text, because some tools read commands from the first word
/// of a comment.
#[must_use]
pub fn comment_text(text: &str) -> Cow<'_, str> {
    // In Tcl a comment that ends in a backslash continues in the next line.
    let ends_with_backslash = text.ends_with('\\');
    if !ends_with_backslash && !text.contains(is_hidden) {
        return text.into();
    }
    let mut line = escape_hidden(text).into_owned();
    if ends_with_backslash {
        line.push('.');
    }
    line.into()
}

/// Escapes text in a paragraph, a heading or a table of Markdown without HTML.
#[must_use]
pub fn markdown_text(text: &str) -> Cow<'_, str> {
    const MARKS: &str = "\\`*_[]<>|~&#$";
    if !text.contains(|letter| is_hidden(letter) || MARKS.contains(letter)) {
        return text.into();
    }
    let mut line = String::new();
    for letter in escape_hidden(text).chars() {
        if MARKS.contains(letter) {
            line.push('\\');
        }
        line.push(letter);
    }
    line.into()
}

/// Returns the beginning of a text for a message, with its control characters escaped.
#[must_use]
pub fn message_excerpt(text: &str) -> String {
    const MAX_LETTERS: usize = 40;
    let ellipsis = if text.chars().nth(MAX_LETTERS).is_some() { "..." } else { "" };
    text.chars().take(MAX_LETTERS).flat_map(char::escape_debug).chain(ellipsis.chars()).collect()
}

/// Returns the text with its hidden characters escaped, such as `\n` and `\u{1b}`.
#[must_use]
pub fn escape_hidden(text: &str) -> Cow<'_, str> {
    if !text.contains(is_hidden) {
        return text.into();
    }
    let mut shown = String::new();
    for letter in text.chars() {
        if is_hidden(letter) {
            shown.extend(letter.escape_default());
        } else {
            shown.push(letter);
        }
    }
    shown.into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::{Command, Stdio};

    const TEXTS: &[&str] = &[
        "plain-1.2_x/y:z",
        "my net",
        "it's",
        "",
        "$HOME $(id) `id`",
        "a;b&c|d>e",
        "[exit 3]",
        "}{",
        "{",
        "\\",
        "a\\",
        "\"",
        "#x",
        "a\nb",
        "\ta\r",
        "\u{e4}\u{4e16}",
        "\u{1f600}",
        "\u{1b}[2J",
        "*",
        "~",
        "!x",
    ];

    #[test]
    fn a_shell_reads_the_words_back() {
        let words: Vec<_> = TEXTS.iter().map(|text| shell_word(text)).collect();
        let script = format!("printf '<%s>\\n' {}", words.join(" "));
        let output = Command::new("sh").args(["-c", &script]).output().unwrap();
        let expected: String = TEXTS.iter().map(|text| format!("<{text}>\n")).collect();
        assert_eq!(String::from_utf8(output.stdout).unwrap(), expected);
        assert_eq!(shell_word("a\0b c"), "'ab c'");
        assert_eq!(words[0], TEXTS[0]);
    }

    #[test]
    fn tcl_reads_the_words_back() {
        if Command::new("tclsh").stdin(Stdio::null()).output().is_err() {
            let is_strict =
                std::env::var_os("FOVEATE_REQUIRE_TOOLS").is_some_and(|value| value == "1");
            assert!(!is_strict, "FOVEATE_REQUIRE_TOOLS is 1, and tclsh is missing (Debian: tcl)");
            return eprintln!("skipped: tclsh is missing");
        }
        let words: Vec<_> = TEXTS.iter().map(|text| tcl_word(text)).collect();
        let words = words.join(" ");
        let script = format!(
            "fconfigure stdout -encoding utf-8 -translation lf\nforeach word [list {words}] {{ puts <$word> }}\n\
             foreach word {{{words}}} {{ puts <$word> }}\n"
        );
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("words.tcl");
        std::fs::write(&path, script).unwrap();
        let output =
            Command::new("tclsh").args(["-encoding", "utf-8"]).arg(&path).output().unwrap();
        let expected: String = TEXTS.iter().map(|text| format!("<{text}>\n")).collect();
        assert_eq!(String::from_utf8(output.stdout).unwrap(), expected.repeat(2));
    }

    #[test]
    fn a_message_shows_the_beginning_of_a_text() {
        assert_eq!(message_excerpt("a\nb\u{1b}\u{e4}"), "a\\nb\\u{1b}\u{e4}");
        assert_eq!(message_excerpt(&"x".repeat(1000)), "x".repeat(40) + "...");
    }

    #[test]
    fn comments_and_markdown_stay_on_their_line() {
        assert_eq!(comment_text("a board; $(x)"), "a board; $(x)");
        assert_eq!(comment_text("a\nb\\"), "a\\nb\\.");
        assert_eq!(comment_text("\u{202e}x\u{2028}"), "\\u{202e}x\\u{2028}");
        assert_eq!(markdown_text("a board (x), 1.2"), "a board (x), 1.2");
        assert_eq!(markdown_text("<b>*x*</b>\n[y](z)"), "\\<b\\>\\*x\\*\\</b\\>\\\\n\\[y\\](z)");
    }
}

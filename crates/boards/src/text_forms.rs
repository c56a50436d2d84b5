// SPDX-License-Identifier: MIT OR Apache-2.0
//! The safety of texts that are copied from the file of a board or a sensor into scripts and
//! pages: every text must be a plain word, unless its key is among the [`FORMS`], which allow
//! it other characters. So a key that is added later takes only a plain word. Checked texts
//! become files of a project with [`rendered`] and [`source_file`].

use askama::Template;
use foveate_emit::SourceFile;
use foveate_tools::escaping::{is_hidden, message_excerpt};
use toml::{Table, Value};

/// The largest number of characters of a word.
const WORD_LENGTH: usize = 64;
const LINE_LENGTH: usize = 200;
const CHANGE_LENGTH: usize = 1000;

/// The form that a text must have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TextForm {
    /// A name, a pin or a level.
    Word,
    /// A device, as its tool calls it.
    Part,
    /// A line for people, in any writing system.
    Line,
    /// The address of a page.
    Page,
    /// A command that people run by hand, of words that a shell takes unchanged.
    Command,
    /// The name of a sensor, or the path of its file.
    Sensor,
    /// A change of a configuration, which is parsed.
    Change,
}

/// The forms of the texts that are no plain words.
const FORMS: &[(&str, TextForm)] = &[
    ("title", TextForm::Line),
    ("page", TextForm::Page),
    ("flash", TextForm::Command),
    ("sensor", TextForm::Sensor),
    ("device.part", TextForm::Part),
    ("design.set", TextForm::Change),
];

/// Checks every text of a file.
///
/// # Errors
/// Returns which text is wrong, and what would be right.
pub(crate) fn check_texts(file: &Table) -> Result<(), String> {
    file.iter().try_for_each(|(key, value)| check_value(key, key, value))
}

/// Checks the name of a board, which is also the name of its file and of its bitstream.
///
/// # Errors
/// Returns the fault in the name, and the form that would be right.
pub(crate) fn check_name(name: &str) -> Result<(), String> {
    TextForm::Word.check_text(name).map_err(|expected| {
        format!("its name is that of its bitstream, in scripts: {expected}; rename the file")
    })
}

/// Checks a value. `path` names it in messages; `key` is the same without indices of arrays.
fn check_value(path: &str, key: &str, value: &Value) -> Result<(), String> {
    match value {
        Value::String(text) => {
            let form =
                FORMS.iter().find(|(known, _)| *known == key).map_or(TextForm::Word, |form| form.1);
            form.check_text(text)
                .map_err(|expected| format!("{path} = \"{}\": {expected}", message_excerpt(text)))
        }
        Value::Array(values) => values
            .iter()
            .enumerate()
            .try_for_each(|(place, value)| check_value(&format!("{path}[{place}]"), key, value)),
        Value::Table(table) => table.iter().try_for_each(|(name, value)| {
            check_value(&format!("{path}.{name}"), &format!("{key}.{name}"), value)
        }),
        Value::Integer(_) | Value::Float(_) | Value::Boolean(_) | Value::Datetime(_) => Ok(()),
    }
}

impl TextForm {
    /// Checks a text.
    ///
    /// # Errors
    /// Returns the form that would be right.
    fn check_text(self, text: &str) -> Result<(), String> {
        let max_length = match self {
            Self::Word | Self::Part => WORD_LENGTH,
            Self::Line | Self::Page | Self::Command | Self::Sensor => LINE_LENGTH,
            Self::Change => CHANGE_LENGTH,
        };
        let length = text.chars().count();
        if length > max_length {
            return Err(format!("it has {length} characters; at most {max_length} are allowed"));
        }
        let (is_valid, expected) = match self {
            Self::Word => {
                (is_word(text, ""), "letters, digits, `.`, `_` and `-`, and not begin with `-`")
            }
            Self::Part => (
                is_word(text, "/"),
                "letters, digits, `.`, `_`, `/` and `-`, and not begin with `-`",
            ),
            Self::Line => (is_line(text), "a line of text without control characters"),
            Self::Page => (
                is_page(text),
                "an address that begins with https:// or http://, with `%20` for a space",
            ),
            Self::Command => (
                is_command(text),
                "a program and its arguments with a space between them, of letters, digits and `-_./:=,+@` alone, which a shell does not change",
            ),
            Self::Sensor => (
                is_sensor(text),
                "the name of a sensor, or the path of a file NAME.toml, whose name has only letters, digits, `.`, `_` and `-`, and does not begin with `-`",
            ),
            Self::Change => (is_line(text), "KEY=VALUE in a line without control characters"),
        };
        if is_valid { Ok(()) } else { Err(format!("expected {expected}")) }
    }
}

/// Returns true for letters, digits, and `others`, unless the text is an option or a folder.
fn is_word(text: &str, others: &str) -> bool {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c) || others.contains(c);
    let is_name = |part: &str| !part.is_empty() && part != "." && part != "..";
    !text.starts_with('-') && text.chars().all(is_plain) && text.split('/').all(is_name)
}

fn is_line(text: &str) -> bool {
    !text.trim().is_empty() && !text.contains(is_hidden)
}

/// Returns true for an address without brackets, which would end a link in Markdown, and without
/// quotes, which would end one in HTML.
fn is_page(text: &str) -> bool {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-._~:/?#@!$&*+,;=%".contains(c);
    let host = text.strip_prefix("https://").or_else(|| text.strip_prefix("http://"));
    host.is_some_and(|host| host.starts_with(|c: char| c.is_ascii_alphanumeric()))
        && text.chars().all(is_plain)
}

fn is_command(text: &str) -> bool {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./:=,+@".contains(c);
    let (program, _) = text.split_once(' ').unwrap_or((text, ""));
    let is_program = !program.starts_with('-') && !program.contains('=');
    is_program && text.split(' ').all(|word| !word.is_empty() && word.chars().all(is_plain))
}

fn is_sensor(text: &str) -> bool {
    let name = text.rsplit('/').next().unwrap_or_default();
    is_word(name, "") && !text.contains(is_hidden)
}

/// Returns a file of a project.
pub(crate) fn source_file(path: &str, contents: String) -> SourceFile {
    SourceFile { path: path.to_owned(), contents }
}

/// Returns a filled template, with the newline at its end that askama drops.
pub(crate) fn rendered(view: &impl Template) -> String {
    let text = view.render();
    text.map_or_else(|e| unreachable!("a template only fails when writing does: {e}"), |t| t + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_form_accepts_and_refuses_texts() {
        for (form, good, bad) in [
            (
                TextForm::Word,
                &["up5k", "LVCMOS33", "A1", "35", "x.y_z-1"][..],
                &["", "-x", ".", "..", "a/b", "a b", "\u{e4}", "a;"][..],
            ),
            (
                TextForm::Part,
                &["GW2AR-LV18QN88C8/I7", "xcvu9p-flga2104-2L-e"],
                &["../x", "a/../b", "/x", "-x", "a b"],
            ),
            (
                TextForm::Line,
                &["A board; \u{e4} (1 \u{b5}s) $x"],
                &["", " ", "a\nb", "\u{1b}[2J", "\u{202e}x"],
            ),
            (
                TextForm::Page,
                &["https://a.b/c?d=e&f#g", "http://x"],
                &[
                    "ftp://x",
                    "javascript:x",
                    "https://",
                    "https://x/)y",
                    "https://x y",
                    "https://x/\"",
                ],
            ),
            (
                TextForm::Command,
                &["load", "vivado -mode batch -source program.tcl", "./up/load --to=/dev/ttyUSB0"],
                &["", " load", "a  b", "a;b", "a $b", "-x", "X=1 a", "a\nb"],
            ),
            (
                TextForm::Sensor,
                &["ov7670-vga", "mine.toml", "../my sensors/mine.toml"],
                &["", "..", "-x.toml", "a/-x.toml", "a/b c.toml", "a\n/b.toml"],
            ),
            (
                TextForm::Change,
                &["frame={width=320,height=240}", "render.irrelevant='mean'"],
                &["", "a\nb"],
            ),
        ] {
            for text in good {
                assert_eq!(form.check_text(text), Ok(()), "{form:?} {text}");
            }
            for text in bad {
                assert!(form.check_text(text).is_err(), "{form:?} {text}");
            }
        }
    }

    #[test]
    fn an_error_names_the_key_and_shows_the_text() {
        let check = |text: &str| check_texts(&text.parse().unwrap()).unwrap_err();
        let error = check("[pins]\ndata = [\"1\", \"a\\nb\"]");
        assert!(error.starts_with("pins.data[1] = \"a\\nb\": expected letters, digits"), "{error}");
        let error = check(&format!("title = '{}'", "x".repeat(201)));
        assert!(
            error.ends_with("...\": it has 201 characters; at most 200 are allowed"),
            "{error}"
        );
    }
}

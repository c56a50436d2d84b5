// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tables as text.

use std::fmt::Write as _;

/// Returns a CSV file (RFC 4180). All records have the same number of fields; fields are quoted
/// where necessary.
///
/// # Panics
/// Panics if the number of fields of a record differs from that of the first.
#[must_use]
pub fn csv_text<R>(records: impl IntoIterator<Item = R>) -> String
where
    R: IntoIterator<Item: AsRef<[u8]>>,
{
    let mut file = csv::Writer::from_writer(Vec::new());
    for record in records {
        file.write_record(record).expect("memory takes everything, and records are alike");
    }
    let bytes = file.into_inner().expect("memory takes everything");
    String::from_utf8(bytes).expect("fields are text")
}

/// Escapes a name so that every reader accepts it unchanged, even one that supports neither quotes
/// nor a `#` in a name. The characters `,` `#` `"` `%` and control characters are written as in a
/// URL (`%2C`).
#[must_use]
pub fn escape_name(name: &str) -> String {
    let mut text = String::with_capacity(name.len());
    for letter in name.chars() {
        match letter {
            ',' | '#' | '"' | '%' | '\0'..='\x1F' | '\x7F' => {
                let _ = write!(text, "%{:02X}", u32::from(letter));
            }
            other => text.push(other),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_quoted_only_where_necessary() {
        let records = [["name", "b"], ["a b.png", ""], ["a,\"b\".png", "c\nd"]];
        assert_eq!(csv_text(records), "name,b\na b.png,\n\"a,\"\"b\"\".png\",\"c\nd\"\n");
    }

    #[test]
    fn escaped_names_need_no_quotes() {
        assert_eq!(escape_name("clips/a b-1_\u{fc}.png"), "clips/a b-1_\u{fc}.png");
        assert_eq!(escape_name("a,\"b\"#1 50%\n.png"), "a%2C%22b%22%231 50%25%0A.png");
        assert_eq!(csv_text([[escape_name("a,\"\r")]]), escape_name("a,\"\r") + "\n");
    }
}

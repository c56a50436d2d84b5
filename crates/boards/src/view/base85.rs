// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bytes as text in base 85, which takes a sixth less space than base64: five characters stand for
//! four bytes.
//!
//! The characters are harmless in an element of HTML. `web/engine_text.js` reads the text.

/// The 85 digits. The characters that mean something in HTML or in strings are left out.
pub(crate) const DIGITS: &[u8; 85] =
    b"0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%()*+-.:;=?@[]^_{|}~";

/// Encodes bytes. Every group of four, with the first byte as the most significant one, becomes
/// five digits, the most significant first. A last group of n < 4 bytes becomes n + 1 digits.
pub(crate) fn encode(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len().div_ceil(4) * 5);
    for group in bytes.chunks(4) {
        let mut word = [0; 4];
        word[..group.len()].copy_from_slice(group);
        let word = u32::from_be_bytes(word);
        let digits =
            [85_u32.pow(4), 85_u32.pow(3), 85_u32.pow(2), 85, 1].map(|unit| word / unit % 85);
        text.extend(digits[..=group.len()].iter().map(|&digit| char::from(DIGITS[digit as usize])));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Decodes a text by its definition: digits that are missing at the end count as 84.
    fn decode(text: &str) -> Vec<u8> {
        let value = |digit: &u8| DIGITS.iter().position(|own| own == digit).unwrap() as u64;
        let groups = text.as_bytes().chunks(5).flat_map(|group| {
            let digits = group.iter().map(value).chain(std::iter::repeat(84)).take(5);
            let word = u32::try_from(digits.fold(0, |word, digit| 85 * word + digit)).unwrap();
            word.to_be_bytes()[..group.len() - 1].to_vec()
        });
        groups.collect()
    }

    #[test]
    fn a_text_becomes_the_same_bytes() {
        assert_eq!(encode(&[]), "");
        assert_eq!(encode(&[0, 0, 0, 0]), "00000");
        assert_eq!(encode(&[255; 4]), "|NsC0");
        let byte = |n: u32| (n * n % 251 + n / 7 % 6).to_le_bytes()[0];
        let bytes: Vec<u8> = (0..2000).map(byte).collect();
        for length in (0..40).chain([1999, 2000]) {
            assert_eq!(decode(&encode(&bytes[..length])), bytes[..length], "{length}");
        }
    }

    #[test]
    fn every_digit_is_another_and_harmless_in_html() {
        let digits: std::collections::BTreeSet<_> = DIGITS.iter().collect();
        assert_eq!(digits.len(), 85);
        assert!(DIGITS.iter().all(|digit| !b"<>&'\"`\\".contains(digit)));
    }
}

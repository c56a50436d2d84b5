// SPDX-License-Identifier: MIT OR Apache-2.0
//! The natural order of file names: numbers compare by value, so `frame2` comes before `frame10`.

use std::cmp::Ordering;
use std::path::Path;

/// Compares two paths folder by folder in natural order. The order is total: names that differ only
/// in leading zeros are ordered by their bytes.
#[must_use]
pub fn natural_order(a: &Path, b: &Path) -> Ordering {
    let mut left = a.components();
    let mut right = b.components();
    loop {
        let order = match (left.next(), right.next()) {
            (None, None) => break a.cmp(b),
            (None, Some(_)) => Ordering::Less,
            (Some(_), None) => Ordering::Greater,
            (Some(l), Some(r)) => compare_names(
                l.as_os_str().to_string_lossy().as_bytes(),
                r.as_os_str().to_string_lossy().as_bytes(),
            ),
        };
        if order != Ordering::Equal {
            break order;
        }
    }
}

fn compare_names(mut a: &[u8], mut b: &[u8]) -> Ordering {
    loop {
        let (Some(&first), Some(&second)) = (a.first(), b.first()) else {
            return a.len().cmp(&b.len());
        };
        let order = if first.is_ascii_digit() && second.is_ascii_digit() {
            compare_numbers(take_number(&mut a), take_number(&mut b))
        } else {
            (a, b) = (&a[1..], &b[1..]);
            first.cmp(&second)
        };
        if order != Ordering::Equal {
            return order;
        }
    }
}

/// Takes the digits from the front of a text, and returns them without leading zeros.
fn take_number<'a>(text: &mut &'a [u8]) -> &'a [u8] {
    let end = text.iter().position(|byte| !byte.is_ascii_digit()).unwrap_or(text.len());
    let (digits, rest) = text.split_at(end);
    *text = rest;
    let zeros = digits.iter().take_while(|&&digit| digit == b'0').count();
    &digits[zeros..]
}

/// Compares numbers without leading zeros: the one with more digits is larger.
fn compare_numbers(a: &[u8], b: &[u8]) -> Ordering {
    a.len().cmp(&b.len()).then_with(|| a.cmp(b))
}

/// Returns true if two names without their extensions differ at most in leading zeros.
pub(crate) fn is_same_number(a: &Path, b: &Path) -> bool {
    let stem = |path: &Path| path.with_extension("").as_os_str().as_encoded_bytes().to_owned();
    let (a, b) = (stem(a), stem(b));
    let (mut left, mut right) = (a.as_slice(), b.as_slice());
    loop {
        match (left.first(), right.first()) {
            (None, None) => return true,
            (Some(one), Some(other)) if one.is_ascii_digit() && other.is_ascii_digit() => {
                if take_number(&mut left) != take_number(&mut right) {
                    return false;
                }
            }
            (one, other) if one == other => (left, right) = (&left[1..], &right[1..]),
            _ => return false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_compare_as_numbers_anywhere_in_a_path() {
        let sorted = [
            "a/frame2.png",
            "a/frame10.png",
            "a2/x",
            "a10/x",
            "frame",
            "frame-3",
            "frame1.png",
            "frame1a.png",
            "frame002.png",
            "frame2.png",
            "frame99999999999999999999998.png",
            "frame99999999999999999999999.png",
            "frames",
        ];
        let mut paths: Vec<&Path> = sorted.iter().map(Path::new).collect();
        paths.reverse();
        paths.sort_by(|a, b| natural_order(a, b));
        assert_eq!(paths, sorted.map(Path::new));
    }

    #[test]
    fn equal_only_if_the_same() {
        let order = natural_order(Path::new("f01"), Path::new("f1"));
        assert_ne!(order, Ordering::Equal);
        assert_eq!(order, natural_order(Path::new("f1"), Path::new("f01")).reverse());
        assert_eq!(natural_order(Path::new("f1"), Path::new("f1")), Ordering::Equal);
    }
    #[test]
    fn numbers_with_other_zeros_are_the_same() {
        let same = |a: &str, b: &str| is_same_number(Path::new(a), Path::new(b));
        assert!(same("a/f1.png", "a/f01.png") && same("a/f1.png", "a/f1.jpg") && same("2", "02"));
        assert!(!same("a/f1.png", "b/f1.png") && !same("f1.png", "f10.png") && !same("f1", "f1a"));
        assert!(!same("f", "f1") && !same("1f", "f1"));
    }
}

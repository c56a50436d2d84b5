// SPDX-License-Identifier: MIT OR Apache-2.0
//! Formats a number of bytes with its unit.

/// Returns a number of bytes in the largest binary unit that divides it, such as `1 MiB` or
/// `1500 bytes`.
pub(crate) fn size_text(bytes: u64) -> String {
    let units = [(30, "GiB"), (20, "MiB"), (10, "KiB")];
    let unit = units.into_iter().find(|(shift, _)| bytes > 0 && bytes.trailing_zeros() >= *shift);
    unit.map_or_else(
        || if bytes == 1 { "1 byte".to_owned() } else { format!("{bytes} bytes") },
        |(shift, unit)| format!("{} {unit}", bytes >> shift),
    )
}

#[cfg(test)]
mod tests {
    use super::size_text;

    #[test]
    fn the_unit_divides_the_number() {
        let cases = [
            (0, "0 bytes"),
            (1, "1 byte"),
            (1 << 10, "1 KiB"),
            (3 << 20, "3 MiB"),
            (1 << 30, "1 GiB"),
            (1025, "1025 bytes"),
        ];
        for (bytes, text) in cases {
            assert_eq!(size_text(bytes), text);
        }
    }
}

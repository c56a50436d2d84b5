// SPDX-License-Identifier: MIT OR Apache-2.0
//! Formats numbers for people.

/// The text in place of a missing number.
pub const MISSING: &str = "–";

/// Formats a number with commas between thousands.
#[must_use]
pub fn grouped(value: u64) -> String {
    let digits = value.to_string();
    let (first, rest) = digits.split_at((digits.len() - 1) % 3 + 1);
    let thousands = rest.as_bytes().chunks(3).map(String::from_utf8_lossy);
    thousands.fold(first.to_owned(), |text, group| text + "," + &group)
}

/// Formats a share in percent, without the sign; small shares have more digits.
#[must_use]
pub fn percent(share: f64) -> String {
    let value = share * 100.0;
    match value.abs() {
        _ if !value.is_finite() => MISSING.to_owned(),
        0.0 => "0".to_owned(),
        magnitude if magnitude < 0.0005 => "<0.001".to_owned(),
        magnitude if magnitude < 0.9995 => format!("{value:.3}"),
        magnitude if magnitude < 9.995 => format!("{value:.2}"),
        _ => format!("{value:.1}"),
    }
}

/// Formats a number with some digits after the point; a large number is whole, with commas between
/// thousands.
#[must_use]
pub fn real_number(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return MISSING.to_owned();
    }
    if value.abs() < 999.5 {
        let text = format!("{value:.digits$}");
        let is_zero = !text.contains(|digit: char| ('1'..='9').contains(&digit));
        return if is_zero { text.trim_start_matches('-').to_owned() } else { text };
    }
    let (whole, sign) = (format!("{:.0}", value.abs()), if value < 0.0 { "-" } else { "" });
    whole.parse().map_or_else(|_| format!("{value:.3e}"), |whole| sign.to_owned() + &grouped(whole))
}

/// Formats the number at a tick: short, with k, M or G.
#[must_use]
pub fn tick_label(value: f64) -> String {
    let magnitude = value.abs();
    let (value, unit) = match magnitude {
        _ if magnitude >= 1e9 => (value / 1e9, " G"),
        _ if magnitude >= 1e6 => (value / 1e6, " M"),
        _ if magnitude >= 1e3 => (value / 1e3, " k"),
        _ => (value, ""),
    };
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    format!("{}{unit}", if text == "-0" { "0" } else { text })
}

/// Formats a count with its unit: `1 clip`, `2 clips`.
#[must_use]
pub fn counted(count: usize, one: &str) -> String {
    format!("{} {one}{}", grouped(count as u64), if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_matter() {
        let shares = [0.0, 1e-8, 0.000_05, 0.003_1, 0.0999, 0.5, 1.0, f64::NAN].map(percent);
        assert_eq!(shares, ["0", "<0.001", "0.005", "0.310", "9.99", "50.0", "100.0", "–"]);
        assert_eq!(
            [0, 12, 999, 1000, 143_472, 1_182_240].map(grouped).join(" "),
            "0 12 999 1,000 143,472 1,182,240"
        );
        assert_eq!(
            [0.25, -0.04, -0.3, 37.04, 12_345.6, -4e3].map(|value| real_number(value, 1)),
            ["0.2", "0.0", "-0.3", "37.0", "12,346", "-4,000"]
        );
        assert_eq!(real_number(f64::INFINITY, 1), "–");
        let ticks = [0.0, 0.001, 2.5, 1e3, 2e4, 1.5e6, 3e9].map(tick_label);
        assert_eq!(ticks, ["0", "0.001", "2.5", "1 k", "20 k", "1.5 M", "3 G"]);
        assert_eq!([counted(1, "clip"), counted(2000, "point")], ["1 clip", "2,000 points"]);
    }
}

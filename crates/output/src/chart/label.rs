// SPDX-License-Identifier: MIT OR Apache-2.0
//! Formats numbers and names in a chart.

/// Returns a label with no more digits than necessary.
pub(crate) fn number_label(value: f64) -> String {
    // Values of an axis are sums of steps, so rounding removes their errors.
    ((value * 1e9).round() / 1e9).to_string()
}

/// Returns a label of a logarithmic axis, such as `20 k`.
pub(crate) fn unit_label(value: f64) -> String {
    let units = [(1e9, " G"), (1e6, " M"), (1e3, " k")];
    let unit = units.into_iter().find(|&(size, _)| value >= size).unwrap_or((1.0, ""));
    format!("{}{}", (value / unit.0 * 10.0).round() / 10.0, unit.1)
}

/// Truncates a name to at most this many letters.
pub(crate) fn truncated(name: &str, letters: usize) -> String {
    if name.chars().count() <= letters {
        return name.to_owned();
    }
    name.chars().take(letters - 1).chain(['…']).collect()
}

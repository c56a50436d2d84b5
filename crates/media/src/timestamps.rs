// SPDX-License-Identifier: MIT OR Apache-2.0
//! The times of frames that have none of their own, such as images, from a file
//! ([`TimestampsFile`]).
//!
//! A line of the file has the time of a frame, as a decimal number. The name of the frame's
//! file may follow or precede it, separated by a comma or by white space. Empty lines and lines
//! that begin with `#` are ignored.

use crate::FootageError;
use foveate_tools::{Interrupt, InterruptibleReader, LimitedReader, open_interruptibly};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

/// The largest file of times in bytes.
const MAX_BYTES: u64 = 1 << 26;

/// The longest time between the first frame and the last in ns, ten years. More is most likely
/// another unit.
const MAX_SPAN_NS: i128 = 3653 * 24 * 3600 * 1_000_000_000;

/// The largest number of characters of a line in messages.
const MAX_SHOWN: usize = 60;

/// The unit of the times in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TimestampUnit {
    /// Seconds.
    #[default]
    Seconds,
    /// Milliseconds.
    Milliseconds,
    /// Microseconds.
    Microseconds,
    /// Nanoseconds.
    Nanoseconds,
}

impl TimestampUnit {
    /// All units, largest first.
    pub const ALL: [Self; 4] =
        [Self::Seconds, Self::Milliseconds, Self::Microseconds, Self::Nanoseconds];

    /// Returns the symbol of the unit.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Seconds => "s",
            Self::Milliseconds => "ms",
            Self::Microseconds => "us",
            Self::Nanoseconds => "ns",
        }
    }

    /// Returns the number of decimals of a time in seconds that the unit moves before the point.
    fn decimals(self) -> usize {
        match self {
            Self::Seconds => 0,
            Self::Milliseconds => 3,
            Self::Microseconds => 6,
            Self::Nanoseconds => 9,
        }
    }
}

/// A file of times.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TimestampsFile {
    /// The path of the file.
    pub path: PathBuf,
    /// The unit of its times.
    pub unit: TimestampUnit,
}

/// The entry of a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TimestampEntry {
    /// The time since the first frame in microseconds.
    pub(crate) time_us: u64,
    /// The name of the frame's file without its folder, if the file of times has names.
    pub(crate) name: Option<String>,
    pub(crate) line: usize,
}

impl TimestampsFile {
    /// Reads the entries. Their times are counted from the first.
    pub(crate) fn read(&self, interrupt: &Interrupt) -> Result<Vec<TimestampEntry>, FootageError> {
        let text = self.text(interrupt).map_err(|error| match interrupt.is_set() {
            true => FootageError::Interrupted,
            false => self.refused(error.to_string()),
        })?;
        let text = text.strip_prefix('\u{FEFF}').unwrap_or(&text);
        let mut entries: Vec<TimestampEntry> = Vec::new();
        let mut first_ns = None;
        for (number, line) in text.lines().enumerate() {
            let line = line.trim();
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            let (time_ns, name) = parse_line(line, self.unit)
                .map_err(|problem| self.refused(format!("line {}: {problem}", number + 1)))?;
            let since_ns = time_ns - *first_ns.get_or_insert(time_ns);
            if since_ns > MAX_SPAN_NS {
                return Err(self.refused(format!(
                    "line {}: the time is more than ten years after the first; --timestamp-unit names the unit",
                    number + 1
                )));
            }
            let time_us = u64::try_from((since_ns + 500).div_euclid(1000)).ok();
            let after = |last: &TimestampEntry| time_us.is_some_and(|time| time > last.time_us);
            if !entries.last().is_none_or(after) {
                return Err(self.refused(format!(
                    "line {}: the time is not later, by a microsecond at least, than that of the frame before; \
                     times increase",
                    number + 1
                )));
            }
            entries.push(TimestampEntry {
                time_us: time_us.unwrap_or_default(),
                name,
                line: number + 1,
            });
        }
        Ok(entries)
    }

    fn text(&self, interrupt: &Interrupt) -> io::Result<String> {
        let file = InterruptibleReader::new(open_interruptibly(&self.path, interrupt)?, interrupt);
        let mut text = String::new();
        LimitedReader::new(file, MAX_BYTES).read_to_string(&mut text)?;
        Ok(text)
    }

    /// Returns the error for this file.
    pub(crate) fn refused(&self, problem: String) -> FootageError {
        FootageError::Timestamps { path: self.path.clone(), problem }
    }
}

/// Returns the time of a line in nanoseconds, and the name beside it.
fn parse_line(line: &str, unit: TimestampUnit) -> Result<(i128, Option<String>), String> {
    let halves =
        |pair: Option<(&str, &str)>| pair.map(|(a, b)| (a.trim().to_owned(), b.trim().to_owned()));
    let separator = if line.contains(',') { |c: char| c == ',' } else { char::is_whitespace };
    let (first, last) = (halves(line.split_once(separator)), halves(line.rsplit_once(separator)));
    let (Some((time, name)), Some((other_name, other_time))) = (first, last) else {
        return parse_time_ns(line, unit).map(|time| (time, None));
    };
    let named = |time: i128, name: &str| {
        let name = Path::new(name).file_name().map(|name| name.to_string_lossy().into_owned());
        (time, name)
    };
    match (parse_time_ns(&time, unit), parse_time_ns(&other_time, unit)) {
        (Ok(_), Ok(_)) => {
            Err("there are two numbers; a line has one time, with a decimal point".to_owned())
        }
        (Ok(time), Err(_)) => Ok(named(time, &name)),
        (Err(_), Ok(time)) => Ok(named(time, &other_name)),
        (Err(problem), Err(_)) => Err(problem),
    }
}

/// Parses a decimal number of a unit as nanoseconds. Digits below a nanosecond are left out.
fn parse_time_ns(text: &str, unit: TimestampUnit) -> Result<i128, String> {
    let symbol = unit.symbol();
    let shown: String = text.chars().take(MAX_SHOWN).collect();
    let wrong = || {
        format!(
            "`{shown}` is not a time in {symbol}, a decimal number such as 12.5; --timestamp-unit names the unit"
        )
    };
    // A number with an exponent has no more digits than a floating-point number.
    let plain = match text.contains(['e', 'E']) {
        true => format!(
            "{:.9}",
            text.parse::<f64>().ok().filter(|time| time.is_finite()).ok_or_else(wrong)?
        ),
        false => text.to_owned(),
    };
    let number = plain.strip_prefix(['-', '+']).unwrap_or(&plain);
    let (whole, fraction) = number.split_once('.').unwrap_or((number, ""));
    let is_number = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    if !is_number(whole) || !is_number(fraction) || whole.len() + fraction.len() == 0 {
        return Err(wrong());
    }
    let digits = 9 - unit.decimals();
    let fraction = &fraction[..fraction.len().min(digits)];
    // A time of a clock, such as nanoseconds since 1970, has 19 digits.
    let nanoseconds: i128 = format!("0{whole}{fraction:0<digits$}")
        .parse()
        .ok()
        .filter(|&time: &i128| time < i128::from(i64::MAX))
        .ok_or_else(|| {
            format!("`{shown}` {symbol} is too large for a time; --timestamp-unit names the unit")
        })?;
    Ok(if plain.starts_with('-') { -nanoseconds } else { nanoseconds })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, unit: TimestampUnit) -> Result<Vec<(u64, Option<String>)>, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("times.txt");
        std::fs::write(&path, text).unwrap();
        let entries = TimestampsFile { path, unit }
            .read(&Interrupt::default())
            .map_err(|error| error.to_string())?;
        Ok(entries.into_iter().map(|entry| (entry.time_us, entry.name)).collect())
    }

    #[test]
    fn times_are_counted_from_the_first_in_any_unit() {
        let times = |text, unit| {
            read(text, unit).map(|entries| entries.into_iter().map(|entry| entry.0).collect())
        };
        let expected: Result<Vec<u64>, String> = Ok(vec![0, 33_333, 66_667]);
        for (text, unit) in [
            ("# seconds\n0.0\n0.0333333\n\n0.0666666667\n", TimestampUnit::Seconds),
            ("1305031102.1\n1305031102.133333\n1305031102.166667", TimestampUnit::Seconds),
            ("-33.333\r\n0\r\n33.3337\r\n", TimestampUnit::Milliseconds),
            ("10000\n43333\n76667\n", TimestampUnit::Microseconds),
            ("\u{FEFF}+1.0e+00\n1.033333e+00\n1.066666666e0\n", TimestampUnit::Seconds),
            (
                "1403636579763555584\n1403636579796888584\n1403636579830222084",
                TimestampUnit::Nanoseconds,
            ),
        ] {
            assert_eq!(times(text, unit), expected, "{text}");
        }
    }

    #[test]
    fn names_may_stand_beside_times() {
        let expected = vec![(0, Some("a.png".to_owned())), (500_000, Some("b.png".to_owned()))];
        for text in [
            "1 rgb/a.png\n1.5 rgb/b.png",
            "1,a.png\n1.5, b.png",
            "images/a.png 1\nimages/b.png 1.5",
        ] {
            assert_eq!(read(text, TimestampUnit::Seconds).unwrap(), expected, "{text}");
        }
    }

    #[test]
    fn times_that_make_no_sense_are_refused() {
        for (text, problem) in [
            ("0\n1\n1\n", "line 3: the time is not later"),
            ("0\n1\n0.5\n", "line 3: the time is not later"),
            ("time\n0\n", "line 1: `time` is not a time in s"),
            ("0\n1e\n", "line 2: `1e` is not a time in s"),
            ("0\n1e999\n", "line 2: `1e999` is not a time in s"),
            ("0\n1,5\n", "line 2: there are two numbers; a line has one time"),
            ("0\n400000000\n", "more than ten years after the first; --timestamp-unit"),
            ("1403636579763555584\n", "too large for a time; --timestamp-unit"),
            ("a 0 b\n", "line 1: `a` is not a time"),
            (".\n", "line 1: `.` is not a time"),
        ] {
            let error = read(text, TimestampUnit::Seconds).unwrap_err();
            assert!(error.contains(problem), "{text}: {error}");
        }
    }
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frame rate, its notation, and the times of frames.

use crate::FootageError;

/// The number of frames per second as a fraction. Frame t of a sequence of images has the time t /
/// rate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRate {
    frames: u32,
    seconds: u32,
}

impl FrameRate {
    /// Makes a rate of `frames` in `seconds`, such as 30 in 1 or 30000 in 1001.
    ///
    /// # Errors
    /// Fails if one of the numbers is zero.
    pub fn new(frames: u32, seconds: u32) -> Result<Self, FootageError> {
        if frames == 0 || seconds == 0 {
            return Err(FootageError::FrameRate { frames, seconds });
        }
        Ok(Self { frames, seconds })
    }

    /// Parses a rate such as `30`, `29.97` or `30000/1001`.
    ///
    /// # Errors
    /// Fails if the text is not a rate. The error says what is expected.
    pub fn parse(text: &str) -> Result<Self, String> {
        let wrong = || "expected frames per second, such as 30, 29.97 or 30000/1001".to_owned();
        let digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
        let (frames, seconds) = match (text.split_once('/'), text.split_once('.')) {
            (Some((frames, seconds)), _) if digits(frames) => {
                (frames.parse().ok(), seconds.parse().ok())
            }
            (None, Some((whole, part)))
                if digits(whole) && digits(part) && (1..=6).contains(&part.len()) =>
            {
                let unit =
                    u32::try_from(part.len()).ok().and_then(|power| 10u32.checked_pow(power));
                (format!("{whole}{part}").parse().ok(), unit)
            }
            (None, None) if digits(text) => (text.parse().ok(), Some(1)),
            _ => (None, None),
        };
        let (frames, seconds) = frames.zip(seconds).ok_or_else(wrong)?;
        Self::new(frames, seconds).map_err(|_| wrong())
    }

    /// Returns the time of a frame in microseconds, rounded to the nearest.
    #[must_use]
    pub fn time_us(self, frame: u64) -> u64 {
        let scaled = u128::from(frame) * u128::from(self.seconds) * 1_000_000;
        let rounded = (scaled + u128::from(self.frames) / 2) / u128::from(self.frames);
        u64::try_from(rounded).unwrap_or(u64::MAX)
    }

    /// Returns the number of whole frame times that have passed at a time.
    pub(crate) fn frames_passed(self, time_us: u64) -> u128 {
        u128::from(time_us) * u128::from(self.frames) / (u128::from(self.seconds) * 1_000_000)
    }

    /// Returns an eighth of the time of a frame in microseconds.
    pub(crate) fn eighth_us(self) -> u64 {
        u64::from(self.seconds) * 1_000_000 / (8 * u64::from(self.frames))
    }
}

impl Default for FrameRate {
    fn default() -> Self {
        Self { frames: 30, seconds: 1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_rounded_to_the_nearest_microsecond_without_drift() {
        let rate = FrameRate::default();
        assert_eq!([0, 1, 2, 3].map(|t| rate.time_us(t)), [0, 33_333, 66_667, 100_000]);
        assert_eq!(FrameRate::new(30_000, 1_001).unwrap().time_us(30_000), 1_001_000_000);
        assert_eq!(rate.time_us(u64::MAX), u64::MAX);
        let message = FrameRate::new(0, 1).unwrap_err().to_string();
        assert!(message.starts_with("0 frames in 1 s are not a frame rate"));
    }

    #[test]
    fn rates_are_read_as_people_write_them() {
        let rate = |frames, seconds| Ok(FrameRate { frames, seconds });
        assert_eq!(FrameRate::parse("30"), rate(30, 1));
        assert_eq!(FrameRate::parse("29.97"), rate(2997, 100));
        assert_eq!(FrameRate::parse("0.5"), rate(5, 10));
        assert_eq!(FrameRate::parse("30000/1001"), rate(30_000, 1001));
        for text in ["", "0", "-5", "1/0", "a", "1.", "30/", "0.0", "1e3", "99999999999", "+5"] {
            assert!(FrameRate::parse(text).is_err(), "{text}");
        }
    }
}

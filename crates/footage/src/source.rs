// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sources of frames, and frames with their names and times.

pub(crate) mod ahead;
pub(crate) mod feed;
pub(crate) mod files;
pub(crate) mod form;
pub(crate) mod memory;
pub(crate) mod resize;
pub(crate) mod select;

use foveate_frame::Raster;

use crate::FootageError;
use form::SetForm;

/// A frame with its name and time.
#[derive(Clone, Debug)]
pub struct SourceFrame {
    /// File name, or the name of the scene.
    pub name: String,
    /// Time since the first frame of the clip in microseconds.
    pub time_us: u64,
    /// The class of an image of a labelled set.
    pub label: Option<String>,
    /// The pixels.
    pub frame: Raster,
}

/// Where a frame was in its input, before any option took, cropped or scaled it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin {
    /// Its number among all frames of the input, from 0. After a sought start only with
    /// [`InputOptions::numbered`](crate::InputOptions::numbered).
    pub number: u64,
    /// Width and height.
    pub size: (u32, u32),
    /// Whether its name is that of a file of its own.
    pub own_file: bool,
}

/// How the frames of a source are related.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// They follow each other in time.
    Clip,
    /// They are unrelated: each is a first frame.
    Set,
}

impl Kind {
    /// The time of a frame without one of its own: by the rate in a clip, zero in a set.
    pub(crate) fn time_us(self, rate: FrameRate, frame: u64) -> u64 {
        match self {
            Self::Clip => rate.time_us(frame),
            Self::Set => 0,
        }
    }
}

/// Frames of one size and depth, one at a time.
pub trait Source: Send {
    /// Width and height of every frame.
    fn size(&self) -> (u32, u32);

    /// The inputs as the user named them, for the summary.
    fn inputs(&self) -> &[String];

    /// The number of all frames, if it is known. For a video it comes from the container, and may be
    /// wrong.
    fn frames(&self) -> Option<u64>;

    /// The next frame, or `None` after the last.
    ///
    /// # Errors
    /// When it cannot be read or does not have the size of the others.
    fn next_frame(&mut self) -> Result<Option<SourceFrame>, FootageError>;

    /// Takes back a frame that is no longer needed, to use its memory again.
    fn give_back(&mut self, _frame: SourceFrame) {}

    /// Where the frame that was given last was in its input; `None` where a source has no such place, and
    /// before the first frame.
    fn origin(&self) -> Option<Origin> {
        None
    }

    /// Whether frames follow each other in time. In a set, every frame is a first frame.
    fn kind(&self) -> Kind {
        Kind::Clip
    }

    /// For a set: the kind of its files, and its labels.
    fn form(&self) -> SetForm {
        SetForm::default()
    }

    /// After the last frame: why the source ended too early, if it did. The frames before are good.
    fn problem(&self) -> Option<String> {
        None
    }
}

/// Frames per second as a fraction; frame t of a set of images is at t / rate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRate {
    frames: u32,
    seconds: u32,
}

impl FrameRate {
    /// `frames` in `seconds`: 30 in 1, or 30000 in 1001.
    ///
    /// # Errors
    /// When one of the numbers is zero.
    pub fn new(frames: u32, seconds: u32) -> Result<Self, FootageError> {
        if frames == 0 || seconds == 0 {
            return Err(FootageError::FrameRate { frames, seconds });
        }
        Ok(Self { frames, seconds })
    }

    /// A rate as people write it: `30`, `29.97` or `30000/1001`.
    ///
    /// # Errors
    /// When the text is not a rate; the error says what would be right.
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

    /// Time of a frame in microseconds, rounded to the nearest.
    #[must_use]
    pub fn time_us(self, frame: u64) -> u64 {
        let scaled = u128::from(frame) * u128::from(self.seconds) * 1_000_000;
        let rounded = (scaled + u128::from(self.frames) / 2) / u128::from(self.frames);
        u64::try_from(rounded).unwrap_or(u64::MAX)
    }

    /// How many whole frame times have passed at a time.
    pub(crate) fn passed(self, time_us: u64) -> u128 {
        u128::from(time_us) * u128::from(self.frames) / (u128::from(self.seconds) * 1_000_000)
    }

    /// An eighth of the time of a frame.
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
        assert!(message.starts_with("0 frames in 1 s is not a frame rate"));
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
